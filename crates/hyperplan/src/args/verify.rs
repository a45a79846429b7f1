//! What `verify` takes.

use super::{Limit, Output, Plan, Problem, Reading, Selection};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Verify {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) limit: Limit,
    #[command(flatten)]
    pub(crate) plan: Plan,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// What a solver printed for a query that `emit` wrote: its model, by (get-model) or (get-value (...));
    /// `-` is standard input
    #[arg(long, value_name = "FILE", conflicts_with = "actions")]
    pub(crate) model: Option<PathBuf>,
    /// Saves the strategy that the model describes, as JSON
    #[arg(long, value_name = "FILE.json", requires = "model")]
    pub(crate) save: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) selection: Selection,
    #[command(flatten)]
    pub(crate) output: Output,
}
