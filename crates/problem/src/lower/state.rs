//! Names in a system: its variables, its labels, and constants.

use super::consts::Consts;
use super::diagnostics::{Diagnostics, suggest};
use super::expr::Context;
use super::limits::Limits;
use super::typed::Typed;
use crate::expr::{Expr, Leaf, TransLeaf, Type};
use crate::ids::VarId;
use crate::system::Var;
use hyperplan_syntax::{Diagnostic, Span};
use indexmap::IndexMap;
use rustc_hash::FxHashSet;
use std::cell::RefCell;
use typed_index_collections::TiVec;

/// What the names of one system stand for, and where they are declared, in the order of declaration.
pub(crate) type Names = IndexMap<String, (Leaf, Span)>;

/// Typing expressions over one system's state.
pub(crate) struct StateContext<'a> {
    pub(crate) consts: &'a Consts,
    pub(crate) diagnostics: &'a mut Diagnostics,
    pub(crate) names: Names,
    pub(crate) vars: TiVec<VarId, Var>,
    /// The types of labels, by their present number, as far as they are known.
    pub(crate) label_types: Vec<Type>,
    /// The system's name, for messages.
    pub(crate) system: String,
    /// Whether part of the system is missing after an error, so that unknown names mean nothing.
    pub(crate) poisoned: bool,
    pub(crate) limits: Limits,
    /// The values of enumerations, of as many variables as are counted.
    pub(crate) values: RefCell<(usize, FxHashSet<String>)>,
}

impl Context for StateContext<'_> {
    type Leaf = Leaf;

    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits) {
        (self.diagnostics, &mut self.limits)
    }

    fn resolve(&mut self, name: &str) -> Option<Option<Typed<Leaf>>> {
        match self.names.get(name) {
            Some(&(leaf @ Leaf::Var(id), _)) => {
                Some(Some(Typed::of_type(Expr::Leaf(leaf), &self.vars[id].ty)))
            }
            Some(&(leaf @ Leaf::Label(id), _)) => {
                // What is typed before the label is known as a truth value or refused.
                let ty = self.label_types.get(usize::from(id)).unwrap_or(&Type::Bool);
                Some(Some(Typed::of_type(Expr::Leaf(leaf), ty)))
            }
            None => self.consts.typed(name).or(self.poisoned.then_some(None)),
        }
    }

    fn is_enum_value(&self, name: &str) -> bool {
        let (counted, values) = &mut *self.values.borrow_mut();
        for var in &self.vars.raw[*counted..] {
            if let Type::Enum(own) = &var.ty {
                values.extend(own.iter().cloned());
            }
        }
        *counted = self.vars.len();
        values.contains(name)
    }

    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic {
        let message = format!("no variable, label or constant `{name}` in system {}", self.system);
        let candidates = self.names.keys().map(String::as_str).chain(self.consts.names());
        suggest(Diagnostic::error("unknown-name", span, message), name, candidates)
    }
}

/// Typing what `trans` says: expressions over the states before and after a step.
pub(crate) struct TransContext<'c, 'a> {
    state: &'c mut StateContext<'a>,
}

impl<'c, 'a> TransContext<'c, 'a> {
    /// In a system whose labels are known.
    pub(crate) fn new(state: &'c mut StateContext<'a>) -> Self {
        TransContext { state }
    }
}

impl Context for TransContext<'_, '_> {
    type Leaf = TransLeaf;

    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits) {
        self.state.parts()
    }

    fn resolve(&mut self, name: &str) -> Option<Option<Typed<TransLeaf>>> {
        let meant = self.state.resolve(name)?;
        Some(meant.map(|typed| typed.map(&mut |leaf| TransLeaf::Before(*leaf))))
    }

    fn is_enum_value(&self, name: &str) -> bool {
        self.state.is_enum_value(name)
    }

    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic {
        self.state.unknown(name, span)
    }

    fn primed(&mut self, name: &str, span: Span) -> Option<Typed<TransLeaf>> {
        if self.state.names.contains_key(name) || self.state.poisoned {
            let meant = self.state.resolve(name).flatten()?;
            return Some(meant.map(&mut |leaf| TransLeaf::After(*leaf)));
        }
        let diagnostic = self.state.unknown(name, span);
        self.error(diagnostic)
    }
}

/// Whether the type is an enumeration with that value.
pub(crate) fn has_value(ty: &Type, name: &str) -> bool {
    matches!(ty, Type::Enum(values) if values.iter().any(|v| v == name))
}
