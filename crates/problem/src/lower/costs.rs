//! Costs: what steps of a system cost, and what objectives say of their sums.
//!
//! The sum of a path's costs is a number that each step adds to: a variable that every action *also* changes. So an
//! objective that reads `cost fuel[p]` is about a path of another system, which is the one of the file with such variables.
//! They stop at a number that no sum reaches in the steps that the objective reads, or beyond all that the sums are compared
//! with; thus they take no transition away and decide nothing about paths that go on for ever.

use super::also::{Together, satisfied};
use super::base::Actions;
use super::diagnostics::Diagnostics;
use super::expr::{Context, integer};
use super::limits::{MAX_BOUND, MAX_RANGE};
use super::state::StateContext;
use super::step::StepContext;
use crate::expr::{Comparison, Expr, Leaf, PathLeaf, StepLeaf, Value};
use crate::formula::{Formula, Node};
use crate::ids::{CostId, PathId, SystemId, VarId};
use crate::objective::{Mode, Objective};
use crate::sums::{add_sum, same_state};
use crate::system::{Cost, System};
use hyperplan_syntax::ast::{self, Ident};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
use typed_index_collections::{TiSlice, TiVec};

/// Of systems with more actions it is not searched whether a cost can be negative.
const MOST_ACTIONS: usize = 64;

/// How many partial assignments may be looked at to see that a cost is never negative.
const MOST_LOOKS: usize = 400_000;

/// `cost NAME = EXPR;`, or `None` after a message.
pub(super) fn lower_cost(
    cx: &mut StateContext,
    name: &Ident,
    e: &ast::Expr,
    system: &System,
    actions: &Actions,
) -> Option<Cost> {
    if let Some(first) = system.costs.iter().find(|cost| cost.name == name.name) {
        let message = format!("a second cost `{}`", name.name);
        let diagnostic = Diagnostic::error("duplicate-name", name.span, message);
        return cx.error(diagnostic.with_related(first.span, "the first one"));
    }
    let (expr, bounds) = integer(&mut StepContext { state: &mut *cx, system, actions }, e)?;
    if !system.is_finite() {
        let message = format!("system {} has variables without bounds, and no costs", system.name);
        let diagnostic = Diagnostic::error("unbounded-cost", name.span, message);
        return cx.error(diagnostic.with_help("give every variable a range, such as `0..99`"));
    }
    let bounds = bounds.filter(|bounds| bounds.hi <= MAX_RANGE);
    let Some(bounds) = bounds else {
        let message = "a step may cost more than 2^40";
        return cx.error(Diagnostic::error("number-too-large", e.span, message));
    };
    if bounds.lo < 0
        && let Some(place) = negative(system, &expr)
    {
        let message = format!("a cost is never negative, and this may be{place}");
        let help = "add what makes it positive, or write `if E < 0 then 0 else E`";
        return cx.error(Diagnostic::error("negative-cost", e.span, message).with_help(help));
    }
    one_number(cx, e, &expr, system)?;
    Some(Cost { name: name.name.clone(), expr, most: bounds.hi.max(0), span: name.span })
}

/// Where an expression over a step may be negative, in words; `None` where it never is.
fn negative(system: &System, expr: &Expr<StepLeaf>) -> Option<String> {
    let mut reads_numbers = false;
    expr.for_each_leaf(&mut |leaf| reads_numbers |= matches!(leaf, StepLeaf::Attribute(_)));
    if reads_numbers || system.actions.len() > MOST_ACTIONS {
        return Some(String::new());
    }
    let mut looks = MOST_LOOKS;
    for &action in &system.actions {
        let cost = expr.of_state(action, &|_| Expr::Const(Value::Int(0)));
        let below = Expr::Compare(Comparison::Lt, Box::new(cost), Box::new(Expr::Const(Value::Int(0))));
        let there = Expr::And(vec![below, Expr::Not(Box::new(system.absorb.clone()))]);
        match satisfied(system, &there, &mut looks) {
            Together::Never => {}
            Together::Somewhere(place) => return Some(place),
            Together::Unknown => return Some(String::new()),
        }
    }
    None
}

