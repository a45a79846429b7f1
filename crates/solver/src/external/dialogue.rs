//! The session of an external solver.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::time::Duration;

use hyperplan_smt::{Features, Op, Printer, Script, Term, Value, logic};

use super::discover::{locate, search, version};
use super::process::{Next, Process};
use super::profile::{Profile, profile};
use super::reply::{self, Meaning};
use crate::deadline::Deadline;
use crate::error::Error;
use crate::session::{Answer, Identity, Options, Quantifiers, Session, Size};
use crate::transcript::Transcript;

/// How much text is gathered before it is sent.
const PIECE: usize = 1 << 16;
/// How many symbols one `get-value` asks for.
const ASK: usize = 1000;
/// How long a solver that gave up may take to say why.
const PATIENCE: Duration = Duration::from_secs(1);

/// A session with a solver that hyperplan knows.
pub(crate) fn open_profile(name: &str, options: &Options) -> Result<Box<dyn Session>, Error> {
    let profile =
        profile(name).ok_or_else(|| Error::Unsupported { what: format!("no solver {name} is known") })?;
    options.demand_at_most(profile.quantifiers, profile.name)?;
    let (path, tried) = locate(profile);
    let missing = || Error::Missing { name: profile.name.to_owned(), tried, hint: profile.hint.to_owned() };
    let path = path.ok_or_else(missing)?;
    let one_shot = profile.one_shot.filter(|_| options.quantifiers() > Quantifiers::None);
    let arguments = one_shot.unwrap_or(profile.arguments).iter().map(|&text| text.to_owned()).collect();
    let program = Program {
        name: profile.name.to_owned(),
        version: OnceCell::new(),
        path,
        arguments,
        one_shot: one_shot.is_some(),
        profile: Some(profile),
    };
    Ok(Box::new(Dialogue::new(program, options)))
}

/// A session with any command that reads SMT-LIB from its standard input.
pub(crate) fn open_command(line: &str, options: &Options) -> Result<Box<dyn Session>, Error> {
    let mut words = split_words(line).into_iter();
    let program = words.next().unwrap_or_default();
    let (path, tried) = search(&program);
    let hint =
        "give the name of a known solver (z3, cvc5, yices, bitwuzla, builtin) or of a program".to_owned();
    let path = path.ok_or_else(|| Error::Missing { name: program.clone(), tried, hint })?;
    let name =
        Path::new(&program).file_name().map_or(program.clone(), |name| name.to_string_lossy().into_owned());
    // A command need not know `--version`: what it is stays unknown.
    let version = OnceCell::from(String::new());
    let program = Program { name, version, path, arguments: words.collect(), one_shot: false, profile: None };
    Ok(Box::new(Dialogue::new(program, options)))
}

