//! The session of an external solver that is spoken to on its standard input.

use hyperplan_smt::{Features, Op, Printer, Script, Term, Value};

use super::exchange::{Exchange, REASON, VERSION};
use super::profile::{Assumptions, Profile};
use super::program::Program;
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use crate::session::{Answer, Identity, Options, Quantifiers, QuerySize, Session};

/// How much text is gathered before it is sent.
const PIECE: usize = 1 << 16;
/// How many symbols one `get-value` asks for.
pub(super) const ASK: usize = 1000;

impl Program {
    /// The logic is chosen by what is known now, and where more may follow, it leaves room.
    pub(super) fn logic(&self, features: Features, options: &Options) -> Result<String, Error> {
        let quantifiers = features.quantifiers || options.quantifiers() > Quantifiers::None;
        self.profile.logic(&Features { quantifiers, ..features })
    }

    /// What is said first.
    pub(super) fn preamble(&self, logic: &str, options: &Options) -> String {
        let Profile { setup, seed, .. } = &*self.profile;
        let mut text: String = setup.iter().flat_map(|command| [command.as_str(), "\n"]).collect();
        if let Some(option) = seed.as_ref().filter(|_| options.seed != 0) {
            text += &format!("(set-option {option} {})\n", options.seed % (1 << 31));
        }
        text += &format!("(set-logic {logic})\n");
        text
    }
}

/// A dialogue with a process, which is started at the first check, and again after one that ended at
/// a deadline, or by itself.
pub(super) struct Dialogue {
    program: Program,
    options: Options,
    running: Option<Running>,
    deadline: Deadline,
    has_model: bool,
    size: QuerySize,
}

/// What belongs to one process.
struct Running {
    exchange: Exchange,
    printer: Printer,
    /// The logic that was set.
    logic: Option<String>,
    /// How many assertions it has been told.
    fed: usize,
    /// How many bytes.
    bytes: usize,
    checks: usize,
    /// Whether the last check's assumptions are to be popped.
    pushed: bool,
}

impl Dialogue {
    pub(super) fn new(program: Program, options: &Options) -> Dialogue {
        let (options, deadline) = (options.clone(), Deadline::never());
        Dialogue { program, options, running: None, deadline, has_model: false, size: QuerySize::default() }
    }

    fn start(&self) -> Result<Running, Error> {
        let exchange = Exchange::start(&self.program, &self.program.arguments, &self.options)?;
        let printer = Printer::new();
        Ok(Running { exchange, printer, logic: None, fed: 0, bytes: 0, checks: 0, pushed: false })
    }

    /// Sends what the process does not know yet, and the check.
    fn feed(
        &self,
        running: &mut Running,
        script: &Script,
        assumptions: &[Term],
        deadline: &Deadline,
    ) -> Result<(), Error> {
        let terms = &script.terms;
        running.printer.scan(terms, script.literals(running.fed));
        running.printer.scan(terms, assumptions);
        let mut text = Vec::with_capacity(2 * PIECE);
        if running.checks == 0 {
            let expected = running.printer.features().beside(terms).union(self.options.features);
            let logic = self.program.logic(expected, &self.options)?;
            text.extend_from_slice(self.program.preamble(&logic, &self.options).as_bytes());
            running.logic = Some(logic);
        }
        running.checks += 1;
        if std::mem::take(&mut running.pushed) {
            text.extend_from_slice(b"(pop 1)\n");
        }
        // Writing to a vector cannot fail.
        let _ = running.printer.declare(&mut text, terms);
        while running.fed < script.len() {
            let _ = running.printer.assertion(&mut text, terms, script.assertion(running.fed));
            running.fed += 1;
            if text.len() > PIECE {
                let piece = std::mem::replace(&mut text, Vec::with_capacity(2 * PIECE));
                running.bytes += piece.len();
                running.exchange.send(piece, deadline);
                if deadline.passed() || running.exchange.must_stop() {
                    return Ok(());
                }
            }
        }
        let _ = self.ask(running, script, assumptions, &mut text);
        running.bytes += text.len();
        running.exchange.send(text, deadline);
        Ok(())
    }

