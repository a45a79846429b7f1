//! A map while it is read and changed: what each cell is, and the labels of cells.

use super::{Cell, Clearance, GridMap, Lettered};
use crate::place::Place;
use std::collections::BTreeSet;

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Occupancy {
    Free,
    Obstacle,
    /// As maps of ROS have cells that nobody has seen.
    Unknown,
}

/// A map in the convention of the language: row 0 is the bottom one.
#[derive(Clone, Debug)]
pub(crate) struct Raster {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Row by row from the bottom.
    pub(crate) cells: Vec<Occupancy>,
    /// Labels of free cells; none has a cell twice.
    pub(crate) labels: Vec<Lettered>,
    /// Cells that nobody has seen, whatever they were taken for; sorted.
    pub(crate) unknown: Vec<Cell>,
    /// Where it lies, if that was said.
    pub(crate) place: Option<Place>,
    /// What says how far obstacles are, if that was wanted.
    pub(crate) clearance: Option<Clearance>,
}

impl Raster {
    /// A map of free cells.
    pub(crate) fn new(width: u32, height: u32) -> Raster {
        let cells = vec![Occupancy::Free; width as usize * height as usize];
        Raster { width, height, cells, labels: Vec::new(), unknown: Vec::new(), place: None, clearance: None }
    }

    pub(crate) fn index(&self, (x, y): Cell) -> usize {
        y as usize * self.width as usize + x as usize
    }

    /// How many of the cells are free.
    pub(crate) fn free(&self) -> usize {
        self.cells.iter().filter(|cell| **cell == Occupancy::Free).count()
    }

    /// What unknown cells are taken for.
    pub(crate) fn settle_unknown(&mut self, as_what: Occupancy) {
        let columns = (0..self.width).flat_map(|x| (0..self.height).map(move |y| (x, y)));
        self.unknown = columns.filter(|cell| self.cells[self.index(*cell)] == Occupancy::Unknown).collect();
        self.cells.iter_mut().filter(|cell| **cell == Occupancy::Unknown).for_each(|cell| *cell = as_what);
    }

    /// Makes cells obstacles whose centre is at most so far from the centre of one, the square of the distance in cells.
    ///
    /// In each column the distance to the nearest obstacle is known after two passes. A cell at distance `d` from one makes
    /// those of its row obstacles that are at most the root of `limit - d * d` away.
    pub(crate) fn inflate(&mut self, limit: u64) {
        let (width, height) = (self.width as usize, self.height as usize);
        // Nothing is farther away than the map is long.
        let radius = limit.isqrt().min((width + height) as u64);
        let reach: Vec<usize> = (0..=radius).map(|d| (limit - d * d).isqrt() as usize).collect();
        let distance = self.vertical_distances(reach.len());
        let mut changes = vec![0_i64; width + 1];
        for y in 0..height {
            let row = y * width;
            changes.fill(0);
            for x in 0..width {
                if let Some(&reach) = reach.get(distance[row + x] as usize) {
                    changes[x.saturating_sub(reach)] += 1;
                    changes[(x + reach + 1).min(width)] -= 1;
                }
            }
            let mut covered = 0;
            for (cell, change) in self.cells[row..row + width].iter_mut().zip(&changes) {
                covered += change;
                if covered > 0 {
                    *cell = Occupancy::Obstacle;
                }
            }
        }
        self.drop_covered_labels();
    }

    /// How far each cell is from the nearest obstacle of its column; `far` where it is that far or farther.
    fn vertical_distances(&self, far: usize) -> Vec<u32> {
        let (width, far) = (self.width as usize, u32::try_from(far).unwrap_or(u32::MAX));
        let mut distance: Vec<u32> =
            self.cells.iter().map(|cell| if *cell == Occupancy::Obstacle { 0 } else { far }).collect();
        for at in width..distance.len() {
            distance[at] = distance[at].min(distance[at - width].saturating_add(1)).min(far);
        }
        for at in (0..distance.len() - width).rev() {
            distance[at] = distance[at].min(distance[at + width].saturating_add(1)).min(far);
        }
        distance
    }

    /// A map of larger cells, each of so many by so many, from the lower left corner on. A cell is free if all its parts are,
    /// and has the labels of all of them; at the right and at the top there may be fewer parts.
    pub(crate) fn scale(&mut self, by: u32) {
        let mut scaled = Raster::new(self.width.div_ceil(by), self.height.div_ceil(by));
        for (row, y) in self.cells.chunks(self.width as usize).zip(0..) {
            for (cell, x) in row.iter().zip(0..) {
                if *cell != Occupancy::Free {
                    let at = scaled.index((x / by, y / by));
                    scaled.cells[at] = Occupancy::Obstacle;
                }
            }
        }
        scaled.unknown = self.scaled_unknown(by);
        let labels = std::mem::take(&mut self.labels);
        scaled.labels = relabelled(labels, |(x, y)| Some((x / by, y / by)));
        scaled.place = self.place.map(|place| place.scaled(by));
        *self = scaled;
        self.drop_covered_labels();
    }

