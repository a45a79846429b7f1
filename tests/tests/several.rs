//! Several answers on random problems, by brute force: those that are found are strategies, no two of them the same, and where it
//! is said that there are no others, they are as many as there are; that what is preferred is the best, and comes first.

use hyperplan_plan::{
    Config, Limits, More, Outcome, Quantifiers, Several, States, Value, Verdict, Wanted, cheapest, several,
    solve, straightened,
};
use hyperplan_problem::{CostId, Difference, PathId, Target};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_tests::brute::{Brute, Path};
use hyperplan_tests::judge::{lowered, path, wrong};
use hyperplan_tests::model::{Atom, Formula, Problem};
use hyperplan_tests::random::{self, Random};
use hyperplan_tests::{number, say};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

/// Most tuples of paths that brute force looks at.
const MOST: usize = 20_000;

/// Where there are more different strategies, so many are asked for.
const MANY: usize = 12;

/// A problem with states that absorb, often, and something to reach, often nothing else.
fn errand(random: &mut Random, mut problem: Problem) -> Problem {
    if random.once_in(2) {
        problem.system.absorb = random.subset(problem.system.states(), 3);
    }
    let simple = random.once_in(2);
    if simple {
        problem.semantics = None;
        problem.exists.iter_mut().for_each(|exists| *exists = true);
        problem.exists.truncate(2);
    }
    let horizon = problem.within.unwrap_or(problem.look);
    let paths = problem.exists.len();
    let interval = |random: &mut Random| match problem.within {
        Some(_) if random.once_in(2) => None,
        _ => Some((random.bound(2).min(horizon), horizon)),
    };
    let atom = |random: &mut Random, path: usize| {
        let label = random.below(problem.system.labels.len());
        Box::new(Formula::Atom(match random.below(4) {
            0 => Atom::Took(path, random.below(problem.system.actions.len())),
            _ => Atom::Label(path, label),
        }))
    };
    let mut parts = Vec::new();
    for path in 0..paths {
        let i = interval(random);
        match random.below(4) {
            0 => parts.push(Formula::Until(i, atom(random, path), atom(random, path))),
            1 => {
                let any = random.below(paths);
                parts.push(Formula::Globally(i, atom(random, any)));
            }
            _ => {}
        }
        parts.push(Formula::Finally(i, atom(random, path)));
    }
    if simple {
        parts.truncate(1 + random.below(parts.len()));
    } else {
        parts.truncate(random.below(2));
        parts.push(problem.formula.clone());
    }
    problem.formula = Formula::And(parts);
    problem
}

/// What single paths have to reach, if that and what always holds is all that the formula says.
fn errands(problem: &Problem) -> Option<Vec<(usize, Formula)>> {
    if problem.semantics.is_some() || problem.exists.contains(&false) {
        return None;
    }
    let mut found = Vec::new();
    for part in conjuncts(&problem.formula) {
        let operands: Vec<Formula> = match &part {
            Formula::Finally(_, a) | Formula::Globally(_, a) => vec![(**a).clone()],
            Formula::Until(_, a, b) | Formula::StrongRelease(_, a, b) => vec![(**a).clone(), (**b).clone()],
            other => vec![other.clone()],
        };
        let mut paths = Some(BTreeSet::new());
        if !operands.iter().all(|operand| timeless(operand, &mut paths)) {
            return None;
        }
        if matches!(part, Formula::Finally(..) | Formula::Until(..) | Formula::StrongRelease(..)) {
            let paths = paths?;
            let [path] = paths.iter().copied().collect::<Vec<_>>()[..] else { return None };
            found.push((path, part));
        }
    }
    (!found.is_empty()).then_some(found)
}

fn conjuncts(formula: &Formula) -> Vec<Formula> {
    match formula {
        Formula::And(all) => all.iter().flat_map(conjuncts).collect(),
        other => vec![other.clone()],
    }
}

