//! The scatter plot of two contestants: a mark for each instance, below the diagonal where the vertical one was faster.

use serde::Serialize;
use svg::Node;
use svg::node::element::{Group, Title};

use super::{Area, Axis, COLORS, FAINT, INK, MARKERS, document, line, marker, round, short, text};
use crate::contest::{Cell, Contest};
use crate::table::seconds;
use crate::{Answer, RunStatus};

const AREA: Area = Area { left: 64.0, top: 40.0, width: 372.0, height: 372.0 };
/// How far beyond the limit those lie that failed otherwise.
const BEYOND: f64 = 24.0;

/// How instances are marked, for the page too.
#[derive(Serialize)]
pub(crate) struct Kind {
    #[serde(skip)]
    name: &'static str,
    /// The data of a path.
    outline: &'static str,
    class: &'static str,
    #[serde(skip)]
    color: &'static str,
}

/// Both solved it, and it is satisfiable, or unsatisfiable; or one of them at least did not solve it.
pub(crate) const KINDS: [Kind; 3] = [
    Kind { name: "sat", outline: MARKERS[0], class: "c0", color: COLORS[0] },
    Kind { name: "unsat", outline: MARKERS[5], class: "c1", color: COLORS[1] },
    Kind { name: "unsolved by one or both", outline: MARKERS[2], class: "c6", color: COLORS[6] },
];

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
        } else if cell.median.status == RunStatus::Timeout && !cell.wrong {
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
fn kind(a: &Cell<'_>, b: &Cell<'_>) -> &'static Kind {
    match (a.solved(), b.solved()) {
        (Some(Answer::Sat), Some(Answer::Sat)) => &KINDS[0],
        (Some(Answer::Unsat), Some(Answer::Unsat)) => &KINDS[1],
        _ => &KINDS[2],
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
    for (i, Kind { name, outline, class, color }) in KINDS.iter().enumerate() {
        let x = AREA.left + 8.0 + [0.0, 56.0, 122.0][i];
        plot.append(marker(outline, (x, 14.0)).set("class", *class).set("stroke", *color));
        plot.append(text(name, x + 9.0, 18.0, "start"));
    }
    let mut points = Group::new().set("class", "points");
    for (i, row) in contest.cells.iter().enumerate() {
        let cells = (row[horizontal].as_ref(), row[vertical].as_ref());
        let (Some(a), Some(b), Some(x), Some(y)) =
            (cells.0, cells.1, scatter.at(cells.0), scatter.at(cells.1))
        else {
            continue;
        };
        let &Kind { outline, class, color, .. } = kind(a, b);
        let mut point = marker(outline, (AREA.left + x, AREA.bottom() - y));
        point.append(Title::new(format!("{}: {}, {}", contest.instances[i].label, words(a), words(b))));
        points.append(point.set("class", class).set("stroke", color));
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
