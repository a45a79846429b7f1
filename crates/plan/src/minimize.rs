//! The least value of a constant for which an objective is realizable.
//!
//! Values are taken upwards, and every smaller value of the range is proved unrealizable before one is called the least.
//! Four things make that faster than asking one after the other:
//!
//! - *More does not hurt*: where the whole objective lasts ([`crate::lasting`]) from each value to the next, one that
//!   is unrealizable for a value is so for all smaller ones. Then values are tried at growing distances, and the gap
//!   is bisected.
//! - *Parts that last*: of other objectives those conjuncts are taken that last. If these alone are hopeless for a
//!   value, so is the objective for all smaller ones.
//! - *Where a plan is done*: with the largest value of a range that is not wide, a plan comes early to where it stays, and what
//!   others do that is read is over. What is left of its horizon is a guess of how much less would do, and is tried first; that
//!   is no proof, and needs none.
//! - *Hopeless* is what the states that can matter show without any solver: for some path of the leading block
//!   there are none, say since the goal is too far away. Each path is looked at by itself first, which takes least.

use crate::config::{Config, Outcome, Seconds, Verdict};
use crate::decide::SLACKS;
use crate::fact::{Error, Reason, Unsupported};
use crate::lasting::{conjuncts, lasting};
use crate::prepare::is_existential;
use crate::race::search_or_race;
use hyperplan_encode::{self as encode, Encoder, Goal, Narrowing};
use hyperplan_problem::{FormulaId, Node, Objective, PathId, Problem, Trace};
use hyperplan_solver::{QuerySize, Unknown};
use hyperplan_verify::{Budget, settled_for_others};
use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

/// What part of the time that is left a value may take, where larger ones can still be asked: one in so many.
pub const SHARE: u32 = 4;

/// Values of a range whose last is asked for a guess, and the time for that.
const NEAR: i64 = 256;
const GUESS: Duration = Duration::from_secs(1);

/// What is known of the least value.
#[derive(Debug)]
pub struct Least {
    /// The value of the constant that the outcome is about. If the outcome is realizable and nothing is `undecided`,
    /// it is the least; if it is unrealizable, so is the whole range, of which it is the last.
    pub value: i64,
    /// The problem with this value.
    pub problem: Problem,
    /// The answer for this value; times, rounds and the largest query are those of all values tried.
    pub outcome: Outcome,
    /// Every smaller value of the range is unrealizable.
    pub proved: i64,
    /// Why the search ended before `proved` reached a realizable `value`.
    pub undecided: Option<Reason>,
}

/// Why there is no answer at all.
#[derive(Debug, thiserror::Error)]
pub enum MinimizeError<E> {
    /// There is no problem for some value.
    #[error("{0}")]
    Problem(E),
    /// The search failed for a value.
    #[error("for {value}: {error}")]
    Solve {
        /// The value.
        value: i64,
        /// Why.
        error: Error,
    },
}

/// The problem for each value of a constant.
pub type ProblemOf<'a, E> = &'a mut dyn FnMut(i64) -> Result<Problem, E>;

/// As [`crate::minimize()`], without what is known of candidates.
pub(crate) fn minimize<E>(
    objective: &str,
    range: RangeInclusive<i64>,
    problem_of: ProblemOf<'_, E>,
    config: &Config,
) -> Result<Least, MinimizeError<E>> {
    let mut minimizer = Minimizer::new(objective, range, problem_of, config)?;
    let mut last = minimizer.last()?;
    if let Some(none) = last.take_if(|last| last.outcome.verdict == Verdict::Unrealizable) {
        minimizer.low = minimizer.high;
        return Ok(minimizer.conclude(none, None));
    }
    let guess = last.as_ref().and_then(|last| saved(last, objective));
    minimizer.refute(guess.map(|saved| minimizer.high - saved))?;
    minimizer.run(last)
}

/// What is known of a range without asking for any of its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Narrowed {
    /// Smaller values are unrealizable; in the range.
    pub low: i64,
    /// Whether a value that is unrealizable says so of all smaller ones.
    pub lasts: bool,
}

/// Values of a range up to which it is looked whether the objective lasts.
const FAR: i64 = 1024;

