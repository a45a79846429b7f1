//! Operands: names, brackets, conditionals; and what else of an operator has brackets, intervals
//! and sets.

use super::choice::Branch;
use super::expr::{Bounds, Node};
use super::item::MINIMIZE;
use super::{Abort, Parse, Parser, ident};
use crate::ast::{Expr, ExprKind, Interval, Set};
use crate::diagnostic::Diagnostic;
use crate::operator::{Operator, TABLE, level};
use crate::span::Span;
use crate::token::Tok;

impl Parser<'_> {
    /// `[a,b]` or `[b]`, where one stands.
    #[inline(never)]
    pub(super) fn bounds(&mut self) -> Parse<Bounds> {
        if self.peek() != Tok::LBracket || self.peek_at(1) == Tok::RBracket {
            self.check_interval_brackets()?;
            return Ok(None);
        }
        let open = self.bump();
        let first = self.node(level::SUM)?;
        let mut height = first.height;
        let mut interval = Interval { lo: None, hi: first.expr, span: open.span };
        if let Some(dots) = self.eat(Tok::DotDot) {
            self.wrong(dots.span, "an interval has a comma between its ends", "write `[a,b]`");
        } else if self.eat(Tok::Comma).is_none() {
            self.expect(Tok::RBracket, "`,` or `]`")?;
            interval.span = self.since(open.span);
            return Ok(Some((interval, height)));
        }
        let second = self.node(level::SUM)?;
        height = height.max(second.height);
        interval.lo = Some(std::mem::replace(&mut interval.hi, second.expr));
        if self.peek() == Tok::RParen {
            return self.fail_with("`]`", Some("both ends belong to an interval: `[a,b]`".to_owned()));
        }
        self.expect(Tok::RBracket, "`]`")?;
        interval.span = self.since(open.span);
        Ok(Some((interval, height)))
    }

    /// The set to the right of `in`, and `left` in it.
    #[inline(never)]
    pub(super) fn membership(&mut self, left: Node) -> Parse<Node> {
        let start = self.token().span;
        let (set, height) = self.set_and_height(false)?;
        let whole = self.since(left.outer);
        self.inner(ExprKind::In(left.expr, set), whole, left.height.max(height), start)
    }

    /// What an update chooses from: `{E, ...}`, `LO..HI`, or one of several by condition.
    pub(super) fn set(&mut self) -> Parse<Set> {
        Ok(self.set_and_height(true)?.0)
    }

    /// `{E, ...}`, `LO..HI` or `enabled[p]`; where there is a choice, also a conditional set.
    #[inline(never)]
    pub(super) fn set_and_height(&mut self, choice: bool) -> Parse<(Set, u32)> {
        let start = self.token();
        if self.eat(Tok::LBrace).is_some() {
            let (items, height) = self.list(Tok::RBrace, "`,` or `}`")?;
            return Ok((Set::List(items, self.since(start.span)), height));
        }
        if self.at_word("enabled") && self.peek_at(1) == Tok::LBracket {
            self.bump();
            self.bump();
            let path = self.name("a path variable")?;
            self.expect(Tok::RBracket, "`]`")?;
            return Ok((Set::Enabled(path, self.since(start.span)), 1));
        }
        let lo = match self.peek() {
            Tok::If if choice => match self.conditional_set()? {
                (Branch::Set(set), height) => return Ok((set, height)),
                (Branch::Value(lo), _) => lo,
            },
            _ => self.node(level::SUM)?,
        };
        if self.peek() != Tok::DotDot {
            let help = "a set is written `{a, b}`, `0..2` or `enabled[p]`";
            return self.fail_with("`..`", Some(help.to_owned()));
        }
        self.bump();
        let hi = self.node(level::SUM)?;
        let height = lo.height.max(hi.height);
        Ok((Set::Range(lo.expr, hi.expr), height))
    }

    /// One or more expressions with commas between them, up to `close`; and the greatest height.
    #[inline(never)]
    fn list(&mut self, close: Tok, expected: &str) -> Parse<(Vec<Expr>, u32)> {
        let mut items = Vec::new();
        let mut height = 0;
        loop {
            let item = self.node(level::LOWEST)?;
            height = height.max(item.height);
            items.push(*item.expr);
            if self.eat(Tok::Comma).is_none() {
                break;
            }
        }
        self.expect(close, expected)?;
        Ok((items, height))
    }

    pub(super) fn operand(&mut self, least: u8) -> Parse<Node> {
        let token = self.token();
        let kind = match token.tok {
            Tok::Number => ExprKind::Number(token.text.to_owned()),
            Tok::True => ExprKind::Bool(true),
            Tok::False => ExprKind::Bool(false),
            Tok::Ident => return self.named(),
            Tok::Str => {
                let quoted = self.string("a name in quotes")?;
                return Ok(Node::leaf(ExprKind::Text(quoted.text), quoted.span));
            }
            Tok::LParen => return self.parenthesized(),
            Tok::If => return self.conditional(least),
            _ => return self.no_operand(),
        };
        self.bump();
        Ok(Node::leaf(kind, token.span))
    }

    /// `NAME`, `NAME'`, `NAME[p]` or `NAME(p, ...)`.
    #[inline(never)]
    fn named(&mut self) -> Parse<Node> {
        let token = self.bump();
        let costs = token.text == "cost" && self.peek() == Tok::Ident && self.peek_at(1) == Tok::LBracket;
        let kind = match self.peek() {
            _ if costs => {
                let cost = ident(self.bump());
                self.bump();
                let paths = self.names("a path variable")?;
                self.expect(Tok::RBracket, "`]` after the path variable")?;
                ExprKind::Cost(cost, paths)
            }
            Tok::LBracket => {
                self.bump();
                let paths = self.names("a path variable")?;
                self.expect(Tok::RBracket, "`]` after the path variable")?;
                ExprKind::At(ident(token), paths)
            }
            Tok::LParen => ExprKind::Call(ident(token), self.parenthesized_names("a path variable")?),
            Tok::Prime if self.primes => {
                self.bump();
                ExprKind::Primed(token.text.to_owned())
            }
            _ => {
                self.check_glued(token.text)?;
                ExprKind::Name(token.text.to_owned())
            }
        };
        Ok(Node::leaf(kind, self.since(token.span)))
    }

    /// Explains `F_T goal[p]` and `GF goal[p]`, which the lexer reads as names.
    fn check_glued(&mut self, text: &str) -> Parse<()> {
        let token = self.token();
        let operand = matches!(token.tok, Tok::Ident | Tok::Number)
            || token.prefix().is_some_and(|row| row.operator != Operator::Neg);
        let operator = token.infix().or(token.slip(false)).is_some();
        if !operand || operator || token.first_on_line || self.at_word("semantics") || self.at_word(MINIMIZE)
        {
            return Ok(());
        }
        let span = self.tokens[self.at - 1].span;
        let unary = |c: char| {
            let is = |name: &str| name.chars().eq([c]);
            TABLE.iter().any(|row| matches!(row.operator, Operator::Unary(_)) && is(row.name))
        };
        let bounded = |op: &str| TABLE.iter().any(|row| row.interval && row.name == op);
        let help = match text.split_once('_') {
            Some((op, bound)) if bounded(op) && !bound.is_empty() => {
                format!("an operator and its bound are written `{op}[0,{bound}]`")
            }
            None if text.chars().all(unary) => {
                let apart: Vec<String> = text.chars().map(String::from).collect();
                format!("put blanks between operators: `{}`", apart.join(" "))
            }
            _ => return Ok(()),
        };
        self.wrong(span, format!("`{text}` is read as one name"), help);
        Err(Abort)
    }

    /// `(E)` or `(E, E, ...)`.
    #[inline(never)]
    fn parenthesized(&mut self) -> Parse<Node> {
        let open = self.bump();
        let mut node = self.node(level::LOWEST)?;
        if self.eat(Tok::RParen).is_some() {
            node.outer = self.since(open.span);
            return Ok(node);
        }
        if self.eat(Tok::Comma).is_none() {
            return self.unclosed_parenthesis(open.span);
        }
        let (rest, height) = self.list(Tok::RParen, "`,` or `)`")?;
        let mut items = vec![*node.expr];
        items.extend(rest);
        let whole = self.since(open.span);
        let name = self.peek() == Tok::Ident && self.token().infix().is_none();
        if name && !self.token().first_on_line && self.peek_at(1) == Tok::LBracket {
            let help = "an interval is written in brackets: `F[0,T] goal[p]`";
            return self.fail_with("an operator", Some(help.to_owned()));
        }
        self.inner(ExprKind::Tuple(items), whole, node.height.max(height), open.span)
    }

    #[inline(never)]
    fn unclosed_parenthesis<T>(&mut self, open: Span) -> Parse<T> {
        let token = self.token();
        if token.tok != Tok::Bad {
            let message = format!("expected an operator or `)`, found {}", token.describe());
            let error = Diagnostic::error("syntax", token.span, message).with_label("not expected here");
            self.report(error.with_related(open, "opened here"));
        }
        Err(Abort)
    }

    /// `if C then A else B`; `B` reaches as far to the right as the expression around may.
    #[inline(never)]
    fn conditional(&mut self, least: u8) -> Parse<Node> {
        let start = self.token();
        let (mut branches, mut height) = (Vec::new(), 0);
        while self.eat(Tok::If).is_some() {
            let condition = self.node(level::LOWEST)?;
            self.expect(Tok::Then, "`then`")?;
            let yes = self.node(level::LOWEST)?;
            self.expect_else()?;
            height = height.max(condition.height).max(yes.height);
            branches.push((*condition.expr, *yes.expr));
        }
        let mut last = self.node(least)?;
        height = height.max(last.height);
        // The same chain in parentheses.
        if let ExprKind::If(more, end) = last.expr.kind {
            branches.extend(more);
            last.expr = end;
        }
        self.inner(ExprKind::If(branches, last.expr), self.since(start.span), height, start.span)
    }

    #[inline(never)]
    pub(super) fn expect_else(&mut self) -> Parse<()> {
        if self.eat(Tok::Else).is_some() {
            return Ok(());
        }
        self.fail_with("`else`", Some("an `if` always has an `else`".to_owned()))
    }

    #[inline(never)]
    fn no_operand<T>(&mut self) -> Parse<T> {
        let token = self.token();
        let help = match token.tok {
            Tok::Exists | Tok::Forall => {
                "quantifiers stand in front of the whole formula: `exists p. forall q. ...`"
            }
            Tok::Op(Operator::Binary(_)) => "this operator stands between two formulas: `a U b`",
            Tok::Ident | Tok::Number => return self.fail("an expression"),
            Tok::Op(Operator::Implies) if self.behind().end == token.span.start && self.at > 0 => {
                "write `->`"
            }
            Tok::Assign if self.behind().start == token.span.start => "equality is written `==`",
            _ => return self.fail("an expression"),
        };
        self.fail_with("an expression", Some(help.to_owned()))
    }
}
