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

/// An objective: a quantifier prefix and a formula.
#[derive(Clone, Debug)]
pub struct Objective {
    /// Its name.
    pub name: String,
    /// Path variables, outermost first; never empty.
    pub paths: TiVec<PathId, PathVar>,
    /// How operators are read.
    pub mode: Mode,
    /// The quantifier-free rest.
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
}
