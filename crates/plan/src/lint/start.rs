//! Atoms about the action just taken, where time 0 decides them: no action has been taken there.

use hyperplan_problem::{Expr, Formula, FormulaId, Mode, Node, Objective, PathLeaf, Problem, Written};
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::operator::Operator;
use typed_index_collections::TiVec;

/// Looks at what is read at time 0 for sure: the operators that begin there, and atoms outside all of them.
pub(super) fn lint(problem: &Problem, objective: &Objective) -> Vec<Diagnostic> {
    let formula = &objective.formula;
    let about_actions = nodes_about_actions(formula);
    if !about_actions[formula.root()] {
        return Vec::new();
    }
    let start = truths(formula, &at_start);
    let mut later: Option<Truths> = None;
    let mut found = Vec::new();
    let mut seen: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| false).collect();
    let mut stack = vec![formula.root()];
    while let Some(id) = stack.pop() {
        if !about_actions[id] || std::mem::replace(&mut seen[id], true) {
            continue;
        }
        match &formula.nodes[id] {
            Node::Release(interval, _, a) if interval.lo == 0 && formula.globally(id).is_some() => {
                if start[*a] == Some(false) {
                    found.push(never(formula, id, culprit(formula, *a, &start)));
                } else if interval.hi != Some(0) && objective.mode != Mode::Within(0) {
                    let later = later.get_or_insert_with(|| never_later(problem, objective));
                    if later[*a] == Some(false) {
                        found.push(never_after(formula, id, *a));
                    }
                }
            }
            Node::Until(..) if start[id] == Some(true) && formula.finally(id).is_some() => {
                found.push(always(formula, id));
            }
            node if start[id].is_some() && is_read_as_one(formula, id, node) => {
                found.extend(start[id].map(|value| fixed(formula, id, value)));
            }
            _ if is_temporal(formula, id) => {}
            _ => stack.extend(formula.operands(id).into_iter().rev()),
        }
    }
    found
}

/// Whether a node is an atom as written: `action[p] == none` is a conjunction of others at the same place.
fn is_read_as_one(formula: &Formula, id: FormulaId, node: &Node) -> bool {
    let here = formula.spans[id];
    match node {
        Node::Atom(_) | Node::Not(_) => true,
        _ => formula.operands(id).iter().any(|&operand| formula.spans[operand] == here),
    }
}

/// Whether a node is what a temporal operator was lowered to.
fn is_temporal(formula: &Formula, id: FormulaId) -> bool {
    match &formula.nodes[id] {
        Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..) => true,
        Node::Atom(_) | Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => {
            let temporal =
                |written: &Written| matches!(written.operator, Operator::Unary(_) | Operator::Binary(_));
            formula.written(id).is_some_and(temporal)
        }
    }
}

fn never(formula: &Formula, id: FormulaId, culprit: FormulaId) -> Diagnostic {
    let message = "this is false at time 0, where no action has been taken, so the `G` around it never holds";
    Diagnostic::warning("action-at-start", formula.spans[culprit], message)
        .with_related(formula.spans[id], "the `G`")
        .with_help("begin one step later: `G[1,T]`, or `N G` under `within`")
}

fn never_after(formula: &Formula, id: FormulaId, a: FormulaId) -> Diagnostic {
    let message = "this is false after time 0, where some action has been taken, so the `G` never holds";
    Diagnostic::warning("action-at-start", formula.spans[a], message)
        .with_related(formula.spans[id], "the `G`")
}

fn always(formula: &Formula, id: FormulaId) -> Diagnostic {
    let message = "this always holds: time 0 counts, where no action has been taken";
    Diagnostic::warning("action-at-start", formula.spans[id], message)
        .with_help("begin one step later: `F[1,T]`, or `X F` under `within`")
}

fn fixed(formula: &Formula, id: FormulaId, value: bool) -> Diagnostic {
    let message = format!("this is always {value}: it is read at time 0, where no action has been taken");
    Diagnostic::warning("action-at-start", formula.spans[id], message)
        .with_help("`X` reads the action that is taken first, `G` and `F` those that follow")
}

