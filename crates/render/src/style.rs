//! What lines, areas and letters look like: told apart by colour, and without colour by dashes and hatchings.

use svg::node::element::path::Data;
use svg::node::element::{Definitions, Path, Pattern, Rectangle, Text};

/// Colours that stay apart for color-blind readers (Okabe and Ito), each with dashes of its own.
const STROKES: [(&str, &str); 6] = [
    ("#0072b2", "none"),
    ("#d55e00", "9 4"),
    ("#00795a", "2.5 3"),
    ("#a8497f", "12 3 2.5 3"),
    ("#2a9fd8", "5 2.5"),
    ("#000000", "1.5 2.5"),
];

/// Of areas: light colours, and the dark ones of what is drawn on them.
const TINTS: [(&str, &str); 8] = [
    ("#fbe0b4", "#a86400"),
    ("#b5d9f2", "#00558c"),
    ("#cfeac6", "#2f6b1f"),
    ("#f5cbdc", "#8a1f52"),
    ("#e2d6f3", "#5b2d8a"),
    ("#f3eda4", "#6b6200"),
    ("#d8d8d8", "#333333"),
    ("#c2e9e6", "#00605c"),
];

/// What hatchings are made of, in tiles of eight by eight.
const HATCHINGS: [&str; 8] = [
    "M-1 1L1 -1M-1 9L9 -1M7 9L9 7",
    "M-1 7L1 9M-1 -1L9 9M7 -1L9 1",
    "M0 4H8",
    "M4 0V8",
    "M3 3h2v2h-2z",
    "M4 2V6M2 4H6",
    "M2 2L6 6M2 6L6 2",
    "M2 4a2 2 0 1 0 4 0a2 2 0 1 0 -4 0",
];

pub(crate) const MARGIN: f64 = 36.0;
pub(crate) const LEGEND_LINE: f64 = 20.0;
pub(crate) const OBSTACLE: &str = "#3a3a3a";
pub(crate) const UNKNOWN: &str = "#b9b9b9";
/// The hatching of cells that nobody has seen.
pub(crate) const UNKNOWN_HATCHING: &str = "unknown";
/// The font that pictures without fonts of the system are drawn with, and what stands in for it elsewhere.
pub(crate) const FONT: &str = "DejaVu Sans, Verdana, sans-serif";
/// The width of a letter of that font, in its size; few letters are wider.
pub(crate) const LETTER: f64 = 0.64;

/// Colour and dashes of the path at that place.
pub(crate) fn stroke(index: usize) -> (&'static str, &'static str) {
    STROKES[index % STROKES.len()]
}

/// The colour of the area of a label, and of what is drawn on it.
pub(crate) fn tint(index: usize) -> (&'static str, &'static str) {
    TINTS[index % TINTS.len()]
}

fn hatching(index: usize) -> String {
    // Beyond the colours that there are each comes again, with another hatching.
    format!("hatching-{}-{}", index % TINTS.len(), (index + index / TINTS.len()) % HATCHINGS.len())
}

/// How the area of a label is filled.
pub(crate) fn fill(index: usize) -> String {
    format!("url(#{})", hatching(index))
}

/// The hatchings of so many labels, and that of cells that nobody has seen.
pub(crate) fn definitions(labels: usize) -> Definitions {
    let tile = |id: &str, ground: &str, ink: &str, lines: &str| {
        let ground = Rectangle::new().set("width", 8).set("height", 8).set("fill", ground);
        let lines = Path::new().set("d", lines).set("stroke", ink).set("stroke-width", 0.9);
        let lines = lines.set("fill", "none").set("stroke-opacity", 0.55);
        let pattern = Pattern::new().set("id", id).set("patternUnits", "userSpaceOnUse");
        pattern.set("width", 8).set("height", 8).add(ground).add(lines)
    };
    let labels = labels.min(TINTS.len() * HATCHINGS.len());
    let unknown = tile(UNKNOWN_HATCHING, UNKNOWN, "#555555", "M1 1h1.5v1.5h-1.5zM5 5h1.5v1.5h-1.5z");
    (0..labels).fold(Definitions::new().add(unknown), |all, index| {
        let lines = HATCHINGS[(index + index / TINTS.len()) % HATCHINGS.len()];
        let (ground, ink) = tint(index);
        all.add(tile(&hatching(index), ground, ink, lines))
    })
}

/// What stands at the end of a path.
pub(crate) fn end((x, y): (f64, f64), radius: f64, color: &str, crashed: bool) -> Path {
    let (left, top, size) = (number(x - radius), number(y - radius), number(2.0 * radius));
    if crashed {
        let cross = Data::new().move_to((left, top)).line_by((size, size));
        let cross = cross.move_to((left, number(y + radius))).line_by((size, -size));
        return Path::new().set("d", cross).set("stroke", color).set("stroke-width", 3).set("fill", "none");
    }
    let square = Data::new().move_to((left, top)).horizontal_line_by(size).vertical_line_by(size);
    let square = square.horizontal_line_by(-size).close();
    Path::new().set("d", square).set("fill", color).set("stroke", "#ffffff").set("stroke-width", 1)
}

/// Letters that can be read whatever is behind them.
pub(crate) fn on_white(words: &str, (x, y): (f64, f64), size: f64, color: &str) -> Text {
    let text = Text::new(words).set("x", number(x)).set("y", number(y)).set("font-size", number(size));
    let text = text.set("style", format!("fill: {color}")).set("paint-order", "stroke");
    text.set("stroke", "#ffffff").set("stroke-width", 2.5).set("stroke-linejoin", "round")
}

/// No more of words than there is room for.
pub(crate) fn clipped(words: &str, most: usize) -> String {
    match words.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &words[..end]),
        None => words.to_owned(),
    }
}

/// How wide words are, at most.
pub(crate) fn width(words: &str, size: f64) -> f64 {
    words.chars().count() as f64 * size * LETTER
}

/// Two decimals are enough for a drawing, and keep its text short.
pub(crate) fn number(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

/// The least of 1, 2, 5, 10, 20 and so on of which so many are at least so long.
pub(crate) fn every(one: f64, long: f64) -> usize {
    let steps = (0..18).flat_map(|power| [1, 2, 5].map(|digit| digit * 10_usize.pow(power)));
    steps.into_iter().find(|step| *step as f64 * one >= long).unwrap_or(usize::MAX)
}
