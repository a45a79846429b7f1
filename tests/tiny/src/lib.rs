//! Tiny problems for property tests of single crates, and what they mean, by brute force: paths of exactly so many
//! steps are listed from the clauses, and formulas are read as the language defines them. For the whole program there
//! are larger ones, in the workspace's `tests`.

use hyperplan_problem::{
    ActionId, Also, Expr, FormulaId, Interval, Leaf, NoFiles, Node, Objective, Overrides, PathId, PathLeaf,
    Problem, State, StepLeaf, System, Trace, TransLeaf, Update, Value, VarId, read,
};
use hyperplan_syntax::SourceMap;
use proptest::prelude::*;
use std::convert::Infallible;

/// The problem that a text describes.
///
/// # Panics
/// If it describes none.
#[must_use]
pub fn problem(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "tiny.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    lowered.problem
}

/// A system with a number, a truth value, two actions and up to five clauses, some of which have several outcomes.
pub fn system() -> impl Strategy<Value = String> {
    let guard = prop_oneof![
        Just("true".to_owned()),
        (0..4).prop_map(|n| format!("x < {n}")),
        (0..4).prop_map(|n| format!("x == {n}")),
        (0..3).prop_map(|n| format!("(b | x > {n})")),
    ];
    let update = prop_oneof![
        Just(String::new()),
        Just("x' = x + 1;".to_owned()),
        Just("x' = x - 1;".to_owned()),
        Just("b' = !b;".to_owned()),
        (0..3).prop_map(|n| format!("x' = {n}; b' = x == {n};")),
        (0..3).prop_map(|n| format!("x' in {{x, {n}}};")),
        (0..2).prop_map(|n| format!("x' in x - {n}..x + 1;")),
        (0..3).prop_map(|n| format!("x' in if x < {n} then {{0, x + 1}} else if b then {{2}} else x..2;")),
        (0..3).prop_map(|n| format!("b' in if x == {n} then {{true, false}} else {{b}};")),
    ];
    let actions = prop::sample::select(vec!["l", "r", "l | r"]);
    let clause = (actions, guard, update)
        .prop_map(|(actions, guard, update)| format!("on {actions} when {guard} {{ {update} }}"));
    let absorb = prop_oneof![Just(String::new()), Just("absorb x == 2;".to_owned())];
    let also = prop_oneof![
        4 => Just(String::new()),
        1 => Just("also on * { n' = n - 1; }".to_owned()),
        1 => Just("also on l when b { n' in {0, n + 1}; } also on r | l when !b { n' in n - 1..x; }".to_owned()),
        1 => Just("also on r when x > 0 { n' = if action == r then x else 0; }".to_owned()),
        1 => Just("also on * { n' in if action == l & high then {0, 2} else if b then n..level else {x}; }".to_owned()),
    ];
    let trans = prop_oneof![
        3 => Just(String::new()),
        1 => (0..3).prop_map(|n| format!("trans x' != {n} | b;")),
        1 => Just("trans high' -> x <= x' + 1; trans !b | b' | level' == 0;".to_owned()),
    ];
    let rules = (absorb, also, trans, any::<bool>());
    (prop::collection::vec(clause, 1..6), rules, 0..3).prop_map(|(clauses, rules, init)| {
        let (absorb, also, trans, counts) = rules;
        let clauses = clauses.join(" ");
        // A variable that only `also` changes is there where one does: it makes more states.
        let (more, n) = if also.is_empty() { ("", "") } else { (", n: 0..2", "& n == 1") };
        let trans = if counts && !also.is_empty() {
            format!("{trans} trans n' >= n - 1 & n' <= x' + 1;")
        } else {
            trans
        };
        format!(
            "system S {{ state x: 0..2, b: bool{more}; action l, r; label level = if b then 0 else 2 - x; \
             label high = level > 1; init x <= {init} & !b{n}; {absorb} {trans} {clauses} {also} }}"
        )
    })
}