/// Refuses costs of which it could not be told what a step costs: two ways to take it carry two numbers.
fn one_number(cx: &mut StateContext, e: &ast::Expr, expr: &Expr<StepLeaf>, system: &System) -> Option<()> {
    let mut reads_numbers = false;
    expr.for_each_leaf(&mut |leaf| reads_numbers |= matches!(leaf, StepLeaf::Attribute(_)));
    let Some(edges) = system.edges.as_ref().filter(|_| reads_numbers) else { return Some(()) };
    let listed: rustc_hash::FxHashSet<_> = edges.iter().map(|(_, edge)| edge.action).collect();
    let both = system.clauses.iter().find(|c| c.actions.iter().any(|action| listed.contains(action)));
    let Some(clause) = both else { return Some(()) };
    let message = "the graph has transitions of an action that a clause gives others, which carry no numbers";
    let diagnostic = Diagnostic::error("ambiguous-cost", e.span, message);
    let help = "give the clause an action of its own";
    cx.error(diagnostic.with_related(clause.span, "this clause").with_help(help))
}

/// The variable that stands for the sum of a cost until the objective is complete.
pub(super) fn placeholder(system: &System, cost: CostId) -> VarId {
    VarId::from(system.vars.len() + usize::from(cost))
}

/// Bounds of what the sum of a cost can be, whatever the objective.
pub(super) fn most(cost: &Cost) -> i64 {
    cost.most.saturating_mul(MAX_BOUND)
}

/// A sum that an atom of an objective reads.
type Sum = (PathId, CostId);

/// Gives each path of which the formula reads sums a system with variables for them; the systems that are new, to be
/// numbered behind those that there are. `None` after a message.
pub(super) fn with_sums(
    systems: &TiSlice<SystemId, System>,
    objective: &mut Objective,
    new: &mut Vec<System>,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let system_of = |path: PathId| &systems[objective.paths[path].system];
    let sum = |leaf: &PathLeaf| match *leaf {
        PathLeaf::State(path, Leaf::Var(var)) => {
            let at = usize::from(var).checked_sub(system_of(path).vars.len())?;
            Some((path, CostId::from(at)))
        }
        _ => None,
    };
    let mut sums: Vec<Sum> = Vec::new();
    for node in &objective.formula.nodes {
        if let Node::Atom(e) = node {
            e.for_each_leaf(&mut |leaf| sums.extend(sum(leaf)));
        }
    }
    sums.sort_unstable();
    sums.dedup();
    if sums.is_empty() {
        return Some(());
    }
    let steps = steps(objective);
    let mut vars: FxHashMap<Sum, VarId> = FxHashMap::default();
    let mut changed = Vec::new();
    for own in sums.chunk_by(|a, b| a.0 == b.0) {
        let path = own[0].0;
        let mut system = system_of(path).clone();
        system.base = Some(objective.paths[path].system);
        for &(_, cost) in own {
            let reached = system.costs[cost].most.saturating_mul(steps);
            let compared = compared(&objective.formula, &|leaf| sum(leaf) == Some((path, cost)));
            let cap = compared.map_or(reached, |most| reached.min(most.saturating_add(1)).max(0));
            if cap > MAX_RANGE {
                let message =
                    format!("the cost {} of {steps} steps may be more than 2^40", system.costs[cost].name);
                let diagnostic = Diagnostic::error("number-too-large", objective.span, message);
                return diagnostics.refuse(diagnostic.with_help("count in larger units"));
            }
            vars.insert((path, cost), add_sum(&mut system, cost, cap));
        }
        let known = new.iter().position(|other| *other == system);
        let at = known.unwrap_or_else(|| {
            new.push(system);
            new.len() - 1
        });
        changed.push((path, SystemId::from(systems.len() + at)));
    }
    let mut of = |leaf: &PathLeaf| match sum(leaf).and_then(|sum| Some((sum.0, vars.get(&sum)?))) {
        Some((path, var)) => Expr::Leaf(PathLeaf::State(path, Leaf::Var(*var))),
        None => match *leaf {
            // The states are those of the file's system, without the sums.
            PathLeaf::SameState(p, q) if changed.iter().any(|(path, _)| [p, q].contains(path)) => {
                same_state(system_of(p), p, q)
            }
            leaf => Expr::Leaf(leaf),
        },
    };
    let mut formula = objective.formula.clone();
    for node in &mut formula.nodes {
        if let Node::Atom(e) = node {
            *e = e.substitute(&mut of);
        }
    }
    objective.formula = formula;
    for (path, system) in changed {
        objective.paths[path].system = system;
    }
    Some(())
}

