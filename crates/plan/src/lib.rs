//! The search for a strategy: what is encoded, what is asked of a solver, and what is made of the answers.
//!
//! [`solve`] decides an objective: quantifiers are handed to the solver, expanded into finitely many cases, or
//! decided by counterexamples; a strategy is verified by `hyperplan-verify`, which shares nothing with the encoding,
//! before it is returned. [`minimize()`] finds the least value of a constant with which it can be had. [`emit`] gives the
//! query as a benchmark instead. [`lint`] and [`lint_systems`] look for what is probably not meant.

mod cegis;
mod config;
mod cross_check;
mod direct;
mod emit;
mod evidence;
mod lasting;
mod lint;
mod minimize;
mod oracle;
mod prepare;
mod race;
mod solve;

pub use config::{Config, Error, Outcome, Quantifiers, Seconds, Verdict, Verified};
pub use emit::{EmitConfig, Emitted, Status, Track, emit, strategy_of_model};
pub use hyperplan_encode::{Limits, States};
pub use lint::{Budget, Lints, lint, lint_systems};
pub use minimize::{Family, Least, MinimizeError, minimize};
pub use solve::solve;
