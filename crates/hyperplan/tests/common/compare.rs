//! A comparison in a folder of its own.

use super::{Run, command, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

pub(crate) struct Comparison {
    folder: TempDir,
}

impl Comparison {
    pub(crate) fn new() -> Comparison {
        Comparison { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Where its log and reports are.
    pub(crate) fn out(&self) -> PathBuf {
        self.folder().join("out")
    }

    /// A folder with so many small queries.
    pub(crate) fn queries(&self, count: usize) -> PathBuf {
        let folder = self.folder().join("queries");
        fs::create_dir_all(&folder).expect("the folder is ours");
        for index in 0..count {
            let text = format!("(declare-const x{index} Bool)\n(assert x{index})\n(check-sat)\n");
            fs::write(folder.join(format!("{index}.smt2")), text).expect("the folder is ours");
        }
        folder
    }

    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let out = self.out();
        command(&[&["compare", "--out", text(&out)], arguments].concat())
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        Run::new(self.command(arguments).output().expect("the command was built for this test"))
    }

    pub(crate) fn log(&self) -> String {
        fs::read_to_string(self.out().join("runs.jsonl")).unwrap_or_default()
    }

    /// The finished runs.
    pub(crate) fn records(&self) -> Vec<serde_json::Value> {
        let parse = |line| serde_json::from_str(line).expect("each line is a run");
        self.log().lines().map(parse).collect()
    }
}
