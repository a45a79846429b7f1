//! Typed expressions, over the state of one system or over the paths of an objective.

use crate::ids::{ActionId, AttributeId, LabelId, PathId, VarId};
use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul};
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
    /// `int`: all integers
    Int,
    /// `real`: all real numbers
    Real,
}

impl Type {
    /// Whether the type has finitely many values.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        match self {
            Type::Bool | Type::Range { .. } | Type::Enum(_) => true,
            Type::Int | Type::Real => false,
        }
    }

    /// Whether the value is one of the type.
    #[must_use]
    pub fn contains(&self, value: Value) -> bool {
        match (self, value) {
            (Type::Bool, Value::Bool(_)) | (Type::Int, Value::Int(_)) | (Type::Real, Value::Real(_)) => true,
            (Type::Range { lo, hi }, Value::Int(n)) => (*lo..=*hi).contains(&n),
            (Type::Enum(names), Value::Enum(i)) => (i as usize) < names.len(),
            _ => false,
        }
    }
}

/// An exact fraction of 64-bit integers. What does not fit is reported, never rounded.
pub type Rational = Ratio<i64>;

/// A value of a variable or expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Value {
    /// A truth value.
    Bool(bool),
    /// An integer.
    Int(i64),
    /// An enumeration value, by position in its [`Type::Enum`].
    Enum(u32),
    /// A real number, as far as it is a fraction.
    Real(Rational),
}

impl Value {
    /// A real number; `None` for the one numerator of 64 bits that has no negative, so that fractions can be turned
    /// around and over without a thought.
    #[must_use]
    pub fn real(value: Rational) -> Option<Value> {
        (*value.numer() != i64::MIN).then_some(Value::Real(value))
    }

    /// The sum of two numbers of one type; `None` where it does not fit.
    #[must_use]
    pub fn checked_add(self, other: Value) -> Option<Value> {
        match (self, other) {
            (Value::Int(a), Value::Int(b)) => a.checked_add(b).map(Value::Int),
            (Value::Real(a), Value::Real(b)) => a.checked_add(&b).and_then(Value::real),
            _ => None,
        }
    }

    /// The product of two numbers of one type; `None` where it does not fit.
    #[must_use]
    pub fn checked_mul(self, other: Value) -> Option<Value> {
        match (self, other) {
            (Value::Int(a), Value::Int(b)) => a.checked_mul(b).map(Value::Int),
            (Value::Real(a), Value::Real(b)) => a.checked_mul(&b).and_then(Value::real),
            _ => None,
        }
    }
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

/// What an expression over one step of a system reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StepLeaf {
    /// Of the state before the step.
    State(Leaf),
    /// Whether the step takes this action.
    Took(ActionId),
    /// A number of the listed transition that the step follows; 0 where it follows none.
    Attribute(AttributeId),
}

/// What an expression over the states before and after a step reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TransLeaf {
    /// In the state before it.
    Before(Leaf),
    /// In the state after it.
    After(Leaf),
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
    /// Whether every transition of the path's state leads back to it, a state without transitions included. It is
    /// not written but comes from `semantics hpes | hopt`.
    Halted(PathId),
}

impl PathLeaf {
    /// The path or paths that it reads.
    #[must_use]
    pub fn paths(self) -> [Option<PathId>; 2] {
        match self {
            PathLeaf::State(p, _) | PathLeaf::Took(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
                [Some(p), None]
            }
            PathLeaf::SameAction(p, q) | PathLeaf::SameState(p, q) => [Some(p), Some(q)],
        }
    }
}

/// Comparison of two values of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// Equality: both integers, both reals, or both of one enumeration.
    Eq,
    /// Less, on integers or reals.
    Lt,
    /// Less or equal, on integers or reals.
    Le,
}

impl Comparison {
    /// Whether it holds between two values of one type.
    #[must_use]
    pub fn holds(self, a: Value, b: Value) -> bool {
        match self {
            Comparison::Eq => a == b,
            Comparison::Lt => a < b,
            Comparison::Le => a <= b,
        }
    }
}

/// The tuples of a set such as `{(0, 0), (3, 4)}`; a map's obstacles and cells are such sets. An enumeration value
/// stands in it by its position.
#[derive(Clone, Debug, Default)]
pub struct TupleSet {
    /// All tuples, sorted, without repetition, of equal length.
    pub tuples: Vec<Box<[i64]>>,
    index: FxHashSet<Box<[i64]>>,
}

