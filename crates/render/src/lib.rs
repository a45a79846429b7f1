//! Maps with the paths of a strategy, as terminal text and as SVG, and traces as tables.
//!
//! The same input gives the same output, byte for byte. A system can be drawn if it is a map, has integer range
//! variables `x` and `y`, or is a graph whose nodes lie somewhere; everything else gets a table. A drawing has at least
//! one system that can be drawn; the traces of others are tables in it.

mod board;
mod drawing;
mod eval;
mod roadmap;
mod table;
mod text;

pub use board::{Board, Mark};
pub use drawing::svg;
pub use table::{actions_line, steps_to_rest, table};
pub use text::{TextStyle, text_map};

use hyperplan_problem::{Objective, Problem, SystemId, Trace};
use roadmap::Roadmap;
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

/// Whether there will be something to draw, once there is a strategy for the objective or a counterexample.
///
/// # Errors
/// If no system that it has paths of can be drawn.
pub fn can_draw(problem: &Problem, objective: &Objective) -> Result<(), Error> {
    let systems = objective.leading_block().into_iter().map(|path| objective.paths[path].system);
    let boards = systems.map(|system| match &problem.systems[system].coordinates {
        Some(_) => Ok(()),
        None => Board::without_marks(&problem.systems[system]).map(|_| ()),
    });
    // One that can be drawn is enough; else the first says why it cannot.
    boards.reduce(|all, one| if all.is_ok() { all } else { one.or(all) }).unwrap_or(Err(Error::NoSystem))
}

impl<'a> Scene<'a> {
    /// The boards of the systems that can be drawn, one at least.
    fn boards(&self) -> Result<Vec<(SystemId, Board)>, Error> {
        let (mut boards, mut reason) = (Vec::new(), Error::NoSystem);
        for system in self.systems()?.into_iter().rev() {
            match Board::of(&self.problem.systems[system]) {
                Ok(board) => boards.push((system, board)),
                Err(error) => reason = error,
            }
        }
        boards.reverse();
        if boards.is_empty() { Err(reason) } else { Ok(boards) }
    }

    /// The systems that are graphs whose nodes lie somewhere.
    fn roadmaps(&self) -> Result<Vec<(SystemId, Roadmap<'a>)>, Error> {
        let systems = self.systems()?.into_iter();
        Ok(systems.filter_map(|system| Some((system, Roadmap::of(&self.problem.systems[system])?))).collect())
    }

    /// The traces of systems that are not drawn, as tables with their names.
    fn tables(&self, drawn: &[SystemId]) -> Vec<(String, String)> {
        let Some(objective) = self.objective else { return Vec::new() };
        let var = |trace: &'a Trace| objective.paths.get(trace.path).map(|var| (var, trace));
        let rest = self.traces.iter().filter_map(var);
        let rest = rest.filter(|(var, _)| !drawn.contains(&var.system));
        rest.map(|(var, trace)| (heading(&var.name, trace), table(self.problem, objective, trace))).collect()
    }

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

/// The line above a trace.
fn heading(name: &str, trace: &Trace) -> String {
    let steps = trace.actions.len();
    format!("{name} ({steps} step{}):", if steps == 1 { "" } else { "s" })
}
