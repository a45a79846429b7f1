//! Comparisons of fractions without real variables, as comparisons of integers.
//!
//! `x + 1/2 < y` with integers x and y is `2 x + 1 < 2 y`. So reals occur only where a system has real variables, and
//! whatever handles finite systems knows integers only.

use super::typed::{self as make, Bounded, Bounds};
use crate::expr::{Comparison, Expr, Rational, Value};

/// Integers that become parts of fractions are at most this, so that products with denominators can be bounded.
pub(super) const MAX_CONVERTED: i64 = 1 << 44;

/// The comparison of two real expressions; `None` where numbers leave the limit.
pub(super) fn compare<L: Clone>(op: Comparison, a: Expr<L>, b: Expr<L>) -> Option<Expr<L>> {
    if matches!((&a, &b), (Expr::Const(_), Expr::Const(_))) || reads_reals(&a) || reads_reals(&b) {
        return Some(make::compare(op, a, b));
    }
    let factor = Rational::from(common(denominator(&a)?, denominator(&b)?)?);
    Some(make::compare(op, multiple(&a, factor)?.0, multiple(&b, factor)?.0))
}

/// Whether a real expression reads a real variable: whether it is more than constants and converted integers.
fn reads_reals<L>(e: &Expr<L>) -> bool {
    match e {
        Expr::Leaf(_) => true,
        Expr::Add(es) => es.iter().any(reads_reals),
        Expr::Scale(_, a) => reads_reals(a),
        Expr::If(branches, last) => branches.iter().any(|(_, a)| reads_reals(a)) || reads_reals(last),
        _ => false,
    }
}

/// A number whose product with the expression has integer coefficients only.
fn denominator<L>(e: &Expr<L>) -> Option<i64> {
    let fits = |n: i64| (i128::from(n) <= make::LIMIT).then_some(n);
    match e {
        Expr::Const(Value::Real(r)) => fits(*r.denom()),
        Expr::Add(es) => es.iter().try_fold(1, |lcm: i64, e| common(lcm, denominator(e)?)),
        Expr::Scale(c, a) => denominator(a)?.checked_mul(*c.denom()).and_then(fits),
        Expr::If(branches, last) => {
            branches.iter().try_fold(denominator(last)?, |lcm, (_, a)| common(lcm, denominator(a)?))
        }
        _ => Some(1),
    }
}

fn common(a: i64, b: i64) -> Option<i64> {
    (a / num_integer::gcd(a, b)).checked_mul(b)
}

/// The expression times a factor that makes it integral.
fn multiple<L: Clone>(e: &Expr<L>, factor: Rational) -> Option<Bounded<L>> {
    use num_traits::CheckedMul as _;
    match e {
        Expr::Const(Value::Real(r)) => {
            let product = r.checked_mul(&factor)?;
            let n = product.is_integer().then(|| product.to_integer())?;
            let bounds = Bounds::new(i128::from(n), i128::from(n))?;
            Some((Expr::Const(Value::Int(n)), Some(bounds)))
        }
        Expr::ToReal(a) => {
            let bounds = Bounds { lo: -MAX_CONVERTED, hi: MAX_CONVERTED };
            let factor = factor.is_integer().then(|| factor.to_integer())?;
            make::scale(factor, ((**a).clone(), Some(bounds)))
        }
        Expr::Add(es) => make::sum(es.iter().map(|e| multiple(e, factor)).collect::<Option<_>>()?),
        Expr::Scale(c, a) => multiple(a, factor.checked_mul(c)?),
        Expr::If(branches, last) => {
            let (last, mut bounds) = multiple(last, factor)?;
            let mut scaled = Vec::with_capacity(branches.len());
            for (condition, value) in branches {
                let (value, own) = multiple(value, factor)?;
                bounds = bounds.zip(own).map(|(all, own)| all.hull(own));
                scaled.push((condition.clone(), value));
            }
            Some((Expr::choice(scaled, last), bounds))
        }
        _ => None,
    }
}

/// A number such as `0.25`, exactly.
pub(super) fn decimal(digits: &str) -> Option<Rational> {
    let (whole, rest) = digits.split_once('.')?;
    let numerator: i64 = format!("{whole}{rest}").parse().ok()?;
    let denominator = 10_i64.checked_pow(u32::try_from(rest.len()).ok()?)?;
    let value = Rational::new(numerator, denominator);
    (i128::from(*value.numer()).abs() <= make::LIMIT).then_some(value)
}

/// A number as a user may write it in one word: `-3`, `0.25`, `1/4`.
pub(crate) fn number(text: &str) -> Option<Value> {
    let fits = |n: &i64| i128::from(*n).abs() <= make::LIMIT;
    let integer = |text: &str| text.parse::<i64>().ok().filter(fits);
    if let Some((numerator, denominator)) = text.split_once('/') {
        let (numerator, denominator) = (integer(numerator)?, integer(denominator).filter(|d| *d > 0)?);
        return Some(Value::Real(Rational::new(numerator, denominator)));
    }
    match text.strip_prefix('-') {
        Some(rest) if text.contains('.') => decimal(rest).map(|r| Value::Real(-r)),
        None if text.contains('.') => decimal(text).map(Value::Real),
        _ => integer(text).map(Value::Int),
    }
}
