//! rsmt2's printing traits on our symbols, sorts and terms: the only place that knows of rsmt2.
//!
//! The traits are what it does well. They make of a symbol, a sort and an expression three things that write themselves
//! anywhere, and keep apart what a declaration, a definition and an assertion may be given; the printer says which of
//! them comes where, and beneath them everything is written token by token, since a script has millions. Its parser is
//! not used: it counts bytes where it means characters, and panics where a parenthesis is too many, so that
//! [`tokens`](crate::tokens) and [`read_value`](crate::read_value) read what solvers say. Its solvers are not used
//! either: they have no deadline, and block for ever where a solver answers while it is written to.

use std::io;

use rsmt2::SmtRes;
use rsmt2::errors::{Error, ErrorKind};
use rsmt2::print::{Expr2Smt, Sort2Smt, Sym2Smt};

use super::expression::{Expression, SharedName};
use super::name::{FunctionName, SortName, SymbolName};

impl Sym2Smt for SymbolName<'_> {
    fn sym_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

impl Expr2Smt for SymbolName<'_> {
    fn expr_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

impl Sym2Smt for FunctionName<'_> {
    fn sym_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

impl Sym2Smt for SharedName {
    fn sym_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

impl Sort2Smt for SortName<'_> {
    fn sort_to_smt2<W: io::Write>(&self, w: &mut W) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

impl Expr2Smt for Expression<'_> {
    fn expr_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        Ok(self.write(w)?)
    }
}

/// Writes a symbol.
pub(super) fn symbol(w: &mut impl io::Write, symbol: &impl Sym2Smt) -> io::Result<()> {
    symbol.sym_to_smt2(w, ()).map_err(io_error)
}

/// Writes a sort.
pub(super) fn sort(w: &mut impl io::Write, sort: &impl Sort2Smt) -> io::Result<()> {
    sort.sort_to_smt2(w).map_err(io_error)
}

/// Writes a term.
pub(super) fn expression(w: &mut impl io::Write, expression: &impl Expr2Smt) -> io::Result<()> {
    expression.expr_to_smt2(w, ()).map_err(io_error)
}

/// The input-output error in an error of rsmt2.
fn io_error(error: Error) -> io::Error {
    match error.0 {
        ErrorKind::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
