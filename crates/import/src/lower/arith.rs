//! Numbers: sums, products, quotients.

use super::{Lower, Place, Val, choice, compare, e, int, wrong, wrong_with};
use crate::parser::Parse;
use crate::tree::Expr;
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{self, ArithOp, CompareOp, ExprKind};

/// Values of a factor or divisor that are told apart.
const MAX_VALUES: i128 = 256;

/// An integer with its bounds.
type Bounded = (ast::Expr, i128, i128);

pub(super) fn arith(op: ArithOp, a: ast::Expr, by: i128, span: Span) -> ast::Expr {
    e(ExprKind::Arith(op, Box::new(a), Box::new(int(by, span))), span)
}

pub(super) fn plus(a: ast::Expr, n: i128, span: Span) -> ast::Expr {
    match n {
        0 => a,
        _ => e(ExprKind::Sum(vec![(false, a), (n < 0, int(n.abs(), span))]), span),
    }
}

fn minus(a: ast::Expr, span: Span) -> ast::Expr {
    match a.kind {
        ExprKind::Neg(inside) => *inside,
        kind => e(ExprKind::Neg(Box::new(e(kind, a.span))), span),
    }
}

impl Lower<'_> {
    pub(super) fn negated(&mut self, place: Place<'_>, a: &Expr, span: Span) -> Parse<Val> {
        match self.value(place, a)? {
            Val::Int(a, lo, hi) => Ok(Val::Int(minus(a, span), -hi, -lo)),
            Val::Word(a, word) => {
                let (lo, hi) = word.bounds();
                Ok(self.wrapped(minus(a, span), -i128::from(hi), -i128::from(lo), word, span))
            }
            other => wrong("type-mismatch", a.span, format!("expected a number, found {}", other.describe())),
        }
    }

    pub(super) fn sum(&mut self, place: Place<'_>, items: &[(bool, Expr)], span: Span) -> Parse<Val> {
        let mut word = None;
        let (mut lo, mut hi) = (0i128, 0i128);
        let mut parts = Vec::with_capacity(items.len());
        for (negative, item) in items {
            let (part, least, most) = match self.value(place, item)? {
                Val::Int(a, lo, hi) => (a, lo, hi),
                Val::Word(a, own) if word.is_none_or(|word| word == own) => {
                    word = Some(own);
                    let (lo, hi) = own.bounds();
                    (a, i128::from(lo), i128::from(hi))
                }
                other => {
                    let message = format!("expected a number, found {}", other.describe());
                    return wrong("type-mismatch", item.span, message);
                }
            };
            (lo, hi) = if *negative { (lo - most, hi - least) } else { (lo + least, hi + most) };
            parts.push((*negative, part));
        }
        let total = if lo == hi && word.is_none() { int(lo, span) } else { e(ExprKind::Sum(parts), span) };
        Ok(match word {
            Some(word) => self.wrapped(total, lo, hi, word, span),
            None => Val::Int(total, lo, hi),
        })
    }

    pub(super) fn product(&mut self, place: Place<'_>, a: &Expr, b: &Expr, span: Span) -> Parse<Val> {
        let (left, right) = (self.value(place, a)?, self.value(place, b)?);
        let word = match (&left, &right) {
            (Val::Word(_, word), _) | (_, Val::Word(_, word)) => Some(*word),
            _ => None,
        };
        let (left, right) = (number(left, a.span)?, number(right, b.span)?);
        let ends = [left.1 * right.1, left.1 * right.2, left.2 * right.1, left.2 * right.2];
        let lo = ends.into_iter().min().unwrap_or(0);
        let hi = ends.into_iter().max().unwrap_or(0);
        if lo.abs().max(hi.abs()) > 1 << 60 {
            return wrong("number-too-large", span, "the value may not fit in 62 bits");
        }
        let scaled = |a: ast::Expr, n: i128| match n {
            0 => int(0, span),
            1 => a,
            _ => arith(ArithOp::Mul, a, n, span),
        };
        let total = if lo == hi {
            int(lo, span)
        } else if right.1 == right.2 {
            scaled(left.0, right.1)
        } else if left.1 == left.2 {
            scaled(right.0, left.1)
        } else {
            let (few, other) =
                if left.2 - left.1 <= right.2 - right.1 { (left, right) } else { (right, left) };
            let help = "one factor should be a constant, or have few values";
            self.by_value(few, span, help, &mut |lower, n| {
                let other = lower.copy(&other.0)?;
                Ok(scaled(other, n))
            })?
        };
        Ok(match word {
            Some(word) => self.wrapped(total, lo, hi, word, span),
            None => Val::Int(total, lo, hi),
        })
    }

    /// A value for each that a number may have.
    pub(super) fn by_value(
        &mut self,
        (number, lo, hi): Bounded,
        span: Span,
        help: &str,
        value: &mut dyn FnMut(&mut Self, i128) -> Parse<ast::Expr>,
    ) -> Parse<ast::Expr> {
        if hi - lo >= MAX_VALUES {
            let message = format!("this may have more than {MAX_VALUES} values on both sides");
            return wrong_with("nonlinear", span, message, help);
        }
        let mut branches = Vec::new();
        for n in lo..hi {
            let number = self.copy(&number)?;
            branches.push((compare(CompareOp::Eq, number, int(n, span), span), value(self, n)?));
        }
        Ok(choice(branches, value(self, hi)?, span))
    }

    /// A quotient rounded towards zero, or what remains then, with the sign of the dividend: as in C, which NuSMV follows.
    pub(super) fn quotient(
        &mut self,
        place: Place<'_>,
        a: &Expr,
        b: &Expr,
        remainder: bool,
        span: Span,
    ) -> Parse<Val> {
        let (left, right) = (self.value(place, a)?, self.value(place, b)?);
        let word = match (&left, &right) {
            (Val::Word(_, word), _) | (_, Val::Word(_, word)) => Some(*word),
            _ => None,
        };
        let (left, right) = (number(left, a.span)?, number(right, b.span)?);
        if right.1 <= 0 && right.2 >= 0 {
            let message = "the divisor may be 0";
            return wrong_with("bad-divisor", b.span, message, "give it a range without 0");
        }
        let magnitude = left.1.abs().max(left.2.abs());
        let (lo, hi) = if remainder {
            let most = (right.1.abs().max(right.2.abs()) - 1).min(magnitude);
            (if left.1 < 0 { -most } else { 0 }, if left.2 > 0 { most } else { 0 })
        } else {
            (-magnitude, magnitude)
        };
        let lo = if !remainder && left.1 >= 0 && right.1 > 0 { 0 } else { lo };
        let total = if right.1 == right.2 {
            self.truncated(left, right.1, remainder, span)?
        } else {
            let help = "the divisor should be a constant, or have few values";
            self.by_value(right, span, help, &mut |lower, n| {
                let left = (lower.copy(&left.0)?, left.1, left.2);
                lower.truncated(left, n, remainder, span)
            })?
        };
        Ok(match word {
            Some(word) => self.wrapped(total, lo, hi, word, span),
            None => Val::Int(total, lo, hi),
        })
    }

    fn truncated(&mut self, (a, lo, hi): Bounded, by: i128, remainder: bool, span: Span) -> Parse<ast::Expr> {
        let op = if remainder { ArithOp::Mod } else { ArithOp::Div };
        // For a >= 0: a / b = sign(b) * (a div |b|), and a mod b = a % |b|. For a < 0 the same of -a, negated.
        let up = |a| {
            let positive = arith(op, a, by.abs(), span);
            if by < 0 && !remainder { minus(positive, span) } else { positive }
        };
        if lo >= 0 {
            return Ok(up(a));
        }
        if hi <= 0 {
            return Ok(minus(up(minus(a, span)), span));
        }
        let (tested, negated) = (self.copy(&a)?, self.copy(&a)?);
        let below = minus(up(minus(negated, span)), span);
        let positive = compare(CompareOp::Ge, tested, int(0, span), span);
        Ok(choice(vec![(positive, up(a))], below, span))
    }
}

/// A number with its bounds, be it an integer or a word.
fn number(value: Val, span: Span) -> Parse<Bounded> {
    match value {
        Val::Int(a, lo, hi) => Ok((a, lo, hi)),
        Val::Word(a, word) => {
            let (lo, hi) = word.bounds();
            Ok((a, i128::from(lo), i128::from(hi)))
        }
        other => wrong("type-mismatch", span, format!("expected a number, found {}", other.describe())),
    }
}
