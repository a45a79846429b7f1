//! The paths that come closest to defeating a strategy, against runs that are followed by hand.

use crate::{Beginning, Budget, Check, Defeat, check, starts, worst};
use hyperplan_problem::{ActionId, NoFiles, Overrides, PathId, Problem, State, Strategy, Trace, Value, read};
use hyperplan_random::Random;
use hyperplan_syntax::SourceMap;

fn problem(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    lowered.problem
}

const T: usize = 12;
const WIDTH: i64 = 5;
const HEIGHT: i64 = 4;

/// A random map, on which walls stop the robot, and its rows from the bottom.
fn room(random: &mut Random) -> (Problem, Vec<Vec<bool>>) {
    let mut walls = vec![vec![false; WIDTH as usize]; HEIGHT as usize];
    for _ in 0..random.below(6) {
        let (x, y) = (random.below(WIDTH as usize), random.below(HEIGHT as usize));
        walls[y][x] = (x, y) != (0, 0) && (x as i64, y as i64) != (WIDTH - 1, HEIGHT - 1);
    }
    let row = |(y, row): (usize, &Vec<bool>)| {
        let letter = |(x, wall): (usize, &bool)| match (wall, x as i64, y as i64) {
            (true, ..) => '#',
            (_, x, y) if (x, y) == (WIDTH - 1, HEIGHT - 1) => 'G',
            (_, 0 | 1, 0 | 1) => 'S',
            _ => '.',
        };
        format!("\"{}\"", row.iter().enumerate().map(letter).collect::<String>())
    };
    let rows: Vec<String> = walls.iter().enumerate().rev().map(|(y, cells)| row((y, cells))).collect();
    let text = format!(
        "system W = grid {{ {} }} {{ edge stay; obstacle stay; absorb goal; }}
         objective o {{ exists p. forall q. x[p] == 0 & y[p] == 0 & F[0,{T}] goal[p]
           & (start[q] & G[0,{T}] action[p] == action[q] -> F[0,{T}] goal[q]) }}",
        rows.join(" ")
    );
    (problem(&text), walls)
}

/// The cells on the way from a cell with these actions, to the end.
fn walk(walls: &[Vec<bool>], actions: &[&str], from: (i64, i64)) -> Vec<(i64, i64)> {
    let mut cells = vec![from];
    for action in actions {
        let (x, y) = cells[cells.len() - 1];
        let (a, b) = match *action {
            "up" => (x, y + 1),
            "down" => (x, y - 1),
            "left" => (x - 1, y),
            _ => (x + 1, y),
        };
        let inside = (0..WIDTH).contains(&a) && (0..HEIGHT).contains(&b);
        let stays = (x, y) == (WIDTH - 1, HEIGHT - 1) || !inside || walls[b as usize][a as usize];
        cells.push(if stays { (x, y) } else { (a, b) });
    }
    cells
}

fn state((x, y): (i64, i64)) -> State {
    [Value::Int(x), Value::Int(y)].into()
}