/// A formula over some paths, to be read `within`.
pub fn formula(paths: &'static [&'static str]) -> impl Strategy<Value = String> {
    let path = || prop::sample::select(paths);
    let atom = prop_oneof![
        (path(), 0..3).prop_map(|(p, n)| format!("x[{p}] == {n}")),
        path().prop_map(|p| format!("b[{p}]")),
        path().prop_map(|p| format!("action[{p}] == l")),
        (path(), path()).prop_map(|(p, q)| format!("action[{p}] == action[{q}]")),
        (path(), path()).prop_map(|(p, q)| format!("state[{p}] == state[{q}]")),
        (path(), path()).prop_map(|(p, q)| format!("x[{p}] < x[{q}]")),
    ];
    atom.prop_recursive(4, 12, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            inner.clone().prop_map(|a| format!("!({a})")),
            inner.clone().prop_map(|a| format!("X ({a})")),
            inner.clone().prop_map(|a| format!("G ({a})")),
            inner.prop_map(|a| format!("F[1,2] ({a})")),
            pair.clone().prop_map(|(a, b)| format!("(({a}) & ({b}))")),
            pair.clone().prop_map(|(a, b)| format!("(({a}) -> ({b}))")),
            pair.clone().prop_map(|(a, b)| format!("(({a}) U ({b}))")),
            pair.prop_map(|(a, b)| format!("(({a}) R[0,1] ({b}))")),
        ]
    })
}

/// Where a leaf of a system's expressions stands for, in a state.
fn read_leaf(system: &System, leaf: Leaf, state: &State) -> Option<Value> {
    match leaf {
        Leaf::Var(var) => Some(state[usize::from(var)]),
        Leaf::Label(label) => value(system, &system.labels[label].expr, state),
    }
}

fn value(system: &System, expr: &Expr<Leaf>, state: &State) -> Option<Value> {
    expr.evaluate(&mut |leaf| read_leaf(system, *leaf, state))
}

fn holds_in(system: &System, expr: &Expr<Leaf>, state: &State) -> bool {
    value(system, expr, state) == Some(Value::Bool(true))
}

/// Every transition from a state.
///
/// # Panics
/// On systems with variables without bounds.
#[must_use]
pub fn transitions(system: &System, from: &State) -> Vec<(ActionId, State)> {
    let stay = |&action: &ActionId| (action, from.clone());
    if holds_in(system, &system.absorb, from) {
        return system.actions.iter().map(stay).collect();
    }
    let mut found = Vec::new();
    for clause in system.clauses.iter().filter(|clause| holds_in(system, &clause.guard, from)) {
        for &action in &clause.actions {
            let mut all = vec![from.clone()];
            for (var, update) in &clause.updates {
                let of = |e: &Expr<Leaf>| value(system, e, from).expect("it has a value");
                all = extended(system, &all, *var, update, &of);
            }
            let also = |also: &&Also| also.actions.contains(&action) && holds_in(system, &also.guard, from);
            for (var, update) in system.also.iter().filter(also).flat_map(|also| &also.updates) {
                let of = |e: &Expr<StepLeaf>| step_value(system, e, from, action);
                all = extended(system, &all, *var, update, &of);
            }
            found.extend(all.into_iter().map(|to| (action, to)));
        }
    }
    let is_step = |to: &State| {
        let holds = system.trans.evaluate(&mut |leaf| match *leaf {
            TransLeaf::Before(leaf) => read_leaf(system, leaf, from),
            TransLeaf::After(leaf) => read_leaf(system, leaf, to),
        });
        holds == Some(Value::Bool(true))
    };
    found.retain(|(_, to)| is_step(to));
    found.sort();
    found.dedup();
    found
}

/// The value of an expression over a step that follows no edge.
fn step_value(system: &System, expr: &Expr<StepLeaf>, from: &State, action: ActionId) -> Value {
    let value = expr.evaluate(&mut |leaf| match *leaf {
        StepLeaf::State(leaf) => read_leaf(system, leaf, from),
        StepLeaf::Took(taken) => Some(Value::Bool(taken == action)),
        StepLeaf::Attribute(_) => Some(Value::Int(0)),
    });
    value.expect("it has a value")
}

/// The states with each of the values that an update gives a variable.
fn extended<L>(
    system: &System,
    states: &[State],
    var: VarId,
    update: &Update<L>,
    of: &dyn Fn(&Expr<L>) -> Value,
) -> Vec<State> {
    let Ok(update) = update.in_state(&mut |c| Ok::<_, Infallible>(of(c) == Value::Bool(true)));
    let values: Vec<Value> = match update {
        Update::If(..) => unreachable!("no conditions are left"),
        Update::Assign(e) => vec![of(e)],
        Update::OneOf(es) => es.iter().map(of).collect(),
        Update::Within(lo, hi) => match (of(lo), of(hi)) {
            (Value::Int(lo), Value::Int(hi)) => (lo..=hi).map(Value::Int).collect(),
            _ => unreachable!("ranges are of integers"),
        },
    };
    let values: Vec<Value> =
        values.into_iter().filter(|&value| system.vars[var].ty.contains(value)).collect();
    let with = |state: &State, value: Value| {
        let mut next = state.clone();
        next[usize::from(var)] = value;
        next
    };
    states.iter().flat_map(|state| values.iter().map(|&v| with(state, v))).collect()
}

