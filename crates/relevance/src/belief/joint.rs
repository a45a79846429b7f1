//! Several paths at once: their states, their options, and numbers for what is met again.

use hyperplan_space::StateIx;
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::ops::Range;

/// A number for each of some things.
#[derive(Debug)]
pub(super) struct Numbers<T> {
    all: Vec<T>,
    index: FxHashMap<T, u32>,
}

impl<T: Copy + Eq + Hash> Numbers<T> {
    pub(super) fn new() -> Self {
        Numbers { all: Vec::new(), index: FxHashMap::default() }
    }

    pub(super) fn of(&mut self, thing: T) -> u32 {
        let next = self.all.len() as u32;
        *self.index.entry(thing).or_insert_with(|| {
            self.all.push(thing);
            next
        })
    }

    /// The number of what was met before.
    pub(super) fn find(&self, thing: &T) -> Option<u32> {
        self.index.get(thing).copied()
    }

    pub(super) fn get(&self, number: u32) -> T {
        self.all[number as usize]
    }

    pub(super) fn len(&self) -> usize {
        self.all.len()
    }
}

/// States of all paths; those of the paths that are not meant are 0.
pub(super) type States<const N: usize> = [StateIx; N];

/// Every choice of one of each path's options, of the paths in a range.
pub(super) fn joint<T: Copy + Default, const N: usize>(
    range: Range<usize>,
    options: impl Fn(usize) -> Vec<T>,
) -> Vec<[T; N]> {
    let mut all = vec![[T::default(); N]];
    for at in range {
        let own = options(at);
        let with = |done: &[T; N]| {
            let done = *done;
            own.iter().map(move |&option| std::array::from_fn(|i| if i == at { option } else { done[i] }))
        };
        all = all.iter().flat_map(with).collect();
    }
    all
}
