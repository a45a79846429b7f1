//! Terms to clauses, incrementally: Tseitin's transformation by polarity (Plaisted and Greenbaum).
//!
//! A Boolean node gets a SAT variable when it is first needed. Its clauses in the direction "the
//! variable implies the node" are added once it occurs positively, those in the other direction
//! once it occurs negatively; both may come in different calls. The declared symbols' values in a
//! model satisfy the script, while inner variables need not equal their nodes.
//! Bit-vector terms become literals, one per bit, by circuits that hold in both directions.

use hyperplan_smt::{Op, Script, Sort, Term, Terms, Value, View};

use super::bits::Gates;
use super::budget::{Budget, Halt};
use super::{BOTH, Gate, Lit, NEGATIVE, POSITIVE, Sink};
use crate::error::Error;

/// How many clauses are added between two looks at the budget: a few milliseconds.
const STRIDE: usize = 1 << 12;

/// What of an arena has been turned into clauses.
pub(crate) struct Cnf<S> {
    pub(crate) gates: Gates<S>,
    /// Per node: the literal of a Boolean.
    literals: Vec<Option<Lit>>,
    /// Per node: the directions whose clauses were added.
    done: Vec<u8>,
    /// Per node: where in `bits` a bit-vector's literals start.
    starts: Vec<Option<u32>>,
    bits: Vec<Lit>,
    /// Assertions whose clauses are to be added.
    asserted: Vec<Term>,
    /// Nodes whose clauses are to be added, with the directions needed.
    pending: Vec<(Term, u8)>,
    clause: Vec<Lit>,
    /// How many clauses there will be when the budget is looked at next.
    look: usize,
}

impl<S: Sink> Cnf<S> {
    pub(crate) fn new(sink: S) -> Cnf<S> {
        Cnf {
            gates: Gates::new(sink),
            literals: Vec::new(),
            done: Vec::new(),
            starts: Vec::new(),
            bits: Vec::new(),
            asserted: Vec::new(),
            pending: Vec::new(),
            clause: Vec::new(),
            look: 0,
        }
    }

    /// Takes an assertion, a disjunction; [`Cnf::finish`] adds what clauses are missing.
    pub(crate) fn assert(&mut self, script: &Script, literals: &[Term]) {
        let terms = &script.terms;
        self.grow(terms);
        if let &[only] = literals {
            self.asserted.push(only);
        } else {
            self.assert_clause(terms, literals.iter().copied());
        }
    }

    /// The literal of a Boolean term that will be assumed to be true; [`Cnf::finish`] adds its clauses.
    pub(crate) fn assumption(&mut self, script: &Script, t: Term) -> Lit {
        self.grow(&script.terms);
        self.literal(&script.terms, t, POSITIVE)
    }

    /// The literal of a declared Boolean symbol, if it has occurred.
    pub(crate) fn known_literal(&self, symbol: Term) -> Option<Lit> {
        let literal = (*self.literals.get(symbol.index())?)?;
        Some(if symbol.is_negated() { !literal } else { literal })
    }

    /// The bits of a declared bit-vector symbol, if it has occurred.
    pub(crate) fn known_bits(&self, symbol: Term, width: u32) -> Option<&[Lit]> {
        let start = (*self.starts.get(symbol.index())?)? as usize;
        Some(&self.bits[start..start + width as usize])
    }

    fn grow(&mut self, terms: &Terms) {
        self.literals.resize(terms.len(), None);
        self.done.resize(terms.len(), 0);
        self.starts.resize(terms.len(), None);
    }

    /// Conjunctions at the top are taken apart, disjunctions become clauses.
    fn assert_one(&mut self, terms: &Terms, t: Term) {
        match terms.view(t) {
            View::App(Op::And, conjuncts) if !t.is_negated() => self.asserted.extend_from_slice(conjuncts),
            View::App(Op::And, conjuncts) => self.assert_clause(terms, conjuncts.iter().map(|&c| !c)),
            _ => self.assert_clause(terms, std::iter::once(t)),
        }
    }

    fn assert_clause(&mut self, terms: &Terms, literals: impl Iterator<Item = Term>) {
        let mut clause = std::mem::take(&mut self.clause);
        clause.clear();
        for t in literals {
            clause.push(self.literal(terms, t, POSITIVE));
        }
        self.gates.sink.clause(&clause);
        self.clause = clause;
    }

    /// The literal of a term that occurs with that polarity; its clauses become pending.
    fn literal(&mut self, terms: &Terms, t: Term, polarity: u8) -> Lit {
        if t.is_const() {
            return self.gates.constant(t == Term::TRUE);
        }
        let literal = match self.literals[t.index()] {
            Some(literal) => literal,
            None => {
                let fresh = self.gates.fresh();
                self.literals[t.index()] = Some(fresh);
                fresh
            }
        };
        let (literal, needed) = if t.is_negated() { (!literal, flip(polarity)) } else { (literal, polarity) };
        if needed & !self.done[t.index()] != 0 && !matches!(terms.op(t), Op::Symbol | Op::Bound) {
            self.pending.push((t.positive(), needed));
        }
        literal
    }