/// How many steps the formula reads at most.
fn steps(objective: &Objective) -> i64 {
    if let Mode::Within(steps) = objective.mode {
        return i64::from(steps);
    }
    let nodes = &objective.formula.nodes;
    let mut time: Vec<Option<i64>> = vec![None; nodes.len()];
    time[usize::from(objective.formula.root())] = Some(0);
    let mut latest = 0;
    for (id, node) in nodes.iter_enumerated().rev() {
        let Some(now) = time[usize::from(id)] else { continue };
        let later = match node {
            Node::Next(_) | Node::WeakNext(_) => 1,
            Node::Until(interval, ..) | Node::Release(interval, ..) => i64::from(interval.hi.unwrap_or(0)),
            Node::Atom(_) | Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => 0,
        };
        latest = latest.max(now.saturating_add(later));
        for child in node.children() {
            let read = &mut time[usize::from(child)];
            *read = (*read).max(Some(now.saturating_add(later)));
        }
    }
    latest
}

/// The greatest constant that a sum is compared with, if that is all that the formula does with it.
fn compared(formula: &Formula, is_sum: &dyn Fn(&PathLeaf) -> bool) -> Option<i64> {
    let mut most = 0;
    for node in &formula.nodes {
        let Node::Atom(e) = node else { continue };
        let mut open = vec![e];
        while let Some(e) = open.pop() {
            match e {
                Expr::Leaf(leaf) if is_sum(leaf) => return None,
                Expr::Compare(_, a, b) => match (&**a, &**b) {
                    (Expr::Leaf(leaf), Expr::Const(Value::Int(n)))
                    | (Expr::Const(Value::Int(n)), Expr::Leaf(leaf))
                        if is_sum(leaf) =>
                    {
                        most = most.max(*n);
                    }
                    _ => open.extend([&**a, b]),
                },
                _ => open.extend(e.children()),
            }
        }
    }
    Some(most)
}

/// The cost of a system that has a name, or `None` after a message.
pub(super) fn known_cost(
    system: &System,
    name: &Ident,
    poisoned: bool,
    diagnostics: &mut Diagnostics,
) -> Option<CostId> {
    let known = system.costs.iter_enumerated().find(|(_, cost)| cost.name == name.name);
    if known.is_none() && !poisoned {
        let message = format!("no cost `{}` in system {}", name.name, system.name);
        let diagnostic = Diagnostic::error("unknown-name", name.span, message);
        let costs: TiVec<CostId, &str> = system.costs.iter().map(|cost| cost.name.as_str()).collect();
        diagnostics.push(match costs.is_empty() {
            true => diagnostic.with_help(format!("declare it in the system: `cost {} = 1;`", name.name)),
            false => super::diagnostics::suggest(diagnostic, &name.name, costs),
        });
    }
    known.map(|(id, _)| id)
}

/// Refuses sums under `semantics`: where paths halt, costs go on.
pub(super) fn demand_plain(
    objective: &Objective,
    place: Option<Span>,
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    let (Some(_), Some(place)) = (objective.semantics, place) else { return Some(()) };
    let message = "costs cannot be read under `semantics`: where a path halts, what it costs need not";
    let diagnostic = Diagnostic::error("misplaced-cost", place, message);
    diagnostics.refuse(diagnostic.with_help("leave `semantics` out, or use `minimize`"))
}
