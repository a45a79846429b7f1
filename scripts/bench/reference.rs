//! The five objectives of the case studies, each by an explicit search that knows nothing else: what hyperplan, which
//! reads any objective, is measured against.
//!
//! `reference OBJECTIVE MAP T` prints the actions of a plan (or of two), or `unrealizable`. `sp` is a breadth-first
//! search of cells, `iso` and `cso` of pairs of cells; `isr` and `ar` are A* over the cells where the robot and its
//! disturbed twins may be, bounded from below by the twin that is farthest from the goal. One file without
//! dependencies: `rustc -O scripts/bench/reference.rs`.

use std::collections::{BinaryHeap, HashMap, VecDeque};
use std::{env, fs, process};

const ACTIONS: [(&str, isize, isize); 5] =
    [("stay", 0, 0), ("up", 0, 1), ("down", 0, -1), ("left", -1, 0), ("right", 1, 0)];
const FAR: u32 = u32::MAX;

/// A map, its rows counted from the bottom.
struct Map {
    width: isize,
    height: isize,
    wall: Vec<bool>,
    goal: Vec<bool>,
    starts: Vec<usize>,
}

impl Map {
    fn read(file: &str) -> Map {
        let text = fs::read_to_string(file).unwrap_or_else(|error| fail(&format!("{file}: {error}")));
        let rows: Vec<&[u8]> = text.lines().rev().map(str::as_bytes).collect();
        let width = rows.first().map_or(0, |row| row.len());
        if width == 0 || rows.iter().any(|row| row.len() != width) {
            fail(&format!("{file}: rows must be of one length"));
        }
        let cells: Vec<u8> = rows.concat();
        let those = |letter: u8| cells.iter().map(|&cell| cell == letter).collect::<Vec<bool>>();
        let starts = (0..cells.len()).filter(|&at| cells[at] == b'S').collect();
        Map {
            width: width as isize,
            height: rows.len() as isize,
            wall: those(b'#'),
            goal: those(b'G'),
            starts,
        }
    }

    /// Where a move leads: goals are never left, and what lies beyond the edge is no cell.
    fn target(&self, at: usize, action: usize) -> Option<usize> {
        if self.goal[at] {
            return Some(at);
        }
        let (_, dx, dy) = ACTIONS[action];
        let (x, y) = (at as isize % self.width + dx, at as isize / self.width + dy);
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        inside.then_some((y * self.width + x) as usize)
    }

    /// The same where obstacles cannot be entered: there is no such move.
    fn free(&self, at: usize, action: usize) -> Option<usize> {
        self.target(at, action).filter(|&to| !self.wall[to])
    }

    /// The same where the edge holds the robot back and obstacles wreck it.
    fn bump(&self, at: usize, action: usize) -> Option<usize> {
        Some(self.target(at, action).unwrap_or(at)).filter(|&to| !self.wall[to])
    }

    fn row(&self, at: usize) -> usize {
        at / self.width as usize
    }

    /// How many moves each cell is from a goal.
    fn distances(&self) -> Vec<u32> {
        let mut distance = vec![FAR; self.wall.len()];
        let mut queue: VecDeque<usize> = (0..distance.len()).filter(|&at| self.goal[at]).collect();
        queue.iter().for_each(|&at| distance[at] = 0);
        while let Some(at) = queue.pop_front() {
            let (x, y) = (at as isize % self.width, at as isize / self.width);
            for (_, dx, dy) in &ACTIONS[1..] {
                let (x, y) = (x - dx, y - dy);
                if !(0..self.width).contains(&x) || !(0..self.height).contains(&y) {
                    continue;
                }
                let from = (y * self.width + x) as usize;
                if !self.wall[from] && distance[from] == FAR {
                    distance[from] = distance[at] + 1;
                    queue.push_back(from);
                }
            }
        }
        distance
    }
}

/// A search tree: each node's parent and the action that led there.
type Tree = Vec<(usize, usize)>;

fn actions(tree: &Tree, mut node: usize, base: usize) -> String {
    let mut found = Vec::new();
    while tree[node].0 != node {
        found.push(tree[node].1);
        node = tree[node].0;
    }
    let words = |divisor: usize| {
        let names: Vec<&str> = found.iter().rev().map(|&action| ACTIONS[action / divisor % 5].0).collect();
        names.join(",")
    };
    if base == 5 { words(1) } else { format!("{}\n{}", words(5), words(1)) }
}

/// Breadth first over states that are numbers below `size`, for at most `horizon` steps.
fn breadth<const N: usize>(
    size: usize,
    starts: Vec<usize>,
    horizon: u32,
    next: impl Fn(usize, usize) -> Option<usize>,
    done: impl Fn(usize) -> bool,
) -> Option<String> {
    let mut seen = vec![0u64; size.div_ceil(64)];
    let mut fresh = |state: usize| {
        let new = seen[state / 64] >> (state % 64) & 1 == 0;
        seen[state / 64] |= 1 << (state % 64);
        new
    };
    let mut tree: Tree = Vec::new();
    let mut states: Vec<usize> = Vec::new();
    for state in starts {
        if fresh(state) {
            tree.push((states.len(), 0));
            states.push(state);
        }
    }
    let (mut node, mut layer) = (0, states.len());
    for time in 0..=horizon {
        while node < layer {
            if done(states[node]) {
                return Some(actions(&tree, node, N));
            }
            for action in 0..N {
                if time == horizon {
                    break;
                }
                if let Some(to) = next(states[node], action).filter(|&to| fresh(to)) {
                    tree.push((node, action));
                    states.push(to);
                }
            }
            node += 1;
        }
        layer = states.len();
    }
    None
}

