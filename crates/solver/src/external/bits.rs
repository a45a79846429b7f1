//! The session of a SAT or QBF solver: each check is a process of its own, which gets a file of bits.

use hyperplan_smt::{Features, Script, Term, Value};

use super::assignment::Heard;
use super::dialogue::{negate, out_of_memory};
use super::exchange::Exchange;
use super::one_shot::temporary;
use super::process::Next;
use super::profile::FILE;
use super::program::Program;
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use crate::propositional::{Format, Propositional};
use crate::session::{Answer, Identity, Options, QuerySize, Session};
use crate::transcript::{cannot_keep, keep_file};

/// Asks for an assignment to the outermost block by what it is called with, and reads it back.
pub(super) struct Bits {
    program: Program,
    options: Options,
    format: Format,
    /// Of the last check, if it was satisfiable: the query, and which variables are true.
    model: Option<(Propositional, Vec<bool>)>,
    size: QuerySize,
}

impl Bits {
    pub(super) fn new(program: Program, format: Format, options: &Options) -> Bits {
        Bits { program, options: options.clone(), format, model: None, size: QuerySize::default() }
    }

    fn run(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        // Where there are no bits for something, this names solvers that take it.
        self.program.profile.logic(&Features::of(script))?;
        let query = Propositional::new(script, assumptions, self.format, deadline)?;
        let mut text = Vec::new();
        // Writing to a vector cannot fail.
        let _ = query.write(&mut text, &[], self.options.queries.is_none());
        self.size = QuerySize {
            clauses: query.size(),
            variables: query.variables(),
            bytes: text.len(),
            logic: Some(self.format.to_string()),
        };
        let ending = self.format.name();
        if let Some(directory) = &self.options.queries {
            let name = &self.program.profile.name;
            let kept = keep_file(directory, "", name, ending, |to| to.write_all(&text));
            kept.map_err(|source| cannot_keep(directory, source))?;
        }
        let heard = self.ask(text, query.variables(), deadline)?;
        let Some(heard) = heard else { return Ok(Answer::Unknown(deadline.reason())) };
        Ok(match heard.answer {
            Some(Some(true)) => {
                let mut is_true = vec![false; query.variables() + 1];
                for &literal in heard.literals.iter().filter(|&&literal| literal > 0) {
                    if let Some(value) = is_true.get_mut(literal.unsigned_abs() as usize) {
                        *value = true;
                    }
                }
                if heard.literals.is_empty() && query.has_symbols() {
                    return Err(
                        self.misunderstood("an assignment to the outermost block", "nothing about that")
                    );
                }
                self.model = Some((query, is_true));
                Answer::Sat
            }
            Some(Some(false)) => Answer::Unsat,
            Some(None) | None => Answer::Unknown(Unknown::Unsaid),
        })
    }

    /// What the program says to a query of so many variables; `None` at the deadline.
    fn ask(&self, text: Vec<u8>, variables: usize, deadline: &Deadline) -> Result<Option<Heard>, Error> {
        let file = self.program.takes_file().then(|| temporary(&[&text], self.format.name())).transpose();
        let file = file.map_err(|source| Error::Io {
            what: "cannot write the query to a file (TMPDIR says where)".to_owned(),
            source,
        })?;
        let path = file.as_ref().map_or_else(String::new, |file| file.path().display().to_string());
        let arguments: Vec<String> =
            self.program.arguments.iter().map(|word| word.replace(FILE, &path)).collect();
        let options = Options { queries: None, ..self.options.clone() };
        let mut exchange = Exchange::start(&self.program, &arguments, &options)?;
        exchange.take_long_lines();
        if file.is_none() {
            exchange.send(text, deadline);
        }
        exchange.close_input();
        let (mut heard, mut last) = (Heard::default(), String::new());
        let contradicts =
            |said: &str| self.misunderstood("the query", &format!("{said} after another answer"));
        loop {
            match exchange.next(deadline)? {
                Next::Deadline => return Ok(None),
                Next::Ended => break,
                Next::Reply(reply) => {
                    heard.line(reply.text()).map_err(|()| contradicts(reply.text()))?;
                    heard.within(variables);
                    reply.text().clone_into(&mut last);
                }
            }
        }
        let status = exchange.end();
        heard.exit(&status).map_err(|()| contradicts(&status))?;
        match heard.answer {
            None => Err(exchange.crashed_after(&last)),
            Some(_) => Ok(Some(heard)),
        }
    }

    fn misunderstood(&self, asked: &str, said: &str) -> Error {
        let name = self.program.profile.name.clone();
        Error::Protocol { name, asked: asked.to_owned(), said: said.to_owned() }
    }
}

impl Session for Bits {
    fn check(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        self.model = None;
        if assumptions.contains(&Term::FALSE) {
            return Ok(Answer::Unsat);
        }
        if deadline.passed() {
            return Ok(Answer::Unknown(deadline.reason()));
        }
        match self.run(script, assumptions, deadline) {
            Err(Error::Interrupted) => Ok(Answer::Unknown(deadline.reason())),
            answer => out_of_memory(answer),
        }
    }

    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error> {
        let Some((query, is_true)) = &self.model else {
            return Err(Error::NoModel { name: self.program.profile.name.clone() });
        };
        let value = |symbol: &Term| {
            let known = query.value(&script.terms, symbol.positive(), |variable| is_true[variable as usize]);
            match known.unwrap_or_else(|| Value::default_of(script.terms.sort(*symbol))) {
                // More bits than values: the query rules the rest out.
                Value::Enum(enumeration, at) if at >= script.terms.constructors(enumeration) => Err(self
                    .misunderstood(
                        "an assignment",
                        &format!("value {at} of {}", script.terms.sort(*symbol)),
                    )),
                value => Ok(value),
            }
        };
        let mut values: Vec<Value> = symbols.iter().map(value).collect::<Result<_, _>>()?;
        negate(&mut values, symbols);
        Ok(values)
    }

    fn identity(&self) -> Identity {
        // Tables show what it was given: comparisons with others depend on that.
        let version = format!("{} ({})", self.program.version.get(), self.format);
        Identity { name: self.program.profile.name.clone(), version: version.trim_start().to_owned() }
    }

    fn size(&self) -> QuerySize {
        self.size.clone()
    }
}
