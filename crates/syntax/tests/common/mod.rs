//! Shared by the tests: fully parenthesized text of expressions, and short forms of diagnostics.
#![allow(dead_code, unreachable_pub)]

use hyperplan_syntax::ast::{
    ArithOp, BinaryOp, CompareOp, Expr, ExprKind, File, Ident, Interval, Item, ObjectiveBody, Set, UnaryOp,
};
use hyperplan_syntax::{Diagnostic, SourceId, parse};

pub const SOURCE: SourceId = SourceId(0);

/// Parses what must be without fault.
pub fn good(text: &str) -> File {
    let (file, errors) = parse(SOURCE, text);
    assert!(errors.is_empty(), "{text}\n{errors:#?}");
    file
}

/// `code: message @ marked text` of every diagnostic.
pub fn faults(text: &str) -> Vec<String> {
    let (_, errors) = parse(SOURCE, text);
    errors.iter().map(|error| fault(text, error)).collect()
}

fn fault(text: &str, error: &Diagnostic) -> String {
    let marked = error.span.map_or("nowhere", |span| &text[span.range()]);
    format!("{}: {} @ {marked}", error.code, error.message)
}

/// The help of the only diagnostic.
pub fn advice(text: &str) -> String {
    let (_, errors) = parse(SOURCE, text);
    assert_eq!(errors.len(), 1, "{text}\n{errors:#?}");
    errors[0].help.clone().unwrap_or_default()
}

/// The body of `objective o { TEXT }`, fully parenthesized.
pub fn formula(text: &str) -> String {
    let file = good(&format!("objective o {{ {text} }}"));
    match &file.items[..] {
        [Item::Objective(objective)] => match &objective.body {
            ObjectiveBody::Formula(formula) => show(&formula.body),
            other => panic!("{other:?}"),
        },
        other => panic!("{other:?}"),
    }
}

pub fn names(idents: &[Ident]) -> String {
    idents.iter().map(|ident| ident.name.as_str()).collect::<Vec<_>>().join(",")
}

fn list(exprs: &[Expr], between: &str) -> String {
    exprs.iter().map(show).collect::<Vec<_>>().join(between)
}

pub fn show_set(set: &Set) -> String {
    match set {
        Set::List(items, _) => format!("{{{}}}", list(items, ",")),
        Set::Range(lo, hi) => format!("{}..{}", show(lo), show(hi)),
        Set::Enabled(path, _) => format!("enabled[{}]", path.name),
        Set::If(branches, last, _) => {
            let shown =
                branches.iter().map(|(c, set)| format!("if {} then {} else ", show(c), show_set(set)));
            shown.collect::<String>() + &show_set(last)
        }
    }
}

fn show_interval(interval: &Option<Interval>) -> String {
    match interval {
        None => String::new(),
        Some(Interval { lo: None, hi, .. }) => format!("[{}]", show(hi)),
        Some(Interval { lo: Some(lo), hi, .. }) => format!("[{},{}]", show(lo), show(hi)),
    }
}

pub fn show(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Number(text) | ExprKind::Name(text) => text.clone(),
        ExprKind::Primed(text) => format!("{text}'"),
        ExprKind::Text(text) => format!("{text:?}"),
        ExprKind::At(name, paths) => format!("{}[{}]", name.name, names(paths)),
        ExprKind::Cost(name, paths) => format!("cost {}[{}]", name.name, names(paths)),
        ExprKind::Call(name, args) => format!("{}({})", name.name, names(args)),
        ExprKind::Not(inner) => format!("(! {})", show(inner)),
        ExprKind::Neg(inner) => format!("(- {})", show(inner)),
        ExprKind::And(items) => format!("({})", list(items, " & ")),
        ExprKind::Or(items) => format!("({})", list(items, " | ")),
        ExprKind::Implies(left, right) => format!("({} -> {})", show(left), show(right)),
        ExprKind::Iff(left, right) => format!("({} <-> {})", show(left), show(right)),
        ExprKind::Compare(op, left, right) => format!("({} {} {})", show(left), compare(*op), show(right)),
        ExprKind::Sum(items) => {
            let signed =
                |(minus, item): &(bool, Expr)| format!("{}{}", if *minus { "-" } else { "+" }, show(item));
            format!("({})", items.iter().map(signed).collect::<Vec<_>>().join(" "))
        }
        ExprKind::Arith(op, left, right) => format!("({} {} {})", show(left), arith(*op), show(right)),
        ExprKind::In(left, set) => format!("({} in {})", show(left), show_set(set)),
        ExprKind::Tuple(items) => format!("<{}>", list(items, ",")),
        ExprKind::If(branches, last) => {
            let shown = branches.iter().map(|(c, a)| format!("if {} then {} else ", show(c), show(a)));
            format!("({}{})", shown.collect::<String>(), show(last))
        }
        ExprKind::Unary(op, interval, inner) => {
            let op = match op {
                UnaryOp::Next => "X",
                UnaryOp::WeakNext => "N",
                UnaryOp::Finally => "F",
                UnaryOp::Globally => "G",
            };
            format!("({op}{} {})", show_interval(interval), show(inner))
        }
        ExprKind::Binary(op, interval, left, right) => {
            let op = match op {
                BinaryOp::Until => "U",
                BinaryOp::Release => "R",
                BinaryOp::WeakUntil => "W",
                BinaryOp::StrongRelease => "M",
            };
            format!("({} {op}{} {})", show(left), show_interval(interval), show(right))
        }
    }
}

fn compare(op: CompareOp) -> &'static str {
    match op {
        CompareOp::Eq => "==",
        CompareOp::Ne => "!=",
        CompareOp::Lt => "<",
        CompareOp::Le => "<=",
        CompareOp::Gt => ">",
        CompareOp::Ge => ">=",
    }
}

fn arith(op: ArithOp) -> &'static str {
    match op {
        ArithOp::Mul => "*",
        ArithOp::Divide => "/",
        ArithOp::Div => "div",
        ArithOp::Mod => "%",
    }
}
