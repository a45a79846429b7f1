//! Prints the assertions of a growing script: declarations, definitions of shared terms, assertions.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io;

use super::expression::{Expression, Mark, Scratch, SharedName};
use super::free::Free;
use super::name::{FunctionName, SortName, SymbolName};
use super::node_set::NodeSet;
use super::rsmt2;
use crate::features::Features;
use crate::term::{Enumeration, Function, Op, Sort, Term};
use crate::terms::{Terms, View};

/// Terms deeper than this are cut by definitions: solvers' own parsers may recurse.
const HEIGHT: u8 = 100;

/// Remembers what of an arena has been declared and defined, so that a script can be printed bit by
/// bit. Feed what is new to [`Printer::scan`], then [`Printer::declare`], then print each assertion.
///
/// Which terms are shared has to be known before the first is printed, so there are a few bytes for each node (some
/// more where there are quantifiers), however often it is printed. Beyond these nothing grows with the text but a stack,
/// with the depth to which terms are printed in one piece.
#[derive(Default)]
pub struct Printer {
    /// Per node.
    marks: Vec<Mark>,
    /// Nodes that were met but not looked at yet: empty but while scanning or settling.
    work: NodeSet,
    /// Nodes that are being seen to.
    found: NodeSet,
    /// The enumerations that occur.
    datatypes: BTreeSet<Enumeration>,
    /// Those to be declared.
    undeclared_datatypes: Vec<Enumeration>,
    /// The functions that occur.
    functions: BTreeSet<Function>,
    /// Those to be declared.
    undeclared_functions: Vec<Function>,
    /// Symbols to be declared.
    undeclared: NodeSet,
    /// How many have been.
    declared: usize,
    /// The free variables, with the number of nodes that they were computed for.
    free: Option<(usize, Free)>,
    features: Features,
    scratch: RefCell<Scratch>,
    /// The series of names for shared terms.
    series: u32,
}

impl Printer {
    /// A printer that has printed nothing.
    #[must_use]
    pub fn new() -> Self {
        Printer::default()
    }

    /// A printer whose names for shared terms are its own: several with different numbers may print into one text. What
    /// it prints stands within the scope of another's, perhaps, whose arena has the same enumerations.
    #[must_use]
    pub fn numbered(series: u32, within: Option<&Printer>) -> Self {
        let datatypes = within.map_or_else(BTreeSet::new, |outer| outer.datatypes.clone());
        Printer { series, datatypes, ..Printer::default() }
    }

    /// What occurs in everything scanned so far.
    #[must_use]
    pub fn features(&self) -> Features {
        self.features
    }

    /// Takes note of terms that are to be printed: counts what they share.
    pub fn scan(&mut self, terms: &Terms, roots: &[Term]) {
        self.marks.resize(terms.len(), Mark::default());
        for set in [&mut self.work, &mut self.found, &mut self.undeclared] {
            set.grow(terms.len());
        }
        for &root in roots {
            self.touch(root);
        }
        while let Some(t) = self.work.pop_last() {
            self.features.add(terms, t);
            if let Sort::Enum(enumeration) = terms.sort(t)
                && self.datatypes.insert(enumeration)
            {
                self.undeclared_datatypes.push(enumeration);
            }
            if terms.op(t) == Op::Symbol {
                self.undeclared.insert(t);
            }
            if let View::Apply(function, _) = terms.view(t)
                && self.functions.insert(function)
            {
                self.undeclared_functions.push(function);
            }
            for &child in terms.children(t) {
                self.touch(child);
            }
        }
        let quantified = self.features.quantifiers;
        if quantified && self.free.as_ref().is_none_or(|(count, _)| *count < terms.len()) {
            self.free = Some((terms.len(), Free::new(terms)));
        }
    }

