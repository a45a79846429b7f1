//! Concrete states as rows of integers: one with what its labels are, and several in one piece.

use crate::eval::eval;
use hyperplan_problem::{Expr, LabelId, Leaf, System};
use std::cell::{Cell, OnceCell};

/// A state of a finite system. What a label is there is found when it is first asked, once.
pub(crate) struct Row<'a> {
    system: &'a System,
    codes: Vec<i64>,
    /// What each label is, and in which round that was found.
    labels: Vec<Cell<(u32, i64)>>,
    /// Labels may be in long chains: those that one reads, directly or not, are found before it, and none within another.
    below: Vec<OnceCell<Box<[LabelId]>>>,
    /// How many states it has been.
    round: u32,
}

impl<'a> Row<'a> {
    /// No state yet.
    pub(crate) fn new(system: &'a System) -> Self {
        Row {
            system,
            codes: Vec::with_capacity(system.vars.len()),
            labels: vec![Cell::new((0, 0)); system.labels.len()],
            below: vec![OnceCell::new(); system.labels.len()],
            round: 0,
        }
    }

    /// Turns to another state, or to the first variables of one, of which alone may then be asked.
    pub(crate) fn turn(&mut self, codes: &[i64]) {
        if self.round == u32::MAX {
            self.labels.fill(Cell::new((0, 0)));
            self.round = 0;
        }
        self.round += 1;
        self.codes.clear();
        self.codes.extend_from_slice(codes);
    }

    /// The system that it is a state of.
    pub(crate) fn system(&self) -> &'a System {
        self.system
    }

    /// The codes of its variables.
    pub(crate) fn codes(&self) -> &[i64] {
        &self.codes
    }

    /// The value of an expression.
    pub(crate) fn eval(&self, expr: &Expr<Leaf>) -> i64 {
        eval(expr, &mut |leaf| self.leaf(*leaf))
    }

    /// Whether a Boolean expression holds.
    pub(crate) fn holds(&self, expr: &Expr<Leaf>) -> bool {
        self.eval(expr) != 0
    }

    /// What a leaf is.
    pub(crate) fn leaf(&self, leaf: Leaf) -> i64 {
        match leaf {
            Leaf::Var(var) => self.codes[usize::from(var)],
            Leaf::Label(label) => self.known(label).unwrap_or_else(|| self.find(label)),
        }
    }

    fn known(&self, label: LabelId) -> Option<i64> {
        let (round, value) = self.labels[usize::from(label)].get();
        (round == self.round).then_some(value)
    }

    fn find(&self, label: LabelId) -> i64 {
        if self.system.labels[label].nested {
            let below = || self.system.labels_below(label).into();
            for &below in self.below[usize::from(label)].get_or_init(below) {
                if self.known(below).is_none() {
                    self.find_only(below);
                }
            }
        }
        self.find_only(label)
    }

    /// What a label is that reads only known ones.
    fn find_only(&self, label: LabelId) -> i64 {
        let value = eval(&self.system.labels[label].expr, &mut |leaf| match *leaf {
            Leaf::Var(var) => self.codes[usize::from(var)],
            Leaf::Label(below) => self.labels[usize::from(below)].get().1,
        });
        self.labels[usize::from(label)].set((self.round, value));
        value
    }
}

/// States of one system, one after the other. Systems without variables have states, too.
#[derive(Default)]
pub(crate) struct Rows {
    count: usize,
    codes: Vec<i64>,
}

impl Rows {
    /// Number of states.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.codes.clear();
    }

    /// Adds a state.
    pub(crate) fn push(&mut self, codes: &[i64]) {
        self.count += 1;
        self.codes.extend_from_slice(codes);
    }

    /// Takes the last state away again.
    pub(crate) fn pop(&mut self) {
        let width = self.width();
        self.codes.truncate(self.codes.len() - width);
        self.count = self.count.saturating_sub(1);
    }

    /// The last state.
    pub(crate) fn last_mut(&mut self) -> &mut [i64] {
        let width = self.width();
        let start = self.codes.len() - width;
        &mut self.codes[start..]
    }

    /// A state by its position.
    pub(crate) fn get(&self, at: usize) -> &[i64] {
        let width = self.width();
        &self.codes[at * width..(at + 1) * width]
    }

    /// All of them.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &[i64]> {
        (0..self.count).map(|at| self.get(at))
    }

    fn width(&self) -> usize {
        self.codes.len().checked_div(self.count).unwrap_or(0)
    }
}
