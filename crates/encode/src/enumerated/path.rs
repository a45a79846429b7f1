//! Paths whose states are enumerated: a condition for each state that can matter at a time, and one for each letter
//! (action and outcome number) of a step. The symbols behind them are Booleans (`--states onehot`), or one of an
//! enumeration for each time (`--states enum`).

use super::choice::{self, Choice, Codings, Place};
use crate::names::Names;
use hyperplan_problem::{ActionId, PathId};
use hyperplan_relevance::Error;
use hyperplan_relevance::{Layers, LosingMove, Task};
use hyperplan_smt::{Model, Script, Term, Terms};
use hyperplan_space::{Graph, Letter, Run, StateIx};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The states possible at one time, with the terms that say which it is.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Layer {
    /// Sorted.
    pub(crate) states: Vec<StateIx>,
    pub(crate) terms: Vec<Term>,
    /// See [`Choice::variable`].
    variable: Option<Term>,
}

impl Layer {
    /// States with conditions that exclude each other.
    pub(super) fn new(states: Vec<StateIx>, terms: Vec<Term>) -> Layer {
        Layer { states, terms, variable: None }
    }

    /// The only state.
    pub(super) fn only(state: StateIx) -> Layer {
        Layer::new(vec![state], vec![Term::TRUE])
    }

    /// Whether the state is one of those for which `holds`.
    pub(crate) fn any(&self, terms: &mut Terms, mut holds: impl FnMut(StateIx) -> bool) -> Term {
        let (mut yes, mut no) = (Vec::new(), Vec::new());
        for (&state, &term) in self.states.iter().zip(&self.terms) {
            if holds(state) { yes.push(term) } else { no.push(term) }
        }
        // Exactly one of the terms is true, so the shorter side will do.
        if no.is_empty() {
            Term::TRUE
        } else if yes.len() <= no.len() {
            terms.or(&yes)
        } else {
            !terms.or(&no)
        }
    }

    /// Whether it is this state.
    pub(crate) fn is(&self, state: StateIx) -> Term {
        self.states.binary_search(&state).map_or(Term::FALSE, |at| self.terms[at])
    }
}

/// The letters possible at one step, with the terms that say which it is.
#[derive(Debug, Default)]
pub(crate) struct Step {
    /// Empty where only the action is known.
    pub(crate) letters: Vec<(Letter, Term)>,
    pub(crate) actions: Vec<(ActionId, Term)>,
    /// See [`Choice::variable`].
    variable: Option<Term>,
}

impl Step {
    /// A choice among letters.
    fn new(terms: &mut Terms, graph: &Graph, letters: Vec<Letter>, choice: Choice) -> Step {
        let letters: Vec<(Letter, Term)> = letters.into_iter().zip(choice.terms).collect();
        let action = |letter: Letter| graph.letters[letter as usize].0;
        let actions = letters
            .chunk_by(|a, b| action(a.0) == action(b.0))
            .map(|same| {
                let any: Vec<Term> = same.iter().map(|l| l.1).collect();
                (action(same[0].0), terms.or(&any))
            })
            .collect();
        Step { letters, actions, variable: choice.variable }
    }

    /// Where only the action is known.
    pub(super) fn of_actions(actions: Vec<(ActionId, Term)>) -> Step {
        Step { letters: Vec::new(), actions, variable: None }
    }

    /// Whether the action is this one.
    pub(crate) fn took(&self, action: ActionId) -> Term {
        self.actions.iter().find(|a| a.0 == action).map_or(Term::FALSE, |a| a.1)
    }
}

/// The terms of a path: `layers[t]` its state at time t, `steps[t]` what leads from there to t + 1.
#[derive(Clone, Debug)]
pub(crate) struct EnumeratedPath {
    /// The path variable that it stands for.
    pub(crate) path: PathId,
    pub(crate) graph: Arc<Graph>,
    pub(crate) layers: Vec<Arc<Layer>>,
    pub(crate) steps: Vec<Arc<Step>>,
}

/// The letters that lead from one layer to the next, sorted.
fn letters_between(graph: &Graph, layers: &Layers, time: usize) -> Vec<Letter> {
    let mut letters: Vec<Letter> = layers.at[time]
        .iter()
        .flat_map(|&state| graph.successors(state))
        .filter(|t| layers.contains(time + 1, t.1))
        .map(|t| t.0)
        .collect();
    letters.sort_unstable();
    letters.dedup();
    letters
}

