//! Typing expressions, whatever their names stand for: constants, states and paths share this.

use super::diagnostics::Diagnostics;
use super::fractions;
use super::limits::Limits;
use super::sets::membership;
use super::typed::{self, Bounded, EnumType, LIMIT, Typed, braces, known_int};
use crate::expr::{Comparison, Expr, Rational, Value};
use hyperplan_syntax::ast::{self, ArithOp, CompareOp, ExprKind, Ident};
use hyperplan_syntax::{Diagnostic, Span};

/// What names stand for where an expression is written.
pub(crate) trait Context {
    /// What expressions read here.
    type Leaf: Clone;

    /// Where messages go, and what bounds the nodes that are built.
    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits);

    /// A variable, label, constant or parameter; `None` if there is none of that name, and `Some(None)` if what it
    /// stands for was refused already.
    fn resolve(&mut self, name: &str) -> Option<Option<Typed<Self::Leaf>>>;

    /// Whether some enumeration in reach has a value of that name.
    fn is_enum_value(&self, _name: &str) -> bool {
        false
    }

    /// The message about a name that stands for nothing here.
    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic;

    /// `NAME'`
    fn primed(&mut self, name: &str, span: Span) -> Option<Typed<Self::Leaf>> {
        let message = format!("`{name}'` is the value after a step, and there is none here");
        self.error(Diagnostic::error("misplaced-prime", span, message).with_help("primes belong to `trans`"))
    }

    /// `NAME[PATHS]`
    fn at(&mut self, name: &Ident, paths: &[Ident], span: Span) -> Option<Typed<Self::Leaf>> {
        let _ = paths;
        let message = format!("`{}` of a path: there are no paths here", name.name);
        self.error(Diagnostic::error("misplaced-path", span, message).with_help("paths belong to objectives"))
    }

    /// `cost NAME[PATHS]`
    fn cost(&mut self, name: &Ident, paths: &[Ident], span: Span) -> Option<Typed<Self::Leaf>> {
        let _ = paths;
        let message = format!("`cost {}` of a path: there are no paths here", name.name);
        self.error(Diagnostic::error("misplaced-path", span, message).with_help("paths belong to objectives"))
    }

    /// `NAME(ARGS)`
    fn call(
        &mut self,
        name: &Ident,
        args: &[Ident],
        hint: Option<&EnumType>,
        span: Span,
    ) -> Option<Typed<Self::Leaf>> {
        let _ = (args, hint);
        let message =
            format!("`{}(...)` is a use of a definition, and those belong to objectives", name.name);
        self.error(Diagnostic::error("misplaced-use", span, message))
    }

    /// Comparisons of things that are no values: actions, whole states, observations.
    fn compare_special(
        &mut self,
        op: CompareOp,
        a: &ast::Expr,
        b: &ast::Expr,
        span: Span,
    ) -> Option<Option<Typed<Self::Leaf>>> {
        let _ = (op, a, b, span);
        None
    }

    /// Membership of things that are no values.
    fn member_special(
        &mut self,
        element: &ast::Expr,
        set: &ast::Set,
        span: Span,
    ) -> Option<Option<Typed<Self::Leaf>>> {
        let _ = (element, set, span);
        None
    }

    /// The message about a temporal operator inside an expression.
    fn temporal(&self, span: Span) -> Diagnostic {
        Diagnostic::error("misplaced-temporal", span, "a temporal operator cannot stand here")
            .with_help("temporal operators belong to objectives")
    }

    /// Reports: nothing comes of what was wrong.
    fn error<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.parts().0.refuse(diagnostic)
    }
}

/// Types an expression; `None` after a message, so that whatever contains it comes to nothing too, without a word.
/// `hint` is the enumeration that is expected, if one is: its values need no declaration.
pub(crate) fn typed<C: Context>(
    cx: &mut C,
    e: &ast::Expr,
    hint: Option<&EnumType>,
) -> Option<Typed<C::Leaf>> {
    let (diagnostics, limits) = cx.parts();
    if !limits.enter(e.span, diagnostics) {
        return None;
    }
    let result = typed_inner(cx, e, hint);
    cx.parts().1.leave();
    result
}

