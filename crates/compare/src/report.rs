//! All that is written about a comparison, as files.

use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::Record;
use crate::contest::Contest;
use crate::judge::{Judgement, judge_contest};
use crate::score::{Scores, scores};
use crate::table;

/// Judgement and scores, for other programs.
#[derive(Serialize)]
struct Outcome<'a> {
    judgement: &'a Judgement,
    scores: &'a Scores,
}

/// Writes all reports into a folder, which is made if need be: `runs.csv`, `runs.json`, `scores.json`, `table.md`, `table.tex`.
/// Returns what was written.
pub fn write_all(records: &[Record], dir: &Path) -> io::Result<Vec<PathBuf>> {
    std::fs::create_dir_all(dir)?;
    let contest = Contest::new(records);
    let judgement = judge_contest(&contest);
    let scores = scores(&contest, |_| true);
    let sheets = table::sheets(&contest);
    let mut csv = Vec::new();
    table::csv(records, &mut csv)?;
    let files = [
        ("runs.csv", csv),
        ("runs.json", json(&records)?),
        ("scores.json", json(&Outcome { judgement: &judgement, scores: &scores })?),
        ("table.md", markdown(&sheets).into_bytes()),
        ("table.tex", latex(&sheets).into_bytes()),
    ];
    let mut written = Vec::new();
    for (name, contents) in files {
        let path = dir.join(name);
        std::fs::write(&path, contents)?;
        written.push(path);
    }
    Ok(written)
}

fn json(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
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
        .map(|sheet| format!("% {}\n{}", sheet.caption.replace(['\n', '\r'], " "), table::latex(sheet)))
        .collect();
    format!("% \\usepackage{{booktabs}}\n{}", tables.join("\n"))
}
