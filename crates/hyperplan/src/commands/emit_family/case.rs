//! One objective on one map: its least horizon, and its benchmarks.

use super::emit::LARGEST;
use super::{Note, Work};
use crate::config;
use crate::explain::Explain;
use crate::failure::{Exit, Failure, Result};
use crate::files;
use crate::proof::Made;
use crate::store::write_whole;
use hyperplan_family::{
    About, Case, Dropped, Entry, Horizon, Layout, Map, Objective, Record, body_of, sha256,
};
use hyperplan_plan::{
    self as plan, Config, EmitConfig, Fault, Limits, MinimizeError, Paths, Pruning, Quantifiers, States,
    Status, Track, Verdict, emit, minimize, solve,
};
use hyperplan_problem::{NoFiles, Overrides, Problem, read};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::SourceMap;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::sync::mpsc::SyncSender;

/// One case, and where to say what comes of it.
pub(super) struct One<'a> {
    pub(super) work: &'a Work<'a>,
    pub(super) case: Case,
    pub(super) deadline: &'a Deadline,
    pub(super) notes: &'a SyncSender<Note>,
    pub(super) done: &'a BTreeSet<String>,
}

/// How a benchmark is written.
#[derive(Clone, Copy)]
struct Encoding {
    states: Option<States>,
    quantifiers: Quantifiers,
    paths: Paths,
    pruning: Pruning,
}

