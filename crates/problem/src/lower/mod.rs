//! From syntax to meaning: names resolved, types checked, maps and templates expanded.
//!
//! Mistakes are collected, not thrown: one run reports all it can find, and what was reported once is treated as
//! unknown from there on, so that one mistake does not look like ten. No file is read here: a [`Loader`] does that.

mod also;
mod base;
mod bodies;
mod changes;
mod clauses;
mod consts;
mod costs;
mod damage;
mod diagnostics;
mod env;
mod expr;
mod files;
mod formula;
mod fractions;
mod graphs;
mod grid;
mod image;
mod json;
mod labels;
mod limits;
mod maps;
mod meaning;
mod minimize;
mod objective;
mod order;
mod paths;
mod ros;
mod scenarios;
mod semantics;
mod sets;
mod special;
mod state;
mod step;
mod system;
mod template;
#[cfg(test)]
mod tests;
mod typed;
mod types;
mod unused;
mod walk;

pub(crate) use base::{Actions, Base};
pub use consts::Overrides;
pub(crate) use diagnostics::Diagnostics;
pub(crate) use fractions::number;
pub use limits::{MAX_BOUND, MAX_DEPTH, MAX_NODES};
pub use minimize::targets;
pub use unused::uses;

use crate::expr::Value;
use crate::ids::SystemId;
use crate::prelude;
use crate::problem::Problem;
use consts::{constants, duplicate};
use env::Env;
use hyperplan_syntax::ast::{self, Item, ObjectiveBody};
use hyperplan_syntax::{Diagnostic, SourceMap, Span};
use objective::{Shared, lower_objective};
use paths::Defines;
use rustc_hash::FxHashMap;
use system::lower_system;
use typed_index_collections::TiVec;

/// Gives the contents of files that a problem names.
pub trait Loader {
    /// The contents of a file, its path as in the problem, relative to the problem file; or why there is none.
    ///
    /// # Errors
    /// A few words such as "no such file", which complete the message "cannot read `PATH`: ".
    fn load(&self, path: &str) -> Result<Vec<u8>, String>;
}

impl<F: Fn(&str) -> Result<Vec<u8>, String>> Loader for F {
    fn load(&self, path: &str) -> Result<Vec<u8>, String> {
        self(path)
    }
}

/// A loader for problems that name no files.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Loader for NoFiles {
    fn load(&self, _path: &str) -> Result<Vec<u8>, String> {
        Err("no files can be read here".into())
    }
}

/// What a problem file means, and what is wrong with it.
#[derive(Debug, Default)]
pub struct Lowered {
    /// Systems and objectives; incomplete, and not to be used, where there are errors.
    pub problem: Problem,
    /// Errors and warnings, in the order found.
    pub diagnostics: Vec<Diagnostic>,
    /// Constants in the order of the file, with their values (replaced ones with what replaced them).
    pub consts: Vec<(String, Value)>,
    /// Warnings of what is declared and never used: for a command that looks for what is doubtful.
    pub unused: Vec<Diagnostic>,
}

impl Lowered {
    /// Whether some diagnostic is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }
}

/// Parses and lowers a problem text; `name` is how messages call it.
pub fn read(
    sources: &mut SourceMap,
    name: &str,
    text: &str,
    loader: &dyn Loader,
    overrides: &Overrides,
) -> Lowered {
    let source = sources.add(name, text);
    let (file, mut diagnostics) = hyperplan_syntax::parse(source, text);
    if diagnostics.iter().any(Diagnostic::is_error) {
        if !file.items.is_empty() {
            let found = lower(&file, sources, loader, overrides).diagnostics;
            diagnostics.extend(damage::independent(found, &file, sources));
            diagnostics.sort_by_key(|diagnostic| diagnostic.span);
        }
        return Lowered { diagnostics, ..Lowered::default() };
    }
    if file.items.is_empty() {
        let help = "a problem declares a system and an objective";
        let nothing = Diagnostic::error("empty-file", Span::new(source, 0..0), "the file declares nothing");
        return Lowered { diagnostics: vec![nothing.with_help(help)], ..Lowered::default() };
    }
    let mut lowered = lower(&file, sources, loader, overrides);
    diagnostics.append(&mut lowered.diagnostics);
    Lowered { diagnostics, ..lowered }
}

