//! Unrolls a formula over time into a term, linear in the horizon for every operator.
//!
//! A bounded operator is a window that slides over time. Time is cut into blocks of the window's length; each
//! window is a suffix of one block and a prefix of the next, so that prefixes and suffixes, each shared by all
//! windows that need it, are all there is to build. A sliding `F[0,b]` would otherwise cost a factor of `b`.
//!
//! `R` is `U` through duality: negation of a term costs nothing.

use hyperplan_problem::{Expr, Formula, FormulaId, Interval, Mode, Node, PathLeaf};
use hyperplan_relevance::Goal;
use hyperplan_smt::{Term, Terms};
use rustc_hash::FxHashMap;

/// Gives the term of an atom at a time. Under `within K` times are `0..=K`; in bounded mode no path is asked about
/// beyond its horizon.
pub(crate) trait AtomTerms {
    fn atom(&mut self, terms: &mut Terms, atom: (FormulaId, &Expr<PathLeaf>), time: u32) -> Term;
}

/// The unrolling of one formula over one choice of paths.
pub(crate) struct Unroller<'a, A> {
    formula: &'a Formula,
    mode: Mode,
    atoms: A,
    memo: FxHashMap<(FormulaId, u32), Term>,
    windows: FxHashMap<(Window, u32), Term>,
}

/// An operand of a window: a subformula or its negation, or `true`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Operand {
    True,
    Is(FormulaId),
    Not(FormulaId),
}

/// Values along the blocks of windows of one length, for `left U right`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Window {
    part: Part,
    length: u32,
    left: Operand,
    right: Operand,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Part {
    /// `left U right` from here, `right` no later than the block's end.
    UntilToEnd,
    /// `left` from here to the block's end.
    AlwaysToEnd,
    /// `left U right` from the block's start, `right` no later than here.
    UntilFromStart,
    /// `left` from the block's start to here.
    AlwaysFromStart,
}

impl<'a, A: AtomTerms> Unroller<'a, A> {
    pub(crate) fn new(formula: &'a Formula, mode: Mode, atoms: A) -> Self {
        Unroller { formula, mode, atoms, memo: FxHashMap::default(), windows: FxHashMap::default() }
    }

    /// A goal, at time 0.
    pub(crate) fn goal(&mut self, terms: &mut Terms, goal: &Goal) -> Term {
        let parts: Vec<Term> =
            goal.parts.iter().map(|&(id, want)| self.at(terms, id, 0).negate_if(!want)).collect();
        if goal.all { terms.and(&parts) } else { terms.or(&parts) }
    }

    /// The last position, where there is one.
    fn end(&self) -> Option<u32> {
        match self.mode {
            Mode::Within(steps) => Some(steps),
            Mode::Bounded => None,
        }
    }

    /// A subformula at a time. The recursion is over the formula's nesting, never over time.
    fn at(&mut self, terms: &mut Terms, id: FormulaId, time: u32) -> Term {
        if let Some(&known) = self.memo.get(&(id, time)) {
            return known;
        }
        let formula = self.formula;
        let term = match &formula.nodes[id] {
            Node::Atom(expr) => self.atoms.atom(terms, (id, expr), time),
            Node::Not(a) => !self.at(terms, *a, time),
            Node::And(ids) | Node::Or(ids) => {
                let parts: Vec<Term> = ids.iter().map(|&id| self.at(terms, id, time)).collect();
                if matches!(&formula.nodes[id], Node::And(_)) { terms.and(&parts) } else { terms.or(&parts) }
            }
            Node::Iff(a, b) => {
                let (a, b) = (self.at(terms, *a, time), self.at(terms, *b, time));
                terms.iff(a, b)
            }
            Node::Next(a) | Node::WeakNext(a) => {
                if self.end() == Some(time) {
                    if matches!(&formula.nodes[id], Node::WeakNext(_)) { Term::TRUE } else { Term::FALSE }
                } else {
                    self.at(terms, *a, time + 1)
                }
            }
            Node::Until(interval, a, b) => {
                let (left, right) = (self.operand(*a, true), self.operand(*b, true));
                self.until(terms, *interval, left, right, time)
            }
            Node::Release(interval, a, b) => {
                let (left, right) = (self.operand(*a, false), self.operand(*b, false));
                !self.until(terms, *interval, left, right, time)
            }
        };
        self.memo.insert((id, time), term);
        term
    }

    /// A subformula or its negation, as an operand.
    fn operand(&self, id: FormulaId, positive: bool) -> Operand {
        match (self.formula.constant(id), positive) {
            (Some(value), _) if value == positive => Operand::True,
            (_, true) => Operand::Is(id),
            (_, false) => Operand::Not(id),
        }
    }

