//! Results of others as runs: of BenchExec (`*.results.*.xml`), of SMT-COMP (JSON) and of StarExec (CSV).
//!
//! What they do not say stays unknown: digests of files, machines, processors. A run of a file that was run here too is put
//! beside ours, see [`beside`].

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use sha2::{Digest as _, Sha256};

use crate::packed::{ending, unpacked};
use crate::record::{Answer, Limit, Record, RunStatus};

/// Why a file has no results.
#[derive(Debug, thiserror::Error)]
pub enum ForeignError {
    /// It is no XML.
    #[error("no XML: {0}")]
    Xml(#[from] roxmltree::Error),
    /// It is XML of something else.
    #[error(
        "line {line}: expected results of BenchExec, an element `result` with elements `run`, and not `{found}`"
    )]
    Root {
        /// The line.
        line: u32,
        /// The element.
        found: String,
    },
    /// A part of it is not what it is to be.
    #[error("line {line}: {what}")]
    Part {
        /// The line.
        line: u64,
        /// What is wrong.
        what: String,
    },
    /// It is no JSON, or of something else.
    #[error("no results of SMT-COMP: {0}")]
    Json(#[from] serde_json::Error),
    /// It is no CSV.
    #[error("no CSV: {0}")]
    Csv(#[from] csv::Error),
    /// It is not in UTF-8.
    #[error("it is not in UTF-8")]
    Encoding,
    /// It ends in `.gz`, and is damaged, or stands for too much.
    #[error("it cannot be unpacked: {0}")]
    Packed(#[from] std::io::Error),
    /// There is nothing in it.
    #[error("it has no runs")]
    Empty,
}

/// Whether a file is one of these by its name; else it is a log. Each may be compressed, and end in `.gz` too.
#[must_use]
pub fn is_foreign(path: &Path) -> bool {
    ["xml", "json", "csv"].contains(&ending(path).as_str())
}

/// The runs of such a file.
///
/// # Errors
/// If it is none, with the line.
pub fn read(path: &Path, bytes: &[u8]) -> Result<Vec<Record>, ForeignError> {
    let bytes = unpacked(path, bytes)?;
    let text = std::str::from_utf8(&bytes).map_err(|_| ForeignError::Encoding)?;
    let mut records = match ending(path).as_str() {
        "xml" => benchexec(text)?,
        "json" => smt_comp(text)?,
        _ => starexec(text)?,
    };
    if records.is_empty() {
        return Err(ForeignError::Empty);
    }
    number(&mut records);
    Ok(records)
}

/// Tells runs of one solver on one file apart, and gives each its key: the same file read again has the same runs.
fn number(records: &mut [Record]) {
    let mut seen: BTreeMap<(String, String, String), u32> = BTreeMap::new();
    for record in records {
        let place = (record.instance.clone(), record.solver.clone(), record.options.clone());
        let next = seen.entry(place).or_default();
        record.repetition = *next;
        *next += 1;
        let Record { instance, solver, version, options, repetition, status, wall_s, cpu_s, .. } = &*record;
        let what = format!(
            "{instance}\0{solver}\0{version:?}\0{options}\0{repetition}\0{status}\0{wall_s}\0{cpu_s}"
        );
        record.key = Sha256::digest(what.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    }
}

/// A run of which nothing but that is known.
fn run(instance: String, solver: String, status: RunStatus) -> Record {
    let family = instance.rsplit_once('/').map_or(".", |(folder, _)| folder).to_owned();
    let logic = instance.split('/').rev().skip(1).find(|part| crate::division::division(part).is_some());
    Record { logic: logic.map(str::to_owned), family, instance, solver, status, ..Record::default() }
}

/// What BenchExec wrote: an element `result` for each run definition, with an element `run` for each task.
fn benchexec(text: &str) -> Result<Vec<Record>, ForeignError> {
    // BenchExec names its DTD, which is not fetched.
    let document =
        Document::parse_with_options(text, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() })?;
    let root = document.root_element();
    let line = |node: Node<'_, '_>| document.text_pos_at(node.range().start).row;
    if !root.has_tag_name("result") {
        return Err(ForeignError::Root { line: line(root), found: root.tag_name().name().to_owned() });
    }
    let said = |name: &str| root.attribute(name).filter(|value| !value.is_empty());
    let seconds = |name: &str| said(name).and_then(number_of);
    let limit = Limit {
        wall_s: seconds("walltimelimit"),
        cpu_s: seconds("timelimit"),
        memory_mib: said("memlimit").and_then(mebibytes),
    };
    let host = root
        .children()
        .find(|node| node.has_tag_name("systeminfo"))
        .and_then(|node| node.attribute("hostname"));
    let mut records = Vec::new();
    for node in root.children().filter(|node| node.has_tag_name("run")) {
        let missing = |what: &str| ForeignError::Part {
            line: line(node).into(),
            what: format!("the run has no {what}"),
        };
        let name = node.attribute("name").ok_or_else(|| missing("name"))?;
        let column = |title: &str| {
            let columns = node.children().filter(|child| child.has_tag_name("column"));
            columns
                .filter(|child| child.attribute("title") == Some(title))
                .find_map(|child| child.attribute("value"))
        };
        let time = |title: &str| column(title).and_then(number_of).ok_or_else(|| missing(title));
        let status = column("status").ok_or_else(|| missing("status"))?;
        let instance = name.strip_suffix(".yml").unwrap_or(name).to_owned();
        let mut record = run(instance, contestant(root), verdict(status, column("terminationreason")));
        record.expected = match node.attribute("expectedVerdict") {
            Some("true") => Some(Answer::Sat),
            Some("false") => Some(Answer::Unsat),
            _ => None,
        };
        record.version = said("version").map(str::to_owned);
        record.options = said("options").unwrap_or_default().to_owned();
        (record.wall_s, record.cpu_s) = (time("walltime")?, time("cputime")?);
        record.memory_mib = column("memory").and_then(number_of).unwrap_or(0.0) / MEBI;
        record.message = (record.status == RunStatus::Error).then(|| status.to_owned());
        record.exit_code = column("returnvalue").and_then(|value| value.parse().ok());
        record.signal = column("exitsignal").and_then(|value| value.parse().ok());
        record.limit = limit;
        record.host = host.unwrap_or_default().to_owned();
        records.push(record);
    }
    Ok(records)
}

/// Who took part: what the run definition is called, or the tool. SMT-COMP calls a definition by solver, number and track.
fn contestant(root: Node<'_, '_>) -> String {
    let name = root.attribute("name").unwrap_or_default();
    let benchmark = root.attribute("benchmarkname").unwrap_or_default();
    let own = name.strip_prefix(benchmark).unwrap_or(name).trim_start_matches('.');
    let first = own.split(',').next().unwrap_or_default();
    match (first, root.attribute("tool")) {
        ("", Some(tool)) => tool.to_owned(),
        ("", None) => "unnamed".to_owned(),
        (name, _) => name.to_owned(),
    }
}

/// A status of BenchExec; whatever ended a run by force is said beside.
fn verdict(status: &str, reason: Option<&str>) -> RunStatus {
    match (status, reason) {
        (status, _) if status.starts_with("TIMEOUT") => RunStatus::Timeout,
        (status, _) if status.starts_with("OUT OF MEMORY") || status.starts_with("OUT OF JAVA MEMORY") => {
            RunStatus::Memout
        }
        (_, Some("walltime" | "cputime" | "cputime-soft")) => RunStatus::Timeout,
        // SMT-COMP takes a kill for one for want of memory.
        ("KILLED BY SIGNAL 9", _) | (_, Some("memory")) => RunStatus::Memout,
        ("true" | "sat", _) => RunStatus::Sat,
        ("false" | "unsat", _) => RunStatus::Unsat,
        ("unknown", _) => RunStatus::Unknown,
        _ => RunStatus::Error,
    }
}

const MEBI: f64 = 1_048_576.0;

/// A number with or without its unit, seconds or bytes.
fn number_of(text: &str) -> Option<f64> {
    let number = text.trim().trim_end_matches(['s', 'B', ' ']);
    number.parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0)
}

/// An amount of memory, `16000000000 B` or `15 GB`, in MiB.
fn mebibytes(text: &str) -> Option<u64> {
    let (number, unit) =
        text.trim().split_at(text.trim().find(|c: char| c.is_alphabetic()).unwrap_or(text.trim().len()));
    let unit = match unit.trim() {
        "B" | "" => 1.0,
        "kB" | "KB" => 1e3,
        "MB" => 1e6,
        "GB" => 1e9,
        _ => return None,
    };
    let bytes = number.trim().parse::<f64>().ok().filter(|number| *number >= 0.0)? * unit;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative, and `as` saturates"
    )]
    let mebibytes = (bytes / MEBI) as u64;
    Some(mebibytes)
}

