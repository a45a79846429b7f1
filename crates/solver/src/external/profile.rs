//! What is particular to each solver: data, read from the table beside this file and from configuration files.

use std::fmt;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::propositional::Format;
use crate::session::Quantifiers;

/// A solver that has a name here.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Profile {
    /// What it is called here.
    pub(crate) name: String,
    /// Other names that mean it.
    pub(crate) aliases: Vec<String>,
    /// The program: a name to be sought in `PATH`, or a path.
    pub(crate) program: String,
    /// What it reads, if that is not SMT-LIB 2.
    pub(crate) format: Option<Format>,
    /// Arguments of a dialogue.
    pub(crate) arguments: Vec<String>,
    /// Arguments of a process that answers one check: where no more are asked, there are quantifiers, or no dialogue is
    /// possible.
    /// [`FILE`] among them stands for the path of a file with the query, which else comes on standard input.
    pub(crate) one_shot: Option<Vec<String>>,
    /// Whether a process answers more than one check.
    pub(crate) incremental: bool,
    /// How it takes assumptions.
    pub(crate) assumptions: Assumptions,
    /// The commands that come first, such as the one that asks for models.
    pub(crate) setup: Vec<String>,
    /// The logic that is always set, if it should not be the smallest that fits.
    pub(crate) logic: Option<String>,
    /// The option that sets the seed.
    pub(crate) seed: Option<String>,
    /// The theories that it takes; `None` if that is not known.
    pub(crate) theories: Option<Vec<Theory>>,
    /// The quantifiers that it takes.
    pub(crate) quantifiers: Quantifiers,
    /// The arguments that make it say its version.
    pub(crate) version: Vec<String>,
    /// Whether it also says it in a dialogue, to `(get-info :version)`: that saves a process.
    pub(crate) tells_version: bool,
    /// How to install it.
    pub(crate) install: Install,
    /// The configuration file that says so; none for the table of hyperplan.
    pub(crate) origin: Option<PathBuf>,
}

/// What stands for the path of the query's file among the arguments.
pub(crate) const FILE: &str = "{file}";

/// How a solver takes assumptions.
#[derive(Copy, Clone, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Assumptions {
    /// `check-sat-assuming`.
    Check,
    /// As assertions between `push` and `pop`.
    Push,
}

/// What terms may be about, beyond Booleans.
#[derive(Copy, Clone, PartialEq, Eq, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Theory {
    BitVectors,
    Integers,
    Reals,
    Datatypes,
    Functions,
}

impl fmt::Display for Theory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Theory::BitVectors => "bit-vectors",
            Theory::Integers => "integers",
            Theory::Reals => "reals",
            Theory::Datatypes => "datatypes",
            Theory::Functions => "functions",
        })
    }
}

/// How to install a solver: a command for each kind of system.
#[derive(Clone, PartialEq, Eq, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Install {
    /// On Debian and its relatives.
    pub debian: Option<String>,
    /// On macOS.
    pub macos: Option<String>,
    /// From the Python package index, anywhere.
    pub pypi: Option<String>,
    /// An address that says more.
    pub see: Option<String>,
}

impl fmt::Display for Install {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let commands = [(&self.debian, "Debian"), (&self.macos, "macOS"), (&self.pypi, "PyPI")];
        let commands = commands.iter().filter_map(|(command, place)| Some((command.as_ref()?, place)));
        let commands: Vec<String> =
            commands.map(|(command, place)| format!("`{command}` ({place})")).collect();
        match (commands.split_last(), &self.see) {
            (None, None) => f.write_str("install it, or say where it is"),
            (None, Some(see)) => write!(f, "see {see}"),
            (Some((last, [])), _) => write!(f, "install it with {last}"),
            (Some((last, others)), _) => write!(f, "install it with {} or {last}", others.join(", ")),
        }
    }
}

impl Profile {
    /// What a solver is like if nothing is said but its name.
    pub(crate) fn plain(name: &str) -> Profile {
        let setup = ["(set-option :print-success false)", "(set-option :produce-models true)"];
        Profile {
            name: name.to_owned(),
            aliases: Vec::new(),
            program: String::new(),
            format: None,
            arguments: Vec::new(),
            one_shot: None,
            incremental: true,
            assumptions: Assumptions::Check,
            setup: setup.map(str::to_owned).to_vec(),
            logic: None,
            seed: None,
            theories: None,
            quantifiers: Quantifiers::Any,
            version: vec!["--version".to_owned()],
            tells_version: false,
            install: Install::default(),
            origin: None,
        }
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it reads; `None` for SMT-LIB 2.
    #[must_use]
    pub fn format(&self) -> Option<Format> {
        self.format
    }

    /// The environment variable that says where the program is.
    pub(crate) fn variable(&self) -> String {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        format!("HYPERPLAN_{}", self.name.chars().map(letter).collect::<String>())
    }

    /// Whether that is one of its names.
    pub(crate) fn is_called(&self, name: &str) -> bool {
        self.name == name || self.aliases.iter().any(|alias| alias == name)
    }

    /// Whether it takes that theory, as far as it is known.
    pub(crate) fn takes(&self, theory: Theory) -> bool {
        self.theories.as_ref().is_none_or(|theories| theories.contains(&theory))
    }
}
