//! A map as a drawing.

use crate::bitmap;
use crate::board::{Board, Mark};
use crate::mover::{Mover, Point};
use crate::panel::{Entry, Panel, Purpose};
use crate::style::{
    LETTER, MARGIN, OBSTACLE, UNKNOWN, UNKNOWN_HATCHING, every, fill, number, on_white, tint, width,
};
use crate::track::{Area, Sizes};
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Image, Line, Path, Rectangle, Text};

type Cell = (u32, u32);

/// The longer side of a map.
const SIDE: f64 = 900.0;
/// Between two numbers of metres along an axis.
const METRES_APART: f64 = 60.0;
/// Where cells are smaller, there are no lines between them.
const LEAST_LATTICE: f64 = 9.0;
/// Where cells are smaller, labels of few cells are said by pins.
const LEAST_LETTERS: f64 = 20.0;
/// The radius of a pin's head.
const PIN: f64 = 9.0;
/// More pins of one label, or letters of all, are not drawn.
const MOST_PINS: usize = 12;
const MOST_LETTERS: usize = 60;
/// So many runs of cells in rows take more text than a picture of them.
const MOST_RUNS: usize = 6_000;

/// A board and the size of its cells.
pub(crate) struct Sheet<'a> {
    board: &'a Board,
    cell: f64,
    purpose: Purpose,
}

impl<'a> Sheet<'a> {
    pub(crate) fn new(board: &'a Board, purpose: Purpose) -> Self {
        let longest = f64::from(board.width.max(board.height).max(1));
        let most = if longest <= 8.0 { 64.0 } else { 40.0 };
        let cell = (SIDE / longest).min(most);
        Sheet { board, cell: if cell >= 2.0 { cell.floor() } else { cell }, purpose }
    }

    pub(crate) fn sizes(&self) -> Sizes {
        Sizes::of(self.cell)
    }

    fn width(&self) -> f64 {
        f64::from(self.board.width) * self.cell
    }

    fn height(&self) -> f64 {
        f64::from(self.board.height) * self.cell
    }

    /// The top left corner of a cell.
    fn corner(&self, (x, y): Cell) -> Point {
        let row = f64::from(self.board.height - 1 - y);
        (MARGIN + f64::from(x) * self.cell, MARGIN + row * self.cell)
    }

    /// The middle of a cell.
    pub(crate) fn middle(&self, cell: Cell) -> Point {
        let (x, y) = self.corner(cell);
        (x + self.cell / 2.0, y + self.cell / 2.0)
    }

    /// The map without paths, and what is to be drawn above them.
    pub(crate) fn panel(&self, (paths, movers): (Group, Vec<Mover>), mut entries: Vec<Entry>) -> Panel {
        let mut areas = Group::new().set("class", "areas");
        if !self.purpose.bare {
            areas = self.areas(areas);
        }
        let mut group = Group::new().set("class", "map").add(areas);
        for (index, mark) in self.board.marks.iter().enumerate() {
            group = group.add(self.letters(index, mark));
        }
        group = group.add(paths);
        for (index, mark) in self.board.marks.iter().enumerate() {
            group = group.add(self.pins(index, mark));
        }
        let labels = self.board.marks.iter().enumerate();
        entries.extend(labels.map(|(i, mark)| Entry::Label(i, format!("{} {}", mark.letter, mark.label))));
        if !self.board.obstacles.is_empty() {
            entries.push(Entry::Area(OBSTACLE.to_owned(), "obstacle".to_owned()));
        }
        if !self.board.unknown.is_empty() {
            entries.push(Entry::Area(format!("url(#{UNKNOWN_HATCHING})"), "unknown".to_owned()));
        }
        entries.extend(self.board.scale().map(Entry::Words));
        let below = if self.board.place.is_some() { 46.0 } else { 34.0 };
        let (width, height) = (self.width() + 2.0 * MARGIN, self.height() + MARGIN + below);
        Panel { group, width, height, movers }.with_legend(entries)
    }

    /// The ground, what it consists of, and numbers along it.
    fn areas(&self, areas: Group) -> Group {
        let mut group = areas.add(self.frame());
        for (index, mark) in self.board.marks.iter().enumerate().rev() {
            let area = self.area(&mark.cells, &fill(index), tint(index).0);
            group = group.add(area.set("class", mark.label.as_str()));
        }
        if self.cell >= LEAST_LATTICE {
            group = group.add(self.lattice());
        }
        group = group.add(self.area(&self.board.obstacles, OBSTACLE, OBSTACLE).set("class", "obstacles"));
        if !self.board.unknown.is_empty() {
            let hatching = format!("url(#{UNKNOWN_HATCHING})");
            group = group.add(self.area(&self.board.unknown, &hatching, UNKNOWN).set("class", "unknown"));
        }
        group.add(self.border()).add(self.axes()).add(self.metres())
    }

    fn frame(&self) -> Rectangle {
        self.rectangle().set("fill", "#fcfcfc")
    }

