//! The log of a comparison: a line of JSON for each finished run.
//!
//! A line is written with one call as soon as its run has ended, so that a comparison that is killed loses no more than
//! the runs that were going on. What a kill or a full disk left of a last line is cut off when the log is opened again;
//! its run is done again like one that never was. One comparison at a time has the log to itself.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::packed::unpacked;
use crate::record::Record;

/// Why a log cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// Reading or writing failed.
    #[error("cannot {what} {}: {source}", path.display())]
    Io {
        /// What was tried.
        what: &'static str,
        /// The file.
        path: PathBuf,
        /// Why it failed.
        source: io::Error,
    },
    /// Somebody else is writing it.
    #[error("{} is in use by another comparison: wait for it, or choose another folder", path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
}

/// A log that is open for writing, and ours alone.
#[derive(Debug)]
pub struct Log {
    file: File,
    path: PathBuf,
}

/// What was in a log when it was opened.
#[derive(Debug, Default)]
pub struct Past {
    /// The runs, in the order in which they ended.
    pub records: Vec<Record>,
    /// What was wrong with the file, in words.
    pub notes: Vec<String>,
}

/// Locks the file. A process that is just being started by us has its descriptors for a moment, and with them an older
/// lock: a short wait tells that from another comparison.
fn lock(file: &File) -> Result<(), TryLockError> {
    for _ in 0..20 {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(10)),
            other => return other,
        }
    }
    file.try_lock()
}

impl Log {
    /// Opens the log, which is made if there is none, and reads what is in it.
    ///
    /// # Errors
    /// When it cannot be read or written, or another process has it.
    pub fn open(path: &Path) -> Result<(Log, Past), LogError> {
        let failed = |what| move |source| LogError::Io { what, path: path.to_owned(), source };
        let options = OpenOptions::new().read(true).append(true).create(true).open(path);
        let mut file = options.map_err(failed("write"))?;
        match lock(&file) {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(LogError::InUse { path: path.to_owned() }),
            // A file system without locks: nothing can be known of others.
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(failed("lock")(error)),
        }
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed("read"))?;
        let (past, whole) = read(path, &bytes);
        if whole < bytes.len() {
            file.set_len(whole as u64).map_err(failed("write"))?;
            file.seek(SeekFrom::End(0)).map_err(failed("write"))?;
        } else if bytes.last().is_some_and(|last| *last != b'\n') {
            // All of the line but its end.
            file.write_all(b"\n").map_err(failed("write"))?;
        }
        Ok((Log { file, path: path.to_owned() }, past))
    }

    /// Reads what is in a log, which may be compressed (`.gz`), and which somebody may be writing: nothing is locked, and
    /// nothing changed.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn look(path: &Path) -> Result<Past, LogError> {
        let failed = |source| LogError::Io { what: "read", path: path.to_owned(), source };
        let bytes = std::fs::read(path).map_err(failed)?;
        Ok(read(path, &unpacked(path, &bytes).map_err(failed)?).0)
    }

    /// Writes a run.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn append(&mut self, record: &Record) -> Result<(), LogError> {
        self.extend(std::slice::from_ref(record))
    }

    /// Writes many runs, which takes hardly longer than one.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn extend(&mut self, records: &[Record]) -> Result<(), LogError> {
        let failed = |source| LogError::Io { what: "write", path: self.path.clone(), source };
        let mut to = BufWriter::new(&self.file);
        for record in records {
            let mut line = serde_json::to_vec(record).map_err(|error| failed(error.into()))?;
            line.push(b'\n');
            to.write_all(&line).map_err(failed)?;
        }
        to.flush().map_err(failed)?;
        drop(to);
        // Against a loss of power. Not every file system can, and a killed process loses nothing anyway.
        let _ = self.file.sync_data();
        Ok(())
    }
}

