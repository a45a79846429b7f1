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

fn push_parts<'a>(e: &'a Expr, stack: &mut Vec<&'a Expr>) {
    match &e.kind {
        ExprKind::Bool(_)
        | ExprKind::Number(_)
        | ExprKind::Name(_)
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
            match set {
                Set::List(es, _) => stack.extend(es),
                Set::Range(lo, hi) => stack.extend([&**lo, hi]),
                Set::Enabled(..) => {}
            }
        }
        ExprKind::If(a, b, c) => stack.extend([&**a, b, c]),
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
