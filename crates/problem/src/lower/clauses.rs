//! Transition clauses and their updates.

use super::base::Actions;
use super::diagnostics::suggest;
use super::expr::{Context, mismatch, truth, typed};
use super::state::StateContext;
use super::typed::{Typed, braces, known_int};
use crate::expr::{Expr, Leaf, Type};
use crate::ids::{ActionId, VarId};
use crate::system::{Clause, System, Update};
use hyperplan_syntax::ast::{self, Ident, Set, UpdateValue};
use hyperplan_syntax::{Diagnostic, Span};

/// A clause, or `None` after a message.
pub(super) fn lower_clause(
    cx: &mut StateContext,
    clause: &ast::Clause,
    system: &System,
    actions: &Actions,
) -> Option<Clause> {
    let listed = match &clause.actions {
        None => Some(system.actions.clone()),
        Some(names) => clause_actions(cx, names, system, actions),
    };
    let guard = match &clause.guard {
        None => Some(Expr::TRUE),
        Some(guard) => truth(cx, guard),
    };
    let updates: Vec<_> = clause.updates.iter().map(|u| lower_update(cx, u)).collect();
    let updates = updates.into_iter().collect::<Option<Vec<_>>>()?;
    repeated_update(cx, clause)?;
    Some(Clause { actions: listed?, guard: guard?, updates, span: clause.span, generated: false })
}

fn clause_actions(
    cx: &mut StateContext,
    names: &[Ident],
    system: &System,
    actions: &Actions,
) -> Option<Vec<ActionId>> {
    let mut listed = Vec::new();
    let mut complete = true;
    for name in names {
        match actions.get(&name.name).filter(|id| system.actions.contains(id)) {
            Some(id) if !listed.contains(&id) => listed.push(id),
            Some(_) => {}
            None => {
                complete = false;
                let message = format!("no action `{}` in system {}", name.name, system.name);
                let candidates = system.actions.iter().map(|id| actions.names[*id].as_str());
                let diagnostic = Diagnostic::error("unknown-action", name.span, message);
                cx.error(suggest(diagnostic, &name.name, candidates));
            }
        }
    }
    complete.then_some(listed)
}

/// Refuses two updates of one variable.
fn repeated_update(cx: &mut StateContext, clause: &ast::Clause) -> Option<()> {
    for (index, update) in clause.updates.iter().enumerate() {
        if let Some(first) = clause.updates[..index].iter().find(|u| u.var.name == update.var.name) {
            let message = format!("a second update of `{}`", update.var.name);
            let diagnostic = Diagnostic::error("repeated-update", update.var.span, message);
            cx.error(diagnostic.with_related(first.var.span, "the first one"));
            return None;
        }
    }
    Some(())
}

fn lower_update(cx: &mut StateContext, update: &ast::Update) -> Option<(VarId, Update)> {
    let id = match cx.names.get(&update.var.name) {
        Some((Leaf::Var(id), _)) => id,
        Some((Leaf::Label(_), declared)) => {
            let message = format!("`{}` is a label; only variables can be updated", update.var.name);
            let diagnostic = Diagnostic::error("not-a-variable", update.var.span, message);
            cx.error(diagnostic.with_related(declared, "declared here"));
            return None;
        }
        None => {
            if !cx.poisoned {
                let message = format!("no variable `{}` in system {}", update.var.name, cx.system);
                let diagnostic = Diagnostic::error("unknown-name", update.var.span, message);
                let diagnostic =
                    suggest(diagnostic, &update.var.name, cx.vars.iter().map(|v| v.name.as_str()));
                cx.error(diagnostic);
            }
            return None;
        }
    };
    let ty = cx.vars[id].ty.clone();
    let value = match &update.value {
        UpdateValue::Assign(e) => Update::Assign(of_type(cx, e, &ty)?),
        UpdateValue::Choose(Set::List(members, span)) if members.is_empty() => {
            cx.error(Diagnostic::error("empty-set", *span, "the set is empty"));
            return None;
        }
        UpdateValue::Choose(Set::List(members, _)) => {
            let values: Vec<_> = members.iter().map(|m| of_type(cx, m, &ty)).collect();
            Update::OneOf(values.into_iter().collect::<Option<Vec<_>>>()?)
        }
        UpdateValue::Choose(Set::Range(lo, hi)) => within(cx, lo, hi, &ty)?,
        UpdateValue::Choose(Set::Enabled(_, span)) => {
            let message = "`enabled[...]` is a set of actions, not of values";
            cx.error(Diagnostic::error("misplaced-path", *span, message));
            return None;
        }
    };
    Some((id, value))
}

/// An expression of the variable's type.
fn of_type(cx: &mut StateContext, e: &ast::Expr, ty: &Type) -> Option<Expr<Leaf>> {
    let hint = match ty {
        Type::Enum(values) => Some(values),
        Type::Bool | Type::Range { .. } => None,
    };
    match (typed(cx, e, hint), ty) {
        (Typed::Bool(e), Type::Bool) | (Typed::Int(e, _), Type::Range { .. }) => Some(e),
        (Typed::Enum(e, values), Type::Enum(expected)) if values == *expected => Some(e),
        (found, _) => {
            mismatch(cx, &found, &expected(ty), e.span);
            None
        }
    }
}

fn expected(ty: &Type) -> String {
    match ty {
        Type::Bool => "a truth value".into(),
        Type::Range { .. } => "an integer".into(),
        Type::Enum(values) => format!("one of {}", braces(values)),
    }
}

/// `v' in LO..HI`
fn within(cx: &mut StateContext, lo: &ast::Expr, hi: &ast::Expr, ty: &Type) -> Option<Update> {
    let span = lo.span.to(hi.span);
    if !matches!(ty, Type::Range { .. }) {
        let message = format!("expected {}, found integers", expected(ty));
        cx.error(Diagnostic::error("type-mismatch", span, message));
        return None;
    }
    let (lo, hi) = (constant_end(cx, lo), constant_end(cx, hi));
    let (lo, hi) = (lo?, hi?);
    if lo > hi {
        cx.error(Diagnostic::error("empty-range", span, format!("the range {lo}..{hi} is empty")));
        return None;
    }
    Some(Update::Within(lo, hi))
}

fn constant_end(cx: &mut StateContext, e: &ast::Expr) -> Option<i64> {
    let span: Span = e.span;
    match typed(cx, e, None) {
        Typed::Int(e, _) => {
            let value = known_int(&e);
            if value.is_none() {
                let message = "a range of which an end varies is not supported yet";
                let help = "list the values: `v' in {E, ...}`";
                cx.error(Diagnostic::error("not-supported", span, message).with_help(help));
            }
            value
        }
        other => {
            mismatch(cx, &other, "an integer", span);
            None
        }
    }
}
