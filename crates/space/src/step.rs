//! Where updates lead from a state: the values that they allow, of which `trans` may rule some out.

use crate::eval::{bounds, eval_in, eval_trans};
use crate::graph::TooLarge;
use hyperplan_problem::{Expr, LabelMemo, Leaf, System, TransLeaf, Update, VarId};
use std::convert::Infallible;

/// A system with the parts of its `trans`.
pub(crate) struct Steps<'a> {
    system: &'a System,
    /// Each with the variables that it reads of the state after a step, itself or in labels.
    parts: Vec<(&'a Expr<TransLeaf>, Vec<VarId>)>,
}

impl<'a> Steps<'a> {
    pub(crate) fn new(system: &'a System) -> Self {
        let after = |leaf: &TransLeaf| match *leaf {
            TransLeaf::Before(_) => None,
            TransLeaf::After(leaf) => Some(leaf),
        };
        let parts = conjuncts(&system.trans).into_iter().filter(|part| !part.is_true());
        Steps { system, parts: parts.map(|part| (part, variables_read(system, part, &after))).collect() }
    }

    /// The states that updates lead to, in or out of range, of which `trans` holds. Updates without a choice are carried
    /// out first, then each choice; a part of `trans` is tested as soon as what it reads is known.
    pub(crate) fn outcomes<'u>(
        &self,
        updates: impl IntoIterator<Item = &'u (VarId, Update)>,
        codes: &[i64],
        budget: usize,
    ) -> Result<Vec<Vec<i64>>, TooLarge> {
        let (plain, choices): (Vec<_>, Vec<_>) =
            updates.into_iter().partition(|(_, update)| matches!(update, Update::Assign(_)));
        let updates: Vec<&(VarId, Update)> = plain.into_iter().chain(choices).collect();
        let tests = self.tests(&updates);
        let holds = |next: &[i64], done: usize| {
            let mut due = tests.iter().filter(|(after, _)| *after == done);
            due.all(|(_, test)| eval_trans(self.system, test, codes, next) != 0)
        };
        let mut all = vec![codes.to_vec()];
        all.retain(|next| holds(next, 0));
        for (done, (var, update)) in (1..).zip(updates) {
            if all.is_empty() {
                break;
            }
            let values = update_values(self.system, *var, update, codes, budget / all.len())?;
            let at = usize::from(*var);
            if let [value] = values[..] {
                all.iter_mut().for_each(|next| next[at] = value);
                all.retain(|next| holds(next, done));
                continue;
            }
            let mut longer = Vec::with_capacity(all.len() * values.len());
            for before in &all {
                for &value in &values {
                    let mut next = before.clone();
                    next[at] = value;
                    if holds(&next, done) {
                        longer.push(next);
                    }
                }
            }
            all = longer;
        }
        Ok(all)
    }

    /// The parts of `trans`, each with the number of updates after which it can be tested.
    fn tests(&self, updates: &[&(VarId, Update)]) -> Vec<(usize, &'a Expr<TransLeaf>)> {
        if self.parts.is_empty() {
            return Vec::new();
        }
        let mut place = vec![0; self.system.vars.len()];
        for (at, (var, _)) in updates.iter().enumerate() {
            place[usize::from(*var)] = at + 1;
        }
        let last = |vars: &[VarId]| vars.iter().map(|var| place[usize::from(*var)]).max().unwrap_or(0);
        self.parts.iter().map(|(part, vars)| (last(vars), *part)).collect()
    }
}

/// What applies of an update in a state.
fn applied<'u>(system: &System, update: &'u Update, codes: &[i64]) -> &'u Update {
    let Ok(update) =
        update.in_state(&mut |condition| Ok::<_, Infallible>(eval_in(system, condition, codes) != 0));
    update
}

/// The least and greatest values that an update gives, whatever the variable's type.
pub(crate) fn update_values_unclipped(system: &System, update: &Update, codes: &[i64]) -> Vec<i64> {
    match applied(system, update, codes) {
        Update::Assign(e) => vec![eval_in(system, e, codes)],
        Update::OneOf(es) => es.iter().map(|e| eval_in(system, e, codes)).collect(),
        Update::Within(lo, hi) => vec![eval_in(system, lo, codes), eval_in(system, hi, codes)],
        Update::If(..) => unreachable!("what applies in a state has no conditions"),
    }
}

/// The values that an update allows, no more than `most`; those outside the variable's type may be left out.
fn update_values(
    system: &System,
    var: VarId,
    update: &Update,
    codes: &[i64],
    most: usize,
) -> Result<Vec<i64>, TooLarge> {
    let update = applied(system, update, codes);
    let (lo, hi) = match update {
        Update::Assign(_) | Update::If(..) => (0, 0),
        Update::OneOf(es) => (1, es.len() as i64),
        Update::Within(lo, hi) => {
            let (least, greatest) = bounds(&system.vars[var].ty).ok_or(TooLarge)?;
            (eval_in(system, lo, codes).max(least), eval_in(system, hi, codes).min(greatest))
        }
    };
    // Ranges may have more values than there is memory.
    if i128::from(hi) - i128::from(lo) >= most as i128 {
        return Err(TooLarge);
    }
    Ok(match update {
        Update::Within(..) => (lo..=hi).collect(),
        _ => update_values_unclipped(system, update, codes),
    })
}

/// The parts of a conjunction.
pub(crate) fn conjuncts<L>(expr: &Expr<L>) -> Vec<&Expr<L>> {
    match expr {
        Expr::And(es) => es.iter().flat_map(conjuncts).collect(),
        other => vec![other],
    }
}

/// The variables that an expression reads, itself or in labels, among those leaves that `state` tells; in order.
pub(crate) fn variables_read<L>(
    system: &System,
    expr: &Expr<L>,
    state: &dyn Fn(&L) -> Option<Leaf>,
) -> Vec<VarId> {
    let mut found = Vec::new();
    let mut labels: LabelMemo<()> = LabelMemo::default();
    expr.for_each_leaf(&mut |leaf| match state(leaf) {
        None => {}
        Some(Leaf::Var(var)) => found.push(var),
        Some(Leaf::Label(label)) => labels.find(system, label, &mut |expr, _| {
            expr.for_each_leaf(&mut |leaf| {
                if let Leaf::Var(var) = leaf {
                    found.push(*var);
                }
            });
        }),
    });
    found.sort_unstable();
    found.dedup();
    found
}
