//! What the tree does not have: comments, blank lines, and where brackets close.

use crate::lexer::{Comment, lex};
use crate::span::SourceId;
use crate::token::Tok;

/// The text that a tree was parsed from, or nothing.
pub(super) struct Source<'a> {
    text: &'a str,
    comments: Vec<Comment<'a>>,
    /// Comments that were printed.
    printed: usize,
    /// Where each `{` is and its `}`, by the former.
    braces: Vec<(usize, usize)>,
    semicolons: Vec<usize>,
    /// Where each token begins, and which it is.
    tokens: Vec<(usize, Tok)>,
}

impl<'a> Source<'a> {
    pub(super) fn new(text: &'a str) -> Source<'a> {
        let lexemes = lex(SourceId(0), text);
        let mut source = Source {
            text,
            comments: lexemes.comments,
            printed: 0,
            braces: Vec::new(),
            semicolons: Vec::new(),
            tokens: lexemes.tokens.iter().map(|token| (token.span.start as usize, token.tok)).collect(),
        };
        let mut open = Vec::new();
        for token in &lexemes.tokens {
            let at = token.span.start as usize;
            match token.tok {
                Tok::LBrace => {
                    open.push(source.braces.len());
                    source.braces.push((at, text.len()));
                }
                Tok::RBrace => {
                    if let Some(brace) = open.pop().and_then(|nth: usize| source.braces.get_mut(nth)) {
                        brace.1 = at;
                    }
                }
                Tok::Semi => source.semicolons.push(at),
                _ => {}
            }
        }
        source
    }

    /// Whether there is a text at all.
    pub(super) fn is_known(&self) -> bool {
        !self.text.is_empty()
    }

    /// The first braces that open at `at` or later: where they open and where they close.
    pub(super) fn braces(&self, at: usize) -> (usize, usize) {
        let nth = self.braces.partition_point(|(open, _)| *open < at);
        self.braces.get(nth).copied().unwrap_or((at, at))
    }

    /// Whether the first token at `at` or later opens a brace.
    pub(super) fn opens(&self, at: usize) -> bool {
        let nth = self.tokens.partition_point(|(start, _)| *start < at);
        self.tokens.get(nth).is_some_and(|(_, tok)| *tok == Tok::LBrace)
    }

    /// Where the word in front of `at` begins, parentheses between them passed over.
    pub(super) fn word_before(&self, at: usize) -> usize {
        let behind = self.tokens.partition_point(|(start, _)| *start < at);
        let word = self.tokens[..behind].iter().rev().find(|(_, tok)| *tok != Tok::LParen);
        word.map_or(at, |(start, _)| *start)
    }

    /// Where the parentheses around what stands at `at` begin.
    pub(super) fn opening(&self, at: usize) -> usize {
        let behind = self.tokens.partition_point(|(start, _)| *start < at);
        let open = self.tokens[..behind].iter().rev().take_while(|(_, tok)| *tok == Tok::LParen).last();
        open.map_or(at, |(start, _)| *start)
    }

    /// The first `;` at `at` or later.
    pub(super) fn semicolon(&self, at: usize) -> usize {
        let nth = self.semicolons.partition_point(|semicolon| *semicolon < at);
        self.semicolons.get(nth).copied().unwrap_or(at)
    }

    /// The next comment that is still to be printed, if it begins before `at`.
    pub(super) fn next_comment(&mut self, at: usize) -> Option<Comment<'a>> {
        let comment = self.comments.get(self.printed).copied().filter(|comment| comment.start < at)?;
        self.printed += 1;
        Some(comment)
    }

    /// How many comments are still to be printed before `at`.
    pub(super) fn comments_before(&self, at: usize) -> usize {
        self.comments[self.printed..].iter().take_while(|comment| comment.start < at).count()
    }

    /// Whether a line ends between two places.
    pub(super) fn breaks_between(&self, start: usize, end: usize) -> bool {
        self.text.get(start..end).is_some_and(|between| between.contains(['\n', '\r']))
    }

    /// Whether nothing stands before `at` on its line.
    pub(super) fn begins_line(&self, at: usize) -> bool {
        self.line_breaks_before(at) > 0
    }

    /// Whether there is an empty line above.
    pub(super) fn is_apart(&self, at: usize) -> bool {
        self.line_breaks_before(at) > 1
    }

    fn line_breaks_before(&self, at: usize) -> usize {
        let before = self.text.get(..at).unwrap_or("");
        let blanks = &before[before.trim_end().len()..];
        let breaks = blanks.matches('\n').count();
        if breaks == 0 { blanks.matches('\r').count() } else { breaks }
    }
}
