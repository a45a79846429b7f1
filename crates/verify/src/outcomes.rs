//! Whether a strategy depends on outcomes that its actions might not have.

use crate::check::decide;
use crate::graph::Graph;
use crate::report::{Budget, Error, Stop};
use hyperplan_problem::{
    Comparison, Expr, FormulaId, Interval, Leaf, Node, Objective, PathId, PathLeaf, Problem, Quantifier,
    Strategy, Trace, Value, VarId,
};

/// Whether the objective also holds if the actions of the paths `of` have any other outcomes, from the same first states:
/// each of them then becomes universal among the paths with its first state and its actions. `None` where that is not to be
/// had within the budget.
///
/// # Errors
/// If the problem is malformed.
pub fn holds_for_all_outcomes(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    of: &[PathId],
    budget: &Budget,
) -> Result<Option<bool>, Error> {
    for trace in strategy.traces.iter().filter(|trace| of.contains(&trace.path)) {
        match can_always_act(problem, objective, trace, budget) {
            Ok(true) => {}
            Ok(false) => return Ok(Some(false)),
            Err(Stop::Budget) => return Ok(None),
            Err(Stop::Error(error)) => return Err(error),
        }
    }
    decide(problem, &pinned(problem, objective, strategy, of), budget)
}

/// Whether each action can be taken whatever came of those before. A path on which one cannot be is none, and a universal
/// quantifier would pass over it.
fn can_always_act(
    problem: &Problem,
    objective: &Objective,
    trace: &Trace,
    budget: &Budget,
) -> Result<bool, Stop> {
    let limit = usize::try_from(budget.states).unwrap_or(usize::MAX);
    let mut moves = 0;
    let mut graph = Graph::new(&problem.systems[objective.paths[trace.path].system], limit);
    let mut here = match trace.states.first() {
        Some(first) if graph.is_state(first) => vec![graph.intern(first)?],
        _ => return Ok(false),
    };
    for action in &trace.actions {
        let mut next = Vec::new();
        for state in here {
            let after = graph.after(state, *action)?;
            moves += after.len() as u64;
            if moves > budget.moves {
                return Err(Stop::Budget);
            }
            if after.is_empty() {
                return Ok(false);
            }
            next.extend(after);
        }
        next.sort_unstable();
        next.dedup();
        here = next;
    }
    Ok(true)
}

/// The objective with its leading block universal, over the paths that agree with the strategy: those `of` in their first
/// state and their actions, the others in all.
fn pinned(problem: &Problem, objective: &Objective, strategy: &Strategy, of: &[PathId]) -> Objective {
    let mut pinned = objective.clone();
    let root = pinned.formula.root();
    let mut parts = vec![root];
    for trace in &strategy.traces {
        pinned.paths[trace.path].quantifier = Quantifier::Forall;
        let variables = problem.systems[objective.paths[trace.path].system].vars.keys();
        let states = if of.contains(&trace.path) { 1 } else { trace.states.len() };
        for (time, state) in trace.states.iter().enumerate() {
            let mut agrees = Vec::new();
            if time < states {
                agrees.extend(variables.clone().map(|var| is(trace.path, var, state[usize::from(var)])));
            }
            let took = time.checked_sub(1).and_then(|step| trace.actions.get(step));
            agrees.extend(took.map(|&action| Expr::Leaf(PathLeaf::Took(trace.path, action))));
            parts.push(differs_at(&mut pinned, time, agrees));
        }
    }
    pinned.formula.push(Node::Or(parts), objective.span);
    pinned
}

pub(crate) fn is(path: PathId, var: VarId, value: Value) -> Expr<PathLeaf> {
    let leaf = Expr::Leaf(PathLeaf::State(path, Leaf::Var(var)));
    match value {
        Value::Bool(true) => leaf,
        Value::Bool(false) => Expr::Not(Box::new(leaf)),
        value => Expr::Compare(Comparison::Eq, Box::new(leaf), Box::new(Expr::Const(value))),
    }
}

/// That some of these are false at a time.
pub(crate) fn differs_at(objective: &mut Objective, time: usize, agrees: Vec<Expr<PathLeaf>>) -> FormulaId {
    let span = objective.span;
    let formula = &mut objective.formula;
    let atom = formula.push(Node::Atom(Expr::Not(Box::new(Expr::And(agrees)))), span);
    let always = formula.push(Node::And(Vec::new()), span);
    let time = u32::try_from(time).unwrap_or(u32::MAX);
    formula.push(Node::Until(Interval { lo: time, hi: Some(time) }, always, atom), span)
}
