//! Solvers as programs that are given a script at once, and whatever they print is the answer: how they are measured.

use std::path::PathBuf;

use super::catalog::Catalog;
use super::profile::FILE;
use super::program::Program;
use super::program::locate;
use super::spec::Spec;
use super::version;
use crate::error::Error;
use crate::session::Options;

/// A solver as a program.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Standalone {
    /// Where it is.
    pub program: PathBuf,
    /// Its version, if it says one.
    pub version: Option<String>,
    /// Arguments for a script with one check.
    single: Vec<String>,
    /// Arguments for other scripts.
    several: Vec<String>,
    /// The option that sets the seed.
    seed: Option<String>,
}

impl Standalone {
    /// The arguments for a script in that file, which may take back assertions and ask several times; and whether the
    /// script is read from standard input.
    #[must_use]
    pub fn arguments(&self, file: &str, incremental: bool) -> (Vec<String>, bool) {
        let arguments = if incremental { &self.several } else { &self.single };
        let from_input = !arguments.iter().any(|argument| argument.contains(FILE));
        (arguments.iter().map(|argument| argument.replace(FILE, file)).collect(), from_input)
    }

    /// The command that sets the seed, if there is one.
    #[must_use]
    pub fn seed(&self, seed: u64) -> Option<String> {
        self.seed.as_ref().map(|option| format!("(set-option {option} {seed})\n"))
    }
}

impl Catalog {
    /// The program of a solver; `None` for the embedded one, and for those that read no SMT-LIB.
    ///
    /// # Errors
    /// When it is not installed.
    pub fn standalone(&self, spec: &Spec) -> Result<Option<Standalone>, Error> {
        let profile = match spec {
            Spec::Builtin | Spec::Backend(_) => return Ok(None),
            Spec::Profile(name) => self.profile(name),
            Spec::Configured(profile) | Spec::Program(_, profile) => Some(profile),
            Spec::Command(line) => {
                let Program { path, arguments, .. } = Program::of_command(line)?;
                let several = arguments.clone();
                return Ok(Some(Standalone {
                    program: path,
                    version: None,
                    single: arguments,
                    several,
                    seed: None,
                }));
            }
        };
        let unknown = || Error::Unsupported { what: format!("no solver {} is known", spec.name()) };
        let profile = profile.ok_or_else(unknown)?;
        if profile.format.is_some() {
            return Ok(None);
        }
        let program = match spec {
            Spec::Program(line, _) => Program::of_kind(line, profile, &Options::default())?.path,
            _ => Program::of_profile(profile, &Options::default())?.path,
        };
        let several = profile.arguments.clone();
        // What only a dialogue needs makes some solvers slower.
        let needed = |argument: &String| !["--incremental", "--produce-models"].contains(&argument.as_str());
        let single = || several.iter().filter(|argument| needed(argument)).cloned().collect();
        Ok(Some(Standalone {
            version: version::ask(&program, &profile.version),
            program,
            single: profile.one_shot.clone().unwrap_or_else(single),
            several,
            seed: profile.seed.clone(),
        }))
    }

    /// The solvers that can be named and are there, the embedded one, as it comes, first.
    #[must_use]
    pub fn installed(&self) -> Vec<Spec> {
        let external = self.profiles().iter().filter(|profile| locate(profile).0.is_some());
        let external = external.map(|profile| match &profile.origin {
            Some(_) => Spec::Configured(profile.clone()),
            None => Spec::Profile(profile.name.clone()),
        });
        std::iter::once(Spec::Builtin).chain(external).collect()
    }
}