impl One<'_> {
    pub(super) fn run(&self, least: Option<Option<u32>>) -> Result<()> {
        let name = self.case.to_string();
        let map = match Map::random(self.case.map) {
            Ok(map) => map,
            Err(_) if self.done.contains(&name) => return Ok(()),
            Err(reason) => return self.dropped(&name, &reason.to_string()),
        };
        let objective = self.case.objective;
        let least = match least {
            Some(least) => least,
            None => match self.least(&map)? {
                Found::Least(least) => {
                    self.note(Record::Least { case: name, least });
                    least
                }
                Found::Undecided(reason) => return self.dropped(&name, &reason),
                Found::Interrupted => return Ok(()),
            },
        };
        for (horizon, steps) in self.work.family.horizons(&map, objective, least) {
            if !self.horizon(&map, horizon, steps)? {
                break;
            }
        }
        Ok(())
    }

    fn note(&self, record: Record) {
        // The receiver is there until all workers have ended.
        let _ = self.notes.send(Note::Record(Box::new(record)));
    }

    fn dropped(&self, instance: &str, reason: &str) -> Result<()> {
        if !self.deadline.passed() {
            let (instance, reason) = (instance.to_owned(), reason.to_owned());
            self.note(Record::Dropped(Dropped { instance, reason }));
        }
        Ok(())
    }

    fn config(&self) -> Config {
        Config { deadline: self.deadline.within(self.work.limit), ..Config::new(Spec::Builtin) }
    }

    /// Searches for the least horizon.
    fn least(&self, map: &Map) -> Result<Found> {
        let objective = self.case.objective;
        let (fewest, most) = (objective.least_steps(map), objective.most_steps(map));
        let mut problem = |steps: i64| problem(objective, map, u32::try_from(steps).unwrap_or(0));
        let found = minimize(objective.name(), fewest.into()..=most.into(), &mut problem, &self.config());
        let least = match found {
            Ok(least) => least,
            Err(MinimizeError::Problem(failure)) => return Err(failure),
            Err(MinimizeError::Solve { error, .. }) => return self.undecided(&error).map(Found::Undecided),
        };
        Ok(match (least.outcome.verdict, least.undecided) {
            _ if self.deadline.passed() => Found::Interrupted,
            (Verdict::Realizable, None) => Found::Least(u32::try_from(least.value).ok()),
            (Verdict::Unrealizable, _) => Found::Least(None),
            (_, reason) => {
                let reason = reason.or(least.outcome.reason);
                let reason = reason.map_or_else(String::new, |reason| Explain::default().reason(&reason));
                let limit = self.work.limit.as_secs_f64();
                Found::Undecided(format!("the least horizon was not found within {limit} s: {reason}"))
            }
        })
    }

    /// What an error means for one instance; a bug of ours, or a solver's, ends everything.
    fn undecided(&self, error: &plan::Error) -> Result<String> {
        match error.fault() {
            Fault::Request | Fault::Time => Ok(Explain::default().error(error)),
            Fault::Solver | Fault::Ours => Err(Explain::default().failure(self.case, error)),
        }
    }

    /// Writes the problem and the benchmarks of a horizon; `false` where the time is up.
    fn horizon(&self, map: &Map, horizon: Horizon, steps: u32) -> Result<bool> {
        let objective = self.case.objective;
        let name = format!("{}-T{steps}", self.case);
        let wanted: Vec<(String, Encoding)> =
            self.encodings().map(|encoding| (encoding.instance(&name), encoding)).collect();
        if wanted.iter().all(|(instance, _)| self.done.contains(instance)) {
            return Ok(true);
        }
        let text = objective.problem(map, steps);
        let problem = parsed(&text)?;
        let Some(status) = self.status(&problem, horizon)? else { return Ok(false) };
        if !self.fits(status) {
            return Ok(true);
        }
        let file = Layout::problem(&name);
        write_whole(self.work.folder, &file, text.as_bytes())?;
        let mut certificate = match status {
            Status::Unsat if self.work.certify => self.certificate(&problem)?,
            _ => None,
        };
        for (instance, encoding) in wanted {
            if self.deadline.passed() {
                return Ok(false);
            }
            if self.done.contains(&instance) {
                continue;
            }
            let (states, quantifiers) =
                (config::states_name(encoding.states), encoding.quantifiers.to_string());
            let pruning = config::pruning_name(encoding.pruning).to_owned();
            let paths = encoding.paths.to_string();
            let about =
                About { instance, case: self.case, horizon, steps, states, quantifiers, paths, pruning };
            self.benchmark(&problem, &file, (encoding, status, certificate.as_mut()), about)?;
        }
        Ok(true)
    }

    fn encodings(&self) -> impl Iterator<Item = Encoding> {
        let Work { states, quantifiers, paths, pruning, .. } = self.work;
        // Without a second block there is nothing to keep or to expand.
        let quantifiers = if self.case.objective.is_single() { &quantifiers[..1] } else { &quantifiers[..] };
        let written = states.iter().flat_map(move |&states| {
            quantifiers
                .iter()
                .flat_map(move |&quantifiers| paths.iter().map(move |&paths| (states, quantifiers, paths)))
        });
        // Paths are functions where states are written by variable, which is one of several ways here.
        let fits = |&(states, _, paths): &(Option<States>, _, _)| {
            paths == Paths::Symbols || !states.is_some_and(States::is_enumerated)
        };
        written.filter(fits).flat_map(move |(states, quantifiers, paths)| {
            pruning.iter().map(move |&pruning| Encoding { states, quantifiers, paths, pruning })
        })
    }

    /// The status of an instance: what the search for the least horizon proved, or what the solver says; `None` where
    /// the time is up.
    fn status(&self, problem: &Problem, horizon: Horizon) -> Result<Option<Status>> {
        match horizon {
            Horizon::Below | Horizon::Never => return Ok(Some(Status::Unsat)),
            Horizon::Least => return Ok(Some(Status::Sat)),
            Horizon::Above | Horizon::Double => {}
        }
        let Some(objective) = problem.objective(self.case.objective.name()) else { return Ok(None) };
        let verdict = match solve(problem, objective, &self.config()) {
            Ok(outcome) => outcome.verdict,
            Err(error) => self.undecided(&error).map(|_| Verdict::Unknown)?,
        };
        Ok(match verdict {
            _ if self.deadline.passed() => None,
            Verdict::Realizable => Some(Status::Sat),
            Verdict::Unrealizable => Some(Status::Unsat),
            Verdict::Unknown => Some(Status::Unknown),
        })
    }

    /// The certificate of a problem without a strategy; none where it takes too long, or would be too large.
    fn certificate(&self, problem: &Problem) -> Result<Option<Made>> {
        let Some(objective) = problem.objective(self.case.objective.name()) else { return Ok(None) };
        let made = Made::new((problem, objective), Vec::new(), &self.deadline.within(self.work.limit));
        match made {
            Ok(made) => Ok(Some(made)),
            Err((status @ (Exit::Bug | Exit::Solver), why)) => {
                Err(Failure::new(status, format_args!("{}: {why}", self.case)))
            }
            Err(_) => Ok(None),
        }
    }

    /// Whether the track has benchmarks of that status: an unsatisfiable one has no model, a satisfiable one no core.
    fn fits(&self, status: Status) -> bool {
        match self.work.common.track {
            Track::Single | Track::Incremental => true,
            Track::Model => status == Status::Sat,
            Track::UnsatCore => status == Status::Unsat,
        }
    }

    /// The folder of the track. The SMT-LIB library has the first two; the others hold what a competition would derive
    /// from the library's files.
    fn folder(&self) -> &'static str {
        match self.work.common.track {
            Track::Single => "non-incremental",
            Track::Incremental => "incremental",
            Track::Model => "model-validation",
            Track::UnsatCore => "unsat-core",
        }
    }

    fn benchmark(
        &self,
        problem: &Problem,
        file: &str,
        (encoding, status, certificate): (Encoding, Status, Option<&mut Made>),
        about: About,
    ) -> Result<()> {
        let Some(objective) = problem.objective(self.case.objective.name()) else { return Ok(()) };
        let place = self.case.objective.place(self.case.map);
        let remarks = vec![format!("Problem: {file}; T = {}", about.steps), place];
        let config = EmitConfig {
            quantifiers: encoding.quantifiers,
            states: encoding.states,
            paths: encoding.paths,
            limits: Limits { pruning: encoding.pruning, ..self.work.common.limits },
            status: Some(status),
            remarks,
            deadline: self.deadline.within(self.work.limit),
            ..self.work.common.clone()
        };
        let mut emitted = match emit(problem, objective, &config) {
            Ok(emitted) => emitted,
            Err(error) => return self.dropped(&about.instance, &self.undecided(&error)?),
        };
        if self.deadline.passed() {
            return Ok(());
        }
        let mut text = Bounded::default();
        if emitted.write(&mut text).is_err() {
            return self.dropped(&about.instance, &format!("has more than {} MB", LARGEST / 1_000_000));
        }
        let (text, logic) = (text.0, emitted.logic);
        let path = self.work.layout.benchmark(self.folder(), &logic, &self.case, &about.instance);
        write_whole(self.work.folder, &path, &text)?;
        let certified = certificate.is_some();
        if let Some(made) = certificate {
            let path = self.work.folder.join(&path);
            made.of_benchmark(&text, files::relative(&path, &self.work.folder.join(file))?);
            made.write(&path.with_extension(""))?;
        }
        let entry = Entry {
            file: path,
            sha256: sha256(&text),
            body: sha256(body_of(&text)),
            bytes: text.len() as u64,
            logic,
            status: status.text().to_owned(),
            certified,
            problem: file.to_owned(),
            about,
        };
        self.note(Record::Written(Box::new(entry)));
        Ok(())
    }
}

