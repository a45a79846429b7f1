//! What transitions do besides: `also on A when G { ... }`.

use super::base::Actions;
use super::clauses::{head, new_value, repeated_update, updated};
use super::state::StateContext;
use super::step::StepContext;
use super::typed::labels_read;
use crate::display;
use crate::expr::{Expr, Leaf, TupleSet, Type, Value};
use crate::ids::{ActionId, LabelId, VarId};
use crate::system::{Also, System};
use hyperplan_syntax::{Diagnostic, Span, ast};
use rustc_hash::FxHashSet;
use typed_index_collections::TiVec;

/// How many partial assignments of one system may be looked at to see that clauses exclude each other.
const MOST_LOOKS: usize = 400_000;

/// The clause, or `None` after a message.
pub(super) fn lower_also(
    cx: &mut StateContext,
    clause: &ast::Clause,
    system: &System,
    actions: &Actions,
) -> Option<Also> {
    let (listed, guard) = head(cx, clause, system, actions);
    let lower = |update: &ast::Update| {
        let var = updated(cx, update)?;
        let ty = cx.vars[var].ty.clone();
        let mut cx = StepContext { state: &mut *cx, system, actions };
        Some((var, new_value(&mut cx, &update.value, &ty)?))
    };
    let updates: Vec<_> = clause.updates.iter().map(lower).collect();
    let updates = updates.into_iter().collect::<Option<Vec<_>>>()?;
    repeated_update(cx, clause)?;
    let mut actions = listed?;
    actions.sort_unstable();
    Some(Also { actions, guard: guard?, updates, span: clause.span })
}

/// Refuses systems in which one step could change a variable twice: by what makes it, and by what it does besides.
pub(super) fn demand_apart(cx: &mut StateContext, system: &System) {
    let mut looks = MOST_LOOKS;
    for (at, also) in system.also.iter().enumerate() {
        let span = also.span;
        if let Some(edges) = &system.edges {
            let moves = also.updates.iter().any(|(var, _)| *var == edges.var);
            let listed = |action: &ActionId| edges.iter().any(|(_, edge)| edge.action == *action);
            if moves && also.actions.iter().any(listed) {
                let name = &system.vars[edges.var].name;
                let message =
                    format!("the graph's transitions say what `{name}` becomes, and so does this clause");
                cx.diagnostics.push(Diagnostic::error("repeated-update", span, message));
            }
        }
        let others = system.also[..at].iter().map(|other| {
            let vars = other.updates.iter().map(|(var, _)| *var).collect::<Vec<_>>();
            (&other.actions[..], &other.guard, vars, other.span, "the other one")
        });
        let clauses = system.clauses.iter().map(|clause| {
            let vars = clause.updates.iter().map(|(var, _)| *var).collect();
            let what = if clause.generated { "a move of this map" } else { "the transitions' clause" };
            (&clause.actions[..], &clause.guard, vars, clause.span, what)
        });
        // Of the moves of a map one message is enough.
        let mut blamed: FxHashSet<Span> = FxHashSet::default();
        for (actions, guard, vars, place, what) in others.chain(clauses) {
            let both = also.updates.iter().map(|(var, _)| *var).find(|var| vars.contains(var));
            let shared = actions.iter().any(|action| also.actions.binary_search(action).is_ok());
            let Some(var) = both.filter(|_| shared && !blamed.contains(&place)) else { continue };
            let name = &system.vars[var].name;
            let diagnostic = match together(system, [guard, &also.guard], &mut looks) {
                Together::Never => continue,
                Together::Somewhere(place) => {
                    let message = format!("a step would change `{name}` twice{place}");
                    let help = "a `when` that excludes the other, or one clause: `v' = if C then A else B;`";
                    Diagnostic::error("repeated-update", span, message).with_help(help)
                }
                Together::Unknown => {
                    let message = format!("it cannot be told whether a step would change `{name}` twice");
                    let help = "write one clause with `v' = if C then A else B;`, or give one of them `when C` and the other \
                         `when !C`";
                    Diagnostic::error("repeated-update", span, message).with_help(help)
                }
            };
            blamed.insert(place);
            cx.diagnostics.push(diagnostic.with_related(place, what));
        }
    }
}

/// Whether two guards hold in one state that does not absorb.
pub(super) enum Together {
    /// They do not.
    Never,
    /// They do, in the states with these values, in words.
    Somewhere(String),
    /// It would take too long to tell.
    Unknown,
}

