//! `hyperplan emit --family --select`: solvers are measured on the benchmarks, and some are chosen by that.

use crate::args;
use crate::commands::compare::{self, Measure};
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, reason};
use crate::guard;
use crate::output::Output;
use crate::proof::{DESCRIPTION, REFUTATION};
use crate::store::write_whole;
use hyperplan_compare::contest::{Cell, Contest};
use hyperplan_compare::{Answer, Record, RunStatus};
use hyperplan_family::select::{
    Candidate, Chosen, Criteria, Outcome, Timed, UNKNOWN, most, remarked, select,
};
use hyperplan_family::{Manifest, Selected, sha256};
use hyperplan_outlet::one_line;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The folder of the runs, within that of the family.
const MEASURED: &str = "measured";
/// The folder of what was chosen.
const SELECTED: &str = "selected";

/// Refuses what makes no selection, before anything is done for it.
pub(super) fn check(args: &args::Emit) -> Result<()> {
    let wanted = &args.family;
    if args.track != args::Track::Single {
        return Err(Failure::input("--select measures single queries: leave out --track"));
    }
    for (option, seconds) in
        [("--measure-limit", wanted.measure_limit.unwrap_or(1.0)), ("--easy", wanted.easy)]
    {
        if !(seconds.is_finite() && seconds > 0.0) {
            return Err(Failure::input(format_args!("{option} {seconds} is not a time to work in")));
        }
    }
    match wanted.measured.iter().find(|log| !log.is_file()) {
        Some(log) => Err(Failure::input(format_args!("--measured: there is no log {}", log.display()))),
        None => Ok(()),
    }
}

/// Measures what was not measured yet, chooses, and writes what was chosen.
pub(super) fn run(
    args: &args::Emit,
    (folder, manifest): (&Path, &Manifest),
    count: usize,
    verbose: bool,
    out: &mut Output,
) -> Result {
    let wanted = &args.family;
    let all = manifest.benchmarks.len();
    if count > all {
        let what =
            format_args!("--select {count}: there are {all} benchmarks to choose from; make more of them");
        return Err(Failure::input(what));
    }
    let mut limit = wanted.measure_limit;
    let records = match wanted.measured.as_slice() {
        [] => {
            let seconds = *limit.get_or_insert(60.0);
            match compare::measure(measure(wanted, (folder, manifest), seconds), verbose, out)? {
                Some(records) => records,
                None => return Ok(Exit::Undecided),
            }
        }
        logs => compare::look(logs, out)?,
    };
    let records = of_family(manifest, records, limit);
    let limit_s = match limit {
        Some(limit) => limit,
        None => the_limit(&records)?,
    };
    let (candidates, solvers) = candidates(manifest, &records);
    let criteria = Criteria { count, easy_s: wanted.easy, limit_s };
    let unmeasured = candidates.iter().filter(|candidate| candidate.runs.is_empty()).count();
    if unmeasured > 0 {
        out.remark(format_args!(
            "note: {unmeasured} of {all} benchmarks were not measured, and are not chosen"
        ));
    }
    let possible = most(&candidates, &criteria);
    let selection = select(candidates, &criteria);
    if possible < count {
        let mut failure = Failure::input(match possible {
            0 => format!(
                "--select {count}: none of the {all} benchmarks can be chosen; make larger ones, or see --easy"
            ),
            _ => format!(
                "--select {count}: only {possible} of the {all} benchmarks can be chosen; take --select {possible}, or make more"
            ),
        });
        let reasons = selection.left_out.iter().map(|(why, number)| format!("{number} not, since {why}"));
        failure.details = reasons.collect::<Vec<_>>().join("\n");
        return Err(failure);
    }
    let left_out = selection.left_out.clone();
    let selected =
        Selected { head: manifest.head.clone(), criteria, solvers, left_out, benchmarks: selection.chosen };
    let selected = write(folder, selected)?;
    say(&selected, &folder.join(SELECTED), out)?;
    Ok(Exit::Good)
}

/// What is measured of a family.
fn measure(wanted: &args::Family, (folder, manifest): (&Path, &Manifest), seconds: f64) -> Measure {
    guard::doing("measuring benchmarks");
    let files = manifest.benchmarks.iter().map(|entry| folder.join(&entry.file).display().to_string());
    Measure {
        files: files.collect(),
        solver: wanted.measure_by.clone(),
        seconds,
        jobs: wanted.jobs.and_then(|jobs| u16::try_from(jobs.get()).ok()).unwrap_or(1),
        folder: folder.join(MEASURED),
    }
}

/// The runs on benchmarks of the family as they are, with that limit if there is one, by whatever path they were named.
fn of_family(manifest: &Manifest, records: Vec<Record>, limit: Option<f64>) -> Vec<Record> {
    let files: BTreeMap<&str, &str> =
        manifest.benchmarks.iter().map(|entry| (entry.sha256.as_str(), entry.file.as_str())).collect();
    let of_file = |record: Record| {
        let file = (*files.get(record.sha256.as_str())?).to_owned();
        let meant = limit.is_none() || record.limit.wall_s == limit;
        meant.then(|| Record { instance: file, family: String::new(), ..record })
    };
    records.into_iter().filter_map(of_file).collect()
}

/// The limit that all runs had.
fn the_limit(records: &[Record]) -> Result<f64> {
    let limits: BTreeSet<String> =
        records.iter().filter_map(|record| record.limit.wall_s).map(|limit| limit.to_string()).collect();
    match (limits.first(), records.first().and_then(|record| record.limit.wall_s)) {
        (Some(_), Some(limit)) if limits.len() == 1 => Ok(limit),
        (None, _) | (_, None) => Err(Failure::input(
            "--measured: no run in these logs is about a benchmark of the family as it is, with a limit of time",
        )),
        _ => {
            let limits: Vec<String> = limits.into_iter().collect();
            Err(Failure::input(format_args!(
                "--measured: the runs have limits of {} s; say by --measure-limit which ones count",
                limits.join(", ")
            )))
        }
    }
}

