//! What is asked, on a map or of a system of its own.

use crate::map::Map;
use crate::parameters::{Cell, Kind, Parameters};
use crate::{locks, roads};
use serde::{Deserialize, Serialize};
use std::fmt::{self, Write as _};
use std::str::FromStr;

/// What is asked. The first five are the objectives of "Hyperproperties for Robotics: Planning via HyperLTL" (Wang,
/// Nalluri, Pajic; ICRA 2020), as the prelude has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Objective {
    /// Shortest path: the paper's (6).
    Sp,
    /// Robustness against another start: (9).
    Isr,
    /// Robustness against one replaced action: (10).
    Ar,
    /// Opacity of the start: (12).
    Iso,
    /// Opacity of where the robot is: (13).
    Cso,
    /// Robustness against any of several starts.
    Isrs,
    /// Robustness against two replaced actions.
    Ar2,
    /// Robustness against any number of replaced actions, but no two in succession.
    Ars,
    /// Conformant planning while the robot drifts.
    Drift,
    /// Opacity of where the robot is, among three ways.
    Cso3,
    /// Another way against every suspicion: a change of quantifiers more.
    Alibi,
    /// Two counters that one sequence has to bring to their goal from two starts.
    Locks,
    /// Opacity on a roadmap, within a budget.
    Roads,
}

impl Objective {
    /// Those of the paper.
    pub const PAPER: [Objective; 5] =
        [Objective::Sp, Objective::Isr, Objective::Ar, Objective::Iso, Objective::Cso];
    /// All of them.
    pub const ALL: [Objective; 13] = [
        Objective::Sp,
        Objective::Isr,
        Objective::Ar,
        Objective::Iso,
        Objective::Cso,
        Objective::Isrs,
        Objective::Ar2,
        Objective::Ars,
        Objective::Drift,
        Objective::Cso3,
        Objective::Alibi,
        Objective::Locks,
        Objective::Roads,
    ];

