//! The two questions: does a strategy decide an objective as claimed, and is an objective true.

use crate::graph::Ahead;
use crate::horizon::horizon;
use crate::joint::JointMove;
use crate::report::{Budget, Check, Defeat, Error, Stop};
use crate::run::Outcome;
use crate::search::{Fixed, Search};
use hyperplan_problem::{Mode, Objective, Problem, Quantifier, Strategy, Trace};

/// Whether the strategy, one trace for each path variable of the objective's leading block, decides the objective
/// as claimed: where the block is `exists`, that the rest holds; where it is `forall`, that the rest fails.
///
/// # Errors
/// If the strategy is malformed, or too short for what the objective reads.
pub fn check(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    budget: &Budget,
) -> Result<Check, Error> {
    let fixed = objective.leading_block().len();
    if fixed == 0 {
        return Err(Error::Malformed { what: "an objective has no path variable" });
    }
    let mut search = match Search::new(problem, objective, fixed, budget) {
        Ok(search) => search,
        Err(stop) => return too_large(stop, None, budget),
    };
    match checked(&mut search, objective, strategy) {
        Ok(None) => Ok(Check::Holds),
        Ok(Some(defeat)) => Ok(Check::Fails(defeat)),
        Err(stop) => too_large(stop, Some(&search), budget),
    }
}

/// Whether the objective is true, or `None` where the budget does not suffice to tell.
///
/// # Errors
/// If the problem is malformed.
pub fn decide(problem: &Problem, objective: &Objective, budget: &Budget) -> Result<Option<bool>, Error> {
    if objective.paths.is_empty() {
        return Err(Error::Malformed { what: "an objective has no path variable" });
    }
    let outcome = Search::new(problem, objective, 0, budget).and_then(|mut search| search.run(false));
    match outcome {
        Ok(Outcome::Decided(truth, _)) => Ok(Some(truth)),
        Ok(Outcome::Missing) => Err(Error::Malformed { what: "an atom of the objective has no value" }),
        Err(Stop::Budget) => Ok(None),
        Err(Stop::Error(error)) => Err(error),
    }
}

/// The truth value of a formula whose paths are all given, one trace for each path variable in order, and the first time at
/// which what was read of them decides it; `None` where that takes more than the budget.
///
/// # Errors
/// If a trace is malformed, or too short for what the formula reads.
pub fn settled(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    budget: &Budget,
) -> Result<Option<(bool, u32)>, Error> {
    settled_beside(problem, objective, objective.paths.len(), strategy, budget)
}

/// As [`settled`], of an objective under a strategy, one trace for each path variable of its leading block: whatever the other
/// paths do.
///
/// # Errors
/// Those of [`settled`].
pub fn settled_for_others(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    budget: &Budget,
) -> Result<Option<(bool, u32)>, Error> {
    settled_beside(problem, objective, objective.leading_block().len(), strategy, budget)
}

/// Where so many paths are given.
fn settled_beside(
    problem: &Problem,
    objective: &Objective,
    given: usize,
    strategy: &Strategy,
    budget: &Budget,
) -> Result<Option<(bool, u32)>, Error> {
    let outcome = Search::new(problem, objective, given, budget).and_then(|mut search| {
        for trace in &strategy.traces {
            let fixed = well_formed(&mut search, objective, trace)?;
            search.fixed.push(fixed);
        }
        Ok((search.run(false)?, search.time))
    });
    match outcome {
        Ok((Outcome::Decided(truth, _), time)) => Ok(Some((truth, time))),
        Ok((Outcome::Missing, _)) => Err(too_short(objective, strategy)),
        Err(Stop::Budget) => Ok(None),
        Err(Stop::Error(error)) => Err(error),
    }
}

fn too_large(stop: Stop, search: Option<&Search<'_>>, budget: &Budget) -> Result<Check, Error> {
    match stop {
        Stop::Budget => {
            let reached = search.map(Search::reached).unwrap_or_default();
            Ok(Check::TooLarge { budget: *budget, reached })
        }
        Stop::Error(error) => Err(error),
    }
}

fn checked(
    search: &mut Search<'_>,
    objective: &Objective,
    strategy: &Strategy,
) -> Result<Option<Defeat>, Stop> {
    let leading = objective.leading_block();
    if !leading.iter().eq(strategy.traces.iter().map(|t| &t.path)) {
        let names: Vec<&str> = leading.iter().map(|&p| objective.paths[p].name.as_str()).collect();
        return Err(Error::WrongPaths { expected: names.join(", ") }.into());
    }
    // All that is malformed is reported before anything that fails.
    for trace in &strategy.traces {
        let fixed = well_formed(search, objective, trace)?;
        search.fixed.push(fixed);
    }
    for index in 0..search.fixed.len() {
        if let Some(defeat) = no_path(search, objective, index)? {
            return Ok(Some(defeat));
        }
    }
    let claimed = objective.paths.first().is_some_and(|p| p.quantifier == Quantifier::Exists);
    match search.run(true)? {
        Outcome::Decided(truth, _) if truth == claimed => Ok(None),
        Outcome::Decided(_, Some(chain)) if strategy.traces.len() < objective.paths.len() => {
            Ok(Some(Defeat::Paths(defeating(search, objective, &chain)?)))
        }
        Outcome::Decided(..) => Ok(Some(Defeat::Formula)),
        Outcome::Missing => Err(too_short(objective, strategy).into()),
    }
}

