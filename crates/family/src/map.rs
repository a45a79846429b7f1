//! Random maps.

use crate::parameters::{Cell, Kind, Parameters, index};
use crate::random::Random;
use crate::walls::walls;
use std::collections::VecDeque;
use std::ops::RangeInclusive;

/// The side lengths that maps may have.
pub const SIZES: RangeInclusive<u32> = 3..=256;
/// The greatest share of obstacles, in percent; beyond it hardly any two cells are connected.
pub const MAX_DENSITY: u32 = 60;
/// How often obstacles are laid out anew.
const ATTEMPTS: u32 = 200;

/// A square map with obstacles, a start and a goal.
///
/// As the random maps of the pathfinding benchmarks (Sturtevant, *Benchmarks for Grid-Based Pathfinding*, 2012; Stern
/// et al., *Multi-Agent Pathfinding: Definitions, Variants, and Benchmarks*, 2019) it is a square in which a given share
/// of cells, chosen uniformly, are obstacles. Exactly:
///
/// 1. Numbers are drawn from PCG32 with the seed, on stream `1000 * size + density`, and 1,000,000 more for each kind
///    before the map's in [`Kind::ALL`].
/// 2. Walls are built, see the module `walls`. Of the `n` cells without one, numbered from the bottom left, row by row,
///    `round(n * density / 100)` become obstacles (halves are rounded up): the first of a Fisher-Yates shuffle, which for
///    `i = 0, 1, ...` swaps the cell at `i` with the one at `i + below(n - i)`. In a maze none do: there the density says
///    how many of the walls between two corridors are opened.
/// 3. The *room* is the largest set of free cells that are connected by moves up, down, left and right; of several, the
///    one with the lowest number.
/// 4. The start is one cell of the room, `below(its cells)`, in the order of their numbers. The goal is one of those
///    cells of the room, chosen alike, that are at least half as far from the start as the farthest.
/// 5. Where the room has less than half of the free cells, or its farthest cell is nearer than `size / 2` moves (rounded
///    down), all is drawn anew from step 2 on.
///
/// So start and goal are connected, and not neighbors. Free cells outside the room stay as they are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Map {
    parameters: Parameters,
    obstacle: Vec<bool>,
    start: Cell,
    goal: Cell,
    distance: u32,
}

/// Why there is no such map.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MapError {
    /// The size is out of bounds.
    #[error("maps have {low} to {high} cells a side, not {0}", low = SIZES.start(), high = SIZES.end())]
    Size(u32),
    /// The density is out of bounds.
    #[error("obstacles are 0 to {MAX_DENSITY} percent of a map, not {0}")]
    Density(u32),
    /// No attempt had room for a path.
    #[error(
        "no map of {size} x {size} cells with {density} % obstacles and seed {seed} ({kind}) has room for a path"
    )]
    NoRoom {
        /// Where its walls are.
        kind: Kind,
        /// The length of a side.
        size: u32,
        /// The share of obstacles.
        density: u32,
        /// The seed.
        seed: u64,
    },
}

impl Parameters {
    /// Whether sizes and densities are such that maps are made.
    ///
    /// # Errors
    /// If one is out of bounds.
    pub fn check(&self) -> Result<(), MapError> {
        if !SIZES.contains(&self.size) {
            return Err(MapError::Size(self.size));
        }
        if self.density > MAX_DENSITY {
            return Err(MapError::Density(self.density));
        }
        Ok(())
    }
}

impl Map {
    /// The map of these parameters.
    ///
    /// # Errors
    /// If they are out of bounds, or leave no room.
    pub fn random(parameters: Parameters) -> Result<Map, MapError> {
        parameters.check()?;
        let Parameters { size, density, seed, kind } = parameters;
        let before = Kind::ALL.into_iter().filter(|&other| other < kind).count() as u64;
        let stream = before * 1_000_000 + u64::from(size) * 1000 + u64::from(density);
        let mut random = Random::new(seed, stream);
        let attempt = (0..ATTEMPTS).find_map(|_| attempt(parameters, &mut random));
        attempt.ok_or(MapError::NoRoom { size, density, seed, kind })
    }

