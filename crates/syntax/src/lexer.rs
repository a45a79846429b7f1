//! From text to tokens (nom, with places by nom_locate).
//!
//! The lexer never fails: what is no token becomes [`Tok::Bad`], reported here and passed over in
//! silence by the parser. Text with control characters is not read at all.

use nom::branch::alt;
use nom::bytes::complete::{is_not, tag, take_until, take_while};
use nom::character::complete::{char, digit1, none_of, satisfy};
use nom::combinator::{map, opt, recognize, rest, value, verify};
use nom::error::{Error, ErrorKind};
use nom::multi::many0_count;
use nom::sequence::{delimited, pair, preceded, terminated};
use nom::{IResult, Input as _, Parser};
use nom_locate::LocatedSpan;

use crate::diagnostic::Diagnostic;
use crate::lookalike::looks_like;
use crate::span::{SourceId, Span};
use crate::token::{SYMBOLS, Tok, Token, is_operator, reserved};

type Input<'a> = LocatedSpan<&'a str>;
type Lexed<'a, T> = IResult<Input<'a>, T>;

/// More bad places than this are not worth telling one by one.
const MAX_ERRORS: usize = 20;

/// What a piece of text is: a token, or a mistake.
#[derive(Clone, Copy)]
enum Lexeme {
    Good(Tok),
    Character,
    UnclosedString,
    UnclosedQuote,
    Number,
    BlockComment,
}

/// What a text consists of.
#[derive(Default)]
pub(crate) struct Lexemes<'a> {
    /// The last one is [`Tok::Eof`].
    pub(crate) tokens: Vec<Token<'a>>,
    pub(crate) comments: Vec<Comment<'a>>,
    pub(crate) errors: Vec<Diagnostic>,
}

/// A comment up to the end of its line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Comment<'a> {
    /// With the slashes, without blanks at the end.
    pub(crate) text: &'a str,
    /// Where it begins.
    pub(crate) start: usize,
}

/// The tokens and comments of `text`; or an error if it is no text at all.
pub(crate) fn lex(source: SourceId, text: &str) -> Lexemes<'_> {
    let mut lexemes = Lexemes::default();
    let end = text.trim_end().len();
    if let Some(error) = not_text(source, text) {
        lexemes.errors.push(error);
    } else {
        read(source, text, &mut lexemes);
    }
    let eof = Token { tok: Tok::Eof, text: "", span: Span::new(source, end..end), first_on_line: true };
    lexemes.tokens.push(eof);
    lexemes
}

fn read<'a>(source: SourceId, text: &'a str, lexemes: &mut Lexemes<'a>) {
    let Lexemes { tokens, comments, errors } = lexemes;
    let mut input = Input::new(text.strip_prefix('\u{feff}').unwrap_or(text));
    let skipped = text.len() - input.fragment().len();
    let mut line = 0;
    // Between a quantifier and its point, which a word may touch: `exists p.goal[p]`.
    let mut quantifier = false;
    loop {
        input = blanks(input, |comment| {
            let start = comment.location_offset() + skipped;
            comments.push(Comment { text: comment.fragment().trim_end(), start });
        });
        // A prime belongs to the word it touches; elsewhere `'` opens a quoted letter.
        let touches_word = |last: &Token<'_>| last.span.end as usize == input.location_offset() + skipped;
        // Behind `x[p]` one is as wrong as any, but it is a prime that is meant.
        let primed = |last: &Token<'_>| matches!(last.tok, Tok::Ident | Tok::RBracket) && touches_word(last);
        let after_word = tokens.last().is_some_and(primed);
        let Ok((next, (lexeme, piece))) = lexeme(input, after_word, quantifier) else { return };
        let start = piece.location_offset() + skipped;
        let span = Span::new(source, start..start + piece.fragment().len());
        let first_on_line = tokens.is_empty() || piece.location_line() != line;
        line = piece.location_line();
        let tok = match lexeme {
            Lexeme::Good(tok) => tok,
            bad => {
                if errors.len() < MAX_ERRORS {
                    errors.push(complaint(bad, &piece, span));
                }
                Tok::Bad
            }
        };
        quantifier = match tok {
            Tok::Exists | Tok::Forall => true,
            Tok::Ident | Tok::Comma | Tok::Colon => quantifier,
            _ => false,
        };
        tokens.push(Token { tok, text: piece.into_fragment(), span, first_on_line });
        input = next;
    }
}

