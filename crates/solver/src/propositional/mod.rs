//! Scripts in the formats of SAT and QBF solvers: bits for symbols, quantifiers in front.

mod clauses;
mod qcir;

use std::fmt;
use std::io::{self, Write};

use hyperplan_outlet::one_line;
use hyperplan_smt::{Op, Script, Sort, Term, Terms, Value, symbol_text};
use rustc_hash::FxHashMap;

use crate::circuit::{Budget, Cnf, Halt, Lit, Prefix, Sink, width};
use crate::deadline::Deadline;
use crate::error::Error;
use clauses::Clauses;
use qcir::Net;

/// What a query is written in for programs that know nothing of terms.
#[derive(Copy, Clone, PartialEq, Eq, Debug, Hash)]
pub enum Format {
    /// Clauses without quantifiers: DIMACS.
    Dimacs,
    /// Clauses with quantifiers in front: QDIMACS 1.1.
    Qdimacs,
    /// Gates with quantifiers in front: QCIR-14, prenex and cleansed.
    Qcir,
}

impl Format {
    /// What it is called, and how files in it end.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Format::Dimacs => "dimacs",
            Format::Qdimacs => "qdimacs",
            Format::Qcir => "qcir",
        }
    }

    /// Every line of comment begins so.
    fn comment(self) -> &'static str {
        match self {
            Format::Dimacs | Format::Qdimacs => "c",
            Format::Qcir => "#",
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::Dimacs => "DIMACS",
            Format::Qdimacs => "QDIMACS",
            Format::Qcir => "QCIR",
        })
    }
}

/// A script in one of these formats, ready to be written.
pub struct Propositional {
    format: Format,
    body: Body,
    /// From the outside in; the first is existential unless there is nothing to choose, and neighbours differ.
    blocks: Vec<Block>,
    /// The variables that stand for symbols, or for what quantifiers bind, each with its name.
    names: Vec<(Lit, String)>,
    /// The literals of each declared symbol that occurs.
    symbols: FxHashMap<Term, Vec<Lit>>,
    variables: usize,
}

enum Body {
    Clauses(Clauses),
    Net(Net),
}

/// Neighbouring variables of one quantifier.
struct Block {
    universal: bool,
    variables: Vec<u32>,
}

impl Propositional {
    /// Turns what a script asserts, and further Boolean terms, into bits.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for numbers without bounds, for quantifiers where the format has none or they cannot stand in
    /// front; [`Error::Interrupted`] once the deadline has passed.
    pub fn new(
        script: &Script,
        assumptions: &[Term],
        format: Format,
        deadline: &Deadline,
    ) -> Result<Propositional, Error> {
        match format {
            Format::Qcir => Propositional::with::<Net>(script, assumptions, format, deadline),
            _ => Propositional::with::<Clauses>(script, assumptions, format, deadline),
        }
    }

    fn with<S: Sink + Default + Into<Body>>(
        script: &Script,
        assumptions: &[Term],
        format: Format,
        deadline: &Deadline,
    ) -> Result<Propositional, Error> {
        let terms = &script.terms;
        let asserted = [script.literals(0), assumptions].concat();
        let prefix =
            Prefix::of(terms, &asserted).ok_or_else(|| S::unsupported("quantifiers inside equalities"))?;
        if format == Format::Dimacs && prefix.levels.iter().any(|level| !level.is_empty()) {
            let what = "DIMACS has no quantifiers: use QDIMACS or QCIR, or expand the quantifiers";
            return Err(Error::Unsupported { what: what.to_owned() });
        }
        let mut cnf = Cnf::new(S::default());
        let budget = Budget::new(deadline, None, None);
        for literals in script.assertions(0).chain(assumptions.chunks(1)) {
            cnf.assert(script, literals);
            cnf.finish(terms, &budget).map_err(|halt| match halt {
                Halt::Error(error) => error,
                Halt::Spent | Halt::Tired => Error::Interrupted,
            })?;
        }
        let literals = |t: Term| match terms.sort(t) {
            Sort::Bool => cnf.known_literal(t).map(|literal| vec![literal]),
            _ => cnf.known_bits(t, width(terms, t)).map(<[Lit]>::to_vec),
        };
        let known = |t: Term| Some((t, literals(t)?));
        let symbols: Vec<Term> = terms.iter().filter(|&t| terms.op(t) == Op::Symbol).collect();
        let symbols: Vec<(Term, Vec<Lit>)> = symbols.into_iter().filter_map(known).collect();
        let mut levels: Vec<Vec<(Term, Vec<Lit>)>> = vec![symbols.clone()];
        for (at, level) in prefix.levels.into_iter().enumerate() {
            levels.resize_with(levels.len().max(at + 1), Vec::new);
            levels[at].extend(level.into_iter().filter_map(known));
        }
        let mut names: Vec<(Lit, String)> =
            levels.iter().flatten().flat_map(|(t, literals)| named(terms, *t, literals)).collect();
        names.sort_unstable();
        let variables = cnf.gates.variables();
        let blocks = blocks(&levels, variables, format);
        let body = cnf.gates.sink.into();
        Ok(Propositional { format, body, blocks, names, symbols: symbols.into_iter().collect(), variables })
    }

