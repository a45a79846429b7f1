//! Certificates of what is said to be impossible: made for `solve --proof`.

use crate::failure::{Exit, Failure, Result};
use crate::files;
use crate::load::Loaded;
use crate::output::Output;
use crate::wish::{Smallest, Wish};
use hyperplan_certify::{Apart, Benchmark, Bound, Certificate, Claim, Error, Parts, compress, with_bounds};
use hyperplan_compare::plan::sha256;
use hyperplan_plan::{Proved, Unproved, Verdict, prove};
use hyperplan_problem::answer::{Below, CostValue, Minimized};
use hyperplan_problem::{Objective, Problem, Target};
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

/// What an answer says, as far as it may be certified.
pub(crate) struct Said<'a> {
    pub(crate) verdict: Verdict,
    pub(crate) minimized: Option<&'a Minimized>,
    pub(crate) costs: &'a [CostValue],
    /// The strategies, or counterexamples, where there are no others.
    pub(crate) all: Option<Apart>,
}

/// A claim: that an objective of a problem has no strategy, or no counterexample.
struct Subject<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    /// The value of a constant that the file does not have.
    value: Option<(&'a str, i64)>,
    /// Costs that its strategies would have.
    costs: Vec<Bound>,
    /// What they would differ from.
    apart: Option<&'a Apart>,
    /// What of the objective is asked for, if it is not all.
    parts: Option<&'a Parts>,
}

impl Subject<'_> {
    /// The name of its files.
    fn name(&self) -> String {
        let name = &match (self.apart, self.parts) {
            (Some(_), _) => format!("{}-others", self.objective.name),
            (None, Some(_)) => format!("{}-parts", self.objective.name),
            (None, None) => self.objective.name.clone(),
        };
        match (self.value, self.costs.len()) {
            (Some((constant, value)), 0) => format!("{name}-{constant}={value}"),
            (Some((constant, value)), number) => format!("{name}-{constant}={value}-cost-{number}"),
            (None, 0) => name.clone(),
            (None, number) => format!("{name}-cost-{number}"),
        }
    }
}

