//! The cheapest strategy: one that meets the objective with the least value of what is to be minimized, and the proof that
//! it is.
//!
//! A strategy is found first, whatever it costs; then one is asked for that costs no more than some bound, which rises from
//! what no strategy is below, at growing distances, until there is one; and the gap is bisected. Each bound below the
//! answer was proved too low, be it one by one or by a larger one. Of several targets the first counts most: what it came to
//! is a bound of its own while the next is looked at. What a strategy costs is always what the checker says.

use crate::config::{Config, Outcome, Quantifiers, Verdict};
use crate::fact::{Error, Reason};
use crate::minimize::{Spent, Steps};
use crate::race::search_or_race;
use hyperplan_encode::{self as encode, Among, Encoder, Goal};
use hyperplan_problem::{Mode, Objective, PathId, Problem, Strategy, Target, bounded, extended};
use hyperplan_solver::Unknown;

/// What is known of the least values.
#[derive(Debug)]
pub struct Cheapest {
    /// The answer: where it is realizable, with the cheapest strategy that was found. Times, rounds and the largest query
    /// are those of all bounds tried.
    pub outcome: Outcome,
    /// Where a strategy was found, for each target its value under that strategy, and a value below which there is none,
    /// given those before.
    pub values: Vec<Value>,
    /// Why the search ended before some value was proved to be the least.
    pub undecided: Option<Reason>,
}

/// The value of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Value {
    /// Of the strategy found.
    pub found: i64,
    /// No strategy is below.
    pub least: i64,
}

/// The cheapest strategy that meets an objective, of which targets are given: at least one, over costs of a leading block of
/// `exists`.
///
/// # Errors
/// Those of [`crate::solve()`].
pub fn cheapest(
    problem: &Problem,
    objective: &Objective,
    targets: &[Target],
    config: &Config,
) -> Result<Cheapest, Error> {
    let (objective, time) = to_the_end(problem, objective, targets);
    let outcome = search_or_race(problem, &objective, config)?;
    cheaper(Search::new((problem, &objective, time), targets, config, &outcome), outcome)
}

/// As [`cheapest`], of an objective whose paths are long enough to be paid for to the end, among the strategies of which some
/// targets are at most so large. An answer for the same systems says how states are written.
pub(crate) fn cheapest_with(
    problem: &Problem,
    objective: &Objective,
    (kept, targets): (&[(Target, i64)], &[Target]),
    config: &Config,
    before: &Outcome,
) -> Result<Cheapest, Error> {
    let all: Vec<Target> = kept.iter().map(|(target, _)| target).chain(targets).cloned().collect();
    let (_, time) = to_the_end(problem, objective, &all);
    let mut search = Search::new((problem, objective, time), targets, config, before);
    search.kept = kept;
    let outcome = search.ask(kept)?;
    cheaper(search, outcome)
}

/// As [`cheapest`], of an objective for which there is an answer; `None` where its paths are not long enough to be paid for to
/// the end.
pub(crate) fn improved(
    problem: &Problem,
    objective: &Objective,
    targets: &[Target],
    config: &Config,
    outcome: Outcome,
) -> Option<Result<Cheapest, Error>> {
    let (extended, time) = to_the_end(problem, objective, targets);
    let same = extended.formula.nodes.len() == objective.formula.nodes.len();
    same.then(|| cheaper(Search::new((problem, objective, time), targets, config, &outcome), outcome))
}

/// Lowers what an answer's strategy costs.
fn cheaper(mut search: Search<'_>, outcome: Outcome) -> Result<Cheapest, Error> {
    let targets = search.targets;
    search.spent.add(&outcome);
    let Some(strategy) = outcome.witness.clone().filter(|_| outcome.verdict == Verdict::Realizable) else {
        return Ok(Cheapest { outcome, values: Vec::new(), undecided: None });
    };
    let mut best = Best { values: search.values(&strategy)?, strategy };
    let mut least: Vec<i64> = targets.iter().map(|target| target.constant).collect();
    let mut undecided = None;
    for at in 0..targets.len() {
        undecided = search.lower(at, &mut best, &mut least)?;
        if undecided.is_some() {
            break;
        }
    }
    let Best { strategy, values } = best;
    let outcome = search.spent.told(Outcome { witness: Some(strategy), ..outcome });
    let values = values.into_iter().zip(least).map(|(found, least)| Value { found, least }).collect();
    Ok(Cheapest { outcome, values, undecided })
}

/// The objective with all paths that the targets speak of read to the same time, the last at which any of them is; and that
/// time.
pub(crate) fn to_the_end(problem: &Problem, objective: &Objective, targets: &[Target]) -> (Objective, u32) {
    if let Mode::Within(steps) = objective.mode {
        return (objective.clone(), steps);
    }
    let mut paths: Vec<PathId> =
        targets.iter().flat_map(|target| &target.terms).map(|&(_, path, _)| path).collect();
    paths.sort_unstable();
    paths.dedup();
    let horizons = hyperplan_horizon::horizons(objective);
    let steps = |path: &PathId| horizons[*path].steps.unwrap_or(0);
    let time = paths.iter().map(steps).max().unwrap_or(0);
    paths.retain(|path| steps(path) < time);
    let time = u32::try_from(time).unwrap_or(u32::MAX);
    (if paths.is_empty() { objective.clone() } else { extended(problem, objective, &paths, time) }, time)
}

struct Search<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    /// When the targets are read.
    time: u32,
    targets: &'a [Target],
    /// Targets that are at most so large in any case.
    kept: &'a [(Target, i64)],
    config: &'a Config,
    /// Whether bounds can be asked for state by state; else they are parts of the objective.
    one_by_one: bool,
    spent: Spent,
}

struct Best {
    strategy: Strategy,
    values: Vec<i64>,
}

