//! What is suspicious about systems, found by looking at every reachable state.

use super::{Lints, Uninspected};
use hyperplan_problem::{Problem, System, display};
use hyperplan_solver::Deadline;
use hyperplan_space::{Findings, Graph, StateIx, inspect};
use hyperplan_syntax::Diagnostic;

/// Systems with more states are not inspected.
const INSPECTED_STATES: usize = 300_000;

/// Pairs of overlapping clauses that are listed for one system.
const OVERLAPS: usize = 3;

/// What is suspicious about the systems of a problem: dead ends, labels that hold nowhere, clauses that overlap,
/// transitions lost at the ends of ranges.
#[must_use]
pub fn lint_systems(problem: &Problem, deadline: &Deadline) -> Lints {
    let mut lints = Lints::default();
    // Those with costs added up are others once more.
    for system in problem.systems.iter().filter(|system| system.base.is_none()) {
        match Graph::explore(system, INSPECTED_STATES) {
            Ok(graph) if graph.is_empty() => {
                let message = format!("system {} has no initial state", system.name);
                lints.warnings.push(Diagnostic::warning("no-initial-state", system.span, message));
            }
            Ok(graph) => match inspect(system, &graph, &|| deadline.passed()) {
                Some(findings) => describe(system, &graph, &findings, &mut lints.warnings),
                None => lints.notes.push(uninspected(system, true)),
            },
            Err(_) => lints.notes.push(uninspected(system, false)),
        }
    }
    lints
}

fn uninspected(system: &System, late: bool) -> Uninspected {
    Uninspected { system: system.name.clone(), late }
}

fn describe(system: &System, graph: &Graph, findings: &Findings, found: &mut Vec<Diagnostic>) {
    let example = |state: StateIx| display::state(system, &graph.state(system, state));
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
    for &label in &findings.unreachable {
        let label = &system.labels[label];
        let message = format!("label {} holds in no reachable state", label.name);
        found.push(Diagnostic::warning("unreachable-label", label.span, message));
    }
    for &(first, second, state) in findings.overlaps.iter().take(OVERLAPS) {
        found.push(overlap(system, first, second, &example(state), findings.overlaps.len()));
    }
    for &(clause, state) in &findings.added {
        let what = if system.map.is_some() { "a move of the map" } else { "a transition of the graph" };
        let message = format!("this clause is enabled together with {what}, such as in {}", example(state));
        found.push(
            Diagnostic::warning("overlapping-clauses", system.clauses[clause].span, message)
                .with_help("the outcome is then nondeterministic; give what is new an action of its own"),
        );
    }
    for &clause in &findings.idle {
        let message = "this clause applies in no reachable state";
        found.push(Diagnostic::warning("idle-clause", system.also[clause].span, message));
    }
    if let Some(&(first, state)) = findings.lost.first() {
        found.push(lost(system, findings.lost.len(), first, &example(state)));
    }
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

fn overlap(system: &System, first: usize, second: usize, example: &str, pairs: usize) -> Diagnostic {
    let mut message = format!(
        "two clauses of one action are enabled together, with different outcomes, such as in {example}"
    );
    if pairs > OVERLAPS {
        message += &format!(" (one of {pairs} such pairs)");
    }
    Diagnostic::warning("overlapping-clauses", system.clauses[second].span, message)
        .with_related(system.clauses[first].span, "the other clause")
        .with_help("the outcome is then nondeterministic; guards that exclude each other make it one")
}
