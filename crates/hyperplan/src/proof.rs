//! Certificates of what is said to be impossible: made for `solve --proof`.

use crate::failure::{Exit, Failure, Result};
use crate::files;
use crate::load::Loaded;
use crate::output::Output;
use crate::wish::Wish;
use hyperplan_certify::{Certificate, Claim, Error, compress};
use hyperplan_plan::{Outcome, Unproved, Verdict, prove};
use hyperplan_problem::answer::{Below, Minimized};
use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::Deadline;
use std::path::Path;

/// The ending of descriptions; their refutations end with [`REFUTATION`].
pub(crate) const DESCRIPTION: &str = "json";
pub(crate) const REFUTATION: &str = "lrat.gz";

/// Where certificates go, and how long it may take to make them.
pub(crate) struct Prover<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) set: &'a [(String, String)],
    pub(crate) deadline: &'a Deadline,
}

impl Prover<'_> {
    /// Certifies what an answer says is impossible; which files were made. Where there is no certificate, this is said.
    ///
    /// # Errors
    /// If the answer is wrong, or nothing can be written.
    pub(crate) fn prove(
        &self,
        (loaded, objective): (&Loaded, &Objective),
        (outcome, minimized): (&Outcome, Option<&Minimized>),
        wish: &Wish<'_>,
        out: &mut Output,
    ) -> Result<(Vec<String>, Exit)> {
        let name = &objective.name;
        let mut made = Vec::new();
        let mut worst = Exit::Good;
        let mut one = |problem: &Problem, value: Option<(&str, i64)>| -> Result<bool> {
            let Some(objective) = problem.objective(name) else { return Ok(false) };
            let what = value.map_or_else(
                || name.clone(),
                |(constant, value)| format!("{name} with {constant} = {value}"),
            );
            match self.write(problem, objective, value) {
                Ok(file) => made.push(file),
                Err((status @ (Exit::Bug | Exit::Solver), why)) => {
                    return Err(Failure::new(status, format_args!("{what}: {why}")));
                }
                Err((status, why)) => {
                    out.remark(format_args!("note: {what}: not certified: {why}"));
                    worst = worst.max(status);
                    // Larger values would fare no better.
                    return Ok(false);
                }
            }
            Ok(true)
        };
        let claims = claims(objective, outcome.verdict);
        match (wish, minimized) {
            (Wish::Constant(parameter), Some(minimized)) => {
                let (first, last) = minimized.range;
                let end = match (minimized.value, minimized.below, Claim::of(objective)) {
                    // A value for which the property holds.
                    (Some(value), _, Claim::NoCounterexample) => Some(value..value + 1),
                    (Some(value), Below::Unrealizable, Claim::NoStrategy) => Some(first..value),
                    (None, _, Claim::NoStrategy) if outcome.verdict == Verdict::Unrealizable => {
                        Some(first..last + 1)
                    }
                    _ => None,
                };
                for value in end.into_iter().flatten() {
                    if !one(&parameter.problem(value)?, Some((parameter.constant, value)))? {
                        break;
                    }
                }
            }
            _ if claims => {
                one(&loaded.problem, None)?;
            }
            _ => {}
        }
        if !claims && !wish.targets(loaded, objective)?.is_empty() {
            out.remark(format_args!("note: {name}: not certified: that a cost is the least"));
            worst = worst.max(Exit::Input);
        }
        Ok((made, worst))
    }

    /// Makes and writes one certificate, and says what it is called; or which status a failure has, and why.
    fn write(
        &self,
        problem: &Problem,
        objective: &Objective,
        value: Option<(&str, i64)>,
    ) -> Result<String, (Exit, String)> {
        let failed = |error: &Error| (status(error), error.to_string());
        let proved = prove(problem, objective, self.deadline).map_err(|unproved| match unproved {
            Unproved::Undecided(reason) => (Exit::Undecided, reason.to_string()),
            Unproved::Certify(error) => failed(&error),
            Unproved::Failed(error) => (crate::explain::status(&error), error.to_string()),
        })?;
        let mut set: Vec<String> = self.set.iter().map(|(name, value)| format!("{name}={value}")).collect();
        set.extend(value.map(|(constant, value)| format!("{constant}={value}")));
        let stop = || self.deadline.passed();
        let certificate = Certificate::new(problem, objective, set, &proved.branches, &stop);
        let certificate = certificate.map_err(|e| failed(&e))?;
        let name = match value {
            Some((constant, value)) => format!("{}-{constant}={value}", objective.name),
            None => objective.name.clone(),
        };
        let file = |ending: &str| self.folder.join(format!("{name}.{ending}"));
        let said = |failure: Failure| (failure.status, failure.message);
        files::write(&file(REFUTATION), |to| compress(to, |to| proved.refutation(to))).map_err(said)?;
        files::write(&file(DESCRIPTION), |to| certificate.write(to)).map_err(said)?;
        Ok(file(DESCRIPTION).display().to_string())
    }
}

/// Whether a verdict claims that something does not exist.
fn claims(objective: &Objective, verdict: Verdict) -> bool {
    match Claim::of(objective) {
        Claim::NoStrategy => verdict == Verdict::Unrealizable,
        Claim::NoCounterexample => verdict == Verdict::Realizable,
    }
}

/// The exit status of a failure to certify or to check.
pub(crate) fn status(error: &Error) -> Exit {
    match error {
        Error::TooLarge { .. } | Error::Stopped => Exit::Undecided,
        Error::Malformed { .. } => Exit::Bug,
        Error::Step { .. } | Error::Incomplete => Exit::Unrealizable,
        Error::Infinite { .. }
        | Error::Instance { .. }
        | Error::Foreign(_)
        | Error::Unreadable(_)
        | Error::Io(_) => Exit::Input,
    }
}
