//! What was typed becomes what is meant: the one place where arguments are checked.

use crate::args::{self, ColorWhen};
use crate::configuration::Configured;
use crate::failure::{Failure, Result};
use crate::files::{check_writable, make_folder};
use crate::guard;
use crate::output::Output;
use crate::pictures::Picture;
use crate::signals;
use chrono::{DateTime, NaiveDate, Utc};
use hyperplan_plan::{Config, Paths, Pruning, States, Status, Track};
use hyperplan_solver::{Deadline, Format, Spec};
use std::path::PathBuf;
use std::time::Duration;

/// A checked `solve` command.
pub(crate) struct Solve {
    pub(crate) plan: Config,
    pub(crate) plot: Option<Picture>,
    pub(crate) save: Option<PathBuf>,
}

impl Solve {
    pub(crate) fn new(args: &args::Solve, out: &Output) -> Result<Self> {
        let plot = args.plot.as_deref().map(Picture::new).transpose()?;
        for path in args.plot.iter().chain(&args.save) {
            check_writable(path)?;
        }
        args.queries.iter().chain(&args.proof).try_for_each(|folder| make_folder(folder))?;
        if args.memory == Some(0) {
            return Err(Failure::input("--memory 0 leaves no memory to the solver"));
        }
        let configured = Configured::new(out);
        let (solver, rivals) = solvers(&args.solver, &configured)?;
        let second = |text: &String| self::solver(text, &configured);
        let plan = Config {
            rivals,
            cross_check: args.cross_check.as_ref().map(second).transpose()?,
            quantifiers: args.encoding.quantifiers,
            states: args.encoding.states,
            deadline: deadline(args.encoding.timeout, args.memory)?,
            verify: !args.no_verify,
            seed: args.seed,
            memory_mib: args.memory,
            queries: args.queries.clone(),
            ..Config::new(solver)
        };
        Ok(Solve { plan, plot, save: args.save.clone() })
    }
}

/// A solver by name or command line.
pub(crate) fn solver(text: &str, configured: &Configured<'_>) -> Result<Spec> {
    match solvers(text, configured)? {
        (solver, rivals) if rivals.is_empty() => Ok(solver),
        _ => Err(Failure::input(format_args!("one solver is wanted here, not a list ({text})"))),
    }
}

/// One solver, and those that race it.
fn solvers(text: &str, configured: &Configured<'_>) -> Result<(Spec, Vec<Spec>)> {
    // What is built in reads no configuration.
    let specs = match Spec::embedded(text.trim()) {
        Some(embedded) => embedded.map(|spec| vec![spec]),
        None => configured.catalog()?.specs(text),
    };
    let specs = specs.map_err(|e| Failure::input(format_args!("{e}")))?;
    let mut specs = specs.into_iter();
    let first = specs.next().ok_or_else(|| Failure::input("the solver's name is empty"))?;
    Ok((first, specs.collect()))
}

/// What was asked for, as it is typed.
pub(crate) fn states_name(states: Option<States>) -> String {
    states.map_or("auto", States::name).to_owned()
}

/// How much is left out of benchmarks.
pub(crate) fn pruning(args: &args::Emit, usual: Pruning) -> Vec<Pruning> {
    let named = args.pruning.iter().map(|pruning| match pruning {
        args::Pruning::None => Pruning::None,
        args::Pruning::Light => Pruning::Light,
        args::Pruning::Full => Pruning::Full,
    });
    match args.pruning.is_empty() {
        true if args.no_pruning => vec![Pruning::Light],
        true => vec![usual],
        false => named.collect(),
    }
}

/// The name of that.
pub(crate) fn pruning_name(pruning: Pruning) -> &'static str {
    match pruning {
        Pruning::None => "none",
        Pruning::Light => "light",
        Pruning::Full => "full",
    }
}

pub(crate) fn paths(typed: args::Paths) -> Paths {
    match typed {
        args::Paths::Symbols => Paths::Symbols,
        args::Paths::Functions => Paths::Functions,
        args::Paths::Policies => Paths::Policies,
    }
}

pub(crate) fn track(typed: args::Track) -> Track {
    match typed {
        args::Track::Single => Track::Single,
        args::Track::Incremental => Track::Incremental,
        args::Track::Model => Track::Model,
        args::Track::UnsatCore => Track::UnsatCore,
    }
}

/// What a benchmark is written in: nothing stands for SMT-LIB 2.
pub(crate) fn format(typed: args::EmitFormat) -> Option<Format> {
    match typed {
        args::EmitFormat::Smt2 => None,
        args::EmitFormat::Qcir => Some(Format::Qcir),
        args::EmitFormat::Qdimacs => Some(Format::Qdimacs),
        args::EmitFormat::Dimacs => Some(Format::Dimacs),
    }
}

/// The expected answer, where it was given.
pub(crate) fn status(typed: args::Status) -> Option<Status> {
    match typed {
        args::Status::Auto => None,
        args::Status::Sat => Some(Status::Sat),
        args::Status::Unsat => Some(Status::Unsat),
        args::Status::Unknown => Some(Status::Unknown),
    }
}

/// A date as headers have it: the one that was given, that of `SOURCE_DATE_EPOCH`, or today's.
pub(crate) fn date(given: Option<&str>) -> Result<String> {
    let format = "%Y-%m-%d";
    let date = match (given, std::env::var("SOURCE_DATE_EPOCH")) {
        (Some(text), _) => NaiveDate::parse_from_str(text, format)
            .map_err(|_| Failure::input(format_args!("--date {text} is no date; write it as 2026-01-31")))?,
        (None, Ok(seconds)) => {
            let date = seconds.trim().parse().ok().and_then(|seconds| DateTime::from_timestamp(seconds, 0));
            let wrong =
                || Failure::input(format_args!("SOURCE_DATE_EPOCH={seconds} is no number of seconds"));
            date.ok_or_else(wrong)?.date_naive()
        }
        (None, Err(_)) => Utc::now().date_naive(),
    };
    Ok(date.format(format).to_string())
}

/// A name that fits on a line of a header.
pub(crate) fn author(name: &str) -> Result<String> {
    if name.trim().is_empty() || name.contains(|c: char| c.is_control() || "|\\".contains(c)) {
        return Err(Failure::input("--author takes a name on one line, without | and \\"));
    }
    Ok(name.trim().to_owned())
}

/// The end of the whole command, by time, by signal, or by how much this process grows.
pub(crate) fn deadline(timeout: Option<f64>, memory_mib: Option<u64>) -> Result<Deadline> {
    let deadline = match timeout {
        None => Deadline::never(),
        // Too long to count is as good as no end.
        Some(seconds) if seconds > 0.0 => {
            Deadline::after(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
        }
        Some(seconds) => {
            return Err(Failure::input(format_args!("--timeout {seconds} is not a time to work in")));
        }
    };
    signals::watch(&deadline.cancel_flag());
    guard::begin(&deadline, memory_mib);
    Ok(deadline)
}

/// Whether to use colors, where that was said.
pub(crate) fn color(when: ColorWhen) -> Option<bool> {
    match when {
        ColorWhen::Auto => None,
        ColorWhen::Always => Some(true),
        ColorWhen::Never => Some(false),
    }
}
