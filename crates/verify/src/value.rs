//! Values of levels.

use crate::joint::JointId;
use crate::residual::ResidualId;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// A value of a level: below the last block a residual, else a set of pairs; the constants are shared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ValueId(pub(crate) u32);

impl ValueId {
    pub(crate) const FALSE: ValueId = ValueId(ResidualId::FALSE.0);
    pub(crate) const TRUE: ValueId = ValueId(ResidualId::TRUE.0);
    /// It depends on what a trace would have done beyond its end.
    pub(crate) const MISSING: ValueId = ValueId(ResidualId::MISSING.0);
    /// Nothing read yet.
    pub(crate) const START: ValueId = ValueId(ResidualId::START.0);

    /// A truth value.
    pub(crate) fn of(truth: bool) -> Self {
        if truth { ValueId::TRUE } else { ValueId::FALSE }
    }

    /// Whether no further step changes it.
    pub(crate) fn is_constant(self) -> bool {
        self <= ValueId::MISSING
    }
}

/// The first id that names a set.
const FIRST_SET: u32 = ResidualId::START.0 + 1;

/// A prefix of a block's paths, as far as it matters: the joint state, and the value of the next level.
pub(crate) type Pair = (JointId, ValueId);

/// The sets of one step, hash-consed.
#[derive(Debug, Default)]
pub(crate) struct Sets {
    all: Vec<Rc<[Pair]>>,
    index: FxHashMap<Rc<[Pair]>, ValueId>,
}

impl Sets {
    /// The pairs of a value that is not constant.
    pub(crate) fn get(&self, value: ValueId) -> Rc<[Pair]> {
        match value.0.checked_sub(FIRST_SET) {
            None => Rc::from([(JointId::START, ValueId::START)]),
            Some(index) => self.all[index as usize].clone(),
        }
    }

    /// The value that consists of these pairs, sorted and without repetition; and whether it is new.
    pub(crate) fn intern(&mut self, pairs: Vec<Pair>) -> (ValueId, bool) {
        if let Some(&id) = self.index.get(pairs.as_slice()) {
            return (id, false);
        }
        let pairs: Rc<[Pair]> = pairs.into();
        // Entries, which the budget bounds, are at least as many as sets.
        let id = ValueId(u32::try_from(self.all.len()).unwrap_or(u32::MAX - FIRST_SET) + FIRST_SET);
        self.all.push(pairs.clone());
        self.index.insert(pairs, id);
        (id, true)
    }
}