/// Interns a trace whose states and actions are those of its system and whose lengths fit.
fn well_formed(search: &mut Search<'_>, objective: &Objective, trace: &Trace) -> Result<Fixed, Stop> {
    let var = &objective.paths[trace.path];
    let path = || var.name.clone();
    let steps = trace.actions.len();
    if trace.states.len() != steps + 1 {
        return Err(Error::Lengths { path: path(), states: trace.states.len(), actions: steps }.into());
    }
    let length = match objective.mode {
        Mode::Within(k) => Some(u64::from(k)),
        Mode::Bounded => search.ends[trace.path],
    };
    if length.is_some_and(|length| steps as u64 != length) {
        return Err(wrong_length(objective, trace).into());
    }
    let graph = &mut search.graphs[var.system];
    if let Some(step) = trace.actions.iter().position(|a| !graph.system.actions.contains(a)) {
        return Err(Error::NotAnAction { path: path(), step }.into());
    }
    let mut states = Vec::with_capacity(trace.states.len());
    for (step, state) in trace.states.iter().enumerate() {
        if !graph.is_state(state) {
            return Err(Error::NotAState { path: path(), step }.into());
        }
        states.push(graph.intern(state)?);
    }
    Ok(Fixed { path: trace.path, states, actions: trace.actions.clone() })
}

/// Why a trace is not (the beginning of) a path of its system.
fn no_path(search: &mut Search<'_>, objective: &Objective, index: usize) -> Result<Option<Defeat>, Stop> {
    let Search { fixed, graphs, ends, .. } = search;
    let trace = &fixed[index];
    let path = trace.path;
    let graph = &mut graphs[objective.paths[path].system];
    if let Some(&first) = trace.states.first()
        && !graph.is_initial(first)?
    {
        return Ok(Some(Defeat::NotInitial { path }));
    }
    for (step, (pair, &action)) in trace.states.windows(2).zip(&trace.actions).enumerate() {
        if !graph.has_step(pair[0], action, pair[1])? {
            return Ok(Some(Defeat::NoTransition { path, step }));
        }
    }
    if let (Mode::Bounded, None, Some(&last)) = (objective.mode, ends[path], trace.states.last())
        && !graph.can_go(last, Ahead::Forever)?
    {
        return Ok(Some(Defeat::DeadEnd { path }));
    }
    Ok(None)
}

/// The traces of the first free block along the moves that decide it, continued in any way to the length that the
/// objective reads: whatever follows, they defeat the claim.
fn defeating(
    search: &mut Search<'_>,
    objective: &Objective,
    chain: &[JointMove],
) -> Result<Vec<Trace>, Stop> {
    let Search { graphs, levels, mode, ends, .. } = search;
    let joint = &levels[0].joint;
    let mut traces = Vec::new();
    for (i, &(path, system)) in joint.paths.iter().enumerate() {
        let graph = &mut graphs[system];
        let mut ids: Vec<_> = chain.iter().map(|mv| joint.states(mv.to)[i]).collect();
        let mut actions: Vec<_> = chain.iter().filter_map(|mv| joint.deed(mv.deed)[i]).collect();
        let length = match mode {
            Mode::Bounded => horizon(objective, path).min(LONGEST_DEFEAT),
            Mode::Within(k) => u64::from(*k),
        };
        if let Some(end) = ends[path].and_then(|end| usize::try_from(end).ok()) {
            // Beyond its end it only waited for the others.
            ids.truncate(end + 1);
        }
        while let (Some(&last), Some(rest)) = (ids.last(), length.checked_sub(actions.len() as u64 + 1)) {
            let ahead = match mode {
                Mode::Bounded if ends[path].is_none() => Ahead::Forever,
                _ => Ahead::Steps(u32::try_from(rest).unwrap_or(u32::MAX)),
            };
            let mut onward = None;
            for mv in graph.moves(last)?.to_vec() {
                if graph.can_go(mv.to, ahead)? {
                    onward = Some(mv);
                    break;
                }
            }
            let Some(mv) = onward else { break };
            ids.push(mv.to);
            actions.push(mv.action);
        }
        let states = ids.iter().map(|&id| graph.values(id).iter().copied().collect()).collect();
        traces.push(Trace { path, states, actions });
    }
    Ok(traces)
}

/// Where paths are infinite, a defeating trace is not continued beyond this many steps.
const LONGEST_DEFEAT: u64 = 100_000;

/// Blames the trace that lacks most of what the objective reads.
fn too_short(objective: &Objective, strategy: &Strategy) -> Error {
    let lack = |t: &&Trace| horizon(objective, t.path).saturating_sub(t.actions.len() as u64);
    match strategy.traces.iter().max_by_key(lack) {
        Some(trace) if lack(&trace) > 0 => wrong_length(objective, trace),
        _ => Error::Malformed { what: "an atom of the objective has no value" },
    }
}

fn wrong_length(objective: &Objective, trace: &Trace) -> Error {
    Error::WrongLength {
        path: objective.paths[trace.path].name.clone(),
        steps: trace.actions.len() as u64,
        needed: horizon(objective, trace.path),
    }
}
