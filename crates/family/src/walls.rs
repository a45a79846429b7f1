//! The walls of structured maps: rooms, mazes and the aisles of warehouses, as robots and computer games have them, and the
//! benchmarks of pathfinding after them (Sturtevant 2012). There is one way between two places, or few, so that a detour
//! is long, and what hides a path or makes up for a fault has to be known many steps before.

use crate::parameters::{Cell, Kind, Parameters, index};
use crate::random::Random;

/// The cells that are walls, row by row from the bottom.
///
/// - Rooms: walls are the columns and rows whose number leaves the remainder `w` modulo `w + 1`, where `w` is a quarter of
///   the size, at least 2. Of each stretch of wall between two rooms one cell, `below(its cells)`, is a door.
/// - Maze: cells with even column and row are places. From the one at the bottom left a depth-first search goes to a
///   neighbor that it has not seen, `below(how many there are)` among right, left, above, below, and opens the cell
///   between; where there is none it goes back. Then `round(n * density / 100)` of the `n` walls between two places that
///   are left are opened, the first of a shuffle.
/// - Aisles: racks are two rows deep and five columns long, between aisles one cell wide; the outermost cells are free.
pub(crate) fn walls(parameters: Parameters, random: &mut Random) -> Vec<bool> {
    let Parameters { kind, size, density, .. } = parameters;
    let all = |is_wall: &dyn Fn(u32, u32) -> bool| -> Vec<bool> {
        (0..size * size).map(|i| is_wall(i % size, i / size)).collect()
    };
    match kind {
        Kind::Random => all(&|_, _| false),
        Kind::Aisles => all(&|x, y| x % 6 != 0 && y % 3 != 0 && x + 1 < size && y + 1 < size),
        Kind::Rooms => {
            let pitch = (size / 4).max(2) + 1;
            let mut walls = all(&|x, y| x % pitch == pitch - 1 || y % pitch == pitch - 1);
            doors(size, pitch, &mut walls, random);
            walls
        }
        Kind::Maze => {
            let mut walls = all(&|x, y| x % 2 == 1 || y % 2 == 1);
            dig(size, &mut walls, random);
            let between = |&i: &usize| walls[i] && is_between(size, u32::try_from(i).unwrap_or(0));
            let mut closed: Vec<usize> = (0..walls.len()).filter(between).collect();
            let opened = (u32::try_from(closed.len()).unwrap_or(0) * density + 50) / 100;
            random.shuffle(&mut closed, opened);
            closed.iter().take(opened as usize).for_each(|&i| walls[i] = false);
            walls
        }
    }
}

/// Opens a door in each stretch of wall between two rooms: first in columns, then in rows.
fn doors(size: u32, pitch: u32, walls: &mut [bool], random: &mut Random) {
    let lines = || (pitch - 1..size.saturating_sub(1)).step_by(pitch as usize);
    for upright in [true, false] {
        for line in lines() {
            for first in (0..size).step_by(pitch as usize) {
                let along = first + random.below((pitch - 1).min(size - first));
                let door = if upright { Cell { x: line, y: along } } else { Cell { x: along, y: line } };
                walls[index(size, door)] = false;
            }
        }
    }
}

/// Whether a cell of a maze lies between two places.
fn is_between(size: u32, cell: u32) -> bool {
    let (x, y) = (cell % size, cell / size);
    (x % 2 == 1 && y % 2 == 0 && x + 1 < size) || (x % 2 == 0 && y % 2 == 1 && y + 1 < size)
}

/// Opens walls until all places of a maze are connected, by one way each.
fn dig(size: u32, walls: &mut [bool], random: &mut Random) {
    let mut seen = vec![false; walls.len()];
    seen[0] = true;
    let mut way = vec![Cell { x: 0, y: 0 }];
    while let Some(&here) = way.last() {
        let right = (here.x + 2 < size).then(|| Cell { x: here.x + 2, ..here });
        let left = here.x.checked_sub(2).map(|x| Cell { x, ..here });
        let above = (here.y + 2 < size).then(|| Cell { y: here.y + 2, ..here });
        let below = here.y.checked_sub(2).map(|y| Cell { y, ..here });
        let open = [right, left, above, below].into_iter().flatten();
        let open: Vec<Cell> = open.filter(|&next| !seen[index(size, next)]).collect();
        let Some(&next) = random.choose(&open) else {
            way.pop();
            continue;
        };
        seen[index(size, next)] = true;
        walls[index(size, Cell { x: (here.x + next.x) / 2, y: (here.y + next.y) / 2 })] = false;
        way.push(next);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(kind: Kind, size: u32, density: u32) -> Vec<String> {
        let parameters = Parameters { kind, size, density, seed: 0 };
        let walls = walls(parameters, &mut Random::new(0, 0));
        let row = |row: &[bool]| row.iter().map(|&wall| if wall { '#' } else { '.' }).collect();
        walls.chunks(size as usize).rev().map(row).collect()
    }

    /// Places that are connected, and the free cells between them.
    fn connected(rows: &[String]) -> (usize, usize) {
        let size = rows.len();
        let free = |x: usize, y: usize| rows[size - 1 - y].as_bytes()[x] == b'.';
        let mut seen = vec![false; size * size];
        let mut found: Vec<(usize, usize)> = vec![(0, 0)];
        seen[0] = true;
        let mut next = 0;
        while let Some(&(x, y)) = found.get(next) {
            next += 1;
            let beside = [(x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))];
            for (x, y) in beside {
                if x < size && y < size && free(x, y) && !seen[y * size + x] {
                    seen[y * size + x] = true;
                    found.push((x, y));
                }
            }
        }
        (found.len(), rows.iter().map(|row| row.bytes().filter(|&b| b == b'.').count()).sum())
    }

    #[test]
    fn all_that_is_free_is_connected() {
        for size in [5, 8, 9, 16, 21] {
            for kind in [Kind::Rooms, Kind::Maze, Kind::Aisles] {
                let rows = picture(kind, size, 0);
                let (found, free) = connected(&rows);
                assert_eq!(found, free, "{kind} {size}\n{}", rows.join("\n"));
            }
        }
    }

    #[test]
    fn a_maze_without_openings_has_one_way_to_each_place() {
        let rows = picture(Kind::Maze, 9, 0);
        // 25 places, and so 24 cells between them.
        assert_eq!(connected(&rows).0, 49, "{}", rows.join("\n"));
        assert_eq!(connected(&picture(Kind::Maze, 9, 50)).0, 49 + 8);
    }

    #[test]
    fn racks_stand_between_aisles() {
        let rows = picture(Kind::Aisles, 8, 0);
        let (aisle, racks) = ("........", ".#####..");
        assert_eq!(rows, [aisle, aisle, racks, racks, aisle, racks, racks, aisle]);
    }
}
