//! The core of formulas: few forms, in which everything behind lowering reads what users write.

use crate::expr::{Expr, PathLeaf};
use crate::ids::FormulaId;
use hyperplan_syntax::Span;
use hyperplan_syntax::operator::Operator;
use std::collections::BTreeSet;
use typed_index_collections::TiVec;

/// A formula as a flat arena: children before parents, so that every pass is a loop.
#[derive(Clone, Debug, Default)]
pub struct Formula {
    /// The nodes.
    pub nodes: TiVec<FormulaId, Node>,
    /// Where each node is written; a part that came with a template lies in the template's text.
    pub spans: TiVec<FormulaId, Span>,
    /// What each node is the meaning of.
    written: TiVec<FormulaId, Option<Box<Written>>>,
}

/// An operator as it was written, where the core has no form of its own for it.
#[derive(Clone, Debug)]
pub struct Written {
    /// The operator.
    pub operator: Operator,
    /// Its interval; without meaning for operators that take none.
    pub interval: Interval,
    /// What it stood before or between.
    pub operands: Vec<FormulaId>,
}

/// `[lo, hi]` in steps from now; `hi` is `None` for no bound (only under [`Mode::Within`]). `lo <= hi`.
///
/// [`Mode::Within`]: crate::Mode::Within
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Interval {
    /// First step.
    pub lo: u32,
    /// Last step.
    pub hi: Option<u32>,
}

impl Interval {
    /// Every later position, and the present one.
    pub const ALWAYS: Interval = Interval { lo: 0, hi: None };
}

/// A node of a formula.
#[derive(Clone, Debug)]
pub enum Node {
    /// A Boolean expression over what the paths are and did now; constants too.
    Atom(Expr<PathLeaf>),
    /// Negation.
    Not(FormulaId),
    /// Conjunction. The empty one is part of what an operator means and never written, unlike the constant `true`:
    /// it holds wherever it is read, even where a semantics says that no subformula does.
    And(Vec<FormulaId>),
    /// Disjunction. The empty one is the negation of the empty conjunction.
    Or(Vec<FormulaId>),
    /// Equivalence; not in terms of the others, as each operand would then occur twice.
    Iff(FormulaId, FormulaId),
    /// Strong next: there is a next position and it holds there.
    Next(FormulaId),
    /// Weak next: if there is a next position it holds there.
    WeakNext(FormulaId),
    /// The second at some step of the interval, the first at every step (from now) before it.
    Until(Interval, FormulaId, FormulaId),
    /// The dual of until: the second at every step of the interval that comes after no step (from now) of the first.
    Release(Interval, FormulaId, FormulaId),
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
        self.written.push(None);
        self.nodes.push_and_get_key(node)
    }

    /// Adds the node that an operator comes to.
    pub(crate) fn push_written(&mut self, node: Node, written: Written, span: Span) -> FormulaId {
        let id = self.push(node, span);
        self.written[id] = Some(Box::new(written));
        id
    }

    /// The operator that the node is the meaning of, where it is not the node's own.
    #[must_use]
    pub fn written(&self, id: FormulaId) -> Option<&Written> {
        self.written[id].as_deref()
    }

    /// The conjuncts as they are written: what one operator means is not taken apart.
    #[must_use]
    pub fn parts(&self) -> Vec<FormulaId> {
        let mut found = Vec::new();
        let mut stack = vec![self.root()];
        while let Some(id) = stack.pop() {
            match &self.nodes[id] {
                Node::And(ids) if self.written(id).is_none() && !ids.is_empty() => {
                    stack.extend(ids.iter().rev());
                }
                _ => found.push(id),
            }
        }
        let mut seen = BTreeSet::new();
        found.retain(|part| seen.insert(*part));
        found
    }

    /// The operands as written.
    #[must_use]
    pub fn operands(&self, id: FormulaId) -> Vec<FormulaId> {
        self.written(id).map_or_else(|| self.nodes[id].children(), |written| written.operands.clone())
    }

    /// The sides of what was written as an implication.
    #[must_use]
    pub fn implication(&self, id: FormulaId) -> Option<(FormulaId, FormulaId)> {
        match self.written(id)? {
            Written { operator: Operator::Implies, operands, .. } => {
                Some((*operands.first()?, *operands.last()?))
            }
            _ => None,
        }
    }

    /// The value of an empty conjunction or disjunction.
    #[must_use]
    pub fn constant(&self, id: FormulaId) -> Option<bool> {
        match &self.nodes[id] {
            Node::And(ids) if ids.is_empty() => Some(true),
            Node::Or(ids) if ids.is_empty() => Some(false),
            _ => None,
        }
    }

    /// The interval and operand of "at some step".
    #[must_use]
    pub fn finally(&self, id: FormulaId) -> Option<(Interval, FormulaId)> {
        match self.nodes[id] {
            Node::Until(interval, left, right) if self.constant(left) == Some(true) => {
                Some((interval, right))
            }
            _ => None,
        }
    }

    /// The interval and operand of "at every step".
    #[must_use]
    pub fn globally(&self, id: FormulaId) -> Option<(Interval, FormulaId)> {
        match self.nodes[id] {
            Node::Release(interval, left, right) if self.constant(left) == Some(false) => {
                Some((interval, right))
            }
            _ => None,
        }
    }
}

impl Node {
    /// Direct children.
    #[must_use]
    pub fn children(&self) -> Vec<FormulaId> {
        match self {
            Node::Atom(_) => Vec::new(),
            Node::Not(a) | Node::Next(a) | Node::WeakNext(a) => vec![*a],
            Node::And(xs) | Node::Or(xs) => xs.clone(),
            Node::Iff(a, b) | Node::Until(_, a, b) | Node::Release(_, a, b) => vec![*a, *b],
        }
    }

    /// The same node over other children.
    #[must_use]
    pub fn map_children(&self, f: impl Fn(FormulaId) -> FormulaId) -> Node {
        let all = |ids: &[FormulaId]| ids.iter().map(|&id| f(id)).collect();
        match self {
            Node::Atom(e) => Node::Atom(e.clone()),
            Node::And(ids) => Node::And(all(ids)),
            Node::Or(ids) => Node::Or(all(ids)),
            Node::Not(a) => Node::Not(f(*a)),
            Node::Iff(a, b) => Node::Iff(f(*a), f(*b)),
            Node::Next(a) => Node::Next(f(*a)),
            Node::WeakNext(a) => Node::WeakNext(f(*a)),
            Node::Until(i, a, b) => Node::Until(*i, f(*a), f(*b)),
            Node::Release(i, a, b) => Node::Release(*i, f(*a), f(*b)),
        }
    }
}
