//! From text to tokens, of SMV and of the formula languages alike.

use hyperplan_syntax::{Diagnostic, SourceId, Span};

/// What was read, or the message about what cannot be.
pub(crate) type Parse<T> = Result<T, Box<Diagnostic>>;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tok {
    /// A name or keyword.
    Word,
    Number,
    /// `0ud8_255`
    WordNumber,
    /// `"..."`
    Text,
    Sign,
    Eof,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    pub(crate) tok: Tok,
    pub(crate) text: &'a str,
    pub(crate) span: Span,
}

/// Longer signs before their beginnings.
const SIGNS: &[&str] = &[
    "<->", "<=>", ":=", "..", "::", "->", "=>", "!=", "<=", ">=", "<<", ">>", "/\\", "\\/", "&&", "||", "==",
    "@", ":", ".", "=", "<", ">", "+", "-", "*", "/", "&", "|", "!", "~", "?", "¬", "∧", "∨", "→", "↔", "∃",
    "∀",
];

/// The tokens of a text, the last of which is the end; or what cannot be read.
pub(crate) fn lex(source: SourceId, text: &str) -> Parse<Vec<Token<'_>>> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let bytes = text.as_bytes();
    let mut at = 0;
    loop {
        at = skip(source, text, at)?;
        let rest = &text[at..];
        let span = |length: usize| Span::new(source, at..at + length);
        let Some(&first) = bytes.get(at) else {
            tokens.push(Token { tok: Tok::Eof, text: "", span: span(0) });
            return Ok(tokens);
        };
        let (tok, length) = match first {
            b'0'..=b'9' => number(rest),
            b'"' => match rest[1..].find(['"', '\n']) {
                Some(end) if bytes[at + 1 + end] == b'"' => (Tok::Text, end + 2),
                _ => {
                    let message = "this string has no closing `\"`";
                    return Err(Box::new(Diagnostic::error("unclosed-string", span(1), message)));
                }
            },
            c if c.is_ascii_alphabetic() || c == b'_' => (Tok::Word, word(rest)),
            _ => match sign(rest) {
                Some(length) => (Tok::Sign, length),
                None => {
                    let found = rest.chars().next().unwrap_or_default();
                    let message = format!("unexpected character `{}`", found.escape_debug());
                    return Err(Box::new(Diagnostic::error(
                        "bad-character",
                        span(found.len_utf8()),
                        message,
                    )));
                }
            },
        };
        tokens.push(Token { tok, text: &rest[..length], span: span(length) });
        at += length;
    }
}

/// How long the sign at the beginning is.
fn sign(text: &str) -> Option<usize> {
    // Most signs are one character, and cannot begin another.
    if matches!(text.as_bytes()[0], b'(' | b')' | b'{' | b'}' | b'[' | b']' | b',' | b';') {
        return Some(1);
    }
    SIGNS.iter().find(|sign| text.starts_with(**sign)).map(|sign| sign.len())
}

/// Behind blanks and comments, which are `--` to the end of the line, `//` as well, and `/-- ... --/`.
fn skip(source: SourceId, text: &str, mut at: usize) -> Parse<usize> {
    loop {
        let rest = &text[at..];
        let blanks = rest.len() - rest.trim_start().len();
        if blanks > 0 {
            at += blanks;
        } else if rest.starts_with("/--") {
            let Some(end) = rest.find("--/") else {
                let span = Span::new(source, at..at + 3);
                return Err(Box::new(Diagnostic::error(
                    "unclosed-comment",
                    span,
                    "this comment has no closing `--/`",
                )));
            };
            at += end + 3;
        } else if rest.starts_with("--") || rest.starts_with("//") || rest.starts_with('\u{feff}') {
            at += if rest.starts_with('\u{feff}') { 3 } else { rest.find('\n').unwrap_or(rest.len()) };
        } else {
            return Ok(at);
        }
    }
}

/// A hyphen is part of a name where a letter or digit follows, as in NuSMV.
fn word(text: &str) -> usize {
    let bytes = text.as_bytes();
    let plain = |c: u8| c.is_ascii_alphanumeric() || matches!(c, b'_' | b'$' | b'#');
    let mut length = 1;
    while let Some(&c) = bytes.get(length) {
        let hyphen = c == b'-' && bytes.get(length + 1).is_some_and(|&next| plain(next));
        if !plain(c) && !hyphen {
            break;
        }
        length += 1;
    }
    length
}

fn number(text: &str) -> (Tok, usize) {
    let bytes = text.as_bytes();
    let all = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    let is_word = bytes[0] == b'0'
        && bytes.get(1).is_some_and(|c| matches!(c, b'u' | b's' | b'b' | b'd' | b'h' | b'o'));
    if is_word {
        return (Tok::WordNumber, all);
    }
    (Tok::Number, text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()))
}
