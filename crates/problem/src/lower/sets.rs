//! `E in SET`.

use super::expr::{Context, compare_typed, integer, mismatch, numeric, typed};
use super::limits::MAX_COPIES;
use super::typed::{self as make, EnumType, Typed, known_int};
use crate::expr::{Expr, Rational, TupleSet, Value};
use hyperplan_syntax::ast::{self, CompareOp, ExprKind, Set};
use hyperplan_syntax::{Diagnostic, Span};
use std::sync::Arc;

/// Lists of constants up to this length become comparisons; longer ones a [`TupleSet`].
const FEW: usize = 8;

/// `element in set`
pub(crate) fn membership<C: Context>(
    cx: &mut C,
    element: &ast::Expr,
    set: &Set,
    span: Span,
) -> Typed<C::Leaf> {
    if let Some(special) = cx.member_special(element, set, span) {
        return special;
    }
    match set {
        Set::Enabled(_, place) => {
            let message = "`enabled[...]` is a set of actions";
            let help = "write `ACTION in enabled[PATH]`, in an objective";
            cx.error(Diagnostic::error("misplaced-path", *place, message).with_help(help))
        }
        Set::Range(lo, hi) => in_range(cx, element, lo, hi, span),
        Set::List(members, place) if members.is_empty() => {
            cx.error(Diagnostic::error("empty-set", *place, "the set is empty"))
        }
        Set::List(members, _) => match &element.kind {
            ExprKind::Tuple(parts) => in_tuples(cx, parts, members),
            _ => in_list(cx, element, members, span),
        },
    }
}

fn in_range<C: Context>(
    cx: &mut C,
    element: &ast::Expr,
    lo: &ast::Expr,
    hi: &ast::Expr,
    span: Span,
) -> Typed<C::Leaf> {
    let (e, lo_typed, hi_typed) = (numeric(cx, element), numeric(cx, lo), numeric(cx, hi));
    let Some((e, (lo_typed, hi_typed))) = e.zip(lo_typed.zip(hi_typed)) else { return Typed::Poison };
    let (e, lo_typed, hi_typed) = (e.typed(), lo_typed.typed(), hi_typed.typed());
    if let Some(empty) = empty_range(&lo_typed, &hi_typed) {
        return cx.error(Diagnostic::error("empty-range", lo.span.to(hi.span), empty));
    }
    let (Typed::Int(inner, _) | Typed::Real(inner)) = &e else { return Typed::Poison };
    if !may_copy(cx, inner, 2, span) {
        return Typed::Poison;
    }
    let above = compare_typed(cx, CompareOp::Le, lo_typed, e.clone(), span);
    let below = compare_typed(cx, CompareOp::Le, e, hi_typed, span);
    match (above, below) {
        (Typed::Bool(above), Typed::Bool(below)) => Typed::Bool(make::and([above, below])),
        _ => Typed::Poison,
    }
}

/// What is wrong with a range of constants in the wrong order.
pub(super) fn empty_range<L>(lo: &Typed<L>, hi: &Typed<L>) -> Option<String> {
    let value = |end: &Typed<L>| match end {
        Typed::Int(Expr::Const(Value::Int(n)), _) => Some(Rational::from(*n)),
        Typed::Real(Expr::Const(Value::Real(r))) => Some(*r),
        _ => None,
    };
    let (lo, hi) = (value(lo)?, value(hi)?);
    (lo > hi).then(|| format!("the range {lo}..{hi} is empty"))
}

/// Whether an expression may be written so many times: nested sets would double it at every level.
fn may_copy<C: Context>(cx: &mut C, e: &Expr<C::Leaf>, copies: usize, span: Span) -> bool {
    let limit = MAX_COPIES / copies.max(1);
    let fits = make::size(e, limit + 1) <= limit;
    if !fits {
        let message = "the expression to the left of `in` is too large for this set";
        cx.error(Diagnostic::error("too-large", span, message));
    }
    fits
}

fn in_tuples<C: Context>(cx: &mut C, parts: &[ast::Expr], members: &[ast::Expr]) -> Typed<C::Leaf> {
    let parts: Vec<_> = parts.iter().map(|p| integer(cx, p).map(|(e, _)| e)).collect();
    let width = parts.len();
    let tuples: Vec<_> = members.iter().map(|m| constant_tuple(cx, m, width)).collect();
    let parts = parts.into_iter().collect::<Option<Vec<_>>>();
    let tuples = tuples.into_iter().collect::<Option<Vec<_>>>();
    let Some((parts, tuples)) = parts.zip(tuples) else { return Typed::Poison };
    Typed::Bool(member(parts, TupleSet::new(tuples)))
}

