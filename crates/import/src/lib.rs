//! Files of other tools as problems: models in SMV, as NuSMV and its relatives write it, circuits in AIGER, AutoHyper's
//! explicit systems and Boolean programs, planning tasks in PDDL; formulas of HyperQB 1 and 2.0, HyperLasso, AutoHyper and MCHyper.
//!
//! What comes out is a syntax tree of the problem language whose places are those of the original files, so that
//! whatever is found wrong with it later is shown where it was written. No file is read here.
//!
//! `lexer` and `parser` read models and formulas alike; `smv` puts modules together; `lower` turns expressions into those
//! of the problem language, `system` models into systems. Models in other forms than SMV become modules of it (`build`).

mod aiger;
mod build;
mod dialect;
mod explicit;
mod hq;
mod known;
mod lexer;
mod lower;
mod mchyper;
mod names;
mod parser;
mod pddl;
mod program;
mod smv;
mod system;
mod tree;

pub use aiger::ascii;
pub use dialect::Dialect;
use hyperplan_syntax::ast::{
    self, Expr, ExprKind, File, Formula, Ident, Item, Objective, ObjectiveBody, Quantifier,
};
use hyperplan_syntax::{Diagnostic, SourceId, SourceMap, Span};
pub use known::Known;

use lower::{Lower, Named, Path, Place};
use names::Names;
use smv::model::Model;
use std::collections::BTreeMap;

/// What kind of file it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A model in SMV.
    Smv,
    /// A circuit in AIGER.
    Aiger,
    /// An explicit system of AutoHyper.
    Explicit,
    /// A Boolean program of AutoHyper.
    Program,
    /// A domain or a problem in PDDL.
    Pddl,
    /// A formula.
    Formula,
}

impl Kind {
    /// The kind of a file, by its name; where that ends with `.txt`, by how it begins.
    #[must_use]
    pub fn of(name: &str, text: &str) -> Option<Kind> {
        match name.rsplit_once('.')?.1 {
            "smv" | "nusmv" => Some(Kind::Smv),
            "aag" | "aig" => Some(Kind::Aiger),
            "hq" => Some(Kind::Formula),
            "txt" => Kind::of_text(text),
            // Plans have this ending too.
            "pddl" => is_definition(text).then_some(Kind::Pddl),
            _ => None,
        }
    }

    fn of_text(text: &str) -> Option<Kind> {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with("--"))?;
        let (first, rest) = line.split_at(line.find(|c| !word(c)).unwrap_or(line.len()));
        match (first.to_lowercase().as_str(), rest.trim_start()) {
            ("forall" | "exists", _) => Some(Kind::Formula),
            ("ap" | "variables", rest) if rest.starts_with(':') => Some(Kind::Explicit),
            (_, rest) if !first.is_empty() && rest.starts_with(':') && rest.ends_with(';') => {
                Some(Kind::Program)
            }
            _ => None,
        }
    }

    /// The modules of a model's text, as far as they can be read, and what is wrong.
    fn modules(self, source: SourceId, text: &str) -> (Vec<tree::Module>, Vec<Diagnostic>) {
        let read = match self {
            Kind::Smv => return smv::parser::parse(source, text),
            Kind::Aiger => aiger::parse(source, text),
            Kind::Explicit => explicit::parse(source, text),
            Kind::Program => program::parse(source, text),
            Kind::Pddl | Kind::Formula => Ok(Vec::new()),
        };
        read.map_or_else(|error| (Vec::new(), vec![*error]), |modules| (modules, Vec::new()))
    }
}

/// A file to be imported.
#[derive(Clone, Debug)]
pub struct Input {
    /// As the user calls it.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// How formulas are read.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// `within K`: formulas whose operators have no bounds need it.
    pub bound: Option<u32>,
    /// `semantics S`, of a bound: without one they are refused.
    pub semantics: Option<String>,
    /// The language of formulas; without it, that whose signs they have.
    pub dialect: Option<Dialect>,
    /// What is known of the formulas.
    pub status: Option<Known>,
}

/// A variable as it is in a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Original {
    /// Its full name.
    pub name: String,
    /// Whether it has a sign, and how many bits, if it is a word.
    pub word: Option<(bool, u32)>,
    /// Whether it is an input.
    pub input: bool,
}

/// By system and name in the problem.
pub type Originals = BTreeMap<String, BTreeMap<String, Original>>;

