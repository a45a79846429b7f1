//! Which paths of the other player are enough to defeat every candidate.
//!
//! The paths of the block after the leading one are told apart by where they begin, and by the steps in which they do something
//! else than the leading path whose actions theirs are compared with. Leaving out some of either makes the objective weaker. What
//! is left when nothing more can be left out defeats every candidate alone; and a candidate that wins as soon as one
//! more is left out is a good one.

use super::asker::{Asker, needed};
use super::failure::compares_actions;
use super::part::{at, is_at, now};
use crate::choice::Choice;
use crate::config::Verdict;
use crate::fact::Error;
use crate::lint::demand::paths as read_paths;
use hyperplan_problem::{Expr, FormulaId, Mode, Node, Objective, PathId, PathLeaf, Problem, State, Strategy};
use hyperplan_space::{Graph, StateIx, value_in};

/// Systems with more states are not looked at, and more starts or steps not asked about one by one.
const STATES: usize = 300_000;
const CHOICES: usize = 1_000;
/// Of more parts it is not found out where a path may begin.
const PARTS: usize = 100;
/// Choices that a candidate is spared alone, to see whether it wins then.
const TRIED: usize = 3;

/// Choices of the other player that are enough to defeat every candidate.
#[derive(Clone, Debug)]
pub struct Opponents {
    /// The choices that are left.
    pub choices: Vec<Choice>,
    /// Whether none of them can be left out.
    pub minimal: bool,
    /// So many choices there were.
    pub of: usize,
    /// Paths whose starts were told apart, and those whose steps were, of which there was more than one.
    pub starts: Vec<PathId>,
    /// Of these paths steps were told apart.
    pub steps: Vec<PathId>,
}

/// A strategy that wins against paths of the other player that make none of some choices; `None` where these were not told
/// apart.
pub(super) struct Best {
    pub(super) strategy: Strategy,
    pub(super) spared: Option<Vec<Choice>>,
}

/// Leaves out what is not needed to defeat every candidate of an objective that has no strategy.
pub(super) fn opponents(
    asker: &Asker<'_>,
    objective: &Objective,
    best: &mut Option<Best>,
) -> Result<Option<Opponents>, Error> {
    let Some(all) = choices(asker, objective) else { return Ok(None) };
    if all.len() < 2 {
        return Ok(None);
    }
    let of = all.len();
    let of_path = |path: &PathId, start: bool| {
        all.iter()
            .filter(|choice| {
                matches!(choice, Choice::Start(own, _) if start && own == path)
                    || matches!(choice, Choice::Replaced(own, ..) if !start && own == path)
            })
            .count()
    };
    let block = objective.blocks().into_iter().nth(1).unwrap_or_default();
    let starts = block.iter().copied().filter(|path| of_path(path, true) > 1).collect();
    let steps = block.iter().copied().filter(|path| of_path(path, false) > 0).collect();
    let mut without = |kept: &[Choice]| {
        let left_out: Vec<Choice> = all.iter().filter(|choice| !kept.contains(choice)).cloned().collect();
        let Ok(outcome) = asker.ask(&without(asker.problem, objective, &left_out))? else { return Ok(None) };
        // Without any start of some path there is nobody to win against.
        let begins =
            |path: &PathId| kept.iter().any(|choice| matches!(choice, Choice::Start(own, _) if own == path));
        let better = |best: &Best| best.spared.as_ref().is_none_or(|spared| left_out.len() < spared.len());
        if let Some(strategy) = outcome.witness
            && block.iter().all(begins)
            && best.as_ref().is_none_or(better)
        {
            *best = Some(Best { strategy, spared: Some(left_out) });
        }
        Ok(Some(outcome.verdict == Verdict::Unrealizable))
    };
    let (choices, minimal) = needed(all.clone(), &asker.deadline, &mut without)?;
    // Those that are enough together are most likely to be what is too much: without one of them alone much is still won
    // against.
    for spared in choices.iter().take(TRIED) {
        let rest: Vec<Choice> = all.iter().filter(|choice| *choice != spared).cloned().collect();
        if without(&rest)? == Some(false) {
            break;
        }
    }
    Ok(Some(Opponents { choices, minimal, of, starts, steps }))
}

