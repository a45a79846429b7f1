//! What a program says its version is: found out beside the dialogue, once for each program.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::process::{Next, Process};
use crate::deadline::Deadline;

/// How long a program may take to say its version.
const PATIENCE: Duration = Duration::from_secs(2);
/// How long an answer waits for it.
const WAIT: Duration = Duration::from_millis(500);

type Key = (PathBuf, Vec<String>);

/// The versions that were asked for.
static ASKED: Mutex<BTreeMap<Key, Arc<OnceLock<String>>>> = Mutex::new(BTreeMap::new());

/// A version that is being found out; empty if the program does not say it.
#[derive(Clone)]
pub(super) struct Version(Arc<OnceLock<String>>);

impl Version {
    /// No version.
    pub(super) fn none() -> Version {
        Version(Arc::new(OnceLock::from(String::new())))
    }

    /// Begins to find out the version of a program, unless that was begun before.
    pub(super) fn begin(program: &Path, arguments: &[String]) -> Version {
        let key = (program.to_owned(), arguments.to_vec());
        let mut asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(version) = asked.get(&key) {
            return Version(Arc::clone(version));
        }
        let version = Version(Arc::default());
        asked.insert(key.clone(), Arc::clone(&version.0));
        let cell = Arc::clone(&version.0);
        let ask = move || cell.set(ask(&key.0, &key.1).unwrap_or_default());
        if thread::Builder::new().name("solver version".into()).spawn(ask).is_err() {
            return Version::none();
        }
        version
    }

    /// The version, if it comes soon.
    pub(super) fn get(&self) -> String {
        let end = Instant::now() + WAIT;
        loop {
            if let Some(version) = self.0.get() {
                return version.clone();
            }
            if Instant::now() >= end {
                return String::new();
            }
            thread::sleep(Duration::from_millis(2));
        }
    }
}

/// The version number in what the program says, if it answers in time.
pub(super) fn ask(program: &Path, arguments: &[String]) -> Option<String> {
    let mut process = Process::spawn(program, arguments, None).ok()?;
    process.close_input();
    let deadline = Deadline::after(PATIENCE);
    while let Next::Reply(reply) = process.next(&deadline) {
        let found = reply.text().split_whitespace().find_map(number);
        if found.is_some() {
            return found.map(str::to_owned);
        }
    }
    None
}

/// A word that looks like a version: digits with a dot.
fn number(word: &str) -> Option<&str> {
    let word = word.trim_matches(|c: char| !c.is_ascii_alphanumeric()).trim_start_matches('v');
    let fits = word.starts_with(|c: char| c.is_ascii_digit()) && word.contains('.');
    fits.then_some(word)
}
