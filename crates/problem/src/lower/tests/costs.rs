//! Costs: what steps cost, and their sums as variables of systems that objectives have for themselves.

use super::{codes, ok};
use crate::{CostId, Node, PathId, PathLeaf, Problem, State, SystemId, Target, Trace, Type, Value, bounded};

const COUNT: &str = "system Count {
  state n: 0..3;
  action up, stay;
  on up { n' = n + 1; }
  on stay {}
  init n == 0;
  absorb n == 3;
  cost c = if action == up then 2 * n + 1 else 0;
}
";

fn problem(objective: &str) -> Problem {
    ok(&format!("{COUNT}objective o {{ {objective} }}")).problem
}

fn target(problem: &Problem) -> &Target {
    &problem.objectives[0].minimize[0]
}

#[test]
fn sums_are_variables_of_a_system_of_their_own() {
    let problem = problem("exists p. forall q. F[0,5] (cost c[p] <= 4 & state[p] == state[q])");
    assert_eq!(problem.systems.len(), 2);
    let objective = &problem.objectives[0];
    let (p, q) = (&objective.paths[PathId(0)], &objective.paths[PathId(1)]);
    assert_eq!((p.system, q.system), (SystemId(1), SystemId(0)));
    let summed = &problem.systems[p.system];
    assert_eq!((summed.base, summed.name.as_str()), (Some(SystemId(0)), "Count"));
    let sum = summed.vars.raw.last().expect("there are variables");
    // Beyond 4 all sums are alike.
    assert_eq!((sum.ty.clone(), sum.sums), (Type::Range { lo: 0, hi: 5 }, Some(CostId(0))));
    // What the file's system has is compared, and not the sums.
    for node in &objective.formula.nodes {
        let Node::Atom(e) = node else { continue };
        e.for_each_leaf(&mut |leaf| assert!(!matches!(leaf, PathLeaf::SameState(..)), "{leaf:?}"));
    }
}

#[test]
fn sums_stop_where_no_path_can_come_to() {
    let problem = problem("exists p, q. F[0,5] (cost c[p] < cost c[q] & X true)");
    let sum = problem.systems[SystemId(1)].vars.raw.last().expect("there are variables");
    // Six steps at most are read, and none costs more than 7.
    assert_eq!(sum.ty, Type::Range { lo: 0, hi: 42 });
    assert_eq!(problem.systems.len(), 2, "both paths are of one system");
}

#[test]
fn bounds_have_sums_of_their_own() {
    let problem =
        problem("exists p. F[0,5] (n[p] == 3 & cost c[p] <= 20) minimize 2 * cost c[p] + cost c[p] - 1;");
    let own = target(&problem).clone();
    assert_eq!((own.terms.clone(), own.constant), (vec![(3, PathId(0), CostId(0))], -1));
    assert_eq!(own.value(|_, _| Some(9)), Some(26));
    let (bounded, objective) = bounded(&problem, &problem.objectives[0], &[(own, 26)], 5);
    let system = &bounded.systems[objective.paths[PathId(0)].system];
    let mut names: Vec<&str> = system.vars.iter().map(|var| var.name.as_str()).collect();
    assert_eq!(names.len(), 3);
    names.dedup();
    assert_eq!(names.len(), 3, "solvers know them by name");
    assert_eq!(system.vars.raw[2].ty, Type::Range { lo: 0, hi: 10 });
}

#[test]
fn sums_follow_from_the_steps() {
    let problem = problem("exists p. F[0,4] cost c[p] == 9");
    let system = &problem.systems[SystemId(1)];
    let up = problem.action("up").expect("declared");
    let state = |n: i64| State::from([Value::Int(n), Value::Int(0)]);
    let states = [0, 1, 2, 3, 3].map(state).to_vec();
    let mut trace = Trace { path: PathId(0), states, actions: vec![up; 4] };
    system.add_up(&mut trace);
    let sums: Vec<Value> = trace.states.iter().map(|state| state[1]).collect();
    // Where it absorbs nothing is added.
    assert_eq!(sums, [0, 1, 4, 9, 9].map(Value::Int));
}

#[test]
fn what_is_never_negative_is_a_cost() {
    let good = |cost: &str| ok(&COUNT.replace("2 * n + 1", cost)).problem.systems[SystemId(0)].costs.len();
    assert_eq!(good("if n > 1 then n - 2 else 2 - n"), 1);
    // Never where it does not absorb.
    assert_eq!(good("2 - n"), 1);
    assert_eq!(codes(&COUNT.replace("2 * n + 1", "1 - n"))[0].0, "negative-cost");
}

#[test]
fn nothing_is_read_of_sums_in_other_places() {
    assert_eq!(codes(&COUNT.replace("init n == 0", "init cost c[p] == 0"))[0].0, "misplaced-path");
}
