//! The report as a page: one file that needs no network. The template escapes all text of records; links are relative,
//! whatever a record says.

use std::collections::BTreeSet;
use std::io;

use askama::Template;
use serde::Serialize;

use crate::contest::{Cell, Contest, Contestant, Row, is_certified};
use crate::judge::{Fault, Finding, Judgement};
use crate::links::Links;
use crate::plot::{self, KINDS, Kind, Scatter};
use crate::score::Scores;
use crate::table::{self, Sheet, seconds};
use crate::{Answer, Record};

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    style: &'static str,
    script: &'static str,
    facts: String,
    verdict: String,
    findings: &'a [Finding],
    links: &'a Links<'a>,
    scores: Grid,
    notes: Vec<String>,
    cactus: String,
    scatter: String,
    names: Vec<String>,
    pair: (usize, usize),
    divisions: Vec<Grid>,
    difficulty: Grid,
    families: Vec<Grid>,
    instances: Grid,
    contestants: Grid,
    data: String,
}

/// A table of the page.
struct Grid {
    id: String,
    caption: String,
    head: Vec<String>,
    /// Columns of text, which are set to the left.
    text: Vec<bool>,
    rows: Vec<GridRow>,
}

impl Grid {
    fn is_text(&self, column: &usize) -> bool {
        self.text.get(*column).copied().unwrap_or(true)
    }
}

struct GridRow {
    cells: Vec<GridCell>,
    /// Stays last, however the table is sorted.
    last: bool,
}

#[derive(Default)]
struct GridCell {
    text: String,
    /// What it is sorted by, if not by its text.
    key: Option<f64>,
    title: Option<String>,
    href: Option<String>,
    bad: bool,
}

/// What the page's script needs to draw any two contestants.
#[derive(Serialize)]
struct Data<'a> {
    origin: (f64, f64),
    kinds: [Kind; 3],
    instances: Vec<&'a str>,
    contestants: Vec<ContestantData<'a>>,
}

#[derive(Serialize)]
struct ContestantData<'a> {
    name: &'a str,
    at: Vec<Option<f64>>,
    /// The number of the kind: sat, unsat, not solved.
    answer: Vec<u8>,
    words: Vec<String>,
}

/// Writes the page, with the tables of divisions and by difficulty.
pub(crate) fn page(
    contest: &Contest<'_>,
    judgement: &Judgement,
    scores: &Scores,
    (divisions, difficulty): (&[Sheet], &Sheet),
    links: &Links<'_>,
) -> io::Result<String> {
    let order = scores.order();
    let pair = (order.first().copied().unwrap_or(0), order.get(1).copied().unwrap_or(0));
    let sheets = table::sheets(contest);
    let (all, families) = sheets.split_first().ok_or_else(|| io::Error::other("no table"))?;
    let page = Page {
        style: include_str!("../templates/report.css"),
        script: include_str!("../templates/report.js"),
        facts: facts(contest),
        verdict: verdict(judgement),
        findings: &judgement.findings,
        scores: scores_grid(all, "scores", "Scores"),
        notes: table::notes(contest, scores),
        cactus: if order.is_empty() { String::new() } else { plot::cactus(contest, scores) },
        scatter: if order.len() < 2 { String::new() } else { plot::scatter(contest, pair.0, pair.1) },
        names: contest.contestants.iter().map(|contestant| contestant.label.clone()).collect(),
        pair,
        divisions: (0..).zip(divisions).map(|(i, sheet)| division(i, sheet)).collect(),
        difficulty: scores_grid(difficulty, "difficulty", &difficulty.caption),
        families: (0..).zip(families).map(|(i, sheet)| family(i, sheet)).collect(),
        instances: instances(contest, &order, links),
        contestants: contestants(contest),
        links,
        data: data(contest)?,
    };
    page.render().map_err(io::Error::other)
}

fn division(number: usize, sheet: &Sheet) -> Grid {
    scores_grid(sheet, &format!("division-{number}"), &sheet.caption)
}

