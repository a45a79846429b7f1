//! From an objective to a verified answer.

use crate::cegis::{Assignment, Cegis};
use crate::config::{Config, Error, Outcome, Quantifiers, Seconds, Verdict, Verified};
use crate::direct;
use crate::oracle::{Oracle, Stop};
use crate::prepare::{decided, no_dead_ends, without_paths};
use crate::race::race;
use hyperplan_encode::{self as encode, Encoder, Goal, Graphs, Narrowing, States};
use hyperplan_problem::{Objective, PathId, Problem, Quantifier, Strategy};
use hyperplan_solver::{Spec, Told};
use hyperplan_verify as verify;
use std::time::Instant;

/// Runs that are hardly longer than the shortest make small queries, so they are tried first; then longer ones, and
/// then all, if there are others.
pub(crate) const SLACKS: [Option<u32>; 4] = [Some(4), Some(16), Some(64), None];

/// After so many checks a search over infinitely many choices is taken to have no end.
const ENDLESS: u32 = 200;

/// Decides an objective. A strategy (or counterexample) in the outcome has been verified, unless the configuration
/// says not to.
///
/// # Errors
/// What is not supported, failures of solvers, and answers that fail verification; being undecided is no error.
pub fn solve(problem: &Problem, objective: &Objective, config: &Config) -> Result<Outcome, Error> {
    solve_sharing(problem, objective, config, &Graphs::default())
}

/// As [`solve`], with systems that were enumerated before. Where the choice of states is ours and too many can matter,
/// the search goes on symbolically.
pub(crate) fn solve_sharing(
    problem: &Problem,
    objective: &Objective,
    config: &Config,
    graphs: &Graphs,
) -> Result<Outcome, Error> {
    if !config.rivals.is_empty() {
        return race(problem, objective, config);
    }
    match attempt(problem, objective, config, graphs) {
        Err(Error::Encode(error @ encode::Error::TooLarge { .. })) if config.states.is_none() => {
            let symbolic = Config { states: Some(States::Bitvec), ..config.clone() };
            let mut outcome = attempt(problem, objective, &symbolic, graphs)?;
            outcome
                .notes
                .push(format!("states are bit-vectors, as there are too many to write one by one: {error}"));
            Ok(outcome)
        }
        answer => answer,
    }
}

fn attempt(
    problem: &Problem,
    objective: &Objective,
    config: &Config,
    graphs: &Graphs,
) -> Result<Outcome, Error> {
    let start = Instant::now();
    let stop = || config.deadline.passed();
    let (wish, limits) = (config.states, config.limits);
    let encoder = Encoder::sharing(problem, objective, wish, limits, &stop, graphs)?;
    if encoder.states.is_arithmetic() && config.solver == Spec::Builtin {
        return Err(needs_arithmetic(&encoder));
    }
    let mut oracle = Oracle::new(config);
    let mut outcome = unknown(objective, &encoder, config);
    let vacuous = no_dead_ends(&encoder, &mut oracle).and_then(|()| without_paths(&encoder, &mut oracle));
    let answer = match vacuous {
        Err(stop) => Err(stop),
        Ok(None) => search(&encoder, config, &mut oracle, &mut outcome),
        Ok(Some(path)) => {
            let var = &objective.paths[path];
            outcome.notes.push(format!(
                "system {} has no path for {} to range over, which alone decides the objective",
                problem.systems[var.system].name, var.name
            ));
            let decided = decided(objective, var.quantifier);
            let encoder = Encoder::sharing(problem, &decided, wish, limits, &stop, graphs)?;
            search(&encoder, config, &mut oracle, &mut outcome)
        }
    };
    let total = start.elapsed().as_secs_f64();
    outcome.seconds =
        Seconds { encode: (total - oracle.solving).max(0.0), solve: oracle.solving, verify: 0.0 };
    outcome.solver = oracle.identity();
    outcome.notes.append(&mut oracle.notes);
    outcome.told = oracle.largest.clone();
    match answer {
        Err(Stop::Error(Error::Encode(encode::Error::Interrupted))) => {
            outcome.reason = Some(config.deadline.reason().to_owned());
            return Ok(outcome);
        }
        Err(Stop::Error(error)) => return Err(error),
        Err(Stop::Unknown(reason)) => {
            outcome.reason = Some(reason);
            return Ok(outcome);
        }
        Ok(found) => conclude(&encoder, found.as_ref(), &mut outcome),
    }
    if config.verify {
        let start = Instant::now();
        confirm(&encoder, config, &mut outcome).map_err(|error| oracle.with_evidence(error))?;
        outcome.seconds.verify = start.elapsed().as_secs_f64();
    }
    Ok(outcome)
}

/// The embedded solver knows bits only.
fn needs_arithmetic(encoder: &Encoder<'_>) -> Error {
    let systems = encoder.objective.paths.iter().map(|path| &encoder.problem.systems[path.system]);
    let what = match systems.into_iter().find(|system| !system.is_finite()) {
        Some(system) => format!("system {} has variables without bounds, which", system.name),
        None => format!("--states {}", encoder.states),
    };
    Error::Unsupported(format!(
        "{what} takes a solver for integers and reals, such as --solver z3, cvc5 or yices; the builtin solver has none"
    ))
}

