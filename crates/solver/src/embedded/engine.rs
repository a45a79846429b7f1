//! The session of the embedded engine.

use hyperplan_smt::{Header, Script, Sort, Term, Value, WriteOptions, write_script};

use super::table::Built;
use super::worker::Worker;
use crate::circuit::{Budget, Cnf, Halt, Memory, Sink as _, width};
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use crate::session::{Answer, Identity, Options, QuerySize, Session};
use crate::transcript::{cannot_keep, keep_query};

/// The embedded engine.
pub(crate) struct Engine {
    /// What the user calls it.
    name: String,
    options: Options,
    /// The limit, counted from the start of the session.
    memory: Option<Memory>,
    cnf: Cnf<Worker>,
    version: String,
    /// How many assertions have been taken.
    fed: usize,
    has_model: bool,
    /// What of the script cannot be handled: from then on there is no answer.
    unsupported: Option<String>,
    /// The assertions alone are unsatisfiable; more of them will not change that.
    refuted: bool,
}

impl Engine {
    /// An engine of that name, with one of the SAT solvers.
    pub(crate) fn new(name: &str, backend: Built, options: &Options) -> Result<Engine, Error> {
        let memory = options.memory_mib.map(Memory::growing_by).transpose()?;
        let worker = Worker::start(name, backend.serve, options.seed, options.incremental)?;
        let cnf = Cnf::new(worker);
        Ok(Engine {
            name: name.to_owned(),
            options: options.clone(),
            memory,
            cnf,
            version: backend.version(),
            fed: 0,
            has_model: false,
            unsupported: None,
            refuted: false,
        })
    }

    /// Keeps the query as a file that any solver can replay: everything asserted so far, and the assumptions as
    /// further assertions.
    fn keep(&self, script: &Script, assumptions: &[Term]) -> Result<(), Error> {
        let Some(directory) = &self.options.queries else { return Ok(()) };
        let header = Header { status: self.options.status, ..Header::default() };
        let options = WriteOptions { header, assumptions: assumptions.to_vec(), ..WriteOptions::default() };
        let kept = keep_query(directory, "", &self.name, |mut to| write_script(&mut to, script, &options));
        kept.map(|_| ()).map_err(|source| cannot_keep(directory, source))
    }

    /// Whether the script is satisfiable under the assumptions, after encoding what is new of it.
    fn answer(&mut self, script: &Script, assumptions: &[Term], budget: &Budget) -> Result<bool, Halt> {
        self.cnf.gates.sink.ready(budget)?;
        self.cnf.finish(&script.terms, budget)?;
        while self.fed < script.len() {
            self.cnf.assert(script, script.assertion(self.fed));
            self.fed += 1;
            self.cnf.finish(&script.terms, budget)?;
        }
        let mut literals = Vec::with_capacity(assumptions.len());
        for &t in assumptions.iter().filter(|&&t| t != Term::TRUE) {
            literals.push(self.cnf.assumption(script, t));
            self.cnf.finish(&script.terms, budget)?;
        }
        let answer = self.cnf.gates.sink.solve(&literals, budget)?;
        self.has_model = answer;
        self.refuted = !answer && literals.is_empty();
        Ok(answer)
    }
}

impl Engine {
    /// The bits of a symbol in the model, as a number; zero if it has not occurred.
    fn number(&self, script: &Script, symbol: Term) -> u128 {
        let mut number = 0;
        let literals = self.cnf.known_bits(symbol, width(&script.terms, symbol)).unwrap_or_default();
        for (i, &literal) in literals.iter().enumerate() {
            number |= u128::from(self.cnf.gates.sink.is_true(literal)) << i;
        }
        number
    }
}

impl Session for Engine {
    fn check(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        self.check_within(script, assumptions, deadline, None)
    }

    fn check_within(
        &mut self,
        script: &Script,
        assumptions: &[Term],
        deadline: &Deadline,
        effort: Option<u64>,
    ) -> Result<Answer, Error> {
        self.has_model = false;
        if let Some(what) = &self.unsupported {
            return Err(Error::Unsupported { what: what.clone() });
        }
        self.keep(script, assumptions)?;
        if self.refuted {
            return Ok(Answer::Unsat);
        }
        let budget = Budget::new(deadline, self.memory.as_ref(), effort);
        match self.answer(script, assumptions, &budget) {
            Ok(true) => Ok(Answer::Sat),
            Ok(false) => Ok(Answer::Unsat),
            Err(Halt::Spent) => Ok(Answer::Unknown(budget.reason())),
            Err(Halt::Tired) => Ok(Answer::Unknown(Unknown::Effort)),
            Err(Halt::Error(error)) => {
                if let Error::Unsupported { what } = &error {
                    self.unsupported = Some(what.clone());
                }
                Err(error)
            }
        }
    }

    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error> {
        if !self.has_model {
            return Err(Error::NoModel { name: self.name.clone() });
        }
        let sat = &self.cnf.gates.sink;
        let mut values = Vec::with_capacity(symbols.len());
        for &symbol in symbols {
            values.push(match script.terms.sort(symbol) {
                Sort::Bool => {
                    let literal = self.cnf.known_literal(symbol);
                    Value::Bool(literal.map_or(symbol.is_negated(), |literal| sat.is_true(literal)))
                }
                Sort::BitVec(width) => Value::Bv { width, bits: self.number(script, symbol) },
                Sort::Enum(enumeration) => Value::Enum(enumeration, self.number(script, symbol) as u32),
                sort @ (Sort::Int | Sort::Real) => Value::default_of(sort),
            });
        }
        Ok(values)
    }

    fn identity(&self) -> Identity {
        Identity { name: self.name.clone(), version: self.version.clone() }
    }

    fn size(&self) -> QuerySize {
        let gates = &self.cnf.gates;
        QuerySize { clauses: gates.sink.size(), variables: gates.variables(), ..QuerySize::default() }
    }
}
