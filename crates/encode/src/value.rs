//! Expressions as terms.
//!
//! A number is a list of cases (value, when) where the states of its path are enumerated, and a bit-vector or an
//! integer or real term where they are not. The conditions of a list of cases exclude each other and cover everything *on the assumption that
//! the path is a path*, which every use is guarded by.

use hyperplan_problem::{Comparison, Expr, TupleSet, Value};
use hyperplan_smt::{Rational, Sort, Term, Terms};
use hyperplan_space::code;
use std::collections::BTreeMap;

/// The value of an expression at one time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Val {
    /// A truth value.
    Bool(Term),
    /// A number (or an enumeration value's position): each value with its condition, by value.
    Cases(Vec<(i64, Term)>),
    /// A signed bit-vector, and bounds of the number that it stands for.
    Bits {
        /// The bit-vector.
        term: Term,
        /// The lower bound.
        lo: i64,
        /// The upper bound.
        hi: i64,
    },
    /// A term of sort Int or Real.
    Number(Term),
}

/// Where the leaves of an expression come from.
pub(crate) trait Leaves<L> {
    /// The value of a leaf.
    fn leaf(&mut self, terms: &mut Terms, leaf: &L) -> Val;

    /// The value of a whole expression, where there is a shorter way than through its parts.
    fn whole(&mut self, terms: &mut Terms, expr: &Expr<L>) -> Option<Val>;
}

/// A number known to be `value`.
pub(crate) fn constant(value: i64) -> Val {
    Val::Cases(vec![(value, Term::TRUE)])
}

/// The least width of a signed bit-vector that holds `lo..=hi`.
pub(crate) fn width(lo: i64, hi: i64) -> u32 {
    let bits = |v: i64| if v < 0 { 65 - (!v).leading_zeros() } else { 65 - v.leading_zeros() };
    bits(lo).max(bits(hi))
}

/// A fraction as the terms have it.
fn rational(value: hyperplan_problem::Rational) -> Rational {
    let (numerator, denominator) = (i128::from(*value.numer()), i128::from(*value.denom()));
    Rational::new(numerator, denominator).expect("denominators are not zero")
}

/// A known value.
pub(crate) fn known(terms: &mut Terms, value: Value) -> Val {
    match value {
        Value::Bool(b) => Val::Bool(Term::from(b)),
        Value::Real(r) => Val::Number(terms.real(rational(r))),
        Value::Int(_) | Value::Enum(_) => constant(code(value)),
    }
}

impl Val {
    /// The term of a truth value. A number here would be an ill-typed expression, which the typed problem excludes.
    pub(crate) fn truth(&self) -> Term {
        match self {
            Val::Bool(term) => *term,
            Val::Cases(_) | Val::Bits { .. } | Val::Number(_) => unreachable!("expressions are well-typed"),
        }
    }

    /// As a signed bit-vector term with its bounds.
    fn bits(&self, terms: &mut Terms) -> (Term, i64, i64) {
        match self {
            Val::Bits { term, lo, hi } => (*term, *lo, *hi),
            Val::Cases(cases) => {
                let lo = cases.first().map_or(0, |c| c.0);
                let hi = cases.last().map_or(0, |c| c.0);
                let width = width(lo, hi);
                let mut term = terms.bv(i128::from(hi), width);
                for &(value, when) in cases.iter().rev().skip(1) {
                    let this = terms.bv(i128::from(value), width);
                    term = terms.ite(when, this, term);
                }
                (term, lo, hi)
            }
            Val::Bool(_) | Val::Number(_) => unreachable!("expressions are well-typed"),
        }
    }

    /// As a term of that sort, Int or Real.
    fn number(&self, terms: &mut Terms, sort: Sort) -> Term {
        match self {
            Val::Number(term) if sort == Sort::Real && terms.sort(*term) == Sort::Int => terms.to_real(*term),
            Val::Number(term) => *term,
            Val::Cases(cases) => {
                let constant = |terms: &mut Terms, value: i64| match sort {
                    Sort::Real => terms.real(Rational::from(value)),
                    _ => terms.int(value),
                };
                let mut term = constant(terms, cases.last().map_or(0, |c| c.0));
                for &(value, when) in cases.iter().rev().skip(1) {
                    let this = constant(terms, value);
                    term = terms.ite(when, this, term);
                }
                term
            }
            Val::Bool(_) | Val::Bits { .. } => unreachable!("a query has bit-vectors or numbers, not both"),
        }
    }

