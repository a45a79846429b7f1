//! What is to be run: what was asked for, on the command line or in a plan, and the runs that come of it.

use super::LOG;
use crate::args::{self, Asked};
use crate::config;
use crate::configuration::Configured;
use crate::failure::{Exit, Failure, Result};
use crate::files::{read_source, reason, write_bytes};
use crate::instances::instances;
use crate::output::Output;
use crate::tables::imported;
use hyperplan_compare::list::{self, Listed};
use hyperplan_compare::plan::{Candidate, Instance, Kind, Run, Ways, count, plan, sha256};
use hyperplan_compare::share::expected;
use hyperplan_compare::{Limit, Log};
use hyperplan_solver::{Error, Options, open};
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// More runs than this are hardly meant.
const MOST_RUNS: u64 = 1_000_000;

/// What is to be run.
pub(super) struct Comparison {
    asked: Asked,
    /// Where a plan says it: the runs that come of it.
    pub(super) listed: Option<Vec<Listed>>,
    pub(super) solvers: Vec<Arc<Candidate>>,
    pub(super) ways: Ways,
    build: OnceCell<String>,
}

impl Comparison {
    /// What the arguments mean, or the plan that they name; `None` where they name nothing.
    pub(super) fn new(args: &args::Compare, out: &Output) -> Result<Option<Comparison>> {
        let (asked, listed) = match &args.cluster.plan {
            Some(file) if args.asked.files.is_empty() => {
                let (asked, listed) = read(file, &args.asked)?;
                (asked, Some(listed))
            }
            _ if args.asked.files.is_empty()
                && (args.cluster.shard.is_some() || args.benchexec.is_some()) =>
            {
                return Err(Failure::input("name files to run, or a plan: --plan FILE"));
            }
            _ if args.asked.files.is_empty() => return Ok(None),
            _ => (Asked { files: imported(args, out)?, ..args.asked.clone() }, None),
        };
        let ways = ways(&asked)?;
        let solvers = candidates(asked.solver.as_deref(), out)?;
        Ok(Some(Comparison { asked, listed, solvers, ways, build: OnceCell::new() }))
    }

    pub(super) fn instances(&self, out: &Output) -> Result<Vec<Arc<Instance>>> {
        instances(&self.asked, out)
    }

    /// All runs.
    pub(super) fn runs(&self, out: &Output) -> Result<Vec<Run>> {
        match &self.listed {
            Some(listed) => self.of_plan(&listed.iter().collect::<Vec<_>>(), out),
            None => self.of(&self.asked, out),
        }
    }

    /// Some runs of the plan, which have to come of the files and solvers of this machine.
    pub(super) fn of_plan(&self, listed: &[&Listed], out: &Output) -> Result<Vec<Run>> {
        let objectives = listed.iter().filter_map(|run| run.objective.clone());
        let asked = Asked {
            files: unique(listed.iter().map(|run| run.file.clone())),
            // Of queries nobody asks.
            objective: Some(unique(objectives)).filter(|some| !some.is_empty()).unwrap_or(vec!["all".into()]),
            // Those that could not be used are not in the plan.
            skip_bad: false,
            ..self.asked.clone()
        };
        if listed.is_empty() {
            return Ok(Vec::new());
        }
        let runs = self.of(&asked, out)?;
        let here: BTreeMap<&str, &Run> = runs.iter().map(|run| (run.key.as_str(), run)).collect();
        let found = listed.iter().map(|wanted| match here.get(wanted.key.as_str()) {
            Some(run) => Ok(Run::clone(run)),
            None => Err(Failure::input(wanted.why_not(&runs))),
        });
        found.collect()
    }

