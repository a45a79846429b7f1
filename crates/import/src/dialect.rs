//! How the formula languages differ: in how tightly operators bind where there are no parentheses.

use crate::lexer::{Tok, Token};

/// The language of a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// HyperQB 1.
    HyperQb1,
    /// HyperQB 2.0.
    HyperQb2,
    /// HyperLasso.
    HyperLasso,
    /// AutoHyper.
    AutoHyper,
}

impl Dialect {
    /// All of them.
    pub const ALL: [Dialect; 4] =
        [Dialect::HyperQb1, Dialect::HyperQb2, Dialect::HyperLasso, Dialect::AutoHyper];

    /// As it is typed.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Dialect::HyperQb1 => "hyperqb1",
            Dialect::HyperQb2 => "hyperqb2",
            Dialect::HyperLasso => "hyperlasso",
            Dialect::AutoHyper => "autohyper",
        }
    }

    /// As the tool is called.
    pub(crate) fn tool(self) -> &'static str {
        match self {
            Dialect::HyperQb1 => "HyperQB 1",
            Dialect::HyperQb2 => "HyperQB 2.0",
            Dialect::HyperLasso => "HyperLasso",
            Dialect::AutoHyper => "AutoHyper",
        }
    }

    /// The language whose signs a formula has. Without any of its own it is written as all of them are.
    pub(crate) fn of(tokens: &[Token<'_>]) -> Option<Dialect> {
        let sign = |signs: &[&str]| tokens.iter().any(|t| t.tok == Tok::Sign && signs.contains(&t.text));
        let pathed = |pair: &[Token<'_>]| pair[0].text == "}" && pair[1].text.starts_with('_');
        // Behind an operand a star is a product.
        let opens = |pair: &[Token<'_>]| pair[1].text == "*" && is_open(pair[0]);
        if sign(&["/\\", "\\/"]) || tokens.windows(2).any(opens) {
            Some(Dialect::HyperQb1)
        } else if tokens.windows(2).any(pathed) || tokens.iter().any(|t| t.tok == Tok::Text) {
            Some(Dialect::AutoHyper)
        } else if matches!(tokens[0].text, "Forall" | "Exists") && tokens.iter().all(is_hyperqb_2) {
            Some(Dialect::HyperQb2)
        } else {
            None
        }
    }

    /// How its operators bind.
    pub(crate) fn grammar(self) -> &'static Grammar {
        match self {
            Dialect::HyperQb1 => &HYPERQB_1,
            Dialect::HyperQb2 => &HYPERQB_2,
            Dialect::HyperLasso => &USUAL,
            Dialect::AutoHyper => &AUTOHYPER,
        }
    }
}

/// Whether an operand is to come.
fn is_open(token: Token<'_>) -> bool {
    token.tok == Tok::Sign && !matches!(token.text, ")" | "]" | "}" | "*")
}

/// Whether HyperQB 2.0 has that sign.
fn is_hyperqb_2(token: &Token<'_>) -> bool {
    let signs = ["(", ")", "[", "]", ".", "&", "|", "->", "=", "~"];
    token.tok != Tok::Sign || signs.contains(&token.text)
}

/// How tightly an operator binds: the more, the tighter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Binding {
    pub(crate) level: u8,
    /// The least level of operators in the operand to its right.
    pub(crate) right: u8,
}

impl Binding {
    pub(crate) const fn left(level: u8) -> Binding {
        Binding { level, right: level + 1 }
    }

    const fn right(level: u8) -> Binding {
        Binding { level, right: level }
    }
}

/// The operators in which languages differ. What is not named here binds as in NuSMV, more tightly than these.
#[derive(Debug)]
pub(crate) struct Grammar {
    pub(crate) implies: Binding,
    pub(crate) iff: Binding,
    pub(crate) xor: Binding,
    pub(crate) or: Binding,
    pub(crate) and: Binding,
    pub(crate) until: Binding,
    pub(crate) release: Binding,
    pub(crate) equal: Binding,
    /// The least level of operators below `!`, `X`, `F` and `G`.
    pub(crate) unary: u8,
}

/// As NuSMV has it, in models and, with temporal operators between `&` and `!`, in formulas.
pub(crate) static USUAL: Grammar = Grammar {
    implies: Binding::right(1),
    iff: Binding::left(2),
    xor: Binding::left(4),
    or: Binding::left(4),
    and: Binding::left(5),
    until: Binding::right(6),
    release: Binding::right(6),
    equal: Binding::left(8),
    unary: 7,
};

/// The published grammar, in which `/\` binds least, and `<->` has whatever may stand to its right.
static HYPERQB_1: Grammar = Grammar {
    and: Binding::left(1),
    or: Binding::left(2),
    implies: Binding::right(3),
    iff: Binding { level: 6, right: 1 },
    until: Binding::left(7),
    release: Binding::left(7),
    ..USUAL
};

/// `=` is "if and only if" as well, and binds least; `R` binds more tightly than `U`.
static HYPERQB_2: Grammar = Grammar {
    equal: Binding::right(1),
    iff: Binding::right(1),
    implies: Binding::right(2),
    release: Binding::right(7),
    unary: 8,
    ..USUAL
};

/// As in Spot, `<->` binds least; but `->` and `U` group to the left.
static AUTOHYPER: Grammar = Grammar {
    iff: Binding::left(1),
    xor: Binding::left(1),
    implies: Binding::left(2),
    until: Binding::left(6),
    release: Binding::left(6),
    ..USUAL
};
