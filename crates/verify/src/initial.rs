//! Initial states: all assignments that satisfy `init`, found variable by variable.

use crate::eval::{eval, truth};
use crate::graph::{Graph, ILL_TYPED, StateId, belongs, integers};
use crate::report::Stop;
use hyperplan_problem::{Comparison, Expr, LabelId, Leaf, Type, Value, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiVec;

impl Graph<'_> {
    /// All initial states, in the order of their values.
    pub(crate) fn initial_states(&mut self) -> Result<Vec<StateId>, Stop> {
        let mut domains = Vec::with_capacity(self.system.vars.len());
        let fixed = self.fixed_by_init();
        for (id, var) in self.system.vars.iter_enumerated() {
            let domain = match (fixed.get(&id), &var.ty) {
                (Some(&value), ty) => {
                    if belongs(ty, value) {
                        vec![value]
                    } else {
                        Vec::new()
                    }
                }
                (None, Type::Bool) => vec![Value::Bool(false), Value::Bool(true)],
                (None, Type::Range { lo, hi }) => integers(*lo, *hi, self.limit)?,
                (None, Type::Enum(names)) => (0..).zip(names.iter()).map(|(i, _)| Value::Enum(i)).collect(),
            };
            domains.push(domain);
        }
        let mut states = Vec::new();
        if self.init_so_far(&[]) == Some(false) {
            return Ok(states);
        }
        let mut partial: Vec<Value> = Vec::with_capacity(domains.len());
        // `next[i]` is the choice to try for variable i; its length is one more than `partial`'s.
        let mut next = vec![0_usize];
        let mut tried = 0_usize;
        while let Some(choice) = next.last_mut() {
            let depth = partial.len();
            let chosen = domains.get(depth).map(|domain| domain.get(*choice).copied());
            *choice += 1;
            tried += 1;
            if tried > self.limit.saturating_mul(16) {
                return Err(Stop::Budget);
            }
            match chosen {
                // All variables have a value.
                None => {
                    states.push(self.intern(&partial)?);
                    next.pop();
                    partial.pop();
                }
                Some(None) => {
                    next.pop();
                    partial.pop();
                }
                Some(Some(value)) => {
                    partial.push(value);
                    match self.init_so_far(&partial) {
                        Some(false) => {
                            partial.pop();
                        }
                        None if partial.len() == domains.len() => return Err(ILL_TYPED.into()),
                        _ => next.push(0),
                    }
                }
            }
        }
        Ok(states)
    }

    /// Whether `init` holds, as far as the first variables tell.
    fn init_so_far(&self, partial: &[Value]) -> Option<bool> {
        if self.system.init.is_true() {
            return Some(true);
        }
        let mut labels: TiVec<LabelId, Option<Value>> = TiVec::with_capacity(self.system.labels.len());
        let leaf = |labels: &TiVec<LabelId, Option<Value>>, l: &Leaf| match l {
            Leaf::Var(v) => partial.get(usize::from(*v)).copied(),
            Leaf::Label(l) => labels.get(*l).copied().flatten(),
        };
        for label in &self.system.labels {
            let value = eval(&label.expr, &|l| leaf(&labels, l));
            labels.push(value);
        }
        truth(&self.system.init, &|l| leaf(&labels, l))
    }

    /// Variables that `init` plainly equates with a constant, so that large types need not be enumerated.
    fn fixed_by_init(&self) -> FxHashMap<VarId, Value> {
        let mut fixed = FxHashMap::default();
        let mut seen = FxHashSet::default();
        let mut conjuncts = vec![&self.system.init];
        while let Some(e) = conjuncts.pop() {
            match e {
                Expr::And(es) => conjuncts.extend(es),
                Expr::Leaf(Leaf::Label(l)) if seen.insert(*l) => {
                    conjuncts.extend(self.system.labels.get(*l).map(|l| &l.expr))
                }
                Expr::Compare(Comparison::Eq, a, b) => match (&**a, &**b) {
                    (Expr::Leaf(Leaf::Var(v)), Expr::Const(c))
                    | (Expr::Const(c), Expr::Leaf(Leaf::Var(v))) => {
                        fixed.insert(*v, *c);
                    }
                    _ => {}
                },
                _ => {}
            }
        }
        fixed
    }
}
