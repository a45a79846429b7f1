//! Gates: literals with constants folded, and the circuits of bit-vector operations on them.
//! Bits are in order of weight, the lowest first.

use super::backend::Lit;
use super::worker::Worker;
use crate::session::QuerySize;

/// What all SAT solvers take: some double the numbers.
const MOST_VARIABLES: i32 = i32::MAX / 2;

/// Makes literals and clauses.
pub(super) struct Gates {
    pub(super) sat: Worker,
    /// How many variables there are.
    variables: i32,
    /// A literal that is true.
    top: Lit,
}

impl Gates {
    pub(super) fn new(mut sat: Worker) -> Gates {
        let top = Lit::new(1);
        sat.clause(&[top]);
        Gates { sat, variables: 1, top }
    }

    /// What the SAT solver was given.
    pub(super) fn size(&self) -> QuerySize {
        QuerySize { clauses: self.sat.clauses(), variables: self.variables as usize, ..QuerySize::default() }
    }

    pub(super) fn constant(&self, value: bool) -> Lit {
        if value { self.top } else { !self.top }
    }

    fn value(&self, literal: Lit) -> Option<bool> {
        (literal.variable() == self.top.variable()).then_some(literal == self.top)
    }

    pub(super) fn fresh(&mut self) -> Lit {
        assert!(self.variables < MOST_VARIABLES, "too many SAT variables");
        self.variables += 1;
        Lit::new(self.variables)
    }

    pub(super) fn and(&mut self, a: Lit, b: Lit) -> Lit {
        match (self.value(a), self.value(b)) {
            (Some(false), _) | (_, Some(false)) => return self.constant(false),
            (Some(true), _) => return b,
            (_, Some(true)) => return a,
            _ if a == b => return a,
            _ if a == !b => return self.constant(false),
            _ => {}
        }
        let g = self.fresh();
        self.sat.clause(&[!g, a]);
        self.sat.clause(&[!g, b]);
        self.sat.clause(&[g, !a, !b]);
        g
    }

    fn xor(&mut self, a: Lit, b: Lit) -> Lit {
        match (self.value(a), self.value(b)) {
            (Some(a), _) => return if a { !b } else { b },
            (_, Some(b)) => return if b { !a } else { a },
            _ if a == b => return self.constant(false),
            _ if a == !b => return self.constant(true),
            _ => {}
        }
        let g = self.fresh();
        self.sat.clause(&[!g, a, b]);
        self.sat.clause(&[!g, !a, !b]);
        self.sat.clause(&[g, !a, b]);
        self.sat.clause(&[g, a, !b]);
        g
    }

    fn mux(&mut self, c: Lit, a: Lit, b: Lit) -> Lit {
        match self.value(c) {
            Some(true) => return a,
            Some(false) => return b,
            None if a == b => return a,
            None if a == !b => return !self.xor(c, a),
            None => {}
        }
        if self.value(a).is_some() || self.value(b).is_some() {
            let (then, other) = (self.and(c, a), self.and(!c, b));
            return !self.and(!then, !other);
        }
        let g = self.fresh();
        self.sat.clause(&[!c, !a, g]);
        self.sat.clause(&[!c, a, !g]);
        self.sat.clause(&[c, !b, g]);
        self.sat.clause(&[c, b, !g]);
        self.sat.clause(&[!a, !b, g]);
        self.sat.clause(&[a, b, !g]);
        g
    }

    /// Whether at least two of three are true.
    fn majority(&mut self, a: Lit, b: Lit, c: Lit) -> Lit {
        for (x, y, z) in [(a, b, c), (b, a, c), (c, a, b)] {
            match self.value(x) {
                Some(true) => return !self.and(!y, !z),
                Some(false) => return self.and(y, z),
                None if y == z => return y,
                None if y == !z => return x,
                None => {}
            }
        }
        let g = self.fresh();
        for (x, y) in [(a, b), (a, c), (b, c)] {
            self.sat.clause(&[!x, !y, g]);
            self.sat.clause(&[x, y, !g]);
        }
        g
    }

    /// The sum of two and a carry, modulo 2^width.
    pub(super) fn add(&mut self, a: &[Lit], b: &[Lit], mut carry: Lit) -> Vec<Lit> {
        let mut sum = Vec::with_capacity(a.len());
        for (i, (&x, &y)) in a.iter().zip(b).enumerate() {
            let half = self.xor(x, y);
            sum.push(self.xor(half, carry));
            if i + 1 < a.len() {
                carry = self.majority(x, y, carry);
            }
        }
        sum
    }

    pub(super) fn negate(&mut self, a: &[Lit]) -> Vec<Lit> {
        let inverted: Vec<Lit> = a.iter().map(|&x| !x).collect();
        let zero = vec![self.constant(false); a.len()];
        self.add(&inverted, &zero, self.constant(true))
    }

    /// The product modulo 2^width: shift and add.
    pub(super) fn multiply(&mut self, a: &[Lit], b: &[Lit]) -> Vec<Lit> {
        let mut product = vec![self.constant(false); a.len()];
        for (shift, &x) in a.iter().enumerate() {
            if self.value(x) == Some(false) {
                continue;
            }
            let row: Vec<Lit> = b[..b.len() - shift].iter().map(|&y| self.and(x, y)).collect();
            let sum = self.add(&product[shift..], &row, self.constant(false));
            product.splice(shift.., sum);
        }
        product
    }

    pub(super) fn select(&mut self, c: Lit, a: &[Lit], b: &[Lit]) -> Vec<Lit> {
        a.iter().zip(b).map(|(&x, &y)| self.mux(c, x, y)).collect()
    }

    pub(super) fn equal(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        let mut all = self.constant(true);
        for (&x, &y) in a.iter().zip(b) {
            let differ = self.xor(x, y);
            all = self.and(all, !differ);
        }
        all
    }

    /// Less-than; the sign bit, where there is one, counts the other way round.
    pub(super) fn less(&mut self, a: &[Lit], b: &[Lit], signed: bool) -> Lit {
        let mut less = self.constant(false);
        for (i, (&x, &y)) in a.iter().zip(b).enumerate() {
            let (x, y) = if signed && i + 1 == a.len() { (y, x) } else { (x, y) };
            less = self.majority(!x, y, less);
        }
        less
    }
}
