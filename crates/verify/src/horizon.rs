//! How far the formula can look along a path, by this crate's own account.

use hyperplan_problem::{FormulaId, Interval, Mode, Node, Objective, PathId, PathLeaf};

/// The last position at which the formula can read `path`; 0 where it never does, K under `within K`.
pub(crate) fn horizon(objective: &Objective, path: PathId) -> u64 {
    if let Mode::Within(k) = objective.mode {
        return u64::from(k);
    }
    let mut reach: Vec<Option<u64>> = Vec::with_capacity(objective.formula.nodes.len());
    for node in &objective.formula.nodes {
        let of = |id: &FormulaId| reach.get(usize::from(*id)).copied().flatten();
        let later = |id: &FormulaId, steps: u64| of(id).map(|r| r.saturating_add(steps));
        let here = match node {
            Node::Atom(expr) => {
                let mut read = false;
                expr.for_each_leaf(&mut |leaf| read |= paths_of(leaf).contains(&Some(path)));
                read.then_some(0)
            }
            Node::Not(a) => of(a),
            Node::And(xs) | Node::Or(xs) => xs.iter().filter_map(of).max(),
            Node::Iff(a, b) => of(a).max(of(b)),
            Node::Next(a) | Node::WeakNext(a) => later(a, 1),
            // They read the left operand strictly before the right one.
            Node::Until(i, a, b) | Node::Release(i, a, b) => {
                let before = bound(i).checked_sub(1).and_then(|n| later(a, n));
                before.max(later(b, bound(i)))
            }
        };
        reach.push(here);
    }
    reach.last().copied().flatten().unwrap_or(0)
}

fn bound(interval: &Interval) -> u64 {
    u64::from(interval.hi.unwrap_or(interval.lo))
}

/// The path variables that a leaf reads.
pub(crate) fn paths_of(leaf: &PathLeaf) -> [Option<PathId>; 2] {
    match leaf {
        PathLeaf::State(p, _) | PathLeaf::Took(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
            [Some(*p), None]
        }
        PathLeaf::SameAction(p, q) | PathLeaf::SameState(p, q) => [Some(*p), Some(*q)],
    }
}