    /// The sort at which it can be combined with another value; `None` where neither is an integer or real.
    fn number_sort_with(&self, terms: &Terms, other: &Val) -> Option<Sort> {
        let sort = |value: &Val| match value {
            Val::Number(term) => Some(terms.sort(*term)),
            _ => None,
        };
        match (sort(self), sort(other)) {
            (Some(Sort::Real), _) | (_, Some(Sort::Real)) => Some(Sort::Real),
            (a, b) => a.or(b),
        }
    }

    /// The sort of a term that holds its values; of a list of numbers, that of `numbers`, or a bit-vector of their width.
    pub(crate) fn sort(&self, terms: &Terms, numbers: Sort) -> Sort {
        match (self, numbers) {
            (Val::Bool(_), _) => Sort::Bool,
            (Val::Bits { lo, hi, .. }, _) => Sort::BitVec(width(*lo, *hi)),
            (Val::Number(term), _) => terms.sort(*term),
            (Val::Cases(cases), Sort::BitVec(_)) => {
                Sort::BitVec(width(cases.first().map_or(0, |c| c.0), cases.last().map_or(0, |c| c.0)))
            }
            (Val::Cases(_), numbers) => numbers,
        }
    }

    /// As a term of that sort, which must hold its values.
    pub(crate) fn of_sort(&self, terms: &mut Terms, sort: Sort) -> Term {
        match (self, sort) {
            (Val::Bool(term), _) => *term,
            (_, Sort::BitVec(width)) => self.bits_of_width(terms, width),
            (_, sort) => self.number(terms, sort),
        }
    }

    /// As a signed bit-vector term of that width, which must hold its values.
    pub(crate) fn bits_of_width(&self, terms: &mut Terms, width: u32) -> Term {
        let (term, _, _) = self.bits(terms);
        extend(terms, term, width)
    }
}

/// Sign-extends, or drops high bits that repeat the sign.
fn extend(terms: &mut Terms, term: Term, to: u32) -> Term {
    let Sort::BitVec(from) = terms.sort(term) else { return term };
    match from.cmp(&to) {
        std::cmp::Ordering::Less => terms.sign_extend(term, to - from),
        std::cmp::Ordering::Equal => term,
        std::cmp::Ordering::Greater => terms.extract(term, to - 1, 0),
    }
}

