//! What a search tells, as data: why something is undecided or failed, and what else is worth knowing. Words are made
//! where these are shown; advice about flags is the caller's.

use crate::evidence::Evidence;
use crate::watch::Standing;
use hyperplan_encode as encode;
use hyperplan_problem::answer::{Quantifiers, ReasonCode, States};
use hyperplan_solver::{self as solver, Format, PrintedModelError, Unknown};
use hyperplan_verify as verify;
use std::fmt::Display;
use std::io;
use std::sync::Arc;

/// Why an objective is undecided.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Reason {
    /// The time is up, or a solver does not know.
    #[error(transparent)]
    Solver(#[from] Unknown),
    /// Which paths go on for ever cannot be told of a large system.
    #[error(
        "system {system} is too large to enumerate and has states without transitions, so it is not known which \
         paths go on for ever; use `absorb`, or `within K`"
    )]
    DeadEnds {
        /// The system.
        system: String,
    },
    /// A search over infinitely many choices was given up.
    #[error("no end after {0} counterexamples")]
    NoEnd(u32),
    /// Instance by instance, numbers without bounds outgrew ours.
    #[error("numbers in the search grew beyond 64 bits")]
    LargeNumbers,
    /// Numbers without bounds are too large for ours in the model that a solver found.
    #[error("the numbers in the solver's model are beyond 64 bits")]
    LargeModel,
    /// The checker's own numbers outgrew ours.
    #[error(transparent)]
    Checker(verify::Error),
    /// A system has states with more transitions than the checker looks at.
    #[error("there are more transitions from a state than the checker looks at; use `within K`")]
    TooManySteps,
    /// What nobody could check is no answer.
    #[error("a strategy was found, but could not be verified: {0}")]
    Unverified(Box<Reason>),
    /// Solvers that raced, each with what it came to.
    #[error("{}", listed(.0))]
    Several(Vec<(String, Fallen)>),
}

/// What a solver that won no race came to.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Fallen {
    /// It did not know.
    #[error(transparent)]
    Undecided(Reason),
    /// It failed.
    #[error(transparent)]
    Failed(Arc<Error>),
}

impl Reason {
    /// The reason in a word.
    #[must_use]
    pub fn code(&self) -> ReasonCode {
        match self {
            Reason::Solver(Unknown::Timeout | Unknown::WaitsForEnd) => ReasonCode::Timeout,
            Reason::Solver(Unknown::Interrupted) => ReasonCode::Interrupted,
            Reason::Solver(Unknown::Memory | Unknown::MemoryLimit { .. }) => ReasonCode::OutOfMemory,
            Reason::Solver(Unknown::Incomplete(_) | Unknown::Effort) => ReasonCode::Incomplete,
            Reason::Solver(Unknown::Said(_) | Unknown::Unsaid) => ReasonCode::SolverGaveUp,
            Reason::DeadEnds { .. } => ReasonCode::DeadEnds,
            Reason::NoEnd(_) => ReasonCode::NoEnd,
            Reason::LargeNumbers | Reason::LargeModel | Reason::Checker(_) => ReasonCode::LargeNumbers,
            Reason::TooManySteps | Reason::Unverified(_) => ReasonCode::Unverified,
            Reason::Several(_) => ReasonCode::Several,
        }
    }
}

