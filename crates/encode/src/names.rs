//! What the symbols of paths are called.

use crate::choice::{Alphabet, Choice, Place};
use crate::graph::{Graph, Letter, StateIx};
use hyperplan_problem::{Problem, System, Type, Value};
use hyperplan_smt::{Script, Terms};
use std::borrow::Cow;

/// Names the symbols of one path.
pub(crate) struct Names<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) system: &'a System,
    /// The path variable's name, with a number for copies.
    pub(crate) path: String,
}

/// A name as a part of a symbol's. Names from graph files may be anything, dots and slashes included: a number then
/// keeps the symbols of different things different.
fn plain(name: &str, number: u32) -> Cow<'_, str> {
    if name.bytes().all(|b| b.is_ascii_alphanumeric() || b" _-+*=<>".contains(&b)) && !name.is_empty() {
        Cow::Borrowed(name)
    } else {
        Cow::Owned(format!("#{number}"))
    }
}

impl Names<'_> {
    /// `p.at.3.4`: path p is where the first variable is 3 and the second 4.
    pub(crate) fn state(&self, graph: &Graph, state: StateIx) -> String {
        let mut name = format!("{}.at", self.path);
        for (value, var) in graph.state(self.system, state).iter().zip(&self.system.vars) {
            match (value, &var.ty) {
                (Value::Enum(at), Type::Enum(values)) => {
                    name.push_str(&format!(".{}", plain(&values[*at as usize], *at)));
                }
                (Value::Bool(b), _) => name.push_str(&format!(".{b}")),
                (Value::Int(i), _) => name.push_str(&format!(".{i}")),
                (Value::Enum(at), _) => name.push_str(&format!(".{at}")),
                (Value::Real(r), _) => name.push_str(&format!(".{r}")),
            }
        }
        name
    }

    /// `q.may2.at.3.4`: some run of q may be there and owe what the residual 2 stands for.
    pub(crate) fn pair(&self, graph: &Graph, state: StateIx, residual: u32) -> String {
        let state = self.state(graph, state);
        let place = state.strip_prefix(&self.path).unwrap_or(&state);
        format!("{}.may{residual}{place}", self.path)
    }

    /// `p.up`, or `p.up/1` for the second outcome of `up`.
    pub(crate) fn letter(&self, graph: &Graph, letter: Letter) -> String {
        let (action, number) = graph.letters[letter as usize];
        let action = plain(&self.problem.actions[action], action.0);
        match number {
            0 => format!("{}.{action}", self.path),
            _ => format!("{}.{action}/{number}", self.path),
        }
    }

    /// The assertions of a step come next.
    pub(crate) fn begin_step(&self, script: &mut Script, step: usize) {
        let path = &self.path;
        script.section(format!("path.{path}.{step}"), format!("path {path}: step {step}"));
    }

    /// Which of some states it is.
    pub(crate) fn choose_state(
        &self,
        terms: &mut Terms,
        graph: &Graph,
        states: &[StateIx],
        place: &Place,
        alphabet: &Alphabet,
    ) -> Choice {
        let whole = format!("{}.at", self.path);
        Choice::new(terms, alphabet.states, states, place, |state| self.state(graph, state), &whole)
    }

    /// Which of some letters it is.
    pub(crate) fn choose_letter(
        &self,
        terms: &mut Terms,
        graph: &Graph,
        letters: &[Letter],
        place: &Place,
        alphabet: &Alphabet,
    ) -> Choice {
        let whole = format!("{}.do", self.path);
        Choice::new(terms, alphabet.letters, letters, place, |letter| self.letter(graph, letter), &whole)
    }
}
