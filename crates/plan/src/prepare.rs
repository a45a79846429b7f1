//! What must be settled before quantifiers are: whether paths exist at all, and whether they can go on.

use crate::fact::Reason;
use crate::oracle::{Oracle, Stop};
use hyperplan_encode::{Encoder, Goal, Query, Relevant};
use hyperplan_problem::{Expr, Mode, Node, Objective, PathId, Problem, Quantifier};

/// Whether the objective begins with `exists`, so that its leading block is to make the formula true.
pub(crate) fn is_existential(objective: &Objective) -> bool {
    objective.paths.first().is_none_or(|path| path.quantifier == Quantifier::Exists)
}

/// Whether every path has finitely many states to be in.
pub(crate) fn is_finite(problem: &Problem, objective: &Objective) -> bool {
    objective.paths.iter().all(|path| problem.systems[path.system].is_finite())
}

/// In bounded mode a path counts only if it can go on for ever. Where the states were not enumerated, this is known
/// only if no state at all is a dead end.
pub(crate) fn no_dead_ends(encoder: &Encoder<'_>, oracle: &mut Oracle<'_>) -> Result<(), Stop> {
    if encoder.objective.mode != Mode::Bounded {
        return Ok(());
    }
    for path in encoder.objective.paths.keys() {
        // In a system with infinitely many states a path has its horizon's steps, whatever may follow.
        if !encoder.task.system(path).is_finite() {
            continue;
        }
        let Some(script) = encoder.writer.stuck(path) else { continue };
        let mut dialogue = oracle.open(1)?;
        if oracle.check(&mut dialogue, &script)? {
            return Err(Stop::Unknown(Reason::DeadEnds { system: encoder.task.system(path).name.clone() }));
        }
    }
    Ok(())
}

/// The first path variable that has no path to range over: it alone decides the objective.
pub(crate) fn without_paths(encoder: &Encoder<'_>, oracle: &mut Oracle<'_>) -> Result<Option<PathId>, Stop> {
    for path in encoder.objective.paths.keys() {
        let some = match encoder.has_path(path) {
            Some(known) => known,
            None => {
                let mut query = Query::new(encoder, &[], Relevant::default());
                query.paths.declare(&mut query.script, path, &Goal::new(&encoder.objective.formula, true))?;
                let mut dialogue = oracle.open(1)?;
                oracle.check(&mut dialogue, &query.script)?
            }
        };
        if !some {
            return Ok(Some(path));
        }
    }
    Ok(None)
}

/// The objective with its formula decided, as it is when this quantifier ranges over nothing. The formula still reads
/// what it read, so horizons stay what they were.
pub(crate) fn decided(objective: &Objective, quantifier: Quantifier) -> Objective {
    let mut formula = objective.formula.clone();
    let root = formula.root();
    let holds = quantifier == Quantifier::Forall;
    let constant = formula.push(Node::Atom(if holds { Expr::TRUE } else { Expr::FALSE }), objective.span);
    let parts = vec![root, constant];
    formula.push(if holds { Node::Or(parts) } else { Node::And(parts) }, objective.span);
    Objective { formula, ..objective.clone() }
}
