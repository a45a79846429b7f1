//! What the lexer hands to the parser.

use crate::ast::CompareOp;
use crate::operator::{Operator, Row, TABLE, is_word};
use crate::span::Span;
use std::cmp::Reverse;
use std::sync::LazyLock;

/// The kind of a token. Words that are keywords only in some places (`state`, `label`, `when`) are
/// plain [`Tok::Ident`]s; only words that no name may be have a kind of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tok {
    Ident,
    Number,
    /// `"..."`
    Str,
    /// `'W'`
    Char,
    /// Something the lexer has already reported.
    Bad,
    Eof,

    LParen,
    RParen,
    LBracket,
    RBracket,
    LBrace,
    RBrace,
    Comma,
    Semi,
    Colon,
    Dot,
    DotDot,
    Prime,
    Hash,
    Assign,

    /// An operator, by its name or another sign for it; `-` is always the one between two operands.
    Op(Operator),
    /// A sign of other languages, which is refused with advice.
    Foreign,
    ColonEq,

    Exists,
    Forall,
    True,
    False,
    If,
    Then,
    Else,
}

/// `==`
pub(crate) const EQUALS: Tok = Tok::Op(Operator::Compare(CompareOp::Eq));

/// A token with its text and place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    pub(crate) tok: Tok,
    pub(crate) text: &'a str,
    pub(crate) span: Span,
    /// Nothing but blanks and comments stand before it on its line.
    pub(crate) first_on_line: bool,
}

/// Punctuation, and the paper's signs for quantifiers.
const PUNCTUATION: &[(&str, Tok)] = &[
    (":=", Tok::ColonEq),
    ("..", Tok::DotDot),
    ("(", Tok::LParen),
    (")", Tok::RParen),
    ("[", Tok::LBracket),
    ("]", Tok::RBracket),
    ("{", Tok::LBrace),
    ("}", Tok::RBrace),
    (",", Tok::Comma),
    (";", Tok::Semi),
    (":", Tok::Colon),
    (".", Tok::Dot),
    ("#", Tok::Hash),
    ("=", Tok::Assign),
    ("∃", Tok::Exists),
    ("∀", Tok::Forall),
];

/// Punctuation and the signs of operators, longer ones before their prefixes.
pub(crate) static SYMBOLS: LazyLock<Vec<(&str, Tok)>> = LazyLock::new(|| {
    let mut symbols = PUNCTUATION.to_vec();
    // What has a meaning of its own is listed first, and so found first.
    for row in TABLE.iter().filter(|row| row.operator != Operator::Neg) {
        let own = [row.name].into_iter().chain(row.signs.iter().copied());
        symbols.extend(own.filter(|sign| !is_word(sign)).map(|sign| (sign, Tok::Op(row.operator))));
    }
    // `[]` is two brackets to the lexer.
    let slips = TABLE.iter().flat_map(|row| row.slips.iter().copied());
    symbols.extend(slips.filter(|sign| !is_word(sign) && *sign != "[]").map(|sign| (sign, Tok::Foreign)));
    symbols.sort_by_key(|(sign, _)| Reverse(sign.len()));
    symbols
});

/// The words besides operators that no variable, label, action or path may be called.
const KEYWORDS: &[(&str, Tok)] = &[
    ("exists", Tok::Exists),
    ("forall", Tok::Forall),
    ("true", Tok::True),
    ("false", Tok::False),
    ("if", Tok::If),
    ("then", Tok::Then),
    ("else", Tok::Else),
];

/// What the lexer tells apart, and words of other languages for which there is advice.
pub(crate) fn lexemes() -> impl Iterator<Item = &'static str> {
    let words = TABLE.iter().flat_map(|row| [row.name].into_iter().chain(row.slips.iter().copied()));
    SYMBOLS.iter().chain(KEYWORDS).map(|(text, _)| *text).chain(words)
}

/// The token of a word that no name may be.
pub(crate) fn reserved(word: &str) -> Option<Tok> {
    let keyword = KEYWORDS.iter().find(|(keyword, _)| *keyword == word).map(|&(_, tok)| tok);
    let operator = || TABLE.iter().find(|row| row.name == word && row.is_reserved());
    keyword.or_else(|| operator().map(|row| Tok::Op(row.operator)))
}

/// Whether the word is an operator, be it in some places only.
pub(crate) fn is_operator(word: &str) -> bool {
    TABLE.iter().any(|row| row.name == word)
}

impl Token<'_> {
    /// How messages name it.
    pub(crate) fn describe(&self) -> String {
        match self.tok {
            Tok::Eof => "the end of the file".to_owned(),
            Tok::Str => "a string".to_owned(),
            _ => format!("`{}`", self.text),
        }
    }

    /// Whether it is a word, reserved or not (and not one of the paper's signs).
    pub(crate) fn is_word(&self) -> bool {
        self.tok == Tok::Ident || reserved(self.text).is_some()
    }

    /// The operator between two operands that it is; behind an operand a contextual name is one too.
    pub(crate) fn infix(&self) -> Option<&'static Row> {
        match self.tok {
            Tok::Op(operator) => Some(operator.row()).filter(|row| !row.is_prefix()),
            Tok::Ident => TABLE.iter().find(|row| row.contextual && row.name == self.text),
            _ => None,
        }
    }

    /// The operator before an operand that it is.
    pub(crate) fn prefix(&self) -> Option<&'static Row> {
        let Tok::Op(operator) = self.tok else { return None };
        TABLE.iter().find(|row| row.is_prefix() && row.name == operator.name())
    }

    /// The operator that a sign or word of another language means, in front of an operand or between two.
    pub(crate) fn slip(&self, prefix: bool) -> Option<&'static Row> {
        let slips = |row: &&Row| row.slips.iter().any(|slip| slip.eq_ignore_ascii_case(self.text));
        let candidate = matches!(self.tok, Tok::Foreign | Tok::Ident | Tok::Assign);
        TABLE.iter().find(|row| candidate && row.is_prefix() == prefix && slips(row))
    }
}
