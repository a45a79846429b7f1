//! What a picture is put together from: panels, with legends below.

use crate::mover::Mover;
use crate::style::{LEGEND_LINE, MARGIN, clipped, fill, number, stroke, width};
use svg::node::element::{Group, Line, Rectangle, Text};

/// What a drawing is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Purpose {
    /// Whether pictures may stand in it, which are shorter than what has very many lines.
    pub(crate) bitmaps: bool,
    /// Whether something is to move on it.
    pub(crate) film: bool,
    /// Whether what does not depend on the paths is left out, as another drawing has it.
    pub(crate) bare: bool,
}

/// A part of a picture with its size.
pub(crate) struct Panel {
    pub(crate) group: Group,
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// What moves on it in films.
    pub(crate) movers: Vec<Mover>,
}

/// One line of a legend.
pub(crate) enum Entry {
    /// The path at that place.
    Path(usize, String),
    /// The label at that place.
    Label(usize, String),
    /// What is filled so.
    Area(String, String),
    /// Words alone.
    Words(String),
}

/// The size of a legend's letters.
const LETTERS: f64 = 13.0;
/// The most letters of a line.
const MOST_LETTERS: usize = 100;

impl Panel {
    /// Puts a legend below.
    pub(crate) fn with_legend(self, entries: Vec<Entry>) -> Panel {
        let (mut group, mut y, mut wide) = (Group::new().set("class", "legend"), self.height, self.width);
        group = group.set("font-size", LETTERS);
        for entry in entries {
            let (swatch, words, left) = entry.parts();
            let words = clipped(&words, MOST_LETTERS);
            let left = MARGIN + left;
            wide = wide.max(left + width(&words, LETTERS) + MARGIN);
            let line = Group::new().set("transform", format!("translate(0 {})", number(y)));
            let line = swatch.into_iter().fold(line, Group::add);
            group = group.add(line.add(Text::new(words).set("x", left).set("y", 0)));
            y += LEGEND_LINE;
        }
        let group = Group::new().add(self.group).add(group);
        Panel { group, width: wide, height: y + MARGIN / 2.0, movers: self.movers }
    }

    /// Puts a name above, where there are several panels.
    pub(crate) fn with_title(self, title: &str) -> Panel {
        let title = &clipped(title, MOST_LETTERS);
        let moved = self.group.set("transform", "translate(0 14)");
        let text = Text::new(title.as_str())
            .set("x", MARGIN)
            .set("y", 22)
            .set("font-size", 15)
            .set("class", "title");
        let width = self.width.max(2.0 * MARGIN + width(title, 15.0));
        let movers = self.movers.into_iter().map(|mover| mover.moved((0.0, 14.0))).collect();
        Panel { group: Group::new().add(text).add(moved), width, height: self.height + 14.0, movers }
    }
}

impl Entry {
    /// What is drawn before the words, the words, and where they begin.
    fn parts(self) -> (Option<Group>, String, f64) {
        let square = |fill: String| {
            let square = Rectangle::new().set("x", MARGIN + 14.0).set("y", -13).set("width", 22);
            Group::new().add(square.set("height", 16).set("fill", fill).set("stroke", "#666666"))
        };
        match self {
            Entry::Path(index, words) => {
                let (color, dashes) = stroke(index);
                let line = Line::new().set("x1", MARGIN).set("x2", MARGIN + 36.0).set("y1", -5).set("y2", -5);
                let line = line.set("stroke", color).set("stroke-width", 3).set("stroke-dasharray", dashes);
                (Some(Group::new().add(line)), words, 44.0)
            }
            Entry::Label(index, words) => (Some(square(fill(index))), words, 44.0),
            Entry::Area(fill, words) => (Some(square(fill)), words, 44.0),
            Entry::Words(words) => (None, words, 0.0),
        }
    }
}

/// Puts panels beside each other while there is room, and below where not.
pub(crate) fn arranged(panels: Vec<Panel>) -> Panel {
    let (mut group, mut x, mut y, mut line, mut width) = (Group::new(), 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut movers = Vec::new();
    for panel in panels {
        if x > 0.0 && x + panel.width > WIDEST {
            (x, y, line) = (0.0, y + line, 0.0);
        }
        let at = format!("translate({} {})", number(x), number(y));
        group = group.add(Group::new().set("class", "panel").set("transform", at).add(panel.group));
        movers.extend(panel.movers.into_iter().map(|mover| mover.moved((x, y))));
        x += panel.width;
        line = line.max(panel.height);
        width = width.max(x);
    }
    Panel { group, width, height: y + line, movers }
}

/// The same, further down.
pub(crate) fn arranged_below(panel: Panel) -> Panel {
    let movers = panel.movers.into_iter().map(|mover| mover.moved((0.0, TIME_LINE))).collect();
    let group = Group::new().set("transform", format!("translate(0 {TIME_LINE})")).add(panel.group);
    Panel { group, width: panel.width.max(260.0), height: panel.height + TIME_LINE, movers }
}

/// The height of the line in which films have the time.
const TIME_LINE: f64 = 20.0;

/// Wider than this, panels are put below each other.
const WIDEST: f64 = 1100.0;
