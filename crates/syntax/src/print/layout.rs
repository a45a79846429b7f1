//! Breaking text into lines (after Oppen, "Prettyprinting"): a group is printed on one line if it fits, else each of
//! its breaks ends a line.
//!
//! The text is a flat list of pieces; both passes over it are loops, so that nesting costs no call stack.

use std::borrow::Cow;

/// Lines are at most this long where they can be broken.
const WIDTH: usize = 100;

/// A piece of the text.
#[derive(Debug)]
enum Piece {
    Text(Cow<'static, str>),
    /// A comment, with `true` at the end of a line that has begun: what follows is on another line.
    Comment(String, bool),
    /// A blank, or a line break if the group is broken, indented by so much more than the group.
    Break(usize),
    /// A blank, or a line break if what comes before the next break does not fit.
    Fill,
    /// A line break; with `true` an empty line as well.
    Line(bool),
    Open(Indent),
    Close,
}

/// How far the lines of a group are indented.
#[derive(Clone, Copy, Debug)]
pub(super) enum Indent {
    /// By so much more than those of the group around it.
    By(usize),
    /// As the place where the group begins.
    Here,
}

/// A text on its way into lines.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pieces: Vec<Piece>,
}

impl Layout {
    pub(super) fn text(&mut self, text: impl Into<Cow<'static, str>>) {
        self.pieces.push(Piece::Text(text.into()));
    }

    /// A comment, with its slashes, beside what stands before it or on a line of its own; the line ends behind it.
    pub(super) fn comment(&mut self, text: String, beside: bool) {
        self.pieces.push(Piece::Comment(text, beside));
    }

    /// A blank, or a line break where the group does not fit on one line.
    pub(super) fn soft(&mut self) {
        self.soft_indented(0);
    }

    /// The same; the next line is indented by `more` than the group.
    pub(super) fn soft_indented(&mut self, more: usize) {
        self.pieces.push(Piece::Break(more));
    }

    /// A blank, or a line break where what follows does not fit.
    pub(super) fn fill(&mut self) {
        self.pieces.push(Piece::Fill);
    }

    /// A line break, unless a line begins here; with `blank` an empty line too.
    pub(super) fn line(&mut self, blank: bool) {
        self.pieces.push(Piece::Line(blank));
    }

    pub(super) fn open(&mut self, indent: Indent) {
        self.pieces.push(Piece::Open(indent));
    }

    pub(super) fn close(&mut self) {
        self.pieces.push(Piece::Close);
    }

    /// The text in lines, each ended.
    pub(super) fn finish(self) -> String {
        let measures = Measures::new(&self.pieces);
        let mut lines = Lines::default();
        let mut groups = vec![Group { indent: 0, broken: true }];
        for (at, piece) in self.pieces.iter().enumerate() {
            let group = groups.last().copied().unwrap_or_default();
            match piece {
                Piece::Text(text) => lines.text(text),
                Piece::Comment(text, beside) => {
                    if lines.due.is_some() {
                        // There is nothing to stand beside: it has a line of its own in this group.
                        lines.end(false, group.indent);
                    }
                    lines.comment(text, *beside);
                    lines.end(false, group.indent);
                }
                Piece::Break(more) if group.broken => lines.end(false, group.indent + more),
                Piece::Fill if group.broken && !lines.fits(1 + measures.chunks[at]) => {
                    lines.end(false, group.indent);
                }
                Piece::Break(_) | Piece::Fill => lines.blank(),
                Piece::Line(blank) => lines.end(*blank, group.indent),
                Piece::Open(indent) => {
                    let indent = match indent {
                        Indent::By(more) => group.indent + more,
                        Indent::Here => lines.column(),
                    };
                    groups.push(Group { indent, broken: group.broken && !lines.fits(measures.chunks[at]) });
                }
                Piece::Close => drop(groups.pop()),
            }
        }
        lines.end(false, 0);
        lines.finish()
    }
}

