//! How long a prefix of each path an objective can read (the paper's section VI-A, corrected and tightened).
//!
//! The paper's recursion gives a path that does not occur a finite horizon (`x + (-inf) = x`) and charges both
//! operands of a bounded until with the whole bound. Here a path that does not occur has no horizon, and in
//! `phi U[a,b] psi` the left operand is read only up to step `b - 1`, since `psi` may come no later than `b`; the
//! same holds for `R`, its dual. What other operators read follows from what they mean: `W` is `U` or `G[0,b] phi`, so
//! it reads `phi` up to `b`.
//!
//! Both numbers are computed top-down: the latest time at which each subformula is read. The chain of operators
//! that leads to the latest read of a path is the reason for its horizon.

use hyperplan_problem::{Expr, FormulaId, Interval, Mode, Node, Objective, PathId, PathLeaf};
use typed_index_collections::TiVec;

/// The horizon of one path variable, in steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Horizon {
    /// The paper's number (as corrected for paths that do not occur).
    pub paper: Option<u64>,
    /// The number of steps of the path that the objective can read: what hyperplan uses.
    pub steps: Option<u64>,
    /// Why: the operators on the way to the latest read, outermost first, each with the steps that it adds. Empty
    /// under `within`, where the objective says so itself, and for a path that is read only at time 0.
    pub reason: Vec<(FormulaId, u64)>,
    /// The latest-read atom, where the path is read at all.
    pub atom: Option<FormulaId>,
}

/// Shorter paths are no burden.
const SHORT: u64 = 10;

/// A path that is much longer than any bound of its objective says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Long {
    /// The path, of equally long ones the first.
    pub path: PathId,
    /// Its horizon, in steps.
    pub steps: u64,
    /// The greatest bound.
    pub bound: u64,
}

/// The longest path of an objective, where that is surprising: one bound inside another, as in "get there, and from
/// there back", is common, with a step between them; more add up to what nobody wrote.
#[must_use]
pub fn surprising(objective: &Objective) -> Option<Long> {
    if objective.mode != Mode::Bounded {
        return None;
    }
    let end = |node: &Node| match node {
        Node::Until(interval, ..) | Node::Release(interval, ..) => interval.hi.map(u64::from),
        _ => None,
    };
    let bound = objective.formula.nodes.iter().filter_map(end).max()?;
    let each = horizons(objective);
    let (path, steps) = each.iter_enumerated().rev().map(|(path, h)| (path, h.steps)).max_by_key(|h| h.1)?;
    let steps = steps.filter(|&steps| steps >= SHORT && steps > 2 * bound + 1)?;
    Some(Long { path, steps, bound })
}

/// The horizon of each path variable of an objective.
#[must_use]
pub fn horizons(objective: &Objective) -> TiVec<PathId, Horizon> {
    let paper = latest_reads(objective, Charge::Paper);
    let tight = latest_reads(objective, Charge::Tight);
    objective
        .paths
        .keys()
        .map(|path| {
            let atom = tight.latest_atom(objective, path);
            match objective.mode {
                Mode::Within(steps) => {
                    let steps = Some(u64::from(steps));
                    Horizon { paper: steps, steps, reason: Vec::new(), atom }
                }
                Mode::Bounded => Horizon {
                    paper: paper.latest_atom(objective, path).and_then(|atom| paper.time[atom]),
                    steps: atom.and_then(|atom| tight.time[atom]),
                    reason: atom.map_or_else(Vec::new, |atom| tight.chain(atom)),
                    atom,
                },
            }
        })
        .collect()
}

/// The latest time at which a subformula is read, in bounded mode; `None` where it never is.
#[must_use]
pub fn latest_read(objective: &Objective, id: FormulaId) -> Option<u64> {
    latest_reads(objective, Charge::Tight).time[id]
}

/// How much of a bound each operand of an until is charged.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Charge {
    Paper,
    Tight,
}

struct LatestReads {
    /// The latest time at which a node is read; `None` where it never is.
    time: TiVec<FormulaId, Option<u64>>,
    /// The parent from which that read comes, and the steps it adds.
    from: TiVec<FormulaId, Option<(FormulaId, u64)>>,
}

fn latest_reads(objective: &Objective, charge: Charge) -> LatestReads {
    let formula = &objective.formula;
    let mut reads = LatestReads {
        time: formula.nodes.iter().map(|_| None).collect(),
        from: formula.nodes.iter().map(|_| None).collect(),
    };
    reads.time[formula.root()] = Some(0);
    // Parents come after their children, so walking backwards meets every parent first.
    for (id, node) in formula.nodes.iter_enumerated().rev() {
        if let Some(now) = reads.time[id] {
            for (child, delay) in delays(node, charge) {
                let Some(delay) = delay else { continue };
                if reads.time[child].is_none_or(|t| t < now + delay) {
                    reads.time[child] = Some(now + delay);
                    reads.from[child] = Some((id, delay));
                }
            }
        }
    }
    reads
}

/// For each child, how many steps after the parent it may be read at the latest; `None`: never.
fn delays(node: &Node, charge: Charge) -> Vec<(FormulaId, Option<u64>)> {
    // An interval without an end occurs only under `within`, where these numbers are not used.
    let end = |interval: &Interval| u64::from(interval.hi.unwrap_or(0));
    match node {
        Node::Next(a) | Node::WeakNext(a) => vec![(*a, Some(1))],
        Node::Until(interval, left, right) | Node::Release(interval, left, right) => {
            let end = end(interval);
            let before = match charge {
                Charge::Paper => Some(end),
                Charge::Tight => end.checked_sub(1),
            };
            vec![(*left, before), (*right, Some(end))]
        }
        Node::Atom(_) | Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => {
            node.children().into_iter().map(|c| (c, Some(0))).collect()
        }
    }
}

impl LatestReads {
    fn latest_atom(&self, objective: &Objective, path: PathId) -> Option<FormulaId> {
        let mut best: Option<FormulaId> = None;
        for (id, node) in objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            let later = self.time[id].is_some() && best.is_none_or(|b| self.time[b] < self.time[id]);
            if later && reads(expr, path) {
                best = Some(id);
            }
        }
        best
    }

    fn chain(&self, atom: FormulaId) -> Vec<(FormulaId, u64)> {
        let mut chain = Vec::new();
        let mut at = atom;
        while let Some((parent, delay)) = self.from[at] {
            if delay > 0 {
                chain.push((parent, delay));
            }
            at = parent;
        }
        chain.reverse();
        chain
    }
}

/// Whether an atom reads anything of the path. Whether it has halted is asked by no atom that the objective writes.
fn reads(expr: &Expr<PathLeaf>, path: PathId) -> bool {
    let mut found = false;
    expr.for_each_leaf(&mut |leaf| {
        found |= leaf.paths().contains(&Some(path)) && !matches!(leaf, PathLeaf::Halted(_));
    });
    found
}

#[cfg(test)]
mod tests;
