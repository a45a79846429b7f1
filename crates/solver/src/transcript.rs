//! Keeps what solvers are asked, as files that can be replayed, and what they replied, as comments in these.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use hyperplan_smt::{Status, write_comment};

use crate::error::Error;

/// The file of one process.
pub(crate) struct Transcript {
    file: BufWriter<File>,
}

impl Transcript {
    /// A new file in the directory.
    pub(crate) fn create(
        directory: &Path,
        solver: &str,
        status: Option<Status>,
    ) -> Result<Transcript, Error> {
        let file = numbered(directory, solver)?;
        let mut transcript = Transcript { file: BufWriter::new(file) };
        if let Some(status) = status {
            transcript.keep(format!("(set-info :status {})\n", status.text()).as_bytes());
        }
        Ok(transcript)
    }

    /// Keeps a piece. A full disk must not stop the search: failures are ignored.
    pub(crate) fn keep(&mut self, text: &[u8]) {
        let _ = self.file.write_all(text);
    }

    /// Brings what was kept to the file: whoever waits may be killed.
    pub(crate) fn flush(&mut self) {
        let _ = self.file.flush();
    }

    /// Keeps what the solver said, after what it was told last.
    pub(crate) fn comment(&mut self, text: &str) {
        let _ = write_comment(&mut self.file, text);
    }
}

impl Drop for Transcript {
    fn drop(&mut self) {
        self.keep(b"(exit)\n");
        self.flush();
    }
}

/// A new file for a query, in the directory, which is made if need be: the first number that is free.
pub(crate) fn numbered(directory: &Path, solver: &str) -> Result<File, Error> {
    let created = new_query_file(directory, "", solver);
    created.map(|(_, file)| file).map_err(|source| cannot_keep(directory, source))
}

/// A new file for a query of a solver, in a directory, which is made if need be. Its name has a number, the first that is
/// free.
///
/// # Errors
/// When it cannot be made.
pub fn new_query_file(directory: &Path, prefix: &str, solver: &str) -> io::Result<(PathBuf, File)> {
    fs::create_dir_all(directory)?;
    let name: String = solver.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    for number in 1..=999_999_u32 {
        let path = directory.join(format!("{prefix}{number:04}-{name}.smt2"));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            result => return result.map(|file| (path, file)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

pub(crate) fn cannot_keep(directory: &Path, source: io::Error) -> Error {
    Error::Io { what: format!("cannot keep queries in {}", directory.display()), source }
}
