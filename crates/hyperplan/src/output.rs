//! Standard output and standard error: results go to the one, everything else to the other.

use crate::failure::{Failure, Result};
use crate::files::reason;
use hyperplan_outlet::one_line;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};

/// Where a command prints.
pub(crate) struct Output {
    stdout: io::BufWriter<io::Stdout>,
    /// The reader has gone (`| head`): nothing more needs printing, and nothing is wrong.
    closed: bool,
    quiet: bool,
    /// Colors on standard output.
    pub(crate) color: bool,
    /// Colors on standard error.
    pub(crate) color_errors: bool,
}

impl Output {
    /// Colors are used where asked for, or where a terminal can show them.
    pub(crate) fn new(quiet: bool, color: Option<bool>) -> Self {
        let wanted = |terminal: bool| color.unwrap_or(terminal && std::env::var_os("NO_COLOR").is_none());
        let color = wanted(io::stdout().is_terminal());
        let color_errors = wanted(io::stderr().is_terminal());
        Output { stdout: io::BufWriter::new(io::stdout()), closed: false, quiet, color, color_errors }
    }

    /// Whether nothing but results is wanted.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// How many characters a line of standard output has room for, where it is a terminal.
    pub(crate) fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(io::stdout())?;
        Some(width.0.into())
    }

    /// Whether the reader of standard output has gone.
    pub(crate) fn is_closed(&self) -> bool {
        self.closed
    }

    /// Prints a result and a line break.
    pub(crate) fn line(&mut self, text: impl Display) -> Result<()> {
        self.write(|out| writeln!(out, "{text}"))?;
        // A result that took minutes should be seen at once.
        self.flush()
    }

    /// Prints a result as it is.
    pub(crate) fn write(&mut self, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
        if self.closed {
            return Ok(());
        }
        let done = print(&mut self.stdout);
        self.settle(done)
    }

    /// Prints text of others as it is, but for what would do something to a terminal where there is one.
    pub(crate) fn verbatim(&mut self, text: &str) -> Result<()> {
        if !io::stdout().is_terminal() {
            return self.write(|out| out.write_all(text.as_bytes()));
        }
        text.lines().try_for_each(|line| self.line(one_line(line)))
    }

    /// Sends what is still in the buffer.
    pub(crate) fn flush(&mut self) -> Result<()> {
        if self.closed {
            return Ok(());
        }
        let done = self.stdout.flush();
        self.settle(done)
    }

    fn settle(&mut self, done: io::Result<()>) -> Result<()> {
        match done {
            Err(e) if e.kind() == io::ErrorKind::BrokenPipe => {
                self.closed = true;
                Ok(())
            }
            other => other
                .map_err(|e| Failure::input(format_args!("cannot write standard output: {}", reason(&e)))),
        }
    }

    /// Prints a remark on standard error, on one line, unless remarks are not wanted.
    pub(crate) fn remark(&self, text: impl Display) {
        if !self.quiet {
            self.error(text);
        }
    }

    /// Prints a message on standard error, on one line, whatever is in the names and words of others that it tells.
    pub(crate) fn error(&self, text: impl Display) {
        self.lines(one_line(&text.to_string()));
    }

    /// Prints lines on standard error in which what is of others was made harmless. There is nothing left to do if they
    /// cannot be written.
    pub(crate) fn lines(&self, text: impl Display) {
        let _ = writeln!(io::stderr().lock(), "{text}");
    }

    /// Says why a command failed, or a part of it.
    pub(crate) fn failure(&self, failure: &Failure) {
        if !failure.message.is_empty() {
            self.error(format_args!("error: {}", failure.message));
        }
        if !failure.details.is_empty() {
            self.lines(format_args!("\n{}", failure.details));
        }
    }
}