    /// The check. Assumptions that are not literals get names; where a process answers one check
    /// only, they are assertions.
    fn ask(
        &self,
        running: &mut Running,
        script: &Script,
        assumptions: &[Term],
        text: &mut Vec<u8>,
    ) -> std::io::Result<()> {
        let terms = &script.terms;
        let push = self.program.profile.assumptions == Assumptions::Push;
        if assumptions.is_empty() || self.program.one_shot || push {
            // What is defined within the push would be forgotten by the pop.
            for &t in assumptions.iter().filter(|_| push) {
                running.printer.force_name(text, terms, t)?;
            }
            running.pushed = push && !assumptions.is_empty() && !self.program.one_shot;
            if running.pushed {
                text.extend_from_slice(b"(push 1)\n");
            }
            for &t in assumptions {
                running.printer.assertion(text, terms, &[t])?;
            }
            text.extend_from_slice(b"(check-sat)\n");
            return Ok(());
        }
        for &t in assumptions {
            running.printer.force_name(text, terms, t)?;
        }
        text.extend_from_slice(b"(check-sat-assuming (");
        for &t in assumptions {
            text.push(b' ');
            running.printer.term(text, terms, t)?;
        }
        text.extend_from_slice(b"))\n");
        Ok(())
    }

    /// Finds out the version, where that was not done yet and the solver tells it.
    fn learn_version(&self, running: &mut Running) -> Result<(), Error> {
        if self.program.is_to_tell_version() && running.exchange.is_open() {
            running.exchange.send(VERSION.to_vec(), &self.deadline);
            self.hear_version(running)?;
        }
        Ok(())
    }

    fn hear_version(&self, running: &mut Running) -> Result<(), Error> {
        let version = running.exchange.version(&self.deadline)?;
        self.program.version.learn(&version.unwrap_or_default());
        Ok(())
    }

    /// Values of symbols that the solver knows. All is asked at once, the version too, so that nobody waits for
    /// somebody who waits.
    fn ask_values(
        &self,
        running: &mut Running,
        script: &Script,
        symbols: &[Term],
    ) -> Result<Vec<Value>, Error> {
        let ask = |symbols| get_value(&running.printer, script, symbols);
        let mut text: Vec<u8> = symbols.chunks(ASK).flat_map(ask).collect();
        let version = self.program.is_to_tell_version();
        if version {
            text.extend_from_slice(VERSION);
        }
        running.exchange.send(text, &self.deadline);
        let mut values = Vec::with_capacity(symbols.len());
        for asked in symbols.chunks(ASK) {
            values.extend(running.exchange.values(script, asked, &self.deadline)?);
        }
        if version {
            self.hear_version(running)?;
        }
        Ok(values)
    }

    fn known_values(
        &self,
        running: &mut Running,
        script: &Script,
        symbols: &[Term],
    ) -> Result<Vec<Value>, Error> {
        let terms = &script.terms;
        let mut values: Vec<Value> = symbols.iter().map(|&t| Value::default_of(terms.sort(t))).collect();
        let known =
            |i: &usize| terms.op(symbols[*i]) == Op::Symbol && running.printer.is_declared(symbols[*i]);
        let known: Vec<usize> = (0..symbols.len()).filter(known).collect();
        let asked: Vec<Term> = known.iter().map(|&i| symbols[i].positive()).collect();
        for (i, value) in known.into_iter().zip(self.ask_values(running, script, &asked)?) {
            values[i] = value;
        }
        negate(&mut values, symbols);
        Ok(values)
    }

    /// Whether a process that says nothing may be waiting for the end of its input: it has said nothing before, and is not
    /// known to speak in dialogues.
    fn may_wait(&self, running: &Running) -> bool {
        running.checks == 1 && !self.program.profile.tells_version
    }

