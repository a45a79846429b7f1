//! Names in an expression over one step of a system: those of the state before, the action, the numbers of a graph's
//! transitions.

use super::base::Actions;
use super::clauses::known_action;
use super::diagnostics::{Diagnostics, suggest};
use super::expr::{Context, typed};
use super::limits::Limits;
use super::state::StateContext;
use super::typed::{self as make, Bounds, EnumType, Typed};
use crate::edges::Attribute;
use crate::expr::{Comparison, Expr, StepLeaf, Value};
use crate::ids::AttributeId;
use crate::system::System;
use hyperplan_syntax::ast::{self, CompareOp, ExprKind, Set};
use hyperplan_syntax::{Diagnostic, Span};

/// Typing expressions over one system's steps.
pub(super) struct StepContext<'a, 'c> {
    pub(super) state: &'a mut StateContext<'c>,
    pub(super) system: &'a System,
    pub(super) actions: &'a Actions,
}

impl StepContext<'_, '_> {
    /// The number of a graph's transitions that has a name.
    fn attribute(&self, name: &str) -> Option<Typed<StepLeaf>> {
        let edges = self.system.edges.as_ref()?;
        let hidden = |derived: bool| {
            let StateContext { names, consts, .. } = &*self.state;
            derived && (names.contains_key(name) || consts.get(name).is_some())
        };
        let is_meant = |a: &Attribute| a.name == name && !hidden(a.derived);
        let at = edges.attributes().iter().position(is_meant)?;
        let id = AttributeId::from(at);
        let (lo, hi) = edges.numbers_between(id);
        Some(Typed::Int(Expr::Leaf(StepLeaf::Attribute(id)), Some(Bounds { lo, hi })))
    }

    /// The action that the step takes, as a value of variables of type `action`.
    fn action(&self) -> Typed<StepLeaf> {
        let names: EnumType = self.system.actions.iter().map(|&id| self.actions.names[id].clone()).collect();
        let mut values = self
            .system
            .actions
            .iter()
            .zip(0..)
            .map(|(&action, at)| (Expr::Leaf(StepLeaf::Took(action)), Expr::Const(Value::Enum(at))));
        // Whichever is not one of the others is the first; every system has an action.
        let (_, first) = values.next().unwrap_or((Expr::TRUE, Expr::Const(Value::Enum(0))));
        Typed::Enum(Expr::choice(values, first), names)
    }

    /// That the step takes the action that a variable or label has.
    fn takes_value(&mut self, e: &ast::Expr) -> Option<Expr<StepLeaf>> {
        let value = typed(self, e, None)?;
        let Typed::Enum(value, names) = value else {
            let message = format!("an action is compared with {}", value.describe());
            let diagnostic = Diagnostic::error("type-mismatch", e.span, message);
            return self
                .error(diagnostic.with_help("compare it with an action, or a variable of type `action`"));
        };
        let takes = |(name, at): (&String, u32)| {
            let action = self.actions.get(name).filter(|action| self.system.actions.contains(action))?;
            let has = make::compare(Comparison::Eq, value.clone(), Expr::Const(Value::Enum(at)));
            Some(make::and([Expr::Leaf(StepLeaf::Took(action)), has]))
        };
        Some(make::or(names.iter().zip(0..).filter_map(takes)))
    }

    /// That the step takes an action.
    fn takes(&mut self, action: &ast::Expr) -> Option<Expr<StepLeaf>> {
        if let ExprKind::Name(name) = &action.kind
            && self.state.names.contains_key(name)
            && !self.actions.get(name).is_some_and(|id| self.system.actions.contains(&id))
        {
            return self.takes_value(action);
        }
        let (ExprKind::Name(name) | ExprKind::Text(name)) = &action.kind else {
            let message = "cannot compare `action` with this";
            let diagnostic = Diagnostic::error("type-mismatch", action.span, message);
            return self.error(diagnostic.with_help("compare it with the name of an action"));
        };
        let action = known_action(self.state, name, action.span, self.system, self.actions)?;
        Some(Expr::Leaf(StepLeaf::Took(action)))
    }
}

/// Whether an expression is the word `action`, which is no name of a variable.
fn is_action(e: &ast::Expr) -> bool {
    matches!(&e.kind, ExprKind::Name(name) if name == "action")
}

impl Context for StepContext<'_, '_> {
    type Leaf = StepLeaf;

    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits) {
        self.state.parts()
    }

    fn resolve(&mut self, name: &str) -> Option<Option<Typed<StepLeaf>>> {
        if name == "action" {
            return Some(Some(self.action()));
        }
        if let Some(attribute) = self.attribute(name) {
            return Some(Some(attribute));
        }
        let meant = self.state.resolve(name)?;
        Some(meant.map(|typed| typed.map(&mut |leaf| StepLeaf::State(*leaf))))
    }

    fn is_enum_value(&self, name: &str) -> bool {
        self.state.is_enum_value(name)
    }

    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic {
        let diagnostic = self.state.unknown(name, span);
        let attributes = self.system.edges.iter().flat_map(|edges| edges.attributes());
        let names: Vec<&str> = attributes.map(|attribute| attribute.name.as_str()).collect();
        if diagnostic.help.is_some() { diagnostic } else { suggest(diagnostic, name, names) }
    }

    fn compare_special(
        &mut self,
        op: CompareOp,
        a: &ast::Expr,
        b: &ast::Expr,
        span: Span,
    ) -> Option<Option<Typed<StepLeaf>>> {
        let action = match (is_action(a), is_action(b)) {
            (true, _) => b,
            (false, true) => a,
            (false, false) => return None,
        };
        if !matches!(op, CompareOp::Eq | CompareOp::Ne) {
            let message = "`action` has no order, only `==` and `!=`";
            return Some(self.error(Diagnostic::error("type-mismatch", span, message)));
        }
        let takes = self.takes(action);
        Some(takes.map(|takes| Typed::Bool(if op == CompareOp::Ne { make::not(takes) } else { takes })))
    }

    fn member_special(
        &mut self,
        element: &ast::Expr,
        set: &Set,
        span: Span,
    ) -> Option<Option<Typed<StepLeaf>>> {
        if !is_action(element) {
            return None;
        }
        let Set::List(members, _) = set else {
            let message = "`action` is no integer";
            return Some(self.error(Diagnostic::error("type-mismatch", span, message)));
        };
        let cases: Vec<_> = members.iter().map(|member| self.takes(member)).collect();
        let cases: Option<Vec<_>> = cases.into_iter().collect();
        Some(cases.map(|cases| Typed::Bool(make::or(cases))))
    }
}
