//! What transitions do besides, as updates of the clauses and edges that give them.

use crate::row::Row;
use hyperplan_problem::{ActionId, Also, AttributeId, Expr, Leaf, StepLeaf, System, Update, Value, VarId};

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
            (*var, update.map(&mut |expr| expr.of_state(action, number)))
        };
        also.updates.iter().map(of).collect()
    };
    system.also_on(action).map(|also| (also, updates(also))).collect()
}

/// Of these clauses, the updates of those whose guards hold in a state.
pub(crate) fn applied<'u>(
    all: &'u [(&Also, Updates)],
    from: &Row<'_>,
) -> impl Iterator<Item = &'u (VarId, Update)> {
    all.iter().filter(|(also, _)| from.holds(&also.guard)).flat_map(|(_, updates)| updates)
}

/// What the transitions do besides that have that action and these numbers, whatever guards say: what applies where is
/// told in the updates.
pub fn besides(system: &System, action: ActionId, number: &dyn Fn(AttributeId) -> Expr<Leaf>) -> Updates {
    let applicable = applicable(system, action, number);
    let mut vars: Vec<VarId> = applicable.iter().flat_map(|(_, own)| own).map(|(var, _)| *var).collect();
    vars.sort_unstable();
    vars.dedup();
    let update = |var: VarId| {
        let own = applicable.iter().filter_map(|(also, updates)| {
            let (_, update) = updates.iter().find(|(updated, _)| *updated == var)?;
            Some((&also.guard, update))
        });
        (var, one_of(var, &own.collect::<Vec<_>>()))
    };
    vars.into_iter().map(update).collect()
}

/// What becomes of a variable where no two of these guards hold together, and nothing becomes of it where none does.
fn one_of(var: VarId, updates: &[(&Expr<Leaf>, &Update)]) -> Update {
    if let [(guard, update)] = updates
        && guard.is_true()
    {
        return (*update).clone();
    }
    let unchanged = Expr::Leaf(Leaf::Var(var));
    let value = |(guard, update): &(&Expr<Leaf>, &Update)| match update {
        Update::Assign(e) => Some(((*guard).clone(), e.clone())),
        _ => None,
    };
    if let Some(values) = updates.iter().map(value).collect::<Option<Vec<_>>>() {
        return Update::Assign(Expr::choice(values, unchanged));
    }
    let chosen = |update: &Update| match update {
        Update::Assign(e) => Update::OneOf(vec![e.clone()]),
        other => other.clone(),
    };
    let branches = updates.iter().map(|(guard, update)| ((*guard).clone(), chosen(update))).collect();
    Update::If(branches, Box::new(Update::OneOf(vec![unchanged])))
}