    /// What the map was made from.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        self.parameters
    }

    /// Where to start.
    #[must_use]
    pub fn start(&self) -> Cell {
        self.start
    }

    /// Where to go.
    #[must_use]
    pub fn goal(&self) -> Cell {
        self.goal
    }

    /// The least number of moves from the start to the goal.
    #[must_use]
    pub fn distance(&self) -> u32 {
        self.distance
    }

    /// Whether a cell is an obstacle; what is outside the map is one.
    #[must_use]
    pub fn is_obstacle(&self, cell: Cell) -> bool {
        let size = self.parameters.size;
        cell.x >= size || cell.y >= size || self.obstacle[index(size, cell)]
    }

    /// The least number of moves from one cell to each that can be reached, in the order of cells.
    pub(crate) fn distances(&self, from: Cell) -> impl Iterator<Item = (Cell, u32)> {
        let size = self.parameters.size;
        let all = distances(size, &self.obstacle, index(size, from));
        all.into_iter().enumerate().filter_map(move |(i, steps)| Some((cell(size, i), steps?)))
    }

    /// The free cells next to one: left, right, below, above.
    pub fn neighbors(&self, cell: Cell) -> impl Iterator<Item = Cell> {
        let size = self.parameters.size;
        neighbors(size, cell).filter(|&next| !self.is_obstacle(next))
    }
}

fn cell(size: u32, index: usize) -> Cell {
    let index = u32::try_from(index).expect("maps have at most 256 x 256 cells");
    Cell { x: index % size, y: index / size }
}

fn neighbors(size: u32, Cell { x, y }: Cell) -> impl Iterator<Item = Cell> {
    let left = x.checked_sub(1).map(|x| Cell { x, y });
    let right = (x + 1 < size).then_some(Cell { x: x + 1, y });
    let below = y.checked_sub(1).map(|y| Cell { x, y });
    let above = (y + 1 < size).then_some(Cell { x, y: y + 1 });
    [left, right, below, above].into_iter().flatten()
}

fn attempt(parameters: Parameters, random: &mut Random) -> Option<Map> {
    let Parameters { size, density, kind, .. } = parameters;
    let mut obstacle = walls(parameters, random);
    let mut order: Vec<usize> = (0..obstacle.len()).filter(|&i| !obstacle[i]).collect();
    let free = u32::try_from(order.len()).ok()?;
    let obstacles = if kind == Kind::Maze { 0 } else { (free * density + 50) / 100 };
    random.shuffle(&mut order, obstacles);
    order[..obstacles as usize].iter().for_each(|&i| obstacle[i] = true);
    let room = largest_room(size, &obstacle);
    if room.len() * 2 < (free - obstacles) as usize {
        return None;
    }
    let start = *random.choose(&room)?;
    let distances = distances(size, &obstacle, start);
    let far = room.iter().filter_map(|&i| distances[i]).max().unwrap_or(0);
    if far < size / 2 {
        return None;
    }
    let goals: Vec<usize> =
        room.iter().copied().filter(|&i| distances[i].is_some_and(|d| 2 * d >= far)).collect();
    let goal = *random.choose(&goals)?;
    let distance = distances[goal]?;
    Some(Map { parameters, obstacle, start: cell(size, start), goal: cell(size, goal), distance })
}

/// The largest connected set of free cells, in the order of their numbers.
fn largest_room(size: u32, obstacle: &[bool]) -> Vec<usize> {
    let mut seen = obstacle.to_vec();
    let mut largest = Vec::new();
    for first in 0..seen.len() {
        if seen[first] {
            continue;
        }
        let mut room = Vec::new();
        spread(size, first, &mut seen, |here, _| room.push(here));
        if room.len() > largest.len() {
            largest = room;
        }
    }
    largest.sort_unstable();
    largest
}

