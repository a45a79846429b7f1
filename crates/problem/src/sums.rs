//! Sums of costs as variables of systems.

use crate::expr::{Comparison, Expr, Leaf, PathLeaf, StepLeaf, Type, Value};
use crate::ids::{CostId, PathId, VarId};
use crate::system::{Also, Cost, System, Update, Var};

/// A variable with the sum of a cost, or with `cap` where that is less.
pub(crate) fn add_sum(system: &mut System, cost: CostId, cap: i64) -> VarId {
    let Cost { name, expr, span, .. } = system.costs[cost].clone();
    let ty = Type::Range { lo: 0, hi: cap };
    let mut name = format!("cost {name}");
    // An objective may read the sum, and be asked for one that is no greater than something else.
    while system.var(&name).is_some() {
        name.push('\'');
    }
    let var = system.vars.push_and_get_key(Var { name, ty, sums: Some(cost), span });
    let here = || Expr::Leaf(StepLeaf::State(Leaf::Var(var)));
    let constant = |n| Expr::Const(Value::Int(n));
    let sum = Expr::Add(vec![here(), expr]);
    let fits = Expr::Compare(Comparison::Le, Box::new(sum.clone()), Box::new(constant(cap)));
    let next = Expr::choice([(fits, sum)], constant(cap));
    let mut actions = system.actions.clone();
    actions.sort_unstable();
    let updates = vec![(var, Update::Assign(next))];
    system.also.push(Also { actions, guard: Expr::TRUE, updates, span });
    let starts = Expr::Compare(
        Comparison::Eq,
        Box::new(Expr::Leaf(Leaf::Var(var))),
        Box::new(Expr::Const(Value::Int(0))),
    );
    let init = std::mem::replace(&mut system.init, Expr::TRUE);
    system.init = if init.is_true() { starts } else { Expr::And(vec![init, starts]) };
    var
}

/// That all variables of the file's system agree.
pub(crate) fn same_state(system: &System, p: PathId, q: PathId) -> Expr<PathLeaf> {
    let equal = |(var, declared): (VarId, &Var)| {
        let of = |path| Box::new(Expr::Leaf(PathLeaf::State(path, Leaf::Var(var))));
        match declared.ty {
            Type::Bool => Expr::Iff(of(p), of(q)),
            _ => Expr::Compare(Comparison::Eq, of(p), of(q)),
        }
    };
    let own = system.vars.iter_enumerated().filter(|(_, declared)| declared.sums.is_none());
    Expr::And(own.map(equal).collect())
}
