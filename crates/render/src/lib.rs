//! Maps with the paths of a strategy, as terminal text and as SVG, and traces as tables.
//!
//! The same input gives the same output, byte for byte. A system can be drawn if it is a map or has integer range
//! variables `x` and `y`; everything else gets a table.

mod board;
mod drawing;
mod eval;
mod table;
mod text;

pub use board::{Board, Mark};
pub use drawing::svg;
pub use table::{actions_line, table};
pub use text::{TextStyle, text_map};

use hyperplan_problem::{Objective, Problem, SystemId, Trace};
use thiserror::Error;

/// Why something cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Error {
    /// The system has no place in the plane.
    #[error("system {system} cannot be drawn: it is no grid and has no integer variables x and y")]
    Unsupported {
        /// The system.
        system: String,
    },
    /// The map has more cells than are drawn.
    #[error("system {system} cannot be drawn: {width} x {height} cells are more than {limit}")]
    TooLarge {
        /// The system.
        system: String,
        /// Number of columns.
        width: u64,
        /// Number of rows.
        height: u64,
        /// The most cells that are drawn.
        limit: u64,
    },
    /// The problem has no system.
    #[error("there is no system to draw")]
    NoSystem,
}

/// What to draw: a problem, and where there is one an objective with some traces of its paths.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective whose paths the traces are; without one, the problem's first system is drawn alone.
    pub objective: Option<&'a Objective>,
    /// The traces; each names a path variable of the objective.
    pub traces: &'a [Trace],
}

impl<'a> Scene<'a> {
    /// The systems to draw, each once, in the order of the objective's paths.
    fn systems(&self) -> Result<Vec<SystemId>, Error> {
        let mut systems = Vec::new();
        let paths = self.objective.iter().flat_map(|o| o.paths.iter_enumerated());
        for (_, path) in
            paths.filter(|(id, _)| self.traces.is_empty() || self.traces.iter().any(|t| t.path == *id))
        {
            if !systems.contains(&path.system) {
                systems.push(path.system);
            }
        }
        if systems.is_empty() {
            systems.push(self.problem.systems.first_key().ok_or(Error::NoSystem)?);
        }
        Ok(systems)
    }

    /// The traces of paths of that system, each with its name and its place among all traces.
    fn traces_of(&self, system: SystemId) -> Vec<(usize, &'a str, &'a Trace)> {
        let Some(objective) = self.objective else { return Vec::new() };
        let named = self.traces.iter().enumerate();
        named
            .filter_map(|(i, trace)| objective.paths.get(trace.path).map(|var| (i, var, trace)))
            .filter(|(_, var, _)| var.system == system)
            .map(|(i, var, trace)| (i, var.name.as_str(), trace))
            .collect()
    }
}
