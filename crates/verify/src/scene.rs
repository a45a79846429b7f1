//! What the atoms say at one position of all paths.

use crate::atoms::Atom;
use crate::eval::truth;
use crate::graph::{Graph, StateId};
use crate::residual::AtomId;
use hyperplan_problem::{ActionId, Expr, PathId, PathLeaf, SystemId, Value};
use typed_index_collections::TiSlice;

/// Where all paths are at one position.
#[derive(Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub(crate) atoms: &'a TiSlice<AtomId, Atom>,
    pub(crate) graphs: &'a TiSlice<SystemId, Graph<'a>>,
    pub(crate) systems: &'a TiSlice<PathId, SystemId>,
    pub(crate) states: &'a TiSlice<PathId, Option<StateId>>,
    pub(crate) took: &'a TiSlice<PathId, Option<ActionId>>,
}

impl<'a> Scene<'a> {
    /// The values of these atoms.
    pub(crate) fn values(self, atoms: &'a [AtomId]) -> impl Iterator<Item = (AtomId, Option<bool>)> + 'a {
        atoms.iter().map(move |&id| (id, self.truth(&self.atoms[id].expr)))
    }

    fn truth(&self, expr: &Expr<PathLeaf>) -> Option<bool> {
        truth(expr, &|leaf| self.leaf(leaf))
    }

    /// `None` where it reads a trace beyond its end.
    fn leaf(&self, leaf: &PathLeaf) -> Option<Value> {
        match *leaf {
            PathLeaf::State(p, leaf) => self.graphs[self.systems[p]].leaf(self.states[p]?, leaf),
            PathLeaf::Took(p, action) => {
                self.states[p]?;
                Some(Value::Bool(self.took[p] == Some(action)))
            }
            PathLeaf::SameAction(p, q) => {
                self.states[p].and(self.states[q])?;
                Some(Value::Bool(self.took[p] == self.took[q]))
            }
            PathLeaf::SameState(p, q) => Some(Value::Bool(self.states[p]? == self.states[q]?)),
            PathLeaf::Enabled(p, action) => {
                self.graphs[self.systems[p]].enabled(self.states[p]?, action).map(Value::Bool)
            }
            PathLeaf::Halted(p) => self.graphs[self.systems[p]].halted(self.states[p]?).map(Value::Bool),
        }
    }
}
