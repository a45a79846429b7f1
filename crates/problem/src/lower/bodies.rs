//! Definitions and templates that no objective uses, or not all of: their names are checked as far as that goes without
//! arguments. What an objective's use of them has shown already is not said again.

use super::diagnostics::{Diagnostics, suggest};
use super::objective::Shared;
use super::template::unquantified;
use super::walk::visit;
use crate::expr::Type;
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::{Define, Expr, ExprKind, File, Ident, Item};

/// Names that can be read of any path.
const SPECIAL: [&str; 4] = ["action", "state", "obs", "enabled"];

/// What is in reach of a body besides the names of the file.
#[derive(Clone, Copy)]
struct Scope<'a> {
    /// Of the template around.
    params: &'a [Ident],
    /// Of the template around.
    defines: &'a [Define],
}

pub(super) fn check(file: &File, shared: &Shared, diagnostics: &mut Diagnostics) {
    for item in &file.items {
        match item {
            Item::Define(define) => {
                check_define(define, Scope { params: &[], defines: &[] }, shared, diagnostics);
            }
            Item::Template(template) => {
                let scope = Scope { params: &template.params, defines: &template.formula.defines };
                for define in scope.defines {
                    check_define(define, scope, shared, diagnostics);
                }
                names(&template.formula.body, scope, shared, diagnostics);
                let bodies: Vec<&Expr> =
                    scope.defines.iter().map(|define| &define.body).chain([&template.formula.body]).collect();
                for param in &template.params {
                    if !bodies.iter().any(|body| mentions(body, &param.name)) {
                        diagnostics.push_where_none(unused(param));
                    }
                }
            }
            Item::Const(_) | Item::System(_) | Item::Objective(_) => {}
        }
    }
}

fn check_define(define: &Define, scope: Scope<'_>, shared: &Shared, diagnostics: &mut Diagnostics) {
    let paths: Vec<&str> = define.params.iter().map(|param| param.name.as_str()).collect();
    unquantified(&define.body, &paths, diagnostics);
    for param in &define.params {
        if !mentions(&define.body, &param.name) {
            diagnostics.push_where_none(unused(param));
        }
    }
    names(&define.body, scope, shared, diagnostics);
}

fn unused(param: &Ident) -> Diagnostic {
    let message = format!("the parameter `{}` is not used", param.name);
    Diagnostic::warning("unused-parameter", param.span, message)
}

/// Whether the name stands in the expression, for whatever it may.
fn mentions(body: &Expr, name: &str) -> bool {
    let mut found = false;
    visit(body, &mut |e| {
        found |= match &e.kind {
            ExprKind::Name(other) => other == name,
            ExprKind::At(read, paths) => read.name == name || paths.iter().any(|path| path.name == name),
            ExprKind::Cost(_, args) | ExprKind::Call(_, args) => args.iter().any(|arg| arg.name == name),
            ExprKind::In(_, hyperplan_syntax::ast::Set::Enabled(path, _)) => path.name == name,
            _ => false,
        };
    });
    found
}

/// Reports names that stand for nothing in any system.
fn names(body: &Expr, scope: Scope<'_>, shared: &Shared, diagnostics: &mut Diagnostics) {
    visit(body, &mut |e| match &e.kind {
        ExprKind::At(name, _) => diagnostics_of_label(name, scope, shared, diagnostics),
        ExprKind::Call(name, args) => {
            let inside = scope.defines.iter().find(|define| define.name.name == name.name);
            match inside.or_else(|| shared.defines.get(name.name.as_str()).map(|(define, _)| *define)) {
                Some(define) if define.params.len() != args.len() => {
                    let (takes, given) = (define.params.len(), args.len());
                    let message = format!("`{}` takes {takes} paths, not {given}", name.name);
                    let error = Diagnostic::error("argument-count", e.span, message);
                    diagnostics.push_where_none(error.with_related(define.name.span, "defined here"));
                }
                Some(_) => {}
                None => {
                    let message = format!("no definition `{}`", name.name);
                    let mut known: Vec<&str> = shared.defines.keys().copied().collect();
                    known.extend(scope.defines.iter().map(|define| define.name.name.as_str()));
                    known.sort_unstable();
                    let error = Diagnostic::error("unknown-name", name.span, message);
                    diagnostics.push_where_none(suggest(error, &name.name, known));
                }
            }
        }
        ExprKind::Name(name) if !is_value(name, scope, shared) => {
            let message = format!("`{name}` is no constant, action or value of an enumeration");
            let error = Diagnostic::error("unknown-name", e.span, message);
            let known = scope.params.iter().map(|param| param.name.as_str());
            let known = known.chain(shared.consts.names());
            diagnostics.push_where_none(suggest(error, name, known));
        }
        _ => {}
    });
}

/// Whether names of systems may be missing, so that none can be called unknown.
fn incomplete(shared: &Shared) -> bool {
    shared.systems.is_empty() || shared.poisoned.iter().any(|poisoned| *poisoned)
}

fn diagnostics_of_label(name: &Ident, scope: Scope<'_>, shared: &Shared, diagnostics: &mut Diagnostics) {
    let word = name.name.as_str();
    let parameter = scope.params.iter().any(|param| param.name == word);
    let known = shared.systems.iter().any(|s| s.label(word).is_some() || s.var(word).is_some());
    if parameter || known || SPECIAL.contains(&word) || incomplete(shared) {
        return;
    }
    let message = format!("no label or variable `{word}` in any system");
    let labels = shared.systems.iter().flat_map(|system| {
        let labels = system.labels.iter().map(|label| label.name.as_str());
        labels.chain(system.vars.iter().map(|var| var.name.as_str()))
    });
    let candidates = scope.params.iter().map(|param| param.name.as_str()).chain(labels);
    let error = Diagnostic::error("unknown-name", name.span, message);
    diagnostics.push_where_none(suggest(error, word, candidates));
}

fn is_value(name: &str, scope: Scope<'_>, shared: &Shared) -> bool {
    let of_enumeration =
        |ty: &Type| matches!(ty, Type::Enum(values) if values.iter().any(|value| value == name));
    name == "none"
        || scope.params.iter().any(|param| param.name == name)
        || shared.consts.get(name).is_some()
        || shared.actions.get(name).is_some()
        || shared.systems.iter().any(|system| system.vars.iter().any(|var| of_enumeration(&var.ty)))
        || incomplete(shared)
}
