//! Building formulas on finite traces: constants folded, equal parts shared.

use crate::expr::{Expr, PathLeaf};
use crate::formula::{Formula, Interval, Node};
use crate::ids::FormulaId;
use hyperplan_syntax::Span;
use rustc_hash::FxHashMap;
use std::mem::Discriminant;
use typed_index_collections::TiVec;

/// A node by what it is made of; atoms have no key.
type Key = (Discriminant<Node>, Option<Interval>, Vec<FormulaId>);

pub(super) struct Builder<'a> {
    source: &'a Formula,
    formula: Formula,
    index: FxHashMap<Key, FormulaId>,
    atoms: FxHashMap<FormulaId, FormulaId>,
    /// The place of what is built.
    span: Span,
}

impl<'a> Builder<'a> {
    /// The empty conjunction.
    pub(super) const TRUE: FormulaId = FormulaId(0);
    /// The empty disjunction.
    pub(super) const FALSE: FormulaId = FormulaId(1);

    pub(super) fn new(source: &'a Formula, span: Span) -> Self {
        let mut formula = Formula::default();
        formula.push(Node::And(Vec::new()), span);
        formula.push(Node::Or(Vec::new()), span);
        Builder { source, formula, index: FxHashMap::default(), atoms: FxHashMap::default(), span }
    }

    /// What is built from now on belongs to that place.
    pub(super) fn at(&mut self, span: Span) {
        self.span = span;
    }

    pub(super) fn constant(holds: bool) -> FormulaId {
        if holds { Self::TRUE } else { Self::FALSE }
    }

    /// An atom of the source; each becomes one atom, however often it is read.
    pub(super) fn atom(&mut self, id: FormulaId, expr: &Expr<PathLeaf>) -> FormulaId {
        if expr.is_true() || expr.is_false() {
            return Self::constant(expr.is_true());
        }
        if let Some(&known) = self.atoms.get(&id) {
            return known;
        }
        let atom = self.formula.push(Node::Atom(expr.clone()), self.source.spans[id]);
        self.atoms.insert(id, atom);
        atom
    }

    /// An atom that is not in the source.
    pub(super) fn new_atom(&mut self, expr: Expr<PathLeaf>) -> FormulaId {
        self.formula.push(Node::Atom(expr), self.span)
    }

    pub(super) fn not(&mut self, a: FormulaId) -> FormulaId {
        match (a, &self.formula.nodes[a]) {
            (Self::TRUE, _) => Self::FALSE,
            (Self::FALSE, _) => Self::TRUE,
            (_, &Node::Not(inner)) => inner,
            _ => self.intern(Node::Not(a)),
        }
    }

    pub(super) fn and(&mut self, parts: &[FormulaId]) -> FormulaId {
        self.join(true, parts)
    }

    pub(super) fn or(&mut self, parts: &[FormulaId]) -> FormulaId {
        self.join(false, parts)
    }

    /// A conjunction, or a disjunction.
    pub(super) fn join(&mut self, and: bool, parts: &[FormulaId]) -> FormulaId {
        let (neutral, absorbing) = (Self::constant(and), Self::constant(!and));
        if parts.contains(&absorbing) {
            return absorbing;
        }
        let mut parts: Vec<FormulaId> = parts.iter().copied().filter(|&p| p != neutral).collect();
        parts.dedup();
        match parts.as_slice() {
            [] => neutral,
            [only] => *only,
            _ => self.intern(if and { Node::And(parts) } else { Node::Or(parts) }),
        }
    }

    /// Strong next.
    pub(super) fn next(&mut self, a: FormulaId) -> FormulaId {
        if a == Self::FALSE { a } else { self.intern(Node::Next(a)) }
    }

    /// Whether this is the last position.
    pub(super) fn last(&mut self) -> FormulaId {
        self.intern(Node::WeakNext(Self::FALSE))
    }

    pub(super) fn finally(&mut self, interval: Interval, a: FormulaId) -> FormulaId {
        match a {
            Self::FALSE => a,
            Self::TRUE if interval.lo == 0 => a,
            _ => self.intern(Node::Until(interval, Self::TRUE, a)),
        }
    }

    pub(super) fn globally(&mut self, interval: Interval, a: FormulaId) -> FormulaId {
        match a {
            Self::TRUE => a,
            Self::FALSE if interval.lo == 0 => a,
            _ => self.intern(Node::Release(interval, Self::FALSE, a)),
        }
    }

    pub(super) fn until(&mut self, interval: Interval, a: FormulaId, b: FormulaId) -> FormulaId {
        match (a, b) {
            (Self::TRUE, _) | (_, Self::FALSE) => self.finally(interval, b),
            (_, Self::TRUE) if interval.lo == 0 => b,
            _ => self.intern(Node::Until(interval, a, b)),
        }
    }

    pub(super) fn release(&mut self, interval: Interval, a: FormulaId, b: FormulaId) -> FormulaId {
        match (a, b) {
            (Self::FALSE, _) | (_, Self::TRUE) => self.globally(interval, b),
            (_, Self::FALSE) if interval.lo == 0 => b,
            _ => self.intern(Node::Release(interval, a, b)),
        }
    }

    fn intern(&mut self, node: Node) -> FormulaId {
        let interval = match node {
            Node::Until(interval, ..) | Node::Release(interval, ..) => Some(interval),
            _ => None,
        };
        let key = (std::mem::discriminant(&node), interval, node.children());
        if let Some(&known) = self.index.get(&key) {
            return known;
        }
        let id = self.formula.push(node, self.span);
        self.index.insert(key, id);
        id
    }

    /// The formula with this root and nothing that it does not need.
    pub(super) fn finish(self, root: FormulaId) -> Formula {
        let built = self.formula;
        let mut needed: TiVec<FormulaId, bool> = built.nodes.iter().map(|_| false).collect();
        needed[root] = true;
        for (id, node) in built.nodes.iter_enumerated().rev() {
            if needed[id] {
                node.children().into_iter().for_each(|child| needed[child] = true);
            }
        }
        let mut formula = Formula::default();
        let mut place: TiVec<FormulaId, FormulaId> = TiVec::with_capacity(built.nodes.len());
        for (id, node) in built.nodes.into_iter_enumerated() {
            // What is not needed is no child of what is: its place is never looked up.
            place.push(if needed[id] {
                formula.push(node.map_children(|child| place[child]), built.spans[id])
            } else {
                root
            });
        }
        formula
    }
}