/// Membership, folded where the tuple is constant.
fn member<L>(parts: Vec<Expr<L>>, set: TupleSet) -> Expr<L> {
    let constant: Option<Vec<i64>> = parts.iter().map(known_int).collect();
    match constant {
        Some(tuple) => Expr::Const(Value::Bool(set.contains(&tuple))),
        None => Expr::Member(parts, Arc::new(set)),
    }
}

fn constant_tuple<C: Context>(cx: &mut C, e: &ast::Expr, width: usize) -> Option<Box<[i64]>> {
    let ExprKind::Tuple(parts) = &e.kind else {
        let message = format!("expected a tuple of {width} integers");
        cx.error(Diagnostic::error("type-mismatch", e.span, message));
        return None;
    };
    if parts.len() != width {
        let message = format!("expected a tuple of {width} integers, found one of {}", parts.len());
        cx.error(Diagnostic::error("type-mismatch", e.span, message));
        return None;
    }
    let values: Vec<_> = parts.iter().map(|p| constant_integer(cx, p)).collect();
    values.into_iter().collect()
}

fn constant_integer<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<i64> {
    let (expr, _) = integer(cx, e)?;
    let value = known_int(&expr);
    if value.is_none() {
        let message = "the members of a set of tuples must be constants";
        cx.error(Diagnostic::error("not-constant", e.span, message));
    }
    value
}

fn in_list<C: Context>(cx: &mut C, element: &ast::Expr, members: &[ast::Expr], span: Span) -> Typed<C::Leaf> {
    let e = typed(cx, element, None);
    if matches!(e, Typed::Poison) {
        return Typed::Poison;
    }
    let hint: Option<EnumType> = e.enumeration().cloned();
    let values: Vec<_> = members.iter().map(|m| (typed(cx, m, hint.as_ref()), m.span)).collect();
    let mut known = Vec::new();
    let mut poisoned = false;
    for (value, place) in &values {
        match (&e, value) {
            (_, Typed::Poison) => poisoned = true,
            (Typed::Int(..), Typed::Int(v, _)) => known.extend(known_int(v)),
            (Typed::Int(..) | Typed::Real(_), Typed::Int(..) | Typed::Real(_)) => {}
            (Typed::Bool(_), Typed::Bool(_)) => {}
            (Typed::Enum(_, t), Typed::Enum(v, u)) if t == u => known.extend(known_position(v)),
            (e, other) => {
                poisoned = true;
                mismatch(cx, other, &e.describe(), *place);
            }
        }
    }
    if poisoned {
        return Typed::Poison;
    }
    let compound = |e: &Expr<C::Leaf>| !matches!(e, Expr::Leaf(_) | Expr::Const(_));
    match e {
        Typed::Int(e, _) if known.len() == values.len() && (known.len() > FEW || compound(&e)) => {
            let tuples = known.into_iter().map(|v| Box::from([v])).collect();
            Typed::Bool(member(vec![e], TupleSet::new(tuples)))
        }
        Typed::Enum(e, _) if known.len() == values.len() && known.len() > FEW => {
            let tuples = known.into_iter().map(|v| Box::from([v])).collect();
            Typed::Bool(Expr::Member(vec![e], Arc::new(TupleSet::new(tuples))))
        }
        e => one_of(cx, &e, values, span),
    }
}

/// The position of a constant enumeration value.
fn known_position<L>(e: &Expr<L>) -> Option<i64> {
    match e {
        Expr::Const(Value::Enum(position)) => Some(i64::from(*position)),
        _ => None,
    }
}

/// The disjunction of equalities.
fn one_of<C: Context>(
    cx: &mut C,
    e: &Typed<C::Leaf>,
    values: Vec<(Typed<C::Leaf>, Span)>,
    span: Span,
) -> Typed<C::Leaf> {
    let (Typed::Bool(inner) | Typed::Int(inner, _) | Typed::Real(inner) | Typed::Enum(inner, _)) = e else {
        return Typed::Poison;
    };
    if !may_copy(cx, inner, values.len(), span) {
        return Typed::Poison;
    }
    let mut cases = Vec::with_capacity(values.len());
    for (value, place) in values {
        match compare_typed(cx, CompareOp::Eq, e.clone(), value, place) {
            Typed::Bool(case) => cases.push(case),
            _ => return Typed::Poison,
        }
    }
    Typed::Bool(make::or(cases))
}
