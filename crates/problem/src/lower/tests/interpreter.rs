//! The meaning of a system, as plainly as it can be said.

use crate::{ActionId, Comparison, Expr, Leaf, System, Type, Update, Value};
use std::collections::BTreeSet;

pub(super) fn eval(system: &System, e: &Expr<Leaf>, state: &[Value]) -> Value {
    let int = |e: &Expr<Leaf>| match eval(system, e, state) {
        Value::Int(n) => n,
        other => panic!("no integer: {other:?}"),
    };
    let truth = |e: &Expr<Leaf>| holds(system, e, state);
    match e {
        Expr::Const(v) => *v,
        Expr::Leaf(Leaf::Var(id)) => state[usize::from(*id)],
        Expr::Leaf(Leaf::Label(id)) => eval(system, &system.labels[*id].expr, state),
        Expr::Not(a) => Value::Bool(!truth(a)),
        Expr::And(es) => Value::Bool(es.iter().all(truth)),
        Expr::Or(es) => Value::Bool(es.iter().any(truth)),
        Expr::Iff(a, b) => Value::Bool(truth(a) == truth(b)),
        Expr::Compare(op, a, b) => {
            let (a, b) = (eval(system, a, state), eval(system, b, state));
            Value::Bool(match op {
                Comparison::Eq => a == b,
                Comparison::Lt => a < b,
                Comparison::Le => a <= b,
            })
        }
        Expr::Add(es) => Value::Int(es.iter().map(int).sum()),
        Expr::Mul(c, a) => Value::Int(c * int(a)),
        Expr::Div(a, c) => Value::Int(int(a).div_euclid(*c)),
        Expr::Mod(a, c) => Value::Int(int(a).rem_euclid(*c)),
        Expr::If(c, a, b) => eval(system, if truth(c) { a } else { b }, state),
        Expr::Member(es, set) => Value::Bool(set.contains(&es.iter().map(int).collect::<Vec<_>>())),
    }
}

pub(super) fn holds(system: &System, e: &Expr<Leaf>, state: &[Value]) -> bool {
    match eval(system, e, state) {
        Value::Bool(b) => b,
        other => panic!("no truth value: {other:?}"),
    }
}

fn fits(ty: &Type, v: Value) -> bool {
    match (ty, v) {
        (Type::Bool, Value::Bool(_)) => true,
        (Type::Range { lo, hi }, Value::Int(n)) => (*lo..=*hi).contains(&n),
        (Type::Enum(values), Value::Enum(i)) => (i as usize) < values.len(),
        other => panic!("wrong type: {other:?}"),
    }
}

/// All successors of a state by an action.
pub(super) fn successors(system: &System, state: &[Value], action: ActionId) -> BTreeSet<Vec<Value>> {
    if holds(system, &system.absorb, state) {
        return BTreeSet::from([state.to_vec()]);
    }
    let mut all = BTreeSet::new();
    for clause in system.clauses.iter().filter(|c| c.actions.contains(&action)) {
        if !holds(system, &clause.guard, state) {
            continue;
        }
        let mut next = vec![state.to_vec()];
        for (var, update) in &clause.updates {
            let values: Vec<Value> = match update {
                Update::Assign(e) => vec![eval(system, e, state)],
                Update::OneOf(es) => es.iter().map(|e| eval(system, e, state)).collect(),
                Update::Within(lo, hi) => (*lo..=*hi).map(Value::Int).collect(),
            };
            let fitting: Vec<Value> =
                values.into_iter().filter(|v| fits(&system.vars[*var].ty, *v)).collect();
            next = next
                .into_iter()
                .flat_map(|s| {
                    fitting.iter().map(move |v| {
                        let mut s = s.clone();
                        s[usize::from(*var)] = *v;
                        s
                    })
                })
                .collect();
        }
        all.extend(next);
    }
    all
}

/// All assignments of values to variables.
pub(super) fn states(system: &System) -> Vec<Vec<Value>> {
    let mut all = vec![Vec::new()];
    for var in &system.vars {
        let values: Vec<Value> = match &var.ty {
            Type::Bool => vec![Value::Bool(false), Value::Bool(true)],
            Type::Range { lo, hi } => (*lo..=*hi).map(Value::Int).collect(),
            Type::Enum(names) => (0..names.len()).map(|i| Value::Enum(u32::try_from(i).unwrap())).collect(),
        };
        all = all
            .into_iter()
            .flat_map(|s: Vec<Value>| {
                values.iter().map(move |v| s.iter().copied().chain([*v]).collect::<Vec<_>>())
            })
            .collect();
    }
    all
}

/// The states where a label holds.
pub(super) fn labelled(system: &System, label: &str) -> Vec<Vec<Value>> {
    let expr = &system.labels[system.label(label).expect("the label exists")].expr;
    states(system).into_iter().filter(|s| holds(system, expr, s)).collect()
}
