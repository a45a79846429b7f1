//! Paths whose states are enumerated: a condition for each state that can matter at a time, and one for each letter
//! (action and outcome number) of a step. The symbols behind them are Booleans (`--states onehot`), or one of an
//! enumeration for each time (`--states enum`).

use crate::choice::{self, Alphabet, Choice, Place};
use crate::graph::{Graph, Letter, StateIx};
use crate::inputs::{Inputs, Move, Start};
use crate::names::Names;
use crate::reach::Layers;
use crate::{Error, Stop};
use hyperplan_problem::{ActionId, PathId};
use hyperplan_smt::{Model, Script, Sort, Term, Terms};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// A path whose every state and letter is known.
#[derive(Clone, Debug)]
pub struct FixedPath {
    pub(crate) graph: Rc<Graph>,
    pub(crate) states: Vec<StateIx>,
    pub(crate) letters: Vec<Letter>,
    pub(crate) actions: Vec<ActionId>,
}

impl FixedPath {
    /// From the states and letters of a path.
    pub(crate) fn new(graph: Rc<Graph>, states: Vec<StateIx>, letters: Vec<Letter>) -> FixedPath {
        let actions = letters.iter().map(|&l| graph.letters[l as usize].0).collect();
        FixedPath { graph, states, letters, actions }
    }
}

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
    fn new(states: Vec<StateIx>, terms: Vec<Term>) -> Layer {
        Layer { states, terms, variable: None }
    }

    /// The only state.
    fn only(state: StateIx) -> Layer {
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
    fn of_actions(actions: Vec<(ActionId, Term)>) -> Step {
        Step { letters: Vec::new(), actions, variable: None }
    }

    /// Whether the action is this one.
    pub(crate) fn took(&self, action: ActionId) -> Term {
        self.actions.iter().find(|a| a.0 == action).map_or(Term::FALSE, |a| a.1)
    }
}

/// The terms of a path: `layers[t]` its state at time t, `steps[t]` what leads from there to t + 1.
#[derive(Clone, Debug)]
pub(crate) struct ExplicitPath {
    pub(crate) graph: Rc<Graph>,
    pub(crate) layers: Vec<Rc<Layer>>,
    pub(crate) steps: Vec<Rc<Step>>,
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

impl ExplicitPath {
    /// A path that the solver chooses: a symbol for each state of the layers and each letter, and clauses that make
    /// them a path. With exactly one state at time 0 and exactly one letter a step, both directions of the
    /// transition leave exactly one state at every time.
    ///
    /// # Errors
    /// [`Error::Interrupted`] soon after `stop` says so.
    pub(crate) fn declare(
        script: &mut Script,
        names: &Names<'_>,
        graph: &Rc<Graph>,
        layers: &Layers,
        alphabet: &Alphabet,
        stop: Stop<'_>,
    ) -> Result<Self, Error> {
        script.section(format!("path.{}", names.path), format!("path {}: where it starts", names.path));
        if layers.at.iter().any(Vec::is_empty) {
            script.assert(Term::FALSE);
        }
        let mut path = ExplicitPath { graph: graph.clone(), layers: Vec::new(), steps: Vec::new() };
        for (time, states) in layers.at.iter().enumerate() {
            let place = Place { time, bound: false };
            let choice = names.choose_state(&mut script.terms, graph, states, &place, alphabet);
            if time == 0 {
                let start = choice.is_made(&mut script.terms);
                script.assert(start);
            }
            path.layers.push(Rc::new(Layer {
                states: states.clone(),
                terms: choice.terms,
                variable: choice.variable,
            }));
        }
        for time in 0..path.layers.len() - 1 {
            if stop() {
                return Err(Error::Interrupted);
            }
            names.begin_step(script, time + 1);
            let letters = letters_between(graph, layers, time);
            let place = Place { time: time + 1, bound: false };
            let choice = names.choose_letter(&mut script.terms, graph, &letters, &place, alphabet);
            let made = choice.is_made(&mut script.terms);
            script.assert(made);
            let step = Step::new(&mut script.terms, graph, letters, choice);
            transition(script, graph, &path.layers[time], &step, &path.layers[time + 1]);
            path.steps.push(Rc::new(step));
        }
        Ok(path)
    }

