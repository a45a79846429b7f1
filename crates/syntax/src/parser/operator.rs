//! The operators: how tightly each binds, and what other languages write instead.

use crate::ast::{ArithOp, BinaryOp, CompareOp, UnaryOp};
use crate::token::Tok;

/// How tightly an operator binds; a greater number binds more tightly.
pub(crate) mod level {
    pub(crate) const LOWEST: u8 = 0;
    pub(crate) const IFF: u8 = 1;
    pub(crate) const IMPLIES: u8 = 2;
    pub(crate) const OR: u8 = 3;
    pub(crate) const AND: u8 = 4;
    pub(crate) const UNTIL: u8 = 5;
    pub(crate) const LOGIC_PREFIX: u8 = 6;
    pub(crate) const COMPARE: u8 = 7;
    pub(crate) const SUM: u8 = 8;
    pub(crate) const PRODUCT: u8 = 9;
    pub(crate) const NEG: u8 = 10;
    /// Names, numbers, what has brackets around it.
    pub(crate) const OPERAND: u8 = 11;
}

/// Operators between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Infix {
    Iff,
    Implies,
    Or,
    And,
    Temporal(BinaryOp),
    Compare(CompareOp),
    In,
    Plus,
    Minus,
    Arith(ArithOp),
}

impl Infix {
    pub(super) fn level(self) -> u8 {
        match self {
            Infix::Iff => level::IFF,
            Infix::Implies => level::IMPLIES,
            Infix::Or => level::OR,
            Infix::And => level::AND,
            Infix::Temporal(_) => level::UNTIL,
            Infix::Compare(_) | Infix::In => level::COMPARE,
            Infix::Plus | Infix::Minus => level::SUM,
            Infix::Arith(_) => level::PRODUCT,
        }
    }

    /// `a OP b OP c` is `a OP (b OP c)`.
    pub(super) fn is_right_associative(self) -> bool {
        matches!(self, Infix::Implies | Infix::Temporal(_))
    }

    /// `a OP b OP c` is one flat list.
    pub(super) fn is_flat(self) -> bool {
        matches!(self, Infix::And | Infix::Or | Infix::Plus | Infix::Minus)
    }

    pub(super) fn of(tok: Tok) -> Option<Infix> {
        Some(match tok {
            Tok::Iff => Infix::Iff,
            Tok::Arrow => Infix::Implies,
            Tok::Pipe => Infix::Or,
            Tok::Amp => Infix::And,
            Tok::Until => Infix::Temporal(BinaryOp::Until),
            Tok::Release => Infix::Temporal(BinaryOp::Release),
            Tok::WeakUntil => Infix::Temporal(BinaryOp::WeakUntil),
            Tok::EqEq => Infix::Compare(CompareOp::Eq),
            Tok::Ne => Infix::Compare(CompareOp::Ne),
            Tok::Lt => Infix::Compare(CompareOp::Lt),
            Tok::Le => Infix::Compare(CompareOp::Le),
            Tok::Gt => Infix::Compare(CompareOp::Gt),
            Tok::Ge => Infix::Compare(CompareOp::Ge),
            Tok::In => Infix::In,
            Tok::Plus => Infix::Plus,
            Tok::Minus => Infix::Minus,
            Tok::Star => Infix::Arith(ArithOp::Mul),
            Tok::Slash => Infix::Arith(ArithOp::Divide),
            Tok::Div => Infix::Arith(ArithOp::Div),
            Tok::Percent => Infix::Arith(ArithOp::Mod),
            _ => return None,
        })
    }

    /// What a sign or word of another language means, and how it is written here.
    pub(super) fn of_slip(tok: Tok, text: &str) -> Option<(Infix, &'static str)> {
        Some(match tok {
            Tok::Assign => (Infix::Compare(CompareOp::Eq), "=="),
            Tok::AmpAmp | Tok::Wedge => (Infix::And, "&"),
            Tok::PipePipe | Tok::Vee => (Infix::Or, "|"),
            Tok::FatArrow => (Infix::Implies, "->"),
            Tok::LtEqGt => (Infix::Iff, "<->"),
            Tok::LtGt => (Infix::Compare(CompareOp::Ne), "!="),
            Tok::EqLt => (Infix::Compare(CompareOp::Le), "<="),
            Tok::Ident => match text.to_ascii_lowercase().as_str() {
                "and" => (Infix::And, "&"),
                "or" => (Infix::Or, "|"),
                "implies" => (Infix::Implies, "->"),
                "is" => (Infix::Compare(CompareOp::Eq), "=="),
                "xor" => (Infix::Compare(CompareOp::Ne), "!="),
                "iff" => (Infix::Iff, "<->"),
                "mod" => (Infix::Arith(ArithOp::Mod), "%"),
                "until" | "u" => (Infix::Temporal(BinaryOp::Until), "U"),
                "release" | "releases" => (Infix::Temporal(BinaryOp::Release), "R"),
                _ => return None,
            },
            _ => return None,
        })
    }
}

/// Operators before one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prefix {
    Not,
    Temporal(UnaryOp),
    Neg,
}

impl Prefix {
    pub(super) fn level(self) -> u8 {
        match self {
            Prefix::Not | Prefix::Temporal(_) => level::LOGIC_PREFIX,
            Prefix::Neg => level::NEG,
        }
    }

    pub(super) fn of(tok: Tok) -> Option<Prefix> {
        Some(match tok {
            Tok::Bang => Prefix::Not,
            Tok::Next => Prefix::Temporal(UnaryOp::Next),
            Tok::WeakNext => Prefix::Temporal(UnaryOp::WeakNext),
            Tok::Finally => Prefix::Temporal(UnaryOp::Finally),
            Tok::Globally => Prefix::Temporal(UnaryOp::Globally),
            Tok::Minus => Prefix::Neg,
            _ => return None,
        })
    }

    /// What a sign of another language means, and how it is written here.
    pub(super) fn of_slip(tok: Tok) -> Option<(Prefix, &'static str)> {
        Some(match tok {
            Tok::Tilde => (Prefix::Not, "!"),
            Tok::LtGt => (Prefix::Temporal(UnaryOp::Finally), "F"),
            _ => return None,
        })
    }

    /// The same for words, which may be names too.
    pub(super) fn of_word(text: &str) -> Option<(Prefix, &'static str)> {
        Some(match text.to_ascii_lowercase().as_str() {
            "not" => (Prefix::Not, "!"),
            "next" => (Prefix::Temporal(UnaryOp::Next), "X"),
            "eventually" | "finally" => (Prefix::Temporal(UnaryOp::Finally), "F"),
            "always" | "globally" => (Prefix::Temporal(UnaryOp::Globally), "G"),
            _ => return None,
        })
    }
}
