//! From objectives to queries, and from values back to paths.
//!
//! An [`Encoder`] holds what does not depend on the query: the systems' reachable states where they can be
//! enumerated, and the horizons. A [`Query`] is one script under construction: paths are declared (chosen by the
//! solver), bound (by a quantifier), fixed (constants) or instantiated (defined by inputs in terms of other paths),
//! and the formula is unrolled over them.
//!
//! Nothing here prints or runs a solver.

mod atom;
mod choice;
mod eval;
mod expand;
mod explicit;
mod game;
mod generalize;
mod goal;
mod graph;
mod inputs;
mod inspect;
mod moves;
mod names;
mod path;
mod query;
mod reach;
mod real;
mod realize;
mod residual;
mod sweep;
mod symbolic;
#[cfg(test)]
mod tests;
mod unroll;
mod value;

pub use explicit::FixedPath;
pub use goal::Goal;
pub use graph::{Graph, Graphs, LIVE, Letter, StateIx, TooLarge};
pub use inputs::{Inputs, Move, Start};
pub use inspect::{Findings, inspect};
pub use path::{Instance, Known, Path};
pub use query::{Copies, Env, Narrowing, Query};
pub use reach::Layers;
pub use symbolic::FixedRows;

use hyperplan_problem::{Mode, Node, Objective, PathId, PathLeaf, Problem, System, SystemId, Trace};
use hyperplan_smt::Script;
use moves::Moves;
use std::rc::Rc;
use typed_index_collections::TiVec;

/// A state as a row of integers, one a variable: Booleans as 0 and 1, enumeration values by position.
pub type Row = Box<[i64]>;

/// How states are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum States {
    /// A Boolean for each state that can matter at a time.
    Onehot,
    /// A bit-vector for each variable.
    Bitvec,
    /// An integer for each variable, a real for each that is one.
    Int,
    /// A value of a datatype, one for each state of the system, at each time.
    Enum,
    /// A real for each variable.
    Real,
}

impl States {
    /// Whether the states that can matter are told apart one by one.
    #[must_use]
    pub fn is_enumerated(self) -> bool {
        matches!(self, States::Onehot | States::Enum)
    }

    /// Whether variables are integers or reals.
    #[must_use]
    pub fn is_arithmetic(self) -> bool {
        matches!(self, States::Int | States::Real)
    }
}

/// Budgets of the encoding.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Steps of any path.
    pub horizon: u64,
    /// Enumerated states of a system.
    pub states: usize,
    /// States that can matter, added up over time (with what is left of the formula), of one path.
    pub layer_states: usize,
    /// Joint states of two paths, added up likewise, beyond which they are explored one by one.
    pub pairs: usize,
    /// Pairs of state and residual, added up over time, of a path whose runs are followed all at once.
    pub swept: usize,
    /// Residuals of the formula beyond which pruning forgets it.
    pub residuals: usize,
    /// Cases of one universally quantified path.
    pub cases: usize,
    /// States of a system that become the constructors of a datatype.
    pub constructors: usize,
    /// Whether what a goal asks for says which states can matter. Without, all that can be reached do: answers are
    /// the same, which tests rely on.
    pub prune: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Limits {
            horizon: 100_000,
            states: 2_000_000,
            layer_states: 50_000_000,
            pairs: 6_000_000,
            swept: 3_000_000,
            residuals: 20_000,
            cases: 4096,
            constructors: 65_536,
            prune: true,
        }
    }
}

