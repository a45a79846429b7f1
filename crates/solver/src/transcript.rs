//! Keeps what solvers are asked, as files that can be replayed, and what they replied, as comments in these.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use hyperplan_outlet::create;
use hyperplan_smt::{Status, write_comment};

use crate::error::Error;

/// The file of one process. It grows while the process works, so that whoever ends us sees what was asked.
pub(crate) struct Transcript {
    path: PathBuf,
    file: BufWriter<File>,
    /// Why nothing more can be kept.
    failed: Option<io::Error>,
}

impl Transcript {
    /// A new file in the directory.
    pub(crate) fn create(
        directory: &Path,
        solver: &str,
        status: Option<Status>,
    ) -> Result<Transcript, Error> {
        let (path, file) = numbered(directory, solver).map_err(|source| cannot_keep(directory, source))?;
        let mut transcript = Transcript { path, file: BufWriter::new(file), failed: None };
        if let Some(status) = status {
            transcript.keep(format!("(set-info :status {})\n", status.text()).as_bytes());
        }
        Ok(transcript)
    }

    /// Keeps a piece. [`Transcript::flush`] tells if that fails.
    pub(crate) fn keep(&mut self, text: &[u8]) {
        let kept = self.file.write_all(text);
        self.failed = self.failed.take().or(kept.err());
    }

    /// Keeps what the solver said, after what it was told last.
    pub(crate) fn comment(&mut self, text: &str) {
        let kept = write_comment(&mut self.file, text);
        self.failed = self.failed.take().or(kept.err());
    }

    /// Brings what was kept to the file: whoever waits may be killed.
    pub(crate) fn flush(&mut self) -> Result<(), Error> {
        let kept = self.failed.take().map_or_else(|| self.file.flush(), Err);
        kept.map_err(|source| {
            // What has only a part of a query is none.
            let _ = fs::remove_file(&self.path);
            cannot_keep(self.path.parent().unwrap_or(Path::new("")), source)
        })
    }
}

impl Drop for Transcript {
    fn drop(&mut self) {
        self.keep(b"(exit)\n");
        // Without that line it can be replayed all the same.
        let _ = self.file.flush();
    }
}

/// What files for queries of a solver are called, in order.
fn names(prefix: &str, solver: &str, ending: &str) -> impl Iterator<Item = String> {
    let name: String = solver.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    (1..=999_999_u32).map(move |number| format!("{prefix}{number:04}-{name}.{ending}"))
}

/// A new file in a directory, which is made if need be: the first number that is free.
fn numbered(directory: &Path, solver: &str) -> io::Result<(PathBuf, File)> {
    fs::create_dir_all(directory)?;
    for name in names("", solver, "smt2") {
        let path = directory.join(name);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            result => return result.map(|file| (path, file)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

/// Keeps a query of a solver in a new file, whole or not at all, in a directory, which is made if need be. Its name has a
/// number, the first that is free.
///
/// # Errors
/// When it cannot be written, or printed.
pub fn keep_query(
    directory: &Path,
    prefix: &str,
    solver: &str,
    print: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<PathBuf> {
    keep_file(directory, prefix, solver, "smt2", print)
}

/// The same with another ending than that of SMT-LIB.
pub(crate) fn keep_file(
    directory: &Path,
    prefix: &str,
    solver: &str,
    ending: &str,
    print: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<PathBuf> {
    fs::create_dir_all(directory)?;
    create(directory, names(prefix, solver, ending), print)
}

pub(crate) fn cannot_keep(directory: &Path, source: io::Error) -> Error {
    Error::Keep { folder: directory.to_owned(), source }
}