    /// One check. A process that turns out to have ended since the last one says nothing: `None`.
    fn attempt(
        &mut self,
        mut running: Running,
        script: &Script,
        assumptions: &[Term],
        deadline: &Deadline,
    ) -> Result<Answer, Error> {
        self.feed(&mut running, script, assumptions, deadline)?;
        let (clauses, variables) = (running.fed, running.printer.declared());
        self.size = QuerySize { clauses, variables, bytes: running.bytes, logic: running.logic.clone() };
        // On an error or at the deadline the process is dropped, which kills it.
        let answer = match running.exchange.answer(deadline)? {
            None if !deadline.cancelled() && self.may_wait(&running) && running.exchange.answers_at_end() => {
                return Ok(Answer::Unknown(Unknown::WaitsForEnd));
            }
            None => return Ok(Answer::Unknown(deadline.reason())),
            Some(Answer::Unknown(Unknown::Unsaid)) => {
                running.exchange.send(REASON.to_vec(), deadline);
                Answer::Unknown(running.exchange.reason(0, deadline)?)
            }
            Some(answer) => answer,
        };
        // While values are wanted, the model is not to be put at risk.
        self.has_model = answer == Answer::Sat;
        if !self.has_model {
            self.learn_version(&mut running)?;
        }
        self.running = Some(running);
        Ok(answer)
    }
}

impl Session for Dialogue {
    fn check(&mut self, script: &Script, assumptions: &[Term], deadline: &Deadline) -> Result<Answer, Error> {
        self.has_model = false;
        self.deadline = deadline.clone();
        if assumptions.contains(&Term::FALSE) {
            return Ok(Answer::Unsat);
        }
        if deadline.passed() {
            return Ok(Answer::Unknown(deadline.reason()));
        }
        let assumptions: Vec<Term> = assumptions.iter().copied().filter(|&t| t != Term::TRUE).collect();
        let old = self.running.take().filter(|old| !self.program.one_shot && old.exchange.is_open());
        let again = old.is_some();
        let running = match old {
            Some(running) => running,
            None => self.start()?,
        };
        let mut answer = self.attempt(running, script, &assumptions, deadline);
        if again && matches!(answer, Err(Error::Crashed { .. })) && !deadline.passed() {
            // One that fails when it is asked more may answer when it is asked at once.
            let running = self.start()?;
            answer = self.attempt(running, script, &assumptions, deadline);
        }
        out_of_memory(answer)
    }

    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error> {
        let mut running = match self.running.take() {
            Some(running) if self.has_model => running,
            other => {
                self.running = other;
                return Err(Error::NoModel { name: self.program.profile.name.clone() });
            }
        };
        let values = self.known_values(&mut running, script, symbols)?;
        self.running = Some(running);
        Ok(values)
    }

    fn identity(&self) -> Identity {
        Identity { name: self.program.profile.name.clone(), version: self.program.version.get() }
    }

    fn size(&self) -> QuerySize {
        self.size.clone()
    }
}

/// The command that asks for the values of declared symbols.
pub(super) fn get_value(printer: &Printer, script: &Script, symbols: &[Term]) -> Vec<u8> {
    let mut text = b"(get-value (".to_vec();
    for &symbol in symbols {
        text.push(b' ');
        // Writing to a vector cannot fail.
        let _ = printer.term(&mut text, &script.terms, symbol);
    }
    text.extend_from_slice(b"))\n");
    text
}

/// Values of symbols become those of what was asked for, which may be their negations.
pub(super) fn negate(values: &mut [Value], symbols: &[Term]) {
    for (value, symbol) in values.iter_mut().zip(symbols) {
        if let Value::Bool(b) = value {
            *b ^= symbol.is_negated();
        }
    }
}

/// A solver that had not enough memory is undecided, not at fault.
pub(super) fn out_of_memory(answer: Result<Answer, Error>) -> Result<Answer, Error> {
    match answer {
        Err(Error::Memory { .. }) => Ok(Answer::Unknown(Unknown::Memory)),
        answer => answer,
    }
}
