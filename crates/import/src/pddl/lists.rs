//! PDDL as lists within lists.

use crate::build::wrong;
use crate::parser::Parse;
use hyperplan_syntax::{SourceId, Span};

/// Lists nested more deeply are refused, so that what walks them may recurse.
const MAX_NESTING: usize = 100;

/// A word, in small letters, or a list.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub(super) kind: Kind,
    pub(super) span: Span,
}

#[derive(Clone, Debug)]
pub(super) enum Kind {
    Word(String),
    List(Vec<Node>),
}

impl Node {
    pub(super) fn word(&self) -> Parse<&str> {
        match &self.kind {
            Kind::Word(word) => Ok(word),
            Kind::List(_) => wrong("syntax", self.span, "expected a word"),
        }
    }

    pub(super) fn list(&self) -> Parse<&[Node]> {
        match &self.kind {
            Kind::List(items) => Ok(items),
            Kind::Word(word) => wrong("syntax", self.span, format!("expected a list in place of `{word}`")),
        }
    }

    /// The first word of a list, and what follows.
    pub(super) fn headed(&self) -> Parse<(&str, &[Node])> {
        match self.list()?.split_first() {
            Some((first, rest)) => Ok((first.word()?, rest)),
            None => wrong("syntax", self.span, "this list is empty"),
        }
    }
}

/// The lists of a text.
pub(super) fn read(source: SourceId, text: &str) -> Parse<Vec<Node>> {
    let bytes = text.as_bytes();
    // Lists that are open, each with its beginning.
    let mut open: Vec<(usize, Vec<Node>)> = vec![(0, Vec::new())];
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let here = |length: usize| Span::new(source, at..at + length);
        match byte {
            b';' => at += text[at..].find('\n').unwrap_or(text.len() - at),
            b'(' if open.len() > MAX_NESTING => {
                return wrong(
                    "too-deep",
                    here(1),
                    format!("lists are nested more than {MAX_NESTING} levels deep"),
                );
            }
            b'(' => {
                open.push((at, Vec::new()));
                at += 1;
            }
            b')' => {
                let (Some((start, items)), Some((_, outer))) = (open.pop(), open.last_mut()) else {
                    return wrong("syntax", here(1), "this `)` closes nothing");
                };
                outer.push(Node { kind: Kind::List(items), span: Span::new(source, start..at + 1) });
                at += 1;
            }
            _ if byte.is_ascii_whitespace() => at += 1,
            _ => {
                let ends = |c: char| c.is_ascii_whitespace() || matches!(c, '(' | ')' | ';');
                let length = text[at..].find(ends).unwrap_or(text.len() - at);
                let word = text[at..at + length].to_lowercase();
                if let Some((_, items)) = open.last_mut() {
                    items.push(Node { kind: Kind::Word(word), span: here(length) });
                }
                at += length;
            }
        }
    }
    match (open.pop(), open.is_empty()) {
        (Some((_, items)), true) => Ok(items),
        (unclosed, _) => {
            let start = unclosed.map_or(0, |(start, _)| start);
            wrong("syntax", Span::new(source, start..start + 1), "this `(` has no closing `)`")
        }
    }
}
