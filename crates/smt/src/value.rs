//! Values of terms, and models.

use std::fmt;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::rational::Rational;
use crate::term::{Enumeration, Function, Sort, Term};

/// The value of a term.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub enum Value {
    /// A truth value.
    Bool(bool),
    /// A bit-vector; the bits above the width are zero.
    Bv {
        /// The number of bits, at most 128.
        width: u32,
        /// The bits, read as an unsigned number.
        bits: u128,
    },
    /// An integer.
    Int(i128),
    /// A rational number.
    Real(Rational),
    /// A constructor of an enumeration, by its position.
    Enum(Enumeration, u32),
}

impl Value {
    /// A bit-vector: `value` in two's complement, cut to `width` bits.
    #[must_use]
    pub fn bv(value: i128, width: u32) -> Value {
        Value::Bv { width, bits: (value as u128) & mask(width) }
    }

    /// Its sort.
    #[must_use]
    pub fn sort(self) -> Sort {
        match self {
            Value::Bool(_) => Sort::Bool,
            Value::Bv { width, .. } => Sort::BitVec(width),
            Value::Int(_) => Sort::Int,
            Value::Real(_) => Sort::Real,
            Value::Enum(enumeration, _) => Sort::Enum(enumeration),
        }
    }

    /// False, zero, or the first constructor: what a symbol without a value is taken to be.
    #[must_use]
    pub fn default_of(sort: Sort) -> Value {
        match sort {
            Sort::Bool => Value::Bool(false),
            Sort::BitVec(width) => Value::Bv { width, bits: 0 },
            Sort::Int => Value::Int(0),
            Sort::Real => Value::Real(Rational::ZERO),
            Sort::Enum(enumeration) => Value::Enum(enumeration, 0),
        }
    }

    /// The truth value, if it is one.
    #[must_use]
    pub fn as_bool(self) -> Option<bool> {
        match self {
            Value::Bool(b) => Some(b),
            _ => None,
        }
    }

    /// The position of a constructor.
    #[must_use]
    pub fn as_constructor(self) -> Option<u32> {
        match self {
            Value::Enum(_, position) => Some(position),
            _ => None,
        }
    }

    /// A bit-vector read as an unsigned number.
    #[must_use]
    pub fn as_unsigned(self) -> Option<u128> {
        match self {
            Value::Bv { bits, .. } => Some(bits),
            _ => None,
        }
    }

    /// A bit-vector read in two's complement, or an integer.
    #[must_use]
    pub fn as_signed(self) -> Option<i128> {
        match self {
            Value::Bv { width, bits } => Some(signed(bits, width)),
            Value::Int(i) => Some(i),
            _ => None,
        }
    }
}

/// A word of ones of that width.
#[inline]
pub(crate) fn mask(width: u32) -> u128 {
    if width >= 128 { u128::MAX } else { (1 << width) - 1 }
}

/// The two's complement reading of the low `width` bits.
#[inline]
pub(crate) fn signed(bits: u128, width: u32) -> i128 {
    let shift = 128 - width;
    ((bits << shift) as i128) >> shift
}

/// What a declared function is.
pub trait Interpretation: fmt::Debug + Send + Sync {
    /// What it gives for arguments; `None` where that is not known.
    fn value(&self, args: &[Value]) -> Option<Value>;
}

/// Values of declared symbols, and what declared functions are. What has none counts as false, zero or the first
/// constructor: a model is total.
#[derive(Clone, Debug, Default)]
pub struct Model {
    values: FxHashMap<Term, Value>,
    functions: FxHashMap<Function, Arc<dyn Interpretation>>,
}

impl Model {
    /// The model in which everything is as it is without a value.
    #[must_use]
    pub fn new() -> Self {
        Model::default()
    }

    /// Sets the value of a symbol, or of a function for some arguments; of a complemented Boolean one too.
    pub fn insert(&mut self, symbol: Term, value: Value) {
        let value = match value {
            Value::Bool(b) => Value::Bool(b ^ symbol.is_negated()),
            _ => value,
        };
        self.values.insert(symbol.positive(), value);
    }

    /// The value that was set for a symbol, complemented where the handle is.
    #[must_use]
    pub fn get(&self, symbol: Term) -> Option<Value> {
        let value = *self.values.get(&symbol.positive())?;
        Some(match value {
            Value::Bool(b) => Value::Bool(b ^ symbol.is_negated()),
            _ => value,
        })
    }

    /// Says what a function is.
    pub fn define(&mut self, function: Function, meant: impl Interpretation + 'static) {
        self.functions.insert(function, Arc::new(meant));
    }

    /// What a function is, where that was said.
    #[must_use]
    pub fn function(&self, function: Function) -> Option<&dyn Interpretation> {
        self.functions.get(&function).map(|meant| &**meant)
    }

    /// The truth value of a Boolean literal or constant; a symbol without a value is false.
    #[must_use]
    pub fn is_true(&self, literal: Term) -> bool {
        if literal.is_const() {
            return literal == Term::TRUE;
        }
        self.get(literal).and_then(Value::as_bool).unwrap_or(literal.is_negated())
    }

    /// How many symbols have a value.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether no symbol has a value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

impl FromIterator<(Term, Value)> for Model {
    fn from_iter<I: IntoIterator<Item = (Term, Value)>>(values: I) -> Self {
        let mut model = Model::new();
        model.extend(values);
        model
    }
}

impl Extend<(Term, Value)> for Model {
    fn extend<I: IntoIterator<Item = (Term, Value)>>(&mut self, values: I) {
        for (symbol, value) in values {
            self.insert(symbol, value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terms::Terms;

    #[test]
    fn literals_and_constants_are_true_or_false() {
        let mut terms = Terms::new();
        let stem = terms.stem("x");
        let [a, b, absent] = [0, 1, 2].map(|time| terms.symbol(stem, Some(time), Sort::Bool));
        let mut model: Model = [(a, Value::Bool(true)), (!b, Value::Bool(true))].into_iter().collect();
        for _ in 0..2 {
            assert!(model.is_true(Term::TRUE) && model.is_true(!Term::FALSE));
            assert!(!model.is_true(Term::FALSE) && !model.is_true(!Term::TRUE));
            assert!(model.is_true(a) && !model.is_true(!a));
            assert!(!model.is_true(b) && model.is_true(!b));
            assert!(!model.is_true(absent) && model.is_true(!absent));
            // Whatever a solver says of the constants changes nothing.
            model.insert(Term::TRUE, Value::Bool(false));
        }
    }
}
