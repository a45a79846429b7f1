//! `hyperplan emit`: benchmarks in SMT-LIB 2.

use crate::args;
use crate::config;
use crate::configuration::Configured;
use crate::explain::Explain;
use crate::failure::{Exit, Failure, Result};
use crate::files::{self, cannot_write, check_writable};
use crate::load::{self, Consts, Loaded};
use crate::output::Output;
use crate::proof::Made;
use hyperplan_outlet::one_line;
use hyperplan_plan::{EmitConfig, Emitted, Limits, Paths, Pruning, Quantifiers, States, Status, emit};
use hyperplan_problem::{Objective, Problem, Type, display};
use hyperplan_solver::{Deadline, Format};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The most values that `--each` takes.
const MOST_VALUES: i64 = 100_000;

pub(crate) fn run(args: &args::Emit, file: &Path, out: &mut Output) -> Result {
    let common = common(args, &config::date(args.date.as_deref())?, out)?;
    let whole = args::Problem { file: file.to_owned(), set: Vec::new(), foreign: args.foreign.clone() };
    let text = load::text(&whole)?;
    if args.certify && (args.foreign.is_some() || file == Path::new("-")) {
        return Err(Failure::input("--certify takes a problem file (.hp), which certificates name"));
    }
    let (mut target, mut worst) = (None, Exit::Good);
    for setting in settings(args)? {
        let mut set = args.set.clone();
        set.extend(setting.clone());
        let problem = args::Problem { set, ..whole.clone() };
        let (loaded, consts) = Loaded::with_consts(&problem, &text, Instant::now(), out)?;
        let objectives = loaded.selected(args.selection.objective.as_deref(), false)?;
        let several = objectives.len() > 1 || setting.is_some() || encodings(args).count() > 1;
        let target = match &target {
            Some(target) => target,
            None => target.insert(Target::new(args.output.as_deref(), several, ending(&common))?),
        };
        if args.certify && matches!(target, Target::Standard) {
            return Err(Failure::input(
                "--certify writes files beside the benchmark: give it one by -o FILE",
            ));
        }
        let common = EmitConfig { remarks: remarks(&loaded, &consts), ..common.clone() };
        for objective in objectives {
            for (quantifiers, states, paths, pruning) in encodings(args) {
                let limits = Limits { pruning, ..common.limits };
                let config = EmitConfig { quantifiers, states, paths, limits, ..common.clone() };
                let mut emitted = match emit(&loaded.problem, objective, &config) {
                    Ok(emitted) => emitted,
                    Err(error) => {
                        // The other files may do better.
                        let failure = Explain::default().failure(&objective.name, &error);
                        out.failure(&failure);
                        worst = worst.max(failure.status);
                        continue;
                    }
                };
                let whose = if several { format!("{}: ", objective.name) } else { String::new() };
                for note in &emitted.notes {
                    out.remark(format_args!("note: {whose}{}", Explain::default().note(note)));
                }
                let name = Name { objective: &objective.name, setting: setting.as_ref(), args };
                target.write(&name.of(&config), &mut emitted, out)?;
                if let Some(path) = target.path(&name.of(&config)).filter(|_| args.certify)
                    && emitted.status == Status::Unsat
                {
                    let set = problem.set.iter().map(|(name, value)| format!("{name}={value}")).collect();
                    let about = (&loaded.problem, objective, set);
                    worst = worst.max(certify(args, about, (&path, file), &config.deadline, out)?);
                }
            }
        }
    }
    Ok(worst)
}

/// Writes the certificate of a benchmark that is unsatisfiable; where there is none, this is said.
fn certify(
    args: &args::Emit,
    (problem, objective, set): (&Problem, &Objective, Vec<String>),
    (path, file): (&Path, &Path),
    deadline: &Deadline,
    out: &mut Output,
) -> Result<Exit> {
    let mut made = match Made::new((problem, objective), set, deadline) {
        Ok(made) => made,
        Err((Exit::Bug, why)) if args.status == args::Status::Unsat => {
            return Err(Failure::input(format_args!("{}: --status unsat: {why}", objective.name)));
        }
        Err((status @ (Exit::Bug | Exit::Solver), why)) => {
            return Err(Failure::new(status, format_args!("{}: {why}", objective.name)));
        }
        Err((status, why)) => {
            out.remark(format_args!("note: {}: not certified: {why}", path.display()));
            return Ok(status);
        }
    };
    let cannot = |e| Failure::input(format_args!("cannot read {}: {}", path.display(), files::reason(&e)));
    made.of_benchmark(&files::read_bytes(path).map_err(cannot)?, files::relative(path, file)?);
    made.write(&path.with_extension(""))?;
    Ok(Exit::Good)
}

/// What all benchmarks of a command have in common.
pub(super) fn common(args: &args::Emit, date: &str, out: &Output) -> Result<EmitConfig> {
    let configured = Configured::new(out);
    let solver = |text: &String| config::solver(text, &configured);
    let solver = args.solver.as_ref().map(solver).transpose()?;
    // A family is laid out as SMT-LIB has it.
    let reads = || solver.as_ref().filter(|_| args.family.folder.is_none())?.profile()?.format();
    let config = EmitConfig {
        format: args.format.map_or_else(reads, config::format),
        track: config::track(args.track),
        status: config::status(args.status),
        comments: !args.no_comments,
        deadline: config::deadline(args.timeout, None)?,
        solver,
        ..EmitConfig::new(date)
    };
    match config.demand_format() {
        Ok(()) => {}
        Err(error) if args.family.folder.is_some() => {
            return Err(Failure::input(format_args!(
                "a family is in SMT-LIB 2, but {error}: leave out --solver"
            )));
        }
        Err(error) => return Err(Explain::default().failure("--solver", &error.into())),
    }
    Ok(match &args.author {
        Some(author) => EmitConfig { author: config::author(author)?, ..config },
        None => config,
    })
}

