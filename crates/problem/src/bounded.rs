//! Objectives of which the costs are bounded.

use crate::expr::{Comparison, Expr, Leaf, PathLeaf, Value};
use crate::formula::{Interval, Node};
use crate::ids::{CostId, PathId, SystemId};
use crate::objective::Objective;
use crate::problem::Problem;
use crate::sums::{add_sum, same_state};
use crate::target::Target;
use hyperplan_syntax::ast::UnaryOp;
use rustc_hash::FxHashMap;

/// The objective with some paths read at a time too, where nothing is said of them: so that they have so many steps.
#[must_use]
pub fn extended(problem: &Problem, objective: &Objective, paths: &[PathId], time: u32) -> Objective {
    let mut objective = objective.clone();
    let (formula, span) = (&mut objective.formula, objective.span);
    let mut parts = vec![formula.root()];
    for &path in paths {
        let action = problem.systems[objective.paths[path].system].actions.first();
        let took = |action| Expr::Leaf(PathLeaf::Took(path, action));
        let always = action.map(|&action| Expr::Or(vec![took(action), Expr::Not(Box::new(took(action)))]));
        let atom = formula.push(Node::Atom(always.unwrap_or(Expr::TRUE)), span);
        parts.push(formula.unary(UnaryOp::Finally, Interval { lo: time, hi: Some(time) }, atom, span));
    }
    formula.push(Node::And(parts), span);
    objective
}

/// The objective with the demand that targets are at most so large after `time` steps. The paths of which they speak get
/// systems with the sums of their costs, behind all others; each state of these begins with one of the system before.
#[must_use]
pub fn bounded(
    problem: &Problem,
    objective: &Objective,
    bounds: &[(Target, i64)],
    time: u32,
) -> (Problem, Objective) {
    let (mut problem, mut objective) = (problem.clone(), objective.clone());
    let terms = || {
        bounds
            .iter()
            .flat_map(|(target, bound)| target.terms.iter().map(move |term| (term, bound - target.constant)))
    };
    let mut sums: Vec<(PathId, CostId)> = terms().map(|(&(_, path, cost), _)| (path, cost)).collect();
    sums.sort_unstable();
    sums.dedup();
    let mut vars = FxHashMap::default();
    let mut changed: Vec<(PathId, SystemId)> = Vec::new();
    for own in sums.chunk_by(|a, b| a.0 == b.0) {
        let path = own[0].0;
        let before = objective.paths[path].system;
        let mut system = problem.systems[before].clone();
        system.base.get_or_insert(before);
        for &(_, cost) in own {
            let same = terms().filter(|((_, p, c), _)| (*p, *c) == (path, cost));
            let caps = same.map(|((factor, ..), bound)| bound.max(0) / factor + 1);
            let reached = system.costs[cost].most.saturating_mul(i64::from(time));
            let cap = caps.max().unwrap_or(0).min(reached.saturating_add(1));
            vars.insert((path, cost), add_sum(&mut system, cost, cap));
        }
        changed.push((path, before));
        let known = problem.systems.iter_enumerated().find(|(_, other)| **other == system).map(|(id, _)| id);
        objective.paths[path].system = known.unwrap_or_else(|| problem.systems.push_and_get_key(system));
    }
    let formula = &mut objective.formula;
    let moved = |path: PathId| changed.iter().find(|(p, _)| *p == path).map(|(_, system)| *system);
    for node in &mut formula.nodes {
        if let Node::Atom(e) = node {
            *e = e.substitute(&mut |leaf| match *leaf {
                PathLeaf::SameState(p, q) => match moved(p).or(moved(q)) {
                    Some(system) => same_state(&problem.systems[system], p, q),
                    None => Expr::Leaf(*leaf),
                },
                leaf => Expr::Leaf(leaf),
            });
        }
    }
    let mut parts = vec![formula.root()];
    for (target, bound) in bounds {
        let left = bound - target.constant;
        let sum = |&(factor, path, cost): &(i64, PathId, CostId)| {
            let var = vars.get(&(path, cost)).copied()?;
            Some(Expr::Mul(factor, Box::new(Expr::Leaf(PathLeaf::State(path, Leaf::Var(var))))))
        };
        let sum = Expr::Add(target.terms.iter().filter_map(sum).collect());
        let small = Expr::Compare(Comparison::Le, Box::new(sum), Box::new(Expr::Const(Value::Int(left))));
        let atom = formula.push(Node::Atom(if left < 0 { Expr::FALSE } else { small }), objective.span);
        // Sums do not fall, so this says the same at every time; and what is too much already need not be gone on with.
        let always = Interval { lo: 0, hi: Some(time) };
        parts.push(formula.unary(UnaryOp::Globally, always, atom, objective.span));
    }
    formula.push(Node::And(parts), objective.span);
    (problem, objective)
}
