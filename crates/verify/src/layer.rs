//! The pairs of the first free block: one step's sets of joint states by value, and how the next one's are found.

use crate::joint::{DeedId, JointId};
use crate::valuation::ValuationId;
use crate::value::ValueId;
use rustc_hash::{FxHashMap, FxHashSet};
use typed_index_collections::TiVec;

/// The joint states that share a value.
pub(crate) type Group = (ValueId, Members);

/// A set of joint states: what takes less memory of a list and a bit for each joint state.
#[derive(Clone, Debug)]
pub(crate) enum Members {
    Listed(Box<[JointId]>),
    Bits(Box<[u64]>),
}

const BITS: usize = u64::BITS as usize;

impl Members {
    /// Some of `all` joint states.
    pub(crate) fn of(list: &[JointId], all: usize) -> Self {
        let words = all.div_ceil(BITS);
        if list.len() <= 2 * words {
            return Members::Listed(list.into());
        }
        Members::Bits(with(vec![0; words], list).into())
    }

    /// What it takes: a joint state of a list counts one, as do 32 bits.
    pub(crate) fn size(&self) -> u64 {
        match self {
            Members::Listed(list) => list.len() as u64,
            Members::Bits(words) => 2 * words.len() as u64,
        }
    }

    /// All of them.
    pub(crate) fn list(&self) -> Vec<JointId> {
        match self {
            Members::Listed(list) => list.to_vec(),
            Members::Bits(words) => listed(words.iter().copied()),
        }
    }

    /// What is new since `before`, where nothing is gone.
    pub(crate) fn grown(&self, before: &Members) -> Option<Vec<JointId>> {
        match self {
            Members::Listed(now) => {
                let before: FxHashSet<JointId> = before.list().into_iter().collect();
                let new: Vec<JointId> = now.iter().copied().filter(|joint| !before.contains(joint)).collect();
                (before.len() + new.len() == now.len()).then_some(new)
            }
            Members::Bits(now) => {
                let before = before.bits(now.len());
                let kept = before.iter().zip(now).all(|(before, now)| before & !now == 0);
                let new = before.iter().zip(now).map(|(before, now)| now & !before);
                (kept && before.len() <= now.len()).then(|| listed(new))
            }
        }
    }

    /// Whether a joint state is among them.
    pub(crate) fn contains(&self, joint: JointId) -> bool {
        let (word, bit) = (usize::from(joint) / BITS, usize::from(joint) % BITS);
        match self {
            Members::Listed(list) => list.contains(&joint),
            Members::Bits(words) => words.get(word).is_some_and(|word| word >> bit & 1 == 1),
        }
    }

    /// A bit for each joint state, in at least so many words.
    fn bits(&self, words: usize) -> Vec<u64> {
        match self {
            Members::Listed(list) => with(vec![0; words], list),
            Members::Bits(bits) => {
                let mut bits = bits.to_vec();
                bits.resize(bits.len().max(words), 0);
                bits
            }
        }
    }
}

/// Sets the bits of these joint states.
fn with(mut bits: Vec<u64>, list: &[JointId]) -> Vec<u64> {
    for &joint in list {
        let word = usize::from(joint) / BITS;
        if bits.len() <= word {
            bits.resize(word + 1, 0);
        }
        bits[word] |= 1 << (usize::from(joint) % BITS);
    }
    bits
}

/// The joint states whose bits are set.
fn listed(words: impl Iterator<Item = u64>) -> Vec<JointId> {
    let mut list = Vec::new();
    for (number, mut word) in words.enumerate() {
        while word != 0 {
            list.push(JointId::from(number * BITS + word.trailing_zeros() as usize));
            word &= word - 1;
        }
    }
    list
}

/// Where a move leads: into a group of the next layer, or nowhere that matters any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Slot(u32);

impl Slot {
    /// The value is decided, or the move leads to no path.
    pub(crate) const DROPPED: Slot = Slot(u32::MAX);
}

/// A group of the next layer, as far as it is known.
#[derive(Debug)]
struct Growing {
    value: ValueId,
    /// A set that belongs to it.
    base: Option<Members>,
    /// What else does; a joint state may be listed several times.
    list: Vec<JointId>,
}

