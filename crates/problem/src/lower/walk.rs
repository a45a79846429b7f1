//! Visiting the parts of a syntax tree, whatever its depth.

use hyperplan_syntax::ast::{Expr, ExprKind, Set};

/// Calls `f` on the expression and all its parts, those in intervals and sets too.
pub(super) fn visit<'a>(e: &'a Expr, f: &mut impl FnMut(&'a Expr)) {
    let mut stack = vec![e];
    while let Some(e) = stack.pop() {
        f(e);
        push_parts(e, &mut stack);
    }
}

/// Calls `f` on all parts of a set.
pub(super) fn visit_set<'a>(set: &'a Set, f: &mut impl FnMut(&'a Expr)) {
    let mut stack = Vec::new();
    push_set(set, &mut stack);
    stack.into_iter().for_each(|e| visit(e, f));
}

fn push_set<'a>(set: &'a Set, stack: &mut Vec<&'a Expr>) {
    let mut sets = vec![set];
    while let Some(set) = sets.pop() {
        match set {
            Set::List(es, _) => stack.extend(es),
            Set::Range(lo, hi) => stack.extend([&**lo, hi]),
            Set::Enabled(..) => {}
            Set::If(branches, last, _) => {
                stack.extend(branches.iter().map(|(condition, _)| condition));
                sets.extend(branches.iter().map(|(_, set)| set).chain([&**last]));
            }
        }
    }
}

fn push_parts<'a>(e: &'a Expr, stack: &mut Vec<&'a Expr>) {
    match &e.kind {
        ExprKind::Bool(_)
        | ExprKind::Number(_)
        | ExprKind::Name(_)
        | ExprKind::Primed(_)
        | ExprKind::Text(_)
        | ExprKind::At(..)
        | ExprKind::Cost(..)
        | ExprKind::Call(..) => {}
        ExprKind::Not(a) | ExprKind::Neg(a) => stack.push(a),
        ExprKind::And(es) | ExprKind::Or(es) | ExprKind::Tuple(es) => stack.extend(es),
        ExprKind::Implies(a, b)
        | ExprKind::Iff(a, b)
        | ExprKind::Compare(_, a, b)
        | ExprKind::Arith(_, a, b) => stack.extend([&**a, b]),
        ExprKind::Sum(terms) => stack.extend(terms.iter().map(|(_, e)| e)),
        ExprKind::In(a, set) => {
            stack.push(a);
            push_set(set, stack);
        }
        ExprKind::If(branches, last) => {
            stack.extend(branches.iter().flat_map(|(c, a)| [c, a]).chain([&**last]));
        }
        ExprKind::Unary(_, interval, a) => {
            stack.push(a);
            stack.extend(interval.iter().flat_map(|i| i.lo.iter().chain([&i.hi]).map(|e| &**e)));
        }
        ExprKind::Binary(_, interval, a, b) => {
            stack.extend([&**a, b]);
            stack.extend(interval.iter().flat_map(|i| i.lo.iter().chain([&i.hi]).map(|e| &**e)));
        }
    }
}
