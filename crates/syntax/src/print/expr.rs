//! Expressions, with as few parentheses as their operators allow.

use std::borrow::Cow;

use super::layout::Indent;
use super::system::quoted;
use super::{Printer, start};
use crate::ast::{ArithOp, BinaryOp, CompareOp, Expr, ExprKind, Ident, Interval, Set, UnaryOp};
use crate::parser::operator::level;

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
    match &e.kind {
        ExprKind::Bool(_)
        | ExprKind::Number(_)
        | ExprKind::Name(_)
        | ExprKind::Text(_)
        | ExprKind::At(..)
        | ExprKind::Call(..)
        | ExprKind::Tuple(_) => level::OPERAND,
        // Its last part reaches as far as it can.
        ExprKind::If(..) => level::LOWEST,
        ExprKind::Not(_) | ExprKind::Unary(..) => level::LOGIC_PREFIX,
        ExprKind::Neg(_) => level::NEG,
        ExprKind::And(_) => level::AND,
        ExprKind::Or(_) => level::OR,
        ExprKind::Implies(..) => level::IMPLIES,
        ExprKind::Iff(..) => level::IFF,
        ExprKind::Compare(..) | ExprKind::In(..) => level::COMPARE,
        ExprKind::Sum(_) => level::SUM,
        ExprKind::Arith(..) => level::PRODUCT,
        ExprKind::Binary(..) => level::UNTIL,
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
        ExprKind::Text(name) => out.push(Task::Text(quoted(name).into())),
        ExprKind::At(name, paths) => out.push(applied(name, "[", paths, "]")),
        ExprKind::Call(name, args) => out.push(applied(name, "(", args, ")")),
        ExprKind::Not(a) => out.extend([text("!"), Task::Expr(a, below_not(a))]),
        ExprKind::Neg(a) => out.extend([text("-"), Task::Expr(a, level::NEG)]),
        ExprKind::And(items) => chain(items, "& ", level::AND, out),
        ExprKind::Or(items) => chain(items, "| ", level::OR, out),
        ExprKind::Sum(items) => sum(items, out),
        ExprKind::Implies(a, b) => {
            out.extend([Task::Expr(a, level::IMPLIES + 1), Task::Soft, text("-> ")]);
            out.push(if matches!(b.kind, ExprKind::Implies(..)) {
                Task::Rest(b)
            } else {
                Task::Expr(b, level::IMPLIES)
            });
        }
        ExprKind::Iff(a, b) => {
            let (a, b) = (Task::Expr(a, level::IFF), Task::Expr(b, level::IFF + 1));
            out.extend([a, Task::Soft, text("<-> "), b]);
        }
        ExprKind::Compare(op, a, b) => {
            // Comparisons cannot be chained.
            let (a, b) = (Task::Expr(a, level::SUM), Task::Expr(b, level::SUM));
            out.extend([a, Task::Soft, text(compare(*op)), b]);
        }
        ExprKind::Arith(op, a, b) => {
            let (a, b) = (Task::Expr(a, level::PRODUCT), Task::Expr(b, level::PRODUCT + 1));
            out.extend([a, Task::Soft, text(arith(*op)), b]);
        }
        ExprKind::In(a, set) => out.extend([Task::Expr(a, level::SUM), text(" in "), Task::Set(set)]),
        ExprKind::Tuple(items) => {
            out.push(text("("));
            list(items, out);
            out.push(text(")"));
        }
        ExprKind::If(c, a, b) => conditional(c, a, b, out),
        ExprKind::Unary(op, interval, a) => {
            out.push(text(unary(*op)));
            out.extend(interval.as_ref().map(Task::Interval));
            out.extend([text(" "), Task::Expr(a, level::LOGIC_PREFIX)]);
        }
        ExprKind::Binary(op, interval, a, b) => {
            out.extend([Task::Expr(a, level::UNTIL + 1), Task::Soft, text(binary(*op))]);
            out.extend(interval.as_ref().map(Task::Interval));
            out.push(text(" "));
            out.push(if matches!(b.kind, ExprKind::Binary(..)) {
                Task::Rest(b)
            } else {
                Task::Expr(b, level::UNTIL)
            });
        }
    }
}

/// `!x == 1` is `!(x == 1)`, but hardly anybody reads it so.
fn below_not(operand: &Expr) -> u8 {
    if level_of(operand) == level::COMPARE { level::OPERAND } else { level::LOGIC_PREFIX }
}

fn conditional<'a>(c: &'a Expr, a: &'a Expr, b: &'a Expr, out: &mut Tasks<'a>) {
    out.extend([text("if "), Task::Expr(c, level::LOWEST), Task::Soft]);
    out.extend([text("then "), Task::Expr(a, level::LOWEST), Task::Soft, text("else ")]);
    out.push(if matches!(b.kind, ExprKind::If(..)) { Task::Rest(b) } else { Task::Expr(b, level::LOWEST) });
}

/// Operands with one sign between them.
fn chain<'a>(items: &'a [Expr], sign: &'static str, level: u8, out: &mut Tasks<'a>) {
    for (nth, item) in items.iter().enumerate() {
        if nth > 0 {
            out.extend([Task::Soft, text(sign)]);
        }
        out.push(Task::Expr(item, level + 1));
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

fn compare(op: CompareOp) -> &'static str {
    match op {
        CompareOp::Eq => "== ",
        CompareOp::Ne => "!= ",
        CompareOp::Lt => "< ",
        CompareOp::Le => "<= ",
        CompareOp::Gt => "> ",
        CompareOp::Ge => ">= ",
    }
}

fn arith(op: ArithOp) -> &'static str {
    match op {
        ArithOp::Mul => "* ",
        ArithOp::Divide => "/ ",
        ArithOp::Div => "div ",
        ArithOp::Mod => "% ",
    }
}

fn unary(op: UnaryOp) -> &'static str {
    match op {
        UnaryOp::Next => "X",
        UnaryOp::WeakNext => "N",
        UnaryOp::Finally => "F",
        UnaryOp::Globally => "G",
    }
}

fn binary(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Until => "U",
        BinaryOp::Release => "R",
        BinaryOp::WeakUntil => "W",
    }
}