    fn of(&self, asked: &Asked, out: &Output) -> Result<Vec<Run>> {
        let instances = instances(asked, out)?;
        let mut ways = self.ways.clone();
        let number = count(&instances, &self.solvers, &ways);
        if number > MOST_RUNS {
            return Err(Failure::input(format_args!(
                "these would be {number} runs, of at most {MOST_RUNS}; take fewer of --repeat, --seed, files or encodings"
            )));
        }
        if instances.iter().any(|instance| matches!(instance.kind, Kind::Problem { .. })) {
            ways.build = match self.build.get() {
                Some(build) => build.clone(),
                None => {
                    let program = std::env::current_exe().map_err(Failure::input)?;
                    self.build.get_or_init(|| build(&program).unwrap_or_default()).clone()
                }
            };
        }
        let runs = plan(&instances, &self.solvers, &ways);
        if runs.is_empty() {
            return Err(Failure::input(
                "there is nothing to run: the builtin solver reads no SMT-LIB files, SAT and QBF solvers neither, \
                 and there is no other",
            ));
        }
        left_out(asked, &instances, &self.solvers, out);
        Ok(runs)
    }

    /// Writes the plan. What runs took before, by the log of the folder, says how long they will take.
    pub(super) fn write(&self, file: &Path, folder: &Path, out: &Output) -> Result {
        let runs = self.runs(out)?;
        let log = folder.join(LOG);
        let past = if log.is_file() { Log::look(&log).map_err(Failure::input)?.records } else { Vec::new() };
        let text = self.text(&runs, &expected(&runs, &past))?;
        write_bytes(file, text.as_bytes())?;
        out.remark(format_args!(
            "note: {} runs in {}; to do a part of them: hyperplan compare --plan {} --shard 1/8",
            runs.len(),
            file.display(),
            file.display()
        ));
        Ok(Exit::Good)
    }

    /// The text of a plan of some runs.
    pub(super) fn text(&self, runs: &[Run], seconds: &[f64]) -> Result<String> {
        let listed: Vec<Listed> =
            runs.iter().zip(seconds).map(|(run, &seconds)| Listed::new(run, seconds)).collect();
        list::write(&self.asked, &listed).map_err(Failure::input)
    }
}

/// A plan, where the arguments say nothing else.
pub(super) fn read(file: &Path, asked: &Asked) -> Result<(Asked, Vec<Listed>)> {
    if !asked.is_default() {
        return Err(Failure::input(format_args!(
            "{} says what is run, and how; leave out what says it again",
            file.display()
        )));
    }
    list::read(file, &read_source(file)?).map_err(Failure::input)
}

/// Says what of the request comes to nothing.
fn left_out(asked: &Asked, instances: &[Arc<Instance>], solvers: &[Arc<Candidate>], out: &Output) {
    let is_query = |instance: &Arc<Instance>| matches!(instance.kind, Kind::Query(_));
    let no_readers = solvers.iter().filter(|solver| asked.solver.is_some() && solver.standalone.is_none());
    let no_readers: Vec<&str> = no_readers.map(|solver| solver.name.as_str()).collect();
    if !no_readers.is_empty() && instances.iter().any(is_query) {
        let names = no_readers.join(", ");
        out.remark(format_args!("note: no SMT-LIB files are read by {names}: left out there"));
    }
    if !asked.set.is_empty() && instances.iter().all(is_query) {
        out.remark("note: --set is for problem files, of which there are none");
    }
}

/// What was typed, checked.
fn ways(asked: &Asked) -> Result<Ways> {
    for (option, seconds) in [("--timeout", Some(asked.timeout)), ("--cpu", asked.cpu)] {
        if let Some(seconds) = seconds.filter(|seconds| !(seconds.is_finite() && *seconds > 0.0)) {
            return Err(Failure::input(format_args!("{option} {seconds} is not a time to work in")));
        }
    }
    if asked.memory == Some(0) {
        return Err(Failure::input("--memory 0 leaves no memory to the solver"));
    }
    Ok(Ways {
        quantifiers: unique(asked.quantifiers.iter().map(ToString::to_string)),
        states: unique(asked.states.iter().map(|&states| config::states_name(states))),
        seeds: unique(asked.seed.iter().copied()),
        repetitions: asked.repeat,
        limit: Limit { wall_s: Some(asked.timeout), cpu_s: asked.cpu, memory_mib: asked.memory },
        cases: asked.cubes,
        options: asked.no_verify.then(|| "--no-verify".to_owned()).into_iter().collect(),
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
        let stamp = program.and_then(|program| build(program).ok()).unwrap_or_default();
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
