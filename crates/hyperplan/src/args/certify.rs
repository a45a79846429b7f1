//! What `certify` takes.

use super::{Limit, Output, Reading, Selection};
use clap::Args;
use hyperplan::foreign::Foreign;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Certify {
    /// The problem file (.hp); `-` is standard input. Or a model of another tool (.smv)
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// The folder with the certificates that `solve --proof` made; before it further models and the formula (.hq), where
    /// FILE is a model
    #[arg(value_name = "DIR", required = true)]
    pub(crate) folder: Vec<PathBuf>,
    /// Also writes what was checked into this folder, for other checkers: clauses (.cnf), and refutations in LRAT form
    /// (.lrat) and for VeriPB (.pbp)
    #[arg(long, value_name = "DIR")]
    pub(crate) export: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) limit: Limit,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) selection: Selection,
    #[command(flatten)]
    pub(crate) output: Output,
    /// What is read instead, where the file is one of another tool.
    #[arg(skip)]
    pub(crate) foreign: Option<Foreign>,
}
