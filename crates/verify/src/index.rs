//! States by their values.

use hyperplan_problem::{System, Type, Value};
use rustc_hash::FxHashMap;

id! {
    /// A state that was met.
    StateId, "the budget of states is kept below 2^32"
}

/// Up to so many combinations of values there is a place for each.
const PLACES: u64 = 1 << 20;

/// Which state has which values. Where each variable has finitely many, a state has a number among all combinations.
#[derive(Debug)]
pub(crate) enum Index {
    /// By number: one more than the state, or nothing.
    Placed(Numbers, Vec<u32>),
    Numbered(Numbers, FxHashMap<u64, StateId>),
    Listed(FxHashMap<Box<[Value]>, StateId>),
}

impl Index {
    /// Of no states yet.
    pub(crate) fn new(system: &System) -> Self {
        match Numbers::of(system) {
            Some((numbers, all)) if all <= PLACES => {
                // It is no more than PLACES.
                Index::Placed(numbers, vec![0; usize::try_from(all).unwrap_or(0)])
            }
            Some((numbers, _)) => Index::Numbered(numbers, FxHashMap::default()),
            None => Index::Listed(FxHashMap::default()),
        }
    }

    /// The state with these values, which are of their variables' types.
    pub(crate) fn get(&self, values: &[Value]) -> Option<StateId> {
        match self {
            Index::Placed(numbers, places) => {
                places.get(numbers.number(values) as usize)?.checked_sub(1).map(StateId)
            }
            Index::Numbered(numbers, known) => known.get(&numbers.number(values)).copied(),
            Index::Listed(known) => known.get(values).copied(),
        }
    }

    /// Another state with its values.
    pub(crate) fn insert(&mut self, values: &[Value], state: StateId) {
        match self {
            Index::Placed(numbers, places) => places[numbers.number(values) as usize] = state.0 + 1,
            Index::Numbered(numbers, known) => {
                known.insert(numbers.number(values), state);
            }
            Index::Listed(known) => {
                known.insert(values.into(), state);
            }
        }
    }
}

/// Numbers of combinations of values: the least value of each variable, and how many it has.
#[derive(Debug)]
pub(crate) struct Numbers(Vec<(i64, u64)>);

impl Numbers {
    /// Those of the states of a system, and how many they are, if 64 bits are enough.
    fn of(system: &System) -> Option<(Self, u64)> {
        let digits = system.vars.iter().map(|var| match &var.ty {
            Type::Bool => Some((0, 2)),
            Type::Range { lo, hi } => Some((*lo, hi.abs_diff(*lo).checked_add(1)?)),
            Type::Enum(names) => Some((0, names.len() as u64)),
            Type::Int | Type::Real => None,
        });
        let digits: Vec<(i64, u64)> = digits.collect::<Option<_>>()?;
        let all = digits.iter().try_fold(1_u64, |all, (_, count)| all.checked_mul(*count))?;
        Some((Numbers(digits), all))
    }

    fn number(&self, values: &[Value]) -> u64 {
        let digit = |value: &Value, least: i64| match *value {
            Value::Bool(value) => u64::from(value),
            Value::Int(value) => value.abs_diff(least),
            Value::Enum(position) => position.into(),
            // No variable that may be one is counted.
            Value::Real(_) => 0,
        };
        let numbered = self.0.iter().zip(values);
        numbered.fold(0, |number, ((least, count), value)| number * count + digit(value, *least))
    }
}
