//! For those who look for instances: what an assignment says of the player's paths, and instances that do what given paths do.
//! Nothing here has to be believed.

use super::{Encoder, Place};
use crate::error::Error;
use crate::instance::{Instance, targets};
use hyperplan_problem::Trace;

impl Encoder<'_> {
    /// The player's paths of the block before a place, under an assignment that satisfies all clauses.
    ///
    /// # Errors
    /// If it does not.
    pub fn traces(&self, place: Place, holds: &dyn Fn(i32) -> bool) -> Result<Vec<Trace>, Error> {
        const WRONG: Error = Error::Malformed { what: "an assignment does not satisfy the clauses" };
        let (scope, next) = &self.places[place.0];
        let paths =
            next.checked_sub(1).and_then(|block| self.blocks.get(block)).map_or(&[][..], Vec::as_slice);
        let mut traces = Vec::new();
        for &path in paths {
            let (copy, graph) = (self.copy(path, scope)?, self.graph(path));
            let cell =
                |time: usize, state| copy.layers[time].cells.iter().find(|c| c.0 == state && holds(c.1));
            let first = copy.layers[0].cells.iter().find(|cell| holds(cell.1)).ok_or(WRONG)?;
            let mut state = first.0;
            let mut trace = Trace { path, states: vec![graph.values(state).into()], actions: Vec::new() };
            for (time, acts) in copy.acts.iter().enumerate() {
                let (action, _) = acts.iter().find(|act| holds(act.1)).ok_or(WRONG)?;
                let mut there = targets(&graph, state, *action, self.lasting());
                state = there.find(|to| cell(time + 1, *to).is_some()).ok_or(WRONG)?;
                trace.actions.push(*action);
                trace.states.push(graph.values(state).into());
            }
            traces.push(trace);
        }
        Ok(traces)
    }

    /// Instances that do what these traces of one block do, given those before.
    ///
    /// # Errors
    /// If they are no paths.
    pub fn instances(&self, known: &[Trace], traces: &[Trace]) -> Result<Vec<Instance>, Error> {
        let mut all: Vec<Trace> = known.iter().map(|trace| self.read_of(trace)).collect();
        let mut found = Vec::new();
        for trace in traces {
            let trace = self.read_of(trace);
            let graph = self.graph(trace.path);
            found.push(Instance::of(self.objective, &graph, (&all, &trace), self.lasting())?);
            all.push(trace);
        }
        Ok(found)
    }

    /// A trace up to the last time at which it is read.
    fn read_of(&self, trace: &Trace) -> Trace {
        let steps = self.horizons[usize::from(trace.path)] as usize;
        let states = trace.states.iter().take(steps + 1).cloned().collect();
        Trace { path: trace.path, states, actions: trace.actions.iter().take(steps).copied().collect() }
    }

    /// Whether these instances, given these paths, are such traces.
    #[must_use]
    pub fn are(&self, instances: &[Instance], known: &[Trace], traces: &[Trace]) -> bool {
        let mut all: Vec<Trace> = known.iter().map(|trace| self.read_of(trace)).collect();
        instances.iter().zip(traces).all(|(own, trace)| {
            let found = own.trace(&self.graph(own.path), &all, self.lasting());
            let same = found.as_ref() == Some(&self.read_of(trace));
            all.extend(found);
            same
        })
    }
}
