//! A whole problem: systems and objectives.

use crate::ids::{ActionId, SystemId};
use crate::objective::Objective;
use crate::system::System;
use typed_index_collections::TiVec;

/// Everything that a problem file declares, resolved and typed.
#[derive(Clone, Debug, Default)]
pub struct Problem {
    /// Action names; the same name in two systems is one action.
    pub actions: TiVec<ActionId, String>,
    /// Systems.
    pub systems: TiVec<SystemId, System>,
    /// Objectives in the order of the file.
    pub objectives: Vec<Objective>,
}

impl Problem {
    /// The objective with that name.
    #[must_use]
    pub fn objective(&self, name: &str) -> Option<&Objective> {
        self.objectives.iter().find(|o| o.name == name)
    }

    /// The action with that name.
    #[must_use]
    pub fn action(&self, name: &str) -> Option<ActionId> {
        self.actions.iter_enumerated().find(|(_, n)| *n == name).map(|(id, _)| id)
    }
}
