//! What a system starts from before its items are read, and the action names that systems share.

use crate::edges::Edges;
use crate::expr::{Expr, Leaf};
use crate::ids::{ActionId, VarId};
use crate::system::{Clause, Label, Map, Var};
use rustc_hash::FxHashMap;
use std::sync::Arc;
use typed_index_collections::TiVec;

/// Action names; the same name in two systems is one action.
#[derive(Debug, Default)]
pub(crate) struct Actions {
    pub(crate) names: TiVec<ActionId, String>,
    ids: FxHashMap<String, ActionId>,
}

impl Actions {
    /// The id of a name, new or known.
    pub(crate) fn intern(&mut self, name: &str) -> ActionId {
        if let Some(id) = self.ids.get(name) {
            return *id;
        }
        let id = self.names.push_and_get_key(name.to_owned());
        self.ids.insert(name.to_owned(), id);
        id
    }

    pub(crate) fn get(&self, name: &str) -> Option<ActionId> {
        self.ids.get(name).copied()
    }
}

/// The parts of a system that come from a map or a graph, or nothing for a plain system.
#[derive(Debug)]
pub(crate) struct Base {
    pub(crate) vars: TiVec<VarId, Var>,
    pub(crate) actions: Vec<ActionId>,
    pub(crate) clauses: Vec<Clause>,
    pub(crate) edges: Option<Edges>,
    pub(crate) labels: Vec<Label>,
    pub(crate) init: Expr<Leaf>,
    pub(crate) absorb: Expr<Leaf>,
    pub(crate) map: Option<Map>,
    /// Where each node of a graph lies.
    pub(crate) coordinates: Option<Arc<[(f64, f64)]>>,
    /// Whether something is missing after an error.
    pub(crate) poisoned: bool,
}

impl Default for Base {
    fn default() -> Self {
        Base {
            vars: TiVec::new(),
            actions: Vec::new(),
            clauses: Vec::new(),
            edges: None,
            labels: Vec::new(),
            init: Expr::TRUE,
            absorb: Expr::FALSE,
            map: None,
            coordinates: None,
            poisoned: false,
        }
    }
}
