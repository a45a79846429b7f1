//! The scatter plot of two contestants: a mark for each instance, below the diagonal where the vertical one was faster.

use svg::Node;
use svg::node::element::{Group, Title};

use super::{Area, Axis, FAINT, INK, document, line, marker, round, short, text};
use crate::contest::{Cell, Contest};
use crate::table::seconds;
use crate::{Answer, Status};

const AREA: Area = Area { left: 64.0, top: 40.0, width: 372.0, height: 372.0 };
/// How far beyond the limit those lie that failed otherwise.
const BEYOND: f64 = 24.0;

/// How an instance is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Both solved it, and it is satisfiable.
    Sat,
    /// Both solved it, and it is unsatisfiable.
    Unsat,
    /// One of them at least did not solve it.
    Unsolved,
}

impl Kind {
    /// All kinds, in the order of their numbers on the page.
    pub(crate) const ALL: [Self; 3] = [Self::Sat, Self::Unsat, Self::Unsolved];

    fn name(self) -> &'static str {
        match self {
            Self::Sat => "sat",
            Self::Unsat => "unsat",
            Self::Unsolved => "unsolved by one or both",
        }
    }

    /// The outline, the class and the color.
    pub(crate) fn style(self) -> (usize, &'static str, &'static str) {
        match self {
            Self::Sat => (0, "c0", super::COLORS[0]),
            Self::Unsat => (5, "c1", super::COLORS[1]),
            Self::Unsolved => (2, "c6", super::COLORS[6]),
        }
    }

    /// The outline as the data of a path.
    pub(crate) fn outline(self) -> &'static str {
        super::MARKERS[self.style().0]
    }
}

/// Where a contestant's times lie on the axes that all scatter plots share.
pub(crate) struct Scatter {
    axis: Axis,
}

impl Scatter {
    pub(crate) fn new(contest: &Contest<'_>) -> Self {
        Self { axis: Axis::new(contest, AREA.width - BEYOND) }
    }

    /// The distance along an axis; none where nothing was run that counts.
    pub(crate) fn at(&self, cell: Option<&Cell<'_>>) -> Option<f64> {
        let cell = cell.filter(|cell| cell.counts())?;
        Some(round(if cell.solved().is_some() {
            self.axis.at(cell.median.wall_s)
        } else if cell.median.status == Status::Timeout && !cell.wrong {
            self.axis.length
        } else {
            self.axis.length + BEYOND
        }))
    }

    /// The place of the origin on the page, from which distances go right and up.
    pub(crate) fn origin() -> (f64, f64) {
        (AREA.left, AREA.bottom())
    }
}

/// How two results on an instance are marked.
fn kind(a: &Cell<'_>, b: &Cell<'_>) -> Kind {
    match (a.solved(), b.solved()) {
        (Some(Answer::Sat), Some(Answer::Sat)) => Kind::Sat,
        (Some(Answer::Unsat), Some(Answer::Unsat)) => Kind::Unsat,
        _ => Kind::Unsolved,
    }
}

/// What a cell says of itself, in words.
pub(crate) fn words(cell: &Cell<'_>) -> String {
    match (cell.solved(), cell.wrong) {
        (_, true) => "wrong".to_owned(),
        (Some(_), false) => format!("{} s", seconds(cell.median.wall_s)),
        (None, false) => cell.median.status.to_string(),
    }
}

/// Draws the contestants with these numbers, the first along the horizontal axis.
pub fn scatter(contest: &Contest<'_>, horizontal: usize, vertical: usize) -> String {
    let names = [horizontal, vertical].map(|c| contest.contestants[c].label.as_str());
    let scatter = Scatter::new(contest);
    let mut plot = Group::new();
    scatter.grid(&mut plot, contest);
    let name = |name: &str| format!("{}, seconds", short(name, 40));
    AREA.axes(&mut plot, &name(names[0]), &name(names[1]));
    for (i, kind) in Kind::ALL.into_iter().enumerate() {
        let x = AREA.left + 8.0 + [0.0, 56.0, 122.0][i];
        let (outline, class, stroke) = kind.style();
        plot.append(marker(outline, (x, 14.0)).set("class", class).set("stroke", stroke));
        plot.append(text(kind.name(), x + 9.0, 18.0, "start"));
    }
    let mut points = Group::new().set("class", "points");
    for (i, row) in contest.cells.iter().enumerate() {
        let cells = (row[horizontal].as_ref(), row[vertical].as_ref());
        let (Some(a), Some(b), Some(x), Some(y)) =
            (cells.0, cells.1, scatter.at(cells.0), scatter.at(cells.1))
        else {
            continue;
        };
        let (outline, class, stroke) = kind(a, b).style();
        let mut point = marker(outline, (AREA.left + x, AREA.bottom() - y));
        point.append(Title::new(format!("{}: {}, {}", contest.instances[i].label, words(a), words(b))));
        points.append(point.set("class", class).set("stroke", stroke));
    }
    plot.append(points);
    let title = format!("Wall time of {} against {}", names[0], names[1]);
    document(AREA.right() + 40.0, AREA.bottom() + 48.0, &title, plot)
}

impl Scatter {
    /// Ticks, the diagonal with those of a tenth and of ten times, and the lines of those who did not make it.
    fn grid(&self, plot: &mut Group, contest: &Contest<'_>) {
        let (left, bottom) = Self::origin();
        let end = self.axis.length;
        for (at, name) in self.axis.ticks() {
            // What comes too close to the name of the limit goes without its own.
            let name = if end - at < 30.0 { "" } else { &name };
            AREA.column(plot, left + at, name);
            AREA.row(plot, bottom - at, name);
        }
        let limit = contest.limit().map_or_else(|| "time".to_owned(), |limit| limit.to_string());
        for (at, name) in [(end, limit.as_str()), (end + BEYOND, "fail")] {
            plot.append(
                line("limit", INK, (left + at, bottom), (left + at, AREA.top)).set("stroke-dasharray", "4 4"),
            );
            plot.append(
                line("limit", INK, (left, bottom - at), (AREA.right(), bottom - at))
                    .set("stroke-dasharray", "4 4"),
            );
            plot.append(text(name, left + at, bottom + 16.0, "middle"));
            plot.append(text(name, left - 6.0, bottom - at + 4.0, "end"));
        }
        let decade = end / (self.axis.high / self.axis.low).log10();
        plot.append(line("axis", INK, (left, bottom), (left + end, bottom - end)));
        if decade < end {
            let (below, above) = ((left + decade, bottom), (left + end, bottom - end + decade));
            let mirror = |(x, y): (f64, f64)| (left + bottom - y, bottom + left - x);
            for (from, to) in [(below, above), (mirror(below), mirror(above))] {
                plot.append(line("aside", FAINT, from, to).set("stroke-dasharray", "1 4"));
            }
        }
    }
}
