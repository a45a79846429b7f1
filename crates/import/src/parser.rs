//! Reading tokens: what the parsers of models and of formulas share, and expressions.
//!
//! Expressions are read by operator precedence. Chains are flat, and what nests is bounded, so that whatever walks a
//! tree may recurse.

use crate::dialect::{Binding, Grammar, USUAL};
pub(crate) use crate::lexer::Parse;
use crate::lexer::{Tok, Token};
use crate::tree::{Access, Bounds, Expr, Infix, Kind, Name, Word};
use hyperplan_syntax::ast::{BinaryOp, Ident, UnaryOp};
use hyperplan_syntax::{Diagnostic, Span};

/// Expressions nested more deeply are refused. Levels of the problem language are less deep than it allows itself.
const MAX_NESTING: u32 = 200;

/// How tightly operators bind, as NuSMV has it; for those in between, in which formula languages differ, see [`Grammar`].
mod level {
    pub(super) const CONDITION: u8 = 3;
    pub(super) const OR: u8 = 4;
    pub(super) const COMPARE: u8 = 8;
    pub(super) const IN: u8 = 9;
    pub(super) const UNION: u8 = 10;
    pub(super) const RANGE: u8 = 11;
    pub(super) const SHIFT: u8 = 12;
    pub(super) const SUM: u8 = 13;
    pub(super) const PRODUCT: u8 = 14;
    pub(super) const NEG: u8 = 15;
    pub(super) const CONCAT: u8 = 16;
    pub(super) const NOT: u8 = 17;
}

/// An operator between two operands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Op {
    And,
    Or,
    Union,
    Range,
    Plus,
    Minus,
    Xnor,
    If,
    Infix(Infix),
    Temporal(BinaryOp),
}

pub(crate) struct Parser<'a> {
    pub(crate) tokens: Vec<Token<'a>>,
    pub(crate) at: usize,
    depth: u32,
    /// The path variables of a formula; `None` in a model.
    pub(crate) paths: Option<Vec<String>>,
    /// Cases without one that always applies.
    pub(crate) open_cases: Vec<Span>,
    /// Between the stars of `*act[A]=1*`, where a star is no product.
    star: bool,
    /// How operators bind.
    grammar: &'static Grammar,
}

impl<'a> Parser<'a> {
    pub(crate) fn new(tokens: Vec<Token<'a>>) -> Self {
        Self::of(tokens, &USUAL)
    }

    pub(crate) fn of(tokens: Vec<Token<'a>>, grammar: &'static Grammar) -> Self {
        Parser { tokens, at: 0, depth: 0, paths: None, open_cases: Vec::new(), star: false, grammar }
    }

