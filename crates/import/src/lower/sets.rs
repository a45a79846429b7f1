//! Sets: what a variable may become, and what `in` asks.

use super::symbols::negation;
use super::{Lower, Place, Val, choice, e, wrong};
use crate::parser::Parse;
use crate::smv::model::Symbol;
use crate::smv::resolve::Meaning;
use crate::tree::{Expr, Kind};
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{self, ExprKind, Set};

/// Values of a range that are listed, where it is joined with other sets.
const MAX_LISTED: i128 = 10_000;

/// A set of values.
#[derive(Clone, Debug)]
pub(crate) enum Choice {
    /// These.
    Values(Vec<Val>),
    /// The integers between two, with the bounds of each.
    Range(Box<[(ast::Expr, i128, i128); 2]>),
    /// As the first condition that holds says, or the last.
    If(Vec<(ast::Expr, Choice)>, Box<Choice>),
}

impl Choice {
    /// The only value, if there is no choice whatever the state.
    pub(crate) fn is_single(&self) -> bool {
        match self {
            Choice::Values(values) => values.len() == 1,
            Choice::Range(..) => false,
            Choice::If(branches, last) => branches.iter().all(|(_, c)| c.is_single()) && last.is_single(),
        }
    }
}

impl<'t> Lower<'t> {
    /// What an expression stands for where sets may stand; a value is the set of itself.
    pub(crate) fn choice(&mut self, place: Place<'_>, expr: &Expr) -> Parse<Choice> {
        self.count(1, expr.span)?;
        match &expr.kind {
            Kind::Set(members) | Kind::Union(members) => {
                let mut all = Choice::Values(Vec::new());
                for member in members {
                    let more = self.choice(place, member)?;
                    all = self.union(all, more, expr.span)?;
                }
                Ok(all)
            }
            Kind::Range(lo, hi) => {
                let (lo, hi) = (self.integer(place, lo)?, self.integer(place, hi)?);
                if lo.1 > hi.2 {
                    let message = format!("the range {}..{} is empty", lo.1, hi.2);
                    return wrong("empty-range", expr.span, message);
                }
                Ok(Choice::Range(Box::new([lo, hi])))
            }
            Kind::Case(branches, last) if self.is_set(place, expr, 0) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, value) in branches {
                    kept.push((self.truth(place, condition)?, self.choice(place, value)?));
                }
                let last = last.as_ref().map(|last| self.choice(place, last)).transpose()?;
                let Some(mut last) = last.or_else(|| kept.pop().map(|(_, value)| value)) else {
                    return wrong("misplaced-set", expr.span, "a `case` without cases".to_owned());
                };
                if let Choice::If(more, end) = last {
                    kept.extend(more);
                    last = *end;
                }
                Ok(if kept.is_empty() { last } else { Choice::If(kept, Box::new(last)) })
            }
            Kind::Name(name) => match self.models[place.model].model.meaning(place.scope, name) {
                Some(Meaning::Argument(scope, argument)) => self.choice(Place { scope, ..place }, argument),
                Some(Meaning::Symbol(full, &Symbol::Define(scope, body, _)))
                    if !self.models[place.model].is_label(full) && self.depth < 100 =>
                {
                    self.depth += 1;
                    let found = self.choice(Place { scope, ..place }, body);
                    self.depth -= 1;
                    found
                }
                _ => Ok(Choice::Values(vec![self.value(place, expr)?])),
            },
            Kind::Next(inside) if !place.next && place.path.is_none() => {
                self.choice(Place { next: true, ..place }, inside)
            }
            _ => Ok(Choice::Values(vec![self.value(place, expr)?])),
        }
    }

    /// Whether an expression is a set of several values, or one of several by condition.
    pub(crate) fn is_set(&self, place: Place<'_>, expr: &Expr, depth: u32) -> bool {
        match &expr.kind {
            Kind::Set(members) => members.len() > 1 || members.iter().any(|m| self.is_set(place, m, depth)),
            Kind::Range(..) | Kind::Union(_) => true,
            Kind::Case(branches, last) => {
                branches.iter().map(|(_, v)| v).chain(last.as_deref()).any(|v| self.is_set(place, v, depth))
            }
            Kind::Next(inside) => self.is_set(place, inside, depth),
            Kind::Name(name) if depth < 100 => {
                match self.models[place.model].model.meaning(place.scope, name) {
                    Some(Meaning::Argument(scope, argument)) => {
                        self.is_set(Place { scope, ..place }, argument, depth + 1)
                    }
                    Some(Meaning::Symbol(full, &Symbol::Define(scope, body, _)))
                        if !self.models[place.model].is_label(full) =>
                    {
                        self.is_set(Place { scope, ..place }, body, depth + 1)
                    }
                    _ => false,
                }
            }
            _ => false,
        }
    }

    fn union(&mut self, a: Choice, b: Choice, span: Span) -> Parse<Choice> {
        match (a, b) {
            (Choice::Values(none), b) if none.is_empty() => Ok(b),
            (Choice::Values(mut a), Choice::Values(b)) => {
                a.extend(b);
                Ok(Choice::Values(a))
            }
            (Choice::If(branches, last), other) | (other, Choice::If(branches, last)) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, one) in branches {
                    self.count(1, span)?;
                    kept.push((condition, self.union(one, other.clone(), span)?));
                }
                Ok(Choice::If(kept, Box::new(self.union(*last, other, span)?)))
            }
            (Choice::Range(ends), other) | (other, Choice::Range(ends)) => {
                let [(_, lo, end), (_, start, hi)] = *ends;
                if lo != end || start != hi || hi - lo >= MAX_LISTED {
                    let message =
                        "a union with a range whose ends vary, or that is very long, is not supported";
                    return wrong("unsupported", span, message);
                }
                let listed = (lo..=hi).map(|n| Val::Int(super::int(n, span), n, n)).collect();
                self.union(Choice::Values(listed), other, span)
            }
        }
    }

    /// Whether a value is in a set.
    pub(crate) fn member(&mut self, value: Val, set: Choice, span: Span) -> Parse<ast::Expr> {
        match set {
            Choice::Values(members) => {
                let numbers = members.iter().all(|m| matches!(m, Val::Int(_, lo, hi) if lo == hi));
                if let (Val::Int(a, ..), true, true) = (&value, numbers, members.len() > 1) {
                    let members = members.into_iter().filter_map(|m| match m {
                        Val::Int(number, ..) => Some(number),
                        _ => None,
                    });
                    let set = Set::List(members.collect(), span);
                    return Ok(e(ExprKind::In(Box::new(a.clone()), set), span));
                }
                let mut ways = Vec::with_capacity(members.len());
                let one = members.len() == 1;
                for member in members {
                    let value = if one { value.clone() } else { self.copy_value(&value, span)? };
                    ways.push(self.equal(value, member, span)?);
                }
                Ok(match ways.len() {
                    1 => ways.remove(0),
                    _ => either(ways, span),
                })
            }
            Choice::Range(ends) => match value {
                Val::Int(a, ..) => {
                    let [(lo, ..), (hi, ..)] = *ends;
                    Ok(e(ExprKind::In(Box::new(a), Set::Range(Box::new(lo), Box::new(hi))), span))
                }
                other => {
                    let message = format!("{} is in no range of integers", other.describe());
                    wrong("type-mismatch", span, message)
                }
            },
            Choice::If(branches, last) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, set) in branches {
                    let value = self.copy_value(&value, span)?;
                    kept.push((condition, self.member(value, set, span)?));
                }
                Ok(choice(kept, self.member(value, *last, span)?, span))
            }
        }
    }

    fn copy_value(&mut self, value: &Val, span: Span) -> Parse<Val> {
        match value {
            Val::Bool(a) | Val::Int(a, ..) | Val::Word(a, _) => {
                self.copy(a)?;
            }
            Val::Symbol(_) => self.count(10, span)?,
        }
        Ok(value.clone())
    }
}

/// One of several; a value and its negation are all there are.
fn either(ways: Vec<ast::Expr>, span: Span) -> ast::Expr {
    if let [a, b] = &ways[..]
        && negation(a.clone()) == *b
    {
        return e(ExprKind::Bool(true), span);
    }
    e(ExprKind::Or(ways), span)
}
