//! Alternations of quantifiers, against the naive enumeration.

use super::build::{F, b, problem, strategy, system, trace};
use super::naive::{Naive, Path};
use crate::{Budget, Check, Defeat, check, decide};
use hyperplan_problem::{Mode, Quantifier};
use hyperplan_syntax::ast::BinaryOp;

#[test]
fn an_inner_path_may_know_the_future_of_an_outer_one() {
    // (X a[r]) <-> (X X a[q]), with a free: r's first action announces q's second.
    let free = || system(1, 2, &[(0, 0, 0), (0, 1, 0)], &[0]);
    let announce = F::Iff(b(F::X(b(F::Took(1, 0)))), b(F::X(b(F::X(b(F::Took(0, 0)))))));
    let known = problem(free(), "ae", Mode::Bounded, &announce);
    assert_eq!(decide(&known, &known.objectives[0], &Budget::default()), Ok(Some(true)));
    // The other way round r would have to guess.
    let guess = problem(free(), "ea", Mode::Bounded, &announce);
    assert_eq!(decide(&guess, &guess.objectives[0], &Budget::default()), Ok(Some(false)));
}

pub(crate) struct Random(pub(crate) hyperplan_random::Random);

impl Random {
    pub(crate) fn below(&mut self, n: u32) -> u32 {
        self.0.bound(n)
    }

    pub(crate) fn formula(&mut self, paths: u32, depth: u32, look: u32) -> F {
        let p = self.below(paths);
        let q = self.below(paths);
        if depth == 0 {
            return match self.below(6) {
                0 | 1 => F::At(p, i64::from(self.below(3))),
                2 => F::Took(p, self.below(2)),
                3 => F::SameAction(p, q),
                4 => F::SameState(p, q),
                _ => F::Enabled(p, self.below(2)),
            };
        }
        let kind = self.below(if look == 0 { 5 } else { 11 });
        let lo = self.below(look + 1);
        let hi = lo + self.below(look - lo + 1);
        let later = look.saturating_sub(if kind < 5 {
            0
        } else if kind < 7 {
            1
        } else {
            hi
        });
        let mut sub = || b(self.formula(paths, depth - 1, later));
        match kind {
            0 => F::Not(sub()),
            1 => F::And(vec![*sub(), *sub()]),
            2 => F::Or(vec![*sub(), *sub()]),
            3 => F::Implies(sub(), sub()),
            4 => F::Iff(sub(), sub()),
            5 => F::X(sub()),
            6 => F::N(sub()),
            7 => F::Fin(lo, Some(hi), sub()),
            8 => F::Glob(lo, Some(hi), sub()),
            9 => F::Bin(BinaryOp::Until, lo, Some(hi), sub(), sub()),
            _ => {
                const OTHERS: [BinaryOp; 3] =
                    [BinaryOp::Release, BinaryOp::WeakUntil, BinaryOp::StrongRelease];
                let op = OTHERS[self.below(3) as usize];
                let lhs = b(self.formula(paths, depth - 1, later));
                F::Bin(op, lo, Some(hi), lhs, b(self.formula(paths, depth - 1, later)))
            }
        }
    }

    pub(crate) fn edges(&mut self) -> Vec<(i64, u32, i64)> {
        let count = 3 + self.below(4);
        let mut edges = Vec::new();
        for _ in 0..count {
            edges.push((i64::from(self.below(3)), self.below(2), i64::from(self.below(3))));
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

pub(crate) fn as_trace(index: usize, path: &Path) -> hyperplan_problem::Trace {
    let states: Vec<i64> = path.iter().map(|p| p.0).collect();
    let actions: Vec<u32> = path.iter().filter_map(|p| p.1).collect();
    trace(u32::try_from(index).unwrap(), &states, &actions)
}

#[test]
fn up_to_three_blocks_agree_with_enumeration() {
    let mut random = Random(hyperplan_random::Random::new(1));
    let prefixes = ["e", "a", "ee", "ea", "ae", "aa", "eae", "aea", "eea", "aee", "eaa", "aae"];
    let (mut truths, mut cases, mut strategies) = (0, 0, 0);
    for _ in 0..3000 {
        let prefix = prefixes[random.below(12) as usize];
        let edges = random.edges();
        let init: &[i64] = [&[0][..], &[0, 1], &[0, 1, 2]][random.below(3) as usize];
        let bounded = random.below(2) == 0;
        let steps = if prefix.len() == 3 { 2 } else { 3 };
        let mode = if bounded { Mode::Bounded } else { Mode::Within(steps) };
        let depth = 2 + random.below(2);
        let f = random.formula(u32::try_from(prefix.len()).unwrap(), depth, if bounded { steps } else { 4 });
        let problem = problem(system(3, 2, &edges, init), prefix, mode, &f);
        let naive = Naive { states: 3, edges: &edges, init, mode, steps };
        let all = naive.paths();
        if all.len() > 40 {
            continue;
        }
        let expected = naive.holds(prefix, &[], &f);
        let objective = &problem.objectives[0];
        let answer = decide(&problem, objective, &Budget::default());
        assert_eq!(answer, Ok(Some(expected)), "{prefix} {mode:?} {edges:?} {init:?} {f:?}");
        cases += 1;
        truths += u32::from(expected);
        if objective.leading_block().len() > 1 {
            continue;
        }
        // Each path is a strategy, or is not and is defeated by a path.
        let claimed = objective.paths[hyperplan_problem::PathId(0)].quantifier == Quantifier::Exists;
        for path in all.iter().take(3) {
            strategies += 1;
            let good = naive.holds(&prefix[1..], &[path], &f) == claimed;
            let verdict = check(&problem, objective, &strategy(&[as_trace(0, path)]), &Budget::default());
            match verdict.unwrap() {
                Check::Holds => assert!(good, "{prefix} {mode:?} {edges:?} {path:?} {f:?}"),
                Check::Fails(Defeat::Paths(traces)) => {
                    assert!(!good, "{prefix} {mode:?} {edges:?} {path:?} {f:?}");
                    assert_eq!(
                        traces.len(),
                        prefix[1..].chars().filter(|&c| prefix[1..].starts_with(c)).count()
                    );
                    let block = traces.len();
                    let extended: Vec<Vec<&Path>> = traces
                        .iter()
                        .map(|t| {
                            all.iter().filter(|p| as_trace(t.path.0 as usize, p).starts_with(t)).collect()
                        })
                        .collect();
                    // Every continuation of the defeating paths defeats it.
                    for first in &extended[0] {
                        let seconds: Vec<&Path> = extended.get(1).map_or(vec![*first], Clone::clone);
                        for second in seconds {
                            let chosen = [path, first, second];
                            let rest = naive.holds(&prefix[1 + block..], &chosen[..=block], &f);
                            assert_ne!(rest, claimed, "{prefix} {mode:?} {edges:?} {chosen:?} {f:?}");
                        }
                    }
                    assert!(extended.iter().all(|e| !e.is_empty()), "a defeat must be a path");
                }
                Check::Fails(Defeat::Formula) => assert!(!good && prefix.len() == 1),
                other => panic!("{other:?}"),
            }
        }
    }
    assert!(cases > 1000 && truths * 5 > cases && truths * 5 < cases * 4, "{truths} of {cases} are true");
    assert!(strategies > 1000);
}

trait StartsWith {
    fn starts_with(&self, other: &Self) -> bool;
}

impl StartsWith for hyperplan_problem::Trace {
    fn starts_with(&self, other: &Self) -> bool {
        self.states.starts_with(&other.states) && self.actions.starts_with(&other.actions)
    }
}
