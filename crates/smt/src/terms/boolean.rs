//! Boolean constructors, equality and if-then-else.

use super::Terms;
use crate::term::{Op, Sort, Term};

/// A conjunct that is itself a conjunction is merged into its parent up to this many arguments:
/// enough to keep terms shallow, and too few for chains to become quadratic.
const FLATTEN: usize = 8;

impl Terms {
    /// Conjunction.
    pub fn and(&mut self, ts: &[Term]) -> Term {
        let mut conjuncts = std::mem::take(&mut self.scratch);
        conjuncts.clear();
        for &t in ts {
            self.add_conjunct(&mut conjuncts, t);
        }
        let result = self.and_of(&mut conjuncts);
        self.scratch = conjuncts;
        result
    }

    /// Disjunction.
    pub fn or(&mut self, ts: &[Term]) -> Term {
        let mut conjuncts = std::mem::take(&mut self.scratch);
        conjuncts.clear();
        for &t in ts {
            self.add_conjunct(&mut conjuncts, !t);
        }
        let result = self.and_of(&mut conjuncts);
        self.scratch = conjuncts;
        !result
    }

    fn add_conjunct(&self, conjuncts: &mut Vec<Term>, t: Term) {
        self.check_bool("and", t);
        let inner = if t.is_negated() || self.op(t) != Op::And { &[] } else { self.children(t) };
        if (1..=FLATTEN).contains(&inner.len()) {
            conjuncts.extend_from_slice(inner);
        } else {
            conjuncts.push(t);
        }
    }

    /// The conjunction of what is left after sorting and folding.
    fn and_of(&mut self, conjuncts: &mut Vec<Term>) -> Term {
        conjuncts.sort_unstable();
        conjuncts.dedup();
        // The constants sort first, and a term sorts next to its complement.
        if conjuncts.first() == Some(&Term::TRUE) {
            conjuncts.remove(0);
        }
        if conjuncts.first() == Some(&Term::FALSE) || conjuncts.windows(2).any(|w| w[0] == !w[1]) {
            return Term::FALSE;
        }
        match conjuncts[..] {
            [] => Term::TRUE,
            [only] => only,
            _ => self.intern(Op::And, Sort::Bool, conjuncts),
        }
    }

    /// Conjunction of two.
    pub fn and2(&mut self, a: Term, b: Term) -> Term {
        self.and(&[a, b])
    }

    /// Disjunction of two.
    pub fn or2(&mut self, a: Term, b: Term) -> Term {
        self.or(&[a, b])
    }

    /// Implication.
    pub fn implies(&mut self, a: Term, b: Term) -> Term {
        self.or(&[!a, b])
    }

    /// Whether both are true or both are false.
    pub fn iff(&mut self, a: Term, b: Term) -> Term {
        self.check_bool("iff", a);
        self.check_bool("iff", b);
        let negate = a.is_negated() ^ b.is_negated();
        let (mut a, mut b) = (a.positive(), b.positive());
        if a > b {
            (a, b) = (b, a);
        }
        let result = if a == b {
            Term::TRUE
        } else if a == Term::TRUE {
            b
        } else {
            self.intern(Op::Eq, Sort::Bool, &[a, b])
        };
        result.negate_if(negate)
    }

    /// Exclusive or.
    pub fn xor(&mut self, a: Term, b: Term) -> Term {
        !self.iff(a, b)
    }

    /// `a` where `c` holds, else `b`; of any sort.
    pub fn ite(&mut self, c: Term, a: Term, b: Term) -> Term {
        self.check_bool("ite", c);
        let sort = self.same_sort("ite", a, b);
        let (c, a, b) = if c.is_negated() { (!c, b, a) } else { (c, a, b) };
        if c == Term::TRUE || a == b {
            return a;
        }
        if sort == Sort::Bool { self.bool_ite(c, a, b) } else { self.intern(Op::Ite, sort, &[c, a, b]) }
    }

    fn bool_ite(&mut self, c: Term, a: Term, b: Term) -> Term {
        if a == !b {
            return self.iff(c, a);
        }
        if a == Term::TRUE || a == c {
            return self.or2(c, b);
        }
        if a == Term::FALSE || a == !c {
            return self.and2(!c, b);
        }
        if b == Term::TRUE || b == !c {
            return self.or2(!c, a);
        }
        if b == Term::FALSE || b == c {
            return self.and2(c, a);
        }
        let negate = a.is_negated();
        let node = self.intern(Op::Ite, Sort::Bool, &[c, a.negate_if(negate), b.negate_if(negate)]);
        node.negate_if(negate)
    }

    /// Equality of any sort.
    pub fn eq(&mut self, a: Term, b: Term) -> Term {
        if self.same_sort("=", a, b) == Sort::Bool {
            return self.iff(a, b);
        }
        if a == b {
            return Term::TRUE;
        }
        // Equal constants are the same term.
        if self.op(a) == Op::Const && self.op(b) == Op::Const {
            return Term::FALSE;
        }
        // A constant comes last, for readers.
        let (a, b) = (a.min(b), a.max(b));
        let (a, b) = if self.op(a) == Op::Const { (b, a) } else { (a, b) };
        self.intern(Op::Eq, Sort::Bool, &[a, b])
    }

    /// Panics unless the term is Boolean.
    #[inline]
    pub(crate) fn assert_bool(&self, t: Term) {
        self.check_bool("assert", t);
    }

    #[inline]
    pub(super) fn check_bool(&self, what: &str, t: Term) {
        let sort = self.sort(t);
        assert!(sort == Sort::Bool, "{what}: a Bool is needed, not {sort}");
    }
}
