//! Expressions, with as few parentheses as their operators allow.

use std::borrow::Cow;

use super::layout::Indent;
use super::system::quoted;
use super::{Printer, start};
use crate::ast::{Expr, ExprKind, Ident, Interval, Set};
use crate::operator::{Fixity, Operator, level};

/// What is still to be printed. A stack of it stands for recursion, so that nesting costs no call stack.
enum Task<'a> {
    /// An operand that binds at least so tightly, or has parentheses around it.
    Expr(&'a Expr, u8),
    /// An expression that shares the lines of the one around it.
    Rest(&'a Expr),
    Set(&'a Set),
    Interval(&'a Interval),
    Text(Cow<'static, str>),
    Soft,
    Fill,
    Open,
    Close,
}

type Tasks<'a> = Vec<Task<'a>>;

impl Printer<'_> {
    /// An expression where any may stand.
    pub(super) fn expr(&mut self, e: &Expr) {
        self.tasks(vec![Task::Expr(e, level::LOWEST)]);
    }

    /// An expression where comparisons and logic need parentheses, as bounds are.
    pub(super) fn arithmetic(&mut self, e: &Expr) {
        self.tasks(vec![Task::Expr(e, level::SUM)]);
    }

    pub(super) fn set(&mut self, set: &Set) {
        self.tasks(vec![Task::Set(set)]);
    }

    /// `LO..HI`
    pub(super) fn range(&mut self, lo: &Expr, hi: &Expr) {
        let mut tasks = Vec::new();
        range(lo, hi, &mut tasks);
        tasks.reverse();
        self.tasks(tasks);
    }

    /// Carries out tasks, the last one first.
    fn tasks(&mut self, mut stack: Tasks<'_>) {
        while let Some(task) = stack.pop() {
            let first = stack.len();
            match task {
                Task::Expr(e, least) => {
                    self.comments(start(e));
                    wrapped(e, least, &mut stack);
                }
                Task::Rest(e) => parts(e, &mut stack),
                Task::Set(set) => set_parts(set, &mut stack),
                Task::Interval(interval) => interval_parts(interval, &mut stack),
                Task::Text(text) => self.layout.text(text),
                Task::Soft => {
                    // Comments in front of what comes next stand in front of its operator too.
                    if let Some(next) = stack.iter().rev().find_map(|task| match task {
                        Task::Expr(e, _) | Task::Rest(e) => Some(start(e)),
                        _ => None,
                    }) {
                        self.comments(next);
                    }
                    self.layout.soft();
                }
                Task::Fill => self.layout.fill(),
                Task::Open => self.layout.open(Indent::Here),
                Task::Close => self.layout.close(),
            }
            stack[first..].reverse();
        }
    }
}

fn text(text: &'static str) -> Task<'static> {
    Task::Text(Cow::Borrowed(text))
}

/// How tightly the outermost operator binds.
fn level_of(e: &Expr) -> u8 {
    match (&e.kind, Operator::of(&e.kind)) {
        (_, Some(operator)) => operator.row().level,
        // Its last part reaches as far as it can.
        (ExprKind::If(..), None) => level::LOWEST,
        (_, None) => level::OPERAND,
    }
}

/// The expression, in parentheses if it binds less tightly than `least`; its lines are a group of their own.
fn wrapped<'a>(e: &'a Expr, least: u8, out: &mut Tasks<'a>) {
    let parentheses = level_of(e) < least;
    if parentheses {
        out.push(text("("));
    }
    out.extend([Task::Open, Task::Rest(e), Task::Close]);
    if parentheses {
        out.push(text(")"));
    }
}

/// The parts of an expression in order, without parentheses around them all.
fn parts<'a>(e: &'a Expr, out: &mut Tasks<'a>) {
    match &e.kind {
        ExprKind::Bool(value) => out.push(text(if *value { "true" } else { "false" })),
        ExprKind::Number(word) | ExprKind::Name(word) => out.push(Task::Text(word.clone().into())),
        ExprKind::Primed(word) => out.push(Task::Text(format!("{word}'").into())),
        ExprKind::Text(name) => out.push(Task::Text(quoted(name).into())),
        ExprKind::At(name, paths) => out.push(applied(name, "[", paths, "]")),
        ExprKind::Cost(name, paths) => {
            out.push(text("cost "));
            out.push(applied(name, "[", paths, "]"));
        }
        ExprKind::Call(name, args) => out.push(applied(name, "(", args, ")")),
        ExprKind::Not(a) => prefix(Operator::Not, None, a, out),
        ExprKind::Neg(a) => prefix(Operator::Neg, None, a, out),
        ExprKind::And(items) => chain(Operator::And, items, out),
        ExprKind::Or(items) => chain(Operator::Or, items, out),
        ExprKind::Sum(items) => sum(items, out),
        ExprKind::Implies(a, b) => infix(Operator::Implies, None, a, b, out),
        ExprKind::Iff(a, b) => infix(Operator::Iff, None, a, b, out),
        ExprKind::Compare(op, a, b) => infix(Operator::Compare(*op), None, a, b, out),
        ExprKind::Arith(op, a, b) => infix(Operator::Arith(*op), None, a, b, out),
        ExprKind::In(a, set) => out.extend([Task::Expr(a, level::SUM), text(" in "), Task::Set(set)]),
        ExprKind::Tuple(items) => {
            out.push(text("("));
            list(items, out);
            out.push(text(")"));
        }
        ExprKind::If(branches, last) => {
            conditional(branches, |value| Task::Expr(value, level::LOWEST), out);
            out.push(Task::Expr(last, level::LOWEST));
        }
        ExprKind::Unary(op, interval, a) => prefix(Operator::Unary(*op), interval.as_ref(), a, out),
        ExprKind::Binary(op, interval, a, b) => {
            infix(Operator::Binary(*op), interval.as_ref(), a, b, out);
        }
    }
}

/// An operator and its operand.
fn prefix<'a>(operator: Operator, interval: Option<&'a Interval>, a: &'a Expr, out: &mut Tasks<'a>) {
    let row = operator.row();
    out.push(text(row.name));
    out.extend(interval.map(Task::Interval));
    if matches!(operator, Operator::Unary(_)) {
        out.push(text(" "));
    }
    // `!x == 1` is `!(x == 1)`, but hardly anybody reads it so.
    let misread = operator == Operator::Not && level_of(a) == level::COMPARE;
    out.push(Task::Expr(a, if misread { level::OPERAND } else { row.level }));
}

/// An operator between two operands.
fn infix<'a>(
    operator: Operator,
    interval: Option<&'a Interval>,
    a: &'a Expr,
    b: &'a Expr,
    out: &mut Tasks<'a>,
) {
    let row = operator.row();
    let same = if row.fixity == Fixity::Left { row.level } else { row.level + 1 };
    out.extend([Task::Expr(a, same), Task::Soft, text(row.name)]);
    out.extend(interval.map(Task::Interval));
    out.push(text(" "));
    out.push(match row.fixity {
        Fixity::Right if level_of(b) == row.level => Task::Rest(b),
        Fixity::Right => Task::Expr(b, row.level),
        _ => Task::Expr(b, row.level + 1),
    });
}

