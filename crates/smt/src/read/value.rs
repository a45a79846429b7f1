//! Values, in all notations in which solvers write them.

use crate::lexer::{Token, tokens};
use crate::rational::Rational;
use crate::term::Sort;
use crate::terms::Terms;
use crate::value::Value;

/// The value of that sort that is written so: whole numbers are reals too.
#[must_use]
pub fn read_value(terms: &Terms, sort: Sort, text: &str) -> Option<Value> {
    if let Sort::Enum(enumeration) = sort {
        return terms.constructor_called(enumeration, text);
    }
    match (any_value(text)?, sort) {
        (Value::Int(i), Sort::Real) => Rational::new(i, 1).map(Value::Real),
        (Value::Real(r), Sort::Int) if r.denominator() == 1 => Some(Value::Int(r.numerator())),
        (value, _) => (value.sort() == sort).then_some(value),
    }
}

/// A value that is no constructor.
fn any_value(text: &str) -> Option<Value> {
    // The longest has two signs: `(- (/ (- 1) (- 3)))`. What is longer would recurse.
    let tokens: Vec<Token<'_>> = tokens(text).take(21).map(|(_, token)| token).collect();
    match tokens[..] {
        [Token::Word("true")] => Some(Value::Bool(true)),
        [Token::Word("false")] => Some(Value::Bool(false)),
        [Token::Binary(digits)] => vector(digits.len(), u128::from_str_radix(digits, 2).ok()?),
        [Token::Hex(digits)] => vector(digits.len() * 4, u128::from_str_radix(digits, 16).ok()?),
        [Token::Open, Token::Word("_"), Token::Word(constant), Token::Number(width), Token::Close] => {
            vector(width.parse().ok()?, constant.strip_prefix("bv")?.parse().ok()?)
        }
        _ if tokens.len() > 20 => None,
        _ => number(&tokens),
    }
}

/// A bit-vector, unless the bits are more than the width.
pub(super) fn vector(width: usize, bits: u128) -> Option<Value> {
    let width = u32::try_from(width).ok().filter(|width| (1..=128).contains(width))?;
    (bits.leading_zeros() >= 128 - width).then_some(Value::Bv { width, bits })
}

/// An integer or rational: digits, a decimal, and at most a few levels of `-` and `/`.
fn number(tokens: &[Token<'_>]) -> Option<Value> {
    match tokens {
        // Some write a sign as a part of the number.
        [Token::Number(digits) | Token::Word(digits)] => decimal(digits),
        [Token::Open, Token::Word("-"), inner @ .., Token::Close] => match number(inner)? {
            Value::Int(i) => Some(Value::Int(i.checked_neg()?)),
            Value::Real(r) => Some(Value::Real(r.checked_mul(Rational::from(-1))?)),
            _ => None,
        },
        [Token::Open, Token::Word("/"), inner @ .., Token::Close] => {
            let split = if inner.first() == Some(&Token::Open) { 4 } else { 1 };
            let (a, b) = inner.split_at_checked(split)?;
            let (a, b) = (real(number(a)?)?, real(number(b)?)?);
            Some(Value::Real(a.checked_mul(Rational::new(b.denominator(), b.numerator())?)?))
        }
        _ => None,
    }
}

/// Whether that is a number with more digits than there is room for, which is not the fault of who wrote it.
#[must_use]
pub fn is_large_number(text: &str) -> bool {
    // The longest number that always fits has so many.
    const DIGITS: usize = 18;
    let mut large = false;
    let fits = tokens(text).all(|(_, token)| match token {
        Token::Open | Token::Close | Token::Word("-" | "/") => true,
        Token::Number(text) | Token::Word(text) => {
            let digits = text.strip_prefix('-').unwrap_or(text);
            large |= digits.len() > DIGITS;
            digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.')
        }
        _ => false,
    });
    fits && large
}

fn real(value: Value) -> Option<Rational> {
    match value {
        Value::Int(i) => Rational::new(i, 1),
        Value::Real(r) => Some(r),
        _ => None,
    }
}

/// A numeral or decimal, if it fits.
pub(super) fn decimal(digits: &str) -> Option<Value> {
    let Some((whole, fraction)) = digits.split_once('.') else {
        return Some(Value::Int(digits.parse().ok()?));
    };
    let fraction = fraction.trim_end_matches('0');
    let denominator = 10_i128.checked_pow(u32::try_from(fraction.len()).ok()?)?;
    Some(Value::Real(Rational::new(format!("{whole}{fraction}").parse().ok()?, denominator)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_in_all_notations() {
        let fraction = |n, d| Rational::new(n, d).map(Value::Real);
        for (text, expected) in [
            ("true", Some(Value::Bool(true))),
            ("false", Some(Value::Bool(false))),
            ("#b0101", Some(Value::bv(5, 4))),
            ("#x0F", Some(Value::bv(15, 8))),
            ("(_ bv5 8)", Some(Value::bv(5, 8))),
            ("7", Some(Value::Int(7))),
            ("(- 3)", Some(Value::Int(-3))),
            ("-3", Some(Value::Int(-3))),
            ("2.50", fraction(5, 2)),
            ("(/ 1.0 3.0)", fraction(1, 3)),
            ("(- (/ 1 6))", fraction(-1, 6)),
            ("(/ (- 2) 4)", fraction(-1, 2)),
            ("(- (/ (- 1) (- 3)))", fraction(-1, 3)),
        ] {
            assert_eq!(any_value(text), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_value() {
        let deep = format!("{}1{}", "(- ".repeat(200_000), ")".repeat(200_000));
        let all = ["", "x", "|1|", "1 2", "(lambda (y) y)", "(/ 1 0)", "(/ 1)", "(- true)", "(/ (- 1) (- 3)"];
        let vectors = ["(_ bv5 2)", "(_ bv5 129)", "(_ bv0 0)", "(_ bv 3)", "#b", "#xg"];
        for text in all.into_iter().chain(vectors).chain([deep.as_str()]) {
            assert_eq!(any_value(text), None, "{text}");
        }
    }

    #[test]
    fn numbers_without_room() {
        let digits = "9".repeat(39);
        for text in [&digits, &format!("(- {digits})"), &format!("-{digits}"), &format!("(/ 1.0 {digits}.0)")]
        {
            assert_eq!((any_value(text), is_large_number(text)), (None, true), "{text}");
        }
        let symbol = format!("x{digits}");
        let quoted = format!("|{digits}|");
        let power = format!("(+ {digits} 1)");
        for text in ["", "7", "(- 3)", "(/ 1 0)", "true", "#b01", &symbol, &quoted, &power] {
            assert!(!is_large_number(text), "{text}");
        }
    }

    #[test]
    fn whole_numbers_are_reals() {
        let terms = Terms::new();
        assert_eq!(read_value(&terms, Sort::Real, "2"), Some(Value::Real(Rational::from(2))));
        assert_eq!(read_value(&terms, Sort::Int, "2.0"), Some(Value::Int(2)));
        for (sort, text) in [(Sort::Bool, "2"), (Sort::Int, "2.5"), (Sort::BitVec(3), "#b10")] {
            assert_eq!(read_value(&terms, sort, text), None, "{text}");
        }
    }
}