/// What is not supported.
#[derive(Debug, thiserror::Error)]
pub enum Unsupported {
    /// The embedded solver knows bits only.
    #[error("{} takes a solver for integers and reals; the builtin solver has none", subject(.system.as_deref(), *.states))]
    Arithmetic {
        /// The system that has variables without bounds, if one has.
        system: Option<String>,
        /// How states are written.
        states: States,
    },
    /// The embedded solver takes no quantifiers.
    #[error("quantifiers can be kept for a solver that decides them; the builtin solver does not")]
    KeptQuantifiers,
    /// There is nothing to search explicitly.
    #[error(
        "an explicit search takes two blocks of quantifiers, two to four paths, and states that are written one by one"
    )]
    NotExplicit,
    /// A search without queries is no benchmark.
    #[error("an explicit search asks no solver: there is nothing to write")]
    NothingToWrite,
    /// The problem has no such objective.
    #[error("there is no objective {0}")]
    NoObjective(String),
    /// Which paths go on for ever cannot be told of a large system.
    #[error(
        "system {system} is too large to enumerate, so it is not known which of its paths go on for ever; use \
         `within K`"
    )]
    Endless {
        /// The system.
        system: String,
    },
    /// Quantifiers that are decided so make no incremental benchmark.
    #[error("quantifiers {0} give a single query, which is no incremental benchmark")]
    SingleQuery(Quantifiers),
    /// A dialogue was to give a model or a core.
    #[error("the search by counterexamples is a dialogue, which asks for no model and no core")]
    Dialogue,
    /// A model of an unsatisfiable query was wanted.
    #[error("the query is unsatisfiable: there is no model to ask for")]
    NoModel,
    /// A core of a satisfiable query was wanted.
    #[error("the query is satisfiable: there is no unsatisfiable core to ask for")]
    NoCore,
    /// No solver for integers and reals is there.
    #[error("a search with integers or reals takes z3, cvc5 or yices, and none was found")]
    NoArithmeticSolver,
    /// Bits cannot stand for what has no bounds.
    #[error("{}, which no bits stand for: {format} is for finite systems", unbounded(.system.as_deref(), *.states))]
    NoBits {
        /// The system that has variables without bounds, if one has.
        system: Option<String>,
        /// How states are written.
        states: States,
        /// What the query was to be written in.
        format: Format,
    },
    /// Models and cores are asked for in SMT-LIB, and dialogues held.
    #[error("{0} has no commands: it asks for no model and no core, and holds no dialogue")]
    NoTracks(Format),
    /// The solver that a file is for reads another format.
    #[error("solver {solver} is given {}, and does not read {}", format_name(*.reads), format_name(*.written))]
    NotRead {
        /// The solver.
        solver: String,
        /// What it reads; `None` for SMT-LIB 2.
        reads: Option<Format>,
        /// What the file was to be written in.
        written: Option<Format>,
    },
    /// Functions are for SMT-LIB.
    #[error("{0} has no functions: paths have to be symbols there")]
    NoFunctions(Format),
    /// A search by counterexamples tries candidates, which are paths.
    #[error("the search by counterexamples asks for paths as symbols, not as functions")]
    DialogueOfFunctions,
    /// A search did not get far enough to make a dialogue.
    #[error("the search did not get to ask twice: give it more time")]
    ShortDialogue,
    /// A search needs no dialogue.
    #[error("the search asks only once, which makes no incremental benchmark")]
    OneCheck,
    /// There is no strategy to ask about.
    #[error("there is nothing that the objective asks for, and so no step of it to ask about")]
    NoSteps,
    /// The time was up before a model was understood.
    #[error("out of time")]
    OutOfTime,
    /// A model belongs to no query of an objective.
    #[error("it is no model of objective {0} as emit writes it: no symbol fits")]
    ForeignModel(String),
    /// A model says what no paths do.
    #[error("it describes no paths of the objective's systems")]
    NoPaths,
    /// A model has numbers that are too large for ours.
    #[error("its numbers are beyond 64 bits")]
    LargeModel,
    /// A model has a value that cannot be read.
    #[error(transparent)]
    Value(PrintedModelError),
}

fn unbounded(system: Option<&str>, states: States) -> String {
    match system {
        Some(system) => format!("system {system} has variables without bounds"),
        None => format!("states are written as {states}"),
    }
}

fn format_name(format: Option<Format>) -> String {
    format.map_or_else(|| "SMT-LIB 2".to_owned(), |format| format.to_string())
}

fn subject(system: Option<&str>, states: States) -> String {
    match system {
        Some(system) => format!("system {system} has variables without bounds, which"),
        None => format!("states {states}"),
    }
}

