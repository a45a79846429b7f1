//! Tables: of scores and instances, for Markdown and whatever else; of runs, as CSV.

use std::borrow::Cow;
use std::io;

use serde::Serialize;

use crate::contest::{Cell, Contest};
use crate::score::{Score, Scores, scores};
use crate::text::one_line;
use crate::{Answer, Record, Status};

/// Names of columns and the rows below.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sheet {
    /// What stands above.
    pub caption: String,
    /// The names.
    pub head: Vec<String>,
    /// Which columns are text, and set to the left.
    pub text: Vec<bool>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

/// The scores as a table, best first, the virtual best solver last. Columns that say nothing are left out.
pub fn sheet(scores: &Scores, caption: &str) -> Sheet {
    type Column = (&'static str, fn(&Score) -> String, fn(&Score) -> bool);
    let always: fn(&Score) -> bool = |_| true;
    // Where a solver takes part in several ways, these share what it alone solves.
    let several = scores.scores.iter().any(|score| score.unique_solver != score.unique);
    let parallel = scores.scores.iter().all(|score| score.rank == score.sequential_rank);
    let columns: [Column; 17] = [
        ("counted", |s| s.counted.to_string(), always),
        ("wrong", |s| s.wrong.to_string(), |s| s.wrong > 0),
        ("solved", |s| s.solved.to_string(), always),
        ("sat", |s| s.sat.to_string(), always),
        ("unsat", |s| s.unsat.to_string(), always),
        ("PAR-2", |s| if s.counted > 0 { seconds(s.par2) } else { String::new() }, always),
        ("wall", |s| seconds(s.parallel.wall_s), always),
        ("CPU", |s| seconds(s.parallel.cpu_s), always),
        ("unique", |s| s.unique.to_string(), always),
        (SOLVER_UNIQUE, |s| s.unique_solver.to_string(), always),
        ("fastest", |s| s.fastest.to_string(), always),
        (SEQUENTIAL, |s| s.sequential_rank.to_string(), always),
        ("unknown", |s| s.unknown.to_string(), |s| s.unknown > 0),
        ("timeout", |s| s.timeout.to_string(), |s| s.timeout > 0),
        ("memout", |s| s.memout.to_string(), |s| s.memout > 0),
        ("error", |s| s.error.to_string(), |s| s.error > 0),
        ("unsupported", |s| s.unsupported.to_string(), |s| s.unsupported > 0),
    ];
    let wanted = |column: &&Column| match column.0 {
        SOLVER_UNIQUE => several,
        SEQUENTIAL => !parallel,
        _ => scores.scores.iter().any(column.2),
    };
    let shown: Vec<&Column> = columns.iter().filter(wanted).collect();
    let head = ["#", "solver"].into_iter().chain(shown.iter().map(|column| column.0));
    let order = scores.order();
    let ranked = order.iter().map(|&i| (scores.scores[i].rank.to_string(), &scores.scores[i]));
    let best = (order.len() > 1).then_some((String::new(), &scores.best));
    let row = |(rank, score): (String, &Score)| {
        let virtual_best = rank.is_empty();
        let cells = shown.iter().map(|column| match column.0 {
            "unique" | SOLVER_UNIQUE | "fastest" | SEQUENTIAL if virtual_best => String::new(),
            _ => column.1(score),
        });
        [rank, score.contestant.clone()].into_iter().chain(cells).collect()
    };
    Sheet {
        caption: caption.to_owned(),
        head: head.map(str::to_owned).collect(),
        text: (0..shown.len() + 2).map(|i| i == 1).collect(),
        rows: ranked.chain(best).map(row).collect(),
    }
}

pub(crate) const SOLVER_UNIQUE: &str = "solver unique";
pub(crate) const SEQUENTIAL: &str = "seq. #";

/// The instances with what each contestant made of them, best contestant first: seconds, or what happened else.
pub fn instances(contest: &Contest<'_>, scores: &Scores) -> Sheet {
    let order = scores.order();
    let names = order.iter().map(|&c| contest.contestants[c].label.clone());
    let row = |i: usize| {
        let results = order.iter().map(|&c| contest.cells[i][c].as_ref().map_or_else(String::new, result));
        [contest.instances[i].label.clone(), contest.answer(i)].into_iter().chain(results).collect()
    };
    Sheet {
        caption: "instances".to_owned(),
        head: ["instance", "answer"].map(str::to_owned).into_iter().chain(names).collect(),
        text: [true, true].into_iter().chain(order.iter().map(|_| false)).collect(),
        rows: (0..contest.instances.len()).map(row).collect(),
    }
}

/// A cell in a word.
pub(crate) fn result(cell: &Cell<'_>) -> String {
    match (cell.wrong, cell.solved()) {
        (true, _) if cell.says().is_some() => format!("{} wrong", cell.median.status),
        (true, _) => "wrong".to_owned(),
        (false, Some(_)) => seconds(cell.median.wall_s),
        (false, None) => cell.median.status.to_string(),
    }
}

/// One table over everything, and one for each family if there are several.
pub fn sheets(contest: &Contest<'_>) -> Vec<Sheet> {
    let mut sheets = vec![sheet(&scores(contest, |_| true), "all")];
    let families = families(contest);
    if families.len() > 1 {
        for family in families {
            let scores = scores(contest, |i| contest.instances[i].family == family);
            sheets.push(sheet(&scores.of_counted(), &one_line(family)));
        }
    }
    sheets
}

/// The families, in order.
pub(crate) fn families<'c>(contest: &'c Contest<'_>) -> Vec<&'c str> {
    let mut families: Vec<&str> = contest.instances.iter().map(|instance| instance.family.as_str()).collect();
    families.dedup();
    families
}

/// What the columns mean and how repetitions were dealt with, a sentence each.
pub(crate) fn notes(contest: &Contest<'_>, scores: &Scores) -> Vec<String> {
    let mut notes = vec![
        "Order: fewer wrong answers, more correct ones, less wall time, less CPU time (SMT-COMP's parallel score)."
            .to_owned(),
        format!(
            "PAR-2: mean wall time in seconds; what was not solved counts as twice {}.",
            match contest.limit() {
                Some(limit) => format!("the limit of {limit} s"),
                None => "its limit".to_owned(),
            }
        ),
        "Wall, CPU: seconds in all, of what was solved.".to_owned(),
    ];
    if scores.scores.iter().any(|score| score.rank != score.sequential_rank) {
        notes.push(format!(
            "{SEQUENTIAL}: the place by CPU time, which is limited like wall time (SMT-COMP's sequential score)."
        ));
    }
    if scores.scores.iter().any(|score| score.unique != score.unique_solver) {
        notes.push(format!(
            "Unique: solved by no other; {SOLVER_UNIQUE}: by no other solver, in whatever configuration."
        ));
    }
    if scores.scores.iter().any(|score| score.unsupported > 0) {
        notes.push("What a solver does not support is not counted.".to_owned());
    }
    if scores.scores.iter().any(|score| score.counted != scores.best.counted) {
        notes.push("Not everyone was counted on every instance: compare with care.".to_owned());
    }
    if scores.repetitions > 1 {
        notes.push(format!(
            "Each time is the median of up to {} runs; a wrong answer in any of them is wrong.",
            scores.repetitions
        ));
    }
    if scores.disputed > 0 {
        let (instances, are) = if scores.disputed == 1 { ("instance", "is") } else { ("instances", "are") };
        notes.push(format!(
            "{} {instances} with contradictory answers, of which nothing tells the right one, {are} left out.",
            scores.disputed
        ));
    }
    notes
}

/// A table in Markdown.
pub fn markdown(sheet: &Sheet) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| markdown_text(cell)).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let rule: Vec<&str> = sheet.text.iter().map(|text| if *text { "---" } else { "---:" }).collect();
    let mut text = format!("{}| {} |\n", line(&sheet.head), rule.join(" | "));
    text.extend(sheet.rows.iter().map(|row| line(row)));
    text
}

