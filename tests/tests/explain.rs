//! What `explain` says of random problems is so, by brute force: parts exclude each other, and none of them can be left out;
//! so much more time is enough, and less is not; some choices of the other player defeat every candidate. And the parts that
//! fail on a candidate or a counterexample fail. What is told of candidates where a search was cut off is so, too.

use hyperplan_plan::explain::{
    Choice, Closest, Explanation, Later, Opponents, Scope, closest, explain, longer,
};
use hyperplan_plan::{Config, Outcome, Quantifiers, Verdict, solve};
use hyperplan_problem::{Problem as Typed, Strategy, Value};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{lowered, path};
use hyperplan_tests::model::{Atom, Formula, Problem};
use hyperplan_tests::random::{self, Random};
use hyperplan_tests::{number, say};
use std::time::Duration;

/// Most tuples of paths that brute force looks at.
const MOST: usize = 20_000;

/// What was checked, by kind.
#[derive(Default)]
struct Seen {
    cores: u32,
    games: u32,
    least: u32,
    opponents: u32,
    candidates: u32,
    failures: u32,
}

fn atom(atom: Atom) -> Formula {
    Formula::Atom(atom)
}

/// A problem of several parts, most of which ask for little.
fn conflict(random: &mut Random) -> Problem {
    let mut problem = random::problem(random);
    let (paths, horizon) = (problem.exists.len(), problem.within.unwrap_or(problem.look));
    problem.semantics = None;
    if random.once_in(3) {
        problem.exists[0] = true;
    }
    // Less time than it was made for is often too little.
    problem.within = problem.within.map(|steps| if random.once_in(2) { steps / 2 } else { steps });
    let interval = problem.within.is_none().then_some((0, horizon));
    let mut all = if random.once_in(2) { vec![problem.formula.clone()] } else { Vec::new() };
    for _ in 0..2 + random.below(3) {
        let path = random.below(paths);
        let label = |random: &mut Random| atom(Atom::Label(path, random.below(problem.system.labels.len())));
        let part = match random.below(5) {
            0 => atom(Atom::Is(path, 0, random.below(problem.system.vars[0].1.size()))),
            1 => Formula::Globally(interval, Box::new(label(random))),
            2 if paths > 1 => {
                let (first, second) = (random.below(paths), random.below(paths));
                let same = Formula::Globally(interval, Box::new(atom(Atom::SameAction(first, second))));
                Formula::Implies(
                    Box::new(same),
                    Box::new(Formula::Finally(interval, Box::new(label(random)))),
                )
            }
            _ => Formula::Finally(interval, Box::new(label(random))),
        };
        all.push(part);
    }
    Problem { formula: Formula::And(all), ..problem }
}

/// The conjuncts, as the problem's text has them.
fn conjuncts(formula: &Formula) -> Vec<Formula> {
    match formula {
        Formula::And(all) => all.iter().flat_map(conjuncts).collect(),
        other => vec![other.clone()],
    }
}

/// By brute force, if that is not too much.
fn verdict(problem: &Problem) -> Option<bool> {
    let brute = Brute::new(problem, MOST)?;
    let tuples = brute.paths.len().checked_pow(u32::try_from(problem.exists.len()).ok()?)?;
    (tuples <= MOST).then(|| brute.verdict())
}

fn config() -> Config {
    Config { deadline: Deadline::after(Duration::from_secs(60)), ..Config::new(Spec::Builtin) }
}

#[test]
fn reasons_are_reasons() {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", 1_500);
    let mut seen = Seen::default();
    for seed in first..first + cases {
        let problem = conflict(&mut Random::new(seed));
        if verdict(&problem) != Some(false) {
            continue;
        }
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let outcome = solve(&typed, objective, &config()).expect("it is supported");
        assert_eq!(outcome.verdict, Verdict::Unrealizable, "seed {seed}\n{problem}");
        // More time for many paths is much to search.
        let few = problem.exists.len() <= 2;
        let mut ways: Vec<_> = longer(&typed, objective).into_iter().filter(|_| few).collect();
        let found = explain(&typed, objective, &outcome, &mut ways, &config()).expect("nothing fails");
        let about = format!("seed {seed}\n{problem}\n{found:#?}");
        judge(&problem, &typed, (&found, &outcome), &about, &mut seen);
    }
    let Seen { cores, games, least, opponents, candidates, failures } = seen;
    say(&format!(
        "seeds {first}..{}: {cores} cores, {games} of them of games, {least} least times, {opponents} opponents, {candidates} candidates, {failures} failures",
        first + cases
    ));
    assert!(
        cores > 50 && games > 5 && least > 5 && opponents > 10 && candidates > 10 && failures > 30,
        "too little for the test to mean something"
    );
}