/// What a path is built from.
pub(crate) struct Builder<'b, 'n> {
    pub(crate) task: &'b Task<'n>,
    pub(crate) path: PathId,
    pub(crate) names: &'b Names<'n>,
    pub(crate) graph: &'b Arc<Graph>,
    /// What can matter of the path.
    pub(crate) layers: &'b Layers,
    pub(crate) codings: &'b Codings,
}

impl Builder<'_, '_> {
    fn empty(&self) -> EnumeratedPath {
        EnumeratedPath { path: self.path, graph: self.graph.clone(), layers: Vec::new(), steps: Vec::new() }
    }

    fn choose_state(&self, terms: &mut Terms, time: usize, bound: bool) -> Choice {
        let (place, whole) = (Place { time, bound }, format!("{}.at", self.names.path));
        let name = |state| self.names.state(self.graph, state);
        Choice::new(terms, self.codings.states, &self.layers.at[time], &place, name, &whole)
    }

    /// The letters of the step after a time, and which of them it is.
    fn choose_letter(&self, terms: &mut Terms, time: usize, bound: bool) -> (Vec<Letter>, Choice) {
        let letters = letters_between(self.graph, self.layers, time);
        let (place, whole) = (Place { time: time + 1, bound }, format!("{}.do", self.names.path));
        let name = |letter| self.names.letter(self.graph, letter);
        let choice = Choice::new(terms, self.codings.letters, &letters, &place, name, &whole);
        (letters, choice)
    }

    /// A path that the solver chooses: a symbol for each state of the layers and each letter, and clauses that make
    /// them a path. With exactly one state at time 0 and exactly one letter a step, both directions of the
    /// transition leave exactly one state at every time.
    ///
    /// # Errors
    /// [`Error::Interrupted`] soon after the task is to stop.
    pub(crate) fn declare(&self, script: &mut Script) -> Result<EnumeratedPath, Error> {
        let (graph, layers, name) = (self.graph, self.layers, &self.names.path);
        script.section(format!("path.{name}"), format!("path {name}: where it starts"));
        if layers.at.iter().any(Vec::is_empty) {
            script.assert(Term::FALSE);
        }
        let mut path = self.empty();
        for (time, states) in layers.at.iter().enumerate() {
            let choice = self.choose_state(&mut script.terms, time, false);
            if time == 0 {
                let start = choice.is_made(&mut script.terms);
                script.assert(start);
            }
            path.layers.push(Arc::new(Layer {
                states: states.clone(),
                terms: choice.terms,
                variable: choice.variable,
            }));
        }
        for time in 0..path.layers.len() - 1 {
            self.task.go_on()?;
            self.names.begin_step(script, time + 1);
            let (letters, choice) = self.choose_letter(&mut script.terms, time, false);
            let made = choice.is_made(&mut script.terms);
            script.assert(made);
            let step = Step::new(&mut script.terms, graph, letters, choice);
            transition(script, graph, &path.layers[time], &step, &path.layers[time + 1]);
            path.steps.push(Arc::new(step));
        }
        Ok(path)
    }

    /// A path whose initial state and letters are bound variables and whose other states are defined by them.
    ///
    /// # Errors
    /// [`Error::Interrupted`] soon after the task is to stop.
    pub(crate) fn bind(&self, terms: &mut Terms) -> Result<(EnumeratedPath, Vec<Term>, Term), Error> {
        let (graph, layers) = (self.graph, self.layers);
        let mut guards = Vec::new();
        let mut bound = Vec::new();
        let mut bind = |terms: &mut Terms, choice: &Choice| {
            bound.extend(choice::symbols(choice.variable, choice.terms.iter().copied()));
            guards.push(choice.is_made(terms));
        };
        let start = self.choose_state(terms, 0, true);
        bind(terms, &start);
        let mut path = self.empty();
        path.layers.push(Arc::new(Layer::new(layers.at[0].clone(), start.terms)));
        for time in 0..layers.at.len() - 1 {
            self.task.go_on()?;
            let (letters, choice) = self.choose_letter(terms, time, true);
            bind(terms, &choice);
            let step = Step::new(terms, graph, letters, choice);
            let mut next = Vec::new();
            let layer = path.layers[time].clone();
            for (&state, &here) in layer.states.iter().zip(&layer.terms) {
                for &(letter, term) in &step.letters {
                    if let Some(to) =
                        graph.successor(state, letter).filter(|&to| layers.contains(time + 1, to))
                    {
                        next.push((to, terms.and2(here, term)));
                    }
                }
            }
            path.layers.push(Arc::new(gather(terms, next)));
            path.steps.push(Arc::new(step));
        }
        let arrived = path.layers.last().map_or(Vec::new(), |l| l.terms.clone());
        guards.push(terms.or(&arrived));
        let guard = terms.and(&guards);
        Ok((path, bound, guard))
    }
}

