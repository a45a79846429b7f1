//! What lasts: which parts of an objective, once they hold for a value of a constant, hold for the next one too.
//!
//! Two values of the constant give two objectives. They are compared as they are after everything was resolved, so
//! that it does not matter where in the file the constant stands: in a bound, in `within`, in the argument of a
//! template, or in another constant. Actions and systems must be the same, and the formulas must have the same
//! operators and atoms; intervals and the length given by `within` may differ.
//!
//! A subformula *lasts upwards* if from its earlier version follows the later one, on the same paths and at the same
//! position, and *downwards* if the earlier follows from the later one. Below, `[a,b]` is the interval of the
//! earlier version and `[a',b']` that of the later one.
//!
//! | | upwards | downwards |
//! | --- | --- | --- |
//! | `U` | `[a,b]` within `[a',b']` | `[a',b']` within `[a,b]`, not longer |
//! | `R` | `[a',b']` within `[a,b]`, not longer | `[a,b]` within `[a',b']` |
//! | `(f U[a,b] g) \| G[0,b] f` | `a' <= a`, `b' <= b`, not longer | `a <= a'`, `b <= b'` |
//! | `X` | | not longer |
//! | `N` | not longer | |
//!
//! and the operands last in the same direction; negation turns the direction, an equivalence needs both. The
//! disjunction, which is `f W[a,b] g`, lasts longer than its parts: a `g` that comes too late for the later interval
//! still means that `f` holds as long as that interval lasts.
//!
//! *Without `within`* paths are infinite and do not depend on the constant, so what lasts upwards on all tuples of
//! paths lasts under any quantifiers. (Systems with `int` or `real` variables are left out: their paths end with the
//! horizon.)
//!
//! *With `within K`* the later paths may be *longer*. Then upwards means: from the earlier version on the paths cut
//! to the earlier length follows the later one on the whole paths, at all positions of the cut paths; downwards is
//! the converse. Strong operators ask for positions that exist, and those of a path cut short exist on the whole one,
//! so they last upwards; weak ones last downwards; the table says "not longer" for the others. As to quantifiers: a
//! path that is given under `forall` is cut, answered as before, and the answer of each `exists` is prolonged in any
//! way. That needs that the systems of existential paths have no dead ends; the cut path is a path all the same.

#[cfg(test)]
mod tests;

use hyperplan_encode::{Graphs, Limits};
use hyperplan_problem::{Formula, FormulaId, Interval, Mode, Node, Objective, Problem, Quantifier};
use typed_index_collections::TiVec;

/// A problem and one of its objectives.
pub(crate) type Question<'a> = (&'a Problem, &'a Objective);

/// The parts of an objective that must all hold.
pub(crate) fn conjuncts(formula: &Formula) -> Vec<FormulaId> {
    let mut found = Vec::new();
    let mut seen: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| false).collect();
    let mut stack = vec![formula.root()];
    while let Some(id) = stack.pop() {
        if std::mem::replace(&mut seen[id], true) {
            continue;
        }
        match &formula.nodes[id] {
            Node::And(ids) => stack.extend(ids.iter().rev()),
            _ => found.push(id),
        }
    }
    found
}

/// For each subformula whether it lasts upwards, quantifiers included; `None` where this is known of none.
pub(crate) fn lasting(
    earlier: Question<'_>,
    later: Question<'_>,
    graphs: &Graphs,
) -> Option<TiVec<FormulaId, bool>> {
    let longer = longer(earlier.1.mode, later.1.mode)?;
    if !same_paths(earlier, later, longer, graphs) {
        return None;
    }
    let lasts = compare(&earlier.1.formula, &later.1.formula, longer)?;
    Some(lasts.into_iter().map(|lasts| lasts.up).collect())
}

/// How each subformula lasts; `None` where the formulas have not the same operators and atoms.
fn compare(from: &Formula, to: &Formula, longer: bool) -> Option<TiVec<FormulaId, Lasts>> {
    if from.nodes.len() != to.nodes.len() {
        return None;
    }
    let mut lasts: TiVec<FormulaId, Lasts> = TiVec::with_capacity(from.nodes.len());
    for id in from.nodes.keys() {
        let both = node(from, to, id, longer, &lasts)?;
        lasts.push(both);
    }
    Some(lasts)
}

/// Whether later paths are longer; `None` where they are shorter.
fn longer(earlier: Mode, later: Mode) -> Option<bool> {
    match (earlier, later) {
        (Mode::Bounded, Mode::Bounded) => Some(false),
        (Mode::Within(a), Mode::Within(b)) if a <= b => Some(a < b),
        _ => None,
    }
}

