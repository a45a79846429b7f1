//! Prints symbols and sorts by their names.

use std::io;

use crate::term::{Op, Sort, Term};
use crate::terms::{Terms, View};

/// A symbol or bound variable of an arena, for printing.
pub(crate) struct SymbolName<'a> {
    terms: &'a Terms,
    symbol: Term,
}

impl<'a> SymbolName<'a> {
    pub(crate) fn new(terms: &'a Terms, symbol: Term) -> Self {
        SymbolName { terms, symbol }
    }

    #[inline]
    pub(crate) fn write(&self, w: &mut impl io::Write) -> io::Result<()> {
        let (stem, time) = match self.terms.view(self.symbol) {
            View::Symbol(stem, time) | View::Bound(stem, time) => (stem, time),
            _ => return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a symbol")),
        };
        let is_bound = self.terms.op(self.symbol) == Op::Bound;
        self.terms.mangled(stem).write_at(w, is_bound, time)
    }
}

/// A sort of an arena, for printing.
pub(crate) struct SortName<'a> {
    pub(crate) terms: &'a Terms,
    pub(crate) sort: Sort,
}

impl SortName<'_> {
    pub(crate) fn write(&self, w: &mut impl io::Write) -> io::Result<()> {
        match self.sort {
            Sort::Enum(enumeration) => self.terms.enumeration_name(enumeration).write(w),
            sort => write!(w, "{sort}"),
        }
    }
}

/// How a declared symbol is written, quotes included.
#[must_use]
pub fn symbol_text(terms: &Terms, symbol: Term) -> String {
    let mut text = Vec::new();
    // Writing to a vector cannot fail, and what is no symbol has no name.
    let _ = SymbolName::new(terms, symbol).write(&mut text);
    String::from_utf8_lossy(&text).into_owned()
}
