//! What a program says its version is: found out once for each program, in the dialogue if it tells it there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use super::process::{Next, Process};
use crate::deadline::Deadline;

/// How long a program may take to say its version.
const PATIENCE: Duration = Duration::from_secs(2);
/// How long an answer waits for it.
const WAIT: Duration = Duration::from_millis(500);

type Key = (PathBuf, Vec<String>);

/// The versions that were asked for or will be.
static ASKED: Mutex<BTreeMap<Key, Arc<OnceLock<String>>>> = Mutex::new(BTreeMap::new());

/// The version of a program, once it is known; empty if the program does not say it.
#[derive(Clone)]
pub(super) struct Version {
    key: Key,
    known: Arc<OnceLock<String>>,
}

impl Version {
    /// No version.
    pub(super) fn none() -> Version {
        Version { key: Key::default(), known: Arc::new(OnceLock::from(String::new())) }
    }

    /// The version of a program that says it when it is given those arguments. Nothing is started yet.
    pub(super) fn of(program: &Path, arguments: &[String]) -> Version {
        let key = (program.to_owned(), arguments.to_vec());
        let mut asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
        let known = Arc::clone(asked.entry(key.clone()).or_default());
        Version { key, known }
    }

    pub(super) fn is_known(&self) -> bool {
        self.known.get().is_some()
    }

    /// What the program said in a dialogue.
    pub(super) fn learn(&self, reply: &str) {
        if let Some(version) = reply.split_whitespace().find_map(number) {
            // What was known before stays.
            let _ = self.known.set(version.to_owned());
        }
    }

    /// The version. If it is not known, the program is asked, and may take a moment to answer.
    pub(super) fn get(&self) -> String {
        if let Some(version) = self.known.get() {
            return version.clone();
        }
        let (send, receive) = mpsc::channel();
        let (key, known) = (self.key.clone(), Arc::clone(&self.known));
        let ask = move || {
            let version = known.get_or_init(|| ask(&key.0, &key.1).unwrap_or_default());
            // Nobody may be waiting any more.
            let _ = send.send(version.clone());
        };
        match thread::Builder::new().name("solver version".into()).spawn(ask) {
            Ok(_) => receive.recv_timeout(WAIT).unwrap_or_default(),
            Err(_) => String::new(),
        }
    }
}

/// The version number in what the program says, on either stream, if it answers in time. Without arguments it is not asked.
pub(super) fn ask(program: &Path, arguments: &[String]) -> Option<String> {
    if arguments.is_empty() {
        return None;
    }
    let mut process = Process::spawn(program, arguments, None).ok()?;
    process.close_input();
    let deadline = Deadline::after(PATIENCE);
    while let Next::Reply(reply) = process.next(&deadline) {
        let found = reply.text().split_whitespace().find_map(number);
        if found.is_some() {
            return found.map(str::to_owned);
        }
    }
    process.kill();
    process.last_errors().split_whitespace().find_map(number).map(str::to_owned)
}

/// A word that looks like a version: digits with a dot.
fn number(word: &str) -> Option<&str> {
    let word = word.trim_matches(|c: char| !c.is_ascii_alphanumeric()).trim_start_matches(['v', '.']);
    let fits = word.starts_with(|c: char| c.is_ascii_digit()) && word.contains('.');
    fits.then_some(word)
}
