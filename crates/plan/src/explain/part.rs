//! The objectives that are made of some parts of another, and what holds of given paths.

use crate::lint::rewrite::{Builder, Replaced};
use hyperplan_problem::{
    Comparison, Expr, Formula, FormulaId, Interval, Leaf, Mode, Node, Objective, PathId, PathLeaf, Problem,
    State, Trace, Value, VarId, extended,
};
use hyperplan_syntax::Span;

/// The objective with some parts only.
pub(super) fn of_parts(objective: &Objective, parts: &[FormulaId]) -> Objective {
    let mut builder = Builder::new(&objective.formula);
    let built = builder.parts(parts, &Replaced::new());
    let built = builder.join(true, built, objective.formula.root());
    let formula = builder.finish(built).unwrap_or_else(|value| constant(value, objective.span));
    Objective { formula, minimize: Vec::new(), ..objective.clone() }
}

fn constant(value: bool, span: Span) -> Formula {
    let mut formula = Formula::default();
    formula.push(Node::Atom(if value { Expr::TRUE } else { Expr::FALSE }), span);
    formula
}

/// The objective without all paths behind these, of which the formula must read none.
pub(super) fn first_paths(objective: &Objective, count: usize) -> Objective {
    Objective { paths: objective.paths.iter().take(count).cloned().collect(), ..objective.clone() }
}

/// A question with leading paths as long as an objective has them, so that its strategies are of that.
pub(crate) fn as_long(problem: &Problem, objective: &Objective, question: &Objective) -> Objective {
    let mut question = question.clone();
    if matches!(objective.mode, Mode::Within(_)) {
        return question;
    }
    let horizons = hyperplan_horizon::horizons(objective);
    for path in objective.leading_block() {
        if let Some(steps) = horizons[path].steps.and_then(|steps| u32::try_from(steps).ok()) {
            question = extended(problem, &question, &[path], steps);
        }
    }
    question
}

/// The objective with paths bound to traces.
pub(super) fn pinned(problem: &Problem, objective: &Objective, traces: &[Trace]) -> Objective {
    let mut pinned = objective.clone();
    let mut parts = vec![pinned.formula.root()];
    for trace in traces {
        for (time, state) in trace.states.iter().enumerate() {
            let mut agrees = vec![is_at(problem, objective, trace.path, state)];
            let took = time.checked_sub(1).and_then(|step| trace.actions.get(step));
            agrees.extend(took.map(|&action| Expr::Leaf(PathLeaf::Took(trace.path, action))));
            parts.push(at(&mut pinned.formula, time, Expr::And(agrees), objective.span));
        }
    }
    pinned.formula.push(Node::And(parts), objective.span);
    pinned
}

/// That a path is in a state.
pub(super) fn is_at(problem: &Problem, objective: &Objective, path: PathId, state: &State) -> Expr<PathLeaf> {
    let vars = problem.systems[objective.paths[path].system].vars.keys();
    Expr::And(vars.zip(state.iter()).map(|(var, &value)| is(path, var, value)).collect())
}

fn is(path: PathId, var: VarId, value: Value) -> Expr<PathLeaf> {
    let leaf = Expr::Leaf(PathLeaf::State(path, Leaf::Var(var)));
    match value {
        Value::Bool(true) => leaf,
        Value::Bool(false) => Expr::Not(Box::new(leaf)),
        value => Expr::Compare(Comparison::Eq, Box::new(leaf), Box::new(Expr::Const(value))),
    }
}

/// That something holds at a time.
pub(super) fn at(formula: &mut Formula, time: usize, what: Expr<PathLeaf>, span: Span) -> FormulaId {
    let atom = formula.push(Node::Atom(what), span);
    if time == 0 {
        return atom;
    }
    let always = formula.push(Node::And(Vec::new()), span);
    let time = u32::try_from(time).unwrap_or(u32::MAX);
    formula.push(Node::Until(Interval { lo: time, hi: Some(time) }, always, atom), span)
}

/// What a subformula without operators over time is in a state of a path, as far as that alone decides it.
pub(super) fn now(
    formula: &Formula,
    id: FormulaId,
    leaf: &mut impl FnMut(&PathLeaf) -> Option<Value>,
) -> Option<bool> {
    match &formula.nodes[id] {
        Node::Atom(e) => e.truth(leaf),
        Node::Not(a) => now(formula, *a, leaf).map(|value| !value),
        Node::And(ids) => all(formula, ids, true, leaf),
        Node::Or(ids) => all(formula, ids, false, leaf),
        Node::Iff(a, b) => Some(now(formula, *a, leaf)? == now(formula, *b, leaf)?),
        Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..) => None,
    }
}

/// A conjunction (`and`) or disjunction.
fn all(
    formula: &Formula,
    ids: &[FormulaId],
    and: bool,
    leaf: &mut impl FnMut(&PathLeaf) -> Option<Value>,
) -> Option<bool> {
    let mut so_far = Some(and);
    for &id in ids {
        match now(formula, id, leaf) {
            Some(value) if value != and => return Some(value),
            value => so_far = so_far.and(value),
        }
    }
    so_far
}