    #[inline]
    fn touch(&mut self, t: Term) {
        let mark = &mut self.marks[t.index()];
        match mark.uses {
            0 => {
                mark.uses = 1;
                self.work.insert(t);
            }
            1 => {
                mark.uses = 2;
                // If it was printed inline already, it gets a name now.
                mark.settle(false);
            }
            _ => {}
        }
    }

    /// How many symbols and functions have been declared.
    #[must_use]
    pub fn declared(&self) -> usize {
        self.declared
    }

    /// Declares the enumerations, functions and symbols that were found since the last call.
    ///
    /// # Errors
    /// When writing fails.
    pub fn declare(&mut self, w: &mut impl io::Write, terms: &Terms) -> io::Result<()> {
        self.declare_datatypes(w, terms)?;
        self.declare_functions(w, terms)?;
        self.declared += self.undeclared.len();
        while let Some(symbol) = self.undeclared.pop_first() {
            w.write_all(b"(declare-fun ")?;
            rsmt2::symbol(w, &SymbolName::new(terms, symbol))?;
            w.write_all(b" () ")?;
            rsmt2::sort(w, &SortName::new(terms, terms.sort(symbol)))?;
            w.write_all(b")\n")?;
        }
        Ok(())
    }

    fn declare_datatypes(&mut self, w: &mut impl io::Write, terms: &Terms) -> io::Result<()> {
        for enumeration in std::mem::take(&mut self.undeclared_datatypes) {
            w.write_all(b"(declare-datatypes ((")?;
            terms.enumeration_name(enumeration).write(w)?;
            w.write_all(b" 0)) ((")?;
            for (at, constructor) in terms.constructor_names(enumeration).iter().enumerate() {
                w.write_all(if at == 0 { b"(" } else { b" (" })?;
                constructor.write(w)?;
                w.write_all(b")")?;
            }
            w.write_all(b")))\n")?;
        }
        Ok(())
    }

    fn declare_functions(&mut self, w: &mut impl io::Write, terms: &Terms) -> io::Result<()> {
        let mut functions = std::mem::take(&mut self.undeclared_functions);
        functions.sort_unstable();
        self.declared += functions.len();
        for function in functions {
            w.write_all(b"(declare-fun ")?;
            rsmt2::symbol(w, &FunctionName { terms, function })?;
            for (at, &sort) in terms.domain(function).iter().enumerate() {
                w.write_all(if at == 0 { b" (" } else { b" " })?;
                rsmt2::sort(w, &SortName::new(terms, sort))?;
            }
            w.write_all(b") ")?;
            rsmt2::sort(w, &SortName::new(terms, terms.range(function)))?;
            w.write_all(b")\n")?;
        }
        Ok(())
    }

    /// Prints the definitions that the assertion needs, and the assertion: a disjunction.
    ///
    /// # Errors
    /// When writing fails.
    pub fn assertion(&mut self, w: &mut impl io::Write, terms: &Terms, literals: &[Term]) -> io::Result<()> {
        self.define(w, terms, literals)?;
        w.write_all(b"(assert ")?;
        self.disjunction(w, terms, literals)?;
        w.write_all(b")\n")
    }

    /// As [`Printer::assertion`], with a name, which must be a simple symbol that nothing else has.
    ///
    /// # Errors
    /// When writing fails.
    pub fn named_assertion(
        &mut self,
        w: &mut impl io::Write,
        terms: &Terms,
        literals: &[Term],
        name: &str,
    ) -> io::Result<()> {
        self.define(w, terms, literals)?;
        w.write_all(b"(assert (! ")?;
        self.disjunction(w, terms, literals)?;
        writeln!(w, " :named {name}))")
    }

    fn disjunction(&self, w: &mut impl io::Write, terms: &Terms, literals: &[Term]) -> io::Result<()> {
        if let [only] = literals {
            self.term(w, terms, *only)
        } else {
            w.write_all(b"(or")?;
            for &t in literals {
                w.write_all(b" ")?;
                self.term(w, terms, t)?;
            }
            w.write_all(b")")
        }
    }

