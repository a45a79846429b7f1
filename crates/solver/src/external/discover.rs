//! Which solvers this machine has.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use super::profile::{Profile, profiles};

/// A solver, found or not.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Found {
    /// What it is called here.
    pub name: String,
    /// Where it is; `None` if it was not found.
    pub path: Option<PathBuf>,
    /// Its version, if it says one.
    pub version: Option<String>,
    /// Where it was sought.
    pub tried: Vec<String>,
    /// What it can do.
    pub abilities: Vec<String>,
    /// How to install it.
    pub hint: String,
}

/// Every solver that hyperplan knows, the embedded one first, in a fixed order.
#[must_use]
pub fn discover() -> Vec<Found> {
    let external = profiles().iter().map(|profile| {
        let (path, tried) = locate(profile);
        Found {
            name: profile.name.to_owned(),
            version: path.as_deref().and_then(version),
            path,
            tried,
            abilities: profile.all_abilities(),
            hint: profile.hint.to_owned(),
        }
    });
    builtin().into_iter().chain(external).collect()
}

/// The name of the first solver found that knows integers and reals.
pub(crate) fn for_arithmetic() -> Option<&'static str> {
    let able = |profile: &&Profile| ["integers", "reals"].iter().all(|a| profile.abilities.contains(a));
    profiles().iter().filter(able).find(|profile| locate(profile).0.is_some()).map(|profile| profile.name)
}

#[cfg(any(feature = "cadical", feature = "batsat"))]
fn builtin() -> Option<Found> {
    use crate::session::{Options, Session as _};
    let engine = crate::embedded::Engine::new(&Options::default()).ok()?;
    Some(Found {
        name: "builtin".to_owned(),
        path: env::current_exe().ok(),
        version: Some(engine.identity().version),
        tried: Vec::new(),
        abilities: ["bit-vectors", "incremental"].map(str::to_owned).to_vec(),
        hint: "part of hyperplan".to_owned(),
    })
}

#[cfg(not(any(feature = "cadical", feature = "batsat")))]
fn builtin() -> Option<Found> {
    None
}

/// Where the profile's program is, and where it was sought: the environment variable, else `PATH`.
pub(super) fn locate(profile: &Profile) -> (Option<PathBuf>, Vec<String>) {
    if let Some(path) = env::var_os(profile.variable).filter(|path| !path.is_empty()) {
        let path = PathBuf::from(path);
        let tried = vec![format!("{}={}", profile.variable, path.display())];
        return (is_program(&path).then_some(path), tried);
    }
    let (path, mut tried) = search(profile.program);
    tried.insert(0, format!("${}", profile.variable));
    (path, tried)
}

/// Where a program is: itself if it is a path, else in the directories of `PATH`.
pub(super) fn search(program: &str) -> (Option<PathBuf>, Vec<String>) {
    if program.contains('/') {
        let path = PathBuf::from(program);
        return (is_program(&path).then_some(path), vec![program.to_owned()]);
    }
    let directories = env::var_os("PATH").unwrap_or_default();
    let mut tried = Vec::new();
    for directory in env::split_paths(&directories) {
        let path = directory.join(program);
        if is_program(&path) {
            return (Some(path), tried);
        }
        tried.push(path.display().to_string());
    }
    (None, tried)
}

fn is_program(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt as _;
    path.metadata().is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}

/// The version number in what the program says to `--version`, if it answers within seconds.
pub(super) fn version(path: &Path) -> Option<String> {
    let mut command = Command::new(path);
    command.arg("--version").stdin(Stdio::null()).stderr(Stdio::null()).stdout(Stdio::piped());
    let mut child = command.spawn().ok()?;
    let mut stdout = child.stdout.take()?;
    let (send, receive) = mpsc::channel();
    std::thread::spawn(move || {
        let mut text = vec![0; 4096];
        let count = std::io::Read::read(&mut stdout, &mut text).unwrap_or(0);
        text.truncate(count);
        // The receiver may have stopped waiting.
        let _ = send.send(String::from_utf8_lossy(&text).into_owned());
    });
    let text = receive.recv_timeout(Duration::from_secs(5));
    // Whatever it is doing now, it is not needed any more.
    let _ = child.kill();
    let _ = child.wait();
    text.ok()?.split_whitespace().find_map(version_in).map(str::to_owned)
}

/// A word that looks like a version: digits with a dot.
fn version_in(word: &str) -> Option<&str> {
    let word = word.trim_matches(|c: char| !c.is_ascii_alphanumeric());
    let fits = word.starts_with(|c: char| c.is_ascii_digit()) && word.contains('.');
    fits.then_some(word)
}
