//! What may be typed about files of other tools.

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use hyperplan_import::{Dialect, Known};
use std::path::PathBuf;

/// Files of other tools.
#[derive(Clone, Debug, Args)]
#[group(skip)]
pub(crate) struct Others {
    /// Where FILE is a model of another tool: models of further quantifiers, and the formula
    #[arg(value_name = "MORE")]
    pub(crate) more: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

/// How formulas of other tools are read.
#[derive(Clone, Debug, Default, PartialEq, Args)]
#[group(skip)]
pub(crate) struct Reading {
    /// The number of steps of each path, for formulas of other tools: read `within K`
    #[arg(long, value_name = "K")]
    pub(crate) bound: Option<u32>,
    /// How formulas of other tools are read beyond K: `pes`, `opt`, `hpes` or `hopt`; without it, as on finite traces
    #[arg(long, value_name = "S", requires = "bound")]
    pub(crate) semantics: Option<String>,
    /// The language of these formulas, which matters where operators stand beside each other without parentheses; without
    /// it, that whose signs they have
    #[arg(long, value_parser = dialects(), value_name = "NAME")]
    pub(crate) dialect: Option<Dialect>,
}

/// The languages of formulas.
fn dialects() -> impl TypedValueParser<Value = Dialect> {
    let named = |name: String| Dialect::ALL.into_iter().find(|dialect| dialect.name() == name);
    PossibleValuesParser::new(Dialect::ALL.map(Dialect::name))
        .try_map(move |name| named(name).ok_or("it is none of them"))
}

/// What is known of a formula.
pub(crate) fn known() -> impl TypedValueParser<Value = Known> {
    PossibleValuesParser::new(["realizable", "unrealizable", "holds", "violated"])
        .try_map(|word| Known::of_word(&word).ok_or("it is none of them"))
}
