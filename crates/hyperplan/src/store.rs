//! The folder of a family: its log, and files that are there whole or not at all.

use crate::failure::{Failure, Result};
use crate::files::{cannot_write, reason, write_bytes};
use crate::proof::{DESCRIPTION, REFUTATION};
use hyperplan_family::{Head, Log, Manifest, Record, sha256};
use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

/// The file that says what was done.
const LOG: &str = "log.jsonl";

/// A folder with what was done so far.
pub(crate) struct Store {
    folder: PathBuf,
    log: File,
    pub(crate) head: Head,
    pub(crate) past: Log,
}

impl Store {
    /// Opens a folder for a family, and makes it if there is none. A folder of another family is refused, and so is
    /// one that another process works on.
    pub(crate) fn open(folder: &Path, head: Head) -> Result<Self> {
        fs::create_dir_all(folder).map_err(|e| cannot_write(folder, &e))?;
        let path = folder.join(LOG);
        let foreign =
            !path.exists() && fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some());
        if foreign {
            return Err(Failure::input(format_args!(
                "{} has other files; a family needs a directory of its own",
                folder.display()
            )));
        }
        let mut log = OpenOptions::new()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&path)
            .map_err(|e| cannot_write(&path, &e))?;
        match log.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(Failure::input(format_args!(
                    "{} is being written by another run",
                    folder.display()
                )));
            }
            // Where files cannot be locked there is one run, one hopes.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let mut text = String::new();
        let cannot_read = |why: String| Failure::input(format_args!("cannot read {}: {why}", path.display()));
        log.read_to_string(&mut text).map_err(|e| cannot_read(e.to_string()))?;
        let past = Log::read(&text).map_err(|e| cannot_read(e.to_string()))?;
        if let Some(other) = past.head.as_ref().filter(|other| **other != head) {
            return Err(Failure::input(format_args!(
                "{} has another family: {}; use another directory",
                folder.display(),
                difference(other, &head)
            )));
        }
        // What was being written when an earlier run was killed.
        let whole = past.whole as u64;
        log.set_len(whole).and_then(|()| log.seek(SeekFrom::End(0))).map_err(|e| cannot_write(&path, &e))?;
        let new = past.head.is_none();
        let mut store = Store { folder: folder.to_owned(), log, head: head.clone(), past };
        if new {
            store.note(&Record::Head(head))?;
        }
        Ok(store)
    }

    /// What there is in the folder of a family, which stays as it is.
    pub(crate) fn look(folder: &Path) -> Result<Manifest> {
        let path = folder.join(LOG);
        let cannot_read = |why: String| Failure::input(format_args!("cannot read {}: {why}", path.display()));
        let text = fs::read_to_string(&path).map_err(|e| cannot_read(reason(&e)))?;
        let past = Log::read(&text).map_err(|e| cannot_read(e.to_string()))?;
        let head = past.head.ok_or_else(|| cannot_read("it has no family".to_owned()))?;
        Ok(Manifest::new(head, &past.records).0)
    }

    /// The date of the family that a folder has, if any: a run that goes on a day later is of the same family.
    pub(crate) fn date(folder: &Path) -> Option<String> {
        let text = fs::read_to_string(folder.join(LOG)).ok()?;
        Log::read(&text).ok()?.head.map(|head| head.date)
    }

    /// Adds a line to the log.
    pub(crate) fn note(&mut self, record: &Record) -> Result<()> {
        let line = record.line().map_err(|e| Failure::input(format_args!("{e}")))?;
        // In one piece, so that what is cut off is at most a line.
        self.log.write_all(line.as_bytes()).map_err(|e| cannot_write(&self.folder.join(LOG), &e))?;
        self.past.records.push(record.clone());
        Ok(())
    }

    /// The instances that need no more work: their benchmarks are there as they were written, with certificates if these are
    /// wanted, or were dropped.
    pub(crate) fn done(&self, certify: bool) -> BTreeSet<String> {
        let (manifest, _) = Manifest::new(self.head.clone(), &self.past.records);
        let intact = manifest.benchmarks.iter().filter(|entry| {
            if certify && entry.status == "unsat" && !entry.certified {
                return false;
            }
            let path = self.folder.join(&entry.file);
            fs::read(path).is_ok_and(|bytes| sha256(&bytes) == entry.sha256)
        });
        let dropped = manifest.dropped.into_iter().map(|dropped| dropped.instance);
        intact.map(|entry| entry.about.instance.clone()).chain(dropped).collect()
    }

    /// Writes the manifest, and removes files that are like others.
    pub(crate) fn finish(&self) -> Result<Manifest> {
        let (manifest, alike) = Manifest::new(self.head.clone(), &self.past.records);
        for file in alike {
            let file = self.folder.join(file);
            // They may be gone since an earlier run.
            for file in [file.clone(), file.with_extension(DESCRIPTION), file.with_extension(REFUTATION)] {
                let _ = fs::remove_file(file);
            }
        }
        let json = manifest.json().map_err(|e| Failure::input(format_args!("{e}")))?;
        let csv = manifest.csv().map_err(|e| Failure::input(format_args!("{e}")))?;
        write_whole(&self.folder, "manifest.json", json.as_bytes())?;
        write_whole(&self.folder, "manifest.csv", &csv)?;
        Ok(manifest)
    }
}

/// Writes a file of a folder, whole or not at all.
pub(crate) fn write_whole(folder: &Path, file: &str, contents: &[u8]) -> Result<()> {
    let path = folder.join(file);
    let parent = path.parent().unwrap_or(folder);
    fs::create_dir_all(parent).map_err(|e| cannot_write(parent, &e))?;
    write_bytes(&path, contents)
}

/// What is not the same of two families.
fn difference(old: &Head, new: &Head) -> String {
    let parts = [
        ("generator", &old.generator, &new.generator),
        ("date", &old.date, &new.date),
        ("name", &old.family, &new.family),
        ("submitter", &old.submitter, &new.submitter),
        ("track", &old.track, &new.track),
    ];
    let different = parts.iter().filter(|(_, old, new)| old != new);
    let words: Vec<String> =
        different.map(|(name, old, new)| format!("its {name} is {old}, not {new}")).collect();
    words.join(", ")
}
