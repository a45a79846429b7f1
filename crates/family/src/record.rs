//! What became of each instance: a log that is written as the work goes on, and read when it is taken up again.

use crate::family::{Case, Horizon};
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// What all instances have in common; a log with another head belongs to another family.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head {
    /// The program that made the family, with its version.
    pub generator: String,
    /// The date of the family.
    pub date: String,
    /// Its name.
    pub family: String,
    /// Who submits it.
    pub submitter: String,
    /// The track.
    pub track: String,
}

/// What an instance is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// The name of its files.
    pub instance: String,
    /// The objective and the map.
    #[serde(flatten)]
    pub case: Case,
    /// The horizon, by its name.
    pub horizon: Horizon,
    /// The horizon, in steps.
    pub steps: u32,
    /// How states are written.
    pub states: String,
    /// How quantifiers are decided.
    pub quantifiers: String,
    /// What stands for what paths do.
    #[serde(default = "symbols", skip_serializing_if = "is_symbols")]
    pub paths: String,
    /// How much is left out.
    #[serde(default = "light")]
    pub pruning: String,
}

/// What there was before there was a choice.
fn light() -> String {
    "light".to_owned()
}

fn symbols() -> String {
    "symbols".to_owned()
}

fn is_symbols(paths: &str) -> bool {
    paths == "symbols"
}

/// A benchmark that was written.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Its path in the folder of the family.
    pub file: String,
    /// The SHA-256 of the file.
    pub sha256: String,
    /// The SHA-256 of what follows the header, which says what the file is rather than what it asks.
    pub body: String,
    /// How many bytes it has.
    pub bytes: u64,
    /// Its logic.
    pub logic: String,
    /// Its status: `sat`, `unsat` or `unknown`.
    pub status: String,
    /// Whether a certificate beside the file proves the status: there are some of `unsat` only.
    #[serde(default)]
    pub certified: bool,
    /// The path of the problem.
    pub problem: String,
    /// What it is about.
    #[serde(flatten)]
    pub about: About,
}

/// An instance that has no benchmark.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Dropped {
    /// The name that it would have.
    pub instance: String,
    /// Why it has none.
    pub reason: String,
}

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "record", rename_all = "lowercase")]
pub enum Record {
    /// The family.
    Head(Head),
    /// The least horizon of a case; none where no horizon is enough.
    Least {
        /// The case, by its name.
        case: String,
        /// The horizon.
        least: Option<u32>,
    },
    /// A benchmark was written.
    Written(Box<Entry>),
    /// An instance was dropped.
    Dropped(Dropped),
}

impl Record {
    /// The record as a line of the log, with its end.
    ///
    /// # Errors
    /// None: records are plain data.
    pub fn line(&self) -> Result<String, LogError> {
        let mut line = serde_json::to_string(self).map_err(|e| LogError::Line(0, e))?;
        line.push('\n');
        Ok(line)
    }
}

/// What was done so far.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Log {
    /// The records, without what was superseded; the head is not among them.
    pub records: Vec<Record>,
    /// The family, unless the log is empty.
    pub head: Option<Head>,
    /// How many bytes are whole lines. What follows was cut off.
    pub whole: usize,
}

/// Why a log cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// A line is not a record.
    #[error("line {0} is no record: {1}")]
    Line(usize, serde_json::Error),
    /// It does not begin with a head.
    #[error("it does not begin with what the family is")]
    Headless,
}

impl Log {
    /// Reads a log. A last line without end was being written when the work was interrupted, and does not count.
    ///
    /// # Errors
    /// If it is no log.
    pub fn read(text: &str) -> Result<Log, LogError> {
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        let mut log = Log { whole, ..Log::default() };
        for (number, line) in text[..whole].lines().enumerate() {
            match serde_json::from_str(line).map_err(|e| LogError::Line(number + 1, e))? {
                Record::Head(head) if number == 0 => log.head = Some(head),
                _ if number == 0 => return Err(LogError::Headless),
                record => log.records.push(record),
            }
        }
        Ok(log)
    }

    /// The least horizon of a case, if it was found.
    #[must_use]
    pub fn least(&self, case: &str) -> Option<Option<u32>> {
        self.records.iter().rev().find_map(|record| match record {
            Record::Least { case: other, least } if other == case => Some(*least),
            _ => None,
        })
    }
}

/// The SHA-256 of some bytes, in hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What a benchmark asks: all that follows the first declaration or assertion.
#[must_use]
pub fn body_of(text: &[u8]) -> &[u8] {
    let mut start = 0;
    for line in text.split_inclusive(|&byte| byte == b'\n') {
        if [&b"(decl"[..], b"(defi", b"(asse"].iter().any(|word| line.starts_with(word)) {
            break;
        }
        start += line.len();
    }
    &text[start..]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn head() -> Head {
        let text = |text: &str| text.to_owned();
        Head {
            generator: text("g"),
            date: text("d"),
            family: text("f"),
            submitter: text("s"),
            track: text("t"),
        }
    }

    #[test]
    fn a_log_is_read_as_it_was_written_but_for_what_was_cut_off() {
        let least = Record::Least { case: "sp-1".into(), least: Some(7) };
        let never = Record::Least { case: "ar-1".into(), least: None };
        let lines: String = [Record::Head(head()), least.clone(), never.clone()]
            .iter()
            .map(|record| record.line().expect("plain data"))
            .collect();
        let log = Log::read(&format!("{lines}{{\"record\":\"lea")).expect("a log");
        assert_eq!((log.head.as_ref(), &log.records[..]), (Some(&head()), &[least, never][..]));
        assert_eq!(log.whole, lines.len());
        assert_eq!(
            [log.least("sp-1"), log.least("ar-1"), log.least("sp")],
            [Some(Some(7)), Some(None), None]
        );
    }

    #[test]
    fn what_is_no_log_is_refused() {
        assert!(matches!(Log::read("hello\n"), Err(LogError::Line(1, _))));
        assert!(matches!(
            Log::read("{\"record\":\"least\",\"case\":\"a\",\"least\":1}\n"),
            Err(LogError::Headless)
        ));
        assert_eq!(Log::read("").expect("empty"), Log::default());
    }

    #[test]
    fn the_body_begins_with_the_first_declaration() {
        let text = b"(set-info :status sat)\n; hello\n(declare-fun x () Bool)\n(assert x)\n";
        assert_eq!(body_of(text), b"(declare-fun x () Bool)\n(assert x)\n");
        assert_eq!(body_of(b"(exit)\n"), b"");
        assert_eq!(sha256(b"abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
