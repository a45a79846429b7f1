//! The moves of a map, and what happens where one is not possible.

use crate::names::names;

/// A move: its action name and where it leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Move {
    pub(crate) name: &'static str,
    /// Change of column.
    pub(crate) dx: i64,
    /// Change of row; up is positive.
    pub(crate) dy: i64,
}

const fn to(name: &'static str, dx: i64, dy: i64) -> Move {
    Move { name, dx, dy }
}

/// All moves there are; the first four are the default. A diagonal move looks only at the cell that it leads to, unless
/// `corner` has a rule for the two that it passes between.
pub(crate) const MOVES: [Move; 9] = [
    to("up", 0, 1),
    to("down", 0, -1),
    to("left", -1, 0),
    to("right", 1, 0),
    to("stay", 0, 0),
    to("up_left", -1, 1),
    to("up_right", 1, 1),
    to("down_left", -1, -1),
    to("down_right", 1, -1),
];

/// What becomes of a move onto an obstacle or over the edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Rule {
    /// There is no such transition.
    #[default]
    Undefined,
    /// The robot stays where it is.
    Stay,
    /// The robot stays where it is and has crashed.
    Crash,
}

names!(pub(crate) Rule: Undefined "undefined", Stay "stay", Crash "crash");
