//! Plans given by their actions: the states follow where `init`, the objective and the actions leave no choice.

use crate::graph::{Graph, StateId};
use crate::horizon::{horizon, paths_of};
use crate::report::{Budget, Error, Stop};
use hyperplan_problem::answer::write_state;
use hyperplan_problem::{
    Expr, FormulaId, Node, Objective, PathId, PathLeaf, Problem, Quantifier, State, Strategy, Trace, Value,
};

/// Why the states of a plan do not follow from its actions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Open {
    /// No state satisfies `init` and what the objective says of the first state, or the given one is none.
    NoStart {
        /// The plan's path.
        path: PathId,
    },
    /// An action cannot be taken, wherever the plan starts and whatever came of the actions before.
    Stuck {
        /// The plan's path.
        path: PathId,
        /// The action's position.
        step: usize,
        /// A state in which it was to be taken.
        state: State,
    },
    /// The plan can start in several states.
    Starts {
        /// The plan's path.
        path: PathId,
        /// How many.
        count: usize,
        /// Two of them.
        states: [State; 2],
    },
    /// An action has several outcomes.
    Outcomes {
        /// The plan's path.
        path: PathId,
        /// The action's position.
        step: usize,
        /// How many.
        count: usize,
        /// Two of them.
        states: [State; 2],
    },
    /// There are too many states to look at.
    TooMany {
        /// The plan's path.
        path: PathId,
    },
    /// The problem is malformed, or a number leaves 64 bits.
    Error(Error),
}

impl Open {
    /// The reason in words, with the problem's own names.
    #[must_use]
    pub fn describe(&self, problem: &Problem, objective: &Objective) -> String {
        let name = |path: &PathId| objective.paths.get(*path).map_or("?", |p| p.name.as_str());
        let shown = |path: &PathId, state: &State| {
            let state = write_state(&problem.systems[objective.paths[*path].system], state);
            let values: Vec<String> =
                state.0.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            format!("({})", values.join(", "))
        };
        let two = |path: &PathId, [a, b]: &[State; 2]| format!("{} and {}", shown(path, a), shown(path, b));
        match self {
            Open::NoStart { path } => format!("path {} can start nowhere", name(path)),
            Open::Stuck { path, step, state } => {
                format!("path {}, action {step}: it is not possible in {}", name(path), shown(path, state))
            }
            Open::Starts { path, count, states } => format!(
                "path {} can start in {count} states, such as {}; give its first state",
                name(path),
                two(path, states)
            ),
            Open::Outcomes { path, step, count, states } => format!(
                "path {}, action {step}: it can lead to {count} states, such as {}; give the states",
                name(path),
                two(path, states)
            ),
            Open::TooMany { path } => format!("path {} has too many states to follow; give them", name(path)),
            Open::Error(error) => error.to_string(),
        }
    }
}

/// Completes traces that have fewer states than their actions call for, none or the first: where `init`, conjuncts of
/// the objective about the first state alone, and the actions leave one choice of states, these are the trace's. A trace that
/// is shorter than what the objective reads and ends in a state that every action leads back to is continued there, by the
/// system's first action.
///
/// # Errors
/// [`Open`] where a choice is left.
pub fn complete(
    problem: &Problem,
    objective: &Objective,
    strategy: &mut Strategy,
    budget: &Budget,
) -> Result<(), Open> {
    let limit = usize::try_from(budget.states).unwrap_or(usize::MAX);
    for trace in &mut strategy.traces {
        let mut graph = Graph::new(&problem.systems[objective.paths[trace.path].system], limit);
        if trace.states.len() < trace.actions.len() + 1 && trace.states.len() <= 1 {
            trace.states = Followed { objective, trace, graph: &mut graph }.states()?;
        }
        extend(objective, trace, &mut graph).map_err(|stop| opened(stop, trace.path))?;
    }
    Ok(())
}

/// What a search that stopped says of the path.
fn opened(stop: Stop, path: PathId) -> Open {
    match stop {
        Stop::Budget => Open::TooMany { path },
        Stop::Error(error) => Open::Error(error),
    }
}

/// Continues a trace in its last state, if that is absorbing, as far as the objective reads.
fn extend(objective: &Objective, trace: &mut Trace, graph: &mut Graph<'_>) -> Result<(), Stop> {
    let needed = usize::try_from(horizon(objective, trace.path)).unwrap_or(usize::MAX);
    let (Some(last), Some(&action)) = (trace.states.last().cloned(), graph.system.actions.first()) else {
        return Ok(());
    };
    if trace.actions.len() >= needed || needed > LONGEST || !graph.is_state(&last) {
        return Ok(());
    }
    let here = graph.intern(&last)?;
    let system = graph.system;
    let moves = graph.moves(here)?;
    let every = system.actions.iter().all(|a| moves.iter().any(|m| m.action == *a));
    if every && moves.iter().all(|m| m.to == here) {
        trace.actions.resize(needed, action);
        trace.states.resize(needed + 1, last);
    }
    Ok(())
}

