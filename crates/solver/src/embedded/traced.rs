//! `CaDiCaL` with all that it derives.

use super::trace::Trace;
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use cadical_sys::{CaDiCal, ProofTracer, Status, Terminator};
use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;

pub(super) struct Traced {
    sat: CaDiCal,
    deadline: Deadline,
    trace: Rc<RefCell<Trace>>,
}

struct Stop(Deadline, Rc<RefCell<Trace>>);

impl Terminator for Stop {
    fn terminated(&mut self) -> bool {
        self.1.borrow().is_full() || self.0.passed()
    }
}

struct Tracer(Rc<RefCell<Trace>>);

impl ProofTracer for Tracer {
    fn add_original_clause(&mut self, id: i64, _: bool, _: &[i32], restored: bool) {
        // What is restored has its old number.
        if !restored {
            self.0.borrow_mut().given(id);
        }
    }

    fn add_derived_clause(&mut self, id: i64, _: bool, witness: i32, clause: &[i32], antecedents: &[i64]) {
        self.0.borrow_mut().derived(id, clause, antecedents, witness == 0);
    }

    fn delete_clause(&mut self, _: i64, _: bool, _: &[i32]) {}
    fn weaken_minus(&mut self, _: i64, _: &[i32]) {}
    fn strengthen(&mut self, _: i64) {}
    fn finalize_clause(&mut self, _: i64, _: &[i32]) {}
    fn add_assumption(&mut self, _: i32) {}
    fn add_constraint(&mut self, _: &[i32]) {}
    fn reset_assumptions(&mut self) {}
    fn add_assumption_clause(&mut self, _: i64, _: &[i32], _: &[i64]) {}
    fn conclude_sat(&mut self, _: i32, _: &[i32]) {}
    fn conclude_unsat(&mut self, _: i32, _: &[i64]) {}
    fn conclude_unknown(&mut self, _: &[i32]) {}
}

impl Traced {
    pub(super) fn new(deadline: &Deadline) -> Result<Traced, Error> {
        let mut sat = CaDiCal::new();
        // New variables would take steps of another kind. Most variables are false: a path is in one of many states. Of other
        // options (`unsat`, `stabilizeonly`, no inprocessing) none did better on action robustness at 20 x 20 and 40 x 40.
        for (option, value) in [("factor", 0), ("phase", 0)] {
            if !sat.set(option, value) {
                return Err(Error::Unsupported { what: format!("the SAT solver has no option {option}") });
            }
        }
        let trace = Rc::new(RefCell::new(Trace::default()));
        sat.connect_proof_tracer1(Tracer(Rc::clone(&trace)), true, false);
        sat.connect_terminator(Stop(deadline.clone(), Rc::clone(&trace)));
        Ok(Traced { sat, deadline: deadline.clone(), trace })
    }

    pub(super) fn add(&mut self, clauses: &[i32]) {
        for clause in clauses.split_inclusive(|literal| *literal == 0) {
            self.sat.clause6(clause.strip_suffix(&[0]).unwrap_or(clause));
        }
    }

    pub(super) fn solve(&mut self) -> Result<Option<Vec<bool>>, Unknown> {
        match self.sat.solve() {
            Status::SATISFIABLE => Ok(Some((1..=self.sat.vars()).map(|v| self.sat.val(v) > 0).collect())),
            Status::UNSATISFIABLE => Ok(None),
            Status::UNKNOWN if self.trace.borrow().is_full() => Err(Unknown::Memory),
            Status::UNKNOWN => Err(self.deadline.reason()),
        }
    }

    pub(super) fn refutation(&self, to: &mut dyn Write) -> io::Result<()> {
        self.trace.borrow().write(to)
    }
}
