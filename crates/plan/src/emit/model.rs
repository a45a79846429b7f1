//! From a model of an emitted query back to paths.

use super::settled;
use crate::direct;
use crate::fact::{Error, Unsupported};
use crate::prepare::is_existential;
use hyperplan_encode::{Encoder, Goal, Limits, Narrowing, Paths, Pruning, States};
use hyperplan_problem::{Objective, PathId, Problem, Strategy};
use hyperplan_smt::{Evaluation, Function, Model, Sort, Term, Terms, Value, is_large_number};
use hyperplan_solver::{Deadline, PrintedModel, PrintedModelError};
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
    let stop = || deadline.passed();
    let mut try_reading = |states, paths, pruning| {
        let limits = Limits { pruning, ..Limits::default() };
        // What cannot be written so was not written so.
        let how = (Some(states), paths);
        readings.extend(settled(problem, objective, how, limits, &stop, |encoder| read(encoder, model)).ok());
    };
    for states in [States::Onehot, States::Enum, States::Bitvec, States::Int, States::Real] {
        for pruning in [Pruning::Full, Pruning::Light, Pruning::None] {
            try_reading(states, Paths::Symbols, pruning);
        }
    }
    for states in [States::Bitvec, States::Int, States::Real] {
        for paths in [Paths::Functions, Paths::Policies] {
            // Of variables nothing is left out.
            try_reading(states, paths, Pruning::Full);
        }
    }
    // The same symbols may stand for numbers of several sorts, of which their values fit some.
    let rank = |reading: &Reading| (Reverse(reading.present), reading.absent, reading.fit());
    match readings.into_iter().min_by_key(rank) {
        Some(reading) if reading.present > 0 || reading.absent == 0 => reading.strategy,
        _ if deadline.passed() => Err(Unsupported::OutOfTime.into()),
        _ if model.is_empty() => Err(Unsupported::Value(PrintedModelError::Empty).into()),
        _ => Err(Unsupported::ForeignModel(objective.name.clone()).into()),
    }
}

/// A model read in one way.
struct Reading {
    /// Symbols and functions of the leading block's paths that the model has, and that it has not.
    present: usize,
    absent: usize,
    strategy: Result<Strategy, Error>,
}

impl Reading {
    /// How well the values fit: the less the better.
    fn fit(&self) -> u8 {
        match &self.strategy {
            Ok(_) => 0,
            Err(Error::Unsupported(Unsupported::Value(_))) => 2,
            Err(_) => 1,
        }
    }
}

fn read(encoder: &Encoder<'_>, printed: &PrintedModel) -> Result<Reading, Error> {
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let goal = Goal::new(&objective.formula, is_existential(objective));
    let direct = direct::leading(encoder, &blocks, &goal, Narrowing::default())?;
    let terms = &direct.query.script.terms;
    let symbols = direct.query.script.symbols();
    let functions = direct.query.script.functions();
    let known = functions.iter().filter(|&&function| printed.has_function(terms, function)).count();
    let present = symbols.iter().filter(|&&symbol| printed.has(terms, symbol)).count() + known;
    let absent = symbols.len() + functions.len() - present;
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
    // What no assertion reads is not printed, but a part of the paths.
    let paths = block.iter().filter_map(|&path| direct.path(path));
    let described: Vec<Term> = paths.flat_map(|path| direct.query.paths.symbols(path)).collect();
    let (unread, applied): (Vec<Term>, Vec<Term>) = described.iter().partition(|&&t| terms.is_symbol(t));
    for &symbol in symbols.iter().chain(&unread) {
        let sort = terms.sort(symbol);
        let value = printed.value(terms, symbol).map_err(|error| match &error {
            PrintedModelError::Value { value, .. }
                if matches!(sort, Sort::Int | Sort::Real) && is_large_number(value) =>
            {
                Unsupported::LargeModel
            }
            _ => Unsupported::Value(error),
        })?;
        // A symbol that does not matter may be left out; any value will do.
        model.insert(symbol, value.unwrap_or_else(|| Value::default_of(sort)));
    }
    if !applied.is_empty() {
        apply(terms, &direct.query.script.functions(), &applied, printed, &mut model)?;
    }
    let trace = |&path: &PathId| {
        let declared = direct.path(path)?;
        Some(direct.query.paths.decode(declared, &model)?.trace(path))
    };
    let traces: Option<Vec<_>> = block.iter().map(trace).collect();
    // A model that was read describes paths, unless its numbers are too large for ours.
    let none = if direct.query.encoder.is_finite() { Unsupported::NoPaths } else { Unsupported::LargeModel };
    Ok(Strategy { traces: traces.ok_or(none)? })
}

/// Adds what functions give where paths read them. What they are where nothing is said of them does not matter.
fn apply(
    terms: &Terms,
    functions: &[Function],
    applied: &[Term],
    printed: &PrintedModel,
    model: &mut Model,
) -> Result<(), Error> {
    for &function in functions {
        if let Some(definition) = printed.function(terms, function).map_err(Unsupported::Value)? {
            model.define(function, definition.clone());
        }
    }
    let evaluation = Evaluation::new(terms, model);
    // What is not known was not read, or is too large.
    let values = applied.iter().filter_map(|&t| Some((t, evaluation.value(terms, t)?)));
    model.extend(values.collect::<Vec<_>>());
    Ok(())
}
