//! One of several alternatives, such as the states that can matter at a time, as symbols.

use crate::names::Names;
use hyperplan_smt::{Enumeration, Model, Sort, Term, Terms};
use hyperplan_space::Graph;

/// How a choice among the states, or the letters, of a system is written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coding {
    /// A Boolean for each alternative.
    Onehot,
    /// One symbol of an enumeration, whose constructors are all states, or letters, there are, by number.
    Enum(Enumeration),
}

/// The codings of a system's states and letters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Codings {
    pub(crate) states: Coding,
    pub(crate) letters: Coding,
}

impl Codings {
    /// A Boolean for each.
    pub(crate) const ONEHOT: Codings = Codings { states: Coding::Onehot, letters: Coding::Onehot };

    /// New enumerations of a system's states and letters, `names.path` being the system's name.
    pub(crate) fn enumerations(terms: &mut Terms, names: &Names<'_>, graph: &Graph) -> Codings {
        let system = &names.path;
        let actions = Names { path: format!("{system}.do"), ..*names };
        let states = (0..graph.len() as u32).map(|state| names.state(graph, state));
        let letters = (0..graph.letters.len() as u32).map(|letter| actions.letter(graph, letter));
        Codings {
            states: Coding::new(terms, &format!("{system}.State"), states),
            letters: Coding::new(terms, &format!("{system}.Letter"), letters),
        }
    }
}

impl Coding {
    /// An enumeration; what has no alternatives is never written.
    fn new(terms: &mut Terms, name: &str, constructors: impl Iterator<Item = String>) -> Coding {
        let mut constructors = constructors.peekable();
        match constructors.peek() {
            Some(_) => Coding::Enum(terms.enumeration(name, constructors)),
            None => Coding::Onehot,
        }
    }
}

/// Alternatives with the terms that say which it is.
pub(crate) struct Choice {
    /// For each alternative.
    pub(crate) terms: Vec<Term>,
    /// The symbol of an enumeration that the terms are about; without, they are symbols themselves, or constants.
    pub(crate) variable: Option<Term>,
}

/// A symbol's stem and time, and whether it is bound by a quantifier.
pub(crate) struct Place {
    pub(crate) time: usize,
    pub(crate) bound: bool,
}

impl Place {
    fn symbol(&self, terms: &mut Terms, name: &str, sort: Sort) -> Term {
        let stem = terms.stem(name);
        let time = Some(self.time as u32);
        if self.bound { terms.bound_symbol(stem, time, sort) } else { terms.symbol(stem, time, sort) }
    }
}

impl Choice {
    /// Symbols for some alternatives, by number; the only one there is needs none. `name` is what each is called,
    /// `whole` the choice as such.
    pub(crate) fn new(
        terms: &mut Terms,
        coding: Coding,
        items: &[u32],
        place: &Place,
        name: impl Fn(u32) -> String,
        whole: &str,
    ) -> Choice {
        if items.len() <= 1 {
            return Choice { terms: vec![Term::TRUE; items.len()], variable: None };
        }
        match coding {
            Coding::Onehot => {
                let symbol = |&item: &u32| place.symbol(terms, &name(item), Sort::Bool);
                Choice { terms: items.iter().map(symbol).collect(), variable: None }
            }
            Coding::Enum(enumeration) => {
                let variable = place.symbol(terms, whole, Sort::Enum(enumeration));
                let is = |&item: &u32| {
                    let constructor = terms.constructor(enumeration, item);
                    terms.eq(variable, constructor)
                };
                Choice { terms: items.iter().map(is).collect(), variable: Some(variable) }
            }
        }
    }

    /// It is exactly one of the alternatives.
    pub(crate) fn is_made(&self, terms: &mut Terms) -> Term {
        match self.variable.map(|variable| terms.sort(variable)) {
            Some(Sort::Enum(all)) if terms.constructors(all) as usize == self.terms.len() => Term::TRUE,
            Some(_) => terms.or(&self.terms),
            None => exactly_one(terms, &self.terms),
        }
    }
}

/// The symbols whose values say which of some alternatives it is, by its variable, if it has one, and its terms.
pub(crate) fn symbols(variable: Option<Term>, terms: impl Iterator<Item = Term>) -> Vec<Term> {
    match variable {
        Some(variable) => vec![variable],
        None => terms.filter(|t| !t.is_const()).collect(),
    }
}

/// Which of some alternatives, numbers with their terms, a model chooses.
pub(crate) fn chosen(
    variable: Option<Term>,
    mut alternatives: impl Iterator<Item = (u32, Term)>,
    model: &Model,
) -> Option<u32> {
    match variable {
        Some(variable) => {
            let chosen = model.get(variable)?.as_constructor()?;
            alternatives.find(|(item, _)| *item == chosen).map(|(item, _)| item)
        }
        None => alternatives.find(|(_, term)| model.is_true(*term)).map(|(item, _)| item),
    }
}

/// Exactly one of the terms is true; linear, by halves.
fn exactly_one(terms: &mut Terms, all: &[Term]) -> Term {
    let (any, at_most_one) = one_of(terms, all);
    terms.and2(any, at_most_one)
}

fn one_of(terms: &mut Terms, all: &[Term]) -> (Term, Term) {
    match all {
        [] => (Term::FALSE, Term::TRUE),
        [only] => (*only, Term::TRUE),
        _ => {
            let (left, right) = all.split_at(all.len() / 2);
            let (any_left, one_left) = one_of(terms, left);
            let (any_right, one_right) = one_of(terms, right);
            let both = terms.and2(any_left, any_right);
            (terms.or2(any_left, any_right), terms.and(&[one_left, one_right, !both]))
        }
    }
}
