//! What an update chooses from, where that depends on the state: `v' in if C then {1, 2} else 0..x;`.
//!
//! The lower end of a range may begin with `if` as well, `v' in if C then 1 else 2 .. 5;`. What stands behind the first
//! `then` tells the two apart.

use super::expr::Node;
use super::{MAX_NESTING, Parse, Parser};
use crate::ast::{Expr, ExprKind, Set};
use crate::operator::level;
use crate::span::Span;
use crate::token::Tok;

/// What stands behind `then` and `else`.
pub(super) enum Branch {
    Set(Set),
    Value(Node),
}

/// The branches of one chain, which are of one kind.
enum Branches {
    Unknown,
    Sets(Vec<(Expr, Set)>),
    Values(Vec<(Expr, Expr)>),
}

impl Parser<'_> {
    /// `if C then SET else SET`, or the same with values; and its height.
    #[inline(never)]
    pub(super) fn conditional_set(&mut self) -> Parse<(Branch, u32)> {
        if self.depth >= MAX_NESTING {
            return self.too_deep(self.token().span);
        }
        self.depth += 1;
        let start = self.token().span;
        let (mut branches, mut height) = (Branches::Unknown, 0);
        while self.eat(Tok::If).is_some() {
            let condition = self.node(level::LOWEST)?;
            self.expect(Tok::Then, "`then`")?;
            let (branch, own) = self.branch(&branches)?;
            self.expect_else()?;
            height = height.max(condition.height).max(own);
            match (&mut branches, branch) {
                (Branches::Sets(sets), Branch::Set(set)) => sets.push((*condition.expr, set)),
                (Branches::Values(values), Branch::Value(node)) => values.push((*condition.expr, *node.expr)),
                (all @ Branches::Unknown, Branch::Set(set)) => {
                    *all = Branches::Sets(vec![(*condition.expr, set)]);
                }
                (all @ Branches::Unknown, Branch::Value(node)) => {
                    *all = Branches::Values(vec![(*condition.expr, *node.expr)]);
                }
                _ => return self.mixed(),
            }
        }
        let (last, own) = self.branch(&branches)?;
        self.depth -= 1;
        self.chain(branches, last, height.max(own), start)
    }

    fn chain(&mut self, branches: Branches, last: Branch, height: u32, start: Span) -> Parse<(Branch, u32)> {
        let whole = self.since(start);
        match (branches, last) {
            (Branches::Sets(mut sets), Branch::Set(mut last)) => {
                if let Set::If(more, end, _) = last {
                    sets.extend(more);
                    last = *end;
                }
                Ok((Branch::Set(Set::If(sets, Box::new(last), whole)), height + 1))
            }
            (Branches::Values(values), Branch::Value(last)) => {
                let node = self.inner(ExprKind::If(values, last.expr), whole, height, start)?;
                Ok((Branch::Value(node), height + 1))
            }
            _ => self.mixed(),
        }
    }

    /// A set, or a value where the branches before are values.
    fn branch(&mut self, before: &Branches) -> Parse<(Branch, u32)> {
        match (self.peek(), before) {
            (Tok::If, _) => return self.conditional_set(),
            (Tok::LBrace, Branches::Unknown | Branches::Sets(_)) => {
                let (set, height) = self.set_and_height(true)?;
                return Ok((Branch::Set(set), height));
            }
            _ => {}
        }
        let lo = self.node(level::SUM)?;
        let height = lo.height;
        match (self.peek(), before) {
            (Tok::DotDot, Branches::Unknown | Branches::Sets(_)) => {
                self.bump();
                let hi = self.node(level::SUM)?;
                Ok((Branch::Set(Set::Range(lo.expr, hi.expr)), height.max(hi.height)))
            }
            (_, Branches::Sets(_)) => self.mixed(),
            _ => Ok((Branch::Value(lo), height)),
        }
    }

    fn mixed<T>(&mut self) -> Parse<T> {
        let help = "where one case is a set, all are: a single value is written `{x}`";
        self.fail_with("a set", Some(help.to_owned()))
    }
}
