//! The concrete path that an instance describes once the paths that it refers to are known.

use crate::eval::{code, holds_in};
use crate::explicit::FixedPath;
use crate::graph::Graph;
use crate::inputs::{Inputs, Move, Start};
use crate::moves::Moves;
use crate::path::{Instance, Known};
use crate::reach::lasts;
use crate::symbolic::FixedRows;
use crate::{Encoder, Row, StateIx};
use hyperplan_problem::{ActionId, Mode, PathId, State};
use std::rc::Rc;

/// `None` where the instance describes no path: then it asks for nothing.
pub(crate) fn realize(
    encoder: &Encoder<'_>,
    path: PathId,
    instance: &Instance,
    known: &[Option<Known>],
) -> Option<Known> {
    let other = |p: PathId| known[usize::from(p)].as_ref();
    match instance {
        Instance::Explicit(inputs) => {
            let graph = encoder.graph(path)?;
            explicit(encoder, graph, path, inputs, &other).map(Known::Explicit)
        }
        Instance::Symbolic(inputs) => {
            let moves = encoder.model(path).moves.as_deref()?;
            symbolic(encoder, moves, path, inputs, &other).map(Known::Symbolic)
        }
    }
}

fn action_of(other: Option<&Known>, time: usize) -> Option<ActionId> {
    match other? {
        Known::Explicit(p) => p.actions.get(time).copied(),
        Known::Symbolic(p) => p.actions.get(time).copied(),
    }
}

fn explicit<'k>(
    encoder: &Encoder<'_>,
    graph: &Rc<Graph>,
    path: PathId,
    inputs: &Inputs<StateIx>,
    other: &impl Fn(PathId) -> Option<&'k Known>,
) -> Option<FixedPath> {
    let mut at = match inputs.start {
        Start::State(state) => state,
        Start::Same(p) => match other(p)? {
            Known::Explicit(o) => o.states[0],
            Known::Symbolic(_) => return None,
        },
    };
    let (mut states, mut letters) = (vec![at], Vec::new());
    for (time, movement) in inputs.moves.iter().enumerate() {
        let next = match *movement {
            Move::Same(p) => match other(p)? {
                Known::Explicit(o) => graph.successor(at, *o.letters.get(time)?)?,
                Known::Symbolic(_) => return None,
            },
            Move::SameAction(p, number) => graph.outcome(at, action_of(other(p), time)?, number)?,
            Move::Act(action, number) => graph.outcome(at, action, number)?,
        };
        let action = match *movement {
            Move::Act(action, _) => action,
            Move::Same(p) | Move::SameAction(p, _) => action_of(other(p), time)?,
        };
        letters.push(graph.letter_of(at, action, next)?);
        states.push(next);
        at = next;
    }
    let end = inputs.moves.len() as u32;
    let start_is_initial = graph.initial.contains(&states[0]);
    (start_is_initial && lasts(encoder.objective.mode, graph, at, end))
        .then(|| FixedPath::new(graph.clone(), states, letters))
        .filter(|p| p.states.len() == encoder.horizon(path) as usize + 1)
}

fn symbolic<'k>(
    encoder: &Encoder<'_>,
    moves: &Moves,
    path: PathId,
    inputs: &Inputs<State>,
    other: &impl Fn(PathId) -> Option<&'k Known>,
) -> Option<FixedRows> {
    let system = encoder.system(path);
    let first = match &inputs.start {
        Start::State(row) => row.clone(),
        Start::Same(p) => match other(*p)? {
            Known::Symbolic(o) => o.rows[0].clone(),
            Known::Explicit(_) => return None,
        },
    };
    if holds_in(system, &system.init, &first) != Some(true) {
        return None;
    }
    let mut fixed = FixedRows { rows: vec![first], actions: Vec::new(), numbers: Vec::new() };
    for (time, movement) in inputs.moves.iter().enumerate() {
        let (action, preferred) = match *movement {
            Move::Act(action, number) => (action, number),
            Move::SameAction(p, number) => (action_of(other(p), time)?, number),
            Move::Same(p) => (action_of(other(p), time)?, 0),
        };
        let from = fixed.rows.last()?;
        let values = inputs.values.get(time).unwrap_or(from);
        let (number, next) = moves.preferred(system, from, action, preferred, values)?;
        fixed.rows.push(next);
        fixed.actions.push(action);
        fixed.numbers.push(number);
    }
    let model = encoder.model(path);
    let live = match (&model.live, encoder.objective.mode) {
        (Some(live), Mode::Bounded) => {
            let last: Row = fixed.rows.last()?.iter().map(|&value| code(value)).collect();
            live.binary_search(&last).is_ok()
        }
        _ => true,
    };
    live.then_some(fixed)
}