/// What SMT-COMP publishes: `{"results": [...]}`.
#[derive(Deserialize)]
struct Published {
    results: Vec<PublishedRun>,
}

#[derive(Deserialize)]
struct PublishedRun {
    file: PublishedFile,
    solver: String,
    result: String,
    #[serde(deserialize_with = "amount")]
    cpu_time: f64,
    #[serde(deserialize_with = "amount")]
    wallclock_time: f64,
    #[serde(default, deserialize_with = "amount")]
    memory_usage: f64,
}

/// A time, or an amount of memory.
fn amount<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let number = f64::deserialize(from)?;
    let fits = number.is_finite() && number >= 0.0;
    if fits { Ok(number) } else { Err(D::Error::custom(format_args!("{number} is no time, and no memory"))) }
}

#[derive(Deserialize)]
struct PublishedFile {
    #[serde(default)]
    incremental: bool,
    logic: String,
    #[serde(default)]
    family: Vec<String>,
    name: String,
}

fn smt_comp(text: &str) -> Result<Vec<Record>, ForeignError> {
    let Published { results } = serde_json::from_str(text)?;
    let record = |published: PublishedRun| {
        let PublishedFile { incremental, logic, family, name } = published.file;
        let kind = if incremental { "incremental" } else { "non-incremental" };
        let parts: Vec<&str> =
            [kind, &logic].into_iter().chain(family.iter().map(String::as_str)).chain([&*name]).collect();
        let status = match published.result.to_ascii_lowercase().as_str() {
            "sat" => RunStatus::Sat,
            "unsat" => RunStatus::Unsat,
            "unknown" => RunStatus::Unknown,
            "timeout" => RunStatus::Timeout,
            "oom" | "outofmemory" | "memout" => RunStatus::Memout,
            // One time and one answer cannot stand for several questions.
            "incremental" | "incrementalerror" => RunStatus::Unsupported,
            _ => RunStatus::Error,
        };
        let message = (status == RunStatus::Error).then(|| published.result.clone());
        Record {
            logic: Some(logic.clone()),
            wall_s: published.wallclock_time,
            cpu_s: published.cpu_time,
            memory_mib: published.memory_usage / MEBI,
            message,
            ..run(parts.join("/"), published.solver, status)
        }
    };
    Ok(results.into_iter().map(record).collect())
}