/// Every level of an expression recurses through here. Where `inline(never)` stands, it keeps that frame small.
fn typed_inner<C: Context>(cx: &mut C, e: &ast::Expr, hint: Option<&EnumType>) -> Option<Typed<C::Leaf>> {
    match &e.kind {
        ExprKind::Bool(b) => Some(Typed::Bool(Expr::Const(Value::Bool(*b)))),
        ExprKind::Number(digits) => number(cx, digits, e.span),
        ExprKind::Name(name) => named(cx, name, e.span, hint),
        ExprKind::Primed(name) => cx.primed(name, e.span),
        ExprKind::Text(name) => quoted(cx, name, e.span, hint),
        ExprKind::At(name, paths) => cx.at(name, paths, e.span),
        ExprKind::Cost(name, paths) => cx.cost(name, paths, e.span),
        ExprKind::Call(name, args) => cx.call(name, args, hint, e.span),
        ExprKind::Not(a) => truth(cx, a).map(|a| Typed::Bool(typed::not(a))),
        ExprKind::And(es) => truths(cx, es).map(|es| Typed::Bool(typed::and(es))),
        ExprKind::Or(es) => truths(cx, es).map(|es| Typed::Bool(typed::or(es))),
        ExprKind::Implies(a, b) => both(cx, a, b, |a, b| typed::or([typed::not(a), b])),
        ExprKind::Iff(a, b) => both(cx, a, b, typed::iff),
        ExprKind::Compare(op, a, b) => compare(cx, *op, a, b, e.span),
        ExprKind::Neg(a) => negated(cx, a, e.span),
        ExprKind::Sum(terms) => sum(cx, terms, e.span),
        ExprKind::Arith(op, a, b) => arith(cx, *op, a, b, e.span),
        ExprKind::In(element, set) => membership(cx, element, set, e.span),
        ExprKind::If(branches, last) => choice(cx, branches, last, hint),
        ExprKind::Tuple(_) => {
            let message = "a tuple can only stand to the left of `in` and in the set to its right";
            cx.error(Diagnostic::error("misplaced-tuple", e.span, message))
        }
        ExprKind::Unary(..) | ExprKind::Binary(..) => {
            let diagnostic = cx.temporal(e.span);
            cx.error(diagnostic)
        }
    }
}

/// A truth value, or `None` after a message.
pub(crate) fn truth<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<Expr<C::Leaf>> {
    match typed(cx, e, None)? {
        Typed::Bool(expr) => Some(expr),
        other => mismatch(cx, &other, "a truth value", e.span),
    }
}

/// An integer with its bounds, or `None` after a message.
pub(crate) fn integer<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<Bounded<C::Leaf>> {
    match typed(cx, e, None)? {
        Typed::Int(expr, bounds) => Some((expr, bounds)),
        other => mismatch(cx, &other, "an integer", e.span),
    }
}

/// A number of either type.
pub(crate) enum Number<L> {
    Int(Bounded<L>),
    Real(Expr<L>),
}

impl<L> Number<L> {
    pub(crate) fn typed(self) -> Typed<L> {
        match self {
            Number::Int((e, bounds)) => Typed::Int(e, bounds),
            Number::Real(e) => Typed::Real(e),
        }
    }

    /// As a real; `None` where the integer is too large for that.
    fn real(self) -> Option<Expr<L>> {
        match self {
            Number::Int((e, bounds)) => {
                let fits = bounds.is_none_or(|b| b.magnitude() <= i128::from(fractions::MAX_CONVERTED));
                fits.then(|| typed::to_real(e))
            }
            Number::Real(e) => Some(e),
        }
    }
}

/// A number, or `None` after a message.
pub(crate) fn numeric<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<Number<C::Leaf>> {
    match typed(cx, e, None)? {
        Typed::Int(expr, bounds) => Some(Number::Int((expr, bounds))),
        Typed::Real(expr) => Some(Number::Real(expr)),
        other => mismatch(cx, &other, "a number", e.span),
    }
}

/// A real number, or `None` after a message.
pub(crate) fn real<C: Context>(cx: &mut C, e: &ast::Expr) -> Option<Expr<C::Leaf>> {
    numeric(cx, e)?.real().or_else(|| overflow(cx, e.span))
}

/// Says that something of another type was expected.
#[cold]
#[inline(never)]
pub(crate) fn mismatch<C: Context, T>(
    cx: &mut C,
    found: &Typed<C::Leaf>,
    expected: &str,
    span: Span,
) -> Option<T> {
    let message = format!("expected {expected}, found {}", found.describe());
    cx.error(Diagnostic::error("type-mismatch", span, message))
}

#[inline(never)]
fn truths<C: Context>(cx: &mut C, es: &[ast::Expr]) -> Option<Vec<Expr<C::Leaf>>> {
    // All of them are typed before the first failure counts: one run reports all mistakes.
    let typed: Vec<_> = es.iter().map(|e| truth(cx, e)).collect();
    typed.into_iter().collect()
}

