//! From tokens to the syntax tree.
//!
//! Declarations are parsed by recursive descent without nesting; expressions by operator precedence
//! with an explicit stack, so that only brackets recurse, and those to [`MAX_NESTING`]. A mistake
//! ends the declaration it stands in: it is reported once, and parsing goes on behind the next `;`,
//! at the closing `}`, or at the next line that begins with a keyword.

mod choice;
mod expr;
mod habit;
mod item;
mod map_item;
mod operand;
mod recover;
mod system;

use crate::ast::{Expr, File, Ident, Text};
use crate::diagnostic::Diagnostic;
use crate::lexer::{Lexemes, lex};
use crate::similar::similar;
use crate::span::{SourceId, Span};
use crate::token::{Tok, Token, lexemes};
use std::collections::BTreeSet;

/// Expressions nested more deeply are refused; so everything that walks the tree may recurse.
///
/// The parser itself takes at most 3.5 KB of stack a level, without any optimization: a thread of
/// 2 MB is enough.
pub const MAX_NESTING: u32 = 500;

/// After so many errors the rest of a file is not worth reading.
const MAX_ERRORS: usize = 50;

/// The words and signs that the language knows, and those of other languages for which it has advice; words that mean
/// something behind others only, such as `when`, are not among them. For those who make texts up.
#[must_use]
pub fn vocabulary() -> BTreeSet<&'static str> {
    lexemes().chain(recover::TOP.iter().copied()).chain(recover::ITEMS.iter().copied()).collect()
}

/// Parses a problem file. With errors, the file has what could be parsed all the same.
#[must_use]
pub fn parse(source: SourceId, text: &str) -> (File, Vec<Diagnostic>) {
    let Lexemes { tokens, errors, .. } = lex(source, text);
    if tokens.len() == 1 {
        return (File::default(), errors);
    }
    let mut parser = Parser::new(tokens, text, errors);
    let mut file = parser.file();
    file.skipped = parser.skipped;
    let mut errors = parser.errors;
    errors.sort_by_key(|error| error.span.map(|span| span.start));
    if errors.len() > MAX_ERRORS {
        errors.truncate(MAX_ERRORS);
        errors.push(Diagnostic::error_nowhere("too-many-errors", "too many errors; the rest is not shown"));
    }
    (file, errors)
}

/// Parses expressions with commas between them, as they stand behind `minimize`; none where there is an error.
pub fn parse_exprs(source: SourceId, text: &str) -> (Vec<Expr>, Vec<Diagnostic>) {
    let Lexemes { tokens, errors, .. } = lex(source, text);
    let mut parser = Parser::new(tokens, text, errors);
    let all = parser.separated(Parser::expr).and_then(|all| match parser.peek() {
        Tok::Eof => Ok(all),
        _ => parser.fail("an operator, `,` or the end"),
    });
    (all.unwrap_or_default(), parser.errors)
}

/// The declaration at hand cannot be parsed; the reason has been reported.
#[derive(Clone, Copy, Debug)]
struct Abort;

type Parse<T> = Result<T, Abort>;

struct Parser<'a> {
    /// Never empty; the last one is [`Tok::Eof`].
    tokens: Vec<Token<'a>>,
    at: usize,
    text: &'a str,
    errors: Vec<Diagnostic>,
    /// Braces open at this point.
    braces: u32,
    /// Expressions open at this point.
    depth: u32,
    /// See [`File::skipped`].
    skipped: Vec<Span>,
    /// Whether expressions may speak of the state after a step, as `trans` does.
    primes: bool,
}

impl<'a> Parser<'a> {
    fn new(tokens: Vec<Token<'a>>, text: &'a str, errors: Vec<Diagnostic>) -> Self {
        Parser { tokens, at: 0, text, errors, braces: 0, depth: 0, skipped: Vec::new(), primes: false }
    }