/// What came of the search for the least horizon.
enum Found {
    /// The least, or none up to the last that was tried.
    Least(Option<u32>),
    Undecided(String),
    Interrupted,
}

impl Encoding {
    fn instance(self, name: &str) -> String {
        let mut name = format!("{name}-{}-{}", config::states_name(self.states), self.quantifiers);
        if self.paths != Paths::Symbols {
            name += &format!("-{}", self.paths);
        }
        match self.pruning {
            // What families have unless something else is asked for.
            Pruning::Light => name,
            other => format!("{name}-{}", config::pruning_name(other)),
        }
    }
}

/// The problem of an objective on a map.
fn problem(objective: Objective, map: &Map, steps: u32) -> Result<Problem> {
    parsed(&objective.problem(map, steps))
}

fn parsed(text: &str) -> Result<Problem> {
    let mut sources = SourceMap::new();
    let lowered = read(&mut sources, "problem.hp", text, &NoFiles, &Overrides::default());
    if lowered.has_errors() {
        let message = "this is a bug in hyperplan: a problem that it made has errors";
        return Err(Failure { details: text.to_owned(), ..Failure::new(Exit::Bug, message) });
    }
    Ok(lowered.problem)
}

/// A text that is not too long.
#[derive(Default)]
struct Bounded(Vec<u8>);

impl Write for Bounded {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if (self.0.len() + bytes.len()) as u64 > LARGEST {
            return Err(io::Error::other("too long"));
        }
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
