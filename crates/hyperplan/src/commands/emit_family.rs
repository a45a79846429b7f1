//! `hyperplan emit --family`: benchmarks on random maps, with horizons about the least that is enough.

mod case;
mod select;

use super::emit;
use crate::args;
use crate::config;
use crate::failure::{Exit, Failure, Result};
use crate::output::Output;
use crate::store::Store;
use case::One;
use clap::ValueEnum as _;
use hyperplan_family::{Case, Family, Head, Layout, Manifest, Record};
use hyperplan_plan::{EmitConfig, Paths, Pruning, Quantifiers, States};
use hyperplan_solver::Deadline;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::time::Duration;

pub(crate) fn run(args: &args::Emit, verbose: bool, out: &mut Output) -> Result {
    let Some(folder) = &args.family.folder else {
        return Err(Failure::input("expected a problem file, or --family DIR"));
    };
    if args.family.select.is_some() {
        select::check(args)?;
    }
    let (manifest, status) = match args.family.measured.as_slice() {
        [] => make(args, folder, out)?,
        _ => (Store::look(folder)?, Exit::Good),
    };
    match args.family.select {
        Some(count) if status == Exit::Good => {
            let count = usize::try_from(count).unwrap_or(usize::MAX);
            select::run(args, (folder, &manifest), count, verbose, out)
        }
        _ => Ok(status),
    }
}

/// Makes the benchmarks that are not there yet.
fn make(args: &args::Emit, folder: &Path, out: &mut Output) -> Result<(Manifest, Exit)> {
    let work = Work::new(args, folder, out)?;
    let head = Head {
        generator: format!("hyperplan {}", env!("CARGO_PKG_VERSION")),
        date: work.date.clone(),
        family: args.family.name.clone(),
        submitter: args.family.submitter.clone(),
        track: args.track.to_possible_value().map_or_else(String::new, |track| track.get_name().to_owned()),
    };
    let mut store = Store::open(folder, head)?;
    let result = work.run(&mut store, args.family.jobs.map(Into::into), out);
    // Also of what there is after a failure.
    let manifest = store.finish()?;
    result?;
    let count = |status: &str| manifest.benchmarks.iter().filter(|entry| entry.status == status).count();
    let certified = match manifest.benchmarks.iter().filter(|entry| entry.certified).count() {
        0 if !args.certify => String::new(),
        number => format!(" of which {number} certified"),
    };
    out.line(format_args!(
        "{}: {} benchmarks ({} sat, {} unsat{certified}, {} unknown), {} dropped; see manifest.json",
        folder.display(),
        manifest.benchmarks.len(),
        count("sat"),
        count("unsat"),
        count("unknown"),
        manifest.dropped.len()
    ))?;
    if work.deadline.passed() {
        out.remark("note: not all was done; run it again to go on");
        return Ok((manifest, Exit::Undecided));
    }
    Ok((manifest, Exit::Good))
}

/// What is to be done.
struct Work<'a> {
    folder: &'a Path,
    family: Family,
    layout: Layout,
    date: String,
    states: Vec<Option<States>>,
    quantifiers: Vec<Quantifiers>,
    paths: Vec<Paths>,
    pruning: Vec<Pruning>,
    /// How benchmarks are emitted, but for that.
    common: EmitConfig,
    certify: bool,
    limit: Duration,
    deadline: Deadline,
}

