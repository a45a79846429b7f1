//! What the operators mean, in the forms of the core: the one place that says it.

use crate::formula::{Formula, Interval, Node, Written};
use crate::ids::FormulaId;
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::operator::Operator;

impl Formula {
    /// `f -> g`
    pub fn implies(&mut self, f: FormulaId, g: FormulaId, span: Span) -> FormulaId {
        let unless = self.push(Node::Not(f), span);
        let written =
            Written { operator: Operator::Implies, interval: Interval::ALWAYS, operands: vec![f, g] };
        self.push_written(Node::Or(vec![unless, g]), written, span)
    }

    /// A temporal operator before a formula; `i` is its interval, if it takes one.
    pub fn unary(&mut self, op: UnaryOp, i: Interval, f: FormulaId, span: Span) -> FormulaId {
        let node = match op {
            UnaryOp::Next => return self.push(Node::Next(f), span),
            UnaryOp::WeakNext => return self.push(Node::WeakNext(f), span),
            UnaryOp::Finally => Node::Until(i, self.truth(true, span), f),
            UnaryOp::Globally => Node::Release(i, self.truth(false, span), f),
        };
        let written = Written { operator: Operator::Unary(op), interval: i, operands: vec![f] };
        self.push_written(node, written, span)
    }

    /// A temporal operator between two formulas; `i` is its interval.
    pub fn binary(&mut self, op: BinaryOp, i: Interval, f: FormulaId, g: FormulaId, span: Span) -> FormulaId {
        let node = match op {
            BinaryOp::Until => return self.push(Node::Until(i, f, g), span),
            BinaryOp::Release => return self.push(Node::Release(i, f, g), span),
            BinaryOp::WeakUntil => {
                let always = Node::Release(Interval { lo: 0, ..i }, self.truth(false, span), f);
                Node::Or(vec![self.push(Node::Until(i, f, g), span), self.push(always, span)])
            }
            BinaryOp::StrongRelease => Node::Until(i, g, self.push(Node::And(vec![f, g]), span)),
        };
        let written = Written { operator: Operator::Binary(op), interval: i, operands: vec![f, g] };
        self.push_written(node, written, span)
    }

    /// The empty conjunction or disjunction.
    fn truth(&mut self, value: bool, span: Span) -> FormulaId {
        self.push(if value { Node::And(Vec::new()) } else { Node::Or(Vec::new()) }, span)
    }
}
