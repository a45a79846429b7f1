//! What a path costs, step by step, by the definition.

use crate::graph::Graph;
use crate::report::{Error, Stop};
use hyperplan_problem::{CostId, Objective, Problem, Trace};

/// The sum of what the steps of a trace cost. Whether they are steps is for [`crate::check()`] to say.
///
/// # Errors
/// If the trace is none of its system, or the sum does not fit into 64 bits.
pub fn cost(problem: &Problem, objective: &Objective, trace: &Trace, cost: CostId) -> Result<i64, Error> {
    let var = objective.paths.get(trace.path).ok_or(Error::Malformed { what: "a trace of no path" })?;
    let system = &problem.systems[var.system];
    let cost = system.costs.get(cost).ok_or(Error::Malformed { what: "a cost that the system has not" })?;
    let (states, actions) = (trace.states.len(), trace.actions.len());
    if states != actions + 1 {
        return Err(Error::Lengths { path: var.name.clone(), states, actions });
    }
    let sum = || -> Result<i64, Stop> {
        let mut graph = Graph::new(system, trace.states.len());
        let mut sum: i64 = 0;
        for (step, (pair, &action)) in trace.states.windows(2).zip(&trace.actions).enumerate() {
            if !pair.iter().all(|state| graph.is_state(state)) {
                return Err(Error::NotAState { path: var.name.clone(), step }.into());
            }
            let (from, to) = (graph.intern(&pair[0])?, graph.intern(&pair[1])?);
            let own = graph.step_cost(from, action, to, &cost.expr)?;
            let overflow = || Error::Overflow { system: system.name.clone() };
            sum = sum.checked_add(own).ok_or_else(overflow)?;
        }
        Ok(sum)
    };
    sum().map_err(|stop| match stop {
        Stop::Error(error) => error,
        Stop::Budget => Error::Malformed { what: "a trace of too many states" },
    })
}
