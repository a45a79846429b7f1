//! `hyperplan compare`: solvers and encodings over problems.

mod benchexec;
mod certified;
mod cluster;
mod comparison;
mod doing;
mod gather;
mod merge;
mod shard;

use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::reason;
use crate::output::Output;
use comparison::Comparison;
use doing::{Doing, keys};
use hyperplan_compare::foreign::beside;
use hyperplan_compare::merge::{Settled, settled};
use hyperplan_compare::plan::Run;
use hyperplan_compare::report::write_all;
use hyperplan_compare::{Fault, Log, Past, Record, judge, summary, tidy, together};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

pub(super) const LOG: &str = "runs.jsonl";

/// Benchmarks to be measured.
pub(super) struct Measure {
    pub(super) files: Vec<String>,
    /// The solvers; without, all that are installed.
    pub(super) solver: Option<String>,
    /// The limit of each run.
    pub(super) seconds: f64,
    pub(super) jobs: u16,
    /// Where the log is, which says what was done before, and the reports.
    pub(super) folder: PathBuf,
}

/// Measures solvers on benchmarks, as the command does that says the same, and gives these runs, without others that the
/// log may have; none if it was interrupted. Wrong answers are found, and are no failure.
pub(super) fn measure(what: Measure, verbose: bool, out: &mut Output) -> Result<Option<Vec<Record>>> {
    let Measure { files, solver, seconds, jobs, folder } = what;
    let args = args::Compare::new(files, solver, seconds);
    let args = args::Compare { jobs, out: folder, ..args };
    let Some(comparison) = Comparison::new(&args, out)? else { return Ok(Some(Vec::new())) };
    let Some(records) = done(&args, &comparison.runs(out)?, verbose, out)? else { return Ok(None) };
    report(&args, &records, out)?;
    Ok(Some(records))
}

/// The runs of some logs, each once.
pub(super) fn look(logs: &[PathBuf], out: &Output) -> Result<Vec<Record>> {
    let mut records = Vec::new();
    for log in logs {
        let past = Log::look(log).map_err(Failure::input)?;
        past.notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
        records.extend(past.records);
    }
    Ok(settle(records, out))
}

pub(crate) fn run(args: &args::Compare, verbose: bool, out: &mut Output) -> Result {
    let cluster = &args.cluster;
    if !cluster.merge.is_empty() {
        return merge::run(args, out);
    }
    let Some(comparison) = Comparison::new(args, out)? else { return again(args, out) };
    if let Some(folder) = &args.benchexec {
        return benchexec::run(folder, &comparison, out);
    }
    match (&cluster.plan, cluster.shard) {
        _ if cluster.engine.is_some() => cluster::run(args, &comparison, verbose, out),
        (_, Some(shard)) => shard::run(args, shard, &comparison, verbose, out),
        (Some(file), None) if comparison.listed.is_none() => comparison.write(file, &args.out, out),
        (_, None) => here(args, &comparison.runs(out)?, verbose, out),
    }
}

/// Does the runs on this machine, and reports.
fn here(args: &args::Compare, runs: &[Run], verbose: bool, out: &mut Output) -> Result {
    match done(args, runs, verbose, out)? {
        Some(records) => report(args, &records, out),
        None => Ok(Exit::Undecided),
    }
}

/// Does the runs that are not in the log, and gives all; none if it was interrupted.
fn done(args: &args::Compare, runs: &[Run], verbose: bool, out: &mut Output) -> Result<Option<Vec<Record>>> {
    let doing = Doing::new(args)?;
    let (mut log, past) = open(&args.out, out)?;
    let wanted: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
    let mut records: Vec<Record> = past.into_iter().filter(|run| wanted.contains(run.key.as_str())).collect();
    let done = keys(&records);
    let missing: Vec<Run> = runs.iter().filter(|run| !done.contains(&run.key)).cloned().collect();
    told_before(runs.len() - missing.len(), runs.len(), out);
    let mut progress = doing.progress(missing.len(), verbose, out);
    let all = doing.all(&missing, &mut log, &mut progress, |record| records.push(record));
    drop(progress);
    tidy(doing.folder());
    let kept = format!(
        "{} of {} runs are done, and kept in {}; the same command does the others",
        keys(&records).len(),
        runs.len(),
        args.out.join(LOG).display()
    );
    match all {
        Ok(true) => Ok(Some(in_order(records, runs, out))),
        Ok(false) => {
            out.error(format_args!("interrupted: {kept}"));
            Ok(None)
        }
        Err(failure) => Err(Failure::new(failure.status, format_args!("{}; {kept}", failure.message))),
    }
}