/// The index says the same once more.
impl PartialEq for TupleSet {
    fn eq(&self, other: &Self) -> bool {
        self.tuples == other.tuples
    }
}

impl Eq for TupleSet {}

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

/// A well-typed expression with leaves `L`. Integers are mathematical: where no variable of type `int` is read, the
/// bounds of every subexpression were computed when it was built and fit in 62 bits, so that no evaluation
/// overflows. Reals occur only where a variable of type `real` is read or assigned: other comparisons of fractions
/// were turned into comparisons of integers.
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
    /// Comparison of two integers or two reals, or equality of two enumeration values.
    Compare(Comparison, Box<Expr<L>>, Box<Expr<L>>),
    /// Sum of integers or of reals; never empty.
    Add(Vec<Expr<L>>),
    /// Product of an integer and a constant.
    Mul(i64, Box<Expr<L>>),
    /// Product of a real and a constant.
    Scale(Rational, Box<Expr<L>>),
    /// An integer as a real.
    ToReal(Box<Expr<L>>),
    /// Integer quotient by a positive constant, rounded down (SMT-LIB `div`).
    Div(Box<Expr<L>>, i64),
    /// Remainder of [`Expr::Div`], never negative (SMT-LIB `mod`).
    Mod(Box<Expr<L>>, i64),
    /// The value beside the first condition that holds, the last where none does; all values are of one type. A chain
    /// is flat, however long it is: the last value is never such a choice itself.
    If(Vec<(Expr<L>, Expr<L>)>, Box<Expr<L>>),
    /// Membership of a tuple of integers and enumeration values.
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

    /// The value beside the first condition that holds, or the last one; all of one type.
    #[must_use]
    pub fn choice(branches: impl IntoIterator<Item = (Expr<L>, Expr<L>)>, mut last: Expr<L>) -> Expr<L> {
        let mut kept = Vec::new();
        for (condition, value) in branches {
            if condition.is_true() {
                last = value;
                break;
            }
            if !condition.is_false() {
                kept.push((condition, value));
            }
        }
        match last {
            last if kept.is_empty() => last,
            Expr::If(more, end) => {
                kept.extend(more);
                Expr::If(kept, end)
            }
            last => Expr::If(kept, Box::new(last)),
        }
    }

    /// Direct subexpressions.
    #[must_use]
    pub fn children(&self) -> Vec<&Expr<L>> {
        match self {
            Expr::Const(_) | Expr::Leaf(_) => Vec::new(),
            Expr::Not(a)
            | Expr::Mul(_, a)
            | Expr::Scale(_, a)
            | Expr::ToReal(a)
            | Expr::Div(a, _)
            | Expr::Mod(a, _) => vec![a],
            Expr::And(es) | Expr::Or(es) | Expr::Add(es) | Expr::Member(es, _) => es.iter().collect(),
            Expr::Iff(a, b) | Expr::Compare(_, a, b) => vec![a, b],
            Expr::If(branches, last) => branches.iter().flat_map(|(c, a)| [c, a]).chain([&**last]).collect(),
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
        self.substitute(&mut |leaf| Expr::Leaf(f(leaf)))
    }

    /// The expression with others in the places of its leaves.
    pub fn substitute<M>(&self, f: &mut impl FnMut(&L) -> Expr<M>) -> Expr<M> {
        let mut many = |es: &[Expr<L>]| es.iter().map(|e| e.substitute(f)).collect::<Vec<_>>();
        match self {
            Expr::Const(v) => Expr::Const(*v),
            Expr::And(es) => Expr::And(many(es)),
            Expr::Or(es) => Expr::Or(many(es)),
            Expr::Add(es) => Expr::Add(many(es)),
            Expr::Member(es, set) => Expr::Member(many(es), set.clone()),
            Expr::Leaf(leaf) => f(leaf),
            Expr::Not(a) => Expr::Not(Box::new(a.substitute(f))),
            Expr::Mul(c, a) => Expr::Mul(*c, Box::new(a.substitute(f))),
            Expr::Scale(c, a) => Expr::Scale(*c, Box::new(a.substitute(f))),
            Expr::ToReal(a) => Expr::ToReal(Box::new(a.substitute(f))),
            Expr::Div(a, c) => Expr::Div(Box::new(a.substitute(f)), *c),
            Expr::Mod(a, c) => Expr::Mod(Box::new(a.substitute(f)), *c),
            Expr::Iff(a, b) => Expr::Iff(Box::new(a.substitute(f)), Box::new(b.substitute(f))),
            Expr::Compare(op, a, b) => {
                Expr::Compare(*op, Box::new(a.substitute(f)), Box::new(b.substitute(f)))
            }
            Expr::If(branches, last) => {
                let branches = branches.iter().map(|(c, a)| (c.substitute(f), a.substitute(f))).collect();
                Expr::If(branches, Box::new(last.substitute(f)))
            }
        }
    }

    /// The value, given that of each leaf; `None` where a leaf that matters has none, or a number does not fit.
    /// A false conjunct and a true disjunct decide whatever the others are.
    pub fn evaluate(&self, leaf: &mut impl FnMut(&L) -> Option<Value>) -> Option<Value> {
        match self {
            Expr::Const(value) => Some(*value),
            Expr::Leaf(l) => leaf(l),
            Expr::Not(a) => a.truth(leaf).map(|a| Value::Bool(!a)),
            Expr::And(es) => junction(es, false, leaf).map(Value::Bool),
            Expr::Or(es) => junction(es, true, leaf).map(Value::Bool),
            Expr::Iff(a, b) => Some(Value::Bool(a.truth(leaf)? == b.truth(leaf)?)),
            Expr::Compare(op, a, b) => Some(Value::Bool(op.holds(a.evaluate(leaf)?, b.evaluate(leaf)?))),
            Expr::Add(es) => {
                let (first, rest) = es.split_first()?;
                let first = first.evaluate(leaf)?;
                rest.iter().try_fold(first, |sum, e| sum.checked_add(e.evaluate(leaf)?))
            }
            Expr::Mul(c, a) => Value::Int(*c).checked_mul(a.evaluate(leaf)?),
            Expr::Scale(c, a) => Value::Real(*c).checked_mul(a.evaluate(leaf)?),
            Expr::ToReal(a) => a.integer(leaf).and_then(|n| Value::real(Rational::from(n))),
            Expr::Div(a, c) => a.integer(leaf)?.checked_div_euclid(*c).map(Value::Int),
            Expr::Mod(a, c) => a.integer(leaf)?.checked_rem_euclid(*c).map(Value::Int),
            Expr::If(branches, last) => {
                for (condition, value) in branches {
                    if condition.truth(leaf)? {
                        return value.evaluate(leaf);
                    }
                }
                last.evaluate(leaf)
            }
            Expr::Member(es, set) => {
                let mut position = |e: &Expr<L>| match e.evaluate(leaf)? {
                    Value::Int(n) => Some(n),
                    Value::Enum(position) => Some(i64::from(position)),
                    Value::Bool(_) | Value::Real(_) => None,
                };
                let tuple: Vec<i64> = es.iter().map(&mut position).collect::<Option<_>>()?;
                Some(Value::Bool(set.contains(&tuple)))
            }
        }
    }

    /// The truth value of a Boolean expression; see [`Expr::evaluate`].
    pub fn truth(&self, leaf: &mut impl FnMut(&L) -> Option<Value>) -> Option<bool> {
        match self.evaluate(leaf)? {
            Value::Bool(b) => Some(b),
            Value::Int(_) | Value::Enum(_) | Value::Real(_) => None,
        }
    }

    fn integer(&self, leaf: &mut impl FnMut(&L) -> Option<Value>) -> Option<i64> {
        match self.evaluate(leaf)? {
            Value::Int(n) => Some(n),
            Value::Bool(_) | Value::Enum(_) | Value::Real(_) => None,
        }
    }
}

impl Expr<StepLeaf> {
    /// What the expression says of steps with that action and these numbers, of the state before.
    #[must_use]
    pub fn of_state(&self, action: ActionId, number: &dyn Fn(AttributeId) -> Expr<Leaf>) -> Expr<Leaf> {
        self.substitute(&mut |leaf| match *leaf {
            StepLeaf::State(leaf) => Expr::Leaf(leaf),
            StepLeaf::Took(taken) => Expr::Const(Value::Bool(taken == action)),
            StepLeaf::Attribute(attribute) => number(attribute),
        })
    }
}

/// A disjunction (`winner` true) or conjunction (`winner` false) of which some parts may have no value.
fn junction<L>(es: &[Expr<L>], winner: bool, leaf: &mut impl FnMut(&L) -> Option<Value>) -> Option<bool> {
    let mut unknown = false;
    for e in es {
        match e.truth(leaf) {
            Some(b) if b == winner => return Some(winner),
            Some(_) => {}
            None => unknown = true,
        }
    }
    if unknown { None } else { Some(!winner) }
}
