//! Runs the command as a user does. Not every test file needs all of it.

#![allow(dead_code, reason = "each test file is a crate of its own")]

#[cfg(unix)]
pub(crate) mod fakes;

pub(crate) mod compare;

use std::io::{Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// What a run of the command left.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    pub(crate) fn new(output: Output) -> Run {
        Run {
            status: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).expect("output is UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("messages are UTF-8"),
        }
    }

    /// The objects on standard output, one a line.
    pub(crate) fn json(&self) -> Vec<serde_json::Value> {
        let parse = |line| serde_json::from_str(line).expect("each line is a JSON object");
        self.stdout.lines().map(parse).collect()
    }
}

/// A command in the folder of the specs, of a user who has configured nothing.
pub(crate) fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyperplan"));
    command.current_dir(specs()).args(arguments).stdin(Stdio::null()).env_remove("NO_COLOR");
    command.env("XDG_CONFIG_HOME", concat!(env!("CARGO_TARGET_TMPDIR"), "/no-configuration"));
    command
}

/// Runs the command in the folder of the specs.
pub(crate) fn hyperplan(arguments: &[&str]) -> Run {
    Run::new(command(arguments).output().expect("the command was built for this test"))
}

/// As [`hyperplan`], with a text on standard input.
pub(crate) fn hyperplan_with(arguments: &[&str], input: &str) -> Run {
    let mut file = tempfile::tempfile().expect("a temporary file");
    file.write_all(input.as_bytes()).and_then(|()| file.rewind()).expect("writable");
    Run::new(command(arguments).stdin(file).output().expect("the command was built for this test"))
}

/// The folder of the specs.
pub(crate) fn specs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs")
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> &str {
    path.to_str().expect("temporary folders have plain names")
}

/// Whether the solver is installed; a test without its solver says so, or fails where solvers are required.
pub(crate) fn solver_is_there(name: &str) -> bool {
    let found = hyperplan(&["solvers", "--format", "json"]).json();
    let there = found.iter().any(|solver| solver["name"] == name && solver["path"].is_string());
    if !there {
        assert!(std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "{name} is required");
        let _ = writeln!(std::io::stderr(), "{name} is missing: skipped");
    }
    there
}