/// The value of an expression.
pub(crate) fn translate<L>(terms: &mut Terms, expr: &Expr<L>, leaves: &mut impl Leaves<L>) -> Val {
    if let Some(value) = leaves.whole(terms, expr) {
        return value;
    }
    match expr {
        Expr::Const(value) => known(terms, *value),
        Expr::Leaf(leaf) => leaves.leaf(terms, leaf),
        Expr::Not(a) => Val::Bool(!translate(terms, a, leaves).truth()),
        Expr::And(es) | Expr::Or(es) => {
            let parts: Vec<Term> = es.iter().map(|e| translate(terms, e, leaves).truth()).collect();
            Val::Bool(if matches!(expr, Expr::And(_)) { terms.and(&parts) } else { terms.or(&parts) })
        }
        Expr::Iff(a, b) => {
            let (a, b) = (translate(terms, a, leaves).truth(), translate(terms, b, leaves).truth());
            Val::Bool(terms.iff(a, b))
        }
        Expr::Compare(op, a, b) => {
            let (a, b) = (translate(terms, a, leaves), translate(terms, b, leaves));
            Val::Bool(compare(terms, *op, a, b))
        }
        Expr::Add(es) => {
            let parts: Vec<Val> = es.iter().map(|e| translate(terms, e, leaves)).collect();
            parts.into_iter().reduce(|a, b| add(terms, a, b)).unwrap_or_else(|| constant(0))
        }
        Expr::Mul(c, a) => {
            let a = translate(terms, a, leaves);
            multiply(terms, *c, a)
        }
        Expr::Scale(c, a) => {
            let a = translate(terms, a, leaves).number(terms, Sort::Real);
            Val::Number(terms.real_mul(rational(*c), a))
        }
        Expr::ToReal(a) => Val::Number(translate(terms, a, leaves).number(terms, Sort::Real)),
        Expr::Div(a, c) => {
            let a = translate(terms, a, leaves);
            if let Val::Number(a) = a {
                return Val::Number(terms.int_div(a, *c));
            }
            divide(terms, a, *c)
        }
        Expr::Mod(a, c) => {
            // a mod c = a - c * (a div c)
            let a = translate(terms, a, leaves);
            if let Val::Number(a) = a {
                return Val::Number(terms.int_mod(a, *c));
            }
            match a {
                Val::Cases(cases) => {
                    merge(terms, cases.into_iter().map(|(v, when)| (v.rem_euclid(*c), when)))
                }
                bits => {
                    let quotient = divide(terms, bits.clone(), *c);
                    let product = multiply(terms, -*c, quotient);
                    let sum = add(terms, bits, product);
                    let (term, _, _) = sum.bits(terms);
                    Val::Bits { term, lo: 0, hi: *c - 1 }
                }
            }
        }
        Expr::If(branches, last) => {
            let branches: Vec<(Term, Val)> = branches
                .iter()
                .map(|(c, a)| (translate(terms, c, leaves).truth(), translate(terms, a, leaves)))
                .collect();
            let last = translate(terms, last, leaves);
            choose_first(terms, branches, last)
        }
        Expr::Member(es, set) => {
            let tuple: Vec<Val> = es.iter().map(|e| translate(terms, e, leaves)).collect();
            Val::Bool(member(terms, &tuple, set))
        }
    }
}

/// The value beside the first condition that holds, or the last.
fn choose_first(terms: &mut Terms, branches: Vec<(Term, Val)>, last: Val) -> Val {
    let listed = |value: &Val| matches!(value, Val::Cases(_));
    if !branches.iter().all(|(_, value)| listed(value)) || !listed(&last) {
        return branches.into_iter().rev().fold(last, |rest, (c, a)| choose(terms, c, a, rest));
    }
    // All cases at once: going through the rest of the chain for each branch would take the square of its length.
    let (mut all, mut before) = (Vec::new(), Term::FALSE);
    for (c, value) in branches.into_iter().chain([(Term::TRUE, last)]) {
        let here = terms.and2(c, !before);
        if let Val::Cases(cases) = value {
            for (value, when) in cases {
                all.push((value, terms.and2(when, here)));
            }
        }
        before = terms.or(&[before, c]);
    }
    merge(terms, all.into_iter())
}

/// `if c then a else b`.
pub(crate) fn choose(terms: &mut Terms, c: Term, a: Val, b: Val) -> Val {
    match (a, b) {
        (Val::Bool(a), Val::Bool(b)) => Val::Bool(terms.ite(c, a, b)),
        (Val::Cases(a), Val::Cases(b)) => {
            let mut all = Vec::with_capacity(a.len() + b.len());
            for (cases, when) in [(a, c), (b, !c)] {
                for (value, case) in cases {
                    all.push((value, terms.and2(case, when)));
                }
            }
            merge(terms, all.into_iter())
        }
        (a, b) => {
            if let Some(sort) = a.number_sort_with(terms, &b) {
                let (a, b) = (a.number(terms, sort), b.number(terms, sort));
                return Val::Number(terms.ite(c, a, b));
            }
            let ((a, alo, ahi), (b, blo, bhi)) = (a.bits(terms), b.bits(terms));
            let (lo, hi) = (alo.min(blo), ahi.max(bhi));
            let w = width(lo, hi);
            let (a, b) = (extend(terms, a, w), extend(terms, b, w));
            Val::Bits { term: terms.ite(c, a, b), lo, hi }
        }
    }
}

/// Joins the conditions of equal values, and drops impossible ones.
pub(crate) fn merge(terms: &mut Terms, cases: impl Iterator<Item = (i64, Term)>) -> Val {
    let mut by_value: BTreeMap<i64, Vec<Term>> = BTreeMap::new();
    for (value, when) in cases {
        if when != Term::FALSE {
            by_value.entry(value).or_default().push(when);
        }
    }
    Val::Cases(by_value.into_iter().map(|(value, when)| (value, terms.or(&when))).collect())
}

