//! `forall` paths that are tied to another path's actions and cannot always take them.
//!
//! Such a path gets stuck, so it is no path, and refutes nothing: a plan can win by driving it there. The question is
//! asked of a system in which the impossible leads to a state of its own ([`super::total`]): can the assumption
//! hold until its path takes the other's action where it cannot?

use super::question::{Asker, free};
use super::rewrite::{Replaced, conjuncts};
use super::total::{JUST_STUCK, enabled, is, total};
use hyperplan_problem::{
    Comparison, Expr, Formula, FormulaId, Interval, Leaf, Mode, Node, Objective, PathId, PathLeaf, Problem,
    Quantifier, State, System, Type, Value, VarId, display,
};
use hyperplan_space::Graph;
use hyperplan_syntax::Diagnostic;
use hyperplan_syntax::ast::UnaryOp;
use std::collections::BTreeSet;

/// Systems with more states are not enumerated to see that nobody can get stuck.
const STATES: usize = 100_000;

/// Of graphs with more transitions it is not asked.
const EDGES: usize = 2_000;

/// Warns of each `forall` path that can get stuck, once.
pub(super) fn lint(asker: &mut Asker<'_>, found: &mut Vec<Diagnostic>) {
    let objective = asker.objective;
    let ties = ties(objective);
    for (follower, var) in objective.paths.iter_enumerated() {
        let Some(tie) = ties.iter().find(|tie| tie.follower == follower) else { continue };
        let system = &asker.problem.systems[var.system];
        if is_total(system) {
            continue;
        }
        if system.edges.as_ref().is_some_and(|edges| edges.iter().count() > EDGES) {
            let what = format!("path {} can get stuck: system {} is too large", var.name, system.name);
            asker.leave_open(objective.formula.spans[tie.atom], &what);
            continue;
        }
        if !system.trans.is_true() {
            let what = format!("path {} can get stuck: system {} has `trans`", var.name, system.name);
            asker.leave_open(objective.formula.spans[tie.atom], &what);
            continue;
        }
        found.extend(ask(asker, tie));
    }
}

/// An assumption that a path's actions are another's.
struct Tie {
    follower: PathId,
    leader: PathId,
    atom: FormulaId,
}

/// The equalities of actions that are assumed at every step of some time, for `forall` paths.
fn ties(objective: &Objective) -> Vec<Tie> {
    let formula = &objective.formula;
    let mut found = Vec::new();
    let mut seen = BTreeSet::new();
    // A subformula, the truth value that the assumption gives it, and whether at every step.
    let mut stack = vec![(formula.root(), false, false)];
    while let Some((id, want, always)) = stack.pop() {
        if !seen.insert((id, want, always)) {
            continue;
        }
        match &formula.nodes[id] {
            Node::Atom(Expr::Leaf(PathLeaf::SameAction(p, q))) if want && always => {
                for (follower, leader) in [(*p, *q), (*q, *p)] {
                    // Of two `forall` paths the later one follows.
                    let leads = objective.paths[leader].quantifier == Quantifier::Exists || leader < follower;
                    if objective.paths[follower].quantifier == Quantifier::Forall && leads {
                        found.push(Tie { follower, leader, atom: id });
                    }
                }
            }
            Node::Not(a) => stack.push((*a, !want, always)),
            Node::Until(_, a, b) => stack.extend([(*b, want, always || !want), (*a, want, always || want)]),
            Node::Release(_, a, b) => stack.extend([(*b, want, always || want), (*a, want, always || !want)]),
            Node::And(ids) => stack.extend(ids.iter().map(|&i| (i, want, always))),
            // Of an implication the antecedent first.
            Node::Or(ids) => stack.extend(ids.iter().rev().map(|&i| (i, want, always))),
            Node::Next(a) | Node::WeakNext(a) => stack.push((*a, want, always)),
            Node::Iff(..) | Node::Atom(_) => {}
        }
    }
    found
}

/// Whether every action is possible in every reachable state; not known of large systems.
fn is_total(system: &System) -> bool {
    let Ok(graph) = Graph::explore(system, STATES) else { return false };
    (0..graph.len()).all(|state| {
        let state = u32::try_from(state).unwrap_or(u32::MAX);
        system.actions.iter().all(|&action| graph.enables(state, action))
    })
}

