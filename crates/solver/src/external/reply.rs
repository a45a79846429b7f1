//! What solvers say: splitting their output into replies, and reading those.

use std::collections::VecDeque;

use hyperplan_smt::{Context, Sort, Terms, parts, read_value};

/// A reply: a line that does not begin with a parenthesis, or a whole s-expression.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Reply {
    Line(String),
    Expression(String),
}

impl Reply {
    pub(super) fn text(&self) -> &str {
        match self {
            Reply::Line(text) | Reply::Expression(text) => text,
        }
    }

    fn is_error(&self) -> bool {
        matches!(self, Reply::Expression(text) if text[1..].trim_start().starts_with("error"))
    }
}

/// Splits output as it comes. Comments and carriage returns outside of quotes are dropped.
#[derive(Default)]
pub(super) struct Splitter {
    /// How many parentheses are open.
    depth: usize,
    context: Context,
    current: Vec<u8>,
    replies: VecDeque<Reply>,
    errors: usize,
    has_long_lines: bool,
}

/// A reply longer than this is given up: it becomes a line, which no command has for an answer.
const LONGEST: usize = 1 << 28;
/// The same for what is a line from the start.
const LONGEST_LINE: usize = 1 << 16;

impl Splitter {
    pub(super) fn feed(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.byte(byte);
            let longest = if self.depth == 0 && !self.has_long_lines { LONGEST_LINE } else { LONGEST };
            if self.current.len() > longest {
                self.current.truncate(200);
                self.emit_line();
            }
        }
    }

    /// Lines may be as long as other replies.
    pub(super) fn take_long_lines(&mut self) {
        self.has_long_lines = true;
    }

    fn byte(&mut self, byte: u8) {
        if self.depth == 0 {
            return self.outside(byte);
        }
        let after = self.context.after(byte);
        let before = std::mem::replace(&mut self.context, after);
        match (before, after) {
            (Context::Comment, Context::Code) => self.current.push(b' '),
            (_, Context::Comment) => {}
            (Context::Code, Context::Code) => {
                self.current.push(byte);
                match byte {
                    b'(' => self.depth += 1,
                    b')' => self.depth -= 1,
                    _ => {}
                }
                if self.depth == 0 {
                    self.emit(Reply::Expression);
                }
            }
            _ => self.current.push(byte),
        }
    }

    /// A byte that is in no parentheses: quotes mean nothing in a line.
    fn outside(&mut self, byte: u8) {
        match byte {
            b'\n' => self.emit_line(),
            _ if self.context == Context::Comment => {}
            b';' => self.context = Context::Comment,
            b' ' | b'\t' | b'\r' if self.current.is_empty() => {}
            _ => {
                self.depth = usize::from(byte == b'(' && self.current.is_empty());
                self.current.push(byte);
            }
        }
    }

    /// The output has ended.
    pub(super) fn finish(&mut self) {
        self.emit_line();
    }

    fn emit_line(&mut self) {
        (self.depth, self.context) = (0, Context::Code);
        self.emit(Reply::Line);
    }

    fn emit(&mut self, kind: fn(String) -> Reply) {
        let text = String::from_utf8_lossy(&self.current).trim().to_owned();
        self.current.clear();
        if !text.is_empty() {
            let reply = kind(text);
            self.errors += usize::from(reply.is_error());
            self.replies.push_back(reply);
        }
    }

    pub(super) fn next(&mut self) -> Option<Reply> {
        let reply = self.replies.pop_front()?;
        self.errors -= usize::from(reply.is_error());
        Some(reply)
    }

    pub(super) fn unread(&self) -> usize {
        self.replies.len()
    }

    pub(super) fn has_error(&self) -> bool {
        self.errors > 0
    }
}

/// What a reply to a check means.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Meaning {
    /// `sat`, `unsat` or (`None`) `unknown`.
    Answer(Option<bool>),
    /// The solver's own time limit.
    Timeout,
    /// An error, with its message.
    Error(String),
    /// Something that may come before an answer: a warning, `success`, `unsupported`.
    Noise,
    /// Anything else.
    Other,
}

/// Understands a reply to a check.
pub(super) fn meaning(reply: &Reply) -> Meaning {
    match reply {
        Reply::Line(line) => match line.as_str() {
            "sat" => Meaning::Answer(Some(true)),
            "unsat" => Meaning::Answer(Some(false)),
            "unknown" => Meaning::Answer(None),
            "timeout" => Meaning::Timeout,
            "success" | "unsupported" => Meaning::Noise,
            line if line.to_ascii_lowercase().contains("warning") => Meaning::Noise,
            _ => Meaning::Other,
        },
        Reply::Expression(text) if reply.is_error() => Meaning::Error(error_message(text)),
        Reply::Expression(_) => Meaning::Other,
    }
}

/// The message in `(error "...")`.
fn error_message(text: &str) -> String {
    let inner = text.trim_start_matches('(').trim_start().trim_start_matches("error");
    inner.trim_end_matches(')').trim().trim_matches('"').trim().to_owned()
}

