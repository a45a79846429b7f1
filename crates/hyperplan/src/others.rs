//! Which paths are drawn: those of a strategy, and of all that it has to cope with the worst, or many for a menu.

use hyperplan_problem::{
    FormulaId, Node, Objective, PathId, Problem, Quantifier, State, Strategy, Trace, display,
};
use hyperplan_render::{Part, Variant, steps_to_rest};
use hyperplan_verify::{Beginning, Budget, Check, Defeat, check, holds_at, progress_of, starts, worst};

/// What a picture may cost besides drawing: some seconds at most.
const BUDGET: Budget = Budget { states: 300_000, entries: 3_000_000, moves: 20_000_000 };
/// What each entry of a menu may cost.
const ENTRY: Budget = Budget { states: 100_000, entries: 300_000, moves: 1_000_000 };
/// The most starts, replaced actions, and parts of an objective that are shown.
const MOST_STARTS: usize = 24;
const MOST_REPLACED: usize = 48;
const MOST_PARTS: usize = 40;

/// Why something is not drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Undrawn {
    /// The objective has no such path.
    #[error("{objective} has no path {path}; it has {paths}")]
    NoPath {
        /// The objective.
        objective: String,
        /// What was named.
        path: String,
        /// Its paths.
        paths: String,
    },
    /// There is nothing to draw of a path.
    #[error(
        "there is no path {0} to draw: the strategy has none, and none was found that it has to cope with"
    )]
    Missing(String),
    /// What there is cannot be drawn.
    #[error(transparent)]
    Render(#[from] hyperplan_render::Error),
}

/// The paths to draw.
pub struct Shown {
    /// The paths.
    pub traces: Vec<Trace>,
    /// What legends say of those that are not the strategy's.
    pub note: &'static str,
}

/// The paths of a strategy and those of the next block that come closest to defeating it, or do. Where some are named, only
/// these.
///
/// # Errors
/// When one that is named cannot be drawn.
pub fn shown(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    named: &[String],
) -> Result<Shown, Undrawn> {
    if let Some(name) = named.iter().find(|name| objective.path(name).is_none()) {
        let paths: Vec<&str> = objective.paths.iter().map(|path| path.name.as_str()).collect();
        let (objective, path, paths) = (objective.name.clone(), name.clone(), paths.join(", "));
        return Err(Undrawn::NoPath { objective, path, paths });
    }
    let leading = objective.leading_block();
    let is_other = |name: &String| objective.path(name).is_some_and(|path| !leading.contains(&path));
    let wanted = named.is_empty() || named.iter().any(is_other);
    let (others, note) = if wanted { others(problem, objective, strategy) } else { (Vec::new(), "") };
    let is_named = |trace: &&Trace| named.is_empty() || named.contains(&objective.paths[trace.path].name);
    let traces: Vec<Trace> = strategy.traces.iter().chain(&others).filter(is_named).cloned().collect();
    let is_there = |name: &&String| traces.iter().any(|trace| objective.paths[trace.path].name == **name);
    match named.iter().find(|name| !is_there(name)) {
        Some(name) => Err(Undrawn::Missing(name.clone())),
        None => Ok(Shown { traces, note }),
    }
}

/// Whether an objective has paths that a strategy has to cope with.
fn has_others(objective: &Objective) -> bool {
    let exists = objective.paths.first().is_some_and(|path| path.quantifier == Quantifier::Exists);
    exists && objective.leading_block().len() < objective.paths.len()
}

/// The paths of the block after a strategy's, with what is said of them.
fn others(problem: &Problem, objective: &Objective, strategy: &Strategy) -> (Vec<Trace>, &'static str) {
    if !has_others(objective) {
        return (Vec::new(), "");
    }
    match check(problem, objective, strategy, &BUDGET) {
        Ok(Check::Fails(Defeat::Paths(traces))) => return (traces, "defeats the strategy"),
        Ok(Check::Holds) => {}
        // What is no strategy is drawn as it is.
        _ => return (Vec::new(), ""),
    }
    match worst(problem, objective, strategy, None, &BUDGET) {
        Ok(Some(traces)) => (traces, "the worst of all"),
        _ => (Vec::new(), ""),
    }
}

