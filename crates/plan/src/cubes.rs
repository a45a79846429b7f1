//! An objective in cases by the first actions of its leading paths, for searches side by side (cube and conquer: Heule,
//! Kullmann, Wieringa and Biere 2011, who choose by lookahead; here the choices are those that come first in time).
//!
//! Under `exists` a case asks for a strategy that begins so: the objective is realizable if one case is. Under `forall` it
//! speaks of the paths that begin so only: the objective is realizable if all cases are. Every path has taken exactly one
//! action of its system at each time from 1 to its horizon, so the cases leave nothing out; no horizon grows by
//! what a case says, as it says nothing of later times.

use hyperplan_horizon::horizons;
use hyperplan_problem::{
    ActionId, Expr, Formula, FormulaId, Node, Objective, PathId, PathLeaf, Problem, Quantifier,
};

/// The first actions of some paths of the leading block, from the first step on.
pub type Cube = Vec<(PathId, Vec<ActionId>)>;

/// At least so many cases, if the horizons allow it: by the actions of all leading paths in the first step, then in the
/// second, as often as needed. One case is the objective itself.
#[must_use]
pub fn cubes(problem: &Problem, objective: &Objective, at_least: usize) -> Vec<Cube> {
    let horizons = horizons(objective);
    let mut cubes: Vec<Cube> = vec![Vec::new()];
    let leading = objective.leading_block();
    let longest = leading.iter().filter_map(|&path| horizons[path].steps).max().unwrap_or(0);
    for time in 1..=longest {
        for &path in &leading {
            if cubes.len() >= at_least {
                return cubes;
            }
            if horizons[path].steps.is_some_and(|steps| time <= steps) {
                let actions = &problem.systems[objective.paths[path].system].actions;
                cubes = cubes.iter().flat_map(|cube| actions.iter().map(|&a| with(cube, path, a))).collect();
            }
        }
    }
    cubes
}

/// A case in which that path takes one more action.
fn with(cube: &Cube, path: PathId, action: ActionId) -> Cube {
    let mut cube = cube.clone();
    match cube.iter_mut().find(|(of, _)| *of == path) {
        Some((_, actions)) => actions.push(action),
        None => cube.push((path, vec![action])),
    }
    cube
}

/// The objective in one case.
#[must_use]
pub fn within(objective: &Objective, cube: &Cube) -> Objective {
    let mut objective = objective.clone();
    let formula = &mut objective.formula;
    let root = formula.root();
    let mut taken: Vec<FormulaId> = Vec::new();
    for (path, actions) in cube {
        for (step, &action) in actions.iter().enumerate() {
            taken.push(takes(formula, *path, action, step + 1));
        }
    }
    let span = objective.span;
    match objective.paths.first().map(|path| path.quantifier) {
        Some(Quantifier::Forall) => {
            let all = formula.push(Node::And(taken), span);
            let other = formula.push(Node::Not(all), span);
            formula.push(Node::Or(vec![other, root]), span);
        }
        _ => {
            taken.push(root);
            formula.push(Node::And(taken), span);
        }
    }
    objective
}

/// That a path has taken an action at a time, which is one of its horizon.
fn takes(formula: &mut Formula, path: PathId, action: ActionId, time: usize) -> FormulaId {
    let span = formula.spans[formula.root()];
    let atom = formula.push(Node::Atom(Expr::Leaf(PathLeaf::Took(path, action))), span);
    (0..time).fold(atom, |now, _| formula.push(Node::Next(now), span))
}
