//! Solvers that misbehave, written as shell scripts.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Replies to every `get-value` with false for each symbol.
pub(crate) const FALSE: &str = r#"*get-value*) echo "$line" | sed 's/(get-value (//; s/))//' |
  awk '{printf "("; for (i = 1; i <= NF; i++) printf "(%s false)", $i; print ")"}' ;;"#;

/// A folder with a fake solver, and an empty folder for temporary files.
pub(crate) struct Fake {
    folder: TempDir,
}

impl Fake {
    /// The script notes its process, and may note others with `note PID`.
    pub(crate) fn new(body: &str) -> Fake {
        Fake::called("fake", body)
    }

    pub(crate) fn called(name: &str, body: &str) -> Fake {
        let fake = Fake { folder: tempfile::tempdir().expect("a temporary folder") };
        fs::create_dir(fake.temporary()).expect("the folder is ours");
        let pids = fake.folder.path().join("pids");
        let script = format!("#!/bin/sh\nnote() {{ echo $1 >> '{}'; }}\nnote $$\n{body}\n", pids.display());
        let path = fake.folder.path().join(name);
        fs::write(&path, script).expect("the folder is ours");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("the file is ours");
        fake
    }

    /// A script that replies to each line, by the cases of a `case`.
    pub(crate) fn replying(cases: &str) -> Fake {
        Fake::new(&format!("while read -r line; do case $line in {cases} esac; done"))
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn program(&self) -> PathBuf {
        let files = fs::read_dir(self.folder()).expect("the folder is ours").flatten();
        let program = |path: &PathBuf| path.is_file() && !path.ends_with("pids");
        files.map(|file| file.path()).find(program).expect("it was written")
    }

    pub(crate) fn temporary(&self) -> PathBuf {
        self.folder().join("tmp")
    }

    /// How many processes have begun.
    pub(crate) fn begun(&self) -> usize {
        self.pids().len()
    }

    fn pids(&self) -> Vec<String> {
        let text = fs::read_to_string(self.folder().join("pids")).unwrap_or_default();
        text.split_whitespace().map(str::to_owned).collect()
    }

    /// Whether nothing is left: no process, no zombie, no temporary file. The kernel may take a moment.
    pub(crate) fn is_clean(&self) -> Result<(), String> {
        let end = Instant::now() + Duration::from_secs(10);
        loop {
            let left: Vec<String> = self.pids().into_iter().filter(|pid| exists(pid)).collect();
            let files: Vec<PathBuf> =
                fs::read_dir(self.temporary()).expect("ours").flatten().map(|file| file.path()).collect();
            if left.is_empty() && files.is_empty() {
                return Ok(());
            }
            if Instant::now() >= end {
                return Err(format!("processes {left:?} and files {files:?} are left"));
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

/// Whether there is such a process. What nobody waits for any more is a matter of the system's first process.
fn exists(pid: &str) -> bool {
    let output =
        Command::new("ps").args(["-o", "stat=,ppid=", "-p", pid]).output().expect("every Unix has ps");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    match text.split_whitespace().collect::<Vec<_>>().as_slice() {
        [stat, parent] => !(stat.starts_with('Z') && *parent == "1"),
        _ => false,
    }
}