/// For a page: the paths of the strategy with the worst others, and then with others from each start, and after each action
/// of the strategy that is replaced by another.
///
/// # Errors
/// Those of [`shown()`].
pub fn variants(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    named: &[String],
) -> Result<Vec<Variant>, Undrawn> {
    let Shown { traces, note } = shown(problem, objective, strategy, named)?;
    let name = match note {
        "" => "the strategy",
        note => note,
    };
    let variant = |name: String, traces: Vec<Trace>, note: &'static str| {
        let parts = parts(problem, objective, &traces);
        Variant { name, traces, note, parts }
    };
    let mut all = vec![variant(name.to_owned(), traces, note)];
    if !named.is_empty() || !has_others(objective) || note == "defeats the strategy" {
        return Ok(all);
    }
    for (name, path, beginning) in beginnings(problem, objective, strategy) {
        let found = worst(problem, objective, strategy, Some((path, &beginning)), &ENTRY);
        if let Ok(Some(others)) = found {
            let traces = strategy.traces.iter().cloned().chain(others).collect();
            all.push(variant(name, traces, "the worst of these"));
        }
    }
    Ok(all)
}

/// How the first path of the block after the strategy's may begin, in words too.
fn beginnings(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
) -> Vec<(String, PathId, Beginning)> {
    let Some(path) = objective.paths.keys().nth(strategy.traces.len()) else { return Vec::new() };
    let (name, system) = (&objective.paths[path].name, objective.paths[path].system);
    let shown = |state: &State| display::state(&problem.systems[system], state);
    let from = |state: State| {
        (
            format!("{name} from {}", shown(&state)),
            path,
            Beginning { start: Some(state), actions: Vec::new() },
        )
    };
    let mut all: Vec<_> =
        starts(problem, system, MOST_STARTS, &ENTRY).into_iter().flatten().map(from).collect();
    let model = strategy.traces.iter().find(|trace| objective.paths[trace.path].system == system);
    let Some(model) = model else { return all };
    let steps = steps_to_rest(problem, objective, model);
    let replaced = (0..steps).flat_map(|step| {
        let others = problem.systems[system].actions.iter().filter(move |a| **a != model.actions[step]);
        others.map(move |action| (step, *action))
    });
    for (step, action) in replaced.take(MOST_REPLACED) {
        let actions = model.actions[..step].iter().copied().chain([action]).collect();
        let (instead, action) = (&problem.actions[model.actions[step]], &problem.actions[action]);
        let words = format!("{name}, step {}: {action} instead of {instead}", step + 1);
        all.push((words, path, Beginning { start: None, actions }));
    }
    all
}

/// What the parts of the objective come to on these paths: its conjuncts, what they assume and ask, and below them what
/// speaks of one time.
fn parts(problem: &Problem, objective: &Objective, traces: &[Trace]) -> Vec<Part> {
    let chosen = chosen(objective);
    let (present, whole): (Vec<_>, Vec<_>) = chosen.iter().partition(|(_, _, present)| *present);
    let ids = |parts: &[&(FormulaId, usize, bool)]| parts.iter().map(|(id, ..)| *id).collect::<Vec<_>>();
    let now = holds_at(problem, objective, traces, &ids(&present), &BUDGET);
    let so_far = progress_of(problem, objective, traces, &ids(&whole), &BUDGET);
    let (Ok(Some(now)), Ok(Some(so_far))) = (now, so_far) else { return Vec::new() };
    let (mut now, mut so_far) = (now.into_iter(), so_far.into_iter());
    let part = |(id, depth, present): &(FormulaId, usize, bool)| {
        let values = if *present { now.next() } else { so_far.next() };
        let words = display::formula(problem, objective, *id);
        Part { words, depth: *depth, present: *present, values: values.unwrap_or_default() }
    };
    chosen.iter().map(part).collect()
}

/// The parts that are shown, each with how deep it stands and whether it speaks of one time.
fn chosen(objective: &Objective) -> Vec<(FormulaId, usize, bool)> {
    let formula = &objective.formula;
    let mut is_present: Vec<bool> = Vec::with_capacity(formula.nodes.len());
    for node in &formula.nodes {
        let temporal =
            matches!(node, Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..));
        let below = node.children().iter().all(|child| is_present[usize::from(*child)]);
        is_present.push(!temporal && below);
    }
    let mut chosen: Vec<(FormulaId, usize, bool)> = Vec::new();
    let mut stack = vec![(formula.root(), 0)];
    while let Some((id, depth)) = stack.pop() {
        let known = chosen.iter().any(|(known, ..)| *known == id);
        if known || chosen.len() == MOST_PARTS || formula.constant(id).is_some() {
            continue;
        }
        let below = match (&formula.nodes[id], formula.implication(id)) {
            (Node::And(parts), _) if id == formula.root() => {
                stack.extend(parts.iter().rev().map(|part| (*part, 0)));
                continue;
            }
            _ if is_present[usize::from(id)] => Vec::new(),
            (_, Some((assumed, asked))) => vec![assumed, asked],
            (node, None) => node.children(),
        };
        // At the top a part says something of time 0, whatever it speaks of.
        chosen.push((id, depth, is_present[usize::from(id)] && depth > 0));
        stack.extend(below.into_iter().rev().map(|part| (part, depth + 1)));
    }
    chosen
}
