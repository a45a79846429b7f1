//! A system's reachable states, enumerated.
//!
//! Transitions are made deterministic by *letters*: a letter is an action and the number of one of its outcomes, so
//! that a state and a letter have at most one successor. A system whose actions are deterministic has one letter an
//! action.

use crate::eval::{code, decode, eval};
use crate::row::Row;
use hyperplan_problem::{ActionId, Expr, Leaf, State, System, Value};
use std::sync::OnceLock;

/// The index of a state of a [`Graph`].
pub type StateIx = u32;

/// The index of a letter of a [`Graph`].
pub type Letter = u32;

/// The number of steps that a state allows, where there is no limit: the state is live.
pub const LIVE: u32 = u32::MAX;

/// All states reachable from the initial ones, with every transition between them.
#[derive(Debug)]
pub struct Graph {
    /// Number of variables: how many of `codes` belong to a state.
    pub(crate) width: usize,
    /// The codes of the states' variables, one state after the other.
    pub(crate) codes: Vec<i64>,
    /// The initial states, sorted by their codes.
    pub initial: Vec<StateIx>,
    /// The action and the outcome number of each letter; the letters of an action are neighbours.
    pub letters: Vec<(ActionId, u32)>,
    /// Where each state's transitions start in `transitions`.
    pub(crate) starts: Vec<u32>,
    /// `(letter, successor)`, by letter.
    pub(crate) transitions: Vec<(Letter, StateIx)>,
    /// The length of the longest path from each state; [`LIVE`] where there is no longest.
    pub rank: Vec<u32>,
    /// What each label is, by state; of those that were asked for.
    pub(crate) labels: Vec<OnceLock<Box<[i64]>>>,
}

/// Transitions that a budget of one state allows.
pub(crate) const EDGES: usize = 16;

/// Why a system was not enumerated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl Graph {
    /// Number of states.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rank.len()
    }

    /// Whether there is no state at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rank.is_empty()
    }

    /// Whether it has no more states than a budget, and no more transitions than go with it.
    pub(crate) fn fits(&self, budget: usize) -> bool {
        self.len() <= budget && self.transitions.len() <= budget.saturating_mul(EDGES)
    }

    /// The codes of a state's variables.
    #[must_use]
    pub fn codes(&self, state: StateIx) -> &[i64] {
        let at = state as usize * self.width;
        &self.codes[at..at + self.width]
    }

    /// What a variable or a label of the graph's system is in a state, as a code.
    #[must_use]
    pub fn leaf(&self, system: &System, state: StateIx, leaf: Leaf) -> i64 {
        match leaf {
            Leaf::Var(var) => self.codes(state)[usize::from(var)],
            Leaf::Label(label) => {
                self.labels[usize::from(label)].get_or_init(|| self.label(system, leaf))[state as usize]
            }
        }
    }

    /// What a label is in each state.
    fn label(&self, system: &System, label: Leaf) -> Box<[i64]> {
        let mut row = Row::new(system);
        let mut of = |state| {
            row.turn(self.codes(state));
            row.leaf(label)
        };
        (0..self.len() as StateIx).map(&mut of).collect()
    }

    /// A state as values.
    #[must_use]
    pub fn state(&self, system: &System, state: StateIx) -> State {
        self.codes(state).iter().zip(&system.vars).map(|(&c, var)| decode(&var.ty, c)).collect()
    }

    /// The initial state with these values, if it is one: they are sorted by their codes.
    #[must_use]
    pub fn initial_state(&self, values: &[Value]) -> Option<StateIx> {
        let codes: Vec<i64> = values.iter().map(|&value| code(value)).collect();
        let at = self.initial.binary_search_by(|&state| self.codes(state).cmp(&codes)).ok()?;
        Some(self.initial[at])
    }

    /// The transitions of a state, by letter.
    #[must_use]
    pub fn successors(&self, state: StateIx) -> &[(Letter, StateIx)] {
        let at = state as usize;
        &self.transitions[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// The position of a state's first transition among all.
    #[must_use]
    pub fn first_transition(&self, state: StateIx) -> usize {
        self.starts[state as usize] as usize
    }

    /// Where a letter leads.
    #[must_use]
    pub fn successor(&self, state: StateIx, letter: Letter) -> Option<StateIx> {
        let all = self.successors(state);
        all.binary_search_by_key(&letter, |t| t.0).ok().map(|at| all[at].1)
    }

    /// The transition with that action whose outcome has this number, or the last outcome where there are fewer.
    #[must_use]
    pub fn outcome(&self, state: StateIx, action: ActionId, number: u32) -> Option<(Letter, StateIx)> {
        self.of_action(state, action).take_while(|t| self.letters[t.0 as usize].1 <= number).last()
    }

    /// The transition with that action to the state with these values, where there is one.
    #[must_use]
    pub fn step_to(&self, state: StateIx, action: ActionId, values: &[Value]) -> Option<(Letter, StateIx)> {
        let codes: Vec<i64> = values.iter().map(|&value| code(value)).collect();
        self.of_action(state, action).find(|t| self.codes(t.1) == codes)
    }

    /// The transitions of a state with an action.
    pub fn of_action(
        &self,
        state: StateIx,
        action: ActionId,
    ) -> impl Iterator<Item = (Letter, StateIx)> + '_ {
        let all = self.successors(state).iter().copied();
        all.filter(move |(letter, _)| self.letters[*letter as usize].0 == action)
    }

    /// Whether a state has a transition with that action, live or not.
    #[must_use]
    pub fn enables(&self, state: StateIx, action: ActionId) -> bool {
        self.of_action(state, action).next().is_some()
    }

    /// The least number of steps from one of these states to one in which an expression over the system's states holds.
    #[must_use]
    pub fn steps_to(&self, system: &System, starts: Vec<StateIx>, expr: &Expr<Leaf>) -> Option<u32> {
        let holds = |state: StateIx| eval(expr, &mut |leaf| self.leaf(system, state, *leaf)) != 0;
        let mut met = vec![false; self.len()];
        let mut now = starts;
        for steps in 0.. {
            now.retain(|&state| !std::mem::replace(&mut met[state as usize], true));
            if now.is_empty() {
                break;
            }
            if now.iter().any(|&state| holds(state)) {
                return Some(steps);
            }
            let next = now.iter().flat_map(|&state| self.successors(state)).map(|&(_, next)| next);
            now = next.filter(|&next| !met[next as usize]).collect();
        }
        None
    }

    /// Whether every transition of a state leads back to it; so too where there is none.
    #[must_use]
    pub fn halts(&self, state: StateIx) -> bool {
        self.successors(state).iter().all(|&(_, next)| next == state)
    }

    /// Whether every state is live.
    #[must_use]
    pub fn all_live(&self) -> bool {
        self.rank.iter().all(|&r| r == LIVE)
    }
}

/// From where edges, each with its source and its target, lead to each of `count` nodes, once per edge: where the sources
/// of each start, and they.
#[must_use]
pub fn sources(count: usize, edges: impl Iterator<Item = (u32, u32)> + Clone) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; count + 2];
    for (_, to) in edges.clone() {
        starts[to as usize + 2] += 1;
    }
    for at in 2..starts.len() {
        starts[at] += starts[at - 1];
    }
    // Filling in a node's sources moves the start of its own to that of the next node's.
    let mut sources = vec![0; starts[count + 1] as usize];
    for (from, to) in edges {
        let slot = &mut starts[to as usize + 1];
        sources[*slot as usize] = from;
        *slot += 1;
    }
    (starts, sources)
}
