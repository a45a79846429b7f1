//! Linear integer and real arithmetic.

use super::Terms;
use crate::rational::Rational;
use crate::term::{Op, Sort, Term};
use crate::value::Value;

impl Terms {
    /// An integer constant.
    pub fn int(&mut self, value: i64) -> Term {
        self.constant(Value::Int(i128::from(value)))
    }

    /// A rational constant.
    pub fn real(&mut self, value: Rational) -> Term {
        self.constant(Value::Real(value))
    }

    /// A multiple of an integer.
    pub fn int_mul(&mut self, c: i64, t: Term) -> Term {
        let factor = self.int(c);
        match c {
            0 => self.arith_checked(Sort::Int, factor, t),
            1 => self.arith_checked(Sort::Int, t, t),
            _ => self.arith(Op::Mul, Sort::Int, Sort::Int, &[factor, t]),
        }
    }

    /// A multiple of a real.
    pub fn real_mul(&mut self, c: Rational, t: Term) -> Term {
        let factor = self.real(c);
        if c == Rational::ZERO {
            return self.arith_checked(Sort::Real, factor, t);
        }
        if c == Rational::ONE {
            return self.arith_checked(Sort::Real, t, t);
        }
        self.arith(Op::Mul, Sort::Real, Sort::Real, &[factor, t])
    }

    /// `a <= b`, on integers or on reals.
    pub fn le(&mut self, a: Term, b: Term) -> Term {
        let sort = self.number_sort(a);
        if a == b {
            return Term::TRUE;
        }
        self.arith(Op::Le, sort, Sort::Bool, &[a, b])
    }

    /// `a < b`, on integers or on reals.
    pub fn lt(&mut self, a: Term, b: Term) -> Term {
        !self.le(b, a)
    }

    /// Division by a positive constant, rounded down.
    pub fn int_div(&mut self, t: Term, c: i64) -> Term {
        assert!(c > 0, "div by {c}");
        let divisor = self.int(c);
        if c == 1 {
            return self.arith_checked(Sort::Int, t, t);
        }
        self.arith(Op::IntDiv, Sort::Int, Sort::Int, &[t, divisor])
    }

    /// Remainder, never negative, of the division by a positive constant.
    pub fn int_mod(&mut self, t: Term, c: i64) -> Term {
        assert!(c > 0, "mod {c}");
        let divisor = self.int(c);
        self.arith(Op::IntMod, Sort::Int, Sort::Int, &[t, divisor])
    }

    /// An integer as a real.
    pub fn to_real(&mut self, t: Term) -> Term {
        self.arith(Op::ToReal, Sort::Int, Sort::Real, &[t])
    }

    /// Sum of integers or of reals, one at least, with the constants gathered into one unless that overflows.
    pub fn add(&mut self, ts: &[Term]) -> Term {
        let sort = self.number_sort(ts[0]);
        let zero = Value::default_of(sort);
        let mut constant = zero;
        let mut summands = Vec::with_capacity(ts.len() + 1);
        for &t in ts {
            self.arith_checked(sort, t, t);
            let folded = self.value(t).and_then(|v| crate::apply::apply(Op::Add, sort, &[constant, v], &[]));
            match folded {
                Some(sum) => constant = sum,
                None => summands.push(t),
            }
        }
        if constant != zero || summands.is_empty() {
            summands.push(self.constant(constant));
        }
        if let [only] = summands[..] {
            return only;
        }
        summands.sort_unstable();
        self.intern(Op::Add, sort, &summands)
    }

    fn arith(&mut self, op: Op, of: Sort, sort: Sort, args: &[Term]) -> Term {
        for &t in args {
            self.arith_checked(of, t, t);
        }
        self.fold(op, sort, args, &[]).unwrap_or_else(|| self.intern(op, sort, args))
    }

    fn number_sort(&self, t: Term) -> Sort {
        let sort = self.sort(t);
        assert!(matches!(sort, Sort::Int | Sort::Real), "arithmetic: a number is needed, not {sort}");
        sort
    }

    fn arith_checked(&self, sort: Sort, result: Term, t: Term) -> Term {
        let found = self.sort(t);
        assert!(found == sort, "arithmetic: {sort} is needed, not {found}");
        result
    }
}