fn sp(map: &Map, horizon: u32) -> Option<String> {
    let next = |at: usize, action: usize| map.free(at, action);
    breadth::<5>(map.wall.len(), map.starts.clone(), horizon, next, |at| map.goal[at])
}

/// Pairs that take the same actions, in the same rows, at goals at the same times.
fn iso(map: &Map, horizon: u32) -> Option<String> {
    let cells = map.wall.len();
    let alike = |p: usize, q: usize| map.row(p) == map.row(q) && map.goal[p] == map.goal[q];
    let pairs = map.starts.iter().flat_map(|&p| map.starts.iter().map(move |&q| (p, q)));
    let starts = pairs.filter(|&(p, q)| p != q && alike(p, q)).map(|(p, q)| p * cells + q).collect();
    let next = |pair: usize, action: usize| {
        let (p, q) = (map.free(pair / cells, action)?, map.free(pair % cells, action)?);
        alike(p, q).then_some(p * cells + q)
    };
    breadth::<5>(cells * cells, starts, horizon, next, |pair| map.goal[pair / cells])
}

/// Pairs in the same rows, and whether they were apart.
fn cso(map: &Map, horizon: u32) -> Option<String> {
    let cells = map.wall.len();
    let starts = map.starts.iter().map(|&at| (at * cells + at) * 2).collect();
    let next = |state: usize, actions: usize| {
        let (p, q) = (map.free(state / 2 / cells, actions / 5)?, map.free(state / 2 % cells, actions % 5)?);
        let apart = state % 2 == 1 || p != q;
        (map.row(p) == map.row(q)).then_some((p * cells + q) * 2 + usize::from(apart))
    };
    let done = |state: usize| state % 2 == 1 && map.goal[state / 2 / cells] && map.goal[state / 2 % cells];
    breadth::<25>(cells * cells * 2, starts, horizon, next, done)
}

/// The other starts follow the same actions.
fn isr(map: &Map, horizon: u32) -> Option<String> {
    twins(map, horizon, map.starts.iter().map(|&at| at as u32).collect(), false)
}

/// One action may be replaced.
fn ar(map: &Map, horizon: u32) -> Option<String> {
    twins(map, horizon, vec![map.starts[0] as u32], true)
}

/// A* over where the robot (first) and its twins (the others, sorted, those at goals left out) are.
fn twins(map: &Map, horizon: u32, start: Vec<u32>, faults: bool) -> Option<String> {
    let distance = map.distances();
    let farthest = |cells: &[u32]| cells.iter().map(|&at| distance[at as usize]).max().unwrap_or(0);
    let mut tree: Tree = vec![(0, 0)];
    let mut nodes: Vec<(u32, Vec<u32>)> = vec![(0, start)];
    let mut best: HashMap<Vec<u32>, u32> = HashMap::new();
    let mut open = BinaryHeap::from([(std::cmp::Reverse(0), 0, 0)]);
    while let Some((_, _, node)) = open.pop() {
        let (time, cells) = nodes[node].clone();
        if cells.iter().all(|&at| map.goal[at as usize]) {
            return Some(actions(&tree, node, 5));
        }
        if best.get(&cells).is_some_and(|&known| known < time) {
            continue;
        }
        for action in 0..ACTIONS.len() {
            let Some(to) = follow(map, &cells, action, faults) else { continue };
            let bound = farthest(&to);
            if bound == FAR
                || time + 1 + bound > horizon
                || best.get(&to).is_some_and(|&known| known <= time + 1)
            {
                continue;
            }
            best.insert(to.clone(), time + 1);
            tree.push((node, action));
            open.push((std::cmp::Reverse(time + 1 + bound), time + 1, nodes.len()));
            nodes.push((time + 1, to));
        }
    }
    None
}

/// Where all are after an action of the robot; with faults, it has a new twin for each other action.
fn follow(map: &Map, cells: &[u32], action: usize, faults: bool) -> Option<Vec<u32>> {
    let robot = map.bump(cells[0] as usize, action)? as u32;
    let mut twins = Vec::with_capacity(cells.len() + 4);
    for &at in &cells[1..] {
        twins.push(map.bump(at as usize, action)? as u32);
    }
    for other in (0..ACTIONS.len()).filter(|&other| faults && other != action) {
        twins.push(map.bump(cells[0] as usize, other)? as u32);
    }
    twins.retain(|&at| !map.goal[at as usize]);
    twins.sort_unstable();
    twins.dedup();
    twins.insert(0, robot);
    Some(twins)
}

fn fail(message: &str) -> ! {
    eprintln!("error: {message}");
    process::exit(2)
}

fn main() {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [objective, file, horizon] = arguments.as_slice() else { fail("usage: reference OBJECTIVE MAP T") };
    let Ok(horizon) = horizon.parse() else { fail("T must be a number") };
    let map = Map::read(file);
    if map.starts.is_empty() {
        fail("there is no start");
    }
    let found = match objective.as_str() {
        "sp" => sp(&map, horizon),
        "iso" => iso(&map, horizon),
        "cso" => cso(&map, horizon),
        "isr" => isr(&map, horizon),
        "ar" => ar(&map, horizon),
        _ => fail("the objective is sp, iso, cso, isr or ar"),
    };
    println!("{}", found.unwrap_or_else(|| "unrealizable".to_owned()));
}
