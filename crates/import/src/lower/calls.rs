//! The functions of SMV.

use super::{Lower, Place, Val, choice, compare, e, int, wrong};
use crate::parser::{MAX_WIDTH, Parse};
use crate::tree::{Expr, Word};
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{CompareOp, ExprKind, Ident};

impl Lower<'_> {
    /// `NAME(E, ...)`
    pub(super) fn call(
        &mut self,
        place: Place<'_>,
        name: &Ident,
        arguments: &[Expr],
        span: Span,
    ) -> Parse<Val> {
        match (name.name.as_str(), arguments) {
            ("count", _) => self.count_of(place, arguments, span),
            ("abs", [a]) => self.absolute(place, a, span),
            ("min", [a, b]) => self.extreme(place, CompareOp::Le, a, b, span),
            ("max", [a, b]) => self.extreme(place, CompareOp::Ge, a, b, span),
            ("bool", [a]) => match self.value(place, a)? {
                Val::Bool(a) => Ok(Val::Bool(a)),
                Val::Int(a, ..) | Val::Word(a, _) => {
                    Ok(Val::Bool(compare(CompareOp::Ne, a, int(0, span), span)))
                }
                other => wrong("type-mismatch", a.span, format!("{} is no number", other.describe())),
            },
            ("toint", [a]) => match self.value(place, a)? {
                Val::Bool(a) => Ok(Val::Int(choice(vec![(a, int(1, span))], int(0, span), span), 0, 1)),
                Val::Word(a, word) => {
                    let (lo, hi) = word.bounds();
                    Ok(Val::Int(a, i128::from(lo), i128::from(hi)))
                }
                value @ Val::Int(..) => Ok(value),
                other => wrong("type-mismatch", a.span, format!("{} is no number", other.describe())),
            },
            ("word1", [a]) => {
                let a = self.truth(place, a)?;
                let bit = choice(vec![(a, int(1, span))], int(0, span), span);
                Ok(Val::Word(bit, Word { signed: false, width: 1 }))
            }
            ("signed" | "unsigned", [a]) => {
                let (a, word) = self.word(place, a)?;
                let bits = self.unsigned(a, word, span);
                Ok(self.of_bits(bits, Word { signed: name.name == "signed", ..word }, span))
            }
            ("uwconst" | "swconst", [a, width]) => {
                let value = i128::from(self.models[place.model].model.number(place.scope, a)?);
                let width = self.width(place, width, 0)?;
                let word = Word { signed: name.name == "swconst", width };
                Ok(self.wrapped(int(value, span), value, value, word, span))
            }
            ("extend" | "resize", [a, by]) => {
                let (a, word) = self.word(place, a)?;
                let more = if name.name == "extend" { word.width } else { 0 };
                let width = self.width(place, by, more)?;
                let (lo, hi) = word.bounds();
                let word = Word { width, ..word };
                Ok(self.wrapped(a, i128::from(lo), i128::from(hi), word, span))
            }
            (known, _) if FUNCTIONS.contains(&known) => {
                let message = format!("`{known}` does not take {} arguments", arguments.len());
                wrong("argument-count", span, message)
            }
            (other, _) => wrong("unsupported", name.span, format!("the function `{other}` is not supported")),
        }
    }

    /// How many of some truth values hold.
    fn count_of(&mut self, place: Place<'_>, arguments: &[Expr], span: Span) -> Parse<Val> {
        let mut terms = Vec::with_capacity(arguments.len());
        for argument in arguments {
            let truth = self.truth(place, argument)?;
            terms.push((false, choice(vec![(truth, int(1, span))], int(0, span), span)));
        }
        let most = terms.len() as i128;
        let total = if terms.len() == 1 { terms.remove(0).1 } else { e(ExprKind::Sum(terms), span) };
        Ok(Val::Int(total, 0, most))
    }

    fn absolute(&mut self, place: Place<'_>, a: &Expr, span: Span) -> Parse<Val> {
        let (a, lo, hi) = self.integer(place, a)?;
        let (tested, other) = (self.copy(&a)?, self.copy(&a)?);
        let negative = compare(CompareOp::Lt, tested, int(0, span), span);
        let minus = e(ExprKind::Neg(Box::new(other)), span);
        let least = if lo > 0 {
            lo
        } else if hi < 0 {
            -hi
        } else {
            0
        };
        Ok(Val::Int(choice(vec![(negative, minus)], a, span), least, lo.abs().max(hi.abs())))
    }

    /// The one of two numbers that stands so to the other.
    fn extreme(&mut self, place: Place<'_>, op: CompareOp, a: &Expr, b: &Expr, span: Span) -> Parse<Val> {
        let (a, b) = (self.integer(place, a)?, self.integer(place, b)?);
        let (left, right) = (self.copy(&a.0)?, self.copy(&b.0)?);
        let first = compare(op, left, right, span);
        let (lo, hi) = match op {
            CompareOp::Le => (a.1.min(b.1), a.2.min(b.2)),
            _ => (a.1.max(b.1), a.2.max(b.2)),
        };
        Ok(Val::Int(choice(vec![(first, a.0)], b.0, span), lo, hi))
    }

    fn word(&mut self, place: Place<'_>, a: &Expr) -> Parse<(hyperplan_syntax::ast::Expr, Word)> {
        match self.value(place, a)? {
            Val::Word(bits, word) => Ok((bits, word)),
            other => wrong("type-mismatch", a.span, format!("expected a word, found {}", other.describe())),
        }
    }

    /// So many bits and `more`.
    fn width(&mut self, place: Place<'_>, bits: &Expr, more: u32) -> Parse<u32> {
        let number = self.models[place.model].model.number(place.scope, bits)?;
        let width = u32::try_from(number).ok().and_then(|width| width.checked_add(more));
        match width.filter(|width| (1..=MAX_WIDTH).contains(width)) {
            Some(width) => Ok(width),
            None => wrong("unsupported", bits.span, format!("words have 1 to {MAX_WIDTH} bits")),
        }
    }
}

/// The functions that are read.
const FUNCTIONS: [&str; 12] = [
    "abs", "min", "max", "bool", "toint", "word1", "signed", "unsigned", "uwconst", "swconst", "extend",
    "resize",
];
