//! Why there is no strategy, or no counterexample, as something that others can check.
//!
//! Instances of the other player's paths are collected until the plain clauses of `hyperplan-certify` have no model any more. What a
//! model says of the leading block is given to the independent checker, whose counterexample is the next instance. Nothing
//! here is trusted: a wrong instance makes no certificate, and a claim that is wrong ends with a strategy that the checker
//! accepts.

use crate::fact::{Error, Reason};
use hyperplan_certify::{self as certify, Branch, Encoder, Place};
use hyperplan_problem::{Objective, Problem, Strategy, Trace};
use hyperplan_solver::{Deadline, Refuter, Unknown};
use hyperplan_verify::{Budget, Check, Defeat, check};
use std::io::{self, Write};

/// Instances that refute a claim, and why.
pub struct Proved {
    /// The instances, in the order in which they were found.
    pub branches: Vec<Branch>,
    refuter: Refuter,
}

impl Proved {
    /// Writes the refutation of the clauses, in LRAT form, as text.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn refutation(&self, to: &mut dyn Write) -> io::Result<()> {
        self.refuter.refutation(to)
    }
}

/// Why there is no certificate.
#[derive(Debug, thiserror::Error)]
pub enum Unproved {
    /// It could not be decided.
    #[error(transparent)]
    Undecided(Reason),
    /// It takes something that is not there.
    #[error(transparent)]
    Certify(#[from] certify::Error),
    /// The claim is wrong, or something here is.
    #[error(transparent)]
    Failed(#[from] Error),
}

impl From<Unknown> for Unproved {
    fn from(unknown: Unknown) -> Self {
        Unproved::Undecided(unknown.into())
    }
}

/// Proves that the leading block of an objective has no strategy (or, for `forall`, no counterexample).
///
/// # Errors
/// Where the claim is wrong, the deadline came first, or it would be too large.
pub fn prove(problem: &Problem, objective: &Objective, deadline: &Deadline) -> Result<Proved, Unproved> {
    let mut encoder = Encoder::new(problem, objective, &|| deadline.passed())?;
    let mut refuter = Refuter::new(deadline).map_err(Error::from)?;
    let mut branches: Vec<Branch> = Vec::new();
    loop {
        refuter.add(&encoder.take());
        let Some(model) = refuter.solve()? else { return Ok(Proved { branches, refuter }) };
        let branch = answer(problem, objective, &encoder, &branches, &model)?;
        encoder.branch(Place(branch.after), &branch.instances)?;
        branches.push(branch);
    }
}

/// Instances that defeat what a model says.
fn answer(
    problem: &Problem,
    objective: &Objective,
    encoder: &Encoder<'_>,
    branches: &[Branch],
    model: &[bool],
) -> Result<Branch, Unproved> {
    let holds = |literal: i32| {
        let value = model.get(literal.unsigned_abs() as usize - 1).copied().unwrap_or(false);
        value == (literal > 0)
    };
    let (mut after, mut known): (usize, Vec<Trace>) = (0, Vec::new());
    loop {
        known.extend(encoder.traces(Place(after), &holds)?);
        let defeat = defeat(problem, objective, &known)?;
        let is_it =
            |(_, own): &(usize, &Branch)| own.after == after && encoder.are(&own.instances, &known, &defeat);
        match (1..).zip(branches).find(is_it) {
            // It is there already: so something is wrong with what the player answers to it.
            Some((place, _)) => after = place,
            None => return Ok(Branch { after, instances: encoder.instances(&known, &defeat)? }),
        }
        known.extend(defeat);
    }
}

/// What defeats the paths chosen so far: paths of the next block.
fn defeat(problem: &Problem, objective: &Objective, known: &[Trace]) -> Result<Vec<Trace>, Unproved> {
    // The paths that are known are one block.
    let mut rest = objective.clone();
    let quantifier = objective.paths.first().map(|path| path.quantifier);
    for trace in known {
        if let (Some(path), Some(quantifier)) = (rest.paths.get_mut(trace.path), quantifier) {
            path.quantifier = quantifier;
        }
    }
    let strategy = Strategy { traces: known.to_vec() };
    let bug = |what: &str| Err(Error::Bug(what.to_owned()).into());
    match check(problem, &rest, &strategy, &Budget::default()) {
        Ok(Check::Fails(Defeat::Paths(traces))) => Ok(traces),
        Ok(Check::Holds) if known.len() == objective.leading_block().len() => {
            bug("the answer is wrong: there is what it says that there is not")
        }
        Ok(Check::Holds) => bug("the checker accepts what it said is defeated"),
        Ok(Check::Fails(defeat)) => {
            bug(&format!("the clauses allow what the checker refutes: {}", defeat.describe(&rest)))
        }
        Ok(Check::TooLarge { .. }) => {
            Err(certify::Error::TooLarge { what: "a strategy cannot be checked".to_owned() }.into())
        }
        Err(error) => bug(&error.to_string()),
    }
}
