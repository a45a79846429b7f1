//! Evaluation of state expressions where some variables may be unknown: a label that depends on nothing but the
//! cell can be drawn, whatever else the state has.

use hyperplan_problem::{Comparison, Expr, Leaf, System, Value};

/// The value of `expr` where variable `v` has the value `known(v)`; `None` where that is not enough to tell.
pub(crate) fn eval(system: &System, expr: &Expr<Leaf>, known: &[Option<Value>]) -> Option<Value> {
    let value = |e: &Expr<Leaf>| eval(system, e, known);
    let bool = |e: &Expr<Leaf>| truth(system, e, known);
    let int = |e: &Expr<Leaf>| integer(system, e, known);
    match expr {
        Expr::Const(v) => Some(*v),
        Expr::Leaf(Leaf::Var(v)) => known.get(usize::from(*v)).copied().flatten(),
        Expr::Leaf(Leaf::Label(l)) => value(&system.labels.get(*l)?.expr),
        Expr::Not(a) => bool(a).map(|b| Value::Bool(!b)),
        Expr::And(es) => junction(es.iter().map(bool), false).map(Value::Bool),
        Expr::Or(es) => junction(es.iter().map(bool), true).map(Value::Bool),
        Expr::Iff(a, b) => Some(Value::Bool(bool(a)? == bool(b)?)),
        Expr::Compare(op, a, b) => {
            let (a, b) = (value(a)?, value(b)?);
            Some(Value::Bool(match op {
                Comparison::Eq => a == b,
                Comparison::Lt => a < b,
                Comparison::Le => a <= b,
            }))
        }
        Expr::Add(es) => es.iter().try_fold(0i64, |sum, e| sum.checked_add(int(e)?)).map(Value::Int),
        Expr::Mul(c, a) => c.checked_mul(int(a)?).map(Value::Int),
        Expr::Div(a, c) => int(a)?.checked_div_euclid(*c).map(Value::Int),
        Expr::Mod(a, c) => int(a)?.checked_rem_euclid(*c).map(Value::Int),
        Expr::If(c, a, b) => value(if bool(c)? { a } else { b }),
        Expr::Member(es, set) => {
            let tuple: Vec<i64> = es.iter().map(int).collect::<Option<_>>()?;
            Some(Value::Bool(set.contains(&tuple)))
        }
    }
}

/// The truth value of a Boolean expression.
pub(crate) fn truth(system: &System, expr: &Expr<Leaf>, known: &[Option<Value>]) -> Option<bool> {
    match eval(system, expr, known) {
        Some(Value::Bool(b)) => Some(b),
        _ => None,
    }
}

fn integer(system: &System, expr: &Expr<Leaf>, known: &[Option<Value>]) -> Option<i64> {
    match eval(system, expr, known) {
        Some(Value::Int(n)) => Some(n),
        _ => None,
    }
}

/// A disjunction (`winner` true) or conjunction (`winner` false) of values that may be unknown.
fn junction(values: impl Iterator<Item = Option<bool>>, winner: bool) -> Option<bool> {
    let mut unknown = false;
    for value in values {
        match value {
            Some(b) if b == winner => return Some(winner),
            Some(_) => {}
            None => unknown = true,
        }
    }
    if unknown { None } else { Some(!winner) }
}