fn unknown(objective: &Objective, encoder: &Encoder<'_>, config: &Config) -> Outcome {
    let horizons = hyperplan_horizon::horizons(objective);
    let quantifiers = match config.quantifiers {
        // A single block has no quantifiers to decide: its query has none.
        _ if objective.blocks().len() == 1 => Quantifiers::Expand,
        chosen => chosen,
    };
    Outcome {
        verdict: Verdict::Unknown,
        reason: None,
        horizons: horizons.iter_enumerated().map(|(p, h)| h.steps.map(|_| encoder.task.horizon(p))).collect(),
        witness: None,
        verified: None,
        solver: Oracle::new(config).identity(),
        quantifiers,
        because: (objective.blocks().len() == 1)
            .then_some("there is one block of quantifiers, so one query decides"),
        states: encoder.states,
        iterations: 0,
        told: Told::default(),
        seconds: Seconds::default(),
        notes: Vec::new(),
    }
}

/// The paths of the leading block that decide the objective, if there are some.
fn search(
    encoder: &Encoder<'_>,
    config: &Config,
    oracle: &mut Oracle<'_>,
    outcome: &mut Outcome,
) -> Result<Option<Assignment>, Stop> {
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let want = leading(objective) == Quantifier::Exists;
    let choice = outcome.quantifiers;
    if choice == Quantifiers::Keep {
        outcome.iterations = 1;
        return keep(encoder, config, oracle, &blocks, want);
    }
    let goal = Goal::new(&objective.formula, want);
    for narrowing in narrowings(encoder, &blocks, config) {
        let query = match choice {
            // Without a second block there is nothing to expand; the search below asks one query.
            Quantifiers::Expand if blocks.len() > 1 => {
                Some(direct::expand(encoder, &blocks, want, narrowing)?)
            }
            Quantifiers::Auto => direct::sweep(encoder, &blocks, want, narrowing)?,
            _ => None,
        };
        if choice == Quantifiers::Auto {
            outcome.because = Some(reason(encoder, &blocks, query.is_some()));
        }
        let (found, exact) = if let Some(query) = query {
            outcome.quantifiers = Quantifiers::Expand;
            outcome.iterations += 1;
            (query.solve(oracle, 1)?, query.exact)
        } else {
            if choice == Quantifiers::Auto {
                outcome.quantifiers = Quantifiers::Cegis;
            }
            let patient = choice != Quantifiers::Auto || is_finite(encoder);
            let mut cegis = Cegis::new(encoder, oracle, &blocks);
            (cegis.narrowing, cegis.most_checks) = (narrowing, (!patient).then_some(ENDLESS));
            let known = vec![None; objective.paths.len()];
            let found = cegis.find(0, &known, &goal, 1);
            outcome.iterations += cegis.rounds;
            let exact = cegis.exact;
            match found {
                // Numbers without bounds have infinitely many counterexamples; the solver may know better.
                Err(Stop::Unknown(reason)) if !patient && !config.deadline.passed() => {
                    outcome.quantifiers = Quantifiers::Keep;
                    outcome.because = Some("a search by counterexamples found no end");
                    return match keep(encoder, config, oracle, &blocks, want) {
                        // Not every solver takes every prefix of quantifiers.
                        Err(Stop::Error(error)) if error.exit_code() == 2 => Err(Stop::Unknown(reason)),
                        answer => answer,
                    };
                }
                found => (found?.pop(), exact),
            }
        };
        if found.is_some() || exact {
            return Ok(found);
        }
    }
    Ok(None)
}

