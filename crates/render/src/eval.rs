//! Evaluation of state expressions where some variables may be unknown: a label that depends on nothing but the
//! cell can be drawn, whatever else the state has.

use hyperplan_problem::{Expr, Leaf, System, Value};

/// The truth value of a Boolean expression where variable `v` has the value `known(v)`; `None` where that is not
/// enough to tell.
pub(crate) fn truth(system: &System, expr: &Expr<Leaf>, known: &[Option<Value>]) -> Option<bool> {
    let value = system.evaluate(expr, &|v| known.get(usize::from(v)).copied().flatten());
    value.map(|value| value == Value::Bool(true))
}