#[inline(never)]
fn both<C: Context>(
    cx: &mut C,
    a: &ast::Expr,
    b: &ast::Expr,
    make: impl Fn(Expr<C::Leaf>, Expr<C::Leaf>) -> Expr<C::Leaf>,
) -> Option<Typed<C::Leaf>> {
    let (a, b) = (truth(cx, a), truth(cx, b));
    a.zip(b).map(|(a, b)| Typed::Bool(make(a, b)))
}

#[inline(never)]
fn number<C: Context>(cx: &mut C, digits: &str, span: Span) -> Option<Typed<C::Leaf>> {
    let number = match digits.split_once('.') {
        Some(_) => fractions::decimal(digits).map(Typed::real),
        None => digits.parse().ok().filter(|n| i128::from(*n) <= LIMIT).map(Typed::int),
    };
    number.or_else(|| {
        cx.error(Diagnostic::error("number-too-large", span, "the number does not fit in 62 bits"))
    })
}

#[inline(never)]
fn named<C: Context>(cx: &mut C, name: &str, span: Span, hint: Option<&EnumType>) -> Option<Typed<C::Leaf>> {
    let value = hint.and_then(|values| Some((values.iter().position(|v| v == name)?, values)));
    let meant = cx.resolve(name);
    match (value, meant) {
        (Some((_, values)), Some(Some(Typed::Enum(_, other)))) if other == *values => {
            let message = format!("`{name}` is both a value of {} and a variable", braces(values));
            cx.error(Diagnostic::error("ambiguous-name", span, message).with_help("rename one of them"))
        }
        (Some((index, values)), _) => {
            let index = u32::try_from(index).unwrap_or(u32::MAX);
            Some(Typed::Enum(Expr::Const(Value::Enum(index)), values.clone()))
        }
        (None, Some(meant)) => meant,
        (None, None) if hint.is_none() && cx.is_enum_value(name) => {
            let message = format!("`{name}` is a value of an enumeration, but nothing here says of which");
            let help = "compare it with a variable of that enumeration";
            cx.error(Diagnostic::error("ambiguous-name", span, message).with_help(help))
        }
        (None, None) => {
            let diagnostic = match hint {
                Some(values) => no_such_value(name, values, span),
                None => cx.unknown(name, span),
            };
            let diagnostic = match name.to_ascii_lowercase().as_str() {
                word @ ("true" | "false") => diagnostic.with_help(format!("write `{word}`")),
                _ => diagnostic,
            };
            cx.error(diagnostic)
        }
    }
}

fn no_such_value(name: &str, values: &EnumType, span: Span) -> Diagnostic {
    let message = format!("`{name}` is not one of {}", braces(values));
    let diagnostic = Diagnostic::error("unknown-name", span, message);
    super::diagnostics::suggest(diagnostic, name, values.iter().map(String::as_str))
}

/// A name in quotes: always a value of the enumeration that is expected.
#[inline(never)]
fn quoted<C: Context>(cx: &mut C, name: &str, span: Span, hint: Option<&EnumType>) -> Option<Typed<C::Leaf>> {
    let Some(values) = hint else {
        let message =
            format!("{name:?} names a value of an enumeration or an action, but nothing here says which");
        let help = "compare it with a variable of that enumeration or with a path's `action`";
        return cx.error(Diagnostic::error("ambiguous-name", span, message).with_help(help));
    };
    match values.iter().position(|v| v == name).and_then(|index| u32::try_from(index).ok()) {
        Some(index) => Some(Typed::Enum(Expr::Const(Value::Enum(index)), values.clone())),
        None => cx.error(no_such_value(name, values, span)),
    }
}

/// Whether the expression may need the type of the other side to be understood.
fn wants_hint<C: Context>(cx: &C, e: &ast::Expr) -> bool {
    match &e.kind {
        ExprKind::Name(name) => cx.is_enum_value(name),
        ExprKind::Text(_) => true,
        ExprKind::If(branches, last) => {
            branches.iter().map(|(_, value)| value).chain([&**last]).any(|value| wants_hint(cx, value))
        }
        _ => false,
    }
}

type Pair<L> = (Typed<L>, Typed<L>);

