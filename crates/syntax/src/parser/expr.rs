//! Expressions and formulas, by operator precedence.
//!
//! Operators wait on a stack for their right operand, so that chains and prefixes cost no call
//! stack. Every node knows its height, which [`MAX_NESTING`] bounds. Where `inline(never)` stands,
//! it keeps the frames of the functions that do recurse small.

use super::{Abort, MAX_NESTING, Parse, Parser};
use crate::ast::{Expr, ExprKind, Interval};
use crate::diagnostic::Diagnostic;
use crate::operator::{Fixity, Operator, Row, TABLE, level};
use crate::span::Span;
use crate::token::Tok;

/// An expression on its way into the tree. Small, since the call stack holds many of them.
pub(super) struct Node {
    pub(super) expr: Box<Expr>,
    /// With the parentheses around it.
    pub(super) outer: Span,
    /// Of the tree below.
    pub(super) height: u32,
}

impl Node {
    pub(super) fn leaf(kind: ExprKind, span: Span) -> Node {
        Node { expr: Box::new(Expr { kind, span }), outer: span, height: 1 }
    }

    /// A comparison that no parentheses protect.
    fn is_bare_comparison(&self) -> bool {
        self.outer == self.expr.span && matches!(self.expr.kind, ExprKind::Compare(..) | ExprKind::In(..))
    }
}

/// An interval and the height of its bounds.
pub(super) type Bounds = Option<(Interval, u32)>;

/// An operator that waits for its right operand.
enum Pending {
    Prefix {
        op: &'static Row,
        bounds: Bounds,
        span: Span,
    },
    Infix {
        op: &'static Row,
        bounds: Bounds,
        span: Span,
        left: Node,
    },
    /// `&`, `|`, or `+` and `-`: what stands to the left, and whether the next operand is subtracted.
    Flat {
        op: &'static Row,
        items: Vec<(bool, Expr)>,
        start: Span,
        height: u32,
        minus: bool,
    },
}

impl Pending {
    fn level(&self) -> u8 {
        match self {
            Pending::Prefix { op, .. } | Pending::Infix { op, .. } | Pending::Flat { op, .. } => op.level,
        }
    }
}

