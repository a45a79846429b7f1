//! From a counterexample to the instance that it stands for.

use crate::Encoder;
use crate::explicit::FixedPath;
use crate::inputs::{Inputs, Move, Start};
use crate::moves::Moves;
use crate::path::{Instance, Known};
use crate::symbolic::FixedRows;
use hyperplan_problem::{PathId, State};
use std::rc::Rc;

/// The inputs of a path, in terms of paths before it where the objective compares them and they agree. Under the
/// other paths given, the inputs describe exactly the counterexample.
pub(crate) fn generalize(
    encoder: &Encoder<'_>,
    path: PathId,
    counterexample: &Known,
    before: &[Option<Known>],
) -> Instance {
    let tied = encoder.tied_before(path);
    let alike = encoder.compared_before(path);
    match counterexample {
        Known::Explicit(own) => {
            let other = |p: PathId| match before[usize::from(p)].as_ref() {
                Some(Known::Explicit(other)) => Some((p, other)),
                _ => None,
            };
            let tied: Vec<(PathId, &FixedPath)> = tied.into_iter().filter_map(other).collect();
            let start = alike
                .into_iter()
                .filter_map(other)
                .find(|(_, o)| Rc::ptr_eq(&o.graph, &own.graph) && o.states[0] == own.states[0])
                .map_or(Start::State(own.states[0]), |(p, _)| Start::Same(p));
            let quantifier = |p: PathId| encoder.objective.paths[p].quantifier;
            let chosen = |p: PathId| quantifier(p) != quantifier(path);
            let moves = (0..own.letters.len()).map(|time| explicit_move(own, &tied, &chosen, time)).collect();
            Instance::Explicit(Inputs { start, moves, values: Vec::new() })
        }
        Known::Symbolic(own) => {
            let other = |p: PathId| match before[usize::from(p)].as_ref() {
                Some(Known::Symbolic(other)) => Some((p, other)),
                _ => None,
            };
            let tied: Vec<(PathId, &FixedRows)> = tied.into_iter().filter_map(other).collect();
            let start: Start<State> = alike
                .into_iter()
                .filter_map(other)
                .find(|(_, o)| o.rows[0] == own.rows[0])
                .map_or_else(|| Start::State(own.rows[0].clone()), |(p, _)| Start::Same(p));
            let moves = (0..own.actions.len())
                .map(|time| {
                    let (action, number) = (own.actions[time], own.numbers[time]);
                    match tied.iter().find(|(_, o)| o.actions.get(time) == Some(&action)) {
                        Some(&(p, _)) => Move::SameAction(p, number),
                        None => Move::Act(action, number),
                    }
                })
                .collect();
            let open = encoder.model(path).moves.as_deref().is_some_and(Moves::has_inputs);
            let values = if open { own.rows[1..].to_vec() } else { Vec::new() };
            Instance::Symbolic(Inputs { start, moves, values })
        }
    }
}

/// A path of the same player is an instance like this one: of its steps the actions are known, not the outcomes.
fn explicit_move(
    own: &FixedPath,
    tied: &[(PathId, &FixedPath)],
    chosen: &dyn Fn(PathId) -> bool,
    time: usize,
) -> Move {
    let letter = own.letters[time];
    let (action, number) = own.graph.letters[letter as usize];
    let same_letter =
        |o: &FixedPath| Rc::ptr_eq(&o.graph, &own.graph) && o.letters.get(time) == Some(&letter);
    match tied.iter().find(|(_, o)| o.actions.get(time) == Some(&action)) {
        Some(&(p, other)) if chosen(p) && same_letter(other) => Move::Same(p),
        Some(&(p, _)) => Move::SameAction(p, number),
        None => Move::Act(action, number),
    }
}