/// Words between blanks; single or double quotes keep blanks together.
fn split_words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match quote {
            Some(q) if c == q => quote = None,
            None if c == '"' || c == '\'' => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            None if c.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

/// What to run.
struct Program {
    name: String,
    /// Found out when it is asked for: that takes a process.
    version: OnceCell<String>,
    path: PathBuf,
    arguments: Vec<String>,
    /// A process answers one check; the next check starts a new one.
    one_shot: bool,
    profile: Option<&'static Profile>,
}

/// A dialogue with a process, which is started at the first check, and again after one that ended at
/// a deadline.
struct Dialogue {
    program: Program,
    options: Options,
    running: Option<Running>,
    deadline: Deadline,
    has_model: bool,
    told: Size,
}

/// What belongs to one process.
struct Running {
    process: Process,
    printer: Printer,
    transcript: Option<Transcript>,
    /// How many assertions it has been told.
    fed: usize,
    checks: usize,
}

impl Running {
    /// Sends what is in the buffer.
    fn flush(&mut self, text: &mut Vec<u8>, deadline: &Deadline) {
        if let Some(transcript) = &mut self.transcript {
            transcript.keep(text);
        }
        self.process.send(std::mem::take(text), deadline);
    }
}

impl Dialogue {
    fn new(program: Program, options: &Options) -> Dialogue {
        let options = options.clone();
        let deadline = Deadline::never();
        Dialogue { program, options, running: None, deadline, has_model: false, told: Size::default() }
    }

    fn name(&self) -> String {
        self.program.name.clone()
    }

    fn start(&mut self) -> Result<Running, Error> {
        let program = &self.program;
        let process = Process::spawn(&program.path, &program.arguments, self.options.memory_mib);
        let what = || format!("cannot start {}", program.path.display());
        let process = process.map_err(|source| Error::Io { what: what(), source })?;
        let transcript = match &self.options.queries {
            Some(directory) => Some(Transcript::create(directory, &program.name, self.options.status)?),
            None => None,
        };
        Ok(Running { process, printer: Printer::new(), transcript, fed: 0, checks: 0 })
    }

    /// What is said first. The logic is chosen by what is known now, and where more may follow, it
    /// leaves room.
    fn preamble(&self, features: Features) -> String {
        let mut text = String::from("(set-option :print-success false)\n(set-option :produce-models true)\n");
        let seed = self.program.profile.and_then(|profile| profile.seed).filter(|_| self.options.seed != 0);
        if let Some(option) = seed {
            text += &format!("(set-option {option} {})\n", self.options.seed % (1 << 31));
        }
        let quantifiers = features.quantifiers || self.options.quantifiers() > Quantifiers::None;
        // Booleans alone would be QF_UF, for which solvers are slower than for bit-vectors.
        let bitvec = features.bitvec || !features.int && !features.real;
        text += &format!("(set-logic {})\n", logic(&Features { quantifiers, bitvec, ..features }));
        text
    }

    /// Sends what the process does not know yet, and the check.
    fn feed(&self, running: &mut Running, script: &Script, assumptions: &[Term], deadline: &Deadline) {
        let terms = &script.terms;
        running.printer.scan(terms, script.literals(running.fed));
        running.printer.scan(terms, assumptions);
        let mut text = Vec::with_capacity(2 * PIECE);
        if running.checks == 0 {
            text.extend_from_slice(self.preamble(running.printer.features()).as_bytes());
        }
        running.checks += 1;
        // Writing to a vector cannot fail.
        let _ = running.printer.declare(&mut text, terms);
        while running.fed < script.len() {
            let _ = running.printer.assertion(&mut text, terms, script.assertion(running.fed));
            running.fed += 1;
            if text.len() > PIECE {
                running.flush(&mut text, deadline);
                if deadline.passed() || running.process.must_stop() {
                    return;
                }
            }
        }
        let _ = self.ask(running, script, assumptions, &mut text);
        running.flush(&mut text, deadline);
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
        if self.program.one_shot || assumptions.is_empty() {
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

    /// The answer to a check, from what the solver says.
    fn answer(&self, running: &mut Running, deadline: &Deadline) -> Result<Option<Answer>, Error> {
        loop {
            match running.process.next(deadline) {
                Next::Deadline => return Ok(None),
                Next::Ended => return Err(self.crashed(running, "")),
                Next::Reply(reply) => match reply::meaning(&reply) {
                    Meaning::Noise => {}
                    Meaning::Answer(_) if running.process.is_cut() => {
                        return Err(self.misunderstood(running, "assert", reply.text()));
                    }
                    Meaning::Answer(Some(true)) => return Ok(Some(Answer::Sat)),
                    Meaning::Answer(Some(false)) => return Ok(Some(Answer::Unsat)),
                    Meaning::Answer(None) => return Ok(Some(Answer::Unknown(self.reason(running)))),
                    Meaning::Timeout => return Ok(Some(Answer::Unknown("timeout".to_owned()))),
                    Meaning::Error(message) => return Err(reported(self.name(), message)),
                    Meaning::Other => return Err(self.misunderstood(running, "check-sat", reply.text())),
                },
            }
        }
    }

    /// Why the solver said unknown; a solver that does not say so soon is not waited for.
    fn reason(&self, running: &mut Running) -> String {
        let deadline = self.deadline.within(PATIENCE);
        running.process.send(b"(get-info :reason-unknown)\n".to_vec(), &deadline);
        match running.process.next(&deadline) {
            Next::Reply(reply) => reply::reason(&reply).unwrap_or_else(|| "unknown".to_owned()),
            Next::Ended | Next::Deadline => "unknown".to_owned(),
        }
    }

    fn crashed(&self, running: &mut Running, said: &str) -> Error {
        let status = running.process.kill();
        let errors = running.process.last_errors();
        Error::Crashed { name: self.name(), status, last_words: last_words(said, &errors) }
    }

    fn misunderstood(&self, running: &Running, asked: &str, said: &str) -> Error {
        let said = last_words(said, &running.process.last_errors());
        Error::Protocol { name: self.name(), asked: asked.to_owned(), said }
    }

    /// Values of symbols that the solver knows.
    fn ask_values(
        &self,
        running: &mut Running,
        script: &Script,
        symbols: &[Term],
    ) -> Result<Vec<Value>, Error> {
        let mut text = b"(get-value (".to_vec();
        for &symbol in symbols {
            text.push(b' ');
            // Writing to a vector cannot fail.
            let _ = running.printer.term(&mut text, &script.terms, symbol);
        }
        text.extend_from_slice(b"))\n");
        running.flush(&mut text, &self.deadline);
        let reply = loop {
            match running.process.next(&self.deadline) {
                Next::Deadline => return Err(Error::Deadline { name: self.name() }),
                Next::Ended => return Err(self.crashed(running, "")),
                Next::Reply(reply) => match reply::meaning(&reply) {
                    Meaning::Noise => {}
                    Meaning::Error(message) => return Err(reported(self.name(), message)),
                    _ => break reply,
                },
            }
        };
        let values = reply::values(&reply).filter(|values| values.len() == symbols.len());
        let sorted = values.and_then(|values| {
            let pairs = values.into_iter().zip(symbols);
            pairs.map(|(value, &symbol)| reply::of_sort(value, script.terms.sort(symbol))).collect()
        });
        sorted.ok_or_else(|| self.misunderstood(running, "get-value", reply.text()))
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
        for chunk in known.chunks(ASK) {
            let asked: Vec<Term> = chunk.iter().map(|&i| symbols[i].positive()).collect();
            for (&i, value) in chunk.iter().zip(self.ask_values(running, script, &asked)?) {
                values[i] = value;
            }
        }
        for (value, symbol) in values.iter_mut().zip(symbols) {
            if let Value::Bool(b) = value {
                *b ^= symbol.is_negated();
            }
        }
        Ok(values)
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
            return Ok(Answer::Unknown(deadline.reason().to_owned()));
        }
        let assumptions: Vec<Term> = assumptions.iter().copied().filter(|&t| t != Term::TRUE).collect();
        let mut running = match self.running.take() {
            Some(running) if !self.program.one_shot => running,
            _ => self.start()?,
        };
        self.feed(&mut running, script, &assumptions, deadline);
        self.told = Size { clauses: running.fed, variables: running.printer.declared() };
        // On an error or at the deadline the process is dropped, which kills it.
        match self.answer(&mut running, deadline)? {
            Some(answer) => {
                self.has_model = answer == Answer::Sat;
                self.running = Some(running);
                Ok(answer)
            }
            None => Ok(Answer::Unknown(deadline.reason().to_owned())),
        }
    }

    fn values(&mut self, script: &Script, symbols: &[Term]) -> Result<Vec<Value>, Error> {
        let mut running = match self.running.take() {
            Some(running) if self.has_model => running,
            other => {
                self.running = other;
                return Err(Error::NoModel { name: self.name() });
            }
        };
        let values = self.known_values(&mut running, script, symbols)?;
        self.running = Some(running);
        Ok(values)
    }

    fn identity(&self) -> Identity {
        let program = &self.program;
        let version = program.version.get_or_init(|| version(&program.path).unwrap_or_default());
        Identity { name: program.name.clone(), version: version.clone() }
    }

    fn size(&self) -> Size {
        self.told
    }
}

/// The end of what was said on both streams.
fn last_words(said: &str, errors: &str) -> String {
    const LONGEST: usize = 400;
    let words = [said.trim(), errors.trim()].into_iter().filter(|text| !text.is_empty());
    let words = words.collect::<Vec<_>>().join(" / ");
    let skip = words.chars().count().saturating_sub(LONGEST);
    words.chars().skip(skip).collect()
}

/// An error that a solver reported. One that knows no such logic did nothing wrong.
fn reported(name: String, message: String) -> Error {
    let lower = message.to_lowercase();
    let unknown = ["not supported", "unsupported", "unknown logic"].iter().any(|words| lower.contains(words));
    if lower.contains("logic") && unknown {
        return Error::Unsupported { what: format!("solver {name} cannot take this query: {message}") };
    }
    Error::Reported { name, message }
}