    pub(crate) fn token(&self) -> Token<'a> {
        self.token_at(0)
    }

    pub(crate) fn token_at(&self, ahead: usize) -> Token<'a> {
        self.tokens[(self.at + ahead).min(self.tokens.len() - 1)]
    }

    pub(crate) fn bump(&mut self) -> Token<'a> {
        let token = self.token();
        if token.tok != Tok::Eof {
            self.at += 1;
        }
        token
    }

    /// Whether this sign or keyword is next.
    pub(crate) fn is(&self, text: &str) -> bool {
        let token = self.token();
        matches!(token.tok, Tok::Sign | Tok::Word) && token.text == text
    }

    pub(crate) fn eat(&mut self, text: &str) -> bool {
        let found = self.is(text);
        self.at += usize::from(found);
        found
    }

    pub(crate) fn expect(&mut self, text: &str) -> Parse<Token<'a>> {
        if self.is(text) { Ok(self.bump()) } else { self.fail(&format!("`{text}`")) }
    }

    pub(crate) fn fail<T>(&self, expected: &str) -> Parse<T> {
        let token = self.token();
        let found = match token.tok {
            Tok::Eof => "the end of the file".to_owned(),
            _ => format!("`{}`", token.text),
        };
        let message = format!("expected {expected}, found {found}");
        Err(Box::new(Diagnostic::error("syntax", token.span, message).with_label("not expected here")))
    }

    pub(crate) fn refuse<T>(&self, span: Span, message: impl Into<String>, help: &str) -> Parse<T> {
        let error = Diagnostic::error("unsupported", span, message);
        Err(Box::new(if help.is_empty() { error } else { error.with_help(help) }))
    }

    pub(crate) fn name(&mut self, what: &str) -> Parse<Ident> {
        if self.token().tok != Tok::Word {
            return self.fail(what);
        }
        let token = self.bump();
        Ok(Ident { name: token.text.to_owned(), span: token.span })
    }

    /// One or more with commas between them.
    pub(crate) fn list<T>(&mut self, one: impl Fn(&mut Self) -> Parse<T>) -> Parse<Vec<T>> {
        let mut all = vec![one(self)?];
        while self.eat(",") {
            all.push(one(self)?);
        }
        Ok(all)
    }

    pub(crate) fn since(&self, start: Span) -> Span {
        start.to(self.tokens[self.at.saturating_sub(1)].span)
    }

    pub(crate) fn expr(&mut self) -> Parse<Expr> {
        self.operators(0)
    }

    /// What stands between signs that are no operators, as the ends of a range.
    pub(crate) fn sum(&mut self) -> Parse<Expr> {
        self.operators(level::SHIFT)
    }

    fn operators(&mut self, least: u8) -> Parse<Expr> {
        if self.depth >= MAX_NESTING {
            return too_deep(self.token().span);
        }
        self.depth += 1;
        let start = self.token().span;
        let mut left = self.operand()?;
        while let Some((op, binding)) = self.infix().filter(|(_, binding)| binding.level >= least) {
            self.bump();
            left = self.apply(op, binding, left, start)?;
        }
        self.depth -= 1;
        Ok(left)
    }

    /// A node over others, which began at `start`.
    fn node(&self, kind: Kind, start: Span) -> Parse<Expr> {
        let node = Expr::new(kind, self.since(start));
        if node.height > MAX_NESTING { too_deep(start) } else { Ok(node) }
    }

    fn apply(&mut self, op: Op, binding: Binding, left: Expr, start: Span) -> Parse<Expr> {
        let right = binding.right;
        let kind = match op {
            Op::And => Kind::And(self.chain(op, right, left)?),
            Op::Or => Kind::Or(self.chain(op, right, left)?),
            Op::Union => Kind::Union(self.chain(op, right, left)?),
            Op::Plus | Op::Minus => {
                let mut items = vec![(false, left), (op == Op::Minus, self.operators(right)?)];
                while let Some((next @ (Op::Plus | Op::Minus), _)) = self.infix() {
                    self.bump();
                    items.push((next == Op::Minus, self.operators(right)?));
                }
                Kind::Sum(items)
            }
            Op::Range => Kind::Range(Box::new(left), Box::new(self.operators(right)?)),
            Op::If => return self.condition(left, start),
            Op::Xnor => Kind::Infix(Infix::Iff, Box::new(left), Box::new(self.operators(right)?)),
            Op::Infix(infix) => Kind::Infix(infix, Box::new(left), Box::new(self.operators(right)?)),
            Op::Temporal(op) => {
                let bounds = self.bounds()?;
                Kind::Binary(op, bounds, Box::new(left), Box::new(self.operators(right)?))
            }
        };
        self.node(kind, start)
    }

    fn chain(&mut self, op: Op, right: u8, first: Expr) -> Parse<Vec<Expr>> {
        let mut items = vec![first, self.operators(right)?];
        while self.infix().is_some_and(|(next, _)| next == op) {
            self.bump();
            items.push(self.operators(right)?);
        }
        Ok(items)
    }

    /// `C ? A : B`, behind the `?`; a chain of them is flat.
    fn condition(&mut self, first: Expr, start: Span) -> Parse<Expr> {
        let mut branches = Vec::new();
        let mut condition = first;
        loop {
            let then = self.operators(level::CONDITION + 1)?;
            self.expect(":")?;
            branches.push((condition, then));
            let next = self.operators(level::CONDITION + 1)?;
            if !self.eat("?") {
                let kind = Kind::Case(branches, Some(Box::new(next)));
                return self.node(kind, start);
            }
            condition = next;
        }
    }

    fn infix(&self) -> Option<(Op, Binding)> {
        let token = self.token();
        if !matches!(token.tok, Tok::Sign | Tok::Word) {
            return None;
        }
        let formula = self.paths.is_some();
        let grammar = self.grammar;
        let infix = |op, level| Some((Op::Infix(op), Binding::left(level)));
        let bound = |op, binding| Some((op, binding));
        match token.text {
            "->" | "=>" | "→" => bound(Op::Infix(Infix::Implies), grammar.implies),
            "<->" | "<=>" | "↔" => bound(Op::Infix(Infix::Iff), grammar.iff),
            "?" if !formula => bound(Op::If, Binding::left(level::CONDITION)),
            "|" | "||" | "\\/" | "∨" => bound(Op::Or, grammar.or),
            "xor" => bound(Op::Infix(Infix::Xor), grammar.xor),
            "xnor" => bound(Op::Xnor, Binding::left(level::OR)),
            "&" | "&&" | "/\\" | "∧" => bound(Op::And, grammar.and),
            "U" if formula => bound(Op::Temporal(BinaryOp::Until), grammar.until),
            "R" if formula => bound(Op::Temporal(BinaryOp::Release), grammar.release),
            "W" if formula => bound(Op::Temporal(BinaryOp::WeakUntil), grammar.until),
            "M" if formula => bound(Op::Temporal(BinaryOp::StrongRelease), grammar.release),
            "=" | "==" => bound(Op::Infix(Infix::Eq), grammar.equal),
            "!=" => infix(Infix::Ne, level::COMPARE),
            "<" => infix(Infix::Lt, level::COMPARE),
            "<=" => infix(Infix::Le, level::COMPARE),
            ">" => infix(Infix::Gt, level::COMPARE),
            ">=" => infix(Infix::Ge, level::COMPARE),
            "in" => infix(Infix::In, level::IN),
            "union" => bound(Op::Union, Binding::left(level::UNION)),
            ".." => bound(Op::Range, Binding::left(level::RANGE)),
            "<<" => infix(Infix::ShiftLeft, level::SHIFT),
            ">>" => infix(Infix::ShiftRight, level::SHIFT),
            "+" => bound(Op::Plus, Binding::left(level::SUM)),
            "-" => bound(Op::Minus, Binding::left(level::SUM)),
            "*" if !self.star => infix(Infix::Mul, level::PRODUCT),
            "/" => infix(Infix::Div, level::PRODUCT),
            "mod" => infix(Infix::Mod, level::PRODUCT),
            "::" => infix(Infix::Concat, level::CONCAT),
            _ => None,
        }
    }

    fn operand(&mut self) -> Parse<Expr> {
        let token = self.token();
        let start = token.span;
        let kind = match (token.tok, token.text) {
            (Tok::Number, digits) => match digits.parse() {
                Ok(number) => {
                    self.bump();
                    Kind::Int(number)
                }
                Err(_) => return self.refuse(start, "the number does not fit in 62 bits", ""),
            },
            (Tok::WordNumber, text) => {
                self.bump();
                word_number(text).map_or_else(
                    || {
                        self.refuse(
                            start,
                            "this is no constant of a word type that is supported",
                            "write `0ud8_255`, `0sd8_-1`, `0b8_1010` or `0uh8_ff`, of at most 40 bits",
                        )
                    },
                    Ok,
                )?
            }
            (Tok::Word, "TRUE" | "true") => self.constant(true),
            (Tok::Word, "FALSE" | "false") => self.constant(false),
            (Tok::Sign, "!" | "~" | "¬") | (Tok::Word, "not") => {
                self.bump();
                let least = if self.paths.is_some() { self.grammar.unary } else { level::NOT };
                Kind::Not(Box::new(self.operators(least)?))
            }
            (Tok::Sign, "-") => {
                self.bump();
                Kind::Neg(Box::new(self.operators(level::NEG)?))
            }
            (Tok::Sign, "(") => return self.parenthesized(),
            (Tok::Sign, "{") if self.paths.is_some() => return self.braced(),
            (Tok::Sign, "{") => {
                self.bump();
                let members = self.list(Self::expr)?;
                self.expect("}")?;
                Kind::Set(members)
            }
            (Tok::Sign, "*") if self.paths.is_some() => return self.starred(),
            (Tok::Text, _) if self.paths.is_some() => return self.quoted(),
            (Tok::Word, "case") => return self.case(),
            (Tok::Word, "next") if self.token_at(1).text == "(" => {
                self.bump();
                self.bump();
                let inside = self.expr()?;
                self.expect(")")?;
                Kind::Next(Box::new(inside))
            }
            (Tok::Word, word) => match temporal(word).filter(|_| self.begins_temporal()) {
                Some(op) => {
                    self.bump();
                    let bounds = if op == UnaryOp::Next { None } else { self.bounds()? };
                    Kind::Unary(op, bounds, Box::new(self.operators(self.grammar.unary)?))
                }
                None => return self.named(),
            },
            _ => return self.fail("an expression"),
        };
        self.node(kind, start)
    }

    fn constant(&mut self, value: bool) -> Kind {
        self.bump();
        Kind::Bool(value)
    }

    /// Whether the letter at hand is an operator: in a formula, with no path behind it.
    fn begins_temporal(&self) -> bool {
        let behind = self.token_at(2).text;
        let next = self.token_at(1);
        let operand = match next.tok {
            Tok::Sign => match next.text {
                "[" => !self.is_path(behind),
                sign => matches!(sign, "(" | "{" | "*" | "!" | "~" | "¬" | "-"),
            },
            Tok::Word => {
                !matches!(next.text, "U" | "R" | "W" | "M" | "xor" | "xnor" | "in" | "union" | "mod")
            }
            Tok::Number | Tok::WordNumber | Tok::Text => true,
            Tok::Eof => false,
        };
        self.paths.is_some() && operand
    }

    fn is_path(&self, name: &str) -> bool {
        self.paths.iter().flatten().any(|path| path == name)
    }

    /// `[a,b]` behind a temporal operator.
    fn bounds(&mut self) -> Parse<Bounds> {
        if !(self.is("[") && self.token_at(1).tok == Tok::Number) {
            return Ok(None);
        }
        self.bump();
        let number = |parser: &mut Self| -> Parse<u32> {
            let token = parser.bump();
            match token.text.parse() {
                Ok(number) if token.tok == Tok::Number => Ok(number),
                _ => parser.refuse(token.span, "this is no number of steps", ""),
            }
        };
        let first = number(self)?;
        let interval = if self.eat(",") { (first, number(self)?) } else { (0, first) };
        self.expect("]")?;
        Ok(Some(interval))
    }

    fn parenthesized(&mut self) -> Parse<Expr> {
        let open = self.bump();
        let inside = self.expr()?;
        if !self.is(")") {
            let mut error = *self.fail::<Expr>("an operator or `)`").expect_err("it fails");
            error.related.push((open.span, "opened here".to_owned()));
            return Err(Box::new(error));
        }
        self.bump();
        Ok(inside)
    }

    /// `name`, with what is read of it; in a formula with the path.
    fn named(&mut self) -> Parse<Expr> {
        let base = self.bump();
        if self.is("(") && self.paths.is_none() {
            self.bump();
            let arguments = self.list(Self::expr)?;
            self.expect(")")?;
            let ident = Ident { name: base.text.to_owned(), span: base.span };
            return self.node(Kind::Call(ident, arguments), base.span);
        }
        let mut access = Vec::new();
        loop {
            if self.is(".") && self.token_at(1).tok == Tok::Word {
                self.bump();
                access.push(Access::Dot(self.bump().text.to_owned()));
            } else if self.is("[") && !(self.is_path(self.token_at(1).text) && self.token_at(2).text == "]") {
                self.bump();
                let first = self.expr()?;
                if self.eat(":") {
                    access.push(Access::Bits(first, self.expr()?));
                } else {
                    access.push(Access::Index(first));
                }
                self.expect("]")?;
            } else {
                break;
            }
        }
        let name = Kind::Name(Name { base: base.text.to_owned(), access });
        let name = self.node(name, base.span)?;
        if !self.eat("[") {
            return Ok(name);
        }
        let path = self.name("a path")?;
        self.expect("]")?;
        self.node(Kind::At(Box::new(name), path), base.span)
    }

    /// `{E}_A`
    fn braced(&mut self) -> Parse<Expr> {
        let open = self.bump();
        let inside = self.expr()?;
        self.expect("}")?;
        self.of_path(inside, open.span, true)
    }

    /// `*E*`, perhaps with `_A` behind it.
    fn starred(&mut self) -> Parse<Expr> {
        let open = self.bump();
        let before = std::mem::replace(&mut self.star, true);
        let inside = self.expr();
        self.star = before;
        let inside = inside?;
        self.expect("*")?;
        self.of_path(inside, open.span, false)
    }

    /// `"x"_A`
    fn quoted(&mut self) -> Parse<Expr> {
        let token = self.bump();
        let base = token.text.trim_matches('"').to_owned();
        let name = Expr::new(Kind::Name(Name { base, access: Vec::new() }), token.span);
        self.of_path(name, token.span, false)
    }

    fn of_path(&mut self, inside: Expr, start: Span, needed: bool) -> Parse<Expr> {
        let token = self.token();
        let path = token.text.strip_prefix('_').filter(|path| token.tok == Tok::Word && self.is_path(path));
        match path {
            Some(path) => {
                self.bump();
                let path = Ident { name: path.to_owned(), span: token.span };
                self.node(Kind::At(Box::new(inside), path), start)
            }
            // Of several paths, each with its own: `{"x"_A > "x"_B}`.
            None if needed && !reads_path(&inside) => self.fail("`_` and a path, as in `{goal}_A`"),
            None => Ok(inside),
        }
    }

    /// `case C : E; ... esac`. A last value that is a `case` itself goes on with the same list.
    fn case(&mut self) -> Parse<Expr> {
        let start = self.bump().span;
        let mut branches: Vec<(Expr, Expr)> = Vec::new();
        let mut open = 1;
        let mut decided = false;
        while open > 0 {
            if self.eat("esac") {
                open -= 1;
                if open > 0 {
                    self.expect(";")?;
                }
                continue;
            }
            let condition = self.expr()?;
            self.expect(":")?;
            let always = matches!(condition.kind, Kind::Bool(true) | Kind::Int(1));
            if always && self.is("case") && !decided {
                self.bump();
                open += 1;
                continue;
            }
            let value = self.expr()?;
            // HyperQB 2.0 does without the last one.
            if !self.is("esac") {
                self.expect(";")?;
            }
            // What stands behind a case that always applies is never reached.
            if !decided {
                branches.push((condition, value));
            }
            decided |= always;
        }
        if !decided {
            self.open_cases.push(start);
        }
        let span = self.since(start);
        let last = if decided { branches.pop().map(|(_, last)| last) } else { None };
        match (branches.is_empty(), last) {
            (true, Some(only)) => Ok(only),
            (true, None) => self.refuse(span, "a `case` without cases", ""),
            (false, last) => self.node(Kind::Case(branches, last.map(Box::new)), start),
        }
    }
}

