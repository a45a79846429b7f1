//! Instances of a path, defined by inputs in terms of other paths; instances share the steps that they have in common.

use super::path::{EnumeratedPath, Layer, Step};
use crate::names::Names;
use crate::writing::at;
use hyperplan_problem::PathId;
use hyperplan_relevance::{Instance, Layers, Move, Start};
use hyperplan_smt::{Script, Sort, Term};
use hyperplan_space::{Graph, StateIx};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Builds instances of a universally quantified path, sharing the steps that instances have in common.
#[derive(Default)]
pub(crate) struct Instances {
    /// For a path variable (each is pruned in its own way), the layer that follows a layer under a move at a time,
    /// where the move follows a step of another path. Layers and steps count by address, as there are several
    /// instances of a path; they are kept alive here, so that addresses stay unique.
    next: FxHashMap<(PathId, usize, Move, usize, usize), Shared>,
}

/// A layer, what follows it, the step between, and the step of another path that it follows.
type Shared = (Arc<Layer>, Arc<Layer>, Arc<Step>, Option<Arc<Step>>);

/// What an instance is built from.
pub(crate) struct Building<'b, 'n> {
    pub(crate) script: &'b mut Script,
    pub(crate) path: PathId,
    /// Names of its symbols; fresh for each instance.
    pub(crate) names: &'b Names<'n>,
    pub(crate) graph: &'b Arc<Graph>,
    /// What can matter of the path.
    pub(crate) layers: &'b Layers,
    /// The paths that the inputs may refer to.
    pub(crate) env: &'b [Option<&'b EnumeratedPath>],
}

impl Instances {
    /// The path that starts and moves as `inputs` say, and the condition that it is a path through the layers.
    pub(crate) fn build(
        &mut self,
        building: &mut Building<'_, '_>,
        inputs: &Instance,
    ) -> (EnumeratedPath, Term) {
        let graph = building.graph;
        let first = match &inputs.start {
            Start::Same(other) => at(building.env, *other).layers[0].clone(),
            Start::State(state) => building.only(graph.initial_state(state)),
        };
        let mut path = EnumeratedPath {
            path: building.path,
            graph: graph.clone(),
            layers: vec![first],
            steps: Vec::new(),
        };
        for (time, &movement) in inputs.moves.iter().enumerate() {
            let here = path.layers[time].clone();
            let followed = match movement {
                Move::Same(other) | Move::SameAction(other, _) => {
                    Some(at(building.env, other).steps[time].clone())
                }
                Move::Act(..) => None,
            };
            let address = followed.as_ref().map_or(0, |step| Arc::as_ptr(step) as usize);
            let key = (building.path, Arc::as_ptr(&here) as usize, movement, address, time);
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
    /// The first layer of a path that starts in this state and nowhere else: that of another path, if one does so,
    /// to share what follows. Without a state, or where it cannot matter, there is none to start in.
    fn only(&self, state: Option<StateIx>) -> Arc<Layer> {
        let Some(state) = state else { return Arc::new(Layer::new(Vec::new(), Vec::new())) };
        let others = self.env.iter().flatten().filter(|path| Arc::ptr_eq(&path.graph, self.graph));
        let mut starts = others.map(|path| &path.layers[0]);
        let shared = starts.find(|layer| layer.states == [state] && layer.terms == [Term::TRUE]);
        shared.cloned().unwrap_or_else(|| {
            let possible = self.layers.contains(0, state);
            Arc::new(if possible { Layer::only(state) } else { Layer::new(Vec::new(), Vec::new()) })
        })
    }

    fn step(&mut self, here: &Arc<Layer>, movement: Move, time: usize) -> (Arc<Layer>, Arc<Step>) {
        let graph = self.graph;
        match movement {
            Move::Same(other) => {
                let other = at(self.env, other);
                let step = other.steps[time].clone();
                if Arc::ptr_eq(here, &other.layers[time]) {
                    // The same state and the same letter: the same path up to here and one step on.
                    return (other.layers[time + 1].clone(), step);
                }
                (self.follow(here, &step.letters, time, |s, l| graph.successor(s, l)), step)
            }
            Move::SameAction(other, number) => {
                let actions = at(self.env, other).steps[time].actions.clone();
                let next =
                    self.follow(here, &actions, time, |s, a| graph.outcome(s, a, number).map(|to| to.1));
                (next, Arc::new(Step::of_actions(actions)))
            }
            Move::Act(action, number) => {
                let actions = vec![(action, Term::TRUE)];
                let next =
                    self.follow(here, &actions, time, |s, a| graph.outcome(s, a, number).map(|to| to.1));
                (next, Arc::new(Step::of_actions(actions)))
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
    ) -> Arc<Layer> {
        let mut edges: Vec<(StateIx, usize, Term)> = Vec::new();
        for (&state, &when) in here.states.iter().zip(&here.terms) {
            for (at, &(choice, _)) in choices.iter().enumerate() {
                let to = successor(state, choice).filter(|&to| self.layers.contains(time + 1, to));
                edges.extend(to.map(|to| (to, at, when)));
            }
        }
        edges.sort_unstable();
        let terms: Vec<Term> = choices.iter().map(|c| c.1).collect();
        let certain = terms == [Term::TRUE];
        let mut layer = Layer::new(Vec::new(), Vec::new());
        for to in edges.chunk_by(|a, b| a.0 == b.0) {
            let term = match to {
                [(_, at, when)] if certain || *when == Term::TRUE => {
                    if certain {
                        *when
                    } else {
                        terms[*at]
                    }
                }
                _ if certain => {
                    let when: Vec<Term> = to.iter().map(|edge| edge.2).collect();
                    self.script.terms.or(&when)
                }
                _ => self.define(to, &terms, time + 1),
            };
            layer.states.push(to[0].0);
            layer.terms.push(term);
        }
        Arc::new(layer)
    }

    /// A symbol that is true exactly if one of the edges is taken: for each choice, from one of its states.
    fn define(&mut self, edges: &[(StateIx, usize, Term)], choices: &[Term], time: usize) -> Term {
        let stem = self.script.terms.stem(&self.names.state(self.graph, edges[0].0));
        let there = self.script.terms.symbol(stem, Some(time as u32), Sort::Bool);
        let mut clause = Vec::new();
        for (at, &choice) in choices.iter().enumerate() {
            clause.clear();
            clause.extend([!there, !choice]);
            for edge in edges.iter().filter(|edge| edge.1 == at) {
                self.script.clause(&[!edge.2, !choice, there]);
                clause.push(edge.2);
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