/// No trace is continued beyond so many steps.
const LONGEST: usize = 100_000;

struct Followed<'a, 'p> {
    objective: &'a Objective,
    trace: &'a Trace,
    graph: &'a mut Graph<'p>,
}

impl Followed<'_, '_> {
    fn states(&mut self) -> Result<Vec<State>, Open> {
        let layers = self.layers().map_err(|stop| opened(stop, self.trace.path))??;
        if let Some((at, layer)) = layers.iter().enumerate().find(|(_, layer)| layer.len() > 1) {
            return Err(self.choice(at, layer));
        }
        Ok(layers.iter().filter_map(|layer| layer.first()).map(|&state| self.state(state)).collect())
    }

    fn state(&self, id: StateId) -> State {
        self.graph.values(id).iter().copied().collect()
    }

    fn choice(&self, at: usize, layer: &[StateId]) -> Open {
        let (path, count) = (self.trace.path, layer.len());
        let states = [self.state(layer[0]), self.state(layer[1])];
        match at.checked_sub(1) {
            None => Open::Starts { path, count, states },
            Some(step) => Open::Outcomes { path, step, count, states },
        }
    }

    /// The states in which the plan can be at each time, of those runs that go through to its end.
    fn layers(&mut self) -> Result<Result<Vec<Vec<StateId>>, Open>, Stop> {
        let starts = self.starts()?;
        if starts.is_empty() {
            return Ok(Err(Open::NoStart { path: self.trace.path }));
        }
        let mut layers = vec![starts];
        for (step, &action) in self.trace.actions.iter().enumerate() {
            let mut next = Vec::new();
            for &state in &layers[step] {
                next.extend(self.graph.after(state, action)?);
            }
            next.sort_unstable();
            next.dedup();
            if next.is_empty() {
                let (path, state) = (self.trace.path, self.state(layers[step][0]));
                return Ok(Err(Open::Stuck { path, step, state }));
            }
            layers.push(next);
        }
        for (step, &action) in self.trace.actions.iter().enumerate().rev() {
            let mut onward = Vec::new();
            for &state in &layers[step] {
                if self
                    .graph
                    .after(state, action)?
                    .iter()
                    .any(|to| layers[step + 1].binary_search(to).is_ok())
                {
                    onward.push(state);
                }
            }
            layers[step] = onward;
        }
        Ok(Ok(layers))
    }

    /// Where the plan may start: in the state that is given, or in those that `init` and the objective allow.
    fn starts(&mut self) -> Result<Vec<StateId>, Stop> {
        if let Some(given) = self.trace.states.first() {
            // Whether it is initial is for the check to say.
            return if self.graph.is_state(given) {
                Ok(vec![self.graph.intern(given)?])
            } else {
                Ok(Vec::new())
            };
        }
        let mut starts = self.graph.initial_states()?;
        // A counterexample has to make the formula false, which no single conjunct needs to be.
        if self.objective.paths.first().is_none_or(|p| p.quantifier == Quantifier::Forall) {
            return Ok(starts);
        }
        for atom in self.first_state_atoms() {
            starts.retain(|&state| self.holds(state, atom) != Some(false));
        }
        Ok(starts)
    }

    /// The conjuncts of the formula that read nothing but the path's first state.
    fn first_state_atoms(&self) -> Vec<&Expr<PathLeaf>> {
        let nodes = &self.objective.formula.nodes;
        let mut atoms = Vec::new();
        let mut stack: Vec<FormulaId> = nodes.last_key().into_iter().collect();
        while let Some(id) = stack.pop() {
            match &nodes[id] {
                Node::And(parts) => stack.extend(parts),
                Node::Atom(expr) => conjuncts(expr, &mut atoms),
                _ => {}
            }
        }
        atoms.retain(|expr| {
            let mut own = true;
            expr.for_each_leaf(&mut |leaf| {
                own &= matches!(leaf, PathLeaf::State(..)) && paths_of(leaf).contains(&Some(self.trace.path));
            });
            own
        });
        atoms
    }

    fn holds(&self, state: StateId, expr: &Expr<PathLeaf>) -> Option<bool> {
        let value = crate::eval::eval(expr, &|leaf| match leaf {
            PathLeaf::State(_, leaf) => self.graph.leaf(state, *leaf),
            _ => None,
        });
        value.map(|value| value == Value::Bool(true))
    }
}

fn conjuncts<'e>(expr: &'e Expr<PathLeaf>, found: &mut Vec<&'e Expr<PathLeaf>>) {
    match expr {
        Expr::And(parts) => parts.iter().for_each(|part| conjuncts(part, found)),
        other => found.push(other),
    }
}
