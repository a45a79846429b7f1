//! Where maps lie.

use crate::expr::Rational;

/// Where a map lies in the plane, in metres: what the YAML files of ROS say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The side of a cell; positive.
    pub resolution: Rational,
    /// The lower left corner of the lower left cell.
    pub origin: (f64, f64),
    /// How far the map is turned about that corner, counterclockwise, in radians.
    pub yaw: f64,
}

impl Place {
    /// The side of a cell in metres.
    #[must_use]
    pub fn cell(&self) -> f64 {
        *self.resolution.numer() as f64 / *self.resolution.denom() as f64
    }

    /// The centre of a cell, by column and row. Rounded to a tenth of a micrometre, as no map knows more.
    #[must_use]
    pub fn centre(&self, (x, y): (u32, u32)) -> (f64, f64) {
        let (x, y) = self.point(f64::from(x) + 0.5, f64::from(y) + 0.5);
        // Without `+ 0.0` there is a negative zero.
        let rounded = |metres: f64| (metres * 1e7).round() / 1e7 + 0.0;
        (rounded(x), rounded(y))
    }

    /// The point so many cells to the right of the corner, and above it.
    fn point(&self, x: f64, y: f64) -> (f64, f64) {
        let (x, y, (sin, cos)) = (x * self.cell(), y * self.cell(), self.yaw.sin_cos());
        (self.origin.0 + x * cos - y * sin, self.origin.1 + x * sin + y * cos)
    }

    /// With cells that many times as large.
    pub(crate) fn scaled(self, by: u32) -> Place {
        let by = i64::from(by);
        // A resolution has few digits, and a factor as many as a map has cells.
        let resolution = Rational::new(self.resolution.numer().saturating_mul(by), *self.resolution.denom());
        Place { resolution, ..self }
    }

    /// Of the part that begins with that cell.
    pub(crate) fn moved(self, (x, y): (u32, u32)) -> Place {
        Place { origin: self.point(f64::from(x), f64::from(y)), ..self }
    }
}
