//! Objectives: quantifiers, templates, and the check that every path matters.

use super::Diagnostics;
use super::base::Actions;
use super::consts::{Consts, duplicate};
use super::costs::{demand_plain, with_sums};
use super::diagnostics::suggest;
use super::formula::number_of_steps;
use super::limits::Limits;
use super::minimize::lower_minimize;
use super::paths::{Defines, Frame, PathContext};
use super::semantics;
use super::template::{Bindings, bind};
use crate::formula::{Formula, Node};
use crate::ids::{PathId, SystemId};
use crate::objective::{Mode, Objective, PathVar, Quantifier, Semantics};
use crate::system::System;
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::{self, ExprKind, ObjectiveBody};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

/// What objectives share.
pub(super) struct Shared<'a> {
    pub(super) systems: &'a TiSlice<SystemId, System>,
    pub(super) poisoned: &'a TiSlice<SystemId, bool>,
    pub(super) actions: &'a Actions,
    pub(super) consts: &'a Consts,
    pub(super) defines: Defines<'a>,
    pub(super) templates: FxHashMap<&'a str, &'a ast::Template>,
    /// In order, for suggestions.
    pub(super) template_names: Vec<&'a str>,
}

/// What an objective says, be it by itself or by a template.
struct Body<'a> {
    formula: &'a ast::Formula,
    bindings: Bindings<'a>,
    consts: Consts,
}

/// An objective; `None` after a message. Systems that only such objectives have are added to those that are `new`.
pub(super) fn lower_objective(
    shared: &Shared,
    ast: &ast::Objective,
    new: &mut Vec<System>,
    diagnostics: &mut Diagnostics,
) -> Option<Objective> {
    let mode = mode(shared, ast, diagnostics);
    let body = match &ast.body {
        ObjectiveBody::Formula(formula) => {
            Body { formula, bindings: Bindings::default(), consts: shared.consts.clone() }
        }
        ObjectiveBody::Instance { template: name, args } => {
            let Some(template) = shared.templates.get(name.name.as_str()) else {
                let message = format!("no template `{}`", name.name);
                let diagnostic = Diagnostic::error("unknown-template", name.span, message);
                return diagnostics.refuse(suggest(
                    diagnostic,
                    &name.name,
                    shared.template_names.iter().copied(),
                ));
            };
            let (bindings, consts) = bind(template, name, args, shared.consts, diagnostics)?;
            diagnostics.enter_use(name.span, format!("in this instance of `{}`", name.name));
            Body { formula: &template.formula, bindings, consts }
        }
    };
    let objective = lower_body(shared, ast, &body, mode, new, diagnostics);
    if matches!(ast.body, ObjectiveBody::Instance { .. }) {
        diagnostics.leave_use();
    }
    objective
}

/// `within K [semantics S]`; `None` after a message.
fn mode(
    shared: &Shared,
    ast: &ast::Objective,
    diagnostics: &mut Diagnostics,
) -> Option<(Mode, Option<Semantics>)> {
    let semantics = ast.semantics.as_ref().map(|name| {
        let known = name.name.parse().ok();
        if known.is_none() {
            let message = format!("no semantics `{}`", name.name);
            let diagnostic = Diagnostic::error("unknown-name", name.span, message);
            diagnostics.push(suggest(diagnostic, &name.name, Semantics::ALL.map(Semantics::name)));
        }
        known
    });
    let mode = match &ast.within {
        None => Mode::Bounded,
        Some(within) => {
            let steps = shared.consts.evaluate(within, diagnostics)?;
            Mode::Within(number_of_steps(steps, "the length", within.span, diagnostics)?)
        }
    };
    match semantics {
        None => Some((mode, None)),
        Some(known) => Some((mode, Some(known?))),
    }
}

