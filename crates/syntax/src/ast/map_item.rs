//! What only maps say of the picture or text that they are read from.

use super::{Expr, Ident, Text};
use crate::span::Span;

/// An item that says how the cells of a map come about; the map's moves and rules are items of their own.
#[derive(Clone, Debug, PartialEq)]
pub enum MapItem {
    /// `scenario "FILE.scen" N;`
    Scenario {
        /// The file with scenarios of the Moving AI Lab.
        file: Text,
        /// Which of its lines, from 1.
        row: Expr,
    },
    /// `unknown obstacle|free;`
    Unknown(Ident),
    /// `inflate N;` or `inflate D m;`
    Inflate {
        /// How far obstacles grow.
        by: Expr,
        /// The place of the `m`, where metres are meant and not cells.
        metres: Option<Span>,
    },
    /// `scale N;`
    Scale(Expr),
    /// `crop X0..X1, Y0..Y1;`, both ends included
    Crop(Box<Area>),
    /// `clearance NAME N;`
    Clearance {
        /// The label that it declares.
        name: Ident,
        /// The greatest value that it has.
        most: Expr,
    },
}

/// A part of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// The first and the last column.
    pub x: (Expr, Expr),
    /// The first and the last row.
    pub y: (Expr, Expr),
}

impl MapItem {
    /// The expressions in it.
    #[must_use]
    pub fn exprs(&self) -> Vec<&Expr> {
        match self {
            MapItem::Scenario { row: e, .. } | MapItem::Inflate { by: e, .. } | MapItem::Scale(e) => vec![e],
            MapItem::Clearance { most, .. } => vec![most],
            MapItem::Unknown(_) => Vec::new(),
            MapItem::Crop(part) => vec![&part.x.0, &part.x.1, &part.y.0, &part.y.1],
        }
    }

    /// The word that it begins with.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            MapItem::Scenario { .. } => "scenario",
            MapItem::Unknown(_) => "unknown",
            MapItem::Inflate { .. } => "inflate",
            MapItem::Scale(_) => "scale",
            MapItem::Crop(_) => "crop",
            MapItem::Clearance { .. } => "clearance",
        }
    }
}
