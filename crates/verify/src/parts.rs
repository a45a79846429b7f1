//! What the parts of an objective come to on given paths, time by time.

use crate::atoms::translated;
use crate::report::{Budget, Error, Stop};
use crate::residual::ResidualId;
use crate::search::{Fixed, Search};
use hyperplan_problem::{FormulaId, Objective, Problem, Trace};

/// For each of these parts of the formula, what is known of it once positions 0 to t of the paths were read, for each t up
/// to the longest trace's end: whether it holds at time 0, or `None` while that is open. It stays open where it reads a path
/// that is not given. `None` for all if the budget does not suffice.
///
/// # Errors
/// If a number on the way does not fit, or the problem is malformed.
pub fn progress_of(
    problem: &Problem,
    objective: &Objective,
    traces: &[Trace],
    parts: &[FormulaId],
    budget: &Budget,
) -> Result<Option<Vec<Vec<Option<bool>>>>, Error> {
    read(problem, objective, traces, parts, budget, false)
}

/// For each of these parts, whether it holds at each time when its paths are read from there on as far as one position
/// tells: what an atom says then. `None` where a single position does not tell.
///
/// # Errors
/// As [`progress_of`].
pub fn holds_at(
    problem: &Problem,
    objective: &Objective,
    traces: &[Trace],
    parts: &[FormulaId],
    budget: &Budget,
) -> Result<Option<Vec<Vec<Option<bool>>>>, Error> {
    read(problem, objective, traces, parts, budget, true)
}

fn read(
    problem: &Problem,
    objective: &Objective,
    traces: &[Trace],
    parts: &[FormulaId],
    budget: &Budget,
    anew: bool,
) -> Result<Option<Vec<Vec<Option<bool>>>>, Error> {
    match read_all(problem, objective, traces, parts, budget, anew) {
        Ok(all) => Ok(Some(all)),
        Err(Stop::Budget) => Ok(None),
        Err(Stop::Error(error)) => Err(error),
    }
}

fn read_all(
    problem: &Problem,
    objective: &Objective,
    traces: &[Trace],
    parts: &[FormulaId],
    budget: &Budget,
    anew: bool,
) -> Result<Vec<Vec<Option<bool>>>, Stop> {
    let mut search = Search::new(problem, objective, objective.paths.len(), budget)?;
    // The same residuals again, of all parts.
    let (of_parts, _) = translated(objective, &mut search.residuals)?;
    for trace in traces {
        let graph = &mut search.graphs[objective.paths[trace.path].system];
        let mut states = Vec::with_capacity(trace.states.len());
        for state in &trace.states {
            if !graph.is_state(state) {
                return Err(Error::Malformed { what: "a trace has something that is no state" }.into());
            }
            states.push(graph.intern(state)?);
        }
        search.fixed.push(Fixed { path: trace.path, states, actions: trace.actions.clone() });
    }
    let mut now: Vec<ResidualId> = parts.iter().map(|part| of_parts[usize::from(*part)].0).collect();
    let begin = now.clone();
    let mut said = vec![Vec::new(); parts.len()];
    let end = traces.iter().map(|trace| trace.states.len()).max().unwrap_or(0);
    for time in 0..end {
        search.time = u32::try_from(time).unwrap_or(u32::MAX);
        let valuation = search.enter()?;
        for (part, said) in said.iter_mut().enumerate() {
            let from = if anew { begin[part] } else { now[part] };
            let next = search.progress.read(&mut search.residuals, &search.valuations, from, valuation)?;
            now[part] = next;
            said.push(match next {
                ResidualId::TRUE => Some(true),
                ResidualId::FALSE => Some(false),
                _ => None,
            });
        }
    }
    Ok(said)
}
