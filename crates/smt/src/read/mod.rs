//! The SMT-LIB 2 reader: from text to a [`Script`], as far as [`Terms`](crate::Terms) can express it.
//!
//! The text is read once, token by token. Terms are built as they end, on a stack of what has begun, so that nothing
//! recurses; sharing (`let`, `define-fun`, `:named`) becomes that of the arena. What cannot be expressed is refused.

mod arith;
mod bits;
mod commands;
mod expand;
mod names;
mod operators;
mod sorts;
mod terms;
mod value;

use crate::script::Script;
use crate::term::Term;

pub use value::read_value;

/// A benchmark that was read: what it declares, and what it asserts before its check.
///
/// Its symbols are called as in the text, without a time. Where these look like names of the writer's own (`$1`), it
/// should not be written again.
pub struct Benchmark {
    /// The assertions. Those that are true whatever the symbols are have been dropped.
    pub script: Script,
    /// The declared symbols, in order.
    pub symbols: Vec<Term>,
    /// Where each assertion of the script comes from.
    pub origins: Vec<Origin>,
    /// How many assertions there are in the text.
    pub assertions: usize,
}

/// Where an assertion comes from.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub struct Origin {
    /// Which of the text's assertions it is, from 1.
    pub number: usize,
    /// The line on which it begins, from 1.
    pub line: usize,
}

/// Why a text cannot be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
pub enum ReadError {
    /// It is no SMT-LIB 2, or its sorts do not fit.
    #[error("{line}:{column}: {what}")]
    Syntax {
        /// What is wrong.
        what: String,
        /// The line, from 1.
        line: usize,
        /// The column, in characters from 1.
        column: usize,
    },
    /// There is something in it that terms cannot express here, or that is not known.
    #[error("{line}:{column}: {what} is not supported")]
    Unsupported {
        /// What is not supported.
        what: String,
        /// The line, from 1.
        line: usize,
        /// The column, in characters from 1.
        column: usize,
    },
}

/// Reads a benchmark with at most one `check-sat`, after which nothing is declared or asserted.
///
/// Numerals stand for reals where a real is needed. `push`, `pop`, functions and sorts that are not interpreted, and
/// products and quotients of variables are not supported.
///
/// # Errors
/// [`ReadError`], at the first place that cannot be read.
pub fn read_script(text: &str) -> Result<Benchmark, ReadError> {
    commands::Reader::new(text).read().map_err(|trouble| trouble.placed(text))
}

/// A [`ReadError`] whose place is not counted out yet.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Trouble {
    at: usize,
    what: String,
    unsupported: bool,
}

impl Trouble {
    fn syntax(at: usize, what: impl Into<String>) -> Trouble {
        Trouble { at, what: what.into(), unsupported: false }
    }

    fn unsupported(at: usize, what: impl Into<String>) -> Trouble {
        Trouble { at, what: what.into(), unsupported: true }
    }

    fn placed(self, text: &str) -> ReadError {
        let before = &text[..self.at];
        let line = 1 + newlines(before);
        let column = 1 + before.chars().rev().take_while(|c| *c != '\n').count();
        let what = self.what;
        match self.unsupported {
            true => ReadError::Unsupported { what, line, column },
            false => ReadError::Syntax { what, line, column },
        }
    }
}

fn newlines(text: &str) -> usize {
    text.bytes().filter(|byte| *byte == b'\n').count()
}

/// The beginning of what was written, for messages.
fn shown(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests;