/// Types two operands that should have one type; the one that stands on its own first.
fn operands<C: Context>(
    cx: &mut C,
    a: &ast::Expr,
    b: &ast::Expr,
    hint: Option<&EnumType>,
) -> Option<Pair<C::Leaf>> {
    // An enumeration value beside something that was refused cannot be judged.
    if hint.is_none() && wants_hint(cx, a) && !wants_hint(cx, b) {
        let right = typed(cx, b, None)?;
        return Some((typed(cx, a, right.enumeration())?, right));
    }
    let left = typed(cx, a, hint);
    if left.is_none() && wants_hint(cx, b) {
        return None;
    }
    let right = typed(cx, b, hint.or(left.as_ref().and_then(Typed::enumeration)));
    left.zip(right)
}

#[inline(never)]
fn compare<C: Context>(
    cx: &mut C,
    op: CompareOp,
    a: &ast::Expr,
    b: &ast::Expr,
    span: Span,
) -> Option<Typed<C::Leaf>> {
    if let Some(special) = cx.compare_special(op, a, b, span) {
        return special;
    }
    let (left, right) = operands(cx, a, b, None)?;
    compare_typed(cx, op, left, right, span).map(Typed::Bool)
}

/// Compares two typed operands.
pub(crate) fn compare_typed<C: Context>(
    cx: &mut C,
    op: CompareOp,
    left: Typed<C::Leaf>,
    right: Typed<C::Leaf>,
    span: Span,
) -> Option<Expr<C::Leaf>> {
    use typed::compare as make;
    let equality = matches!(op, CompareOp::Eq | CompareOp::Ne);
    let equal = match (left, right) {
        (Typed::Int(a, _), Typed::Int(b, _)) => {
            let (comparison, a, b) = ordered(op, a, b);
            make(comparison, a, b)
        }
        (left @ (Typed::Int(..) | Typed::Real(_)), right @ (Typed::Int(..) | Typed::Real(_))) => {
            let reals = as_real(left).zip(as_real(right)).map(|(a, b)| ordered(op, a, b));
            let compared = reals.and_then(|(comparison, a, b)| fractions::compare(comparison, a, b));
            compared.or_else(|| overflow(cx, span))?
        }
        (Typed::Enum(a, t), Typed::Enum(b, u)) if equality && t == u => make(Comparison::Eq, a, b),
        (Typed::Bool(a), Typed::Bool(b)) if equality => typed::iff(a, b),
        (left, right) => {
            let in_quotes = number_as_value(&left, &right).or_else(|| number_as_value(&right, &left));
            let (left, right) = (left.describe(), right.describe());
            let message = if equality {
                format!("cannot compare {left} with {right}")
            } else {
                format!("only numbers have an order, not {left} and {right}")
            };
            let diagnostic = Diagnostic::error("type-mismatch", span, message);
            return cx.error(match in_quotes {
                Some(number) => diagnostic.with_help(format!("write the value in quotes: `\"{number}\"`")),
                None => diagnostic,
            });
        }
    };
    Some(if op == CompareOp::Ne { typed::not(equal) } else { equal })
}

/// The number, where it was written for an enumeration value of that name.
fn number_as_value<L>(values: &Typed<L>, number: &Typed<L>) -> Option<i64> {
    let (Typed::Enum(_, values), Typed::Int(number, _)) = (values, number) else { return None };
    known_int(number).filter(|number| values.contains(&number.to_string()))
}

/// The message about arithmetic that may leave 62 bits.
pub(crate) fn overflow<T>(cx: &mut impl Context, span: Span) -> Option<T> {
    let message = "the value may not fit in 62 bits";
    cx.error(Diagnostic::error("number-too-large", span, message).with_help("make the ranges smaller"))
}

/// The comparison with its sides in order; `!=` as `==`.
fn ordered<L>(op: CompareOp, a: Expr<L>, b: Expr<L>) -> (Comparison, Expr<L>, Expr<L>) {
    match op {
        CompareOp::Eq | CompareOp::Ne => (Comparison::Eq, a, b),
        CompareOp::Lt => (Comparison::Lt, a, b),
        CompareOp::Le => (Comparison::Le, a, b),
        CompareOp::Gt => (Comparison::Lt, b, a),
        CompareOp::Ge => (Comparison::Le, b, a),
    }
}

fn as_real<L>(number: Typed<L>) -> Option<Expr<L>> {
    match number {
        Typed::Int(e, bounds) => Number::Int((e, bounds)).real(),
        Typed::Real(e) => Some(e),
        _ => None,
    }
}

#[inline(never)]
fn negated<C: Context>(cx: &mut C, a: &ast::Expr, span: Span) -> Option<Typed<C::Leaf>> {
    let a = numeric(cx, a)?;
    minus(a).or_else(|| overflow(cx, span)).map(Number::typed)
}

