//! Arguments of families of benchmarks.

use super::{Seeds, seeds};
use clap::Args;
use hyperplan_family as family;
use std::path::PathBuf;

/// A family of benchmarks, most of them on maps.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Families")]
pub(crate) struct Family {
    /// Writes a family of benchmarks into a directory, most of them on random maps, in the layout of SMT-LIB submissions; goes on
    /// where an earlier run stopped, and adds to what is there
    #[arg(long = "family", value_name = "DIR", conflicts_with_all = ["file", "set", "objective", "output", "each", "status"])]
    pub(crate) folder: Option<PathBuf>,
    /// Cells along a side of the maps
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_values_t = [4, 6], conflicts_with = "file")]
    pub(crate) sizes: Vec<u32>,
    /// Obstacles, in percent of the cells
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_values_t = [10, 20], conflicts_with = "file")]
    pub(crate) densities: Vec<u32>,
    /// Seeds of the maps: numbers and ranges, both ends included
    #[arg(long, value_name = "N|LO..HI,...", value_parser = seeds, default_value = "0..1", conflicts_with = "file")]
    pub(crate) seeds: Seeds,
    /// Kinds of maps: random, rooms, maze, aisles
    #[arg(long, value_name = "KIND,...", value_delimiter = ',', default_values_t = [family::Kind::Random], conflicts_with = "file")]
    pub(crate) maps: Vec<family::Kind>,
    /// Objectives: sp, isr, ar, iso, cso of the paper; isrs, ar2, ars, drift, cso3, alibi, locks, roads
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_values_t = family::Objective::PAPER,
        conflicts_with = "file")]
    pub(crate) objectives: Vec<family::Objective>,
    /// Horizons, by the least that is enough: below, least, above (by one), double
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_values_t = family::Horizon::ALL,
        conflicts_with = "file")]
    pub(crate) horizons: Vec<family::Horizon>,
    /// The name of the family
    #[arg(long, value_name = "NAME", default_value = "random-maps", conflicts_with = "file")]
    pub(crate) name: String,
    /// Who submits it
    #[arg(long, value_name = "NAME", default_value = "hyperplan", conflicts_with = "file")]
    pub(crate) submitter: String,
    /// Seconds to search for each least horizon and each status
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, conflicts_with = "file")]
    pub(crate) limit: f64,
    /// How many instances are worked on at a time [default: one a core]
    #[arg(long, value_name = "N", conflicts_with = "file")]
    pub(crate) jobs: Option<std::num::NonZeroUsize>,
    /// Then measures solvers on all of them, and chooses N by how hard they are, into DIR/selected
    #[arg(long, value_name = "N", requires = "folder", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) select: Option<u32>,
    /// The solvers that are measured [default: all that are installed]
    #[arg(long, value_name = "SOLVER,...", requires = "select", conflicts_with = "measured")]
    pub(crate) measure_by: Option<String>,
    /// Seconds for each run [default: 60]; with --measured: only runs with this limit count
    #[arg(long, value_name = "SECONDS", requires = "select")]
    pub(crate) measure_limit: Option<f64>,
    /// Makes and runs nothing, but chooses by these logs of `compare` among what is there
    #[arg(long, value_name = "LOG,...", value_delimiter = ',', requires = "select")]
    pub(crate) measured: Vec<PathBuf>,
    /// What all solvers do within so many seconds is easy: at most a tenth is
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, requires = "select")]
    pub(crate) easy: f64,
}