impl EnumeratedPath {
    /// A known path, as constants.
    pub(crate) fn fix(path: PathId, fixed: &Run) -> Self {
        let layer = |&state: &StateIx| Arc::new(Layer::only(state));
        let step = |(&letter, &action): (&Letter, &ActionId)| {
            let letters = vec![(letter, Term::TRUE)];
            Arc::new(Step { letters, actions: vec![(action, Term::TRUE)], variable: None })
        };
        EnumeratedPath {
            path,
            graph: fixed.graph.clone(),
            layers: fixed.states.iter().map(layer).collect(),
            steps: fixed.letters.iter().zip(&fixed.actions).map(step).collect(),
        }
    }

    /// The symbols that a model must give values to, so that [`EnumeratedPath::decode`] can read the path.
    pub(crate) fn symbols(&self) -> Vec<Term> {
        let start = &self.layers[0];
        let mut symbols = choice::symbols(start.variable, start.terms.iter().copied());
        for step in &self.steps {
            symbols.extend(choice::symbols(step.variable, step.letters.iter().map(|l| l.1)));
        }
        symbols
    }

    /// The path that a model describes, by replaying its letters from its initial state; `None` if it is none.
    pub(crate) fn decode(&self, model: &Model) -> Option<Run> {
        let first = &self.layers[0];
        let starts = first.states.iter().copied().zip(first.terms.iter().copied());
        let start = choice::chosen(first.variable, starts, model)?;
        let letter = |step: &Arc<Step>| choice::chosen(step.variable, step.letters.iter().copied(), model);
        let letters: Option<Vec<Letter>> = self.steps.iter().map(letter).collect();
        Run::replay(&self.graph, start, letters?)
    }

    /// That the path does not make a losing move at a time, as a clause; `pair` says that the other path may be where
    /// the move loses.
    pub(crate) fn avoids(&self, losing: &LosingMove, time: usize, pair: Option<Term>) -> Vec<Term> {
        let letters = self.steps.get(time).map_or(&[][..], |step| &step.letters);
        let made = match losing.turn.letter {
            None => Term::TRUE,
            Some(letter) => letters.iter().find(|l| l.0 == letter).map_or(Term::FALSE, |l| l.1),
        };
        let there = self.layers[time.min(self.layers.len() - 1)].is(losing.state);
        [Some(!there), Some(!made), pair.map(|pair| !pair)].into_iter().flatten().collect()
    }
}

/// The clauses of one step, both ways.
fn transition(script: &mut Script, graph: &Graph, from: &Layer, step: &Step, to: &Layer) {
    let mut before: FxHashMap<(StateIx, Letter), Vec<Term>> = FxHashMap::default();
    for (&state, &here) in from.states.iter().zip(&from.terms) {
        for &(letter, term) in &step.letters {
            match graph.successor(state, letter).map(|next| (next, to.is(next))) {
                Some((next, there)) if there != Term::FALSE => {
                    script.clause(&[!here, !term, there]);
                    before.entry((next, letter)).or_default().push(here);
                }
                _ => script.clause(&[!here, !term]),
            }
        }
    }
    let mut clause = Vec::new();
    for (&state, &there) in to.states.iter().zip(&to.terms) {
        for &(letter, term) in &step.letters {
            clause.clear();
            clause.extend([!there, !term]);
            clause.extend(before.get(&(state, letter)).into_iter().flatten());
            script.clause(&clause);
        }
    }
}

/// A layer from (state, condition) pairs.
fn gather(terms: &mut Terms, mut pairs: Vec<(StateIx, Term)>) -> Layer {
    pairs.retain(|p| p.1 != Term::FALSE);
    pairs.sort_unstable();
    let mut layer = Layer::new(Vec::new(), Vec::new());
    for same in pairs.chunk_by(|a, b| a.0 == b.0) {
        let when: Vec<Term> = same.iter().map(|p| p.1).collect();
        layer.states.push(same[0].0);
        layer.terms.push(terms.or(&when));
    }
    layer
}
