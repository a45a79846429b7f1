//! An objective as an SMT-LIB 2 benchmark: one query, or the dialogue of the search by counterexamples.

mod about;
mod dialect;
mod forced;
mod model;
mod tape;

use crate::cegis::Cegis;
use crate::config::{Config, Quantifiers, Verdict};
use crate::direct;
use crate::fact::{Error, Note, Unsupported};
use crate::oracle::{Oracle, Stop, solver_for};
use crate::prepare::{decided, is_existential};
use crate::solve::solve;
use dialect::Dialect;
use hyperplan_encode::{Encoder, Goal, Limits, Narrowing, Paths, Pruning, States};
use hyperplan_problem::{Mode, Objective, PathId, Problem, Quantifier};
use hyperplan_smt::{Ask, Features, Header, Script, WriteOptions, write_header, write_script};
use hyperplan_solver::{Deadline, Format, Propositional, Spec};
use std::io;
use tape::Tape;

pub use hyperplan_smt::Status;
pub use model::strategy_of_model;

/// Which of SMT-COMP's tracks a benchmark is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Track {
    /// One query.
    #[default]
    Single,
    /// The dialogue of the search by counterexamples; with quantifiers kept, which steps of a strategy are forced.
    Incremental,
    /// One query that asks for a model.
    Model,
    /// One query with named assertions that asks for an unsatisfiable core.
    UnsatCore,
}

/// How to emit.
#[derive(Clone, Debug)]
pub struct EmitConfig {
    /// The solver that the file is for, if one.
    pub solver: Option<Spec>,
    /// What it is written in; `None` for SMT-LIB 2.
    pub format: Option<Format>,
    /// How quantifiers are written; [`Quantifiers::Cegis`] is a dialogue.
    pub quantifiers: Quantifiers,
    /// How states are written; without, hyperplan chooses.
    pub states: Option<States>,
    /// What stands for what paths do.
    pub paths: Paths,
    /// The track.
    pub track: Track,
    /// The `:status`; without, it is found out by solving.
    pub status: Option<Status>,
    /// When the benchmark was generated, as YYYY-MM-DD.
    pub date: String,
    /// By whom.
    pub author: String,
    /// Further lines about the problem, such as the constants that were set.
    pub remarks: Vec<String>,
    /// Whether comments say what follows.
    pub comments: bool,
    /// Budgets of the encoding.
    pub limits: Limits,
    /// When to give up.
    pub deadline: Deadline,
}

impl EmitConfig {
    /// One query, with all choices left to hyperplan.
    #[must_use]
    pub fn new(date: impl Into<String>) -> Self {
        EmitConfig {
            solver: None,
            format: None,
            quantifiers: Quantifiers::Auto,
            states: None,
            paths: Paths::Symbols,
            track: Track::Single,
            status: None,
            date: date.into(),
            author: format!("hyperplan {}", env!("CARGO_PKG_VERSION")),
            remarks: Vec::new(),
            comments: true,
            limits: Limits::default(),
            deadline: Deadline::never(),
        }
    }

    /// Refuses a solver that is given another format.
    ///
    /// # Errors
    /// [`Unsupported::NotRead`].
    pub fn demand_format(&self) -> Result<(), Unsupported> {
        match self.solver.as_ref().and_then(Spec::profile) {
            Some(profile) if profile.format() != self.format => Err(Unsupported::NotRead {
                solver: profile.name().to_owned(),
                reads: profile.format(),
                written: self.format,
            }),
            _ => Ok(()),
        }
    }
}

/// A benchmark, ready to be written.
pub struct Emitted {
    body: Body,
    options: WriteOptions,
    /// What it is written in; `None` for SMT-LIB 2.
    pub format: Option<Format>,
    /// The logic; empty where it is not written in SMT-LIB.
    pub logic: String,
    /// The expected answer; of a dialogue, whether there is what the objective asks for.
    pub status: Status,
    /// How quantifiers are written.
    pub quantifiers: Quantifiers,
    /// How states are written.
    pub states: States,
    /// Declared symbols, or variables of bits.
    pub symbols: usize,
    /// Assertions, clauses, or gates.
    pub assertions: usize,
    /// What the user should know.
    pub notes: Vec<Note>,
}

enum Body {
    Query(Script),
    Dialogue(Tape),
    Bits(Box<Propositional>),
}

