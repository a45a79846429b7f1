//! What the symbols of paths are called.

use hyperplan_problem::{PathId, Problem, System, Type, Value};
use hyperplan_relevance::Task;
use hyperplan_smt::Script;
use hyperplan_space::{Graph, Letter, StateIx};
use rustc_hash::FxHashMap;
use std::borrow::Cow;
use std::sync::{Mutex, PoisonError};

/// How many paths each path variable has stood for, so that all have names of their own.
#[derive(Debug, Default)]
pub struct Copies(Mutex<FxHashMap<PathId, u32>>);

impl Copies {
    /// Names for one more.
    pub(crate) fn next<'a>(&self, task: &Task<'a>, path: PathId) -> Names<'a> {
        let mut copies = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let copy = copies.entry(path).or_default();
        *copy += 1;
        Names::new(task, path, *copy - 1)
    }
}

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

impl<'a> Names<'a> {
    /// Names for a copy of a path variable.
    pub(crate) fn new(task: &Task<'a>, path: PathId, copy: u32) -> Self {
        let name = &task.objective.paths[path].name;
        let name = if copy == 0 { name.clone() } else { format!("{name}~{copy}") };
        Names { problem: task.problem, system: task.system(path), path: name }
    }

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
}
