//! What is said in a search by counterexamples, or asked of a strategy step by step, as one incremental benchmark.
//!
//! The outermost search speaks at the bottom of the assertion stack. The search for what defeats a candidate speaks
//! above it, between `push` and `pop`: its symbols are others, and what lies below is satisfiable, so the answers are
//! those that it was given. Every check has its answer for `:status`.

use crate::fact::Error;
use crate::oracle::Listener;
use hyperplan_smt::{Features, Printer, Script, Status, Term, write_comment};
use std::io::{self, Seek as _, Write};
use tempfile::SpooledTempFile;

/// How many bytes stay in memory.
const IN_MEMORY: usize = 1 << 24;

/// The text so far, and what each open dialogue has said.
pub(super) struct Tape {
    text: SpooledTempFile,
    open: Vec<Scope>,
    /// How many dialogues there were.
    dialogues: u32,
    features: Features,
    comments: bool,
    pub(super) checks: usize,
    pub(super) symbols: usize,
    pub(super) assertions: usize,
    /// The first failure; nothing is written after it.
    failure: Option<io::Error>,
}

struct Scope {
    printer: Printer,
    fed: usize,
}

impl Tape {
    pub(super) fn new(comments: bool) -> Self {
        Tape {
            text: SpooledTempFile::new(IN_MEMORY),
            open: Vec::new(),
            dialogues: 0,
            features: Features::default(),
            comments,
            checks: 0,
            symbols: 0,
            assertions: 0,
            failure: None,
        }
    }

    pub(super) fn features(&self) -> Features {
        self.features
    }

    fn say(&mut self, scope: &mut Scope, script: &Script, satisfiable: bool) -> io::Result<()> {
        // One piece of text at a time: what is spooled is not buffered.
        let mut text = Vec::new();
        self.feed(scope, script, &mut text)?;
        self.ask(&mut text, satisfiable)
    }

    /// Says what is new in a script; what is not written yet is in `text`.
    fn feed(&mut self, scope: &mut Scope, script: &Script, text: &mut Vec<u8>) -> io::Result<()> {
        let (terms, printer) = (&script.terms, &mut scope.printer);
        printer.scan(terms, script.literals(scope.fed));
        self.features = self.features.union(printer.features());
        let declared = printer.declared();
        printer.declare(text, terms)?;
        self.symbols += printer.declared() - declared;
        let mut sections = script.sections().filter(|(at, _)| *at >= scope.fed).peekable();
        for (index, literals) in (scope.fed..).zip(script.assertions(scope.fed)) {
            while let Some((_, section)) = sections.next_if(|(at, _)| *at <= index) {
                if self.comments {
                    write_comment(text, &section.text)?;
                }
            }
            printer.assertion(text, terms, literals)?;
            self.assertions += 1;
            if text.len() > 1 << 16 {
                self.text.write_all(text)?;
                text.clear();
            }
        }
        scope.fed = script.len();
        Ok(())
    }

    /// Asks for an answer, after the text.
    fn ask(&mut self, text: &mut Vec<u8>, satisfiable: bool) -> io::Result<()> {
        self.checks += 1;
        let status = if satisfiable { Status::Sat } else { Status::Unsat };
        writeln!(text, "(set-info :status {})", status.text())?;
        text.extend_from_slice(b"(check-sat)\n");
        self.text.write_all(text)
    }

    /// A first check, of all that is in a script, with its answer.
    pub(super) fn begin(&mut self, script: &Script, satisfiable: bool) {
        self.opened();
        self.checked(script, satisfiable);
    }

    /// Says what is new in the innermost dialogue's script, and asks for something besides, which is forgotten after the
    /// answer.
    pub(super) fn aside(&mut self, script: &Script, besides: Term, satisfiable: bool, what: &str) {
        let Some(mut scope) = self.open.pop() else { return };
        self.keep(|tape| {
            let terms = &script.terms;
            let mut text = Vec::new();
            tape.feed(&mut scope, script, &mut text)?;
            // What is declared and defined after `push` would be forgotten as well.
            scope.printer.scan(terms, &[besides]);
            tape.features = tape.features.union(scope.printer.features());
            let declared = scope.printer.declared();
            scope.printer.declare(&mut text, terms)?;
            tape.symbols += scope.printer.declared() - declared;
            scope.printer.define(&mut text, terms, &[besides])?;
            text.extend_from_slice(b"(push 1)\n");
            if tape.comments {
                write_comment(&mut text, what)?;
            }
            scope.printer.assertion(&mut text, terms, &[besides])?;
            tape.assertions += 1;
            tape.ask(&mut text, satisfiable)?;
            tape.text.write_all(b"(pop 1)\n")
        });
        self.open.push(scope);
    }

    fn keep(&mut self, write: impl FnOnce(&mut Self) -> io::Result<()>) {
        if self.failure.is_none() {
            self.failure = write(self).err();
        }
    }

    /// Writes what was said.
    pub(super) fn copy(&mut self, mut to: &mut dyn Write) -> io::Result<()> {
        self.text.rewind()?;
        io::copy(&mut self.text, &mut to).map(|_| ())
    }

    /// The tape, unless something could not be kept.
    pub(super) fn finished(mut self) -> Result<Self, Error> {
        while self.open.len() > 1 {
            self.closed();
        }
        match self.failure.take() {
            None => Ok(self),
            Some(error) => Err(Error::Tape(error)),
        }
    }
}

impl Listener for Tape {
    fn opened(&mut self) {
        if !self.open.is_empty() {
            self.keep(|tape| tape.text.write_all(b"(push 1)\n"));
        }
        let printer = Printer::numbered(self.dialogues, self.open.last().map(|scope| &scope.printer));
        self.dialogues += 1;
        self.open.push(Scope { printer, fed: 0 });
    }

    fn closed(&mut self) {
        self.open.pop();
        if !self.open.is_empty() {
            self.keep(|tape| tape.text.write_all(b"(pop 1)\n"));
        }
    }

    fn checked(&mut self, script: &Script, satisfiable: bool) {
        let Some(mut scope) = self.open.pop() else { return };
        self.keep(|tape| tape.say(&mut scope, script, satisfiable));
        self.open.push(scope);
    }
}
