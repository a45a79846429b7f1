//! Questions: whether some paths, all chosen freely, satisfy a formula.

use crate::cegis::{Assignment, Cegis};
use crate::config::Config;
use crate::fact::{Error, Reason};
use crate::oracle::{Oracle, Stop, solver_for};
use crate::prepare::{is_finite, no_dead_ends, without_paths};
use hyperplan_encode::{self as encode, Encoder, Goal, Limits};
use hyperplan_problem::{Formula, Mode, Objective, PathId, PathVar, Problem, Quantifier};
use hyperplan_solver::{Deadline, Spec, Unknown};
use hyperplan_syntax::{Diagnostic, Span};
use std::time::Duration;

/// Systems with more states are not enumerated for a question.
const STATES: usize = 300_000;

/// Undecided questions that are listed; of the others only that there are some.
const LISTED: usize = 20;

/// Asks, keeps the time, and remembers what was not decided.
pub(crate) struct Asker<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) objective: &'a Objective,
    /// The end of all questions.
    deadline: Deadline,
    /// The time for one of them.
    each: Duration,
    /// Who is asked.
    solver: Spec,
    undecided: Vec<Diagnostic>,
}

impl<'a> Asker<'a> {
    pub(crate) fn new(
        problem: &'a Problem,
        objective: &'a Objective,
        deadline: Deadline,
        each: Duration,
    ) -> Self {
        let solver = solver_for(!is_finite(problem, objective)).unwrap_or(Spec::Builtin);
        Asker { problem, objective, deadline, each, solver, undecided: Vec::new() }
    }

    pub(crate) fn into_undecided(self) -> Vec<Diagnostic> {
        self.undecided
    }

    /// Whether some choice of all paths satisfies the formula; `None` where that was not decided. `what` completes
    /// the sentence "it is undecided whether ...".
    pub(crate) fn possible(&mut self, formula: Formula, about: Span, what: &str) -> Option<bool> {
        let question = free(self.objective, formula);
        let found = self.example(self.problem, &question, about, what)?;
        Some(found.is_some())
    }

    /// The paths of an objective without `forall` that satisfy it, where there are some.
    pub(crate) fn example(
        &mut self,
        problem: &Problem,
        question: &Objective,
        about: Span,
        what: &str,
    ) -> Option<Option<Assignment>> {
        let config = self.config();
        match search(problem, question, &config) {
            Ok(found) => Some(found),
            Err(stop) => {
                self.give_up(stop, about, what);
                None
            }
        }
    }

    /// A warning where some path ranges over nothing, so that quantifiers alone decide the objective.
    pub(crate) fn without_paths(&mut self) -> Option<Diagnostic> {
        let config = self.config();
        let (problem, objective) = (self.problem, self.objective);
        match nothing_for(problem, objective, &config) {
            Ok(path) => path.map(|path| nothing(problem, objective, path)),
            Err(stop) => {
                self.give_up(stop, objective.span, "there are paths");
                None
            }
        }
    }

    /// Whether there is no time for more questions, which is then noted.
    pub(crate) fn is_over(&mut self, about: Span) -> bool {
        let over = self.deadline.passed();
        if over {
            self.give_up(Stop::Unknown(Unknown::Timeout.into()), about, "every part of this matters");
        }
        over
    }

    fn config(&self) -> Config {
        let deadline = self.deadline.within(self.each);
        Config { deadline, verify: false, ..Config::new(self.solver.clone()) }
    }

    /// Notes a question that was not asked.
    pub(crate) fn leave_open(&mut self, about: Span, what: &str) {
        let message = format!("it is undecided whether {what}");
        self.undecided.push(Diagnostic::warning("undecided", about, message));
    }

    fn give_up(&mut self, stop: Stop, about: Span, what: &str) {
        let message = if self.undecided.len() < LISTED {
            let why = match stop {
                _ if self.deadline.passed() => "no time was left".to_owned(),
                Stop::Error(Error::Encode(encode::Error::Interrupted)) => self.late(),
                Stop::Unknown(Reason::Solver(Unknown::Timeout)) => self.late(),
                Stop::Unknown(reason) => reason.to_string(),
                Stop::Error(error) => error.to_string(),
            };
            format!("it is undecided whether {what}: {why}")
        } else if self.undecided.len() == LISTED {
            "more is undecided".to_owned()
        } else {
            return;
        };
        self.undecided.push(Diagnostic::warning("undecided", about, message));
    }

    fn late(&self) -> String {
        format!("that takes more than {} s", self.each.as_secs_f64())
    }
}

/// The objective with all paths chosen freely, and another formula.
pub(crate) fn free(objective: &Objective, formula: Formula) -> Objective {
    let exists = |path: &PathVar| PathVar { quantifier: Quantifier::Exists, ..path.clone() };
    Objective { formula, paths: objective.paths.iter().map(exists).collect(), ..objective.clone() }
}

fn limits() -> Limits {
    Limits { states: STATES, ..Limits::default() }
}

fn search(problem: &Problem, question: &Objective, config: &Config) -> Result<Option<Assignment>, Stop> {
    let stop = || config.deadline.passed();
    if stop() {
        return Err(Stop::Unknown(config.deadline.reason().into()));
    }
    let encoder = Encoder::new(problem, question, None, limits(), &stop)?;
    let mut oracle = Oracle::new(config);
    no_dead_ends(&encoder, &mut oracle)?;
    let blocks = [question.paths.keys().collect::<Vec<_>>()];
    let mut cegis = Cegis::new(&encoder, &mut oracle, &blocks);
    let none = vec![None; question.paths.len()];
    Ok(cegis.find(0, &none, &Goal::new(&question.formula, true), 1)?.pop())
}

fn nothing_for(problem: &Problem, objective: &Objective, config: &Config) -> Result<Option<PathId>, Stop> {
    let stop = || config.deadline.passed();
    let encoder = Encoder::new(problem, objective, None, limits(), &stop)?;
    let mut oracle = Oracle::new(config);
    no_dead_ends(&encoder, &mut oracle)?;
    without_paths(&encoder, &mut oracle)
}

fn nothing(problem: &Problem, objective: &Objective, path: PathId) -> Diagnostic {
    let var = &objective.paths[path];
    let system = &problem.systems[var.system].name;
    let message = match objective.mode {
        Mode::Within(1) => format!("system {system} has no path of 1 step"),
        Mode::Within(steps) => format!("system {system} has no path of {steps} steps"),
        _ => format!("system {system} has no path that goes on for ever"),
    };
    let holds = if var.quantifier == Quantifier::Forall { "holds" } else { "fails" };
    Diagnostic::warning("no-paths", var.span, message)
        .with_help(format!("`{}` ranges over nothing, so the objective {holds} whatever it says", var.name))
}
