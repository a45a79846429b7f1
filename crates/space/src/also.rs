//! What transitions do besides, as updates of the clauses and edges that give them.

use crate::graph::TooLarge;
use hyperplan_problem::{ActionId, Also, AttributeId, Expr, Leaf, StepLeaf, System, Update, Value, VarId};

/// More commands than this are refused: each is a part of every step.
pub const MAX_COMMANDS: usize = 4096;

/// Updates of different variables.
pub type Updates = Vec<(VarId, Update)>;

/// The number that steps carry that follow no edge.
pub fn no_number(_: AttributeId) -> Expr<Leaf> {
    Expr::Const(Value::Int(0))
}

/// Of the clauses that add something to an action, the guards and updates in terms of the state before.
pub(crate) fn applicable<'s>(
    system: &'s System,
    action: ActionId,
    number: &dyn Fn(AttributeId) -> Expr<Leaf>,
) -> Vec<(&'s Also, Updates)> {
    let updates = |also: &Also| {
        let of = |(var, update): &(VarId, Update<StepLeaf>)| {
            (*var, update.map(|expr| expr.of_state(action, number)))
        };
        also.updates.iter().map(of).collect()
    };
    system.also_on(action).map(|also| (also, updates(also))).collect()
}

/// What the transitions do besides that have that action and these numbers, whatever guards say: what applies where is
/// told in the expressions. Where the result has several lists, each gives some of the outcomes.
///
/// # Errors
/// [`TooLarge`] beyond [`MAX_COMMANDS`] lists.
pub fn besides(
    system: &System,
    action: ActionId,
    number: &dyn Fn(AttributeId) -> Expr<Leaf>,
) -> Result<Vec<Updates>, TooLarge> {
    let applicable = applicable(system, action, number);
    let mut vars: Vec<VarId> = applicable.iter().flat_map(|(_, own)| own).map(|(var, _)| *var).collect();
    vars.sort_unstable();
    vars.dedup();
    let mut all: Vec<Updates> = vec![Vec::new()];
    for var in vars {
        let own = applicable.iter().filter_map(|(also, updates)| {
            let (_, update) = updates.iter().find(|(updated, _)| *updated == var)?;
            Some((&also.guard, update))
        });
        let ways = one_of(var, &own.collect::<Vec<_>>());
        if all.len() * ways.len() > MAX_COMMANDS {
            return Err(TooLarge);
        }
        let with = |done: &Updates, way: &Update| done.iter().cloned().chain([(var, way.clone())]).collect();
        all = all.iter().flat_map(|done| ways.iter().map(move |way| with(done, way))).collect();
    }
    Ok(all)
}

/// What becomes of a variable where no two of these guards hold together, and nothing becomes of it where none does.
fn one_of(var: VarId, updates: &[(&Expr<Leaf>, &Update)]) -> Vec<Update> {
    let choices = updates.iter().map(|(_, update)| match update {
        Update::OneOf(es) => es.len(),
        Update::Assign(_) | Update::Within(..) => 1,
    });
    let choices = choices.max().unwrap_or(1);
    // The nth value of each, from 0 again where one has fewer.
    let chosen = |nth: usize, upper: bool| {
        updates.iter().rev().fold(Expr::Leaf(Leaf::Var(var)), |otherwise, (guard, update)| {
            let value = match update {
                Update::Assign(e) => e,
                Update::OneOf(es) => &es[nth % es.len()],
                Update::Within(lo, hi) => {
                    if upper {
                        hi
                    } else {
                        lo
                    }
                }
            };
            if guard.is_true() {
                return value.clone();
            }
            Expr::If(Box::new((*guard).clone()), Box::new(value.clone()), Box::new(otherwise))
        })
    };
    if updates.iter().any(|(_, update)| matches!(update, Update::Within(..))) {
        return (0..choices).map(|nth| Update::Within(chosen(nth, false), chosen(nth, true))).collect();
    }
    match choices {
        1 => vec![Update::Assign(chosen(0, false))],
        _ => vec![Update::OneOf((0..choices).map(|nth| chosen(nth, false)).collect())],
    }
}
