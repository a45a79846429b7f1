//! Transition clauses and their updates.

use super::base::Actions;
use super::diagnostics::suggest;
use super::expr::{Context, integer, mismatch, real, truth, typed};
use super::sets::empty_range;
use super::state::StateContext;
use super::typed::{Typed, braces};
use crate::expr::{Expr, Leaf, Type};
use crate::ids::{ActionId, VarId};
use crate::system::{Clause, System, Update};
use hyperplan_syntax::ast::{self, Ident, Set, UpdateValue};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;

/// A clause, or `None` after a message.
pub(super) fn lower_clause(
    cx: &mut StateContext,
    clause: &ast::Clause,
    system: &System,
    actions: &Actions,
) -> Option<Clause> {
    let (listed, guard) = head(cx, clause, system, actions);
    let updates: Vec<_> = clause.updates.iter().map(|u| lower_update(cx, u)).collect();
    let updates = updates.into_iter().collect::<Option<Vec<_>>>()?;
    repeated_update(cx, clause)?;
    Some(Clause { actions: listed?, guard: guard?, updates, span: clause.span, generated: false })
}

/// The actions and the guard; `None` after a message.
pub(super) fn head(
    cx: &mut StateContext,
    clause: &ast::Clause,
    system: &System,
    actions: &Actions,
) -> (Option<Vec<ActionId>>, Option<Expr<Leaf>>) {
    let listed = match &clause.actions {
        None => Some(system.actions.clone()),
        Some(names) => clause_actions(cx, names, system, actions),
    };
    let guard = match &clause.guard {
        None => Some(Expr::TRUE),
        Some(guard) => truth(cx, guard),
    };
    (listed, guard)
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
        match known_action(cx, &name.name, name.span, system, actions) {
            Some(id) if !listed.contains(&id) => listed.push(id),
            Some(_) => {}
            None => complete = false,
        }
    }
    complete.then_some(listed)
}

/// An action of the system, or `None` after a message.
pub(super) fn known_action(
    cx: &mut StateContext,
    name: &str,
    span: Span,
    system: &System,
    actions: &Actions,
) -> Option<ActionId> {
    let known = actions.get(name).filter(|id| system.actions.contains(id));
    if known.is_none() {
        let message = format!("no action `{name}` in system {}", system.name);
        let candidates = system.actions.iter().map(|id| actions.names[*id].as_str());
        cx.diagnostics.push(suggest(Diagnostic::error("unknown-action", span, message), name, candidates));
    }
    known
}

/// Refuses two updates of one variable.
pub(super) fn repeated_update(cx: &mut StateContext, clause: &ast::Clause) -> Option<()> {
    let mut seen = FxHashMap::default();
    for update in &clause.updates {
        if let Some(first) = seen.insert(update.var.name.as_str(), update.var.span) {
            let message = format!("a second update of `{}`", update.var.name);
            let diagnostic = Diagnostic::error("repeated-update", update.var.span, message);
            return cx.error(diagnostic.with_related(first, "the first one"));
        }
    }
    Some(())
}

fn lower_update(cx: &mut StateContext, update: &ast::Update) -> Option<(VarId, Update)> {
    let id = updated(cx, update)?;
    let ty = cx.vars[id].ty.clone();
    Some((id, new_value(cx, &update.value, &ty)?))
}

/// The variable that an update is of.
pub(super) fn updated(cx: &mut StateContext, update: &ast::Update) -> Option<VarId> {
    match cx.names.get(&update.var.name).copied() {
        Some((Leaf::Var(id), _)) => Some(id),
        Some((Leaf::Label(_), declared)) => {
            let message = format!("`{}` is a label; only variables can be updated", update.var.name);
            let diagnostic = Diagnostic::error("not-a-variable", update.var.span, message);
            cx.error(diagnostic.with_related(declared, "declared here"))
        }
        None => {
            if !cx.poisoned {
                let message = format!("no variable `{}` in system {}", update.var.name, cx.system);
                let diagnostic = Diagnostic::error("unknown-name", update.var.span, message);
                let diagnostic =
                    suggest(diagnostic, &update.var.name, cx.vars.iter().map(|v| v.name.as_str()));
                cx.diagnostics.push(diagnostic);
            }
            None
        }
    }
}

