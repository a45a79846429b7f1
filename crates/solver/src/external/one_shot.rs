//! The session of an external solver that takes a whole query, in a file or up to the end of its input: each check is a
//! process of its own.

use std::collections::BTreeMap;
use std::io::Write as _;

use hyperplan_smt::{Op, Printer, Script, Term, Value};
use tempfile::NamedTempFile;

use super::dialogue::{ASK, get_value, negate, out_of_memory};
use super::exchange::{Exchange, REASON, VERSION};
use super::profile::FILE;
use super::program::Program;
use super::watchdog;
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use crate::session::{Answer, Identity, Options, QuerySize, Session};

/// Each query has all questions after the check, since there is no asking later: the version, all values, why the answer
/// is not known. What a solver says to those that do not fit its answer does not matter.
pub(super) struct OneShot {
    program: Program,
    options: Options,
    model: Known,
    size: QuerySize,
}

/// What is known of the last check's model.
enum Known {
    /// There is none.
    Nothing,
    /// All of it.
    Values(BTreeMap<Term, Value>),
    /// It has numbers for which there is no room.
    TooLarge,
}

/// A query with its questions.
struct Query {
    text: Vec<u8>,
    /// Whether it asks for the version. It may become known elsewhere before the reply comes, which is due all the same.
    asks_version: bool,
    /// The symbols whose values it asks for.
    symbols: Vec<Term>,
}

impl OneShot {
    pub(super) fn new(program: Program, options: &Options) -> OneShot {
        OneShot { program, options: options.clone(), model: Known::Nothing, size: QuerySize::default() }
    }

    fn run(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        let Query { text, asks_version, symbols } = self.query(script, assumptions)?;
        let file = self.program.takes_file().then(|| temporary(&[&text, b"(exit)\n"], "smt2")).transpose();
        let file = file.map_err(|source| Error::Io {
            what: "cannot write the query to a file (TMPDIR says where)".to_owned(),
            source,
        })?;
        let path = file.as_ref().map_or_else(String::new, |file| file.path().display().to_string());
        let arguments: Vec<String> =
            self.program.arguments.iter().map(|word| word.replace(FILE, &path)).collect();
        let mut exchange = Exchange::start(&self.program, &arguments, &self.options)?;
        match &file {
            Some(_) => exchange.keep(&text),
            None => exchange.send(text, deadline),
        }
        exchange.close_input();
        let Some(answer) = exchange.answer(deadline)? else {
            return Ok(Answer::Unknown(deadline.reason()));
        };
        if asks_version {
            self.program.version.learn(&exchange.version(deadline)?.unwrap_or_default());
        }
        match answer {
            Answer::Sat => {
                let mut model = BTreeMap::new();
                for asked in symbols.chunks(ASK) {
                    match exchange.values(script, asked, deadline) {
                        Err(Error::LargeNumber { .. }) => {
                            self.model = Known::TooLarge;
                            return Ok(Answer::Sat);
                        }
                        values => model.extend(asked.iter().copied().zip(values?)),
                    }
                }
                self.model = Known::Values(model);
                Ok(Answer::Sat)
            }
            Answer::Unknown(Unknown::Unsaid) => {
                Ok(Answer::Unknown(exchange.reason(symbols.chunks(ASK).len(), deadline)?))
            }
            answer => Ok(answer),
        }
    }

    fn query(&mut self, script: &Script, assumptions: &[Term]) -> Result<Query, Error> {
        let terms = &script.terms;
        let mut printer = Printer::new();
        printer.scan(terms, script.literals(0));
        printer.scan(terms, assumptions);
        let logic = self.program.logic(printer.features(), &self.options)?;
        let mut text = self.program.preamble(&logic, &self.options).into_bytes();
        // Writing to a vector cannot fail.
        let _ = printer.declare(&mut text, terms);
        for literals in script.assertions(0).chain(assumptions.chunks(1)) {
            let _ = printer.assertion(&mut text, terms, literals);
        }
        text.extend_from_slice(b"(check-sat)\n");
        let asks_version = self.program.is_to_tell_version();
        if asks_version {
            text.extend_from_slice(VERSION);
        }
        let known = |t: &Term| terms.op(*t) == Op::Symbol && printer.is_declared(*t);
        let symbols: Vec<Term> = terms.iter().filter(known).collect();
        let (clauses, variables, bytes) = (script.len(), symbols.len(), text.len());
        self.size = QuerySize { clauses, variables, bytes, logic: Some(logic) };
        for asked in symbols.chunks(ASK) {
            text.extend_from_slice(&get_value(&printer, script, asked));
        }
        // Last, since some end at the error that it may be.
        text.extend_from_slice(REASON);
        Ok(Query { text, asks_version, symbols })
    }
}

/// A file that is removed with this, or by the watchdog. Some programs want the ending.
pub(super) fn temporary(pieces: &[&[u8]], ending: &str) -> std::io::Result<NamedTempFile> {
    watchdog::begin();
    let suffix = format!(".{ending}");
    let mut file = tempfile::Builder::new().prefix("hyperplan-").suffix(&suffix).tempfile()?;
    watchdog::watch_file(file.path());
    pieces.iter().try_for_each(|piece| file.write_all(piece))?;
    file.flush()?;
    Ok(file)
}

impl Session for OneShot {
    fn check(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        self.model = Known::Nothing;
        if assumptions.contains(&Term::FALSE) {
            return Ok(Answer::Unsat);
        }
        if deadline.passed() {
            return Ok(Answer::Unknown(deadline.reason()));
        }
        match self.run(script, assumptions, deadline) {
            Err(Error::Deadline { .. }) => Ok(Answer::Unknown(deadline.reason())),
            answer => out_of_memory(answer),
        }
    }

    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error> {
        let name = || self.program.profile.name.clone();
        let model = match &self.model {
            Known::Values(model) => model,
            Known::TooLarge => return Err(Error::LargeNumber { name: name() }),
            Known::Nothing => return Err(Error::NoModel { name: name() }),
        };
        let value = |t: &Term| {
            let known = model.get(&t.positive()).copied();
            known.unwrap_or_else(|| Value::default_of(script.terms.sort(*t)))
        };
        let mut values: Vec<Value> = symbols.iter().map(value).collect();
        negate(&mut values, symbols);
        Ok(values)
    }

    fn identity(&self) -> Identity {
        Identity { name: self.program.profile.name.clone(), version: self.program.version.get() }
    }

    fn size(&self) -> QuerySize {
        self.size.clone()
    }
}