fn add(terms: &mut Terms, a: Val, b: Val) -> Val {
    if let Some(sort) = a.number_sort_with(terms, &b) {
        let (a, b) = (a.number(terms, sort), b.number(terms, sort));
        return Val::Number(terms.add(&[a, b]));
    }
    if let (Val::Cases(a), Val::Cases(b)) = (&a, &b) {
        let mut sums = Vec::with_capacity(a.len() * b.len());
        for &(x, when_x) in a {
            for &(y, when_y) in b {
                sums.push((x + y, terms.and2(when_x, when_y)));
            }
        }
        return merge(terms, sums.into_iter());
    }
    let ((a, alo, ahi), (b, blo, bhi)) = (a.bits(terms), b.bits(terms));
    let (lo, hi) = (alo + blo, ahi + bhi);
    let w = width(lo, hi);
    let (a, b) = (extend(terms, a, w), extend(terms, b, w));
    Val::Bits { term: terms.bv_add(a, b), lo, hi }
}

fn multiply(terms: &mut Terms, c: i64, a: Val) -> Val {
    match a {
        Val::Cases(cases) => merge(terms, cases.into_iter().map(|(v, when)| (c * v, when))),
        Val::Number(a) if terms.sort(a) == Sort::Real => Val::Number(terms.real_mul(Rational::from(c), a)),
        Val::Number(a) => Val::Number(terms.int_mul(c, a)),
        bits => {
            let (a, alo, ahi) = bits.bits(terms);
            let (lo, hi) = ((c * alo).min(c * ahi), (c * alo).max(c * ahi));
            // The product is exact modulo the width; only the result must fit.
            let w = width(lo.min(alo), hi.max(ahi)).max(width(c, c));
            let a = extend(terms, a, w);
            let factor = terms.bv(i128::from(c), w);
            Val::Bits { term: terms.bv_mul(factor, a), lo, hi }
        }
    }
}

/// A number divided by a positive constant, rounded down. On bit-vectors this becomes a chain of comparisons with the
/// steps, so no division circuit is needed.
fn divide(terms: &mut Terms, a: Val, c: i64) -> Val {
    match a {
        Val::Cases(cases) => merge(terms, cases.into_iter().map(|(v, when)| (v.div_euclid(c), when))),
        bits => {
            let (_, lo, hi) = bits.bits(terms);
            let mut cases = Vec::new();
            let mut at = lo;
            let mut below = Term::FALSE;
            while at <= hi {
                let end = (at.div_euclid(c) + 1).saturating_mul(c);
                let upto = if end > hi {
                    Term::TRUE
                } else {
                    compare(terms, Comparison::Lt, bits.clone(), constant(end))
                };
                cases.push((at.div_euclid(c), terms.and2(upto, !below)));
                below = upto;
                at = end;
            }
            Val::Cases(cases)
        }
    }
}

/// A comparison of two numbers.
pub(crate) fn compare(terms: &mut Terms, op: Comparison, a: Val, b: Val) -> Term {
    if let Some(sort) = a.number_sort_with(terms, &b) {
        let (a, b) = (a.number(terms, sort), b.number(terms, sort));
        return match op {
            Comparison::Eq => terms.eq(a, b),
            Comparison::Lt => terms.lt(a, b),
            Comparison::Le => terms.le(a, b),
        };
    }
    if let (Val::Cases(a), Val::Cases(b)) = (&a, &b) {
        return match op {
            Comparison::Eq => equal_cases(terms, a, b),
            Comparison::Lt => less_cases(terms, a, b),
            Comparison::Le => !less_cases(terms, b, a),
        };
    }
    let ((a, alo, ahi), (b, blo, bhi)) = (a.bits(terms), b.bits(terms));
    match op {
        Comparison::Eq if ahi < blo || bhi < alo => return Term::FALSE,
        Comparison::Lt if ahi < blo => return Term::TRUE,
        Comparison::Lt if bhi <= alo => return Term::FALSE,
        Comparison::Le if ahi <= blo => return Term::TRUE,
        Comparison::Le if bhi < alo => return Term::FALSE,
        _ => {}
    }
    let w = width(alo.min(blo), ahi.max(bhi));
    let (a, b) = (extend(terms, a, w), extend(terms, b, w));
    match op {
        Comparison::Eq => terms.eq(a, b),
        Comparison::Lt => terms.bv_slt(a, b),
        Comparison::Le => terms.bv_sle(a, b),
    }
}

