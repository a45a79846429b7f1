//! Typed systems and objectives: what a problem file means, before anything is computed from it.

pub mod answer;
mod bounded;
pub mod display;
mod distinct;
mod edges;
mod expr;
mod formula;
mod ids;
pub mod lower;
mod names;
mod objective;
mod place;
pub mod prelude;
#[allow(clippy::module_inception)]
mod problem;
mod status;
mod strategy;
mod sums;
mod system;
mod target;

pub use bounded::{bounded, extended};
pub use distinct::{Difference, Distinction};
pub use edges::{Attribute, Edge, Edges};
pub use expr::{
    Comparison, Expr, Leaf, PathLeaf, Rational, State, StepLeaf, TransLeaf, TupleSet, Type, Value,
};
pub use formula::{Formula, Interval, Node, Written};
pub use ids::{ActionId, AttributeId, CostId, FormulaId, LabelId, PathId, SystemId, VarId};
pub use lower::{Loader, Lowered, NoFiles, Overrides, lower, read};
pub use objective::{Mode, Objective, PathVar, Quantifier, Semantics};
pub use place::Place;
pub use problem::Problem;
pub use status::KnownStatus;
pub use strategy::{Strategy, Trace};
pub use system::{Also, Clause, Cost, Label, LabelMemo, Map, System, Update, Var};
pub use target::Target;