fn lower_body(
    shared: &Shared,
    ast: &ast::Objective,
    body: &Body,
    mode: Option<(Mode, Option<Semantics>)>,
    new: &mut Vec<System>,
    diagnostics: &mut Diagnostics,
) -> Option<Objective> {
    if body.formula.quantifiers.is_empty() {
        let message = "the objective has no path";
        let diagnostic = Diagnostic::error("no-path", ast.name.span, message);
        return diagnostics.refuse(diagnostic.with_help("begin it with `exists p.` or `forall p.`"));
    }
    let defines = visible_defines(shared, &body.formula.defines, diagnostics);
    let (paths, frame) = paths(shared, body, diagnostics);
    let complete = paths.len() == body.formula.quantifiers.len();
    let mut cx = PathContext {
        systems: shared.systems,
        poisoned: shared.poisoned,
        actions: shared.actions,
        globals: shared.consts,
        consts: &body.consts,
        bindings: body.bindings.clone(),
        defines: &defines,
        paths,
        frame,
        expanding: Vec::new(),
        // After a refused length nothing more is to be said about bounds.
        mode: mode.map_or(Mode::Within(0), |m| m.0),
        formula: Formula::default(),
        cost: None,
        diagnostics,
        limits: Limits::default(),
    };
    cx.formula(&body.formula.body)?;
    let (paths, formula, cost) = (cx.paths, cx.formula, cx.cost);
    if !complete {
        return None;
    }
    let (name, span) = (ast.name.name.clone(), ast.name.span);
    let (mode, semantics) = mode?;
    let mut objective = Objective { name, paths, mode, semantics, formula, minimize: Vec::new(), span };
    let wishes = &body.formula.minimize;
    let poisoned = Some(shared.poisoned);
    let minimize = lower_minimize(shared.systems, poisoned, &objective, &body.consts, wishes, diagnostics);
    unused_paths(&objective, diagnostics);
    demand_plain(&objective, cost, diagnostics)?;
    translate(&mut objective, diagnostics)?;
    objective.minimize = minimize?;
    with_sums(shared.systems, &mut objective, new, diagnostics)?;
    Some(objective)
}

/// Gives a formula under other semantics the form that the mode asks for; `None` after a message.
fn translate(objective: &mut Objective, diagnostics: &mut Diagnostics) -> Option<()> {
    let (Mode::Within(steps), Some(semantics)) = (objective.mode, objective.semantics) else {
        return Some(());
    };
    if objective.formula.nodes.len() > semantics::MAX_SOURCE {
        let message = format!(
            "more than {} parts once definitions are expanded, too many for `semantics`",
            semantics::MAX_SOURCE
        );
        return diagnostics.refuse(Diagnostic::error("too-large", objective.span, message));
    }
    objective.formula = semantics::compile(&objective.formula, steps, semantics, objective.paths.keys());
    Some(())
}

/// The definitions in reach: those inside hide those before.
fn visible_defines<'a>(
    shared: &Shared<'a>,
    local: &'a [ast::Define],
    diagnostics: &mut Diagnostics,
) -> Defines<'a> {
    let mut defines = shared.defines.clone();
    let mut inside: FxHashMap<&str, &ast::Define> = FxHashMap::default();
    for define in local {
        if let Some(first) = inside.insert(&define.name.name, define) {
            diagnostics.push(duplicate("definition", &define.name, first.name.span));
        }
        defines.insert(&define.name.name, (define, true));
    }
    defines
}

/// The path variables. One whose system is not known is in the frame only, so that nothing more is said of it.
fn paths<'a>(
    shared: &Shared,
    body: &Body<'a>,
    diagnostics: &mut Diagnostics,
) -> (TiVec<PathId, PathVar>, Frame<'a>) {
    let mut paths: TiVec<PathId, PathVar> = TiVec::new();
    let mut frame = Frame { paths: Vec::new(), parameters: true };
    let quantifiers = &body.formula.quantifiers;
    for (index, quantifier) in quantifiers.iter().enumerate() {
        let path = &quantifier.path;
        if let Some(first) = quantifiers[..index].iter().find(|q| q.path.name == path.name) {
            diagnostics.push(duplicate("path", path, first.path.span));
            continue;
        }
        let id = system_of(shared, body, quantifier, diagnostics).map(|system| {
            let quantifier = if quantifier.forall { Quantifier::Forall } else { Quantifier::Exists };
            paths.push_and_get_key(PathVar { name: path.name.clone(), quantifier, system, span: path.span })
        });
        frame.paths.push((&path.name, id));
    }
    (paths, frame)
}

