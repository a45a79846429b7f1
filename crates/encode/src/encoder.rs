//! How an objective is going to be written, chosen once.

use crate::enumerated::Enumerated;
use crate::paths::Paths;
use crate::variables::{ByVariable, Numbers};
use crate::writing::Writer;
use hyperplan_problem::answer::States;
use hyperplan_problem::{Objective, PathId, Problem, Target};
use hyperplan_relevance::{Arena, Ceiling, Cube, Error, Limits, Stop, Task};
use hyperplan_space::{Graph, Graphs};
use std::sync::Arc;
use typed_index_collections::TiVec;

/// What does not depend on the query: an objective, and how it is going to be written.
pub struct Encoder<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective.
    pub objective: &'a Objective,
    /// How states are written.
    pub states: States,
    /// The objective with its horizons.
    pub task: Task<'a>,
    /// The states of each path's system, where they were enumerated.
    graphs: TiVec<PathId, Option<Arc<Graph>>>,
    /// How states are written, and what comes of that.
    pub writer: Box<dyn Writer + 'a>,
}

/// The choices of the leading block that are looked at; all by default.
#[derive(Clone, Debug, Default)]
pub struct Among {
    /// What targets over their costs are at most; for systems whose states are written one by one.
    pub bounds: Vec<(Target, i64)>,
    /// The case that they are in. Where states are not written one by one all cases are looked at.
    pub cube: Cube,
}

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
        Encoder::among(problem, objective, wish, limits, stop, graphs, &Among::default())
    }

    /// As [`Encoder::sharing`], of some choices of the leading block only. Queries of the leading block have to ask for
    /// bounds by [`Writing::afford`].
    ///
    /// # Errors
    /// Those of [`Encoder::new`], and [`Error::NotEnumerable`] where there are bounds, and states are not written one by one.
    ///
    /// [`Writing::afford`]: crate::Writing::afford
    pub fn among(
        problem: &'a Problem,
        objective: &'a Objective,
        wish: Option<States>,
        limits: Limits,
        stop: Stop<'a>,
        graphs: &Graphs,
        Among { bounds, cube }: &Among,
    ) -> Result<Self, Error> {
        let task = Task::new(problem, objective, limits, stop)?;
        let graphs = explore(&task, wish, graphs)?;
        let finite = objective.paths.iter().all(|path| problem.systems[path.system].is_finite());
        let all: Option<TiVec<PathId, Arc<Graph>>> = graphs.iter().cloned().collect();
        let states = wish.unwrap_or(match (finite, &all) {
            (false, _) => States::Int,
            (true, Some(_)) => States::Onehot,
            (true, None) => States::Bitvec,
        });
        let by_variable = |numbers| -> Result<Box<dyn Writer + 'a>, Error> {
            Ok(Box::new(ByVariable::new(task.clone(), graphs.clone(), numbers)?))
        };
        let writer = match (states, all) {
            _ if !bounds.is_empty() && !states.is_enumerated() => {
                return Err(Error::NotEnumerable { system: task.system(PathId::from(0)).name.clone() });
            }
            (States::Bitvec, _) => by_variable(Numbers::Bits)?,
            (States::Int, _) => by_variable(Numbers::Integers)?,
            (States::Real, _) => by_variable(Numbers::Reals)?,
            (States::Onehot | States::Enum, Some(graphs)) => {
                let ceiling = |(target, most): &(Target, i64)| {
                    Ceiling::new(|path| task.system(path), &graphs, target, *most)
                };
                let ceilings = bounds.iter().map(ceiling).collect();
                let arena = Arena { task: task.clone(), graphs, ceilings, cube: cube.clone() };
                Box::new(Enumerated::new(arena, states == States::Enum))
            }
            (States::Onehot | States::Enum, None) => {
                let paths = graphs.iter_enumerated().filter(|(_, graph)| graph.is_none());
                let system = paths.map(|(path, _)| task.system(path).name.clone()).next();
                return Err(Error::NotEnumerable { system: system.unwrap_or_default() });
            }
        };
        Ok(Encoder { problem, objective, states, task, graphs, writer })
    }

    /// The same with other things standing for what paths do; states have to be written by variable.
    ///
    /// # Errors
    /// [`Error::NoFunctions`] where they are written one by one; those of [`Encoder::new`].
    pub fn with_paths(mut self, paths: Paths) -> Result<Self, Error> {
        let numbers = match self.states {
            _ if paths == Paths::Symbols => return Ok(self),
            States::Onehot | States::Enum => return Err(Error::NoFunctions { states: self.states.name() }),
            States::Bitvec => Numbers::Bits,
            States::Int => Numbers::Integers,
            States::Real => Numbers::Reals,
        };
        let writer = ByVariable::new(self.task.clone(), self.graphs.clone(), numbers)?;
        self.writer = Box::new(writer.with_paths(paths));
        Ok(self)
    }

    /// Whether every path has finitely many states to be in.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.objective.paths.keys().all(|path| self.task.system(path).is_finite())
    }

    /// Whether a path's system has a path that is long enough (for ever, in bounded mode); `None` where its states
    /// were not enumerated.
    #[must_use]
    pub fn has_path(&self, path: PathId) -> Option<bool> {
        let graph = self.graphs[path].as_ref()?;
        Some(graph.initial.iter().any(|&state| self.task.lasts(graph, state, 0)))
    }
}

/// The states of each path's system, where they can be enumerated.
fn explore(
    task: &Task<'_>,
    wish: Option<States>,
    graphs: &Graphs,
) -> Result<TiVec<PathId, Option<Arc<Graph>>>, Error> {
    let mut all: TiVec<PathId, Option<Arc<Graph>>> = TiVec::new();
    for path in task.objective.paths.keys() {
        if let Some(same) = all.keys().find(|&other| task.same_system(other, path)) {
            all.push(all[same].clone());
            continue;
        }
        let system = task.system(path);
        if !system.is_finite() && wish.is_some_and(|wish| !wish.is_arithmetic()) {
            return Err(Error::Unbounded { system: system.name.clone() });
        }
        let graph = graphs.explore(system, task.limits.states);
        let limit = task.limits.constructors;
        if wish == Some(States::Enum) && graph.as_ref().is_some_and(|g| g.len() > limit) {
            let what = format!("the states of system {}, each a constructor of a datatype", system.name);
            return Err(Error::TooLarge { what, limit });
        }
        all.push(graph);
    }
    Ok(all)
}
