//! What symbols stand for, here and now.

use rustc_hash::FxHashMap;

use crate::term::{Function, Term};

/// What a symbol stands for.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) enum Meaning {
    /// A term.
    Term(Term),
    /// A function that is declared.
    Function(Function),
    /// A macro, by its number.
    Macro(usize),
}

/// The symbols in scope. What a scope hides comes back when it ends.
#[derive(Default)]
pub(super) struct Names<'t> {
    known: FxHashMap<&'t str, Meaning>,
    /// What was bound in scopes that have not ended, and what was hidden by that.
    bound: Vec<(&'t str, Option<Meaning>)>,
}

impl<'t> Names<'t> {
    /// What a symbol stands for.
    pub(super) fn get(&self, name: &str) -> Option<Meaning> {
        self.known.get(name).copied()
    }

    /// Adds a symbol for good; whether it is new.
    pub(super) fn declare(&mut self, name: &'t str, meaning: Meaning) -> bool {
        self.known.insert(name, meaning).is_none()
    }

    /// The beginning of a scope, for [`Names::leave`].
    pub(super) fn enter(&self) -> usize {
        self.bound.len()
    }

    /// Binds a symbol until the scope ends.
    pub(super) fn bind(&mut self, name: &'t str, term: Term) {
        let hidden = self.known.insert(name, Meaning::Term(term));
        self.bound.push((name, hidden));
    }

    /// Ends a scope.
    pub(super) fn leave(&mut self, scope: usize) {
        for (name, hidden) in self.bound.drain(scope..).rev() {
            match hidden {
                Some(meaning) => self.known.insert(name, meaning),
                None => self.known.remove(name),
            };
        }
    }
}