/// Why an objective cannot be encoded as asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// A path is too long.
    #[error("path {path} would have {steps} steps; more than {limit} are not supported")]
    HorizonTooLong {
        /// The path variable.
        path: String,
        /// Its horizon.
        steps: u64,
        /// The limit.
        limit: u64,
    },
    /// A budget is exceeded.
    #[error("{what}: more than {limit}")]
    TooLarge {
        /// What there is too much of.
        what: String,
        /// The limit.
        limit: usize,
    },
    /// A universally quantified path has too many cases to be expanded.
    #[error("path {path} has more than {limit} cases; use --quantifiers cegis")]
    TooManyCases {
        /// The path variable.
        path: String,
        /// The limit.
        limit: usize,
    },
    /// The caller asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// States are to be enumerated, but there are too many.
    #[error("system {system} has too many states to enumerate; use --states bitvec")]
    NotEnumerable {
        /// The system.
        system: String,
    },
    /// A system has integers or reals without bounds.
    #[error("system {system} has variables without bounds, which takes --states int or real")]
    Unbounded {
        /// The system.
        system: String,
    },
    /// A system is about integers in a way that reals cannot express.
    #[error("{what}, which reals cannot express; use --states int")]
    NotReal {
        /// What it has.
        what: String,
    },
}

/// What is known of one system.
struct Model {
    graph: Option<Rc<Graph>>,
    moves: Option<Rc<Moves>>,
    /// The live states, where the system was enumerated and some are not live.
    live: Option<Vec<Row>>,
}

/// What does not depend on the query.
pub struct Encoder<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective.
    pub objective: &'a Objective,
    /// How states are written.
    pub states: States,
    limits: Limits,
    horizons: TiVec<PathId, u32>,
    models: TiVec<SystemId, Option<Model>>,
    stop: Stop<'a>,
}

/// Asked now and then while something large is built: whether to stop.
pub type Stop<'a> = &'a dyn Fn() -> bool;

impl<'a> Encoder<'a> {
    /// Prepares an objective. Without a wish, states are enumerated where the budget allows.
    ///
    /// # Errors
    /// [`Error::HorizonTooLong`], and [`Error::NotEnumerable`] where enumeration is asked for and impossible. What
    /// is built later fails with [`Error::Interrupted`] soon after `stop` says so.
    pub fn new(
        problem: &'a Problem,
        objective: &'a Objective,
        wish: Option<States>,
        limits: Limits,
        stop: Stop<'a>,
    ) -> Result<Self, Error> {
        Encoder::sharing(problem, objective, wish, limits, stop, &Graphs::default())
    }

    /// As [`Encoder::new`], with what was enumerated before.
    ///
    /// # Errors
    /// Those of [`Encoder::new`].
    pub fn sharing(
        problem: &'a Problem,
        objective: &'a Objective,
        wish: Option<States>,
        limits: Limits,
        stop: Stop<'a>,
        graphs: &Graphs,
    ) -> Result<Self, Error> {
        let horizons = horizons(objective, &limits)?;
        let mut models: TiVec<SystemId, Option<Model>> = problem.systems.iter().map(|_| None).collect();
        let (mut enumerable, mut finite) = (true, true);
        for path in &objective.paths {
            if models[path.system].is_some() {
                continue;
            }
            let system = &problem.systems[path.system];
            if !system.is_finite() && wish.is_some_and(|wish| !wish.is_arithmetic()) {
                return Err(Error::Unbounded { system: system.name.clone() });
            }
            finite &= system.is_finite();
            let graph = graphs.explore(system, limits.states);
            if graph.is_none() && wish.is_some_and(States::is_enumerated) {
                return Err(Error::NotEnumerable { system: system.name.clone() });
            }
            if wish == Some(States::Enum) && graph.as_ref().is_some_and(|g| g.len() > limits.constructors) {
                let what = format!("the states of system {}, each a constructor of a datatype", system.name);
                return Err(Error::TooLarge { what, limit: limits.constructors });
            }
            enumerable &= graph.is_some();
            models[path.system] = Some(Model { graph, moves: None, live: None });
        }
        let states = wish.unwrap_or(match (finite, enumerable) {
            (false, _) => States::Int,
            (true, true) => States::Onehot,
            (true, false) => States::Bitvec,
        });
        let mut encoder = Encoder { problem, objective, states, limits, horizons, models, stop };
        if states == States::Real {
            real::demand(problem, objective)?;
        }
        if !states.is_enumerated() {
            encoder.prepare_symbolic()?;
        }
        Ok(encoder)
    }

