//! Warnings about objectives and systems that hold, or fail, for no good reason.

use crate::cegis::Cegis;
use crate::config::{Config, Error, Quantifiers, States};
use crate::oracle::{Oracle, Stop};
use crate::prepare::{no_dead_ends, without_paths};
use hyperplan_encode::{self as encode, Encoder, Goal, Graph, Limits, inspect};
use hyperplan_problem::{
    Formula, FormulaId, Node, Objective, PathVar, Problem, Quantifier, System, SystemId, display,
};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::Diagnostic;
use std::time::Duration;

/// How long one question about vacuity may take.
const QUESTION: Duration = Duration::from_secs(2);

/// Systems larger than this are not inspected state by state.
const INSPECTED_STATES: usize = 300_000;

/// What is suspicious about the systems of a problem: dead ends, labels that hold nowhere, clauses that overlap,
/// transitions lost at the ends of ranges.
#[must_use]
pub fn lint_systems(problem: &Problem) -> Vec<Diagnostic> {
    problem.systems.keys().flat_map(|id| lint_system(problem, id)).collect()
}

fn lint_system(problem: &Problem, id: SystemId) -> Vec<Diagnostic> {
    let system = &problem.systems[id];
    let Ok(graph) = Graph::explore(system, INSPECTED_STATES) else { return Vec::new() };
    let findings = inspect(system, &graph);
    let example = |state| display::state(system, &graph.state(system, state));
    let mut found = Vec::new();
    if graph.is_empty() {
        let message = format!("system {} has no initial state", system.name);
        return vec![Diagnostic::warning("no-initial-state", system.span, message)];
    }
    if let Some((count, state)) = findings.dead_ends {
        let (states, have) = if count == 1 { ("state", "has") } else { ("states", "have") };
        let message = format!(
            "{count} reachable {states} of system {} {have} no transition, such as {}",
            system.name,
            example(state)
        );
        let help = "paths that lead there are no paths where they must go on; `absorb` mends it";
        found.push(Diagnostic::warning("dead-end", system.span, message).with_help(help));
    }
    for label in findings.unreachable {
        let label = &system.labels[label];
        let message = format!("label {} holds in no reachable state", label.name);
        found.push(Diagnostic::warning("unreachable-label", label.span, message));
    }
    for (first, second, state) in findings.overlaps {
        found.push(overlap(system, first, second, &example(state)));
    }
    if let Some(&(first, state)) = findings.lost.first() {
        found.push(lost(system, findings.lost.len(), first, &example(state)));
    }
    found
}

/// Stopping at the end of a range is an idiom, walls without guards: one warning for a system is enough.
fn lost(system: &System, clauses: usize, first: usize, example: &str) -> Diagnostic {
    let message = match clauses {
        1 => format!("an update leaves its variable's range, such as in {example}"),
        n => format!("updates of {n} clauses leave their variables' ranges, this one in {example}"),
    };
    Diagnostic::warning("lost-transition", system.clauses[first].span, message)
        .with_help("there is no such transition then; a `when` can say so")
}

fn overlap(system: &System, first: usize, second: usize, example: &str) -> Diagnostic {
    let message = format!("two clauses of one action are enabled together, such as in {example}");
    Diagnostic::warning("overlapping-clauses", system.clauses[second].span, message)
        .with_related(system.clauses[first].span, "the other clause")
        .with_help("the outcome is then nondeterministic; guards that exclude each other make it one")
}

/// What is suspicious about an objective: parts that the rest implies, antecedents that are never met. Each question
/// has a time budget; the deadline bounds them all.
#[must_use]
pub fn lint(problem: &Problem, objective: &Objective, deadline: &Deadline) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for part in parts(objective) {
        let truth = possible(problem, objective, &part, deadline);
        let span = objective.formula.spans[part.about];
        match truth {
            Ok(true) => {}
            Ok(false) if part.antecedent => {
                let message = "this antecedent is never met, so what it implies asks for nothing";
                found.push(Diagnostic::warning("vacuous-antecedent", span, message));
            }
            Ok(false) => {
                let message =
                    "this part of the objective constrains nothing: the rest of the objective implies it";
                found.push(Diagnostic::warning("vacuous", span, message));
            }
            Err(Stop::Unknown(_) | Stop::Error(Error::Encode(encode::Error::Interrupted))) => {
                let message =
                    "it is undecided, within the time for it, whether this part constrains anything";
                found.push(Diagnostic::warning("vacuity-undecided", span, message));
            }
            // Whatever cannot be encoded is reported by the commands that need it.
            Err(Stop::Error(_)) => {}
        }
    }
    found
}