/// The values in the reply to `get-value`, in order, as they are written: it is a list of pairs of a symbol, which does
/// not matter here, and its value.
pub(super) fn values(reply: &Reply) -> Option<Vec<&str>> {
    let Reply::Expression(text) = reply else { return None };
    let pairs = parts(text)?.into_iter().map(|pair| match parts(pair)?.as_slice() {
        [_, text] => Some(*text),
        _ => None,
    });
    pairs.collect()
}

/// The reason in the reply to `(get-info :reason-unknown)`.
pub(super) fn reason(reply: &Reply) -> Option<String> {
    let Reply::Expression(text) = reply else { return None };
    let inner = text.strip_prefix('(')?.strip_suffix(')')?.trim();
    let reason = inner.strip_prefix(":reason-unknown")?.trim().trim_matches('"').trim();
    // `(incomplete)` is what is meant by the one in parentheses; those in a sentence belong to it.
    let whole = reason.strip_prefix('(').and_then(|rest| rest.strip_suffix(')'));
    Some(whole.unwrap_or(reason).to_owned())
}

/// What is understood of output that comes in pieces of so many bytes, reply by reply. For tests that try strange
/// outputs; no part of the interface.
#[doc(hidden)]
#[must_use]
pub fn understand_output(output: &[u8], piece: usize) -> Vec<String> {
    let mut splitter = Splitter::default();
    output.chunks(piece.max(1)).for_each(|piece| splitter.feed(piece));
    splitter.finish();
    let describe = |reply: Reply| {
        let (meaning, reason) = (meaning(&reply), reason(&reply));
        let terms = Terms::new();
        let read = |text| {
            [Sort::Bool, Sort::BitVec(8), Sort::Int, Sort::Real].map(|sort| read_value(&terms, sort, text))
        };
        let values: Option<Vec<_>> = values(&reply).map(|texts| texts.into_iter().map(read).collect());
        format!("{reply:?}: {meaning:?}, {reason:?}, {values:?}")
    };
    std::iter::from_fn(|| splitter.next()).map(describe).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(text: &str) -> Vec<Reply> {
        let mut splitter = Splitter::default();
        // Byte by byte: pieces may end anywhere.
        for byte in text.bytes() {
            splitter.feed(&[byte]);
        }
        splitter.finish();
        std::iter::from_fn(|| splitter.next()).collect()
    }

    #[test]
    fn splits_replies() {
        let line = |text: &str| Reply::Line(text.to_owned());
        let expression = |text: &str| Reply::Expression(text.to_owned());
        assert_eq!(split("\r\n\nsat\r\n"), [line("sat")]);
        assert_eq!(split("; hello\nunsat ; (why)"), [line("unsat")]);
        assert_eq!(split("unsupported\n; ignored\nsat\n"), [line("unsupported"), line("sat")]);
        assert_eq!(split("(a (b |)|)\n \")(\")sat"), [expression("(a (b |)|)\n \")(\")"), line("sat")]);
        assert_eq!(split("(a ; )\n)"), [expression("(a  )")]);
        assert_eq!(split(")\n(open"), [line(")"), line("(open")]);
    }

    #[test]
    fn understands_answers() {
        let of = |text: &str| split(text).iter().map(meaning).collect::<Vec<_>>();
        assert_eq!(of("sat"), [Meaning::Answer(Some(true))]);
        assert_eq!(of("unsat\n"), [Meaning::Answer(Some(false))]);
        assert_eq!(of("unknown"), [Meaning::Answer(None)]);
        assert_eq!(of("satisfied"), [Meaning::Other]);
        assert_eq!(of("WARNING: x\n"), [Meaning::Noise]);
        assert_eq!(of("(error \"no such logic\")"), [Meaning::Error("no such logic".to_owned())]);
        assert_eq!(of("(error \"a ) b (\")"), [Meaning::Error("a ) b (".to_owned())]);
        assert_eq!(of("( error \"\u{e4}\")"), [Meaning::Error("\u{e4}".to_owned())]);
    }

    #[test]
    fn finds_values() {
        let of = |text: &str| -> Option<Vec<String>> {
            let replies = split(text);
            Some(values(replies.first()?)?.into_iter().map(str::to_owned).collect())
        };
        let some = |texts: &[&str]| Some(texts.iter().map(|&text| text.to_owned()).collect());
        assert_eq!(of("((x #b0101) (|a b| #x0F)\n (y (_ bv5 8)))"), some(&["#b0101", "#x0F", "(_ bv5 8)"]));
        assert_eq!(of("((x true)(y\r\n false))"), some(&["true", "false"]));
        assert_eq!(of("((|\u{e4})| 7) (y (- 3)))"), some(&["7", "(- 3)"]));
        for damaged in [
            "(error \"bad\")",
            "(x) 1",
            "((x 1)",
            "((x 1 2))",
            "((x))",
            "(x 1)",
            "((a) b) c)",
            "((x (- 1)) (y)) (z 1))",
        ] {
            assert_eq!(of(damaged), None, "{damaged}");
        }
    }

    #[test]
    fn reads_reasons() {
        let of = |text: &str| split(text).first().and_then(reason);
        assert_eq!(of("(:reason-unknown \"incomplete\")"), Some("incomplete".to_owned()));
        assert_eq!(
            of("(:reason-unknown (incomplete quantifiers))"),
            Some("incomplete quantifiers".to_owned())
        );
    }
}
