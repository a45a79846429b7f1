//! Plots as SVG: on white paper by themselves, recolored by the page they are put into. Contestants differ by color,
//! marker and dashes at once, so that none of these is needed.

mod cactus;
mod scatter;

use svg::Node;
use svg::node::element::{Element, Group, Line, Path, Rectangle, Text};

use crate::contest::Contest;

pub use cactus::cactus;
pub use scatter::scatter;
pub(crate) use scatter::{KINDS, Kind, Scatter, words};

/// Okabe and Ito's colors, which are told apart without full color vision, but for their yellow, which is too faint
/// for a line on white.
const COLORS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];

const DASHES: [&str; 5] = ["none", "8 3", "2 3", "8 3 2 3", "14 4"];

/// Outlines of markers around the origin: circle, square, triangles, diamond, plus, cross, bar.
const MARKERS: [&str; 8] = [
    "M-3.5 0a3.5 3.5 0 1 0 7 0a3.5 3.5 0 1 0 -7 0z",
    "M-3 -3h6v6h-6z",
    "M0 -4l4 7h-8z",
    "M0 -4.5l4.5 4.5l-4.5 4.5l-4.5 -4.5z",
    "M0 -4v8M-4 0h8",
    "M-3.2 -3.2l6.4 6.4M-3.2 3.2l6.4 -6.4",
    "M0 4l4 -7h-8z",
    "M-4 -2h8M-4 2h8",
];

/// Paper, since what shows a file may be dark.
const GROUND: &str = "#ffffff";
const INK: &str = "#000000";
const FAINT: &str = "#5c5c5c";
const PALE: &str = "#b0b0b0";

/// Times on a logarithmic axis, as distances from its beginning.
#[derive(Clone, Copy, Debug)]
struct Axis {
    low: f64,
    high: f64,
    length: f64,
}

/// Below this all times are the same.
const LEAST_S: f64 = 0.001;

impl Axis {
    /// Wide enough for every time that was enough, and for the limits. The same for all contestants: plots can be
    /// compared by eye.
    fn new(contest: &Contest<'_>, length: f64) -> Self {
        let solved = contest.cells.iter().flatten().flatten().filter(|cell| cell.solved().is_some());
        let times = solved.map(|cell| cell.median.wall_s).filter(|wall| wall.is_finite());
        let (least, most) =
            times.fold((f64::INFINITY, 0.0_f64), |(least, most), wall| (least.min(wall), most.max(wall)));
        let longest = Some(contest.longest()).filter(|longest| longest.is_finite()).unwrap_or(0.0);
        let least = if least.is_finite() { least } else { LEAST_S };
        let low = 10.0_f64.powf(least.clamp(LEAST_S, 1e6).log10().floor());
        Self { low, high: longest.max(most).max(10.0 * low), length }
    }

    fn at(&self, wall_s: f64) -> f64 {
        let wall_s = if wall_s.is_nan() { self.high } else { wall_s.clamp(self.low, self.high) };
        self.length * (wall_s / self.low).log10() / (self.high / self.low).log10()
    }

    /// Powers of ten, with their names.
    fn ticks(&self) -> Vec<(f64, String)> {
        let mut ticks = Vec::new();
        let mut tick = self.low;
        while tick <= self.high * 1.000_001 && ticks.len() < 30 {
            let digits = usize::from(tick < 0.5) + usize::from(tick < 0.05) + usize::from(tick < 0.005);
            ticks.push((self.at(tick), format!("{tick:.digits$}")));
            tick *= 10.0;
        }
        ticks
    }
}

/// Where the axes are.
#[derive(Clone, Copy, Debug)]
struct Area {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Area {
    fn bottom(&self) -> f64 {
        self.top + self.height
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }

    /// A tick of the horizontal axis with its grid line.
    fn column(&self, into: &mut Group, x: f64, name: &str) {
        into.append(line("grid", PALE, (x, self.top), (x, self.bottom())).set("stroke-width", 0.5));
        into.append(text(name, x, self.bottom() + 16.0, "middle"));
    }

    /// A tick of the vertical axis with its grid line.
    fn row(&self, into: &mut Group, y: f64, name: &str) {
        into.append(line("grid", PALE, (self.left, y), (self.right(), y)).set("stroke-width", 0.5));
        into.append(text(name, self.left - 6.0, y + 4.0, "end"));
    }

    /// The axes and what they are called.
    fn axes(&self, into: &mut Group, horizontal: &str, vertical: &str) {
        let corner = (self.left, self.bottom());
        into.append(line("axis", INK, corner, (self.right(), self.bottom())));
        into.append(line("axis", INK, corner, (self.left, self.top)));
        into.append(
            text(horizontal, self.left + self.width / 2.0, self.bottom() + 36.0, "middle")
                .set("class", "ink name"),
        );
        let (x, y) = (self.left - 48.0, self.top + self.height / 2.0);
        let turned = format!("rotate(-90 {x} {y})");
        into.append(text(vertical, x, y, "middle").set("class", "ink name").set("transform", turned));
    }
}

/// Coordinates with a tenth of a pixel: what is finer is noise in the file.
fn round(x: f64) -> f64 {
    (x * 10.0).round() / 10.0
}

fn line(class: &str, color: &str, from: (f64, f64), to: (f64, f64)) -> Line {
    Line::new()
        .set("class", class)
        .set("stroke", color)
        .set("x1", round(from.0))
        .set("y1", round(from.1))
        .set("x2", round(to.0))
        .set("y2", round(to.1))
}

fn text(content: &str, x: f64, y: f64, anchor: &str) -> Text {
    Text::new(content)
        .set("class", "ink")
        .set("fill", INK)
        .set("x", round(x))
        .set("y", round(y))
        .set("text-anchor", anchor)
}

fn marker(outline: &str, at: (f64, f64)) -> Path {
    Path::new()
        .set("d", outline)
        .set("transform", format!("translate({} {})", round(at.0), round(at.1)))
        .set("fill", "none")
        .set("stroke-width", 1.5)
}

/// The class and the color of a contestant.
fn color(number: usize) -> (String, &'static str) {
    let color = number % COLORS.len();
    (format!("c{color}"), COLORS[color])
}

/// At most so many characters, for legends.
fn short(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(most.saturating_sub(1)).collect();
    short.push('…');
    short
}

/// A document of some size that says what it is.
fn document(width: f64, height: f64, title: &str, contents: Group) -> String {
    let mut document = Element::new("svg");
    document.assign("xmlns", "http://www.w3.org/2000/svg");
    document.assign("viewBox", format!("0 0 {width} {height}"));
    document.assign("width", width);
    document.assign("height", height);
    document.assign("role", "img");
    document.assign("aria-label", title);
    document.assign("class", "plot");
    document.assign("font-family", "sans-serif");
    document.assign("font-size", 12);
    let ground = Rectangle::new().set("class", "ground").set("fill", GROUND);
    document.append(ground.set("width", "100%").set("height", "100%"));
    document.append(contents);
    format!("{document}\n")
}
