//! What a function is, as solvers' models say it: `(define-fun f ((x S) ...) T body)`.

use std::fmt;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::expand::Macro;
use super::names::Meaning;
use super::{Reader, Trouble};
use crate::eval::node;
use crate::lexer::{Token, tokens};
use crate::term::{Sort, Term};
use crate::terms::Terms;
use crate::value::{Interpretation, Model, Value};

/// How often definitions are gone through: some solvers define a function by others that come after it.
const ROUNDS: usize = 64;

/// A function from values to values.
#[derive(Clone)]
pub struct Definition {
    terms: Arc<Terms>,
    meant: Arc<Macro>,
}

impl fmt::Debug for Definition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.domain().try_for_each(|sort| write!(f, "{sort} "))?;
        write!(f, "-> {}", self.range())
    }
}

impl Definition {
    /// The sorts of its arguments.
    pub fn domain(&self) -> impl ExactSizeIterator<Item = Sort> {
        self.meant.parameters.iter().map(|&parameter| self.terms.sort(parameter))
    }

    /// The sort of what it gives.
    #[must_use]
    pub fn range(&self) -> Sort {
        self.terms.sort(self.meant.body)
    }

    /// What it gives for as many arguments as it takes; `None` where they are of other sorts, or where that is not known.
    #[must_use]
    pub fn value(&self, args: &[Value]) -> Option<Value> {
        let Macro { parameters, body, nodes } = &*self.meant;
        if !self.domain().eq(args.iter().map(|value| value.sort())) {
            return None;
        }
        let mut known: FxHashMap<Term, Value> =
            parameters.iter().copied().zip(args.iter().copied()).collect();
        let of = |known: &FxHashMap<Term, Value>, t: Term| match known.get(&t.positive()) {
            Some(Value::Bool(b)) => Some(Value::Bool(b ^ t.is_negated())),
            Some(value) => Some(*value),
            None => self.terms.value(t),
        };
        let nothing = Model::new();
        for &t in nodes {
            if let Some(value) = node(&self.terms, &nothing, |_| None, t, |t| of(&known, t)) {
                known.insert(t, value);
            }
        }
        of(&known, *body)
    }
}

impl Interpretation for Definition {
    fn value(&self, args: &[Value]) -> Option<Value> {
        Definition::value(self, args)
    }
}

/// Reads definitions of functions with arguments, each a text of its own, with what they are called. They may be in terms
/// of each other, in any order; what cannot be read is left out.
#[must_use]
pub fn read_definitions<'t>(texts: &[&'t str]) -> Vec<(&'t str, Definition)> {
    let mut reader = Reader::new("");
    let (mut open, mut found) = (texts.to_vec(), Vec::new());
    for _ in 0..ROUNDS {
        let before = open.len();
        open.retain(|text| match reader.definition(text) {
            Ok(function) => {
                found.extend(function);
                false
            }
            Err(_) => true,
        });
        if open.is_empty() || open.len() == before {
            break;
        }
    }
    let Reader { script, macros, .. } = reader;
    let (terms, macros) = (Arc::new(script.terms), macros.into_iter().map(Arc::new).collect::<Vec<_>>());
    let definition = |at: usize| Definition { terms: terms.clone(), meant: macros[at].clone() };
    found.into_iter().map(|(name, at)| (name, definition(at))).collect()
}

impl<'t> Reader<'t> {
    /// One definition: its name, and the number of the macro, if it has arguments.
    fn definition(&mut self, text: &'t str) -> Result<Option<(&'t str, usize)>, Trouble> {
        self.tokens = tokens(text);
        let name = self.defined();
        self.names.leave(0);
        let name = name?;
        Ok(match self.names.get(name) {
            Some(Meaning::Macro(number)) => Some((name, number)),
            _ => None,
        })
    }

    fn defined(&mut self) -> Result<&'t str, Trouble> {
        self.open()?;
        let (at, command) = self.token()?;
        if command != Token::Word("define-fun") {
            return Err(Trouble::syntax(at, "define-fun is missing"));
        }
        let (_, name) = self
            .tokens
            .clone()
            .next()
            .and_then(|(place, token)| match token {
                Token::Word(name) | Token::Quoted(name) => Some((place, name)),
                _ => None,
            })
            .ok_or_else(|| Trouble::syntax(at, "a symbol is missing"))?;
        self.define(true)?;
        self.close()?;
        Ok(name)
    }
}
