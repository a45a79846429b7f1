//! Values of enumerations. SMV compares those of different enumerations; the problem language does not.

use super::{Lower, Val, choice, compare, e, not, wrong};
use crate::parser::Parse;
use hyperplan_syntax::ast::{self, CompareOp, ExprKind};
use hyperplan_syntax::{Span, is_name};
use std::rc::Rc;

/// A symbol, by how it comes about.
#[derive(Clone, Debug)]
pub(crate) enum Symbolic {
    Constant(String),
    /// Read of a variable or label of that enumeration.
    Read(ast::Expr, Rc<[String]>),
    /// As the first condition that holds says, or the last.
    Choice(Vec<(ast::Expr, Symbolic)>, Box<Symbolic>),
}

/// A value as it is written.
fn constant(name: &str, span: Span) -> ast::Expr {
    let kind = if is_name(name) { ExprKind::Name(name.to_owned()) } else { ExprKind::Text(name.to_owned()) };
    e(kind, span)
}

impl Symbolic {
    /// The one enumeration of all that is read in it, if it also has all constants.
    pub(crate) fn enumeration(&self) -> Option<Rc<[String]>> {
        let (mut found, mut constants) = (None, Vec::new());
        let mut stack = vec![self];
        while let Some(symbol) = stack.pop() {
            match symbol {
                Symbolic::Constant(name) => constants.push(name),
                Symbolic::Read(_, of) if found.as_ref().is_none_or(|found| found == of) => {
                    found = Some(of.clone())
                }
                Symbolic::Read(..) => return None,
                Symbolic::Choice(branches, last) => {
                    stack.extend(branches.iter().map(|(_, symbol)| symbol).chain([&**last]));
                }
            }
        }
        found.filter(|of| constants.iter().all(|name| of.contains(name)))
    }
}

impl Lower<'_> {
    pub(super) fn joined_symbols(
        &mut self,
        conditions: Vec<ast::Expr>,
        values: Vec<Val>,
        span: Span,
    ) -> Parse<Val> {
        let symbols = values.into_iter().map(|value| as_symbol(value, span));
        let mut symbols: Vec<Symbolic> = symbols.collect::<Parse<_>>()?;
        let Some(mut last) = symbols.pop() else { return wrong("type-mismatch", span, "no values") };
        let mut branches: Vec<_> = conditions.into_iter().zip(symbols).collect();
        if let Symbolic::Choice(more, end) = last {
            branches.extend(more);
            last = *end;
        }
        Ok(Val::Symbol(if branches.is_empty() { last } else { Symbolic::Choice(branches, Box::new(last)) }))
    }

    /// A symbol as a value of that enumeration. What may be none of its values is refused.
    pub(crate) fn as_value_of(
        &mut self,
        symbol: Symbolic,
        of: &Rc<[String]>,
        span: Span,
    ) -> Parse<ast::Expr> {
        match symbol {
            Symbolic::Constant(name) if of.contains(&name) => Ok(constant(&name, span)),
            Symbolic::Constant(name) => {
                let values = of.join(", ");
                wrong("unknown-name", span, format!("`{name}` is not one of {{{values}}}"))
            }
            Symbolic::Read(read, own) if own == *of => Ok(read),
            Symbolic::Read(read, own) => {
                if let Some(other) = own.iter().find(|value| !of.contains(value)) {
                    let values = of.join(", ");
                    return wrong(
                        "type-mismatch",
                        span,
                        format!("this may be `{other}`, which is not one of {{{values}}}"),
                    );
                }
                let (last, rest) =
                    own.split_last().map_or((String::new(), &own[..]), |(l, r)| (l.clone(), r));
                let mut branches = Vec::new();
                for value in rest {
                    let read = self.copy(&read)?;
                    let is = compare(CompareOp::Eq, read, constant(value, span), span);
                    branches.push((is, constant(value, span)));
                }
                Ok(choice(branches, constant(&last, span), span))
            }
            Symbolic::Choice(branches, last) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, symbol) in branches {
                    kept.push((condition, self.as_value_of(symbol, of, span)?));
                }
                Ok(choice(kept, self.as_value_of(*last, of, span)?, span))
            }
        }
    }

    pub(super) fn same_symbol(&mut self, a: Symbolic, b: Symbolic, span: Span) -> Parse<ast::Expr> {
        let truth = |b| Ok(e(ExprKind::Bool(b), span));
        match (a, b) {
            (Symbolic::Constant(a), Symbolic::Constant(b)) => truth(a == b),
            (Symbolic::Constant(name), Symbolic::Read(read, of))
            | (Symbolic::Read(read, of), Symbolic::Constant(name)) => {
                if !of.contains(&name) {
                    return truth(false);
                }
                Ok(compare(CompareOp::Eq, read, constant(&name, span), span))
            }
            (Symbolic::Read(a, of), Symbolic::Read(b, other)) if of == other => {
                Ok(compare(CompareOp::Eq, a, b, span))
            }
            (Symbolic::Read(a, of), Symbolic::Read(b, other)) => {
                let mut ways = Vec::new();
                for value in of.iter().filter(|value| other.contains(value)) {
                    let (a, b) = (self.copy(&a)?, self.copy(&b)?);
                    let a = compare(CompareOp::Eq, a, constant(value, span), span);
                    let b = compare(CompareOp::Eq, b, constant(value, span), span);
                    ways.push(e(ExprKind::And(vec![a, b]), span));
                }
                Ok(match ways.len() {
                    0 => e(ExprKind::Bool(false), span),
                    1 => ways.remove(0),
                    _ => e(ExprKind::Or(ways), span),
                })
            }
            (Symbolic::Choice(branches, last), other) | (other, Symbolic::Choice(branches, last)) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, symbol) in branches {
                    let other = self.copy_symbol(&other, span)?;
                    kept.push((condition, self.same_symbol(symbol, other, span)?));
                }
                Ok(choice(kept, self.same_symbol(*last, other, span)?, span))
            }
        }
    }

    fn copy_symbol(&mut self, symbol: &Symbolic, span: Span) -> Parse<Symbolic> {
        let mut size = 0;
        let mut stack = vec![symbol];
        while let Some(symbol) = stack.pop() {
            size += 1;
            if let Symbolic::Choice(branches, last) = symbol {
                for (condition, symbol) in branches {
                    self.copy(condition)?;
                    stack.push(symbol);
                }
                stack.push(last);
            }
        }
        self.count(size, span)?;
        Ok(symbol.clone())
    }
}

/// A symbol; numbers are symbols where symbols are.
pub(super) fn as_symbol(value: Val, span: Span) -> Parse<Symbolic> {
    match value {
        Val::Symbol(symbol) => Ok(symbol),
        Val::Int(_, lo, hi) if lo == hi => Ok(Symbolic::Constant(lo.to_string())),
        other => wrong("type-mismatch", span, format!("expected a symbol, found {}", other.describe())),
    }
}

/// That a truth value is false.
pub(super) fn negation(a: ast::Expr) -> ast::Expr {
    not(a)
}