impl Parser<'_> {
    /// A whole expression or formula.
    pub(super) fn expr(&mut self) -> Parse<Expr> {
        Ok(*self.node(level::LOWEST)?.expr)
    }

    /// An expression without comparisons and logic, as bounds are.
    pub(super) fn arithmetic(&mut self) -> Parse<Expr> {
        Ok(*self.node(level::SUM)?.expr)
    }

    /// An expression of operators that bind at least as tightly as `least`.
    pub(super) fn node(&mut self, least: u8) -> Parse<Node> {
        if self.depth >= MAX_NESTING {
            return self.too_deep(self.token().span);
        }
        self.depth += 1;
        let node = self.operators(least);
        self.depth -= 1;
        node
    }

    #[inline(never)]
    pub(super) fn too_deep<T>(&mut self, span: Span) -> Parse<T> {
        let message = format!("this expression is nested more than {MAX_NESTING} levels deep");
        self.report(
            Diagnostic::error("too-deep", span, message).with_help("name parts of it by `define` or `label`"),
        );
        Err(Abort)
    }

    fn operators(&mut self, least: u8) -> Parse<Node> {
        let mut stack = Vec::new();
        loop {
            self.prefixes(&mut stack)?;
            let mut node = self.operand(least)?;
            loop {
                let Some((op, span)) = self.infix(least) else {
                    return self.reduce(&mut stack, node, None);
                };
                node = self.reduce(&mut stack, node, Some(op))?;
                if op.level == level::COMPARE && node.is_bare_comparison() {
                    self.report(
                        Diagnostic::error("chained-comparison", span, "comparisons cannot be chained")
                            .with_help("write `a < b & b < c`, or put parentheses around one of them"),
                    );
                }
                if op.operator == Operator::In {
                    node = self.membership(node)?;
                } else {
                    self.shift(&mut stack, op, span, node)?;
                    break;
                }
            }
        }
    }

    /// Puts `node OP` on the stack.
    #[inline(never)]
    fn shift(&mut self, stack: &mut Vec<Pending>, op: &'static Row, span: Span, node: Node) -> Parse<()> {
        if stack.len() >= MAX_NESTING as usize {
            return self.too_deep(span);
        }
        if op.fixity != Fixity::Flat {
            let bounds = if op.interval { self.bounds()? } else { None };
            stack.push(Pending::Infix { op, bounds, span, left: node });
            return Ok(());
        }
        let next_is_minus = op.operator == Operator::Minus;
        match stack.last_mut() {
            Some(Pending::Flat { op: same, items, height, minus, .. }) if same.level == op.level => {
                items.push((*minus, *node.expr));
                *height = node.height.max(*height);
                *minus = next_is_minus;
            }
            _ => stack.push(Pending::Flat {
                op,
                items: vec![(false, *node.expr)],
                start: node.outer,
                height: node.height,
                minus: next_is_minus,
            }),
        }
        Ok(())
    }

    /// Gives `node` to the operators on the stack that bind it more tightly than `next` does; to
    /// all of them where nothing follows.
    #[inline(never)]
    fn reduce(&mut self, stack: &mut Vec<Pending>, mut node: Node, next: Option<&Row>) -> Parse<Node> {
        while let Some(top) = stack.last() {
            if let Some(next) = next {
                let waits_on_equal = matches!(next.fixity, Fixity::Right | Fixity::Flat);
                if top.level() < next.level || top.level() == next.level && waits_on_equal {
                    break;
                }
            }
            let Some(top) = stack.pop() else { break };
            node = self.apply(top, node)?;
        }
        Ok(node)
    }

    #[inline(never)]
    fn apply(&mut self, pending: Pending, right: Node) -> Parse<Node> {
        match pending {
            Pending::Prefix { op, bounds, span } => {
                let (interval, bound_height) = unzip(bounds);
                let height = right.height.max(bound_height);
                let operand = right.expr;
                let kind = match op.operator {
                    Operator::Not => ExprKind::Not(operand),
                    Operator::Neg => ExprKind::Neg(operand),
                    Operator::Unary(op) => ExprKind::Unary(op, interval, operand),
                    // The others stand between operands.
                    _ => return Err(Abort),
                };
                self.inner(kind, span.to(right.outer), height, span)
            }
            Pending::Infix { op, bounds, span, left } => {
                let (interval, bound_height) = unzip(bounds);
                let height = left.height.max(right.height).max(bound_height);
                let whole = left.outer.to(right.outer);
                let (left, right) = (left.expr, right.expr);
                let kind = match op.operator {
                    Operator::Iff => ExprKind::Iff(left, right),
                    Operator::Implies => ExprKind::Implies(left, right),
                    Operator::Binary(op) => ExprKind::Binary(op, interval, left, right),
                    Operator::Compare(op) => ExprKind::Compare(op, left, right),
                    Operator::Arith(op) => ExprKind::Arith(op, left, right),
                    // `shift` makes none of the others: they are flat, or have a set to their right.
                    _ => return Err(Abort),
                };
                self.inner(kind, whole, height, span)
            }
            Pending::Flat { op, mut items, start, height, minus } => {
                let whole = start.to(right.outer);
                let height = height.max(right.height);
                items.push((minus, *right.expr));
                let unsigned = |items: Vec<(bool, Expr)>| items.into_iter().map(|(_, item)| item).collect();
                let kind = match op.operator {
                    Operator::And => ExprKind::And(unsigned(items)),
                    Operator::Or => ExprKind::Or(unsigned(items)),
                    _ => ExprKind::Sum(items),
                };
                self.inner(kind, whole, height, start)
            }
        }
    }

    /// A node above others, the highest of which has `height`; `mark` is shown if that is too much.
    #[inline(never)]
    pub(super) fn inner(&mut self, kind: ExprKind, span: Span, height: u32, mark: Span) -> Parse<Node> {
        if height >= MAX_NESTING {
            return self.too_deep(mark);
        }
        Ok(Node { expr: Box::new(Expr { kind, span }), outer: span, height: height + 1 })
    }

    /// The operator at the present token, if it binds at least as tightly as `least`.
    #[inline(never)]
    fn infix(&mut self, least: u8) -> Option<(&'static Row, Span)> {
        let token = self.token();
        // A contextual name may begin the next update, where a `;` is missing.
        let own = token.infix().filter(|row| !row.contextual || self.peek_at(1) != Tok::Prime);
        let op = own.or_else(|| token.slip(false)).filter(|op| op.level >= least)?;
        self.bump();
        if own.is_none() {
            let message = format!("`{}` is not an operator here", token.text);
            let help = match token.text {
                "=>" => "write `->` for implication, `>=` for \"at least\"".to_owned(),
                _ => format!("write `{}`", op.name),
            };
            self.wrong(token.span, message, help);
        }
        Some((op, token.span))
    }

    /// Puts the prefix operators at this place on the stack.
    #[inline(never)]
    fn prefixes(&mut self, stack: &mut Vec<Pending>) -> Parse<()> {
        while let Some((op, span)) = self.prefix() {
            if stack.len() >= MAX_NESTING as usize {
                return self.too_deep(span);
            }
            if stack.last().is_some_and(|top| top.level() > op.level) {
                let text = self.text.get(span.range()).unwrap_or("");
                self.report(
                    Diagnostic::error("needs-parentheses", span, format!("`{text}` needs parentheses here"))
                        .with_help(format!(
                            "comparisons and arithmetic bind more tightly: write `a == ({text} b)`"
                        )),
                );
            }
            let temporal = matches!(op.operator, Operator::Unary(_));
            let bounds = if temporal { self.bounds()? } else { None };
            if let Some((interval, _)) = bounds.as_ref().filter(|_| !op.interval) {
                self.misplaced_interval(op.name, interval.span);
            }
            stack.push(Pending::Prefix { op, bounds, span });
        }
        Ok(())
    }

    #[inline(never)]
    fn misplaced_interval(&mut self, name: &str, span: Span) {
        let error = Diagnostic::error("interval-not-allowed", span, format!("`{name}` takes no interval"));
        self.report(
            error.with_help(format!("`{name}` always speaks of the next step; repeat it for later ones")),
        );
    }

    #[inline(never)]
    fn prefix(&mut self) -> Option<(&'static Row, Span)> {
        let token = self.token();
        if let Some(op) = token.prefix() {
            self.bump();
            return Some((op, token.span));
        }
        let op = match token.tok {
            Tok::LBracket if self.peek_at(1) == Tok::RBracket => {
                self.bump();
                TABLE.iter().find(|row| row.slips.contains(&"[]"))?
            }
            Tok::Foreign => token.slip(true)?,
            Tok::Ident if self.operand_follows() => token.slip(true)?,
            _ => return None,
        };
        self.bump();
        let span = self.since(token.span);
        let text = self.text.get(span.range()).unwrap_or("");
        self.wrong(span, format!("`{text}` is not an operator here"), format!("write `{}`", op.name));
        Some((op, span))
    }

    /// Whether the word at this place cannot be a name, since an operand follows it.
    fn operand_follows(&self) -> bool {
        match self.peek_at(1) {
            // `within K semantics S` is the one place where a word follows a number's name.
            Tok::Ident => {
                let next = self.token_at(1);
                next.text != "semantics" && next.infix().or(next.slip(false)).is_none()
            }
            Tok::Number | Tok::True | Tok::False | Tok::Op(Operator::Not | Operator::Unary(_)) => true,
            Tok::Foreign => self.token_at(1).text == "~",
            // `not(p)` may be the use of a definition, `not (x == 1)` may not.
            Tok::LParen => match self.peek_at(2) {
                Tok::Ident => !matches!(self.peek_at(3), Tok::RParen | Tok::Comma),
                inside => inside != Tok::RParen,
            },
            _ => false,
        }
    }
}

fn unzip(bounds: Bounds) -> (Option<Interval>, u32) {
    bounds.map_or((None, 0), |(interval, height)| (Some(interval), height))
}
