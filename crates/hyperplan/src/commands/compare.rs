//! `hyperplan compare`: solvers and encodings over problems.

use crate::args;
use crate::config;
use crate::configuration::Configured;
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, reason};
use crate::instances::instances;
use crate::output::Output;
use crate::progress::Progress;
use crate::signals;
use crate::tables;
use hyperplan_compare::benchexec::{Configuration, Problem};
use hyperplan_compare::plan::{Candidate, Instance, Kind, Run, Ways, count, plan, sha256};
use hyperplan_compare::report::write_all;
use hyperplan_compare::{
    Event, Fault, Limit, Log, LogError, Past, Record, Setting, judge, prepare, run_all, summary,
};
use hyperplan_solver::{Error, Options, open};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

const LOG: &str = "runs.jsonl";
/// More runs than this are hardly meant.
const MOST_RUNS: u64 = 1_000_000;

pub(crate) fn run(args: &args::Compare, verbose: bool, out: &mut Output) -> Result {
    if args.files.is_empty() {
        return again(&args.out, out);
    }
    let mut ways = ways(args)?;
    let solvers = candidates(args.solver.as_deref(), out)?;
    let files = tables::imported(args, out)?;
    let instances = instances(&files, args, out)?;
    if let Some(folder) = &args.benchexec {
        return benchexec(folder, &instances, &solvers, &ways, out);
    }
    let number = count(&instances, &solvers, &ways);
    if number > MOST_RUNS {
        return Err(Failure::input(format_args!(
            "these would be {number} runs, of at most {MOST_RUNS}; take fewer of --repeat, --seed, files or encodings"
        )));
    }
    let hyperplan = std::env::current_exe().map_err(Failure::input)?;
    if instances.iter().any(|instance| matches!(instance.kind, Kind::Problem { .. })) {
        ways.build = build(&hyperplan)?;
    }
    let runs = plan(&instances, &solvers, &ways);
    if runs.is_empty() {
        return Err(Failure::input(
            "there is nothing to run: the builtin solver reads no SMT-LIB files, and there is no other",
        ));
    }
    left_out(args, &instances, &solvers, out);
    let cannot = |error: io::Error| cannot_write(&args.out, &error);
    let folder = prepare(&args.out).map_err(cannot)?;
    let (mut log, past) = Log::open(&args.out.join(LOG)).map_err(Failure::input)?;
    past.notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
    let setting = Setting {
        jobs: args.jobs.into(),
        hyperplan,
        supervisor: vec!["supervise".to_owned()],
        folder,
        queries: args.queries,
        host: rustix::system::uname().nodename().to_string_lossy().into_owned(),
    };
    let mut done = by_key(past.records, &runs);
    let missing: Vec<Run> = runs.iter().filter(|run| !done.contains_key(&run.key)).cloned().collect();
    if !done.is_empty() {
        out.remark(format_args!(
            "note: {} of {} runs were done before",
            runs.len() - missing.len(),
            runs.len()
        ));
    }
    let all = do_all(&missing, &setting, &mut log, &mut done, Progress::new(missing.len(), verbose, out));
    let kept = format!(
        "{} of {} runs are done, and kept in {}; the same command does the others",
        done.len(),
        runs.len(),
        args.out.join(LOG).display()
    );
    match all {
        Ok(true) => {}
        Ok(false) => {
            out.error(format_args!("interrupted: {kept}"));
            return Ok(Exit::Undecided);
        }
        Err(failure) => {
            return Err(Failure::new(failure.status, format_args!("{}; {kept}", failure.message)));
        }
    }
    let records: Vec<Record> = runs.iter().filter_map(|run| done.remove(&run.key)).collect();
    report(&records, &args.out, out)
}

/// Says what of the request comes to nothing.
fn left_out(args: &args::Compare, instances: &[Arc<Instance>], solvers: &[Arc<Candidate>], out: &Output) {
    let is_query = |instance: &Arc<Instance>| matches!(instance.kind, Kind::Query(_));
    let embedded = args.solver.is_some() && solvers.iter().any(|solver| solver.standalone.is_none());
    if embedded && instances.iter().any(is_query) {
        out.remark("note: the builtin solver reads no SMT-LIB files, and is left out there");
    }
    if !args.set.is_empty() && instances.iter().all(is_query) {
        out.remark("note: --set is for problem files, of which there are none");
    }
}

