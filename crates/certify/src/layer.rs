//! What has variables: the states and actions of a path at a time, and numbers that depend on its state.

use hyperplan_problem::ActionId;
use rustc_hash::FxHashMap;

/// A variable, from 1 on, or its negation; or one of the constants.
pub(crate) type Lit = i32;
pub(crate) const TRUE: Lit = i32::MAX;
pub(crate) const FALSE: Lit = -TRUE;

/// The states in which a path can be at a time, each with its variable, by state.
pub(crate) struct Layer {
    pub(crate) id: u32,
    pub(crate) cells: Vec<(u32, Lit)>,
}

/// The actions that a path can take at a time, each with its variable, by action.
pub(crate) type Acts = Vec<(ActionId, Lit)>;

/// A number that depends on a state: its values in a layer, ascending, and for each that it is at least that.
pub(crate) struct Order {
    pub(crate) values: Vec<i64>,
    pub(crate) lits: Vec<Lit>,
}

impl Order {
    /// That the number is at least that.
    pub(crate) fn at_least(&self, n: i64) -> Lit {
        let at = self.values.partition_point(|value| *value < n);
        self.lits.get(at).copied().unwrap_or(FALSE)
    }
}

/// The states that are reached at the next time: each with its variable and those of the states from where.
#[derive(Default)]
pub(crate) struct Next {
    index: FxHashMap<u32, usize>,
    pub(crate) reached: Vec<(u32, Lit, Vec<Lit>)>,
}

impl Next {
    /// The variable of a state that is reached from where `from` holds.
    pub(crate) fn reach(&mut self, to: u32, from: Lit, variables: &mut Lit) -> Lit {
        let at = *self.index.entry(to).or_insert_with(|| {
            *variables += 1;
            self.reached.push((to, *variables, Vec::new()));
            self.reached.len() - 1
        });
        let (_, x, before) = &mut self.reached[at];
        before.push(from);
        *x
    }
}