/// The choices of the block after the leading one; `None` where they are too many to be told apart.
fn choices(asker: &Asker<'_>, objective: &Objective) -> Option<Vec<Choice>> {
    let block = objective.blocks().into_iter().nth(1)?;
    let mut all = Vec::new();
    for &path in &block {
        for from in objective.leading_block() {
            if compares_actions(objective, from, path) {
                let steps = steps(objective, path).min(steps(objective, from));
                all.extend((0..steps).map(|step| Choice::Replaced(path, from, step)));
            }
        }
    }
    // What is rare is kept: of other steps first.
    for &path in &block {
        all.extend(starts(asker, objective, path)?.into_iter().map(|state| Choice::Start(path, state)));
    }
    (all.len() <= CHOICES).then_some(all)
}

fn steps(objective: &Objective, path: PathId) -> usize {
    let steps = match objective.mode {
        Mode::Within(steps) => u64::from(steps),
        Mode::Bounded => hyperplan_horizon::horizons(objective)[path].steps.unwrap_or(0),
    };
    usize::try_from(steps).unwrap_or(usize::MAX)
}

/// The states in which a path of the other player may begin and still matter: no assumption fails there.
fn starts(asker: &Asker<'_>, objective: &Objective, path: PathId) -> Option<Vec<State>> {
    let system = &asker.problem.systems[objective.paths[path].system];
    if !system.is_finite() {
        return None;
    }
    let graph = asker.config.graphs.explore(system, STATES)?;
    let all = graph.initial.iter().map(|&state: &StateIx| Graph::state(&graph, system, state));
    let states = mattering(asker.problem, objective, path, all, CHOICES + 1)?;
    (states.len() <= CHOICES).then_some(states)
}

/// Of states in which a path of the other player may begin, the first so many that matter: no assumption fails there. `None`
/// where the objective has too many parts to tell.
pub(super) fn mattering(
    problem: &Problem,
    objective: &Objective,
    path: PathId,
    all: impl IntoIterator<Item = State>,
    most: usize,
) -> Option<Vec<State>> {
    let system = &problem.systems[objective.paths[path].system];
    let (_, others) = others(objective);
    if others.len() > PARTS {
        return None;
    }
    let matters = |state: &State| {
        let mut leaf = |leaf: &PathLeaf| match *leaf {
            PathLeaf::State(own, leaf) if own == path => value_in(system, &Expr::Leaf(leaf), state),
            _ => None,
        };
        others.iter().any(|&part| now(&objective.formula, part, &mut leaf) != Some(true))
    };
    Some(all.into_iter().filter(matters).take(most).collect())
}

/// The objective with some choices left out: paths that make one of them need not be won against.
pub(super) fn without(problem: &Problem, objective: &Objective, left_out: &[Choice]) -> Objective {
    let mut weaker = objective.clone();
    let span = objective.span;
    let (own, mut others) = others(objective);
    let formula = &mut weaker.formula;
    let mut excused: Vec<FormulaId> = left_out
        .iter()
        .map(|choice| match choice {
            Choice::Start(path, state) => at(formula, 0, is_at(problem, objective, *path, state), span),
            Choice::Replaced(path, from, step) => {
                let same = Expr::Leaf(PathLeaf::SameAction(*from, *path));
                at(formula, step + 1, Expr::Not(Box::new(same)), span)
            }
        })
        .collect();
    if !others.is_empty() {
        let all = if others.len() == 1 { others.remove(0) } else { formula.push(Node::And(others), span) };
        excused.push(all);
        let all = formula.push(Node::Or(excused), span);
        let parts = own.into_iter().chain([all]).collect();
        formula.push(Node::And(parts), span);
    }
    weaker
}

/// The parts that read only leading paths, and the others.
fn others(objective: &Objective) -> (Vec<FormulaId>, Vec<FormulaId>) {
    let (formula, leading) = (&objective.formula, objective.leading_block());
    let own = |part: &FormulaId| read_paths(formula, *part).iter().all(|path| leading.contains(path));
    formula.parts().into_iter().partition(own)
}
