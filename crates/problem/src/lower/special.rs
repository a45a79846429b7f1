//! Atoms over actions, whole states and observations.

use super::diagnostics::suggest;
use super::expr::{Context, compare_typed};
use super::paths::PathContext;
use super::typed::{self as make, Typed};
use crate::expr::{Expr, Leaf, PathLeaf};
use crate::ids::{ActionId, PathId};
use crate::names::names;
use crate::system::System;
use hyperplan_syntax::ast::{self, CompareOp, ExprKind, Ident, Set};
use hyperplan_syntax::{Diagnostic, Span};

/// One side of a comparison of things that are no values.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Special {
    Action,
    State,
    Obs,
}

names!(pub(crate) Special: Action "action", State "state", Obs "obs");

type Side<'e> = (Special, &'e Ident, &'e [Ident], Span);

fn side(e: &ast::Expr) -> Option<Side<'_>> {
    match &e.kind {
        ExprKind::At(name, paths) => Some((name.name.parse().ok()?, name, paths, e.span)),
        _ => None,
    }
}

impl PathContext<'_> {
    /// `action[p] == ...`, `state[p] == state[q]`, `obs[p] == obs[q]`; `None` for an ordinary comparison.
    pub(super) fn special_comparison(
        &mut self,
        op: CompareOp,
        a: &ast::Expr,
        b: &ast::Expr,
        span: Span,
    ) -> Option<Option<Typed<PathLeaf>>> {
        let (left, right) = (side(a), side(b));
        let (first, other) = match (left, right) {
            (Some(first), _) => (first, b),
            (None, Some(first)) => (first, a),
            (None, None) => return None,
        };
        if !matches!(op, CompareOp::Eq | CompareOp::Ne) {
            let message = format!("`{}[...]` has no order, only `==` and `!=`", first.0.name());
            return Some(self.error(Diagnostic::error("type-mismatch", span, message)));
        }
        let equal = match (left, right) {
            (Some(left), Some(right)) if left.0 == right.0 => self.two_paths(left, right, span),
            (Some(left), Some(right)) => {
                let message = format!("cannot compare `{}` with `{}`", left.0.name(), right.0.name());
                self.diagnostics.refuse(Diagnostic::error("type-mismatch", span, message))
            }
            _ => self.with_name(first, other),
        };
        let negate = |e| if op == CompareOp::Ne { make::not(e) } else { e };
        Some(equal.map(|e| Typed::Bool(negate(e))))
    }

    /// The same special of two paths.
    fn two_paths(&mut self, left: Side, right: Side, span: Span) -> Option<Expr<PathLeaf>> {
        let p = self.one_path(left.1, left.2, left.3);
        let q = self.one_path(right.1, right.2, right.3);
        let (p, q) = (p?, q?);
        if left.0 != Special::Obs && p == q {
            return Some(Expr::TRUE);
        }
        match left.0 {
            Special::Action => Some(Expr::Leaf(PathLeaf::SameAction(p, q))),
            Special::State => self.same_state(p, q, span),
            Special::Obs => self.same_observation(p, q, span),
        }
    }

    fn same_state(&mut self, p: PathId, q: PathId, span: Span) -> Option<Expr<PathLeaf>> {
        if self.paths[p].system == self.paths[q].system {
            return Some(Expr::Leaf(PathLeaf::SameState(p, q)));
        }
        let (s, t) = (&self.system(p).name, &self.system(q).name);
        let message = format!("states of two systems, {s} and {t}, cannot be compared");
        let diagnostic = Diagnostic::error("type-mismatch", span, message);
        self.diagnostics.refuse(diagnostic.with_help("compare variables, such as `x[p] == x[q]`"))
    }

    /// The conjunction of equalities of what the two systems' `observe` items list.
    fn same_observation(&mut self, p: PathId, q: PathId, span: Span) -> Option<Expr<PathLeaf>> {
        let (s, t) = (self.system(p), self.system(q));
        if let Some(path) = [p, q].into_iter().find(|path| self.system(*path).observe.is_empty()) {
            if !self.poisoned[self.paths[path].system] {
                let system = self.system(path);
                let message = format!("system {} does not say what is observed", system.name);
                let diagnostic = Diagnostic::error("nothing-observed", span, message);
                let help = format!("add `observe EXPR, ...;` to system {}", system.name);
                self.diagnostics.push(diagnostic.with_related(system.span, "this system").with_help(help));
            }
            return None;
        }
        if s.observe.len() != t.observe.len() {
            let (m, n) = (s.observe.len(), t.observe.len());
            let message = format!("system {} lists {m} observations, system {} lists {n}", s.name, t.name);
            return self.diagnostics.refuse(Diagnostic::error("type-mismatch", span, message));
        }
        if p == q {
            return Some(Expr::TRUE);
        }
        let mut equalities = Vec::with_capacity(s.observe.len());
        for (a, b) in s.observe.iter().zip(&t.observe) {
            let (a, b) = (observed(s, p, a), observed(t, q, b));
            equalities.push(compare_typed(self, CompareOp::Eq, a, b, span)?);
        }
        Some(make::and(equalities))
    }

    /// `action[p] == NAME`
    fn with_name(&mut self, (special, name, paths, span): Side, other: &ast::Expr) -> Option<Expr<PathLeaf>> {
        let path = self.one_path(name, paths, span);
        let (ExprKind::Name(action) | ExprKind::Text(action)) = &other.kind else {
            let help = match special {
                Special::Action => "compare it with an action, `none`, or another path's `action`".to_owned(),
                special => format!("compare it with another path's `{}`", special.name()),
            };
            let message = format!("cannot compare `{}` with this", special.name());
            let diagnostic = Diagnostic::error("type-mismatch", other.span, message);
            return self.diagnostics.refuse(diagnostic.with_help(help));
        };
        if special != Special::Action {
            let message = format!("cannot compare `{}` with `{action}`", special.name());
            let help = format!("compare it with another path's `{}`", special.name());
            return self
                .diagnostics
                .refuse(Diagnostic::error("type-mismatch", other.span, message).with_help(help));
        }
        let path = path?;
        if action == "none" {
            let taken = self.system(path).actions.iter().map(|a| Expr::Leaf(PathLeaf::Took(path, *a)));
            return Some(make::and(taken.map(make::not)));
        }
        let action = self.action(action, other.span, path)?;
        Some(Expr::Leaf(PathLeaf::Took(path, action)))
    }

    /// An action of the path's system.
    fn action(&mut self, name: &str, span: Span, path: PathId) -> Option<ActionId> {
        let system = self.system(path);
        if let Some(id) = self.actions.get(name).filter(|id| system.actions.contains(id)) {
            return Some(id);
        }
        if self.poisoned[self.paths[path].system] {
            return None;
        }
        let message = format!("no action `{name}` in system {}", system.name);
        let candidates = system.actions.iter().map(|id| self.actions.names[*id].as_str());
        let diagnostic = suggest(Diagnostic::error("unknown-action", span, message), name, candidates);
        self.diagnostics.refuse(diagnostic)
    }

    /// `up in enabled[p]` and `action[p] in {up, down}`; `None` for an ordinary set.
    pub(super) fn special_membership(
        &mut self,
        element: &ast::Expr,
        set: &Set,
        span: Span,
    ) -> Option<Option<Typed<PathLeaf>>> {
        if let Set::Enabled(path, _) = set {
            let path = self.path(path);
            let (ExprKind::Name(name) | ExprKind::Text(name)) = &element.kind else {
                let message = "only an action can be in `enabled[...]`";
                return Some(self.error(Diagnostic::error("type-mismatch", element.span, message)));
            };
            let action = path.and_then(|path| Some((path, self.action(name, element.span, path)?)));
            let leaf = action.map(|(path, action)| Expr::Leaf(PathLeaf::Enabled(path, action)));
            return Some(leaf.map(Typed::Bool));
        }
        let special = side(element)?;
        let Set::List(members, _) = set else {
            let message = format!("`{}[...]` is no integer", special.0.name());
            return Some(self.error(Diagnostic::error("type-mismatch", span, message)));
        };
        let cases: Vec<_> = members.iter().map(|m| self.with_name(special, m)).collect();
        let cases: Option<Vec<_>> = cases.into_iter().collect();
        Some(cases.map(|cases| Typed::Bool(make::or(cases))))
    }
}

/// What a system observes, read of a path. Types were checked when the system was read.
fn observed(system: &System, path: PathId, e: &Expr<Leaf>) -> Typed<PathLeaf> {
    let read = e.map(&mut |leaf| PathLeaf::State(path, *leaf));
    super::types::retyped(system, e, read)
}
