//! Words: integers that wrap, with bits that can be read.

use super::arith::{arith, plus};
use super::{Lower, Place, Val, choice, compare, e, int, wrong, wrong_with};
use crate::parser::{MAX_WIDTH, Parse};
use crate::tree::{Access, Expr, Infix, Word};
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{self, ArithOp, CompareOp, ExprKind, Ident};

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
    fn unsigned(&mut self, a: ast::Expr, word: Word, span: Span) -> ast::Expr {
        if word.signed { arith(ArithOp::Mod, a, power(word.width), span) } else { a }
    }

    /// Bits as a word of that type.
    fn of_bits(&mut self, bits: ast::Expr, word: Word, span: Span) -> Val {
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

    /// `NAME(E, ...)`
    pub(super) fn call(
        &mut self,
        place: Place<'_>,
        name: &Ident,
        arguments: &[Expr],
        span: Span,
    ) -> Parse<Val> {
        let constant = |lower: &Self, e: &Expr| lower.models[place.model].model.number(place.scope, e);
        match (name.name.as_str(), arguments) {
            ("count", _) => {
                let mut terms = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    let truth = self.truth(place, argument)?;
                    terms.push((false, choice(vec![(truth, int(1, span))], int(0, span), span)));
                }
                let most = terms.len() as i128;
                let total = if terms.len() == 1 { terms.remove(0).1 } else { e(ExprKind::Sum(terms), span) };
                Ok(Val::Int(total, 0, most))
            }
            ("abs", [a]) => {
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
            ("min" | "max", [a, b]) => {
                let (a, b) = (self.integer(place, a)?, self.integer(place, b)?);
                let op = if name.name == "min" { CompareOp::Le } else { CompareOp::Ge };
                let (left, right) = (self.copy(&a.0)?, self.copy(&b.0)?);
                let first = compare(op, left, right, span);
                let (lo, hi) = if name.name == "min" {
                    (a.1.min(b.1), a.2.min(b.2))
                } else {
                    (a.1.max(b.1), a.2.max(b.2))
                };
                Ok(Val::Int(choice(vec![(first, a.0)], b.0, span), lo, hi))
            }
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
            ("signed" | "unsigned", [a]) => match self.value(place, a)? {
                Val::Word(a, word) => {
                    let bits = self.unsigned(a, word, span);
                    Ok(self.of_bits(bits, Word { signed: name.name == "signed", ..word }, span))
                }
                other => wrong("type-mismatch", a.span, format!("{} is no word", other.describe())),
            },
            ("uwconst" | "swconst", [a, width]) => {
                let (value, width) = (constant(self, a)?, constant(self, width)?);
                let width = u32::try_from(width).ok().filter(|width| (1..=MAX_WIDTH).contains(width));
                let Some(width) = width else {
                    return wrong("unsupported", span, format!("words have 1 to {MAX_WIDTH} bits"));
                };
                let word = Word { signed: name.name == "swconst", width };
                let value = i128::from(value);
                Ok(self.wrapped(int(value, span), value, value, word, span))
            }
            ("extend" | "resize", [a, by]) => {
                let by = constant(self, by)?;
                let Val::Word(a, word) = self.value(place, a)? else {
                    return wrong("type-mismatch", a.span, "expected a word");
                };
                let width = if name.name == "extend" { i64::from(word.width) + by } else { by };
                let Some(width) = u32::try_from(width).ok().filter(|width| (1..=MAX_WIDTH).contains(width))
                else {
                    return wrong("unsupported", span, format!("words have 1 to {MAX_WIDTH} bits"));
                };
                let (lo, hi) = word.bounds();
                let word = Word { width, ..word };
                Ok(self.wrapped(a, i128::from(lo), i128::from(hi), word, span))
            }
            (
                known @ ("abs" | "min" | "max" | "bool" | "toint" | "word1" | "signed" | "unsigned"
                | "uwconst" | "swconst" | "extend" | "resize"),
                _,
            ) => wrong(
                "argument-count",
                span,
                format!("`{known}` does not take {} arguments", arguments.len()),
            ),
            (other, _) => wrong("unsupported", name.span, format!("the function `{other}` is not supported")),
        }
    }
}