/// The states that a system of [`system`] starts in.
#[must_use]
pub fn starts(system: &System) -> Vec<State> {
    let mut all = vec![Vec::new()];
    for var in &system.vars {
        let values = [false, true].map(Value::Bool).into_iter().chain((0..3).map(Value::Int));
        let values: Vec<Value> = values.filter(|value| var.ty.contains(*value)).collect();
        let with = |state: &Vec<Value>, value: &Value| state.iter().copied().chain([*value]).collect();
        all = all.iter().flat_map(|state| values.iter().map(|value| with(state, value))).collect();
    }
    all.into_iter().map(State::from).filter(|state| holds_in(system, &system.init, state)).collect()
}

/// Every path of so many steps.
#[must_use]
pub fn paths(system: &System, path: PathId, steps: usize) -> Vec<Trace> {
    let start = |state| Trace { path, states: vec![state], actions: Vec::new() };
    let mut all: Vec<Trace> = starts(system).into_iter().map(start).collect();
    for _ in 0..steps {
        let further = |trace: &Trace| {
            let next = transitions(system, &trace.states[trace.actions.len()]).into_iter();
            let trace = trace.clone();
            next.map(move |(action, state)| {
                let mut longer = trace.clone();
                longer.actions.push(action);
                longer.states.push(state);
                longer
            })
        };
        all = all.iter().flat_map(further).collect();
    }
    all
}

/// Whether paths of equal length, in the order of their variables, satisfy the objective's formula `within` that length.
#[must_use]
pub fn holds(problem: &Problem, objective: &Objective, paths: &[&Trace]) -> bool {
    Reading { problem, objective, paths }.at(objective.formula.root(), 0)
}

struct Reading<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    paths: &'a [&'a Trace],
}

impl Reading<'_> {
    fn at(&self, id: FormulaId, time: usize) -> bool {
        let end = self.paths[0].actions.len();
        let times = |interval: &Interval| {
            let last = interval.hi.map_or(end, |hi| end.min(time + hi as usize));
            time + interval.lo as usize..=last
        };
        match &self.objective.formula.nodes[id] {
            Node::Atom(expr) => expr.evaluate(&mut |leaf| self.leaf(leaf, time)) == Some(Value::Bool(true)),
            Node::Not(a) => !self.at(*a, time),
            Node::And(parts) => parts.iter().all(|&part| self.at(part, time)),
            Node::Or(parts) => parts.iter().any(|&part| self.at(part, time)),
            Node::Iff(a, b) => self.at(*a, time) == self.at(*b, time),
            Node::Next(a) => time < end && self.at(*a, time + 1),
            Node::WeakNext(a) => time == end || self.at(*a, time + 1),
            Node::Until(interval, a, b) => times(interval)
                .any(|then| self.at(*b, then) && (time..then).all(|before| self.at(*a, before))),
            Node::Release(interval, a, b) => times(interval)
                .all(|then| self.at(*b, then) || (time..then).any(|before| self.at(*a, before))),
        }
    }

    fn leaf(&self, leaf: &PathLeaf, time: usize) -> Option<Value> {
        let of = |path: PathId| self.paths[usize::from(path)];
        let took = |path: PathId| time.checked_sub(1).map(|step| of(path).actions[step]);
        let system = |path: PathId| &self.problem.systems[self.objective.paths[path].system];
        let next = |path: PathId| transitions(system(path), &of(path).states[time]);
        Some(Value::Bool(match *leaf {
            PathLeaf::State(path, leaf) => return read_leaf(system(path), leaf, &of(path).states[time]),
            PathLeaf::Took(path, action) => took(path) == Some(action),
            PathLeaf::SameAction(p, q) => took(p) == took(q),
            PathLeaf::SameState(p, q) => of(p).states[time] == of(q).states[time],
            PathLeaf::Enabled(path, action) => next(path).iter().any(|step| step.0 == action),
            PathLeaf::Halted(path) => next(path).iter().all(|step| step.1 == of(path).states[time]),
        }))
    }
}
