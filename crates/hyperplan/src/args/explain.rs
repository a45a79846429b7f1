//! What `explain` takes.

use super::{Limit, Output, Plan, Problem, Reading, Selection};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Explain {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) limit: Limit,
    #[command(flatten)]
    pub(crate) plan: Plan,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// Who is asked, as in `solve`
    #[arg(long, value_name = "SOLVER", default_value = "builtin")]
    pub(crate) solver: String,
    /// Writes certificates into this folder, for `hyperplan certify`: that there is no strategy, that the parts shown exclude
    /// each other, that so much more time does not help
    #[arg(long, value_name = "DIR", conflicts_with_all = ["strategy", "actions"])]
    pub(crate) proof: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    #[command(flatten)]
    pub(crate) output: Output,
}
