//! Whole problem files with a meaning: what they mean, their queries, their warnings and their answers.

use super::choices;
use super::problem::{formatted_alike, shown};
use crate::whole::Whole;
use hyperplan_plan::{
    Budget as LintBudget, Config, EmitConfig, Fault, Limits, Lints, Pruning, Quantifiers, States, Status,
    Track, Verdict, emit, lint, lint_systems, solve,
};
use hyperplan_problem::{Objective, Problem, System};
use hyperplan_smt::read_script;
use hyperplan_solver::{Deadline, Spec};
use hyperplan_verify::{Budget, decide};
use std::time::Duration;

/// Small, so that an input takes no time: what is beyond them is refused, or not known.
const LIMITS: Limits = Limits {
    horizon: 60,
    states: 2_000,
    layer_states: 5_000,
    pairs: 2_000,
    swept: 2_000,
    residuals: 200,
    chances: 2_000,
    cases: 64,
    constructors: 300,
    pruning: Pruning::Full,
};

/// The same for the checker.
const BUDGET: Budget = Budget { states: 2_000, entries: 50_000, moves: 500_000 };

/// How long each use of a problem may take.
const PATIENCE: Duration = Duration::from_millis(300);

/// What the choices are for: first how, then which problem.
struct Chosen {
    quantifiers: Quantifiers,
    states: Option<States>,
    track: Track,
    whole: Whole,
}

impl Chosen {
    fn by(data: &[u8]) -> Chosen {
        use Quantifiers::{Auto, Cegis, Expand, Explicit, Keep};
        let mut random = choices(data);
        let states = [
            None,
            Some(States::Onehot),
            Some(States::Bitvec),
            Some(States::Enum),
            Some(States::Int),
            Some(States::Real),
        ];
        Chosen {
            quantifiers: [Auto, Keep, Cegis, Expand, Explicit][random.below(5)],
            states: states[random.below(6)],
            track: [Track::Single, Track::Model, Track::UnsatCore, Track::Incremental][random.below(4)],
            whole: Whole::random(&mut random),
        }
    }
}

/// The problem that is made.
pub(super) fn made(data: &[u8]) -> String {
    let Chosen { quantifiers, states, track, whole } = Chosen::by(data);
    let files: String = whole.files.iter().map(|(path, text)| format!("// {path}:\n{text}\n")).collect();
    format!("// {quantifiers:?}, {states:?}, {track:?}\n{}{files}", whole.text)
}

pub(super) fn body(data: &[u8]) {
    tried(data);
}

/// How far an input got.
#[derive(Default)]
struct Got {
    /// Problems with a meaning.
    meaning: u32,
    /// Objectives that became a benchmark.
    emitted: u32,
    /// Answers that the checker gives, too.
    answered: u32,
}

fn tried(data: &[u8]) -> Got {
    let mut got = Got::default();
    let chosen = Chosen::by(data);
    let (lowered, sources) = formatted_alike(&chosen.whole.text, &|path| chosen.whole.file(path));
    if lowered.has_errors() {
        return got;
    }
    got.meaning = 1;
    let problem = &lowered.problem;
    let is_finite = problem.systems.iter().all(System::is_finite);
    let warn = |lints: Lints| shown(&sources, &[lints.warnings, lints.undecided].concat());
    warn(lint_systems(problem, &Deadline::after(PATIENCE)));
    for objective in &problem.objectives {
        got.emitted += u32::from(emitted(problem, objective, &chosen));
        // Elsewhere the questions would be for a solver that may not be there.
        if is_finite {
            let budget = LintBudget { question: PATIENCE / 4, objective: PATIENCE };
            warn(lint(problem, objective, &Deadline::after(PATIENCE), budget));
            got.answered += answered(problem, objective, &chosen);
        }
    }
    got
}

/// What is emitted can be read; whether something is.
fn emitted(problem: &Problem, objective: &Objective, chosen: &Chosen) -> bool {
    let Chosen { quantifiers, states, track, .. } = *chosen;
    let config = EmitConfig {
        quantifiers,
        states,
        track,
        status: Some(Status::Unknown),
        limits: LIMITS,
        deadline: Deadline::after(PATIENCE),
        ..EmitConfig::new("2026-01-01")
    };
    let mut emitted = match emit(problem, objective, &config) {
        Ok(emitted) => emitted,
        Err(error) => {
            assert!(error.fault() < Fault::Solver, "emit: {error}");
            return false;
        }
    };
    let mut text = Vec::new();
    emitted.write(&mut text).expect("a list takes all");
    let text = String::from_utf8(text).expect("it is a text");
    if emitted.script().is_some() {
        let read = read_script(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(read.assertions, emitted.assertions, "assertions\n{text}");
        assert_eq!(read.symbols.len(), emitted.symbols, "symbols\n{text}");
    } else {
        assert!(text.ends_with("(exit)\n"), "{text}");
    }
    true
}

/// What is found is what the checker finds; how often something is.
fn answered(problem: &Problem, objective: &Objective, chosen: &Chosen) -> u32 {
    let mut count = 0;
    let expected = decide(problem, objective, &BUDGET).ok().flatten();
    for (quantifiers, states) in [(Quantifiers::Auto, None), (chosen.quantifiers, chosen.states)] {
        let deadline = Deadline::after(PATIENCE);
        let config = Config { quantifiers, states, deadline, limits: LIMITS, ..Config::new(Spec::Builtin) };
        match solve(problem, objective, &config) {
            Ok(outcome) if outcome.verdict == Verdict::Unknown => {}
            Ok(outcome) => {
                let found = outcome.verdict == Verdict::Realizable;
                let way = format!("{}, {quantifiers:?}, {states:?}", objective.name);
                assert!(expected.is_none_or(|expected| expected == found), "{way}: {found}");
                count += u32::from(expected.is_some());
            }
            Err(error) => assert!(error.fault() < Fault::Solver, "{quantifiers:?}: {error}"),
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::some_choices;
    use hyperplan_random::Random;

    #[test]
    fn inputs_get_far() {
        let mut all = Got::default();
        for seed in 0..60 {
            let Got { meaning, emitted, answered } = tried(&some_choices(&mut Random::new(seed)));
            all.meaning += meaning;
            all.emitted += emitted;
            all.answered += answered;
        }
        let Got { meaning, emitted, answered } = all;
        let counts = format!("{meaning} with a meaning, {emitted} emitted, {answered} answered");
        crate::say(&counts);
        assert!(meaning >= 50 && emitted >= 20 && answered >= 60, "{counts}");
    }
}
