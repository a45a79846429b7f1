//! Typed systems and objectives: what a problem file means, before anything is computed from it.

pub mod answer;
pub mod display;
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
mod system;

pub use edges::{Attribute, Edge, Edges};
pub use expr::{Comparison, Expr, Leaf, PathLeaf, Rational, State, StepLeaf, TupleSet, Type, Value};
pub use formula::{Formula, Interval, Node, Written};
pub use ids::{ActionId, AttributeId, FormulaId, LabelId, PathId, SystemId, VarId};
pub use lower::{Loader, Lowered, NoFiles, Overrides, lower, read};
pub use objective::{Mode, Objective, PathVar, Quantifier, Semantics};
pub use place::Place;
pub use problem::Problem;
pub use status::KnownStatus;
pub use strategy::{Strategy, Trace};
pub use system::{Also, Clause, Label, LabelMemo, Map, System, Update, Var};