impl Prover<'_> {
    /// Certifies what an answer says is impossible; which files were made. Where there is no certificate, this is said.
    ///
    /// # Errors
    /// If the answer is wrong, or nothing can be written.
    pub(crate) fn prove(
        &self,
        (loaded, objective): (&Loaded, &Objective),
        said: &Said<'_>,
        wish: &Wish<'_>,
        out: &mut Output,
    ) -> Result<(Vec<String>, Exit)> {
        let mut made = (Vec::new(), Exit::Good);
        let claims = claims(objective, said.verdict);
        match (&wish.smallest, said.minimized) {
            (Smallest::Constant(parameter), Some(minimized)) => {
                let (first, last) = minimized.range;
                let end = match (minimized.value, minimized.below, Claim::of(objective)) {
                    // A value for which the property holds.
                    (Some(value), _, Claim::NoCounterexample) => Some(value..value + 1),
                    (Some(value), Below::Unrealizable, Claim::NoStrategy) => Some(first..value),
                    (None, _, Claim::NoStrategy) if said.verdict == Verdict::Unrealizable => {
                        Some(first..last + 1)
                    }
                    _ => None,
                };
                for value in end.into_iter().flatten() {
                    let problem = parameter.problem(value)?;
                    let Some(objective) = problem.objective(&objective.name) else { break };
                    let value = Some((parameter.constant, value));
                    // Larger values would fare no better.
                    if !self.one(
                        &Subject {
                            problem: &problem,
                            objective,
                            value,
                            costs: Vec::new(),
                            apart: None,
                            parts: None,
                        },
                        &mut made,
                        out,
                    )? {
                        break;
                    }
                }
                if let (Some(value), Claim::NoStrategy) = (minimized.value, Claim::of(objective)) {
                    let preferred = (&*wish.preferred(loaded, objective, Some(value))?, said.costs);
                    let about = (loaded, objective, Some((parameter.constant, value)));
                    self.costs(about, preferred, &mut made, out)?;
                }
            }
            _ if claims => {
                let (problem, costs) = (&loaded.problem, Vec::new());
                let subject = Subject { problem, objective, value: None, costs, apart: None, parts: None };
                self.one(&subject, &mut made, out)?;
            }
            _ => self.costs(
                (loaded, objective, None),
                (&wish.targets(loaded, objective)?, said.costs),
                &mut made,
                out,
            )?,
        }
        if let Some(all) = &said.all {
            let value = match (&wish.smallest, said.minimized) {
                (Smallest::Constant(parameter), Some(minimized)) => {
                    minimized.value.map(|value| (parameter.constant, value))
                }
                _ => None,
            };
            let kept = wish.kept(loaded, objective)?;
            self.others((loaded, objective, value), (all, &kept, said.costs), &mut made, out)?;
        }
        Ok(made)
    }

    /// Certifies that parts of an objective exclude each other.
    pub(crate) fn parts(
        &self,
        (problem, objective): (&Problem, &Objective),
        parts: &Parts,
        made: &mut (Vec<String>, Exit),
        out: &mut Output,
    ) -> Result<()> {
        let own = parts.objective(objective).map_err(|error| Failure::new(status(&error), error))?;
        let subject = Subject {
            problem,
            objective: &own,
            value: None,
            costs: Vec::new(),
            apart: None,
            parts: Some(parts),
        };
        self.one(&subject, made, out).map(drop)
    }

    /// Certifies an objective as it is, or for a value of a constant; whether there is a certificate.
    pub(crate) fn whole(
        &self,
        (problem, objective): (&Problem, &Objective),
        value: Option<(&str, i64)>,
        made: &mut (Vec<String>, Exit),
        out: &mut Output,
    ) -> Result<bool> {
        self.one(
            &Subject { problem, objective, value, costs: Vec::new(), apart: None, parts: None },
            made,
            out,
        )
    }

    /// Certifies that there are no others, with no more of what is to be as small as possible.
    fn others(
        &self,
        (loaded, objective, value): (&Loaded, &Objective, Option<(&str, i64)>),
        (all, kept, costs): (&Apart, &[Target], &[CostValue]),
        made: &mut (Vec<String>, Exit),
        out: &mut Output,
    ) -> Result<()> {
        let failed = |error: Error| Failure::new(status(&error), error);
        let apart = all.objective(&loaded.problem, objective).map_err(failed)?;
        let bounds: Vec<(Target, i64)> =
            kept.iter().cloned().zip(costs.iter().map(|cost| cost.value)).collect();
        let named = |cost: &CostValue| Bound { cost: cost.expression.clone(), most: cost.value };
        let costs = costs[..bounds.len()].iter().map(named).collect();
        let bounded = (!bounds.is_empty()).then(|| with_bounds(&loaded.problem, &apart, &bounds));
        let bounded = bounded.transpose().map_err(failed)?;
        let (problem, objective) = match &bounded {
            Some((problem, objective)) => (problem, objective),
            None => (&loaded.problem, &apart),
        };
        self.one(&Subject { problem, objective, value, costs, apart: Some(all), parts: None }, made, out)
            .map(drop)
    }

    /// Certifies that no strategy costs less: for each target that none has less of it, of those with no more of the targets before.
    fn costs(
        &self,
        (loaded, objective, value): (&Loaded, &Objective, Option<(&str, i64)>),
        (targets, costs): (&[Target], &[CostValue]),
        made: &mut (Vec<String>, Exit),
        out: &mut Output,
    ) -> Result<()> {
        let mut before: Vec<(Target, i64)> = Vec::new();
        for (target, cost) in targets.iter().zip(costs) {
            let bounds = [before.as_slice(), &[(target.clone(), cost.least - 1)]].concat();
            let bound = |(cost, (_, most)): (&CostValue, &(Target, i64))| Bound {
                cost: cost.expression.clone(),
                most: *most,
            };
            let named = costs.iter().zip(&bounds).map(bound).collect();
            let (problem, objective) = with_bounds(&loaded.problem, objective, &bounds)
                .map_err(|error| Failure::new(status(&error), error))?;
            let subject = Subject {
                problem: &problem,
                objective: &objective,
                value,
                costs: named,
                apart: None,
                parts: None,
            };
            // Where a value need not be the least, nothing is said of those after it.
            if !self.one(&subject, made, out)? || cost.least < cost.value {
                break;
            }
            before.push((target.clone(), cost.value));
        }
        Ok(())
    }

    /// Makes a certificate; whether there is one.
    fn one(&self, subject: &Subject<'_>, made: &mut (Vec<String>, Exit), out: &mut Output) -> Result<bool> {
        let what = || {
            let value = subject.value.map(|(constant, value)| format!("{constant} = {value}"));
            let cost = subject.costs.last().map(|Bound { cost, most }| format!("{cost} <= {most}"));
            let with: Vec<String> = value.into_iter().chain(cost).collect();
            if subject.parts.is_some() {
                return format!("{}: that these parts exclude each other", subject.objective.name);
            }
            if subject.apart.is_some() {
                return format!("{}: that there are no others", subject.objective.name);
            }
            match with.is_empty() {
                true => subject.objective.name.clone(),
                false => format!("{} with {}", subject.objective.name, with.join(", ")),
            }
        };
        match self.write(subject) {
            Ok(file) => {
                made.0.push(file);
                Ok(true)
            }
            Err((status @ (Exit::Bug | Exit::Solver), why)) => {
                Err(Failure::new(status, format_args!("{}: {why}", what())))
            }
            Err((status, why)) => {
                out.remark(format_args!("note: {}: not certified: {why}", what()));
                made.1 = made.1.max(status);
                Ok(false)
            }
        }
    }

    /// Makes and writes one certificate, and says what it is called; or which status a failure has, and why.
    fn write(&self, subject: &Subject<'_>) -> Result<String, (Exit, String)> {
        let &Subject { problem, objective, value, .. } = subject;
        let set = value.map(|(constant, value)| format!("{constant}={value}"));
        let set = self.set.iter().map(|(name, value)| format!("{name}={value}")).chain(set).collect();
        let mut made = Made::new((problem, objective), set, self.deadline)?;
        made.certificate.costs.clone_from(&subject.costs);
        made.certificate.apart = subject.apart.cloned();
        made.certificate.parts = subject.parts.cloned();
        made.write(&self.folder.join(subject.name())).map_err(|failure| (failure.status, failure.message))
    }
}

