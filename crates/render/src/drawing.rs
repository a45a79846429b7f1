//! Maps as SVG.

use crate::board::{Board, Mark};
use crate::{Error, Scene};
use hyperplan_problem::Trace;
use std::fmt::Write as _;
use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Line, Path, Polyline, Rectangle, Style, Text, Title};

/// Colors that stay apart for color-blind readers (Okabe and Ito), each with a dash pattern of its own.
pub(crate) const STROKES: [(&str, &str); 6] = [
    ("#0072b2", ""),
    ("#d55e00", "8 4"),
    ("#009e73", "2 3"),
    ("#cc79a7", "12 3 2 3"),
    ("#56b4e9", "5 2"),
    ("#000000", "1 2"),
];
pub(crate) const MARGIN: f64 = 36.0;
pub(crate) const LEGEND_LINE: f64 = 20.0;
/// Between two numbers of metres along an axis.
const METRES_APART: f64 = 60.0;
/// Of a table: the size of its letters, from line to line, and from letter to letter.
const TABLE_SIZE: f64 = 12.0;
const TABLE_LINE: f64 = 16.0;
const TABLE_CHARACTER: f64 = 7.3;

/// The maps of the scene's systems, one under the other, each with its paths and a legend, and below them tables of the
/// paths of other systems.
///
/// # Errors
/// If no system has a place in the plane.
pub fn svg(scene: Scene<'_>) -> Result<String, Error> {
    let mut groups = Vec::new();
    let (mut width, mut height) = (0.0_f64, 0.0_f64);
    let (boards, roadmaps) = (scene.boards(), scene.roadmaps()?);
    let boards = if roadmaps.is_empty() { boards? } else { boards.unwrap_or_default() };
    for (system, board) in &boards {
        let sheet = Sheet::new(board);
        let traces = scene.traces_of(*system);
        let group = sheet.draw(&traces).set("transform", format!("translate(0 {height})"));
        groups.push(group);
        let lines = (traces.len() + board.marks.len() + usize::from(board.place.is_some())) as f64;
        width = width.max(sheet.width() + 2.0 * MARGIN);
        height += sheet.height() + 2.0 * MARGIN + lines * LEGEND_LINE;
    }
    for (system, map) in &roadmaps {
        let traces = scene.traces_of(*system);
        groups.push(map.draw(&traces).set("transform", format!("translate(0 {height})")));
        width = width.max(map.width());
        height += map.height(traces.len());
    }
    let drawn = boards.iter().map(|(system, _)| *system).chain(roadmaps.iter().map(|(system, _)| *system));
    for (heading, table) in scene.tables(&drawn.collect::<Vec<_>>()) {
        let lines: Vec<&str> = std::iter::once(heading.as_str()).chain(table.lines()).collect();
        groups.push(written(&lines).set("transform", format!("translate(0 {height})")));
        let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
        width = width.max(longest as f64 * TABLE_CHARACTER + 2.0 * MARGIN);
        height += lines.len() as f64 * TABLE_LINE + MARGIN;
    }
    let title = scene.objective.map_or("map", |o| o.name.as_str());
    let style = "text { font-family: sans-serif; fill: #222 } .axis { font-size: 10px; fill: #666 }";
    let background = Rectangle::new().set("width", width).set("height", height).set("fill", "#ffffff");
    let mut document = Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .add(Title::new(title))
        .add(Style::new(style))
        .add(background);
    for group in groups {
        document = document.add(group);
    }
    Ok(format!("{document}\n"))
}

/// Lines of text, one under the other, whose columns stand under each other.
fn written(lines: &[&str]) -> Group {
    let group = Group::new().set("class", "table").set("font-size", TABLE_SIZE);
    let line = |group: Group, (i, line): (usize, &&str)| {
        let text = Text::new(*line).set("x", MARGIN).set("y", (i + 1) as f64 * TABLE_LINE);
        group.add(text.set("xml:space", "preserve").set("style", "font-family: monospace"))
    };
    lines.iter().enumerate().fold(group, line)
}

