//! What expressions and parts of a formula read, and how far.

use crate::error::Error;
use hyperplan_problem::{Expr, FormulaId, Interval, Mode, Node, Objective, PathId, PathLeaf, Type, Value};

/// No path is read later.
const LONGEST: u32 = 1 << 20;

/// The paths that each part of the formula reads, or those of which it reads states.
pub(crate) fn reads(objective: &Objective, states: bool) -> Vec<Vec<PathId>> {
    let mut all: Vec<Vec<PathId>> = Vec::new();
    for node in &objective.formula.nodes {
        let mut own: Vec<PathId> =
            node.children().into_iter().flat_map(|child| all[usize::from(child)].iter().copied()).collect();
        if let Node::Atom(expr) = node {
            expr.for_each_leaf(&mut |leaf| {
                if !states || !matches!(leaf, PathLeaf::Took(..) | PathLeaf::SameAction(..)) {
                    own.extend(leaf.paths().into_iter().flatten());
                }
            });
        }
        own.sort_unstable();
        own.dedup();
        all.push(own);
    }
    all
}

/// The last time at which each path is read; K under `within K`.
pub(crate) fn last_reads(objective: &Objective) -> Result<Vec<u32>, Error> {
    if let Mode::Within(steps) = objective.mode {
        return Ok(vec![steps; objective.paths.len()]);
    }
    let nodes = &objective.formula.nodes;
    // When each part is read last: parts stand before what they are parts of.
    let mut times: Vec<Option<u32>> = vec![None; nodes.len()];
    times[usize::from(objective.formula.root())] = Some(0);
    let mut last = vec![0; objective.paths.len()];
    for (id, node) in nodes.iter_enumerated().rev() {
        let Some(time) = times[usize::from(id)] else { continue };
        let mut read = |part: FormulaId, more: u32| {
            let sum = time.checked_add(more).filter(|time| *time <= LONGEST);
            let sum = sum.ok_or_else(|| Error::TooLarge { what: "the horizon is too long".to_owned() })?;
            let known = &mut times[usize::from(part)];
            *known = (*known).max(Some(sum));
            Ok::<(), Error>(())
        };
        match node {
            Node::Atom(expr) => expr.for_each_leaf(&mut |leaf| {
                for path in leaf.paths().into_iter().flatten() {
                    let known: &mut u32 = &mut last[usize::from(path)];
                    *known = (*known).max(time);
                }
            }),
            Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => {
                node.children().into_iter().try_for_each(|child| read(child, 0))?;
            }
            Node::Next(a) | Node::WeakNext(a) => read(*a, 1)?,
            Node::Until(Interval { hi, .. }, left, right)
            | Node::Release(Interval { hi, .. }, left, right) => {
                let hi = hi.ok_or(Error::Malformed { what: "an operator without `within` has no bound" })?;
                read(*right, hi)?;
                // The left side is read strictly before the right one.
                if let Some(before) = hi.checked_sub(1) {
                    read(*left, before)?;
                }
            }
        }
    }
    Ok(last)
}

/// How numbers of an order are values.
pub(crate) type Kind = fn(i64) -> Value;

pub(crate) const VALUE_BOOL: Kind = |n| Value::Bool(n == 1);

pub(crate) fn value_of(ty: &Type) -> Kind {
    match ty {
        Type::Bool => VALUE_BOOL,
        Type::Enum(_) => |n| Value::Enum(u32::try_from(n).unwrap_or(u32::MAX)),
        Type::Range { .. } | Type::Int | Type::Real => Value::Int,
    }
}

pub(crate) fn number(value: Option<Value>) -> Result<i64, Error> {
    match value {
        Some(Value::Bool(b)) => Ok(i64::from(b)),
        Some(Value::Int(n)) => Ok(n),
        Some(Value::Enum(i)) => Ok(i64::from(i)),
        Some(Value::Real(_)) | None => {
            Err(Error::Malformed { what: "an expression of an objective has no value" })
        }
    }
}

/// The path that an expression reads, if it reads the present state of one path and nothing else.
pub(crate) fn alone(expr: &Expr<PathLeaf>) -> Option<PathId> {
    let (mut own, mut others) = (None, false);
    expr.for_each_leaf(&mut |leaf| match *leaf {
        PathLeaf::State(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
            others |= own.is_some_and(|own| own != p);
            own = Some(p);
        }
        PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => others = true,
    });
    own.filter(|_| !others)
}
