//! Initial states: all assignments that satisfy `init`, found variable by variable.

use crate::domain::{Domain, domain_by_init};
use crate::eval::{eval, truth};
use crate::graph::{Graph, StateId, integers, no_value};
use crate::report::Stop;
use hyperplan_problem::{LabelId, Leaf, Type, Value};
use typed_index_collections::TiVec;

impl Graph<'_> {
    /// All initial states, in the order of their values.
    pub(crate) fn initial_states(&mut self) -> Result<Vec<StateId>, Stop> {
        let mut domains = Vec::with_capacity(self.system.vars.len());
        for (id, var) in self.system.vars.iter_enumerated() {
            let Domain { values, lo: least, hi: most } = domain_by_init(self.system, id);
            let range = |lo: i64, hi: i64| {
                integers(lo.max(least.unwrap_or(lo)), hi.min(most.unwrap_or(hi)), self.limit)
            };
            let domain = match (values, &var.ty) {
                (Some(values), ty) => values.into_iter().filter(|value| ty.contains(*value)).collect(),
                (None, Type::Bool) => vec![Value::Bool(false), Value::Bool(true)],
                (None, Type::Range { lo, hi }) => range(*lo, *hi)?,
                (None, Type::Int) => range(i64::MIN, i64::MAX)?,
                (None, Type::Enum(names)) => (0..).zip(names.iter()).map(|(i, _)| Value::Enum(i)).collect(),
                (None, Type::Real) => return Err(Stop::Budget),
            };
            domains.push(domain);
        }
        let mut states = Vec::new();
        let labels = self.labels_of_init();
        if self.init_so_far(&[], labels) == Some(false) {
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
                    match self.init_so_far(&partial, labels) {
                        Some(false) => {
                            partial.pop();
                        }
                        None if partial.len() == domains.len() => return Err(no_value(self.system).into()),
                        _ => next.push(0),
                    }
                }
            }
        }
        Ok(states)
    }

    /// How many labels `init` may read: one reads only labels before it.
    fn labels_of_init(&self) -> usize {
        let mut labels = 0;
        self.system.init.for_each_leaf(&mut |leaf| {
            if let Leaf::Label(label) = leaf {
                labels = labels.max(usize::from(*label) + 1);
            }
        });
        labels
    }

    /// Whether `init`, which reads the first `labels` labels at most, holds as far as the first variables tell.
    fn init_so_far(&self, partial: &[Value], labels: usize) -> Option<bool> {
        if self.system.init.is_true() {
            return Some(true);
        }
        let read = self.system.labels.iter().take(labels);
        let mut labels: TiVec<LabelId, Option<Value>> = TiVec::with_capacity(labels);
        let leaf = |labels: &TiVec<LabelId, Option<Value>>, l: &Leaf| match l {
            Leaf::Var(v) => partial.get(usize::from(*v)).copied(),
            Leaf::Label(l) => labels.get(*l).copied().flatten(),
        };
        for label in read {
            let value = eval(&label.expr, &|l| leaf(&labels, l));
            labels.push(value);
        }
        truth(&self.system.init, &|l| leaf(&labels, l))
    }
}