    /// Its short name, which is also that of the objective in a problem.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Objective::Sp => "sp",
            Objective::Isr => "isr",
            Objective::Ar => "ar",
            Objective::Iso => "iso",
            Objective::Cso => "cso",
            Objective::Isrs => "isrs",
            Objective::Ar2 => "ar2",
            Objective::Ars => "ars",
            Objective::Drift => "drift",
            Objective::Cso3 => "cso3",
            Objective::Alibi => "alibi",
            Objective::Locks => "locks",
            Objective::Roads => "roads",
        }
    }

    /// Whether it is about a robot on a map; the others have systems of their own, of which only size and seed count.
    #[must_use]
    pub fn has_map(self) -> bool {
        !matches!(self, Objective::Locks | Objective::Roads)
    }

    /// Whether all its paths are of one block, so that there is no quantifier to keep or to expand.
    #[must_use]
    pub fn is_single(self) -> bool {
        matches!(self, Objective::Iso | Objective::Cso | Objective::Cso3 | Objective::Roads)
    }

    /// Whether what cannot be entered ends a path; where paths are compared or hidden there is no move there at all.
    fn crashes(self) -> bool {
        use Objective::{Ar, Ar2, Ars, Isr, Isrs};
        matches!(self, Isr | Ar | Isrs | Ar2 | Ars)
    }

    /// What it asks, on a line.
    fn title(self) -> &'static str {
        match self {
            Objective::Sp => "p is among the fastest ways from the start to the goal.",
            Objective::Isr => {
                "The actions of p also lead from the other start to a goal, past all obstacles."
            }
            Objective::Ar => {
                "The actions of p lead to a goal, past all obstacles, even if one of them is replaced by another."
            }
            Objective::Iso => "Whoever sees only rows and actions cannot tell where the robot set out.",
            Objective::Cso => "Whoever sees only rows cannot tell which of two ways the robot took.",
            Objective::Isrs => "The actions of p lead from every start to a goal, past all obstacles.",
            Objective::Ar2 => {
                "The actions of p lead to a goal, past all obstacles, even if two of them are replaced by others."
            }
            Objective::Ars => {
                "The actions of p lead to a goal, past all obstacles, if any are replaced, but no two in succession."
            }
            Objective::Drift => {
                "The actions of p lead to the goal even if the robot, up to twice, drifts to the right instead."
            }
            Objective::Cso3 => "Whoever sees only rows cannot tell which of three ways the robot took.",
            Objective::Alibi => {
                "Whichever way q, seen like p, the robot is suspected of: some way r, seen like p, was elsewhere."
            }
            Objective::Locks => {
                "One sequence of actions brings both counters to their goal from either start."
            }
            Objective::Roads => {
                "Whoever sees only the side of the map cannot tell which of two ways, within budget, was taken."
            }
        }
    }

    /// The declaration of the objective.
    fn declaration(self) -> &'static str {
        match self {
            Objective::Sp => "objective sp = shortest_path(start, goal, T);",
            Objective::Isr => "objective isr = initial_state_robust(first, start, goal, crash, T);",
            Objective::Ar => "objective ar within T = action_robust(start, goal, crash, T);",
            Objective::Iso => "objective iso = initial_state_opaque(start, goal, T);",
            Objective::Cso => "objective cso = current_state_opaque(start, goal, T);",
            Objective::Isrs => "objective isrs = initial_state_robust(first, start, goal, crash, T);",
            Objective::Ar2 => AR2,
            Objective::Ars => "objective ars within T = action_robust_successive(start, goal, crash, 2, T);",
            Objective::Drift => DRIFT,
            Objective::Cso3 => CSO3,
            Objective::Alibi => ALIBI,
            Objective::Locks => locks::OBJECTIVE,
            Objective::Roads => roads::OBJECTIVE,
        }
    }

    /// The problem on a map within so many steps, as a problem file; of [`Objective::Roads`], within that budget.
    ///
    /// As in the paper's case studies, obstacles cannot be entered where paths are compared or hidden, and crash where
    /// they have to be robust; a goal is never left. The shortest path has one cell for its goal, the others also the
    /// free cells around it, up to two cells away where several faults are to be made up for; a robust path has a second
    /// start, a free cell next to the first, or several, those at most two moves away.
    #[must_use]
    pub fn problem(self, map: &Map, steps: u32) -> String {
        let parameters = map.parameters();
        let place = self.place(parameters);
        let mut text = format!("// {}\n// {place}.\nconst T = {steps};\n\n", self.title());
        match self {
            Objective::Locks => text += &locks::system(parameters),
            Objective::Roads => text += &roads::Roads::new(parameters).system(),
            _ => self.world(map, &mut text),
        }
        text.extend([self.declaration(), "\n"]);
        text
    }

    /// Where it takes place, in words.
    #[must_use]
    pub fn place(self, Parameters { kind, size, density, seed }: Parameters) -> String {
        match (self, kind) {
            (Objective::Locks, _) => format!("Counters: size {size}, seed {seed}"),
            (Objective::Roads, _) => format!("A roadmap: {} places, seed {seed}", size.max(4)),
            (_, Kind::Random) => format!("A random map: size {size}, {density} % obstacles, seed {seed}"),
            (_, Kind::Rooms) => format!("Rooms: size {size}, {density} % obstacles, seed {seed}"),
            (_, Kind::Maze) => format!("A maze: size {size}, {density} % of its walls opened, seed {seed}"),
            (_, Kind::Aisles) => format!("A warehouse: size {size}, {density} % obstacles, seed {seed}"),
        }
    }

    /// The system of a robot on a map.
    fn world(self, map: &Map, text: &mut String) {
        let size = map.parameters().size;
        let starts: Vec<Cell> = match self {
            Objective::Isr => map.neighbors(map.start()).next().into_iter().collect(),
            Objective::Isrs => {
                let near = map.distances(map.start()).filter(|&(_, steps)| steps <= 2).map(|(cell, _)| cell);
                near.filter(|&cell| !self.is_goal(map, cell)).collect()
            }
            _ => Vec::new(),
        };
        *text += "system World = grid {\n";
        for y in (0..size).rev() {
            let row = (0..size).map(|x| self.letter(map, &starts, Cell { x, y }));
            text.extend(["  \"", &row.collect::<String>(), "\"\n"]);
        }
        let (obstacle, edge) = match self {
            Objective::Drift => ("stay", "stay"),
            _ if self.crashes() => ("crash", "stay"),
            _ => ("undefined", "undefined"),
        };
        let _ = write!(text, "}} {{\n  obstacle {obstacle};\n  edge {edge};\n  absorb goal;\n");
        if matches!(self, Objective::Iso | Objective::Cso | Objective::Cso3 | Objective::Alibi) {
            text.push_str("  observe y;\n");
        }
        if matches!(self, Objective::Isr | Objective::Isrs) {
            let Cell { x, y } = map.start();
            let _ = writeln!(text, "  label first = x == {x} & y == {y};");
        }
        match self {
            Objective::Drift => drift(map, text),
            // Those of the paper begin anywhere, and so does the other path of opacity.
            _ if Objective::PAPER.contains(&self) => {}
            _ => text.push_str("  init start;\n"),
        }
        text.push_str("}\n\n");
    }

    fn letter(self, map: &Map, starts: &[Cell], cell: Cell) -> char {
        match () {
            () if map.is_obstacle(cell) => '#',
            () if cell == map.start() || starts.contains(&cell) => 'S',
            () if self.is_goal(map, cell) => 'G',
            () => '.',
        }
    }

    /// Whether a free cell is a goal, unless it is a start.
    fn is_goal(self, map: &Map, cell: Cell) -> bool {
        let goal = map.goal();
        let reach = match self {
            Objective::Sp => 0,
            Objective::Ar2 | Objective::Ars => 2,
            _ => 1,
        };
        goal.x.abs_diff(cell.x) <= reach && goal.y.abs_diff(cell.y) <= reach
    }

    /// Fewer steps than this are not tried in search of the least horizon, as they cannot be enough.
    #[must_use]
    pub fn least_steps(self, map: &Map) -> u32 {
        match self {
            // The template asks about two steps in succession.
            Objective::Ars => 2,
            Objective::Roads => roads::Roads::new(map.parameters()).shortest(),
            _ => 1,
        }
    }

    /// More steps than this are not tried in search of the least horizon.
    #[must_use]
    pub fn most_steps(self, map: &Map) -> u32 {
        match self {
            Objective::Sp => map.distance(),
            Objective::Ar2 | Objective::Ars | Objective::Drift => 2 * map.distance() + 8,
            Objective::Locks => locks::most_steps(map.parameters()),
            Objective::Roads => roads::Roads::new(map.parameters()).most(),
            _ => 2 * map.distance() + 4,
        }
        .max(self.least_steps(map))
    }
}