/// The ways of writing that were asked for.
fn encodings(args: &args::Emit) -> impl Iterator<Item = (Quantifiers, Option<States>, Paths, Pruning)> {
    let states = move |quantifiers| args.states.iter().map(move |&states| (quantifiers, states));
    let written = args.quantifiers.iter().copied().flat_map(states);
    let written = written.flat_map(|(quantifiers, states)| {
        args.paths.iter().map(move |&paths| (quantifiers, states, config::paths(paths)))
    });
    written.flat_map(|(quantifiers, states, paths)| {
        let pruned = config::pruning(args, Pruning::Full).into_iter();
        pruned.map(move |pruning| (quantifiers, states, paths, pruning))
    })
}

/// What the header says of the problem file.
fn remarks(loaded: &Loaded, consts: &Consts) -> Vec<String> {
    let values: Vec<String> = consts
        .iter()
        .map(|(name, value)| format!("{name} = {}", display::value(&Type::Int, *value)))
        .collect();
    // Without folders, which are this machine's.
    let file = Path::new(&loaded.file).file_name().unwrap_or_default().to_string_lossy();
    let mut remarks = vec![format!("Problem: {}", one_line(&file))];
    if !values.is_empty() {
        remarks.push(format!("Constants: {}.", values.join(", ")));
    }
    remarks
}

/// A constant's name and value, as typed.
type Setting = (String, String);

/// The values of `--each`, or the file as it is.
fn settings(args: &args::Emit) -> Result<Vec<Option<Setting>>> {
    let Some((constant, lo, hi)) = &args.each else { return Ok(vec![None]) };
    if hi - lo >= MOST_VALUES {
        return Err(Failure::input(format_args!(
            "--each {constant}={lo}..{hi} is more than {MOST_VALUES} files"
        )));
    }
    Ok((*lo..=*hi).map(|value| Some((constant.clone(), value.to_string()))).collect())
}

/// What a file is called among several: the objective, and what differs from file to file.
struct Name<'a> {
    objective: &'a str,
    setting: Option<&'a Setting>,
    args: &'a args::Emit,
}

impl Name<'_> {
    fn of(&self, config: &EmitConfig) -> String {
        let mut name = self.objective.to_owned();
        if let Some((constant, value)) = self.setting {
            // Without `=`: z3 takes such names for settings.
            name += &format!("-{constant}-{value}");
        }
        if self.args.states.len() > 1 {
            name += &format!("-{}", config::states_name(config.states));
        }
        if self.args.quantifiers.len() > 1 {
            name += &format!("-{}", config.quantifiers);
        }
        if self.args.paths.len() > 1 {
            name += &format!("-{}", config.paths);
        }
        if self.args.pruning.len() > 1 {
            name += &format!("-{}", config::pruning_name(config.limits.pruning));
        }
        name + "." + ending(config)
    }
}

/// How files end.
fn ending(config: &EmitConfig) -> &'static str {
    config.format.map_or("smt2", Format::name)
}

/// Where the benchmarks go.
enum Target {
    Standard,
    File(PathBuf),
    Folder(PathBuf),
}

impl Target {
    fn new(output: Option<&Path>, several: bool, ending: &str) -> Result<Self> {
        let Some(path) = output else {
            if several {
                return Err(Failure::input("several files need a directory: -o DIR"));
            }
            return Ok(Target::Standard);
        };
        if !several && path == Path::new("-") {
            return Ok(Target::Standard);
        }
        if several && path.extension().is_some_and(|extension| extension == ending) && !path.is_dir() {
            let path = path.display();
            return Err(Failure::input(format_args!(
                "several files need a directory, and {path} looks like a file"
            )));
        }
        let ends_like_folder = path.as_os_str().to_string_lossy().ends_with(std::path::MAIN_SEPARATOR);
        if several || path.is_dir() || ends_like_folder {
            std::fs::create_dir_all(path).map_err(|e| cannot_write(path, &e))?;
            return Ok(Target::Folder(path.to_owned()));
        }
        check_writable(path)?;
        Ok(Target::File(path.to_owned()))
    }

    /// The file of a benchmark.
    fn path(&self, name: &str) -> Option<PathBuf> {
        match self {
            Target::Standard => None,
            Target::File(path) => Some(path.clone()),
            Target::Folder(folder) => Some(folder.join(name)),
        }
    }

    fn write(&self, name: &str, emitted: &mut Emitted, out: &mut Output) -> Result<()> {
        match self.path(name) {
            None => out.write(|w| emitted.write(w)),
            Some(path) => write_to(&path, emitted, out),
        }
    }
}

/// The most bytes of a file that SMT-LIB takes.
pub(super) const LARGEST: u64 = 50_000_000;

fn write_to(path: &Path, emitted: &mut Emitted, out: &Output) -> Result<()> {
    let bytes = files::write(path, |to| emitted.write(to))?;
    if bytes > LARGEST && emitted.format.is_none() {
        let megabytes = bytes / 1_000_000;
        out.remark(format_args!("note: {} has {megabytes} MB; SMT-LIB takes at most 50", path.display()));
    }
    Ok(())
}
