//! Atoms of an objective as terms over the paths, however these are written.

use crate::unroll::AtomTerms;
use crate::value::{Leaves, Val, translate};
use crate::writing::{Env, PathIx, Writing, at};
use hyperplan_problem::{ActionId, Expr, FormulaId, PathId, PathLeaf};
use hyperplan_relevance::{Task, only_path};
use hyperplan_smt::{Term, Terms};

/// Atoms over one choice of paths, at a time.
pub(crate) struct AtTime<'b, 'e> {
    pub(crate) task: &'b Task<'b>,
    pub(crate) env: &'b Env,
    pub(crate) writing: &'b mut (dyn Writing + 'e),
    pub(crate) time: u32,
    /// The atom, as long as nothing of it was read.
    pub(crate) atom: Option<FormulaId>,
}

impl AtomTerms for AtTime<'_, '_> {
    fn atom(&mut self, terms: &mut Terms, (id, expr): (FormulaId, &Expr<PathLeaf>), time: u32) -> Term {
        (self.time, self.atom) = (time, Some(id));
        translate(terms, expr, self).truth()
    }
}

impl<'b, 'e> AtTime<'b, 'e> {
    /// Atoms at any time.
    pub(crate) fn new(task: &'b Task<'b>, env: &'b Env, writing: &'b mut (dyn Writing + 'e)) -> Self {
        AtTime { task, env, writing, time: 0, atom: None }
    }

    fn same_action(&self, terms: &mut Terms, p: PathIx, q: PathIx, actions: &[ActionId]) -> Term {
        let Some(step) = (self.time as usize).checked_sub(1) else { return Term::TRUE };
        let both = |&action: &ActionId| {
            let (a, b) = (self.writing.took(p, step, action), self.writing.took(q, step, action));
            terms.implies(a, b)
        };
        let parts: Vec<Term> = actions.iter().map(both).collect();
        terms.and(&parts)
    }
}

impl Leaves<PathLeaf> for AtTime<'_, '_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &PathLeaf) -> Val {
        let time = self.time;
        let env = self.env;
        let of = |path: PathId| at(env, path);
        match *leaf {
            PathLeaf::State(p, leaf) => self.writing.leaf(terms, of(p), time, leaf),
            PathLeaf::Enabled(p, action) => Val::Bool(self.writing.enabled(terms, of(p), time, action)),
            PathLeaf::Halted(p) => Val::Bool(self.writing.halted(terms, of(p), time)),
            // The action just taken; at time 0 none was.
            PathLeaf::Took(p, action) => Val::Bool(match time.checked_sub(1) {
                Some(step) => self.writing.took(of(p), step as usize, action),
                None => Term::FALSE,
            }),
            PathLeaf::SameAction(p, q) if p == q => Val::Bool(Term::TRUE),
            PathLeaf::SameAction(p, q) => {
                let actions = &self.task.system(p).actions;
                Val::Bool(self.same_action(terms, of(p), of(q), actions))
            }
            PathLeaf::SameState(p, q) => Val::Bool(self.writing.same_state(terms, of(p), of(q), time)),
        }
    }

    fn whole(&mut self, terms: &mut Terms, expr: &Expr<PathLeaf>) -> Option<Val> {
        let atom = self.atom.take();
        let path = only_path(expr)?;
        self.writing.whole(terms, at(self.env, path), self.time, expr, atom)
    }
}
