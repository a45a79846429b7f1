//! Gates: literals with constants folded, and the circuits of bit-vector operations on them.
//! Bits are in order of weight, the lowest first.

use super::{BOTH, Gate, Lit, Sink};

/// What all SAT solvers take: some double the numbers.
const MOST_VARIABLES: i32 = i32::MAX / 2;

/// Makes literals, and says what they are.
pub(crate) struct Gates<S> {
    /// Who is told.
    pub(crate) sink: S,
    /// How many variables there are.
    variables: i32,
    /// A literal that is true.
    top: Lit,
}

impl<S: Sink> Gates<S> {
    pub(crate) fn new(mut sink: S) -> Gates<S> {
        sink.clause(&[Lit::TOP]);
        Gates { sink, variables: 1, top: Lit::TOP }
    }

    /// How many variables there are, from 1 on.
    pub(crate) fn variables(&self) -> usize {
        self.variables as usize
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

    /// The literal of a gate.
    fn gate(&mut self, gate: Gate<'_>) -> Lit {
        let literal = self.fresh();
        self.sink.define(literal, gate, BOTH);
        literal
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
        self.gate(Gate::And(&[a, b]))
    }

    fn xor(&mut self, a: Lit, b: Lit) -> Lit {
        match (self.value(a), self.value(b)) {
            (Some(a), _) => return if a { !b } else { b },
            (_, Some(b)) => return if b { !a } else { a },
            _ if a == b => return self.constant(false),
            _ if a == !b => return self.constant(true),
            _ => {}
        }
        !self.gate(Gate::Iff(a, b))
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
        self.gate(Gate::Mux(c, a, b))
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
        self.gate(Gate::Majority(a, b, c))
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
