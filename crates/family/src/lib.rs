//! Families of random planning problems: which maps and objectives there are, what the problems say, where their
//! benchmarks go, and what is written down of them.
//!
//! A [`Family`] is sizes, densities, seeds, objectives and horizons. Each of its [`Case`]s is an objective on a random
//! [`Map`]; with the least horizon of a case known, each [`Horizon`] gives an instance. [`Layout`] says where its
//! benchmark goes, a [`Record`] what became of it, and [`Manifest`] lists all. [`select`] chooses some of them by how
//! hard solvers found them. Nothing here reads or writes a file, asks
//! a solver, or depends on time or machine: the same parameters give the same text.

mod family;
mod layout;
mod locks;
mod manifest;
mod map;
mod objective;
mod parameters;
mod random;
mod record;
mod roads;
pub mod select;
mod selected;
mod walls;

pub use family::{Case, Family, Horizon};
pub use layout::{Layout, NameError};
pub use manifest::Manifest;
pub use map::{MAX_DENSITY, Map, MapError, SIZES};
pub use objective::Objective;
pub use parameters::{Cell, Kind, Parameters};
pub use record::{About, Dropped, Entry, Head, Log, LogError, Record, body_of, sha256};
pub use selected::Selected;
