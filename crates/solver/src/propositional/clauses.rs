//! Clauses with quantifiers in front: DIMACS and QDIMACS.

use std::io::{self, Write};

use super::{Block, Body, Format, unsupported};
use crate::circuit::{Lit, Sink};
use crate::error::Error;

/// Clauses, of which none is empty: what can never be true is that the constant is not.
#[derive(Default)]
pub(super) struct Clauses {
    /// The literals, a 0 after each clause.
    numbers: Vec<i32>,
    count: usize,
    clause: Vec<Lit>,
}

impl Sink for Clauses {
    const QUANTIFIERS: bool = true;

    fn unsupported(what: &str) -> Error {
        unsupported(what)
    }

    fn clause(&mut self, literals: &[Lit]) {
        let clause = &mut self.clause;
        clause.clear();
        // The first clause says that the constant is true.
        if self.count > 0 && literals.contains(&Lit::TOP) {
            return;
        }
        clause.extend(literals.iter().filter(|&&literal| literal != !Lit::TOP));
        clause.sort_unstable_by_key(|literal| (literal.variable(), *literal));
        clause.dedup();
        if clause.windows(2).any(|pair| pair[0] == !pair[1]) {
            return;
        }
        if clause.is_empty() {
            clause.push(!Lit::TOP);
        }
        self.count += 1;
        self.numbers.extend(clause.iter().map(|literal| literal.number()));
        self.numbers.push(0);
    }

    fn size(&self) -> usize {
        self.count
    }
}

impl Clauses {
    pub(super) fn write(
        &self,
        w: &mut impl Write,
        variables: usize,
        blocks: &[Block],
        format: Format,
    ) -> io::Result<()> {
        writeln!(w, "p cnf {variables} {}", self.count)?;
        for block in blocks.iter().filter(|_| format == Format::Qdimacs) {
            w.write_all(if block.universal { b"a" } else { b"e" })?;
            for variable in &block.variables {
                write!(w, " {variable}")?;
            }
            w.write_all(b" 0\n")?;
        }
        for &number in &self.numbers {
            match number {
                0 => w.write_all(b"0\n")?,
                _ => write!(w, "{number} ")?,
            }
        }
        Ok(())
    }
}

impl From<Clauses> for Body {
    fn from(clauses: Clauses) -> Body {
        Body::Clauses(clauses)
    }
}
