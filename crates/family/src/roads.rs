//! Roadmaps: places in the plane, each with roads to the three nearest, and what they cost. A budget is a sum over all steps, which
//! no step by itself comes near, and two ways have to keep within it and look alike at once.

use crate::parameters::Parameters;
use crate::random::Random;
use std::fmt::Write as _;

/// What is asked of two ways.
pub(crate) const OBJECTIVE: &str = "\
objective roads {
  define arrives(p) = F[0,K] (goal[p] & cost length[p] <= T);
  exists p, q.
    start[p] & start[q] & arrives(p) & arrives(q)
    & G[0,K] obs[p] == obs[q] & F[0,K] state[p] != state[q]
}";

/// The stream of its numbers, apart from those of all maps.
const STREAM: u64 = 6_000_000;
/// The side of the plane.
const SIDE: u32 = 100;
/// The roads from each place.
const ROADS: [&str; 3] = ["near", "middle", "far"];

/// A road: where it leads, and its length.
type Road = (usize, u32);

/// A roadmap. Place `i` is at `(below(100), below(100))`; its roads lead to the three places that are nearest, of equals
/// to that with the lower number, and are as long as the distance, rounded, but at least 1. Paths begin at place 0; the
/// goal is the place that is farthest by road.
pub(crate) struct Roads {
    /// Whether a place is in the right half.
    right: Vec<bool>,
    roads: Vec<[Road; 3]>,
    goal: usize,
    /// The length of the shortest way to the goal, and its roads.
    shortest: (u32, u32),
}

impl Roads {
    pub(crate) fn new(Parameters { size, seed, .. }: Parameters) -> Roads {
        let mut random = Random::new(seed, STREAM + u64::from(size));
        // Three roads need four places.
        let places: Vec<[u32; 2]> =
            (0..size.max(4)).map(|_| [random.below(SIDE), random.below(SIDE)]).collect();
        let square = |a: [u32; 2], b: [u32; 2]| a[0].abs_diff(b[0]).pow(2) + a[1].abs_diff(b[1]).pow(2);
        let roads = places.iter().enumerate().map(|(here, &from)| {
            let mut others: Vec<usize> = (0..places.len()).filter(|&other| other != here).collect();
            others.sort_by_key(|&other| (square(from, places[other]), other));
            [0, 1, 2].map(|i| (others[i], rounded_root(square(from, places[others[i]])).max(1)))
        });
        let roads: Vec<[Road; 3]> = roads.collect();
        let lengths = lengths(&roads);
        let reached = lengths
            .iter()
            .enumerate()
            .filter_map(|(place, length)| Some((*length, place)).filter(|_| length.0 < u32::MAX));
        let ((length, hops), goal) =
            reached.max_by_key(|&(length, place)| (length, usize::MAX - place)).unwrap_or(((0, 0), 0));
        let right = places.iter().map(|place| place[0] >= SIDE / 2).collect();
        Roads { right, roads, goal, shortest: (length, hops) }
    }

    /// No way costs less.
    pub(crate) fn shortest(&self) -> u32 {
        self.shortest.0.max(1)
    }

    /// A way that costs more than this is no longer looked for.
    pub(crate) fn most(&self) -> u32 {
        self.shortest.0 + SIDE
    }

    /// The system, and how many steps there are.
    pub(crate) fn system(&self) -> String {
        let choice = |of: &dyn Fn(usize) -> u32| {
            let last = self.roads.len() - 1;
            let cases: String =
                (0..last).map(|place| format!("if node == {place} then {} else ", of(place))).collect();
            format!("{cases}{}", of(last))
        };
        let number = |place: usize| u32::try_from(place).unwrap_or(0);
        let mut text = format!("const K = {};\n\nsystem Roads {{\n", 2 * self.shortest.1 + 2);
        let _ = writeln!(text, "  state node: 0..{};\n  action {};", self.roads.len() - 1, ROADS.join(", "));
        for (which, name) in ROADS.iter().enumerate() {
            let to = choice(&|place| number(self.roads[place][which].0));
            let _ = writeln!(text, "  on {name} {{ node' = {to}; }}");
        }
        let [near, middle, far] = [0, 1, 2].map(|which| choice(&|place| self.roads[place][which].1));
        let _ = writeln!(
            text,
            "  cost length = if action == near then ({near}) else if action == middle then ({middle}) else {far};"
        );
        let right =
            (0..self.right.len()).filter(|&place| self.right[place]).map(|place| format!("node == {place}"));
        let right: Vec<String> = right.collect();
        let right = if right.is_empty() { "false".to_owned() } else { right.join(" | ") };
        let _ = write!(
            text,
            "  label start = node == 0;\n  label goal = node == {};\n  label right = {right};\n  observe right;\n  absorb goal;\n  init start;\n}}\n\n",
            self.goal
        );
        text
    }
}

/// The length of a shortest way from place 0 to each, and of these the fewest roads (Dijkstra).
fn lengths(roads: &[[Road; 3]]) -> Vec<(u32, u32)> {
    let mut lengths = vec![(u32::MAX, u32::MAX); roads.len()];
    let mut open = std::collections::BTreeSet::from([((0, 0), 0)]);
    lengths[0] = (0, 0);
    while let Some(((length, hops), here)) = open.pop_first() {
        for &(to, road) in &roads[here] {
            let next = (length + road, hops + 1);
            if next < lengths[to] {
                open.remove(&(lengths[to], to));
                lengths[to] = next;
                open.insert((next, to));
            }
        }
    }
    lengths
}

/// The square root, rounded to the nearest integer.
fn rounded_root(square: u32) -> u32 {
    let root = square.isqrt();
    // Past the middle, (root + 1/2)^2 = root^2 + root + 1/4.
    if square > root * root + root { root + 1 } else { root }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Kind;

    #[test]
    fn roads_lead_to_the_nearest_and_to_the_goal() {
        for seed in 0..20 {
            let parameters = Parameters {
                kind: Kind::Random,
                size: 3 + u32::try_from(seed).expect("small") * 4,
                density: 0,
                seed,
            };
            let map = Roads::new(parameters);
            assert!(map.goal != 0 && map.shortest() > 1, "{seed}");
            for (place, roads) in map.roads.iter().enumerate() {
                assert!(roads.iter().all(|road| road.0 != place && road.1 >= 1));
                assert!(roads[0].1 <= roads[1].1 && roads[1].1 <= roads[2].1);
            }
        }
    }

    #[test]
    fn roots_are_rounded() {
        assert_eq!([0, 1, 2, 3, 6, 7, 12, 13, 9801].map(rounded_root), [0, 1, 1, 2, 2, 3, 3, 4, 99]);
    }
}
