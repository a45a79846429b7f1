//! The space of states of one system: which states there are, and which steps lead from one to the next.
//!
//! A system is read in two ways. A [`Graph`] lists the states that can be reached and the transitions between them,
//! made deterministic by letters; ranks say how many more steps a state allows. [`Commands`] are the ways to take a
//! step, with what each asks and does, for systems whose states are not listed. A path is a
//! [`hyperplan_problem::Trace`], or, through a graph, a [`Run`].
//!
//! There is no formula here, no path variable but as a label of a trace, no term and no solver. Nothing depends on how
//! states are going to be written.
//!
//! `eval` gives expressions their values, `row` what labels are in one state; `also` says what transitions do besides, `step` where updates lead; `graph` and
//! `command` read them, `explore` fills graphs, whose states `index` numbers, `run` and `inspect` read those.

mod also;
mod command;
mod cost;
mod eval;
mod explore;
mod graph;
mod index;
mod inspect;
mod row;
mod run;
mod step;
#[cfg(test)]
mod tests;

pub use also::{Updates, besides, no_number};
pub use command::{Command, Commands, Guard, Listed, MAX_COMMANDS, NewValue};
pub use cost::step_costs;
pub use eval::{bounds, code, decode, eval, holds_in, is_step, value_in};
pub use explore::Graphs;
pub use graph::{Graph, LIVE, Letter, StateIx, TooLarge, sources};
pub use inspect::{Findings, inspect};
pub use run::Run;