    fn token(&self) -> Token<'a> {
        self.token_at(0)
    }

    /// The token `ahead` of the present one; the end of the file stays where it is.
    fn token_at(&self, ahead: usize) -> Token<'a> {
        self.tokens[(self.at + ahead).min(self.tokens.len() - 1)]
    }

    fn peek(&self) -> Tok {
        self.token().tok
    }

    fn peek_at(&self, ahead: usize) -> Tok {
        self.token_at(ahead).tok
    }

    #[inline(never)]
    fn bump(&mut self) -> Token<'a> {
        let token = self.token();
        match token.tok {
            Tok::LBrace => self.braces += 1,
            Tok::RBrace => self.braces = self.braces.saturating_sub(1),
            _ => {}
        }
        if token.tok != Tok::Eof {
            self.at += 1;
        }
        token
    }

    /// Where the token before the present one ends.
    fn behind(&self) -> Span {
        let last = self.tokens[self.at.saturating_sub(1)].span;
        Span { start: last.end, ..last }
    }

    /// From `start` to the token before the present one.
    fn since(&self, start: Span) -> Span {
        start.to(self.behind())
    }

    fn eat(&mut self, tok: Tok) -> Option<Token<'a>> {
        (self.peek() == tok).then(|| self.bump())
    }

    /// Whether the present token is the word `word`.
    fn at_word(&self, word: &str) -> bool {
        self.peek() == Tok::Ident && self.token().text == word
    }

    fn eat_word(&mut self, word: &str) -> Option<Token<'a>> {
        self.at_word(word).then(|| self.bump())
    }

    #[inline(never)]
    fn expect(&mut self, tok: Tok, what: &str) -> Parse<Token<'a>> {
        if self.peek() == tok { Ok(self.bump()) } else { self.fail(what) }
    }

    fn report(&mut self, error: Diagnostic) {
        self.errors.push(error);
    }

    /// Reports `expected WHAT, found TOKEN` at the present token.
    fn fail<T>(&mut self, expected: &str) -> Parse<T> {
        self.fail_with(expected, None)
    }

    #[inline(never)]
    fn fail_with<T>(&mut self, expected: &str, help: Option<String>) -> Parse<T> {
        let token = self.token();
        // The lexer has said what is wrong with a bad token.
        if token.tok != Tok::Bad {
            let message = format!("expected {expected}, found {}", token.describe());
            let mut error = Diagnostic::error("syntax", token.span, message).with_label("not expected here");
            error.help = help;
            self.report(error);
        }
        Err(Abort)
    }

    /// A name of something that expressions speak of: no reserved word.
    #[inline(never)]
    fn name(&mut self, what: &str) -> Parse<Ident> {
        let token = self.token();
        if token.tok == Tok::Ident {
            self.bump();
            return Ok(ident(token));
        }
        if !token.is_word() {
            return self.fail(what);
        }
        let error =
            Diagnostic::error("reserved-name", token.span, format!("`{}` cannot be a name", token.text));
        self.report(error.with_label(format!("expected {what}")).with_help(format!(
            "`{}` is reserved; choose another name, such as `{}1`",
            token.text,
            token.text.to_lowercase()
        )));
        self.bump();
        Ok(ident(token))
    }

    /// A name that no expression mentions (a system's, an objective's): any word will do.
    fn any_word(&mut self, what: &str) -> Parse<Ident> {
        if self.token().is_word() { Ok(ident(self.bump())) } else { self.fail(what) }
    }

    /// One or more names with commas between them.
    fn names(&mut self, what: &str) -> Parse<Vec<Ident>> {
        self.separated(|parser| parser.name(what))
    }

    /// One or more with commas between them.
    fn separated<T>(&mut self, mut one: impl FnMut(&mut Self) -> Parse<T>) -> Parse<Vec<T>> {
        let mut all = vec![one(self)?];
        while self.eat(Tok::Comma).is_some() {
            all.push(one(self)?);
        }
        Ok(all)
    }

    /// `(NAME, ...)`, possibly empty.
    #[inline(never)]
    fn parenthesized_names(&mut self, what: &str) -> Parse<Vec<Ident>> {
        self.expect(Tok::LParen, "`(`")?;
        if self.eat(Tok::RParen).is_some() {
            return Ok(Vec::new());
        }
        let names = self.names(what)?;
        self.expect(Tok::RParen, "`,` or `)`")?;
        Ok(names)
    }

    /// A string, with its escapes resolved.
    fn string(&mut self, what: &str) -> Parse<Text> {
        let token = self.expect(Tok::Str, what)?;
        let inside = token.text.get(1..token.text.len() - 1).unwrap_or("");
        let mut text = String::with_capacity(inside.len());
        let mut rest = inside.char_indices();
        while let Some((at, found)) = rest.next() {
            match (found, if found == '\\' { rest.next() } else { None }) {
                ('\\', Some((_, escaped @ ('\\' | '"')))) => text.push(escaped),
                ('\\', Some((_, escaped))) => {
                    let start = token.span.start as usize + 1 + at;
                    let span = Span::new(token.span.source, start..start + 1 + escaped.len_utf8());
                    let error =
                        Diagnostic::error("bad-escape", span, format!("unknown escape `\\{escaped}`"));
                    self.report(error.with_help("write `\\\\` for a backslash and `\\\"` for a quote"));
                }
                _ => text.push(found),
            }
        }
        Ok(Text { text, span: token.span })
    }
}

fn ident(token: Token<'_>) -> Ident {
    Ident { name: token.text.to_owned(), span: token.span }
}

/// `did you mean ...?`, if there is something to mean.
fn did_you_mean(name: &str, candidates: &[&str]) -> Option<String> {
    similar(name, candidates.iter().copied()).map(|found| format!("did you mean `{found}`?"))
}