/// Why quantifiers are decided as they are, where the choice is ours.
fn reason(encoder: &Encoder<'_>, blocks: &[Vec<PathId>], swept: bool) -> &'static str {
    match blocks {
        _ if swept => "all runs of the other player's only path can be followed at once",
        [_, last] if last.len() > 1 => "the other player has several paths",
        [_, _] if !encoder.states.is_enumerated() => "states are not written one by one",
        [_, _] => "there are too many runs of the other player's path to follow all at once",
        _ => "the quantifiers alternate more than once",
    }
}

/// Which runs of the leading block are tried, one after the other. Where the choice is ours, a search finds a run that is
/// done first: where nothing else is read it decides; where no path is tied to it, it is worth a guess.
fn narrowings(encoder: &Encoder<'_>, blocks: &[Vec<PathId>], config: &Config) -> Vec<Narrowing> {
    let auto = config.quantifiers == Quantifiers::Auto;
    let alone = blocks.len() == 1;
    let guess = auto && !alone && !encoder.objective.has_ties();
    let guess = guess.then_some(Narrowing { slack: SLACKS[0], one_run: true });
    let steps = SLACKS.map(|slack| Narrowing { slack, one_run: auto && alone && slack.is_some() });
    guess.into_iter().chain(steps).collect()
}

/// Whether every path has finitely many states to be in.
fn is_finite(encoder: &Encoder<'_>) -> bool {
    encoder.objective.paths.iter().all(|path| encoder.problem.systems[path.system].is_finite())
}

/// One query with its quantifiers, for a solver that takes them.
fn keep(
    encoder: &Encoder<'_>,
    config: &Config,
    oracle: &mut Oracle<'_>,
    blocks: &[Vec<PathId>],
    want: bool,
) -> Result<Option<Assignment>, Stop> {
    if config.solver == Spec::Builtin {
        return Err(Error::Unsupported(
            "--quantifiers keep needs a solver that decides quantifiers, such as z3, cvc5 or yices; the builtin \
             solver takes cegis or expand"
                .into(),
        )
        .into());
    }
    direct::keep(encoder, blocks, want)?.solve(oracle, blocks.len())
}

fn leading(objective: &Objective) -> Quantifier {
    objective.paths.first().map_or(Quantifier::Exists, |p| p.quantifier)
}

/// The verdict, and the witness as traces.
fn conclude(encoder: &Encoder<'_>, found: Option<&Assignment>, outcome: &mut Outcome) {
    let objective = encoder.objective;
    let exists = leading(objective) == Quantifier::Exists;
    outcome.verdict = if found.is_some() == exists { Verdict::Realizable } else { Verdict::Unrealizable };
    outcome.witness = found.map(|known| {
        let trace = |path: PathId| known[usize::from(path)].as_ref().map(|known| known.trace(path));
        for path in objective.leading_block() {
            let picked =
                known[usize::from(path)].as_ref().is_some_and(|k| encoder.writer.picks_outcomes(path, k));
            if exists && picked {
                outcome.notes.push(format!(
                    "{0} relies on outcomes that its actions might not have; `exists {0}` picks them too",
                    objective.paths[path].name
                ));
            }
        }
        Strategy { traces: objective.leading_block().into_iter().filter_map(trace).collect() }
    });
}

/// Has the witness checked independently, or, where that is too much to enumerate, by a second query.
fn confirm(encoder: &Encoder<'_>, config: &Config, outcome: &mut Outcome) -> Result<(), Error> {
    let Some(strategy) = &outcome.witness else { return Ok(()) };
    let (problem, objective) = (encoder.problem, encoder.objective);
    let verdict = match verify::check(problem, objective, strategy, &verify::Budget::default()) {
        Err(error @ verify::Error::Overflow { .. }) => {
            unverified(outcome, &error.to_string());
            return Ok(());
        }
        verdict => verdict.map_err(|error| Error::Bug(error.to_string()))?,
    };
    match verdict {
        verify::Verdict::Holds => outcome.verified = Some(Verified::BySearch),
        verify::Verdict::Fails(defeat) => {
            let what = defeat.describe(objective);
            // If our own encoding agrees with the checker, the solver said something wrong.
            return Err(match defeated(encoder, config, strategy) {
                Ok(true) if config.solver != Spec::Builtin => {
                    Error::WrongModel { solver: outcome.solver.name.clone(), what }
                }
                _ => Error::Bug(what),
            });
        }
        verify::Verdict::TooLarge { .. } => match defeated(encoder, config, strategy) {
            Ok(false) => outcome.verified = Some(Verified::BySolver),
            Ok(true) => return Err(Error::Bug("a second query defeats it".into())),
            Err(Stop::Error(error)) => return Err(error),
            Err(Stop::Unknown(reason)) => unverified(outcome, &reason),
        },
    }
    Ok(())
}

/// What nobody could check is no answer.
fn unverified(outcome: &mut Outcome, reason: &str) {
    outcome.verdict = Verdict::Unknown;
    outcome.witness = None;
    outcome.reason = Some(format!("a strategy was found, but could not be verified: {reason}"));
}

/// Whether the paths after the leading block can defeat the strategy, asked of the embedded solver where it can tell.
fn defeated(encoder: &Encoder<'_>, config: &Config, strategy: &Strategy) -> Result<bool, Stop> {
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let want = leading(objective) == Quantifier::Exists;
    let mut known: Assignment = vec![None; objective.paths.len()];
    for trace in &strategy.traces {
        known[usize::from(trace.path)] = encoder.writer.known(trace);
    }
    if blocks.len() < 2 || strategy.traces.iter().any(|t| known[usize::from(t.path)].is_none()) {
        // No path at all, or nothing left to choose: the checker's word stands.
        return Ok(true);
    }
    let solver = match encoder.states {
        states if states.is_arithmetic() => config.solver.clone(),
        _ => Spec::Builtin,
    };
    let own = Config { solver, queries: None, ..config.clone() };
    let formula = &objective.formula;
    let against = Goal::new(formula, want).opposed(formula);
    let mut oracle = Oracle::new(&own);
    let mut cegis = Cegis::new(encoder, &mut oracle, &blocks);
    Ok(!cegis.find(1, &known, &against, 1)?.is_empty())
}
