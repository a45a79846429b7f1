//! What a way of writing states has to provide. There are two: [`crate::enumerated`] and [`crate::variables`].
//!
//! A [`Writer`] knows one objective, and what its paths can be; it is chosen where the encoder is built. A [`Writing`]
//! belongs to one query and keeps the terms of the paths in it, which others know by number only.

use crate::Error;
use crate::names::Copies;
use crate::value::Val;
use hyperplan_problem::{ActionId, Expr, FormulaId, Leaf, PathId, PathLeaf, State, Trace};
use hyperplan_relevance::{Goal, Instance, Known, Narrowing, Relevant};
use hyperplan_smt::{Model, Script, Term, Terms};
use std::sync::Arc;

/// The terms of one path in a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Written(u32);

/// The paths over which the formula is unrolled, by path variable.
pub type Env = Vec<Option<Written>>;

/// Terms of paths, by [`Written`].
#[derive(Debug)]
pub(crate) struct Paths<P>(Vec<P>);

impl<P> Paths<P> {
    pub(crate) fn new() -> Self {
        Paths(Vec::new())
    }

    pub(crate) fn push(&mut self, path: P) -> Written {
        self.0.push(path);
        Written(self.0.len() as u32 - 1)
    }

    pub(crate) fn all_of(&self, env: &Env) -> Vec<Option<&P>> {
        env.iter().map(|path| path.map(|path| &self[path])).collect()
    }
}

impl<P> std::ops::Index<Written> for Paths<P> {
    type Output = P;

    fn index(&self, path: Written) -> &P {
        &self.0[path.0 as usize]
    }
}

/// The path that inputs or a formula refer to: the planner names only paths that it has.
pub(crate) fn at(env: &Env, path: PathId) -> Written {
    env[usize::from(path)].expect("every path that is read was quantified before")
}

/// A path under a quantifier.
pub struct Bound {
    /// The path.
    pub path: Written,
    /// The bound variables.
    pub variables: Vec<Term>,
    /// The condition that they describe a path.
    pub guard: Term,
}

/// A way to write the states of one objective.
pub(crate) trait Writer: Send + Sync {
    /// What can matter of the leading block.
    fn relevant(&self, block: &[PathId], goal: &Goal, narrowing: Narrowing) -> Result<Relevant, Error>;

    /// A query in which some paths are known, with what was found out about those of the leading block.
    fn begin<'e>(
        &'e self,
        known: &[Option<Known>],
        found: Relevant,
        copies: &Arc<Copies>,
        terms: &mut Terms,
    ) -> Box<dyn Writing + 'e>;

    /// A trace cut to its path's horizon; `None` where it is no path of the system, or too short.
    fn known(&self, trace: &Trace) -> Option<Known>;

    /// See [`crate::Encoder::cases`].
    fn cases(&self, path: PathId, goal: &Goal) -> Result<Vec<Instance>, Error>;

    /// See [`crate::Encoder::generalize`].
    fn generalize(&self, path: PathId, counterexample: &Known, before: &[Option<Known>]) -> Instance;

    /// See [`crate::Encoder::realize`].
    fn realize(&self, path: PathId, instance: &Instance, known: &[Option<Known>]) -> Option<Known>;

    /// Whether a path took an action that could have had another outcome.
    fn picks_outcomes(&self, path: PathId, known: &Known) -> bool;

    /// See [`crate::Encoder::stuck`].
    fn stuck(&self, path: PathId) -> Option<Script>;
}

/// The paths of one query. Its methods mean what those of [`crate::Query`] say.
pub(crate) trait Writing: Send {
    fn declare(&mut self, script: &mut Script, path: PathId, goal: &Goal) -> Result<Written, Error>;

    fn bind(&mut self, terms: &mut Terms, path: PathId, goal: &Goal) -> Result<Bound, Error>;

    /// A known path, as constants.
    fn fix(&mut self, terms: &mut Terms, path: PathId, known: &Known) -> Option<Written>;

    fn instantiate(
        &mut self,
        script: &mut Script,
        path: PathId,
        instance: &Instance,
        env: &Env,
        goal: &Goal,
    ) -> Result<(Written, Term), Error>;

    fn restrict(
        &mut self,
        script: &mut Script,
        written: Written,
        goal: &Goal,
        beside: &[(PathId, Known)],
    ) -> Result<(), Error>;

    fn sweep(&mut self, script: &mut Script, path: PathId, env: &Env, goal: &Goal) -> Result<bool, Error>;

    fn symbols(&self, written: Written) -> Vec<Term>;

    fn decode(&self, written: Written, model: &Model) -> Option<Known>;

    /// That a path starts in a state: all of these.
    fn starts(&self, terms: &mut Terms, written: Written, state: &State) -> Vec<Term>;

    /// Whether a step is made by this action.
    fn took(&self, written: Written, step: usize, action: ActionId) -> Term;

    /// Whether two paths of a system are in the same state.
    fn same_state(&self, terms: &mut Terms, p: Written, q: Written, time: u32) -> Term;

    /// Whether a path can take an action.
    fn enabled(&mut self, terms: &mut Terms, path: Written, time: u32, action: ActionId) -> Term;

    /// Whether whatever a path can do leads back to its state.
    fn halted(&mut self, terms: &mut Terms, path: Written, time: u32) -> Term;

    /// A variable or label of a path's state.
    fn leaf(&self, terms: &mut Terms, path: Written, time: u32, leaf: Leaf) -> Val;

    /// The value of a whole expression over one path's state, where there is a shorter way than through its parts.
    fn whole(&self, terms: &mut Terms, path: Written, time: u32, expr: &Expr<PathLeaf>) -> Option<Val>;

    /// The same of an atom, which is asked for again and again.
    fn atom(
        &mut self,
        terms: &mut Terms,
        path: Written,
        time: u32,
        atom: (FormulaId, &Expr<PathLeaf>),
    ) -> Option<Term>;
}