/// As much as the states that can matter show of a range, for those who ask for several of its values at once.
///
/// # Errors
/// Those of the problems, for a value that is looked at, and where the first has no such objective.
pub fn narrowed<E>(
    objective: &str,
    range: RangeInclusive<i64>,
    problem_of: ProblemOf<'_, E>,
    config: &Config,
) -> Result<Narrowed, MinimizeError<E>> {
    let mut minimizer = Minimizer::new(objective, range, problem_of, config)?;
    minimizer.refute(None)?;
    minimizer.follow(minimizer.high.min(minimizer.low.saturating_add(FAR)));
    let Minimizer { low, high, chain, .. } = minimizer;
    Ok(Narrowed { low, lasts: chain.whole && chain.end >= high })
}

fn find<'p, E>(problem: &'p Problem, name: &str, value: i64) -> Result<&'p Objective, MinimizeError<E>> {
    let missing = || Error::from(Unsupported::NoObjective(name.to_owned()));
    problem.objective(name).ok_or_else(|| MinimizeError::Solve { value, error: missing() })
}

/// What lasts from the first value of the range up to `end`.
struct Chain {
    end: i64,
    /// Whether all of the objective does.
    whole: bool,
    /// The conjuncts that do.
    parts: Vec<FormulaId>,
    /// The problem for `end`.
    problem: Problem,
}

struct Minimizer<'a, E> {
    objective: &'a str,
    problem_of: ProblemOf<'a, E>,
    config: &'a Config,
    chain: Chain,
    /// The first value of the range.
    first: i64,
    /// Smaller values are unrealizable.
    low: i64,
    high: i64,
    spent: Spent,
}

/// What all searches took together.
#[derive(Default)]
pub(crate) struct Spent {
    pub(crate) seconds: Seconds,
    rounds: u32,
    largest: QuerySize,
}

impl Spent {
    pub(crate) fn add(&mut self, outcome: &Outcome) {
        self.seconds.encode += outcome.seconds.encode;
        self.seconds.solve += outcome.seconds.solve;
        self.seconds.verify += outcome.seconds.verify;
        self.rounds += outcome.iterations;
        self.largest = std::mem::take(&mut self.largest).max(outcome.size.clone());
    }

    pub(crate) fn told(self, outcome: Outcome) -> Outcome {
        Outcome { seconds: self.seconds, iterations: self.rounds, size: self.largest, ..outcome }
    }
}

/// An answer for a value.
struct Solved {
    value: i64,
    problem: Problem,
    outcome: Outcome,
}

/// Where to look next: at growing distances while the answer is no, then in the middle of what is left.
#[derive(Default)]
pub(crate) struct Steps {
    pub(crate) distance: i64,
    /// The least value known to be otherwise.
    pub(crate) bound: Option<i64>,
}

impl Steps {
    /// A value from `low` up, where smaller ones are settled; `None` where the bound is reached.
    pub(crate) fn next(&self, low: i64, high: i64) -> Option<i64> {
        match self.bound {
            Some(bound) if bound <= low => None,
            Some(bound) => Some(low + (bound - low) / 2),
            None => Some(low.saturating_add(self.distance).min(high)),
        }
    }

    pub(crate) fn grow(&mut self) {
        self.distance = self.distance.saturating_mul(2).saturating_add(1);
    }
}

impl<'a, E> Minimizer<'a, E> {
    fn new(
        objective: &'a str,
        range: RangeInclusive<i64>,
        problem_of: ProblemOf<'a, E>,
        config: &'a Config,
    ) -> Result<Self, MinimizeError<E>> {
        let (low, high) = (*range.start(), *range.end().max(range.start()));
        let problem = problem_of(low).map_err(MinimizeError::Problem)?;
        let parts = conjuncts(&find(&problem, objective, low)?.formula);
        let chain = Chain { end: low, whole: !parts.is_empty(), parts, problem };
        let spent = Spent::default();
        Ok(Minimizer { objective, problem_of, config, chain, first: low, low, high, spent })
    }

    fn problem(&mut self, value: i64) -> Result<Problem, MinimizeError<E>> {
        (self.problem_of)(value).map_err(MinimizeError::Problem)
    }

    /// Follows the chain up to a value. The deadline ends it, and so does a value without a problem: it may never
    /// have to be asked.
    fn follow(&mut self, value: i64) {
        while self.chain.end < value && !self.chain.parts.is_empty() {
            let next = self.chain.end + 1;
            let problem = if self.config.deadline.passed() { None } else { (self.problem_of)(next).ok() };
            let chain = &mut self.chain;
            let lasts = problem.as_ref().and_then(|problem| {
                let (from, to) =
                    (chain.problem.objective(self.objective)?, problem.objective(self.objective)?);
                lasting((&chain.problem, from), (problem, to), &self.config.graphs)
            });
            let before = chain.parts.len();
            chain.parts.retain(|&part| lasts.as_ref().is_some_and(|lasts| lasts[part]));
            chain.whole &= chain.parts.len() == before;
            chain.end = next;
            if let Some(problem) = problem {
                chain.problem = problem;
            }
        }
    }

