//! Where updates lead from a state: the values that they allow, of which `trans` may rule some out.

use crate::eval::{bounds, eval};
use crate::graph::TooLarge;
use crate::row::{Row, Rows};
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
        updates: impl Iterator<Item = &'u (VarId, Update)> + Clone,
        from: &Row<'a>,
        budget: usize,
        found: &mut Rows,
    ) -> Result<(), TooLarge> {
        let is_plain = |own: &&(VarId, Update)| matches!(own.1, Update::Assign(_));
        let choices = updates.clone().filter(|own| !is_plain(own));
        let updates = updates.filter(is_plain).chain(choices);
        let mut tests = self.tests(updates.clone());
        found.clear();
        found.push(from.codes());
        tests.retain(found, from, 0);
        for (done, (var, update)) in (1..).zip(updates) {
            let at = usize::from(*var);
            if let (Update::Assign(e), 1) = (update, found.len()) {
                found.last_mut()[at] = from.eval(e);
                tests.retain(found, from, done);
                continue;
            }
            if found.len() == 0 {
                break;
            }
            let values = update_values(from, *var, update, budget / found.len())?;
            let before = std::mem::take(found);
            for state in before.iter() {
                for &value in &values {
                    found.push(state);
                    found.last_mut()[at] = value;
                    if !tests.hold(found.last_mut(), from, done) {
                        found.pop();
                    }
                }
            }
        }
        Ok(())
    }

    /// The parts of `trans`, each with the number of updates after which it can be tested.
    fn tests<'u>(&self, updates: impl Iterator<Item = &'u (VarId, Update)>) -> Tests<'a> {
        if self.parts.is_empty() {
            return Tests { due: Vec::new(), to: None };
        }
        let mut place = vec![0; self.system.vars.len()];
        for (at, (var, _)) in updates.enumerate() {
            place[usize::from(*var)] = at + 1;
        }
        let last = |vars: &[VarId]| vars.iter().map(|var| place[usize::from(*var)]).max().unwrap_or(0);
        let due = self.parts.iter().map(|(part, vars)| (last(vars), *part)).collect();
        Tests { due, to: Some(Row::new(self.system)) }
    }
}

/// Parts of `trans` to be tested.
struct Tests<'a> {
    /// Each with the number of updates after which it can be.
    due: Vec<(usize, &'a Expr<TransLeaf>)>,
    /// The state after the step, where there are any.
    to: Option<Row<'a>>,
}

impl<'a> Tests<'a> {
    /// Whether those hold of a step that are due after so many updates.
    fn hold(&mut self, next: &[i64], from: &Row<'a>, done: usize) -> bool {
        let Some(to) = &mut self.to else { return true };
        to.turn(next);
        let mut due = self.due.iter().filter(|(after, _)| *after == done);
        due.all(|(_, test)| {
            let value = eval(test, &mut |leaf| match *leaf {
                TransLeaf::Before(leaf) => from.leaf(leaf),
                TransLeaf::After(leaf) => to.leaf(leaf),
            });
            value != 0
        })
    }

    /// Keeps the only state if they hold.
    fn retain(&mut self, only: &mut Rows, from: &Row<'a>, done: usize) {
        if only.len() == 1 && !self.hold(only.last_mut(), from, done) {
            only.clear();
        }
    }
}

/// What applies of an update in a state.
fn applied<'u>(update: &'u Update, from: &Row<'_>) -> &'u Update {
    let Ok(update) = update.in_state(&mut |condition| Ok::<_, Infallible>(from.holds(condition)));
    update
}

/// The least and greatest values that an update gives, whatever the variable's type.
pub(crate) fn update_values_unclipped(update: &Update, from: &Row<'_>) -> Vec<i64> {
    match applied(update, from) {
        Update::Assign(e) => vec![from.eval(e)],
        Update::OneOf(es) => es.iter().map(|e| from.eval(e)).collect(),
        Update::Within(lo, hi) => vec![from.eval(lo), from.eval(hi)],
        Update::If(..) => unreachable!("what applies in a state has no conditions"),
    }
}

/// The values that an update allows, no more than `most`; those outside the variable's type may be left out.
fn update_values(from: &Row<'_>, var: VarId, update: &Update, most: usize) -> Result<Vec<i64>, TooLarge> {
    let update = applied(update, from);
    let (lo, hi) = match update {
        Update::Assign(_) | Update::If(..) => (0, 0),
        Update::OneOf(es) => (1, es.len() as i64),
        Update::Within(lo, hi) => {
            let (least, greatest) = bounds(&from.system().vars[var].ty).ok_or(TooLarge)?;
            (from.eval(lo).max(least), from.eval(hi).min(greatest))
        }
    };
    // Ranges may have more values than there is memory.
    if i128::from(hi) - i128::from(lo) >= most as i128 {
        return Err(TooLarge);
    }
    Ok(match update {
        Update::Within(..) => (lo..=hi).collect(),
        _ => update_values_unclipped(update, from),
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
