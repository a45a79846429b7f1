//! That paths cost no more than they may, as a unary number that grows: how much more than the cheapest runs through the
//! layers do (see `hyperplan_relevance`'s `ceiling`).

use super::path::EnumeratedPath;
use hyperplan_relevance::{Error, NO_WAY, Task, rests, transitions};
use hyperplan_smt::{Script, Term};
use hyperplan_space::StateIx;
use std::collections::BTreeMap;

/// More room than this above the cheapest runs makes too large a query.
const MOST_ROOM: i64 = 100_000;

/// What a step, or a start, costs more than the cheapest: with each surplus the conditions under which it does.
type Surpluses = BTreeMap<i64, Vec<Term>>;

/// Demands of paths that are declared, each with what the transitions of its graph count, to count at most so much together.
///
/// # Errors
/// [`Error::TooLarge`] where the bound is far above what the cheapest runs cost, [`Error::Interrupted`] soon after the task
/// is to stop.
pub(super) fn afford(
    script: &mut Script,
    task: &Task<'_>,
    paths: &[(&EnumeratedPath, &[i64])],
    most: i64,
) -> Result<(), Error> {
    let mut room = most;
    let mut all: Vec<Vec<Vec<i64>>> = Vec::new();
    for (path, weights) in paths {
        let layers: Vec<&[StateIx]> = path.layers.iter().map(|layer| &*layer.states).collect();
        let rests = rests(&path.graph, &layers, weights);
        room = room.saturating_sub(rests[0].iter().copied().min().unwrap_or(NO_WAY));
        all.push(rests);
    }
    if room < 0 {
        script.assert(Term::FALSE);
        return Ok(());
    }
    let mut used = Unary { room, at_least: Vec::new() };
    for ((path, _), rests) in paths.iter().zip(&all) {
        let least = rests[0].iter().copied().min().unwrap_or(NO_WAY);
        let mut surpluses = Surpluses::new();
        for (&term, &rest) in path.layers[0].terms.iter().zip(&rests[0]) {
            surpluses.entry(rest - least).or_default().push(term);
        }
        used.add(script, surpluses)?;
    }
    let steps = paths.iter().map(|(path, _)| path.steps.len()).max().unwrap_or(0);
    for time in 0..steps {
        task.go_on()?;
        for ((path, weights), rests) in paths.iter().zip(&all) {
            if time < path.steps.len() {
                let surpluses = surpluses(script, path, weights, rests, time, room);
                used.add(script, surpluses)?;
            }
        }
    }
    Ok(())
}

/// The surpluses of the steps after a time; those that leave no room are excluded.
fn surpluses(
    script: &mut Script,
    path: &EnumeratedPath,
    weights: &[i64],
    rests: &[Vec<i64>],
    time: usize,
    room: i64,
) -> Surpluses {
    let (layer, next, step) = (&path.layers[time], &path.layers[time + 1], &path.steps[time]);
    let mut surpluses = Surpluses::new();
    for ((&state, &here), &rest) in layer.states.iter().zip(&layer.terms).zip(&rests[time]) {
        for (letter, to, weight) in transitions(&path.graph, weights, state) {
            let Ok(at) = next.states.binary_search(&to) else { continue };
            let Ok(own) = step.letters.binary_search_by_key(&letter, |l| l.0) else { continue };
            let taken = step.letters[own].1;
            let surplus = weight.saturating_add(rests[time + 1][at]).saturating_sub(rest);
            if surplus > room || rests[time + 1][at] >= NO_WAY {
                script.clause(&[!here, !taken]);
            } else if surplus > 0 {
                let term = script.terms.and2(here, taken);
                surpluses.entry(surplus).or_default().push(term);
            }
        }
    }
    surpluses
}

/// A number that is at most `room`: whether it is at least 1, at least 2, and so on, as far as it can be.
struct Unary {
    room: i64,
    at_least: Vec<Term>,
}

impl Unary {
    /// Adds one of some numbers, or nothing; a sum beyond the room is excluded.
    fn add(&mut self, script: &mut Script, surpluses: Surpluses) -> Result<(), Error> {
        let mut ways: Vec<(i64, Term)> = Vec::new();
        for (surplus, terms) in surpluses.into_iter().filter(|(surplus, _)| *surplus > 0) {
            let any = script.terms.or(&terms);
            if surplus > self.room {
                script.assert(!any);
            } else {
                ways.push((surplus, any));
            }
        }
        let Some(&(greatest, _)) = ways.last() else { return Ok(()) };
        let now = std::mem::take(&mut self.at_least);
        let reached = |least: i64| match usize::try_from(least - 1) {
            Err(_) => Term::TRUE,
            Ok(at) => now.get(at).copied().unwrap_or(Term::FALSE),
        };
        // More than is left cannot be added.
        for &(surplus, way) in &ways {
            script.clause(&[!way, !reached(self.room - surplus + 1)]);
        }
        let most = (now.len() as i64).saturating_add(greatest).min(self.room);
        if most > MOST_ROOM {
            let what = "what paths may cost above the least".to_owned();
            return Err(Error::TooLarge { what, limit: MOST_ROOM as usize });
        }
        for least in 1..=most {
            let mut terms = vec![reached(least)];
            for &(surplus, way) in &ways {
                terms.push(script.terms.and2(way, reached(least - surplus)));
            }
            self.at_least.push(script.terms.or(&terms));
        }
        Ok(())
    }
}
