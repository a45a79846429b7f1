//! The leaves of atoms where one path is on a run, and the others are terms.

use super::EnumeratedQuery;
use crate::atom::AtTime;
use crate::value::{Leaves, Val, constant};
use crate::writing::{Env, at};
use hyperplan_problem::{ActionId, Expr, Leaf, PathId, PathLeaf, System, Type};
use hyperplan_relevance::{Task, only_path};
use hyperplan_smt::{Term, Terms};
use hyperplan_space::{Graph, StateIx};

/// The leaves of atoms where one path is on a given step of a run, the others as terms.
pub(super) struct OnRun<'b, 'e, 'a> {
    pub(super) query: &'b mut EnumeratedQuery<'e, 'a>,
    pub(super) task: &'b Task<'b>,
    /// The paths before it.
    pub(super) env: &'b Env,
    /// The path on the run.
    pub(super) path: PathId,
    pub(super) graph: &'b Graph,
    pub(super) state: StateIx,
    /// The action just taken; none at time 0.
    pub(super) action: Option<ActionId>,
    pub(super) time: u32,
}

impl OnRun<'_, '_, '_> {
    /// The other of two paths, where one is on the run.
    fn other(&self, p: PathId, q: PathId) -> Option<PathId> {
        match (p == self.path, q == self.path) {
            (true, _) => Some(q),
            (_, true) => Some(p),
            _ => None,
        }
    }

    /// Whether a path is read at this time at all; beyond its horizon no value matters.
    fn is_read(&self, path: PathId) -> bool {
        path == self.path || self.time <= self.task.horizon(path)
    }

    /// The other paths' leaves at the time.
    fn others(&mut self) -> AtTime<'_, '_> {
        AtTime { task: self.task, env: self.env, writing: &mut *self.query, time: self.time, atom: None }
    }
}

impl Leaves<PathLeaf> for OnRun<'_, '_, '_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &PathLeaf) -> Val {
        let truth = |holds: bool| Val::Bool(Term::from(holds));
        let unread = leaf.paths().into_iter().flatten().any(|p| !self.is_read(p));
        match *leaf {
            PathLeaf::State(p, state_leaf) if p == self.path || unread => {
                let system = self.task.system(p);
                let value = if unread { 0 } else { self.graph.leaf(system, self.state, state_leaf) };
                if is_truth(system, state_leaf) { truth(value != 0) } else { constant(value) }
            }
            _ if unread => truth(false),
            PathLeaf::Took(p, action) if p == self.path => truth(self.action == Some(action)),
            PathLeaf::Enabled(p, action) if p == self.path => truth(self.graph.enables(self.state, action)),
            PathLeaf::Halted(p) if p == self.path => truth(self.graph.halts(self.state)),
            PathLeaf::SameAction(p, q) if self.other(p, q).is_some() => match (self.other(p, q), self.action)
            {
                (Some(other), Some(action)) if other != self.path => {
                    self.others().leaf(terms, &PathLeaf::Took(other, action))
                }
                _ => truth(true),
            },
            PathLeaf::SameState(p, q) if self.other(p, q).is_some() => match self.other(p, q) {
                Some(other) if other != self.path => {
                    let layers = &self.query.paths[at(self.env, other)].layers;
                    Val::Bool(layers[self.time as usize].is(self.state))
                }
                _ => truth(true),
            },
            _ => self.others().leaf(terms, leaf),
        }
    }

    fn whole(&mut self, terms: &mut Terms, expr: &Expr<PathLeaf>) -> Option<Val> {
        only_path(expr).filter(|&p| p != self.path && self.is_read(p))?;
        self.others().whole(terms, expr)
    }
}

/// Whether a variable or label is a truth value rather than a number.
pub(super) fn is_truth(system: &System, leaf: Leaf) -> bool {
    *system.leaf_type(leaf) == Type::Bool
}