/// The least number of moves from one cell to each that can be reached.
fn distances(size: u32, obstacle: &[bool], from: usize) -> Vec<Option<u32>> {
    let mut distances = vec![None; obstacle.len()];
    spread(size, from, &mut obstacle.to_vec(), |here, steps| distances[here] = Some(steps));
    distances
}

/// Visits what can be reached from a cell and was not seen, with the least number of moves there.
fn spread(size: u32, from: usize, seen: &mut [bool], mut visit: impl FnMut(usize, u32)) {
    seen[from] = true;
    let mut queue = VecDeque::from([(from, 0)]);
    while let Some((here, steps)) = queue.pop_front() {
        visit(here, steps);
        for next in neighbors(size, cell(size, here)).map(|c| index(size, c)) {
            if !seen[next] {
                seen[next] = true;
                queue.push_back((next, steps + 1));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(size: u32, density: u32, seed: u64) -> Map {
        Map::random(Parameters { size, density, seed, kind: Kind::Random }).expect("there is room")
    }

    #[test]
    fn maps_have_their_share_of_obstacles_and_a_way() {
        for (size, density) in [(3, 0), (5, 10), (8, 20), (16, 35), (32, 40)] {
            for seed in 0..20 {
                let map = map(size, density, seed);
                let count = map.obstacle.iter().filter(|&&o| o).count();
                assert_eq!(count, ((size * size * density + 50) / 100) as usize);
                assert!(!map.is_obstacle(map.start) && !map.is_obstacle(map.goal));
                let distances = distances(size, &map.obstacle, index(size, map.start));
                assert_eq!(distances[index(size, map.goal)], Some(map.distance));
                assert!(map.distance >= (size / 2).div_ceil(2), "{size} {density} {seed}");
            }
        }
    }

    #[test]
    fn parameters_make_the_map() {
        assert_eq!(map(8, 20, 1), map(8, 20, 1));
        assert_ne!(map(8, 20, 1).obstacle, map(8, 20, 2).obstacle);
        assert_ne!(map(8, 20, 1).obstacle, map(8, 21, 1).obstacle);
    }

    #[test]
    fn every_kind_of_map_has_a_way() {
        for (kind, size, density) in [
            (Kind::Rooms, 9, 0),
            (Kind::Rooms, 16, 10),
            (Kind::Maze, 9, 0),
            (Kind::Maze, 16, 20),
            (Kind::Aisles, 12, 5),
        ] {
            for seed in 0..10 {
                let map = Map::random(Parameters { size, density, seed, kind }).expect("there is room");
                assert!(map.distance >= (size / 2).div_ceil(2), "{kind} {size} {density} {seed}");
                assert!(
                    map.obstacle.iter().any(|&o| o)
                        && !map.is_obstacle(map.start)
                        && !map.is_obstacle(map.goal)
                );
            }
        }
    }

    #[test]
    fn obstacles_are_anywhere() {
        let mut seen = [0_u32; 64];
        for seed in 0..400 {
            map(8, 20, seed).obstacle.iter().zip(&mut seen).for_each(|(&o, n)| *n += u32::from(o));
        }
        // 20 % of 400; that it is so near to 80 everywhere is the seeds' own.
        assert!(seen.iter().all(|n| (50..115).contains(n)), "{seen:?}");
    }

    #[test]
    fn what_has_no_room_is_refused() {
        let parameters = |size, density| Parameters { size, density, seed: 0, kind: Kind::Random };
        assert_eq!(Map::random(parameters(2, 0)), Err(MapError::Size(2)));
        assert_eq!(Map::random(parameters(257, 0)), Err(MapError::Size(257)));
        assert_eq!(Map::random(parameters(8, 61)), Err(MapError::Density(61)));
        let crowded = Map::random(parameters(64, 60));
        assert_eq!(crowded, Err(MapError::NoRoom { size: 64, density: 60, seed: 0, kind: Kind::Random }));
    }
}