/// The runs, and how many bytes are to be kept.
fn read(path: &Path, bytes: &[u8]) -> (Past, usize) {
    let mut past = Past::default();
    let mut whole = 0;
    for (index, line) in bytes.split_inclusive(|byte| *byte == b'\n').enumerate() {
        let place = || format!("{}:{}", path.display(), index + 1);
        match serde_json::from_slice::<Record>(line) {
            Ok(record) => past.records.push(record),
            Err(_) if line.trim_ascii().is_empty() => {}
            Err(_) if !line.ends_with(b"\n") => {
                past.notes.push(format!("{}: the line is incomplete; its run is done again", place()));
                break;
            }
            Err(error) => past.notes.push(format!("{}: not a run, passed over: {error}", place())),
        }
        whole += line.len();
    }
    (past, whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::record;

    fn open(path: &Path) -> (Log, Past) {
        Log::open(path).expect("the folder is ours")
    }

    #[test]
    fn what_was_written_is_read() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("runs.jsonl");
        let (mut log, past) = open(&path);
        assert!(past.records.is_empty() && past.notes.is_empty());
        for key in ["a", "b"] {
            log.append(&record(key)).expect("it can be written");
        }
        drop(log);
        let (_, past) = open(&path);
        assert_eq!(past.records, [record("a"), record("b")]);
    }

    #[test]
    fn a_log_may_be_compressed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("runs.jsonl");
        let (mut log, _) = open(&path);
        log.extend(&[record("a"), record("b")]).expect("it can be written");
        let packed = folder.path().join("runs.jsonl.gz");
        let mut to = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        to.write_all(&std::fs::read(&path).expect("it was written")).expect("it is memory");
        let bytes = to.finish().expect("it is memory");
        std::fs::write(&packed, &bytes).expect("the folder is ours");
        let past = Log::look(&packed).expect("it can be read");
        assert_eq!((past.records, past.notes.len()), (vec![record("a"), record("b")], 0));
        // What is cut off is no log any more, since nothing says how much is missing.
        std::fs::write(&packed, &bytes[..bytes.len() - 9]).expect("the folder is ours");
        assert!(Log::look(&packed).is_err());
    }

    #[test]
    fn a_line_may_be_torn_anywhere() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("runs.jsonl");
        let (mut log, _) = open(&path);
        log.append(&record("a")).expect("it can be written");
        log.append(&record("b")).expect("it can be written");
        drop(log);
        let bytes = std::fs::read(&path).expect("it was written");
        let first = bytes.iter().position(|byte| *byte == b'\n').expect("there are lines") + 1;
        for end in first..=bytes.len() {
            std::fs::write(&path, &bytes[..end]).expect("the folder is ours");
            let (mut log, past) = open(&path);
            // Without its end only, the line is whole.
            let whole = usize::from(end + 1 >= bytes.len());
            assert_eq!(past.records.len(), 1 + whole, "{end}");
            assert_eq!(past.notes.len(), usize::from(end > first) - whole, "{end}");
            log.append(&record("c")).expect("it can be written");
            drop(log);
            let (_, past) = open(&path);
            assert_eq!(past.records.last(), Some(&record("c")), "{end}");
            assert_eq!((past.records.len(), past.notes.len()), (2 + whole, 0), "{end}");
        }
    }

    #[test]
    fn other_lines_are_passed_over() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("runs.jsonl");
        let line = serde_json::to_string(&record("a")).expect("it is JSON");
        std::fs::write(&path, format!("{{}}\n\n{line}\n\u{0}\n")).expect("the folder is ours");
        let (_, past) = open(&path);
        assert_eq!(past.records, [record("a")]);
        assert_eq!(past.notes.len(), 2, "{:?}", past.notes);
        assert!(past.notes[0].contains("runs.jsonl:1: not a run"), "{}", past.notes[0]);
    }

    #[test]
    fn a_log_has_one_writer() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("runs.jsonl");
        let (_log, _) = open(&path);
        assert!(matches!(Log::open(&path), Err(LogError::InUse { .. })));
    }
}