fn judge(
    problem: &Problem,
    typed: &Typed,
    (found, outcome): (&Explanation, &Outcome),
    about: &str,
    seen: &mut Seen,
) {
    assert_eq!(outcome.witness.is_some(), found.counterexample.is_some(), "{about}");
    let all = typed.objectives[0].formula.parts();
    let own = conjuncts(&problem.formula);
    // What one atom is written as may be several parts, or one that stands there twice be one.
    let index = |part| all.iter().position(|&other| other == part).filter(|_| all.len() == own.len());
    if let Some(core) = &found.core {
        assert!(core.minimal && !core.parts.is_empty(), "{about}");
        let kept: Option<Vec<usize>> = core.parts.iter().map(|&part| index(part)).collect();
        if let Some(kept) = kept {
            excludes(problem, &own, (&kept, core.scope), about);
            seen.cores += 1;
            seen.games += u32::from(core.scope == Scope::Game);
        }
    }
    for later in &found.later {
        seen.least += u32::from(is_least(problem, later, about));
    }
    if let Some(opponents) = &found.opponents {
        seen.opponents += u32::from(defeat_all(problem, &own, opponents, about));
    }
    if let Some(candidate) = &found.candidate {
        let spared = candidate.spared.as_deref();
        let checked = spared.and_then(|spared| wins(problem, typed, (&candidate.strategy, spared)));
        assert_ne!(checked, Some(false), "the candidate does not win: {about}");
        seen.candidates += u32::from(checked.is_some());
    }
    let candidate = found.candidate.as_ref().map(|candidate| &candidate.failure);
    for failure in candidate.into_iter().chain(&found.counterexample) {
        let whole = failure.paths.len() == problem.exists.len();
        assert!(!whole || !failure.parts.is_empty(), "{about}");
        let horizon = problem.within.unwrap_or(problem.look);
        for failing in &failure.parts {
            assert!(failing.time.is_none_or(|time| time <= horizon), "{about}");
        }
        seen.failures += u32::from(!failure.parts.is_empty());
    }
}

/// Parts exclude each other, and none of them can be left out.
fn excludes(problem: &Problem, own: &[Formula], (kept, scope): (&[usize], Scope), about: &str) {
    let of = |kept: &[usize]| {
        let formula = Formula::And(kept.iter().map(|&at| own[at].clone()).collect());
        let exists = match scope {
            // Parts of leading paths say nothing of the others, whoever chooses these.
            Scope::Leading | Scope::All => vec![true; problem.exists.len()],
            Scope::Game => problem.exists.clone(),
        };
        verdict(&Problem { formula, exists, ..problem.clone() })
    };
    assert_eq!(of(kept), Some(false), "they do not exclude each other: {about}");
    for out in 0..kept.len() {
        let rest = [&kept[..out], &kept[out + 1..]].concat();
        assert!(rest.is_empty() || of(&rest) == Some(true), "{out} can be left out: {about}");
    }
}

/// So many steps are enough, and fewer are not; whether that was checked.
fn is_least(problem: &Problem, later: &Later, about: &str) -> bool {
    let Some(least) = later.least.filter(|_| problem.within.is_some()) else { return false };
    assert!(later.is_proved(), "{about}");
    for steps in later.now..=least {
        let within = u32::try_from(steps).ok();
        match verdict(&Problem { within, ..problem.clone() }) {
            Some(realizable) => assert_eq!(realizable, steps == least, "within {steps}: {about}"),
            None => return false,
        }
    }
    true
}

