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

    /// The path with these states and the actions between them; `None` where it is none.
    #[must_use]
    pub fn of(graph: &Arc<Graph>, states: &[State], actions: &[ActionId]) -> Option<Run> {
        let start = graph.initial_state(states.first()?)?;
        let (mut at, mut letters) = (start, Vec::with_capacity(actions.len()));
        for (action, next) in actions.iter().zip(&states[1..]) {
            let (letter, to) = graph.step_to(at, *action, next)?;
            letters.push(letter);
            at = to;
        }
        Run::replay(graph, start, letters)
    }

    /// As a trace of the typed problem.
    #[must_use]
    pub fn trace(&self, path: PathId, system: &System) -> Trace {
        let states: Vec<State> = self.states.iter().map(|&state| self.graph.state(system, state)).collect();
        Trace { path, states, actions: self.actions.clone() }
    }
}