/// A board and the size of its cells.
struct Sheet<'a> {
    board: &'a Board,
    cell: f64,
}

impl<'a> Sheet<'a> {
    fn new(board: &'a Board) -> Self {
        let cell = (960.0 / f64::from(board.width.max(board.height).max(1))).clamp(4.0, 40.0).floor();
        Sheet { board, cell }
    }

    fn width(&self) -> f64 {
        f64::from(self.board.width) * self.cell
    }

    fn height(&self) -> f64 {
        f64::from(self.board.height) * self.cell
    }

    /// The top left corner of a cell.
    fn corner(&self, (x, y): (u32, u32)) -> (f64, f64) {
        let row = f64::from(self.board.height - 1 - y);
        (MARGIN + f64::from(x) * self.cell, MARGIN + row * self.cell)
    }

    /// The middle of a cell, moved aside for the `index`-th of `count` paths.
    fn middle(&self, cell: (u32, u32), index: usize, count: usize) -> (f64, f64) {
        let (x, y) = self.corner(cell);
        let aside = (index as f64 - (count as f64 - 1.0) / 2.0) * self.cell * (0.5 / count.max(3) as f64);
        (x + self.cell / 2.0 + aside, y + self.cell / 2.0 - aside)
    }

    fn draw(&self, traces: &[(usize, &str, &Trace)]) -> Group {
        let mut group = Group::new().add(self.frame());
        for mark in self.board.marks.iter().rev() {
            group = group.add(self.mark(mark));
        }
        group = group.add(self.obstacles());
        group = group.add(self.lattice()).add(self.axes());
        group = group.add(self.metres());
        for mark in &self.board.marks {
            group = group.add(self.letters(mark));
        }
        for (place, (index, name, trace)) in traces.iter().enumerate() {
            group = group.add(self.path(place, traces.len(), *index, name, trace));
        }
        group.add(self.legend(traces))
    }

    fn frame(&self) -> Rectangle {
        Rectangle::new()
            .set("x", MARGIN)
            .set("y", MARGIN)
            .set("width", self.width())
            .set("height", self.height())
            .set("fill", "#fafafa")
            .set("stroke", "#444444")
    }

    /// Cells as one outline, a rectangle for each run in a row.
    fn outline(&self, cells: &[(u32, u32)]) -> Data {
        let mut by_row: Vec<(u32, u32)> = cells.iter().map(|&(x, y)| (y, x)).collect();
        by_row.sort_unstable();
        let mut runs: Vec<(u32, u32, u32)> = Vec::new();
        for (y, x) in by_row {
            match runs.last_mut() {
                Some((row, first, length)) if *row == y && *first + *length == x => *length += 1,
                _ => runs.push((y, x, 1)),
            }
        }
        runs.into_iter().fold(Data::new(), |data, (y, x, length)| {
            let width = f64::from(length) * self.cell;
            data.move_to(self.corner((x, y)))
                .horizontal_line_by(width)
                .vertical_line_by(self.cell)
                .horizontal_line_by(-width)
                .close()
        })
    }

    fn obstacles(&self) -> Path {
        Path::new()
            .set("class", "obstacles")
            .set("d", self.outline(&self.board.obstacles))
            .set("fill", "#3a3a3a")
    }

    fn mark(&self, mark: &Mark) -> Path {
        let fill = fill(&mark.label);
        Path::new().set("class", mark.label.as_str()).set("d", self.outline(&mark.cells)).set("fill", fill)
    }

    /// Letters in marked cells. Start and goal have corners of their own, so a cell that is both shows both.
    fn letters(&self, mark: &Mark) -> Group {
        let size = (self.cell * 0.34).max(3.0);
        let (right, low) = match mark.label.as_str() {
            "start" => (0.2, 0.36),
            "goal" => (0.8, 0.36),
            _ => (0.2, 0.92),
        };
        let group = Group::new().set("font-size", size).set("text-anchor", "middle");
        mark.cells.iter().fold(group, |group, &cell| {
            let (x, y) = self.corner(cell);
            let text = Text::new(mark.letter.to_string());
            group.add(text.set("x", number(x + right * self.cell)).set("y", number(y + low * self.cell)))
        })
    }