/// What becomes of a variable of that type.
pub(super) fn new_value<C: Context>(cx: &mut C, value: &UpdateValue, ty: &Type) -> Option<Update<C::Leaf>> {
    match value {
        UpdateValue::Assign(e) => Some(Update::Assign(of_type(cx, e, ty)?)),
        UpdateValue::Choose(set) => chosen(cx, set, ty),
    }
}

/// What an update chooses from. Recursion is bounded by the nesting of the set, which the parser bounds.
fn chosen<C: Context>(cx: &mut C, set: &Set, ty: &Type) -> Option<Update<C::Leaf>> {
    match set {
        Set::List(members, span) if members.is_empty() => {
            cx.error(Diagnostic::error("empty-set", *span, "the set is empty"))
        }
        Set::List(members, _) => {
            let values: Vec<_> = members.iter().map(|m| of_type(cx, m, ty)).collect();
            Some(Update::OneOf(values.into_iter().collect::<Option<Vec<_>>>()?))
        }
        Set::Range(lo, hi) => within(cx, lo, hi, ty),
        Set::Enabled(_, span) => {
            let message = "`enabled[...]` is a set of actions, not of values";
            cx.error(Diagnostic::error("misplaced-path", *span, message))
        }
        Set::If(branches, last, _) => {
            let lowered: Vec<_> =
                branches.iter().map(|(c, set)| (truth(cx, c), chosen(cx, set, ty))).collect();
            let last = chosen(cx, last, ty);
            let lowered = lowered.into_iter().map(|(c, set)| c.zip(set)).collect::<Option<Vec<_>>>()?;
            Some(conditional(lowered, last?))
        }
    }
}

/// Without the branches that constants rule out.
fn conditional<L>(branches: Vec<(Expr<L>, Update<L>)>, last: Update<L>) -> Update<L> {
    let mut kept = Vec::with_capacity(branches.len());
    let mut last = last;
    for (condition, update) in branches {
        if condition.is_true() {
            last = update;
            break;
        }
        if !condition.is_false() {
            kept.push((condition, update));
        }
    }
    if kept.is_empty() { last } else { Update::If(kept, Box::new(last)) }
}

/// An expression of the variable's type.
fn of_type<C: Context>(cx: &mut C, e: &ast::Expr, ty: &Type) -> Option<Expr<C::Leaf>> {
    let hint = match ty {
        Type::Enum(values) => Some(values),
        Type::Bool | Type::Range { .. } | Type::Int => None,
        Type::Real => return real(cx, e),
    };
    match (typed(cx, e, hint)?, ty) {
        (Typed::Bool(e), Type::Bool) | (Typed::Int(e, _), Type::Range { .. } | Type::Int) => Some(e),
        (Typed::Enum(e, values), Type::Enum(expected)) if values == *expected => Some(e),
        (found, _) => mismatch(cx, &found, &expected(ty), e.span),
    }
}

fn expected(ty: &Type) -> String {
    match ty {
        Type::Bool => "a truth value".into(),
        Type::Range { .. } | Type::Int => "an integer".into(),
        Type::Real => "a number".into(),
        Type::Enum(values) => format!("one of {}", braces(values)),
    }
}

/// `v' in LO..HI`
fn within<C: Context>(cx: &mut C, lo: &ast::Expr, hi: &ast::Expr, ty: &Type) -> Option<Update<C::Leaf>> {
    let span: Span = lo.span.to(hi.span);
    let (from, to) = match ty {
        Type::Range { .. } | Type::Int => {
            let (from, to) = (integer(cx, lo), integer(cx, hi));
            let (from, to) = (from?, to?);
            (Typed::Int(from.0, from.1), Typed::Int(to.0, to.1))
        }
        Type::Real => {
            let (from, to) = (real(cx, lo), real(cx, hi));
            (Typed::Real(from?), Typed::Real(to?))
        }
        Type::Bool | Type::Enum(_) => {
            let message = format!("expected {}, found a range of numbers", expected(ty));
            return cx.error(Diagnostic::error("type-mismatch", span, message));
        }
    };
    if let Some(empty) = empty_range(&from, &to) {
        return cx.error(Diagnostic::error("empty-range", span, empty));
    }
    match (from, to) {
        (Typed::Int(from, _) | Typed::Real(from), Typed::Int(to, _) | Typed::Real(to)) => {
            Some(Update::Within(from, to))
        }
        _ => None,
    }
}
