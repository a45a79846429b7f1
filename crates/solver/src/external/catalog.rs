//! The solvers that can be named: hyperplan's own table, and what configuration files add to it or change.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use hyperplan_smt::{Request, parts};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;

use super::line::{is_kind, split_list};
use super::profile::{Assumptions, FILE, Install, Profile, Theory};
use super::spec::Spec;
use crate::embedded;
use crate::error::Error;
use crate::propositional::Format;
use crate::session::{Options, Quantifiers};

/// The solvers that can be named. Later files come before earlier ones, and all before hyperplan's own table.
#[derive(Clone, Debug)]
pub struct Catalog {
    profiles: Vec<Arc<Profile>>,
    files: Vec<PathBuf>,
}

/// What is wrong with a configuration file.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{}:{line}: {what}", file.display())]
pub struct ConfigError {
    /// The file.
    pub file: PathBuf,
    /// The line, counted from 1.
    pub line: usize,
    /// What is wrong there, and what to do.
    pub what: String,
}

/// A configuration file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    solver: Vec<Entry>,
}

/// A solver in a file: what is not said is as in the entry that it is like.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct Entry {
    name: Spanned<String>,
    like: Option<Spanned<String>>,
    aliases: Option<Vec<String>>,
    program: Option<Spanned<String>>,
    format: Option<Reads>,
    arguments: Option<Vec<String>>,
    one_shot: Option<Vec<String>>,
    incremental: Option<bool>,
    assumptions: Option<Assumptions>,
    setup: Option<Vec<String>>,
    logic: Option<String>,
    seed: Option<String>,
    theories: Option<Vec<Theory>>,
    quantifiers: Option<Quantifiers>,
    version: Option<Vec<String>>,
    tells_version: Option<bool>,
    install: Option<Install>,
}

/// What a program reads.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Reads {
    Smt2,
    Dimacs,
    Qdimacs,
    Qcir,
}

impl Default for Catalog {
    fn default() -> Self {
        Catalog { profiles: profiles().to_vec(), files: Vec::new() }
    }
}

impl Catalog {
    /// Hyperplan's own table.
    pub(super) fn known() -> Catalog {
        let mut catalog = Catalog { profiles: Vec::new(), files: Vec::new() };
        let table = include_str!("solvers.toml");
        catalog.read(Path::new("solvers.toml"), table, None).expect("the table is tested");
        catalog
    }

    /// Adds what a configuration file says.
    ///
    /// # Errors
    /// When it is no proper configuration; then nothing has changed.
    pub fn add(&mut self, file: &Path, text: &str) -> Result<(), ConfigError> {
        self.read(file, text, Some(file))?;
        self.files.push(file.to_owned());
        Ok(())
    }

    /// The configuration files that were added, in that order.
    #[must_use]
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The solver that a word or a command line means.
    ///
    /// # Errors
    /// When it means none.
    pub fn spec(&self, text: &str) -> Result<Spec, Error> {
        match self.profile(text.trim()) {
            Some(profile) if profile.origin.is_some() => Ok(Spec::Configured(Arc::clone(profile))),
            None => self.of_kind(text.trim()).map_or_else(|| text.parse(), Ok),
            Some(_) => text.parse(),
        }
    }

    /// A program that is given by its path, or with its version, and is known by its name.
    fn of_kind(&self, line: &str) -> Option<Spec> {
        let profile = self.profiles.iter().find(|profile| is_kind(line, &profile.program))?;
        Some(Spec::Program(line.to_owned(), Arc::clone(profile)))
    }

    /// The solvers in a list with commas. A command line that has a comma itself is written with quotes around the
    /// word that has it.
    ///
    /// # Errors
    /// When one of them means none.
    pub fn specs(&self, text: &str) -> Result<Vec<Spec>, Error> {
        split_list(text).into_iter().map(|text| self.spec(text)).collect()
    }

    pub(crate) fn profiles(&self) -> &[Arc<Profile>] {
        &self.profiles
    }

    /// The profile of that name; a name comes before the others' aliases.
    pub(crate) fn profile(&self, name: &str) -> Option<&Arc<Profile>> {
        let named = self.profiles.iter().find(|profile| profile.name == name);
        named.or_else(|| self.profiles.iter().find(|profile| profile.is_called(name)))
    }

