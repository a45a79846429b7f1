//! From rows of letters to a map.

use super::{Cell, Lettered, MAX_READ, Occupancy, Raster};
use crate::lower::Diagnostics;
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::{FxHashMap, FxHashSet};

/// One row of a map's text, top row first.
#[derive(Clone, Debug)]
pub(crate) struct Row<'a> {
    pub(crate) text: &'a str,
    /// Its place in its source, the quotes included where it has some.
    pub(crate) span: Span,
    /// Whether the bytes of `text` are those of the source from `span.start` on.
    pub(crate) verbatim: bool,
}

/// Whose letters the rows use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Format {
    /// Our own: `.` or space free, `#` or `@` obstacle, `S` and `G` labels.
    #[default]
    Text,
    /// The terrain of the Moving AI Lab's benchmarks. `.` and `G` are ground and `S` is swamp, which can be walked
    /// on; `@` and `O` are out of bounds, `T` is trees and `W` water, which cannot.
    MovingAi,
}

/// What a letter stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Free,
    Obstacle,
    /// A free cell that carries a label.
    Labelled(String),
}

/// Letters to which the problem file gives a meaning.
pub(crate) type Legend = Vec<(char, Meaning)>;

impl Format {
    /// What the letter means without a legend.
    pub(crate) fn meaning(self, letter: char) -> Option<Meaning> {
        match (self, letter) {
            (_, '.') => Some(Meaning::Free),
            (_, '@') => Some(Meaning::Obstacle),
            (Format::Text, ' ') => Some(Meaning::Free),
            (Format::Text, '#') => Some(Meaning::Obstacle),
            (Format::Text, 'S') => Some(Meaning::Labelled("start".into())),
            (Format::Text, 'G') => Some(Meaning::Labelled("goal".into())),
            (Format::MovingAi, 'G' | 'S') => Some(Meaning::Free),
            (Format::MovingAi, 'O' | 'T' | 'W') => Some(Meaning::Obstacle),
            _ => None,
        }
    }

    /// Whether a legend may give the letter another meaning: the terrain letters of a benchmark say nothing about
    /// a problem, ours do.
    pub(crate) fn may_redefine(self, letter: char) -> bool {
        self.meaning(letter).is_none() || (self == Format::MovingAi && letter.is_ascii_alphabetic())
    }
}

/// A map from its rows; `whole` is the place of all of it. `None` after a message.
pub(crate) fn from_rows(
    rows: &[Row],
    format: Format,
    legend: &Legend,
    whole: Span,
    diagnostics: &mut Diagnostics,
) -> Option<Raster> {
    let width = rectangle(rows, whole, diagnostics)?;
    let height = rows.len();
    let mut reader = Reader {
        format,
        legend: legend.iter().cloned().collect(),
        ascii: [None; 128],
        map: Raster::new(number(width), number(height)),
        unknown: FxHashSet::default(),
        failed: false,
    };
    // Labels of the legend exist even where no cell carries them; `start` and `goal` only where a letter says so.
    for (letter, meaning) in legend {
        if let Meaning::Labelled(label) = meaning {
            labelled(&mut reader.map.labels, label, Some(*letter));
        }
    }
    for (index, row) in rows.iter().enumerate() {
        let y = number(height - 1 - index);
        for (x, (offset, letter)) in row.text.char_indices().enumerate() {
            match reader.meaning(letter) {
                Some(what) => reader.cell(what, (number(x), y)),
                None => reader.refuse(letter, || place(row, offset, letter), diagnostics),
            }
        }
    }
    let Reader { mut map, failed: false, .. } = reader else { return None };
    map.labels.iter_mut().for_each(|label| label.cells.sort_unstable());
    Some(map)
}

fn number(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// The place of a letter in its row.
fn place(row: &Row, offset: usize, letter: char) -> Span {
    if !row.verbatim {
        return row.span;
    }
    let start = row.span.start as usize + offset;
    Span::new(row.span.source, start..start + letter.len_utf8())
}

/// The common width of all rows; a message for each row that has another (up to a few).
fn rectangle(rows: &[Row], whole: Span, diagnostics: &mut Diagnostics) -> Option<usize> {
    let width = rows.first().map_or(0, |row| row.text.chars().count());
    if width == 0 {
        diagnostics.push(Diagnostic::error("bad-map", whole, "the map is empty"));
        return None;
    }
    if width.saturating_mul(rows.len()) > MAX_READ {
        let message = format!("the map has more than {MAX_READ} cells");
        diagnostics.push(Diagnostic::error("bad-map", whole, message));
        return None;
    }
    let ragged = rows.iter().filter(|row| row.text.chars().count() != width);
    let mut even = true;
    for row in ragged.take(5) {
        even = false;
        let message = format!("this row has {} cells, the first one {width}", row.text.chars().count());
        let diagnostic = Diagnostic::error("ragged-map", row.span, message);
        diagnostics.push(diagnostic.with_help("all rows of a map have the same length"));
    }
    even.then_some(width)
}

/// The position of a label among others, new or known.
pub(crate) fn labelled(labels: &mut Vec<Lettered>, name: &str, letter: Option<char>) -> usize {
    if let Some(index) = labels.iter().position(|label| label.name == name) {
        return index;
    }
    labels.push(Lettered { name: name.to_owned(), letter, cells: Vec::new() });
    labels.len() - 1
}

/// What a letter was found to stand for: something without a label, or a label by its position.
#[derive(Clone, Copy)]
enum Found {
    Plain(Occupancy),
    Label(usize),
}

/// The map while its cells are read.
struct Reader {
    format: Format,
    legend: FxHashMap<char, Meaning>,
    /// What the letters that most maps consist of were found to be.
    ascii: [Option<Found>; 128],
    map: Raster,
    unknown: FxHashSet<char>,
    failed: bool,
}

impl Reader {
    fn meaning(&mut self, letter: char) -> Option<Found> {
        if let Some(Some(found)) = self.ascii.get(letter as usize) {
            return Some(*found);
        }
        let meaning = self.legend.get(&letter).cloned().or_else(|| self.format.meaning(letter))?;
        let found = match meaning {
            Meaning::Free => Found::Plain(Occupancy::Free),
            Meaning::Obstacle => Found::Plain(Occupancy::Obstacle),
            Meaning::Labelled(label) => Found::Label(labelled(&mut self.map.labels, &label, Some(letter))),
        };
        if let Some(known) = self.ascii.get_mut(letter as usize) {
            *known = Some(found);
        }
        Some(found)
    }

    fn cell(&mut self, what: Found, cell: Cell) {
        match what {
            Found::Plain(what) => {
                let at = self.map.index(cell);
                self.map.cells[at] = what;
            }
            Found::Label(index) => self.map.labels[index].cells.push(cell),
        }
    }

    fn refuse(&mut self, letter: char, place: impl Fn() -> Span, diagnostics: &mut Diagnostics) {
        self.failed = true;
        if self.unknown.len() < 5 && self.unknown.insert(letter) {
            let message = format!("the letter {letter:?} has no meaning in a map");
            let help = format!("say what it is: `legend {letter:?} = NAME;` or `legend {letter:?} = #;`");
            diagnostics.push(Diagnostic::error("unknown-letter", place(), message).with_help(help));
        }
    }
}
