//! The lines of a source that a message shows: few, short, and without characters that could
//! disturb a terminal.

use std::collections::BTreeSet;

use hyperplan_outlet::{is_harmless, one_line};
use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};

use crate::span::{Source, Span};

/// Lines shown above and below a marked one.
const CONTEXT: usize = 1;

/// A place that covers more lines than this is marked on its first line only.
const MAX_LINES: usize = 6;

/// Some lines of one source, with marks.
#[derive(Debug)]
pub(crate) struct Excerpt {
    name: String,
    /// The shown lines of all pieces, one behind the other.
    text: String,
    pieces: Vec<Piece>,
    /// In the order of the spans that the excerpt was made for.
    pub(crate) marks: Vec<Mark>,
}

/// Consecutive lines.
#[derive(Debug)]
struct Piece {
    start: usize,
    end: usize,
    first_line: usize,
    lines: usize,
}

/// A span, as it lies in [`Excerpt::text`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    pub(crate) offset: usize,
    pub(crate) length: usize,
    /// From 0, in the whole source.
    line: usize,
    /// From 0, in characters, in the whole line.
    column: usize,
}

/// A span as lines and bytes within them.
struct Place {
    line: usize,
    start: usize,
    last_line: usize,
    end: usize,
}

impl Excerpt {
    /// The surroundings of `spans`, which are all of `source`; no line is much longer than `width`.
    pub(crate) fn new(source: &Source, spans: &[Span], width: usize) -> Excerpt {
        let text: &str = &source.text;
        let mut starts = vec![0];
        starts.extend(text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at + 1));
        let line_text = |line: usize| {
            let end = starts.get(line + 1).map_or(text.len(), |next| next - 1);
            text[starts[line]..end].trim_end_matches('\r')
        };
        let places: Vec<Place> =
            spans.iter().map(|span| Place::new(text, &starts, *span, &line_text)).collect();
        let shown: BTreeSet<usize> = places
            .iter()
            .flat_map(|place| {
                place.line.saturating_sub(CONTEXT)..=(place.last_line + CONTEXT).min(starts.len() - 1)
            })
            .collect();

        let mut excerpt = Excerpt {
            name: one_line(&source.name).into_owned(),
            text: String::new(),
            pieces: Vec::new(),
            marks: Vec::new(),
        };
        let blank = Mark { offset: 0, length: 0, line: 0, column: 0 };
        excerpt.marks.resize(places.len(), blank);
        for line in shown {
            let content = line_text(line);
            let window = window(content, places.iter().find(|place| place.line == line), width);
            excerpt.begin_line(line);
            let offset = excerpt.text.len();
            let put = |byte: usize| offset + byte.clamp(window.start, window.end) - window.start;
            for (mark, place) in excerpt.marks.iter_mut().zip(&places) {
                if place.line == line {
                    *mark = Mark {
                        offset: put(place.start),
                        length: 0,
                        line,
                        column: content[..place.start].chars().count(),
                    };
                }
                if place.last_line == line {
                    mark.length = put(place.end).saturating_sub(mark.offset);
                }
            }
            excerpt.text.extend(content[window].chars().map(harmless));
            excerpt.text.push('\n');
            if let Some(piece) = excerpt.pieces.last_mut() {
                piece.end = excerpt.text.len();
            }
        }
        excerpt
    }

    fn begin_line(&mut self, line: usize) {
        match self.pieces.last_mut() {
            Some(piece) if piece.first_line + piece.lines == line => piece.lines += 1,
            _ => {
                let start = self.text.len();
                self.pieces.push(Piece { start, end: start, first_line: line, lines: 1 });
            }
        }
    }
}

impl Place {
    fn new<'t>(text: &'t str, starts: &[usize], span: Span, line_text: &impl Fn(usize) -> &'t str) -> Place {
        let on_boundary = |byte: u32| text.floor_char_boundary(byte as usize);
        let (start, end) = (on_boundary(span.start), on_boundary(span.end.max(span.start)));
        let line_of = |byte: usize| starts.partition_point(|&start| start <= byte) - 1;
        let within = |line: usize, byte: usize| (byte - starts[line]).min(line_text(line).len());
        let line = line_of(start);
        // A span that ends with a line break ends on the line that it breaks.
        let last_line = line_of(end.saturating_sub(1).max(start));
        let first = within(line, start);
        if last_line - line > MAX_LINES {
            return Place { line, start: first, last_line: line, end: line_text(line).len() };
        }
        Place { line, start: first, last_line, end: within(last_line, end) }
    }
}

/// Which bytes of a line to show: all of them, or some around the marked place.
fn window(content: &str, place: Option<&Place>, width: usize) -> std::ops::Range<usize> {
    let width = width.max(40);
    if content.len() <= width {
        return 0..content.len();
    }
    let marked = place.map_or(0, |place| place.start);
    let start = if marked < width * 3 / 4 { 0 } else { content.floor_char_boundary(marked - width / 2) };
    start..content.floor_char_boundary(start + width)
}

/// The character, or another of the same length in UTF-8 if it could disturb a terminal.
fn harmless(c: char) -> char {
    match c {
        '\t' => c,
        // Nobody sees these.
        '\u{200b}'..='\u{200d}' | '\u{feff}' => '\u{fffd}',
        c if is_harmless(c) => c,
        c => match c.len_utf8() {
            1 => '?',
            2 => '\u{bf}',
            _ => '\u{fffd}',
        },
    }
}

impl SourceCode for Excerpt {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        lines_before: usize,
        lines_after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let end = span.offset() + span.len();
        let piece = self.pieces.iter().find(|piece| piece.start <= span.offset() && end <= piece.end);
        let piece = piece.ok_or(MietteError::OutOfBounds)?;
        // Without context, it is the position that is asked for.
        let mark = self.marks.iter().find(|mark| mark.offset == span.offset());
        let (line, column) = match mark {
            Some(mark) if lines_before + lines_after == 0 => (mark.line, mark.column),
            _ => (piece.first_line, 0),
        };
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            &self.text.as_bytes()[piece.start..piece.end],
            (piece.start, piece.end - piece.start).into(),
            line,
            column,
            piece.lines,
        )))
    }
}
