//! One script under construction, and the way back from its values to paths.

use crate::Encoder;
use crate::atom::AtTime;
use crate::names::Copies;
use crate::unroll::Unroller;
use crate::writing::{Env, PathIx, Writing};
use hyperplan_relevance::{Goal, Instance, Known, Move, Relevant, Start};
use hyperplan_smt::{Script, Term};
use std::sync::Arc;

/// One script under construction.
pub struct Query<'e, 'a> {
    /// What it is about.
    pub encoder: &'e Encoder<'a>,
    /// What has been asserted so far, and the terms.
    pub script: Script,
    /// The paths in it.
    pub paths: Box<dyn Writing + 'e>,
    known: Env,
}

impl<'e, 'a> Query<'e, 'a> {
    /// An empty script for a question in which some paths are known, given what was found out about those of the
    /// leading block.
    #[must_use]
    pub fn new(encoder: &'e Encoder<'a>, known: &[Option<Known>], found: Relevant) -> Self {
        Query::beside(encoder, known, found, &Arc::default())
    }

    /// As [`Query::new`], with paths named beside those of other queries, so that these can be parts of one text.
    #[must_use]
    pub fn beside(
        encoder: &'e Encoder<'a>,
        known: &[Option<Known>],
        found: Relevant,
        copies: &Arc<Copies>,
    ) -> Self {
        let mut script = Script::new();
        let mut paths = encoder.writer.begin(known, found, copies, &mut script.terms);
        let mut env = vec![None; encoder.objective.paths.len()];
        for (path, known) in encoder.objective.paths.keys().zip(known) {
            let known = known.as_ref();
            env[usize::from(path)] = known.and_then(|known| paths.fix(&mut script.terms, path, known));
        }
        Query { encoder, script, paths, known: env }
    }

    /// An environment with the known paths only, as constants.
    #[must_use]
    pub fn known(&self) -> Env {
        self.known.clone()
    }

    /// Whether a declared path is like a counterexample: starts like it and takes the actions that the instance
    /// made of it gives outright. Used to ask for a different one.
    pub fn resembles(&mut self, path: PathIx, instance: &Instance) -> Term {
        let mut parts = match &instance.start {
            Start::State(state) => self.paths.starts(&mut self.script.terms, path, state),
            Start::Same(_) => Vec::new(),
        };
        for (step, movement) in instance.moves.iter().enumerate() {
            if let Move::Act(action, _) = *movement {
                parts.push(self.paths.took(path, step, action));
            }
        }
        self.script.terms.and(&parts)
    }

    /// Asserts a goal over these paths, which must be all that it reads: of a conjunction each part in a section of
    /// its own.
    pub fn demand(&mut self, env: &Env, goal: &Goal) {
        let encoder = self.encoder;
        let objective = encoder.objective;
        let atoms = AtTime::new(&encoder.task, env, &mut *self.paths);
        let mut unroller = Unroller::new(&objective.formula, objective.mode, atoms);
        for part in goal.conjuncts() {
            let (number, text) = part.described(encoder.problem, objective);
            self.script.section(format!("formula.{number}"), text);
            let demanded = unroller.goal(&mut self.script.terms, &part);
            self.script.assert(demanded);
        }
    }

    /// A goal over these paths, which must be all that it reads.
    pub fn goal(&mut self, env: &Env, goal: &Goal) -> Term {
        let encoder = self.encoder;
        let objective = encoder.objective;
        let atoms = AtTime::new(&encoder.task, env, &mut *self.paths);
        Unroller::new(&objective.formula, objective.mode, atoms).goal(&mut self.script.terms, goal)
    }
}
