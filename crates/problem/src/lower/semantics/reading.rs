//! One reading of a formula: what is assumed beyond the trace, and the translation under it.

use super::builder::Builder;
use super::demand::Demand;
use super::literals::reads_actions;
use crate::formula::{Formula, Interval, Node};
use crate::ids::FormulaId;
use typed_index_collections::{TiSlice, TiVec};

/// What holds at the positions beyond K.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beyond {
    /// Every subformula, or none.
    Constant(bool),
    /// What holds of the states at K; literals that read actions, or none of them.
    Repeated { actions: bool },
}

pub(super) struct Reading<'a> {
    /// Its atoms are literals.
    pub(super) source: &'a Formula,
    pub(super) demands: &'a TiSlice<FormulaId, Demand>,
    pub(super) steps: u32,
    pub(super) beyond: Beyond,
}

/// A subformula or its negation.
#[derive(Clone, Copy)]
struct Reads {
    /// At positions up to K.
    now: FormulaId,
    /// At positions beyond, to be read at K.
    later: FormulaId,
}

const FALSE: Reads = Reads { now: Builder::FALSE, later: Builder::FALSE };

/// The negation of each subformula, and it itself; `FALSE` where it is not needed.
type Done = TiVec<FormulaId, [Reads; 2]>;

impl Reading<'_> {
    /// The whole formula at position 0.
    pub(super) fn root(&self, builder: &mut Builder) -> FormulaId {
        let mut done: Done = TiVec::with_capacity(self.source.nodes.len());
        for (id, &Demand { signs, position }) in self.demands.iter_enumerated() {
            builder.at(self.source.spans[id]);
            let mut both = [FALSE; 2];
            for sign in [false, true].into_iter().filter(|&sign| signs[usize::from(sign)]) {
                both[usize::from(sign)] = self.node(builder, id, sign, position, &done);
            }
            done.push(both);
        }
        done[self.source.root()][1].now
    }

    fn node(&self, builder: &mut Builder, id: FormulaId, sign: bool, at: Option<u32>, done: &Done) -> Reads {
        let of = |id: FormulaId, sign: bool| done[id][usize::from(sign)];
        match &self.source.nodes[id] {
            Node::Atom(expr) => {
                let atom = builder.atom(id, expr);
                let now = if sign { atom } else { builder.not(atom) };
                let later = match self.beyond {
                    Beyond::Constant(holds) => Builder::constant(holds),
                    Beyond::Repeated { actions } if reads_actions(expr) => Builder::constant(actions),
                    Beyond::Repeated { .. } => now,
                };
                Reads { now, later }
            }
            Node::Not(a) => of(*a, !sign),
            Node::And(ids) | Node::Or(ids) => {
                let parts: Vec<Reads> = ids.iter().map(|&id| of(id, sign)).collect();
                self.join(builder, matches!(self.source.nodes[id], Node::And(_)) == sign, &parts)
            }
            Node::Iff(a, b) => {
                let left = self.join(builder, true, &[of(*a, true), of(*b, sign)]);
                let right = self.join(builder, true, &[of(*a, false), of(*b, !sign)]);
                self.join(builder, false, &[left, right])
            }
            Node::Next(a) | Node::WeakNext(a) => self.next(builder, of(*a, sign), at),
            Node::Until(interval, a, b) => {
                self.until(builder, sign, *interval, at, of(*a, sign), of(*b, sign))
            }
            Node::Release(interval, a, b) => {
                self.until(builder, !sign, *interval, at, of(*a, sign), of(*b, sign))
            }
        }
    }

    /// A conjunction, or a disjunction.
    fn join(&self, builder: &mut Builder, and: bool, parts: &[Reads]) -> Reads {
        let mut all = |part: fn(&Reads) -> FormulaId| {
            let parts: Vec<FormulaId> = parts.iter().map(part).collect();
            builder.join(and, &parts)
        };
        let now = all(|p| p.now);
        let later = match self.beyond {
            Beyond::Constant(holds) if !parts.is_empty() => Builder::constant(holds),
            // Without parts it is part of what an operator means, and no subformula.
            Beyond::Constant(_) | Beyond::Repeated { .. } => all(|p| p.later),
        };
        Reads { now, later }
    }

    fn next(&self, builder: &mut Builder, a: Reads, at: Option<u32>) -> Reads {
        let now = match at {
            Some(position) if position < self.steps && a.now == Builder::TRUE => a.now,
            Some(position) if position < self.steps => builder.next(a.now),
            // Beyond K it is not read at all.
            Some(_) => a.later,
            None => {
                let last = builder.last();
                let (step, end) = (builder.next(a.now), builder.and(&[last, a.later]));
                builder.or(&[step, end])
            }
        };
        Reads { now, later: a.later }
    }

    /// `left U[a,b] right` (`strong`) or `left R[a,b] right`, as the head of the module derives them.
    fn until(
        &self,
        builder: &mut Builder,
        strong: bool,
        interval: Interval,
        at: Option<u32>,
        left: Reads,
        right: Reads,
    ) -> Reads {
        let Interval { lo, hi } = interval;
        let ends_inside = hi.map_or(Builder::FALSE, |hi| self.exists(builder, at, hi));
        let begins_before = lo.checked_sub(1).map_or(Builder::TRUE, |n| self.exists(builder, at, n));
        // Where no step of the interval can be one of the trace, its part on the trace says nothing.
        let outside_only = at.unwrap_or(0).saturating_add(lo) > self.steps;
        let (end_left, end_right) = (end(builder, left.later), end(builder, right.later));
        let now = if strong {
            let inside =
                if outside_only { Builder::FALSE } else { builder.until(interval, left.now, right.now) };
            let reaches_out = builder.not(ends_inside);
            let stay = builder.globally(Interval::ALWAYS, left.now);
            let wait = builder.or(&[begins_before, end_left]);
            let outside = builder.and(&[reaches_out, stay, end_right, wait]);
            builder.or(&[inside, outside])
        } else {
            let inside =
                if outside_only { Builder::TRUE } else { builder.release(interval, left.now, right.now) };
            let released = builder.finally(Interval::ALWAYS, left.now);
            let begins_out = builder.not(begins_before);
            let released_there = builder.and(&[begins_out, end_left]);
            let outside = builder.or(&[ends_inside, released, end_right, released_there]);
            builder.and(&[inside, outside])
        };
        let wait = if lo == 0 { Builder::constant(strong) } else { left.later };
        let later = match self.beyond {
            Beyond::Constant(holds) => Builder::constant(holds),
            Beyond::Repeated { .. } => builder.join(strong, &[right.later, wait]),
        };
        Reads { now, later }
    }

    /// Whether the position so many steps from now is one of the trace; where now is, if that is known.
    fn exists(&self, builder: &mut Builder, at: Option<u32>, ahead: u32) -> FormulaId {
        match at.unwrap_or(0).checked_add(ahead) {
            Some(position) if position <= self.steps && (at.is_some() || ahead == 0) => Builder::TRUE,
            Some(position) if position <= self.steps => {
                builder.finally(Interval { lo: ahead, hi: Some(ahead) }, Builder::TRUE)
            }
            _ => Builder::FALSE,
        }
    }
}

/// `later`, which is to be read at K, from any position.
fn end(builder: &mut Builder, later: FormulaId) -> FormulaId {
    if later == Builder::TRUE || later == Builder::FALSE {
        return later;
    }
    let last = builder.last();
    let at_end = builder.and(&[last, later]);
    builder.finally(Interval::ALWAYS, at_end)
}
