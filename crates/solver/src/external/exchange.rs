//! A process with what was said to it and by it: sending, understanding replies, and telling what went wrong.
//!
//! Replies are matched to commands by their order alone, never by when they come: a solver that answers before it is
//! asked cannot be told from one that is fast, and is treated alike in every run. What it says first is the answer to
//! the first check; a reply that is none to the command whose turn it is is the solver's fault.

use std::time::Duration;

use hyperplan_smt::{Script, Sort, Term, Value, is_large_number, read_value};

use super::process::{Next, Process};
use super::program::Program;
use super::reply::{self, Meaning, Reply};
use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use crate::session::{Answer, Options};
use crate::transcript::Transcript;

/// How long a solver that gave up may take to say why.
const PATIENCE: Duration = Duration::from_secs(1);

/// How long a solver that got the end of its input may take to answer: the time is up already.
const MOMENT: Duration = Duration::from_millis(300);

/// Asks why the answer is not known.
pub(super) const REASON: &[u8] = b"(get-info :reason-unknown)\n";

/// Asks for the version.
pub(super) const VERSION: &[u8] = b"(get-info :version)\n";

/// One process, and the record of the talk.
pub(super) struct Exchange {
    name: String,
    process: Process,
    transcript: Option<Transcript>,
    /// It says what nobody asked for, or does not say what it should: the next check takes a new process.
    lost: bool,
}

impl Exchange {
    /// Starts a program.
    pub(super) fn start(
        program: &Program,
        arguments: &[String],
        options: &Options,
    ) -> Result<Exchange, Error> {
        let process = Process::spawn(&program.path, arguments, options.memory_mib);
        let what = || format!("cannot start {}", program.path.display());
        let process = process.map_err(|source| Error::Io { what: what(), source })?;
        let transcript = match &options.queries {
            Some(directory) => Some(Transcript::create(directory, &program.profile.name, options.status)?),
            None => None,
        };
        Ok(Exchange { name: program.profile.name.clone(), process, transcript, lost: false })
    }

    /// Keeps what the process gets in another way than by [`Exchange::send`].
    pub(super) fn keep(&mut self, text: &[u8]) {
        if let Some(transcript) = &mut self.transcript {
            transcript.keep(text);
        }
    }

    /// Sends a piece, which ends with a whole command.
    pub(super) fn send(&mut self, text: Vec<u8>, deadline: &Deadline) {
        self.keep(&text);
        self.process.send(text, deadline);
    }

    /// Has it say lines of any length: what describes an assignment may be one.
    pub(super) fn take_long_lines(&mut self) {
        self.process.take_long_lines();
    }

    /// How it ended, or has to.
    pub(super) fn end(&mut self) -> String {
        self.process.kill()
    }

    /// There is no more to send.
    pub(super) fn close_input(&mut self) {
        self.process.close_input();
    }

    /// Whether sending more makes no sense.
    pub(super) fn must_stop(&mut self) -> bool {
        self.process.must_stop()
    }

    /// Whether the process can be asked more.
    pub(super) fn is_open(&self) -> bool {
        !self.lost && !self.process.has_ended()
    }

    /// What comes next. That it cannot be kept, or what was sent before, is an error.
    pub(super) fn next(&mut self, deadline: &Deadline) -> Result<Next, Error> {
        if let Some(transcript) = &mut self.transcript {
            transcript.flush()?;
        }
        let next = self.process.next(deadline);
        if let Some(transcript) = &mut self.transcript {
            match &next {
                Next::Reply(reply) => transcript.comment(reply.text()),
                Next::Ended => transcript.comment("(no more output)"),
                Next::Deadline => transcript.comment(&format!("({})", deadline.reason())),
            }
            transcript.flush()?;
        }
        Ok(next)
    }

    /// The answer to a check, from what the solver says; `None` at the deadline.
    pub(super) fn answer(&mut self, deadline: &Deadline) -> Result<Option<Answer>, Error> {
        loop {
            let reply = match self.next(deadline)? {
                Next::Deadline => return Ok(None),
                Next::Ended => return Err(self.crashed()),
                Next::Reply(reply) => reply,
            };
            match reply::meaning(&reply) {
                Meaning::Noise => {}
                // It was not asked: the time was up before that.
                Meaning::Answer(_) if self.process.is_cut() && deadline.passed() => return Ok(None),
                Meaning::Answer(Some(true)) => return Ok(Some(Answer::Sat)),
                Meaning::Answer(Some(false)) => return Ok(Some(Answer::Unsat)),
                Meaning::Answer(None) => return Ok(Some(Answer::Unknown(Unknown::Unsaid))),
                Meaning::Timeout => return Ok(Some(Answer::Unknown(Unknown::Timeout))),
                Meaning::Error(message) => return Err(self.reported(message)),
                Meaning::Other => return Err(self.misunderstood("check-sat", reply.text())),
            }
        }
    }

    /// Of a process that has not answered yet, whether it does once it gets no more input; it has a moment for that, and
    /// cannot be asked any more.
    pub(super) fn answers_at_end(&mut self) -> bool {
        let waits = !self.process.is_cut() && self.is_open();
        self.lost = true;
        self.process.close_input();
        let moment = Deadline::after(MOMENT);
        let answered = |reply: &Reply| matches!(reply::meaning(reply), Meaning::Answer(_));
        waits && matches!(self.next(&moment), Ok(Next::Reply(reply)) if answered(&reply))
    }