/// A question: can the context hold, and the part with it (an antecedent) or its negation (anything else)?
struct Part {
    about: FormulaId,
    antecedent: bool,
    context: Vec<FormulaId>,
}

/// The conjuncts of an objective, those under an antecedent included.
fn parts(objective: &Objective) -> Vec<Part> {
    let conjuncts = conjuncts(objective, objective.formula.root());
    let mut parts = Vec::new();
    for &conjunct in &conjuncts {
        let rest: Vec<FormulaId> = conjuncts.iter().copied().filter(|&c| c != conjunct).collect();
        let Node::Implies(antecedent, consequent) = &objective.formula.nodes[conjunct] else {
            parts.push(Part { about: conjunct, antecedent: false, context: rest });
            continue;
        };
        parts.push(Part { about: *antecedent, antecedent: true, context: rest.clone() });
        let consequents = self::conjuncts(objective, *consequent);
        for &part in &consequents {
            let others = consequents.iter().copied().filter(|&c| c != part);
            let context = rest.iter().copied().chain([*antecedent]).chain(others).collect();
            parts.push(Part { about: part, antecedent: false, context });
        }
    }
    // Where an antecedent is never met, what it implies is vacuous as well; saying it once is enough.
    parts
}

fn conjuncts(objective: &Objective, id: FormulaId) -> Vec<FormulaId> {
    let mut found = Vec::new();
    let mut stack = vec![id];
    while let Some(id) = stack.pop() {
        match &objective.formula.nodes[id] {
            // A conjunction that the translation of `semantics` made of one part is not taken apart.
            Node::And(ids) if objective.semantics.is_none() || written(objective, id) => {
                stack.extend(ids.iter().rev());
            }
            _ => found.push(id),
        }
    }
    found
}

/// Whether a conjunction is one that the objective writes: then its parts have places of their own.
fn written(objective: &Objective, id: FormulaId) -> bool {
    let Formula { nodes, spans } = &objective.formula;
    nodes[id].children().iter().all(|&part| spans[part] != spans[id])
}

/// Whether some paths, all chosen freely, answer the question with yes.
fn possible(
    problem: &Problem,
    objective: &Objective,
    part: &Part,
    deadline: &Deadline,
) -> Result<bool, Stop> {
    let mut formula = objective.formula.clone();
    let span = formula.spans[part.about];
    let last = if part.antecedent { part.about } else { formula.push(Node::Not(part.about), span) };
    let all = part.context.iter().copied().chain([last]).collect();
    formula.push(Node::And(all), span);
    let exists = |path: &PathVar| PathVar { quantifier: Quantifier::Exists, ..path.clone() };
    let question =
        Objective { formula, paths: objective.paths.iter().map(exists).collect(), ..objective.clone() };
    let config = Config {
        solver: Spec::Builtin,
        quantifiers: Quantifiers::Auto,
        states: States::Auto,
        deadline: deadline.within(QUESTION),
        verify: false,
        seed: 0,
        memory_mib: None,
        queries: None,
    };
    let stop = || config.deadline.passed();
    let encoder = Encoder::new(problem, &question, None, Limits::default(), &stop)?;
    let mut oracle = Oracle::new(&config);
    no_dead_ends(&encoder, &mut oracle)?;
    if without_paths(&encoder, &mut oracle)?.is_some() {
        return Err(Stop::Unknown("no paths".into()));
    }
    let blocks = [question.paths.keys().collect::<Vec<_>>()];
    let mut cegis = Cegis { encoder: &encoder, oracle: &mut oracle, blocks: &blocks, rounds: 0, slack: None };
    let none = vec![None; question.paths.len()];
    Ok(!cegis.find(0, &none, &Goal::new(&question.formula, true), 1)?.is_empty())
}