fn minus<L>(number: Number<L>) -> Option<Number<L>> {
    Some(match number {
        Number::Int(e) => Number::Int(typed::scale(-1, e)?),
        Number::Real(e) => Number::Real(typed::scale_real(-Rational::ONE, e)?),
    })
}

#[inline(never)]
fn sum<C: Context>(cx: &mut C, terms: &[(bool, ast::Expr)], span: Span) -> Option<Typed<C::Leaf>> {
    // A loop, which takes less of the stack than a chain of iterators: sums may be nested as deeply as anything.
    let mut parts = Vec::with_capacity(terms.len());
    let mut complete = true;
    for (minus, term) in terms {
        match numeric(cx, term) {
            Some(number) => parts.push((*minus, number)),
            None => complete = false,
        }
    }
    let parts = complete.then_some(parts)?;
    added(parts).or_else(|| overflow(cx, span)).map(Number::typed)
}

/// The sum of numbers, of which some count negatively: real where one of them is.
fn added<L>(parts: Vec<(bool, Number<L>)>) -> Option<Number<L>> {
    let parts = parts.into_iter().map(|(negative, n)| if negative { minus(n) } else { Some(n) });
    let parts: Vec<Number<L>> = parts.collect::<Option<_>>()?;
    if parts.iter().any(|n| matches!(n, Number::Real(_))) {
        let reals = parts.into_iter().map(Number::real).collect::<Option<_>>()?;
        return typed::sum_of_reals(reals).map(Number::Real);
    }
    let integer = |n| if let Number::Int(e) = n { Some(e) } else { None };
    typed::sum(parts.into_iter().map(integer).collect::<Option<_>>()?).map(Number::Int)
}

#[inline(never)]
fn arith<C: Context>(
    cx: &mut C,
    op: ArithOp,
    a: &ast::Expr,
    b: &ast::Expr,
    span: Span,
) -> Option<Typed<C::Leaf>> {
    match op {
        ArithOp::Mul => product(cx, a, b, span),
        ArithOp::Divide => fraction(cx, a, b, span),
        ArithOp::Div | ArithOp::Mod => {
            let (left, right) = (integer(cx, a), integer(cx, b));
            let (left, (right, _)) = left.zip(right)?;
            let Some(by) = known_int(&right).filter(|by| *by > 0) else {
                let message = "the divisor must be a positive constant";
                return cx.error(Diagnostic::error("bad-divisor", b.span, message));
            };
            let divide = if op == ArithOp::Div { typed::quotient } else { typed::remainder };
            let (e, bounds) = divide(left, by);
            Some(Typed::Int(e, bounds))
        }
    }
}

fn product<C: Context>(cx: &mut C, a: &ast::Expr, b: &ast::Expr, span: Span) -> Option<Typed<C::Leaf>> {
    let (left, right) = (numeric(cx, a), numeric(cx, b));
    let (left, right) = left.zip(right)?;
    let product = match (left, right) {
        (Number::Int(a), Number::Int(b)) => match (known_int(&a.0), known_int(&b.0)) {
            (Some(factor), _) => typed::scale(factor, b).map(Number::Int),
            (_, Some(factor)) => typed::scale(factor, a).map(Number::Int),
            _ => return nonlinear(cx, span),
        },
        (a, b) => match a.real().zip(b.real()) {
            Some((a, b)) => match (known_real(&a), known_real(&b)) {
                (Some(factor), _) => typed::scale_real(factor, b).map(Number::Real),
                (_, Some(factor)) => typed::scale_real(factor, a).map(Number::Real),
                _ => return nonlinear(cx, span),
            },
            None => None,
        },
    };
    product.or_else(|| overflow(cx, span)).map(Number::typed)
}

fn nonlinear<C: Context>(cx: &mut C, span: Span) -> Option<Typed<C::Leaf>> {
    let message = "a product of two things that vary is not linear";
    let diagnostic = Diagnostic::error("nonlinear", span, message);
    cx.error(diagnostic.with_help("one side of `*` must be a constant"))
}

/// `a / b`, a real number.
fn fraction<C: Context>(cx: &mut C, a: &ast::Expr, b: &ast::Expr, span: Span) -> Option<Typed<C::Leaf>> {
    let (left, right) = (real(cx, a), real(cx, b));
    let (left, right) = left.zip(right)?;
    let Some(by) = known_real(&right).filter(|by| *by != Rational::ZERO) else {
        let message = "the divisor must be a constant other than 0";
        let help = "for integers there are also `div` (rounds down) and `%` (remainder)";
        return cx.error(Diagnostic::error("bad-divisor", b.span, message).with_help(help));
    };
    typed::scale_real(by.recip(), left).or_else(|| overflow(cx, span)).map(Typed::Real)
}

