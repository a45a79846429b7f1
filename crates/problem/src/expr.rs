//! Typed expressions, over the state of one system or over the paths of an objective.

use crate::ids::{ActionId, LabelId, PathId, VarId};
use rustc_hash::FxHashSet;
use std::sync::Arc;

/// The type of a state variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    /// `bool`
    Bool,
    /// Integers, both ends included; `lo <= hi`.
    Range {
        /// Least value.
        lo: i64,
        /// Greatest value.
        hi: i64,
    },
    /// An enumeration, its values in order of declaration.
    Enum(Arc<[String]>),
}

/// A value of a variable or expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Value {
    /// A truth value.
    Bool(bool),
    /// An integer.
    Int(i64),
    /// An enumeration value, by position in its [`Type::Enum`].
    Enum(u32),
}

/// One value for each variable of a system.
pub type State = Box<[Value]>;

/// What an expression over one system's state reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Leaf {
    /// A state variable.
    Var(VarId),
    /// Whether a label holds.
    Label(LabelId),
}

/// What an atom of an objective reads, now.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PathLeaf {
    /// A variable or label of the state where the path is.
    State(PathId, Leaf),
    /// Whether the action that the path has just taken is this one (never at time 0).
    Took(PathId, ActionId),
    /// Whether both paths have just taken the same action, by name; true at time 0, where neither took one.
    SameAction(PathId, PathId),
    /// Whether both are in the same state (two paths of one system).
    SameState(PathId, PathId),
    /// Whether the path's state has a transition with that action. The action is one of the path's system.
    Enabled(PathId, ActionId),
}

impl PathLeaf {
    /// The path or paths that it reads.
    #[must_use]
    pub fn paths(self) -> [Option<PathId>; 2] {
        match self {
            PathLeaf::State(p, _) | PathLeaf::Took(p, _) | PathLeaf::Enabled(p, _) => [Some(p), None],
            PathLeaf::SameAction(p, q) | PathLeaf::SameState(p, q) => [Some(p), Some(q)],
        }
    }
}

/// Comparison of two values of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// Equality: both integers, or both of one enumeration.
    Eq,
    /// Less, on integers.
    Lt,
    /// Less or equal, on integers.
    Le,
}

/// The tuples of a set such as `{(0, 0), (3, 4)}`; a map's obstacles and cells are such sets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TupleSet {
    /// All tuples, sorted, without repetition, of equal length.
    pub tuples: Vec<Box<[i64]>>,
    index: FxHashSet<Box<[i64]>>,
}

impl TupleSet {
    /// The set of these tuples.
    #[must_use]
    pub fn new(mut tuples: Vec<Box<[i64]>>) -> Self {
        tuples.sort_unstable();
        tuples.dedup();
        let index = tuples.iter().cloned().collect();
        TupleSet { tuples, index }
    }

    /// Whether the tuple is in the set.
    #[must_use]
    pub fn contains(&self, tuple: &[i64]) -> bool {
        self.index.contains(tuple)
    }
}

/// A well-typed expression with leaves `L`. Integers are mathematical: the bounds of every subexpression were
/// computed when it was built and fit in 62 bits, so no evaluation overflows.
#[derive(Clone, Debug, PartialEq)]
pub enum Expr<L> {
    /// A constant.
    Const(Value),
    /// Something read from a state or path.
    Leaf(L),
    /// Negation.
    Not(Box<Expr<L>>),
    /// Conjunction; true when empty.
    And(Vec<Expr<L>>),
    /// Disjunction; false when empty.
    Or(Vec<Expr<L>>),
    /// Equivalence of two Booleans.
    Iff(Box<Expr<L>>, Box<Expr<L>>),
    /// Comparison of two integers, or equality of two enumeration values.
    Compare(Comparison, Box<Expr<L>>, Box<Expr<L>>),
    /// Sum of integers; 0 when empty.
    Add(Vec<Expr<L>>),
    /// Product of an integer and a constant.
    Mul(i64, Box<Expr<L>>),
    /// Integer quotient by a positive constant, rounded down (SMT-LIB `div`).
    Div(Box<Expr<L>>, i64),
    /// Remainder of [`Expr::Div`], never negative (SMT-LIB `mod`).
    Mod(Box<Expr<L>>, i64),
    /// Choice between two expressions of one type; the first is Boolean.
    If(Box<Expr<L>>, Box<Expr<L>>, Box<Expr<L>>),
    /// Membership of a tuple of integers.
    Member(Vec<Expr<L>>, Arc<TupleSet>),
}

impl<L> Expr<L> {
    /// `true`.
    pub const TRUE: Expr<L> = Expr::Const(Value::Bool(true));
    /// `false`.
    pub const FALSE: Expr<L> = Expr::Const(Value::Bool(false));

    /// Whether it is the constant `true`.
    #[must_use]
    pub fn is_true(&self) -> bool {
        matches!(self, Expr::Const(Value::Bool(true)))
    }

    /// Whether it is the constant `false`.
    #[must_use]
    pub fn is_false(&self) -> bool {
        matches!(self, Expr::Const(Value::Bool(false)))
    }

    /// Direct subexpressions.
    #[must_use]
    pub fn children(&self) -> Vec<&Expr<L>> {
        match self {
            Expr::Const(_) | Expr::Leaf(_) => Vec::new(),
            Expr::Not(a) | Expr::Mul(_, a) | Expr::Div(a, _) | Expr::Mod(a, _) => vec![a],
            Expr::And(es) | Expr::Or(es) | Expr::Add(es) | Expr::Member(es, _) => es.iter().collect(),
            Expr::Iff(a, b) | Expr::Compare(_, a, b) => vec![a, b],
            Expr::If(a, b, c) => vec![a, b, c],
        }
    }

    /// Calls `f` on every leaf.
    pub fn for_each_leaf(&self, f: &mut impl FnMut(&L)) {
        if let Expr::Leaf(leaf) = self {
            f(leaf);
        }
        for child in self.children() {
            child.for_each_leaf(f);
        }
    }

    /// The same expression over other leaves.
    pub fn map<M>(&self, f: &mut impl FnMut(&L) -> M) -> Expr<M> {
        let mut many = |es: &[Expr<L>]| es.iter().map(|e| e.map(f)).collect::<Vec<_>>();
        match self {
            Expr::Const(v) => Expr::Const(*v),
            Expr::And(es) => Expr::And(many(es)),
            Expr::Or(es) => Expr::Or(many(es)),
            Expr::Add(es) => Expr::Add(many(es)),
            Expr::Member(es, set) => Expr::Member(many(es), set.clone()),
            Expr::Leaf(leaf) => Expr::Leaf(f(leaf)),
            Expr::Not(a) => Expr::Not(Box::new(a.map(f))),
            Expr::Mul(c, a) => Expr::Mul(*c, Box::new(a.map(f))),
            Expr::Div(a, c) => Expr::Div(Box::new(a.map(f)), *c),
            Expr::Mod(a, c) => Expr::Mod(Box::new(a.map(f)), *c),
            Expr::Iff(a, b) => Expr::Iff(Box::new(a.map(f)), Box::new(b.map(f))),
            Expr::Compare(op, a, b) => Expr::Compare(*op, Box::new(a.map(f)), Box::new(b.map(f))),
            Expr::If(a, b, c) => Expr::If(Box::new(a.map(f)), Box::new(b.map(f)), Box::new(c.map(f))),
        }
    }
}
