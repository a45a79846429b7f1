//! Terms as circuits of literals: bits for bit-vectors and enumerations, gates for operators.
//!
//! [`cnf`] walks over terms, [`bits`] has the circuits of bit-vector operations, and a [`Sink`] is told what each literal
//! is: a SAT solver gets clauses, a file in QCIR gates. What quantifiers bind, and in which order, [`prefix`] says.

mod bits;
mod budget;
mod cnf;
mod prefix;

use std::ops::Not;

use crate::error::Error;

pub(crate) use budget::{Budget, Halt, Memory};
pub(crate) use cnf::{Cnf, width};
pub(crate) use prefix::Prefix;

/// The direction "the literal implies what it stands for".
pub(crate) const POSITIVE: u8 = 1;
/// The direction "what the literal stands for implies it".
pub(crate) const NEGATIVE: u8 = 2;
pub(crate) const BOTH: u8 = 3;

/// A literal: the number of a variable, from 1 on, negative where it is negated.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) struct Lit(i32);

impl Lit {
    /// The one that is true.
    pub(crate) const TOP: Lit = Lit(1);

    /// The literal of a variable, which is not 0.
    pub(crate) fn new(variable: i32) -> Lit {
        Lit(variable)
    }

    pub(crate) fn number(self) -> i32 {
        self.0
    }

    pub(crate) fn variable(self) -> u32 {
        self.0.unsigned_abs()
    }
}

impl Not for Lit {
    type Output = Lit;

    fn not(self) -> Lit {
        Lit(-self.0)
    }
}

/// What a literal stands for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Gate<'a> {
    /// All of these.
    And(&'a [Lit]),
    /// Both or none.
    Iff(Lit, Lit),
    /// The second where the first is true, else the third.
    Mux(Lit, Lit, Lit),
    /// At least two of three.
    Majority(Lit, Lit, Lit),
}

/// Who is told what literals are.
pub(crate) trait Sink {
    /// Whether terms may have quantifiers.
    const QUANTIFIERS: bool;

    /// That terms have what is not supported.
    fn unsupported(what: &str) -> Error;

    /// One of these is true.
    fn clause(&mut self, literals: &[Lit]);

    /// How many clauses it has.
    fn size(&self) -> usize;

    /// What a literal stands for, in some directions at least: by default, clauses.
    fn define(&mut self, g: Lit, gate: Gate<'_>, directions: u8) {
        let mut clauses = |positive: &[&[Lit]], negative: &[&[Lit]]| {
            let mut clause = Vec::with_capacity(4);
            for (direction, condition, bodies) in [(POSITIVE, !g, positive), (NEGATIVE, g, negative)] {
                for body in bodies.iter().filter(|_| directions & direction != 0) {
                    clause.clear();
                    clause.push(condition);
                    clause.extend_from_slice(body);
                    self.clause(&clause);
                }
            }
        };
        match gate {
            Gate::And(conjuncts) => {
                for &literal in conjuncts.iter().filter(|_| directions & POSITIVE != 0) {
                    self.clause(&[!g, literal]);
                }
                if directions & NEGATIVE != 0 {
                    let mut clause: Vec<Lit> = conjuncts.iter().map(|&literal| !literal).collect();
                    clause.push(g);
                    self.clause(&clause);
                }
            }
            Gate::Iff(a, b) => clauses(&[&[!a, b], &[a, !b]], &[&[a, b], &[!a, !b]]),
            // The last clause of each is implied; it helps propagation.
            Gate::Mux(c, a, b) => {
                clauses(&[&[!c, a], &[c, b], &[a, b]], &[&[!c, !a], &[c, !b], &[!a, !b]]);
            }
            Gate::Majority(a, b, c) => {
                clauses(&[&[a, b], &[a, c], &[b, c]], &[&[!a, !b], &[!a, !c], &[!b, !c]]);
            }
        }
    }
}
