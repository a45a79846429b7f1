//! Formulas with parts replaced by truth values.

use hyperplan_problem::{Formula, FormulaId, Node, PathLeaf};
use std::collections::{BTreeMap, BTreeSet};
use typed_index_collections::TiVec;

/// Subformulas, each with the truth value that stands in its place.
pub(crate) type Replaced = BTreeMap<FormulaId, bool>;

/// Builds formulas out of parts of another one.
pub(crate) struct Builder<'f> {
    from: &'f Formula,
    /// What was built.
    formula: Formula,
}

/// A part that was built, or the truth value that it came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Built {
    Constant(bool),
    Node(FormulaId),
}

impl<'f> Builder<'f> {
    pub(crate) fn new(from: &'f Formula) -> Self {
        Builder { from, formula: Formula::default() }
    }

    /// The subformulas at `roots` under these replacements.
    pub(crate) fn parts(&mut self, roots: &[FormulaId], replaced: &Replaced) -> Vec<Built> {
        let needed = needed(self.from, roots, replaced);
        let mut built: TiVec<FormulaId, Built> = TiVec::with_capacity(needed.len());
        for (id, &needed) in needed.iter_enumerated() {
            built.push(match replaced.get(&id) {
                _ if !needed => Built::Constant(false),
                Some(&value) => Built::Constant(value),
                None => self.node(id, &built),
            });
        }
        roots.iter().map(|&root| built[root]).collect()
    }

    /// The subformula at `root`, or its negation.
    pub(crate) fn part(&mut self, root: FormulaId, value: bool) -> Built {
        let built = self.parts(&[root], &Replaced::new()).into_iter().next();
        let built = built.unwrap_or(Built::Constant(true));
        if value { built } else { self.not(built, root) }
    }

    fn node(&mut self, id: FormulaId, built: &TiVec<FormulaId, Built>) -> Built {
        let node = match &self.from.nodes[id] {
            Node::Atom(e) if e.is_true() => return Built::Constant(true),
            Node::Atom(e) if e.is_false() => return Built::Constant(false),
            Node::And(ids) => return self.join(true, ids.iter().map(|&i| built[i]).collect(), id),
            Node::Or(ids) => return self.join(false, ids.iter().map(|&i| built[i]).collect(), id),
            Node::Not(a) => return self.not(built[*a], id),
            Node::WeakNext(a) | Node::Release(_, _, a) if built[*a] == Built::Constant(true) => {
                return Built::Constant(true);
            }
            Node::Next(a) | Node::Until(_, _, a) if built[*a] == Built::Constant(false) => {
                return Built::Constant(false);
            }
            node @ (Node::Atom(_)
            | Node::Iff(..)
            | Node::Next(_)
            | Node::WeakNext(_)
            | Node::Until(..)
            | Node::Release(..)) => node.clone(),
        };
        let children: BTreeMap<FormulaId, FormulaId> = node
            .children()
            .into_iter()
            .map(|at| match built[at] {
                Built::Node(node) => (at, node),
                Built::Constant(value) => (at, self.constant(value, at)),
            })
            .collect();
        let node = node.map_children(|child| children[&child]);
        self.push(node, id)
    }

    pub(crate) fn not(&mut self, part: Built, at: FormulaId) -> Built {
        match part {
            Built::Constant(value) => Built::Constant(!value),
            Built::Node(node) => self.push(Node::Not(node), at),
        }
    }

    /// A conjunction (`and`) or disjunction of parts.
    pub(crate) fn join(&mut self, and: bool, parts: Vec<Built>, at: FormulaId) -> Built {
        let mut nodes = Vec::with_capacity(parts.len());
        for part in parts {
            match part {
                Built::Constant(value) if value == and => {}
                Built::Constant(value) => return Built::Constant(value),
                Built::Node(node) => nodes.push(node),
            }
        }
        match nodes.as_slice() {
            [] => Built::Constant(and),
            [only] => Built::Node(*only),
            _ if and => self.push(Node::And(nodes), at),
            _ => self.push(Node::Or(nodes), at),
        }
    }

    /// The formula whose root is this part; `None` where it is a truth value.
    pub(crate) fn finish(mut self, part: Built) -> Result<Formula, bool> {
        match part {
            Built::Constant(value) => Err(value),
            Built::Node(node) => {
                // The root is the last node.
                let span = self.formula.spans[node];
                if node != self.formula.root() {
                    self.formula.push(Node::And(vec![node]), span);
                }
                Ok(self.formula)
            }
        }
    }

    fn constant(&mut self, value: bool, at: FormulaId) -> FormulaId {
        let span = self.from.spans[at];
        self.formula.push(if value { Node::And(Vec::new()) } else { Node::Or(Vec::new()) }, span)
    }

    fn push(&mut self, node: Node, at: FormulaId) -> Built {
        Built::Node(self.formula.push(node, self.from.spans[at]))
    }
}

/// The nodes under some roots that are not under something replaced.
fn needed(formula: &Formula, roots: &[FormulaId], replaced: &Replaced) -> TiVec<FormulaId, bool> {
    let mut needed: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| false).collect();
    for &root in roots {
        needed[root] = true;
    }
    for (at, node) in formula.nodes.iter_enumerated().rev() {
        if needed[at] && !replaced.contains_key(&at) {
            for child in node.children() {
                needed[child] = true;
            }
        }
    }
    needed
}

/// The nodes in which a subformula occurs, itself included.
pub(crate) fn above(formula: &Formula, id: FormulaId) -> TiVec<FormulaId, bool> {
    let mut above: TiVec<FormulaId, bool> = TiVec::with_capacity(formula.nodes.len());
    for (at, node) in formula.nodes.iter_enumerated() {
        let inside = at == id || at > id && node.children().into_iter().any(|child| above[child]);
        above.push(inside);
    }
    above
}

/// The conjuncts of a formula; what is replaced as a whole is one.
pub(crate) fn conjuncts(formula: &Formula, root: FormulaId, replaced: &Replaced) -> Vec<FormulaId> {
    let mut found = Vec::new();
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        match &formula.nodes[id] {
            Node::And(ids) if !replaced.contains_key(&id) => stack.extend(ids.iter().rev()),
            _ => found.push(id),
        }
    }
    found
}

/// Calls `f` on every leaf of a subformula's atoms. Shared parts are visited once.
pub(crate) fn leaves(formula: &Formula, root: FormulaId, f: &mut impl FnMut(&PathLeaf)) {
    let mut seen = BTreeSet::from([root]);
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        if let Node::Atom(e) = &formula.nodes[id] {
            e.for_each_leaf(f);
        }
        stack.extend(formula.nodes[id].children().into_iter().filter(|&child| seen.insert(child)));
    }
}
