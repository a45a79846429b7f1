//! Maps: reading them, and turning their rules into ordinary transition clauses.

pub(crate) mod formats;
mod moves;
mod pgm;
pub(crate) mod picture;
mod png;
mod raster;
mod rows;
mod system;

pub(crate) use moves::{MOVES, Move, Rule};
pub(crate) use raster::{Occupancy, Raster};
pub(crate) use rows::{Format, Legend, Meaning, Row, from_rows, labelled};
pub(crate) use system::{Rules, base};

use crate::place::Place;
use hyperplan_syntax::ast::Ident;

/// Most cells that a map may have in a problem.
pub(crate) const MAX_CELLS: usize = 4_000_000;

/// Most cells of a file that is read, to be cut or made coarser.
pub(crate) const MAX_READ: usize = 1 << 25;

/// A cell: column from the left, row from the bottom.
pub(crate) type Cell = (u32, u32);

/// A map as a system is made of it, in the convention of the language: the last text line is row 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct GridMap {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Sorted, without repetition.
    pub(crate) obstacles: Vec<Cell>,
    /// Labels that letters carry, in order of first mention.
    pub(crate) labels: Vec<Lettered>,
    /// Cells that nobody has seen, free or not; sorted.
    pub(crate) unknown: Vec<Cell>,
    /// Where it lies, if that was said.
    pub(crate) place: Option<Place>,
    /// What says how far obstacles are, if that was wanted.
    pub(crate) clearance: Option<Clearance>,
}

/// A label that says how far the nearest obstacle is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Clearance {
    pub(crate) name: Ident,
    /// The cells of each distance, from 0; all others are that far or farther.
    pub(crate) cells: Vec<Vec<Cell>>,
}

/// A label of some cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Lettered {
    pub(crate) name: String,
    /// The first of the letters that stand for it, where letters do.
    pub(crate) letter: Option<char>,
    /// Sorted.
    pub(crate) cells: Vec<Cell>,
}
