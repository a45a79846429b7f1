//! Which instances there are.

use crate::map::{Map, MapError, Parameters};
use crate::objective::Objective;
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

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Parameters { size, density, seed } = self.map;
        write!(f, "{}-{size}x{size}-d{density}-s{seed}", self.objective)
    }
}

/// Sizes, densities, seeds, objectives and horizons, each combined with each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Family {
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
            self.densities.iter().flat_map(move |&density| {
                self.seeds.iter().map(move |&seed| Parameters { size, density, seed })
            })
        })
    }

    /// All cases, small maps first.
    pub fn cases(&self) -> impl Iterator<Item = Case> {
        self.maps().flat_map(|map| self.objectives.iter().map(move |&objective| Case { objective, map }))
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
    fn horizons_are_about_the_least() {
        let family = family();
        let map = Map::random(Parameters { size: 6, density: 0, seed: 0 }).expect("there is room");
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