    /// Why the solver said unknown, in the reply to [`REASON`] after so many that do not matter. A solver that does not say
    /// so soon is not waited for, and not asked any more.
    pub(super) fn reason(&mut self, after: usize, deadline: &Deadline) -> Result<Unknown, Error> {
        let deadline = deadline.within(PATIENCE);
        for _ in 0..after {
            self.next(&deadline)?;
        }
        let reason = match self.next(&deadline)? {
            Next::Reply(reply) => reply::reason(&reply),
            Next::Ended | Next::Deadline => None,
        };
        self.lost = reason.is_none();
        Ok(reason.map_or(Unknown::Unsaid, Unknown::from))
    }

    /// What the solver says its version is, after [`VERSION`] was sent. One that does not say so soon is not asked any
    /// more.
    pub(super) fn version(&mut self, deadline: &Deadline) -> Result<Option<String>, Error> {
        let version = match self.next(&deadline.within(PATIENCE))? {
            Next::Reply(reply) => Some(reply.text().to_owned()).filter(|text| text.contains(":version")),
            Next::Ended | Next::Deadline => None,
        };
        self.lost = version.is_none();
        Ok(version)
    }

    /// The values in the reply to a `get-value` about those symbols.
    pub(super) fn values(
        &mut self,
        script: &Script,
        symbols: &[Term],
        deadline: &Deadline,
    ) -> Result<Vec<Value>, Error> {
        let reply = loop {
            match self.next(deadline)? {
                Next::Deadline => return Err(Error::Deadline { name: self.name.clone() }),
                Next::Ended => return Err(self.crashed()),
                Next::Reply(reply) => match reply::meaning(&reply) {
                    Meaning::Noise => {}
                    Meaning::Error(message) => return Err(self.reported(message)),
                    Meaning::Answer(_) | Meaning::Timeout => return Err(self.early(reply.text())),
                    Meaning::Other => break reply,
                },
            }
        };
        let texts = reply::values(&reply).filter(|values| values.len() == symbols.len());
        let terms = &script.terms;
        let mut values = Vec::with_capacity(symbols.len());
        for (text, &symbol) in texts.iter().flatten().zip(symbols) {
            let sort = terms.sort(symbol);
            match read_value(terms, sort, text) {
                Some(value) => values.push(value),
                None if matches!(sort, Sort::Int | Sort::Real) && is_large_number(text) => {
                    return Err(Error::LargeNumber { name: self.name.clone() });
                }
                None => return Err(self.misunderstood("get-value", reply.text())),
            }
        }
        match texts {
            Some(_) => Ok(values),
            None => Err(self.misunderstood("get-value", reply.text())),
        }
    }

    /// It ended without the reply that was due.
    fn crashed(&mut self) -> Error {
        self.crashed_after("")
    }

    /// It ended without an answer, and said this last.
    pub(super) fn crashed_after(&mut self, said: &str) -> Error {
        let status = self.process.kill();
        let said = last_words(said, &self.process.last_errors());
        if let Some(transcript) = &mut self.transcript {
            transcript.comment(&format!("({status})"));
            transcript.comment(&said);
        }
        if tells_of_memory(&said) {
            return Error::Memory { name: self.name.clone() };
        }
        Error::Crashed { name: self.name.clone(), status, last_words: said }
    }

    /// What it says is no reply to what was asked. The process is of no more use.
    fn misunderstood(&mut self, asked: &str, said: &str) -> Error {
        self.lost = true;
        // What it has to say on standard error is worth waiting for.
        self.process.kill();
        let said = last_words(said, &self.process.last_errors());
        if tells_of_memory(&said) {
            return Error::Memory { name: self.name.clone() };
        }
        Error::Protocol { name: self.name.clone(), asked: asked.to_owned(), said }
    }

    /// It answered a check that it was not asked.
    fn early(&mut self, said: &str) -> Error {
        match self.misunderstood("", said) {
            Error::Protocol { name, said, .. } => Error::Early { name, said },
            error => error,
        }
    }

    /// An error that the solver reported. One that knows no such logic did nothing wrong.
    fn reported(&self, message: String) -> Error {
        let name = self.name.clone();
        let lower = message.to_lowercase();
        let says = |words: &[&str]| words.iter().any(|words| lower.contains(words));
        if tells_of_memory(&message) {
            return Error::Memory { name };
        }
        if lower.contains("logic") && says(&["not supported", "unsupported", "unknown logic"]) {
            return Error::Unsupported { what: format!("solver {name} cannot take this query: {message}") };
        }
        Error::Reported { name, message }
    }
}

/// Whether that is what programs say when they get no more memory.
fn tells_of_memory(text: &str) -> bool {
    let lower = text.to_lowercase();
    let signs =
        ["out of memory", "out-of-memory", "memory exhausted", "bad_alloc", "allocate memory", "memoryerror"];
    signs.iter().any(|words| lower.contains(words)) || lower.trim() == "memout"
}

/// The end of what was said on both streams.
fn last_words(said: &str, errors: &str) -> String {
    const LONGEST: usize = 400;
    let words = [said.trim(), errors.trim()].into_iter().filter(|text| !text.is_empty());
    let words = words.collect::<Vec<_>>().join(" / ");
    let skip = words.chars().count().saturating_sub(LONGEST);
    words.chars().skip(skip).collect()
}