impl Emitted {
    /// Writes the benchmark.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(&mut self, mut to: &mut dyn io::Write) -> io::Result<()> {
        match &mut self.body {
            Body::Query(script) => write_script(&mut to, script, &self.options),
            Body::Dialogue(tape) => {
                write_header(&mut to, &self.options, &self.logic)?;
                tape.copy(to)?;
                to.write_all(b"(exit)\n")
            }
            Body::Bits(bits) => {
                let Header { source, license, status, .. } = &self.options.header;
                let mut about: Vec<String> =
                    source.iter().flat_map(|text| text.lines().map(str::to_owned)).collect();
                about.extend(license.iter().map(|license| format!("License: {license}")));
                about.extend(status.map(|status| format!("Status: {}", status.text())));
                if !self.options.bare {
                    about.extend([String::new(), "What variables stand for:".to_owned()]);
                }
                bits.write(to, &about, self.options.bare)
            }
        }
    }

    /// The query; `None` where it is a dialogue, or bits.
    #[must_use]
    pub fn script(&self) -> Option<&Script> {
        match &self.body {
            Body::Query(script) => Some(script),
            Body::Dialogue(_) | Body::Bits(_) => None,
        }
    }
}

/// Builds the benchmark of an objective. A query is satisfiable if and only if the leading block has a choice of paths
/// that decides the objective: a strategy where it is `exists`, a counterexample where it is `forall`.
///
/// # Errors
/// What is not supported, and what is too large.
pub fn emit(problem: &Problem, objective: &Objective, config: &EmitConfig) -> Result<Emitted, Error> {
    config.demand_format()?;
    let stop = || config.deadline.passed();
    let dialect = Dialect::new(config.solver.as_ref());
    // A core is about everything that was said, whether it can matter or not.
    let pruning = match (config.limits.pruning, config.track) {
        (Pruning::Full, Track::UnsatCore) => Pruning::Light,
        (pruning, _) => pruning,
    };
    let limits = Limits { pruning, ..config.limits };
    let how = (config.states, config.paths);
    let emitted = settled(problem, objective, how, limits, &stop, |encoder| build(encoder, config, &dialect));
    emitted.map_err(|error| match error {
        Error::Encode(hyperplan_encode::Error::Interrupted)
        | Error::Solver(hyperplan_solver::Error::Interrupted) => Error::Late(config.deadline.reason()),
        error => error,
    })
}

