//! The independent checker of strategies: an explicit-state search that shares nothing with the encoder.
//!
//! # What is decided
//!
//! An objective is a prefix of quantified path variables and a formula. A *strategy* fixes one trace for each path
//! variable of the leading block; [`check`] says whether the rest of the objective then comes out as claimed: true
//! where the leading block is `exists`, false where it is `forall` (a counterexample). [`decide`] fixes nothing.
//!
//! A *path* of a system starts in a state where `init` holds and follows transitions.
//! - [`Mode::Bounded`]: paths are infinite. A finite prefix stands for its continuations, so it counts only if its
//!   last state is *live*: in the greatest set of states each of which has a transition into the set.
//! - [`Mode::Within`]`(K)`: paths have exactly K steps, whatever may follow. A prefix of t steps counts only if its
//!   last state has a path of K - t more steps. Positions are 0 to K; operators read that finite trace:
//!   X, F, U are strong (they demand a position that exists), N, G, W, R are weak.
//!
//! In a system with infinitely many states it cannot be told which of them are live: without `within`, a path has
//! exactly as many steps there as the formula can read of it. Such systems are explored like others, as far as finitely
//! many states are met; where not (starts without bounds, any real number between two), the check is too large.
//!
//! `phi U[a,b] psi` holds at i if psi holds at some position j of i+a..=i+b and phi at all of i..j; `R[a,b]` is its
//! dual; `F`, `G` are `true U` and `false R`; `phi W[a,b] psi` is `(phi U[a,b] psi) | G[0,b] phi`.
//!
//! # Residuals
//!
//! Reading one position of all paths turns a formula into its *residual*: what the rest of the paths must satisfy
//! from the next position on. `phi U[0,b] psi` becomes `psi' | (phi' & phi U[0,b-1] psi)`, where primes mark the
//! residuals of the operands; with a > 0 it is `phi' & phi U[a-1,b-1] psi`; R is dual. Residuals are hash-consed and
//! normalized, and constant after as many steps as the formula can look ahead.
//!
//! # The lattice of values
//!
//! The path variables that are not fixed form blocks 1 to m of one quantifier each. After t steps of the paths of
//! all blocks before i, a *value* of level i describes the truth of the remaining objective as a function of how
//! those paths go on:
//! - level m + 1: a residual;
//! - level i: a set of pairs (joint state of block i, value of level i + 1), one for each prefix of t steps of the
//!   paths of block i; it is read as the disjunction over the pairs where the block is `exists`, the conjunction
//!   where it is `forall`, over all ways to go on.
//!
//! A step moves every pair by every joint move of its block and the inner value along with it. Because the pairs of
//! a level are carried as a set *inside* each prefix of the outer paths, an inner path may depend on the whole of an
//! outer one, its future included; choosing step by step would be a game, and too strong.
//!
//! Only pairs whose states can go on (live, or with enough steps left) are kept. Hence values may be decided early:
//! in an `exists` set a true pair makes the set true and false pairs are dropped, the empty set is false; dually for
//! `forall`. A third constant, *missing*, stands for what a trace that has ended would have said (Kleene's unknown).
//!
//! The first free block is a plain breadth-first search over (joint state, value). The sets of each step are kept,
//! most of them at a bit for each joint state; a decisive pair gives back the paths that lead to it by looking for
//! some predecessor in the step before, and so on back to the start.

#[macro_use]
mod id;

mod atoms;
mod check;
mod cost;
mod domain;
mod eval;
mod follow;
mod graph;
mod history;
mod horizon;
mod index;
mod initial;
mod joint;
mod layer;
mod level;
mod outcomes;
mod parts;
mod progress;
mod recent;
mod report;
mod residual;
mod run;
mod scene;
mod search;
mod spread;
mod step;
#[cfg(test)]
mod tests;
mod valuation;
mod value;
mod worst;

pub use check::{check, decide, settled, settled_for_others};
pub use cost::cost;
pub use follow::{Open, complete};
pub use outcomes::holds_for_all_outcomes;
pub use parts::{holds_at, progress_of};
pub use report::{Budget, Check, Defeat, Error, Reached};
pub use worst::{Beginning, starts, worst};

#[cfg(doc)]
use hyperplan_problem::Mode;
