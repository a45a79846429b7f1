//! HyperLTLf objectives, resolved and typed.

use crate::expr::{Expr, PathLeaf};
use crate::ids::{FormulaId, PathId, SystemId};
use hyperplan_syntax::Span;
use typed_index_collections::TiVec;

/// `exists` or `forall`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantifier {
    /// There is a path.
    Exists,
    /// For all paths.
    Forall,
}

impl Quantifier {
    /// The other one.
    #[must_use]
    pub fn dual(self) -> Self {
        match self {
            Quantifier::Exists => Quantifier::Forall,
            Quantifier::Forall => Quantifier::Exists,
        }
    }
}

/// A quantified path variable.
#[derive(Clone, Debug)]
pub struct PathVar {
    /// Its name.
    pub name: String,
    /// How it is quantified.
    pub quantifier: Quantifier,
    /// The system whose path it is.
    pub system: SystemId,
    /// Its place in the quantifier prefix.
    pub span: Span,
}

/// How operators are read (`design` of the language: "Objectives").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Without `within`: paths are infinite, every operator is bounded.
    Bounded,
    /// `within K`: every path has exactly this many steps, whatever may follow; positions are `0..=K`.
    Within(u32),
}

/// How a path of K steps stands for the infinite ones that it begins (`within K semantics S`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Semantics {
    /// `pes`: nothing holds beyond K.
    Pessimistic,
    /// `opt`: everything holds beyond K.
    Optimistic,
    /// `hpes`: as `pes`, but the rest is known once every path has halted.
    HaltingPessimistic,
    /// `hopt`: as `opt`, but the rest is known once every path has halted.
    HaltingOptimistic,
}

impl Semantics {
    /// All of them.
    pub const ALL: [Semantics; 4] = [
        Semantics::Pessimistic,
        Semantics::Optimistic,
        Semantics::HaltingPessimistic,
        Semantics::HaltingOptimistic,
    ];

    /// Its name in problem files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Semantics::Pessimistic => "pes",
            Semantics::Optimistic => "opt",
            Semantics::HaltingPessimistic => "hpes",
            Semantics::HaltingOptimistic => "hopt",
        }
    }

    /// The one with that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Semantics> {
        Semantics::ALL.into_iter().find(|s| s.name() == name)
    }
}

/// An objective: a quantifier prefix and a formula.
#[derive(Clone, Debug)]
pub struct Objective {
    /// Its name.
    pub name: String,
    /// Path variables, outermost first; never empty.
    pub paths: TiVec<PathId, PathVar>,
    /// How operators are read.
    pub mode: Mode,
    /// What `semantics` says, under [`Mode::Within`] only.
    pub semantics: Option<Semantics>,
    /// The quantifier-free rest, to be read as the mode says: it was translated where there are other semantics.
    pub formula: Formula,
    /// Its declaration.
    pub span: Span,
}

impl Objective {
    /// The path variables of the leading block: those before the first change of quantifier.
    #[must_use]
    pub fn leading_block(&self) -> Vec<PathId> {
        let first = self.paths.first().map(|p| p.quantifier);
        self.paths
            .iter_enumerated()
            .take_while(|(_, p)| Some(p.quantifier) == first)
            .map(|(id, _)| id)
            .collect()
    }

    /// The path variable with that name.
    #[must_use]
    pub fn path(&self, name: &str) -> Option<PathId> {
        self.paths.iter_enumerated().find(|(_, p)| p.name == name).map(|(id, _)| id)
    }
}

/// A formula as a flat arena: children before parents, so that every pass is a loop.
#[derive(Clone, Debug, Default)]
pub struct Formula {
    /// The nodes.
    pub nodes: TiVec<FormulaId, Node>,
    /// Where each node is written; a part that came with a template lies in the template's text.
    pub spans: TiVec<FormulaId, Span>,
}

impl Formula {
    /// The whole formula: the last node.
    ///
    /// # Panics
    /// If there is no node, which no lowered objective has.
    #[must_use]
    pub fn root(&self) -> FormulaId {
        self.nodes.last_key().expect("a formula has a node")
    }

    /// Adds a node whose children are there already.
    pub fn push(&mut self, node: Node, span: Span) -> FormulaId {
        self.spans.push(span);
        self.nodes.push_and_get_key(node)
    }
}

/// `[lo, hi]` in steps from now; `hi` is `None` for no bound (only under [`Mode::Within`]). `lo <= hi`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Interval {
    /// First step.
    pub lo: u32,
    /// Last step.
    pub hi: Option<u32>,
}

/// Temporal operators with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TemporalOp {
    /// `lhs U rhs`: rhs at some step of the interval, lhs at every step (from now) before it.
    Until,
    /// `lhs R rhs`: the dual, `!(!lhs U !rhs)`.
    Release,
    /// `lhs W rhs`: `(lhs U[a,b] rhs) | G[0,b] lhs`.
    WeakUntil,
}

/// A node of a formula.
#[derive(Clone, Debug)]
pub enum Node {
    /// A Boolean expression over what the paths are and did now; constants too.
    Atom(Expr<PathLeaf>),
    /// Negation.
    Not(FormulaId),
    /// Conjunction.
    And(Vec<FormulaId>),
    /// Disjunction.
    Or(Vec<FormulaId>),
    /// Implication.
    Implies(FormulaId, FormulaId),
    /// Equivalence.
    Iff(FormulaId, FormulaId),
    /// Strong next: there is a next position and it holds there.
    Next(FormulaId),
    /// Weak next: if there is a next position it holds there.
    WeakNext(FormulaId),
    /// At some step of the interval.
    Finally(Interval, FormulaId),
    /// At every step of the interval.
    Globally(Interval, FormulaId),
    /// `U R W`
    Temporal(TemporalOp, Interval, FormulaId, FormulaId),
}

impl Node {
    /// Direct children.
    #[must_use]
    pub fn children(&self) -> Vec<FormulaId> {
        match self {
            Node::Atom(_) => Vec::new(),
            Node::Not(a) | Node::Next(a) | Node::WeakNext(a) | Node::Finally(_, a) | Node::Globally(_, a) => {
                vec![*a]
            }
            Node::And(xs) | Node::Or(xs) => xs.clone(),
            Node::Implies(a, b) | Node::Iff(a, b) | Node::Temporal(_, _, a, b) => vec![*a, *b],
        }
    }

    /// The same node over other children.
    #[must_use]
    pub fn map_children(&self, f: impl Fn(FormulaId) -> FormulaId) -> Node {
        let all = |ids: &[FormulaId]| ids.iter().map(|&id| f(id)).collect();
        match self {
            Node::Atom(e) => Node::Atom(e.clone()),
            Node::Not(a) => Node::Not(f(*a)),
            Node::And(ids) => Node::And(all(ids)),
            Node::Or(ids) => Node::Or(all(ids)),
            Node::Implies(a, b) => Node::Implies(f(*a), f(*b)),
            Node::Iff(a, b) => Node::Iff(f(*a), f(*b)),
            Node::Next(a) => Node::Next(f(*a)),
            Node::WeakNext(a) => Node::WeakNext(f(*a)),
            Node::Finally(i, a) => Node::Finally(*i, f(*a)),
            Node::Globally(i, a) => Node::Globally(*i, f(*a)),
            Node::Temporal(op, i, a, b) => Node::Temporal(*op, *i, f(*a), f(*b)),
        }
    }
}