    /// The larger cells in which there is something that nobody has seen, but no obstacle that somebody has.
    fn scaled_unknown(&self, by: u32) -> Vec<Cell> {
        if self.unknown.is_empty() {
            return Vec::new();
        }
        let seen = |cell: Cell| self.unknown.binary_search(&cell).is_err();
        let cells = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let obstacles =
            cells.filter(|&cell| self.cells[self.index(cell)] == Occupancy::Obstacle && seen(cell));
        let known: BTreeSet<Cell> = obstacles.map(|(x, y)| (x / by, y / by)).collect();
        let unknown: BTreeSet<Cell> = self.unknown.iter().map(|(x, y)| (x / by, y / by)).collect();
        unknown.difference(&known).copied().collect()
    }

    /// The part between two cells, both included and on the map; its lower left cell is the first.
    pub(crate) fn crop(&mut self, first: Cell, last: Cell) {
        let mut cropped = Raster::new(last.0 - first.0 + 1, last.1 - first.1 + 1);
        for y in 0..cropped.height {
            let (from, to) = (self.index((first.0, first.1 + y)), cropped.index((0, y)));
            let width = cropped.width as usize;
            cropped.cells[to..to + width].copy_from_slice(&self.cells[from..from + width]);
        }
        let inside = |(x, y): Cell| (first.0..=last.0).contains(&x) && (first.1..=last.1).contains(&y);
        let moved = |cell: Cell| inside(cell).then(|| (cell.0 - first.0, cell.1 - first.1));
        cropped.labels = relabelled(std::mem::take(&mut self.labels), moved);
        cropped.unknown = self.unknown.iter().copied().filter_map(moved).collect();
        cropped.place = self.place.map(|place| place.moved(first));
        *self = cropped;
    }

    /// Labels are those of free cells.
    fn drop_covered_labels(&mut self) {
        let mut labels = std::mem::take(&mut self.labels);
        for label in &mut labels {
            label.cells.retain(|cell| self.cells[self.index(*cell)] == Occupancy::Free);
        }
        self.labels = labels;
    }

    /// How far each cell is from the nearest obstacle, centre to centre, in cells and rounded up, if that is less than `most`: the
    /// cells of each such distance. Those of distance `n` are the ones that [`Raster::inflate`] by n covers, and by n - 1 does not.
    pub(crate) fn by_clearance(&self, most: u32) -> Vec<Vec<Cell>> {
        let far = most as usize;
        let above = self.vertical_distances(far);
        let mut by_distance = vec![Vec::new(); far];
        for (at, (y, x)) in (0..self.height).flat_map(|y| (0..self.width).map(move |x| (y, x))).enumerate() {
            let (left, right) = (far.min(x as usize), far.min((self.width - 1 - x) as usize));
            let squares = (at - left..=at + right).map(|other| {
                let (dx, dy) = (at.abs_diff(other) as u64, u64::from(above[other]));
                dx * dx + dy * dy
            });
            let square = squares.min().unwrap_or(u64::MAX);
            let distance = square.isqrt() + u64::from(square.isqrt().pow(2) < square);
            // Where a column has none within reach, `far` stands for that.
            if let Some(cells) = usize::try_from(distance).ok().and_then(|d| by_distance.get_mut(d)) {
                cells.push((x, y));
            }
        }
        by_distance
    }

    /// The map that a system is made of. Unknown cells have to be settled.
    pub(crate) fn finish(self) -> GridMap {
        let (width, height) = (self.width, self.height);
        let columns = (0..width).flat_map(|x| (0..height).map(move |y| (x, y)));
        let obstacles = columns.filter(|cell| self.cells[self.index(*cell)] != Occupancy::Free).collect();
        let Raster { labels, unknown, place, clearance, .. } = self;
        GridMap { width, height, obstacles, labels, unknown, place, clearance }
    }
}

/// Labels on other cells; those that are nowhere are left out of them.
fn relabelled(labels: Vec<Lettered>, to: impl Fn(Cell) -> Option<Cell>) -> Vec<Lettered> {
    let one = |label: Lettered| {
        let mut cells: Vec<Cell> = label.cells.into_iter().filter_map(&to).collect();
        cells.sort_unstable();
        cells.dedup();
        Lettered { cells, ..label }
    };
    labels.into_iter().map(one).collect()
}