/// A row of the table that StarExec gives of a job, and SMT-COMP gave of its own until 2023.
#[derive(Deserialize)]
struct Pair {
    benchmark: String,
    solver: String,
    #[serde(default)]
    configuration: String,
    #[serde(default)]
    status: String,
    #[serde(rename = "cpu time", deserialize_with = "amount")]
    cpu_time: f64,
    #[serde(rename = "wallclock time", deserialize_with = "amount")]
    wallclock_time: f64,
    /// In kB.
    #[serde(rename = "memory usage", default, deserialize_with = "amount")]
    memory_usage: f64,
    result: String,
    #[serde(default)]
    expected: String,
}

fn starexec(text: &str) -> Result<Vec<Record>, ForeignError> {
    let mut records = Vec::new();
    for pair in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let pair: Pair = pair?;
        let status = match (pair.result.as_str(), pair.status.as_str()) {
            (_, status) if status.starts_with("timeout") => RunStatus::Timeout,
            // So says the table of the parallel and the cloud track.
            ("timeout", _) => RunStatus::Timeout,
            (_, status) if status.starts_with("memout") => RunStatus::Memout,
            ("sat", _) => RunStatus::Sat,
            ("unsat", _) => RunStatus::Unsat,
            (result, "complete" | "") if result.ends_with("unknown") => RunStatus::Unknown,
            _ => RunStatus::Error,
        };
        let message = (status == RunStatus::Error).then(|| format!("{} {}", pair.status, pair.result));
        records.push(Record {
            options: pair.configuration,
            expected: match pair.expected.as_str() {
                "sat" => Some(Answer::Sat),
                "unsat" => Some(Answer::Unsat),
                _ => None,
            },
            wall_s: pair.wallclock_time,
            cpu_s: pair.cpu_time,
            memory_mib: pair.memory_usage / 1024.0,
            message,
            ..run(pair.benchmark, pair.solver, status)
        });
    }
    Ok(records)
}

/// Puts runs of others beside those that were made here: where the name of one file ends like that of another, from a
/// folder's name on, and of no third, they are about the same file. Those of others are without a digest.
#[must_use]
pub fn beside(mut records: Vec<Record>) -> Vec<Record> {
    let (mut foreign, ours): (Vec<&mut Record>, Vec<&mut Record>) =
        records.iter_mut().partition(|record| record.sha256.is_empty());
    let mut files: BTreeMap<&str, BTreeSet<(&str, &str, &str)>> = BTreeMap::new();
    for record in &ours {
        let name = record.instance.rsplit('/').next().unwrap_or_default();
        files.entry(name).or_default().insert((&record.instance, &record.family, &record.sha256));
    }
    for record in &mut foreign {
        let name = record.instance.rsplit('/').next().unwrap_or_default();
        let same = |file: &&(&str, &str, &str)| {
            ends_with(file.0, &record.instance) || ends_with(&record.instance, file.0)
        };
        let mut meant = files.get(name).into_iter().flatten().filter(same);
        if let (Some((instance, family, sha256)), None) = (meant.next(), meant.next()) {
            let [instance, family, sha256] = [instance, family, sha256].map(|text| (*text).to_owned());
            (record.instance, record.family, record.sha256) = (instance, family, sha256);
        }
    }
    records
}

/// Whether a path ends with another, by whole names.
fn ends_with(path: &str, end: &str) -> bool {
    path.strip_suffix(end.trim_start_matches("./")).is_some_and(|rest| rest.is_empty() || rest.ends_with('/'))
}

#[cfg(test)]
mod tests;
