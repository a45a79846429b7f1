//! What determines a path: where it starts and how it moves, in terms of other paths where possible.
//!
//! A counterexample is turned into inputs before it becomes an instance. Where the counterexample's action equals
//! that of a path quantified before it, and the objective compares the two, the instance says "the same action as
//! that path, whatever it is": then one instance defeats every candidate with the same weakness.

use hyperplan_problem::{ActionId, Objective, PathId, State, Trace};

/// Where a path starts.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// In this state.
    State(State),
    /// Where the other path starts.
    Same(PathId),
}

/// One step of a path. How the outcomes of an action are numbered is up to who writes the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Move {
    /// The same action with the same outcome number as the other path, which another player chooses.
    Same(PathId),
    /// The same action as the other path, with this outcome.
    SameAction(PathId, u32),
    /// This action, with this outcome.
    Act(ActionId, u32),
}

impl Move {
    /// The action, given those of the other paths.
    pub fn action(self, of: impl Fn(PathId) -> Option<ActionId>) -> Option<ActionId> {
        match self {
            Move::Act(action, _) => Some(action),
            Move::Same(path) | Move::SameAction(path, _) => of(path),
        }
    }
}

/// An instance of a path: where it starts and how it moves.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Instance {
    /// Its initial state.
    pub start: Start,
    /// Its steps.
    pub moves: Vec<Move>,
    /// For each step, a state with the values of what its update leaves open; empty where a system has no such
    /// updates.
    pub values: Vec<State>,
}

impl Instance {
    /// Whether it refers to no other path.
    pub fn is_absolute(&self) -> bool {
        matches!(self.start, Start::State(_)) && self.moves.iter().all(|m| matches!(m, Move::Act(..)))
    }
}

/// A path of which everything is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// Its states, from time 0.
    pub states: Vec<State>,
    /// The actions between them.
    pub actions: Vec<ActionId>,
    /// The number of each action's outcome.
    pub numbers: Vec<u32>,
}

impl Known {
    /// As a trace of the typed problem.
    pub fn trace(&self, path: PathId) -> Trace {
        Trace { path, states: self.states.clone(), actions: self.actions.clone() }
    }
}

/// The instance that a counterexample stands for: in terms of the paths before it where the objective compares them and
/// they agree. Beside these it describes exactly the counterexample. Steps can be followed whole ([`Move::Same`]) of
/// the paths that `shares` says.
pub fn generalize(
    objective: &Objective,
    path: PathId,
    counterexample: &Known,
    before: &[Option<Known>],
    shares: &dyn Fn(PathId) -> bool,
) -> Instance {
    let others = |paths: Vec<PathId>| -> Vec<(PathId, &Known)> {
        paths.into_iter().filter_map(|p| Some((p, before[usize::from(p)].as_ref()?))).collect()
    };
    let own = counterexample;
    let start = others(objective.compared_before(path))
        .into_iter()
        .find(|(_, other)| other.states[0] == own.states[0])
        .map_or_else(|| Start::State(own.states[0].clone()), |(p, _)| Start::Same(p));
    let tied = others(objective.tied_before(path));
    // A path of the same player is an instance like this one: of its steps the actions are known, not the outcomes.
    let chosen = |p: PathId| objective.paths[p].quantifier != objective.paths[path].quantifier;
    let movement = |time: usize| {
        let (action, number) = (own.actions[time], own.numbers[time]);
        match tied.iter().find(|(_, other)| other.actions.get(time) == Some(&action)) {
            Some(&(p, other)) if shares(p) && chosen(p) && other.numbers[time] == number => Move::Same(p),
            Some(&(p, _)) => Move::SameAction(p, number),
            None => Move::Act(action, number),
        }
    };
    Instance { start, moves: (0..own.actions.len()).map(movement).collect(), values: Vec::new() }
}