const AR2: &str = "\
objective ar2 within T {
  define none(p, q) = G action[p] == action[q];
  define one(p, q) = G (action[p] != action[q] -> N none(p, q));
  define two(p, q) = G (action[p] != action[q] -> N one(p, q));
  exists p. forall q.
    start[p] & (!crash[p] U[0,T] goal[p]) & (start[q] & two(p, q) -> (!crash[q] U[0,T] goal[q]))
}";

const DRIFT: &str = "\
objective drift {
  exists p. forall q.
    start[p] & F[0,T] goal[p] & (start[q] & G[0,T] action[p] == action[q] -> F[0,T] goal[q])
}";

const CSO3: &str = "\
objective cso3 {
  define seen(p, q) = state[p] == state[q] & G[0,T] obs[p] == obs[q];
  define elsewhere(p, q) = F[0,T] state[p] != state[q];
  exists p, q, r.
    start[p] & seen(p, q) & seen(p, r) & F[0,T] goal[p] & F[0,T] goal[q] & F[0,T] goal[r]
    & elsewhere(p, q) & elsewhere(p, r) & elsewhere(q, r)
}";

const ALIBI: &str = "\
objective alibi {
  define like(q, p) = start[q] & G[0,T] obs[q] == obs[p] & F[0,T] goal[q];
  exists p. forall q. exists r.
    start[p] & F[0,T] goal[p] & (like(q, p) -> like(r, p) & F[0,T] state[r] != state[q])
}";

/// That the robot, up to twice, drifts to the right instead of moving, where there is room.
fn drift(map: &Map, text: &mut String) {
    let size = map.parameters().size;
    let cells = (0..size * size).map(|i| Cell { x: i % size, y: i / size });
    let room =
        cells.filter(|&cell| !map.is_obstacle(cell) && !map.is_obstacle(Cell { x: cell.x + 1, ..cell }));
    let room: Vec<String> = room.map(|Cell { x, y }| format!("({x}, {y})")).collect();
    text.push_str("  state drifts: 0..2;\n");
    if !room.is_empty() {
        let room = room.join(", ");
        let _ = writeln!(
            text,
            "  on * when drifts < 2 & (x, y) in {{{room}}} {{ x' = x + 1; drifts' = drifts + 1; }}"
        );
    }
    text.push_str("  init start & drifts == 0;\n");
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Objective {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Objective::ALL.into_iter().find(|objective| objective.name() == text);
        found.ok_or_else(|| {
            format!(
                "`{text}` is no objective; expected one of {}",
                Objective::ALL.map(Objective::name).join(", ")
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_problem::{NoFiles, Overrides, read};
    use hyperplan_syntax::SourceMap;

    fn map(size: u32, density: u32, seed: u64) -> Map {
        Map::random(Parameters { size, density, seed, kind: Kind::Random }).expect("there is room")
    }

    #[test]
    fn problems_are_without_fault() {
        for (size, density) in [(3, 0), (3, 30), (6, 20), (12, 40)] {
            for objective in Objective::ALL {
                for seed in 0..10 {
                    let map = map(size, density, seed);
                    assert!(objective.least_steps(&map) <= objective.most_steps(&map));
                    let text = objective.problem(&map, objective.least_steps(&map).max(5));
                    let mut sources = SourceMap::new();
                    let lowered = read(&mut sources, "p.hp", &text, &NoFiles, &Overrides::default());
                    assert!(lowered.diagnostics.is_empty(), "{text}\n{:?}", lowered.diagnostics);
                    assert!(lowered.problem.objective(objective.name()).is_some());
                }
            }
        }
    }

    /// The very text, so that a change of the generator is seen: it makes other benchmarks.
    #[test]
    fn a_problem_is_the_same_for_ever() {
        let expected = r##"// The actions of p also lead from the other start to a goal, past all obstacles.
// A random map: size 6, 20 % obstacles, seed 0.
const T = 9;

system World = grid {
  "#.#..."
  "..SS#."
  ".#...."
  "#.GGG."
  "..GGG."
  "#.G#G."
} {
  obstacle crash;
  edge stay;
  absorb goal;
  label first = x == 3 & y == 4;
}

objective isr = initial_state_robust(first, start, goal, crash, T);
"##;
        assert_eq!(Objective::Isr.problem(&map(6, 20, 0), 9), expected);
    }

    #[test]
    fn names_are_read_as_they_are_written() {
        for objective in Objective::ALL {
            assert_eq!(objective.to_string().parse(), Ok(objective));
        }
        assert!("SP".parse::<Objective>().is_err());
    }
}
