//! Budgets and what cannot be enumerated; what is found is shown by the fixtures.

use super::{Budget, Lints, lint, lint_systems};
use hyperplan_problem::{NoFiles, Overrides, Problem, read};
use hyperplan_solver::Deadline;
use hyperplan_syntax::SourceMap;
use std::time::{Duration, Instant};

fn problem(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    lowered.problem
}

fn codes(lints: &Lints) -> Vec<&'static str> {
    lints.warnings.iter().map(|d| d.code).collect()
}

const ROOM: &str = "system W = grid { \"S..G\" } { edge stay; absorb goal; }";

fn vacuous() -> Problem {
    problem(&format!("{ROOM} objective o {{ exists p. start[p] & F[0,3] goal[p] & F[0,3] x[p] > 1 }}"))
}

#[test]
fn within_the_budget_a_vacuous_part_is_found() {
    let problem = vacuous();
    let lints = lint(&problem, &problem.objectives[0], &Deadline::never(), Budget::default());
    assert_eq!(codes(&lints), ["vacuous"]);
    assert!(lints.undecided.is_empty(), "{:?}", lints.undecided);
}

#[test]
fn without_time_for_a_question_it_is_undecided() {
    let problem = vacuous();
    let budget = Budget { question: Duration::ZERO, ..Budget::default() };
    let lints = lint(&problem, &problem.objectives[0], &Deadline::never(), budget);
    assert_eq!(codes(&lints), [""; 0]);
    assert!(!lints.undecided.is_empty());
    for undecided in &lints.undecided {
        assert!(undecided.message.ends_with(": that takes more than 0 s"), "{}", undecided.message);
    }
}

#[test]
fn after_the_deadline_little_is_asked_and_that_is_said() {
    let problem = vacuous();
    let lints = lint(&problem, &problem.objectives[0], &Deadline::after(Duration::ZERO), Budget::default());
    assert_eq!(codes(&lints), [""; 0]);
    assert!(lints.undecided.iter().any(|d| d.message.ends_with(": no time was left")), "{lints:?}");
    assert_eq!(lint_systems(&problem, &Deadline::after(Duration::ZERO)).notes.len(), 1);
}

#[test]
fn a_long_formula_does_not_outlast_the_budget() {
    let parts: Vec<String> = (0..20_000).map(|n| format!("x[p] != {n}")).collect();
    let problem = problem(&format!("{ROOM} objective o {{ exists p. F[0,3] ({}) }}", parts.join(" & ")));
    let budget = Budget { objective: Duration::from_millis(500), ..Budget::default() };
    let start = Instant::now();
    let lints = lint(&problem, &problem.objectives[0], &Deadline::never(), budget);
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    assert!(lints.undecided.len() <= 22, "{}", lints.undecided.len());
}

#[test]
fn a_system_too_large_to_enumerate_is_not_passed_over_in_silence() {
    let text = "system Large {
        state a: 0..999, b: 0..999, c: 0..999;
        action go;
        on go { a' = (a + 1) % 1000; }
        label end = a == 999;
      }
      objective o { exists p. F[0,2] end[p] & F[0,2] a[p] > 990 }";
    let problem = problem(text);
    let lints = lint_systems(&problem, &Deadline::never());
    assert_eq!(
        lints.notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["the states of system Large were not inspected: it has too many states, or infinitely many"]
    );
    let lints = lint(&problem, &problem.objectives[0], &Deadline::never(), Budget::default());
    assert_eq!(codes(&lints), ["vacuous"], "{lints:?}");
}
