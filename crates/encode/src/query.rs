//! One script under construction, and the way back from its values to paths.

use crate::atom::Atoms;
use crate::names::Copies;
use crate::unroll::Unroller;
use crate::writing::{Bound, Env, Writing, Written};
use crate::{Encoder, Error};
use hyperplan_problem::PathId;
use hyperplan_relevance::{Goal, Instance, Known, Move, Relevant, Start};
use hyperplan_smt::{Model, Script, Term};
use std::sync::Arc;

/// One script under construction.
pub struct Query<'e, 'a> {
    encoder: &'e Encoder<'a>,
    /// What has been asserted so far, and the terms.
    pub script: Script,
    writing: Box<dyn Writing + 'e>,
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
        let mut writing = encoder.writer.begin(known, found, copies, &mut script.terms);
        let mut env = vec![None; encoder.objective.paths.len()];
        for (path, known) in encoder.objective.paths.keys().zip(known) {
            let known = known.as_ref();
            env[usize::from(path)] = known.and_then(|known| writing.fix(&mut script.terms, path, known));
        }
        Query { encoder, script, writing, known: env }
    }

    /// An environment with the known paths only, as constants.
    #[must_use]
    pub fn known(&self) -> Env {
        self.known.clone()
    }

    /// A path that the solver chooses to reach a goal.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn declare(&mut self, path: PathId, goal: &Goal) -> Result<Written, Error> {
        self.writing.declare(&mut self.script, path, goal)
    }

    /// A path under a quantifier.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn bind(&mut self, path: PathId, goal: &Goal) -> Result<Bound, Error> {
        self.writing.bind(&mut self.script.terms, path, goal)
    }

    /// An instance of a path whose player has the goal: the path, and the condition that it is one.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn instantiate(
        &mut self,
        path: PathId,
        instance: &Instance,
        env: &Env,
        goal: &Goal,
    ) -> Result<(Written, Term), Error> {
        self.writing.instantiate(&mut self.script, path, instance, env, goal)
    }

    /// Demands of a declared path what the goal asks of it next to known ones: states from which it cannot be met
    /// are excluded at once. The solver would find out, but by search.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn restrict(
        &mut self,
        written: Written,
        goal: &Goal,
        beside: &[(PathId, Known)],
    ) -> Result<(), Error> {
        self.writing.restrict(&mut self.script, written, goal, beside)
    }

    /// Whether a declared path is like a counterexample: starts like it and takes the actions that the instance
    /// made of it gives outright. Used to ask for a different one.
    pub fn resembles(&mut self, written: Written, instance: &Instance) -> Term {
        let mut parts = match &instance.start {
            Start::State(state) => self.writing.starts(&mut self.script.terms, written, state),
            Start::Same(_) => Vec::new(),
        };
        for (step, movement) in instance.moves.iter().enumerate() {
            if let Move::Act(action, _) = *movement {
                parts.push(self.writing.took(written, step, action));
            }
        }
        self.script.terms.and(&parts)
    }

    /// Demands that no choice of a path, the last of all, reaches its player's goal, whatever it is; `env` has the
    /// paths before it. False, with nothing of use demanded, where that takes too much or states are not enumerated.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn sweep(&mut self, path: PathId, env: &Env, goal: &Goal) -> Result<bool, Error> {
        self.writing.sweep(&mut self.script, path, env, goal)
    }

    /// Asserts a goal over these paths, which must be all that it reads: of a conjunction each part in a section of
    /// its own.
    pub fn demand(&mut self, env: &Env, goal: &Goal) {
        let encoder = self.encoder;
        let objective = encoder.objective;
        let atoms = Atoms { task: &encoder.task, env, writing: &mut *self.writing };
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
        let atoms = Atoms { task: &encoder.task, env, writing: &mut *self.writing };
        Unroller::new(&objective.formula, objective.mode, atoms).goal(&mut self.script.terms, goal)
    }

    /// The symbols whose values describe a path.
    #[must_use]
    pub fn symbols(&self, written: Written) -> Vec<Term> {
        self.writing.symbols(written)
    }

    /// The path that a model describes; `None` if it is none, which a right model cannot cause.
    #[must_use]
    pub fn decode(&self, written: Written, model: &Model) -> Option<Known> {
        self.writing.decode(written, model)
    }
}