    fn read(&mut self, file: &Path, text: &str, origin: Option<&Path>) -> Result<(), ConfigError> {
        let error =
            |at: usize, what: String| ConfigError { file: file.to_owned(), line: line(text, at), what };
        let read: File = parse(text).map_err(|(at, what)| error(at, what))?;
        let mut profiles = self.profiles.clone();
        let mut names = BTreeSet::new();
        for entry in read.solver {
            let start = entry.name.span().start;
            if !names.insert(entry.name.get_ref().clone()) {
                let what =
                    format!("solver {} is described twice in this file; rename one", entry.name.get_ref());
                return Err(error(start, what));
            }
            let catalog = Catalog { profiles, files: Vec::new() };
            let profile = entry.profile(&catalog, origin).map_err(|(at, what)| error(at, what))?;
            profiles = catalog.profiles;
            match profiles.iter_mut().find(|other| other.name == profile.name) {
                Some(other) => *other = Arc::new(profile),
                None => profiles.push(Arc::new(profile)),
            }
        }
        self.profiles = profiles;
        Ok(())
    }
}

/// Whether a configuration file says what is run, or what a program is told beyond the query: that may do harm. A
/// file with a mistake says nothing, and cannot be added.
#[must_use]
pub fn says_what_to_run(text: &str) -> bool {
    parse::<File>(text).is_ok_and(|file| file.solver.iter().any(Entry::says_what_to_run))
}

/// Reads TOML; an error has a place.
fn parse<T: DeserializeOwned>(text: &str) -> Result<T, (usize, String)> {
    toml::from_str(text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        (at, error.message().split_whitespace().collect::<Vec<_>>().join(" "))
    })
}

/// The number of the line that a place is on.
fn line(text: &str, at: usize) -> usize {
    text.bytes().take(at).filter(|byte| *byte == b'\n').count() + 1
}

impl Entry {
    /// Arguments and commands can make a known program write files, so they count.
    fn says_what_to_run(&self) -> bool {
        // By name, so that nobody forgets to decide about a new key.
        let Entry {
            name: _,
            like: _,
            aliases: _,
            program,
            format: _,
            arguments,
            one_shot,
            incremental: _,
            assumptions: _,
            setup,
            logic,
            seed,
            theories: _,
            quantifiers: _,
            version,
            tells_version: _,
            install: _,
        } = self;
        let lists = [arguments, one_shot, setup, version];
        program.is_some() || lists.iter().any(|list| list.is_some()) || logic.is_some() || seed.is_some()
    }

    fn profile(self, catalog: &Catalog, origin: Option<&Path>) -> Result<Profile, (usize, String)> {
        let (at, name) = (self.name.span().start, self.name.into_inner());
        if let Some(what) = misnamed(&name) {
            return Err((at, what));
        }
        // A known name without `like` changes that solver.
        let same = catalog.profiles.iter().find(|profile| profile.name == name);
        let base = match &self.like {
            Some(like) => match catalog.profile(like.get_ref()) {
                Some(base) => Profile { aliases: Vec::new(), ..Profile::clone(base) },
                None => {
                    let names: Vec<&str> =
                        catalog.profiles.iter().map(|profile| profile.name.as_str()).collect();
                    let what = format!(
                        "there is no solver {} to be like; there are {}",
                        like.get_ref(),
                        names.join(", ")
                    );
                    return Err((like.span().start, what));
                }
            },
            None => same.map_or_else(|| Profile::plain(&name), |profile| Profile::clone(profile)),
        };
        let program = match self.program {
            Some(program) if program.get_ref().trim().is_empty() => {
                return Err((program.span().start, "the program's name is empty".to_owned()));
            }
            Some(program) => beside(origin, program.into_inner()),
            None if base.program.is_empty() => {
                let what =
                    format!("solver {name} needs a `program`, or a `like` with the name of another solver");
                return Err((at, what));
            }
            None => base.program,
        };
        // Who changes the arguments means all of them.
        let inherited = base.one_shot.filter(|_| self.arguments.is_none());
        let arguments = self.arguments.unwrap_or(base.arguments);
        if arguments.iter().any(|argument| argument.contains(FILE)) {
            let what = format!(
                "{FILE} in `arguments`: a dialogue is on standard input; put these arguments into `one-shot`, and say \
                 `incremental = false`"
            );
            return Err((at, what));
        }
        let format = match self.format {
            None => base.format,
            Some(Reads::Smt2) => None,
            Some(Reads::Dimacs) => Some(Format::Dimacs),
            Some(Reads::Qdimacs) => Some(Format::Qdimacs),
            Some(Reads::Qcir) => Some(Format::Qcir),
        };
        let asks = |command: &&String| Request::of(&words(command)).is_some();
        if let Some(command) = self.setup.iter().flatten().find(asks) {
            let what = format!("{command} in `setup` has an answer, which nobody waits for; leave it out");
            return Err((at, what));
        }
        Ok(Profile {
            name,
            aliases: self.aliases.unwrap_or(base.aliases),
            program,
            format,
            arguments,
            one_shot: self.one_shot.or(inherited),
            // What reads a file of bits answers once.
            incremental: format.is_none() && self.incremental.unwrap_or(base.incremental),
            assumptions: self.assumptions.unwrap_or(base.assumptions),
            setup: self.setup.unwrap_or(base.setup),
            logic: self.logic.or(base.logic),
            seed: self.seed.or(base.seed),
            theories: self.theories.or(base.theories),
            quantifiers: self.quantifiers.unwrap_or(base.quantifiers),
            version: self.version.unwrap_or(base.version),
            tells_version: self.tells_version.unwrap_or(base.tells_version),
            install: self.install.unwrap_or(base.install),
            origin: origin.map(Path::to_owned),
        })
    }
}