    /// How many variables there are, those that stand for gates included.
    #[must_use]
    pub fn variables(&self) -> usize {
        self.variables
    }

    /// How many clauses there are, or in QCIR gates.
    #[must_use]
    pub fn size(&self) -> usize {
        match &self.body {
            Body::Clauses(clauses) => clauses.size(),
            Body::Net(net) => net.size(),
        }
    }

    /// Writes it. `about` are lines of comment; without `bare`, further ones say what each variable is.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(&self, to: &mut dyn Write, about: &[String], bare: bool) -> io::Result<()> {
        let mut w = io::BufWriter::with_capacity(1 << 16, to);
        let mut comments = about.to_vec();
        if !bare {
            comments.extend(self.names.iter().map(|(literal, name)| format!("{} {name}", literal.number())));
        }
        let mark = self.format.comment();
        let about = |w: &mut dyn Write| {
            comments.iter().try_for_each(|line| {
                // QDIMACS has no other characters than those of ASCII.
                let ascii =
                    |c: char| if c.is_ascii() { c.to_string() } else { c.escape_default().to_string() };
                let line: String = one_line(line.trim_end()).chars().map(ascii).collect();
                writeln!(w, "{}", format!("{mark} {line}").trim_end())
            })
        };
        match &self.body {
            Body::Clauses(clauses) => {
                about(&mut w)?;
                clauses.write(&mut w, self.variables, &self.blocks, self.format)?;
            }
            Body::Net(net) => net.write(&mut w, about, self.variables, &self.blocks)?,
        }
        w.flush()
    }

    /// The value of a declared symbol, not negated, under an assignment, which tells whether a variable is true; `None` for symbols that do not
    /// occur.
    pub fn value(&self, terms: &Terms, symbol: Term, is_true: impl Fn(u32) -> bool) -> Option<Value> {
        let literals = self.symbols.get(&symbol)?;
        let bit = |&literal: &Lit| is_true(literal.variable()) == (literal.number() > 0);
        let bits = literals.iter().enumerate().fold(0, |bits, (i, l)| bits | u128::from(bit(l)) << i);
        Some(match terms.sort(symbol) {
            Sort::BitVec(width) => Value::Bv { width, bits },
            Sort::Enum(enumeration) => Value::Enum(enumeration, bits as u32),
            _ => Value::Bool(bits == 1),
        })
    }

    /// Whether a declared symbol occurs.
    #[must_use]
    pub fn has_symbols(&self) -> bool {
        !self.symbols.is_empty()
    }
}

/// What literals of a symbol are called: it, and of a vector the weight of the bit.
fn named(terms: &Terms, t: Term, literals: &[Lit]) -> Vec<(Lit, String)> {
    let name = symbol_text(terms, t);
    match terms.sort(t) {
        Sort::Bool => literals.iter().map(|&literal| (literal, name.clone())).collect(),
        _ => literals.iter().enumerate().map(|(i, &literal)| (literal, format!("{name} bit {i}"))).collect(),
    }
}

/// The blocks of a prefix: with clauses, what stands for gates is chosen last, by whoever wants the formula to be true.
fn blocks(levels: &[Vec<(Term, Vec<Lit>)>], variables: usize, format: Format) -> Vec<Block> {
    let mut is_free = vec![true; variables + 1];
    let mut blocks: Vec<Block> = Vec::new();
    let mut add = |universal: bool, mut variables: Vec<u32>| {
        variables.sort_unstable();
        match blocks.last_mut() {
            _ if variables.is_empty() => {}
            Some(last) if last.universal == universal => last.variables.append(&mut variables),
            _ => blocks.push(Block { universal, variables }),
        }
    };
    for (at, level) in levels.iter().enumerate() {
        let variables: Vec<u32> =
            level.iter().flat_map(|(_, literals)| literals).map(|l| l.variable()).collect();
        for &variable in &variables {
            is_free[variable as usize] = false;
        }
        add(at % 2 == 1, variables);
    }
    if format != Format::Qcir {
        add(false, (1..=variables as u32).filter(|&variable| is_free[variable as usize]).collect());
    }
    blocks
}

/// That bits cannot express something.
fn unsupported(what: &str) -> Error {
    let what = format!("bits cannot stand for {what}: SMT-LIB can");
    Error::Unsupported { what }
}
