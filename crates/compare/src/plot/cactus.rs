//! The quantile plot, also called cactus plot: how many instances were solved in at most so much time each.

use svg::Node;
use svg::node::element::path::Data;
use svg::node::element::{Group, Path, Title};

use super::{Area, Axis, DASHES, INK, MARKERS, color, document, line, marker, round, short, text};
use crate::contest::Contest;
use crate::score::Scores;

const AREA: Area = Area { left: 64.0, top: 16.0, width: 460.0, height: 340.0 };
const LEGEND: f64 = 232.0;
const LEGEND_LINE: f64 = 20.0;

/// Draws the plot. The legend is in the order of the scores.
pub fn cactus(contest: &Contest<'_>, scores: &Scores) -> String {
    let axis = Axis::new(contest, AREA.height - 8.0);
    let columns: Vec<Vec<f64>> = (0..contest.contestants.len()).map(|c| times(contest, c)).collect();
    let most = columns.iter().map(Vec::len).max().unwrap_or(0).max(1);
    let x = |count: usize| AREA.left + AREA.width * ratio(count, most);
    let y = |wall_s: f64| AREA.bottom() - axis.at(wall_s);
    let mut plot = Group::new();
    for (at, name) in axis.ticks() {
        AREA.row(&mut plot, AREA.bottom() - at, &name);
    }
    for count in (0..=most).step_by(step(most)) {
        AREA.column(&mut plot, x(count), &count.to_string());
    }
    AREA.axes(&mut plot, "instances solved", "wall time of each, in seconds");
    if let Some(limit) = contest.limit().filter(|limit| limit.is_finite()) {
        let at = y(limit);
        plot.append(line("limit", INK, (AREA.left, at), (AREA.right(), at)).set("stroke-dasharray", "4 4"));
        plot.append(text(&format!("limit {limit} s"), AREA.right(), at - 4.0, "end"));
    }
    let order = scores.order();
    for &c in &order {
        let points: Vec<(f64, f64)> =
            columns[c].iter().enumerate().map(|(i, wall)| (x(i + 1), y(*wall))).collect();
        plot.append(curve(c, &contest.contestants[c].label, &points));
    }
    for (place, &c) in order.iter().enumerate() {
        let at = AREA.top + 10.0 + LEGEND_LINE * ratio(place, 1);
        plot.append(legend(c, &contest.contestants[c].label, columns[c].len(), at));
    }
    let height = (AREA.bottom() + 48.0).max(AREA.top + 10.0 + LEGEND_LINE * ratio(order.len(), 1));
    document(AREA.right() + LEGEND, height, "Instances solved by time", plot)
}

/// The times of what a contestant solved, ascending.
fn times(contest: &Contest<'_>, contestant: usize) -> Vec<f64> {
    let solved =
        contest.column(contestant).filter(|(i, cell)| !contest.disputed[*i] && cell.solved().is_some());
    let mut times: Vec<f64> = solved.map(|(_, cell)| cell.median.wall_s).collect();
    times.sort_by(f64::total_cmp);
    times
}

#[expect(clippy::cast_precision_loss, reason = "counts of instances and lines are small")]
fn ratio(count: usize, of: usize) -> f64 {
    count as f64 / of as f64
}

/// A round distance between ticks, for at most ten of them.
fn step(most: usize) -> usize {
    (0..18)
        .flat_map(|power| [1, 2, 5].map(|digit| digit * 10_usize.pow(power)))
        .find(|step| most / step <= 10)
        .unwrap_or(most)
}

fn curve(contestant: usize, label: &str, points: &[(f64, f64)]) -> Group {
    let (class, stroke) = color(contestant);
    let mut group = Group::new().set("class", class).set("stroke", stroke).set("fill", "none");
    group.append(Title::new(label));
    let mut data = Data::new();
    for (i, &(x, y)) in points.iter().enumerate() {
        let at = (round(x), round(y));
        data = if i == 0 { data.move_to(at) } else { data.line_to(at) };
    }
    if !points.is_empty() {
        group.append(
            Path::new()
                .set("d", data)
                .set("stroke-width", 1.5)
                .set("stroke-dasharray", DASHES[contestant % DASHES.len()]),
        );
    }
    // The last one always; of many, only some.
    let every = points.len().div_ceil(20).max(1);
    for &at in points.iter().rev().step_by(every) {
        group.append(marker(MARKERS[contestant % MARKERS.len()], at));
    }
    group
}

fn legend(contestant: usize, label: &str, solved: usize, y: f64) -> Group {
    let (class, stroke) = color(contestant);
    let left = AREA.right() + 16.0;
    let mut sample = Group::new().set("class", class).set("stroke", stroke).set("fill", "none");
    sample.append(
        Path::new()
            .set("d", Data::new().move_to((left, y)).line_to((left + 36.0, y)))
            .set("stroke-width", 1.5)
            .set("stroke-dasharray", DASHES[contestant % DASHES.len()]),
    );
    sample.append(marker(MARKERS[contestant % MARKERS.len()], (left + 18.0, y)));
    let mut name = text(&format!("{} ({solved})", short(label, 20)), left + 44.0, y + 4.0, "start");
    name.append(Title::new(label));
    let mut group = Group::new();
    group.append(sample);
    group.append(name);
    group
}