/// The system of a path: the one it names, or the only one that it can be.
fn system_of(
    shared: &Shared,
    body: &Body,
    quantifier: &ast::Quantifier,
    diagnostics: &mut Diagnostics,
) -> Option<SystemId> {
    let names = || shared.systems.iter().map(|system| system.name.as_str());
    if let Some(name) = &quantifier.system {
        let found = shared.systems.iter_enumerated().find(|(_, system)| system.name == name.name);
        if found.is_none() {
            let diagnostic =
                Diagnostic::error("unknown-system", name.span, format!("no system `{}`", name.name));
            diagnostics.push(suggest(diagnostic, &name.name, names()));
        }
        return found.map(|(id, _)| id);
    }
    let path = &quantifier.path;
    let candidates = candidates(shared, body);
    match candidates.as_slice() {
        [only] => return Some(*only),
        _ if shared.systems.is_empty() => {
            let message = "there is no system whose path this could be";
            let diagnostic = Diagnostic::error("no-system", path.span, message);
            diagnostics.push(diagnostic.with_help("declare one: `system NAME { ... }`"));
        }
        [] => nowhere(shared, body, diagnostics),
        _ => {
            let message = format!("there are several systems; whose path is `{}`?", path.name);
            let diagnostic = Diagnostic::error("which-system", path.span, message);
            let example = names().next().unwrap_or_default();
            diagnostics.push(diagnostic.with_help(format!("say it: `{}: {example}`", path.name)));
        }
    }
    None
}

/// Reports the arguments of a template's instance that are labels of no system, or that no one system has all of them.
fn nowhere(shared: &Shared, body: &Body, diagnostics: &mut Diagnostics) {
    let mut args: Vec<&ast::Expr> = body.bindings.labels.values().copied().collect();
    args.sort_unstable_by_key(|arg| arg.span);
    let mut unknown = false;
    for arg in &args {
        let ExprKind::Name(name) = &arg.kind else { continue };
        if !shared.systems.iter().any(|system| has(system, arg)) {
            unknown = true;
            let message = format!("no label or variable `{name}` in any system");
            let labels = shared.systems.iter().flat_map(|s| s.labels.iter().map(|l| l.name.as_str()));
            diagnostics.push(suggest(Diagnostic::error("unknown-name", arg.span, message), name, labels));
        }
    }
    if let (false, Some(first)) = (unknown, args.first()) {
        let message = "no single system has all the labels that the template is given";
        diagnostics.push(Diagnostic::error("which-system", first.span, message));
    }
}

/// Whether an argument is a label or variable of the system.
fn has(system: &System, arg: &ast::Expr) -> bool {
    match &arg.kind {
        ExprKind::Name(name) => system.label(name).is_some() || system.var(name).is_some(),
        _ => false,
    }
}

/// The systems that a path without `: SYSTEM` may be of: for an instance of a template, those that have all the labels
/// that it is given, so that templates, which name no system, serve files with several.
fn candidates(shared: &Shared, body: &Body) -> Vec<SystemId> {
    let all = shared.systems.iter_enumerated();
    if shared.systems.len() == 1 {
        return all.map(|(id, _)| id).collect();
    }
    let args = &body.bindings.labels;
    all.filter(|(_, system)| args.values().all(|arg| has(system, arg))).map(|(id, _)| id).collect()
}

/// Warns of paths that the formula does not mention.
fn unused_paths(objective: &Objective, diagnostics: &mut Diagnostics) {
    let mut used: TiVec<PathId, bool> = objective.paths.iter().map(|_| false).collect();
    for node in &objective.formula.nodes {
        let Node::Atom(e) = node else { continue };
        e.for_each_leaf(&mut |leaf| {
            for path in leaf.paths().into_iter().flatten() {
                used[path] = true;
            }
        });
    }
    for (path, used) in objective.paths.iter().zip(used) {
        if !used {
            let message = format!("the path `{}` does not matter: nothing is said of it", path.name);
            diagnostics.push(Diagnostic::warning("unused-path", path.span, message));
        }
    }
}
