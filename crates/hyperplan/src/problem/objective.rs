//! What can be done with an objective of a problem.

use super::Problem;
use crate::draw::{Kind, Subject};
use crate::error::Error;
use crate::horizon::PathHorizon;
use crate::options::Options;
use crate::outcome::{Outcome, Verification};
use crate::search::{Decided, decide, straight};
use crate::source::Parsed;
use hyperplan_horizon::{Horizon, horizons};
use hyperplan_plan::explain::{Explanation, explain, longer};
use hyperplan_plan::{self as plan, EmitConfig, Emitted, Least, MinimizeError};
use hyperplan_problem::answer::{StrategyFile, Verdict, WitnessPath, plans, to_strategy, to_witness};
use hyperplan_problem::{self as typed, Strategy, Value};
use hyperplan_solver::{Deadline, PrintedModel};
use hyperplan_verify::{Budget, Check, Defeat, check, complete};
use std::ops::RangeInclusive;
use std::time::Instant;

/// The least value of a constant.
#[derive(Debug)]
#[non_exhaustive]
pub struct Minimized {
    /// The least value for which the objective is realizable, if one was found.
    pub value: Option<i64>,
    /// Every smaller value of the range is unrealizable.
    pub proved: bool,
    /// The problem with the value that the outcome is about.
    pub problem: Problem,
    /// The answer for it.
    pub outcome: Outcome,
}

/// An objective of a problem.
#[derive(Clone, Copy, Debug)]
pub struct Objective<'p> {
    pub(crate) problem: &'p Problem,
    pub(crate) typed: &'p typed::Objective,
}

