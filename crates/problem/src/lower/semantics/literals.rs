//! Splitting atoms that read actions at their connectives, into literals.

use crate::expr::{Expr, PathLeaf};
use crate::formula::{Formula, Node};
use crate::ids::FormulaId;
use hyperplan_syntax::Span;
use typed_index_collections::TiVec;

/// The formula with its atoms split so that each reads no action or has no connective at its top.
pub(super) fn literals(formula: &Formula) -> Formula {
    let mut split = Formula::default();
    let mut place: TiVec<FormulaId, FormulaId> = TiVec::with_capacity(formula.nodes.len());
    for (node, &span) in formula.nodes.iter().zip(&formula.spans) {
        let id = match node {
            Node::Atom(expr) => connectives(&mut split, expr, span),
            node => split.push(node.map_children(|child| place[child]), span),
        };
        place.push(id);
    }
    split
}

/// An atom as nodes. Recursion is bounded by the nesting of the expression.
fn connectives(split: &mut Formula, expr: &Expr<PathLeaf>, span: Span) -> FormulaId {
    let mut all = |es: &[Expr<PathLeaf>]| es.iter().map(|e| connectives(split, e, span)).collect();
    let node = match expr {
        _ if !reads_actions(expr) => Node::Atom(expr.clone()),
        Expr::Not(a) => Node::Not(connectives(split, a, span)),
        Expr::And(es) => Node::And(all(es)),
        Expr::Or(es) => Node::Or(all(es)),
        Expr::Iff(a, b) => {
            let (a, b) = (connectives(split, a, span), connectives(split, b, span));
            Node::Iff(a, b)
        }
        // The whole is a truth value, so its branches are.
        Expr::If(branches, last) => {
            let mut ways = Vec::with_capacity(branches.len() + 1);
            let mut none_before = Vec::new();
            for (condition, value) in branches {
                let [c, a] = [condition, value].map(|e| connectives(split, e, span));
                ways.push(split.push(Node::And([&none_before[..], &[c, a]].concat()), span));
                let not_c = split.push(Node::Not(c), span);
                // What was negated so far is one node, so that long chains stay small.
                none_before.push(not_c);
                none_before = vec![split.push(Node::And(none_before), span)];
            }
            none_before.push(connectives(split, last, span));
            ways.push(split.push(Node::And(none_before), span));
            Node::Or(ways)
        }
        atom => Node::Atom(atom.clone()),
    };
    split.push(node, span)
}

/// Whether an expression reads actions that were taken.
pub(super) fn reads_actions(expr: &Expr<PathLeaf>) -> bool {
    let mut reads = false;
    expr.for_each_leaf(&mut |leaf| {
        reads |= match leaf {
            PathLeaf::Took(..) | PathLeaf::SameAction(..) => true,
            PathLeaf::State(..) | PathLeaf::SameState(..) | PathLeaf::Enabled(..) | PathLeaf::Halted(_) => {
                false
            }
        };
    });
    reads
}
