//! Paths through a graph.

use crate::graph::{Graph, Letter, StateIx};
use hyperplan_problem::{ActionId, PathId, State, System, Trace};
use std::sync::Arc;

/// A path whose every state and letter is known.
#[derive(Clone, Debug)]
pub struct Run {
    /// The states of its system.
    pub graph: Arc<Graph>,
    /// Its states, from time 0.
    pub states: Vec<StateIx>,
    /// The letters between them.
    pub letters: Vec<Letter>,
    /// The letters' actions.
    pub actions: Vec<ActionId>,
}

impl Run {
    /// From the states and letters of a path.
    #[must_use]
    pub fn new(graph: Arc<Graph>, states: Vec<StateIx>, letters: Vec<Letter>) -> Run {
        let actions = letters.iter().map(|&l| graph.letters[l as usize].0).collect();
        Run { graph, states, letters, actions }
    }

    /// The run from a state by these letters; `None` where it gets stuck.
    #[must_use]
    pub fn replay(graph: &Arc<Graph>, start: StateIx, letters: Vec<Letter>) -> Option<Run> {
        let mut states = vec![start];
        for &letter in &letters {
            states.push(graph.successor(*states.last()?, letter)?);
        }
        Some(Run::new(graph.clone(), states, letters))
    }

    /// The first steps of a trace; `None` where they are no path, or there are fewer.
    #[must_use]
    pub fn of_trace(graph: &Arc<Graph>, trace: &Trace, steps: usize) -> Option<Run> {
        let (mut states, mut letters) = (vec![graph.initial_state(trace.states.first()?)?], Vec::new());
        for (action, next) in trace.actions.get(..steps)?.iter().zip(trace.states.get(1..)?) {
            let (letter, to) = graph.step_to(*states.last()?, *action, next)?;
            letters.push(letter);
            states.push(to);
        }
        (letters.len() == steps).then(|| Run::new(graph.clone(), states, letters))
    }

    /// As a trace of the typed problem.
    #[must_use]
    pub fn trace(&self, path: PathId, system: &System) -> Trace {
        let states: Vec<State> = self.states.iter().map(|&state| self.graph.state(system, state)).collect();
        Trace { path, states, actions: self.actions.clone() }
    }
}