/// The question, and what its answer says.
fn ask(asker: &mut Asker<'_>, tie: &Tie) -> Option<Diagnostic> {
    let objective = asker.objective;
    let original = &asker.problem.systems[objective.paths[tie.follower].system];
    let (system, stuck) = total(original);
    let mut problem = asker.problem.clone();
    let id = problem.systems.push_and_get_key(system);
    let formula = question(asker.problem, objective, tie, stuck);
    let mut question = free(objective, formula);
    question.paths[tie.follower].system = id;
    let span = objective.formula.spans[tie.atom];
    let name = &objective.paths[tie.follower].name;
    let what = format!("path {name} can get stuck");
    let answer = asker.example(&problem, &question, span, &what)??;
    let stuck_path = answer[usize::from(tie.follower)].as_ref()?;
    let just = |state: &State| state[usize::from(stuck)] == Value::Int(JUST_STUCK);
    let after = stuck_path.states.iter().position(just)?;
    let before: State = stuck_path.states[after.checked_sub(1)?][..usize::from(stuck)].into();
    let action = &problem.actions[*stuck_path.actions.get(after - 1)?];
    let leader = &objective.paths[tie.leader].name;
    let place = display::state(original, &before);
    let message =
        format!("path {name} gets stuck where it cannot follow {leader}: {place} has no `{action}`");
    Some(Diagnostic::warning("stuck-follower", span, message).with_help(format!(
        "a stuck path is no path and refutes nothing, so plans may lead {name} there; make every action possible \
         (`stay` or `crash` on maps), or end with `within K` before it matters"
    )))
}

/// What the tie's assumption and the other paths ask for, and that the follower got stuck by following.
fn question(problem: &Problem, objective: &Objective, tie: &Tie, stuck: VarId) -> Formula {
    let mut formula = objective.formula.clone();
    let span = formula.spans[tie.atom];
    let mut parts = assumptions(objective, tie);
    let state = |leaf: &Leaf| PathLeaf::State(tie.follower, *leaf);
    let just = Node::Atom(is(stuck, JUST_STUCK).map(&mut { state }));
    let same = Node::Atom(Expr::Leaf(PathLeaf::SameAction(tie.leader, tie.follower)));
    let here = vec![formula.push(just, span), formula.push(same, span)];
    let here = formula.push(Node::And(here), span);
    let hi = match objective.mode {
        Mode::Bounded => {
            let steps = hyperplan_horizon::latest_read(objective, tie.atom).unwrap_or(0);
            Some(u32::try_from(steps).unwrap_or(u32::MAX))
        }
        _ => None,
    };
    parts.push(formula.unary(UnaryOp::Finally, Interval { lo: 0, hi }, here, span));
    formula.push(Node::And(parts), span);
    let system = &problem.systems[objective.paths[tie.follower].system];
    for node in &mut formula.nodes {
        if let Node::Atom(e) = node {
            *e = e.substitute(&mut |leaf| read(*leaf, tie.follower, system));
        }
    }
    formula
}

/// What holds when the tie does: the conjuncts that do not speak of the follower, and the antecedents, with the tie
/// among them, that do.
fn assumptions(objective: &Objective, tie: &Tie) -> Vec<FormulaId> {
    let formula = &objective.formula;
    let above = super::rewrite::above(formula, tie.atom);
    let mut parts = Vec::new();
    for part in conjuncts(formula, formula.root(), &Replaced::new()) {
        if !above[part] {
            let mut reads = false;
            super::rewrite::leaves(formula, part, &mut |l| reads |= l.paths().contains(&Some(tie.follower)));
            if !reads {
                parts.push(part);
            }
            continue;
        }
        // Down to the antecedent that has the tie in it.
        let mut at = part;
        loop {
            at = match &formula.nodes[at] {
                Node::And(ids) => match ids.iter().find(|&&i| above[i]) {
                    Some(&next) => next,
                    None => break,
                },
                Node::Or(ids) => {
                    let assumed = ids.iter().filter_map(|&i| match &formula.nodes[i] {
                        Node::Not(a) => Some((*a, above[i])),
                        _ => None,
                    });
                    parts.extend(assumed.clone().map(|(a, _)| a));
                    let tied = assumed.into_iter().any(|(_, above)| above);
                    match ids.iter().find(|&&i| above[i]).filter(|_| !tied) {
                        Some(&next) => next,
                        None => break,
                    }
                }
                _ => break,
            };
        }
    }
    parts
}

/// What a leaf says of the follower, as it is in the system it came from.
fn read(leaf: PathLeaf, follower: PathId, system: &System) -> Expr<PathLeaf> {
    match leaf {
        PathLeaf::Enabled(p, action) if p == follower => {
            enabled(system, action).map(&mut |leaf| PathLeaf::State(p, *leaf))
        }
        PathLeaf::SameState(p, q) if p == follower || q == follower => same(p, q, system),
        leaf => Expr::Leaf(leaf),
    }
}

/// The states' equality, variable by variable.
fn same(p: PathId, q: PathId, system: &System) -> Expr<PathLeaf> {
    let equal = |(var, declared): (VarId, &hyperplan_problem::Var)| {
        let of = |path| Box::new(Expr::Leaf(PathLeaf::State(path, Leaf::Var(var))));
        match declared.ty {
            Type::Bool => Expr::Iff(of(p), of(q)),
            _ => Expr::Compare(Comparison::Eq, of(p), of(q)),
        }
    };
    Expr::And(system.vars.iter_enumerated().map(equal).collect())
}