/// What GitHub and its kin take literally.
fn markdown_text(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '\n' | '\r' => escaped.push(' '),
            '<' => escaped.push_str("&lt;"),
            '&' => escaped.push_str("&amp;"),
            '\\' | '|' | '*' | '_' | '`' | '[' | ']' | '#' if text != "#" => escaped.extend(['\\', c]),
            _ => escaped.push(c),
        }
    }
    escaped
}

/// Seconds, with as many digits as they are worth.
pub(crate) fn seconds(seconds: f64) -> String {
    if seconds.abs() < 10.0 {
        format!("{seconds:.3}")
    } else if seconds.abs() < 1000.0 {
        format!("{seconds:.1}")
    } else {
        format!("{seconds:.0}")
    }
}

/// A record as a row of CSV: flat, in the order of the columns.
#[derive(Serialize)]
struct Row<'a> {
    instance: Cow<'a, str>,
    family: Cow<'a, str>,
    sha256: &'a str,
    logic: Option<&'a str>,
    states: Option<&'a str>,
    quantifiers: Option<&'a str>,
    states_used: Option<&'a str>,
    quantifiers_used: Option<&'a str>,
    horizon: Option<u64>,
    set: String,
    solver: Cow<'a, str>,
    version: Option<Cow<'a, str>>,
    options: Cow<'a, str>,
    seed: u64,
    repetition: u32,
    status: Status,
    expected: Option<Answer>,
    verified: Option<&'a str>,
    wall_s: f64,
    cpu_s: f64,
    solver_s: Option<f64>,
    rounds: Option<u64>,
    memory_mib: f64,
    limit_wall_s: Option<f64>,
    limit_cpu_s: Option<f64>,
    limit_memory_mib: Option<u64>,
    exit_code: Option<i32>,
    signal: Option<i32>,
    host: &'a str,
    variables: Option<u64>,
    assertions: Option<u64>,
    bytes: Option<u64>,
    message: Option<Cow<'a, str>>,
    queries: Option<Cow<'a, str>>,
}

