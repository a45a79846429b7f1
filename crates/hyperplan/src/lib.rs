//! Plans robot motion from hyperproperties: problems in code or from text, solved, checked, explained and drawn.
//!
//! ```
//! use hyperplan::{Options, Problem, Verdict};
//!
//! let problem = Problem::from_text(
//!     "system Line {
//!        state x: 0..3;
//!        action left, right;
//!        on left  { x' = x - 1; }
//!        on right { x' = x + 1; }
//!        init x == 0;
//!      }
//!      objective end { exists p. F[0,3] x[p] == 3 }",
//! )?;
//! let outcome = problem.objective("end")?.solve(&Options::new())?;
//! assert_eq!(outcome.verdict(), Verdict::Realizable);
//! assert_eq!(outcome.path("p").map(|path| path.actions.join(" ")).as_deref(), Some("right right right"));
//! # Ok::<(), hyperplan::Error>(())
//! ```
//!
//! [`Problem`] reads files, texts and files of other tools; [`Problem::builder`] builds one in code, of variables, a [`Graph`] or
//! a [`Grid`]. [`Objective`] is what things are done with: [`Objective::solve`], [`Objective::verify`],
//! [`Objective::minimize`] and so on. [`Options`] says with which solvers, for how long, what [`Cancel`]s, and who is told how
//! far it is. Nothing is printed, there is no global state but a process that ends solvers when this one is killed, and
//! all of it is `Send` and runs in a thread of 2 MiB.
//!
//! The language in which systems and objectives are written is described in `docs/language.md`, this library for its users
//! in `docs/library.md`. The command is a feature, `cli`, which is on unless it is switched off.

mod build;
#[doc(hidden)]
pub mod disk;
pub mod draw;
mod error;
#[doc(hidden)]
pub mod foreign;
#[doc(hidden)]
pub mod horizon;
mod options;
#[doc(hidden)]
pub mod others;
mod outcome;
mod problem;
#[doc(hidden)]
pub mod search;
mod source;

pub use build::{Builder, Cell, Graph, Grid, System};
pub use error::{Error, Faults};
pub use options::{Cancel, Options, Progress, Solvers};
pub use outcome::{Outcome, Verification};
pub use problem::{Minimized, Objective, Problem};

pub use horizon::{HorizonPart, PathHorizon};
pub use hyperplan_horizon::Horizon;
pub use hyperplan_import::{Dialect, Options as Reading};
pub use hyperplan_plan::explain;
pub use hyperplan_plan::{
    EmitConfig, Emitted, Paths, Quantifiers, Stage, Standing, States, Status, Track, Verdict,
};
pub use hyperplan_problem::answer;
pub use hyperplan_solver::Spec;

/// Systems, objectives and strategies as they are typed.
pub use hyperplan_problem as typed;
/// Terms and scripts of SMT-LIB, which print themselves, through the traits of rsmt2 too.
pub use hyperplan_smt as smt;