/// An error if the text is binary data or too large for [`Span`].
fn not_text(source: SourceId, text: &str) -> Option<Diagnostic> {
    if u32::try_from(text.len()).is_err() {
        return Some(Diagnostic::error_nowhere("too-large", "the file is larger than 4 GiB"));
    }
    let control = |c: char| c.is_control() && !c.is_whitespace();
    let (at, found) = text.char_indices().find(|&(_, c)| control(c))?;
    let span = Span::new(source, at..at + found.len_utf8());
    let message = format!("this is not a text file: it has the control character U+{:04X}", u32::from(found));
    Some(Diagnostic::error("not-text", span, message))
}

fn complaint(what: Lexeme, piece: &Input<'_>, span: Span) -> Diagnostic {
    let text = piece.fragment();
    match what {
        Lexeme::UnclosedString => {
            Diagnostic::error("unclosed-string", span, "this string has no closing `\"`")
                .with_help("a string ends on the line where it begins")
        }
        Lexeme::UnclosedQuote => {
            Diagnostic::error("unclosed-string", span, "a quote `'` stands around one character")
                .with_help("write `'W'`, or `'#0000ff'` for a colour; the prime of an update `x'` stands directly after its variable")
        }
        Lexeme::Number => {
            Diagnostic::error("bad-number", span, format!("`{text}` is neither a number nor a name"))
                .with_help(
                    "numbers are digits, with a fraction for reals: `12`, `0.5`; names begin with a letter",
                )
        }
        Lexeme::BlockComment => {
            Diagnostic::error("bad-comment", span, "block comments are not part of the language")
                .with_help("write `//` in front of every line")
        }
        Lexeme::Good(_) | Lexeme::Character => {
            let shown: String = text.chars().take(20).flat_map(char::escape_debug).collect();
            let message = if text.chars().nth(1).is_some() {
                format!("unexpected characters `{shown}`")
            } else {
                format!("unexpected character `{shown}`")
            };
            let error = Diagnostic::error("bad-character", span, message);
            let first = text.chars().next().unwrap_or_default();
            match (looks_like(first), first) {
                (Some(sign), _) => error.with_help(format!("write `{sign}`")),
                (_, '@') => error.with_help("what is read of a path is written `goal[p]`"),
                (_, '?') => error.with_help("write `if C then A else B`"),
                _ if text.chars().any(char::is_alphabetic) => {
                    error.with_help("names consist of the letters a-z and A-Z, digits, and `_`")
                }
                _ => error,
            }
        }
    }
}

/// Passes over blanks and comments.
fn blanks<'a>(mut input: Input<'a>, mut found: impl FnMut(Input<'a>)) -> Input<'a> {
    let blank = |input| take_while(char::is_whitespace)(input);
    let comment = |input| recognize(pair(tag("//"), line)).parse(input);
    loop {
        let after: Lexed<'_, Input<'_>> = blank(input);
        input = after.map_or(input, |(rest, _)| rest);
        let commented: Lexed<'_, Input<'_>> = comment(input);
        let Ok((rest, piece)) = commented else { return input };
        found(piece);
        input = rest;
    }
}

/// The rest of a line; `\r` ends one too, as it does in old files.
fn line(input: Input<'_>) -> Lexed<'_, Input<'_>> {
    take_while(|c| !matches!(c, '\n' | '\r'))(input)
}

fn lexeme<'a>(input: Input<'a>, after_word: bool, quantifier: bool) -> Lexed<'a, (Lexeme, Input<'a>)> {
    if after_word && let Ok((rest, piece)) = tag::<_, _, Error<Input<'a>>>("'")(input) {
        return Ok((rest, (Lexeme::Good(Tok::Prime), piece)));
    }
    let word = |input| if quantifier { plain_word(input) } else { word(input) };
    alt((word, number, string, quoted, block_comment, symbol, other)).parse(input)
}

fn plain_word(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let letter = satisfy(|c| c.is_ascii_alphabetic() || c == '_');
    let (rest, piece) = recognize(pair(letter, take_while(is_word_character))).parse(input)?;
    Ok((rest, (Lexeme::Good(reserved(piece.fragment()).unwrap_or(Tok::Ident)), piece)))
}

/// A word, or a name of parts: `proc.line`, `queue[0][1]`. What may have an interval behind it is no such part.
fn word(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let (rest, (lexeme, piece)) = plain_word(input)?;
    let more = match lexeme {
        Lexeme::Good(Tok::Ident) if !is_operator(piece.fragment()) => parts(rest.fragment()),
        _ => 0,
    };
    if more == 0 {
        return Ok((rest, (lexeme, piece)));
    }
    let (rest, piece) = input.take_split(piece.fragment().len() + more);
    Ok((rest, (Lexeme::Good(Tok::Ident), piece)))
}