impl<'a> Search<'a> {
    /// A search that knows an answer for the same systems.
    fn new(
        (problem, objective, time): (&'a Problem, &'a Objective, u32),
        targets: &'a [Target],
        config: &'a Config,
        before: &Outcome,
    ) -> Self {
        // A search without queries takes no bounds.
        let one_by_one = before.states.is_enumerated() && config.quantifiers != Quantifiers::Explicit;
        let spent = Spent::default();
        Search { problem, objective, time, targets, kept: &[], config, one_by_one, spent }
    }

    /// What each target comes to under a strategy, by the checker.
    fn values(&self, strategy: &Strategy) -> Result<Vec<i64>, Error> {
        let value = |target: &Target| {
            target.value(|path, cost| {
                let trace = strategy.traces.iter().find(|trace| trace.path == path)?;
                hyperplan_verify::cost(self.problem, self.objective, trace, cost).ok()
            })
        };
        let unknown = || Error::Bug("nobody can tell what it costs".into());
        self.targets.iter().map(|target| value(target).ok_or_else(unknown)).collect()
    }

    /// Finds the least value of a target, given those of the targets before; or why it is not known.
    fn lower(&mut self, at: usize, best: &mut Best, least: &mut [i64]) -> Result<Option<Reason>, Error> {
        if let Some(proved) = self.least(at, best)? {
            // Nothing that was found is below it.
            least[at] = least[at].max(proved.min(best.values[at]));
        }
        let mut steps = Steps { bound: Some(best.values[at]), ..Steps::default() };
        // The value of the first strategy may be far off: it ends the search, but is no side of a gap to bisect.
        let mut near = false;
        while least[at] < best.values[at] {
            let bound = match near {
                true => steps.next(least[at], i64::MAX).unwrap_or(least[at]),
                false => least[at].saturating_add(steps.distance).min(best.values[at] - 1),
            };
            self.config.watch.tell(|standing| {
                (standing.least, standing.value) = (Some(least[at]), Some(bound));
                standing.best = Some(best.values[at]);
            });
            let outcome = self.below(at, bound, best)?;
            self.spent.add(&outcome);
            match (outcome.verdict, outcome.witness) {
                (Verdict::Realizable, Some(strategy)) => {
                    let values = self.values(&strategy)?;
                    if values[at] > bound || (0..at).any(|before| values[before] > best.values[before]) {
                        return Err(Error::Bug("it costs more than was asked for".into()));
                    }
                    near = true;
                    steps.bound = Some(values[at]);
                    *best = Best { strategy, values };
                }
                (Verdict::Unrealizable, _) => {
                    least[at] = bound + 1;
                    steps.grow();
                }
                _ => return Ok(Some(outcome.reason.unwrap_or(Reason::Solver(Unknown::Unsaid)))),
            }
        }
        Ok(None)
    }

    /// A value that a target is not below, given those found of the targets before, as far as states written one by one
    /// show.
    fn least(&self, at: usize, best: &Best) -> Result<Option<i64>, Error> {
        if !self.one_by_one {
            return Ok(None);
        }
        let bounds = self.bounds(at, best.values[at], best);
        let Config { states, limits, deadline, among, graphs, .. } = self.config;
        let among = Among { bounds, cube: among.cube.clone() };
        let stop = || deadline.passed();
        let (problem, objective) = (self.problem, self.objective);
        let encoder = Encoder::among(problem, objective, *states, *limits, &stop, graphs, &among);
        let goal = Goal::new(&objective.formula, true);
        match encoder.and_then(|encoder| encoder.writer.least(&goal)) {
            Ok(least) => Ok(least.map(|least| least.saturating_add(self.targets[at].constant))),
            Err(
                encode::Error::TooLarge { .. }
                | encode::Error::NotEnumerable { .. }
                | encode::Error::Interrupted,
            ) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }

    /// What targets may come to: those before what was found of them, and one so much.
    fn bounds(&self, at: usize, bound: i64, best: &Best) -> Vec<(Target, i64)> {
        let before = self.targets[..at].iter().cloned().zip(best.values.iter().copied());
        self.kept.iter().cloned().chain(before).chain([(self.targets[at].clone(), bound)]).collect()
    }

    /// Asks for a strategy with a value of at most so much, and with those found of the targets before.
    fn below(&mut self, at: usize, bound: i64, best: &Best) -> Result<Outcome, Error> {
        self.ask(&self.bounds(at, bound, best))
    }

    /// Asks for a strategy of which targets are at most so large.
    fn ask(&mut self, bounds: &[(Target, i64)]) -> Result<Outcome, Error> {
        if bounds.is_empty() {
            return search_or_race(self.problem, self.objective, self.config);
        }
        if self.one_by_one {
            let among = Among { bounds: bounds.to_vec(), cube: self.config.among.cube.clone() };
            let config = Config { among, ..self.config.clone() };
            match search_or_race(self.problem, self.objective, &config) {
                Err(Error::Encode(encode::Error::TooLarge { .. } | encode::Error::NotEnumerable { .. })) => {
                    self.one_by_one = false;
                }
                answer => return answer,
            }
        }
        let (problem, objective) = bounded(self.problem, self.objective, bounds, self.time);
        // Systems that are bounded otherwise are others, with other states to choose a case by: all cases are looked at.
        let config = Config { among: Among::default(), ..self.config.clone() };
        let mut outcome = search_or_race(&problem, &objective, &config)?;
        for trace in outcome.witness.iter_mut().flat_map(|strategy| &mut strategy.traces) {
            let width = self.problem.systems[self.objective.paths[trace.path].system].vars.len();
            for state in &mut trace.states {
                *state = state[..width].into();
            }
        }
        Ok(outcome)
    }
}
