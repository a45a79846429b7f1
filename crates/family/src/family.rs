//! Which instances there are.

use crate::map::{Map, MapError};
use crate::objective::Objective;
use crate::parameters::{Kind, Parameters};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A horizon, relative to the least with which an objective is realizable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Horizon {
    /// One less: the last that is unrealizable.
    Below,
    /// The least.
    Least,
    /// One more.
    Above,
    /// Twice the least.
    Double,
    /// The most steps that were tried, where none of them is enough.
    Never,
}

impl Horizon {
    /// Those that may be asked for.
    pub const ALL: [Horizon; 4] = [Horizon::Below, Horizon::Least, Horizon::Above, Horizon::Double];

    fn steps(self, least: u32) -> Option<u32> {
        match self {
            Horizon::Below => least.checked_sub(1).filter(|&steps| steps > 0),
            Horizon::Least | Horizon::Never => Some(least),
            Horizon::Above => least.checked_add(1),
            Horizon::Double => least.checked_mul(2),
        }
    }
}

impl fmt::Display for Horizon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

impl FromStr for Horizon {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Horizon::ALL.into_iter().find(|horizon| horizon.to_string() == text);
        found.ok_or_else(|| format!("`{text}` is no horizon; expected below, least, above or double"))
    }
}

/// An objective on a random map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Case {
    /// The objective.
    pub objective: Objective,
    /// The map's parameters.
    #[serde(flatten)]
    pub map: Parameters,
}

impl Case {
    /// Where its difficulty comes from: the objective, and the kind of map.
    #[must_use]
    pub fn source(&self) -> String {
        match self.map.kind {
            Kind::Random => self.objective.to_string(),
            kind => format!("{}-{kind}", self.objective),
        }
    }

    /// How large it is, as a folder is called.
    #[must_use]
    pub fn size(&self) -> String {
        let size = self.map.size;
        if self.objective.has_map() { format!("{size}x{size}") } else { size.to_string() }
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Parameters { density, seed, .. } = self.map;
        let density = if self.objective.has_map() { format!("-d{density}") } else { String::new() };
        write!(f, "{}-{}{density}-s{seed}", self.source(), self.size())
    }
}

/// Sizes, densities, seeds, objectives and horizons, each combined with each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Family {
    /// Kinds of maps.
    pub kinds: Vec<Kind>,
    /// Side lengths of maps.
    pub sizes: Vec<u32>,
    /// Shares of obstacles, in percent.
    pub densities: Vec<u32>,
    /// Seeds of maps.
    pub seeds: Vec<u64>,
    /// Objectives.
    pub objectives: Vec<Objective>,
    /// Horizons.
    pub horizons: Vec<Horizon>,
}

impl Family {
    /// Whether there are such maps.
    ///
    /// # Errors
    /// If a size or density is out of bounds.
    pub fn check(&self) -> Result<(), MapError> {
        self.maps().try_for_each(|map| map.check())
    }

    fn maps(&self) -> impl Iterator<Item = Parameters> {
        self.sizes.iter().flat_map(move |&size| {
            self.kinds.iter().flat_map(move |&kind| {
                self.densities.iter().flat_map(move |&density| {
                    self.seeds.iter().map(move |&seed| Parameters { kind, size, density, seed })
                })
            })
        })
    }

    /// All cases, small maps first. Of what is not about maps there is one for each size and seed.
    pub fn cases(&self) -> impl Iterator<Item = Case> {
        self.maps().flat_map(move |map| {
            let first = Some(&map.kind) == self.kinds.first() && Some(&map.density) == self.densities.first();
            self.objectives.iter().filter_map(move |&objective| match objective.has_map() {
                true => Some(Case { objective, map }),
                false => first
                    .then_some(Case { objective, map: Parameters { kind: Kind::Random, density: 0, ..map } }),
            })
        })
    }

    /// The horizons of a case, each number of steps once. Where no horizon is enough, the last one tried is all.
    #[must_use]
    pub fn horizons(&self, map: &Map, objective: Objective, least: Option<u32>) -> Vec<(Horizon, u32)> {
        let Some(least) = least else { return vec![(Horizon::Never, objective.most_steps(map))] };
        let mut found: Vec<(Horizon, u32)> = Vec::new();
        for &horizon in &self.horizons {
            if let Some(steps) = horizon.steps(least)
                && found.iter().all(|&(_, other)| other != steps)
            {
                found.push((horizon, steps));
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family() -> Family {
        Family {
            kinds: vec![Kind::Random],
            sizes: vec![4, 6],
            densities: vec![0, 10],
            seeds: vec![0, 1, 2],
            objectives: vec![Objective::Sp, Objective::Cso],
            horizons: Horizon::ALL.to_vec(),
        }
    }

    #[test]
    fn cases_are_all_combinations() {
        let names: Vec<String> = family().cases().map(|case| case.to_string()).collect();
        assert_eq!(names.len(), 24);
        assert_eq!([&names[0], &names[1], &names[23]], ["sp-4x4-d0-s0", "cso-4x4-d0-s0", "cso-6x6-d10-s2"]);
    }

    #[test]
    fn what_has_no_map_is_there_once() {
        let kinds = vec![Kind::Rooms, Kind::Maze];
        let family = Family { kinds, objectives: vec![Objective::Ar, Objective::Locks], ..family() };
        let names: Vec<String> = family.cases().map(|case| case.to_string()).collect();
        let locks: Vec<&String> = names.iter().filter(|name| name.starts_with("locks")).collect();
        assert_eq!(locks.len(), 6);
        assert_eq!(
            [locks[0], &names[0], &names[29]],
            ["locks-4-s0", "ar-rooms-4x4-d0-s0", "ar-maze-6x6-d10-s2"]
        );
    }

    #[test]
    fn horizons_are_about_the_least() {
        let family = family();
        let map = Map::random(Parameters { kind: Kind::Random, size: 6, density: 0, seed: 0 })
            .expect("there is room");
        let steps = |least| family.horizons(&map, Objective::Cso, least);
        assert_eq!(
            steps(Some(5)),
            [(Horizon::Below, 4), (Horizon::Least, 5), (Horizon::Above, 6), (Horizon::Double, 10)]
        );
        // No step twice, and none of none.
        assert_eq!(steps(Some(1)), [(Horizon::Least, 1), (Horizon::Above, 2)]);
        assert_eq!(steps(None), [(Horizon::Never, Objective::Cso.most_steps(&map))]);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        assert_eq!(family().check(), Ok(()));
        assert_eq!(Family { sizes: vec![4, 1], ..family() }.check(), Err(MapError::Size(1)));
        assert_eq!(Family { densities: vec![99], ..family() }.check(), Err(MapError::Density(99)));
    }
}
