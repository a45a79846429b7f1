//! The objectives of the paper, on a map.

use crate::map::{Cell, Map};
use serde::{Deserialize, Serialize};
use std::fmt::{self, Write as _};
use std::str::FromStr;

/// An objective of "Hyperproperties for Robotics: Planning via HyperLTL" (Wang, Nalluri, Pajic; ICRA 2020), as the
/// prelude has it.
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
}

impl Objective {
    /// All of them.
    pub const ALL: [Objective; 5] =
        [Objective::Sp, Objective::Isr, Objective::Ar, Objective::Iso, Objective::Cso];

    /// Its short name, which is also that of the objective in a problem.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Objective::Sp => "sp",
            Objective::Isr => "isr",
            Objective::Ar => "ar",
            Objective::Iso => "iso",
            Objective::Cso => "cso",
        }
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
        }
    }

    /// The problem on a map within so many steps, as a problem file.
    ///
    /// As in the paper's case studies, obstacles cannot be entered where paths are compared or hidden, and crash where
    /// they have to be robust; a goal is never left. The shortest path has one cell for its goal, the others also the
    /// free cells around it; a robust path has a second start, a free cell next to the first.
    #[must_use]
    pub fn problem(self, map: &Map, steps: u32) -> String {
        let crash = matches!(self, Objective::Isr | Objective::Ar);
        let hidden = matches!(self, Objective::Iso | Objective::Cso);
        let second = (self == Objective::Isr).then(|| map.neighbors(map.start()).next()).flatten();
        let parameters = map.parameters();
        let mut text = format!(
            "// {}\n// A random map: size {}, {} % obstacles, seed {}.\nconst T = {steps};\n\nsystem World = grid {{\n",
            self.title(),
            parameters.size,
            parameters.density,
            parameters.seed,
        );
        for y in (0..parameters.size).rev() {
            let row = (0..parameters.size).map(|x| self.letter(map, second, Cell { x, y }));
            text.extend(["  \"", &row.collect::<String>(), "\"\n"]);
        }
        let (obstacle, edge) = if crash { ("crash", "stay") } else { ("undefined", "undefined") };
        let _ = write!(text, "}} {{\n  obstacle {obstacle};\n  edge {edge};\n  absorb goal;\n");
        if hidden {
            text.push_str("  observe y;\n");
        }
        if second.is_some() {
            let Cell { x, y } = map.start();
            let _ = writeln!(text, "  label first = x == {x} & y == {y};");
        }
        text.extend(["}\n\n", self.declaration(), "\n"]);
        text
    }

    fn letter(self, map: &Map, second: Option<Cell>, cell: Cell) -> char {
        let goal = map.goal();
        let near = goal.x.abs_diff(cell.x) <= 1 && goal.y.abs_diff(cell.y) <= 1;
        match () {
            () if map.is_obstacle(cell) => '#',
            () if cell == map.start() || Some(cell) == second => 'S',
            () if cell == goal || (near && self != Objective::Sp) => 'G',
            () => '.',
        }
    }

    /// More steps than this are not tried in search of the least horizon.
    #[must_use]
    pub fn most_steps(self, map: &Map) -> u32 {
        match self {
            Objective::Sp => map.distance(),
            _ => 2 * map.distance() + 4,
        }
    }
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
        found.ok_or_else(|| format!("`{text}` is no objective; expected sp, isr, ar, iso or cso"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Parameters;
    use hyperplan_problem::{NoFiles, Overrides, read};
    use hyperplan_syntax::SourceMap;

    fn map(size: u32, density: u32, seed: u64) -> Map {
        Map::random(Parameters { size, density, seed }).expect("there is room")
    }

    #[test]
    fn problems_are_without_fault() {
        for (size, density) in [(3, 0), (3, 30), (6, 20), (12, 40)] {
            for objective in Objective::ALL {
                for seed in 0..10 {
                    let text = objective.problem(&map(size, density, seed), 5);
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