    /// A path whose initial state and letters are bound variables and whose other states are defined by them: the
    /// path, the variables, and the condition that they are a path.
    ///
    /// # Errors
    /// [`Error::Interrupted`] soon after `stop` says so.
    pub(crate) fn bind(
        terms: &mut Terms,
        names: &Names<'_>,
        graph: &Rc<Graph>,
        layers: &Layers,
        alphabet: &Alphabet,
        stop: Stop<'_>,
    ) -> Result<(Self, Vec<Term>, Term), Error> {
        let mut guards = Vec::new();
        let mut bound = Vec::new();
        let mut bind = |terms: &mut Terms, choice: &Choice| {
            bound.extend(choice::symbols(choice.variable, choice.terms.iter().copied()));
            guards.push(choice.is_made(terms));
        };
        let place = Place { time: 0, bound: true };
        let start = names.choose_state(terms, graph, &layers.at[0], &place, alphabet);
        bind(terms, &start);
        let mut path = ExplicitPath { graph: graph.clone(), layers: Vec::new(), steps: Vec::new() };
        path.layers.push(Rc::new(Layer::new(layers.at[0].clone(), start.terms)));
        for time in 0..layers.at.len() - 1 {
            if stop() {
                return Err(Error::Interrupted);
            }
            let letters = letters_between(graph, layers, time);
            let place = Place { time: time + 1, bound: true };
            let choice = names.choose_letter(terms, graph, &letters, &place, alphabet);
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
            path.layers.push(Rc::new(gather(terms, next)));
            path.steps.push(Rc::new(step));
        }
        let arrived = path.layers.last().map_or(Vec::new(), |l| l.terms.clone());
        guards.push(terms.or(&arrived));
        let guard = terms.and(&guards);
        Ok((path, bound, guard))
    }

    /// A known path, as constants.
    pub(crate) fn fix(fixed: &FixedPath) -> Self {
        let layer = |&state: &StateIx| Rc::new(Layer::only(state));
        let step = |(&letter, &action): (&Letter, &ActionId)| {
            let letters = vec![(letter, Term::TRUE)];
            Rc::new(Step { letters, actions: vec![(action, Term::TRUE)], variable: None })
        };
        ExplicitPath {
            graph: fixed.graph.clone(),
            layers: fixed.states.iter().map(layer).collect(),
            steps: fixed.letters.iter().zip(&fixed.actions).map(step).collect(),
        }
    }

    /// The symbols that a model must give values to, so that [`ExplicitPath::decode`] can read the path.
    pub(crate) fn symbols(&self) -> Vec<Term> {
        let start = &self.layers[0];
        let mut symbols = choice::symbols(start.variable, start.terms.iter().copied());
        for step in &self.steps {
            symbols.extend(choice::symbols(step.variable, step.letters.iter().map(|l| l.1)));
        }
        symbols
    }

    /// The path that a model describes, by replaying its letters from its initial state; `None` if it is none.
    pub(crate) fn decode(&self, model: &Model) -> Option<FixedPath> {
        let first = &self.layers[0];
        let starts = first.states.iter().copied().zip(first.terms.iter().copied());
        let mut states = vec![choice::chosen(first.variable, starts, model)?];
        let mut letters = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            let letter = choice::chosen(step.variable, step.letters.iter().copied(), model)?;
            states.push(self.graph.successor(*states.last()?, letter)?);
            letters.push(letter);
        }
        Some(FixedPath::new(self.graph.clone(), states, letters))
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

/// Builds instances of a universally quantified path, sharing the steps that instances have in common.
#[derive(Default)]
pub(crate) struct Instances {
    /// For a path variable (each is pruned in its own way), the layer that follows a layer under a move at a time,
    /// where the move follows a step of another path. Layers and steps count by address, as there are several
    /// instances of a path; they are kept alive here, so that addresses stay unique.
    next: FxHashMap<(PathId, usize, Move, usize, usize), Shared>,
}

/// A layer, what follows it, the step between, and the step of another path that it follows.
type Shared = (Rc<Layer>, Rc<Layer>, Rc<Step>, Option<Rc<Step>>);

/// What an instance is built from.
pub(crate) struct Building<'b, 'n> {
    pub(crate) script: &'b mut Script,
    pub(crate) path: PathId,
    /// Names of its symbols; fresh for each instance.
    pub(crate) names: &'b Names<'n>,
    pub(crate) graph: &'b Rc<Graph>,
    /// What can matter of the path.
    pub(crate) layers: &'b Layers,
    /// The paths that the inputs may refer to.
    pub(crate) env: &'b [Option<&'b ExplicitPath>],
}

impl Instances {
    /// The path that starts and moves as `inputs` say, and the condition that it is a path through the layers.
    pub(crate) fn build(
        &mut self,
        building: &mut Building<'_, '_>,
        inputs: &Inputs<StateIx>,
    ) -> (ExplicitPath, Term) {
        let graph = building.graph;
        let first = match inputs.start {
            Start::Same(other) => at(building.env, other).layers[0].clone(),
            Start::State(state) => only_start(building.env, graph, state).unwrap_or_else(|| {
                let possible = building.layers.contains(0, state);
                Rc::new(if possible { Layer::only(state) } else { Layer::new(Vec::new(), Vec::new()) })
            }),
        };
        let mut path = ExplicitPath { graph: graph.clone(), layers: vec![first], steps: Vec::new() };
        for (time, &movement) in inputs.moves.iter().enumerate() {
            let here = path.layers[time].clone();
            let followed = match movement {
                Move::Same(other) | Move::SameAction(other, _) => {
                    Some(at(building.env, other).steps[time].clone())
                }
                Move::Act(..) => None,
            };
            let address = followed.as_ref().map_or(0, |step| Rc::as_ptr(step) as usize);
            let key = (building.path, Rc::as_ptr(&here) as usize, movement, address, time);
            let shared = self.next.entry(key).or_insert_with(|| {
                let (next, step) = building.step(&here, movement, time);
                (here, next, step, followed)
            });
            path.layers.push(shared.1.clone());
            path.steps.push(shared.2.clone());
        }
        let arrived: Vec<Term> = path.layers.last().map_or(Vec::new(), |l| l.terms.clone());
        let guard = building.script.terms.or(&arrived);
        (path, guard)
    }
}

impl Building<'_, '_> {
    fn step(&mut self, here: &Rc<Layer>, movement: Move, time: usize) -> (Rc<Layer>, Rc<Step>) {
        let graph = self.graph;
        match movement {
            Move::Same(other) => {
                let other = at(self.env, other);
                let step = other.steps[time].clone();
                if Rc::ptr_eq(here, &other.layers[time]) {
                    // The same state and the same letter: the same path up to here and one step on.
                    return (other.layers[time + 1].clone(), step);
                }
                (self.follow(here, &step.letters, time, |s, l| graph.successor(s, l)), step)
            }
            Move::SameAction(other, number) => {
                let actions = at(self.env, other).steps[time].actions.clone();
                let next = self.follow(here, &actions, time, |s, a| graph.outcome(s, a, number));
                (next, Rc::new(Step::of_actions(actions)))
            }
            Move::Act(action, number) => {
                let actions = vec![(action, Term::TRUE)];
                let next = self.follow(here, &actions, time, |s, a| graph.outcome(s, a, number));
                (next, Rc::new(Step::of_actions(actions)))
            }
        }
    }

