use super::Game;
use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::layers;
use crate::task::Arena;
use crate::tests::{alone, arena, problem};
use hyperplan_problem::PathId;
use rustc_hash::FxHashMap;

/// A path that begins one step behind another, on a line; both stop at its end.
const LINE: &str = "
    system Line {
      state x: 0..4;
      action left, right;
      absorb x == 4;
      on left when x > 0 { x' = x - 1; }
      on left when x == 0 {}
      on right { x' = x + 1; }
    }
    objective o within STEPS {
      exists p. forall q. x[p] == 0 & (x[q] == 1 & G action[p] == action[q] -> F x[q] == 4)
    }";

/// A path at home says twice left or right, and the other, elsewhere, must be told the same twice.
const TWICE: &str = "
    system World {
      state at: {home, start, said_left, said_right, goal, pit};
      action left, right;
      init at == home | at == start;
      absorb at == home | at == goal | at == pit;
      on left when at == start { at' = said_left; }
      on right when at == start { at' = said_right; }
      on left when at == said_left { at' = goal; }
      on right when at == said_left { at' = pit; }
      on right when at == said_right { at' = goal; }
      on left when at == said_right { at' = pit; }
    }
    objective o within STEPS {
      exists p. forall q. at[p] == home & (at[q] == start & G action[p] == action[q] -> F at[q] == goal)
    }";

/// The game of p and q in the problem, where the exploration of p alone leaves everything in.
fn game(text: &str, steps: u32, slack: Option<u32>, test: impl FnOnce(&Arena<'_>, Game)) {
    let problem = problem(&text.replace("STEPS", &steps.to_string()));
    let arena = arena(&problem);
    let formula = &arena.task.objective.formula;
    let goal = Goal::new(formula, true);
    let [p, q] = [PathId::from(0), PathId::from(1)];
    let (_, rest) = goal.split(formula, &|path| path == p);
    let nothing = FxHashMap::default();
    let alone = alone(&arena, p, &goal, &nothing);
    let [within] = layers(&alone).expect("the problem is small").layers;
    let against = rest.opposed(formula);
    let mut question = alone.about([p, q]);
    (question.within, question.goal, question.slack) = ([Some(&within), None], &against, slack);
    test(&arena, Game::new(&question).expect("the paths are tied"));
}

fn rows(arena: &Arena<'_>, layers: &Layers) -> Vec<Vec<Vec<i64>>> {
    let graph = &arena.graphs[PathId::from(0)];
    let rows = |states: &Vec<u32>| states.iter().map(|&state| graph.codes(state).into()).collect();
    layers.at.iter().map(rows).collect()
}

#[test]
fn the_value_is_the_distance_of_the_other_path() {
    for steps in 0..7 {
        game(LINE, steps, None, |_, game| {
            assert_eq!(game.value(), (steps >= 3).then_some(3), "{steps} steps");
            assert_eq!(game.layers().at.iter().any(Vec::is_empty), steps < 3, "{steps} steps");
            assert!(!game.lossy);
        });
    }
}

#[test]
fn only_moves_in_time_remain() {
    let straight: Vec<Vec<Vec<i64>>> = (0..4).map(|x| vec![vec![x]]).collect();
    game(LINE, 3, None, |arena, game| {
        assert_eq!(rows(arena, &game.layers()), straight);
        assert!(!game.lossy);
    });
    // With more time p may do more, but not if q has to be there as soon as it can be.
    game(LINE, 5, None, |arena, game| {
        assert!(rows(arena, &game.layers())[1].len() > 1);
        assert!(!game.lossy);
    });
    game(LINE, 5, Some(0), |arena, game| {
        assert_eq!(rows(arena, &game.layers())[..4], straight);
        assert!(game.lossy);
    });
    game(LINE, 5, Some(2), |_, game| assert!(!game.lossy));
}

#[test]
fn moves_are_losing_only_where_the_other_path_is() {
    game(TWICE, 2, None, |arena, game| {
        assert_eq!(game.value(), Some(2));
        let graph = &arena.graphs[PathId::from(1)];
        assert!(game.losing_moves(0).is_empty());
        // What is at stake depends on what p has said, which its state does not tell.
        let mut found: Vec<(i64, u32)> = (game.losing_moves(1).iter())
            .map(|losing| {
                let (_, other) = losing.pair.expect("the other path is somewhere");
                (graph.codes(other)[0], losing.turn.letter.expect("p moves"))
            })
            .collect();
        found.sort_unstable();
        assert_eq!(found, [(2, 1), (3, 0)]);
        assert!((0..3).all(|time| game.closed(time).is_empty()));
        assert_eq!(game.pairs(1).len(), 2);
        assert!(game.pairs(2).is_empty(), "nothing is at stake at the end");
    });
}
