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
#[inline(never)]
pub(crate) fn membership<C: Context>(
    cx: &mut C,
    element: &ast::Expr,
    set: &Set,
    span: Span,
) -> Option<Typed<C::Leaf>> {
    if let Some(special) = cx.member_special(element, set, span) {
        return special;
    }
    match set {
        Set::Enabled(_, place) => {
            let message = "`enabled[...]` is a set of actions";
            let help = "write `ACTION in enabled[PATH]`, in an objective";
            cx.error(Diagnostic::error("misplaced-path", *place, message).with_help(help))
        }
        Set::If(_, _, place) => {
            let message = "a set with conditions is what an update chooses from";
            let help = "write `if C then x in {1, 2} else x == 0`";
            cx.error(Diagnostic::error("misplaced-set", *place, message).with_help(help))
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
) -> Option<Typed<C::Leaf>> {
    let (e, lo_typed, hi_typed) = (numeric(cx, element), numeric(cx, lo), numeric(cx, hi));
    let (e, (lo_typed, hi_typed)) = e.zip(lo_typed.zip(hi_typed))?;
    let (e, lo_typed, hi_typed) = (e.typed(), lo_typed.typed(), hi_typed.typed());
    if let Some(empty) = empty_range(&lo_typed, &hi_typed) {
        return cx.error(Diagnostic::error("empty-range", lo.span.to(hi.span), empty));
    }
    let (Typed::Int(inner, _) | Typed::Real(inner)) = &e else { return None };
    may_copy(cx, inner, 2, span)?;
    let above = compare_typed(cx, CompareOp::Le, lo_typed, e.clone(), span);
    let below = compare_typed(cx, CompareOp::Le, e, hi_typed, span);
    let (above, below) = above.zip(below)?;
    Some(Typed::Bool(make::and([above, below])))
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

/// An expression may be written so many times, or there is a message: nested sets would double it at every level.
fn may_copy<C: Context>(cx: &mut C, e: &Expr<C::Leaf>, copies: usize, span: Span) -> Option<()> {
    let limit = MAX_COPIES / copies.max(1);
    if make::size(e, limit + 1) <= limit {
        return Some(());
    }
    let message = "the expression to the left of `in` is too large for this set";
    cx.error(Diagnostic::error("too-large", span, message))
}

fn in_tuples<C: Context>(cx: &mut C, parts: &[ast::Expr], members: &[ast::Expr]) -> Option<Typed<C::Leaf>> {
    let parts: Vec<_> = parts.iter().map(|p| integer(cx, p).map(|(e, _)| e)).collect();
    let width = parts.len();
    let tuples: Vec<_> = members.iter().map(|m| constant_tuple(cx, m, width)).collect();
    let parts = parts.into_iter().collect::<Option<Vec<_>>>()?;
    let tuples = tuples.into_iter().collect::<Option<Vec<_>>>()?;
    Some(Typed::Bool(member(parts, TupleSet::new(tuples))))
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
        return cx.error(Diagnostic::error("type-mismatch", e.span, message));
    };
    if parts.len() != width {
        let message = format!("expected a tuple of {width} integers, found one of {}", parts.len());
        return cx.error(Diagnostic::error("type-mismatch", e.span, message));
    }
    let values: Vec<_> = parts.iter().map(|p| constant_integer(cx, p)).collect();
    values.into_iter().collect()
}

fn constant_integer<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<i64> {
    let (expr, _) = integer(cx, e)?;
    known_int(&expr).or_else(|| {
        let message = "the members of a set of tuples must be constants";
        cx.error(Diagnostic::error("not-constant", e.span, message))
    })
}

fn in_list<C: Context>(
    cx: &mut C,
    element: &ast::Expr,
    members: &[ast::Expr],
    span: Span,
) -> Option<Typed<C::Leaf>> {
    let e = typed(cx, element, None)?;
    let hint: Option<EnumType> = e.enumeration().cloned();
    let typed: Vec<_> = members.iter().map(|m| typed(cx, m, hint.as_ref())).collect();
    let mut known = Vec::new();
    let mut values = Vec::with_capacity(members.len());
    for (value, member) in typed.into_iter().zip(members) {
        let Some(value) = value else { continue };
        match (&e, &value) {
            (Typed::Int(..), Typed::Int(v, _)) => known.extend(known_int(v)),
            (Typed::Int(..) | Typed::Real(_), Typed::Int(..) | Typed::Real(_)) => {}
            (Typed::Bool(_), Typed::Bool(_)) => {}
            (Typed::Enum(_, t), Typed::Enum(v, u)) if t == u => known.extend(known_position(v)),
            (e, other) => {
                let _: Option<()> = mismatch(cx, other, &e.describe(), member.span);
                continue;
            }
        }
        values.push((value, member.span));
    }
    if values.len() < members.len() {
        return None;
    }
    let compound = |e: &Expr<C::Leaf>| !matches!(e, Expr::Leaf(_) | Expr::Const(_));
    match e {
        Typed::Int(e, _) if known.len() == values.len() && (known.len() > FEW || compound(&e)) => {
            let tuples = known.into_iter().map(|v| Box::from([v])).collect();
            Some(Typed::Bool(member(vec![e], TupleSet::new(tuples))))
        }
        Typed::Enum(e, _) if known.len() == values.len() && known.len() > FEW => {
            let tuples = known.into_iter().map(|v| Box::from([v])).collect();
            Some(Typed::Bool(Expr::Member(vec![e], Arc::new(TupleSet::new(tuples)))))
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
) -> Option<Typed<C::Leaf>> {
    let (Typed::Bool(inner) | Typed::Int(inner, _) | Typed::Real(inner) | Typed::Enum(inner, _)) = e;
    may_copy(cx, inner, values.len(), span)?;
    let cases =
        values.into_iter().map(|(value, place)| compare_typed(cx, CompareOp::Eq, e.clone(), value, place));
    Some(Typed::Bool(make::or(cases.collect::<Option<Vec<_>>>()?)))
}
