//! What a path can never reach, however much time it has.

use super::part::now;
use hyperplan_encode::Graphs;
use hyperplan_problem::{
    FormulaId, Leaf, Mode, Node, Objective, PathId, PathLeaf, Problem, State, System, Value,
};
use hyperplan_space::{Graph, LIVE, StateIx, decode};
use std::collections::VecDeque;

/// Systems with more states are not looked at.
const STATES: usize = 1_000_000;

/// Nor more parts.
const PARTS: usize = 100;

/// A part that asks a path for what it reaches in no time.
#[derive(Clone, Debug)]
pub struct Wall {
    /// The part.
    pub part: FormulaId,
    /// The path.
    pub path: PathId,
    /// The states that it can come to while the part may still be met.
    pub reached: Vec<State>,
    /// So many states the system has that some path comes to.
    pub states: usize,
}

/// Looks among parts that exclude each other for one that is an eventuality of a path, and that no state meets which the
/// path can reach.
///
/// The path begins where the parts that are read at time 0 may hold, goes on only where the left side of the eventuality
/// may hold, and stays where parts that always hold may hold. What depends on other paths or on actions may hold, so
/// what is left out is left out by all paths that meet these parts.
pub(super) fn wall(
    problem: &Problem,
    objective: &Objective,
    parts: &[FormulaId],
    graphs: &Graphs,
) -> Option<Wall> {
    if parts.len() > PARTS {
        return None;
    }
    let formula = &objective.formula;
    for path in objective.leading_block() {
        let system = &problem.systems[objective.paths[path].system];
        for &part in parts {
            let Node::Until(interval, before, goal) = formula.nodes[part] else { continue };
            if !system.is_finite() {
                continue;
            }
            let Some(graph) = graphs.explore(system, STATES) else { continue };
            // Only what holds for as long as the eventuality may take keeps the path anywhere.
            let lasts = |id: &FormulaId| {
                let (always, inner) = formula.globally(*id)?;
                let long = always.hi.is_none_or(|hi| interval.hi.is_some_and(|end| end <= hi));
                (always.lo == 0 && long).then_some(inner)
            };
            let safe: Vec<FormulaId> = parts.iter().filter_map(lasts).collect();
            let place = Place { objective, system, graph: &graph, path };
            let begins = |state: &StateIx| parts.iter().all(|&id| place.may(id, *state));
            let stays = |state: &StateIx| {
                let live = objective.mode != Mode::Bounded || graph.rank[*state as usize] == LIVE;
                live && safe.iter().all(|&id| place.may(id, *state))
            };
            let first: Vec<StateIx> =
                graph.initial.iter().copied().filter(|state| begins(state) && stays(state)).collect();
            let Some(reached) =
                explore(&graph, first, &stays, &|state| place.may(before, *state), &|state| {
                    place.may(goal, *state)
                })
            else {
                continue;
            };
            let reached = reached.into_iter().map(|state| graph.state(system, state)).collect();
            return Some(Wall { part, path, reached, states: graph.len() });
        }
    }
    None
}

/// A path in its system.
struct Place<'a> {
    objective: &'a Objective,
    system: &'a System,
    graph: &'a Graph,
    path: PathId,
}

impl Place<'_> {
    /// Whether a subformula may hold where the path is in a state.
    fn may(&self, id: FormulaId, state: StateIx) -> bool {
        let mut leaf = |leaf: &PathLeaf| match *leaf {
            PathLeaf::State(path, leaf) if path == self.path => self.value(state, leaf),
            _ => None,
        };
        now(&self.objective.formula, id, &mut leaf) != Some(false)
    }

    fn value(&self, state: StateIx, leaf: Leaf) -> Option<Value> {
        let ty = match leaf {
            Leaf::Var(var) => &self.system.vars[var].ty,
            Leaf::Label(label) => &self.system.labels[label].ty,
        };
        Some(decode(ty, self.graph.leaf(self.system, state, leaf)))
    }
}

/// The states that are reached, in the order in which they are; `None` where a goal is among them.
fn explore(
    graph: &Graph,
    first: Vec<StateIx>,
    stays: &dyn Fn(&StateIx) -> bool,
    goes_on: &dyn Fn(&StateIx) -> bool,
    goal: &dyn Fn(&StateIx) -> bool,
) -> Option<Vec<StateIx>> {
    let mut seen = vec![false; graph.len()];
    let mut reached = Vec::new();
    let mut waiting = VecDeque::from(first);
    for &state in &waiting {
        seen[state as usize] = true;
    }
    while let Some(state) = waiting.pop_front() {
        if goal(&state) {
            return None;
        }
        if !goes_on(&state) {
            continue;
        }
        reached.push(state);
        for &(_, next) in graph.successors(state) {
            if !std::mem::replace(&mut seen[next as usize], true) && stays(&next) {
                waiting.push_back(next);
            }
        }
    }
    Some(reached)
}