    /// Adds the clauses of everything asserted and assumed, and of what they need. Where it halts for want of time
    /// or memory, it can be called again.
    pub(crate) fn finish(&mut self, terms: &Terms, budget: &Budget) -> Result<(), Halt> {
        loop {
            self.afford(budget)?;
            if let Some((t, needed)) = self.pending.pop() {
                let missing = needed & !self.done[t.index()];
                if missing != 0 {
                    self.node(terms, t, missing, budget)?;
                }
            } else if let Some(t) = self.asserted.pop() {
                self.assert_one(terms, t);
            } else {
                return Ok(());
            }
        }
    }

    /// Looks at the budget now and then.
    fn afford(&mut self, budget: &Budget) -> Result<(), Halt> {
        if self.gates.sink.size() < self.look {
            return Ok(());
        }
        if budget.spent() {
            return Err(Halt::Spent);
        }
        self.look = self.gates.sink.size() + STRIDE;
        Ok(())
    }

    /// Adds the clauses of one Boolean node in the directions given, or leaves it pending.
    fn node(&mut self, terms: &Terms, t: Term, directions: u8, budget: &Budget) -> Result<(), Halt> {
        self.done[t.index()] |= directions;
        let v = self.literal(terms, t, 0);
        match terms.view(t) {
            View::App(Op::And, conjuncts) => self.conjunction(terms, v, conjuncts, directions),
            View::App(Op::Eq, &[a, b]) if terms.sort(a) == Sort::Bool => {
                let (a, b) = (self.literal(terms, a, BOTH), self.literal(terms, b, BOTH));
                self.gates.sink.define(v, Gate::Iff(a, b), directions);
            }
            View::App(Op::Ite, &[c, a, b]) => {
                let c = self.literal(terms, c, BOTH);
                let (a, b) = (self.literal(terms, a, directions), self.literal(terms, b, directions));
                self.gates.sink.define(v, Gate::Mux(c, a, b), directions);
            }
            View::App(op @ (Op::Eq | Op::BvUlt | Op::BvSlt), &[a, b]) => {
                let bits =
                    self.vector(terms, a, budget).and_then(|a| Ok((a, self.vector(terms, b, budget)?)));
                let (a, b) = bits.inspect_err(|_| {
                    self.done[t.index()] &= !directions;
                    self.pending.push((t, directions));
                })?;
                let g = match op {
                    Op::Eq => self.gates.equal(&a, &b),
                    _ => self.gates.less(&a, &b, op == Op::BvSlt),
                };
                self.gates.sink.define(v, Gate::And(&[g]), directions);
            }
            View::Forall(bound, body) if S::QUANTIFIERS => {
                self.quantified(terms, v, (bound, body), directions, budget)?;
            }
            View::Forall(..) => return Err(S::unsupported("quantifiers").into()),
            View::Apply(..) => return Err(S::unsupported("functions").into()),
            _ => return Err(S::unsupported("integers and reals").into()),
        }
        Ok(())
    }

    /// A quantifier, which the prefix has: what is left of it is its body, for those values of the variables that are some. The
    /// bits of an enumeration may be those of none.
    fn quantified(
        &mut self,
        terms: &Terms,
        v: Lit,
        (bound, body): (&[Term], Term),
        directions: u8,
        budget: &Budget,
    ) -> Result<(), Halt> {
        let mut against = vec![!self.literal(terms, body, directions)];
        for &variable in bound {
            let Sort::Enum(enumeration) = terms.sort(variable) else { continue };
            let bits = self.vector(terms, variable, budget)?;
            let beyond = self.beyond(terms.constructors(enumeration), &bits);
            against.push(!beyond);
        }
        self.gates.sink.define(!v, Gate::And(&against), flip(directions));
        Ok(())
    }

    fn conjunction(&mut self, terms: &Terms, v: Lit, conjuncts: &[Term], directions: u8) {
        let mut literals = std::mem::take(&mut self.clause);
        literals.clear();
        for &t in conjuncts {
            literals.push(self.literal(terms, t, directions));
        }
        self.gates.sink.define(v, Gate::And(&literals), directions);
        self.clause = literals;
    }

