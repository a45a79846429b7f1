//! What reals cannot stand for (`--states real`).
//!
//! A variable with bounds is a real that starts as one of its integers, and integer updates keep it one. Where integers
//! have no bounds there is no list to start from, and reals know no rounding.

use hyperplan_problem::{Expr, Node, Objective, Problem, System, Type};
use hyperplan_relevance::Error;
use hyperplan_space::bounds;

/// The longest list of a variable's values: each is a disjunct.
const MOST_VALUES: i64 = 4096;

/// Refuses what reals cannot express.
pub(crate) fn demand(problem: &Problem, objective: &Objective) -> Result<(), Error> {
    for path in &objective.paths {
        demand_of(&problem.systems[path.system])?;
    }
    for node in &objective.formula.nodes {
        if let Node::Atom(expr) = node {
            demand_exact(&format!("objective {}", objective.name), expr)?;
        }
    }
    Ok(())
}

fn demand_of(system: &System) -> Result<(), Error> {
    let name = &system.name;
    for var in &system.vars {
        let what = match bounds(&var.ty) {
            None if var.ty == Type::Int => "without bounds".to_owned(),
            Some((lo, hi)) if hi.saturating_sub(lo) >= MOST_VALUES => {
                format!("with more than {MOST_VALUES} values")
            }
            _ => continue,
        };
        return Err(Error::NotReal { what: format!("system {name} has an integer, {}, {what}", var.name) });
    }
    let what = format!("system {name}");
    let clauses = system.clauses.iter();
    let updates = clauses.clone().flat_map(|clause| &clause.updates).flat_map(|(_, update)| update.exprs());
    let labels = system.labels.iter().map(|label| &label.expr);
    let rest = [&system.init, &system.absorb];
    let all =
        clauses.map(|clause| &clause.guard).chain(updates).chain(labels).chain(&system.observe).chain(rest);
    for expr in all.chain(system.also.iter().map(|also| &also.guard)) {
        demand_exact(&what, expr)?;
    }
    for (_, update) in system.also.iter().flat_map(|also| &also.updates) {
        for expr in update.exprs() {
            demand_exact(&what, expr)?;
        }
    }
    demand_exact(&what, &system.trans)
}

/// Refuses divisions that round.
fn demand_exact<L>(what: &str, expr: &Expr<L>) -> Result<(), Error> {
    let mut open = vec![expr];
    while let Some(expr) = open.pop() {
        if matches!(expr, Expr::Div(..) | Expr::Mod(..)) {
            return Err(Error::NotReal { what: format!("{what} uses div or %") });
        }
        open.extend(expr.children());
    }
    Ok(())
}
