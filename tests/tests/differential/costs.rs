//! Costs against brute force: in formulas, and as what is to be as small as possible.

use super::{Answers, Tally, embedded, seeds, smallest};
use hyperplan_certify::{check, with_bounds};
use hyperplan_plan::{
    Cheapest, Config, Fault, Limits, Pruning, Quantifiers, States, Value, Verdict, cheapest, prove,
};
use hyperplan_problem::{self as problem, CostId, PathId, Target};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::{SourceId, Span};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{EMBEDDED, fixture, lowered, wrong};
use hyperplan_tests::model::Problem;
use hyperplan_tests::random::{Random, problem_with_costs};
use hyperplan_tests::say;
use hyperplan_verify::{Budget, decide};
use std::time::Duration;

#[test]
fn the_checker_reads_costs_as_brute_force_does() {
    let mut tally = Tally::default();
    for seed in seeds(1500) {
        let random = problem_with_costs(&mut Random::new(seed), true);
        let expected = Brute::new(&random, usize::MAX / 8).expect("no limit").verdict();
        let text = fixture(&random.to_string(), expected);
        tally.add(expected);
        let typed = lowered(&text);
        let answer = decide(&typed, &typed.objectives[0], &Budget::default());
        if answer != Ok(Some(expected)) {
            let small = smallest(&random, |_, brute, typed| {
                decide(typed, &typed.objectives[0], &Budget::default()) != Ok(Some(brute.verdict()))
            });
            panic!("seed {seed}: {answer:?}\n{text}{small}");
        }
    }
    tally.assert_balanced();
}

#[test]
fn the_embedded_solver_reads_costs_as_brute_force_does() {
    let mut answers = Answers::default();
    for seed in seeds(300) {
        let random = problem_with_costs(&mut Random::new(seed), true);
        for solver in embedded(seed) {
            answers.compare(&random, &solver, EMBEDDED, seed);
        }
    }
    answers.report("embedded");
}

/// What some sum of costs comes to, of the first paths of the leading block.
struct Sum {
    factors: Vec<i64>,
    constant: i64,
}

impl Sum {
    fn random(random: &mut Random, paths: usize) -> Sum {
        let mut factors: Vec<i64> = (0..paths).map(|_| [0, 1, 1, 2][random.below(4)]).collect();
        if factors.iter().all(|factor| *factor == 0) {
            factors[0] = 1;
        }
        Sum { factors, constant: [0, 3, -2][random.below(3)] }
    }

    fn target(&self) -> Target {
        let terms = (0_u32..).zip(&self.factors).filter(|(_, factor)| **factor > 0);
        let terms = terms.map(|(path, &factor)| (factor, PathId(path), CostId(0))).collect();
        Target { terms, constant: self.constant, span: Span::new(SourceId(0), 0..0) }
    }

    fn of(&self, brute: &Brute<'_>, paths: &[&Path], steps: usize) -> i64 {
        let cost = |path: &Path| i64::try_from(brute.cost(path, steps)).expect("it is small");
        self.constant + self.factors.iter().zip(paths).map(|(factor, path)| factor * cost(path)).sum::<i64>()
    }
}

/// The least values, by trying all choices of the leading block; `None` where none will do.
fn least<'b>(brute: &'b Brute<'_>, problem: &Problem, sums: &[Sum], steps: usize) -> Option<Vec<i64>> {
    let leading = problem.exists.iter().take_while(|exists| **exists).count();
    let mut choices: Vec<Vec<&'b Path>> = vec![Vec::new()];
    for _ in 0..leading {
        let mut more = Vec::new();
        for choice in &choices {
            more.extend(brute.paths.iter().map(|path| [choice.as_slice(), &[path]].concat()));
        }
        choices = more;
    }
    let good = choices.into_iter().filter(|choice| brute.holds(&mut choice.clone()));
    good.map(|choice| sums.iter().map(|sum| sum.of(brute, &choice, steps)).collect()).min()
}

