//! One run of those that are there first, found depth first.
//!
//! Where the bound is exact, as for "go there past all obstacles", each step that it admits leads on, and a run is found in as
//! many steps as it has; exploring time by time looks at all runs that are as good. Where it is not, all of them have been
//! looked at in the end, and nothing is known but that there is none so soon.

use super::explore::{Exploration, Joint, STRIDE};
use super::question::Place;
use crate::layers::Layers;
use crate::task::Error;
use rustc_hash::FxHashSet;

impl Exploration<'_, 1> {
    /// The layers of a run that owes nothing but safety when the bound says that none can sooner; `None` where there is no
    /// such run, no bound, or too much to look at.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn dive(&mut self) -> Result<Option<[Layers; 1]>, Error> {
        if self.bound.is_none() {
            return Ok(None);
        }
        let (slack, lossy) = (self.slack.replace(0), self.lossy);
        let run = self.depth_first();
        (self.slack, self.lossy) = (slack, lossy);
        run
    }

    fn depth_first(&mut self) -> Result<Option<[Layers; 1]>, Error> {
        let horizon = self.product.horizon;
        let mut met: FxHashSet<(u32, Joint<1>)> = FxHashSet::default();
        let mut run = Vec::new();
        let mut moves: Vec<[Place; 1]> = Vec::new();
        // What is first in order is looked at first, and so comes last.
        let mut open: Vec<(u32, Joint<1>)> = self.start().into_iter().rev().map(|joint| (0, joint)).collect();
        while let Some((time, joint)) = open.pop() {
            let (residual, [state]) = joint;
            if !met.insert((time, joint)) {
                continue;
            }
            if met.len().is_multiple_of(STRIDE) {
                self.product.question.arena.task.go_on()?;
            }
            if met.len() > self.product.question.budget {
                break;
            }
            run.truncate(time as usize);
            run.push(vec![state]);
            let owes_nothing = self.product.owes_nothing(residual);
            if time == horizon {
                if owes_nothing {
                    return Ok(Some([Layers { at: run }]));
                }
                continue;
            }
            self.moves([state], time + 1, &mut moves);
            // Where nothing is owed, staying is as good as anything.
            moves.sort_by_key(|&[(next, _)]| !(owes_nothing && next == state));
            for places in moves.iter().rev() {
                if let Some(after) = self.enter(residual, places, time + 1) {
                    open.push((time + 1, (after, places.map(|place| place.0))));
                }
            }
        }
        Ok(None)
    }
}
