//! Strategies whose detours were taken out, on random problems, judged by brute force: they are strategies still, take no more
//! steps than before, and as few as any where that is said.

use hyperplan_plan::{Config, Rest, Verdict, solve, straightened};
use hyperplan_problem::Strategy;
use hyperplan_solver::{Deadline, Spec};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{lowered, wrong};
use hyperplan_tests::model::{Atom, Formula, Problem};
use hyperplan_tests::random::{self, Random};
use hyperplan_tests::{number, say};
use std::time::Duration;

/// Most tuples of paths that brute force looks at.
const MOST: usize = 20_000;

/// A problem in which leading paths often have something to reach, and states to be absorbed in.
fn errand(random: &mut Random) -> Problem {
    let mut problem = random::problem(random);
    problem.exists[0] = true;
    problem.semantics = None;
    if random.once_in(2) {
        problem.system.absorb = random.subset(problem.system.states(), 3);
    }
    let horizon = problem.within.unwrap_or(problem.look);
    let interval = problem.within.is_none().then_some((0, horizon));
    let label = random.below(problem.system.labels.len());
    let reach = Formula::Finally(interval, Box::new(Formula::Atom(Atom::Label(0, label))));
    problem.formula = match random.below(3) {
        0 => Formula::And(vec![problem.formula, reach]),
        1 => reach,
        _ => problem.formula,
    };
    problem
}

fn leading(problem: &Problem) -> usize {
    problem.exists.iter().take_while(|&&exists| exists).count()
}

/// Steps until a path is absorbed, of as many as count.
fn absorbed(problem: &Problem, states: &[usize], steps: usize) -> usize {
    let first = states.iter().position(|state| problem.system.absorb.contains(state));
    first.unwrap_or(steps).min(steps)
}

/// The least sum of steps of any strategy whose paths have so many.
fn least(problem: &Problem, brute: &Brute<'_>, steps: &[usize]) -> Option<usize> {
    let mut best = None;
    let mut chosen: Vec<&Path> = Vec::new();
    tuples(brute, &mut chosen, steps.len(), &mut |chosen| {
        let of = |(path, &steps): (&&Path, &usize)| absorbed(problem, &path.states, steps);
        let sum: usize = chosen.iter().zip(steps).map(of).sum();
        if best.is_none_or(|best| sum < best) && brute.holds(&mut chosen.to_vec()) {
            best = Some(sum);
        }
    });
    best
}

fn tuples<'b>(
    brute: &'b Brute<'_>,
    chosen: &mut Vec<&'b Path>,
    count: usize,
    f: &mut impl FnMut(&[&'b Path]),
) {
    if chosen.len() == count {
        return f(chosen);
    }
    for path in &brute.paths {
        chosen.push(path);
        tuples(brute, chosen, count, f);
        chosen.pop();
    }
}

/// The problem with what has to be met at last met by a time; `None` where some of it comes later.
fn sooner(problem: &Problem, time: u32) -> Option<Problem> {
    let cut = |formula: &Formula| {
        let shorter = |interval: &Option<(u32, u32)>| match *interval {
            None => Some(Some((0, time))),
            Some((0, hi)) => Some(Some((0, hi.min(time)))),
            Some(_) => None,
        };
        Some(match formula {
            Formula::Finally(i, a) => Formula::Finally(shorter(i)?, a.clone()),
            Formula::Until(i, a, b) => Formula::Until(shorter(i)?, a.clone(), b.clone()),
            // An until by another name.
            Formula::StrongRelease(i, a, b) => Formula::StrongRelease(shorter(i)?, a.clone(), b.clone()),
            other => other.clone(),
        })
    };
    fn conjuncts(formula: &Formula) -> Vec<Formula> {
        match formula {
            Formula::And(all) => all.iter().flat_map(conjuncts).collect(),
            other => vec![other.clone()],
        }
    }
    let parts: Option<Vec<Formula>> = conjuncts(&problem.formula).iter().map(cut).collect();
    Some(Problem { formula: Formula::And(parts?), ..problem.clone() })
}

#[test]
fn detours_are_taken_out() {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", 1_500);
    let (mut shorter, mut absorbing, mut owing) = (0, 0, 0);
    for seed in first..first + cases {
        let problem = errand(&mut Random::new(seed));
        let Some(brute) = Brute::new(&problem, MOST) else { continue };
        let tuples = brute.paths.len().checked_pow(u32::try_from(problem.exists.len()).unwrap_or(u32::MAX));
        if tuples.is_none_or(|tuples| tuples > MOST) || !brute.verdict() {
            continue;
        }
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let deadline = Deadline::after(Duration::from_secs(60));
        let config = Config { deadline: deadline.clone(), ..Config::new(Spec::Builtin) };
        let found = solve(&typed, objective, &config).expect("it is supported");
        assert_eq!(found.verdict, Verdict::Realizable, "seed {seed}\n{problem}");
        let before = found.witness.clone().expect("a strategy");
        let straight = straightened(&typed, objective, found, &config, &deadline);
        let after = straight.outcome.witness.clone().expect("a strategy");
        let about =
            format!("seed {seed}\n{problem}\nbefore {before:?}\nafter {after:?} {:?}", straight.steps);
        assert_eq!(wrong(Ok(straight.outcome), &problem, &brute, &typed, true), None, "{about}");
        shorter += u32::from(before != after);
        let Some((rest, steps)) = straight.steps else {
            assert_eq!(before, after, "{about}");
            continue;
        };
        let sum = |strategy: &Strategy| -> usize {
            let steps = |trace: &hyperplan_problem::Trace| {
                let place = |state: &hyperplan_problem::State| place(&problem, state);
                let states: Vec<usize> = trace.states.iter().map(place).collect();
                absorbed(&problem, &states, trace.actions.len())
            };
            strategy.traces.iter().map(steps).sum()
        };
        let lengths: Vec<usize> = after.traces.iter().map(|trace| trace.actions.len()).collect();
        match rest {
            Rest::Absorbed => {
                assert_eq!(sum(&after) as u64, steps, "{about}");
                assert!(sum(&after) <= sum(&before), "{about}");
                if straight.least {
                    absorbing += 1;
                    assert_eq!(least(&problem, &brute, &lengths), Some(sum(&after)), "{about}");
                }
            }
            Rest::Owing if straight.least && leading(&problem) == 1 => {
                let time = u32::try_from(steps).expect("few steps");
                let realizable = |time| {
                    let sooner = sooner(&problem, time)?;
                    Some(Brute::new(&sooner, MOST)?.verdict())
                };
                owing += 1;
                assert!(realizable(time) != Some(false), "{about}");
                assert!(time == 0 || realizable(time - 1) != Some(true), "{about}");
            }
            Rest::Owing => {}
        }
    }
    say(&format!(
        "seeds {first}..{}: {shorter} shortened, {absorbing} least until absorbed, {owing} until all is met",
        first + cases
    ));
    assert!(shorter > 5 && absorbing > 20 && owing > 20, "too little for the test to mean something");
}

/// A state by its number.
fn place(problem: &Problem, state: &hyperplan_problem::State) -> usize {
    use hyperplan_problem::Value;
    let index = |value: &Value| match value {
        Value::Bool(b) => usize::from(*b),
        Value::Int(n) => usize::try_from(*n).expect("values are few and small"),
        Value::Enum(i) => usize::try_from(*i).expect("values are few and small"),
        Value::Real(_) => panic!("systems are finite"),
    };
    let values: Vec<usize> = state.iter().take(problem.system.vars.len()).map(index).collect();
    problem.system.state(&values).expect("a state of the system")
}
