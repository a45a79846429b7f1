//! The runs of a comparison as a file, for other machines: what was asked for, and a line for each run that comes of it.
//!
//! A machine that is to do some of the runs makes them anew, from its own files and solvers, and finds them in the list by
//! their keys. So nothing is run that is not what was listed: another version of a solver, or a file that has changed,
//! gives another key.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use hyperplan_outlet::one_line;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::plan::{Kind, Run};
use crate::record::Limit;

/// Changes where older programs would read it wrongly.
const FORMAT: u32 = 1;

/// A run of the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Listed {
    /// What tells it from all others, see [`Run::key`].
    pub key: String,
    /// The file, and for a problem file the objective.
    pub instance: String,
    /// The file.
    pub file: String,
    /// The objective, of a problem file.
    pub objective: Option<String>,
    /// The constants that are set.
    pub set: Vec<String>,
    /// Of the file's bytes, in hexadecimal.
    pub sha256: String,
    /// Of all other files that it reads.
    pub others: String,
    /// The solver, as it was asked for.
    pub solver: String,
    /// Its version, if it says one.
    pub version: Option<String>,
    /// How quantifiers are decided; `None` for a query, as with what follows.
    pub quantifiers: Option<String>,
    /// How states are written.
    pub states: Option<String>,
    /// The seed.
    pub seed: u64,
    /// Which of the repetitions.
    pub repetition: u32,
    /// The limits.
    pub limit: Limit,
    /// What it will probably take.
    pub seconds: f64,
}

impl Listed {
    /// A run of this machine.
    #[must_use]
    pub fn new(run: &Run, seconds: f64) -> Listed {
        let instance = &run.instance;
        Listed {
            key: run.key.clone(),
            instance: instance.name.clone(),
            file: instance.file.clone(),
            objective: match &instance.kind {
                Kind::Problem { objective } => Some(objective.clone()),
                Kind::Query(_) => None,
            },
            set: instance.set.clone(),
            sha256: instance.sha256.clone(),
            others: instance.others.clone(),
            solver: run.solver.name.clone(),
            version: run.solver.version.clone(),
            quantifiers: run.quantifiers.clone(),
            states: run.states.clone(),
            seed: run.seed,
            repetition: run.repetition,
            limit: run.limit,
            seconds,
        }
    }

    /// Why this machine has no such run, in words, from those that it has.
    #[must_use]
    pub fn why_not(&self, runs: &[Run]) -> String {
        let file = one_line(&self.file);
        let of_file: Vec<&Run> = runs.iter().filter(|run| run.instance.name == self.instance).collect();
        if of_file.iter().any(|run| run.instance.sha256 != self.sha256) {
            return format!("{file} is not what it was when the plan was written");
        }
        if of_file.iter().any(|run| run.instance.set == self.set && run.instance.others != self.others) {
            return format!("what {file} reads is not what it was when the plan was written");
        }
        let solver = of_file.iter().map(|run| &run.solver).find(|solver| solver.name == self.solver);
        let version =
            |version: &Option<String>| one_line(version.as_deref().unwrap_or("unknown")).into_owned();
        match solver {
            Some(solver) if solver.version != self.version => format!(
                "the version of {} here is {}, and was {} when the plan was written",
                one_line(&self.solver),
                version(&solver.version),
                version(&self.version)
            ),
            Some(_) => format!("{} or hyperplan is another program here", one_line(&self.solver)),
            None => format!("{file} has no such run here"),
        }
    }
}

#[derive(Serialize, Deserialize)]
struct Head<A> {
    /// The format of the file.
    hyperplan_plan: u32,
    asked: A,
}

/// Why a list cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ListError {
    /// Reading failed.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A line is not what it is to be.
    #[error("{}:{line}:{column}: {what}: {why}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What it should have been.
        what: &'static str,
        /// Why it is not.
        why: String,
    },
}

/// The text of a list.
///
/// # Errors
/// When what was asked for is no JSON.
pub fn write<A: Serialize>(asked: &A, runs: &[Listed]) -> serde_json::Result<String> {
    let mut text = serde_json::to_string(&Head { hyperplan_plan: FORMAT, asked })? + "\n";
    for run in runs {
        text += &serde_json::to_string(run)?;
        text.push('\n');
    }
    Ok(text)
}

/// What was asked for, and the runs, of a list's text.
///
/// # Errors
/// When the file cannot be read, or is no list.
pub fn read<A: DeserializeOwned>(path: &Path, text: &str) -> Result<(A, Vec<Listed>), ListError> {
    let wrong = |index: usize, what, error: &serde_json::Error| ListError::Line {
        path: path.to_owned(),
        line: index + 1,
        column: error.column().max(1),
        what,
        // Its place is that within the line.
        why: error.to_string().split(" at line ").next().unwrap_or_default().to_owned(),
    };
    let mut lines = text.lines().enumerate();
    let first = lines.next().map_or("", |(_, line)| line);
    let head = "not the plan of a comparison";
    let format: Head<serde_json::Value> =
        serde_json::from_str(first).map_err(|error| wrong(0, head, &error))?;
    if format.hyperplan_plan != FORMAT {
        let why = format!("its format is {}, and this is {FORMAT}", format.hyperplan_plan);
        let what = "a plan of another version of hyperplan";
        return Err(ListError::Line { path: path.to_owned(), line: 1, column: 1, what, why });
    }
    let asked = serde_json::from_value(format.asked).map_err(|error| wrong(0, head, &error))?;
    let (mut runs, mut keys) = (Vec::new(), BTreeSet::new());
    for (index, line) in lines {
        let run: Listed =
            serde_json::from_str(line).map_err(|error| wrong(index, "not a run of a plan", &error))?;
        if !keys.insert(run.key.clone()) {
            let (what, why) = ("not a run of a plan", "an earlier line is the same run".to_owned());
            return Err(ListError::Line { path: path.to_owned(), line: index + 1, column: 1, what, why });
        }
        runs.push(run);
    }
    Ok((asked, runs))
}
