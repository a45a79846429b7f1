//! Maps with the paths of a strategy, as terminal text, SVG, PNG and PDF, and traces as tables.
//!
//! The same input gives the same output, byte for byte. A system is drawn as a map if it is one or has integer range
//! variables `x` and `y`, as a graph if it is one; paths of everything else are timelines, and tables in text.

mod bitmap;
mod board;
mod drawing;
mod eval;
mod film;
mod mover;
mod page;
mod panel;
mod paper;
mod roadmap;
mod sheet;
mod style;
mod table;
mod text;
mod timeline;
mod track;

pub use board::{Board, Mark};
pub use drawing::svg;
pub use film::Film;
pub use page::{Page, Part, Variant, page};
pub use paper::{pdf, png};
pub use table::{actions_line, steps_to_rest, table};
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
    /// The paths have more steps than are drawn.
    #[error("path {path} cannot be drawn: {steps} steps are more than {limit}")]
    TooLong {
        /// The path variable.
        path: String,
        /// Its steps.
        steps: usize,
        /// The most steps that are drawn.
        limit: usize,
    },
    /// There are too many pictures of a film.
    #[error("{pictures} pictures, one for each time, are more than {limit}")]
    TooManyPictures {
        /// How many.
        pictures: usize,
        /// The most that are drawn.
        limit: usize,
    },
    /// A film without a path.
    #[error("there is no path, so nothing moves")]
    NothingMoves,
    /// The picture was made, but could not be written in that format.
    #[error("the picture cannot be written as {format}: {reason}")]
    Format {
        /// The format.
        format: &'static str,
        /// What the library says.
        reason: String,
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
    /// What legends say of paths that are not the strategy's: why these of all.
    pub note: &'a str,
}

/// The most steps of all paths that are drawn.
const MOST_STEPS: usize = 200_000;

/// Whether there will be something to draw, once there is a strategy for the objective or a counterexample.
///
/// # Errors
/// If a map that it has paths on is too large.
pub fn can_draw(problem: &Problem, objective: &Objective) -> Result<(), Error> {
    for path in objective.leading_block() {
        match Board::without_marks(&problem.systems[objective.paths[path].system]) {
            // Paths without a map have a graph, or a timeline.
            Ok(_) | Err(Error::Unsupported { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

impl<'a> Scene<'a> {
    /// Refuses what is too long.
    fn bounded(&self) -> Result<(), Error> {
        let steps = self.traces.iter().map(|trace| trace.states.len()).sum::<usize>();
        match self.traces.iter().max_by_key(|trace| trace.states.len()) {
            Some(longest) if steps > MOST_STEPS => {
                let path = self.objective.and_then(|objective| objective.paths.get(longest.path));
                let path = path.map(|path| path.name.clone()).unwrap_or_default();
                Err(Error::TooLong { path, steps: longest.actions.len(), limit: MOST_STEPS })
            }
            _ => Ok(()),
        }
    }

    /// What is said of a path that is not the strategy's.
    fn note(&self, trace: &Trace) -> Option<&'a str> {
        let leading = self.objective?.leading_block();
        (!leading.contains(&trace.path) && !self.note.is_empty()).then_some(self.note)
    }

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

    /// The traces of systems that are not drawn, as tables with their names.
    fn tables(&self, drawn: &[SystemId]) -> Vec<(String, String)> {
        let Some(objective) = self.objective else { return Vec::new() };
        let var = |trace: &'a Trace| objective.paths.get(trace.path).map(|var| (var, trace));
        let rest = self.traces.iter().filter_map(var);
        let rest = rest.filter(|(var, _)| !drawn.contains(&var.system));
        rest.map(|(var, trace)| (self.heading(&var.name, trace), table(self.problem, objective, trace)))
            .collect()
    }

    /// The line above a trace: its name, until when something changes, and why it is there.
    fn heading(&self, name: &str, trace: &Trace) -> String {
        let steps = self.objective.map_or(trace.actions.len(), |o| steps_to_rest(self.problem, o, trace));
        let note = self.note(trace).map(|note| format!(", {note}")).unwrap_or_default();
        format!("{name} ({steps} step{}{note}):", if steps == 1 { "" } else { "s" })
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
