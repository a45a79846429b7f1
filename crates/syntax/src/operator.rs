//! The operators: one table, which the lexer, the parser, the printer, advice and the reference page read.
//!
//! A new operator is a form of [`Operator`], a row here, and a line of meaning where formulas are lowered
//! (`hyperplan-problem`, `lower::meaning`).

use crate::ast::{ArithOp, BinaryOp, CompareOp, ExprKind, UnaryOp};

/// How tightly an operator binds; a greater number binds more tightly.
pub mod level {
    /// Nothing is bound: any expression may stand there.
    pub const LOWEST: u8 = 0;
    /// `<->`
    pub const IFF: u8 = 1;
    /// `->`
    pub const IMPLIES: u8 = 2;
    /// `|`
    pub const OR: u8 = 3;
    /// `&`
    pub const AND: u8 = 4;
    /// Temporal operators between two formulas.
    pub const UNTIL: u8 = 5;
    /// `!`, and temporal operators before a formula.
    pub const LOGIC_PREFIX: u8 = 6;
    /// Comparisons.
    pub const COMPARE: u8 = 7;
    /// `+`, `-`
    pub const SUM: u8 = 8;
    /// `*`, `/`, `div`, `%`
    pub const PRODUCT: u8 = 9;
    /// `-` before a number.
    pub const NEG: u8 = 10;
    /// Names, numbers, what has brackets around it.
    pub const OPERAND: u8 = 11;
}

/// An operator of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// `!`
    Not,
    /// `&`
    And,
    /// `|`
    Or,
    /// `->`
    Implies,
    /// `<->`
    Iff,
    /// A temporal operator before a formula.
    Unary(UnaryOp),
    /// A temporal operator between two formulas.
    Binary(BinaryOp),
    /// A comparison.
    Compare(CompareOp),
    /// `in`
    In,
    /// `+`
    Plus,
    /// `-` between two numbers.
    Minus,
    /// `-` before a number.
    Neg,
    /// `*`, `/`, `div`, `%`
    Arith(ArithOp),
}

/// Where an operator stands, and what a chain of it means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fixity {
    /// Before its operand.
    Prefix,
    /// `a OP b OP c` is `(a OP b) OP c`.
    Left,
    /// `a OP b OP c` is `a OP (b OP c)`.
    Right,
    /// `a OP b OP c` is one list.
    Flat,
    /// `a OP b OP c` is an error.
    Unchained,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Which operator.
    pub operator: Operator,
    /// How it is written.
    pub name: &'static str,
    /// Where it stands.
    pub fixity: Fixity,
    /// How tightly it binds.
    pub level: u8,
    /// Signs that are accepted too: the paper's, and those that look like them.
    pub signs: &'static [&'static str],
    /// Signs, and words in any case, of other languages: read as meant, and refused with advice.
    pub slips: &'static [&'static str],
    /// Characters that look like it: no operator, but there is advice.
    pub lookalikes: &'static str,
    /// Whether it takes an interval.
    pub interval: bool,
    /// Whether its name may be a name as well, which it is wherever an operand can stand.
    pub contextual: bool,
    /// What it is, in words: of `f` and `g`, at steps from `a` to `b`.
    pub says: &'static str,
    /// What it is short for, if for anything.
    pub means: Option<&'static str>,
}

impl Row {
    const fn new(
        operator: Operator,
        name: &'static str,
        fixity: Fixity,
        level: u8,
        says: &'static str,
    ) -> Row {
        Row {
            operator,
            name,
            fixity,
            level,
            signs: &[],
            slips: &[],
            lookalikes: "",
            interval: false,
            contextual: false,
            says,
            means: None,
        }
    }

    /// A temporal operator before a formula.
    const fn unary(operator: UnaryOp, name: &'static str, says: &'static str) -> Row {
        Row::new(Operator::Unary(operator), name, Fixity::Prefix, level::LOGIC_PREFIX, says)
    }

    /// A temporal operator between two formulas.
    const fn binary(operator: BinaryOp, name: &'static str, says: &'static str) -> Row {
        let row = Row::new(Operator::Binary(operator), name, Fixity::Right, level::UNTIL, says);
        Row { interval: true, ..row }
    }

    const fn compare(operator: CompareOp, name: &'static str, says: &'static str) -> Row {
        Row::new(Operator::Compare(operator), name, Fixity::Unchained, level::COMPARE, says)
    }

    const fn arith(operator: ArithOp, name: &'static str, says: &'static str) -> Row {
        Row::new(Operator::Arith(operator), name, Fixity::Left, level::PRODUCT, says)
    }

    /// Whether it stands before its operand.
    #[must_use]
    pub fn is_prefix(&self) -> bool {
        self.fixity == Fixity::Prefix
    }

    /// Whether it is a word that no name may be.
    pub(crate) fn is_reserved(&self) -> bool {
        is_word(self.name) && !self.contextual
    }
}