/// Whether a formula has no operators over time; and the paths that it reads, if it reads nothing but single ones.
fn timeless(formula: &Formula, paths: &mut Option<BTreeSet<usize>>) -> bool {
    let mut reads = |own: &[usize]| {
        if let Some(paths) = paths {
            paths.extend(own);
        }
    };
    match formula {
        Formula::Atom(atom) => match *atom {
            Atom::Label(p, _) | Atom::Is(p, ..) | Atom::Took(p, _) => reads(&[p]),
            Atom::Choice(p, ..) | Atom::Coded(p, ..) => reads(&[p]),
            Atom::Less(p, _, q, _) | Atom::SameValue(p, q, _) | Atom::SameObs(p, q) => reads(&[p, q]),
            Atom::SameAction(p, q) | Atom::SameState(p, q) if p == q => {}
            _ => *paths = None,
        },
        Formula::Not(a) => return timeless(a, paths),
        Formula::And(all) | Formula::Or(all) => {
            let all: Vec<bool> = all.iter().map(|a| timeless(a, paths)).collect();
            return !all.contains(&false);
        }
        Formula::Implies(a, b) | Formula::Iff(a, b) => {
            let (a, b) = (timeless(a, paths), timeless(b, paths));
            return a && b;
        }
        _ => return false,
    }
    true
}

/// The first time by which something was reached.
fn reached(brute: &Brute<'_>, errand: &Formula, paths: &[&Path]) -> usize {
    let steps = paths[0].actions.len();
    let shorter = |time: usize| {
        let cut = |i: &Option<(u32, u32)>| {
            let (lo, hi) = i.unwrap_or((0, u32::MAX));
            let time = u32::try_from(time).expect("few steps");
            (lo <= time).then_some(Some((lo, hi.min(time))))
        };
        Some(match errand {
            Formula::Finally(i, a) => Formula::Finally(cut(i)?, a.clone()),
            Formula::Until(i, a, b) => Formula::Until(cut(i)?, a.clone(), b.clone()),
            Formula::StrongRelease(i, a, b) => Formula::StrongRelease(cut(i)?, a.clone(), b.clone()),
            _ => panic!("it is no errand"),
        })
    };
    let by = |time: &usize| shorter(*time).is_some_and(|cut| brute.eval(&cut, paths, 0));
    (0..=steps).find(by).unwrap_or(usize::MAX)
}

type Words = Vec<(usize, Vec<usize>)>;

/// What tells a strategy from others: of each path how long it counts, and the states or actions until then. So many steps of
/// each path are planned.
fn words(problem: &Problem, brute: &Brute<'_>, paths: &[&Path], steps: &[usize], what: Difference) -> Words {
    let errands = errands(problem);
    let word = |(index, path): (usize, &&Path)| {
        let mut rest = steps[index];
        let absorbed = path.states.iter().position(|state| problem.system.absorb.contains(state));
        rest = absorbed.into_iter().fold(rest, usize::min);
        if let Some(errands) = &errands {
            let own = errands.iter().any(|(path, _)| *path == index);
            let mine = errands.iter().filter(|(path, _)| !own || *path == index);
            let last = mine.map(|(_, errand)| reached(brute, errand, paths)).max().unwrap_or(0);
            rest = rest.min(last);
        }
        match what {
            Difference::Cells => (rest, path.states[..=rest].to_vec()),
            Difference::Actions => (rest, path.actions[..rest].to_vec()),
        }
    };
    paths.iter().enumerate().map(word).collect()
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

/// A path as brute force knows it, which is as long as the longest.
fn whole(brute: &Brute<'_>, own: &Path) -> Path {
    let begins = |p: &&Path| p.states.starts_with(&own.states) && p.actions.starts_with(&own.actions);
    brute.paths.iter().find(begins).expect("it goes on").clone()
}

/// The problem by brute force, if it is not too large.
fn brute(problem: &Problem) -> Option<Brute<'_>> {
    let brute = Brute::new(problem, MOST)?;
    let count = brute.paths.len().checked_pow(u32::try_from(problem.exists.len()).unwrap_or(u32::MAX));
    count.is_some_and(|count| count <= MOST).then_some(brute)
}

/// One of the ways to search, of which some take longer and come less often.
fn way(seed: u64) -> Config {
    let usual = Limits::default();
    let (quantifiers, states, limits) = match seed % 8 {
        0 => (
            Quantifiers::Cegis,
            Some(States::Onehot),
            Limits { pruning: hyperplan_plan::Pruning::Light, ..usual },
        ),
        1 => (Quantifiers::Auto, Some(States::Bitvec), usual),
        2 => (Quantifiers::Expand, Some(States::Onehot), usual),
        3 => (Quantifiers::Auto, None, Limits { residuals: 8, layer_states: 40, pairs: 12, ..usual }),
        _ => (Quantifiers::Auto, None, usual),
    };
    let deadline = Deadline::after(Duration::from_secs(60));
    Config { quantifiers, states, limits, deadline, ..Config::new(Spec::Builtin) }
}