    /// The answer for the last value of a range that is not wide, if more does not hurt and it is soon found.
    fn last(&mut self) -> Result<Option<Solved>, MinimizeError<E>> {
        // Other solvers take longer than what a guess may save.
        if self.high == self.low || self.high - self.low > NEAR || !self.config.solver.is_embedded() {
            return Ok(None);
        }
        self.follow(self.high);
        if !self.chain.whole {
            return Ok(None);
        }
        let problem = self.problem(self.high)?;
        let left = self.config.deadline.remaining().map_or(GUESS, |left| GUESS.min(left / SHARE));
        let solved = self.solve(self.high, problem, Some(left))?;
        Ok(Some(solved).filter(|solved| solved.outcome.verdict != Verdict::Unknown))
    }

    /// Raises `low` past values for which the parts that last are hopeless. A guess of the least of the others is tried first,
    /// if there is one: where only smaller values are hopeless, it is asked for at once.
    fn refute(&mut self, guess: Option<i64>) -> Result<(), MinimizeError<E>> {
        let below = guess.map(|guess| guess - 1).filter(|below| (self.low..=self.high).contains(below));
        if let Some(below) = below {
            self.raise(Some(below), Among::All)?;
            if self.low > below {
                return Ok(());
            }
        }
        self.raise(None, Among::Each)?;
        self.raise(None, Among::All)
    }

    /// Raises `low` past values for which the parts that last are hopeless, by what is looked at together.
    fn raise(&mut self, mut first: Option<i64>, among: Among) -> Result<(), MinimizeError<E>> {
        let mut steps = Steps::default();
        let only = first.is_some();
        while let Some(value) = first.take().or_else(|| steps.next(self.low, self.high).filter(|_| !only)) {
            self.follow(value);
            if self.chain.parts.is_empty() {
                break;
            }
            let problem = self.problem(value)?;
            let mut objective = find(&problem, self.objective, value)?.clone();
            objective.formula.push(Node::And(self.chain.parts.clone()), objective.span);
            if !self.is_hopeless(&problem, &objective, among) {
                steps.bound = Some(value);
            } else if value == self.high {
                // The answer for the last value is wanted too.
                self.low = value;
                break;
            } else {
                self.low = value + 1;
                steps.grow();
            }
        }
        Ok(())
    }

    /// Whether the states that can matter show that the objective is unrealizable.
    fn is_hopeless(&mut self, problem: &Problem, objective: &Objective, among: Among) -> bool {
        let start = Instant::now();
        let hopeless = hopeless(problem, objective, self.config, among);
        self.spent.seconds.encode += start.elapsed().as_secs_f64();
        // What cannot be settled here is left to the solver.
        hopeless.unwrap_or(false)
    }

    /// Asks for values from `low` up; the last may have been answered before.
    fn run(mut self, mut last: Option<Solved>) -> Result<Least, MinimizeError<E>> {
        let mut best: Option<Solved> = None;
        let mut steps = Steps::default();
        // Smaller values are settled, or took too long.
        let mut floor = self.low;
        let mut late: Option<Reason> = None;
        loop {
            floor = floor.max(self.low);
            if let Some(least) = best.take_if(|best| best.value == floor) {
                return Ok(self.conclude(least, late));
            }
            let far = steps.next(floor, self.high).unwrap_or(floor);
            if self.chain.whole {
                self.follow(far);
            }
            let value = if self.chain.whole { far } else { self.low };
            if let Some(known) = last.take_if(|last| last.value == value || steps.distance > 0) {
                steps.bound = Some(known.value);
                best = Some(known);
                continue;
            }
            let problem = self.problem(value)?;
            // Where the objective lasts, `refute` has asked this; and our own solver's search begins with it.
            if !self.chain.whole && value < self.high && !self.config.solver.is_embedded() {
                let objective = find(&problem, self.objective, value)?;
                if self.is_hopeless(&problem, objective, Among::All) {
                    self.low = value + 1;
                    continue;
                }
            }
            // Where more does not hurt, the rest of the time is for larger values: some strategy is better than none.
            let patient = !self.chain.whole || value == self.high;
            let share = self.config.deadline.remaining().filter(|_| !patient).map(|left| left / SHARE);
            let solved = self.solve(value, problem, share)?;
            match solved.outcome.verdict {
                Verdict::Realizable => {
                    steps.bound = Some(value);
                    best = Some(solved);
                }
                Verdict::Unrealizable if value == self.high => {
                    self.low = value;
                    return Ok(self.conclude(solved, None));
                }
                Verdict::Unrealizable => {
                    self.low = value + 1;
                    late = None;
                    steps.grow();
                }
                Verdict::Unknown if !patient && !self.config.deadline.passed() => {
                    floor = value + 1;
                    late = solved.outcome.reason;
                    steps.grow();
                }
                Verdict::Unknown => {
                    let reason = solved.outcome.reason.clone().unwrap_or(Reason::Solver(Unknown::Unsaid));
                    return Ok(self.conclude(best.or(last).unwrap_or(solved), Some(reason)));
                }
            }
        }
    }