/// Some choices of the other player are enough, and none of them can be left out; whether that was checked.
fn defeat_all(problem: &Problem, own: &[Formula], found: &Opponents, about: &str) -> bool {
    // Interpreted here over one path of the other player only.
    let leading = problem.exists.iter().take_while(|&&exists| exists).count();
    let block = problem.exists[leading..].iter().take_while(|&&exists| !exists).count();
    if block != 1 || problem.within.is_none() {
        return false;
    }
    assert!(found.minimal, "{about}");
    let path = leading;
    let tied: Vec<usize> = (0..leading).filter(|&p| compares(&problem.formula, p, path)).collect();
    let of = |choices: &[&Choice]| {
        let starts = choices.iter().filter_map(|choice| match choice {
            Choice::Start(_, state) => Some(is_state(problem, path, state)),
            Choice::Replaced(..) => None,
        });
        let mut agrees = vec![Formula::Or(starts.collect())];
        for &from in &tied {
            for step in 0..problem.within.unwrap_or(0) as usize {
                let may = choices.iter().any(|choice| {
                    matches!(choice, Choice::Replaced(_, p, s) if usize::from(*p) == from && *s == step)
                });
                if !may {
                    let same = atom(Atom::SameAction(from, path));
                    agrees.push((0..=step).fold(same, |later, _| Formula::Next(Box::new(later))));
                }
            }
        }
        let (free, others): (Vec<Formula>, Vec<Formula>) =
            own.iter().cloned().partition(|part| reads_only(part, leading));
        let weaker = Formula::Implies(Box::new(Formula::And(agrees)), Box::new(Formula::And(others)));
        let formula = Formula::And(free.into_iter().chain([weaker]).collect());
        verdict(&Problem { formula, ..problem.clone() })
    };
    let all: Vec<&Choice> = found.choices.iter().collect();
    let Some(defeated) = of(&all) else { return false };
    assert!(!defeated, "a candidate wins against these: {about}");
    for out in 0..all.len() {
        let rest = [&all[..out], &all[out + 1..]].concat();
        assert_eq!(of(&rest), Some(true), "{out} can be left out of {all:?}: {about}");
    }
    true
}

/// Whether a candidate wins against all paths that make none of the choices it was spared, if that is not too much.
fn wins(problem: &Problem, typed: &Typed, (strategy, spared): (&Strategy, &[Choice])) -> Option<bool> {
    let leading = problem.exists.iter().take_while(|&&exists| exists).count();
    let excuse = |choice: &Choice| match choice {
        Choice::Start(path, state) => is_state(problem, usize::from(*path), state),
        Choice::Replaced(path, from, step) => {
            let same = atom(Atom::SameAction(usize::from(*from), usize::from(*path)));
            let other = Formula::Not(Box::new(same));
            (0..=*step).fold(other, |later, _| Formula::Next(Box::new(later)))
        }
    };
    let own = conjuncts(&problem.formula);
    let (mut parts, others): (Vec<Formula>, Vec<Formula>) =
        own.into_iter().partition(|part| reads_only(part, leading));
    parts.push(Formula::Or(spared.iter().map(excuse).chain([Formula::And(others)]).collect()));
    let weaker = Problem { formula: Formula::And(parts), ..problem.clone() };
    let brute = Brute::new(&weaker, MOST)?;
    let paths: Vec<Path> = strategy.traces.iter().map(|t| path(&problem.system, typed, t)).collect();
    Some(brute.refute(&paths, true).is_none())
}

