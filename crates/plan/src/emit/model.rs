//! From a model of an emitted query back to paths.

use super::settled;
use crate::direct;
use crate::fact::{Error, Unsupported};
use crate::prepare::is_existential;
use hyperplan_encode::{Encoder, Goal, Limits, Narrowing, States};
use hyperplan_problem::{Objective, PathId, Problem, Strategy};
use hyperplan_smt::{Model, Term};
use hyperplan_solver::{Deadline, PrintedModel};
use std::cmp::Reverse;

/// The paths that a model of an emitted query describes.
///
/// How states were written shows in the symbols: the way of which the model has the most, and lacks the fewest, is
/// taken.
///
/// # Errors
/// [`Error::Unsupported`] where the model belongs to no query of the objective, or a value in it cannot be read.
pub fn strategy_of_model(
    problem: &Problem,
    objective: &Objective,
    model: &PrintedModel,
    deadline: &Deadline,
) -> Result<Strategy, Error> {
    let mut readings = Vec::new();
    for states in [States::Onehot, States::Enum, States::Bitvec, States::Int, States::Real] {
        for prune in [true, false] {
            let limits = Limits { prune, ..Limits::default() };
            let stop = || deadline.passed();
            // What cannot be written so was not written so.
            let encoder =
                settled(problem, objective, Some(states), limits, &stop, |encoder| read(encoder, model));
            readings.extend(encoder.ok());
        }
    }
    let best = readings.into_iter().min_by_key(|reading| (Reverse(reading.present), reading.absent));
    match best {
        Some(reading) if reading.present > 0 || reading.absent == 0 => reading.strategy,
        _ if deadline.passed() => Err(Unsupported::OutOfTime.into()),
        _ => Err(Unsupported::ForeignModel(objective.name.clone()).into()),
    }
}

/// A model read in one way.
struct Reading {
    /// Symbols of the leading block's paths that the model has, and that it has not.
    present: usize,
    absent: usize,
    strategy: Result<Strategy, Error>,
}

fn read(encoder: &Encoder<'_>, printed: &PrintedModel) -> Result<Reading, Error> {
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let goal = Goal::new(&objective.formula, is_existential(objective));
    let direct = direct::leading(encoder, &blocks, &goal, Narrowing::default())?;
    let terms = &direct.query.script.terms;
    let symbols = direct.query.script.symbols();
    let present = symbols.iter().filter(|&&symbol| printed.has(terms, symbol)).count();
    let absent = symbols.len() - present;
    let strategy = strategy(&direct, &blocks[0], &symbols, printed);
    Ok(Reading { present, absent, strategy })
}

fn strategy(
    direct: &direct::Direct<'_, '_>,
    block: &[PathId],
    symbols: &[Term],
    printed: &PrintedModel,
) -> Result<Strategy, Error> {
    let terms = &direct.query.script.terms;
    let mut model = Model::new();
    for &symbol in symbols {
        let value = printed.value(terms, symbol).map_err(Unsupported::Value)?;
        // A symbol that does not matter may be left out; any value will do.
        model.insert(symbol, value.unwrap_or_else(|| hyperplan_smt::Value::default_of(terms.sort(symbol))));
    }
    let trace = |&path: &PathId| {
        let declared = direct.path(path)?;
        Some(direct.query.paths.decode(declared, &model)?.trace(path))
    };
    let traces: Option<Vec<_>> = block.iter().map(trace).collect();
    Ok(Strategy { traces: traces.ok_or(Unsupported::NoPaths)? })
}
