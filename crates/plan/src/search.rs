//! One solver's search: from an objective to a verified answer.

use crate::cegis::{Assignment, strategy};
use crate::config::{Config, Outcome, Seconds, States, Verdict};
use crate::confirm::confirm;
use crate::decide::Decision;
use crate::fact::{Error, Note, Reason, Unsupported};
use crate::oracle::{Account, Oracle, Stop};
use crate::prepare::{decided, is_existential, no_dead_ends, without_paths};
use crate::watch::Stage;
use hyperplan_encode::{self as encode, Encoder};
use hyperplan_problem::answer::ReasonCode;
use hyperplan_problem::{Objective, PathId, Problem};
use hyperplan_verify::{Budget, holds_for_all_outcomes};
use std::time::Instant;

/// Decides an objective with one solver; systems that were enumerated before are not enumerated again. Where the choice
/// of states is ours and too many can matter, the search goes on symbolically.
pub(crate) fn search(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    match attempt(problem, objective, config) {
        Err(Error::Encode(error @ encode::Error::TooLarge { .. }))
            if config.states.is_none() && config.among.bounds.is_empty() =>
        {
            let symbolic = Config { states: Some(States::Bitvec), ..config.clone() };
            let mut outcome = attempt(problem, objective, &symbolic)?;
            outcome.notes.push(Note::Symbolic(error));
            Ok(outcome)
        }
        answer => answer,
    }
}

fn attempt(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    let start = Instant::now();
    let stop = || config.deadline.passed();
    let (wish, limits) = (config.states, config.limits);
    let encoder = Encoder::among(problem, objective, wish, limits, &stop, &config.graphs, &config.among)?;
    if encoder.states.is_arithmetic() && config.solver.is_embedded() {
        return Err(needs_arithmetic(&encoder));
    }
    let mut oracle = Oracle::new(config);
    let mut notes = Vec::new();
    let empty = no_dead_ends(&encoder, &mut oracle).and_then(|()| without_paths(&encoder, &mut oracle));
    let decision = match empty {
        Err(stop) => Decision::stopped(&encoder, config, stop),
        Ok(None) => Decision::of(&encoder, config, &mut oracle),
        Ok(Some(path)) => {
            let var = &objective.paths[path];
            let system = problem.systems[var.system].name.clone();
            notes.push(Note::NoPaths { system, path: var.name.clone() });
            let decided = decided(objective, var.quantifier);
            let encoder = Encoder::sharing(problem, &decided, wish, limits, &stop, &config.graphs)?;
            Decision::of(&encoder, config, &mut oracle)
        }
    };
    let total = start.elapsed().as_secs_f64();
    let mut account = oracle.into_account();
    notes.append(&mut account.notes);
    let horizons = hyperplan_horizon::horizons(objective);
    let outcome = Outcome {
        verdict: Verdict::Unknown,
        reason: None,
        horizons: horizons.iter_enumerated().map(|(p, h)| h.steps.map(|_| encoder.task.horizon(p))).collect(),
        witness: None,
        verified: None,
        closest: None,
        solver: account.solver.clone(),
        quantifiers: decision.quantifiers,
        because: decision.because,
        states: encoder.states,
        iterations: decision.rounds,
        size: account.largest.clone(),
        seconds: Seconds { encode: (total - account.solving).max(0.0), solve: account.solving, verify: 0.0 },
        notes,
    };
    concluded(outcome, &encoder, config, decision.found, &account)
}

/// The embedded solver knows bits only.
fn needs_arithmetic(encoder: &Encoder<'_>) -> Error {
    let systems = encoder.objective.paths.iter().map(|path| &encoder.problem.systems[path.system]);
    let system = systems.into_iter().find(|system| !system.is_finite()).map(|system| system.name.clone());
    Unsupported::Arithmetic { system, states: encoder.states }.into()
}

/// What is perhaps why an objective was too much.
fn long_horizon(objective: &Objective) -> Option<Note> {
    let hyperplan_horizon::Long { path, steps, bound } = hyperplan_horizon::surprising(objective)?;
    Some(Note::LongHorizon { path: objective.paths[path].name.clone(), steps, bound })
}

/// The outcome with the verdict that follows from what was found, once the witness is checked. What nobody could check
/// is no answer.
fn concluded(
    mut outcome: Outcome,
    encoder: &Encoder<'_>,
    config: &Config,
    found: Result<Option<Assignment>, Stop>,
    account: &Account,
) -> Result<Outcome, Error> {
    let undecided = |reason: Reason, mut outcome: Outcome| {
        if matches!(reason.code(), ReasonCode::Timeout | ReasonCode::Interrupted | ReasonCode::OutOfMemory) {
            outcome.notes.push(Note::Stopped(config.watch.standing()));
        }
        outcome.notes.extend(long_horizon(encoder.objective));
        Ok(Outcome { reason: Some(reason), ..outcome })
    };
    let found = match found {
        Ok(found) => found,
        Err(Stop::Unknown(reason)) => return undecided(reason, outcome),
        Err(Stop::Error(Error::Encode(encode::Error::Interrupted))) => {
            return undecided(config.deadline.reason().into(), outcome);
        }
        Err(Stop::Error(error)) => return Err(error),
    };
    let realizable = found.is_some() == is_existential(encoder.objective);
    outcome.notes.extend(found.iter().flat_map(|known| picked_outcomes(encoder, known)));
    let witness = found.map(|known| strategy(encoder.objective, &known));
    if let Some(strategy) = witness.as_ref().filter(|_| config.verify) {
        config.watch.stage(Stage::Verifying);
        let start = Instant::now();
        let verified = confirm(encoder, config, strategy, (account, outcome.quantifiers));
        outcome.seconds.verify = start.elapsed().as_secs_f64();
        match verified {
            Ok(verified) => outcome.verified = Some(verified),
            Err(Stop::Error(error)) => return Err(error),
            Err(Stop::Unknown(reason)) => return undecided(Reason::Unverified(Box::new(reason)), outcome),
        }
    }
    let verdict = if realizable { Verdict::Realizable } else { Verdict::Unrealizable };
    Ok(Outcome { verdict, witness, ..outcome })
}

/// What it may cost to find that a note about outcomes is not called for.
const OUTCOMES: Budget = Budget { states: 100_000, entries: 1_000_000, moves: 5_000_000 };

/// Says of which paths of a strategy the actions might have had other outcomes, unless the objective holds for these too.
fn picked_outcomes(encoder: &Encoder<'_>, known: &Assignment) -> Vec<Note> {
    let objective = encoder.objective;
    if !is_existential(objective) {
        return Vec::new();
    }
    let picks = |path: &PathId| {
        // Where there is one action, a path is what it leads to, and nothing else is chosen.
        let system = &encoder.problem.systems[objective.paths[*path].system];
        system.actions.len() > 1
            && known[usize::from(*path)]
                .as_ref()
                .is_some_and(|known| encoder.writer.picks_outcomes(*path, known))
    };
    let picking: Vec<PathId> = objective.leading_block().into_iter().filter(picks).collect();
    if picking.is_empty() {
        return Vec::new();
    }
    let strategy = strategy(encoder.objective, known);
    if let Ok(Some(true)) = holds_for_all_outcomes(encoder.problem, objective, &strategy, &picking, &OUTCOMES)
    {
        return Vec::new();
    }
    picking.into_iter().map(|path| Note::PicksOutcomes { path: objective.paths[path].name.clone() }).collect()
}
