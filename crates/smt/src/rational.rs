//! Exact fractions of 128-bit integers. Every operation is checked: what does not fit is `None`.

use std::fmt;

use num_rational::Ratio;
use num_traits::{CheckedAdd as _, CheckedMul as _};

/// A fraction in lowest terms with a positive denominator.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Rational(Ratio<i128>);

impl Rational {
    /// Zero.
    pub const ZERO: Rational = Rational(Ratio::new_raw(0, 1));
    /// One.
    pub const ONE: Rational = Rational(Ratio::new_raw(1, 1));

    /// The fraction in lowest terms; `None` if the denominator is zero or it does not fit.
    #[must_use]
    pub fn new(numerator: i128, denominator: i128) -> Option<Rational> {
        // A negative denominator changes both signs, which the least number cannot.
        let fits = denominator > 0 || denominator < 0 && numerator > i128::MIN && denominator > i128::MIN;
        fits.then(|| Rational(Ratio::new(numerator, denominator)))
    }

    /// The numerator, which carries the sign.
    #[must_use]
    pub fn numerator(self) -> i128 {
        *self.0.numer()
    }

    /// The denominator, positive.
    #[must_use]
    pub fn denominator(self) -> i128 {
        *self.0.denom()
    }

    /// The sum.
    #[must_use]
    pub fn checked_add(self, other: Rational) -> Option<Rational> {
        self.0.checked_add(&other.0).map(Rational)
    }

    /// The product.
    #[must_use]
    pub fn checked_mul(self, other: Rational) -> Option<Rational> {
        self.0.checked_mul(&other.0).map(Rational)
    }
}

impl From<i64> for Rational {
    fn from(value: i64) -> Self {
        Rational(Ratio::from(i128::from(value)))
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_nothing() {
        let of = |n, d| Rational::new(n, d);
        assert_eq!(of(6, -4).map(|r| (r.numerator(), r.denominator())), Some((-3, 2)));
        for (n, d) in [(1, 0), (0, 0), (i128::MIN, -1), (1, i128::MIN), (i128::MIN, i128::MIN)] {
            assert_eq!(of(n, d), None, "{n}/{d}");
        }
        let extremes = [i128::MIN, i128::MIN + 1, -3, -1, 0, 1, 2, i128::MAX - 1, i128::MAX];
        let all: Vec<Rational> =
            extremes.iter().flat_map(|&n| extremes.iter().filter_map(move |&d| of(n, d))).collect();
        for &a in &all {
            for &b in &all {
                // No panic, and what has a value has one order.
                let (sum, product) = (a.checked_add(b), a.checked_mul(b));
                assert_eq!((sum, product), (b.checked_add(a), b.checked_mul(a)), "{a} and {b}");
                assert_eq!(a.cmp(&b), b.cmp(&a).reverse(), "{a} and {b}");
            }
        }
        assert_eq!(of(i128::MAX, 1).and_then(|r| r.checked_add(Rational::ONE)), None);
    }
}