    fn lattice(&self) -> Path {
        let (right, bottom) = (MARGIN + self.width(), MARGIN + self.height());
        let mut data = Data::new();
        for x in 1..self.board.width {
            data = data.move_to((MARGIN + f64::from(x) * self.cell, MARGIN)).vertical_line_to(bottom);
        }
        for y in 1..self.board.height {
            data = data.move_to((MARGIN, MARGIN + f64::from(y) * self.cell)).horizontal_line_to(right);
        }
        Path::new().set("d", data).set("stroke", "#dddddd").set("stroke-width", 0.5).set("fill", "none")
    }

    fn axes(&self) -> Group {
        let every = if self.cell >= 16.0 { 1 } else { 10 };
        let mut group = Group::new().set("class", "axis");
        for x in (0..self.board.width).step_by(every) {
            let (left, top) = self.corner((x, 0));
            let text =
                Text::new((self.board.origin.0 + i64::from(x)).to_string()).set("text-anchor", "middle");
            group = group.add(text.set("x", left + self.cell / 2.0).set("y", top + self.cell + 14.0));
        }
        for y in (0..self.board.height).step_by(every) {
            let (left, top) = self.corner((0, y));
            let text = Text::new((self.board.origin.1 + i64::from(y)).to_string()).set("text-anchor", "end");
            group = group.add(text.set("x", left - 6.0).set("y", top + self.cell / 2.0 + 4.0));
        }
        group
    }

    /// The same axes in metres, at the bottom and at the right, where the map is not turned.
    fn metres(&self) -> Group {
        let group = Group::new().set("class", "axis");
        let Some(place) = self.board.place.filter(|place| place.yaw == 0.0) else { return group };
        let every = (METRES_APART / self.cell).ceil() as usize;
        let columns = (0..self.board.width).step_by(every).fold(group, |group, x| {
            let (left, top) = self.corner((x, 0));
            let text = Text::new(metres(place.centre((x, 0)).0)).set("text-anchor", "middle");
            group.add(text.set("x", left + self.cell / 2.0).set("y", top + self.cell + 26.0))
        });
        (0..self.board.height).step_by(every).fold(columns, |group, y| {
            let (left, top) = self.corner((self.board.width - 1, y));
            let text = Text::new(metres(place.centre((0, y)).1));
            group.add(text.set("x", left + self.cell + 4.0).set("y", top + self.cell / 2.0 + 4.0))
        })
    }

    /// A path: its line, a ring at the start, a square (or a cross after a crash) at the end, and step numbers.
    fn path(&self, place: usize, count: usize, index: usize, name: &str, trace: &Trace) -> Group {
        let (color, dashes) = STROKES[index % STROKES.len()];
        let cells = self.board.cells_of(trace);
        let points: Vec<(f64, f64)> = cells.iter().map(|&c| self.middle(c, place, count)).collect();
        let mut line = String::new();
        for (i, (x, y)) in points.iter().enumerate() {
            let _ = write!(line, "{}{},{}", if i == 0 { "" } else { " " }, number(*x), number(*y));
        }
        let polyline = Polyline::new()
            .set("points", line)
            .set("fill", "none")
            .set("stroke", color)
            .set("stroke-width", number((self.cell * 0.09).max(1.0)))
            .set("stroke-linejoin", "round")
            .set("stroke-dasharray", if dashes.is_empty() { "none" } else { dashes });
        let mut group = Group::new().set("class", format!("path {name}")).add(Title::new(name)).add(polyline);
        let radius = number((self.cell * 0.12).max(1.5));
        if let Some((x, y)) = points.first() {
            let ring = Circle::new().set("cx", number(*x)).set("cy", number(*y)).set("r", radius);
            group = group.add(ring.set("fill", "#ffffff").set("stroke", color).set("stroke-width", 1.5));
        }
        if let Some(&last) = points.last() {
            group = group.add(end(last, radius, color, self.board.crash_time(trace).is_some()));
        }
        group.add(self.steps(&cells, place, count, color))
    }