/// Does what is missing; whether all of it was done.
fn do_all(
    missing: &[Run],
    setting: &Setting,
    log: &mut Log,
    done: &mut BTreeMap<String, Record>,
    mut progress: Progress<'_>,
) -> Result<bool> {
    let cancelled = Arc::new(AtomicBool::new(false));
    signals::watch(&cancelled);
    let labels: BTreeMap<&str, String> = missing.iter().map(|run| (run.key.as_str(), run.label())).collect();
    let tell = |event: Event<'_>| -> Result<(), Stop> {
        match event {
            Event::Started(run) => progress.started(&run.label()),
            Event::Finished(record) => {
                log.append(&record)?;
                progress.finished(labels.get(record.key.as_str()).map_or("", String::as_str), &record);
                done.insert(record.key.clone(), *record);
            }
        }
        Ok(())
    };
    run_all(missing, setting, &cancelled, tell).map_err(Failure::input)
}

/// Why runs cannot go on.
#[derive(Debug, thiserror::Error)]
enum Stop {
    #[error("cannot go on: {0}")]
    Io(#[from] io::Error),
    #[error(transparent)]
    Log(#[from] LogError),
}

/// Those of the records that are about one of the runs, the last about each.
fn by_key(records: Vec<Record>, runs: &[Run]) -> BTreeMap<String, Record> {
    let wanted: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
    let records = records.into_iter().filter(|record| wanted.contains(record.key.as_str()));
    records.map(|record| (record.key.clone(), record)).collect()
}

/// Reports what is in the log, without any run: the last of each where it was done again after a change.
fn again(folder: &Path, out: &mut Output) -> Result {
    let path = folder.join(LOG);
    if !path.is_file() {
        return Err(Failure::input(format_args!(
            "name files to run; there is no {} to report",
            path.display()
        )));
    }
    let (_log, Past { records, notes }) = Log::open(&path).map_err(Failure::input)?;
    notes.iter().for_each(|note| out.remark(format_args!("note: {note}")));
    let mut last = BTreeMap::new();
    for (index, record) in records.iter().enumerate() {
        last.insert(place(record), index);
    }
    let mut indices: Vec<usize> = last.into_values().collect();
    indices.sort_unstable();
    let records: Vec<Record> = indices.into_iter().map(|index| records[index].clone()).collect();
    report(&records, folder, out)
}

/// What a record is about, whatever version of it.
fn place(record: &Record) -> impl Ord + use<> {
    let Record { instance, states, quantifiers, set, solver, options, seed, repetition, .. } = record.clone();
    ((instance, set, solver), (states, quantifiers, options), (seed, repetition))
}

/// Prints what is wrong and the scores, and writes all reports.
fn report(records: &[Record], folder: &Path, out: &mut Output) -> Result {
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

/// Writes the same comparison for BenchExec, and runs nothing.
fn benchexec(
    folder: &Path,
    instances: &[Arc<Instance>],
    solvers: &[Arc<Candidate>],
    ways: &Ways,
    out: &mut Output,
) -> Result {
    let problems: Vec<Problem> = instances
        .iter()
        .filter_map(|instance| match &instance.kind {
            Kind::Query(_) => None,
            Kind::Problem { objective } => Some(Problem {
                file: instance.file.clone().into(),
                objective: Some(objective.clone()),
                set: instance.set.clone(),
                expected: instance.expected,
            }),
        })
        .collect();
    let left_out = counted(instances.len() - problems.len(), "SMT-LIB file");
    if problems.is_empty() {
        return Err(Failure::input(format_args!("nothing is left for BenchExec without {left_out}")));
    }
    if problems.len() < instances.len() {
        out.remark(format_args!("note: {left_out} left out: solvers run these there without hyperplan"));
    }
    let option = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let mut configurations = Vec::new();
    for solver in solvers {
        for (quantifiers, states) in
            ways.quantifiers.iter().flat_map(|q| ways.states.iter().map(move |s| (q.as_str(), s.as_str())))
        {
            for seed in &ways.seeds {
                let name = format!("{}-{quantifiers}-{states}", solver.name);
                configurations.push(Configuration {
                    name: if ways.seeds.len() > 1 { format!("{name}-{seed}") } else { name },
                    options: vec![
                        option("--solver", &solver.name),
                        option("--quantifiers", quantifiers),
                        option("--states", states),
                        option("--seed", &seed.to_string()),
                    ],
                });
            }
        }
    }
    hyperplan_compare::benchexec::write(folder, &problems, &configurations, &ways.limit)
        .map_err(|error| cannot_write(folder, &error))?;
    let dir = folder.display();
    out.remark(format_args!(
        "note: {} and {} in {dir}; to run them: cd {dir} && PYTHONPATH=. benchexec hyperplan.xml",
        counted(problems.len(), "task"),
        counted(configurations.len(), "run definition")
    ));
    Ok(Exit::Good)
}

fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// Does the job on standard input, for [`run`].
pub(crate) fn supervise() -> Result {
    hyperplan_compare::supervise().map_err(Failure::input)?;
    Ok(Exit::Good)
}

/// What was typed, checked.
fn ways(args: &args::Compare) -> Result<Ways> {
    for (option, seconds) in [("--timeout", Some(args.timeout)), ("--cpu", args.cpu)] {
        if let Some(seconds) = seconds.filter(|seconds| !(seconds.is_finite() && *seconds > 0.0)) {
            return Err(Failure::input(format_args!("{option} {seconds} is not a time to work in")));
        }
    }
    if args.memory == Some(0) {
        return Err(Failure::input("--memory 0 leaves no memory to the solver"));
    }
    Ok(Ways {
        quantifiers: unique(args.quantifiers.iter().map(ToString::to_string)),
        states: unique(args.states.iter().map(|&states| config::states_name(states))),
        seeds: unique(args.seed.iter().copied()),
        repetitions: args.repeat,
        limit: Limit { wall_s: Some(args.timeout), cpu_s: args.cpu, memory_mib: args.memory },
        options: args.no_verify.then(|| "--no-verify".to_owned()).into_iter().collect(),
        build: String::new(),
    })
}

fn unique<T: Clone + Ord>(values: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen = BTreeSet::new();
    values.filter(|value| seen.insert(value.clone())).collect()
}

/// The solvers that are meant, each once: all of them have to be there.
fn candidates(solvers: Option<&str>, out: &Output) -> Result<Vec<Arc<Candidate>>> {
    let configured = Configured::new(out);
    let catalog = configured.catalog()?;
    let specs = match solvers {
        None => catalog.installed(),
        Some(text) => catalog.specs(text).map_err(Failure::input)?,
    };
    let mut candidates: Vec<Arc<Candidate>> = Vec::new();
    for spec in specs {
        let name = spec.name().to_owned();
        if candidates.iter().any(|candidate| candidate.name == name) {
            continue;
        }
        let standalone = catalog.standalone(&spec).map_err(|error| {
            let status = if matches!(error, Error::Missing { .. }) { Exit::Solver } else { Exit::Input };
            Failure::new(status, error)
        })?;
        let version = match &standalone {
            Some(standalone) => standalone.version.clone(),
            None => Some(open(&spec, &Options::default()).map_err(Failure::input)?.identity().version),
        };
        let program = standalone.as_ref().filter(|_| version.is_none()).map(|standalone| &standalone.program);
        let stamp = program.map_or_else(String::new, |program| stamp(program));
        candidates.push(Arc::new(Candidate { name, version, stamp, standalone }));
    }
    Ok(candidates)
}

/// A digest of the program: the version does not change with every change of the code.
fn build(program: &Path) -> Result<String> {
    let cannot =
        |error| Failure::input(format_args!("cannot read {}: {}", program.display(), reason(&error)));
    Ok(sha256(&std::fs::read(program).map_err(cannot)?))
}

/// The length of a program and when it was written.
fn stamp(program: &Path) -> String {
    let data = program.metadata();
    data.map_or_else(|_| String::new(), |data| format!("{} {:?}", data.len(), data.modified().ok()))
}