/// How much of the text are further parts of a name.
fn parts(text: &str) -> usize {
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let word = |from: &str| from.find(|c| !is_word_character(c)).unwrap_or(from.len());
        at += match rest.as_bytes() {
            [b'.', first, ..] if first.is_ascii_alphabetic() || *first == b'_' => 1 + word(&rest[1..]),
            [b'[', b'0'..=b'9', ..] => {
                let digits = rest[1..].find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len() - 1);
                if rest.as_bytes().get(1 + digits) != Some(&b']') {
                    return at;
                }
                digits + 2
            }
            _ => return at,
        };
    }
}

fn is_word_character(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Whether the text can be a name: a word that is not reserved, or several with points between them, or with indices.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let begins = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let first = text.find(|c| !is_word_character(c)).unwrap_or(text.len());
    let (word, rest) = text.split_at(first);
    let whole = rest.is_empty() || !is_operator(word) && parts(rest) == rest.len();
    begins && whole && reserved(word).is_none()
}

/// Digits, with a fraction only where a digit follows the point: `0..2` begins with the number `0`.
fn number(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let fraction = pair(char('.'), digit1);
    let (rest, piece) = recognize(pair(digit1, opt(fraction))).parse(input)?;
    let (after, tail) = take_while(is_word_character)(rest)?;
    if tail.fragment().is_empty() {
        return Ok((rest, (Lexeme::Good(Tok::Number), piece)));
    }
    let length = piece.fragment().len() + tail.fragment().len();
    Ok((after, (Lexeme::Number, input.take(length))))
}

fn string(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let inside =
        many0_count(alt((value((), is_not("\"\\\r\n")), value((), preceded(char('\\'), none_of("\r\n"))))));
    let closed = recognize(delimited(char('"'), inside, char('"')));
    let unclosed = recognize(pair(char('"'), line));
    alt((
        map(closed, |piece| (Lexeme::Good(Tok::Str), piece)),
        map(unclosed, |piece| (Lexeme::UnclosedString, piece)),
    ))
    .parse(input)
}

fn quoted(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let colour = recognize(pair(char('#'), take_while(|c: char| c.is_ascii_hexdigit())));
    let colour = verify(colour, |piece: &Input<'_>| matches!(piece.fragment().len(), 7 | 9));
    let one = alt((colour, recognize(none_of("'\r\n"))));
    let letter = recognize(delimited(char('\''), one, char('\'')));
    let wrong = recognize(pair(char('\''), opt(terminated(is_not("'\r\n"), char('\'')))));
    alt((
        map(letter, |piece| (Lexeme::Good(Tok::Char), piece)),
        map(wrong, |piece| (Lexeme::UnclosedQuote, piece)),
    ))
    .parse(input)
}

fn block_comment(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let closed = recognize((tag("/*"), take_until("*/"), tag("*/")));
    let unclosed = recognize(pair(tag("/*"), rest));
    map(alt((closed, unclosed)), |piece| (Lexeme::BlockComment, piece)).parse(input)
}

fn symbol(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let text = *input.fragment();
    let Some(&(sign, tok)) = SYMBOLS.iter().find(|(sign, _)| text.starts_with(sign)) else {
        return Err(nom::Err::Error(Error::new(input, ErrorKind::Tag)));
    };
    let (rest, piece) = input.take_split(sign.len());
    Ok((rest, (Lexeme::Good(tok), piece)))
}

/// A run of characters that begin no token.
fn other(input: Input<'_>) -> Lexed<'_, (Lexeme, Input<'_>)> {
    let text = *input.fragment();
    let begins_token = |at: usize, c: char| {
        c.is_whitespace()
            || is_word_character(c)
            || matches!(c, '"' | '\'')
            || SYMBOLS.iter().any(|(sign, _)| text[at..].starts_with(sign))
    };
    let end =
        text.char_indices().skip(1).find(|&(at, c)| begins_token(at, c)).map_or(text.len(), |(at, _)| at);
    if end == 0 {
        return Err(nom::Err::Error(Error::new(input, ErrorKind::Eof)));
    }
    let (rest, piece) = input.take_split(end);
    Ok((rest, (Lexeme::Character, piece)))
}