    fn border(&self) -> Rectangle {
        self.rectangle().set("fill", "none").set("stroke", "#444444")
    }

    fn rectangle(&self) -> Rectangle {
        let rectangle = Rectangle::new().set("x", MARGIN).set("y", MARGIN);
        rectangle.set("width", number(self.width())).set("height", number(self.height()))
    }

    /// Cells as one area, a rectangle for each run in a row; as a picture, where that is shorter.
    fn area(&self, cells: &[Cell], fill: &str, flat: &str) -> Group {
        let mut by_row: Vec<Cell> = cells.iter().map(|&(x, y)| (y, x)).collect();
        by_row.sort_unstable();
        let mut runs: Vec<(u32, u32, u32)> = Vec::new();
        for (y, x) in by_row {
            match runs.last_mut() {
                Some((row, first, length)) if *row == y && *first + *length == x => *length += 1,
                _ => runs.push((y, x, 1)),
            }
        }
        if self.purpose.bitmaps && runs.len() > MOST_RUNS {
            let image = bitmap::data((self.board.width, self.board.height), cells, flat);
            let image = Image::new().set("x", MARGIN).set("y", MARGIN).set("href", image);
            let image = image.set("width", number(self.width())).set("height", number(self.height()));
            return Group::new().add(image.set("style", "image-rendering: pixelated"));
        }
        let sharp = Group::new().set("shape-rendering", "crispEdges");
        if fill.starts_with("url") {
            // A hatching is as large as it is whatever the cells are.
            let data = runs.into_iter().fold(Data::new(), |data, (y, x, length)| {
                let (left, top) = self.corner((x, y));
                let width = number(f64::from(length) * self.cell);
                data.move_to((number(left), number(top)))
                    .horizontal_line_by(width)
                    .vertical_line_by(number(self.cell))
                    .horizontal_line_by(-width)
                    .close()
            });
            return sharp.add(Path::new().set("d", data).set("fill", fill));
        }
        // In cells, which are short numbers.
        let data = runs.into_iter().fold(Data::new(), |data, (y, x, length)| {
            let data = data.move_to((x, self.board.height - 1 - y)).horizontal_line_by(length);
            data.vertical_line_by(1).horizontal_line_by(-i64::from(length) as f64).close()
        });
        let to_cells = format!("translate({MARGIN} {MARGIN}) scale({})", self.cell);
        sharp.add(Path::new().set("d", data).set("fill", fill).set("transform", to_cells))
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
        let path = Path::new().set("class", "lattice").set("d", data).set("stroke", "#dcdcdc");
        path.set("stroke-width", 0.6).set("fill", "none")
    }

    /// Letters in marked cells.
    fn letters(&self, index: usize, mark: &Mark) -> Group {
        let letter = |at| on_white(&mark.letter.to_string(), at, self.letter(), tint(index).1);
        let group = Group::new().set("class", "letters");
        self.lettered(index, mark).into_iter().map(letter).fold(group, Group::add)
    }

    /// The size of letters.
    fn letter(&self) -> f64 {
        (self.cell * 0.35).clamp(9.0, 16.0)
    }

    /// Where letters stand. Start and goal have corners of their own, so a cell that is both shows both.
    fn lettered(&self, index: usize, mark: &Mark) -> Vec<Point> {
        if self.cell < LEAST_LETTERS {
            return Vec::new();
        }
        let size = self.letter();
        let spot = |cell: Cell| {
            let (left, top) = self.corner(cell);
            match index {
                0 => (left + 3.0, top + size),
                1 => (left + self.cell - size * LETTER - 4.0, top + size),
                _ => (left + 3.0, top + self.cell - 3.0),
            }
        };
        let few = mark.cells.len() <= MOST_LETTERS;
        let cells = if few { mark.cells.clone() } else { parts(&mark.cells, MOST_LETTERS) };
        cells.into_iter().map(spot).collect()
    }

    /// Where cells are small: a disc with the letter beside each part of a label, with a line that leads there.
    fn pins(&self, index: usize, mark: &Mark) -> Group {
        let (group, (ground, ink)) = (Group::new().set("class", "pins"), tint(index));
        self.pinned(index, mark).into_iter().fold(group, |group, ((x, y), at)| {
            let line = Line::new().set("x1", number(x)).set("y1", number(y)).set("x2", number(at.0));
            let line = line.set("y2", number(at.1)).set("stroke", ink).set("stroke-width", 1.5);
            let disc = Circle::new().set("cx", number(at.0)).set("cy", number(at.1)).set("r", PIN);
            let disc = disc.set("fill", ground).set("stroke", ink).set("stroke-width", 1.5);
            let letter =
                Text::new(mark.letter.to_string()).set("x", number(at.0)).set("y", number(at.1 + 4.5));
            let letter = letter.set("text-anchor", "middle").set("font-size", 12);
            group.add(line).add(disc).add(letter.set("style", format!("fill: {ink}")))
        })
    }

