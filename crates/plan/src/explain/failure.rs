//! How given paths fail: which part of the objective does, and when.

use super::asker::{Asker, needed};
use super::part::{first_paths, of_parts, pinned};
use crate::fact::Error;
use crate::lint::demand::paths as read_paths;
use crate::prepare::is_existential;
use hyperplan_problem::{
    ActionId, FormulaId, Node, Objective, PathId, PathLeaf, Problem, Quantifier, State, Strategy, Trace,
};
use hyperplan_verify::{self as verify, Budget, Check, Defeat};

/// A part of an objective that paths do not meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failing {
    /// The part: the smallest that is to blame.
    pub part: FormulaId,
    /// The first time at which the paths so far show it; `None` where it fails, with the others, whatever the paths are that are
    /// chosen after them.
    pub time: Option<u32>,
}

/// What a path of the other player does otherwise than the path whose actions it is compared with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The path.
    pub path: PathId,
    /// The other one.
    pub from: PathId,
    /// Where both begin, if not in the same state: of the path, of the other one.
    pub starts: Option<(State, State)>,
    /// Actions that differ until the part fails: the step, from 0; the action; that of the other path.
    pub actions: Vec<(usize, ActionId, ActionId)>,
}

/// Why paths of the leading block do not do what is claimed of them.
#[derive(Clone, Debug)]
pub struct Failure {
    /// What the checker says, if the paths were given for a claim that fails.
    pub defeat: Option<Defeat>,
    /// The paths that show it, of all blocks so far.
    pub paths: Vec<Trace>,
    /// The parts that fail on them; none where the formula has the other value on all of them, or that was not found out.
    pub parts: Vec<Failing>,
    /// What paths do otherwise.
    pub differences: Vec<Difference>,
}

/// What the checker says of paths of the leading block.
#[derive(Clone, Debug)]
pub enum Judged {
    /// They do what is claimed.
    Holds,
    /// They do not, and why.
    Fails(Box<Failure>),
    /// That takes more than the checker's budget.
    TooLarge,
}

/// How a strategy (or counterexample) fails, if it does.
pub(super) fn judge(
    asker: &Asker<'_>,
    objective: &Objective,
    strategy: &Strategy,
) -> Result<Result<Judged, verify::Error>, Error> {
    let checked = verify::check(asker.problem, objective, strategy, &Budget::default());
    let defeat = match checked {
        Err(error) => return Ok(Err(error)),
        Ok(Check::Holds) => return Ok(Ok(Judged::Holds)),
        Ok(Check::TooLarge { .. }) => return Ok(Ok(Judged::TooLarge)),
        Ok(Check::Fails(defeat)) => defeat,
    };
    let mut paths = strategy.traces.clone();
    if let Defeat::Paths(more) = &defeat {
        paths.extend(more.iter().cloned());
    }
    // What refutes a counterexample makes the formula true: no part fails.
    let fails = is_existential(objective) && matches!(defeat, Defeat::Paths(_) | Defeat::Formula);
    let parts = if fails { failing(asker, objective, &paths)? } else { Vec::new() };
    let differences = differences(objective, &paths, &parts);
    Ok(Ok(Judged::Fails(Box::new(Failure { defeat: Some(defeat), paths, parts, differences }))))
}

/// What paths of the blocks so far, which make the objective fail, do not meet.
pub(super) fn failing(
    asker: &Asker<'_>,
    objective: &Objective,
    paths: &[Trace],
) -> Result<Vec<Failing>, Error> {
    let all = objective.formula.parts();
    if paths.len() == objective.paths.len() {
        let settled = |part| settled(asker.problem, objective, part, paths);
        let failed = |part: FormulaId| {
            let (value, _) = settled(part)?;
            let (part, time) = (!value).then(|| culprit(objective, part, &settled))?;
            Some(Failing { part, time: Some(time) })
        };
        let in_time = |_: &FormulaId| !asker.deadline.passed();
        let mut found: Vec<Failing> = all.into_iter().take_while(in_time).filter_map(failed).collect();
        found.sort_by_key(|failing| failing.time);
        return Ok(found);
    }
    let rest = objective.paths.iter().skip(paths.len());
    if rest.into_iter().any(|path| path.quantifier == Quantifier::Forall) {
        return Ok(Vec::new());
    }
    // Some of the parts exclude each other for whatever path is chosen now.
    let all = unfolded(asker.problem, objective, all, paths);
    let question = |parts: &[FormulaId]| {
        let mut question = pinned(asker.problem, &of_parts(objective, parts), paths);
        for path in &mut question.paths {
            path.quantifier = Quantifier::Exists;
        }
        asker.impossible(&question)
    };
    if question(&all)? != Some(true) {
        return Ok(Vec::new());
    }
    let mut without = |rest: &[FormulaId]| if rest.is_empty() { Ok(Some(false)) } else { question(rest) };
    let (core, _) = needed(all, &asker.deadline, &mut without)?;
    Ok(core.into_iter().map(|part| Failing { part, time: None }).collect())
}