/// What some files mean.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// The problem, its places in the original files; incomplete where there are errors.
    pub file: File,
    /// What is wrong.
    pub diagnostics: Vec<Diagnostic>,
    /// What is doubtful, for who asks for that.
    pub doubts: Vec<Diagnostic>,
    /// What the variables of each system are in the original.
    pub originals: Originals,
    /// Comments that say where things come from, for a file of its own.
    pub about: String,
}

/// Makes a problem of models and formulas: a model for each quantifier, or one for all. The texts are added to
/// `sources`.
pub fn import(inputs: &[Input], options: &Options, sources: &mut SourceMap) -> Imported {
    let mut imported = Imported::default();
    let ids: Vec<SourceId> =
        inputs.iter().map(|input| sources.add(input.name.clone(), input.text.as_str())).collect();
    let files = inputs
        .iter()
        .zip(&ids)
        .filter_map(|(input, id)| Some((Kind::of(&input.name, &input.text)?, input, *id)));
    let files: Vec<_> = files.collect();
    if files.iter().any(|(kind, ..)| *kind == Kind::Pddl) {
        return task(&files, options, sources);
    }
    let (formulas, models): (Vec<_>, Vec<_>) =
        files.into_iter().partition(|(kind, ..)| *kind == Kind::Formula);
    let mut distinct: Vec<(Kind, &Input, SourceId)> = Vec::new();
    let numbers: Vec<usize> = models
        .iter()
        .map(|model| {
            distinct.iter().position(|(_, known, _)| known.name == model.1.name).unwrap_or_else(|| {
                distinct.push(*model);
                distinct.len() - 1
            })
        })
        .collect();
    let found = &mut imported.diagnostics;
    let modules: Vec<_> = distinct
        .iter()
        .map(|(kind, input, id)| {
            let (modules, wrong) = kind.modules(*id, &input.text);
            found.extend(wrong);
            modules
        })
        .collect();
    let named: Vec<Named<'_>> =
        modules.iter().filter_map(|modules| Model::new(modules, found)).map(Named::new).collect();
    if named.len() < distinct.len() || found.iter().any(Diagnostic::is_error) {
        found.sort_by_key(|diagnostic| diagnostic.span);
        return imported;
    }
    let doubtful = |diagnostic: &mut Diagnostic| diagnostic.code == "open-case";
    imported.doubts.extend(imported.diagnostics.extract_if(.., doubtful));
    let mut lower = Lower::new(named);
    let mut given = Names::default();
    let mut systems: Vec<Ident> = Vec::new();
    for (at, (_, input, _)) in distinct.iter().enumerate() {
        let name = given.name(stem(&input.name));
        imported.about += &format!("// {name}: {}\n", input.name);
        let name = Ident { name, span: lower.models[at].model.span };
        imported.originals.insert(name.name.clone(), lower.models[at].originals());
        systems.push(name.clone());
        let system = system::system(&mut lower, at, name, &mut imported.diagnostics);
        imported.file.items.push(Item::System(system));
    }
    let mut given = Names::default();
    for (_, input, id) in formulas {
        let name = given.name(stem(&input.name));
        imported.about += &format!("// {name}: {}\n", input.name);
        let known = Known::of(id, &input.text, options);
        if let Ok(Some(known)) = known {
            imported.about += &format!("// {name}: {}\n", known.word());
        }
        imported.diagnostics.extend(known.err().map(|error| *error));
        match objective(&mut lower, (name, input, id), &numbers, &systems, options) {
            Ok((objective, warning)) => {
                imported.file.items.push(Item::Objective(objective));
                imported.diagnostics.extend(warning);
            }
            Err(error) => imported.diagnostics.push(*error),
        }
    }
    // What comes after that is too much as well.
    let mut large = 0;
    imported.diagnostics.retain(|diagnostic| {
        large += usize::from(diagnostic.code == "too-large");
        diagnostic.code != "too-large" || large == 1
    });
    imported.diagnostics.sort_by_key(|diagnostic| diagnostic.span);
    imported
}

/// Whether a text defines something in PDDL.
fn is_definition(text: &str) -> bool {
    let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with(';'));
    line.is_some_and(|line| line.to_lowercase().starts_with("(define"))
}

