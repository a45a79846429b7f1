//! Typed expressions while they are built: with the bounds of integers, and folded where constant.

use crate::display::name;
use crate::expr::{Comparison, Expr, Leaf, Rational, Type, Value};
use std::sync::Arc;

/// Integers stay within `-LIMIT..=LIMIT`, that is in 62 bits with the sign.
pub(crate) const LIMIT: i128 = (1 << 61) - 1;

/// The values of an enumeration.
pub(crate) type EnumType = Arc<[String]>;

/// Least and greatest value that an integer expression can take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bounds {
    pub(crate) lo: i64,
    pub(crate) hi: i64,
}

impl Bounds {
    /// Exactly one value.
    pub(crate) fn exactly(value: i64) -> Self {
        Bounds { lo: value, hi: value }
    }

    /// Bounds that fit the limit, else `None`.
    pub(crate) fn new(lo: i128, hi: i128) -> Option<Self> {
        if lo < -LIMIT || hi > LIMIT {
            return None;
        }
        Some(Bounds { lo: i64::try_from(lo).ok()?, hi: i64::try_from(hi).ok()? })
    }

    /// The greatest absolute value.
    pub(crate) fn magnitude(self) -> i128 {
        i128::from(self.lo).abs().max(i128::from(self.hi).abs())
    }