impl<'a> From<&'a Record> for Row<'a> {
    fn from(record: &'a Record) -> Self {
        Self {
            instance: one_line(&record.instance),
            family: one_line(&record.family),
            sha256: &record.sha256,
            logic: record.logic.as_deref(),
            states: record.states.as_deref(),
            quantifiers: record.quantifiers.as_deref(),
            states_used: record.states_used.as_deref(),
            quantifiers_used: record.quantifiers_used.as_deref(),
            horizon: record.horizon,
            set: one_line(&record.set.join(" ")).into_owned(),
            solver: one_line(&record.solver),
            version: record.version.as_deref().map(one_line),
            options: one_line(&record.options),
            seed: record.seed,
            repetition: record.repetition,
            status: record.status,
            expected: record.expected,
            verified: record.verified.as_deref(),
            wall_s: record.wall_s,
            cpu_s: record.cpu_s,
            solver_s: record.solver_s,
            rounds: record.rounds,
            memory_mib: record.memory_mib,
            limit_wall_s: record.limit.wall_s,
            limit_cpu_s: record.limit.cpu_s,
            limit_memory_mib: record.limit.memory_mib,
            exit_code: record.exit_code,
            signal: record.signal,
            host: &record.host,
            variables: record.variables,
            assertions: record.assertions,
            bytes: record.bytes,
            message: record.message.as_deref().map(one_line),
            queries: record.queries.as_deref().map(one_line),
        }
    }
}

/// Writes every column of every record as CSV, a line each, whatever is in names and messages.
pub fn csv(records: &[Record], to: impl io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    for record in records {
        writer.serialize(Row::from(record)).map_err(io::Error::other)?;
    }
    writer.flush()
}
