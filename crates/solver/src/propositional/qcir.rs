//! Gates with quantifiers in front: QCIR-14, prenex and cleansed, so that there are numbers instead of names, and no gates but
//! `and` and `or`.

use std::io::{self, Write};

use super::{Block, Body, unsupported};
use crate::circuit::{Gate, Lit, Sink};
use crate::error::Error;

/// Gates by the variable that stands for each.
#[derive(Default)]
pub(super) struct Net {
    gates: Vec<Option<Defined>>,
    /// The inputs of conjunctions.
    inputs: Vec<Lit>,
    /// Disjunctions that are true.
    clauses: Vec<Vec<Lit>>,
    count: usize,
}

/// What a variable stands for, or where it is negated the opposite of that.
#[derive(Clone, Copy)]
struct Defined {
    negated: bool,
    gate: Kept,
}

/// A [`Gate`] whose inputs are kept.
#[derive(Clone, Copy)]
enum Kept {
    And { start: usize, end: usize },
    Iff(Lit, Lit),
    Mux(Lit, Lit, Lit),
    Majority(Lit, Lit, Lit),
}

impl Sink for Net {
    const QUANTIFIERS: bool = true;

    fn unsupported(what: &str) -> Error {
        unsupported(what)
    }

    fn clause(&mut self, literals: &[Lit]) {
        if !literals.contains(&Lit::TOP) {
            self.clauses.push(literals.iter().copied().filter(|&literal| literal != !Lit::TOP).collect());
        }
    }

    fn size(&self) -> usize {
        self.count + self.clauses.len()
    }

    fn define(&mut self, g: Lit, gate: Gate<'_>, _: u8) {
        let at = g.variable() as usize;
        self.gates.resize(self.gates.len().max(at + 1), None);
        // Both directions may come one after the other.
        if self.gates[at].is_some() {
            return;
        }
        self.count += 1;
        let gate = match gate {
            Gate::And(inputs) => {
                let start = self.inputs.len();
                self.inputs.extend_from_slice(inputs);
                Kept::And { start, end: self.inputs.len() }
            }
            Gate::Iff(a, b) => Kept::Iff(a, b),
            Gate::Mux(c, a, b) => Kept::Mux(c, a, b),
            Gate::Majority(a, b, c) => Kept::Majority(a, b, c),
        };
        self.gates[at] = Some(Defined { negated: g.number() < 0, gate });
    }
}

impl Net {
    fn defined(&self, variable: usize) -> Option<Defined> {
        // The constant is the conjunction of nothing.
        let top = Defined { negated: false, gate: Kept::And { start: 0, end: 0 } };
        if variable == Lit::TOP.variable() as usize { Some(top) } else { *self.gates.get(variable)? }
    }

    fn inputs(&self, gate: Kept) -> Vec<Lit> {
        match gate {
            Kept::And { start, end } => self.inputs[start..end].to_vec(),
            Kept::Iff(a, b) => vec![a, b],
            Kept::Mux(a, b, c) | Kept::Majority(a, b, c) => vec![a, b, c],
        }
    }

    /// The gates that the whole rests on, inputs first.
    fn order(&self) -> Vec<usize> {
        let mut seen = vec![false; self.gates.len().max(2)];
        let (mut order, mut stack) = (Vec::new(), Vec::new());
        let visit = |literal: Lit, seen: &mut Vec<bool>, stack: &mut Vec<(usize, bool)>| {
            let variable = literal.variable() as usize;
            if self.defined(variable).is_some() && !seen[variable] {
                stack.push((variable, false));
            }
        };
        let roots = if self.is_constant() { &[][..] } else { &self.clauses };
        for &root in roots.iter().flatten() {
            visit(root, &mut seen, &mut stack);
            while let Some((variable, inputs_are_done)) = stack.pop() {
                if inputs_are_done {
                    order.push(variable);
                } else if !std::mem::replace(&mut seen[variable], true) {
                    stack.push((variable, true));
                    let gate = self.defined(variable).map(|defined| self.inputs(defined.gate));
                    gate.iter().flatten().for_each(|&input| visit(input, &mut seen, &mut stack));
                }
            }
        }
        order
    }

