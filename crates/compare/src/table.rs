//! Tables: of scores and instances, for Markdown and whatever else; of runs, as CSV.

use std::io;

use serde_json::Value;

use crate::Record;
use crate::contest::{Cell, Contest};
use crate::score::{Score, Scores, scores};
use hyperplan_outlet::one_line;

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
    let mut families: Vec<&str> = contest.instances.iter().map(|instance| instance.family).collect();
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

/// The columns of runs as CSV: the names of a record's fields, and those of its limits.
const COLUMNS: &str = "\
    instance,family,sha256,logic,states,quantifiers,states_used,quantifiers_used,horizon,set,solver,\
    version,options,seed,repetition,status,expected,verified,wall_s,cpu_s,solver_s,rounds,memory_mib,\
    limit_wall_s,limit_cpu_s,limit_memory_mib,exit_code,signal,host,processor,variables,assertions,bytes,message,\
    queries";

/// Writes every column of every record as CSV, a line each, whatever is in names and messages. Text that a spreadsheet
/// would take for a formula has a `'` before it.
pub fn csv(records: &[Record], to: impl io::Write) -> io::Result<()> {
    let mut writer = csv::Writer::from_writer(to);
    if !records.is_empty() {
        writer.write_record(COLUMNS.split(',')).map_err(io::Error::other)?;
    }
    for record in records {
        let record = serde_json::to_value(record)?;
        let cells = COLUMNS.split(',').map(|column| match column.strip_prefix("limit_") {
            Some(limit) => cell(&record["limit"][limit]),
            None => cell(&record[column]),
        });
        writer.write_record(cells).map_err(io::Error::other)?;
    }
    writer.flush()
}

fn cell(value: &Value) -> String {
    let text = shown(value);
    // With a tab or a line break they may begin too, but these are escaped.
    let formula = !value.is_number() && text.starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠']);
    if formula { format!("'{text}") } else { text }
}

fn shown(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => one_line(text).into_owned(),
        Value::Array(parts) => parts.iter().map(shown).collect::<Vec<_>>().join(" "),
        value => value.to_string(),
    }
}
