use super::{Layers, Question, layers};
use crate::goal::Goal;
use crate::{Encoder, Graphs, Limits};
use hyperplan_problem::{NoFiles, Overrides, PathId, read};
use hyperplan_syntax::SourceMap;
use rustc_hash::FxHashMap;
use std::cell::Cell;
use std::rc::Rc;

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
    let lowered = read(&mut SourceMap::new(), "walk.hp", WALK, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{:#?}", lowered.diagnostics);
    let problem = lowered.problem;
    let (stop, lossy) = (|| false, Cell::new(false));
    let objective = &problem.objectives[0];
    let encoder = Encoder::sharing(&problem, objective, None, Limits::default(), &stop, &Graphs::default())
        .expect("the problem is small");
    let [p, q] = [PathId::from(0), PathId::from(1)];
    let goal = Goal::new(&objective.formula, true);
    let nothing = FxHashMap::default();
    let question = |goal, declared, path, slack| Question {
        encoder: &encoder,
        paths: [path],
        within: [None],
        goal,
        fixed: &[None, None],
        declared,
        slack,
        least: 0,
        one_run: false,
        lossy: &lossy,
        budget: 1000,
    };
    let of_p = layers(&question(&goal, &nothing, p, slack)).expect("the walk is short");
    let declared = FxHashMap::from_iter([(p, Rc::new(of_p.clone()))]);
    let (_, rest) = goal.split(&objective.formula, &|path| path == p);
    let against = rest.opposed(&objective.formula);
    let of_q = layers(&question(&against, &declared, q, None)).expect("the walk is short");
    let range = |layers: Layers| {
        let graph = encoder.graph(p).expect("the system is small");
        let at = |states: &Vec<u32>| {
            let x = || states.iter().map(|&state| graph.row(state)[0]);
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