/// What the leaves about actions are at time 0.
fn at_start(leaf: &PathLeaf) -> Option<bool> {
    match leaf {
        PathLeaf::Took(..) => Some(false),
        PathLeaf::SameAction(..) => Some(true),
        _ => None,
    }
}

/// The value of each subformula now, as far as it is known.
type Truths = TiVec<FormulaId, Option<bool>>;

/// `false` for the subformulas that are so whatever action some path has just taken.
fn never_later(problem: &Problem, objective: &Objective) -> Truths {
    let formula = &objective.formula;
    let mut never: Truths = formula.nodes.iter().map(|_| None).collect();
    for (path, var) in objective.paths.iter_enumerated() {
        let mut always_false: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| true).collect();
        for &action in &problem.systems[var.system].actions {
            let took = |leaf: &PathLeaf| match leaf {
                PathLeaf::Took(p, a) if *p == path => Some(*a == action),
                _ => None,
            };
            for (so_far, now) in always_false.iter_mut().zip(truths(formula, &took)) {
                *so_far &= now == Some(false);
            }
        }
        for (never, always_false) in never.iter_mut().zip(always_false) {
            *never = never.or(always_false.then_some(false));
        }
    }
    never
}

/// The part of a conjunction that is false.
fn culprit(formula: &Formula, id: FormulaId, truths: &Truths) -> FormulaId {
    let mut at = id;
    while let Node::And(ids) = &formula.nodes[at] {
        match ids.iter().find(|&&i| truths[i] == Some(false)) {
            Some(&part) => at = part,
            None => break,
        }
    }
    at
}

/// Each subformula's value now, as far as some leaves decide it.
fn truths(formula: &Formula, leaf: &impl Fn(&PathLeaf) -> Option<bool>) -> Truths {
    let mut all: Truths = TiVec::with_capacity(formula.nodes.len());
    for (id, node) in formula.nodes.iter_enumerated() {
        let value = match node {
            Node::Atom(e) => value(e, leaf),
            Node::Not(a) => not(all[*a]),
            Node::And(ids) => and(ids.iter().map(|&i| all[i])),
            Node::Or(ids) => not(and(ids.iter().map(|&i| not(all[i])))),
            Node::Iff(a, b) => all[*a].zip(all[*b]).map(|(a, b)| a == b),
            Node::Until(i, _, a) if i.lo == 0 && formula.finally(id).is_some() => all[*a].filter(|v| *v),
            Node::Release(i, _, a) if i.lo == 0 && formula.globally(id).is_some() => all[*a].filter(|v| !v),
            Node::Until(..) | Node::Release(..) | Node::Next(_) | Node::WeakNext(_) => None,
        };
        all.push(value);
    }
    all
}

/// Recursion is bounded by the nesting of expressions.
fn value(e: &Expr<PathLeaf>, leaf: &impl Fn(&PathLeaf) -> Option<bool>) -> Option<bool> {
    match e {
        _ if e.is_true() => Some(true),
        _ if e.is_false() => Some(false),
        Expr::Leaf(l) => leaf(l),
        Expr::Not(a) => not(value(a, leaf)),
        Expr::And(es) => and(es.iter().map(|e| value(e, leaf))),
        Expr::Or(es) => not(and(es.iter().map(|e| not(value(e, leaf))))),
        _ => None,
    }
}

fn not(value: Option<bool>) -> Option<bool> {
    value.map(|v| !v)
}

fn and(values: impl Iterator<Item = Option<bool>>) -> Option<bool> {
    let mut so_far = Some(true);
    for value in values {
        match value {
            Some(false) => return Some(false),
            value => so_far = so_far.and(value),
        }
    }
    so_far
}

fn nodes_about_actions(formula: &Formula) -> TiVec<FormulaId, bool> {
    let mut all: TiVec<FormulaId, bool> = TiVec::with_capacity(formula.nodes.len());
    for node in &formula.nodes {
        let mut found = node.children().into_iter().any(|child| all[child]);
        if let Node::Atom(e) = node {
            e.for_each_leaf(&mut |leaf| found |= at_start(leaf).is_some());
        }
        all.push(found);
    }
    all
}