/// The log of a folder, and the runs in it.
fn open(folder: &Path, out: &Output) -> Result<(Log, Vec<Record>)> {
    let (log, Past { records, notes }) = Log::open(&folder.join(LOG)).map_err(Failure::input)?;
    notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
    Ok((log, records))
}

fn told_before(done: usize, all: usize, out: &Output) {
    if done > 0 {
        out.remark(format_args!("note: {done} of {all} runs were done before"));
    }
}

/// A record for each run, in their order.
fn in_order(records: Vec<Record>, runs: &[Run], out: &Output) -> Vec<Record> {
    let mut records = settle(records, out);
    let places: BTreeMap<&str, usize> =
        runs.iter().enumerate().map(|(place, run)| (run.key.as_str(), place)).collect();
    records.sort_by_key(|record| places.get(record.key.as_str()).copied());
    records
}

/// A record for each run, whatever was done several times; says so.
fn settle(records: Vec<Record>, out: &Output) -> Vec<Record> {
    let Settled { records, repeated, contradictions } = settled(records);
    if repeated > 0 {
        out.remark(format_args!("note: {repeated} runs were done more than once; of each the later counts"));
    }
    contradictions.iter().for_each(|what| out.remark(format_args!("warning: {what}")));
    records
}

/// Reports what is in the log, without any run.
fn again(args: &args::Compare, out: &mut Output) -> Result {
    let folder = args.out.as_path();
    let path = folder.join(LOG);
    if !path.is_file() {
        return Err(Failure::input(format_args!(
            "name files to run; there is no {} to report",
            path.display()
        )));
    }
    let (_log, records) = open(folder, out)?;
    report(args, &last(records, out), out)
}

/// The last of each where it was done again after a change.
fn last(records: Vec<Record>, out: &Output) -> Vec<Record> {
    let mut last: BTreeMap<_, (u64, usize, String)> = BTreeMap::new();
    for (index, record) in records.iter().enumerate() {
        let this = (record.ended_ms.unwrap_or(0), index, record.key.clone());
        let kept = last.entry(place(record)).or_insert_with(|| this.clone());
        *kept = this.max(std::mem::take(kept));
    }
    // Without a key each is a run of its own.
    let meant = |(index, record): &(usize, Record)| {
        last.get(&place(record))
            .is_some_and(|(_, at, key)| if key.is_empty() { at == index } else { *key == record.key })
    };
    settle(records.into_iter().enumerate().filter(meant).map(|(_, record)| record).collect(), out)
}

/// What a record is about, whatever version of it.
fn place(record: &Record) -> impl Ord + use<> {
    let Record { instance, states, quantifiers, set, solver, options, seed, repetition, .. } = record.clone();
    ((instance, set, solver), (states, quantifiers, options), (seed, repetition))
}

/// Prints what is wrong and the scores, and writes all reports.
fn report(args: &args::Compare, records: &[Record], out: &mut Output) -> Result {
    let folder = args.out.as_path();
    let believed = args.certified.then(|| certified::certified(records, out));
    let records = &together(beside(believed.unwrap_or_else(|| records.to_vec())));
    let processors: BTreeSet<&str> = records.iter().filter_map(|run| run.processor.as_deref()).collect();
    if processors.len() > 1 {
        let all: Vec<&str> = processors.into_iter().collect();
        let all = all.join("; ");
        out.remark(format_args!("note: times of different processors do not compare; these are {all}"));
    }
    let summary = summary(records, out.width());
    out.line(summary.trim_end())?;
    write_all(records, folder).map_err(|error| {
        let reason = reason(&error);
        Failure::input(format_args!("cannot write the reports in {}: {reason}", folder.display()))
    })?;
    out.remark(format_args!("note: the whole report is {}", folder.join("report.html").display()));
    Ok(match judge(records).fault() {
        None => Exit::Good,
        Some(Fault::Solver | Fault::Status) => Exit::Solver,
        Some(Fault::Ours) => Exit::Bug,
    })
}

/// Does the job on standard input, for [`run`].
pub(crate) fn supervise() -> Result {
    hyperplan_compare::supervise().map_err(Failure::input)?;
    Ok(Exit::Good)
}