    /// Step numbers at regular intervals, until the path comes to rest.
    fn steps(&self, cells: &[(u32, u32)], place: usize, count: usize, color: &str) -> Group {
        let group = Group::new().set("font-size", number((self.cell * 0.26).max(3.0)));
        let rest = cells.windows(2).rposition(|w| w[0] != w[1]).map_or(0, |i| i + 1);
        let every = match rest {
            0..=20 => 1,
            21..=60 => 5,
            _ => 10,
        };
        let mut numbered: Vec<(u32, u32)> = Vec::new();
        let mut group = group;
        for (time, &cell) in cells.iter().enumerate().take(rest + 1).skip(1) {
            if (time % every == 0 || time == rest) && !numbered.contains(&cell) {
                numbered.push(cell);
                let (x, y) = self.middle(cell, place, count);
                let text = Text::new(time.to_string()).set("style", format!("fill: {color}"));
                let (x, y) = (x + self.cell * 0.1, y + self.cell * 0.32);
                group = group.add(text.set("x", number(x)).set("y", number(y)));
            }
        }
        group
    }

    fn legend(&self, traces: &[(usize, &str, &Trace)]) -> Group {
        let mut group = Group::new().set("font-size", 13);
        let mut y = MARGIN + self.height() + if self.board.place.is_some() { 46.0 } else { 34.0 };
        for (index, name, trace) in traces {
            let (color, dashes) = STROKES[index % STROKES.len()];
            let line =
                Line::new().set("x1", MARGIN).set("x2", MARGIN + 36.0).set("y1", y - 4.0).set("y2", y - 4.0);
            let line = line.set("stroke", color).set("stroke-width", 3);
            let line = line.set("stroke-dasharray", if dashes.is_empty() { "none" } else { dashes });
            let words = format!("{name} ({} steps)", trace.actions.len());
            group = group.add(line).add(Text::new(words).set("x", MARGIN + 44.0).set("y", y));
            y += LEGEND_LINE;
        }
        for mark in &self.board.marks {
            let swatch = Rectangle::new()
                .set("x", MARGIN + 20.0)
                .set("y", y - 12.0)
                .set("width", 16)
                .set("height", 16);
            let words = format!("{} {}", mark.letter, mark.label);
            let swatch = swatch.set("fill", fill(&mark.label)).set("stroke", "#888888");
            group = group.add(swatch).add(Text::new(words).set("x", MARGIN + 44.0).set("y", y));
            y += LEGEND_LINE;
        }
        if let Some(scale) = self.board.scale() {
            group = group.add(Text::new(scale).set("x", MARGIN).set("y", y));
        }
        group
    }
}

/// A distance as the axes have it, to centimetres.
fn metres(value: f64) -> String {
    format!("{} m", number(value))
}

/// The colour of the cells or nodes where a label holds.
pub(crate) fn fill(label: &str) -> &'static str {
    match label {
        "start" => "#f7d9a8",
        "goal" => "#a9d4f0",
        _ => "#e6e1ee",
    }
}

/// What stands at the end of a path.
pub(crate) fn end((x, y): (f64, f64), radius: f64, color: &str, crashed: bool) -> Path {
    let (left, top, size) = (number(x - radius), number(y - radius), number(2.0 * radius));
    if crashed {
        let cross = Data::new().move_to((left, top)).line_by((size, size));
        let cross = cross.move_to((left, number(y + radius))).line_by((size, -size));
        return Path::new().set("d", cross).set("stroke", color).set("stroke-width", 2).set("fill", "none");
    }
    let square = Data::new().move_to((left, top)).horizontal_line_by(size).vertical_line_by(size);
    Path::new().set("d", square.horizontal_line_by(-size).close()).set("fill", color)
}

/// Two decimals are enough for a drawing, and keep its text short.
pub(crate) fn number(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}