/// The layer after the present one, as far as it is known.
#[derive(Debug, Default)]
pub(crate) struct Next {
    /// By slot.
    groups: Vec<Growing>,
    slots: FxHashMap<ValueId, Slot>,
    /// Room in all lists.
    room: u64,
    /// Where the moves of the present group lead, by what is said of their states and by deed. An entry counts
    /// only if it is of this round.
    seen: Vec<TiVec<DeedId, (u32, Slot)>>,
    round: u32,
    distinct: Distinct,
}

impl Next {
    /// Turns to another group of the present layer.
    pub(crate) fn turn(&mut self) {
        if self.round == u32::MAX {
            self.seen.clear();
            self.round = 0;
        }
        self.round += 1;
    }

    /// Where an earlier move of the same group led that looked the same to all atoms.
    pub(crate) fn known(&self, said: ValuationId, deed: DeedId) -> Option<Slot> {
        let &(round, slot) = self.seen.get(said.0 as usize)?.get(deed)?;
        (round == self.round).then_some(slot)
    }

    /// Remembers where such moves of the present group lead.
    pub(crate) fn remember(&mut self, said: ValuationId, deed: DeedId, slot: Slot) {
        let row = said.0 as usize;
        if self.seen.len() <= row {
            self.seen.resize(row + 1, TiVec::new());
        }
        let row = &mut self.seen[row];
        if row.len() <= usize::from(deed) {
            row.resize(usize::from(deed) + 1, (0, Slot::DROPPED));
        }
        row[deed] = (self.round, slot);
    }

    /// The group of a value that is not decided.
    pub(crate) fn slot(&mut self, value: ValueId) -> Slot {
        let groups = &mut self.groups;
        *self.slots.entry(value).or_insert_with(|| {
            groups.push(Growing { value, base: None, list: Vec::new() });
            Slot(u32::try_from(groups.len() - 1).unwrap_or(u32::MAX))
        })
    }

    /// Adds a joint state to a group.
    pub(crate) fn push(&mut self, slot: Slot, joint: JointId) {
        let Some(Growing { list, .. }) = self.groups.get_mut(slot.0 as usize) else { return };
        if list.len() == list.capacity() {
            self.room -= list.capacity() as u64;
            self.distinct.retain(list);
            list.reserve(list.len().max(4));
            self.room += list.capacity() as u64;
        }
        list.push(joint);
    }

    /// How many joint states its lists have room for.
    pub(crate) fn room(&self) -> u64 {
        self.room
    }

    /// Puts a layer's sets below the groups found so far, slot by slot; says whether it has as many.
    pub(crate) fn found(&mut self, layer: &[Group]) -> bool {
        for (group, (_, members)) in self.groups.iter_mut().zip(layer) {
            group.base = Some(members.clone());
        }
        self.groups.len() == layer.len()
    }

    /// Forgets what is known.
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.slots.clear();
        self.room = 0;
    }

    /// The layer, complete, of some of `all` joint states; begins the one after.
    pub(crate) fn take(&mut self, all: usize) -> Vec<Group> {
        let groups = std::mem::take(&mut self.groups);
        self.clear();
        let words = all.div_ceil(BITS);
        let finished = groups.into_iter().map(|Growing { value, base, mut list }| {
            let members = match base {
                Some(base @ Members::Bits(_)) => Members::Bits(with(base.bits(words), &list).into()),
                base => {
                    list.extend(base.iter().flat_map(Members::list));
                    self.distinct.retain(&mut list);
                    Members::of(&list, all)
                }
            };
            (value, members)
        });
        finished.collect()
    }
}

/// Finds repetitions: the last round in which a joint state was met.
#[derive(Debug, Default)]
struct Distinct {
    met: TiVec<JointId, u32>,
    round: u32,
}

impl Distinct {
    fn retain(&mut self, list: &mut Vec<JointId>) {
        if self.round == u32::MAX {
            self.met.clear();
            self.round = 0;
        }
        self.round += 1;
        let Distinct { met, round } = self;
        list.retain(|&joint| {
            if met.len() <= usize::from(joint) {
                met.resize(usize::from(joint) + 1, 0);
            }
            std::mem::replace(&mut met[joint], *round) != *round
        });
    }
}
