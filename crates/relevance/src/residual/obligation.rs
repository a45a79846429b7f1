//! The obligations of a residual: how it looks once deadlines are forgotten, and whether anything but safety is left of it.
//!
//! `reach::bound` measures with these how far a state is from where nothing more is owed.

use super::{FALSE, Residual, Residuals, Shape, TRUE};
use hyperplan_problem::Interval;

/// Atoms whose values are known from some time on, for ever.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Settling {
    /// From this time on; `None` where there is no such atom.
    pub(crate) from: Option<u32>,
    /// Which atoms.
    pub(crate) known: u64,
    /// Their values.
    pub(crate) bits: u64,
    /// Atoms of the path in question; what is in neither set is never known.
    pub(crate) own: u64,
}

impl Settling {
    /// Whether a literal can still be true, and whether it will be without further ado.
    fn literal(&self, bit: u8, positive: bool) -> (bool, bool) {
        if self.known >> bit & 1 == 1 {
            let holds = (self.bits >> bit & 1 == 1) == positive;
            (holds, holds)
        } else {
            (true, self.own >> bit & 1 == 0)
        }
    }
}

impl Residuals {
    /// A weaker residual without numbers: deadlines are lifted, and what must always hold is forgotten, but for what
    /// is asked for at a time when it will be false, since the settling atoms are known. `time` is that of the next
    /// position; `None` within operators, where it is open. Recursion is bounded by the nesting of the formula.
    pub(crate) fn relax(&mut self, residual: Residual, time: Option<u32>, settling: &Settling) -> Residual {
        let many = |all: &mut Self, parts: &[Residual]| -> Vec<Residual> {
            parts.iter().map(|&part| all.relax(part, time, settling)).collect()
        };
        match self.shapes[residual as usize].clone() {
            Shape::True | Shape::False | Shape::Literal { .. } => residual,
            Shape::And(parts) => {
                let parts = many(self, &parts);
                self.join(true, parts)
            }
            Shape::Or(parts) => {
                let parts = many(self, &parts);
                self.join(false, parts)
            }
            Shape::Next { strong: false, .. } => TRUE,
            Shape::Next { strong: true, then } => {
                let then = self.relax(then, None, settling);
                self.next(true, then)
            }
            Shape::Until(_, left, right) => {
                let (left, right) = (self.relax(left, None, settling), self.relax(right, None, settling));
                self.temporal(true, Interval::ALWAYS, left, right)
            }
            Shape::Release(interval, left, right) => {
                let covers = settling.from.zip(time).is_some_and(|(from, time)| {
                    let from = from.saturating_sub(time);
                    interval.lo <= from && interval.hi.is_none_or(|hi| from <= hi)
                });
                if !covers || self.can_hold(right, settling) {
                    return TRUE;
                }
                let (left, right) = (self.relax(left, None, settling), self.only_settling(right, settling));
                self.temporal(false, Interval::ALWAYS, left, right)
            }
        }
    }

    /// A weaker residual that reads settling atoms only.
    fn only_settling(&mut self, residual: Residual, settling: &Settling) -> Residual {
        match self.shapes[residual as usize].clone() {
            Shape::Literal { bit, .. } if settling.known >> bit & 1 == 1 => residual,
            Shape::And(parts) => {
                let parts = parts.iter().map(|&part| self.only_settling(part, settling)).collect();
                self.join(true, parts)
            }
            Shape::Or(parts) => {
                let parts = parts.iter().map(|&part| self.only_settling(part, settling)).collect();
                self.join(false, parts)
            }
            Shape::False => FALSE,
            _ => TRUE,
        }
    }

    /// Whether a residual can still be met once the settling atoms are known, as far as they tell.
    pub(crate) fn can_hold(&self, residual: Residual, settling: &Settling) -> bool {
        match &self.shapes[residual as usize] {
            Shape::True => true,
            Shape::False => false,
            Shape::Literal { bit, positive } => settling.literal(*bit, *positive).0,
            Shape::And(parts) => parts.iter().all(|&part| self.can_hold(part, settling)),
            Shape::Or(parts) => parts.iter().any(|&part| self.can_hold(part, settling)),
            Shape::Next { strong: false, .. } => true,
            // A trace may end before the interval begins.
            Shape::Release(Interval { lo: 1.., .. }, ..) => true,
            Shape::Next { then: part, .. } | Shape::Until(_, _, part) | Shape::Release(_, _, part) => {
                self.can_hold(*part, settling)
            }
        }
    }

    /// Whether nothing is owed any more but that something be never the case.
    pub(crate) fn owes_nothing(&self, residual: Residual, settling: &Settling) -> bool {
        match &self.shapes[residual as usize] {
            Shape::True => true,
            Shape::False => false,
            Shape::Literal { bit, positive } => settling.literal(*bit, *positive).1,
            Shape::And(parts) => parts.iter().all(|&part| self.owes_nothing(part, settling)),
            Shape::Or(parts) => parts.iter().any(|&part| self.owes_nothing(part, settling)),
            Shape::Next { strong: false, .. } => true,
            Shape::Next { then: part, .. } | Shape::Until(_, _, part) => self.owes_nothing(*part, settling),
            Shape::Release(_, _, right) => self.can_hold(*right, settling),
        }
    }
}