/// The parts, of implications whose antecedents hold on the paths so far what they imply.
fn unfolded(
    problem: &Problem,
    objective: &Objective,
    all: Vec<FormulaId>,
    paths: &[Trace],
) -> Vec<FormulaId> {
    let formula = &objective.formula;
    let known: Vec<PathId> = paths.iter().map(|trace| trace.path).collect();
    let so_far = first_paths(objective, paths.len());
    let mut stack: Vec<FormulaId> = all.into_iter().rev().collect();
    let mut found = Vec::new();
    while let Some(part) = stack.pop() {
        let holds = |antecedent: FormulaId| {
            read_paths(formula, antecedent).iter().all(|path| known.contains(path))
                && settled(problem, &so_far, antecedent, paths).is_some_and(|(value, _)| value)
        };
        match (formula.implication(part), &formula.nodes[part]) {
            (Some((antecedent, consequent)), _) if holds(antecedent) => stack.push(consequent),
            (None, Node::And(ids)) if formula.written(part).is_none() && !ids.is_empty() => {
                stack.extend(ids.iter().rev());
            }
            _ => found.push(part),
        }
    }
    found
}

/// The value of a part on paths, and when it is known.
fn settled(
    problem: &Problem,
    objective: &Objective,
    part: FormulaId,
    paths: &[Trace],
) -> Option<(bool, u32)> {
    let own = of_parts(objective, &[part]);
    let strategy = Strategy { traces: paths.to_vec() };
    verify::settled(problem, &own, &strategy, &Budget::default()).ok().flatten()
}

/// The smallest part within one that fails: of an implication what it implies, of a conjunction what fails first.
fn culprit(
    objective: &Objective,
    part: FormulaId,
    settled: &dyn Fn(FormulaId) -> Option<(bool, u32)>,
) -> (FormulaId, u32) {
    let formula = &objective.formula;
    let mut at = part;
    loop {
        let within = match (formula.implication(at), &formula.nodes[at]) {
            (Some((_, consequent)), _) => vec![consequent],
            (None, Node::And(ids)) if formula.written(at).is_none() => ids.clone(),
            _ => Vec::new(),
        };
        let failed = |id: &FormulaId| settled(*id).filter(|(value, _)| !value).map(|(_, time)| (time, *id));
        match within.iter().filter_map(failed).min() {
            Some((_, id)) => at = id,
            None => return (at, settled(at).map_or(0, |(_, time)| time)),
        }
    }
}

/// What the paths after the leading block do otherwise than those whose actions theirs are compared with.
pub(super) fn differences(objective: &Objective, paths: &[Trace], parts: &[Failing]) -> Vec<Difference> {
    let until = parts.iter().filter_map(|failing| failing.time).min().map(|time| time as usize);
    let mut found = Vec::new();
    for trace in paths {
        for from in compared(objective, trace.path) {
            let Some(other) = paths.iter().find(|other| other.path == from) else { continue };
            let both = trace.actions.iter().zip(&other.actions).enumerate();
            let both = both.take(until.unwrap_or(usize::MAX));
            let actions = both.filter(|(_, (own, others))| own != others);
            let actions = actions.map(|(step, (own, others))| (step, *own, *others)).collect();
            let same_system = objective.paths[trace.path].system == objective.paths[from].system;
            let firsts = trace.states.first().zip(other.states.first());
            let starts = firsts.filter(|(own, others)| same_system && own != others);
            let starts = starts.map(|(own, others)| (own.clone(), others.clone()));
            found.push(Difference { path: trace.path, from, starts, actions });
        }
    }
    found
}

/// The paths of blocks before that of a path whose actions are compared with its own.
fn compared(objective: &Objective, path: PathId) -> Vec<PathId> {
    let own = objective.paths[path].quantifier;
    let mut tied = objective.tied_before(path);
    tied.retain(|&other| objective.paths[other].quantifier != own);
    tied
}

/// Whether a formula compares actions of these two paths.
pub(super) fn compares_actions(objective: &Objective, first: PathId, second: PathId) -> bool {
    objective.formula.nodes.iter().any(|node| {
        let mut found = false;
        if let Node::Atom(e) = node {
            e.for_each_leaf(&mut |leaf| {
                found |= matches!(*leaf, PathLeaf::SameAction(p, q) if (p, q) == (first, second) || (q, p) == (first, second));
            });
        }
        found
    })
}