impl<'a> Work<'a> {
    fn new(args: &args::Emit, folder: &'a Path, out: &Output) -> Result<Self> {
        let wanted = &args.family;
        let family = Family {
            kinds: once(&wanted.maps),
            sizes: once(&wanted.sizes),
            densities: once(&wanted.densities),
            seeds: once(&wanted.seeds.0),
            objectives: once(&wanted.objectives),
            horizons: once(&wanted.horizons),
        };
        family.check().map_err(Failure::input)?;
        let date = config::date(args.date.clone().or_else(|| Store::date(folder)).as_deref())?;
        let layout = Layout::new(&date, &wanted.name, &wanted.submitter).map_err(Failure::input)?;
        let limit = Duration::try_from_secs_f64(wanted.limit).ok().filter(|limit| !limit.is_zero());
        let limit = limit.ok_or_else(|| {
            Failure::input(format_args!("--limit {} is not a time to work in", wanted.limit))
        })?;
        // Without a choice there are benchmarks of several logics.
        let states = match args.states.as_slice() {
            [None] => vec![Some(States::Onehot), Some(States::Bitvec)],
            chosen => once(chosen),
        };
        let quantifiers = match args.quantifiers.as_slice() {
            [Quantifiers::Auto] if args.track == args::Track::Incremental => vec![Quantifiers::Cegis],
            [Quantifiers::Auto] => vec![Quantifiers::Expand, Quantifiers::Keep],
            chosen => once(chosen),
        };
        if args.track != args::Track::Incremental && quantifiers.contains(&Quantifiers::Cegis) {
            let what = "--quantifiers cegis makes incremental benchmarks: add --track incremental";
            return Err(Failure::input(what));
        }
        let common = emit::common(args, &date, out)?;
        // What cannot matter is left in: a solver has to find that out, which makes the harder benchmarks.
        let pruning = once(&config::pruning(args, Pruning::Light));
        let paths = once(&args.paths.iter().copied().map(config::paths).collect::<Vec<_>>());
        let deadline = common.deadline.clone();
        let certify = args.certify;
        Ok(Work {
            folder,
            family,
            layout,
            date,
            states,
            quantifiers,
            paths,
            pruning,
            common,
            certify,
            limit,
            deadline,
        })
    }

    /// Works through all cases, several at a time; what comes of them is noted here, in the order in which it comes.
    fn run(&self, store: &mut Store, jobs: Option<usize>, out: &Output) -> Result<()> {
        let cases: Vec<Case> = self.family.cases().collect();
        let done = store.done(self.certify);
        let least: Vec<Option<Option<u32>>> =
            cases.iter().map(|case| store.past.least(&case.to_string())).collect();
        let jobs = jobs.or_else(|| std::thread::available_parallelism().ok().map(Into::into)).unwrap_or(1);
        let jobs = jobs.min(cases.len()).max(1);
        let next = AtomicUsize::new(0);
        let (notes, from) = sync_channel::<Note>(jobs);
        let bar = bar(cases.len(), out);
        let part = self.deadline.part();
        std::thread::scope(|scope| {
            for _ in 0..jobs {
                let (notes, next, cases, least, done, part) =
                    (notes.clone(), &next, &cases, &least, &done, &part);
                let worker = move || {
                    while !part.passed() {
                        let at = next.fetch_add(1, Ordering::Relaxed);
                        let Some(&case) = cases.get(at) else { break };
                        let one = One { work: self, case, deadline: part, notes: &notes, done };
                        let ended = one.run(least[at]);
                        let _ = notes.send(Note::Ended(ended));
                    }
                };
                std::thread::Builder::new()
                    .spawn_scoped(scope, worker)
                    .map_err(|e| Failure::input(format_args!("cannot start a thread: {e}")))?;
            }
            drop(notes);
            collect(&from, store, &bar, &part)
        })
    }
}

/// What a worker says.
enum Note {
    Record(Box<Record>),
    Ended(Result<()>),
}

/// Notes what workers say until all have ended. After the first failure they are told to stop.
fn collect(from: &Receiver<Note>, store: &mut Store, bar: &ProgressBar, part: &Deadline) -> Result<()> {
    let mut result = Ok(());
    for note in from {
        let ended = match note {
            Note::Record(record) => store.note(&record),
            Note::Ended(ended) => {
                bar.inc(1);
                ended
            }
        };
        if let Err(failure) = ended {
            part.cancel();
            result = result.and(Err(failure));
        }
    }
    bar.finish_and_clear();
    result
}

fn bar(cases: usize, out: &Output) -> ProgressBar {
    // Nothing is drawn where standard error is no terminal.
    let target = if out.is_quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(cases as u64), target);
    bar.with_style(
        ProgressStyle::with_template("{elapsed_precise} {wide_bar} {pos}/{len} objectives on maps")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    )
}

/// The first occurrence of each.
fn once<T: Clone + PartialEq>(things: &[T]) -> Vec<T> {
    let mut found: Vec<T> = Vec::new();
    for thing in things {
        if !found.contains(thing) {
            found.push(thing.clone());
        }
    }
    found
}
