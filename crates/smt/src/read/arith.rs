//! Arithmetic, as far as it is linear.

use super::Reader;
use super::Trouble;
use super::operators::{Arith, Compare, arity, chain};
use crate::rational::Rational;
use crate::term::{Sort, Term};
use crate::terms::Terms;
use crate::value::Value;

impl Reader<'_> {
    /// A function from numbers to a number.
    pub(super) fn arith(&mut self, at: usize, arith: Arith, args: &[Term]) -> Result<Term, Trouble> {
        let args = self.numbers(at, args)?;
        match arith {
            Arith::Add => Ok(self.terms().add(&args)),
            Arith::Sub if args.len() == 1 => self.negated(at, args[0]),
            Arith::Sub => {
                let mut summands = vec![args[0]];
                for &t in &args[1..] {
                    summands.push(self.negated(at, t)?);
                }
                Ok(self.terms().add(&summands))
            }
            Arith::Mul => args[1..].iter().try_fold(args[0], |product, &t| self.product(at, product, t)),
            Arith::Div => {
                let reals = args.iter().map(|&t| self.of_sort(at, t, Sort::Real));
                let reals: Vec<Term> = reals.collect::<Result<_, _>>()?;
                reals[1..].iter().try_fold(reals[0], |quotient, &t| self.quotient(at, quotient, t))
            }
            Arith::IntDiv => {
                let mut quotient = args[0];
                for &t in &args[1..] {
                    quotient = self.divided(at, quotient, t)?.0;
                }
                Ok(quotient)
            }
            Arith::Mod => {
                let [a, b] = arity(at, &args)?;
                Ok(self.divided(at, a, b)?.1)
            }
            Arith::Abs => {
                let [t] = arity(at, &args)?;
                let negated = self.negated(at, t)?;
                let sort = self.sort_of(t);
                let zero = self.terms().constant(Value::default_of(sort));
                let positive = self.compare(at, Compare::Le, &[zero, t])?;
                Ok(self.terms().ite(positive, t, negated))
            }
            Arith::ToReal => {
                let [t] = arity(at, &args)?;
                self.of_sort(at, t, Sort::Real)
            }
        }
    }

    /// Numbers in order.
    pub(super) fn compare(&mut self, at: usize, compare: Compare, args: &[Term]) -> Result<Term, Trouble> {
        let args = self.numbers(at, args)?;
        Ok(chain(self.terms(), compare, &args, Terms::le))
    }

    /// `(_ divisible n)`.
    pub(super) fn divisible(&mut self, at: usize, by: u32, args: &[Term]) -> Result<Term, Trouble> {
        let [t] = arity(at, args)?;
        let t = self.of_sort(at, t, Sort::Int)?;
        if by == 0 {
            return Err(Trouble::syntax(at, "nothing is divisible by 0"));
        }
        let (rest, zero) = (self.terms().int_mod(t, i64::from(by)), self.terms().int(0));
        Ok(self.terms().eq(rest, zero))
    }

    /// The terms as numbers of one sort.
    fn numbers(&mut self, at: usize, args: &[Term]) -> Result<Vec<Term>, Trouble> {
        let args = self.alike(at, args)?;
        match self.sort_of(args[0]) {
            Sort::Int | Sort::Real => Ok(args),
            sort => Err(Trouble::syntax(at, format!("a number is needed here, not {sort}"))),
        }
    }

    fn negated(&mut self, at: usize, t: Term) -> Result<Term, Trouble> {
        let sort = self.sort_of(t);
        let minus = if sort == Sort::Real { Value::Real(Rational::from(-1)) } else { Value::Int(-1) };
        let minus = self.terms().constant(minus);
        self.product(at, minus, t)
    }

    /// A product of which one is a constant.
    fn product(&mut self, at: usize, a: Term, b: Term) -> Result<Term, Trouble> {
        let (factor, t) = match (self.terms().value(a), self.terms().value(b)) {
            (Some(factor), _) => (factor, b),
            (None, Some(factor)) => (factor, a),
            (None, None) => return Err(Trouble::unsupported(at, "a product of variables")),
        };
        match factor {
            Value::Real(factor) => Ok(self.terms().real_mul(factor, t)),
            Value::Int(factor) => {
                let factor = i64::try_from(factor)
                    .map_err(|_| Trouble::unsupported(at, format!("a product with {factor}")))?;
                Ok(self.terms().int_mul(factor, t))
            }
            _ => Err(Trouble::syntax(at, "a number is needed here")),
        }
    }

    /// A real divided by a constant.
    fn quotient(&mut self, at: usize, a: Term, b: Term) -> Result<Term, Trouble> {
        let inverse = match self.terms().value(b) {
            Some(Value::Real(r)) => Rational::new(r.denominator(), r.numerator()),
            _ => None,
        };
        let inverse = inverse.ok_or_else(|| Trouble::unsupported(at, "division by a variable or by 0"))?;
        Ok(self.terms().real_mul(inverse, a))
    }

    /// Quotient and remainder of the division of an integer by a constant.
    fn divided(&mut self, at: usize, a: Term, b: Term) -> Result<(Term, Term), Trouble> {
        let a = self.of_sort(at, a, Sort::Int)?;
        let divisor = match self.terms().value(b) {
            Some(Value::Int(divisor)) => i64::try_from(divisor).ok().filter(|d| *d != 0),
            _ => None,
        };
        let size = divisor.and_then(i64::checked_abs);
        let (Some(divisor), Some(size)) = (divisor, size) else {
            return Err(Trouble::unsupported(at, "division by a variable, by 0, or by a large number"));
        };
        let terms = self.terms();
        let (quotient, rest) = (terms.int_div(a, size), terms.int_mod(a, size));
        // The remainder is never negative: a = -d * -q + r.
        Ok((if divisor < 0 { terms.int_mul(-1, quotient) } else { quotient }, rest))
    }
}