/// That nothing is cheaper has certificates, and that the cheapest is not there has none.
fn certified(problem: &problem::Problem, targets: &[Target], values: &[Value], context: &dyn Fn() -> String) {
    for (at, value) in values.iter().enumerate() {
        let refuted = |most: i64| {
            let before = targets[..at].iter().cloned().zip(values.iter().map(|value| value.found));
            let bounds: Vec<(Target, i64)> = before.chain([(targets[at].clone(), most)]).collect();
            let (problem, objective) =
                with_bounds(problem, &problem.objectives[0], &bounds).expect("it is short");
            match prove(&problem, &objective, &Deadline::never()) {
                Ok(proved) => {
                    let mut refutation = Vec::new();
                    proved.refutation(&mut refutation).expect("to memory");
                    let mut refutation = refutation.as_slice();
                    let checked = check(&problem, &objective, &proved.branches, &mut refutation, &|| false);
                    checked.unwrap_or_else(|error| panic!("{error}, {}", context()));
                    true
                }
                Err(error) => {
                    let said = error.to_string();
                    assert!(
                        said.contains("there is what it says that there is not"),
                        "{said}, {}",
                        context()
                    );
                    false
                }
            }
        };
        assert!(refuted(value.least - 1) && !refuted(value.least), "{at}: {}", context());
    }
}

#[test]
fn the_cheapest_strategy_is_what_brute_force_finds() {
    let (mut found, mut unknown) = (0_u32, 0_u32);
    for seed in seeds(500) {
        let mut random = Random::new(seed);
        let read = random.once_in(4);
        let problem = problem_with_costs(&mut random, read);
        let leading = problem.exists.iter().take_while(|exists| **exists).count();
        let brute = Brute::new(&problem, 2_000).filter(|brute| {
            leading > 0 && brute.paths.len().saturating_pow(u32::try_from(leading).unwrap_or(9)) < 5_000
        });
        let Some(brute) = brute else { continue };
        let sums: Vec<Sum> = (0..1 + random.below(2)).map(|_| Sum::random(&mut random, leading)).collect();
        let targets: Vec<Target> = sums.iter().map(Sum::target).collect();
        let text = problem.to_string();
        let typed = lowered(&text);
        let usual = Limits::default();
        let unpruned = Limits { pruning: Pruning::Light, ..usual };
        let tight = Limits { layer_states: 40, pairs: 12, swept: 30, residuals: 8, chances: 0, ..usual };
        let ways = [
            (Quantifiers::Auto, None, usual),
            (Quantifiers::Auto, None, tight),
            (Quantifiers::Cegis, Some(States::Onehot), unpruned),
            (Quantifiers::Expand, Some(States::Enum), usual),
            (Quantifiers::Expand, Some(States::Bitvec), usual),
            (Quantifiers::Explicit, Some(States::Onehot), usual),
        ];
        for (quantifiers, states, limits) in ways {
            let context = || format!("seed {seed}, {quantifiers} {states:?} {limits:?} {targets:?}\n{text}");
            let deadline = Deadline::after(Duration::from_secs(60));
            let config = Config { quantifiers, states, limits, deadline, ..Config::new(Spec::Builtin) };
            let answer = match cheapest(&typed, &typed.objectives[0], &targets, &config) {
                Ok(answer) => answer,
                Err(error) if error.fault() == Fault::Request => continue,
                Err(error) => panic!("{error}, {}", context()),
            };
            let Cheapest { outcome, values, undecided } = answer;
            if outcome.verdict == Verdict::Unknown || undecided.is_some() {
                unknown += 1;
                continue;
            }
            let steps = outcome.witness.as_ref().map_or(0, |strategy| {
                let speaks = |path: PathId| targets.iter().any(|t| t.terms.iter().any(|term| term.1 == path));
                let own = strategy.traces.iter().filter(|trace| speaks(trace.path));
                own.map(|trace| trace.actions.len()).max().unwrap_or(0)
            });
            let expected = least(&brute, &problem, &sums, steps);
            let given = (outcome.verdict == Verdict::Realizable)
                .then(|| values.iter().map(|value| value.found).collect::<Vec<_>>());
            assert_eq!(given, expected, "{}", context());
            assert!(values.iter().all(|value| value.least == value.found), "{values:?} {}", context());
            found += u32::from(given.is_some());
            let verdict = expected.is_some();
            let why = wrong(Ok(outcome), &problem, &brute, &typed, verdict);
            assert!(why.is_none(), "{why:?}, {}", context());
            // Certificates do not depend on the way.
            if quantifiers == Quantifiers::Auto && limits.chances > 0 {
                certified(&typed, &targets, &values, &context);
            }
        }
    }
    say(&format!("{found} cheapest strategies, {unknown} unknown"));
    assert!(found > 300 && unknown * 50 < found, "{found}, {unknown}");
}
