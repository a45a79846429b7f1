//! A second solver is asked whether what the first one finds unsatisfiable is so.

use crate::config::Error;
use crate::evidence::{Claim, Evidence};
use crate::oracle::{Dialogue, Oracle, Stop};
use hyperplan_smt::{Model, Script, Term, check_model};
use hyperplan_solver::{Answer, Error as SolverError, open};
use std::time::Instant;

impl Oracle<'_> {
    /// Has unsat confirmed, where that was asked for. A second solver that does not know confirms nothing, which the
    /// user is told; one that contradicts is an error.
    pub(crate) fn cross_check(&mut self, dialogue: &mut Dialogue, script: &Script) -> Result<(), Stop> {
        let Some(spec) = &self.config.cross_check else { return Ok(()) };
        let start = Instant::now();
        let second = match dialogue.second.take() {
            Some(second) => Ok(second),
            None => open(spec, &dialogue.options),
        };
        let checked = second.and_then(|mut second| {
            let answer = second.check(script, &[], &self.config.deadline)?;
            dialogue.second = Some(second);
            Ok(answer)
        });
        self.solving += start.elapsed().as_secs_f64();
        match checked {
            Ok(Answer::Unsat) => Ok(()),
            Ok(Answer::Sat) => Err(self.disagreement(dialogue, script).into()),
            Ok(Answer::Unknown(reason)) => {
                self.unconfirmed(spec.name(), &reason);
                Ok(())
            }
            Err(error) if error.is_unsupported() => {
                self.unconfirmed(spec.name(), &error.to_string());
                Ok(())
            }
            Err(error) => Err(Error::Solver(error).into()),
        }
    }

    fn unconfirmed(&mut self, solver: &str, reason: &str) {
        let note = format!("an unsat was not confirmed by {solver}: {reason}");
        if !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    fn disagreement(&self, dialogue: &mut Dialogue, script: &Script) -> Error {
        let unsat = dialogue.session.identity();
        let Some(second) = &mut dialogue.second else {
            // It has just answered.
            return Error::Solver(SolverError::NoModel { name: unsat.name });
        };
        let sat = second.identity();
        let symbols: Vec<Term> = script.symbols();
        let values = second.values(script, &symbols).unwrap_or_default();
        let known = values.len() == symbols.len();
        let model: Model = symbols.into_iter().zip(values).collect();
        let result = check_model(script, &model);
        let worth = match (result.violated, result.unknown) {
            _ if !known => "but gives no model of the query",
            (Some(_), _) => "but its model does not satisfy the query",
            (None, 0) => "and its model satisfies the query",
            (None, _) => "with a model that cannot be evaluated on the query",
        };
        let evidence = Evidence::new(script, &Claim::Both { unsat: &unsat, sat: &sat, model: &model });
        let what = format!("{worth}, {}", evidence.keep(self.config));
        Error::Disagreement { unsat: unsat.name, sat: sat.name, what }
    }
}
