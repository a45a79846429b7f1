//! The search for a strategy: what is encoded, what is asked of a solver, and what is made of the answers.
//!
//! [`solve`] decides an objective: quantifiers are handed to the solver, expanded into finitely many cases, or
//! decided by counterexamples; a strategy is verified by `hyperplan-verify`, which shares nothing with the encoding,
//! before it is returned. [`minimize()`] finds the least value of a constant with which it can be had, [`cheapest()`] the
//! strategy that costs least. [`straightened()`] takes detours out of one, [`several()`] finds others that differ. [`mod@explain`] says why there is none. [`case()`] is
//! one of several cases of an objective, for searches side by side. [`emit`] gives the query as a benchmark instead. [`lint`] and
//! [`lint_systems`] look for what is probably not meant.

mod cegis;
mod cheapest;
mod choice;
mod config;
mod confirm;
mod cubes;
mod decide;
mod detour;
mod direct;
mod emit;
mod evidence;
pub mod explain;
mod fact;
mod lasting;
mod lint;
mod minimize;
mod oracle;
mod prepare;
mod prove;
mod race;
mod search;
mod several;
mod solve;
mod watch;

pub use cheapest::{Cheapest, Value, cheapest};
pub use config::{Config, Outcome, Quantifiers, Seconds, States, Verdict, Verified};
pub use cubes::case;
pub use detour::{Rest, Straight, straightened, time_for};
pub use emit::{EmitConfig, Emitted, Status, Track, emit, strategy_of_model};
pub use evidence::Evidence;
pub use fact::{Because, Error, Fallen, Fault, Note, Reason, Unsupported, Worth, Wrong};
pub use hyperplan_encode::{Error as EncodeError, Limits, Paths, Pruning};
pub use lint::{Budget, Lints, Uninspected, lint, lint_systems};
pub use minimize::{Least, MinimizeError, Narrowed, ProblemOf, SHARE, narrowed};
pub use prove::{Proved, Unproved, prove};
pub use several::{Another, More, Several, Wanted, several};
pub use solve::{minimize, solve};
pub use watch::{Stage, Standing, Watch};