fn same_paths(earlier: Question<'_>, later: Question<'_>, longer: bool, graphs: &Graphs) -> bool {
    let (from, to) = (&earlier.1.paths, &later.1.paths);
    from.len() == to.len()
        && earlier.0.actions == later.0.actions
        && from.iter().zip(to).all(|(p, q)| {
            let (system, next) = (&earlier.0.systems[p.system], &later.0.systems[q.system]);
            let prolonged = || {
                let graph = graphs.explore(system, Limits::default().states);
                graph.is_some_and(|graph| graph.all_live())
            };
            p.quantifier == q.quantifier
                && p.system == q.system
                && system.is_finite()
                && system == next
                && (!longer || p.quantifier == Quantifier::Forall || prolonged())
        })
}

#[derive(Clone, Copy)]
struct Lasts {
    up: bool,
    down: bool,
}

impl Lasts {
    const BOTH: Lasts = Lasts { up: true, down: true };

    fn and(self, other: Lasts) -> Lasts {
        Lasts { up: self.up && other.up, down: self.down && other.down }
    }

    fn turned(self) -> Lasts {
        Lasts { up: self.down, down: self.up }
    }
}

/// `None` where the nodes are not of one kind.
fn node(
    from: &Formula,
    to: &Formula,
    id: FormulaId,
    longer: bool,
    known: &TiVec<FormulaId, Lasts>,
) -> Option<Lasts> {
    let (a, b) = (&from.nodes[id], &to.nodes[id]);
    if a.children() != b.children() {
        return None;
    }
    if let (Some((i, x, y)), Some((j, ..))) = (as_weak_until(from, a), as_weak_until(to, b)) {
        return Some(known[x].and(known[y]).and(weak_until(&i, &j, longer)));
    }
    let all = |ids: &[FormulaId]| ids.iter().fold(Lasts::BOTH, |all, &id| all.and(known[id]));
    let own = |up: bool, down: bool| Lasts { up, down };
    Some(match (a, b) {
        (Node::Atom(x), Node::Atom(y)) => return (x == y).then_some(Lasts::BOTH),
        (Node::Not(x), Node::Not(_)) => known[*x].turned(),
        (Node::And(ids), Node::And(_)) | (Node::Or(ids), Node::Or(_)) => all(ids),
        (Node::Iff(x, y), Node::Iff(..)) => {
            let both = all(&[*x, *y]);
            both.and(both.turned())
        }
        (Node::Next(x), Node::Next(_)) => known[*x].and(own(true, !longer)),
        (Node::WeakNext(x), Node::WeakNext(_)) => known[*x].and(own(!longer, true)),
        (Node::Until(i, x, y), Node::Until(j, ..)) => all(&[*x, *y]).and(strong(i, j, longer)),
        (Node::Release(i, x, y), Node::Release(j, ..)) => all(&[*x, *y]).and(weak(i, j, longer)),
        _ => return None,
    })
}

/// The interval and the operands of `(f U[a,b] g) | G[0,b] f`.
fn as_weak_until(formula: &Formula, node: &Node) -> Option<(Interval, FormulaId, FormulaId)> {
    let Node::Or(ids) = node else { return None };
    let &[until, always] = ids.as_slice() else { return None };
    let Node::Until(interval, f, g) = formula.nodes[until] else { return None };
    let whole = (Interval { lo: 0, ..interval }, f);
    (formula.globally(always) == Some(whole)).then_some((interval, f, g))
}

/// For `U`.
fn strong(earlier: &Interval, later: &Interval, longer: bool) -> Lasts {
    Lasts { up: inside(earlier, later), down: !longer && inside(later, earlier) }
}

/// For `R`, the dual.
fn weak(earlier: &Interval, later: &Interval, longer: bool) -> Lasts {
    strong(earlier, later, longer).turned()
}

/// For `W`.
fn weak_until(earlier: &Interval, later: &Interval, longer: bool) -> Lasts {
    Lasts {
        up: !longer && later.lo <= earlier.lo && end(later) <= end(earlier),
        down: earlier.lo <= later.lo && end(earlier) <= end(later),
    }
}

fn inside(inner: &Interval, outer: &Interval) -> bool {
    outer.lo <= inner.lo && end(inner) <= end(outer)
}

/// An interval without an end lasts longer than any other.
fn end(interval: &Interval) -> u32 {
    interval.hi.unwrap_or(u32::MAX)
}
