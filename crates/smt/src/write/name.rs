//! Prints symbols and sorts by their names.

use std::io;

use crate::term::{Function, Op, Sort, Term};
use crate::terms::{Terms, View};

/// A symbol or bound variable of an arena, for printing: with rsmt2 a symbol, and an expression too.
pub struct SymbolName<'a> {
    terms: &'a Terms,
    symbol: Term,
}

impl<'a> SymbolName<'a> {
    /// The name of a symbol; what is none cannot be written.
    #[must_use]
    pub fn new(terms: &'a Terms, symbol: Term) -> Self {
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

/// A function of an arena, for printing: with rsmt2 a symbol.
pub(crate) struct FunctionName<'a> {
    pub(crate) terms: &'a Terms,
    pub(crate) function: Function,
}

impl FunctionName<'_> {
    pub(crate) fn write(&self, w: &mut impl io::Write) -> io::Result<()> {
        self.terms.mangled(self.terms.function_stem(self.function)).write(w)
    }
}

/// A sort of an arena, for printing: with rsmt2 a sort.
pub struct SortName<'a> {
    terms: &'a Terms,
    sort: Sort,
}

impl<'a> SortName<'a> {
    /// A sort by its name.
    #[must_use]
    pub fn new(terms: &'a Terms, sort: Sort) -> Self {
        SortName { terms, sort }
    }

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

/// How a declared function is written, quotes included.
#[must_use]
pub fn function_text(terms: &Terms, function: Function) -> String {
    let mut text = Vec::new();
    // Writing to a vector cannot fail.
    let _ = FunctionName { terms, function }.write(&mut text);
    String::from_utf8_lossy(&text).into_owned()
}
