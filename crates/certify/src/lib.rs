//! Certificates that an objective has no strategy (or no counterexample), and their checker.
//!
//! A certificate is a set of *instances*, what the other player answers, and a refutation of the clauses that the [`Encoder`] makes of
//! the problem and these. [`Certificate::check`] makes the clauses anew and checks each step of the refutation ([`Checker`]). It shares
//! nothing with the search but the typed problem; why it can be believed stands at the head of `encode.rs`. How certificates are found
//! is `hyperplan-plan`'s; `docs/proofs.md` takes one apart.

mod certificate;
mod cost;
mod encode;
mod error;
mod instance;
mod layer;
mod lrat;
mod other;
mod reading;
mod system;

pub use certificate::{
    Apart, Benchmark, Certificate, Checked, Claim, Parts, check, compress, dimacs, refutation,
};
pub use cost::{Bound, with_bounds};
pub use encode::{Encoder, Place};
pub use error::Error;
pub use instance::{Action, Branch, Instance, Start, Step};
pub use lrat::Checker;
pub use other::pseudo_boolean;