/// `if C then A else if D then B else `, with what stands behind `then` as `value` says.
fn conditional<'a, T>(branches: &'a [(Expr, T)], value: impl Fn(&'a T) -> Task<'a>, out: &mut Tasks<'a>) {
    for (condition, then) in branches {
        out.extend([text("if "), Task::Expr(condition, level::LOWEST), Task::Soft, text("then ")]);
        out.extend([value(then), Task::Soft, text("else ")]);
    }
}

/// Operands with one sign between them.
fn chain<'a>(operator: Operator, items: &'a [Expr], out: &mut Tasks<'a>) {
    let row = operator.row();
    for (nth, item) in items.iter().enumerate() {
        if nth > 0 {
            out.extend([Task::Soft, text(row.name), text(" ")]);
        }
        out.push(Task::Expr(item, row.level + 1));
    }
}

fn sum<'a>(items: &'a [(bool, Expr)], out: &mut Tasks<'a>) {
    for (nth, (minus, item)) in items.iter().enumerate() {
        if nth > 0 {
            out.extend([Task::Soft, text(if *minus { "- " } else { "+ " })]);
        }
        out.push(Task::Expr(item, level::PRODUCT));
    }
}

/// Expressions with commas between them.
fn list<'a>(items: &'a [Expr], out: &mut Tasks<'a>) {
    out.push(Task::Open);
    for (nth, item) in items.iter().enumerate() {
        if nth > 0 {
            out.extend([text(","), Task::Fill]);
        }
        out.push(Task::Expr(item, level::LOWEST));
    }
    out.push(Task::Close);
}

fn set_parts<'a>(set: &'a Set, out: &mut Tasks<'a>) {
    match set {
        Set::List(items, _) => {
            out.push(text("{"));
            list(items, out);
            out.push(text("}"));
        }
        Set::Range(lo, hi) => range(lo, hi, out),
        Set::Enabled(path, _) => out.push(Task::Text(format!("enabled[{}]", path.name).into())),
        Set::If(branches, last, _) => {
            out.push(Task::Open);
            conditional(branches, Task::Set, out);
            out.extend([Task::Set(last), Task::Close]);
        }
    }
}

fn range<'a>(lo: &'a Expr, hi: &'a Expr, out: &mut Tasks<'a>) {
    let simple = |e: &Expr| level_of(e) > level::PRODUCT;
    let dots = if simple(lo) && simple(hi) { ".." } else { " .. " };
    // As the first word of a set, `enabled[p]` is all of it.
    let least = if begins_enabled(lo) { level::OPERAND + 1 } else { level::SUM };
    out.extend([Task::Expr(lo, least), text(dots), Task::Expr(hi, level::SUM)]);
}

fn begins_enabled(mut e: &Expr) -> bool {
    loop {
        e = match &e.kind {
            ExprKind::Sum(items) => match items.first() {
                Some((_, first)) => first,
                None => return false,
            },
            ExprKind::Arith(_, first, _) => first,
            ExprKind::At(name, _) => return name.name == "enabled",
            _ => return false,
        };
    }
}

fn interval_parts<'a>(interval: &'a Interval, out: &mut Tasks<'a>) {
    out.push(text("["));
    if let Some(lo) = &interval.lo {
        out.extend([Task::Expr(lo, level::SUM), text(",")]);
    }
    out.extend([Task::Expr(&interval.hi, level::SUM), text("]")]);
}

/// `NAME[p, q]` or `NAME(p, q)`
fn applied(name: &Ident, open: &str, args: &[Ident], close: &str) -> Task<'static> {
    let args: Vec<&str> = args.iter().map(|arg| arg.name.as_str()).collect();
    Task::Text(format!("{}{open}{}{close}", name.name, args.join(", ")).into())
}
