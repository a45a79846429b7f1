//! Maps: reading them, and turning their rules into ordinary transition clauses.

pub(crate) mod formats;
mod moves;
mod pgm;
pub(crate) mod picture;
mod png;
mod rows;
mod system;

pub(crate) use moves::{MOVES, Move, Rule};
pub(crate) use rows::{Format, Legend, Meaning, Row, from_rows};
pub(crate) use system::{Rules, base};

/// Most cells that a map may have.
pub(crate) const MAX_CELLS: usize = 4_000_000;

/// A cell: column from the left, row from the bottom.
pub(crate) type Cell = (u32, u32);

/// A map as read, in the convention of the language: the last text line is row 0.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct GridMap {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Sorted, without repetition.
    pub(crate) obstacles: Vec<Cell>,
    /// Labels that letters carry, in order of first mention.
    pub(crate) labels: Vec<Lettered>,
}

/// A label that a letter carries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Lettered {
    pub(crate) name: String,
    /// The first of its letters.
    pub(crate) letter: char,
    /// Sorted.
    pub(crate) cells: Vec<Cell>,
}
