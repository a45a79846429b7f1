//! A shortest path on grids of some size: a check should cost little more than cells x steps.

use super::build::span;
use crate::{Budget, Check, Defeat, check};
use hyperplan_problem::{
    ActionId, Clause, Comparison, Expr, Formula, Interval, Label, LabelId, Leaf, Mode, Node, Objective,
    PathId, PathLeaf, PathVar, Problem, Quantifier, State, Strategy, System, SystemId, Trace, Type, Update,
    Value, Var, VarId,
};
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};

const X: VarId = VarId(0);
const Y: VarId = VarId(1);

fn corner(n: i64) -> Expr<Leaf> {
    let at = |v| Box::new(Expr::Leaf(Leaf::Var(v)));
    let value = |n| Box::new(Expr::Const(Value::Int(n)));
    let equal = |v| Expr::Compare(Comparison::Eq, at(v), value(n));
    Expr::And(vec![equal(X), equal(Y)])
}

fn grid(n: i64) -> System {
    let clause = |action: u32, var: VarId, by: i64| Clause {
        actions: vec![ActionId(action)],
        guard: Expr::TRUE,
        updates: vec![(
            var,
            Update::Assign(Expr::Add(vec![Expr::Leaf(Leaf::Var(var)), Expr::Const(Value::Int(by))])),
        )],
        span: span(),
        generated: true,
    };
    let var = |name: &str| Var {
        name: name.into(),
        ty: Type::Range { lo: 0, hi: n - 1 },
        sums: None,
        span: span(),
    };
    let label =
        |name: &str, expr| Label { name: name.into(), expr, ty: Type::Bool, nested: false, span: span() };
    System {
        name: "Grid".into(),
        vars: vec![var("x"), var("y")].into(),
        actions: (0..4).map(ActionId).collect(),
        clauses: vec![clause(0, X, 1), clause(1, X, -1), clause(2, Y, 1), clause(3, Y, -1)],
        also: Vec::new(),
        costs: Vec::new().into(),
        base: None,
        edges: None,
        trans: Expr::TRUE,
        init: Expr::TRUE,
        labels: vec![label("start", corner(0)), label("goal", corner(n - 1))].into(),
        absorb: Expr::FALSE,
        observe: Vec::new(),
        map: None,
        coordinates: None,
        span: span(),
    }
}

/// `start[p] & F[0,T] goal[p] & (start[q] -> (!goal[q] U[0,T] goal[p]))`
fn shortest(n: i64, horizon: u32) -> Problem {
    let mut f = Formula::default();
    let mut label = |path: u32, label: u32| {
        f.push(Node::Atom(Expr::Leaf(PathLeaf::State(PathId(path), Leaf::Label(LabelId(label))))), span())
    };
    let (start_p, goal_p, start_q, goal_q) = (label(0, 0), label(0, 1), label(1, 0), label(1, 1));
    let interval = Interval { lo: 0, hi: Some(horizon) };
    let reach = f.unary(UnaryOp::Finally, interval, goal_p, span());
    let not_yet = f.push(Node::Not(goal_q), span());
    let until = f.binary(BinaryOp::Until, interval, not_yet, goal_p, span());
    let slower = f.implies(start_q, until, span());
    f.push(Node::And(vec![start_p, reach, slower]), span());
    let path =
        |name: &str, quantifier| PathVar { name: name.into(), quantifier, system: SystemId(0), span: span() };
    let paths = vec![path("p", Quantifier::Exists), path("q", Quantifier::Forall)];
    let objective = Objective {
        name: "o".into(),
        paths: paths.into(),
        mode: Mode::Bounded,
        semantics: None,
        formula: f,
        minimize: Vec::new(),
        span: span(),
    };
    Problem {
        actions: ["right", "left", "up", "down"].map(String::from).to_vec().into(),
        systems: vec![grid(n)].into(),
        objectives: vec![objective],
    }
}

/// Wanders `detours` times to and fro, then right, then up.
fn walk(n: i64, detours: usize) -> Strategy {
    let side = usize::try_from(n - 1).unwrap();
    let moves = [[0, 1].repeat(detours), vec![0; side], vec![2; side]].concat();
    let (mut x, mut y) = (0, 0);
    let state = |x, y| -> State { vec![Value::Int(x), Value::Int(y)].into() };
    let mut states = vec![state(0, 0)];
    for action in &moves {
        match action {
            0 => x += 1,
            1 => x -= 1,
            _ => y += 1,
        }
        states.push(state(x, y));
    }
    Strategy {
        traces: vec![Trace { path: PathId(0), states, actions: moves.into_iter().map(ActionId).collect() }],
    }
}

fn run(n: i64, detours: usize) -> Check {
    let problem = shortest(n, u32::try_from(2 * n).unwrap() + 1);
    check(&problem, &problem.objectives[0], &walk(n, detours), &Budget::default()).unwrap()
}