#[test]
fn of_all_starts_the_one_that_arrives_last() {
    let (mut decided, mut defeated) = (0, 0);
    for seed in 0..600 {
        let mut random = Random::new(seed);
        let (problem, walls) = room(&mut random);
        let objective = &problem.objectives[0];
        let names = ["up", "right", "up", "right", "down", "left"];
        let actions: Vec<&str> = (0..T).map(|_| names[random.below(names.len())]).collect();
        let ids: Vec<ActionId> = actions.iter().map(|name| problem.action(name).expect("a move")).collect();
        let goal = (WIDTH - 1, HEIGHT - 1);
        let arrives = |from| walk(&walls, &actions, from).iter().position(|cell| *cell == goal);
        if arrives((0, 0)).is_none() {
            continue;
        }
        let states = walk(&walls, &actions, (0, 0)).into_iter().map(state).collect();
        let strategy = Strategy { traces: vec![Trace { path: PathId(0), states, actions: ids.clone() }] };
        let cells: Vec<(i64, i64)> = [(0, 0), (0, 1), (1, 0), (1, 1)]
            .into_iter()
            .filter(|(x, y)| !walls[*y as usize][*x as usize])
            .collect();
        let budget = Budget::default();
        let found = worst(&problem, objective, &strategy, None, &budget).expect("well-formed");
        let found = found.expect("some path starts somewhere").remove(0);
        let first = |trace: &Trace| match *trace.states[0] {
            [Value::Int(x), Value::Int(y)] => (x, y),
            _ => panic!("no cell"),
        };
        assert_eq!(found.actions[..T], ids[..], "what is assumed of q holds");
        let all: Vec<Option<usize>> = cells.iter().map(|cell| arrives(*cell)).collect();
        if all.contains(&None) {
            // The strategy fails, and what is found is why.
            assert_eq!(arrives(first(&found)), None, "seed {seed}");
            let checked = check(&problem, objective, &strategy, &budget);
            assert!(matches!(checked, Ok(Check::Fails(Defeat::Paths(_)))));
            defeated += 1;
        } else {
            assert_eq!(arrives(first(&found)), all.into_iter().max().flatten(), "seed {seed}");
            decided += 1;
        }
        // From each start there is one such path.
        for cell in &cells {
            let beginning = Beginning { start: Some(state(*cell)), actions: Vec::new() };
            let found = worst(&problem, objective, &strategy, Some((PathId(1), &beginning)), &budget);
            let found = found.expect("well-formed").expect("it is a start").remove(0);
            assert_eq!(first(&found), *cell);
            assert_eq!(
                found.states[..=T].to_vec(),
                walk(&walls, &actions, *cell).into_iter().map(state).collect::<Vec<_>>()
            );
        }
    }
    assert!(decided > 40 && defeated > 8, "{decided} {defeated}");
}

#[test]
fn a_beginning_that_breaks_what_is_assumed_has_no_path() {
    let problem = problem(
        "system W = grid { \"SS..G\" } { edge stay; absorb goal; }
         objective o { exists p. forall q. x[p] == 0 & F[0,5] goal[p]
           & (start[q] & G[0,5] action[p] == action[q] -> F[0,5] goal[q]) }",
    );
    let objective = &problem.objectives[0];
    let right = problem.action("right").expect("a move");
    let states = (0..6).map(|x| [Value::Int(x.min(4)), Value::Int(0)].into()).collect();
    let strategy = Strategy { traces: vec![Trace { path: PathId(0), states, actions: vec![right; 5] }] };
    let budget = Budget::default();
    let of = |beginning: &Beginning| {
        worst(&problem, objective, &strategy, Some((PathId(1), beginning)), &budget).expect("well-formed")
    };
    let left = problem.action("left").expect("a move");
    assert_eq!(of(&Beginning { start: None, actions: vec![right, left] }), None);
    assert_eq!(
        of(&Beginning { start: Some([Value::Int(3), Value::Int(0)].into()), actions: Vec::new() }),
        None
    );
    assert!(of(&Beginning { start: None, actions: vec![right, right] }).is_some());
    // What was not found out is not told.
    let little = Budget { moves: 1, ..budget };
    assert_eq!(worst(&problem, objective, &strategy, None, &little), Ok(None));
    // Without a deadline, any path that is meant will do.
    let safe = self::problem(
        "system W = grid { \"SS..G\" } { edge stay; absorb goal; }
         objective o { exists p. forall q. x[p] == 0 & (start[q] & G[0,5] action[p] == action[q] -> G[0,5] y[q] == 0) }",
    );
    let found = worst(&safe, &safe.objectives[0], &strategy, None, &budget).expect("well-formed");
    assert_eq!(found.map(|traces| traces[0].actions[..5].to_vec()), Some(vec![right; 5]));
    let system = objective.paths[PathId(0)].system;
    assert_eq!(starts(&problem, system, 3, &budget).map(|states| states.len()), Some(3));
}
