//! Horizons that are much longer than any bound in the objective says.

use hyperplan_horizon::{Horizon, Long, horizons, surprising};
use hyperplan_problem::Objective;
use hyperplan_syntax::Diagnostic;

/// Warns of the longest path of an objective where that is surprising.
pub(super) fn lint(objective: &Objective) -> Option<Diagnostic> {
    let Long { path, steps, bound } = surprising(objective)?;
    let name = &objective.paths[path].name;
    let message = format!("{steps} steps of path {name} matter, though no bound exceeds {bound}");
    Some(explain(objective, &horizons(objective)[path], message))
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
