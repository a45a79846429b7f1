//! What the lexer hands to the parser.

use crate::span::Span;

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

    EqEq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Plus,
    Minus,
    Star,
    Slash,
    Percent,
    Bang,
    Amp,
    Pipe,
    Arrow,
    Iff,

    Exists,
    Forall,
    True,
    False,
    If,
    Then,
    Else,
    In,
    Div,
    Next,
    WeakNext,
    Finally,
    Globally,
    Until,
    Release,
    WeakUntil,

    // What other languages write; each is refused with advice.
    AmpAmp,
    PipePipe,
    FatArrow,
    LtEqGt,
    LtGt,
    Wedge,
    Vee,
    Tilde,
    ColonEq,
    EqLt,
}

/// A token with its text and place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token<'a> {
    pub(crate) tok: Tok,
    pub(crate) text: &'a str,
    pub(crate) span: Span,
    /// Nothing but blanks and comments stand before it on its line.
    pub(crate) first_on_line: bool,
}

/// Operators and punctuation. Longer ones stand before their prefixes.
pub(crate) const SYMBOLS: &[(&str, Tok)] = &[
    ("<->", Tok::Iff),
    ("<=>", Tok::LtEqGt),
    ("->", Tok::Arrow),
    ("=>", Tok::FatArrow),
    ("=<", Tok::EqLt),
    ("==", Tok::EqEq),
    ("!=", Tok::Ne),
    ("<=", Tok::Le),
    (">=", Tok::Ge),
    ("<>", Tok::LtGt),
    ("&&", Tok::AmpAmp),
    ("||", Tok::PipePipe),
    ("/\\", Tok::Wedge),
    ("\\/", Tok::Vee),
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
    ("<", Tok::Lt),
    (">", Tok::Gt),
    ("+", Tok::Plus),
    ("-", Tok::Minus),
    ("*", Tok::Star),
    ("/", Tok::Slash),
    ("%", Tok::Percent),
    ("!", Tok::Bang),
    ("&", Tok::Amp),
    ("|", Tok::Pipe),
    ("~", Tok::Tilde),
    // The paper's signs, and those that look like them.
    ("∃", Tok::Exists),
    ("∀", Tok::Forall),
    ("¬", Tok::Bang),
    ("∧", Tok::Amp),
    ("∨", Tok::Pipe),
    ("⇒", Tok::Arrow),
    ("→", Tok::Arrow),
    ("⇔", Tok::Iff),
    ("↔", Tok::Iff),
    ("◇", Tok::Finally),
    ("◊", Tok::Finally),
    ("♢", Tok::Finally),
    ("⋄", Tok::Finally),
    ("□", Tok::Globally),
    ("◻", Tok::Globally),
    ("○", Tok::Next),
    ("◯", Tok::Next),
    ("𝒰", Tok::Until),
    ("≠", Tok::Ne),
    ("≤", Tok::Le),
    ("≥", Tok::Ge),
    ("∈", Tok::In),
];

/// The words that no variable, label, action or path may be called.
pub(crate) const RESERVED: &[(&str, Tok)] = &[
    ("exists", Tok::Exists),
    ("forall", Tok::Forall),
    ("true", Tok::True),
    ("false", Tok::False),
    ("if", Tok::If),
    ("then", Tok::Then),
    ("else", Tok::Else),
    ("in", Tok::In),
    ("div", Tok::Div),
    ("X", Tok::Next),
    ("N", Tok::WeakNext),
    ("F", Tok::Finally),
    ("G", Tok::Globally),
    ("U", Tok::Until),
    ("R", Tok::Release),
    ("W", Tok::WeakUntil),
];

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
        self.tok == Tok::Ident || RESERVED.iter().any(|(word, _)| *word == self.text)
    }
}
