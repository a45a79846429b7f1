//! Scripts: terms and assertions over them.

use crate::term::{Function, Term};
use crate::terms::{Terms, View};

/// An arena of terms with a growing list of assertions, each a disjunction.
#[derive(Default)]
pub struct Script {
    /// The terms.
    pub terms: Terms,
    literals: Vec<Term>,
    /// Where each assertion's literals end.
    ends: Vec<usize>,
    /// The sections, each with the assertion that it begins with.
    sections: Vec<(usize, Section)>,
}

/// What the assertions that follow are about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// A name, from which those of its assertions are made where they have one: letters, digits and `._`.
    pub name: String,
    /// What it says, for a comment.
    pub text: String,
}

impl Script {
    /// A script without assertions.
    #[must_use]
    pub fn new() -> Self {
        Script::default()
    }

    /// Asserts a Boolean term; true is dropped.
    pub fn assert(&mut self, t: Term) {
        self.clause(&[t]);
    }

    /// Asserts the disjunction of Boolean terms, as it is: not hash-consed. Dropped if one of them
    /// is true; the empty clause is the assertion of false.
    pub fn clause(&mut self, literals: &[Term]) {
        if literals.contains(&Term::TRUE) {
            return;
        }
        let start = self.literals.len();
        for &t in literals {
            self.terms.assert_bool(t);
            if t != Term::FALSE {
                self.literals.push(t);
            }
        }
        if self.literals.len() == start {
            self.literals.push(Term::FALSE);
        }
        self.ends.push(self.literals.len());
    }

    /// Begins a section of assertions.
    pub fn section(&mut self, name: impl Into<String>, text: impl Into<String>) {
        self.sections.push((self.ends.len(), Section { name: name.into(), text: text.into() }));
    }

    /// The sections, each with the index of the assertion that it begins with.
    pub fn sections(&self) -> impl Iterator<Item = (usize, &Section)> {
        self.sections.iter().map(|(at, section)| (*at, section))
    }

    /// How many assertions there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no assertions.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// One assertion.
    #[must_use]
    pub fn assertion(&self, index: usize) -> &[Term] {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.literals[start..self.ends[index]]
    }

    /// The assertions from that index on, each a disjunction that is not empty.
    pub fn assertions(&self, from: usize) -> impl Iterator<Item = &[Term]> {
        (from..self.len()).map(|index| self.assertion(index))
    }

    /// All literals of the assertions from that index on.
    #[must_use]
    pub fn literals(&self, from: usize) -> &[Term] {
        let start = if from == 0 { 0 } else { self.ends[from - 1] };
        &self.literals[start..]
    }

    /// The nodes that occur in assertions, each once, unnegated, children before parents.
    #[must_use]
    pub fn used_terms(&self) -> Vec<Term> {
        let mut used = Vec::new();
        self.terms.reach(&self.literals, &mut Vec::new(), &mut used);
        used.sort_unstable();
        used
    }

    /// The declared symbols that occur in assertions, in order of their making.
    #[must_use]
    pub fn symbols(&self) -> Vec<Term> {
        let mut used = self.used_terms();
        used.retain(|&t| self.terms.is_symbol(t));
        used
    }

    /// The declared functions that are applied in assertions, in order of their making.
    #[must_use]
    pub fn functions(&self) -> Vec<Function> {
        let applied = self.used_terms().into_iter().filter_map(|t| match self.terms.view(t) {
            View::Apply(function, _) => Some(function),
            _ => None,
        });
        let mut functions: Vec<Function> = applied.collect();
        functions.sort_unstable();
        functions.dedup();
        functions
    }
}
