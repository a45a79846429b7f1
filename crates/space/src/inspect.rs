//! What `check` wants to know of a system's reachable states.

use crate::also::{Updates, applicable, applied, no_number};
use crate::eval::bounds;
use crate::graph::{Graph, StateIx};
use crate::row::{Row, Rows};
use crate::step::{Steps, update_values_unclipped};
use hyperplan_problem::{ActionId, LabelId, Leaf, System, Type, Var};

/// Things that are probably not meant, each with a reachable state as an example.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// How many reachable states have no transition, and one of them.
    pub dead_ends: Option<(usize, StateIx)>,
    /// Labels that hold in no reachable state.
    pub unreachable: Vec<LabelId>,
    /// Pairs of written clauses of one action that are enabled together and lead to different states, by position.
    pub overlaps: Vec<(usize, usize, StateIx)>,
    /// Written clauses enabled together with a move of the map, or a transition of the graph, of the same action.
    pub added: Vec<(usize, StateIx)>,
    /// Written clauses an update of which leaves its variable's range where the clause is enabled.
    pub lost: Vec<(usize, StateIx)>,
    /// Clauses that add something to other transitions, by position, of which no guard holds where a state does not
    /// absorb.
    pub idle: Vec<usize>,
}

/// States looked at between two questions whether to stop.
const STRIDE: StateIx = 256;

/// Values of all choices of a clause beyond which its outcomes are not compared with another's.
const OUTCOMES: usize = 1024;

/// Looks at every reachable state. `None` if the caller wanted to stop before the last.
#[must_use]
pub fn inspect(system: &System, graph: &Graph, stop: &dyn Fn() -> bool) -> Option<Findings> {
    let mut findings = Findings::default();
    let mut seen = vec![false; system.labels.len()];
    findings.idle = (0..system.also.len()).collect();
    let truths: Vec<bool> = system.labels.iter().map(|label| label.ty == Type::Bool).collect();
    let steps = Steps::new(system);
    let mut here = Row::new(system);
    for state in 0..graph.len() as StateIx {
        if state % STRIDE == 0 && stop() {
            return None;
        }
        here.turn(graph.codes(state));
        if graph.successors(state).is_empty() {
            let (count, _) = findings.dead_ends.get_or_insert((0, state));
            *count += 1;
        }
        for (at, seen) in seen.iter_mut().enumerate().filter(|(at, _)| truths[*at]) {
            *seen |= here.leaf(Leaf::Label(LabelId::from(at))) != 0;
        }
        if !here.holds(&system.absorb) {
            clauses(&steps, state, &here, &mut findings);
            findings.idle.retain(|&at| !here.holds(&system.also[at].guard));
        }
    }
    findings.unreachable = (0..seen.len()).filter(|&at| truths[at] && !seen[at]).map(LabelId::from).collect();
    Some(findings)
}

fn clauses<'a>(steps: &Steps<'a>, state: StateIx, here: &Row<'a>, findings: &mut Findings) {
    let system = here.system();
    let enabled: Vec<usize> = (0..system.clauses.len())
        .filter(|&at| !system.clauses[at].generated && here.holds(&system.clauses[at].guard))
        .collect();
    for (at, &first) in enabled.iter().enumerate() {
        for &second in &enabled[at + 1..] {
            let actions = &system.clauses[second].actions;
            let mut shared = system.clauses[first].actions.iter().filter(|a| actions.contains(a));
            let known = || findings.overlaps.iter().any(|o| (o.0, o.1) == (first, second));
            if !known() && shared.any(|&action| differ(steps, [first, second], action, here)) {
                findings.overlaps.push((first, second, state));
            }
        }
        if !findings.added.iter().any(|a| a.0 == first) && adds(first, here) {
            findings.added.push((first, state));
        }
        if !findings.lost.iter().any(|l| l.0 == first) && leaves_range(first, here) {
            findings.lost.push((first, state));
        }
    }
}

/// Whether both clauses have outcomes by that action, and not the same.
fn differ<'a>(steps: &Steps<'a>, both: [usize; 2], action: ActionId, here: &Row<'a>) -> bool {
    let system = here.system();
    let also = applicable(system, action, &no_number);
    let besides: Updates = applied(&also, here).cloned().collect();
    let outcomes = |clause: usize| -> Option<Vec<Vec<i64>>> {
        let updates = system.clauses[clause].updates.iter().chain(&besides);
        let mut all = Rows::default();
        steps.outcomes(updates, here, OUTCOMES, &mut all).ok()?;
        let inside = |next: &&[i64]| {
            let fits =
                |(value, var): (&i64, &Var)| bounds(&var.ty).is_none_or(|(lo, hi)| (lo..=hi).contains(value));
            next.iter().zip(&system.vars).all(fits)
        };
        let mut all: Vec<Vec<i64>> = all.iter().filter(inside).map(<[i64]>::to_vec).collect();
        all.sort_unstable();
        all.dedup();
        Some(all)
    };
    match both.map(outcomes) {
        [Some(a), Some(b)] => !a.is_empty() && !b.is_empty() && a != b,
        _ => true,
    }
}

/// Whether a clause gives one of its actions another outcome than the map or graph does.
fn adds(clause: usize, here: &Row<'_>) -> bool {
    let system = here.system();
    let actions = &system.clauses[clause].actions;
    let moves = || {
        let moves = system.clauses.iter().enumerate().filter(|(_, c)| c.generated);
        moves
            .filter(|(_, c)| c.actions.iter().any(|a| actions.contains(a)))
            .any(|(at, c)| here.holds(&c.guard) && !leaves_range(at, here))
    };
    let listed = system.edges.as_ref().is_some_and(|edges| {
        let at = u32::try_from(here.leaf(Leaf::Var(edges.var))).unwrap_or(u32::MAX);
        edges.of(at).iter().any(|edge| actions.contains(&edge.action))
    });
    listed || moves()
}

fn leaves_range(clause: usize, here: &Row<'_>) -> bool {
    let system = here.system();
    system.clauses[clause].updates.iter().any(|(var, update)| {
        let Some((lo, hi)) = bounds(&system.vars[*var].ty) else { return false };
        update_values_unclipped(update, here).iter().any(|v| !(lo..=hi).contains(v))
    })
}