/// All operators, from those that bind most tightly to those that bind least.
pub const TABLE: &[Row] = &[
    Row::new(Operator::Neg, "-", Fixity::Prefix, level::NEG, "minus f"),
    Row { lookalikes: "×·∙⋅＊", ..Row::arith(ArithOp::Mul, "*", "f times g, one of them a constant") },
    Row::arith(ArithOp::Divide, "/", "f divided by the constant g, of reals"),
    Row::arith(ArithOp::Div, "div", "f divided by the constant g, of integers, rounded down"),
    Row { slips: &["mod"], ..Row::arith(ArithOp::Mod, "%", "what remains of f then") },
    Row { lookalikes: "＋", ..Row::new(Operator::Plus, "+", Fixity::Flat, level::SUM, "f plus g") },
    Row {
        lookalikes: "−–—‐‑", ..Row::new(Operator::Minus, "-", Fixity::Flat, level::SUM, "f minus g")
    },
    Row { slips: &["=", "is"], ..Row::compare(CompareOp::Eq, "==", "f equals g") },
    Row { signs: &["≠"], slips: &["<>", "xor"], ..Row::compare(CompareOp::Ne, "!=", "f does not equal g") },
    Row { lookalikes: "＜‹", ..Row::compare(CompareOp::Lt, "<", "f is less than g") },
    Row { signs: &["≤"], slips: &["=<"], ..Row::compare(CompareOp::Le, "<=", "f is at most g") },
    Row { lookalikes: "＞›", ..Row::compare(CompareOp::Gt, ">", "f is greater than g") },
    Row { signs: &["≥"], ..Row::compare(CompareOp::Ge, ">=", "f is at least g") },
    Row {
        signs: &["∈"],
        ..Row::new(Operator::In, "in", Fixity::Unchained, level::COMPARE, "f is one of the set g")
    },
    Row {
        signs: &["¬"],
        slips: &["~", "not"],
        lookalikes: "！",
        ..Row::new(Operator::Not, "!", Fixity::Prefix, level::LOGIC_PREFIX, "f does not hold")
    },
    Row {
        signs: &["○", "◯"],
        slips: &["next"],
        ..Row::unary(UnaryOp::Next, "X", "there is a next position and f holds there")
    },
    Row::unary(UnaryOp::WeakNext, "N", "f holds at the next position, if there is one"),
    Row {
        signs: &["◇", "◊", "♢", "⋄"],
        slips: &["<>", "eventually", "finally"],
        interval: true,
        means: Some("true U[a,b] f"),
        ..Row::unary(UnaryOp::Finally, "F", "f holds at some step from a to b from now")
    },
    Row {
        signs: &["□", "◻"],
        slips: &["[]", "always", "globally"],
        interval: true,
        means: Some("false R[a,b] f"),
        ..Row::unary(UnaryOp::Globally, "G", "f holds at every step from a to b from now")
    },
    Row {
        signs: &["𝒰"],
        slips: &["until", "u"],
        ..Row::binary(
            BinaryOp::Until,
            "U",
            "g holds at some step t from a to b from now, and f at every step before t, from now on",
        )
    },
    Row {
        slips: &["release", "releases"],
        ..Row::binary(
            BinaryOp::Release,
            "R",
            "at every step from a to b from now g holds, or f did at some step, from now on, before it",
        )
    },
    Row {
        means: Some("(f U[a,b] g) | G[0,b] f"),
        ..Row::binary(BinaryOp::WeakUntil, "W", "f U[a,b] g, or f holds at every step up to b")
    },
    Row {
        contextual: true,
        means: Some("g U[a,b] (f & g)"),
        ..Row::binary(
            BinaryOp::StrongRelease,
            "M",
            "f and g hold at some step t from a to b from now, and g at every step before t, from now on",
        )
    },
    Row {
        signs: &["∧"],
        slips: &["&&", "/\\", "and"],
        lookalikes: "＆",
        ..Row::new(Operator::And, "&", Fixity::Flat, level::AND, "f and g hold")
    },
    Row {
        signs: &["∨"],
        slips: &["||", "\\/", "or"],
        lookalikes: "∣｜│",
        ..Row::new(Operator::Or, "|", Fixity::Flat, level::OR, "f or g holds")
    },
    Row {
        signs: &["⇒", "→"],
        slips: &["=>", "implies"],
        lookalikes: "⟶⟹⊃➔",
        means: Some("!f | g"),
        ..Row::new(Operator::Implies, "->", Fixity::Right, level::IMPLIES, "if f holds, so does g")
    },
    Row {
        signs: &["⇔", "↔"],
        slips: &["<=>", "iff"],
        lookalikes: "⟷⟺≡",
        ..Row::new(Operator::Iff, "<->", Fixity::Left, level::IFF, "both f and g hold, or neither")
    },
];

impl Operator {
    /// Its row.
    ///
    /// # Panics
    /// If there is none, which a test rules out.
    #[must_use]
    pub fn row(self) -> &'static Row {
        TABLE.iter().find(|row| row.operator == self).expect("every operator has a row, as a test says")
    }

    /// How it is written.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The one at the root of an expression.
    #[must_use]
    pub fn of(kind: &ExprKind) -> Option<Operator> {
        Some(match kind {
            ExprKind::Not(_) => Operator::Not,
            ExprKind::Neg(_) => Operator::Neg,
            ExprKind::And(_) => Operator::And,
            ExprKind::Or(_) => Operator::Or,
            ExprKind::Implies(..) => Operator::Implies,
            ExprKind::Iff(..) => Operator::Iff,
            ExprKind::Compare(op, ..) => Operator::Compare(*op),
            ExprKind::Sum(_) => Operator::Plus,
            ExprKind::Arith(op, ..) => Operator::Arith(*op),
            ExprKind::In(..) => Operator::In,
            ExprKind::Unary(op, ..) => Operator::Unary(*op),
            ExprKind::Binary(op, ..) => Operator::Binary(*op),
            ExprKind::Bool(_)
            | ExprKind::Number(_)
            | ExprKind::Name(_)
            | ExprKind::Primed(_)
            | ExprKind::Text(_)
            | ExprKind::At(..)
            | ExprKind::Cost(..)
            | ExprKind::Call(..)
            | ExprKind::Tuple(_)
            | ExprKind::If(..) => return None,
        })
    }
}

/// Whether an operator is written like a name.
pub(crate) fn is_word(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
}