#[test]
fn a_shortest_path_on_a_grid() {
    assert_eq!(run(20, 0), Check::Holds);
    let Check::Fails(Defeat::Paths(traces)) = run(20, 1) else { panic!("a detour is not shortest") };
    let steps_to_goal = traces[0].states.iter().position(|s| **s == [Value::Int(19), Value::Int(19)]);
    assert_eq!(steps_to_goal, Some(38));
}

#[test]
#[ignore = "for measuring, in a release build"]
fn a_grid_of_60() {
    assert_eq!(run(60, 0), Check::Holds);
}

#[test]
#[ignore = "for measuring, in a release build"]
fn a_grid_of_200() {
    assert_eq!(run(200, 0), Check::Holds);
}

/// A wall between columns `8 i - 1` and `8 i`, with one door: at the top and at the bottom by turns.
fn is_wall(n: i64, x: i64, y: i64) -> bool {
    x % 8 == 0 && x > 0 && y != if x % 16 == 0 { 0 } else { n - 1 }
}

/// The grid with walls: no move leads across one.
fn rooms(n: i64) -> System {
    let is = |v, c: i64| {
        let leaf = Box::new(Expr::Leaf(Leaf::Var(v)));
        Expr::Compare(Comparison::Eq, leaf, Box::new(Expr::Const(Value::Int(c))))
    };
    let walls = || (1..n).filter(|x| x % 8 == 0);
    let door = |x| if x % 16 == 0 { 0 } else { n - 1 };
    let crosses = |column: i64, x: i64| Expr::And(vec![is(X, column), Expr::Not(Box::new(is(Y, door(x))))]);
    let mut system = grid(n);
    for (clause, side) in system.clauses.iter_mut().zip([1, 0]) {
        let barred = walls().map(|x| crosses(x - side, x)).collect();
        clause.guard = Expr::Not(Box::new(Expr::Or(barred)));
    }
    system
}

/// Where an action leads, if anywhere.
fn step(n: i64, (x, y): (i64, i64), action: u32) -> Option<(i64, i64)> {
    let to = match action {
        0 => (x + 1, y),
        1 => (x - 1, y),
        2 => (x, y + 1),
        _ => (x, y - 1),
    };
    let crossed = match action {
        0 => is_wall(n, x + 1, y),
        1 => is_wall(n, x, y),
        _ => false,
    };
    ((0..n).contains(&to.0) && (0..n).contains(&to.1) && !crossed).then_some(to)
}

/// A fastest way from corner to corner, by breadth-first search.
fn fastest(n: i64) -> Vec<u32> {
    let mut came = std::collections::BTreeMap::from([((0, 0), None)]);
    let mut queue = std::collections::VecDeque::from([(0, 0)]);
    while let Some(at) = queue.pop_front() {
        for action in 0..4 {
            if let Some(to) = step(n, at, action)
                && !came.contains_key(&to)
            {
                came.insert(to, Some((at, action)));
                queue.push_back(to);
            }
        }
    }
    let mut actions = Vec::new();
    let mut at = (n - 1, n - 1);
    while let Some((from, action)) = came[&at] {
        actions.push(action);
        at = from;
    }
    actions.reverse();
    actions
}

/// The states along a way.
fn along(n: i64, actions: &[u32]) -> Vec<State> {
    let mut at = (0, 0);
    let state = |(x, y)| -> State { vec![Value::Int(x), Value::Int(y)].into() };
    let mut states = vec![state(at)];
    for &action in actions {
        at = step(n, at, action).expect("no move leads across a wall");
        states.push(state(at));
    }
    states
}

#[test]
fn a_defeating_run_through_rooms_is_one() {
    let n = 32;
    let way = fastest(n);
    let late = [vec![0, 1], way.clone()].concat();
    let mut problem = shortest(n, u32::try_from(late.len()).unwrap());
    problem.systems = vec![rooms(n)].into();
    let run = |actions: &[u32]| {
        let actions_of_p = actions.iter().copied().map(ActionId).collect();
        let trace = Trace { path: PathId(0), states: along(n, actions), actions: actions_of_p };
        let strategy = Strategy { traces: vec![trace] };
        check(&problem, &problem.objectives[0], &strategy, &Budget::default()).unwrap()
    };
    // Far longer than the 62 steps that the map without walls takes; then up and down to the end.
    assert_eq!(way.len(), 62 + 2 * 31);
    assert_eq!(run(&[way.clone(), vec![3, 2]].concat()), Check::Holds);
    let Check::Fails(Defeat::Paths(traces)) = run(&late) else { panic!("a detour is not shortest") };
    let [q] = traces.as_slice() else { panic!("one path is free") };
    let taken: Vec<u32> = q.actions.iter().map(|a| a.0).collect();
    assert_eq!(q.states, along(n, &taken));
    let goal = q.states.iter().position(|s| **s == [Value::Int(n - 1), Value::Int(n - 1)]);
    assert_eq!(goal, Some(way.len()));
}
