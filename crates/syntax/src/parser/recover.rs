//! Going on behind a mistake, so that one run shows several, and none twice.

use super::{Abort, Parse, Parser};
use crate::diagnostic::Diagnostic;
use crate::similar::similar;
use crate::span::Span;
use crate::token::{EQUALS, Tok, Token};

/// Words that begin a top-level declaration.
pub(super) const TOP: &[&str] = &["const", "system", "template", "define", "objective"];

/// Words that begin an item of a system.
pub(super) const ITEMS: &[&str] = &[
    "state",
    "action",
    "on",
    "also",
    "init",
    "label",
    "cost",
    "observe",
    "absorb",
    "trans",
    "moves",
    "obstacle",
    "edge",
    "corner",
    "legend",
    "scenario",
    "unknown",
    "inflate",
    "scale",
    "crop",
    "clearance",
];

/// What a block holds, and so where its next member begins.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Block {
    File,
    System,
    Updates,
    /// The definitions at the head of a formula.
    Defines,
    /// Quantifiers and a formula, which no `;` ends.
    Formula,
}

impl Parser<'_> {
    /// Whether a member of the block begins at the present token.
    pub(super) fn at_member(&self, block: Block) -> bool {
        let (token, next) = (self.token(), self.peek_at(1));
        if token.tok != Tok::Ident {
            return false;
        }
        match block {
            Block::File => {
                let named = matches!(self.peek_at(2), Tok::LBrace | Tok::LParen | Tok::Assign);
                let misspelt = || named && next == Tok::Ident && self.begins_misspelt(TOP);
                TOP.contains(&token.text) && self.token_at(1).is_word() || misspelt()
            }
            Block::System => {
                let begins = matches!(next, Tok::LBracket | Tok::LParen | Tok::Assign | EQUALS);
                let expression = matches!(
                    token.text,
                    "init" | "observe" | "absorb" | "trans" | "inflate" | "scale" | "crop"
                ) && next == Tok::LParen;
                let misspelt = || next == Tok::Ident && self.begins_misspelt(ITEMS);
                ITEMS.contains(&token.text) && (!begins || expression) || misspelt()
            }
            Block::Updates => next == Tok::Prime,
            Block::Defines | Block::Formula => token.text == "define" && self.token_at(1).is_word(),
        }
    }

    /// Skips what is left of a member that could not be parsed; it began at the token `start`, with
    /// so many braces open.
    fn recover(&mut self, block: Block, start: usize, braces: u32) {
        loop {
            let token = self.token();
            let inside = self.braces > braces;
            let next = token.first_on_line || !inside && self.closed_before();
            if token.tok == Tok::Eof || self.at > start && next && self.at_next(block) {
                break;
            }
            match token.tok {
                Tok::RBrace if !inside && block != Block::File => break,
                Tok::Semi if !inside && block != Block::Formula => {
                    self.bump();
                    break;
                }
                _ => {
                    self.bump();
                }
            }
        }
        self.braces = braces;
    }

    /// Whether a line begins here with a word that is probably meant to be one of `words`.
    fn begins_misspelt(&self, words: &[&str]) -> bool {
        self.token().first_on_line && similar(self.token().text, words.iter().copied()).is_some()
    }

    /// Whether another member of the block, or of one around it, begins at the present token.
    fn at_next(&self, block: Block) -> bool {
        self.at_member(block)
            || self.at_member(Block::File)
            || block == Block::Updates && self.at_member(Block::System)
            || block == Block::Defines && matches!(self.peek(), Tok::Exists | Tok::Forall)
    }

    fn closed_before(&self) -> bool {
        self.at > 0 && self.tokens[self.at - 1].tok == Tok::RBrace
    }

    /// Parses one member by `parse`, or skips it. Always gets ahead.
    pub(super) fn member<T>(&mut self, block: Block, parse: impl FnOnce(&mut Self) -> Parse<T>) -> Option<T> {
        let (start, braces) = (self.at, self.braces);
        match parse(self) {
            Ok(parsed) => Some(parsed),
            Err(Abort) => {
                self.recover(block, start, braces);
                if self.at == start {
                    self.bump();
                    self.braces = braces;
                }
                // Formulas and updates declare nothing.
                if !matches!(block, Block::Formula | Block::Updates) {
                    self.skipped_from(self.tokens[start].span);
                }
                None
            }
        }
    }

    /// Notes that what stands from `start` up to here is not in the tree.
    pub(super) fn skipped_from(&mut self, start: Span) {
        let skipped = self.since(start);
        self.skipped.push(skipped);
    }

    /// The `;` that ends a member. Where the next member begins all the same, it is only reported.
    pub(super) fn semicolon(&mut self, block: Block, after: &str, expected: &str) -> Parse<()> {
        let token = self.token();
        if self.eat(Tok::Semi).is_some() {
            return Ok(());
        }
        let ends = matches!(token.tok, Tok::RBrace | Tok::Eof);
        if ends || token.first_on_line && self.at_next(block) {
            let error =
                Diagnostic::error("missing-semicolon", self.behind(), format!("expected `;` after {after}"));
            self.report(error.with_label("`;` missing here"));
            return Ok(());
        }
        let help = match token.tok {
            Tok::Comma if block == Block::Updates => "an update ends with `;`",
            Tok::Prime if block == Block::Updates => {
                "only the left side of an update has a prime: `x' = x + 1;`"
            }
            _ => match self.instead_of_operator() {
                Some(help) => help,
                None => return self.fail(expected),
            },
        };
        self.fail_with(expected, Some(help.to_owned()))
    }

    /// The `}` of the block that `open` opened, if it is there.
    pub(super) fn close_block(&mut self, open: Token<'_>, expected: &str) {
        if self.eat(Tok::RBrace).is_some() {
            return;
        }
        let token = self.token();
        if token.tok == Tok::Bad {
            return;
        }
        let message = format!("expected {expected}, found {}", token.describe());
        let error = Diagnostic::error("unclosed-brace", token.span, message);
        self.report(error.with_label("`}` missing before this").with_related(open.span, "opened here"));
        self.braces = self.braces.saturating_sub(1);
    }

    /// Whether a block ends here: at its `}`, or where a declaration that cannot stand inside, or
    /// the end of the file, shows that the `}` is missing.
    pub(super) fn block_ends(&self, block: Block) -> bool {
        let token = self.token();
        match token.tok {
            Tok::RBrace | Tok::Eof => true,
            Tok::Ident if self.at_member(block) => false,
            // An indented declaration is rather one in the wrong place.
            Tok::Ident if block == Block::System => self.at_member(Block::File) && !self.is_indented(),
            Tok::Ident => token.first_on_line && self.at_next(block),
            _ => false,
        }
    }

    fn is_indented(&self) -> bool {
        let before = self.text.get(..self.token().span.start as usize).unwrap_or("");
        before.ends_with([' ', '\t'])
    }

    /// Reports a likely slip: what stands at `span` is not of this language, `instead` is.
    pub(super) fn wrong(&mut self, span: Span, message: impl Into<String>, help: impl Into<String>) {
        self.report(Diagnostic::error("wrong-operator", span, message).with_help(help));
    }
}
