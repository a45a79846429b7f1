//! What solvers say: splitting their output into replies, and reading those.

use std::collections::VecDeque;

use hyperplan_smt::{Rational, Sort, Terms, Value};
use rsmt2::parse::SmtParser;

use super::sexpr::parts;

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

#[derive(Copy, Clone, PartialEq, Eq, Debug, Default)]
enum State {
    #[default]
    Between,
    Line,
    Comment,
    Code,
    Quoted,
    Text,
    CodeComment,
}

/// Splits output as it comes. Comments and carriage returns outside of quotes are dropped.
#[derive(Default)]
pub(super) struct Splitter {
    state: State,
    depth: usize,
    current: Vec<u8>,
    replies: VecDeque<Reply>,
    errors: usize,
}

/// A reply longer than this is given up: it becomes a line, which no command has for an answer.
const LONGEST: usize = 1 << 28;
/// The same for what is a line from the start.
const LONGEST_LINE: usize = 1 << 16;

impl Splitter {
    pub(super) fn feed(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.byte(byte);
            let longest = if self.state == State::Line { LONGEST_LINE } else { LONGEST };
            if self.current.len() > longest {
                self.current.truncate(200);
                self.emit_line();
            }
        }
    }

    fn byte(&mut self, byte: u8) {
        self.state = match (self.state, byte) {
            (State::Between, b' ' | b'\t' | b'\r' | b'\n') => State::Between,
            (State::Between, b';') => State::Comment,
            (State::Between, b'(') => {
                self.depth = 1;
                self.current.push(byte);
                State::Code
            }
            (State::Line | State::Comment, b'\n') => {
                self.emit_line();
                State::Between
            }
            (State::Line, b';') | (State::Comment, _) => State::Comment,
            (State::Between | State::Line, _) => {
                self.current.push(byte);
                State::Line
            }
            (State::Code, b';') => State::CodeComment,
            (State::CodeComment, b'\n') => {
                self.current.push(b' ');
                State::Code
            }
            (State::CodeComment, _) => State::CodeComment,
            (state, _) => {
                self.current.push(byte);
                self.inside(state, byte)
            }
        };
    }

    /// One byte inside of parentheses.
    fn inside(&mut self, state: State, byte: u8) -> State {
        match (state, byte) {
            (State::Code, b'(') => self.depth += 1,
            (State::Code, b')') => {
                self.depth -= 1;
                if self.depth == 0 {
                    self.emit(Reply::Expression);
                    return State::Between;
                }
            }
            (State::Code, b'"') => return State::Text,
            (State::Code, b'|') => return State::Quoted,
            (State::Text, b'"') | (State::Quoted, b'|') => return State::Code,
            _ => {}
        }
        state
    }

    /// The output has ended.
    pub(super) fn finish(&mut self) {
        self.emit_line();
    }

    fn emit_line(&mut self) {
        self.state = State::Between;
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

    /// What was not taken yet.
    pub(super) fn replies(&self) -> impl Iterator<Item = &Reply> {
        self.replies.iter()
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
            // rsmt2 reads prefixes, so that the whole word is compared here first.
            "sat" | "unsat" | "unknown" => match SmtParser::of_str(line).check_sat() {
                Ok(answer) => Meaning::Answer(answer),
                Err(_) => Meaning::Other,
            },
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
    // rsmt2 counts bytes, and parentheses in strings: what it cannot read is shown as it is.
    if text.is_ascii()
        && !text[1..text.len() - 1].contains(['(', ')', '|', ';', '\\'])
        && let Err(error) = SmtParser::of_str(text).try_error()
        && let rsmt2::errors::ErrorKind::SolverError(message) = error.kind()
    {
        return message.trim().to_owned();
    }
    let inner = text.trim_start_matches('(').trim_start().trim_start_matches("error");
    inner.trim_end_matches(')').trim().trim_matches('"').trim().to_owned()
}

/// The values in the reply to `get-value`, in order, as they are written: it is a list of pairs of a symbol, which does
/// not matter here, and its value. rsmt2 is not asked, since it counts bytes where it means characters, and panics
/// where a parenthesis is too many.
pub(super) fn values(reply: &Reply) -> Option<Vec<&str>> {
    let Reply::Expression(text) = reply else { return None };
    let pairs = parts(text)?.into_iter().map(|pair| match parts(pair)?.as_slice() {
        [_, text] => Some(*text),
        _ => None,
    });
    pairs.collect()
}

/// The value of that sort that is written so.
pub(super) fn value_of_sort(terms: &Terms, sort: Sort, text: &str) -> Option<Value> {
    match sort {
        Sort::Enum(enumeration) => terms.constructor_called(enumeration, text),
        sort => of_sort(value(text)?, sort),
    }
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

/// A value in any notation.
pub(super) fn value(text: &str) -> Option<Value> {
    match text {
        "true" => return Some(Value::Bool(true)),
        "false" => return Some(Value::Bool(false)),
        _ => {}
    }
    if let Some(digits) = text.strip_prefix("#b") {
        let bits = u128::from_str_radix(digits, 2).ok()?;
        return vector(u32::try_from(digits.len()).ok()?, bits);
    }
    if let Some(digits) = text.strip_prefix("#x") {
        let bits = u128::from_str_radix(digits, 16).ok()?;
        return vector(u32::try_from(digits.len()).ok()?.checked_mul(4)?, bits);
    }
    let spaced = text.replace('(', " ( ").replace(')', " ) ");
    let tokens: Vec<&str> = spaced.split_whitespace().collect();
    if let ["(", "_", constant, width, ")"] = tokens[..] {
        let bits = constant.strip_prefix("bv")?.parse().ok()?;
        return vector(width.parse().ok()?, bits);
    }
    // The longest has two signs: `(- (/ (- 1) (- 3)))`.
    if tokens.len() > 20 { None } else { number(&tokens) }
}

/// A bit-vector, unless the bits are more than the width.
fn vector(width: u32, bits: u128) -> Option<Value> {
    let vector = Value::Bv { width, bits };
    let fits = (1..=128).contains(&width) && bits.leading_zeros() >= 128 - width;
    fits.then_some(vector)
}

/// An integer or rational: digits, a decimal, and at most a few levels of `-` and `/`.
fn number(tokens: &[&str]) -> Option<Value> {
    match tokens {
        [digits] => match digits.split_once('.') {
            None => Some(Value::Int(digits.parse().ok()?)),
            Some((whole, fraction)) => {
                let fraction = fraction.trim_end_matches('0');
                let denominator = 10_i128.checked_pow(u32::try_from(fraction.len()).ok()?)?;
                let numerator = format!("{whole}{fraction}").parse().ok()?;
                Some(Value::Real(Rational::new(numerator, denominator)?))
            }
        },
        ["(", "-", inner @ .., ")"] => match number(inner)? {
            Value::Int(i) => Some(Value::Int(i.checked_neg()?)),
            Value::Real(r) => Some(Value::Real(r.checked_mul(Rational::from(-1))?)),
            _ => None,
        },
        ["(", "/", inner @ .., ")"] => {
            let split = if inner.first() == Some(&"(") { 4 } else { 1 };
            let (a, b) = inner.split_at_checked(split)?;
            let (a, b) = (real(number(a)?)?, real(number(b)?)?);
            Some(Value::Real(a.checked_mul(Rational::new(b.denominator(), b.numerator())?)?))
        }
        _ => None,
    }
}

fn real(value: Value) -> Option<Rational> {
    match value {
        Value::Int(i) => Rational::new(i, 1),
        Value::Real(r) => Some(r),
        _ => None,
    }
}

/// The value as one of that sort: whole numbers are reals too.
fn of_sort(value: Value, sort: Sort) -> Option<Value> {
    match (value, sort) {
        (Value::Int(_), Sort::Real) => real(value).map(Value::Real),
        (Value::Real(r), Sort::Int) if r.denominator() == 1 => Some(Value::Int(r.numerator())),
        _ => (value.sort() == sort).then_some(value),
    }
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
        let values: Option<Vec<Option<Value>>> =
            values(&reply).map(|texts| texts.into_iter().map(value).collect());
        let all_of = |sort| -> Option<Vec<Value>> {
            values.iter().flatten().map(|value| of_sort((*value)?, sort)).collect()
        };
        let (integers, reals) = (all_of(Sort::Int), all_of(Sort::Real));
        format!("{reply:?}: {meaning:?}, {reason:?}, {values:?}, {integers:?}, {reals:?}")
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
    fn reads_values() {
        let of = |text: &str| -> Option<Vec<Value>> {
            let replies = split(text);
            values(replies.first()?)?.into_iter().map(value).collect()
        };
        let bv = |value, width| Value::bv(value, width);
        assert_eq!(
            of("((x #b0101) (|a b| #x0F)\n (y (_ bv5 8)))"),
            Some(vec![bv(5, 4), bv(15, 8), bv(5, 8)])
        );
        assert_eq!(of("((x true)(y\r\n false))"), Some(vec![Value::Bool(true), Value::Bool(false)]));
        assert_eq!(of("((|\u{e4})| 7) (y (- 3)))"), Some(vec![Value::Int(7), Value::Int(-3)]));
        let fraction = |n, d| Value::Real(Rational::new(n, d).expect("small"));
        assert_eq!(of("((x (/ 1.0 3.0)) (y (- (/ 1 6))))"), Some(vec![fraction(1, 3), fraction(-1, 6)]));
        assert_eq!(of("((x (/ (- 2) 4)) (y 2.50))"), Some(vec![fraction(-1, 2), fraction(5, 2)]));
        assert_eq!(of("((x (lambda (y) y)))"), None);
        assert_eq!(of("(error \"bad\")"), None);
        assert_eq!(of("((x (/ 1 0)))"), None);
        for damaged in
            ["(x) 1", "((x 1)", "((x 1 2))", "((x))", "(x 1)", "((a) b) c)", "((x (- 1)) (y)) (z 1))"]
        {
            assert_eq!(of(damaged), None, "{damaged}");
        }
        assert_eq!(of("((x (_ bv5 2)))"), None);
        assert_eq!(of("((x (_ bv5 129)))"), None);
        assert_eq!(of("((x (_ bv0 0)))"), None);
        let deep = format!("((x {}1{}))", "(- ".repeat(200_000), ")".repeat(200_000));
        assert_eq!(of(&deep), None);
        assert_eq!(of_sort(Value::Int(2), Sort::Real), Some(fraction(2, 1)));
        assert_eq!(of_sort(Value::Int(2), Sort::Bool), None);
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