/// Candidates of a search that is over, as if it had been cut off at each of them.
#[test]
fn the_closest_candidate_loses_to_what_is_said() {
    let first = number("HYPERPLAN_SEED", 20_261_129);
    let cases = number("HYPERPLAN_CASES", 1_500);
    let (mut strategies, mut starts, mut replaced, mut several, mut silent) = (0, 0, 0, 0, 0);
    for seed in first..first + cases {
        let random = &mut Random::new(seed);
        let mut problem = conflict(random);
        if problem.exists.len() < 2 {
            continue;
        }
        (problem.exists[0], problem.exists[1]) = (true, false);
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let config = Config { quantifiers: Quantifiers::Cegis, ..config() };
        solve(&typed, objective, &config).expect("it is supported");
        for candidate in config.watch.candidates() {
            let Some(without) = wins(&problem, &typed, (&candidate, &[])) else { continue };
            let about = format!("seed {seed}\n{problem}\n{candidate:?}");
            let Some(Closest { strategy, spared }) =
                closest(&typed, objective, std::slice::from_ref(&candidate))
            else {
                assert!(!without, "it wins, and nothing is said: {about}");
                silent += 1;
                continue;
            };
            assert_eq!((&strategy, without), (&candidate, spared.is_empty()), "{spared:?}: {about}");
            let won = wins(&problem, &typed, (&candidate, &spared));
            assert_eq!(won, Some(true), "it does not win without {spared:?}: {about}");
            for out in 0..spared.len() {
                let rest = [&spared[..out], &spared[out + 1..]].concat();
                let won = wins(&problem, &typed, (&candidate, &rest));
                assert_eq!(won, Some(false), "{out} of {spared:?} need not be left out: {about}");
            }
            strategies += u32::from(spared.is_empty());
            several += u32::from(spared.len() > 1);
            starts += u32::from(spared.iter().any(|choice| matches!(choice, Choice::Start(..))));
            replaced += u32::from(spared.iter().any(|choice| matches!(choice, Choice::Replaced(..))));
        }
    }
    say(&format!(
        "seeds {first}..{}: {strategies} strategies, {starts} candidates that lose to starts, {replaced} to actions, {several} to \
         several choices, {silent} of which nothing is said",
        first + cases
    ));
    assert!(
        strategies > 30 && starts > 10 && replaced > 10 && several > 3,
        "too little for the test to mean something"
    );
}

fn is_state(problem: &Problem, path: usize, state: &hyperplan_problem::State) -> Formula {
    let index = |value: &Value| match value {
        Value::Bool(b) => usize::from(*b),
        Value::Int(n) => usize::try_from(*n).expect("values are few and small"),
        Value::Enum(i) => usize::try_from(*i).expect("values are few and small"),
        Value::Real(_) => panic!("systems are finite"),
    };
    let equal = state.iter().take(problem.system.vars.len()).enumerate();
    Formula::And(equal.map(|(var, value)| atom(Atom::Is(path, var, index(value)))).collect())
}

/// Calls `f` on every atom.
fn atoms(formula: &Formula, f: &mut impl FnMut(&Atom)) {
    match formula {
        Formula::Atom(atom) => f(atom),
        Formula::And(all) | Formula::Or(all) => all.iter().for_each(|one| atoms(one, f)),
        Formula::Not(a)
        | Formula::Next(a)
        | Formula::WeakNext(a)
        | Formula::Finally(_, a)
        | Formula::Globally(_, a) => atoms(a, f),
        Formula::Implies(a, b)
        | Formula::Iff(a, b)
        | Formula::Until(_, a, b)
        | Formula::Release(_, a, b)
        | Formula::WeakUntil(_, a, b)
        | Formula::StrongRelease(_, a, b) => {
            atoms(a, f);
            atoms(b, f);
        }
    }
}

fn compares(formula: &Formula, first: usize, second: usize) -> bool {
    let mut found = false;
    atoms(formula, &mut |atom| {
        found |=
            matches!(*atom, Atom::SameAction(p, q) if (p, q) == (first, second) || (q, p) == (first, second));
    });
    found
}

/// Whether a formula reads none but the first paths.
fn reads_only(formula: &Formula, leading: usize) -> bool {
    let mut only = true;
    atoms(formula, &mut |atom| {
        only &= match *atom {
            Atom::Label(p, _)
            | Atom::Is(p, ..)
            | Atom::Took(p, _)
            | Atom::Enabled(p, _)
            | Atom::Choice(p, ..)
            | Atom::Coded(p, ..)
            | Atom::Costs(p, _) => p < leading,
            Atom::Less(p, _, q, _) | Atom::SameValue(p, q, _) | Atom::Cheaper(p, _, q) => {
                p < leading && q < leading
            }
            Atom::SameAction(p, q) | Atom::SameState(p, q) | Atom::SameObs(p, q) => {
                p < leading && q < leading
            }
        };
    });
    only
}
