//! The value of an expression, by the definition of each of its forms.

use hyperplan_problem::{Comparison, Expr, Value};

/// The value of `expr`, or `None` where it depends on a leaf that has none. Connectives are Kleene's: a false
/// conjunct decides whatever the others are.
pub(crate) fn eval<L>(expr: &Expr<L>, leaf: &impl Fn(&L) -> Option<Value>) -> Option<Value> {
    match expr {
        Expr::Const(value) => Some(*value),
        Expr::Leaf(l) => leaf(l),
        Expr::Not(a) => truth(a, leaf).map(|a| Value::Bool(!a)),
        Expr::And(es) => connective(es, false, leaf),
        Expr::Or(es) => connective(es, true, leaf),
        Expr::Iff(a, b) => Some(Value::Bool(truth(a, leaf)? == truth(b, leaf)?)),
        Expr::Compare(op, a, b) => compare(*op, eval(a, leaf)?, eval(b, leaf)?).map(Value::Bool),
        Expr::Add(es) => {
            let (first, rest) = es.split_first()?;
            let first = eval(first, leaf)?;
            rest.iter().try_fold(first, |sum, e| sum.checked_add(eval(e, leaf)?))
        }
        Expr::Mul(c, a) => c.checked_mul(int(a, leaf)?).map(Value::Int),
        Expr::Scale(c, a) => Value::Real(*c).checked_mul(eval(a, leaf)?),
        Expr::ToReal(a) => int(a, leaf).and_then(|n| Value::real(n.into())),
        Expr::Div(a, c) => int(a, leaf)?.checked_div_euclid(*c).map(Value::Int),
        Expr::Mod(a, c) => int(a, leaf)?.checked_rem_euclid(*c).map(Value::Int),
        Expr::If(branches, last) => chain(branches, last, leaf),
        Expr::Member(es, set) => {
            let mut short = [0; 4];
            let Some(tuple) = short.get_mut(..es.len()) else {
                let tuple = es.iter().map(|e| member(e, leaf)).collect::<Option<Vec<i64>>>()?;
                return Some(Value::Bool(set.contains(&tuple)));
            };
            for (value, e) in tuple.iter_mut().zip(es) {
                *value = member(e, leaf)?;
            }
            Some(Value::Bool(set.contains(tuple)))
        }
    }
}

/// The value beside the first condition that holds, or the last. Where it is not known whether one holds, all that may
/// come of it have to agree.
fn chain<L>(
    branches: &[(Expr<L>, Expr<L>)],
    last: &Expr<L>,
    leaf: &impl Fn(&L) -> Option<Value>,
) -> Option<Value> {
    let mut possible = None;
    let mut agrees = |value: Value| *possible.get_or_insert(value) == value;
    for (condition, value) in branches {
        let holds = truth(condition, leaf);
        if holds != Some(false) && !agrees(eval(value, leaf)?) {
            return None;
        }
        if holds == Some(true) {
            return possible;
        }
    }
    eval(last, leaf).filter(|value| agrees(*value))
}

/// The value of a Boolean expression.
pub(crate) fn truth<L>(expr: &Expr<L>, leaf: &impl Fn(&L) -> Option<Value>) -> Option<bool> {
    match eval(expr, leaf)? {
        Value::Bool(b) => Some(b),
        Value::Int(_) | Value::Enum(_) | Value::Real(_) => None,
    }
}

fn int<L>(expr: &Expr<L>, leaf: &impl Fn(&L) -> Option<Value>) -> Option<i64> {
    match eval(expr, leaf)? {
        Value::Int(n) => Some(n),
        Value::Bool(_) | Value::Enum(_) | Value::Real(_) => None,
    }
}

/// What stands for a value in a set of tuples.
fn member<L>(expr: &Expr<L>, leaf: &impl Fn(&L) -> Option<Value>) -> Option<i64> {
    match eval(expr, leaf)? {
        Value::Int(n) => Some(n),
        Value::Enum(position) => Some(i64::from(position)),
        Value::Bool(_) | Value::Real(_) => None,
    }
}

/// `decisive` is the operand value that decides: false for a conjunction, true for a disjunction.
fn connective<L>(es: &[Expr<L>], decisive: bool, leaf: &impl Fn(&L) -> Option<Value>) -> Option<Value> {
    let mut all_known = true;
    for e in es {
        match truth(e, leaf) {
            Some(b) if b == decisive => return Some(Value::Bool(decisive)),
            Some(_) => {}
            None => all_known = false,
        }
    }
    all_known.then_some(Value::Bool(!decisive))
}

fn compare(op: Comparison, a: Value, b: Value) -> Option<bool> {
    match (op, a, b) {
        (Comparison::Eq, Value::Int(a), Value::Int(b)) => Some(a == b),
        (Comparison::Lt, Value::Int(a), Value::Int(b)) => Some(a < b),
        (Comparison::Le, Value::Int(a), Value::Int(b)) => Some(a <= b),
        (Comparison::Eq, Value::Real(a), Value::Real(b)) => Some(a == b),
        (Comparison::Lt, Value::Real(a), Value::Real(b)) => Some(a < b),
        (Comparison::Le, Value::Real(a), Value::Real(b)) => Some(a <= b),
        (Comparison::Eq, Value::Enum(a), Value::Enum(b)) => Some(a == b),
        (Comparison::Eq, Value::Bool(a), Value::Bool(b)) => Some(a == b),
        _ => None,
    }
}
