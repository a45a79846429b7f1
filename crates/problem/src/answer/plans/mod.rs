//! Plans as other programs read them: tables, messages of ROS, geometries, plans in PDDL; and back from those that have the
//! actions.

mod geojson;
mod pddl;
mod ros;
mod table;

pub use pddl::meant;

use super::{Scalar, StrategyFile, WitnessPath};
use std::path::Path;
use thiserror::Error;

/// How a plan is written for others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlanFormat {
    /// A table: a row a step.
    Csv,
    /// `nav_msgs/Path` messages of ROS, as YAML.
    Ros,
    /// A line for each path, with its actions and states.
    Geojson,
    /// Actions as VAL reads them.
    Pddl,
}

/// Why a plan cannot be written in a format.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum PlanError {
    /// Messages of ROS have places only.
    #[error(
        "system {0} does not say where it lies; a map of ROS with a `resolution` does, and a graph with coordinates"
    )]
    NoPlace(String),
    /// PDDL knows few characters.
    #[error("`{0}` and `{1}` are both `{2}` in PDDL")]
    OneName(String, String, String),
    /// A library failed.
    #[error("{0}")]
    Failed(String),
}

impl PlanFormat {
    /// By how the name of a file ends; none for JSON.
    #[must_use]
    pub fn of_file(path: &Path) -> Option<PlanFormat> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "csv" => Some(PlanFormat::Csv),
            "yaml" | "yml" => Some(PlanFormat::Ros),
            "geojson" => Some(PlanFormat::Geojson),
            "pddl" | "plan" => Some(PlanFormat::Pddl),
            _ => None,
        }
    }

    /// The text for some paths of an objective.
    ///
    /// # Errors
    /// If the format cannot say what they are.
    pub fn write(self, objective: &str, paths: &[WitnessPath]) -> Result<String, PlanError> {
        match self {
            PlanFormat::Csv => table::write(paths),
            PlanFormat::Ros => ros::write(paths),
            PlanFormat::Geojson => geojson::write(objective, paths),
            PlanFormat::Pddl => pddl::write(paths),
        }
    }
}

/// The strategies of a text in one of these formats, or in JSON.
///
/// # Errors
/// If it is none; the words go behind the name of the file.
pub fn read(text: &str) -> Result<Vec<StrategyFile>, String> {
    let head = text.trim_start();
    let first = head.lines().next().unwrap_or_default();
    let with = |witness| vec![StrategyFile { objective: None, verdict: None, witness: Some(witness) }];
    if head.starts_with('{') {
        return match geojson::read(head) {
            Some(found) => found.map(|one| vec![one]),
            None => StrategyFile::read_all(text).map_err(|e| e.to_string()),
        };
    }
    if table::is_head(first) {
        return table::read(head).map(with);
    }
    if pddl::is_line(first) {
        return pddl::read(head).map(with);
    }
    StrategyFile::read_all(text).map_err(|e| e.to_string())
}

/// Where a path is at each time: in the plane if its system says so, else by its numbers `x` and `y`.
fn points(path: &WitnessPath) -> Option<Vec<(f64, f64)>> {
    if let Some(positions) = &path.positions {
        return Some(positions.clone());
    }
    let number = |scalar: &Scalar| match scalar {
        Scalar::Int(n) => Some(*n as f64),
        Scalar::Decimal(x) => Some(*x),
        _ => None,
    };
    path.states.iter().map(|state| Some((number(state.get("x")?)?, number(state.get("y")?)?))).collect()
}