/// Gives a syntax tree its meaning. Texts of map files, and of the prelude where it is used, are added to `sources`,
/// so that diagnostics can point into them.
pub fn lower(
    file: &ast::File,
    sources: &mut SourceMap,
    loader: &dyn Loader,
    overrides: &Overrides,
) -> Lowered {
    let mut diagnostics = Diagnostics::default();
    let consts = constants(file, overrides, &mut diagnostics);
    let mut actions = Actions::default();
    let mut env =
        Env { consts: &consts, actions: &mut actions, diagnostics: &mut diagnostics, sources, loader };
    let (mut systems, poisoned) = systems(file, &mut env);
    let library = if uses_prelude(file) { prelude::parse(sources) } else { ast::File::default() };
    let (templates, template_names) = templates(file, &library, &mut diagnostics);
    let shared = Shared {
        systems: &systems,
        poisoned: &poisoned,
        actions: &actions,
        consts: &consts,
        defines: defines(file, &mut diagnostics),
        templates,
        template_names,
    };
    let mut new = Vec::new();
    let objectives = objectives(file, &shared, &mut new, &mut diagnostics);
    bodies::check(file, &shared, &mut diagnostics);
    systems.extend(new);
    Lowered {
        problem: Problem { actions: actions.names, systems, objectives },
        diagnostics: diagnostics.into_list(),
        consts: consts.values(),
        unused: unused::unused(file),
    }
}

type Systems = (TiVec<SystemId, crate::system::System>, TiVec<SystemId, bool>);

fn systems(file: &ast::File, env: &mut Env) -> Systems {
    let mut systems: Systems = (TiVec::new(), TiVec::new());
    let mut names = FxHashMap::default();
    for item in &file.items {
        let Item::System(ast) = item else { continue };
        if let Some(first) = names.get(ast.name.name.as_str()) {
            env.diagnostics.push(duplicate("system", &ast.name, *first));
            continue;
        }
        names.insert(ast.name.name.as_str(), ast.name.span);
        let (system, poisoned) = lower_system(ast, env);
        systems.0.push(system);
        systems.1.push(poisoned);
    }
    systems
}

/// Whether some objective is an instance of a template that the file does not declare itself.
fn uses_prelude(file: &ast::File) -> bool {
    let own = |name: &str| file.items.iter().any(|i| matches!(i, Item::Template(t) if t.name.name == name));
    file.items.iter().any(|item| match item {
        Item::Objective(ast::Objective { body: ObjectiveBody::Instance { template, .. }, .. }) => {
            !own(&template.name)
        }
        _ => false,
    })
}

type Templates<'a> = (FxHashMap<&'a str, &'a ast::Template>, Vec<&'a str>);

/// The templates in reach: those of the file hide those of the prelude.
fn templates<'a>(
    file: &'a ast::File,
    library: &'a ast::File,
    diagnostics: &mut Diagnostics,
) -> Templates<'a> {
    let mut own: FxHashMap<&str, &ast::Template> = FxHashMap::default();
    let mut names = Vec::new();
    for item in &file.items {
        let Item::Template(template) = item else { continue };
        template::check(template, diagnostics);
        if let Some(first) = own.get(template.name.name.as_str()) {
            diagnostics.push(duplicate("template", &template.name, first.name.span));
            continue;
        }
        own.insert(&template.name.name, template);
        names.push(template.name.name.as_str());
    }
    for item in &library.items {
        let Item::Template(template) = item else { continue };
        own.entry(&template.name.name).or_insert(template);
        names.push(&template.name.name);
    }
    (own, names)
}

fn defines<'a>(file: &'a ast::File, diagnostics: &mut Diagnostics) -> Defines<'a> {
    let mut defines: Defines = FxHashMap::default();
    for item in &file.items {
        let Item::Define(define) = item else { continue };
        match defines.get(define.name.name.as_str()) {
            Some((first, _)) => diagnostics.push(duplicate("definition", &define.name, first.name.span)),
            None => drop(defines.insert(&define.name.name, (define, false))),
        }
    }
    defines
}

fn objectives(
    file: &ast::File,
    shared: &Shared,
    new: &mut Vec<crate::system::System>,
    diagnostics: &mut Diagnostics,
) -> Vec<crate::objective::Objective> {
    let mut objectives = Vec::new();
    let mut names = FxHashMap::default();
    for item in &file.items {
        let Item::Objective(ast) = item else { continue };
        if let Some(first) = names.insert(ast.name.name.as_str(), ast.name.span) {
            diagnostics.push(duplicate("objective", &ast.name, first));
            continue;
        }
        match lower_objective(shared, ast, new, diagnostics) {
            Some(objective) => objectives.push(objective),
            // Whatever is refused was reported; should that be forgotten somewhere, nothing may pass in silence.
            None if !diagnostics.any_error() => {
                let message = format!("the objective `{}` cannot be understood", ast.name.name);
                diagnostics.push(Diagnostic::error("objective-refused", ast.name.span, message));
            }
            None => {}
        }
    }
    objectives
}
