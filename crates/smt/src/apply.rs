//! What operators make of values: how constants are folded, and terms evaluated.

use crate::rational::Rational;
use crate::term::{Op, Sort};
use crate::value::{Value, mask, signed};

/// The operator on values; `numbers` are its indices, such as the bits of an extraction. `None`
/// where the result does not fit into 128 bits, and for leaves, declared functions and quantifiers.
pub(crate) fn apply(op: Op, sort: Sort, args: &[Value], numbers: &[u32]) -> Option<Value> {
    match op {
        Op::True | Op::Symbol | Op::Bound | Op::Const | Op::Apply | Op::Forall => None,
        Op::And => args.iter().try_fold(true, |all, v| Some(all & v.as_bool()?)).map(Value::Bool),
        Op::Eq => Some(Value::Bool(args[0] == args[1])),
        Op::Ite => Some(if args[0].as_bool()? { args[1] } else { args[2] }),
        Op::BvAdd | Op::BvMul | Op::BvNeg | Op::SignExtend | Op::ZeroExtend | Op::Extract => {
            apply_bv(op, sort, args, numbers)
        }
        Op::BvUlt => Some(Value::Bool(args[0].as_unsigned()? < args[1].as_unsigned()?)),
        Op::BvSlt => Some(Value::Bool(args[0].as_signed()? < args[1].as_signed()?)),
        Op::Add => args[1..].iter().try_fold(args[0], |sum, &v| add(sum, v)),
        Op::Mul => match (args[0], args[1]) {
            (Value::Int(a), Value::Int(b)) => Some(Value::Int(a.checked_mul(b)?)),
            (Value::Real(a), Value::Real(b)) => Some(Value::Real(a.checked_mul(b)?)),
            _ => None,
        },
        Op::Le => match (args[0], args[1]) {
            (Value::Int(a), Value::Int(b)) => Some(Value::Bool(a <= b)),
            (Value::Real(a), Value::Real(b)) => Some(Value::Bool(a <= b)),
            _ => None,
        },
        // The divisor is positive: Euclidean division is SMT-LIB's.
        Op::IntDiv => Some(Value::Int(args[0].as_signed()?.checked_div_euclid(args[1].as_signed()?)?)),
        Op::ToReal => Some(Value::Real(Rational::new(args[0].as_signed()?, 1)?)),
        Op::IntMod => Some(Value::Int(args[0].as_signed()?.checked_rem_euclid(args[1].as_signed()?)?)),
    }
}

fn apply_bv(op: Op, sort: Sort, args: &[Value], numbers: &[u32]) -> Option<Value> {
    let Sort::BitVec(width) = sort else { return None };
    let Value::Bv { width: from, bits } = args[0] else { return None };
    let bits = match op {
        Op::BvAdd => bits.wrapping_add(args[1].as_unsigned()?),
        Op::BvMul => bits.wrapping_mul(args[1].as_unsigned()?),
        Op::BvNeg => bits.wrapping_neg(),
        Op::SignExtend => signed(bits, from) as u128,
        Op::ZeroExtend => bits,
        Op::Extract => bits >> numbers.get(1)?,
        _ => return None,
    };
    Some(Value::Bv { width, bits: bits & mask(width) })
}

fn add(a: Value, b: Value) -> Option<Value> {
    match (a, b) {
        (Value::Int(a), Value::Int(b)) => Some(Value::Int(a.checked_add(b)?)),
        (Value::Real(a), Value::Real(b)) => Some(Value::Real(a.checked_add(b)?)),
        _ => None,
    }
}