#[derive(Clone, Copy, Default)]
struct Group {
    indent: usize,
    broken: bool,
}

/// Longer than any line: the width of what cannot be on one.
const ENDLESS: usize = usize::MAX / 4;

/// For a group the width of it and of what cannot be parted from its end; for a break that of what stands before the
/// next break of its group.
struct Measures {
    chunks: Vec<usize>,
}

impl Measures {
    /// From the end to the beginning: each width adds up from those behind it.
    fn new(pieces: &[Piece]) -> Measures {
        let mut chunks = vec![0; pieces.len()];
        // The width from here up to the next break, of whatever group.
        let mut tail = 0_usize;
        let mut open: Vec<Open> = vec![Open::default()];
        for (at, piece) in pieces.iter().enumerate().rev() {
            let group = open.last_mut();
            match (piece, group) {
                (Piece::Close, _) => open.push(Open { chunk: tail, width: 0, tail }),
                (Piece::Open(_), _) => {
                    let closed = open.pop().unwrap_or_default();
                    chunks[at] = closed.width + closed.tail;
                    if let Some(around) = open.last_mut() {
                        around.add(closed.width);
                    }
                }
                (Piece::Text(text), Some(group)) => {
                    let width = text.chars().count();
                    tail += width;
                    group.add(width);
                }
                (Piece::Comment(..) | Piece::Line(_), Some(group)) => {
                    tail = 0;
                    group.width = ENDLESS;
                    group.chunk = 0;
                }
                (Piece::Break(_) | Piece::Fill, Some(group)) => {
                    chunks[at] = group.chunk;
                    tail = 0;
                    group.add(1);
                    group.chunk = 0;
                }
                (_, None) => {}
            }
        }
        Measures { chunks }
    }
}

/// A group whose end was passed.
#[derive(Default)]
struct Open {
    /// The width up to its next break.
    chunk: usize,
    /// Of what is in it.
    width: usize,
    /// Of what follows it up to the next break.
    tail: usize,
}

impl Open {
    fn add(&mut self, width: usize) {
        self.chunk = (self.chunk + width).min(ENDLESS);
        self.width = (self.width + width).min(ENDLESS);
    }
}

/// The lines so far.
#[derive(Default)]
struct Lines {
    out: String,
    /// Characters in the last line.
    column: usize,
    /// A line break that is due before the next text: whether with an empty line, and its indentation.
    due: Option<(bool, usize)>,
    /// A blank that is due before the next text on this line.
    blank: bool,
}

impl Lines {
    fn text(&mut self, text: &str) {
        if let Some((empty, indent)) = self.due.take() {
            self.out.push_str(if empty { "\n\n" } else { "\n" });
            self.out.extend(std::iter::repeat_n(' ', indent));
            self.column = indent;
        } else if self.blank {
            self.out.push(' ');
            self.column += 1;
        }
        // A blank at the end is due too: it is lost where the line ends.
        let shown = text.trim_end_matches(' ');
        self.blank = shown.len() < text.len();
        self.out.push_str(shown);
        self.column += shown.chars().count();
    }

    fn comment(&mut self, text: &str, beside: bool) {
        if beside && self.due.is_none() && !self.out.is_empty() {
            self.blank = false;
            self.out.push_str("  ");
        }
        self.text(text);
    }

    fn blank(&mut self) {
        self.blank = true;
    }

    fn end(&mut self, empty: bool, indent: usize) {
        self.blank = false;
        if !self.out.is_empty() {
            let empty = empty || self.due.is_some_and(|(empty, _)| empty);
            self.due = Some((empty, indent));
        }
    }

    /// Where the next text begins.
    fn column(&self) -> usize {
        self.due.map_or(self.column + usize::from(self.blank), |(_, indent)| indent)
    }

    fn fits(&self, width: usize) -> bool {
        self.column() + width <= WIDTH
    }

    fn finish(mut self) -> String {
        if !self.out.is_empty() {
            self.out.push('\n');
        }
        self.out
    }
}
