//! Models in other forms as modules of SMV: what is common to them.

use crate::parser::Parse;
use crate::tree::{Expr, Infix, Item, Kind, Module, Moment, Name, Role, Type, TypeKind};
use hyperplan_syntax::ast::Ident;
use hyperplan_syntax::{Diagnostic, SourceId, Span};
use rustc_hash::FxHashMap;

/// More variables, gates or states than this are refused.
pub(crate) const MAX_PARTS: usize = 1_000_000;

pub(crate) fn wrong<T>(code: &'static str, span: Span, message: impl Into<String>) -> Parse<T> {
    Err(Box::new(Diagnostic::error(code, span, message)))
}

pub(crate) fn name(text: &str, span: Span) -> Expr {
    Expr::new(Kind::Name(Name { base: text.to_owned(), access: Vec::new() }), span)
}

pub(crate) fn truth(value: bool, span: Span) -> Expr {
    Expr::new(Kind::Bool(value), span)
}

pub(crate) fn int(value: i64, span: Span) -> Expr {
    Expr::new(Kind::Int(value), span)
}

pub(crate) fn not(a: Expr, span: Span) -> Expr {
    Expr::new(Kind::Not(Box::new(a)), span)
}

pub(crate) fn infix(op: Infix, a: Expr, b: Expr, span: Span) -> Expr {
    Expr::new(Kind::Infix(op, Box::new(a), Box::new(b)), span)
}

/// One of some values, of which there is at least one.
pub(crate) fn one_of(mut values: Vec<Expr>, span: Span) -> Expr {
    match values.pop() {
        Some(only) if values.is_empty() => only,
        last => {
            values.extend(last);
            Expr::new(Kind::Set(values), span)
        }
    }
}

/// The module `main` with these items.
pub(crate) fn main(items: Vec<Item>, span: Span) -> Vec<Module> {
    let name = Ident { name: "main".to_owned(), span };
    vec![Module { name, params: Vec::new(), items }]
}

pub(crate) fn boolean(role: Role, ident: Ident) -> Item {
    let span = ident.span;
    Item::Var(role, ident, Type { kind: TypeKind::Bool, span })
}

pub(crate) fn assign(moment: Moment, left: Expr, right: Expr) -> Item {
    Item::Assign(moment, left, right)
}

/// Names of one model, each once.
#[derive(Debug, Default)]
pub(crate) struct Unique {
    taken: FxHashMap<String, ()>,
}

impl Unique {
    /// The name, with `_` behind it until it is new.
    pub(crate) fn name(&mut self, text: &str) -> String {
        let mut name = text.to_owned();
        while self.taken.insert(name.clone(), ()).is_some() {
            name.push('_');
        }
        name
    }
}

/// A text line by line, with places.
pub(crate) struct Lines<'a> {
    source: SourceId,
    text: &'a str,
    at: usize,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(source: SourceId, text: &'a str) -> Self {
        Lines { source, text, at: 0 }
    }

    /// The next line without its end, and where it is.
    pub(crate) fn next(&mut self) -> Option<(&'a str, Span)> {
        let rest = &self.text[self.at..];
        if rest.is_empty() {
            return None;
        }
        let whole = rest.find('\n').map_or(rest, |end| &rest[..=end]);
        let line = whole.trim_end_matches(['\n', '\r']);
        let span = Span::new(self.source, self.at..self.at + line.len());
        self.at += whole.len();
        Some((line, span))
    }

    /// The place behind the last line.
    pub(crate) fn end(&self) -> Span {
        Span::new(self.source, self.text.len()..self.text.len())
    }
}
