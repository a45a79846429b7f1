//! Formulas: temporal operators and Boolean structure become nodes, the rest atoms.

use super::expr::{mismatch, typed};
use super::limits::MAX_BOUND;
use super::paths::PathContext;
use super::typed::Typed;
use super::walk::visit;
use crate::expr::{Expr, PathLeaf};
use crate::formula::{Interval, Node};
use crate::ids::FormulaId;
use crate::objective::Mode;
use hyperplan_syntax::ast::{self, CompareOp, ExprKind};
use hyperplan_syntax::operator::Operator;
use hyperplan_syntax::{Diagnostic, Span};

/// How many definitions are looked through to see whether an operand is a formula.
const LOOK_THROUGH: u32 = 1_000;

impl<'a> PathContext<'a> {
    /// Adds a formula; `None` after a message.
    pub(super) fn formula(&mut self, e: &'a ast::Expr) -> Option<FormulaId> {
        if !self.limits.enter(e.span, self.diagnostics) {
            return None;
        }
        let id = self.formula_inner(e);
        self.limits.leave();
        id
    }

    fn formula_inner(&mut self, e: &'a ast::Expr) -> Option<FormulaId> {
        let node = match &e.kind {
            ExprKind::Not(a) => Node::Not(self.formula(a)?),
            ExprKind::And(es) => Node::And(self.formulas(es)?),
            ExprKind::Or(es) => Node::Or(self.formulas(es)?),
            ExprKind::Implies(a, b) => {
                let (a, b) = self.pair(a, b)?;
                return Some(self.formula.implies(a, b, e.span));
            }
            ExprKind::Iff(a, b) => {
                let (a, b) = self.pair(a, b)?;
                Node::Iff(a, b)
            }
            ExprKind::Compare(CompareOp::Eq, a, b) if self.either_formula(a, b) => {
                let (a, b) = self.pair(a, b)?;
                Node::Iff(a, b)
            }
            ExprKind::Compare(CompareOp::Ne, a, b) if self.either_formula(a, b) => {
                let (a, b) = self.pair(a, b)?;
                Node::Not(self.formula.push(Node::Iff(a, b), e.span))
            }
            ExprKind::If(branches, last)
                if self.is_formula(last) || branches.iter().any(|(c, a)| self.either_formula(c, a)) =>
            {
                return self.choice(branches, last, e.span);
            }
            ExprKind::Call(name, args) => {
                return self.expand(name, args, e.span, |cx, body| cx.formula(body));
            }
            ExprKind::Unary(op, interval, a) => {
                let interval = self.interval(interval.as_ref(), Operator::Unary(*op), e.span);
                let a = self.formula(a)?;
                return Some(self.formula.unary(*op, interval?, a, e.span));
            }
            ExprKind::Binary(op, interval, a, b) => {
                let interval = self.interval(interval.as_ref(), Operator::Binary(*op), e.span);
                let (a, b) = self.pair(a, b)?;
                return Some(self.formula.binary(*op, interval?, a, b, e.span));
            }
            _ => {
                let atom = self.atom(e)?;
                return Some(self.split(atom, e.span));
            }
        };
        Some(self.formula.push(node, e.span))
    }

    fn formulas(&mut self, es: &'a [ast::Expr]) -> Option<Vec<FormulaId>> {
        // All of them before the first failure counts: one run reports all mistakes.
        let ids: Vec<_> = es.iter().map(|e| self.formula(e)).collect();
        ids.into_iter().collect()
    }

    fn pair(&mut self, a: &'a ast::Expr, b: &'a ast::Expr) -> Option<(FormulaId, FormulaId)> {
        let (a, b) = (self.formula(a), self.formula(b));
        a.zip(b)
    }

    /// `if c then a else b` over formulas: `(c & a) | (!c & b)`, from the end of the chain.
    fn choice(
        &mut self,
        branches: &'a [(ast::Expr, ast::Expr)],
        last: &'a ast::Expr,
        span: Span,
    ) -> Option<FormulaId> {
        let lowered: Vec<_> = branches.iter().map(|(c, a)| self.pair(c, a)).collect();
        let mut rest = self.formula(last)?;
        let lowered: Vec<_> = lowered.into_iter().collect::<Option<_>>()?;
        for ((condition, value), (c, _)) in lowered.into_iter().zip(branches).rev() {
            let negated = self.formula.push(Node::Not(condition), c.span);
            let then = self.formula.push(Node::And(vec![condition, value]), span);
            let otherwise = self.formula.push(Node::And(vec![negated, rest]), span);
            rest = self.formula.push(Node::Or(vec![then, otherwise]), span);
        }
        Some(rest)
    }