/// The benchmarks with their runs, and the solvers with their versions.
fn candidates(manifest: &Manifest, records: &[Record]) -> (Vec<Candidate>, BTreeMap<String, String>) {
    let contest = Contest::new(records);
    let rows: BTreeMap<&str, usize> =
        contest.instances.iter().enumerate().map(|(at, row)| (row.name, at)).collect();
    let runs = |file: &str| -> BTreeMap<String, Timed> {
        let Some(&row) = rows.get(file) else { return BTreeMap::new() };
        let cells = contest.contestants.iter().zip(&contest.cells[row]);
        cells.filter_map(|(who, cell)| Some((who.label.clone(), timed(cell.as_ref()?)))).collect()
    };
    let candidates = manifest
        .benchmarks
        .iter()
        .map(|entry| Candidate { runs: runs(&entry.file), entry: entry.clone() })
        .collect();
    let version = |version: Option<&str>| one_line(version.unwrap_or(UNKNOWN)).into_owned();
    let solvers = contest.contestants.iter().map(|who| (who.label.clone(), version(who.version))).collect();
    (candidates, solvers)
}

fn timed(cell: &Cell<'_>) -> Timed {
    let says = cell.says().map(|answer| if answer == Answer::Sat { "sat" } else { "unsat" });
    let outcome = match cell.median.status {
        _ if cell.wrong => Outcome::Wrong,
        RunStatus::Sat | RunStatus::Unsat => Outcome::Solved,
        RunStatus::Unknown | RunStatus::Timeout | RunStatus::Memout => Outcome::Unsolved,
        RunStatus::Error => Outcome::Error,
        RunStatus::Unsupported => Outcome::Unsupported,
    };
    Timed {
        outcome,
        answer: says.map(str::to_owned),
        seconds: (cell.median.wall_s * 1000.0).round() / 1000.0,
    }
}

/// Writes what was chosen into a folder beside, which then takes the place of an earlier one: it is there whole, or as it
/// was.
fn write(folder: &Path, mut selected: Selected) -> Result<Selected> {
    let (new, old) = (folder.join("selected.new"), folder.join("selected.old"));
    let target = folder.join(SELECTED);
    for left in [&new, &old] {
        remove(left)?;
    }
    for chosen in &mut selected.benchmarks {
        benchmark(folder, &new, chosen, &selected.solvers)?;
    }
    let cannot = |e| Failure::input(format_args!("{e}"));
    let json = selected.json().map_err(|e| cannot(e.to_string()))?;
    let csv = selected.csv().map_err(|e| cannot(e.to_string()))?;
    write_whole(&new, "manifest.json", json.as_bytes())?;
    write_whole(&new, "manifest.csv", &csv)?;
    if target.exists() {
        fs::rename(&target, &old).map_err(|e| cannot_write(&target, &e))?;
    }
    fs::rename(&new, &target).map_err(|e| cannot_write(&target, &e))?;
    remove(&old)?;
    Ok(selected)
}

fn remove(folder: &Path) -> Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(cannot_write(folder, &error)),
        _ => Ok(()),
    }
}

/// Copies a benchmark and its problem. What solvers did wrong on it is added to its header, which makes it another file.
fn benchmark(from: &Path, to: &Path, chosen: &mut Chosen, solvers: &BTreeMap<String, String>) -> Result<()> {
    let entry = &mut chosen.entry;
    let text = bytes(&from.join(&entry.file))?;
    if sha256(&text) != entry.sha256 {
        return Err(Failure::input(format_args!(
            "{} is not as it was written; without --measured it is written again",
            from.join(&entry.file).display()
        )));
    }
    let remarks: Vec<String> =
        chosen.runs.iter().filter_map(|(solver, run)| run.remark(solver, solvers)).collect();
    if !remarks.is_empty() {
        let text = remarked(&text, &remarks);
        (entry.sha256, entry.bytes) = (sha256(&text), text.len() as u64);
        // A certificate names the file that it is about.
        entry.certified = false;
        write_whole(to, &entry.file, &text)?;
    } else {
        write_whole(to, &entry.file, &text)?;
    }
    let endings = [DESCRIPTION, REFUTATION].map(|ending| PathBuf::from(&entry.file).with_extension(ending));
    let certificate = endings.iter().filter(|_| entry.certified).map(|path| path.display().to_string());
    for file in certificate.chain([entry.problem.clone()]) {
        write_whole(to, &file, &bytes(&from.join(&file))?)?;
    }
    Ok(())
}

fn bytes(path: &Path) -> Result<Vec<u8>> {
    fs::read(path).map_err(|e| Failure::input(format_args!("cannot read {}: {}", path.display(), reason(&e))))
}

/// Prints how many there are of each logic, status and bin.
fn say(selected: &Selected, folder: &Path, out: &mut Output) -> Result<()> {
    out.line(selected.table().trim_end())?;
    let wrong = selected.benchmarks.iter().flat_map(|one| one.runs.values());
    let wrong = wrong.filter(|run| run.outcome == Outcome::Wrong).count();
    if wrong > 0 {
        out.remark(format_args!("warning: {wrong} answers contradict the status, as the headers say"));
    }
    let folder = folder.display();
    out.line(format_args!("{folder}: {} benchmarks chosen; see manifest.json", selected.benchmarks.len()))
}
