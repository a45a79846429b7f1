//! Horizons that are much longer than any bound in the objective says.

use hyperplan_horizon::{Horizon, horizons};
use hyperplan_problem::{Mode, Node, Objective};
use hyperplan_syntax::Diagnostic;

/// Shorter paths are no burden.
const SHORT: u64 = 10;

/// The longest path of an objective, where that is surprising: one bound inside another, as in "get there, and from
/// there back", is common, with a step between them; more add up to what nobody wrote.
pub(super) fn lint(objective: &Objective) -> Option<Diagnostic> {
    if objective.mode != Mode::Bounded {
        return None;
    }
    let bound = objective.formula.nodes.iter().filter_map(end).max()?;
    let each = horizons(objective);
    // Of equally long paths the first.
    let (path, longest) = each.iter_enumerated().rev().max_by_key(|(_, h)| h.steps)?;
    let steps = longest.steps.filter(|&steps| steps >= SHORT && steps > 2 * bound + 1)?;
    let name = &objective.paths[path].name;
    let message = format!("{steps} steps of path {name} matter, though no bound exceeds {bound}");
    Some(explain(objective, longest, message))
}

/// Marks the operators whose bounds add up.
fn explain(objective: &Objective, horizon: &Horizon, message: String) -> Diagnostic {
    let help = "nested bounds add up; `within K` bounds all of them at once";
    let place = |id| objective.formula.spans[id];
    let mut reason = horizon.reason.iter();
    let (first, steps) = reason.next().map_or((objective.span, 0), |&(id, steps)| (place(id), steps));
    let warning = Diagnostic::warning("long-horizon", first, message).with_label(format!("adds {steps}"));
    reason
        .fold(warning, |warning, &(id, steps)| warning.with_related(place(id), format!("adds {steps}")))
        .with_help(help)
}

/// The last step that an operator's bound allows.
fn end(node: &Node) -> Option<u64> {
    let (Node::Until(interval, ..) | Node::Release(interval, ..)) = node else { return None };
    interval.hi.map(u64::from)
}
