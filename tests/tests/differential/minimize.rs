//! The least value of a constant against brute force: random problems in which bounds grow with the constant.

use super::seeds;
use hyperplan_plan::{Config, Least, Quantifiers, Verdict, minimize};
use hyperplan_problem as typed;
use hyperplan_solver::Spec;
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::{lowered, wrong};
use hyperplan_tests::model::{Formula, Interval, Problem};
use hyperplan_tests::random::{Random, problem};
use hyperplan_tests::say;
use std::convert::Infallible;

/// The greatest value of the constant.
const LAST: u32 = 3;

/// Most tuples of paths that brute force looks at.
const MOST_TUPLES: usize = 5_000;

/// By how much each interval's ends, in the order of the formula, and the length grow with the constant.
struct Growth {
    intervals: Vec<(u32, u32)>,
    within: u32,
}

impl Growth {
    fn random(problem: &Problem, random: &mut Random) -> Growth {
        let mut count = 0;
        grown(&problem.formula, &mut |interval| {
            count += usize::from(interval.is_some());
            interval
        });
        let mut intervals = vec![(0, 0); count];
        for _ in 0..count.min(2) {
            // No interval becomes empty.
            intervals[random.below(count)] = if random.below(4) == 0 { (1, 1) } else { (0, 1) };
        }
        Growth { intervals, within: u32::from(random.below(3) > 0) }
    }

    /// The problem for a value of the constant.
    fn at(&self, problem: &Problem, value: u32) -> Problem {
        let mut growths = self.intervals.iter();
        let formula = grown(&problem.formula, &mut |interval| {
            let (lo, hi) = interval?;
            let (low, high) = growths.next()?;
            Some((lo + low * value, hi + high * value))
        });
        let look = problem.look + value * self.intervals.iter().map(|(_, high)| high).sum::<u32>();
        let within = problem.within.map(|steps| steps + value * self.within);
        Problem { formula, look, within, ..problem.clone() }
    }
}

/// The formula with other intervals; each is asked for once, in a fixed order.
fn grown(formula: &Formula, interval: &mut dyn FnMut(Interval) -> Interval) -> Formula {
    use Formula::{
        And, Atom, Finally, Globally, Iff, Implies, Next, Not, Or, Release, StrongRelease, Until, WeakNext,
        WeakUntil,
    };
    let mut sub = |f: &Formula| Box::new(grown(f, interval));
    match formula {
        Atom(atom) => Atom(atom.clone()),
        Not(a) => Not(sub(a)),
        Next(a) => Next(sub(a)),
        WeakNext(a) => WeakNext(sub(a)),
        And(fs) => And(fs.iter().map(|f| *sub(f)).collect()),
        Or(fs) => Or(fs.iter().map(|f| *sub(f)).collect()),
        Implies(a, b) => Implies(sub(a), sub(b)),
        Iff(a, b) => Iff(sub(a), sub(b)),
        Finally(i, a) => Finally(interval(*i), Box::new(grown(a, interval))),
        Globally(i, a) => Globally(interval(*i), Box::new(grown(a, interval))),
        Until(i, a, b) => Until(interval(*i), Box::new(grown(a, interval)), Box::new(grown(b, interval))),
        Release(i, a, b) => Release(interval(*i), Box::new(grown(a, interval)), Box::new(grown(b, interval))),
        WeakUntil(i, a, b) => {
            WeakUntil(interval(*i), Box::new(grown(a, interval)), Box::new(grown(b, interval)))
        }
        StrongRelease(i, a, b) => {
            StrongRelease(interval(*i), Box::new(grown(a, interval)), Box::new(grown(b, interval)))
        }
    }
}

/// The truth for each value; `None` where that takes too long.
fn verdicts(problem: &Problem, growth: &Growth) -> Option<Vec<bool>> {
    let verdict = |value| {
        let problem = growth.at(problem, value);
        let brute = Brute::new(&problem, MOST_TUPLES)?;
        let paths = u32::try_from(problem.exists.len()).ok()?;
        let tuples = brute.paths.len().checked_pow(paths)?;
        (tuples <= MOST_TUPLES).then(|| brute.verdict())
    };
    (0..=LAST).map(verdict).collect()
}

fn least(problem: &Problem, growth: &Growth, quantifiers: Quantifiers) -> Least {
    let config = Config { quantifiers, ..Config::new(Spec::Builtin) };
    least_of(problem, growth, &config, u32::MAX)
}

