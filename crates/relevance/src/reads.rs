//! What expressions read of paths.

use hyperplan_problem::{Expr, PathId, PathLeaf, System};
use hyperplan_space::{Graph, StateIx};

/// The path whose state alone an expression reads, if there is one.
pub fn only_path(expr: &Expr<PathLeaf>) -> Option<PathId> {
    let (mut path, mut only) = (None, true);
    expr.for_each_leaf(&mut |leaf| match *leaf {
        PathLeaf::State(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
            only &= path.is_none_or(|known| known == p);
            path = Some(p);
        }
        PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => only = false,
    });
    path.filter(|_| only)
}

/// What a leaf is in a state of its path; `None` where it reads more than that.
pub fn in_state(system: &System, graph: &Graph, leaf: &PathLeaf, state: StateIx) -> Option<i64> {
    match *leaf {
        PathLeaf::State(_, leaf) => Some(graph.leaf(system, state, leaf)),
        PathLeaf::Enabled(_, action) => Some(i64::from(graph.enables(state, action))),
        PathLeaf::Halted(_) => Some(i64::from(graph.halts(state))),
        PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => None,
    }
}
