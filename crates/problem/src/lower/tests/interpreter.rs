//! The meaning of a system, as plainly as it can be said.

use crate::{ActionId, Expr, Leaf, System, Type, Update, Value};
use std::collections::BTreeSet;

pub(super) fn eval(system: &System, e: &Expr<Leaf>, state: &[Value]) -> Value {
    let value = e.evaluate(&mut |leaf| match leaf {
        Leaf::Var(id) => Some(state[usize::from(*id)]),
        Leaf::Label(id) => Some(eval(system, &system.labels[*id].expr, state)),
    });
    value.expect("every leaf has a value, and numbers are small")
}

pub(super) fn holds(system: &System, e: &Expr<Leaf>, state: &[Value]) -> bool {
    match eval(system, e, state) {
        Value::Bool(b) => b,
        other => panic!("no truth value: {other:?}"),
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
                Update::Within(lo, hi) => match (eval(system, lo, state), eval(system, hi, state)) {
                    (Value::Int(lo), Value::Int(hi)) => (lo..=hi).map(Value::Int).collect(),
                    other => panic!("no integers: {other:?}"),
                },
            };
            let fitting: Vec<Value> =
                values.into_iter().filter(|v| system.vars[*var].ty.contains(*v)).collect();
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
    if let Some(edges) = &system.edges
        && let Value::Enum(from) = state[usize::from(edges.var)]
    {
        for (_, edge) in edges.iter().filter(|(source, edge)| *source == from && edge.action == action) {
            let mut next = state.to_vec();
            next[usize::from(edges.var)] = Value::Enum(edge.to);
            all.insert(next);
        }
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
            Type::Int | Type::Real => panic!("not a finite type"),
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