/// Equal values: each value of `a` implies the same of `b`.
fn equal_cases(terms: &mut Terms, a: &[(i64, Term)], b: &[(i64, Term)]) -> Term {
    if let ([(value, _)], other) | (other, [(value, _)]) = (a, b) {
        return other.iter().find(|c| c.0 == *value).map_or(Term::FALSE, |c| c.1);
    }
    let parts: Vec<Term> = a
        .iter()
        .map(|&(value, when)| {
            let other = b.binary_search_by_key(&value, |c| c.0).map_or(Term::FALSE, |at| b[at].1);
            terms.implies(when, other)
        })
        .collect();
    terms.and(&parts)
}

/// `a < b`: for each value of `a`, `b` has a greater one. Linear, by sharing the suffixes of `b`.
fn less_cases(terms: &mut Terms, a: &[(i64, Term)], b: &[(i64, Term)]) -> Term {
    let mut greater = Term::FALSE;
    let mut upper = b.iter().rev().peekable();
    let mut parts = Vec::with_capacity(a.len());
    for &(value, when) in a.iter().rev() {
        while let Some(&(_, case)) = upper.next_if(|c| c.0 > value) {
            greater = terms.or2(greater, case);
        }
        parts.push(terms.implies(when, greater));
    }
    terms.and(&parts)
}

/// Membership of a tuple: a trie over the coordinates, the last one as intervals.
pub(crate) fn member(terms: &mut Terms, tuple: &[Val], set: &TupleSet) -> Term {
    let rows: Vec<&[i64]> = set.tuples.iter().map(|t| &**t).collect();
    member_of(terms, tuple, &rows)
}

/// Membership in a sorted list of tuples. The recursion is over the coordinates.
pub(crate) fn member_of(terms: &mut Terms, tuple: &[Val], rows: &[&[i64]]) -> Term {
    let Some((first, rest)) = tuple.split_first() else {
        return if rows.is_empty() { Term::FALSE } else { Term::TRUE };
    };
    let mut parts = Vec::new();
    if rest.is_empty() {
        let mut at = 0;
        while at < rows.len() {
            let start = rows[at][0];
            let mut end = start;
            while at < rows.len() && rows[at][0] <= end + 1 {
                end = end.max(rows[at][0]);
                at += 1;
            }
            let above = compare(terms, Comparison::Le, constant(start), first.clone());
            let below = compare(terms, Comparison::Le, first.clone(), constant(end));
            parts.push(terms.and2(above, below));
        }
    } else {
        for group in rows.chunk_by(|a, b| a[0] == b[0]) {
            let here = equal(terms, first, group[0][0]);
            let tails: Vec<&[i64]> = group.iter().map(|row| &row[1..]).collect();
            let inside = member_of(terms, rest, &tails);
            parts.push(terms.and2(here, inside));
        }
    }
    terms.or(&parts)
}

/// Whether a value (a truth value as 0 or 1) is this.
pub(crate) fn equal(terms: &mut Terms, value: &Val, code: i64) -> Term {
    match value {
        Val::Bool(term) => term.negate_if(code == 0),
        number => compare(terms, Comparison::Eq, number.clone(), constant(code)),
    }
}

/// Whether it has this value.
pub(crate) fn is(terms: &mut Terms, value: &Val, known_value: Value) -> Term {
    let other = known(terms, known_value);
    same(terms, value, &other)
}

/// Whether two values of one type are equal.
pub(crate) fn same(terms: &mut Terms, a: &Val, b: &Val) -> Term {
    match (a, b) {
        (Val::Bool(a), Val::Bool(b)) => terms.iff(*a, *b),
        _ => compare(terms, Comparison::Eq, a.clone(), b.clone()),
    }
}
