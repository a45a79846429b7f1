//! A second solver is asked whether what the first one finds unsatisfiable is so.

use super::{Dialogue, Oracle, Stop};
use crate::evidence::{Evidence, full};
use crate::fact::{Error, Fallen, Note, Worth};
use hyperplan_smt::{Model, Script, Term, check_model};
use hyperplan_solver::{Answer, Error as SolverError, open};
use std::sync::Arc;
use std::time::Instant;

impl Oracle<'_> {
    /// Has unsat confirmed, where that was asked for. A second solver that does not know confirms nothing, which the
    /// user is told; one that contradicts is an error.
    pub(super) fn cross_check(&mut self, dialogue: &mut Dialogue, script: &Script) -> Result<(), Stop> {
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
        self.account.solving += start.elapsed().as_secs_f64();
        match checked {
            Ok(Answer::Unsat) => Ok(()),
            Ok(Answer::Sat) => Err(self.disagreement(dialogue, script).into()),
            Ok(Answer::Unknown(unknown)) => {
                self.unconfirmed(spec.name(), Fallen::Undecided(unknown.into()));
                Ok(())
            }
            Err(error) if error.is_unsupported() => {
                self.unconfirmed(spec.name(), Fallen::Failed(Arc::new(error.into())));
                Ok(())
            }
            Err(error) => Err(Error::Solver(error).into()),
        }
    }

    /// Notes it, unless the same was noted before.
    fn unconfirmed(&mut self, solver: &str, why: Fallen) {
        let note = Note::Unconfirmed { solver: solver.to_owned(), why };
        if self.account.notes.iter().all(|known| known.to_string() != note.to_string()) {
            self.account.notes.push(note);
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
            _ if !known => Worth::Missing,
            (Some(_), _) => Worth::Wrong,
            (None, 0) => Worth::Right,
            (None, _) => Worth::Unknown,
        };
        let answers = format!("Answer of {}: unsat.\nAnswer of {}: sat.", full(&unsat), full(&sat));
        let evidence = Evidence::new(script, &unsat, &model, &answers);
        Error::Disagreement { unsat: unsat.name, sat: sat.name, worth, query: Box::new(evidence) }
    }
}
