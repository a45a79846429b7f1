//! What the tests of the modules share: small problems, with all their states.

use crate::goal::Goal;
use crate::reach::Question;
use crate::task::{Arena, Limits, Task};
use hyperplan_problem::{NoFiles, Overrides, PathId, Problem, read};
use hyperplan_space::Graph;
use hyperplan_syntax::SourceMap;
use rustc_hash::FxHashMap;
use std::sync::Arc;

pub(crate) fn problem(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{:#?}", lowered.diagnostics);
    lowered.problem
}

/// The first objective of a problem.
pub(crate) fn arena(problem: &Problem) -> Arena<'_> {
    let objective = &problem.objectives[0];
    let task = Task::new(problem, objective, Limits::default(), &|| false).expect("it is short");
    let graph = |path: PathId| Arc::new(Graph::explore(task.system(path), 1000).expect("it is small"));
    let graphs = objective.paths.keys().map(graph).collect();
    Arena { task, graphs }
}

/// The question about a path of which nothing is known.
pub(crate) fn alone<'a>(
    arena: &'a Arena<'a>,
    path: PathId,
    goal: &'a Goal,
    declared: &'a FxHashMap<PathId, Arc<crate::Layers>>,
) -> Question<'a, 1> {
    Question {
        arena,
        paths: [path],
        within: [None],
        goal,
        fixed: &[None, None],
        declared,
        slack: None,
        least: 0,
        one_run: false,
        budget: 10_000,
    }
}
