//! All that is written about a comparison, as files.

use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::Record;
use crate::contest::Contest;
use crate::difficulty;
use crate::division::{self, Division, divisions};
use crate::html;
use crate::judge::{Judgement, judge_contest};
use crate::latex;
use crate::links::Links;
use crate::plot;
use crate::score::{Scores, scores};
use crate::table;

/// Judgement and scores, for other programs.
#[derive(Serialize)]
struct Outcome<'a> {
    judgement: &'a Judgement,
    scores: &'a Scores,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    divisions: &'a [Division],
}

/// Writes all reports into a folder, which is made if need be, and returns what was written: `report.html`, `runs.csv`,
/// `runs.json`, `scores.json`, `table.md`, `table.tex`, `difficulty.md`, `divisions.md`, `instances.md`, `instances.tex`, `cactus.svg`, and `scatter-A-B.svg` for each two of the best contestants.
/// The folder is that of the log, as far as links to queries are concerned; links to instances are made where their files
/// are found from the current folder.
pub fn write_all(records: &[Record], dir: &Path) -> io::Result<Vec<PathBuf>> {
    write_all_from(records, dir, "")
}

/// The same, where the log is in another folder: `log` leads there from the reports, `..` say.
pub fn write_all_from(records: &[Record], dir: &Path, log: &str) -> io::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(dir)?;
    let contest = Contest::new(records);
    let judgement = judge_contest(&contest);
    let scores = scores(&contest, |_| true);
    let divisions = divisions(&contest);
    let by_division: Vec<table::Sheet> = divisions.iter().map(division::sheet).collect();
    let difficulty = difficulty::sheet(&contest);
    let sheets = table::sheets(&contest);
    let instances = table::instances(&contest, &scores);
    let mut csv = Vec::new();
    table::csv(records, &mut csv)?;
    let mut files = vec![
        (
            "report.html".to_owned(),
            html::page(&contest, &judgement, &scores, (&by_division, &difficulty), &Links::new(dir, log))?
                .into_bytes(),
        ),
        ("runs.csv".to_owned(), csv),
        ("runs.json".to_owned(), json(&records)?),
        (
            "scores.json".to_owned(),
            json(&Outcome { judgement: &judgement, scores: &scores, divisions: &divisions })?,
        ),
        ("difficulty.md".to_owned(), table::markdown(&difficulty).into_bytes()),
        ("instances.md".to_owned(), table::markdown(&instances).into_bytes()),
        ("instances.tex".to_owned(), latex(std::slice::from_ref(&instances)).into_bytes()),
        ("table.md".to_owned(), markdown(&sheets).into_bytes()),
        ("table.tex".to_owned(), latex(&sheets).into_bytes()),
        ("cactus.svg".to_owned(), plot::cactus(&contest, &scores).into_bytes()),
    ];
    // Without a division of the competition there is nothing to say.
    if !by_division.is_empty() {
        files.push(("divisions.md".to_owned(), headed(&by_division).into_bytes()));
    }
    for (a, b) in pairs(&scores.order()) {
        let names = [a, b].map(|c| slug(&contest.contestants[c].label));
        let mut name = format!("scatter-{}-{}.svg", names[0], names[1]);
        if files.iter().any(|(other, _)| *other == name) {
            name = format!("scatter-{}-{}-{a}-{b}.svg", names[0], names[1]);
        }
        files.push((name, plot::scatter(&contest, a, b).into_bytes()));
    }
    let mut written = Vec::new();
    for (name, contents) in files {
        let path = dir.join(name);
        hyperplan_outlet::write(&path, |to| to.write_all(&contents))?;
        written.push(path);
    }
    remove_stale(dir, &written)?;
    Ok(written)
}

/// Removes our scatter plots of an earlier report that was about others.
fn remove_stale(dir: &Path, written: &[PathBuf]) -> io::Result<()> {
    for entry in std::fs::read_dir(dir)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        let plot = name.strip_prefix("scatter-").and_then(|rest| rest.strip_suffix(".svg"));
        // Ours are of two.
        if plot.is_some_and(|names| names.contains('-')) && !written.contains(&path) {
            std::fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// So many contestants have a plot with each other; the page has all.
const BEST: usize = 4;

fn pairs(order: &[usize]) -> Vec<(usize, usize)> {
    let best = &order[..order.len().min(BEST)];
    best.iter().enumerate().flat_map(|(i, &a)| best[i + 1..].iter().map(move |&b| (a, b))).collect()
}

/// What every file system takes as part of a name.
fn slug(label: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c.to_ascii_lowercase() } else { '_' };
    label.chars().take(40).map(plain).collect()
}

fn json(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
}

/// Tables below their captions.
fn headed(sheets: &[table::Sheet]) -> String {
    let tables = sheets.iter().map(|sheet| format!("### {}\n\n{}", sheet.caption, table::markdown(sheet)));
    tables.collect::<Vec<_>>().join("\n")
}

/// The first table stands for everything; the others are headed by their families.
fn markdown(sheets: &[table::Sheet]) -> String {
    let tables: Vec<String> = sheets
        .iter()
        .enumerate()
        .map(|(i, sheet)| {
            let heading = if i == 0 { String::new() } else { format!("### {}\n\n", sheet.caption) };
            heading + &table::markdown(sheet)
        })
        .collect();
    tables.join("\n")
}

fn latex(sheets: &[table::Sheet]) -> String {
    let tables: Vec<String> = sheets
        .iter()
        .map(|sheet| {
            format!("% {}\n{}", sheet.caption.replace(['\n', '\r'], " "), crate::latex::latex(sheet))
        })
        .collect();
    let packages = sheets.iter().map(latex::packages).max_by_key(|packages| packages.len());
    format!("% \\usepackage{{{}}}\n{}", packages.unwrap_or("booktabs"), tables.join("\n"))
}
