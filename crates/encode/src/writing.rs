//! What a way of writing states has to provide. There are two: `enumerated` and `variables`.
//!
//! A [`Writer`] knows one objective, and what its paths can be; it is chosen where the encoder is built. A [`Writing`]
//! belongs to one query and keeps the terms of the paths in it, which others know by number only.

use crate::names::Copies;
use crate::value::Val;
use derive_more::{From, Into};
use hyperplan_problem::{ActionId, Expr, FormulaId, Leaf, PathId, PathLeaf, State, Trace};
use hyperplan_relevance::Error;
use hyperplan_relevance::{Belief, Case, Goal, Instance, Known, Narrowing, Relevant};
use hyperplan_smt::{Features, Model, Script, Term, Terms};
use std::sync::Arc;
use typed_index_collections::TiVec;

/// The terms of one path in a query, by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, From, Into)]
pub struct PathIx(usize);

/// The paths over which the formula is unrolled, by path variable.
pub type Env = Vec<Option<PathIx>>;

/// The terms of the paths of an environment.
pub(crate) fn all_of<'p, P>(paths: &'p TiVec<PathIx, P>, env: &Env) -> Vec<Option<&'p P>> {
    env.iter().map(|path| path.map(|path| &paths[path])).collect()
}

/// The path that inputs or a formula refer to: the planner names only paths that it has.
pub(crate) fn at<T: Copy>(env: &[Option<T>], path: PathId) -> T {
    env[usize::from(path)].expect("every path that is read was quantified before")
}

/// A path under a quantifier.
pub struct Bound {
    /// The path.
    pub path: PathIx,
    /// The bound variables.
    pub variables: Vec<Term>,
    /// The condition that they describe a path.
    pub guard: Term,
}

/// A way to write the states of one objective.
pub trait Writer: Send + Sync {
    /// What can matter of the leading block for its player to reach the goal; by default, everything does.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    fn relevant(&self, _: &[PathId], _: &Goal, _: Narrowing) -> Result<Relevant, Error> {
        Ok(Relevant::default())
    }

    /// Searches for the paths of the leading block by what the other block, the last, may be doing, without any query; see
    /// [`Belief`]. `budget` is in chances looked at. By default it is not known how.
    ///
    /// # Errors
    /// [`Error::Interrupted`], and [`Error::TooLarge`] where too much can matter.
    fn believe(&self, _: &[PathId], _: &Goal, _: usize) -> Result<Belief<Vec<Known>>, Error> {
        Ok(Belief::Unfit)
    }

    /// A value that the last of the targets with a bound is not below, whatever the choice of the leading block for its player
    /// to reach the goal; `None` where it is not known how to tell.
    ///
    /// # Errors
    /// [`Error::Interrupted`], and [`Error::TooLarge`] where too much can matter.
    fn least(&self, _: &Goal) -> Result<Option<i64>, Error> {
        Ok(None)
    }

    /// One of so many cases of the leading block, by its number from 0, that together have all of its choices that matter. By default it
    /// is not known how to cut.
    ///
    /// # Errors
    /// [`Error::Interrupted`], and [`Error::TooLarge`] where too much can matter.
    fn case(&self, _: &[PathId], _: &Goal, _: (usize, usize)) -> Result<Case, Error> {
        Ok(Case::Whole)
    }

    /// The paths of a query in which some are known, with what was found out about those of the leading block.
    fn begin<'e>(
        &'e self,
        known: &[Option<Known>],
        found: Relevant,
        copies: &Arc<Copies>,
        terms: &mut Terms,
    ) -> Box<dyn Writing + 'e>;

    /// A trace as a known path, cut to its horizon; `None` where it is no path of the system, or too short.
    fn known(&self, trace: &Trace) -> Option<Known>;

    /// The finitely many instances that together cover every choice of a path with which its player can
    /// reach the goal.
    ///
    /// # Errors
    /// [`Error::TooManyCases`] beyond the limit, and where states were not enumerated.
    fn cases(&self, path: PathId, goal: &Goal) -> Result<Vec<Instance>, Error>;

    /// The instance that a counterexample stands for, given the paths before it. Beside these the instance is exactly
    /// the counterexample.
    fn generalize(&self, path: PathId, counterexample: &Known, before: &[Option<Known>]) -> Instance;

    /// The path that an instance describes once the paths that it refers to are known; `None` where it describes
    /// none: then it asks for nothing.
    fn realize(&self, path: PathId, instance: &Instance, known: &[Option<Known>]) -> Option<Known>;

    /// Whether a path took an action that could have had another outcome.
    fn picks_outcomes(&self, path: PathId, known: &Known) -> bool;

    /// What terms about any of its paths may need, where that depends on the path; by default, nothing does.
    fn features(&self) -> Features {
        Features::default()
    }

    /// For a system that was not enumerated, in bounded mode: a script that is unsatisfiable only if no state is a
    /// dead end.
    fn stuck(&self, _: PathId) -> Option<Script> {
        None
    }
}