fn too_deep<T>(span: Span) -> Parse<T> {
    let message = format!("this expression is nested more than {MAX_NESTING} levels deep");
    Err(Box::new(Diagnostic::error("too-deep", span, message).with_help("name parts of it in DEFINE")))
}

/// Whether some part says of which path it is.
fn reads_path(e: &Expr) -> bool {
    match &e.kind {
        Kind::At(..) => true,
        Kind::Not(a) | Kind::Neg(a) => reads_path(a),
        Kind::Infix(_, a, b) => reads_path(a) || reads_path(b),
        Kind::And(es) | Kind::Or(es) => es.iter().any(reads_path),
        Kind::Sum(es) => es.iter().any(|(_, e)| reads_path(e)),
        _ => false,
    }
}

fn temporal(word: &str) -> Option<UnaryOp> {
    Some(match word {
        "F" => UnaryOp::Finally,
        "G" => UnaryOp::Globally,
        "X" => UnaryOp::Next,
        "N" => UnaryOp::WeakNext,
        _ => return None,
    })
}

/// `0ud8_255`, `0b4_1010`, `0uh8_ff`, `0b1010`; a sign is not read here.
fn word_number(text: &str) -> Option<Kind> {
    let rest = &text[1..];
    let (signed, rest) = match rest.as_bytes().first()? {
        b's' => (true, &rest[1..]),
        b'u' => (false, &rest[1..]),
        _ => (false, rest),
    };
    let radix = match rest.as_bytes().first()? {
        b'b' => 2,
        b'o' => 8,
        b'd' => 10,
        b'h' => 16,
        _ => return None,
    };
    let (width, digits) = match rest[1..].split_once('_') {
        Some((width, digits)) => (width.parse().ok()?, digits),
        None if radix == 2 => (u32::try_from(rest.len() - 1).ok()?, &rest[1..]),
        None => return None,
    };
    let word = Word { signed, width };
    let value = i64::from_str_radix(&digits.replace('_', ""), radix).ok()?;
    if !(1..=MAX_WIDTH).contains(&width) || value >= 1 << width {
        return None;
    }
    let (_, most) = word.bounds();
    Some(Kind::Word(word, if value > most { value - (1 << width) } else { value }))
}

/// Words of more bits are refused: bounds of ranges are integers of the problem language.
pub(crate) const MAX_WIDTH: u32 = 40;
