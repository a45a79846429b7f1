//! What `explain` takes.

use super::{Limit, Output, Plan, Problem, Reading, Selection};
use clap::Args;

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
    #[command(flatten)]
    pub(crate) selection: Selection,
    #[command(flatten)]
    pub(crate) output: Output,
}