/// The words of a command, as far as they are no lists.
fn words(command: &str) -> Vec<&str> {
    let parts = parts(command).unwrap_or_default();
    parts.into_iter().take_while(|part| !part.starts_with('(')).collect()
}

/// What is wrong with a name.
fn misnamed(name: &str) -> Option<String> {
    if embedded::backend(name).is_some() {
        return Some(format!("{name} is an embedded solver; choose another name"));
    }
    let good = name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
    (name.is_empty() || !good)
        .then(|| format!("{name:?} is no name for a solver: use letters, digits, `-`, `_` and `.`"))
}

/// A program with a relative path is beside the configuration file.
fn beside(origin: Option<&Path>, program: String) -> String {
    match origin.and_then(Path::parent) {
        Some(folder) if program.contains('/') && Path::new(&program).is_relative() => {
            folder.join(program).display().to_string()
        }
        _ => program,
    }
}

/// The solvers of hyperplan's own table.
static KNOWN: LazyLock<Catalog> = LazyLock::new(Catalog::known);

/// All profiles of hyperplan's own table.
pub(crate) fn profiles() -> &'static [Arc<Profile>] {
    KNOWN.profiles()
}

/// The profile of that name in hyperplan's own table.
pub(crate) fn profile(name: &str) -> Option<&'static Arc<Profile>> {
    KNOWN.profile(name)
}

/// The same for hyperplan's own table.
pub(crate) fn of_kind(line: &str) -> Option<Spec> {
    KNOWN.of_kind(line)
}

/// Refuses quantifiers beyond those that the solver takes, and names solvers that take them.
pub(crate) fn demand_at_most(options: &Options, taken: Quantifiers, solver: &str) -> Result<(), Error> {
    if options.quantifiers() <= taken {
        return Ok(());
    }
    let beyond = match taken {
        Quantifiers::None => "quantifiers",
        _ => "quantifiers inside quantifiers",
    };
    let others = that_take(options.quantifiers()).join(", ");
    Err(Error::Unsupported {
        what: format!("the {solver} solver cannot handle {beyond}: use one of {others}"),
    })
}

/// The names of the solvers that take those quantifiers.
fn that_take(quantifiers: Quantifiers) -> Vec<&'static str> {
    names(|profile| profile.quantifiers >= quantifiers)
}

/// The names of the solvers of hyperplan's own table that fit.
pub(super) fn names(fit: impl Fn(&Profile) -> bool) -> Vec<&'static str> {
    profiles().iter().filter(|profile| fit(profile)).map(|profile| profile.name.as_str()).collect()
}

#[cfg(test)]
mod tests;