impl<'p> Objective<'p> {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'p str {
        &self.typed.name
    }

    /// Its paths and its formula, typed.
    #[must_use]
    pub fn typed(&self) -> &'p typed::Objective {
        self.typed
    }

    /// Decides it; where it says `minimize`, with the strategy that costs least. A strategy was checked by code that shares
    /// nothing with the search.
    ///
    /// # Errors
    /// What is not supported, and failures of solvers. That the time is up is a verdict, `unknown`.
    pub fn solve(&self, options: &Options) -> Result<Outcome, Error> {
        let (start, config) = (Instant::now(), options.config());
        let targets = &self.typed.minimize;
        let decided = options.watched(&config.watch, || {
            decide(&self.problem.typed, self.typed, targets, &config, options.wants_first())
        })?;
        Ok(self.outcome(decided, start))
    }

    fn outcome(&self, decided: Decided, start: Instant) -> Outcome {
        let read = self.problem.time;
        let file = self.problem.source.name();
        Outcome::new(file, (&self.problem.typed, self.typed), decided, (read, read + start.elapsed()))
    }

    /// How many steps of each of its paths matter, and why; in the order of the paths.
    #[must_use]
    pub fn horizon(&self) -> Vec<Horizon> {
        horizons(self.typed).into_iter().collect()
    }

    /// The same by the names of paths, with the parts of the formula as they are written.
    #[must_use]
    pub fn horizon_in_words(&self) -> Vec<(String, PathHorizon)> {
        let names = self.typed.paths.iter().map(|path| path.name.clone());
        let sources = &self.problem.sources;
        names.zip(self.horizon().iter().map(|h| PathHorizon::new(sources, self.typed, h))).collect()
    }

    /// The strategy that paths are, which may come from anywhere: states may be left out where actions decide them.
    ///
    /// # Errors
    /// When they are none, or leave something open.
    pub fn strategy(&self, paths: &[WitnessPath]) -> Result<Strategy, Error> {
        let (problem, objective) = (&*self.problem.typed, self.typed);
        let paths = plans::meant(problem, objective, paths);
        let mut strategy = to_strategy(problem, objective, &paths)?;
        complete(problem, objective, &mut strategy, &Budget::default())
            .map_err(|open| Error::Incomplete(open.describe(problem, objective)))?;
        Ok(strategy)
    }

    /// The strategy in a text: an answer as JSON, CSV or a plan in PDDL. Of several answers that for this objective.
    ///
    /// # Errors
    /// Those of [`Objective::strategy`], and when the text is none.
    pub fn read_strategy(&self, text: &str) -> Result<Strategy, Error> {
        let answers = plans::read(text).map_err(Error::NotRead)?;
        let is_own = |answer: &StrategyFile| answer.objective.as_ref().is_none_or(|own| own == self.name());
        let own = answers.into_iter().find(is_own).and_then(|answer| answer.witness);
        let none = || Error::NotRead(format!("there is no witness for objective {}", self.name()));
        self.strategy(&own.ok_or_else(none)?)
    }

    /// The strategy that the model of a query describes, which [`Objective::emit`] wrote and some solver answered: what it
    /// prints for `(get-model)`. It is not checked.
    ///
    /// # Errors
    /// When the text is no model, or none of a query of this objective.
    pub fn strategy_of_model(&self, text: &str, options: &Options) -> Result<Strategy, Error> {
        let model = PrintedModel::read(text).map_err(|error| Error::NotRead(error.to_string()))?;
        let deadline = options.config().deadline;
        Ok(plan::strategy_of_model(&self.problem.typed, self.typed, &model, &deadline)?)
    }

    /// The paths of a strategy in the names of the problem.
    #[must_use]
    pub fn paths_of(&self, strategy: &Strategy) -> Vec<WitnessPath> {
        to_witness(&self.problem.typed, self.typed, strategy)
    }

    /// Whether a strategy does what the objective asks, decided without any solver.
    ///
    /// # Errors
    /// When numbers outgrow 64 bits.
    pub fn verify(&self, strategy: &Strategy) -> Result<Verification, Error> {
        let (problem, objective) = (&*self.problem.typed, self.typed);
        Ok(match check(problem, objective, strategy, &Budget::default())? {
            Check::Holds => Verification::Holds,
            Check::TooLarge { .. } => Verification::TooLarge,
            Check::Fails(defeat) => {
                let reason = defeat.describe(objective);
                let paths = match defeat {
                    Defeat::Paths(traces) => self.paths_of(&Strategy { traces }),
                    _ => Vec::new(),
                };
                Verification::Fails { reason, paths }
            }
        })
    }

    /// Why it is unrealizable: of an outcome with that verdict; of others nothing is said.
    ///
    /// # Errors
    /// Failures of solvers. What is not found out in time is said to be open.
    pub fn explain(&self, outcome: &Outcome, options: &Options) -> Result<Explanation, Error> {
        let config = options.config();
        let mut ways: Vec<_> = longer(&self.problem.typed, self.typed).into_iter().collect();
        let found = options.watched(&config.watch, || {
            explain(&self.problem.typed, self.typed, &outcome.found, &mut ways, &config)
        });
        Ok(found?)
    }

    /// The least value of an integer constant for which it is realizable. Without a range: from 0, or the least value
    /// with which the problem has no errors, up to the constant's own.
    ///
    /// # Errors
    /// Those of [`Objective::solve`], and when the constant cannot be varied.
    pub fn minimize(
        &self,
        constant: &str,
        range: Option<RangeInclusive<i64>>,
        options: &Options,
    ) -> Result<Minimized, Error> {
        let start = Instant::now();
        let wrong = |why| Error::Constant { name: constant.to_owned(), why };
        let parsed = self.problem.source.parsed().ok_or_else(|| wrong("files of other tools have none"))?;
        let config = options.config();
        let range = self.range(&parsed, constant, range, &config.deadline)?;
        let mut problem_of =
            |value: i64| self.problem.with(constant, value).map(|problem| (*problem.typed).clone());
        let found =
            options.watched(&config.watch, || plan::minimize(self.name(), range, &mut problem_of, &config));
        let Least { value, outcome, undecided, .. } = found.map_err(|error| match error {
            MinimizeError::Problem(error) => error,
            MinimizeError::Solve { value, error } => {
                Error::SearchWith { name: constant.to_owned(), value, error }
            }
        })?;
        let problem = self.problem.with(constant, value)?;
        let objective = problem.objective(self.name())?;
        let outcome = if options.wants_first() {
            outcome
        } else {
            straight(&problem.typed, objective.typed, outcome, &config)
        };
        let found = outcome.verdict == Verdict::Realizable;
        let proved = found && undecided.is_none();
        let outcome = objective.outcome(Decided { outcome, costs: Vec::new(), undecided }, start);
        Ok(Minimized { value: found.then_some(value), proved, outcome, problem })
    }

    /// The values that a constant may take.
    fn range(
        &self,
        parsed: &Parsed<'_>,
        constant: &str,
        range: Option<RangeInclusive<i64>>,
        deadline: &Deadline,
    ) -> Result<RangeInclusive<i64>, Error> {
        let wrong = |why| Error::Constant { name: constant.to_owned(), why };
        let known = self.problem.constants().iter().find(|(name, _)| name == constant);
        let (_, value) = known.ok_or_else(|| wrong("there is none"))?;
        let Value::Int(value) = *value else {
            return Err(wrong("it is a fraction; only integers can be minimized"));
        };
        if !parsed.uses(constant) {
            return Err(wrong("nothing depends on it"));
        }
        match range {
            Some(range) if range.is_empty() => Err(wrong("the range is empty")),
            Some(range) => Ok(range),
            None if value < 0 => Err(wrong("it is negative, so the range must be said")),
            None => {
                // Such as 0 in `[1,T]`. Its own value has no errors, so there is such a value.
                let with = |value: &i64| self.problem.overrides.clone().with(constant, value);
                let fits = |value: &i64| !parsed.lower(&with(value)).0.has_errors();
                // Where the time is up before one is found, the search says so.
                let least = (0..value).take_while(|_| !deadline.passed()).find(fits);
                Ok(least.unwrap_or(value)..=value)
            }
        }
    }

    /// The query as a benchmark, or for a solver of one's own.
    ///
    /// # Errors
    /// What is not supported, or too large.
    pub fn emit(&self, config: &EmitConfig) -> Result<Emitted, Error> {
        Ok(plan::emit(&self.problem.typed, self.typed, config)?)
    }

    /// As [`Objective::emit`], in the time that there is, for the solver of the options; as text.
    ///
    /// # Errors
    /// Those of [`Objective::emit`], and what cannot be written.
    pub fn emit_text(&self, config: EmitConfig, options: &Options) -> Result<String, Error> {
        let plan::Config { deadline, solver, .. } = options.config();
        // The embedded engine reads no text.
        let solver = config.solver.or(Some(solver)).filter(|solver| !solver.is_embedded());
        let mut emitted = self.emit(&EmitConfig { deadline, solver, ..config })?;
        let mut text = Vec::new();
        emitted.write(&mut text).map_err(|error| Error::Search(plan::Error::Tape(error)))?;
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    /// A picture of a strategy, with the worst of all that it has to cope with.
    ///
    /// # Errors
    /// When it is too large, or nothing moves in a film.
    pub fn draw(&self, strategy: &Strategy, kind: Kind) -> Result<Vec<u8>, Error> {
        let (problem, objective) = (&*self.problem.typed, Some(self.typed));
        Ok(Subject { problem, objective, strategy: Some(strategy), named: &[] }.draw(kind)?)
    }
}
