//! The terms of one path, however its states are written.

use crate::eval::code;
use crate::explicit::{ExplicitPath, FixedPath};
use crate::graph::StateIx;
use crate::inputs::{Inputs, Move, Start};
use crate::moves::Moves;
use crate::symbolic::{FixedRows, SymbolicPath};
use crate::{Encoder, Row};
use hyperplan_problem::{PathId, State, System, Trace};
use hyperplan_smt::Term;
use std::rc::Rc;

/// The terms of one path in a query.
#[derive(Debug)]
pub struct Path {
    pub(crate) shape: Shape,
    /// The moves of its system, for symbolic paths.
    pub(crate) moves: Option<Rc<Moves>>,
}

/// How the states are written.
#[derive(Debug)]
pub(crate) enum Shape {
    Explicit(ExplicitPath),
    Symbolic(SymbolicPath),
}

impl Path {
    /// The symbols whose values describe the path.
    #[must_use]
    pub fn symbols(&self) -> Vec<Term> {
        match &self.shape {
            Shape::Explicit(path) => path.symbols(),
            Shape::Symbolic(path) => path.symbols(self.moves()),
        }
    }

    pub(crate) fn moves(&self) -> &Rc<Moves> {
        self.moves.as_ref().expect("symbolic paths have moves")
    }
}

/// A path whose every state and action is known, as the encoder writes it.
#[derive(Clone, Debug)]
pub enum Known {
    /// By indices of enumerated states.
    Explicit(FixedPath),
    /// By the variables' values.
    Symbolic(FixedRows),
}

impl Known {
    /// As a trace of the typed problem.
    #[must_use]
    pub fn trace(&self, path: PathId, system: &System) -> Trace {
        match self {
            Known::Explicit(p) => Trace {
                path,
                states: p.states.iter().map(|&s| p.graph.state(system, s)).collect(),
                actions: p.actions.clone(),
            },
            Known::Symbolic(p) => Trace { path, states: p.rows.clone(), actions: p.actions.clone() },
        }
    }
}

impl Instance {
    /// Whether it refers to no other path.
    #[must_use]
    pub fn is_absolute(&self) -> bool {
        let (start, moves) = match self {
            Instance::Explicit(inputs) => (matches!(inputs.start, Start::State(_)), &inputs.moves),
            Instance::Symbolic(inputs) => (matches!(inputs.start, Start::State(_)), &inputs.moves),
        };
        start && moves.iter().all(|m| matches!(m, Move::Act(..)))
    }
}

/// A trace as the encoder writes it; `None` where it is no path of the system.
pub(crate) fn known(encoder: &Encoder<'_>, trace: &Trace) -> Option<Known> {
    let system = encoder.system(trace.path);
    let steps = encoder.horizon(trace.path) as usize;
    let actions = trace.actions.get(..steps)?.to_vec();
    if let Some(graph) = encoder.graph(trace.path).filter(|_| encoder.states.is_enumerated()) {
        let row = |state: &State| -> Row { state.iter().map(|&v| code(v)).collect() };
        let rows: Vec<Row> = trace.states.iter().map(row).collect();
        let first = *graph.initial.iter().find(|&&s| graph.row(s) == &*rows[0])?;
        let (mut states, mut letters) = (vec![first], Vec::new());
        for (at, &action) in actions.iter().enumerate() {
            let here = *states.last()?;
            let mut next = graph.successors(here).iter().map(|t| t.1);
            let next =
                next.find(|&s| graph.row(s) == &*rows[at + 1] && graph.letter_of(here, action, s).is_some())?;
            letters.push(graph.letter_of(here, action, next)?);
            states.push(next);
        }
        return Some(Known::Explicit(FixedPath::new(graph.clone(), states, letters)));
    }
    let moves = encoder.model(trace.path).moves.as_deref()?;
    let rows = &trace.states;
    let step = |at: usize| moves.number_of(system, &rows[at], actions[at], &rows[at + 1]);
    let numbers: Option<Vec<u32>> = (0..steps).map(step).collect();
    Some(Known::Symbolic(FixedRows { rows: rows[..=steps].to_vec(), actions, numbers: numbers? }))
}

/// What determines an instance of a path.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Instance {
    /// Over enumerated states.
    Explicit(Inputs<StateIx>),
    /// Over variables' values.
    Symbolic(Inputs<State>),
}
