//! Which solvers this machine has.

use std::path::PathBuf;
use std::sync::Arc;
use std::thread;

use super::catalog::{Catalog, profiles};
use super::probe::{self, Ability};
use super::profile::{Install, Profile, Theory};
use super::program::locate;
use super::version;
use crate::embedded;

/// A solver, found or not.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Found {
    /// What it is called here.
    pub name: String,
    /// Where it is; `None` if it was not found.
    pub path: Option<PathBuf>,
    /// Its version, if it says one.
    pub version: Option<String>,
    /// Where it was sought.
    pub tried: Vec<String>,
    /// What it can do, found out by asking it.
    pub abilities: Vec<String>,
    /// What it did when it was asked, where that was wrong.
    pub faults: Vec<String>,
    /// How to install it.
    pub hint: String,
    /// The same, for each kind of system.
    pub install: Install,
    /// The configuration file that describes it.
    pub origin: Option<PathBuf>,
    /// It is part of hyperplan.
    pub is_embedded: bool,
}

/// Every solver that hyperplan knows without configuration, as [`Catalog::discover`].
#[must_use]
pub fn discover() -> Vec<Found> {
    Catalog::default().discover()
}

impl Catalog {
    /// Every solver that can be named, the embedded ones first, in a fixed order. What each can do is found out by
    /// asking small questions, which takes a moment.
    #[must_use]
    pub fn discover(&self) -> Vec<Found> {
        let external = thread::scope(|scope| {
            // One that does not answer keeps nobody else waiting.
            let asked: Vec<_> =
                self.profiles().iter().map(|profile| scope.spawn(|| found(profile))).collect();
            // A thread that panicked is one solver less.
            asked.into_iter().filter_map(|found| found.join().ok()).collect::<Vec<_>>()
        });
        embedded::names().filter_map(embedded).chain(external).collect()
    }
}

fn found(profile: &Arc<Profile>) -> Found {
    let (path, tried) = locate(profile);
    let version = path.as_deref().and_then(|path| version::ask(path, &profile.version));
    let abilities = path.as_deref().map(|path| probe::abilities(profile, path)).unwrap_or_default();
    let able = |(name, ability): &(&str, Ability)| (*ability == Ability::Able).then(|| (*name).to_owned());
    let faulty = |(name, ability): &(&str, Ability)| match ability {
        Ability::Wrong(what) => Some(format!("{name}: {what}")),
        Ability::Able | Ability::Unable => None,
    };
    Found {
        name: profile.name.clone(),
        version,
        path,
        tried,
        abilities: abilities.iter().filter_map(able).collect(),
        faults: abilities.iter().filter_map(faulty).collect(),
        hint: profile.install.to_string(),
        install: profile.install.clone(),
        origin: profile.origin.clone(),
        is_embedded: false,
    }
}

/// The name of the first solver found that knows integers and reals.
pub(crate) fn for_arithmetic() -> Option<&'static str> {
    let able = |profile: &Profile| profile.takes(Theory::Integers) && profile.takes(Theory::Reals);
    let mut able = profiles().iter().filter(|profile| able(profile));
    able.find(|profile| locate(profile).0.is_some()).map(|profile| profile.name.as_str())
}

/// The embedded engine, by one of its names.
fn embedded(name: &'static str) -> Option<Found> {
    let (path, version, abilities, hint) = match embedded::backend(name)? {
        Ok(built) => {
            let abilities = ["bit-vectors", "incremental"].map(str::to_owned).to_vec();
            (std::env::current_exe().ok(), Some(built.version()), abilities, "part of hyperplan".to_owned())
        }
        Err(missing) => (None, None, Vec::new(), missing.to_string()),
    };
    Some(Found {
        name: name.to_owned(),
        path,
        version,
        abilities,
        hint,
        is_embedded: true,
        ..Found::default()
    })
}
