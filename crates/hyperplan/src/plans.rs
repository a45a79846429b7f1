//! Plans for other programs: what of them is told, and in which files.

use crate::failure::{Failure, Result};
use hyperplan_problem::answer::WitnessPath;
use hyperplan_problem::answer::plans::{PlanError, PlanFormat};
use hyperplan_problem::{Expr, Node, Objective, PathLeaf, Problem, Strategy, System};
use hyperplan_render::steps_to_rest;
use hyperplan_verify::{Budget, Check, check, complete};
use std::path::{Path, PathBuf};

/// The strategy without what comes after its paths were absorbed. Where the objective reads actions, those may matter still,
/// to paths that were not; then nothing is cut that the checker would miss.
pub(crate) fn without_rest(problem: &Problem, objective: &Objective, strategy: &Strategy) -> Strategy {
    let mut cut = strategy.clone();
    for trace in &mut cut.traces {
        let steps = steps_to_rest(problem, objective, trace);
        trace.actions.truncate(steps);
        trace.states.truncate(steps + 1);
    }
    if cut == *strategy || !reads_actions(objective) {
        return cut;
    }
    let mut whole = cut.clone();
    let completed = complete(problem, objective, &mut whole, &Budget::default()).is_ok();
    let good = completed && matches!(check(problem, objective, &whole, &Budget::default()), Ok(Check::Holds));
    if good { cut } else { strategy.clone() }
}

fn reads_actions(objective: &Objective) -> bool {
    objective.formula.nodes.iter().any(|node| {
        let mut found = false;
        if let Node::Atom(atom) = node {
            let atom: &Expr<PathLeaf> = atom;
            atom.for_each_leaf(&mut |leaf| {
                found |= matches!(leaf, PathLeaf::Took(..) | PathLeaf::SameAction(..));
            });
        }
        found
    })
}

/// Refuses what could not be written after all the work: messages of ROS are places, and not all systems have some.
pub(crate) fn check_format(format: PlanFormat, problem: &Problem, objective: &Objective) -> Result<()> {
    let systems =
        objective.leading_block().into_iter().map(|path| &problem.systems[objective.paths[path].system]);
    let nowhere = |system: &&System| {
        system.coordinates.is_none() && system.map.as_ref().is_none_or(|map| map.place.is_none())
    };
    match systems.into_iter().find(nowhere) {
        Some(system) if format == PlanFormat::Ros => Err(cannot(&PlanError::NoPlace(system.name.clone()))),
        _ => Ok(()),
    }
}

/// The failure to write a strategy in a format.
pub(crate) fn cannot(error: &PlanError) -> Failure {
    Failure::input(format_args!("the strategy cannot be written so: {error}"))
}

/// The files for the paths of a strategy: one each where there are several, with its name before the extension.
pub(crate) fn files(path: &Path, paths: &[WitnessPath]) -> Vec<PathBuf> {
    if paths.len() == 1 {
        return vec![path.to_owned()];
    }
    paths.iter().map(|own| with_name(path, &own.path)).collect()
}

/// The file with a name before its extension.
pub(crate) fn with_name(path: &Path, name: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{name}.{extension}"))
}