    /// The answer for a value, within so much time, if that is limited.
    fn solve(
        &mut self,
        value: i64,
        problem: Problem,
        limit: Option<Duration>,
    ) -> Result<Solved, MinimizeError<E>> {
        let objective = find(&problem, self.objective, value)?;
        let refuted = Some(self.low).filter(|low| *low > self.first);
        self.config.watch.tell(|standing| (standing.value, standing.least) = (Some(value), refuted));
        let mut config = self.config.clone();
        if let Some(limit) = limit {
            config.deadline = config.deadline.within(limit);
        }
        let outcome = search_or_race(&problem, objective, &config)
            .map_err(|error| MinimizeError::Solve { value, error })?;
        self.spent.add(&outcome);
        if outcome.verdict == Verdict::Realizable {
            self.config.watch.tell(|standing| {
                standing.best = Some(standing.best.map_or(value, |best| best.min(value)));
            });
        }
        Ok(Solved { value, problem, outcome })
    }

    fn conclude(self, solved: Solved, undecided: Option<Reason>) -> Least {
        let Solved { value, problem, outcome } = solved;
        let outcome = self.spent.told(outcome);
        Least { value, problem, outcome, proved: self.low, undecided }
    }
}

/// The steps of its horizon in which no path of a strategy moves any more, nor paths of others do what is read, if that is before
/// its end.
fn saved(solved: &Solved, objective: &str) -> Option<i64> {
    let strategy = solved.outcome.witness.as_ref()?;
    let traces = &strategy.traces;
    let idle = |trace: &Trace| {
        trace.states.iter().rev().zip(trace.states.iter().rev().skip(1)).take_while(|(a, b)| a == b).count()
    };
    let saved = traces.iter().map(idle).min()?;
    let objective = solved.problem.objective(objective)?;
    let others = || {
        let (_, time) =
            settled_for_others(&solved.problem, objective, strategy, &Budget::default()).ok()??;
        let steps = traces.iter().map(|trace| trace.actions.len()).max()?;
        steps.checked_sub(time as usize).filter(|saved| *saved > 0)
    };
    let others = if objective.blocks().len() > 1 { others() } else { None };
    i64::try_from(others.map_or(saved, |others| others.min(saved))).ok()
}

/// Which paths of a leading block are looked at together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Among {
    /// Each by itself, which is soon done.
    Each,
    /// All that are tied, and the one path against the others' player.
    All,
}

/// Whether nothing can matter of some path of a leading block of existential paths. That counts only where every
/// quantifier ranges over some path.
fn hopeless(
    problem: &Problem,
    objective: &Objective,
    config: &Config,
    among: Among,
) -> Result<bool, encode::Error> {
    let stop = || config.deadline.passed();
    let encoder = Encoder::sharing(problem, objective, config.states, config.limits, &stop, &config.graphs)?;
    if !is_existential(objective) || !encoder.states.is_enumerated() {
        return Ok(false);
    }
    if !objective.paths.keys().all(|path| encoder.has_path(path) == Some(true)) {
        return Ok(false);
    }
    let goal = Goal::new(&objective.formula, true);
    let leading = objective.leading_block();
    let one_run = among == Among::Each || leading.len() > 1;
    let blocks: Vec<&[PathId]> = match among {
        Among::Each => leading.chunks(1).collect(),
        Among::All => vec![&leading],
    };
    for block in blocks {
        // Two steps, as most questions here are answered by the first.
        for slack in [SLACKS[0], None] {
            let relevant = encoder.writer.relevant(block, &goal, Narrowing { slack, one_run })?;
            match relevant.is_hopeless() {
                true if relevant.is_exact() => return Ok(true),
                true => {}
                false => break,
            }
        }
    }
    Ok(false)
}
