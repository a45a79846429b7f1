//! Bit-vectors. What terms have no operator for is put together from what they have.

use super::Reader;
use super::Trouble;
use super::operators::{Bits, Compare, Operator, arity, chain};
use crate::term::{Sort, Term};
use crate::terms::Terms;
use crate::value::{Value, mask};

impl Reader<'_> {
    /// The width of bit-vectors of one width.
    pub(super) fn same_width(&mut self, at: usize, args: &[Term]) -> Result<u32, Trouble> {
        let sort = self.sort_of(args[0]);
        let Sort::BitVec(width) = sort else {
            return Err(Trouble::syntax(at, format!("a bit-vector is needed here, not {sort}")));
        };
        for &t in args {
            self.of_sort(at, t, sort)?;
        }
        Ok(width)
    }

    /// Bit-vectors in order.
    pub(super) fn bv_compare(
        &mut self,
        at: usize,
        signed: bool,
        compare: Compare,
        args: &[Term],
    ) -> Result<Term, Trouble> {
        self.same_width(at, args)?;
        let le = if signed { Terms::bv_sle } else { Terms::bv_ule };
        Ok(chain(self.terms(), compare, args, le))
    }

    /// A function from bit-vectors of one width to one.
    pub(super) fn bits(&mut self, at: usize, bits: Bits, args: &[Term]) -> Result<Term, Trouble> {
        let width = self.same_width(at, args)?;
        let terms = self.terms();
        match bits {
            Bits::Not => {
                let [t] = arity(at, args)?;
                Ok(complement(terms, t, width))
            }
            Bits::Neg => {
                let [t] = arity(at, args)?;
                Ok(terms.bv_neg(t))
            }
            // These may have more than two.
            Bits::Add => Ok(args[1..].iter().fold(args[0], |sum, &t| terms.bv_add(sum, t))),
            Bits::Mul => Ok(args[1..].iter().fold(args[0], |product, &t| terms.bv_mul(product, t))),
            Bits::And | Bits::Or | Bits::Xor => {
                let mut result = args[0];
                for &t in &args[1..] {
                    self.check_room(at, 0)?;
                    result = bitwise(self.terms(), bits, result, t, width);
                }
                Ok(result)
            }
            Bits::Sub => {
                let [a, b] = arity(at, args)?;
                let b = terms.bv_neg(b);
                Ok(terms.bv_add(a, b))
            }
            Bits::Nand | Bits::Nor | Bits::Xnor => {
                let [a, b] = arity(at, args)?;
                Ok(bitwise(terms, bits, a, b, width))
            }
            Bits::Shl | Bits::Lshr | Bits::Ashr => {
                let [a, b] = arity(at, args)?;
                let Some(by) = terms.value(b).and_then(Value::as_unsigned) else {
                    return Err(Trouble::unsupported(at, "a shift by a variable"));
                };
                Ok(shifted(terms, bits, a, by, width))
            }
        }
    }

    /// `concat` and `repeat`.
    pub(super) fn joined(&mut self, at: usize, operator: Operator, args: &[Term]) -> Result<Term, Trouble> {
        let repeated;
        let parts = match operator {
            Operator::Repeat(times) => {
                let [t] = arity(at, args)?;
                repeated = vec![t; times.min(129) as usize];
                &repeated[..]
            }
            _ => args,
        };
        let (first, rest) = parts.split_first().ok_or_else(|| Trouble::syntax(at, "repeat of nothing"))?;
        let (mut joined, mut width) = (*first, self.same_width(at, &[*first])?);
        for &t in rest {
            let more = self.same_width(at, &[t])?;
            if width + more > 128 {
                return Err(Trouble::unsupported(at, "a bit-vector of more than 128 bits"));
            }
            joined = concatenated(self.terms(), (joined, width), (t, more));
            width += more;
        }
        Ok(joined)
    }

    /// Functions that do nothing but move bits.
    pub(super) fn rewired(&mut self, at: usize, operator: Operator, t: Term) -> Result<Term, Trouble> {
        let width = self.same_width(at, &[t])?;
        let fits = |by: u32| match by.checked_add(width) {
            Some(..=128) => Ok(by),
            _ => Err(Trouble::unsupported(at, "a bit-vector of more than 128 bits")),
        };
        let terms = self.terms();
        match operator {
            Operator::ZeroExtend(by) => Ok(terms.zero_extend(t, fits(by)?)),
            Operator::SignExtend(by) => Ok(terms.sign_extend(t, fits(by)?)),
            Operator::RotateLeft(by) => Ok(rotated(terms, t, by % width, width)),
            Operator::RotateRight(by) => Ok(rotated(terms, t, (width - by % width) % width, width)),
            Operator::Extract(hi, lo) if lo <= hi && hi < width => Ok(terms.extract(t, hi, lo)),
            _ => Err(Trouble::syntax(at, format!("there are no such bits in {width}"))),
        }
    }
}

fn complement(terms: &mut Terms, t: Term, width: u32) -> Term {
    // -t - 1
    let (negated, ones) = (terms.bv_neg(t), terms.bv(-1, width));
    terms.bv_add(negated, ones)
}

/// Bit by bit.
fn bitwise(terms: &mut Terms, bits: Bits, a: Term, b: Term, width: u32) -> Term {
    let (one, zero) = (terms.bv(1, 1), terms.bv(0, width));
    let mut sum = zero;
    for i in 0..width {
        let [x, y] = [a, b].map(|t| {
            let bit = terms.extract(t, i, i);
            terms.eq(bit, one)
        });
        let set = match bits {
            Bits::Or => terms.or2(x, y),
            Bits::Xor => terms.xor(x, y),
            Bits::Nand => !terms.and2(x, y),
            Bits::Nor => !terms.or2(x, y),
            Bits::Xnor => terms.iff(x, y),
            _ => terms.and2(x, y),
        };
        let place = terms.constant(Value::Bv { width, bits: 1 << i });
        let part = terms.ite(set, place, zero);
        sum = terms.bv_add(sum, part);
    }
    sum
}

fn shifted(terms: &mut Terms, bits: Bits, t: Term, by: u128, width: u32) -> Term {
    let by = u32::try_from(by).unwrap_or(width).min(width);
    match bits {
        Bits::Ashr => {
            let by = by.min(width - 1);
            let high = terms.extract(t, width - 1, by);
            terms.sign_extend(high, by)
        }
        _ if by == width => terms.bv(0, width),
        Bits::Lshr => {
            let high = terms.extract(t, width - 1, by);
            terms.zero_extend(high, by)
        }
        _ => {
            let factor = terms.constant(Value::Bv { width, bits: 1 << by & mask(width) });
            terms.bv_mul(t, factor)
        }
    }
}

/// High bits before low ones, each with their number.
fn concatenated(terms: &mut Terms, high: (Term, u32), low: (Term, u32)) -> Term {
    let width = high.1 + low.1;
    let (wide, low_wide) = (terms.zero_extend(high.0, low.1), terms.zero_extend(low.0, high.1));
    let moved = shifted(terms, Bits::Shl, wide, u128::from(low.1), width);
    terms.bv_add(moved, low_wide)
}

fn rotated(terms: &mut Terms, t: Term, left: u32, width: u32) -> Term {
    if left == 0 {
        return t;
    }
    let (high, low) = (terms.extract(t, width - left - 1, 0), terms.extract(t, width - 1, width - left));
    concatenated(terms, (high, width - left), (low, left))
}
