//! Where the moves from a state lead: what the updates of clauses and listed transitions allow.

use super::{Graph, StateId, Step, ValueOf, no_value, position};
use crate::eval::{eval, truth};
use crate::report::Stop;
use hyperplan_problem::{ActionId, Leaf, TransLeaf, Type, Update, Value, VarId};

/// The values that variables may get, each variable at most once.
pub(crate) type Choices = Vec<(VarId, Vec<Value>)>;

/// Where the moves from a state lead: actions that lead to the same values, and these, one target after the other.
#[derive(Debug, Default)]
pub(crate) struct Targets<'p> {
    pub(crate) actions: Vec<&'p [ActionId]>,
    pub(crate) values: Vec<Value>,
}

impl<'p> Targets<'p> {
    fn add(&mut self, actions: &'p [ActionId], values: &[Value]) {
        self.actions.push(actions);
        self.values.extend_from_slice(values);
    }
}

impl<'p> Graph<'p> {
    /// Where each group of actions leads.
    pub(crate) fn find_targets(&self, state: StateId, found: &mut Targets<'p>) -> Result<(), Stop> {
        let system = self.system;
        let here = self.values(state);
        if self.holds(state, &system.absorb)? {
            found.add(&system.actions, here);
            return Ok(());
        }
        for clause in &system.clauses {
            if !self.holds(state, &clause.guard)?
                || system.also.is_empty() && self.certain(state, (&clause.actions, &clause.updates), found)?
            {
                continue;
            }
            let own = self.each(&clause.updates, &|e| self.value(state, e))?;
            if system.also.is_empty() {
                let targets = self.chosen(state, own)?;
                targets.iter().for_each(|target| found.add(&clause.actions, target));
                continue;
            }
            for action in &clause.actions {
                let mut all = self.besides(state, Step { action: *action, edge: None })?;
                all.extend(own.iter().cloned());
                let targets = self.chosen(state, all)?;
                targets.iter().for_each(|target| found.add(std::slice::from_ref(action), target));
            }
        }
        let Some(edges) = &system.edges else { return Ok(()) };
        for ((at, edge), own) in
            edges.numbered(position(here, edges.var)).zip(edges.of(position(here, edges.var)))
        {
            let mut all = self.besides(state, Step { action: edge.action, edge: Some(at) })?;
            all.push((edges.var, vec![Value::Enum(edge.to)]));
            let targets = self.chosen(state, all)?;
            targets.iter().for_each(|target| found.add(std::slice::from_ref(&own.action), target));
        }
        Ok(())
    }

