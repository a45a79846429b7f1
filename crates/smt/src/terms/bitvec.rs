//! Bit-vector constructors.

use super::Terms;
use crate::term::{Op, Sort, Term};
use crate::value::{Value, mask};

impl Terms {
    /// The constant `value` in two's complement, cut to `width` bits.
    pub fn bv(&mut self, value: i128, width: u32) -> Term {
        self.constant(Value::bv(value, width))
    }

    /// Sum modulo 2^width.
    pub fn bv_add(&mut self, a: Term, b: Term) -> Term {
        let (a, b) = (a.min(b), a.max(b));
        if self.bits(a) == Some(0) {
            return self.bv_checked("bvadd", b, a);
        }
        if self.bits(b) == Some(0) {
            return self.bv_checked("bvadd", a, b);
        }
        self.bv_binary(Op::BvAdd, a, b)
    }

    /// Product modulo 2^width.
    pub fn bv_mul(&mut self, a: Term, b: Term) -> Term {
        let (a, b) = (a.min(b), a.max(b));
        for (constant, other) in [(a, b), (b, a)] {
            match self.bits(constant) {
                Some(0) => return self.bv_checked("bvmul", constant, other),
                Some(1) => return self.bv_checked("bvmul", other, constant),
                _ => {}
            }
        }
        self.bv_binary(Op::BvMul, a, b)
    }

    /// Two's complement.
    pub fn bv_neg(&mut self, a: Term) -> Term {
        let width = self.width("bvneg", a);
        if self.op(a) == Op::BvNeg {
            return self.children(a)[0];
        }
        let sort = Sort::BitVec(width);
        self.fold(Op::BvNeg, sort, &[a], &[]).unwrap_or_else(|| self.intern(Op::BvNeg, sort, &[a]))
    }

    /// Unsigned less-than.
    pub fn bv_ult(&mut self, a: Term, b: Term) -> Term {
        let width = self.width("bvult", a);
        if a == b || self.bits(b) == Some(0) || self.bits(a) == Some(mask(width)) {
            return self.bv_checked("bvult", Term::FALSE, b);
        }
        self.bv_compare(Op::BvUlt, a, b)
    }

    /// Unsigned less-than-or-equal.
    pub fn bv_ule(&mut self, a: Term, b: Term) -> Term {
        !self.bv_ult(b, a)
    }

    /// Signed less-than.
    pub fn bv_slt(&mut self, a: Term, b: Term) -> Term {
        if a == b {
            return self.bv_checked("bvslt", Term::FALSE, b);
        }
        self.bv_compare(Op::BvSlt, a, b)
    }

    /// Signed less-than-or-equal.
    pub fn bv_sle(&mut self, a: Term, b: Term) -> Term {
        !self.bv_slt(b, a)
    }

    /// Widens by `by` copies of the sign bit.
    pub fn sign_extend(&mut self, a: Term, by: u32) -> Term {
        self.extend(Op::SignExtend, a, by)
    }

    /// Widens by `by` zeros.
    pub fn zero_extend(&mut self, a: Term, by: u32) -> Term {
        self.extend(Op::ZeroExtend, a, by)
    }

    /// The bits from `hi` down to `lo`, both included.
    pub fn extract(&mut self, a: Term, hi: u32, lo: u32) -> Term {
        let width = self.width("extract", a);
        assert!(lo <= hi && hi < width, "extract: bits {hi} to {lo} of {width}");
        if hi - lo + 1 == width {
            return a;
        }
        let sort = Sort::BitVec(hi - lo + 1);
        self.fold(Op::Extract, sort, &[a], &[hi, lo])
            .unwrap_or_else(|| self.intern(Op::Extract, sort, &[a, Term(hi), Term(lo)]))
    }

    fn extend(&mut self, op: Op, a: Term, by: u32) -> Term {
        let width = self.width(op.name(), a);
        if by == 0 {
            return a;
        }
        let wide = width.checked_add(by).filter(|&w| w <= 128);
        let sort = Sort::BitVec(wide.expect("bit-vectors have at most 128 bits"));
        self.fold(op, sort, &[a], &[by]).unwrap_or_else(|| self.intern(op, sort, &[a, Term(by)]))
    }

    fn bv_binary(&mut self, op: Op, a: Term, b: Term) -> Term {
        let sort = self.same_sort(op.name(), a, b);
        self.width(op.name(), a);
        self.fold(op, sort, &[a, b], &[]).unwrap_or_else(|| self.intern(op, sort, &[a, b]))
    }

    fn bv_compare(&mut self, op: Op, a: Term, b: Term) -> Term {
        self.same_sort(op.name(), a, b);
        self.width(op.name(), a);
        self.fold(op, Sort::Bool, &[a, b], &[]).unwrap_or_else(|| self.intern(op, Sort::Bool, &[a, b]))
    }

    /// `result`, once it is sure that it goes with `other`: a bit-vector of the same width, or of
    /// any width for a Boolean result.
    fn bv_checked(&self, what: &str, result: Term, other: Term) -> Term {
        self.width(what, other);
        if !result.is_const() {
            self.same_sort(what, result, other);
        }
        result
    }

    fn bits(&self, t: Term) -> Option<u128> {
        self.value(t)?.as_unsigned()
    }
}
