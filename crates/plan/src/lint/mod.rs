//! Warnings about objectives and systems that hold, or fail, for no good reason. `docs/checks.md` lists them.
//!
//! What needs a search is a question with a time budget: whether some paths, all chosen freely, do something. The
//! embedded solver answers it, for systems with infinitely many states an external one if there is one; what it cannot answer in time is said to be undecided, never guessed.

pub(crate) mod demand;
mod horizon;
pub(crate) mod question;
pub(crate) mod rewrite;
mod start;
mod systems;
#[cfg(test)]
mod tests;
mod tie;
mod total;
mod vacuity;

pub use systems::lint_systems;

use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::Deadline;
use hyperplan_syntax::{Diagnostic, Span};
use question::Asker;
use std::time::Duration;

/// How long the questions about an objective may take.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// One question.
    pub question: Duration,
    /// All questions about one objective.
    pub objective: Duration,
}

impl Default for Budget {
    fn default() -> Self {
        Budget { question: Duration::from_secs(2), objective: Duration::from_secs(10) }
    }
}

/// What was found, and what was not found out.
#[derive(Clone, Debug, Default)]
pub struct Lints {
    /// What is probably not meant.
    pub warnings: Vec<Diagnostic>,
    /// Questions that were not decided, each with its place and the reason.
    pub undecided: Vec<Diagnostic>,
    /// What was not looked at.
    pub notes: Vec<Uninspected>,
}

/// A system that was not looked at.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the states of system {system} were not inspected: {}", if *.late { "there was no time for it" } else { "it has too many states, or infinitely many" })]
pub struct Uninspected {
    /// The system.
    pub system: String,
    /// For want of time; else it is too large.
    pub late: bool,
}

/// What is suspicious about an objective. The deadline bounds all of it.
#[must_use]
pub fn lint(problem: &Problem, objective: &Objective, deadline: &Deadline, budget: Budget) -> Lints {
    let mut warnings = start::lint(problem, objective);
    let decided: Vec<Span> = warnings.iter().flat_map(places).collect();
    warnings.extend(horizon::lint(objective));
    let mut asker = Asker::new(problem, objective, deadline.within(budget.objective), budget.question);
    if let Some(nothing) = asker.without_paths() {
        warnings.push(nothing);
    } else if objective.semantics.is_none() {
        // Elsewhere a formula and its negation can fail together, and the questions would say something else.
        let mut vacuous = Vec::new();
        let constant = vacuity::lint(&mut asker, &mut vacuous);
        // What time 0 decides was explained already.
        vacuous.retain(|finding| finding.span.is_none_or(|span| !decided.contains(&span)));
        warnings.append(&mut vacuous);
        if !constant {
            demand::lint(&mut asker, &mut warnings);
        }
        tie::lint(&mut asker, &mut warnings);
    }
    let mut lints = Lints { warnings, undecided: asker.into_undecided(), notes: Vec::new() };
    for list in [&mut lints.warnings, &mut lints.undecided] {
        once(list);
        for finding in list {
            name_objective(objective, finding);
        }
    }
    lints
}

fn places(finding: &Diagnostic) -> Vec<Span> {
    finding.span.into_iter().chain(finding.related.iter().map(|(span, _)| *span)).collect()
}

/// A definition is written once, however often it is used.
fn once(findings: &mut Vec<Diagnostic>) {
    let mut seen = Vec::new();
    findings.retain(|finding| {
        let about = (finding.code, finding.span, finding.message.clone());
        let new = !seen.contains(&about);
        seen.push(about);
        new
    });
}

/// What lies in a template's text concerns the objective that uses it.
fn name_objective(objective: &Objective, finding: &mut Diagnostic) {
    if finding.span.is_some_and(|span| span.source != objective.span.source) {
        let words = format!("in objective {}", objective.name);
        finding.related.push((objective.span, words));
    }
}