    /// Whether it is true, or false, whatever is chosen.
    fn is_constant(&self) -> bool {
        self.clauses.is_empty() || self.clauses.iter().any(Vec::is_empty)
    }

    /// Writes it; lines that need a number of their own go on after so many variables.
    pub(super) fn write(
        &self,
        w: &mut impl Write,
        about: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        variables: usize,
        blocks: &[Block],
    ) -> io::Result<()> {
        let order = self.order();
        let mut last = variables as i32;
        let mut lines = Vec::new();
        for &variable in &order {
            self.lines(variable, &mut last, &mut lines);
        }
        let output = self.whole(&mut last, &mut lines);
        writeln!(w, "#QCIR-G14 {last}")?;
        about(w)?;
        for block in blocks {
            let variables: Vec<String> = block.variables.iter().map(u32::to_string).collect();
            let quantifier = if block.universal { "forall" } else { "exists" };
            writeln!(w, "{quantifier}({})", variables.join(", "))?;
        }
        writeln!(w, "output({output})")?;
        for line in lines {
            let inputs: Vec<String> = line.inputs.iter().map(i32::to_string).collect();
            let gate = if line.is_and { "and" } else { "or" };
            writeln!(w, "{} = {gate}({})", line.variable, inputs.join(", "))?;
        }
        Ok(())
    }

    /// The lines of one gate; the last of them is it.
    fn lines(&self, variable: usize, last: &mut i32, lines: &mut Vec<Line>) {
        let Some(Defined { negated, gate }) = self.defined(variable) else { return };
        let mut line = |is_and: bool, inputs: &[i32]| {
            *last += 1;
            lines.push(Line { variable: *last, is_and, inputs: inputs.to_vec() });
            *last
        };
        let (is_and, inputs) = match gate {
            Kept::And { start, end } => {
                (true, self.inputs[start..end].iter().map(|input| input.number()).collect())
            }
            Kept::Iff(a, b) => {
                let (a, b) = (a.number(), b.number());
                (false, vec![line(true, &[a, b]), line(true, &[-a, -b])])
            }
            Kept::Mux(c, a, b) => {
                let (a, b, c) = (a.number(), b.number(), c.number());
                (false, vec![line(true, &[c, a]), line(true, &[-c, b])])
            }
            Kept::Majority(a, b, c) => {
                let (a, b, c) = (a.number(), b.number(), c.number());
                let some = line(false, &[a, b]);
                (false, vec![line(true, &[a, b]), line(true, &[c, some])])
            }
        };
        let sign = if negated { -1 } else { 1 };
        let inputs = inputs.into_iter().map(|input| sign * input).collect();
        lines.push(Line { variable: variable as i32, is_and: is_and != negated, inputs });
    }

    /// The lines of the whole, a conjunction of disjunctions; it is the last of them, since readers want a gate.
    fn whole(&self, last: &mut i32, lines: &mut Vec<Line>) -> i32 {
        let mut line = |is_and: bool, inputs: Vec<i32>| {
            *last += 1;
            lines.push(Line { variable: *last, is_and, inputs });
            *last
        };
        if self.is_constant() {
            return line(self.clauses.is_empty(), Vec::new());
        }
        let mut conjuncts = Vec::with_capacity(self.clauses.len());
        for clause in &self.clauses {
            conjuncts.push(match clause[..] {
                [only] => only.number(),
                _ => line(false, clause.iter().map(|literal| literal.number()).collect()),
            });
        }
        line(true, conjuncts)
    }
}

/// A line that says what a gate is.
struct Line {
    variable: i32,
    is_and: bool,
    inputs: Vec<i32>,
}

impl From<Net> for Body {
    fn from(net: Net) -> Body {
        Body::Net(net)
    }
}