#[test]
fn there_are_as_many_as_there_are() {
    let first = number("HYPERPLAN_SEED", 20_261_128);
    let cases = number("HYPERPLAN_CASES", 1_200);
    let (mut all, mut several_of, mut many, mut resting, mut against) = (0, 0, 0, 0, 0);
    for seed in first..first + cases {
        let random = &mut Random::new(seed);
        let base = random::problem(random);
        let problem = errand(random, base);
        let exists = problem.exists[0];
        let Some(brute) = brute(&problem).filter(|brute| brute.verdict() == exists) else { continue };
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let config = way(seed);
        let found = solve(&typed, objective, &config).expect("it is supported");
        let straight = seed.is_multiple_of(2);
        let found = match straight {
            true => straightened(&typed, objective, found, &config, &config.deadline).outcome,
            false => found,
        };
        let difference = Difference::ALL[(seed / 3 % 2) as usize];
        let leading = problem.exists.iter().take_while(|e| **e == exists).count();
        let steps: Vec<usize> =
            found.witness.iter().flat_map(|s| &s.traces).map(|t| t.actions.len()).collect();
        let mut expected: BTreeSet<Words> = BTreeSet::new();
        tuples(&brute, &mut Vec::new(), leading, &mut |chosen| {
            if brute.holds(&mut chosen.to_vec()) == exists {
                expected.insert(words(&problem, &brute, chosen, &steps, difference));
            }
        });
        let number = (expected.len() + 1).min(MANY);
        let wanted = Wanted { number, difference, kept: &[], preferred: &[], straight };
        let answer = several(&typed, objective, &found, &wanted, &config);
        let answer = answer.unwrap_or_else(|error| panic!("seed {seed} {difference}: {error}\n{problem}"));
        let about = format!("seed {seed} {difference}\n{problem}\n{answer:#?}\n{expected:?}");
        let Several { others, more } = answer;
        let outcomes: Vec<Outcome> =
            [found].into_iter().chain(others.into_iter().map(|other| other.outcome)).collect();
        let mut seen: BTreeSet<Words> = BTreeSet::new();
        for outcome in outcomes {
            let witness = outcome.witness.clone().expect("it is a strategy");
            assert_eq!(outcome.verdict == Verdict::Realizable, exists, "{about}");
            assert_eq!(wrong(Ok(outcome), &problem, &brute, &typed, exists), None, "{about}");
            let paths: Vec<Path> =
                witness.traces.iter().map(|trace| path(&problem.system, &typed, trace)).collect();
            let paths: Vec<Path> = paths.iter().map(|own| whole(&brute, own)).collect();
            let paths: Vec<&Path> = paths.iter().collect();
            assert!(seen.insert(words(&problem, &brute, &paths, &steps, difference)), "twice: {about}");
        }
        match more {
            More::None => assert_eq!(seen, expected, "{about}"),
            More::Unasked => {
                assert_eq!(seen.len(), number, "{about}");
                assert!(seen.is_subset(&expected) && expected.len() >= MANY, "{about}");
            }
            More::Unknown(_) => panic!("undecided: {about}"),
        }
        all += 1;
        several_of += u32::from(expected.len() > 1);
        many += u32::from(expected.len() >= MANY);
        resting += u32::from(errands(&problem).is_some());
        against += u32::from(!exists);
    }
    say(&format!(
        "seeds {first}..{}: {all} problems, {several_of} with several answers, {many} with {MANY} or more, {resting} at rest \
         before they are absorbed, {against} counterexamples",
        first + cases
    ));
    assert!(
        several_of > 50 && many > 20 && resting > 20 && against > 20,
        "too little for the test to mean something"
    );
}

