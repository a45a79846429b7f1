//! Certificates of what an explanation says is impossible.

use super::{Subject, Told};
use crate::failure::{Exit, Result};
use crate::output::Output;
use crate::proof::Prover;
use hyperplan_certify::Parts;
use hyperplan_plan::Verdict;
use hyperplan_plan::explain::{Longer, Scope, Time};
use hyperplan_problem::Quantifier;

impl Told<'_> {
    /// Certifies that there is no strategy, that the parts shown exclude each other, and that more time does not help, as far as
    /// that is said; its status.
    pub(super) fn certify(
        &mut self,
        prover: &Prover<'_>,
        longer: &mut [Longer<'_>],
        out: &mut Output,
    ) -> Result<Exit> {
        let (problem, objective) = (&self.loaded.problem, self.objective);
        let Subject::Answer { verdict: Verdict::Unrealizable, found, .. } = &self.subject else {
            return Ok(Exit::Good);
        };
        let mut made = (Vec::new(), Exit::Good);
        if objective.paths.first().is_some_and(|path| path.quantifier == Quantifier::Exists) {
            prover.whole((problem, objective), None, &mut made, out)?;
        }
        if let Some(core) = &found.core {
            let all = objective.formula.parts();
            let number = |part| all.iter().position(|other| other == part).map(|at| at + 1);
            let numbers = core.parts.iter().filter_map(number).collect();
            let parts = Parts { numbers, helped: core.scope == Scope::All };
            prover.parts((problem, objective), &parts, &mut made, out)?;
        }
        for later in found.later.iter().filter(|later| later.refuted > later.now) {
            let name = match &later.time {
                Time::Constant(name) => name,
                Time::Within | Time::Interval | Time::Bound => {
                    let message = "that more time does not help is certified for constants only";
                    out.remark(format_args!("note: {}: not certified: {message}", objective.name));
                    continue;
                }
            };
            let Some(longer) = longer.iter_mut().find(|longer| longer.time == later.time) else { continue };
            for value in later.now + 1..=later.refuted {
                let Some(problem) = (longer.problem_of)(value) else { break };
                let Some(objective) = problem.objective(&objective.name) else { break };
                if !prover.whole((&problem, objective), Some((name, value)), &mut made, out)? {
                    break;
                }
            }
        }
        self.certificates = made.0;
        Ok(made.1)
    }
}
