//! What a benchmark looks like for one solver, or for all.

use crate::config::Quantifiers;
use crate::fact::{Error, Note};
use hyperplan_smt::{Features, logic};
use hyperplan_solver::{Profile, Spec};
use std::sync::Arc;

/// What the solver takes that the benchmark is for.
pub(super) struct Dialect(Option<Arc<Profile>>);

impl Dialect {
    pub(super) fn new(solver: Option<&Spec>) -> Self {
        Dialect(solver.and_then(Spec::profile))
    }

    /// Quantifiers are kept where the solver takes them.
    pub(super) fn quantifiers(&self, blocks: usize, notes: &mut Vec<Note>) -> Quantifiers {
        let Err(error) = self.demand_quantifiers(blocks) else { return Quantifiers::Keep };
        notes.push(Note::Expanded(Arc::new(error)));
        Quantifiers::Expand
    }

    /// Refuses quantifiers that the solver does not take.
    pub(super) fn demand_quantifiers(&self, blocks: usize) -> Result<(), Error> {
        match &self.0 {
            Some(profile) if blocks > 1 => Ok(profile.demand_quantifiers(blocks > 2)?),
            _ => Ok(()),
        }
    }

    /// The logic: the one that the terms need and no more, unless another serves the solver better.
    pub(super) fn logic(&self, features: &Features, notes: &mut Vec<Note>) -> Result<String, Error> {
        let smallest = logic(features);
        let Some(profile) = &self.0 else { return Ok(smallest.to_owned()) };
        let logic = profile.logic(features)?;
        if logic != smallest {
            notes.push(Note::Logic { logic: logic.clone(), smallest, solver: profile.name().to_owned() });
        }
        Ok(logic)
    }
}
