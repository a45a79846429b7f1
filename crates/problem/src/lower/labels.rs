//! Labels in an order in which each reads only earlier ones.

use super::diagnostics::Diagnostics;
use super::order;
use super::typed::labels_read;
use super::walk::visit;
use crate::expr::{Expr, Leaf, Type};
use crate::ids::LabelId;
use crate::system::Label;
use hyperplan_syntax::ast::{self, ExprKind};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;

/// The order in which labels are typed: each after those that it reads, as far as that is possible. `names` tells
/// labels by name.
pub(super) fn typing_order(bodies: &[&ast::Expr], names: &FxHashMap<&str, usize>) -> Vec<usize> {
    let reads = |body: &&ast::Expr| {
        let mut read = Vec::new();
        visit(body, &mut |e| {
            if let ExprKind::Name(name) = &e.kind {
                read.extend(names.get(name.as_str()));
            }
        });
        read.sort_unstable();
        read.dedup();
        read
    };
    let order = order::sort(&bodies.iter().map(reads).collect::<Vec<_>>());
    order.sorted.into_iter().chain(order.stuck).collect()
}

/// Sorts labels that were numbered in order of declaration. Gives them in their new order, and each old number's
/// new one. Labels that read themselves, directly or not, are reported and hold nowhere.
pub(super) fn sort(mut labels: Vec<Label>, diagnostics: &mut Diagnostics) -> (Vec<Label>, Vec<LabelId>) {
    let reads: Vec<Vec<usize>> = labels.iter().map(|label| labels_read(&label.expr)).collect();
    let order = order::sort(&reads);
    let named = |label: &usize| (labels[*label].name.as_str(), labels[*label].span);
    if let Some(diagnostic) = cyclic("label", "cyclic-label", order.cycle.iter().map(named).collect()) {
        diagnostics.push(diagnostic);
    }
    for (label, reads) in labels.iter_mut().zip(&reads) {
        label.nested = !reads.is_empty();
    }
    for label in &order.stuck {
        labels[*label].expr = Expr::FALSE;
        labels[*label].ty = Type::Bool;
        labels[*label].nested = false;
    }
    let order: Vec<usize> = order.sorted.into_iter().chain(order.stuck).collect();
    let mut new = vec![LabelId(0); labels.len()];
    for (position, old) in order.iter().enumerate() {
        new[*old] = LabelId::from(position);
    }
    (reorder(labels, &order, &new), new)
}

fn reorder(labels: Vec<Label>, order: &[usize], new: &[LabelId]) -> Vec<Label> {
    if order.iter().enumerate().all(|(position, old)| position == *old) {
        return labels;
    }
    let mut renumber = |leaf: &Leaf| match leaf {
        Leaf::Label(id) => Leaf::Label(new[usize::from(*id)]),
        Leaf::Var(_) => *leaf,
    };
    let moved = |old: &usize| {
        let label = &labels[*old];
        Label {
            name: label.name.clone(),
            expr: label.expr.map(&mut renumber),
            ty: label.ty.clone(),
            nested: label.nested,
            span: label.span,
        }
    };
    order.iter().map(moved).collect()
}

/// The message about declarations that read each other in a ring.
pub(super) fn cyclic(what: &str, code: &'static str, cycle: Vec<(&str, Span)>) -> Option<Diagnostic> {
    let ((_, span), rest) = cycle.split_first()?;
    let names: Vec<String> = cycle.iter().take(8).map(|(name, _)| format!("`{name}`")).collect();
    let message = match names.as_slice() {
        [only] => format!("the {what} {only} reads itself"),
        names => format!("the {what}s {} read each other", names.join(", ")),
    };
    let mut diagnostic = Diagnostic::error(code, *span, message);
    for (_, span) in rest.iter().take(7) {
        diagnostic = diagnostic.with_related(*span, "and this one");
    }
    Some(diagnostic)
}
