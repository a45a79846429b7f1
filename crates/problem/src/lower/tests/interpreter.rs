//! The meaning of a system, as plainly as it can be said.

use crate::{ActionId, Expr, Leaf, StepLeaf, System, TransLeaf, Type, Update, Value, VarId};
use std::collections::BTreeSet;
use std::convert::Infallible;

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
        all.extend(outcomes(system, state, state.to_vec(), &clause.updates, action, None));
    }
    if let Some(edges) = &system.edges
        && let Value::Enum(from) = state[usize::from(edges.var)]
    {
        let all_edges = edges.iter().enumerate();
        for (at, (_, edge)) in
            all_edges.filter(|(_, (source, edge))| *source == from && edge.action == action)
        {
            let mut next = state.to_vec();
            next[usize::from(edges.var)] = Value::Enum(edge.to);
            all.extend(outcomes(system, state, next, &[], action, Some(at)));
        }
    }
    all.retain(|next| is_step(system, state, next));
    all
}

/// What updates make of a state, and clauses that add to the action.
fn outcomes(
    system: &System,
    state: &[Value],
    start: Vec<Value>,
    updates: &[(VarId, Update)],
    action: ActionId,
    edge: Option<usize>,
) -> Vec<Vec<Value>> {
    let step = |e: &Expr<StepLeaf>| {
        let value = e.evaluate(&mut |leaf| match leaf {
            StepLeaf::State(leaf) => Some(eval(system, &Expr::Leaf(*leaf), state)),
            StepLeaf::Took(taken) => Some(Value::Bool(*taken == action)),
            StepLeaf::Attribute(attribute) => {
                let number = |at| system.edges.as_ref().map(|edges| edges.number(at, *attribute));
                Some(Value::Int(edge.and_then(number).unwrap_or(0)))
            }
        });
        value.expect("numbers are small")
    };
    let mut next = vec![start];
    for (var, update) in updates {
        next = extended(system, next, *var, values(update, &|e| eval(system, e, state)));
    }
    for also in &system.also {
        if also.actions.contains(&action) && holds(system, &also.guard, state) {
            for (var, update) in &also.updates {
                next = extended(system, next, *var, values(update, &step));
            }
        }
    }
    next
}

fn values<L>(update: &Update<L>, eval: &dyn Fn(&Expr<L>) -> Value) -> Vec<Value> {
    let Ok(update) = update.in_state(&mut |c| Ok::<_, Infallible>(eval(c) == Value::Bool(true)));
    match update {
        Update::If(..) => unreachable!("no conditions are left"),
        Update::Assign(e) => vec![eval(e)],
        Update::OneOf(es) => es.iter().map(eval).collect(),
        Update::Within(lo, hi) => match (eval(lo), eval(hi)) {
            (Value::Int(lo), Value::Int(hi)) => (lo..=hi).map(Value::Int).collect(),
            other => panic!("no integers: {other:?}"),
        },
    }
}

fn extended(system: &System, states: Vec<Vec<Value>>, var: VarId, values: Vec<Value>) -> Vec<Vec<Value>> {
    let fitting: Vec<Value> = values.into_iter().filter(|v| system.vars[var].ty.contains(*v)).collect();
    let with = |state: &Vec<Value>, value: Value| {
        let mut state = state.clone();
        state[usize::from(var)] = value;
        state
    };
    states.iter().flat_map(|state| fitting.iter().map(|&value| with(state, value))).collect()
}

fn is_step(system: &System, from: &[Value], to: &[Value]) -> bool {
    let holds = system.trans.evaluate(&mut |leaf| match *leaf {
        TransLeaf::Before(leaf) => Some(eval(system, &Expr::Leaf(leaf), from)),
        TransLeaf::After(leaf) => Some(eval(system, &Expr::Leaf(leaf), to)),
    });
    holds == Some(Value::Bool(true))
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