/// What a use makes of the objective, decided where a quantifier ranges over nothing.
fn settled<T>(
    problem: &Problem,
    objective: &Objective,
    (wish, paths): (Option<States>, Paths),
    limits: Limits,
    stop: hyperplan_encode::Stop<'_>,
    with: impl FnOnce(&Encoder<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    let wish = wish.or_else(|| by_variable(problem, objective, paths));
    let encoder = Encoder::new(problem, objective, wish, limits, stop)?.with_paths(paths)?;
    match empty(&encoder)? {
        None => with(&encoder),
        Some(quantifier) => {
            let decided = decided(objective, quantifier);
            with(&Encoder::new(problem, &decided, wish, limits, stop)?.with_paths(paths)?)
        }
    }
}

/// How states are written where paths are functions and nothing was wished.
fn by_variable(problem: &Problem, objective: &Objective, paths: Paths) -> Option<States> {
    let finite = objective.paths.iter().all(|path| problem.systems[path.system].is_finite());
    match paths {
        Paths::Symbols => None,
        Paths::Functions | Paths::Policies if finite => Some(States::Bitvec),
        Paths::Functions | Paths::Policies => Some(States::Int),
    }
}

/// The first quantifier that ranges over nothing: it alone decides the objective.
fn empty(encoder: &Encoder<'_>) -> Result<Option<Quantifier>, Error> {
    let objective = encoder.objective;
    for path in objective.paths.keys() {
        match encoder.has_path(path) {
            Some(true) => {}
            Some(false) => return Ok(Some(objective.paths[path].quantifier)),
            None if objective.mode == Mode::Bounded && encoder.task.system(path).is_finite() => {
                return Err(Unsupported::Endless { system: encoder.task.system(path).name.clone() }.into());
            }
            None => {}
        }
    }
    Ok(None)
}

fn build(encoder: &Encoder<'_>, config: &EmitConfig, dialect: &Dialect) -> Result<Emitted, Error> {
    let mut notes = Vec::new();
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let exists = is_existential(objective);
    let mut changes = Vec::new();
    let format = config.format;
    if config.paths != Paths::Symbols {
        has_functions(config)?;
    }
    if let Some(format) = format {
        has_bits(encoder, config, format)?;
    }
    let quantifiers = quantifiers(config, blocks.len(), dialect, &mut changes)?;
    let (body, found) = body(encoder, config, &blocks, quantifiers, &mut notes)?;
    let status = match (config.status, found) {
        (Some(status), _) => status,
        (None, Some(found)) => found,
        (None, None) => expected(encoder, config, exists, &mut notes)?,
    };
    if !exists {
        notes.push(Note::Counterexample { objective: objective.name.clone() });
    }
    let ask = asked(config.track, status)?;
    let (features, mut symbols, mut assertions) = match &body {
        Body::Query(script) => {
            (Features::of(script), script.symbols().len() + script.functions().len(), script.len())
        }
        Body::Dialogue(tape) => (tape.features(), tape.symbols, tape.assertions),
        Body::Bits(_) => (Features::default(), 0, 0),
    };
    let (body, logic) = match (body, format) {
        (Body::Query(script), Some(format)) => {
            let bits = Propositional::new(&script, &[], format, &config.deadline)?;
            (symbols, assertions) = (bits.variables(), bits.size());
            (Body::Bits(Box::new(bits)), String::new())
        }
        (body, _) => (body, dialect.logic(&features, &mut changes)?),
    };
    let header = Header {
        source: Some(about::source(
            encoder,
            config,
            &about::quantifiers(quantifiers, &features, exists),
            &changes,
        )),
        license: Some("https://creativecommons.org/licenses/by/4.0/".into()),
        category: Some("crafted".into()),
        // A dialogue says it of each check.
        status: (!matches!(body, Body::Dialogue(_))).then_some(status),
    };
    let options = WriteOptions {
        header,
        logic: Some(logic.clone()),
        ask,
        bare: !config.comments,
        ..WriteOptions::default()
    };
    notes.extend(changes);
    Ok(Emitted {
        body,
        options,
        format,
        logic,
        status,
        quantifiers,
        states: encoder.states,
        symbols,
        assertions,
        notes,
    })
}

/// What is asked, and the answer where that was found out on the way.
fn body(
    encoder: &Encoder<'_>,
    config: &EmitConfig,
    blocks: &[Vec<PathId>],
    quantifiers: Quantifiers,
    notes: &mut Vec<Note>,
) -> Result<(Body, Option<Status>), Error> {
    let exists = is_existential(encoder.objective);
    Ok(match quantifiers {
        Quantifiers::Cegis => {
            let (tape, found) = dialogue(encoder, config, blocks, exists, notes)?;
            (Body::Dialogue(tape), found)
        }
        Quantifiers::Keep if config.track == Track::Incremental => {
            let (tape, found) = forced::dialogue(encoder, config, blocks, exists, notes)?;
            (Body::Dialogue(tape), found)
        }
        Quantifiers::Keep if blocks.len() > 1 => {
            (Body::Query(direct::keep(encoder, blocks, exists)?.into_script()), None)
        }
        _ => {
            (Body::Query(direct::expand(encoder, blocks, exists, Narrowing::default())?.into_script()), None)
        }
    })
}

/// Refuses what a format of bits does not have.
fn has_bits(encoder: &Encoder<'_>, config: &EmitConfig, format: Format) -> Result<(), Unsupported> {
    if config.track != Track::Single || config.quantifiers == Quantifiers::Cegis {
        return Err(Unsupported::NoTracks(format));
    }
    if encoder.states.is_arithmetic() {
        let systems = encoder.objective.paths.keys().map(|path| encoder.task.system(path));
        let system = systems.into_iter().find(|system| !system.is_finite()).map(|system| system.name.clone());
        return Err(Unsupported::NoBits { system, states: encoder.states, format });
    }
    Ok(())
}

/// Refuses functions where there is none to take them.
fn has_functions(config: &EmitConfig) -> Result<(), Unsupported> {
    if let Some(format) = config.format {
        return Err(Unsupported::NoFunctions(format));
    }
    let search = match config.quantifiers {
        Quantifiers::Cegis => true,
        Quantifiers::Auto => config.track == Track::Incremental,
        Quantifiers::Keep | Quantifiers::Expand | Quantifiers::Explicit => false,
    };
    if search { Err(Unsupported::DialogueOfFunctions) } else { Ok(()) }
}

/// How quantifiers are written, and whether that fits the track.
fn quantifiers(
    config: &EmitConfig,
    blocks: usize,
    dialect: &Dialect,
    notes: &mut Vec<Note>,
) -> Result<Quantifiers, Error> {
    match (config.track, config.quantifiers) {
        (_, Quantifiers::Auto) if config.format == Some(Format::Dimacs) => Ok(Quantifiers::Expand),
        (_, Quantifiers::Explicit) => Err(Unsupported::NothingToWrite.into()),
        (Track::Incremental, Quantifiers::Auto | Quantifiers::Cegis)
        | (Track::Single, Quantifiers::Cegis) => Ok(Quantifiers::Cegis),
        (Track::Incremental, Quantifiers::Keep) => {
            if blocks > 1 {
                dialect.demand_quantifiers(blocks)?;
            }
            Ok(Quantifiers::Keep)
        }
        (Track::Incremental, one) => Err(Unsupported::SingleQuery(one).into()),
        (Track::Model | Track::UnsatCore, Quantifiers::Cegis) => Err(Unsupported::Dialogue.into()),
        (_, Quantifiers::Expand) => Ok(Quantifiers::Expand),
        (_, Quantifiers::Keep) if blocks == 1 => Ok(Quantifiers::Keep),
        (_, Quantifiers::Keep) => dialect.demand_quantifiers(blocks).map(|()| Quantifiers::Keep),
        (_, Quantifiers::Auto) => Ok(dialect.quantifiers(blocks, notes)),
    }
}

/// What the track asks for besides the answer.
fn asked(track: Track, status: Status) -> Result<Ask, Unsupported> {
    match (track, status) {
        (Track::Single | Track::Incremental, _) => Ok(Ask::Answer),
        (Track::Model, Status::Unsat) => Err(Unsupported::NoModel),
        (Track::Model, _) => Ok(Ask::Model),
        (Track::UnsatCore, Status::Sat) => Err(Unsupported::NoCore),
        (Track::UnsatCore, _) => Ok(Ask::Core),
    }
}

/// The expected answer, found by solving: a strategy that was verified, or the proof that there is none.
fn expected(
    encoder: &Encoder<'_>,
    config: &EmitConfig,
    exists: bool,
    notes: &mut Vec<Note>,
) -> Result<Status, Error> {
    let Some(solver) = solver_for(!encoder.is_finite()) else {
        notes.push(Note::NoArithmeticSolver);
        return Ok(Status::Unknown);
    };
    let own = Config { deadline: config.deadline.clone(), ..Config::new(solver) };
    let outcome = solve(encoder.problem, encoder.objective, &own)?;
    Ok(match (outcome.verdict, exists) {
        (Verdict::Realizable, true) | (Verdict::Unrealizable, false) => Status::Sat,
        (Verdict::Realizable, false) | (Verdict::Unrealizable, true) => Status::Unsat,
        (Verdict::Unknown, _) => {
            notes.extend(outcome.reason.map(Note::StatusUnknown));
            Status::Unknown
        }
    })
}

/// Searches by counterexamples and keeps what is said.
fn dialogue(
    encoder: &Encoder<'_>,
    config: &EmitConfig,
    blocks: &[Vec<PathId>],
    exists: bool,
    notes: &mut Vec<Note>,
) -> Result<(Tape, Option<Status>), Error> {
    let solver = solver_for(encoder.states.is_arithmetic()).ok_or(Unsupported::NoArithmeticSolver)?;
    let own = Config { deadline: config.deadline.clone(), ..Config::new(solver) };
    let mut tape = Tape::new(config.comments);
    let mut oracle = Oracle::new(&own).heard_by(&mut tape);
    let goal = Goal::new(&encoder.objective.formula, exists);
    let nothing = vec![None; encoder.objective.paths.len()];
    let found = Cegis::new(encoder, &mut oracle, blocks).find(0, &nothing, &goal, 1);
    let status = match found {
        Ok(found) => Some(if found.is_empty() { Status::Unsat } else { Status::Sat }),
        Err(Stop::Error(error)) => return Err(error),
        Err(Stop::Unknown(reason)) => {
            notes.push(Note::DialogueCut(reason));
            Some(Status::Unknown)
        }
    };
    if tape.checks < 2 {
        return Err(match status {
            Some(Status::Unknown) => Unsupported::ShortDialogue.into(),
            _ => Unsupported::OneCheck.into(),
        });
    }
    Ok((tape.finished()?, status))
}
