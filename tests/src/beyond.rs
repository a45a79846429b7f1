//! `semantics pes | opt | hpes | hopt` by their definition: the negation normal form, read at positions of the trace
//! and beyond.

use crate::brute::{Brute, Path};
use crate::model::{Formula, Interval, Semantics};

/// What holds beyond the trace.
#[derive(Clone, Copy)]
enum Beyond {
    /// Every formula, or none.
    Constant(bool),
    /// The states stay what they are; atoms that read actions, and their negations, all hold or none does.
    Repeated(bool),
}

struct Reading<'a> {
    brute: &'a Brute<'a>,
    paths: &'a [&'a Path],
    beyond: Beyond,
}

impl Brute<'_> {
    /// The formula's truth on one choice of paths.
    #[must_use]
    pub fn holds_under(&self, semantics: Semantics, formula: &Formula, paths: &[&Path]) -> bool {
        let halting = matches!(semantics, Semantics::Hpes | Semantics::Hopt);
        let hopeful = matches!(semantics, Semantics::Opt | Semantics::Hopt);
        let beyond = if halting && paths.iter().all(|path| self.halted(path.states[self.steps])) {
            Beyond::Repeated(hopeful)
        } else {
            Beyond::Constant(hopeful)
        };
        Reading { brute: self, paths, beyond }.holds(formula, true, 0)
    }

    /// Whether no transition of a state leads to another.
    fn halted(&self, state: usize) -> bool {
        !self.edges.iter().any(|&(from, _, to)| from == state && to != state)
    }
}

impl Reading<'_> {
    /// Whether the formula, or (without `want`) its negation, holds at a position.
    fn holds(&self, formula: &Formula, want: bool, t: usize) -> bool {
        let end = self.brute.steps;
        if let (true, Beyond::Constant(holds)) = (t > end, self.beyond) {
            return holds;
        }
        let all = |fs: &[Formula]| fs.iter().all(|f| self.holds(f, want, t));
        let any = |fs: &[Formula]| fs.iter().any(|f| self.holds(f, want, t));
        let from_now = |i: &Interval| i.map(|(_, hi)| (0, hi));
        match (formula, want) {
            (Formula::Atom(atom), _) => match self.beyond {
                Beyond::Repeated(holds) if t > end && atom.reads_actions() => holds,
                _ => atom.parts().map_or_else(
                    || self.brute.atom(atom, self.paths, t.min(end)) == want,
                    |parts| self.holds(&parts, want, t),
                ),
            },
            (Formula::Not(a), _) => self.holds(a, !want, t),
            (Formula::And(fs), true) | (Formula::Or(fs), false) => all(fs),
            (Formula::Or(fs), true) | (Formula::And(fs), false) => any(fs),
            (Formula::Implies(a, b), true) => self.holds(a, false, t) || self.holds(b, true, t),
            (Formula::Implies(a, b), false) => self.holds(a, true, t) && self.holds(b, false, t),
            (Formula::Iff(a, b), _) => {
                (self.holds(a, true, t) && self.holds(b, want, t))
                    || (self.holds(a, false, t) && self.holds(b, !want, t))
            }
            (Formula::Next(a) | Formula::WeakNext(a), _) => self.holds(a, want, t + 1),
            (Formula::Finally(i, a), true) | (Formula::Globally(i, a), false) => self.some(i, a, want, t),
            (Formula::Globally(i, a), true) | (Formula::Finally(i, a), false) => self.every(i, a, want, t),
            (Formula::Until(i, a, b), true) | (Formula::Release(i, a, b), false) => {
                self.until(i, a, b, want, t)
            }
            (Formula::Release(i, a, b), true) | (Formula::Until(i, a, b), false) => {
                self.release(i, a, b, want, t)
            }
            (Formula::WeakUntil(i, a, b), true) => {
                self.until(i, a, b, true, t) || self.every(&from_now(i), a, true, t)
            }
            (Formula::WeakUntil(i, a, b), false) => {
                self.release(i, a, b, false, t) && self.some(&from_now(i), a, false, t)
            }
            (Formula::StrongRelease(i, a, b), true) => {
                self.window(i, t).any(|j| self.holds(a, true, j) && (t..=j).all(|k| self.holds(b, true, k)))
            }
            (Formula::StrongRelease(i, a, b), false) => {
                self.window(i, t).all(|j| self.holds(a, false, j) || (t..=j).any(|k| self.holds(b, false, k)))
            }
        }
    }

    /// The positions of an interval. All positions beyond the trace are alike, so that without an end the first of
    /// them will do.
    fn window(&self, interval: &Interval, t: usize) -> std::ops::RangeInclusive<usize> {
        match *interval {
            Some((lo, hi)) => t + lo as usize..=t + hi as usize,
            None => t..=t.max(self.brute.steps + 1),
        }
    }

    fn some(&self, interval: &Interval, a: &Formula, want: bool, t: usize) -> bool {
        self.window(interval, t).any(|j| self.holds(a, want, j))
    }

    fn every(&self, interval: &Interval, a: &Formula, want: bool, t: usize) -> bool {
        self.window(interval, t).all(|j| self.holds(a, want, j))
    }

    fn until(&self, interval: &Interval, a: &Formula, b: &Formula, want: bool, t: usize) -> bool {
        self.window(interval, t).any(|j| self.holds(b, want, j) && (t..j).all(|k| self.holds(a, want, k)))
    }

    fn release(&self, interval: &Interval, a: &Formula, b: &Formula, want: bool, t: usize) -> bool {
        self.window(interval, t).all(|j| self.holds(b, want, j) || (t..j).any(|k| self.holds(a, want, k)))
    }
}