fn known_real<L>(e: &Expr<L>) -> Option<Rational> {
    match e {
        Expr::Const(Value::Real(r)) => Some(*r),
        _ => None,
    }
}

#[inline(never)]
fn choice<C: Context>(
    cx: &mut C,
    branches: &[(ast::Expr, ast::Expr)],
    last: &ast::Expr,
    hint: Option<&EnumType>,
) -> Option<Typed<C::Leaf>> {
    let mut conditions = Vec::with_capacity(branches.len());
    for (condition, _) in branches {
        conditions.push(truth(cx, condition));
    }
    let values = values(cx, branches, last, hint);
    let conditions = conditions.into_iter().collect::<Option<Vec<_>>>()?;
    chosen(cx, conditions, values?, branches, last)
}

/// The values of a choice, the last one at the end. Those that stand on their own come first: they may say of which
/// enumeration the others are.
#[inline(never)]
fn values<C: Context>(
    cx: &mut C,
    branches: &[(ast::Expr, ast::Expr)],
    last: &ast::Expr,
    hint: Option<&EnumType>,
) -> Option<Vec<Typed<C::Leaf>>> {
    let all: Vec<&ast::Expr> = branches.iter().map(|(_, value)| value).chain([last]).collect();
    let mut found: Vec<Option<Typed<C::Leaf>>> = Vec::with_capacity(all.len());
    found.resize_with(all.len(), || None);
    let (mut hint, mut refused) = (hint.cloned(), false);
    let waits: Vec<bool> = all.iter().map(|value| hint.is_none() && wants_hint(cx, value)).collect();
    for second in [false, true] {
        // Without a hint after one that was refused, nothing can be said of the others.
        if second && refused && hint.is_none() {
            return None;
        }
        for (at, value) in all.iter().enumerate().filter(|(at, _)| waits[*at] == second) {
            found[at] = typed(cx, value, hint.as_ref());
            refused |= found[at].is_none();
            hint = hint.or_else(|| found[at].as_ref()?.enumeration().cloned());
        }
    }
    found.into_iter().collect()
}

/// Not a part of [`choice`], to keep its frame small.
#[inline(never)]
fn chosen<C: Context>(
    cx: &mut C,
    conditions: Vec<Expr<C::Leaf>>,
    mut values: Vec<Typed<C::Leaf>>,
    branches: &[(ast::Expr, ast::Expr)],
    last: &ast::Expr,
) -> Option<Typed<C::Leaf>> {
    let mut whole = values.pop()?;
    let mut kept = Vec::with_capacity(values.len());
    let reals = values.iter().chain([&whole]).any(|value| matches!(value, Typed::Real(_)));
    for (value, (_, place)) in values.into_iter().zip(branches) {
        let (value, joined) = match (value, whole) {
            (Typed::Bool(a), Typed::Bool(b)) => (a, Typed::Bool(b)),
            (a @ (Typed::Int(..) | Typed::Real(_)), b @ (Typed::Int(..) | Typed::Real(_))) if reals => {
                let (a, b) = as_real(a).zip(as_real(b)).or_else(|| overflow(cx, place.span))?;
                (a, Typed::Real(b))
            }
            (Typed::Int(a, ab), Typed::Int(b, bb)) => (a, Typed::Int(b, ab.zip(bb).map(|(a, b)| a.hull(b)))),
            (Typed::Enum(a, t), Typed::Enum(b, u)) if t == u => (a, Typed::Enum(b, u)),
            (a, b) => {
                let message = format!("one case is {}, the other {}", a.describe(), b.describe());
                let span = place.span.to(last.span);
                return cx.error(Diagnostic::error("type-mismatch", span, message));
            }
        };
        kept.push(value);
        whole = joined;
    }
    let kept = conditions.into_iter().zip(kept);
    Some(match whole {
        Typed::Bool(last) => Typed::Bool(Expr::choice(kept, last)),
        Typed::Int(last, bounds) => Typed::Int(Expr::choice(kept, last), bounds),
        Typed::Real(last) => Typed::Real(Expr::choice(kept, last)),
        Typed::Enum(last, values) => Typed::Enum(Expr::choice(kept, last), values),
    })
}
