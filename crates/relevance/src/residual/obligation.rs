//! The obligations of a residual: how it looks once deadlines are forgotten, and whether anything but safety is left of it.
//!
//! `reach::bound` measures with these how far a state is from where nothing more is owed.

use super::{FALSE, Residual, Residuals, Shape, TRUE};
use hyperplan_problem::Interval;
use rustc_hash::FxHashMap;

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

/// What residuals are relaxed to, by whether the time of the next position is known. They share parts, which would be
/// walked once for each way to them.
type Relaxed = FxHashMap<(Residual, bool), Residual>;

impl Residuals {
    /// A weaker residual without numbers: deadlines are lifted, and what must always hold is forgotten, but for what
    /// is asked for at a time when it will be false, since the settling atoms are known. `time` is that of the next
    /// position, if it is known.
    pub(crate) fn relax(&mut self, residual: Residual, time: Option<u32>) -> Residual {
        self.relaxed(residual, time, &mut Relaxed::default())
    }

    /// The same; within operators the time is open. Recursion is bounded by the nesting of the formula.
    fn relaxed(&mut self, residual: Residual, time: Option<u32>, known: &mut Relaxed) -> Residual {
        if let Some(&relaxed) = known.get(&(residual, time.is_some())) {
            return relaxed;
        }
        let shape = self.shapes[residual as usize].clone();
        let relaxed = match shape {
            Shape::True | Shape::False | Shape::Literal { .. } => return residual,
            Shape::And(ref parts) | Shape::Or(ref parts) => {
                let parts = parts.iter().map(|&part| self.relaxed(part, time, known)).collect();
                self.join(matches!(shape, Shape::And(_)), parts)
            }
            Shape::Next { strong: false, .. } => TRUE,
            Shape::Next { strong: true, then } => {
                let then = self.relaxed(then, None, known);
                self.next(true, then)
            }
            Shape::Until(_, left, right) => {
                let [left, right] = [left, right].map(|part| self.relaxed(part, None, known));
                self.temporal(true, Interval::ALWAYS, left, right)
            }
            Shape::Release(interval, left, right) => {
                let covers = self.settling.from.zip(time).is_some_and(|(from, time)| {
                    let from = from.saturating_sub(time);
                    interval.lo <= from && interval.hi.is_none_or(|hi| from <= hi)
                });
                if !covers || self.can_hold(right) {
                    TRUE
                } else {
                    let left = self.relaxed(left, None, known);
                    let right = self.only_settling(right, &mut FxHashMap::default());
                    self.temporal(false, Interval::ALWAYS, left, right)
                }
            }
        };
        known.insert((residual, time.is_some()), relaxed);
        relaxed
    }

    /// A stronger residual, to be met without the help of some atoms: their literals count as false. Recursion is bounded by
    /// the nesting of the formula.
    pub(crate) fn without(&mut self, residual: Residual, atoms: u64) -> Residual {
        self.strengthened(residual, atoms, &mut FxHashMap::default())
    }

    fn strengthened(
        &mut self,
        residual: Residual,
        atoms: u64,
        known: &mut FxHashMap<Residual, Residual>,
    ) -> Residual {
        if let Some(&stronger) = known.get(&residual) {
            return stronger;
        }
        let mut of = |all: &mut Self, part: Residual| all.strengthened(part, atoms, known);
        let stronger = match self.shapes[residual as usize].clone() {
            Shape::Literal { bit, .. } if atoms >> bit & 1 == 1 => FALSE,
            Shape::True | Shape::False | Shape::Literal { .. } => residual,
            ref shape @ (Shape::And(ref parts) | Shape::Or(ref parts)) => {
                let parts = parts.iter().map(|&part| of(self, part)).collect();
                self.join(matches!(shape, Shape::And(_)), parts)
            }
            Shape::Next { strong, then } => {
                let then = of(self, then);
                self.next(strong, then)
            }
            ref shape @ (Shape::Until(interval, left, right) | Shape::Release(interval, left, right)) => {
                let [left, right] = [left, right].map(|part| of(self, part));
                self.temporal(matches!(shape, Shape::Until(..)), interval, left, right)
            }
        };
        known.insert(residual, stronger);
        stronger
    }

    /// A weaker residual that reads settling atoms only.
    fn only_settling(&mut self, residual: Residual, known: &mut FxHashMap<Residual, Residual>) -> Residual {
        if let Some(&weaker) = known.get(&residual) {
            return weaker;
        }
        let shape = self.shapes[residual as usize].clone();
        let weaker = match shape {
            Shape::Literal { bit, .. } if self.settling.known >> bit & 1 == 1 => residual,
            Shape::And(ref parts) | Shape::Or(ref parts) => {
                let parts = parts.iter().map(|&part| self.only_settling(part, known)).collect();
                self.join(matches!(shape, Shape::And(_)), parts)
            }
            Shape::False => FALSE,
            Shape::True
            | Shape::Literal { .. }
            | Shape::Next { .. }
            | Shape::Until(..)
            | Shape::Release(..) => TRUE,
        };
        known.insert(residual, weaker);
        weaker
    }

    /// Whether a residual can still be met once the settling atoms are known, as far as they tell.
    pub(crate) fn can_hold(&self, residual: Residual) -> bool {
        self.outlooks[residual as usize].0
    }

    /// Whether nothing is owed any more but that something be never the case.
    pub(crate) fn owes_nothing(&self, residual: Residual) -> bool {
        self.outlooks[residual as usize].1
    }

    /// Whether a residual of this shape can still be met, and whether nothing is owed, from what is known of its parts.
    pub(super) fn outlook(&self, shape: &Shape) -> (bool, bool) {
        let of = |part: &Residual| self.outlooks[*part as usize];
        match shape {
            Shape::True => (true, true),
            Shape::False => (false, false),
            Shape::Literal { bit, positive } => self.settling.literal(*bit, *positive),
            Shape::And(parts) => parts.iter().map(of).fold((true, true), |a, b| (a.0 && b.0, a.1 && b.1)),
            Shape::Or(parts) => parts.iter().map(of).fold((false, false), |a, b| (a.0 || b.0, a.1 || b.1)),
            Shape::Next { strong: false, .. } => (true, true),
            Shape::Next { strong: true, then: part } | Shape::Until(_, _, part) => of(part),
            // A trace may end before the interval begins.
            Shape::Release(interval, _, right) => {
                let holds = of(right).0;
                (interval.lo > 0 || holds, holds)
            }
        }
    }
}