    /// A Boolean expression without temporal operators.
    fn atom(&mut self, e: &ast::Expr) -> Option<Expr<PathLeaf>> {
        match typed(self, e, None)? {
            Typed::Bool(expr) => Some(expr),
            other => mismatch(self, &other, "a formula", e.span),
        }
    }

    /// Adds an atom, with the connectives at its top as nodes.
    fn split(&mut self, e: Expr<PathLeaf>, span: Span) -> FormulaId {
        let node = match e {
            Expr::Not(a) => Node::Not(self.split(*a, span)),
            Expr::And(es) => Node::And(es.into_iter().map(|e| self.split(e, span)).collect()),
            Expr::Or(es) => Node::Or(es.into_iter().map(|e| self.split(e, span)).collect()),
            Expr::Iff(a, b) => {
                let (a, b) = (self.split(*a, span), self.split(*b, span));
                Node::Iff(a, b)
            }
            atom => Node::Atom(atom),
        };
        self.formula.push(node, span)
    }

    fn either_formula(&self, a: &ast::Expr, b: &ast::Expr) -> bool {
        self.is_formula(a) || self.is_formula(b)
    }

    /// Whether the expression is, by its outermost form, a formula rather than a value; a definition is what its body
    /// is. A mistake here only means that a temporal operator is refused.
    fn is_formula(&self, e: &ast::Expr) -> bool {
        let mut stack = vec![e];
        let mut fuel = LOOK_THROUGH;
        while let Some(e) = stack.pop() {
            fuel -= 1;
            if fuel == 0 {
                return false;
            }
            match &e.kind {
                ExprKind::Not(_)
                | ExprKind::And(_)
                | ExprKind::Or(_)
                | ExprKind::Implies(..)
                | ExprKind::Iff(..)
                | ExprKind::Unary(..)
                | ExprKind::Binary(..) => return true,
                ExprKind::If(branches, last) => {
                    stack.extend(branches.iter().flat_map(|(c, a)| [c, a]).chain([&**last]));
                }
                ExprKind::Call(name, _) => {
                    stack.extend(self.defines.get(name.name.as_str()).map(|(define, _)| &define.body));
                }
                _ => {}
            }
        }
        false
    }

    /// The interval of an operator; `None` after a message.
    fn interval(
        &mut self,
        interval: Option<&'a ast::Interval>,
        op: Operator,
        span: Span,
    ) -> Option<Interval> {
        let row = op.row();
        if !row.interval {
            return Some(Interval::ALWAYS);
        }
        let Some(interval) = interval else {
            if let Mode::Within(_) = self.mode {
                return Some(Interval::ALWAYS);
            }
            let op = row.name;
            let message = format!("`{op}` has no bound");
            let help =
                format!("give it an interval, such as `{op}[0,T]`, or the objective a length: `within K`");
            let diagnostic = Diagnostic::error("unbounded-operator", span, message);
            return self.diagnostics.refuse(diagnostic.with_help(help));
        };
        let lo = match &interval.lo {
            Some(lo) => self.bound(lo),
            None => Some(0),
        };
        let (hi, lo) = (self.bound(&interval.hi)?, lo?);
        if lo > hi {
            let message = format!("the interval [{lo},{hi}] is empty");
            let span = self.blame(&interval.hi).unwrap_or(interval.span);
            return self.diagnostics.refuse(Diagnostic::error("empty-interval", span, message));
        }
        Some(Interval { lo, hi: Some(hi) })
    }

    fn bound(&mut self, e: &'a ast::Expr) -> Option<u32> {
        let value = self.visible().evaluate(e, self.diagnostics)?;
        let span = self.blame(e).unwrap_or(e.span);
        number_of_steps(value, "the bound", span, self.diagnostics)
    }

    /// The argument of the template that a number depends on, if it does: the mistake is there.
    fn blame(&self, e: &ast::Expr) -> Option<Span> {
        if !self.frame.parameters {
            return None;
        }
        let mut place = None;
        visit(e, &mut |e| {
            if let ExprKind::Name(name) = &e.kind {
                place = place.or(self.bindings.numbers.get(name.as_str()).copied());
            }
        });
        place
    }
}

/// Checks a number of steps: from 0 to [`MAX_BOUND`].
pub(super) fn number_of_steps(
    value: i64,
    what: &str,
    span: Span,
    diagnostics: &mut super::Diagnostics,
) -> Option<u32> {
    let diagnostic = if value < 0 {
        Diagnostic::error("negative-bound", span, format!("{what} is negative: {value}"))
    } else if value > MAX_BOUND {
        let message = format!("{what} is too large: {value}");
        Diagnostic::error("bound-too-large", span, message)
            .with_help(format!("it may be at most {MAX_BOUND}"))
    } else {
        return u32::try_from(value).ok();
    };
    diagnostics.refuse(diagnostic)
}