fn together(system: &System, guards: [&Expr<Leaf>; 2], looks: &mut usize) -> Together {
    let absorbs = || Expr::Not(Box::new(system.absorb.clone()));
    let parts: Vec<&Expr<Leaf>> = guards.into_iter().flat_map(conjuncts).collect();
    let denied = |e: &Expr<Leaf>| matches!(e, Expr::Not(inner) if parts.contains(&&**inner));
    if parts.iter().any(|part| denied(part)) {
        return Together::Never;
    }
    // Letters of a map, which may have millions of cells, are labels of cells that are no other's.
    let cells: Vec<_> = parts.iter().filter_map(|part| members(system, part)).collect();
    let apart = |(a, first): &(&[Expr<Leaf>], &TupleSet), (b, second): &(&[Expr<Leaf>], &TupleSet)| {
        a == b && !first.tuples.iter().any(|tuple| second.contains(tuple))
    };
    if cells.iter().enumerate().any(|(at, first)| cells[at + 1..].iter().any(|second| apart(first, second))) {
        return Together::Never;
    }
    let mut all: Vec<Expr<Leaf>> = parts.into_iter().cloned().collect();
    match satisfied(system, &Expr::And(all.clone()), looks) {
        Together::Somewhere(_) if !system.absorb.is_false() => {
            all.push(absorbs());
            satisfied(system, &Expr::And(all), looks)
        }
        found => found,
    }
}

/// What a condition says is in a set, and that set, if it is such a condition or a label with one.
fn members<'s>(system: &'s System, e: &'s Expr<Leaf>) -> Option<(&'s [Expr<Leaf>], &'s TupleSet)> {
    let e = match e {
        Expr::Leaf(Leaf::Label(label)) => &system.labels[*label].expr,
        e => e,
    };
    conjuncts(e).iter().find_map(|part| match part {
        Expr::Member(tuple, set) => Some((tuple.as_slice(), &**set)),
        _ => None,
    })
}

fn conjuncts(e: &Expr<Leaf>) -> &[Expr<Leaf>] {
    match e {
        Expr::And(es) => es,
        other => std::slice::from_ref(other),
    }
}

/// Looks for values of the variables that a condition reads under which it holds, one variable after the other.
pub(super) fn satisfied(system: &System, condition: &Expr<Leaf>, looks: &mut usize) -> Together {
    let vars = variables(system, condition);
    let mut values: TiVec<VarId, Option<Value>> = vec![None; system.vars.len()].into();
    // Of each variable that has a value, how many were tried.
    let mut tried: Vec<i64> = Vec::new();
    'look: loop {
        *looks = match looks.checked_sub(1) {
            Some(left) => left,
            None => return Together::Unknown,
        };
        match system.evaluate(condition, &|var| values[var]) {
            Some(Value::Bool(true)) => return Together::Somewhere(example(system, &vars, &values)),
            Some(_) => {}
            None if tried.len() < vars.len() => tried.push(0),
            None => return Together::Unknown,
        }
        while let Some(var) = tried.len().checked_sub(1).map(|last| vars[last]) {
            let nth = tried.last_mut().map(|tried| std::mem::replace(tried, *tried + 1)).unwrap_or_default();
            let Some(value) = nth_value(&system.vars[var].ty, nth) else { return Together::Unknown };
            values[var] = value;
            if value.is_some() {
                continue 'look;
            }
            tried.pop();
        }
        return Together::Never;
    }
}

/// The nth value of a type, if it has so many; `None` for a type without an end.
fn nth_value(ty: &Type, nth: i64) -> Option<Option<Value>> {
    let value = match ty {
        Type::Bool => (nth < 2).then_some(Value::Bool(nth == 1)),
        Type::Range { lo, hi } => (nth <= hi - lo).then_some(Value::Int(lo + nth)),
        Type::Enum(names) => u32::try_from(nth).ok().filter(|n| (*n as usize) < names.len()).map(Value::Enum),
        Type::Int | Type::Real => return None,
    };
    Some(value)
}

/// The variables that a condition reads, itself or in labels, those with the fewest values first.
fn variables(system: &System, condition: &Expr<Leaf>) -> Vec<VarId> {
    let mut labels: Vec<usize> = labels_read(condition);
    let mut vars = variables_read(condition);
    let mut known = labels.clone();
    while let Some(label) = labels.pop() {
        let expr = &system.labels[LabelId::from(label)].expr;
        vars.extend(variables_read(expr));
        for below in labels_read(expr) {
            if !known.contains(&below) {
                known.push(below);
                labels.push(below);
            }
        }
    }
    let size = |var: &VarId| match &system.vars[*var].ty {
        Type::Bool => 2,
        Type::Range { lo, hi } => hi - lo + 1,
        Type::Enum(names) => i64::try_from(names.len()).unwrap_or(i64::MAX),
        Type::Int | Type::Real => i64::MAX,
    };
    vars.sort_unstable_by_key(|var| (size(var), *var));
    vars.dedup();
    vars
}

fn variables_read(e: &Expr<Leaf>) -> Vec<VarId> {
    let mut vars = Vec::new();
    e.for_each_leaf(&mut |leaf| {
        if let Leaf::Var(var) = leaf {
            vars.push(*var);
        }
    });
    vars
}

/// Where the values are: `, such as where x == 3`; empty where it is so everywhere.
fn example(system: &System, vars: &[VarId], values: &TiVec<VarId, Option<Value>>) -> String {
    let known = vars.iter().filter_map(|var| Some((&system.vars[*var], values[*var]?)));
    let known: Vec<String> =
        known.map(|(var, value)| format!("{} == {}", var.name, display::value(&var.ty, value))).collect();
    if known.is_empty() { String::new() } else { format!(", such as where {}", known.join(" & ")) }
}