    fn prepare_symbolic(&mut self) -> Result<(), Error> {
        for (system, model) in self.problem.systems.iter().zip(self.models.iter_mut()) {
            let Some(model) = model else { continue };
            model.moves = Some(Rc::new(Moves::new(system, self.states)?));
            if let (Some(graph), Mode::Bounded) = (&model.graph, self.objective.mode)
                && !graph.all_live()
            {
                let mut live: Vec<Row> = (0..graph.len() as StateIx)
                    .filter(|&s| graph.rank[s as usize] == LIVE)
                    .map(|s| graph.row(s).into())
                    .collect();
                live.sort_unstable();
                model.live = Some(live);
            }
        }
        Ok(())
    }

    /// The number of steps of a path.
    #[must_use]
    pub fn horizon(&self, path: PathId) -> u32 {
        self.horizons[path]
    }

    /// The system of a path.
    #[must_use]
    pub fn system(&self, path: PathId) -> &'a System {
        &self.problem.systems[self.objective.paths[path].system]
    }

    /// The enumerated states of a path's system.
    #[must_use]
    pub fn graph(&self, path: PathId) -> Option<&Rc<Graph>> {
        self.model(path).graph.as_ref()
    }

    /// Whether a path's system has a path that is long enough (for ever, in bounded mode); `None` where its states
    /// were not enumerated.
    #[must_use]
    pub fn has_path(&self, path: PathId) -> Option<bool> {
        let graph = self.graph(path)?;
        Some(graph.initial.iter().any(|&s| reach::lasts(self.objective.mode, graph, s, 0)))
    }

    /// For a system that was not enumerated, in bounded mode: a script that is unsatisfiable only if no state is a
    /// dead end.
    #[must_use]
    pub fn stuck(&self, path: PathId) -> Script {
        let mut script = Script::new();
        let names = query::names(self, path, 0);
        if let Some(moves) = &self.model(path).moves {
            let builder = symbolic::Builder { names: &names, moves, live: None, horizon: 0 };
            symbolic::stuck_state(&mut script, &builder);
        }
        script
    }

    /// The instance that a counterexample stands for, given the paths before it.
    #[must_use]
    pub fn generalize(&self, path: PathId, counterexample: &Known, before: &[Option<Known>]) -> Instance {
        generalize::generalize(self, path, counterexample, before)
    }

    /// The path that an instance describes once the paths that it refers to are known; `None` where it describes
    /// none.
    #[must_use]
    pub fn realize(&self, path: PathId, instance: &Instance, known: &[Option<Known>]) -> Option<Known> {
        realize::realize(self, path, instance, known)
    }

    /// A trace as the encoder writes it, cut to its path's horizon; `None` where it is no path of the system, or too
    /// short.
    #[must_use]
    pub fn known(&self, trace: &Trace) -> Option<Known> {
        path::known(self, trace)
    }

    /// The finitely many instances that together cover every choice of a path with which its player can
    /// reach the goal.
    ///
    /// # Errors
    /// [`Error::TooManyCases`] beyond the limit, and where states were not enumerated.
    pub fn cases(&self, path: PathId, goal: &Goal) -> Result<Vec<Instance>, Error> {
        let Some(graph) = self.graph(path) else {
            return self.allow_cases(path, usize::MAX).map(|()| Vec::new());
        };
        let symbolic = self.model(path).moves.as_deref();
        if symbolic.is_some_and(Moves::has_inputs) {
            return self.allow_cases(path, usize::MAX).map(|()| Vec::new());
        }
        let cases = expand::cases(self, graph, path, goal, symbolic)?;
        let instance = |inputs: Inputs<StateIx>| match symbolic {
            None => Instance::Explicit(inputs),
            Some(_) => Instance::Symbolic(Inputs {
                start: match inputs.start {
                    Start::State(state) => Start::State(graph.state(self.system(path), state)),
                    Start::Same(path) => Start::Same(path),
                },
                moves: inputs.moves,
                values: Vec::new(),
            }),
        };
        Ok(cases.into_iter().map(instance).collect())
    }

    /// Whether so many copies of the formula may be made on account of a path.
    ///
    /// # Errors
    /// [`Error::TooManyCases`] beyond the limit.
    pub fn allow_cases(&self, path: PathId, copies: usize) -> Result<(), Error> {
        let limit = self.limits.cases;
        let path = self.objective.paths[path].name.clone();
        if copies > limit { Err(Error::TooManyCases { path, limit }) } else { Ok(()) }
    }

    /// An error once the caller wants to stop.
    fn go_on(&self) -> Result<(), Error> {
        if (self.stop)() { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Whether a path took an action that could have had another outcome.
    #[must_use]
    pub fn picks_outcomes(&self, path: PathId, known: &Known) -> bool {
        match known {
            Known::Explicit(p) => p.states.iter().zip(&p.actions).any(|(&state, &action)| {
                let letters = p.graph.successors(state).iter().map(|t| p.graph.letters[t.0 as usize].0);
                letters.filter(|&a| a == action).count() > 1
            }),
            Known::Symbolic(p) => {
                let system = self.system(path);
                let moves = self.model(path).moves.as_deref();
                let picks = |moves: &Moves, at: usize| moves.has_outcomes(system, &p.rows[at], p.actions[at]);
                moves.is_some_and(|moves| (0..p.actions.len()).any(|at| picks(moves, at)))
            }
        }
    }

    fn model(&self, path: PathId) -> &Model {
        self.models[self.objective.paths[path].system].as_ref().expect("every quantified system was prepared")
    }

    fn same_system(&self, p: PathId, q: PathId) -> bool {
        self.objective.paths[p].system == self.objective.paths[q].system
    }

    /// Whether the formula compares actions or states of some two paths.
    #[must_use]
    pub fn has_ties(&self) -> bool {
        let mut paths = self.objective.paths.keys();
        paths.any(|path| !self.tied_before(path).is_empty() || !self.compared_before(path).is_empty())
    }

    /// Whether the formula compares actions or states of two paths.
    fn ties(&self, first: PathId, second: PathId) -> bool {
        [self.tied_before(second), self.compared_before(second)].iter().any(|ties| ties.contains(&first))
    }

    /// The paths quantified before this one whose actions the formula compares with its own.
    fn tied_before(&self, path: PathId) -> Vec<PathId> {
        self.partners(path, |leaf| match *leaf {
            PathLeaf::SameAction(p, q) => Some((p, q)),
            _ => None,
        })
    }

    /// The paths quantified before this one whose states the formula compares with its own.
    fn compared_before(&self, path: PathId) -> Vec<PathId> {
        self.partners(path, |leaf| match *leaf {
            PathLeaf::SameState(p, q) => Some((p, q)),
            _ => None,
        })
    }

    fn partners(&self, path: PathId, pair: impl Fn(&PathLeaf) -> Option<(PathId, PathId)>) -> Vec<PathId> {
        let mut partners = Vec::new();
        for node in &self.objective.formula.nodes {
            let Node::Atom(expr) = node else { continue };
            expr.for_each_leaf(&mut |leaf| {
                if let Some((p, q)) = pair(leaf) {
                    let other = if p == path { q } else { p };
                    if (p == path || q == path) && other < path {
                        partners.push(other);
                    }
                }
            });
        }
        partners.sort_unstable();
        partners.dedup();
        partners
    }
}

/// The number of steps of each path; a path that is not read has none.
fn horizons(objective: &Objective, limits: &Limits) -> Result<TiVec<PathId, u32>, Error> {
    hyperplan_horizon::horizons(objective)
        .iter_enumerated()
        .map(|(path, horizon)| {
            let steps = horizon.steps.unwrap_or(0);
            u32::try_from(steps).ok().filter(|_| steps <= limits.horizon).ok_or_else(|| {
                Error::HorizonTooLong {
                    path: objective.paths[path].name.clone(),
                    steps,
                    limit: limits.horizon,
                }
            })
        })
        .collect()
}