    /// The layer after a step. At most one of the choices is true, and at most one of the states, so clauses in both
    /// directions define a symbol for each next state; where there is one way to get there, no symbol is needed.
    fn follow<T: Copy + PartialEq>(
        &mut self,
        here: &Layer,
        choices: &[(T, Term)],
        time: usize,
        successor: impl Fn(StateIx, T) -> Option<StateIx>,
    ) -> Rc<Layer> {
        let mut ways: Vec<(StateIx, usize, Term)> = Vec::new();
        for (&state, &when) in here.states.iter().zip(&here.terms) {
            for (at, &(choice, _)) in choices.iter().enumerate() {
                let to = successor(state, choice).filter(|&to| self.layers.contains(time + 1, to));
                ways.extend(to.map(|to| (to, at, when)));
            }
        }
        ways.sort_unstable();
        let terms: Vec<Term> = choices.iter().map(|c| c.1).collect();
        let certain = terms == [Term::TRUE];
        let mut layer = Layer::new(Vec::new(), Vec::new());
        for to in ways.chunk_by(|a, b| a.0 == b.0) {
            let term = match to {
                [(_, at, when)] if certain || *when == Term::TRUE => {
                    if certain {
                        *when
                    } else {
                        terms[*at]
                    }
                }
                _ if certain => {
                    let when: Vec<Term> = to.iter().map(|way| way.2).collect();
                    self.script.terms.or(&when)
                }
                _ => self.define(to, &terms, time + 1),
            };
            layer.states.push(to[0].0);
            layer.terms.push(term);
        }
        Rc::new(layer)
    }

    /// A symbol that is true exactly if one of the ways is gone: for each choice, from one of its states.
    fn define(&mut self, ways: &[(StateIx, usize, Term)], choices: &[Term], time: usize) -> Term {
        let stem = self.script.terms.stem(&self.names.state(self.graph, ways[0].0));
        let there = self.script.terms.symbol(stem, Some(time as u32), Sort::Bool);
        let mut clause = Vec::new();
        for (at, &choice) in choices.iter().enumerate() {
            clause.clear();
            clause.extend([!there, !choice]);
            for way in ways.iter().filter(|way| way.1 == at) {
                self.script.clause(&[!way.2, !choice, there]);
                clause.push(way.2);
            }
            self.script.clause(&clause);
        }
        // Another system's path may do what this system cannot.
        clause.clear();
        clause.push(!there);
        clause.extend_from_slice(choices);
        self.script.clause(&clause);
        there
    }
}

/// The path that inputs refer to: the planner names only paths that it has.
fn at<'a>(env: &[Option<&'a ExplicitPath>], path: PathId) -> &'a ExplicitPath {
    env[usize::from(path)].expect("inputs refer to paths quantified before")
}

/// The first layer of a path that starts in this state and nowhere else, to share what follows.
fn only_start(env: &[Option<&ExplicitPath>], graph: &Rc<Graph>, state: StateIx) -> Option<Rc<Layer>> {
    env.iter()
        .flatten()
        .filter(|path| Rc::ptr_eq(&path.graph, graph))
        .map(|path| &path.layers[0])
        .find(|layer| layer.states == [state] && layer.terms == [Term::TRUE])
        .cloned()
}