    /// Where updates lead that leave no choice, if anywhere; whether they leave none.
    fn certain(
        &self,
        state: StateId,
        (actions, updates): (&'p [ActionId], &[(VarId, Update)]),
        found: &mut Targets<'p>,
    ) -> Result<bool, Stop> {
        let before = found.values.len();
        found.values.extend_from_slice(self.values(state));
        let mut fits = true;
        for (var, update) in updates {
            let Update::Assign(e) = update else {
                found.values.truncate(before);
                return Ok(false);
            };
            let value = self.value(state, e)?;
            let ty = &self.system.vars.get(*var).ok_or_else(|| no_value(self.system))?.ty;
            fits &= ty.contains(value);
            found.values[before + usize::from(*var)] = value;
        }
        match fits {
            true => found.actions.push(actions),
            false => found.values.truncate(before),
        }
        Ok(true)
    }

    /// What each of some updates allows.
    fn each<L>(&self, updates: &[(VarId, Update<L>)], value: &ValueOf<'_, L>) -> Result<Choices, Stop> {
        updates.iter().map(|(var, update)| Ok((*var, self.choices(*var, update, value)?))).collect()
    }

    /// What a step from a state does besides.
    fn besides(&self, from: StateId, step: Step) -> Result<Choices, Stop> {
        let mut all = Choices::new();
        for also in self.also_in(from, step.action)? {
            all.extend(self.each(&also.updates, &|e| self.step_value(from, step, e))?);
        }
        Ok(all)
    }

    /// Where a transition leads that makes these choices. What `trans` rules out is left out as soon as that is known.
    fn chosen(&self, state: StateId, mut open: Choices) -> Result<Vec<Vec<Value>>, Stop> {
        let here = self.values(state);
        let mut known: Vec<bool> = vec![true; here.len()];
        for (var, _) in &open {
            known[usize::from(*var)] = false;
        }
        open.sort_by_key(|(_, choices)| choices.len());
        let mut targets = vec![here.to_vec()];
        for (var, choices) in open {
            known[usize::from(var)] = true;
            let mut longer = Vec::new();
            for target in &targets {
                for &choice in &choices {
                    let target = with(target, var, choice);
                    if self.may_step(state, &target, &known) {
                        longer.push(target);
                    }
                }
                if longer.len() > self.limit {
                    return Err(Stop::Budget);
                }
            }
            targets = longer;
        }
        Ok(targets)
    }

    /// Whether `trans` can hold of a step to these values, as far as they are known.
    fn may_step(&self, from: StateId, there: &[Value], known: &[bool]) -> bool {
        if self.system.trans.is_true() {
            return true;
        }
        let there: Vec<Option<Value>> =
            there.iter().zip(known).map(|(value, known)| known.then_some(*value)).collect();
        let mut labels: Vec<Option<Value>> = Vec::with_capacity(self.system.labels.len());
        let after = |labels: &[Option<Value>], leaf| match leaf {
            Leaf::Var(v) => there.get(usize::from(v)).copied().flatten(),
            Leaf::Label(l) => labels.get(usize::from(l)).copied().flatten(),
        };
        for label in &self.system.labels {
            let value = eval(&label.expr, &|l| after(&labels, *l));
            labels.push(value);
        }
        let holds = truth(&self.system.trans, &|leaf| match *leaf {
            TransLeaf::Before(leaf) => self.leaf(from, leaf),
            TransLeaf::After(leaf) => after(&labels, leaf),
        });
        holds != Some(false)
    }

    /// What an update allows, within the variable's type. Of real numbers there are too many between two.
    fn choices<L>(&self, var: VarId, update: &Update<L>, value: &ValueOf<'_, L>) -> Result<Vec<Value>, Stop> {
        let ty = &self.system.vars.get(var).ok_or_else(|| no_value(self.system))?.ty;
        let mut values = match applied(update, value)? {
            Update::If(..) => Vec::new(),
            Update::Assign(e) => vec![value(e)?],
            Update::OneOf(es) => es.iter().map(value).collect::<Result<_, _>>()?,
            Update::Within(lo, hi) => match (ty, value(lo)?, value(hi)?) {
                (Type::Range { lo: least, hi: most }, Value::Int(lo), Value::Int(hi)) => {
                    integers(lo.max(*least), hi.min(*most), self.limit)?
                }
                (Type::Int, Value::Int(lo), Value::Int(hi)) => integers(lo, hi, self.limit)?,
                (Type::Real, lo, hi) if lo > hi => Vec::new(),
                (Type::Real, lo, hi) if lo == hi => vec![lo],
                (Type::Real, _, _) => return Err(Stop::Budget),
                _ => return Err(no_value(self.system).into()),
            },
        };
        values.retain(|v| ty.contains(*v));
        Ok(values)
    }
}

/// The part of an update that applies: beside the first of its conditions that holds.
fn applied<'u, L>(mut update: &'u Update<L>, value: &ValueOf<'_, L>) -> Result<&'u Update<L>, Stop> {
    'inside: while let Update::If(branches, last) = update {
        for (condition, branch) in branches {
            if value(condition)? == Value::Bool(true) {
                update = branch;
                continue 'inside;
            }
        }
        update = last;
    }
    Ok(update)
}

/// Whether an update allows, somewhere, all that lies between two ends.
pub(crate) fn is_wide<L>(update: &Update<L>) -> bool {
    match update {
        Update::Assign(_) | Update::OneOf(_) => false,
        Update::Within(..) => true,
        Update::If(branches, last) => branches.iter().any(|(_, branch)| is_wide(branch)) || is_wide(last),
    }
}

/// Whether a variable may get this value of its type.
pub(crate) fn may_become<L>(update: &Update<L>, new: Value, value: &ValueOf<'_, L>) -> Result<bool, Stop> {
    match applied(update, value)? {
        Update::If(..) => Ok(false),
        Update::Assign(e) => Ok(value(e)? == new),
        Update::OneOf(es) => {
            let values: Vec<Value> = es.iter().map(value).collect::<Result<_, _>>()?;
            Ok(values.contains(&new))
        }
        Update::Within(lo, hi) => Ok(value(lo)? <= new && new <= value(hi)?),
    }
}

fn with(values: &[Value], var: VarId, value: Value) -> Vec<Value> {
    let mut values = values.to_vec();
    values[usize::from(var)] = value;
    values
}

/// The integers `lo..=hi`, if there are no more than `limit`.
pub(crate) fn integers(lo: i64, hi: i64, limit: usize) -> Result<Vec<Value>, Stop> {
    let count = (i128::from(hi) - i128::from(lo) + 1).max(0);
    if count > limit as i128 {
        return Err(Stop::Budget);
    }
    Ok((lo..=hi).map(Value::Int).collect())
}
