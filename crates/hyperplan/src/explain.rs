//! What the planner tells, in the command's words: with the flags that help, and where evidence is kept.

use crate::failure::{Exit, Failure};
use crate::files::reason;
use hyperplan_plan::{EncodeError, Error, Evidence, Fallen, Fault, Note, Reason, Unsupported, Wrong};
use hyperplan_problem::answer::ReasonCode;
use hyperplan_solver::{Error as SolverError, Format, Unknown, keep_query};
use hyperplan_syntax::Diagnostic;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Puts into words what the planner tells.
#[derive(Clone, Copy, Default)]
pub(crate) struct Explain<'a> {
    /// Where queries are kept; queries that prove a solver wrong are kept in any case.
    pub(crate) queries: Option<&'a Path>,
}

impl Explain<'_> {
    /// How a command fails that is about something.
    pub(crate) fn failure(self, about: impl Display, error: &Error) -> Failure {
        Failure::new(status(error), format_args!("{about}: {}", self.error(error)))
    }

    pub(crate) fn error(self, error: &Error) -> String {
        match error {
            Error::Unsupported(what) => unsupported(what),
            Error::Encode(error) => format!("{error}{}", advice(error)),
            Error::Race(errors) => {
                let each = errors.iter().map(|(name, error)| (name, self.error(error)));
                format!("no solver gave an answer: {}", listed(each))
            }
            Error::WrongModel { wrong: Wrong::Violates, query: Some(query), .. } => {
                format!("{error}, {}", self.keep(query))
            }
            Error::WrongModel { query: Some(query), .. } => {
                format!("{error}; its model could not be evaluated on the query, {}", self.keep(query))
            }
            Error::Disagreement { query, .. } => format!("{error}, {}", self.keep(query)),
            Error::Solver(SolverError::Keep { folder, source }) => {
                format!("cannot keep queries in {}: {}", folder.display(), reason(source))
            }
            error => error.to_string(),
        }
    }

    pub(crate) fn reason(self, reason: &Reason) -> String {
        match reason {
            Reason::Several(each) => listed(each.iter().map(|(name, fallen)| (name, self.fallen(fallen)))),
            reason => format!("{reason}{}", way_out(reason)),
        }
    }

    fn fallen(self, fallen: &Fallen) -> String {
        match fallen {
            Fallen::Undecided(reason) => self.reason(reason),
            Fallen::Failed(error) => self.error(error),
        }
    }

    pub(crate) fn note(self, note: &Note) -> String {
        match note {
            Note::Lost { solver, error } => format!("{solver} gave no answer: {}", self.error(error)),
            Note::StatusUnknown(reason) | Note::DialogueCut(reason) => format!("{note}{}", way_out(reason)),
            note => note.to_string(),
        }
    }

    /// Writes a query beside the others, if these are kept, else among the temporary files. Says where, or why not.
    fn keep(self, query: &Evidence) -> String {
        match self.write(query) {
            Ok(path) => format!("which is kept in {}", path.display()),
            Err(error) => format!("which could not be kept: {}", reason(&error)),
        }
    }

    fn write(self, query: &Evidence) -> io::Result<PathBuf> {
        let folder = self.queries.map_or_else(std::env::temp_dir, Path::to_owned);
        keep_query(&folder, "hyperplan-fault-", query.solver(), |to| to.write_all(query.text()))
    }
}

/// Why something is undecided, in a word and in words.
pub(crate) struct Why {
    pub(crate) code: ReasonCode,
    pub(crate) words: String,
}

impl Why {
    pub(crate) fn new(reason: &Reason, explain: Explain<'_>) -> Why {
        Why { code: reason.code(), words: explain.reason(reason) }
    }
}

/// The exit status that an error means.
pub(crate) fn status(error: &Error) -> Exit {
    match error.fault() {
        Fault::Request => Exit::Input,
        Fault::Time => Exit::Undecided,
        Fault::Solver => Exit::Solver,
        Fault::Ours => Exit::Bug,
    }
}

fn listed<'a>(each: impl Iterator<Item = (&'a String, String)>) -> String {
    each.map(|(name, what)| format!("{name}: {what}")).collect::<Vec<_>>().join("; ")
}

fn unsupported(what: &Unsupported) -> String {
    match what {
        Unsupported::Arithmetic { system, states } => {
            let what = match system {
                Some(system) => format!("system {system} has variables without bounds, which"),
                None => format!("--states {states}"),
            };
            format!(
                "{what} takes a solver for integers and reals, such as --solver z3, cvc5 or yices; the builtin solver \
                 has none"
            )
        }
        Unsupported::KeptQuantifiers => {
            "--quantifiers keep needs a solver that decides quantifiers, such as z3, cvc5 \
                                         or yices; the builtin solver takes cegis or expand"
                .to_owned()
        }
        Unsupported::SingleQuery(quantifiers) => format!(
            "--quantifiers {quantifiers} gives a single query, which is no incremental benchmark; use --quantifiers \
             cegis or keep"
        ),
        Unsupported::NotRead { reads, .. } => {
            let format = reads.map_or("smt2", Format::name);
            format!("{what}; use --format {format}, or leave out --solver")
        }
        Unsupported::NoBits { .. } | Unsupported::NoTracks(_) | Unsupported::NoFunctions(_) => {
            format!("{what}; use --format smt2")
        }
        Unsupported::DialogueOfFunctions => format!("{what}; use --paths symbols"),
        Unsupported::NothingToWrite => format!("{what}; use --quantifiers keep, expand or cegis"),
        Unsupported::Dialogue => format!("{what}; use --quantifiers keep or expand, or --track incremental"),
        Unsupported::OneCheck => format!("{what}; use --quantifiers keep or expand"),
        Unsupported::NoPaths => format!("{what}; is it of another objective, or with another --set?"),
        what => what.to_string(),
    }
}

/// Says with which flags files of other tools are read as they were meant.
pub(crate) fn advise(diagnostics: &mut [Diagnostic]) {
    for diagnostic in diagnostics {
        let help = match diagnostic.code {
            "semantics-without-bound" | "unbounded-operator" => "say it with `--bound K`",
            "other-precedence" => {
                "this is read as it does; parentheses make it plain, and `--dialect` names another"
            }
            _ => continue,
        };
        diagnostic.help = Some(help.to_owned());
    }
}

/// The flags with which an objective can be written that cannot be as asked.
fn advice(error: &EncodeError) -> &'static str {
    match error {
        EncodeError::TooManyCases { .. } => "; use --quantifiers cegis",
        EncodeError::NotEnumerable { .. } => "; use --states bitvec",
        EncodeError::Unbounded { .. } => ", which takes --states int or real",
        EncodeError::NotReal { .. } => "; use --states int",
        EncodeError::NoFunctions { .. } => "; use --states bitvec",
        EncodeError::HorizonTooLong { .. } | EncodeError::TooLarge { .. } | EncodeError::Interrupted => "",
    }
}

/// The flag, or the line of configuration, with which an undecided objective may be decided.
fn way_out(reason: &Reason) -> &'static str {
    match reason {
        Reason::LargeNumbers => "; --quantifiers keep leaves the search to the solver",
        Reason::Solver(Unknown::WaitsForEnd) => {
            "; describe it in hyperplan.toml, with `incremental = false` (docs/solvers.md)"
        }
        Reason::Unverified(reason) => way_out(reason),
        _ => "",
    }
}