    /// Prints the definitions that are needed to print the terms, which must have been scanned.
    ///
    /// # Errors
    /// When writing fails.
    pub fn define(&mut self, w: &mut impl io::Write, terms: &Terms, roots: &[Term]) -> io::Result<()> {
        self.settle(terms, roots);
        while let Some(t) = self.found.pop_first() {
            let children = terms.children(t).iter().map(|child| self.marks[child.index()]);
            let inline = children.filter(|child| !child.is_named()).map(|child| child.height).max();
            let height = inline.map_or(0, |height| height.saturating_add(1));
            let mark = &mut self.marks[t.index()];
            mark.height = height;
            let shared = mark.uses > 1 || height >= HEIGHT;
            if shared && !terms.children(t).is_empty() {
                self.define_one(w, terms, t)?;
            }
        }
        Ok(())
    }

    /// Finds the nodes below the roots that were not seen to yet.
    fn settle(&mut self, terms: &Terms, roots: &[Term]) {
        for &root in roots {
            self.visit(terms, root);
        }
        while let Some(t) = self.work.pop_last() {
            self.found.insert(t);
            for &child in terms.children(t) {
                self.visit(terms, child);
            }
        }
    }

    #[inline]
    fn visit(&mut self, terms: &Terms, t: Term) {
        let mark = &mut self.marks[t.index()];
        if !mark.is_settled() {
            mark.settle(true);
            if terms.op(t) != Op::Symbol {
                self.work.insert(t);
            }
        }
    }

    fn define_one(&mut self, w: &mut impl io::Write, terms: &Terms, t: Term) -> io::Result<()> {
        let closed = self.free.as_ref().is_none_or(|(_, free)| free.is_closed(t));
        if !closed || self.marks[t.index()].is_named() {
            return Ok(());
        }
        w.write_all(b"(define-fun ")?;
        rsmt2::symbol(w, &SharedName { series: self.series, term: t })?;
        w.write_all(b" () ")?;
        rsmt2::sort(w, &SortName::new(terms, terms.sort(t)))?;
        w.write_all(b" ")?;
        rsmt2::expression(w, &self.expression(terms, t, true))?;
        w.write_all(b")\n")?;
        self.marks[t.index()].name();
        Ok(())
    }

    /// Prints a term whose definitions have been printed.
    ///
    /// # Errors
    /// When writing fails.
    pub fn term(&self, w: &mut impl io::Write, terms: &Terms, t: Term) -> io::Result<()> {
        rsmt2::expression(w, &self.expression(terms, t, false))
    }

    /// Whether the symbol has occurred in what was scanned.
    #[must_use]
    pub fn is_declared(&self, symbol: Term) -> bool {
        self.marks.get(symbol.index()).is_some_and(|mark| mark.uses > 0)
    }

    /// Whether the term is printed as a literal: a symbol or a name, perhaps under `not`.
    fn is_literal(&self, terms: &Terms, t: Term) -> bool {
        t.is_const()
            || terms.op(t) == Op::Symbol
            || self.marks.get(t.index()).is_some_and(|mark| mark.is_named())
    }

    /// Gives the term a name, whether it is shared or not.
    ///
    /// # Errors
    /// When writing fails.
    pub fn force_name(&mut self, w: &mut impl io::Write, terms: &Terms, t: Term) -> io::Result<()> {
        self.define(w, terms, &[t])?;
        if self.is_literal(terms, t) { Ok(()) } else { self.define_one(w, terms, t.positive()) }
    }

    fn expression<'a>(&'a self, terms: &'a Terms, term: Term, define: bool) -> Expression<'a> {
        let free = self.free.as_ref().map(|(_, free)| free);
        let (marks, scratch) = (&self.marks, &self.scratch);
        Expression { terms, free, marks, scratch, term, series: self.series, define }
    }
}
