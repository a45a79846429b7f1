//! What others have done of a comparison, gathered from their logs into that of the folder, while they write.

use super::doing::keys;
use super::{LOG, shard};
use crate::failure::{Failure, Result};
use hyperplan_compare::plan::Run;
use hyperplan_compare::{Log, Record};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

/// What a record is told from others by.
type Identity = (String, String, Option<u64>);

pub(super) struct Gathered {
    folder: PathBuf,
    /// Whether records come with what tasks print.
    printed: bool,
    log: Log,
    records: Vec<Record>,
    known: BTreeSet<Identity>,
    /// How far each file was read.
    read: BTreeMap<PathBuf, u64>,
}

impl Gathered {
    pub(super) fn new(folder: &Path, printed: bool, log: Log, records: Vec<Record>) -> Gathered {
        let known = records.iter().map(identity).collect();
        Gathered { folder: folder.to_owned(), printed, log, records, known, read: BTreeMap::new() }
    }

    /// All records that there are.
    pub(super) fn records(&self) -> &[Record] {
        &self.records
    }

    /// Those of the runs of which nothing is known.
    pub(super) fn missing(&self, runs: &[Run]) -> Vec<Run> {
        let done = keys(&self.records);
        runs.iter().filter(|run| !done.contains(&run.key)).cloned().collect()
    }

    /// The records about some runs.
    pub(super) fn about(&self, runs: &[Run]) -> Vec<Record> {
        let wanted: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
        self.records.iter().filter(|record| wanted.contains(record.key.as_str())).cloned().collect()
    }

    /// Gathers what is new, and tells of each. A line that is not whole yet is read the next time; lines that are no runs
    /// are none: what is printed has others.
    pub(super) fn all(&mut self, tell: &mut impl FnMut(&Record)) -> Result<()> {
        let files = match self.printed {
            true => outputs(&self.folder)?,
            false => shard::logs(&self.folder)?,
        };
        for file in files.into_iter().filter(|file| !file.ends_with(LOG)) {
            let from = self.read.get(&file).copied().unwrap_or(0);
            let Ok(bytes) = rest(&file, from) else { continue };
            let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            for line in bytes[..whole].split(|byte| *byte == b'\n') {
                let Ok(record) = serde_json::from_slice::<Record>(line) else { continue };
                if self.known.insert(identity(&record)) {
                    self.log.append(&record).map_err(Failure::input)?;
                    tell(&record);
                    self.records.push(record);
                }
            }
            self.read.insert(file, from + whole as u64);
        }
        Ok(())
    }
}

fn identity(record: &Record) -> Identity {
    (record.key.clone(), record.host.clone(), record.ended_ms)
}

fn rest(file: &Path, from: u64) -> std::io::Result<Vec<u8>> {
    let mut file = File::open(file)?;
    file.seek(SeekFrom::Start(from))?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// What tasks have printed, in order.
pub(super) fn outputs(folder: &Path) -> Result<Vec<PathBuf>> {
    let Ok(entries) = fs::read_dir(folder.join("slurm")) else { return Ok(Vec::new()) };
    let files = entries.flatten().map(|entry| entry.path());
    let mut files: Vec<PathBuf> = files.filter(|path| path.extension() == Some("out".as_ref())).collect();
    files.sort();
    Ok(files)
}
