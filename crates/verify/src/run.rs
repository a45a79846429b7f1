//! The search: values of all levels, moved step by step (see the crate's documentation).

use crate::history::History;
use crate::joint::{JointId, JointMove};
use crate::layer::{Members, Next};
use crate::report::Stop;
use crate::search::Search;
use crate::spread::{Kinds, Spread};
use crate::value::ValueId;

/// What the search found.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// The truth value, and the moves of the first block that decide it, where some do.
    Decided(bool, Option<Vec<JointMove>>),
    /// It depends on what a trace would have done beyond its end.
    Missing,
}

impl Search<'_> {
    /// The objective's value on the fixed traces. With `trail`, the moves that decide it are found, too.
    pub(crate) fn run(&mut self, trail: bool) -> Result<Outcome, Stop> {
        let decisive = self.levels[0].decisive;
        let start = Members::of(&[JointId::START], 1);
        let mut history = History { layers: vec![vec![(ValueId::START, start)]], sets: Vec::new() };
        let mut next = Next::default();
        let mut kinds: [Option<Kinds>; 2] = [None, None];
        let mut missing = false;
        loop {
            let base = self.enter()?;
            let found = match self.spread(&history.layers, kinds[0].as_ref(), base, &mut next)? {
                Spread::Decided(last) => {
                    let chain = if trail { Some(self.look_back(history, last)?) } else { None };
                    return Ok(Outcome::Decided(decisive, chain));
                }
                Spread::Open(found) => found,
            };
            missing |= found.missing;
            let layer = next.take(self.levels[0].joint.len());
            if layer.is_empty() {
                return Ok(if missing { Outcome::Missing } else { Outcome::Decided(!decisive, None) });
            }
            self.count_entries(layer.iter().map(|(_, members)| members.size()).sum())?;
            history.layers.push(layer);
            history.sets.push(std::mem::replace(&mut self.before, std::mem::take(&mut self.now)));
            let [_, last] = kinds;
            kinds = [last, Some(found)];
            self.time += 1;
        }
    }
}
