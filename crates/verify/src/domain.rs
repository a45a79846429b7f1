//! What a system's `init` says of one variable, so that large and infinite types need not be enumerated.

use hyperplan_problem::{Comparison, Expr, LabelId, Leaf, System, TupleSet, Value, VarId};
use std::collections::BTreeSet;
use typed_index_collections::TiVec;

/// Where a variable can be: more than what is possible, never less.
#[derive(Clone, Debug, Default)]
pub(crate) struct Domain {
    /// Among these.
    pub(crate) values: Option<BTreeSet<Value>>,
    /// An integer no less.
    pub(crate) lo: Option<i64>,
    /// An integer no greater.
    pub(crate) hi: Option<i64>,
}

impl Domain {
    fn of(values: impl IntoIterator<Item = Value>) -> Self {
        Domain { values: Some(values.into_iter().collect()), ..Domain::default() }
    }

    fn and(self, other: Domain) -> Domain {
        let values = match (self.values, other.values) {
            (Some(a), Some(b)) => Some(&a & &b),
            (a, b) => a.or(b),
        };
        Domain { values, lo: self.lo.max(other.lo), hi: least(self.hi, other.hi) }
    }

    fn or(self, other: Domain) -> Domain {
        let both = |a: Option<i64>, b: Option<i64>, f: fn(i64, i64) -> i64| a.zip(b).map(|(a, b)| f(a, b));
        Domain {
            values: self.values.zip(other.values).map(|(a, b)| &a | &b),
            lo: both(self.lo, other.lo, i64::min),
            hi: both(self.hi, other.hi, i64::max),
        }
    }
}

/// The lesser of what there is.
fn least(a: Option<i64>, b: Option<i64>) -> Option<i64> {
    a.zip(b).map(|(a, b)| a.min(b)).or(a).or(b)
}

/// What `init` says of a variable.
pub(crate) fn domain_by_init(system: &System, var: VarId) -> Domain {
    // A label reads only labels before it.
    let mut labels: TiVec<LabelId, Domain> = TiVec::with_capacity(system.labels.len());
    for label in &system.labels {
        let domain = domain(&label.expr, var, &labels);
        labels.push(domain);
    }
    domain(&system.init, var, &labels)
}

/// Where the variable can be if the expression holds.
fn domain(e: &Expr<Leaf>, var: VarId, labels: &TiVec<LabelId, Domain>) -> Domain {
    let is_var = |e: &Expr<Leaf>| matches!(e, Expr::Leaf(Leaf::Var(v)) if *v == var);
    match e {
        Expr::Const(Value::Bool(false)) => Domain::of([]),
        Expr::Leaf(Leaf::Label(label)) => labels.get(*label).cloned().unwrap_or_default(),
        Expr::And(es) => es.iter().map(|e| domain(e, var, labels)).fold(Domain::default(), Domain::and),
        Expr::Or(es) => {
            es.iter().map(|e| domain(e, var, labels)).reduce(Domain::or).unwrap_or_else(|| Domain::of([]))
        }
        Expr::Compare(op, a, b) => match (op, &**a, &**b) {
            (Comparison::Eq, a, Expr::Const(c)) | (Comparison::Eq, Expr::Const(c), a) if is_var(a) => {
                Domain::of([*c])
            }
            (op, Expr::Const(Value::Int(c)), a) if is_var(a) => {
                Domain { lo: c.checked_add(i64::from(*op == Comparison::Lt)), ..Domain::default() }
            }
            (op, a, Expr::Const(Value::Int(c))) if is_var(a) => {
                Domain { hi: c.checked_sub(i64::from(*op == Comparison::Lt)), ..Domain::default() }
            }
            _ => Domain::default(),
        },
        Expr::Member(es, set) => es.iter().position(is_var).map(|at| column(set, at)).unwrap_or_default(),
        _ => Domain::default(),
    }
}

/// The values in a place of the tuples, whichever of the types they stand for.
fn column(set: &TupleSet, at: usize) -> Domain {
    let numbers = set.tuples.iter().filter_map(|tuple| tuple.get(at));
    let both = numbers.flat_map(|&n| {
        let position = u32::try_from(n).ok().map(Value::Enum);
        [Some(Value::Int(n)), position].into_iter().flatten()
    });
    Domain::of(both)
}