    /// The bits of a bit-vector term, after those of everything that it is built from.
    fn vector(&mut self, terms: &Terms, t: Term, budget: &Budget) -> Result<Vec<Lit>, Halt> {
        let mut stack = vec![t];
        while let Some(&t) = stack.last() {
            self.afford(budget)?;
            if self.starts[t.index()].is_some() {
                stack.pop();
                continue;
            }
            let before = stack.len();
            for &child in terms.children(t) {
                match terms.sort(child) {
                    Sort::BitVec(_) | Sort::Enum(_) if self.starts[child.index()].is_none() => {
                        stack.push(child)
                    }
                    Sort::BitVec(_) | Sort::Enum(_) | Sort::Bool => {}
                    Sort::Int | Sort::Real => return Err(S::unsupported("integers and reals").into()),
                }
            }
            if stack.len() == before {
                stack.pop();
                let bits = self.circuit(terms, t)?;
                self.starts[t.index()] = Some(self.bits.len() as u32);
                self.bits.extend(bits);
            }
        }
        Ok(self.bits_of(terms, t))
    }

    fn number(&self, bits: u128, width: u32) -> Vec<Lit> {
        (0..width).map(|i| self.gates.constant(bits >> i & 1 == 1)).collect()
    }

    /// Fresh bits; of an enumeration, those of some constructor.
    fn symbol(&mut self, terms: &Terms, t: Term, width: u32) -> Vec<Lit> {
        let bits: Vec<Lit> = (0..width).map(|_| self.gates.fresh()).collect();
        if let Sort::Enum(enumeration) = terms.sort(t) {
            let beyond = self.beyond(terms.constructors(enumeration), &bits);
            self.gates.sink.clause(&[!beyond]);
        }
        bits
    }

    /// Whether bits are those of no constructor.
    fn beyond(&mut self, constructors: u32, bits: &[Lit]) -> Lit {
        let last = self.number(u128::from(constructors - 1), bits.len() as u32);
        self.gates.less(&last, bits, false)
    }

    fn bits_of(&self, terms: &Terms, t: Term) -> Vec<Lit> {
        self.known_bits(t, width(terms, t)).unwrap_or_default().to_vec()
    }

    /// The circuit of one bit-vector node whose children have their bits.
    fn circuit(&mut self, terms: &Terms, t: Term) -> Result<Vec<Lit>, Error> {
        let width = width(terms, t);
        if width == 0 {
            return Err(S::unsupported("integers and reals"));
        }
        let bits = match terms.view(t) {
            View::Const(Value::Bv { bits, .. }) => self.number(bits, width),
            View::Const(Value::Enum(_, position)) => self.number(u128::from(position), width),
            View::Symbol(..) => self.symbol(terms, t, width),
            View::Bound(..) if S::QUANTIFIERS => (0..width).map(|_| self.gates.fresh()).collect(),
            View::Bound(..) | View::Forall(..) => return Err(S::unsupported("quantifiers")),
            View::Apply(..) => return Err(S::unsupported("functions")),
            View::Extend(op, a, by) => {
                let mut bits = self.bits_of(terms, a);
                let fill = match (op, bits.last()) {
                    (Op::SignExtend, Some(&sign)) => sign,
                    _ => self.gates.constant(false),
                };
                bits.extend(std::iter::repeat_n(fill, by as usize));
                bits
            }
            View::Extract(a, hi, lo) => self.bits_of(terms, a)[lo as usize..=hi as usize].to_vec(),
            View::App(Op::Ite, &[c, a, b]) => {
                let c = self.literal(terms, c, BOTH);
                let (a, b) = (self.bits_of(terms, a), self.bits_of(terms, b));
                self.gates.select(c, &a, &b)
            }
            View::App(Op::BvNeg, &[a]) => {
                let a = self.bits_of(terms, a);
                self.gates.negate(&a)
            }
            View::App(op, &[a, b]) => {
                let (a, b) = (self.bits_of(terms, a), self.bits_of(terms, b));
                match op {
                    Op::BvAdd => self.gates.add(&a, &b, self.gates.constant(false)),
                    Op::BvMul => self.gates.multiply(&a, &b),
                    _ => return Err(S::unsupported(op.name())),
                }
            }
            View::Const(_) | View::App(..) => return Err(S::unsupported("an operator")),
        };
        Ok(bits)
    }
}

/// How many bits stand for a term that is neither Boolean nor a number: a constructor's position is one.
pub(crate) fn width(terms: &Terms, t: Term) -> u32 {
    match terms.sort(t) {
        Sort::BitVec(width) => width,
        Sort::Enum(enumeration) => {
            (terms.constructors(enumeration) - 1).checked_ilog2().map_or(1, |log| log + 1)
        }
        Sort::Bool | Sort::Int | Sort::Real => 0,
    }
}

/// The polarity under a complement.
pub(super) fn flip(polarity: u8) -> u8 {
    (polarity & POSITIVE) << 1 | (polarity & NEGATIVE) >> 1
}
