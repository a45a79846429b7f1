//! What a map is made from, and its cells.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// Where the walls of a map are, before obstacles are strewn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// There are none.
    #[default]
    Random,
    /// Rooms with a door to each neighbor.
    Rooms,
    /// A maze of corridors.
    Maze,
    /// The aisles of a warehouse between racks.
    Aisles,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 4] = [Kind::Random, Kind::Rooms, Kind::Maze, Kind::Aisles];

    fn is_random(&self) -> bool {
        *self == Kind::Random
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

impl FromStr for Kind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Kind::ALL.into_iter().find(|kind| kind.to_string() == text);
        found.ok_or_else(|| format!("`{text}` is no kind of map; expected random, rooms, maze or aisles"))
    }
}

/// What a map is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Parameters {
    /// Where its walls are.
    #[serde(rename = "map", default, skip_serializing_if = "Kind::is_random")]
    pub kind: Kind,
    /// The length of a side, in cells.
    pub size: u32,
    /// The share of obstacles, in percent.
    pub density: u32,
    /// The seed.
    pub seed: u64,
}

/// A cell: column and row, both from 0, the row from the bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// The column.
    pub x: u32,
    /// The row.
    pub y: u32,
}

/// The number of a cell, row by row from the bottom.
pub(crate) fn index(size: u32, cell: Cell) -> usize {
    (cell.y * size + cell.x) as usize
}
