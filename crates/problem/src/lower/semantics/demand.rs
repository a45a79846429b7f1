//! Which nodes are needed with which sign, and where they are read.

use crate::formula::{Formula, Node};
use crate::ids::FormulaId;
use typed_index_collections::TiVec;

/// What is asked of a node in the negation normal form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demand {
    /// Whether its negation, and whether it itself, occurs.
    pub(super) signs: [bool; 2],
    /// The only position where it is read, unless there may be several.
    pub(super) position: Option<u32>,
}

/// The demand on every node; the root is read at position 0.
pub(super) fn demands(formula: &Formula) -> TiVec<FormulaId, Demand> {
    let nothing = Demand { signs: [false; 2], position: None };
    let mut demands: TiVec<FormulaId, Demand> = formula.nodes.iter().map(|_| nothing).collect();
    demands[formula.root()] = Demand { signs: [false, true], position: Some(0) };
    // Parents come after their children, so walking backwards meets every parent first.
    for (id, node) in formula.nodes.iter_enumerated().rev() {
        let Demand { signs, position } = demands[id];
        if signs == [false; 2] {
            continue;
        }
        let flipped = [signs[1], signs[0]];
        let position = match node {
            Node::Next(_) | Node::WeakNext(_) => position.and_then(|p| p.checked_add(1)),
            Node::Until(..) | Node::Release(..) => None,
            Node::Atom(_) | Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => position,
        };
        let mut ask = |child: FormulaId, signs: [bool; 2]| {
            let demand = &mut demands[child];
            let first = demand.signs == [false; 2];
            demand.position = position.filter(|_| first || demand.position == position);
            demand.signs = [demand.signs[0] || signs[0], demand.signs[1] || signs[1]];
        };
        match node {
            Node::Not(a) => ask(*a, flipped),
            Node::Iff(a, b) => {
                ask(*a, [true; 2]);
                ask(*b, [true; 2]);
            }
            node => node.children().into_iter().for_each(|child| ask(child, signs)),
        }
    }
    demands
}
