use super::Game;
use crate::goal::Goal;
use crate::reach::{Question, layers};
use crate::{Encoder, Graphs, Layers, Limits, Row};
use hyperplan_problem::{NoFiles, Overrides, PathId, Problem, read};
use hyperplan_syntax::SourceMap;
use rustc_hash::FxHashMap;
use std::cell::Cell;

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

fn problem(text: &str, steps: u32) -> Problem {
    let text = text.replace("STEPS", &steps.to_string());
    let lowered = read(&mut SourceMap::new(), "game.hp", &text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{:#?}", lowered.diagnostics);
    lowered.problem
}

/// The game of p and q in the problem, where the exploration of p alone leaves everything in.
fn game(text: &str, steps: u32, slack: Option<u32>, test: impl FnOnce(&Encoder<'_>, Game, bool)) {
    let problem = problem(text, steps);
    let objective = &problem.objectives[0];
    let (stop, lossy) = (|| false, Cell::new(false));
    let encoder = Encoder::sharing(&problem, objective, None, Limits::default(), &stop, &Graphs::default())
        .expect("the problem is small");
    let formula = &objective.formula;
    let goal = Goal::new(formula, true);
    let [p, q] = [PathId::from(0), PathId::from(1)];
    let (_, rest) = goal.split(formula, &|path| path == p);
    let alone = Question {
        encoder: &encoder,
        paths: [p],
        within: [None],
        goal: &goal,
        fixed: &[None, None],
        declared: &FxHashMap::default(),
        slack: None,
        least: 0,
        one_run: false,
        lossy: &lossy,
        budget: 1000,
    };
    let within = layers(&alone).expect("the problem is small");
    let against = rest.opposed(formula);
    let mut question = alone.about([p, q]);
    (question.within, question.goal, question.slack) = ([Some(&within), None], &against, slack);
    let game = Game::new(&question);
    test(&encoder, game.expect("the paths are tied"), lossy.get());
}

fn rows(encoder: &Encoder<'_>, layers: &Layers) -> Vec<Vec<Row>> {
    let graph = encoder.graph(PathId::from(0)).expect("the system is small");
    let rows = |states: &Vec<u32>| states.iter().map(|&state| graph.row(state).into()).collect();
    layers.at.iter().map(rows).collect()
}

#[test]
fn the_value_is_the_distance_of_the_other_path() {
    for steps in 0..7 {
        game(LINE, steps, None, |_, game, lossy| {
            assert_eq!(game.value(), (steps >= 3).then_some(3), "{steps} steps");
            assert_eq!(game.layers().at.iter().any(Vec::is_empty), steps < 3, "{steps} steps");
            assert!(!lossy);
        });
    }
}

#[test]
fn only_moves_in_time_remain() {
    let straight: Vec<Vec<Row>> = (0..4).map(|x| vec![Row::from([x])]).collect();
    game(LINE, 3, None, |encoder, game, lossy| {
        assert_eq!(rows(encoder, &game.layers()), straight);
        assert!(!lossy);
    });
    // With more time p may do more, but not if q has to be there as soon as it can be.
    game(LINE, 5, None, |encoder, game, lossy| {
        assert!(rows(encoder, &game.layers())[1].len() > 1);
        assert!(!lossy);
    });
    game(LINE, 5, Some(0), |encoder, game, lossy| {
        assert_eq!(rows(encoder, &game.layers())[..4], straight);
        assert!(lossy);
    });
    game(LINE, 5, Some(2), |_, _, lossy| assert!(!lossy));
}

#[test]
fn moves_are_mistakes_only_where_the_other_path_is() {
    game(TWICE, 2, None, |encoder, game, _| {
        assert_eq!(game.value(), Some(2));
        let graph = encoder.graph(PathId::from(1)).expect("the system is small");
        assert!(game.mistakes(0).is_empty());
        // What is at stake depends on what p has said, which its state does not tell.
        let mut found: Vec<(i64, u32)> = (game.mistakes(1).iter())
            .map(|mistake| {
                let (_, other) = mistake.pair.expect("the other path is somewhere");
                (graph.row(other)[0], mistake.turn.letter.expect("p moves"))
            })
            .collect();
        found.sort_unstable();
        assert_eq!(found, [(2, 1), (3, 0)]);
        assert!((0..3).all(|time| game.closed(time).is_empty()));
        assert_eq!(game.pairs(1).len(), 2);
        assert!(game.pairs(2).is_empty(), "nothing is at stake at the end");
    });
}
