//! Tiny problems through the whole search, with the embedded solver. Threads of tests have the stack of any spawned
//! thread, 2 MiB.

use hyperplan_plan::{
    Because, Config, EmitConfig, Error, Fault, Limits, Note, Outcome, Quantifiers, Reason, States, Track,
    Unsupported, Verdict, Verified, emit, minimize, solve,
};
use hyperplan_problem::answer::ReasonCode;
use hyperplan_problem::{NoFiles, Overrides, Problem, read};
use hyperplan_solver::{Deadline, Spec, Unknown};
use hyperplan_syntax::SourceMap;
use std::time::Duration;

/// A line of three rooms, in which a push may fail.
const ROOMS: &str = "const T = 4;
    system Rooms {
      state x: 0..2;
      action left, right, push;
      on left { x' = x - 1; }
      on right { x' = x + 1; }
      on push { x' = x; }
      on push { x' = x + 1; }
      absorb x == 2;
      label start = x == 0;
      label goal = x == 2;
    }
    ";

fn problem(objective: &str) -> Problem {
    let text = format!("{ROOMS} objective o {objective}");
    let lowered = read(&mut SourceMap::new(), "test.hp", &text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    lowered.problem
}

fn config() -> Config {
    Config { deadline: Deadline::after(Duration::from_secs(60)), ..Config::new(Spec::Builtin) }
}

fn solved(objective: &str, config: &Config) -> Result<Outcome, Error> {
    let problem = problem(objective);
    solve(&problem, &problem.objectives[0], config)
}

const REACH: &str = "within T { exists p. start[p] & F goal[p] }";
/// Whoever does the same arrives too, where pushes are never relied on.
const LEAD: &str = "within T {
    exists p. forall q.
      start[p] & F goal[p] & (start[q] & G action[q] == action[p] -> F goal[q])
    }";
const PUSHED: &str = "within T {
    exists p. forall q.
      start[p] & N G (action[p] == push) & F goal[p] & (start[q] & G action[q] == action[p] -> F goal[q])
    }";
const MIMIC: &str = "within T { forall p. exists q. start[p] -> start[q] & G x[p] == x[q] }";
const ALL_ARRIVE: &str = "within T { forall p. start[p] -> F goal[p] }";

#[test]
fn ways_to_decide_agree() {
    let expected = [(REACH, true), (LEAD, true), (PUSHED, false), (MIMIC, true), (ALL_ARRIVE, false)];
    for (objective, realizable) in expected {
        for quantifiers in [Quantifiers::Auto, Quantifiers::Expand, Quantifiers::Cegis] {
            for states in [None, Some(States::Onehot), Some(States::Enum), Some(States::Bitvec)] {
                let config = Config { quantifiers, states, ..config() };
                let outcome = solved(objective, &config).expect("it is supported");
                let expected = if realizable { Verdict::Realizable } else { Verdict::Unrealizable };
                assert_eq!(outcome.verdict, expected, "{quantifiers} {states:?} {objective}");
                assert_eq!(outcome.verified.is_some(), outcome.witness.is_some());
                let asked = outcome.quantifiers != Quantifiers::Explicit;
                assert!(outcome.reason.is_none() && (outcome.iterations > 0 || !asked));
            }
        }
    }
}

#[test]
fn what_was_chosen_is_told_with_its_reason() {
    let outcome = solved(REACH, &config()).expect("it is supported");
    assert_eq!((outcome.quantifiers, outcome.because), (Quantifiers::Expand, Some(Because::OneBlock)));
    assert_eq!((outcome.states, outcome.verified), (States::Onehot, Some(Verified::BySearch)));
    let outcome = solved(LEAD, &config()).expect("it is supported");
    assert_eq!((outcome.quantifiers, outcome.because), (Quantifiers::Explicit, Some(Because::Searched)));
    let limits = Limits { chances: 0, ..Limits::default() };
    let outcome = solved(LEAD, &Config { limits, ..config() }).expect("it is supported");
    assert_eq!((outcome.quantifiers, outcome.because), (Quantifiers::Expand, Some(Because::Swept)));
    let cegis = Config { quantifiers: Quantifiers::Cegis, ..config() };
    let outcome = solved(LEAD, &cegis).expect("it is supported");
    assert_eq!((outcome.quantifiers, outcome.because), (Quantifiers::Cegis, None));
}

/// One answer after the other would take as many rounds as there are paths.
#[test]
fn a_path_like_another_is_that_path() {
    let text = "system S { state x: 0..7; action up, down; on up | down { x' in 0..7; } }
        objective same within 8 { exists a. forall b. exists c. x[a] == 3 & G (x[b] == x[c]) }
        objective other within 8 { exists a. forall b. exists c. x[a] == 3 & G (x[b] == x[c]) & F x[c] == 3 }";
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    let search = |at: usize| {
        let config = Config { quantifiers: Quantifiers::Cegis, ..config() };
        let config = Config { deadline: Deadline::after(Duration::from_secs(60)), ..config };
        solve(&lowered.problem, &lowered.problem.objectives[at], &config).expect("it is supported").verdict
    };
    assert_eq!(search(0), Verdict::Realizable);
    assert_eq!(search(1), Verdict::Unrealizable);
}

#[test]
fn notes_are_facts() {
    let outcome = solved("within T { exists p. start[p] & N G action[p] == push & F goal[p] }", &config());
    let notes = outcome.expect("it is supported").notes;
    assert!(matches!(notes.as_slice(), [Note::PicksOutcomes { path }] if path == "p"), "{notes:?}");
    // With one action alone nothing is picked but outcomes.
    for (actions, all, notes) in [("step", "step", 0), ("step, rest", "step | rest", 1)] {
        let text = format!(
            "system S {{ state x: 0..9; action {actions}; init x == 0; on {all} {{ x' in {{x + 1, x + 2}}; }} }}
             objective o within 3 {{ exists p. F x[p] == 6 }}"
        );
        let lowered = read(&mut SourceMap::new(), "test.hp", &text, &NoFiles, &Overrides::none());
        let outcome =
            solve(&lowered.problem, &lowered.problem.objectives[0], &config()).expect("it is supported");
        assert_eq!((outcome.verdict, outcome.notes.len()), (Verdict::Realizable, notes), "{actions}");
    }
    // In mere left and right the system has an end.
    let text = "system S { state x: 0..1; action up; on up { x' = x + 1; } }
        objective o within 3 { forall p. x[p] == 5 }";
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    let outcome =
        solve(&lowered.problem, &lowered.problem.objectives[0], &config()).expect("it is supported");
    assert_eq!(outcome.verdict, Verdict::Realizable);
    let [Note::NoPaths { system, path }] = outcome.notes.as_slice() else { panic!("{:?}", outcome.notes) };
    assert_eq!((system.as_str(), path.as_str()), ("S", "p"));
}

#[test]
fn bounds_that_add_up_are_told_of_where_nothing_is_found() {
    let nested = "{ exists p. F[0,9] (goal[p] & F[0,9] (start[p] & F[0,9] goal[p])) }";
    let hurried = Config { deadline: Deadline::after(Duration::ZERO), ..config() };
    let outcome = solved(nested, &hurried).expect("so small a system is read without a look at the clock");
    let long = |note: &Note| matches!(note, Note::LongHorizon { steps: 27, bound: 9, path } if path == "p");
    assert!(outcome.verdict == Verdict::Unknown && outcome.notes.iter().any(long), "{:?}", outcome.notes);
    let outcome = solved(nested, &config()).expect("it is supported");
    assert!(
        !outcome.notes.iter().any(|note| matches!(note, Note::LongHorizon { .. })),
        "{:?}",
        outcome.notes
    );
}

#[test]
fn what_the_embedded_solver_cannot_do_is_told() {
    let keep = solved(LEAD, &Config { quantifiers: Quantifiers::Keep, ..config() });
    assert!(matches!(keep, Err(Error::Unsupported(Unsupported::KeptQuantifiers))), "{keep:?}");
    let error =
        solved(REACH, &Config { states: Some(States::Int), ..config() }).expect_err("it knows bits only");
    let Error::Unsupported(Unsupported::Arithmetic { system: None, states: States::Int }) = error else {
        panic!("{error:?}")
    };
    assert_eq!((error.fault(), error.code()), (Fault::Request, ReasonCode::Unsupported));
}

#[test]
fn deadlines_and_cancelling_end_a_search() {
    let flag = Deadline::never();
    flag.cancel();
    for (deadline, expected) in
        [(Deadline::after(Duration::ZERO), Unknown::Timeout), (flag, Unknown::Interrupted)]
    {
        match solved(LEAD, &Config { deadline, ..config() }) {
            Ok(Outcome { verdict: Verdict::Unknown, reason: Some(Reason::Solver(why)), .. }) => {
                assert_eq!(why, expected);
            }
            Err(error) => assert_eq!(error.fault(), Fault::Time),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn the_first_to_answer_wins_a_race() {
    let missing = || Spec::Command("no-such-program-is-here".to_owned());
    let won = solved(LEAD, &Config { rivals: vec![missing()], ..config() }).expect("one can answer");
    assert_eq!((won.verdict, won.solver.name.as_str()), (Verdict::Realizable, "builtin"));
    let lost = solved(LEAD, &Config { solver: missing(), rivals: vec![missing()], ..config() });
    let error = lost.expect_err("there is no solver");
    assert!(matches!(&error, Error::Race(errors) if errors.len() == 2), "{error}");
    assert_eq!((error.fault(), error.code()), (Fault::Solver, ReasonCode::SolverFailed));
    let late = Config { rivals: vec![Spec::Builtin], deadline: Deadline::after(Duration::ZERO), ..config() };
    match solved(LEAD, &late) {
        Ok(outcome) => assert_eq!(outcome.reason.map(|reason| reason.code()), Some(ReasonCode::Timeout)),
        Err(error) => assert_eq!(error.fault(), Fault::Time),
    }
}

#[test]
fn the_least_value_of_a_constant() {
    let mut of = |value: i64| -> Result<Problem, String> {
        let text = format!("{ROOMS} objective o {LEAD}");
        let overrides = Overrides::none().with("T", value);
        Ok(read(&mut SourceMap::new(), "test.hp", &text, &NoFiles, &overrides).problem)
    };
    let least = minimize("o", 0..=8, &mut of, &config()).expect("it is supported");
    assert_eq!((least.value, least.proved, least.outcome.verdict), (2, 2, Verdict::Realizable));
    assert!(least.undecided.is_none());
    let least = minimize("o", 0..=1, &mut of, &config()).expect("it is supported");
    assert_eq!((least.value, least.outcome.verdict), (1, Verdict::Unrealizable));
}

#[test]
fn a_dialogue_is_written_as_it_was_led() {
    let problem = problem(PUSHED);
    let config = EmitConfig { track: Track::Incremental, ..EmitConfig::new("2026-01-31") };
    let mut emitted = emit(&problem, &problem.objectives[0], &config).expect("it is supported");
    let mut text = Vec::new();
    emitted.write(&mut text).expect("memory is there");
    let text = String::from_utf8(text).expect("it is ASCII");
    let count = |what: &str| text.lines().filter(|line| *line == what).count();
    assert!(count("(check-sat)") > 1 && count("(push 1)") > 0, "{text}");
    assert_eq!(count("(push 1)"), count("(pop 1)"));
    assert_eq!(count("(check-sat)"), text.matches("(set-info :status").count());
    // A model is asked of a query only.
    let config = EmitConfig { track: Track::Model, quantifiers: Quantifiers::Cegis, ..config };
    let error = emit(&problem, &problem.objectives[0], &config).err();
    assert!(matches!(error, Some(Error::Unsupported(Unsupported::Dialogue))));
}

/// An objective whose expression is nested this deep through definitions, each nested as deep as half of the parser's limit.
fn nested(open: &str, close: &str, base: &str, levels: usize, objective: &str) -> Problem {
    let (mut text, mut inner, mut left, mut number) = (ROOMS.to_owned(), base.to_owned(), levels, 0);
    while left > 0 {
        let here = left.min(240);
        text += &format!("define d{number}(p) = {}{inner}{};\n", open.repeat(here), close.repeat(here));
        (inner, left, number) = (format!("d{number}(p)"), left - here, number + 1);
    }
    text += &format!("objective o within 2 {{ exists p. {} }}", objective.replace("NESTED", &inner));
    let lowered = read(&mut SourceMap::new(), "test.hp", &text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    lowered.problem
}

/// What recurses, recurses over nesting: three quarters of the stack of a thread, at most, for the deepest there is.
#[test]
fn the_deepest_nesting_gets_along_with_the_stack_of_a_thread() {
    let problems = [
        ("!(", ")", "goal[p]", 980, "NESTED"),
        ("(1 + ", ")", "x[p]", 980, "NESTED > 0"),
        ("(if x[p] > 1 then ", " else 0)", "x[p]", 980, "NESTED > 0"),
        ("(if ", " then goal[p] else start[p])", "goal[p]", 980, "NESTED"),
        ("(goal[p] -> ", ")", "goal[p]", 980, "NESTED"),
        ("(goal[p] U (start[p] | ", "))", "goal[p]", 490, "NESTED"),
    ];
    for (open, close, base, levels, objective) in problems {
        let all = || {
            let problem = nested(open, close, base, levels, objective);
            for quantifiers in [Quantifiers::Auto, Quantifiers::Cegis] {
                for states in [None, Some(States::Bitvec)] {
                    let config = Config { quantifiers, states, ..config() };
                    let outcome = solve(&problem, &problem.objectives[0], &config).expect("it is supported");
                    assert_ne!(outcome.verdict, Verdict::Unknown);
                }
            }
        };
        std::thread::scope(|scope| {
            let small = std::thread::Builder::new().stack_size(3 << 19).spawn_scoped(scope, all);
            small.expect("it starts").join().expect("it does not panic");
        });
    }
}
