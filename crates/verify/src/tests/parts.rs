//! What is known of an objective's parts as paths are read, against the naive evaluation of what they may still become.

use super::alternation::{Random, as_trace};
use super::build::{problem, system};
use super::naive::{Naive, Path};
use crate::{Budget, holds_at, progress_of};
use hyperplan_problem::{Mode, Node};

#[test]
fn what_is_known_of_a_part_is_so_however_paths_go_on() {
    let (mut decided, mut early) = (0, 0);
    for seed in 0..150 {
        let mut random = Random(hyperplan_random::Random::new(seed));
        let (edges, look) = (random.edges(), 3);
        let f = random.formula(2, 2, look);
        for mode in [Mode::Bounded, Mode::Within(3)] {
            let init = [0];
            let naive = Naive { states: 3, edges: &edges, init: &init, mode, steps: look };
            let paths = naive.paths();
            if paths.is_empty() {
                continue;
            }
            let chosen: [&Path; 2] = [0, 1].map(|_| &paths[random.below(paths.len() as u32) as usize]);
            let problem = problem(system(3, 2, &edges, &init), "ea", mode, &f);
            let objective = &problem.objectives[0];
            let traces = [as_trace(0, chosen[0]), as_trace(1, chosen[1])];
            let root = objective.formula.root();
            let known = progress_of(&problem, objective, &traces, &[root], &Budget::default());
            let known = known.expect("well-formed").expect("small").remove(0);
            assert_eq!(known.len(), look as usize + 1);
            let truth = naive.holds("", &chosen, &f);
            assert_eq!(known[look as usize], Some(truth), "{f:?} {edges:?} {mode:?}");
            let first = known.iter().position(Option::is_some).expect("at the end it is known");
            assert!(known[first..].iter().all(|known| *known == Some(truth)), "{known:?}");
            // Whatever goes on as the two do up to there.
            let same = |a: &Path, b: &Path| a[..=first] == b[..=first];
            for p in paths.iter().filter(|path| same(path, chosen[0])) {
                for q in paths.iter().filter(|path| same(path, chosen[1])) {
                    assert_eq!(naive.holds("", &[p, q], &f), truth, "{f:?} {edges:?} {mode:?}");
                }
            }
            decided += 1;
            early += usize::from(first < look as usize);
            // An atom says what holds at each time.
            let atoms = objective.formula.nodes.iter_enumerated();
            let atoms: Vec<_> =
                atoms.filter(|(_, node)| matches!(node, Node::Atom(_))).map(|(id, _)| id).collect();
            let now = holds_at(&problem, objective, &traces, &atoms, &Budget::default());
            let now = now.expect("well-formed").expect("small");
            assert!(now.iter().flatten().all(Option::is_some), "{now:?}");
            // With one path, what reads the other is open.
            let alone = holds_at(&problem, objective, &traces[..1], &atoms, &Budget::default());
            let alone = alone.expect("well-formed").expect("small");
            assert!(
                alone
                    .iter()
                    .zip(&now)
                    .all(|(alone, both)| alone.iter().zip(both).all(|(a, b)| a.is_none() || a == b))
            );
        }
    }
    assert!(decided > 100 && early > 20, "{decided} {early}");
}
