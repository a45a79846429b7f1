//! SMT terms, scripts, and the SMT-LIB 2 writer and reader.
//!
//! [`Terms`] is a hash-consed arena of sort-checked terms, [`Script`] a list of assertions over
//! one, [`write_script`] prints a script as a benchmark of its own, and [`Printer`] feeds one to a
//! solver bit by bit. [`read_script`] reads one. [`check_model`] evaluates a script under a [`Model`]. Nothing here
//! recurses on the depth of terms, and shared terms are printed once.

mod apply;
mod eval;
mod features;
mod lexer;
mod name;
mod rational;
mod read;
mod request;
mod script;
mod term;
mod terms;
mod value;
mod write;

pub use eval::{Evaluation, ModelCheck, Verdict, check_model, check_partial_model};
pub use features::{Features, logic};
pub use lexer::{Context, Token, Tokens, parts, tokens};
pub use rational::Rational;
pub use read::{
    Benchmark, Definition, Origin, ReadError, is_large_number, read_definitions, read_script, read_value,
};
pub use request::Request;
pub use script::{Script, Section};
pub use term::{Enumeration, Function, Op, Sort, Stem, Term};
pub use terms::{Terms, View};
pub use value::{Interpretation, Model, Value};
pub use write::{
    Ask, Header, Printer, SortName, Status, SymbolName, WriteOptions, function_text, symbol_text, term_text,
    value_text, write_comment, write_header, write_script,
};
