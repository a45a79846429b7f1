use super::{Question, layers};
use crate::goal::Goal;
use crate::layers::Layers;
use crate::tests::{alone, arena, problem};
use hyperplan_problem::PathId;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// A walk of nine steps, of which twelve may be taken; no other may be faster.
const WALK: &str = "
    system Line {
      state x: 0..9;
      action left, right;
      on left when x > 0 { x' = x - 1; }
      on left when x == 0 {}
      on right when x < 9 { x' = x + 1; }
      on right when x == 9 {}
      absorb x == 9;
    }
    objective o {
      exists p. forall q. x[p] == 0 & F[0,12] x[p] == 9 & (x[q] == 0 -> (x[q] != 9 U[0,12] x[p] == 9))
    }";

/// The least and the greatest x at each time, of p and, beside it, of q.
fn ranges(slack: Option<u32>) -> [Vec<Option<(i64, i64)>>; 2] {
    let problem = problem(WALK);
    let arena = arena(&problem);
    let formula = &arena.task.objective.formula;
    let [p, q] = [PathId::from(0), PathId::from(1)];
    let (goal, nothing) = (Goal::new(formula, true), FxHashMap::default());
    let [of_p] =
        layers(&Question { slack, ..alone(&arena, p, &goal, &nothing) }).expect("it is short").layers;
    let declared = FxHashMap::from_iter([(p, Arc::new(of_p.clone()))]);
    let (_, rest) = goal.split(formula, &|path| path == p);
    let against = rest.opposed(formula);
    let [of_q] = layers(&alone(&arena, q, &against, &declared)).expect("it is short").layers;
    let range = |layers: Layers| {
        let at = |states: &Vec<u32>| {
            let x = || states.iter().map(|&state| arena.graphs[p].codes(state)[0]);
            x().min().zip(x().max())
        };
        layers.at.iter().map(at).collect()
    };
    [range(of_p), range(of_q)]
}

#[test]
fn only_what_is_in_time_is_visited() {
    let [p, _] = ranges(None);
    let expected = (0..=12).map(|time: i64| Some(((time - 3).max(0), time.min(9))));
    assert_eq!(p, expected.collect::<Vec<_>>());
    let [p, _] = ranges(Some(0));
    assert_eq!(p, (0..=12).map(|time: i64| Some((time.min(9), time.min(9)))).collect::<Vec<_>>());
}

#[test]
fn what_the_first_path_has_done_settles_what_the_second_can_do() {
    // p is there at time 9, and nobody can be there before.
    let [_, q] = ranges(Some(0));
    assert!(q.iter().all(Option::is_none), "{q:?}");
    // p may be there at time 11, so q must have been there at 10, or it does not matter.
    let [_, q] = ranges(Some(2));
    assert_eq!(q[..11].to_vec(), (0..11).map(|t: i64| Some(((t - 1).max(0), t.min(9)))).collect::<Vec<_>>());
}
