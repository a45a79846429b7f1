//! Occupancy grids, handed on as maps of ROS.

use std::fmt::Write as _;

/// What is in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cell {
    /// Nothing.
    #[default]
    Free,
    /// An obstacle.
    Obstacle,
    /// Nobody knows: an obstacle, unless the system has the item `unknown free;`.
    Unknown,
}

impl Cell {
    /// Its shade, as map savers have it.
    fn shade(self) -> u8 {
        match self {
            Cell::Free => 254,
            Cell::Obstacle => 0,
            Cell::Unknown => 205,
        }
    }
}

/// A grid of cells: `x` counts from the left, `y` from the bottom.
#[derive(Clone, Debug)]
pub struct Grid {
    width: usize,
    height: usize,
    /// Shades, the top row first.
    shades: Vec<u8>,
    place: Option<(f64, [f64; 3])>,
    labels: Vec<(String, Vec<(u32, u32)>)>,
}

impl Grid {
    /// A grid whose cells are what `cell(x, y)` says.
    #[must_use]
    pub fn new(width: usize, height: usize, mut cell: impl FnMut(usize, usize) -> Cell) -> Grid {
        let mut shades = Vec::with_capacity(width.saturating_mul(height));
        for y in (0..height).rev() {
            shades.extend((0..width).map(|x| cell(x, y).shade()));
        }
        Grid { width, height, shades, place: None, labels: Vec::new() }
    }

    /// How large cells are, in metres, and where the lower left corner lies: `[x, y, angle]` in metres and radians.
    #[must_use]
    pub fn place(self, resolution: f64, origin: [f64; 3]) -> Grid {
        Grid { place: Some((resolution, origin)), ..self }
    }

    /// A label that holds in these cells, `(x, y)` each.
    #[must_use]
    pub fn label(mut self, name: &str, cells: impl IntoIterator<Item = (u32, u32)>) -> Grid {
        self.labels.push((name.to_owned(), cells.into_iter().collect()));
        self
    }

    /// What a map of ROS says besides its picture.
    pub(super) fn yaml(&self, picture: &str) -> Vec<u8> {
        let mut yaml = format!("image: {picture}\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
        if let Some((resolution, [x, y, angle])) = self.place {
            yaml += &format!("resolution: {resolution:?}\norigin: [{x:?}, {y:?}, {angle:?}]\n");
        }
        yaml.into_bytes()
    }

    pub(super) fn pgm(&self) -> Vec<u8> {
        let mut picture = format!("P5\n{} {}\n255\n", self.width, self.height).into_bytes();
        picture.extend(&self.shades);
        picture
    }

    /// The items that give cells their labels.
    pub(super) fn labels(&self) -> impl Iterator<Item = String> {
        self.labels.iter().map(|(name, cells)| {
            if cells.is_empty() {
                return format!("label {name} = false;");
            }
            let mut text = format!("label {name} = (x, y) in {{");
            for (at, (x, y)) in cells.iter().enumerate() {
                let comma = if at == 0 { "" } else { ", " };
                // Writing into a string cannot fail.
                let _ = write!(text, "{comma}({x}, {y})");
            }
            text + "};"
        })
    }
}
