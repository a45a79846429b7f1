//! A small, lossy memo in front of the exact ones: most moves of a step look alike to the atoms.

use crate::valuation::ValuationId;
use crate::value::ValueId;

/// What the value after a move of the innermost block depends on: the value before, what outer blocks and traces
/// say, what the block's states say, and what its actions say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Look {
    pub(crate) value: ValueId,
    pub(crate) base: ValuationId,
    pub(crate) states: ValuationId,
    pub(crate) deeds: ValuationId,
}

const SLOTS: usize = 1 << 12;

/// Direct-mapped: a new entry replaces whatever had its slot.
#[derive(Debug)]
pub(crate) struct Recent {
    slots: Vec<Option<(Look, ValueId)>>,
}

impl Recent {
    pub(crate) fn new() -> Self {
        Recent { slots: vec![None; SLOTS] }
    }

    pub(crate) fn get(&self, look: Look) -> Option<ValueId> {
        self.slots[slot(look)].filter(|(known, _)| *known == look).map(|(_, value)| value)
    }

    pub(crate) fn put(&mut self, look: Look, value: ValueId) {
        self.slots[slot(look)] = Some((look, value));
    }

    pub(crate) fn clear(&mut self) {
        self.slots.fill(None);
    }
}

fn slot(look: Look) -> usize {
    let mix = |hash: u64, n: u32| (hash ^ u64::from(n)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let hash = [look.value.0, look.base.0, look.states.0, look.deeds.0].into_iter().fold(0, mix);
    (hash >> (64 - SLOTS.trailing_zeros())) as usize
}
