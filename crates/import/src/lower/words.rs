//! Words: integers that wrap, with bits that can be read.

use super::arith::{arith, plus};
use super::{Lower, Place, Val, choice, compare, e, int, wrong, wrong_with};
use crate::parser::{MAX_WIDTH, Parse};
use crate::tree::{Access, Expr, Infix, Word};
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{self, ArithOp, CompareOp, ExprKind};

/// Wider words are not combined bit by bit.
const MAX_BITWISE: u32 = 16;

fn power(bits: u32) -> i128 {
    1 << bits
}

impl<'t> Lower<'t> {
    /// A number, which lies between two, as a word.
    pub(super) fn wrapped(&mut self, a: ast::Expr, lo: i128, hi: i128, word: Word, span: Span) -> Val {
        let (least, most) = word.bounds();
        if lo >= i128::from(least) && hi <= i128::from(most) {
            return Val::Word(a, word);
        }
        let shifted = arith(ArithOp::Mod, plus(a, -i128::from(least), span), power(word.width), span);
        Val::Word(plus(shifted, i128::from(least), span), word)
    }

    /// The bits of a word as a number without sign.
    pub(super) fn unsigned(&mut self, a: ast::Expr, word: Word, span: Span) -> ast::Expr {
        if word.signed { arith(ArithOp::Mod, a, power(word.width), span) } else { a }
    }

    /// Bits as a word of that type.
    pub(super) fn of_bits(&mut self, bits: ast::Expr, word: Word, span: Span) -> Val {
        let most = power(word.width) - 1;
        self.wrapped(bits, 0, most, word, span)
    }

    /// `!w`
    pub(super) fn complement(&mut self, a: ast::Expr, word: Word, span: Span) -> Val {
        let (lo, hi) = word.bounds();
        let sum = i128::from(lo) + i128::from(hi);
        let complement = e(ExprKind::Sum(vec![(false, int(sum, span)), (true, a)]), span);
        Val::Word(complement, word)
    }

    /// `w[HIGH:LOW]`
    pub(super) fn bits(
        &mut self,
        place: Place<'_>,
        value: Val,
        access: Option<&Access>,
        span: Span,
    ) -> Parse<Val> {
        let (Val::Word(a, word), Some(Access::Bits(high, low))) = (value, access) else {
            return wrong("type-mismatch", span, "only words have bits");
        };
        let model = &self.models[place.model].model;
        let (high, low) = (model.number(place.scope, high)?, model.number(place.scope, low)?);
        if low < 0 || high < low || high >= i64::from(word.width) {
            let message = format!("there are no bits {high}:{low} in a word of {} bits", word.width);
            return wrong("out-of-range", span, message);
        }
        let (low, width) = (low as u32, (high - low + 1) as u32);
        let mut bits = self.unsigned(a, word, span);
        if low > 0 {
            bits = arith(ArithOp::Div, bits, power(low), span);
        }
        if low + width < word.width {
            bits = arith(ArithOp::Mod, bits, power(width), span);
        }
        Ok(Val::Word(bits, Word { signed: false, width }))
    }

    /// `<<`, `>>` by a constant, and `::`.
    pub(super) fn word_operator(
        &mut self,
        place: Place<'_>,
        infix: Infix,
        a: &Expr,
        b: &Expr,
        span: Span,
    ) -> Parse<Val> {
        let Val::Word(left, word) = self.value(place, a)? else {
            return wrong("type-mismatch", a.span, "expected a word");
        };
        let right = self.value(place, b)?;
        if infix == Infix::Concat {
            let Val::Word(right, other) = right else {
                return wrong("type-mismatch", b.span, "expected a word");
            };
            let width = word.width + other.width;
            if width > MAX_WIDTH {
                return wrong("unsupported", span, format!("words of {width} bits are not supported"));
            }
            let (left, right) = (self.unsigned(left, word, span), self.unsigned(right, other, span));
            let high = arith(ArithOp::Mul, left, power(other.width), span);
            let both = e(ExprKind::Sum(vec![(false, high), (false, right)]), span);
            return Ok(Val::Word(both, Word { signed: false, width }));
        }
        let by = match right {
            Val::Int(_, lo, hi) if lo == hi => Some(lo),
            _ => self.models[place.model].model.number(place.scope, b).ok().map(i128::from),
        };
        let Some(by) = by.filter(|by| (0..=i128::from(word.width)).contains(by)) else {
            let help = "a word can be shifted by a constant, up to its width";
            return wrong_with("unsupported", b.span, "this shift is not supported", help);
        };
        let by = by as u32;
        if infix == Infix::ShiftLeft {
            let bits = self.unsigned(left, word, span);
            let most = (power(word.width) - 1) * power(by);
            let shifted = arith(ArithOp::Mul, bits, power(by), span);
            if most >= 1 << 60 {
                return wrong("number-too-large", span, "the value may not fit in 62 bits");
            }
            return Ok(self.wrapped(shifted, 0, most, word, span));
        }
        // Rounding down keeps the sign.
        Ok(Val::Word(arith(ArithOp::Div, left, power(by), span), word))
    }

    /// Words bit by bit: both (`Mul`), either (`Iff`), or one alone (`Xor`).
    pub(super) fn bitwise(&mut self, values: Vec<Val>, word: Word, how: Infix, span: Span) -> Parse<Val> {
        if word.width > MAX_BITWISE {
            let message = format!("words of more than {MAX_BITWISE} bits cannot be combined bit by bit here");
            return wrong("unsupported", span, message);
        }
        let mut all = Vec::with_capacity(values.len());
        for value in values {
            match value {
                Val::Word(a, own) if own.width == word.width => all.push(self.unsigned(a, own, span)),
                other => {
                    let message =
                        format!("expected a word of {} bits, found {}", word.width, other.describe());
                    return wrong("type-mismatch", span, message);
                }
            }
        }
        let mut terms = Vec::with_capacity(word.width as usize);
        for bit in 0..word.width {
            let mut ones = Vec::with_capacity(all.len());
            for a in &all {
                let a = self.copy(a)?;
                let a = if bit > 0 { arith(ArithOp::Div, a, power(bit), span) } else { a };
                let a = if bit + 1 < word.width { arith(ArithOp::Mod, a, 2, span) } else { a };
                ones.push(compare(CompareOp::Eq, a, int(1, span), span));
            }
            let set = match how {
                Infix::Mul => e(ExprKind::And(ones), span),
                Infix::Iff => e(ExprKind::Or(ones), span),
                _ => {
                    let differ = ones.into_iter().reduce(|a, b| {
                        let same = e(ExprKind::Iff(Box::new(a), Box::new(b)), span);
                        e(ExprKind::Not(Box::new(same)), span)
                    });
                    differ.unwrap_or_else(|| e(ExprKind::Bool(false), span))
                }
            };
            terms.push((false, choice(vec![(set, int(power(bit), span))], int(0, span), span)));
        }
        let bits = if terms.len() == 1 { terms.remove(0).1 } else { e(ExprKind::Sum(terms), span) };
        Ok(self.of_bits(bits, word, span))
    }
}
