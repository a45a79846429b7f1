//! An objective in cases of its leading paths, for searches side by side (cube and conquer: Heule, Kullmann, Wieringa and Biere 2011).
//!
//! Under `exists` a case asks for a strategy that is in it: the objective is realizable if one case is. Under `forall` it
//! speaks of the paths that are in it only: the objective is realizable if all cases are. So a verdict counts where one case
//! decides, and else all cases have to be decided.
//!
//! Where states are written one by one, a case is where paths are at some times, chosen by lookahead, and the searches look at nothing else
//! ([`Case`]). Where they are not, or where paths differ by their actions only, a case is what paths do first: every path
//! has taken exactly one action of its system at each time from 1 to its horizon, so the cases leave nothing out; no horizon
//! grows by what a case says, as it says nothing of later times.

use crate::config::Config;
use crate::fact::Error;
use crate::prepare::{decided, is_existential};
use hyperplan_encode::{self as encode, Among, Case, Encoder, Goal};
use hyperplan_horizon::horizons;
use hyperplan_problem::{
    ActionId, Expr, Formula, FormulaId, Node, Objective, PathId, PathLeaf, Problem, Quantifier,
};
use std::collections::VecDeque;

/// The objective in one of so many cases, by its number from 0, and how to search then. The same arguments give the same case,
/// whatever the deadline, unless it ends this; some cases may have nothing in them.
///
/// # Errors
/// As of [`crate::solve()`].
pub fn case(
    problem: &Problem,
    objective: &Objective,
    (index, number): (usize, usize),
    config: &Config,
) -> Result<(Objective, Config), Error> {
    if number < 2 {
        return Ok((objective.clone(), config.clone()));
    }
    let stop = || config.deadline.passed();
    let encoder = Encoder::sharing(problem, objective, config.states, config.limits, &stop, &config.graphs)?;
    let goal = Goal::new(&objective.formula, is_existential(objective));
    let nothing = || objective.paths.first().map(|path| decided(objective, path.quantifier));
    let own = match encoder.writer.case(&objective.leading_block(), &goal, (index, number)) {
        Ok(Case::Of(cube)) => {
            let among = Among { cube, ..config.among.clone() };
            return Ok((objective.clone(), Config { among, ..config.clone() }));
        }
        Ok(Case::Empty) => nothing(),
        // What is too large is searched by variables.
        Ok(Case::Whole) | Err(encode::Error::TooLarge { .. }) => {
            match by_actions(problem, objective, number).get(index) {
                Some(taken) => Some(taking(objective, taken)),
                None => nothing(),
            }
        }
        Err(error) => return Err(error.into()),
    };
    Ok((own.unwrap_or_else(|| objective.clone()), config.clone()))
}

/// That a path has taken one of these actions at a time, which is one of its horizon.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Taken {
    time: u64,
    path: PathId,
    actions: Vec<ActionId>,
}

/// By the actions of the leading paths in the first step, then in the second, as far as need be: the first case that can be is cut in
/// two, by the first actions of which it has several.
fn by_actions(problem: &Problem, objective: &Objective, number: usize) -> Vec<Vec<Taken>> {
    let horizons = horizons(objective);
    let leading = objective.leading_block();
    let longest = leading.iter().filter_map(|&path| horizons[path].steps).max().unwrap_or(0);
    let actions = |path: PathId| &problem.systems[objective.paths[path].system].actions;
    // Steps at which there is something to choose.
    let open = |(time, path): &(u64, PathId)| {
        horizons[*path].steps.is_some_and(|steps| *time <= steps) && actions(*path).len() > 1
    };
    let steps = || (1..=longest).flat_map(|time| leading.iter().map(move |&path| (time, path))).filter(open);
    let mut cubes = VecDeque::from([Vec::<Vec<ActionId>>::new()]);
    let mut whole = Vec::new();
    while cubes.len() + whole.len() < number {
        let Some(mut cube) = cubes.pop_front() else { break };
        if cube.last().is_none_or(|actions| actions.len() < 2) {
            match steps().nth(cube.len()) {
                Some((_, path)) => cube.push(actions(path).clone()),
                None => {
                    whole.push(cube);
                    continue;
                }
            }
        }
        let mut other = cube.clone();
        if let (Some(first), Some(second)) = (cube.last_mut(), other.last_mut()) {
            let middle = first.len() / 2;
            first.truncate(middle);
            second.drain(..middle);
        }
        cubes.extend([cube, other]);
    }
    let taken = |cube: Vec<Vec<ActionId>>| {
        steps().zip(cube).map(|((time, path), actions)| Taken { time, path, actions }).collect()
    };
    whole.into_iter().chain(cubes).map(taken).collect()
}

/// The objective of paths that have taken these actions.
fn taking(objective: &Objective, taken: &[Taken]) -> Objective {
    let mut objective = objective.clone();
    let (formula, span) = (&mut objective.formula, objective.span);
    let root = formula.root();
    let mut all: Vec<FormulaId> = taken.iter().map(|step| step.of(formula)).collect();
    match objective.paths.first().map(|path| path.quantifier) {
        Some(Quantifier::Forall) => {
            let all = formula.push(Node::And(all), span);
            let other = formula.push(Node::Not(all), span);
            formula.push(Node::Or(vec![other, root]), span);
        }
        _ => {
            all.push(root);
            formula.push(Node::And(all), span);
        }
    }
    objective
}

impl Taken {
    /// As a formula.
    fn of(&self, formula: &mut Formula) -> FormulaId {
        let span = formula.spans[formula.root()];
        let atom = |&action| Node::Atom(Expr::Leaf(PathLeaf::Took(self.path, action)));
        let each = self.actions.iter().map(|action| formula.push(atom(action), span)).collect();
        let any = formula.push(Node::Or(each), span);
        (0..self.time).fold(any, |now, _| formula.push(Node::Next(now), span))
    }
}
