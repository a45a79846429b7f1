//! A system in which every action is possible everywhere: what the original cannot do leads to being *stuck*.

use hyperplan_problem::{ActionId, Clause, Comparison, Expr, Leaf, System, Type, Update, Value, Var, VarId};
use hyperplan_space::{Updates, besides, no_number};

/// The value of the new variable before anything impossible was tried.
const FREE: i64 = 0;
/// Its value right after.
pub(super) const JUST_STUCK: i64 = 1;
/// Its value from then on.
const STUCK: i64 = 2;

/// The system with a variable that says whether its path got stuck; the other variables then keep their values.
pub(super) fn total(system: &System) -> (System, VarId) {
    let mut total = system.clone();
    let span = system.span;
    let ty = Type::Range { lo: FREE, hi: STUCK };
    let var = total.vars.push_and_get_key(Var { name: "stuck".into(), ty, sums: None, span });
    let free = is(var, FREE);
    let also_free = |e: &Expr<Leaf>| Expr::And(vec![free.clone(), e.clone()]);
    total.init = also_free(&system.init);
    total.absorb = also_free(&system.absorb);
    total.clauses.clear();
    for &action in &system.actions {
        for (guard, updates) in ways(system, action) {
            let guard = also_free(&guard);
            total.clauses.push(Clause { actions: vec![action], guard, updates, span, generated: true });
        }
    }
    total.also.clear();
    total.edges = None;
    let set = |value| vec![(var, Update::Assign(Expr::Const(Value::Int(value))))];
    for &action in &system.actions {
        let cannot = Expr::Not(Box::new(enabled(system, action)));
        let (guard, updates) = (also_free(&cannot), set(JUST_STUCK));
        total.clauses.push(Clause { actions: vec![action], guard, updates, span, generated: true });
    }
    let (guard, updates) = (Expr::Not(Box::new(free)), set(STUCK));
    let actions = system.actions.clone();
    total.clauses.push(Clause { actions, guard, updates, span, generated: true });
    (total, var)
}

/// That the new variable has this value.
pub(super) fn is(var: VarId, value: i64) -> Expr<Leaf> {
    let value = Expr::Const(Value::Int(value));
    Expr::Compare(Comparison::Eq, Box::new(Expr::Leaf(Leaf::Var(var))), Box::new(value))
}

/// That an enumeration has the value of this position.
fn at(var: VarId, position: u32) -> Expr<Leaf> {
    let value = Expr::Const(Value::Enum(position));
    Expr::Compare(Comparison::Eq, Box::new(Expr::Leaf(Leaf::Var(var))), Box::new(value))
}

/// The guards and updates of the transitions with an action, from states that do not absorb.
fn ways(system: &System, action: ActionId) -> Vec<(Expr<Leaf>, Updates)> {
    let own = besides(system, action, &no_number);
    let clauses = system.clauses.iter().filter(|c| c.actions.contains(&action));
    let mut ways: Vec<(Expr<Leaf>, Updates)> = clauses
        .map(|clause| (clause.guard.clone(), clause.updates.iter().chain(&own).cloned().collect()))
        .collect();
    let Some(edges) = &system.edges else { return ways };
    for (position, (from, edge)) in edges.iter().enumerate().filter(|(_, (_, edge))| edge.action == action) {
        let number = |attribute| Expr::Const(Value::Int(edges.number(position, attribute)));
        let mut updates = besides(system, action, &number);
        updates.push((edges.var, Update::Assign(Expr::Const(Value::Enum(edge.to)))));
        ways.push((at(edges.var, from), updates));
    }
    ways
}

/// Where a system has a transition with that action.
pub(super) fn enabled(system: &System, action: ActionId) -> Expr<Leaf> {
    let ways = ways(system, action);
    let mut ways: Vec<Expr<Leaf>> = ways.iter().map(|(guard, own)| possible(system, guard, own)).collect();
    ways.push(system.absorb.clone());
    Expr::Or(ways)
}

/// Where there is an outcome: the guard holds, and each update has a value in range.
fn possible(system: &System, guard: &Expr<Leaf>, updates: &Updates) -> Expr<Leaf> {
    let mut parts = vec![guard.clone()];
    for (var, update) in updates {
        parts.push(has_value(&system.vars[*var].ty, update));
    }
    Expr::And(parts)
}

/// Where an update has a value in range.
fn has_value(ty: &Type, update: &Update) -> Expr<Leaf> {
    // Values of other types are never outside.
    let ends = match ty {
        Type::Range { lo, hi } => Some((Expr::Const(Value::Int(*lo)), Expr::Const(Value::Int(*hi)))),
        _ => None,
    };
    let inside = |e: &Expr<Leaf>| match &ends {
        Some((lo, hi)) => Expr::And(vec![at_most(lo, e), at_most(e, hi)]),
        None => Expr::TRUE,
    };
    match update {
        Update::Assign(e) => inside(e),
        Update::OneOf(es) => Expr::Or(es.iter().map(inside).collect()),
        Update::Within(least, greatest) => {
            let mut parts = vec![at_most(least, greatest)];
            if let Some((lo, hi)) = &ends {
                parts.extend([at_most(least, hi), at_most(lo, greatest)]);
            }
            Expr::And(parts)
        }
        Update::If(branches, last) => {
            let branches = branches.iter().map(|(c, branch)| (c.clone(), has_value(ty, branch)));
            Expr::choice(branches, has_value(ty, last))
        }
    }
}

fn at_most(a: &Expr<Leaf>, b: &Expr<Leaf>) -> Expr<Leaf> {
    Expr::Compare(Comparison::Le, Box::new(a.clone()), Box::new(b.clone()))
}