fn family(number: usize, sheet: &Sheet) -> Grid {
    scores_grid(sheet, &format!("family-{number}"), &sheet.caption)
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn facts(contest: &Contest<'_>) -> String {
    let host = |run: &Record| match &run.processor {
        Some(processor) => format!("{} ({processor})", run.host),
        None => run.host.clone(),
    };
    let hosts: BTreeSet<String> = contest.runs().map(host).collect();
    let mut facts = format!(
        "{} of {} on {}",
        count(contest.runs().count(), "run"),
        count(contest.contestants.len(), "solver configuration"),
        count(contest.instances.len(), "instance")
    );
    if let Some(limit) = contest.limit() {
        facts.push_str(&format!(", limit {limit} s"));
    }
    let memory: BTreeSet<u64> = contest.runs().filter_map(|run| run.limit.memory_mib).collect();
    if let (1, Some(memory)) = (memory.len(), memory.first()) {
        facts.push_str(&format!(" and {memory} MiB"));
    }
    if !hosts.is_empty() {
        let hosts: Vec<String> = hosts.into_iter().collect();
        facts.push_str(&format!(", on {}", hosts.join(", ")));
    }
    facts.push('.');
    facts
}

fn verdict(judgement: &Judgement) -> String {
    let findings = judgement.findings.len();
    let whose = if judgement.fault() == Some(Fault::Ours) {
        "not all of it can be laid on a solver"
    } else {
        "solvers are to blame"
    };
    let are = if findings == 1 { "thing is" } else { "things are" };
    format!("{findings} {are} wrong; {whose}.")
}

fn scores_grid(sheet: &Sheet, id: &str, caption: &str) -> Grid {
    let rows = sheet.rows.iter().map(|row| GridRow {
        last: row.first().is_some_and(String::is_empty),
        cells: row
            .iter()
            .enumerate()
            .map(|(i, text)| GridCell {
                bad: sheet.head[i] == "wrong" && text != "0",
                key: if i == 1 { None } else { text.parse().ok() },
                text: text.clone(),
                ..GridCell::default()
            })
            .collect(),
    });
    Grid {
        id: id.to_owned(),
        caption: caption.to_owned(),
        head: sheet.head.clone(),
        text: sheet.text.clone(),
        rows: rows.collect(),
    }
}

/// The instances with what each contestant made of them, best contestant first.
fn instances(contest: &Contest<'_>, order: &[usize], links: &Links<'_>) -> Grid {
    let names = order.iter().map(|&c| contest.contestants[c].label.clone());
    let row = |(i, instance): (usize, &Row<'_>)| {
        let disputed = contest.disputed[i];
        let mark = if disputed { "✗ " } else { "" };
        let answer =
            GridCell { text: format!("{mark}{}", contest.answer(i)), bad: disputed, ..GridCell::default() };
        let name = GridCell {
            text: instance.label.clone(),
            title: Some(format!("sha256 {}", instance.sha256)),
            href: links.instance(instance.name),
            ..GridCell::default()
        };
        let only = contest.only(i).filter(|_| order.len() > 1);
        let cells = order.iter().map(|&c| result(contest.cells[i][c].as_ref(), only == Some(c), links));
        GridRow { cells: [name, answer].into_iter().chain(cells).collect(), last: false }
    };
    Grid {
        id: "instances".to_owned(),
        caption: "Instances".to_owned(),
        head: ["instance", "answer"].map(str::to_owned).into_iter().chain(names).collect(),
        text: [true, true].into_iter().chain(order.iter().map(|_| false)).collect(),
        rows: contest.instances.iter().enumerate().map(row).collect(),
    }
}

fn result(cell: Option<&Cell<'_>>, only: bool, links: &Links<'_>) -> GridCell {
    let Some(cell) = cell else { return GridCell::default() };
    let mark = match (cell.wrong, only) {
        (true, _) => "✗ ",
        (false, true) => "★ ",
        (false, false) => "",
    };
    let wall_s = cell.median.wall_s;
    GridCell {
        text: format!("{mark}{}", table::result(cell)),
        key: (cell.solved().is_some() && wall_s.is_finite()).then_some(wall_s),
        title: Some(details(cell)),
        href: cell.runs.iter().find_map(|run| run.queries.as_deref()).map(|queries| links.largest(queries)),
        bad: cell.wrong,
    }
}

/// What a pointer shows of a result.
fn details(cell: &Cell<'_>) -> String {
    let run: &Record = cell.median;
    let mut text = format!(
        "{}, wall {} s, CPU {} s, {:.0} MiB",
        run.status,
        seconds(run.wall_s),
        seconds(run.cpu_s),
        run.memory_mib
    );
    if is_certified(run) {
        text.push_str(", witness checked");
    }
    if cell.runs.len() > 1 {
        text.push_str(&format!(", median of {} runs", cell.runs.len()));
    }
    if let Some(waiting) = run.solver_s {
        text.push_str(&format!(", {} s of it in the solver", seconds(waiting)));
    }
    let used = [("quantifiers", &run.quantifiers_used), ("states", &run.states_used)];
    for (name, how) in used {
        if let Some(how) = how {
            text.push_str(&format!(", {name} {how}"));
        }
    }
    let sizes = [
        ("horizon", run.horizon),
        ("variables", run.variables),
        ("assertions", run.assertions),
        ("bytes", run.bytes),
        ("rounds", run.rounds),
    ];
    for (name, size) in sizes {
        if let Some(size) = size {
            text.push_str(&format!(", {name} {size}"));
        }
    }
    if let Some(message) = &run.message {
        text.push_str(&format!("; {message}"));
    }
    text
}

fn contestants(contest: &Contest<'_>) -> Grid {
    let head = ["name", "solver", "version", "quantifiers", "states", "options"];
    let rows = contest.contestants.iter().map(|contestant| {
        let &Contestant { solver, quantifiers, states, version, options, ref label } = contestant;
        let [version, quantifiers, states] = [version, quantifiers, states].map(Option::unwrap_or_default);
        let texts = [label.as_str(), solver, version, quantifiers, states, options];
        let cell = |text: &str| GridCell { text: text.to_owned(), ..GridCell::default() };
        GridRow { cells: texts.map(cell).into(), last: false }
    });
    Grid {
        id: "contestants".to_owned(),
        caption: "Solvers".to_owned(),
        head: head.map(str::to_owned).into(),
        text: vec![true; head.len()],
        rows: rows.collect(),
    }
}

/// As JSON that does not end the script that it stands in.
fn data(contest: &Contest<'_>) -> io::Result<String> {
    let scatter = Scatter::new(contest);
    let column = |c: usize| contest.cells.iter().map(move |row| row[c].as_ref());
    let kind = |cell: Option<&Cell<'_>>| match cell.and_then(Cell::solved) {
        Some(Answer::Sat) => 0,
        Some(Answer::Unsat) => 1,
        None => 2,
    };
    let contestants = contest.contestants.iter().enumerate().map(|(c, contestant)| ContestantData {
        name: &contestant.label,
        at: column(c).map(|cell| scatter.at(cell)).collect(),
        answer: column(c).map(kind).collect(),
        words: column(c).map(|cell| cell.map_or_else(String::new, plot::words)).collect(),
    });
    let data = Data {
        origin: Scatter::origin(),
        kinds: KINDS,
        instances: contest.instances.iter().map(|instance| instance.label.as_str()).collect(),
        contestants: contestants.collect(),
    };
    Ok(serde_json::to_string(&data)?.replace('<', "\\u003c"))
}