    /// Where pins point to, and where their heads are.
    fn pinned(&self, index: usize, mark: &Mark) -> Vec<(Point, Point)> {
        // What can be seen needs no pin, but start and goal are looked for.
        let is_seen = mark.cells.len() as f64 * self.cell * self.cell > 600.0;
        if self.cell >= LEAST_LETTERS || is_seen && !matches!(mark.label.as_str(), "start" | "goal") {
            return Vec::new();
        }
        let pin = |cell: Cell| {
            let (x, y) = self.middle(cell);
            // Above, to the left for a start and to the right for others, but on the map.
            let side = if index == 0 { -17.0 } else { 17.0 };
            let fits = (MARGIN - 20.0..MARGIN + self.width() + 20.0).contains(&(x + side));
            ((x, y), (x + if fits { side } else { -side }, if y > MARGIN { y - 17.0 } else { y + 17.0 }))
        };
        parts(&mark.cells, MOST_PINS).into_iter().map(pin).collect()
    }

    /// Where pins and letters are.
    pub(crate) fn taken(&self) -> Vec<Area> {
        let size = self.letter();
        let of = |(index, mark): (usize, &Mark)| {
            let pins = self.pinned(index, mark).into_iter();
            let pins = pins.map(|(_, (x, y))| [x - PIN, y - PIN, x + PIN, y + PIN]);
            let letters = self.lettered(index, mark).into_iter();
            pins.chain(letters.map(|(x, y)| [x, y - size, x + size * LETTER, y])).collect::<Vec<_>>()
        };
        self.board.marks.iter().enumerate().flat_map(of).collect()
    }

    fn axes(&self) -> Group {
        let mut group = Group::new().set("class", "axis");
        let (last_x, last_y) = (
            self.board.origin.0 + i64::from(self.board.width) - 1,
            self.board.origin.1 + i64::from(self.board.height) - 1,
        );
        let wide = width(&last_x.to_string(), 10.0).max(width(&self.board.origin.0.to_string(), 10.0));
        for x in (0..self.board.width).step_by(every(self.cell, wide + 6.0)) {
            let (left, top) = self.corner((x, 0));
            let text =
                Text::new((self.board.origin.0 + i64::from(x)).to_string()).set("text-anchor", "middle");
            let (x, y) = (left + self.cell / 2.0, top + self.cell + 14.0);
            group = group.add(text.set("x", number(x)).set("y", number(y)));
        }
        // Three digits fit into the margin.
        let size = if last_y.abs() > 999 { 8 } else { 10 };
        for y in (0..self.board.height).step_by(every(self.cell, 14.0)) {
            let (left, top) = self.corner((0, y));
            let text = Text::new((self.board.origin.1 + i64::from(y)).to_string()).set("text-anchor", "end");
            let (x, y) = (left - 6.0, top + self.cell / 2.0 + 4.0);
            group = group.add(text.set("x", number(x)).set("y", number(y)).set("font-size", size));
        }
        group
    }

    /// The same axes in metres, at the bottom and at the right, where the map is not turned.
    fn metres(&self) -> Group {
        let group = Group::new().set("class", "axis");
        let Some(place) = self.board.place.filter(|place| place.yaw == 0.0) else { return group };
        let every = (METRES_APART / self.cell).ceil() as usize;
        let metres = |value: f64| format!("{} m", number(value));
        let columns = (0..self.board.width).step_by(every).fold(group, |group, x| {
            let (left, top) = self.corner((x, 0));
            let text = Text::new(metres(place.centre((x, 0)).0)).set("text-anchor", "middle");
            group.add(text.set("x", number(left + self.cell / 2.0)).set("y", number(top + self.cell + 26.0)))
        });
        (0..self.board.height).step_by(every).fold(columns, |group, y| {
            let (left, top) = self.corner((self.board.width - 1, y));
            let text = Text::new(metres(place.centre((0, y)).1));
            group.add(
                text.set("x", number(left + self.cell + 4.0)).set("y", number(top + self.cell / 2.0 + 4.0)),
            )
        })
    }
}

/// A cell of each part in which cells are neighbours, of so many parts: the first of its lowest row.
fn parts(cells: &[Cell], most: usize) -> Vec<Cell> {
    let mut left: std::collections::BTreeSet<Cell> = cells.iter().map(|&(x, y)| (y, x)).collect();
    let mut found = Vec::new();
    while let Some((y, x)) = left.pop_first() {
        if found.len() == most {
            break;
        }
        found.push((x, y));
        let mut stack = vec![(y, x)];
        while let Some((y, x)) = stack.pop() {
            let beside =
                [(Some(y), x.checked_add(1)), (Some(y), x.checked_sub(1)), (y.checked_add(1), Some(x))];
            let beside = beside.into_iter().chain([(y.checked_sub(1), Some(x))]);
            stack.extend(beside.filter_map(|(y, x)| Some((y?, x?))).filter(|cell| left.remove(cell)));
        }
    }
    found
}