    fn operand_at(&mut self, terms: &mut Terms, operand: Operand, time: u32) -> Term {
        match operand {
            Operand::True => Term::TRUE,
            Operand::Is(id) => self.at(terms, id, time),
            Operand::Not(id) => !self.at(terms, id, time),
        }
    }

    /// `left U[lo,hi] right` at a time.
    fn until(
        &mut self,
        terms: &mut Terms,
        interval: Interval,
        left: Operand,
        right: Operand,
        time: u32,
    ) -> Term {
        let Some(first) = time.checked_add(interval.lo).filter(|&f| self.end().is_none_or(|end| f <= end))
        else {
            return Term::FALSE;
        };
        let unclipped = interval.hi.map(|hi| time.saturating_add(hi));
        let last = match (unclipped, self.end()) {
            (Some(last), Some(end)) => last.min(end),
            (Some(last), None) => last,
            (None, Some(end)) => end,
            // An operator without a bound occurs only under `within`.
            (None, None) => first,
        };
        let length = match (interval.hi, self.end()) {
            (Some(hi), _) => hi - interval.lo + 1,
            (None, end) => end.unwrap_or(0).saturating_add(1),
        };
        let before = if interval.lo == 0 || left == Operand::True {
            Term::TRUE
        } else {
            self.always(terms, interval.lo, left, time, first - 1)
        };
        let from = Window { part: Part::UntilToEnd, length, left, right };
        let suffix = self.window(terms, from, first);
        let core = if first / length == last / length {
            suffix
        } else {
            let stay = self.window(terms, Window { part: Part::AlwaysToEnd, ..from }, first);
            let prefix = self.window(terms, Window { part: Part::UntilFromStart, ..from }, last);
            let through = terms.and2(stay, prefix);
            terms.or2(suffix, through)
        };
        terms.and2(before, core)
    }

    /// `operand` at every time of `first..=last`, a window of `length` steps.
    fn always(&mut self, terms: &mut Terms, length: u32, operand: Operand, first: u32, last: u32) -> Term {
        let window = Window { part: Part::AlwaysToEnd, length, left: operand, right: Operand::True };
        let suffix = self.window(terms, window, first);
        if first / length == last / length {
            return suffix;
        }
        let prefix = self.window(terms, Window { part: Part::AlwaysFromStart, ..window }, last);
        terms.and2(suffix, prefix)
    }

    /// One value of a window's prefixes or suffixes; fills in those that it needs, by a loop over the block.
    fn window(&mut self, terms: &mut Terms, window: Window, time: u32) -> Term {
        if let Some(&known) = self.windows.get(&(window, time)) {
            return known;
        }
        let start = time / window.length * window.length;
        let end = start.saturating_add(window.length - 1);
        let end = self.end().map_or(end, |last| end.min(last));
        match window.part {
            Part::UntilToEnd | Part::AlwaysToEnd => {
                for at in (time..=end).rev() {
                    self.fill(terms, window, at, (at < end).then(|| at + 1));
                }
            }
            Part::UntilFromStart | Part::AlwaysFromStart => {
                for at in start..=time {
                    self.fill(terms, window, at, (at > start).then(|| at - 1));
                }
            }
        }
        self.windows[&(window, time)]
    }

    /// Computes a window's value at `at` from that at the neighbouring time, which is there already.
    fn fill(&mut self, terms: &mut Terms, window: Window, at: u32, neighbour: Option<u32>) {
        if self.windows.contains_key(&(window, at)) {
            return;
        }
        let neighbour_value = neighbour.map(|n| self.windows[&(window, n)]);
        let value = match window.part {
            Part::AlwaysToEnd | Part::AlwaysFromStart => {
                let here = self.operand_at(terms, window.left, at);
                neighbour_value.map_or(here, |n| terms.and2(here, n))
            }
            Part::UntilToEnd => {
                let here = self.operand_at(terms, window.right, at);
                match neighbour_value {
                    None => here,
                    Some(later) => {
                        let left = self.operand_at(terms, window.left, at);
                        let wait = terms.and2(left, later);
                        terms.or2(here, wait)
                    }
                }
            }
            Part::UntilFromStart => {
                let here = self.operand_at(terms, window.right, at);
                match (neighbour_value, neighbour) {
                    (Some(earlier), Some(before)) => {
                        let stay = Window { part: Part::AlwaysFromStart, ..window };
                        let stay = self.window(terms, stay, before);
                        let now = terms.and2(stay, here);
                        terms.or2(earlier, now)
                    }
                    _ => here,
                }
            }
        };
        self.windows.insert((window, at), value);
    }
}
