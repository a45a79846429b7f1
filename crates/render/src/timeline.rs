//! A path over time, where its states lie nowhere: a row for what it does, and one for each variable.

use crate::mover::Mover;
use crate::panel::{Entry, Panel};
use crate::style::{MARGIN, clipped, every, number, stroke, width};
use crate::table::in_words;
use crate::track::Track;
use hyperplan_outlet::one_line;
use hyperplan_problem::{Problem, System, Trace, Value, VarId};
use svg::node::element::path::Data;
use svg::node::element::{Group, Line, Path, Rectangle, Text};

/// From row to row, and the height of what is in one.
const ROW: f64 = 26.0;
const BAR: f64 = 18.0;
const LETTERS: f64 = 11.0;
/// As wide as the times of a path may be.
const WIDEST: f64 = 800.0;
/// More rows are not drawn.
const MOST_ROWS: usize = 60;

/// What stands in a row for some steps.
struct Run {
    from: usize,
    to: usize,
    words: String,
    /// Whether it is what is drawn with emphasis: `true`.
    set: bool,
}

/// The rows of one path.
pub(crate) fn panel(
    problem: &Problem,
    system: &System,
    (track, trace): (&Track<'_>, &Trace),
    mut entries: Vec<Entry>,
) -> Panel {
    let steps = trace.states.len().max(1);
    let vars: Vec<VarId> = system.vars.keys().filter(|var| system.vars[*var].sums.is_none()).collect();
    let mut rows = vec![("action".to_owned(), actions(problem, trace))];
    for var in vars.iter().take(MOST_ROWS) {
        rows.push((clipped(&one_line(&system.vars[*var].name), 24), values(system, *var, trace)));
    }
    if vars.len() > MOST_ROWS {
        entries.push(Entry::Words(format!("and {} more variables", vars.len() - MOST_ROWS)));
    }
    let names = rows.iter().map(|(name, _)| width(name, LETTERS + 1.0)).fold(60.0, f64::max).min(220.0);
    let left = MARGIN + names + 8.0;
    let longest = rows.iter().flat_map(|(_, runs)| runs).map(|run| width(&run.words, LETTERS) + 8.0);
    let step = (WIDEST / steps as f64).min(longest.fold(22.0, f64::max).min(64.0));
    let (color, _) = stroke(track.index);
    let mut group = Group::new().set("class", "timeline").set("data-path", track.name);
    group = group.add(times(steps, left, step, rows.len()));
    for (i, (name, runs)) in rows.iter().enumerate() {
        let top = MARGIN + i as f64 * ROW;
        let text = Text::new(name.as_str()).set("x", left - 8.0).set("y", top + BAR * 0.72);
        group = group.add(text.set("text-anchor", "end").set("font-size", LETTERS + 1.0));
        // What is done lies between two times.
        let shift = if i == 0 { 0.5 } else { 0.0 };
        group = group.add(row(runs, (left + shift * step, top), step, color));
    }
    let at = (0..steps).map(|time| (left + (time as f64 + 0.5) * step, MARGIN - 14.0)).collect();
    let movers = vec![Mover::Cursor { at, height: 14.0 + rows.len() as f64 * ROW }];
    let width = left + steps as f64 * step + MARGIN;
    let height = MARGIN + rows.len() as f64 * ROW + 22.0;
    Panel { group, width, height, movers }.with_legend(entries)
}

/// The times above the rows, and a line down from each that is written.
fn times(steps: usize, left: f64, step: f64, rows: usize) -> Group {
    let apart = every(step, width(&steps.to_string(), 10.0) + 6.0);
    (0..steps).step_by(apart).fold(Group::new().set("class", "axis"), |group, time| {
        let x = number(left + (time as f64 + 0.5) * step);
        let text =
            Text::new(time.to_string()).set("x", x).set("y", MARGIN - 6.0).set("text-anchor", "middle");
        let line = Line::new().set("x1", x).set("x2", x).set("y1", MARGIN - 3.0);
        let line = line.set("y2", MARGIN + rows as f64 * ROW).set("stroke", "#e4e4e4");
        group.add(line).add(text)
    })
}

/// Equal neighbours are one bar, with what it is where that fits. Bars that are too narrow to be seen are one grey area.
fn row(runs: &[Run], (left, top): (f64, f64), step: f64, color: &str) -> Group {
    let mut group = Group::new().set("font-size", LETTERS);
    let mut narrow = Data::new();
    let mut until = f64::NEG_INFINITY;
    for run in runs {
        let (x, wide) = (left + run.from as f64 * step, (run.to - run.from) as f64 * step);
        if wide < 2.0 {
            if x >= until {
                narrow = narrow
                    .move_to((number(x), top))
                    .horizontal_line_by(1)
                    .vertical_line_by(BAR)
                    .horizontal_line_by(-1)
                    .close();
                until = x + 1.0;
            }
            continue;
        }
        let bar = Rectangle::new().set("x", number(x + 0.5)).set("y", top).set("width", number(wide - 1.0));
        let bar = bar.set("height", BAR).set("stroke", color).set("stroke-width", 1);
        group = group.add(bar.set("fill", if run.set { color } else { "#ffffff" }));
        if width(&run.words, LETTERS) * 0.92 <= wide - 3.0 {
            let text = Text::new(run.words.as_str()).set("text-anchor", "middle");
            let text = text.set("x", number(x + wide / 2.0)).set("y", top + BAR * 0.72);
            group = group.add(text.set("style", if run.set { "fill: #ffffff" } else { "fill: #222222" }));
        }
    }
    group.add(Path::new().set("d", narrow).set("fill", "#999999"))
}

fn actions(problem: &Problem, trace: &Trace) -> Vec<Run> {
    let names = trace.actions.iter().map(|action| one_line(&problem.actions[*action]).into_owned());
    // Each action is a step of its own.
    names.enumerate().map(|(time, words)| Run { from: time, to: time + 1, words, set: false }).collect()
}

fn values(system: &System, var: VarId, trace: &Trace) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut before: Option<Value> = None;
    for (time, state) in trace.states.iter().enumerate() {
        let value = state[usize::from(var)];
        match runs.last_mut() {
            Some(run) if before == Some(value) => run.to = time + 1,
            _ => {
                let words = in_words(&system.vars[var].ty, value);
                runs.push(Run { from: time, to: time + 1, words, set: value == Value::Bool(true) });
            }
        }
        before = Some(value);
    }
    runs
}
