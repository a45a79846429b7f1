//! Expressions evaluated on concrete states: of a finite system as a row of integers (Booleans are 0 and 1,
//! enumeration values their position), which is fast; of any system as values.

use hyperplan_problem::{Comparison, Expr, Leaf, System, TransLeaf, Type, Value};

/// A value of a finite type as an integer.
pub fn code(value: Value) -> i64 {
    match value {
        Value::Bool(b) => i64::from(b),
        Value::Int(i) => i,
        Value::Enum(i) => i64::from(i),
        Value::Real(_) => unreachable!("finite systems have no reals"),
    }
}

/// The value of a variable of this type with that code.
pub fn decode(ty: &Type, code: i64) -> Value {
    match ty {
        Type::Bool => Value::Bool(code != 0),
        Type::Range { .. } | Type::Int | Type::Real => Value::Int(code),
        Type::Enum(_) => Value::Enum(u32::try_from(code).unwrap_or(0)),
    }
}

/// The least and greatest code of a finite type.
pub fn bounds(ty: &Type) -> Option<(i64, i64)> {
    match ty {
        Type::Bool => Some((0, 1)),
        Type::Range { lo, hi } => Some((*lo, *hi)),
        Type::Enum(values) => Some((0, values.len() as i64 - 1)),
        Type::Int | Type::Real => None,
    }
}

/// The value of an expression, given that of each leaf.
pub fn eval<L>(expr: &Expr<L>, leaf: &mut impl FnMut(&L) -> i64) -> i64 {
    match expr {
        Expr::Const(value) => code(*value),
        Expr::Leaf(l) => leaf(l),
        Expr::Not(a) => 1 - eval(a, leaf),
        Expr::And(es) => i64::from(es.iter().all(|e| eval(e, leaf) != 0)),
        Expr::Or(es) => i64::from(es.iter().any(|e| eval(e, leaf) != 0)),
        Expr::Iff(a, b) => i64::from(eval(a, leaf) == eval(b, leaf)),
        Expr::Compare(op, a, b) => {
            let (a, b) = (eval(a, leaf), eval(b, leaf));
            i64::from(match op {
                Comparison::Eq => a == b,
                Comparison::Lt => a < b,
                Comparison::Le => a <= b,
            })
        }
        Expr::Add(es) => es.iter().map(|e| eval(e, leaf)).sum(),
        Expr::Mul(c, a) => c * eval(a, leaf),
        Expr::Div(a, c) => eval(a, leaf).div_euclid(*c),
        Expr::Mod(a, c) => eval(a, leaf).rem_euclid(*c),
        Expr::Scale(..) | Expr::ToReal(_) => unreachable!("finite systems have no reals"),
        Expr::If(branches, last) => {
            for (condition, value) in branches {
                if eval(condition, leaf) != 0 {
                    return eval(value, leaf);
                }
            }
            eval(last, leaf)
        }
        Expr::Member(es, set) => {
            let mut short = [0; 4];
            if let Some(tuple) = short.get_mut(..es.len()) {
                tuple.iter_mut().zip(es).for_each(|(value, e)| *value = eval(e, leaf));
                return i64::from(set.contains(tuple));
            }
            let tuple: Vec<i64> = es.iter().map(|e| eval(e, leaf)).collect();
            i64::from(set.contains(&tuple))
        }
    }
}

/// Whether a step of a system between two states is one by [`System::trans`]; `None` where a number does not fit.
pub fn is_step(system: &System, from: &[Value], to: &[Value]) -> Option<bool> {
    if system.trans.is_true() {
        return Some(true);
    }
    system.trans.truth(&mut |leaf| match *leaf {
        TransLeaf::Before(leaf) => value_in(system, &Expr::Leaf(leaf), from),
        TransLeaf::After(leaf) => value_in(system, &Expr::Leaf(leaf), to),
    })
}

/// The value of an expression over one system in a state; `None` where a number does not fit into 64 bits.
pub fn value_in(system: &System, expr: &Expr<Leaf>, state: &[Value]) -> Option<Value> {
    system.evaluate(expr, &|v| Some(state[usize::from(v)]))
}

/// Whether an expression over one system holds in a state; see [`value_in`].
pub fn holds_in(system: &System, expr: &Expr<Leaf>, state: &[Value]) -> Option<bool> {
    match value_in(system, expr, state)? {
        Value::Bool(holds) => Some(holds),
        _ => None,
    }
}
