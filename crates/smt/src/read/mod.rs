//! The SMT-LIB 2 reader: from text to a [`Script`], as far as [`Terms`](crate::Terms) can express it.
//!
//! The text is read once, token by token. Terms are built as they end, on a stack of what has begun, so that nothing
//! recurses; sharing (`let`, `define-fun`, `:named`) becomes that of the arena. What cannot be expressed is refused.

mod arith;
mod bits;
mod commands;
mod definition;
mod expand;
mod names;
mod operators;
mod sorts;
mod terms;
mod value;

use rustc_hash::FxHashMap;

use crate::lexer::{Tokens, tokens};
use crate::script::Script;
use crate::term::{Function, Sort, Term};
use crate::terms::Terms;
use expand::Macro;
use names::Names;

pub use definition::{Definition, read_definitions};
pub use value::{is_large_number, read_value};

/// A benchmark that was read: what it declares, and what it asserts before its check.
///
/// Its symbols are called as in the text, without a time. Where these look like names of the writer's own (`$1`), it
/// should not be written again.
pub struct Benchmark {
    /// The assertions. Those that are true whatever the symbols are have been dropped.
    pub script: Script,
    /// The declared symbols, in order.
    pub symbols: Vec<Term>,
    /// The declared functions with arguments, in order.
    pub functions: Vec<Function>,
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
/// Numerals stand for reals where a real is needed. `push`, `pop`, sorts that are not interpreted, and products and
/// quotients of variables are not supported.
///
/// # Errors
/// [`ReadError`], at the first place that cannot be read.
pub fn read_script(text: &str) -> Result<Benchmark, ReadError> {
    Reader::new(text).read().map_err(|trouble| trouble.placed(text))
}

/// How many terms there may be beyond one for each byte of the text: what macros expand to can be exponential.
const EXPANSION: usize = 1 << 23;

/// What has been read so far.
struct Reader<'t> {
    tokens: Tokens<'t>,
    names: Names<'t>,
    sorts: FxHashMap<&'t str, Sort>,
    macros: Vec<Macro>,
    script: Script,
    symbols: Vec<Term>,
    functions: Vec<Function>,
    origins: Vec<Origin>,
    assertions: usize,
    /// Whether the check has come.
    checked: bool,
    /// How many variables were bound.
    variables: u32,
    /// How much of the bodies of macros was looked at.
    expanded: usize,
    /// A place and its line.
    line: (usize, usize),
}

impl<'t> Reader<'t> {
    fn new(text: &'t str) -> Self {
        let sorts = [("Bool", Sort::Bool), ("Int", Sort::Int), ("Real", Sort::Real)];
        Reader {
            tokens: tokens(text),
            names: Names::default(),
            sorts: sorts.into_iter().collect(),
            macros: Vec::new(),
            script: Script::new(),
            symbols: Vec::new(),
            functions: Vec::new(),
            origins: Vec::new(),
            assertions: 0,
            checked: false,
            variables: 0,
            expanded: 0,
            line: (0, 1),
        }
    }

    fn terms(&mut self) -> &mut Terms {
        &mut self.script.terms
    }

    fn sort_of(&self, t: Term) -> Sort {
        self.script.terms.sort(t)
    }

    /// That there is room for so many more terms.
    fn check_room(&self, at: usize, more: usize) -> Result<(), Trouble> {
        let limit = self.tokens.text().len() + EXPANSION;
        if self.script.terms.len() + more > limit || self.expanded > limit {
            return Err(Trouble::unsupported(at, format!("what expands to more than {limit} terms")));
        }
        Ok(())
    }
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