/// The paths of one query. What cannot be told because too much can matter is an [`Error::TooLarge`].
pub trait Writing: Send {
    /// A path that the solver chooses to reach a goal.
    fn declare(&mut self, script: &mut Script, path: PathId, goal: &Goal) -> Result<PathIx, Error>;

    /// Demands that the declared paths of the leading block cost no more than the encoder's targets may; by default, there are
    /// none.
    fn afford(&mut self, _: &mut Script, _: &Env) -> Result<(), Error> {
        Ok(())
    }

    /// A path under a quantifier.
    fn bind(&mut self, terms: &mut Terms, path: PathId, goal: &Goal) -> Result<Bound, Error>;

    /// A path that the solver chooses for each choice of bound variables, by functions of these: the path, and the
    /// condition that it is one. By default it is bound by a quantifier instead.
    fn depend(&mut self, _: &mut Terms, _: PathId, _: &[Term]) -> Option<(PathIx, Term)> {
        None
    }

    /// A known path, as constants.
    fn fix(&mut self, terms: &mut Terms, path: PathId, known: &Known) -> Option<PathIx>;

    /// An instance of a path whose player has the goal: the path, and the condition that it is one.
    fn instantiate(
        &mut self,
        script: &mut Script,
        path: PathId,
        instance: &Instance,
        env: &Env,
        goal: &Goal,
    ) -> Result<(PathIx, Term), Error>;

    /// Demands of a declared path what the goal asks of it next to known ones: states from which it cannot be met
    /// are excluded at once. The solver would find out, but by search.
    fn restrict(&mut self, _: &mut Script, _: PathIx, _: &Goal, _: &[(PathId, Known)]) -> Result<(), Error> {
        Ok(())
    }

    /// Demands that no choice of a path, the last of all, reaches its player's goal, whatever it is; `env` has the
    /// paths before it. False, with nothing of use demanded, where that takes too much or states are not enumerated.
    fn sweep(&mut self, _: &mut Script, _: PathId, _: &Env, _: &Goal) -> Result<bool, Error> {
        Ok(false)
    }

    /// The symbols whose values describe a path.
    fn symbols(&self, path: PathIx) -> Vec<Term>;

    /// The path that a model describes; `None` if it is none, which a right model cannot cause.
    fn decode(&self, path: PathIx, model: &Model) -> Option<Known>;

    /// That a path starts in a state: all of these.
    fn starts(&self, terms: &mut Terms, path: PathIx, state: &State) -> Vec<Term>;

    /// Whether a step is made by this action.
    fn took(&self, path: PathIx, step: usize, action: ActionId) -> Term;

    /// Whether two paths of a system are in the same state.
    fn same_state(&self, terms: &mut Terms, p: PathIx, q: PathIx, time: u32) -> Term;

    /// A variable or label of a path's state.
    fn leaf(&mut self, terms: &mut Terms, path: PathIx, time: u32, leaf: Leaf) -> Val;

    /// Whether a path can take an action.
    fn enabled(&mut self, terms: &mut Terms, path: PathIx, time: u32, action: ActionId) -> Term;

    /// Whether whatever a path can do leads back to its state.
    fn halted(&mut self, terms: &mut Terms, path: PathIx, time: u32) -> Term;

    /// The value of a whole expression over one path's state, where there is a shorter way than through its parts; if
    /// it is an atom, with its number, as atoms are asked for again and again.
    fn whole(
        &mut self,
        _: &mut Terms,
        _: PathIx,
        _: u32,
        _: &Expr<PathLeaf>,
        _: Option<FormulaId>,
    ) -> Option<Val> {
        None
    }
}