/// Why there is no answer at all.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The request cannot be met by this version.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The objective cannot be encoded as asked.
    #[error(transparent)]
    Encode(#[from] encode::Error),
    /// A solver failed.
    #[error(transparent)]
    Solver(#[from] solver::Error),
    /// A solver's model is wrong.
    #[error("solver {solver} gave a wrong model: {wrong}")]
    WrongModel {
        /// The solver.
        solver: String,
        /// What is wrong with it.
        wrong: Wrong,
        /// The query that it violates, or on which it could not be evaluated.
        query: Option<Box<Evidence>>,
    },
    /// Two solvers contradict each other.
    #[error("solvers {unsat} and {sat} disagree: {unsat} says unsat, {sat} says sat, {worth}")]
    Disagreement {
        /// Who says unsat.
        unsat: String,
        /// Who says sat.
        sat: String,
        /// What the model of the latter is worth.
        worth: Worth,
        /// The query.
        query: Box<Evidence>,
    },
    /// All solvers of a race failed.
    #[error("no solver gave an answer: {}", listed(.0))]
    Race(Vec<(String, Arc<Error>)>),
    /// The time was up before there was anything to show.
    #[error("stopped ({0}) before the query was built")]
    Late(Unknown),
    /// The temporary file of a dialogue could not be written.
    #[error("cannot keep the dialogue in a temporary file: {0}")]
    Tape(io::Error),
    /// Our own checker refutes our answer.
    #[error("this is a bug in hyperplan: the strategy found fails verification: {0}; please report it")]
    Bug(String),
}

/// What is wrong with a model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Wrong {
    /// It makes an assertion false.
    #[error("it does not satisfy the query")]
    Violates,
    /// What it says of a path's states and actions fits no path.
    #[error("it describes no path")]
    NoPath,
    /// Its paths are defeated, in the checker's words.
    #[error("{0}")]
    Defeated(String),
}

/// What the model of a solver is worth that contradicts another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Worth {
    /// There is none.
    #[error("but gives no model of the query")]
    Missing,
    /// It is wrong.
    #[error("but its model does not satisfy the query")]
    Wrong,
    /// It is right.
    #[error("and its model satisfies the query")]
    Right,
    /// Nobody knows.
    #[error("with a model that cannot be evaluated on the query")]
    Unknown,
}

/// Whose fault it is that there is no answer; the worst is the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// What was asked for is not supported, or too large as asked.
    Request,
    /// It was interrupted, or the time was up.
    Time,
    /// A solver failed.
    Solver,
    /// We have a bug.
    Ours,
}

impl Error {
    /// Whose fault it is.
    #[must_use]
    pub fn fault(&self) -> Fault {
        match self {
            Error::Encode(encode::Error::Interrupted) | Error::Late(_) => Fault::Time,
            Error::Unsupported(_) | Error::Encode(_) | Error::Tape(_) => Fault::Request,
            Error::Solver(solver::Error::Keep { .. }) => Fault::Request,
            Error::Solver(error) if error.is_unsupported() => Fault::Request,
            Error::Solver(_) | Error::WrongModel { .. } | Error::Disagreement { .. } => Fault::Solver,
            Error::Race(_) => self.worst().map_or(Fault::Solver, Error::fault),
            Error::Bug(_) => Fault::Ours,
        }
    }

    /// The error in a word.
    #[must_use]
    pub fn code(&self) -> ReasonCode {
        match self {
            Error::Encode(encode::Error::Interrupted) => ReasonCode::Interrupted,
            Error::Late(unknown) => Reason::Solver(unknown.clone()).code(),
            Error::Encode(_) => ReasonCode::TooLarge,
            Error::Unsupported(_) => ReasonCode::Unsupported,
            Error::Solver(solver::Error::Keep { .. }) => ReasonCode::Io,
            Error::Solver(error) if error.is_unsupported() => ReasonCode::Unsupported,
            Error::Solver(_) => ReasonCode::SolverFailed,
            Error::WrongModel { .. } => ReasonCode::WrongModel,
            Error::Disagreement { .. } => ReasonCode::Disagreement,
            Error::Race(_) => self.worst().map_or(ReasonCode::SolverFailed, Error::code),
            Error::Tape(_) => ReasonCode::Io,
            Error::Bug(_) => ReasonCode::Bug,
        }
    }