/// The same with a search that is cancelled once so many problems have been asked for.
fn least_of(problem: &Problem, growth: &Growth, config: &Config, cut: u32) -> Least {
    let mut asked = 0;
    let name = lowered(&problem.to_string()).objectives[0].name.clone();
    let mut family = |value: i64| -> Result<typed::Problem, Infallible> {
        let value = u32::try_from(value).expect("a value of the range");
        asked += 1;
        if asked > cut {
            config.deadline.cancel();
        }
        Ok(lowered(&growth.at(problem, value).to_string()))
    };
    let found = minimize(&name, 0..=i64::from(LAST), &mut family, config);
    found.unwrap_or_else(|error| panic!("{error}\n{problem}"))
}

/// Wherever a search is cut off, what it says is so, and it keeps nothing to itself that it has found.
#[test]
fn a_search_that_is_cut_off_says_what_is_known() {
    let (mut open, mut above, mut nothing) = (0, 0, 0);
    for seed in seeds(600) {
        let mut random = Random::new(seed);
        let problem = problem(&mut random);
        if problem.exists.len() > 2 {
            continue;
        }
        let growth = Growth::random(&problem, &mut random);
        let Some(verdicts) = verdicts(&problem, &growth) else { continue };
        for cut in 1..8 {
            let config = Config::new(Spec::Builtin);
            let Least { value, proved, undecided, outcome, .. } = least_of(&problem, &growth, &config, cut);
            let about =
                format!("seed {seed}, cut {cut}, {value} {proved} {undecided:?} {verdicts:?}\n{problem}");
            let at = |value: i64| verdicts[usize::try_from(value).expect("a value of the range")];
            assert!((0..proved).all(|below| !at(below)), "{about}");
            let best = config.watch.standing().best;
            match outcome.verdict {
                Verdict::Realizable => {
                    assert!(at(value) && best.is_none_or(|best| value <= best), "{about}");
                    above += u32::from(undecided.is_some());
                }
                Verdict::Unrealizable => assert!(!at(value) && best.is_none(), "{about}"),
                Verdict::Unknown => {
                    assert!(undecided.is_some() && best.is_none(), "{best:?} was found: {about}");
                    nothing += 1;
                }
            }
            open += u32::from(undecided.is_some());
        }
    }
    say(&format!("{open} searches did not end, {above} of them with a value, {nothing} with none"));
    assert!(open < 100 || above > 5 && nothing > 50, "too uniform");
}

#[test]
fn the_least_value_is_that_of_brute_force() {
    least_value(3000);
}

pub(super) fn least_value(cases: u64) {
    // By least value, and how often a value above the least is unrealizable.
    let mut found = [0u32; LAST as usize + 2];
    let mut falls = 0;
    for seed in seeds(cases) {
        let mut random = Random::new(seed);
        let problem = problem(&mut random);
        // Long paths under three quantifiers take minutes by counterexamples.
        if problem.exists.len() > 2 {
            continue;
        }
        let growth = Growth::random(&problem, &mut random);
        let Some(verdicts) = verdicts(&problem, &growth) else { continue };
        let expected = verdicts.iter().position(|&verdict| verdict);
        found[expected.unwrap_or(LAST as usize + 1)] += 1;
        falls += u32::from(!verdicts.is_sorted());
        let quantifiers = [Quantifiers::Auto, Quantifiers::Cegis][random.below(2)];
        let Least { value, proved, undecided, outcome, problem: typed } =
            least(&problem, &growth, quantifiers);
        let what = || format!("seed {seed}, {verdicts:?}\n{}", growth.at(&problem, 1));
        assert!(undecided.is_none(), "{undecided:?}: {}", what());
        assert_eq!(
            value,
            expected.map_or(Ok(i64::from(LAST)), i64::try_from).expect("a small number"),
            "{}",
            what()
        );
        assert_eq!(proved, value, "{}", what());
        assert_eq!(outcome.verdict == Verdict::Realizable, expected.is_some(), "{}", what());
        let asked = growth.at(&problem, u32::try_from(value).expect("a value of the range"));
        let brute = Brute::new(&asked, usize::MAX / 8).expect("no limit");
        assert_eq!(wrong(Ok(outcome), &asked, &brute, &typed, expected.is_some()), None, "{}", what());
    }
    say(&format!("least values {found:?}; {falls} with a greater value that is unrealizable"));
    let all: u32 = found.iter().sum();
    assert!(all < 100 || (found[1..=LAST as usize].iter().all(|&n| n > 0) && falls > 10), "too uniform");
}
