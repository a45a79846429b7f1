//! The states of a system that were met, each with its index.

use crate::eval::bounds;
use crate::graph::{StateIx, TooLarge};
use hyperplan_problem::System;
use rustc_hash::FxHashMap;

/// States there may be up to which each has an entry of its own, met or not.
const TABLE: u128 = 1 << 22;

/// The states that were met, numbered in that order.
pub(crate) struct Met {
    /// The codes of the states' variables, one state after the other.
    pub(crate) codes: Vec<i64>,
    width: usize,
    /// Least code and number of codes of each variable.
    radix: Vec<(i64, u128)>,
    index: Index,
    count: usize,
    budget: usize,
}

/// The index of each state by its number in the mixed radix of its variables.
enum Index {
    /// One more than it; zero for none.
    Table(Vec<StateIx>),
    Map(FxHashMap<u128, StateIx>),
}

impl Met {
    /// None yet; at most `budget` will be.
    ///
    /// # Errors
    /// [`TooLarge`] where the numbers of states do not fit.
    pub(crate) fn new(system: &System, budget: usize) -> Result<Met, TooLarge> {
        let radix = system.vars.iter().map(|var| {
            let (lo, hi) = bounds(&var.ty)?;
            Some((lo, (hi - lo) as u128 + 1))
        });
        let radix: Vec<(i64, u128)> = radix.collect::<Option<_>>().ok_or(TooLarge)?;
        let all = radix.iter().try_fold(1u128, |product, (_, n)| product.checked_mul(*n)).ok_or(TooLarge)?;
        let index = match all {
            0..=TABLE => Index::Table(vec![0; all as usize]),
            _ => Index::Map(FxHashMap::default()),
        };
        Ok(Met { codes: Vec::new(), width: radix.len(), radix, index, count: 0, budget })
    }

    /// Number of states.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// The codes of a state's variables.
    pub(crate) fn codes(&self, state: usize) -> &[i64] {
        &self.codes[state * self.width..(state + 1) * self.width]
    }

    /// The index of a state, new or known; `None` where it is outside the types.
    ///
    /// # Errors
    /// [`TooLarge`] beyond the budget.
    pub(crate) fn meet(&mut self, codes: &[i64]) -> Result<Option<StateIx>, TooLarge> {
        let Some(number) = self.number(codes) else { return Ok(None) };
        let known = match &self.index {
            Index::Table(table) => table[number as usize].checked_sub(1),
            Index::Map(map) => map.get(&number).copied(),
        };
        if known.is_some() {
            return Ok(known);
        }
        if self.count >= self.budget {
            return Err(TooLarge);
        }
        let next = self.count as StateIx;
        match &mut self.index {
            Index::Table(table) => table[number as usize] = next + 1,
            Index::Map(map) => {
                map.insert(number, next);
            }
        }
        self.count += 1;
        self.codes.extend_from_slice(codes);
        Ok(Some(next))
    }

    /// `None` where a value is outside its type.
    fn number(&self, codes: &[i64]) -> Option<u128> {
        let mut number = 0u128;
        for (&value, &(lo, n)) in codes.iter().zip(&self.radix) {
            let digit = u128::try_from(value.checked_sub(lo)?).ok().filter(|d| *d < n)?;
            number = number * n + digit;
        }
        Some(number)
    }
}