    /// Of a race the worst failure; of those a wrong model, if there is one.
    fn worst(&self) -> Option<&Error> {
        let Error::Race(errors) = self else { return None };
        let rank = |error: &&Error| (error.fault(), matches!(error, Error::WrongModel { .. }));
        errors.iter().map(|(_, error)| &**error).max_by_key(rank)
    }
}

fn listed(each: &[(String, impl Display)]) -> String {
    each.iter().map(|(name, what)| format!("{name}: {what}")).collect::<Vec<_>>().join("; ")
}

/// Why quantifiers were decided as they were, where the choice was ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Because {
    /// There are none to decide.
    #[error("there is one block of quantifiers, so one query decides")]
    OneBlock,
    /// No query was asked.
    #[error("a search over what the other player may be doing was short")]
    Searched,
    /// One query follows all runs.
    #[error("all runs of the other player's only path can be followed at once")]
    Swept,
    /// Runs of several paths cannot be followed at once.
    #[error("the other player has several paths")]
    SeveralPaths,
    /// Nor can those of states that are not enumerated.
    #[error("states are not written one by one")]
    Symbolic,
    /// Nor too many.
    #[error("there are too many runs of the other player's path to follow all at once")]
    ManyRuns,
    /// Nor can runs on which others depend.
    #[error("the quantifiers alternate more than once")]
    Alternations,
    /// The solver may know better.
    #[error("a search by counterexamples found no end")]
    NoEnd,
}

/// What the user should know besides an answer or a benchmark.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Note {
    /// A path ranges over nothing.
    #[error("system {system} has no path for {path} to range over, which alone decides the objective")]
    NoPaths {
        /// Its system.
        system: String,
        /// Its variable.
        path: String,
    },
    /// States are bit-vectors, since this is too large otherwise.
    #[error("states are bit-vectors, as there are too many to write one by one: {0}")]
    Symbolic(encode::Error),
    /// Nothing was found, and more steps matter than was perhaps meant.
    #[error(
        "{steps} steps of {path} matter, though no bound exceeds {bound}: nested bounds add up; `within K` bounds all of them at once"
    )]
    LongHorizon {
        /// The variable of the longest path.
        path: String,
        /// Its horizon.
        steps: u64,
        /// The greatest bound.
        bound: u64,
    },
    /// What was being done when the search ended without an answer.
    #[error("it was stopped at this: {0}")]
    Stopped(Standing),
    /// A path that the solver chose relies on the outcomes of nondeterministic actions.
    #[error("{path} relies on outcomes that its actions might not have; `exists {path}` picks them too")]
    PicksOutcomes {
        /// Its variable.
        path: String,
    },
    /// The second solver does not say that something is unsatisfiable.
    #[error("an unsat was not confirmed by {solver}: {why}")]
    Unconfirmed {
        /// The solver.
        solver: String,
        /// Why not.
        why: Fallen,
    },
    /// A solver lost a race by failing.
    #[error("{solver} gave no answer: {error}")]
    Lost {
        /// The solver.
        solver: String,
        /// Why.
        error: Arc<Error>,
    },
    /// A benchmark is about a counterexample.
    #[error("{objective} begins with forall: the query is satisfiable if it has a counterexample")]
    Counterexample {
        /// The objective.
        objective: String,
    },
    /// The status of a benchmark was not found out.
    #[error("the status is not known: {0}")]
    StatusUnknown(Reason),
    /// Nobody could be asked for the status of a benchmark.
    #[error("the status is not known: no solver for integers and reals was found")]
    NoArithmeticSolver,
    /// A dialogue ends before the answer is known.
    #[error("the dialogue ends before the answer is known: {0}")]
    DialogueCut(Reason),
    /// A benchmark's solver does not take its quantifiers.
    #[error("quantifiers are expanded: {0}")]
    Expanded(Arc<Error>),
    /// A benchmark's solver is served better by another logic than the smallest.
    #[error("the logic is {logic} instead of {smallest}, which serves {solver} better")]
    Logic {
        /// The logic.
        logic: String,
        /// The smallest.
        smallest: &'static str,
        /// The solver.
        solver: String,
    },
}
