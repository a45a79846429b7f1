//! What is to be decided: an objective, how far each of its paths is read, and the budgets.

use crate::ceiling::Ceiling;
use crate::cube::Cube;
use hyperplan_horizon::{Horizon, horizons};
use hyperplan_problem::{Mode, Objective, PathId, Problem, System};
use hyperplan_space::{Graph, LIVE, StateIx};
use std::sync::Arc;
use typed_index_collections::TiVec;

/// What says which states can matter at a time. Answers are the same, which tests rely on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pruning {
    /// Nothing: all states of a system do at every time, but for the first, where paths begin.
    None,
    /// The steps: those states do that can be reached by then.
    Light,
    /// The goal too: those do through which it can still be met.
    #[default]
    Full,
}

/// Budgets, and how much to prune.
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
    /// Chances of the other player that an explicit search may look at.
    pub chances: usize,
    /// Cases of one universally quantified path.
    pub cases: usize,
    /// States of a system that become the constructors of a datatype.
    pub constructors: usize,
    /// What says which states can matter.
    pub pruning: Pruning,
}

impl Limits {
    /// Whether what a goal asks for says which states can matter.
    #[must_use]
    pub fn prunes(&self) -> bool {
        self.pruning == Pruning::Full
    }
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
            chances: usize::MAX,
            cases: 4096,
            constructors: 65_536,
            pruning: Pruning::Full,
        }
    }
}

/// Why an objective cannot be decided as asked.
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
    #[error("path {path} has more than {limit} cases")]
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
    #[error("system {system} has too many states to enumerate")]
    NotEnumerable {
        /// The system.
        system: String,
    },
    /// A system has integers or reals without bounds.
    #[error("system {system} has variables without bounds")]
    Unbounded {
        /// The system.
        system: String,
    },
    /// Functions of time are for states that are written by variable.
    #[error(
        "paths are functions where states are written by variable, as bitvec, int or real, not as {states}"
    )]
    NoFunctions {
        /// How states are written.
        states: &'static str,
    },
    /// A system is about integers in a way that reals cannot express.
    #[error("{what}, which reals cannot express")]
    NotReal {
        /// What it has.
        what: String,
    },
}

/// Asked now and then while something large is built: whether to stop.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// An objective with its horizons and budgets.
#[derive(Clone)]
pub struct Task<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective.
    pub objective: &'a Objective,
    /// How many steps of each path are read.
    horizons: TiVec<PathId, u32>,
    /// The budgets.
    pub limits: Limits,
    /// Whether to stop.
    pub stop: Stop<'a>,
}

impl<'a> Task<'a> {
    /// An objective with the horizons of its paths; one that is not read has none.
    ///
    /// # Errors
    /// [`Error::HorizonTooLong`].
    pub fn new(
        problem: &'a Problem,
        objective: &'a Objective,
        limits: Limits,
        stop: Stop<'a>,
    ) -> Result<Self, Error> {
        let steps = |(path, horizon): (PathId, &Horizon)| {
            let (steps, limit) = (horizon.steps.unwrap_or(0), limits.horizon);
            let path = || objective.paths[path].name.clone();
            let fits = u32::try_from(steps).ok().filter(|_| steps <= limit);
            fits.ok_or_else(|| Error::HorizonTooLong { path: path(), steps, limit })
        };
        let horizons = horizons(objective).iter_enumerated().map(steps).collect::<Result<_, _>>()?;
        Ok(Task { problem, objective, horizons, limits, stop })
    }

    /// The number of steps of a path.
    pub fn horizon(&self, path: PathId) -> u32 {
        self.horizons[path]
    }

    /// The last time that any path is read at.
    pub fn end(&self) -> u32 {
        self.horizons.iter().copied().max().unwrap_or(0)
    }

    /// The system of a path.
    pub fn system(&self, path: PathId) -> &'a System {
        &self.problem.systems[self.objective.paths[path].system]
    }

    /// Whether two paths are of one system.
    pub fn same_system(&self, p: PathId, q: PathId) -> bool {
        self.objective.paths[p].system == self.objective.paths[q].system
    }

    /// Whether a time is the last position of every trace.
    pub fn is_last(&self, time: u32) -> bool {
        self.objective.mode == Mode::Within(time)
    }

    /// Whether a state allows enough further steps at a time: any number in bounded mode, all that are left under
    /// `within`.
    pub fn lasts(&self, graph: &Graph, state: StateIx, time: u32) -> bool {
        let rank = graph.rank[state as usize];
        match self.objective.mode {
            Mode::Bounded => rank == LIVE,
            Mode::Within(steps) => rank >= steps.saturating_sub(time),
        }
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
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn go_on(&self) -> Result<(), Error> {
        if (self.stop)() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

/// A task all of whose systems are enumerated.
#[derive(Clone)]
pub struct Arena<'a> {
    /// The task.
    pub task: Task<'a>,
    /// The states of each path's system.
    pub graphs: TiVec<PathId, Arc<Graph>>,
    /// What the paths of the leading block may cost.
    pub ceilings: Vec<Ceiling>,
    /// The runs of the leading block that are looked at.
    pub cube: Cube,
}
