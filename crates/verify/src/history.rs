//! Looking back: the moves of the first free block that lead to a pair.

use crate::joint::{JointId, JointMove};
use crate::layer::Group;
use crate::report::{Budget, Error, Stop};
use crate::search::Search;
use crate::value::{Sets, ValueId};
use typed_index_collections::TiSlice;

/// A move of the first block from one of its pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) joint: JointId,
    pub(crate) value: ValueId,
    pub(crate) mv: JointMove,
}

/// The layers so far, and the sets that the values of all but the last name.
#[derive(Debug)]
pub(crate) struct History {
    pub(crate) layers: Vec<Vec<Group>>,
    pub(crate) sets: Vec<Sets>,
}

impl Search<'_> {
    /// The moves from the start up to `last`, which is a move at the present time. Every pair of a layer has a
    /// predecessor in the layer before, and any one will do.
    pub(crate) fn look_back(&mut self, history: History, last: Step) -> Result<Vec<JointMove>, Stop> {
        // No more than the way here did, which the budget allowed.
        self.budget = Budget { entries: u64::MAX, moves: u64::MAX, ..self.budget };
        self.now = std::mem::take(&mut self.before);
        let sources = self.levels[0].joint.sources();
        let mut moves = vec![last.mv];
        let mut target = last;
        for (layer, sets) in history.layers.iter().zip(history.sets).rev() {
            self.time -= 1;
            self.before = sets;
            // The earlier, the more steps are to come: what was found able to go on may not have been so then.
            for level in &mut self.levels {
                level.viable.clear();
            }
            let found = self.predecessor(layer, target, sources.as_deref())?;
            target = found.ok_or(Error::Malformed { what: "a pair has no predecessor" })?;
            moves.push(target.mv);
            self.now = std::mem::take(&mut self.before);
        }
        moves.reverse();
        Ok(moves)
    }

    /// A move at the present time from a pair of this layer to the pair from which `target` moves.
    fn predecessor(
        &mut self,
        layer: &[Group],
        target: Step,
        sources: Option<&TiSlice<JointId, Vec<JointId>>>,
    ) -> Result<Option<Step>, Stop> {
        let base = self.enter()?;
        let innermost = self.levels.len() == 1;
        let sources = sources.filter(|_| innermost);
        for (value, members) in layer {
            let candidates = match sources {
                Some(sources) => {
                    sources[target.joint].iter().copied().filter(|&j| members.contains(j)).collect()
                }
                None => members.list(),
            };
            for joint in candidates {
                let moves = self.joint_moves(0, joint)?;
                for at in 0..moves.len() {
                    let mv = self.levels[0].joint.at(&moves, at);
                    let to = if innermost { mv.to } else { self.representative(0, mv.to)? };
                    if to == target.joint && self.follow(0, mv, *value, base)? == Some(target.value) {
                        return Ok(Some(Step { joint, value: *value, mv }));
                    }
                }
            }
        }
        Ok(None)
    }
}