/// A planning task: a domain and a problem. What it means is written as a problem file first.
fn task(files: &[(Kind, &Input, SourceId)], options: &Options, sources: &mut SourceMap) -> Imported {
    let mut imported = Imported::default();
    let texts: Vec<(SourceId, &str)> =
        files.iter().map(|(_, input, id)| (*id, input.text.as_str())).collect();
    let other = files.iter().find(|(kind, ..)| *kind != Kind::Pddl);
    let whole = |id: &SourceId| Span::new(*id, 0..0);
    let read = match (other, &options.semantics) {
        (Some((_, _, id)), _) => {
            build::wrong("which-model", whole(id), "a task in PDDL stands alone: its goal is the formula")
        }
        (None, Some(_)) => {
            build::wrong("unsupported", whole(&files[0].2), "a plan has an end: semantics are for formulas")
        }
        (None, None) => pddl::problem(&texts, options.bound),
    };
    let text = match read {
        Ok(text) => text,
        Err(error) => {
            imported.diagnostics.push(*error);
            return imported;
        }
    };
    for (_, input, _) in files {
        imported.about += &format!("// {}: {}\n", stem(&input.name), input.name);
    }
    let source = sources.add("the task without parameters".to_owned(), text.as_str());
    let (file, diagnostics) = hyperplan_syntax::parse(source, &text);
    if let Some(known) = options.status {
        let objectives = file.items.iter().filter_map(|item| match item {
            Item::Objective(objective) => Some(&objective.name.name),
            _ => None,
        });
        imported.about.extend(objectives.map(|name| format!("// {name}: {}\n", known.word())));
    }
    Imported { file, diagnostics, ..imported }
}

/// A formula as an objective.
fn objective(
    lower: &mut Lower<'_>,
    (name, input, id): (String, &Input, SourceId),
    models: &[usize],
    systems: &[Ident],
    options: &Options,
) -> parser::Parse<(Objective, Option<Diagnostic>)> {
    let (formula, warning) = hq::parse(id, &input.text, options.dialect)?;
    let whole = Span::new(id, 0..0);
    let count = formula.quantifiers.len();
    if models.len() != 1 && models.len() != count {
        let message = format!("{count} paths are quantified, and there are {} models", models.len());
        let span = formula.quantifiers[0].1.span;
        let help = "give one model for all of them, or one for each, in the order of the quantifiers";
        return lower::wrong_with("which-model", span, message, help);
    }
    let mut given = Names::default();
    let mut paths = Vec::new();
    let mut quantifiers = Vec::new();
    for (at, (forall, path)) in formula.quantifiers.iter().enumerate() {
        let model = if models.len() == 1 { models[0] } else { models[at] };
        let ident = Ident { name: given.name(&path.name), span: path.span };
        paths.push(Path { name: path.name.clone(), ident: ident.clone(), model });
        let system = (systems.len() > 1).then(|| Ident { span: path.span, ..systems[model].clone() });
        quantifiers.push(Quantifier { forall: *forall, path: ident, system });
    }
    if options.bound.is_none() {
        if let Some(semantics) = &options.semantics {
            let message =
                format!("semantics {semantics} are for paths of so many steps, and of how many is not said");
            let help = "say how many steps paths have, or leave the semantics out";
            return lower::wrong_with("semantics-without-bound", whole, message, help);
        }
        bounded(&formula.body)?;
    }
    lower.paths = paths;
    let body = lower.truth(Place::main(models[0]), &formula.body);
    lower.paths = Vec::new();
    let body = body.map_err(|mut error| {
        let about = warning.as_ref().and_then(|warning| Some((warning.span?, warning.message.clone())));
        error.related.extend(about);
        error
    })?;
    let within = options.bound.map(|bound| Expr { kind: ExprKind::Number(bound.to_string()), span: whole });
    let semantics = options.semantics.clone().map(|name| Ident { name, span: whole });
    let body =
        ObjectiveBody::Formula(Formula { defines: Vec::new(), quantifiers, body, minimize: Vec::new() });
    let name = Ident { name, span: formula.quantifiers[0].1.span };
    Ok((Objective { name, within, semantics, body }, warning))
}

/// Refuses operators without bounds, where the formula has no bound as a whole.
fn bounded(body: &tree::Expr) -> parser::Parse<()> {
    let mut stack = vec![body];
    while let Some(e) = stack.pop() {
        let endless = match &e.kind {
            tree::Kind::Unary(op, None, _) => {
                matches!(op, ast::UnaryOp::Finally | ast::UnaryOp::Globally)
            }
            tree::Kind::Binary(_, bounds, ..) => bounds.is_none(),
            _ => false,
        };
        if endless {
            let message = "this operator has no end, and paths of how many steps are meant is not said";
            return lower::wrong("unbounded-operator", e.span, message);
        }
        e.kind.for_each_child(&mut |child| stack.push(child));
    }
    Ok(())
}

/// The file's name without folders and ending.
fn stem(name: &str) -> &str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}
