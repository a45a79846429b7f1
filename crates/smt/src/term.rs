//! Handles: terms, sorts, stems, operators.

use std::fmt;
use std::ops::Not;

/// A handle to a term in a [`Terms`](crate::Terms) arena: the index of a node, and for Boolean
/// terms a complement bit. Negation is free; non-Boolean terms are never negated.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Term(pub(crate) u32);

impl Term {
    /// The constant true.
    pub const TRUE: Term = Term(0);
    /// The constant false.
    pub const FALSE: Term = Term(1);

    /// The term of a node, unnegated.
    #[inline]
    pub(crate) fn of_index(index: usize) -> Term {
        debug_assert!(index < (1 << 31));
        Term((index as u32) << 1)
    }

    /// Whether the handle is a complement.
    #[inline]
    #[must_use]
    pub fn is_negated(self) -> bool {
        self.0 & 1 == 1
    }

    /// Whether the term is [`Term::TRUE`] or [`Term::FALSE`].
    #[inline]
    #[must_use]
    pub fn is_const(self) -> bool {
        self.0 < 2
    }

    /// The same term without its complement.
    #[inline]
    #[must_use]
    pub fn positive(self) -> Term {
        Term(self.0 & !1)
    }

    /// The term, complemented if `negate`.
    #[inline]
    #[must_use]
    pub fn negate_if(self, negate: bool) -> Term {
        Term(self.0 ^ u32::from(negate))
    }

    /// The index of the node: dense, children have smaller indices than their parents.
    #[inline]
    #[must_use]
    pub fn index(self) -> usize {
        (self.0 >> 1) as usize
    }
}

impl Not for Term {
    type Output = Term;

    #[inline]
    fn not(self) -> Term {
        Term(self.0 ^ 1)
    }
}

impl From<bool> for Term {
    fn from(value: bool) -> Term {
        if value { Term::TRUE } else { Term::FALSE }
    }
}

/// The sort of a term.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub enum Sort {
    /// Truth values.
    Bool,
    /// Bit-vectors of a width between 1 and 128.
    BitVec(u32),
    /// Mathematical integers.
    Int,
    /// Real numbers.
    Real,
    /// A datatype whose constructors are constants.
    Enum(Enumeration),
}

/// An enumeration of an arena: a datatype whose constructors are constants.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Enumeration(pub(crate) u32);

/// For messages; an enumeration has its name from the arena, which is not here.
impl fmt::Display for Sort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Sort::Bool => f.write_str("Bool"),
            Sort::BitVec(width) => write!(f, "(_ BitVec {width})"),
            Sort::Int => f.write_str("Int"),
            Sort::Real => f.write_str("Real"),
            Sort::Enum(Enumeration(number)) => write!(f, "enumeration {number}"),
        }
    }
}

/// An interned symbol stem, such as `p.x`: what a symbol is called, without its time.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Stem(pub(crate) u32);

/// A function of an arena that is not interpreted, by its number.
#[derive(Copy, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Function(pub(crate) u32);

/// The operator of a node. `or`, `xor`, `exists` and the other comparisons are complements of
/// these.
#[derive(Copy, Clone, PartialEq, Eq, Hash, Debug)]
pub enum Op {
    /// The constant true.
    True,
    /// A declared symbol.
    Symbol,
    /// A variable that a quantifier binds.
    Bound,
    /// A bit-vector, integer or rational constant, or a constructor of an enumeration.
    Const,
    /// Conjunction of two or more.
    And,
    /// Equality, of Booleans too.
    Eq,
    /// If-then-else of any sort.
    Ite,
    /// Sum modulo 2^width.
    BvAdd,
    /// Product modulo 2^width.
    BvMul,
    /// Two's complement.
    BvNeg,
    /// Unsigned less-than.
    BvUlt,
    /// Signed less-than.
    BvSlt,
    /// Widening with copies of the sign bit.
    SignExtend,
    /// Widening with zeros.
    ZeroExtend,
    /// The bits from high to low, both included.
    Extract,
    /// Sum of two or more integers or reals.
    Add,
    /// Product with a constant, which comes first.
    Mul,
    /// Less-than-or-equal on integers or reals.
    Le,
    /// Integer division by a positive constant, which comes second.
    IntDiv,
    /// Remainder, never negative, by a positive constant, which comes second.
    IntMod,
    /// An integer as a real.
    ToReal,
    /// A declared function, applied.
    Apply,
    /// Universal quantification: the bound variables, then the body.
    Forall,
}

impl Op {
    /// What the operator is called in SMT-LIB; empty for leaves and for functions, which have names of their own.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().0
    }

    /// How many words at the end of a node's arguments are numbers rather than terms
    /// (`None`: all of them).
    pub(crate) fn payload(self) -> Option<usize> {
        self.row().1
    }

    /// The one table of operators: SMT-LIB name, payload words.
    fn row(self) -> (&'static str, Option<usize>) {
        match self {
            Op::True => ("true", None),
            Op::Symbol | Op::Bound | Op::Const => ("", None),
            Op::And => ("and", Some(0)),
            Op::Eq => ("=", Some(0)),
            Op::Ite => ("ite", Some(0)),
            Op::BvAdd => ("bvadd", Some(0)),
            Op::BvMul => ("bvmul", Some(0)),
            Op::BvNeg => ("bvneg", Some(0)),
            Op::BvUlt => ("bvult", Some(0)),
            Op::BvSlt => ("bvslt", Some(0)),
            Op::SignExtend => ("sign_extend", Some(1)),
            Op::ZeroExtend => ("zero_extend", Some(1)),
            Op::Extract => ("extract", Some(2)),
            Op::Add => ("+", Some(0)),
            Op::Mul => ("*", Some(0)),
            Op::Le => ("<=", Some(0)),
            Op::IntDiv => ("div", Some(0)),
            Op::IntMod => ("mod", Some(0)),
            Op::ToReal => ("to_real", Some(0)),
            Op::Apply => ("", Some(1)),
            Op::Forall => ("forall", Some(0)),
        }
    }
}