/// A certificate and its refutation.
pub(crate) struct Made {
    certificate: Certificate,
    proved: Proved,
}

impl Made {
    /// Makes the certificate of an objective; or says which status a failure has, and why.
    pub(crate) fn new(
        (problem, objective): (&Problem, &Objective),
        set: Vec<String>,
        deadline: &Deadline,
    ) -> Result<Made, (Exit, String)> {
        let failed = |error: &Error| (status(error), error.to_string());
        let proved = prove(problem, objective, deadline).map_err(|unproved| match unproved {
            Unproved::Undecided(reason) => (Exit::Undecided, reason.to_string()),
            Unproved::Certify(error) => failed(&error),
            Unproved::Failed(error) => (crate::explain::status(&error), error.to_string()),
        })?;
        let stop = || deadline.passed();
        let certificate = Certificate::new(problem, objective, set, &proved.branches, &stop)
            .map_err(|error| failed(&error))?;
        Ok(Made { certificate, proved })
    }

    /// Says which benchmark has the status that it certifies.
    pub(crate) fn of_benchmark(&mut self, text: &[u8], problem: String) {
        self.certificate.benchmark = Some(Benchmark { sha256: sha256(text), file: problem });
    }

    /// Writes the files; what the description is called.
    pub(crate) fn write(&self, base: &Path) -> Result<String> {
        let file = |ending: &str| base.with_added_extension(ending);
        files::write(&file(REFUTATION), |to| compress(to, |to| self.proved.refutation(to)))?;
        files::write(&file(DESCRIPTION), |to| self.certificate.write(to))?;
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