    /// The smallest bounds that hold both.
    pub(crate) fn hull(self, other: Bounds) -> Bounds {
        Bounds { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    fn scaled(self, factor: i64) -> Option<Bounds> {
        let ends = [self.lo, self.hi].map(|end| i128::from(end) * i128::from(factor));
        Bounds::new(ends[0].min(ends[1]), ends[0].max(ends[1]))
    }
}

/// An integer with its bounds, where it has any.
pub(crate) type Bounded<L> = (Expr<L>, Option<Bounds>);

/// An expression with its type.
#[derive(Clone, Debug)]
pub(crate) enum Typed<L> {
    /// A truth value.
    Bool(Expr<L>),
    /// An integer, with its bounds where it has any.
    Int(Expr<L>, Option<Bounds>),
    /// A real number.
    Real(Expr<L>),
    /// A value of an enumeration.
    Enum(Expr<L>, EnumType),
}

impl<L> Typed<L> {
    /// A known integer.
    pub(crate) fn int(value: i64) -> Self {
        Typed::Int(Expr::Const(Value::Int(value)), Some(Bounds::exactly(value)))
    }

    /// A known real.
    pub(crate) fn real(value: Rational) -> Self {
        Typed::Real(Expr::Const(Value::Real(value)))
    }

    /// Something of a declared type.
    pub(crate) fn of_type(expr: Expr<L>, ty: &Type) -> Self {
        match ty {
            Type::Bool => Typed::Bool(expr),
            Type::Range { lo, hi } => Typed::Int(expr, Some(Bounds { lo: *lo, hi: *hi })),
            Type::Enum(values) => Typed::Enum(expr, values.clone()),
            Type::Int => Typed::Int(expr, None),
            Type::Real => Typed::Real(expr),
        }
    }

    /// The same over other leaves.
    pub(crate) fn map<M>(&self, f: &mut impl FnMut(&L) -> M) -> Typed<M> {
        match self {
            Typed::Bool(e) => Typed::Bool(e.map(f)),
            Typed::Int(e, bounds) => Typed::Int(e.map(f), *bounds),
            Typed::Real(e) => Typed::Real(e.map(f)),
            Typed::Enum(e, values) => Typed::Enum(e.map(f), values.clone()),
        }
    }

    /// The expression, and its type with the bounds that it cannot leave.
    pub(crate) fn into_parts(self) -> (Expr<L>, Type) {
        match self {
            Typed::Bool(e) => (e, Type::Bool),
            Typed::Int(e, Some(Bounds { lo, hi })) => (e, Type::Range { lo, hi }),
            Typed::Int(e, None) => (e, Type::Int),
            Typed::Real(e) => (e, Type::Real),
            Typed::Enum(e, values) => (e, Type::Enum(values)),
        }
    }

    /// How messages call its type.
    pub(crate) fn describe(&self) -> String {
        match self {
            Typed::Bool(_) => "a truth value".into(),
            Typed::Int(..) => "an integer".into(),
            Typed::Real(_) => "a real number".into(),
            Typed::Enum(_, values) => format!("one of {}", braces(values)),
        }
    }

    /// Its enumeration, if it has one.
    pub(crate) fn enumeration(&self) -> Option<&EnumType> {
        match self {
            Typed::Enum(_, values) => Some(values),
            _ => None,
        }
    }
}

/// More values of an enumeration than this are not listed: those of a graph may be many.
const MAX_LISTED: usize = 12;

/// `{a, b, c}`
pub(crate) fn braces(values: &[String]) -> String {
    let mut listed: Vec<String> = values.iter().take(MAX_LISTED).map(|v| name(v).into_owned()).collect();
    if listed.len() < values.len() {
        listed.push("...".to_owned());
    }
    format!("{{{}}}", listed.join(", "))
}

/// The value of a constant truth value.
fn known_bool<L>(e: &Expr<L>) -> Option<bool> {
    match e {
        Expr::Const(Value::Bool(b)) => Some(*b),
        _ => None,
    }
}

/// The value of a constant integer.
pub(crate) fn known_int<L>(e: &Expr<L>) -> Option<i64> {
    match e {
        Expr::Const(Value::Int(n)) => Some(*n),
        _ => None,
    }
}

/// `!e`
pub(crate) fn not<L>(e: Expr<L>) -> Expr<L> {
    match e {
        Expr::Const(Value::Bool(b)) => Expr::Const(Value::Bool(!b)),
        Expr::Not(inner) => *inner,
        e => Expr::Not(Box::new(e)),
    }
}

/// A conjunction without constant members.
pub(crate) fn and<L>(es: impl IntoIterator<Item = Expr<L>>) -> Expr<L> {
    let mut rest: Vec<_> = es.into_iter().filter(|e| !e.is_true()).collect();
    if rest.iter().any(Expr::is_false) {
        return Expr::FALSE;
    }
    match rest.len() {
        0 => Expr::TRUE,
        1 => rest.swap_remove(0),
        _ => Expr::And(rest),
    }
}

/// Adds a member to a conjunction, which stays flat however many are added.
pub(crate) fn and_also<L>(all: &mut Expr<L>, e: Expr<L>) {
    match all {
        Expr::And(members) if !e.is_true() && !e.is_false() => members.push(e),
        _ => *all = and([std::mem::replace(all, Expr::TRUE), e]),
    }
}

/// Adds a member to a disjunction, which stays flat however many are added.
pub(crate) fn or_else<L>(all: &mut Expr<L>, e: Expr<L>) {
    match all {
        Expr::Or(members) if !e.is_true() && !e.is_false() => members.push(e),
        _ => *all = or([std::mem::replace(all, Expr::FALSE), e]),
    }
}

/// A disjunction without constant members.
pub(crate) fn or<L>(es: impl IntoIterator<Item = Expr<L>>) -> Expr<L> {
    let mut rest: Vec<_> = es.into_iter().filter(|e| !e.is_false()).collect();
    if rest.iter().any(Expr::is_true) {
        return Expr::TRUE;
    }
    match rest.len() {
        0 => Expr::FALSE,
        1 => rest.swap_remove(0),
        _ => Expr::Or(rest),
    }
}

/// `a <-> b`
pub(crate) fn iff<L>(a: Expr<L>, b: Expr<L>) -> Expr<L> {
    match (known_bool(&a), known_bool(&b)) {
        (Some(true), _) => b,
        (Some(false), _) => not(b),
        (_, Some(true)) => a,
        (_, Some(false)) => not(a),
        _ => Expr::Iff(Box::new(a), Box::new(b)),
    }
}

/// A comparison of two integers or enumeration values.
pub(crate) fn compare<L>(op: Comparison, a: Expr<L>, b: Expr<L>) -> Expr<L> {
    if let (Expr::Const(a), Expr::Const(b)) = (&a, &b) {
        return Expr::Const(Value::Bool(op.holds(*a, *b)));
    }
    Expr::Compare(op, Box::new(a), Box::new(b))
}

/// A sum of integers, `None` where it may leave the limit. Every partial sum stays within it too. Without bounds, of
/// variables of type `int`, there is no limit.
pub(crate) fn sum<L>(terms: Vec<Bounded<L>>) -> Option<Bounded<L>> {
    let bounds = match terms.iter().map(|(_, b)| *b).collect::<Option<Vec<Bounds>>>() {
        None => None,
        Some(all) if all.iter().map(|b| b.magnitude()).sum::<i128>() > LIMIT => return None,
        Some(all) => {
            let end = |f: fn(&Bounds) -> i64| all.iter().map(|b| i128::from(f(b))).sum::<i128>();
            Some(Bounds::new(end(|b| b.lo), end(|b| b.hi))?)
        }
    };
    let mut constant: i64 = 0;
    let mut rest = Vec::new();
    for (term, _) in terms {
        match known_int(&term) {
            Some(n) => constant = constant.checked_add(n).filter(|c| i128::from(*c).abs() <= LIMIT)?,
            None => rest.push(term),
        }
    }
    if constant != 0 || rest.is_empty() {
        rest.push(Expr::Const(Value::Int(constant)));
    }
    Some((added(rest), bounds))
}

/// A sum of reals, `None` where constants leave 64 bits.
pub(crate) fn sum_of_reals<L>(terms: Vec<Expr<L>>) -> Option<Expr<L>> {
    let mut constant = Value::Real(Rational::ZERO);
    let mut rest = Vec::new();
    for term in terms {
        match term {
            Expr::Const(value) => constant = constant.checked_add(value)?,
            term => rest.push(term),
        }
    }
    if constant != Value::Real(Rational::ZERO) || rest.is_empty() {
        rest.push(Expr::Const(constant));
    }
    Some(added(rest))
}

fn added<L>(mut terms: Vec<Expr<L>>) -> Expr<L> {
    if terms.len() == 1 { terms.swap_remove(0) } else { Expr::Add(terms) }
}

/// A product with a constant, `None` where it may leave the limit.
pub(crate) fn scale<L>(factor: i64, (e, bounds): Bounded<L>) -> Option<Bounded<L>> {
    let bounds = match bounds {
        _ if factor == 0 => Some(Bounds::exactly(0)),
        Some(bounds) => Some(bounds.scaled(factor)?),
        None => None,
    };
    let expr = match (factor, known_int(&e)) {
        (0, _) => Expr::Const(Value::Int(0)),
        (_, Some(n)) => Expr::Const(Value::Int(factor * n)),
        (1, _) => e,
        _ => Expr::Mul(factor, Box::new(e)),
    };
    Some((expr, bounds))
}

/// A product of a real with a constant, `None` where constants leave 64 bits.
pub(crate) fn scale_real<L>(factor: Rational, e: Expr<L>) -> Option<Expr<L>> {
    Some(match e {
        _ if factor == Rational::ZERO => Expr::Const(Value::Real(factor)),
        Expr::Const(value) => Expr::Const(value.checked_mul(Value::Real(factor))?),
        e if factor == Rational::ONE => e,
        e => Expr::Scale(factor, Box::new(e)),
    })
}

/// An integer as a real.
pub(crate) fn to_real<L>(e: Expr<L>) -> Expr<L> {
    match known_int(&e) {
        Some(n) => Expr::Const(Value::Real(Rational::from(n))),
        None => Expr::ToReal(Box::new(e)),
    }
}

/// Quotient by a positive constant, rounded down.
pub(crate) fn quotient<L>((e, bounds): Bounded<L>, by: i64) -> Bounded<L> {
    let bounds = bounds.map(|b| Bounds { lo: b.lo.div_euclid(by), hi: b.hi.div_euclid(by) });
    match known_int(&e) {
        Some(n) => (Expr::Const(Value::Int(n.div_euclid(by))), bounds),
        None => (Expr::Div(Box::new(e), by), bounds),
    }
}

/// Remainder of [`quotient`].
pub(crate) fn remainder<L>((e, bounds): Bounded<L>, by: i64) -> Bounded<L> {
    if let Some(n) = known_int(&e) {
        let n = n.rem_euclid(by);
        return (Expr::Const(Value::Int(n)), Some(Bounds::exactly(n)));
    }
    let small = bounds.filter(|b| b.lo >= 0 && b.hi < by);
    (Expr::Mod(Box::new(e), by), Some(small.unwrap_or(Bounds { lo: 0, hi: by - 1 })))
}

/// Number of nodes of an expression, counted up to `limit`.
pub(crate) fn size<L>(e: &Expr<L>, limit: usize) -> usize {
    let mut stack = vec![e];
    let mut count = 0;
    while let Some(e) = stack.pop() {
        count += 1;
        if count >= limit {
            return limit;
        }
        stack.extend(e.children());
    }
    count
}

/// The labels that an expression reads, by id.
pub(crate) fn labels_read(e: &Expr<Leaf>) -> Vec<usize> {
    let mut labels = Vec::new();
    e.for_each_leaf(&mut |leaf| {
        if let Leaf::Label(id) = leaf {
            labels.push(usize::from(*id));
        }
    });
    labels.sort_unstable();
    labels.dedup();
    labels
}
