//! What moves along paths in films and on pages.

use crate::style::{clipped, number, stroke};
use svg::node::element::{Circle, Group, Line, Text};

pub(crate) type Point = (f64, f64);

/// What moves.
#[derive(Clone, Debug)]
pub(crate) enum Mover {
    /// The robot of a path.
    Robot {
        /// The place of the path among all.
        index: usize,
        name: String,
        /// Where it is at each time.
        at: Vec<Point>,
        radius: f64,
    },
    /// The present, in a timeline.
    Cursor {
        /// Where its upper end is at each time.
        at: Vec<Point>,
        height: f64,
    },
}

impl Mover {
    /// Where it is at each time.
    pub(crate) fn at(&self) -> &[Point] {
        match self {
            Mover::Robot { at, .. } | Mover::Cursor { at, .. } => at,
        }
    }

    /// The same, elsewhere.
    pub(crate) fn moved(mut self, (x, y): Point) -> Mover {
        match &mut self {
            Mover::Robot { at, .. } | Mover::Cursor { at, .. } => {
                at.iter_mut().for_each(|at| *at = (number(at.0 + x), number(at.1 + y)));
            }
        }
        self
    }

    /// What it looks like, about the origin.
    pub(crate) fn drawn(&self) -> Group {
        match self {
            Mover::Robot { index, name: path, radius, .. } => {
                let ((color, _), name) = (stroke(*index), clipped(path, 6));
                let disc = Circle::new().set("r", number(*radius)).set("fill", color);
                let disc = disc.set("stroke", "#ffffff").set("stroke-width", 1.5);
                let size = (radius * 1.3).min(2.6 * radius / (name.chars().count() as f64).max(1.0));
                let text = Text::new(name).set("text-anchor", "middle").set("y", number(size * 0.36));
                let text = text.set("font-size", number(size)).set("style", "fill: #ffffff");
                Group::new().set("class", "robot").set("data-path", path.as_str()).add(disc).add(text)
            }
            Mover::Cursor { height, .. } => {
                let line = Line::new().set("y2", number(*height)).set("stroke", "#c00000");
                Group::new().set("class", "cursor").add(line.set("stroke-width", 2))
            }
        }
    }
}