/// What is preferred is the least, of those with the least of what is to be minimized; and so on among the others.
#[test]
fn the_best_come_first() {
    let first = number("HYPERPLAN_SEED", 20_261_128);
    let cases = number("HYPERPLAN_CASES", 700);
    let (mut all, mut ordered, mut kept_of, mut alternating) = (0, 0, 0, 0);
    for seed in first..first + cases {
        let random = &mut Random::new(seed);
        let base = random::problem_with_costs(random, false);
        let problem = errand(random, base);
        let solved = |brute: &Brute<'_>| problem.exists[0] && brute.verdict();
        let Some(brute) = brute(&problem).filter(solved) else { continue };
        let leading = problem.exists.iter().take_while(|exists| **exists).count();
        let typed = lowered(&problem.to_string());
        let objective = &typed.objectives[0];
        let of = |path: usize| {
            let terms = vec![(1, PathId::from(path), CostId::from(0))];
            Target { terms, constant: 0, span: objective.span }
        };
        // What one path costs is to be minimized, and what another one costs is preferred.
        let minimized = usize::from(leading > 1 && random.once_in(2));
        let targets: Vec<Target> = (0..minimized).chain([minimized]).map(of).collect();
        let config = way(seed);
        let found = cheapest(&typed, objective, &targets, &config).expect("it is supported");
        assert!(found.undecided.is_none(), "seed {seed}\n{problem}");
        let difference = Difference::ALL[(seed / 3 % 2) as usize];
        let traces: Vec<_> = found.outcome.witness.iter().flat_map(|s| &s.traces).collect();
        let steps: Vec<usize> = traces.iter().map(|trace| trace.actions.len()).collect();
        // The least cost of each that differs, of those with the least of what is to be minimized.
        let mut classes: BTreeMap<(usize, Words), usize> = BTreeMap::new();
        tuples(&brute, &mut Vec::new(), leading, &mut |chosen| {
            if brute.holds(&mut chosen.to_vec()) {
                let cost = |path: usize| brute.cost(chosen[path], steps[path]);
                let key =
                    ((0..minimized).map(cost).sum(), words(&problem, &brute, chosen, &steps, difference));
                let least = classes.entry(key).or_insert(usize::MAX);
                *least = cost(minimized).min(*least);
            }
        });
        let least = classes.keys().map(|(cost, _)| *cost).min().expect("there is one");
        let mut expected: Vec<usize> =
            classes.iter().filter(|((cost, _), _)| *cost == least).map(|(_, cost)| *cost).collect();
        expected.sort_unstable();
        let number = (expected.len() + 1).min(6);
        let kept: Vec<(Target, i64)> =
            targets[..minimized].iter().cloned().zip(found.values.iter().map(|value| value.found)).collect();
        let preferred = &targets[minimized..];
        let wanted = Wanted { number, difference, kept: &kept, preferred, straight: false };
        let answer = several(&typed, objective, &found.outcome, &wanted, &config).expect("it is supported");
        let about = format!("seed {seed} {difference}\n{problem}\n{found:?}\n{answer:#?}");
        let value = |value: &Value| (value.found, value.least);
        let mut values: Vec<(i64, i64)> = found.values[minimized..].iter().map(value).collect();
        values.extend(answer.others.iter().flat_map(|other| &other.values).map(value));
        let both =
            |cost: &usize| (i64::try_from(*cost).expect("small"), i64::try_from(*cost).expect("small"));
        let expected: Vec<(i64, i64)> = expected.iter().map(both).collect();
        assert_eq!(values, expected[..expected.len().min(number)], "{about}");
        match answer.more {
            More::None => assert!(number > expected.len(), "{about}"),
            More::Unasked => assert!(number <= expected.len(), "{about}"),
            More::Unknown(_) => panic!("undecided: {about}"),
        }
        for other in answer.others {
            assert_eq!(wrong(Ok(other.outcome), &problem, &brute, &typed, true), None, "{about}");
        }
        all += 1;
        ordered += u32::from(values.windows(2).any(|pair| pair[0] != pair[1]));
        kept_of += u32::from(minimized > 0);
        alternating += u32::from(problem.exists.contains(&false));
    }
    say(&format!(
        "seeds {first}..{}: {all} problems, {ordered} whose answers are not all alike, {kept_of} with something to minimize \
         besides, {alternating} with `forall`",
        first + cases
    ));
    assert!(
        all > 100 && ordered > 30 && kept_of > 10 && alternating > 10,
        "too little for the test to mean something"
    );
}
