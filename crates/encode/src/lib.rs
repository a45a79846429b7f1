//! From objectives to queries, and from values back to paths.
//!
//! An [`Encoder`] knows one objective, and how its states are written: one by one (`enumerated`) or by variable
//! (`variables`). These are two implementations of one interface (`writing`), and which it is, is decided where the
//! encoder is built; nothing else can tell them apart. A [`Query`] is one script under construction: paths are declared
//! (chosen by the solver), bound (by a quantifier), known (constants) or instantiated (defined by inputs in terms of other
//! paths), and the formula is unrolled over them. What can matter of the leading block is found before
//! ([`Writer::relevant`]), and is what a query is made from.
//!
//! Invariants: nothing here prints or runs a solver; a path is known outside of its query as a
//! [`hyperplan_relevance::Known`] or an [`Instance`], whatever its states are written as: how that is, `enumerated` and
//! `variables` know alone. Encoders can be shared by threads, and queries sent between them.
//!
//! `value` (expressions), `names` and `unroll` (the formula) know no path; `writing` is the interface, `atom` reads the
//! formula's atoms through it, `enumerated` and `variables` implement it; `encoder` chooses, `query` is built on both.

mod atom;
mod encoder;
mod enumerated;
mod names;
mod paths;
mod query;
#[cfg(test)]
mod tests;
mod unroll;
mod value;
mod variables;
mod writing;

pub use encoder::{Among, Encoder};
pub use hyperplan_problem::answer::States;
pub use hyperplan_relevance::{
    Belief, Case, Error, Goal, Instance, Known, Limits, Narrowing, Pruning, Relevant, Stop,
};
pub use hyperplan_space::Graphs;
pub use names::Copies;
pub use paths::Paths;
pub use query::Query;
pub use writing::{Bound, Env, PathIx, Writer, Writing};
