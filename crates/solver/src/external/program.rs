//! What is run for a session.

use std::env;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::catalog::{demand_at_most, profiles};
use super::line::split_words;
use super::profile::{FILE, Profile};
use super::version::Version;
use crate::embedded;
use crate::error::Error;
use crate::session::{Options, Quantifiers};

/// A program with its arguments.
pub(super) struct Program {
    pub(super) version: Version,
    pub(super) path: PathBuf,
    pub(super) arguments: Vec<String>,
    /// A process answers one check; the next check starts a new one.
    pub(super) one_shot: bool,
    /// What is known of it.
    pub(super) profile: Arc<Profile>,
}

impl Program {
    /// The program of a solver that is known by name.
    pub(super) fn of_profile(profile: &Arc<Profile>, options: &Options) -> Result<Program, Error> {
        demand_at_most(options, profile.quantifiers, &profile.name)?;
        let (path, tried) = locate(profile);
        let hint = || format!("{}; or set {}", profile.install, profile.variable());
        let path = path.ok_or_else(|| Error::Missing { name: profile.name.clone(), tried, hint: hint() })?;
        Ok(Program::at(path, profile, options))
    }

    /// The program that a command line without arguments names, of a kind that is known.
    pub(super) fn of_kind(line: &str, profile: &Arc<Profile>, options: &Options) -> Result<Program, Error> {
        demand_at_most(options, profile.quantifiers, &profile.name)?;
        let Program { path, .. } = Program::of_command(line)?;
        Ok(Program::at(path, profile, options))
    }

    /// A program of a kind that is known.
    pub(super) fn at(path: PathBuf, profile: &Arc<Profile>, options: &Options) -> Program {
        let one_shot =
            !profile.incremental || !options.incremental || options.quantifiers() > Quantifiers::None;
        let one_shot = profile.one_shot.as_ref().filter(|_| one_shot);
        Program {
            version: Version::of(&path, &profile.version),
            path,
            arguments: one_shot.unwrap_or(&profile.arguments).clone(),
            one_shot: one_shot.is_some() || !profile.incremental,
            profile: Arc::clone(profile),
        }
    }

    /// The program of a command line. One that names `{file}` is given the query in a file.
    pub(super) fn of_command(line: &str) -> Result<Program, Error> {
        let mut words = split_words(line).into_iter();
        let program = words.next().unwrap_or_default();
        let (path, tried) = search(&program);
        let meant = similar(&program).map_or_else(String::new, |name| format!("did you mean {name}? "));
        let hint = format!(
            "{meant}give the name of a known solver (`hyperplan solvers` lists them) or of a program"
        );
        let path = path.ok_or_else(|| Error::Missing { name: program.clone(), tried, hint })?;
        let name = Path::new(&program)
            .file_name()
            .map_or(program.clone(), |name| name.to_string_lossy().into_owned());
        let arguments: Vec<String> = words.collect();
        let one_shot = arguments.iter().any(|argument| argument.contains(FILE));
        // A command need not know `--version`: what it is stays unknown.
        Ok(Program {
            version: Version::none(),
            path,
            arguments,
            one_shot,
            profile: Arc::new(Profile::plain(&name)),
        })
    }

    /// Whether the query comes in a file.
    pub(super) fn takes_file(&self) -> bool {
        self.arguments.iter().any(|argument| argument.contains(FILE))
    }

    /// Whether to ask for the version in the dialogue.
    pub(super) fn is_to_tell_version(&self) -> bool {
        !self.version.is_known() && self.profile.tells_version
    }
}

/// Where the profile's program is, and where it was sought: the environment variable, else `PATH`.
pub(super) fn locate(profile: &Profile) -> (Option<PathBuf>, Vec<String>) {
    let variable = profile.variable();
    if let Some(path) = env::var_os(&variable).filter(|path| !path.is_empty()) {
        let path = PathBuf::from(path);
        let tried = vec![format!("{variable}={}", path.display())];
        return (is_program(&path).then_some(path), tried);
    }
    let (path, mut tried) = search(&profile.program);
    tried.insert(0, format!("${variable}"));
    (path, tried)
}

/// Where a program is: itself if it is a path, else in the directories of `PATH`. Those that depend on the current folder
/// do not count, nor does an empty one, which would be that folder: it may be anybody's.
pub(super) fn search(program: &str) -> (Option<PathBuf>, Vec<String>) {
    if program.contains('/') {
        let path = PathBuf::from(program);
        let there = if path.is_file() { ", which cannot be executed" } else { "" };
        return (is_program(&path).then_some(path), vec![format!("{program}{there}")]);
    }
    let directories = env::var_os("PATH").unwrap_or_default();
    let mut tried = Vec::new();
    for directory in env::split_paths(&directories).filter(|directory| directory.is_absolute()) {
        let path = directory.join(program);
        if is_program(&path) {
            return (Some(path), tried);
        }
        let path = path.display().to_string();
        if !tried.contains(&path) {
            tried.push(path);
        }
    }
    if tried.is_empty() {
        tried.push("PATH, which has no absolute directory".to_owned());
    }
    (None, tried)
}

fn is_program(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    path.metadata().is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}

/// The known solver that was probably meant: one slip in names of up to four letters, two in longer ones.
fn similar(program: &str) -> Option<&'static str> {
    let program = program.to_lowercase();
    let names = profiles().iter().flat_map(|profile| [&profile.name].into_iter().chain(&profile.aliases));
    names
        .map(String::as_str)
        .chain(embedded::names())
        .map(|name| (strsim::damerau_levenshtein(&program, name), name))
        .filter(|(distance, name)| *distance <= if name.len() > 4 { 2 } else { 1 })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_in_names_of_solvers() {
        let near = [
            "z4",
            "Z3",
            "cvc4",
            "yice",
            "bitwzula",
            "buildin",
            "cadicle",
            "ls",
            "lingeling",
            "/usr/bin/z3x",
            "",
        ]
        .map(similar);
        let names = ["z3", "z3", "cvc5", "yices", "bitwuzla", "builtin", "cadical"].map(Some);
        assert_eq!(near[..7], names);
        assert_eq!(near[7..], [None; 4]);
        let message = Program::of_command("z4 -in").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(message.contains("did you mean z3? give the name"), "{message}");
    }
}
