//! Slurm, through its commands: an array job, what has become of its tasks, and its end.
//!
//! Jobs are found by their names, which the caller makes from what they are about; so whoever comes later finds them too.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use hyperplan_outlet::one_line;

/// Why Slurm does not do what it is to do.
#[derive(Debug, thiserror::Error)]
pub enum SlurmError {
    /// A command cannot be run.
    #[error("cannot run {program}: {source}")]
    Start {
        /// The command.
        program: &'static str,
        /// Why.
        source: io::Error,
    },
    /// A command failed.
    #[error("{program} failed: {said}")]
    Failed {
        /// The command.
        program: &'static str,
        /// The last that it said.
        said: String,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// An array job.
#[derive(Clone, Debug)]
pub struct Order<'a> {
    /// What it is found by.
    pub name: &'a str,
    /// Where tasks begin.
    pub current: &'a Path,
    /// Where what tasks print goes; `%a` is the number of the task.
    pub output: &'a Path,
    /// How many tasks there are, numbered from 1.
    pub tasks: usize,
    /// The cores of each.
    pub cores: u16,
    /// The memory of each, in MiB; without it, what the cluster gives.
    pub memory_mib: Option<u64>,
    /// The time that each may take, in seconds.
    pub seconds: f64,
    /// Whether a task has its node for itself.
    pub exclusive: bool,
    /// Further options of the submission, which win over all of this.
    pub options: &'a [String],
    /// What a task does, as lines of shell.
    pub body: &'a str,
}

impl Order<'_> {
    /// The job as a script.
    #[must_use]
    pub fn script(&self) -> String {
        // Slurm counts minutes.
        let minutes = (self.seconds / 60.0).ceil().max(1.0);
        let mut lines = vec![
            format!("--job-name={}", self.name),
            format!("--array=1-{}", self.tasks),
            "--nodes=1".to_owned(),
            "--ntasks=1".to_owned(),
            format!("--cpus-per-task={}", self.cores),
            format!("--time={minutes}"),
            // Who watches submits anew what was lost, and no more than that.
            "--no-requeue".to_owned(),
            "--open-mode=append".to_owned(),
        ];
        lines.extend(self.memory_mib.map(|mib| format!("--mem={mib}M")));
        lines.extend(self.exclusive.then(|| "--exclusive".to_owned()));
        let directives: String = lines.iter().map(|line| format!("#SBATCH {line}\n")).collect();
        format!("#!/bin/sh\n{directives}{}", self.body)
    }

    /// Submits it, by a script that is written into a file; gives the number of the job.
    ///
    /// # Errors
    /// When it is refused, or the script cannot be written.
    pub fn submit(&self, script: &Path) -> Result<String, SlurmError> {
        let written = hyperplan_outlet::write(script, |to| to.write_all(self.script().as_bytes()));
        written.map_err(|source| SlurmError::Write { path: script.to_owned(), source })?;
        let mut command = Command::new("sbatch");
        // Paths are arguments: in a script they would have to be quoted.
        command.arg("--parsable").arg("--chdir").arg(self.current).arg("--output").arg(self.output);
        let said = heard("sbatch", command.args(self.options).arg(script))?;
        // With the name of the cluster behind it, where there are several.
        Ok(said.trim().split(';').next().unwrap_or_default().to_owned())
    }
}

/// A task that waits or runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Task {
    /// Its number.
    pub number: String,
    /// Its state, `PENDING` or `RUNNING` say.
    pub state: String,
    /// Why it waits.
    pub reason: String,
    /// Where it runs.
    pub node: String,
}

impl Task {
    /// Whether it waits for something that time alone does not bring.
    #[must_use]
    pub fn is_stuck(&self) -> bool {
        let patient = ["None", "Priority", "Resources", "BeginTime", "JobArrayTaskLimit", "Dependency"];
        self.state == "PENDING" && !patient.contains(&self.reason.as_str())
    }
}

/// The tasks of a job that have not ended, by its name.
///
/// # Errors
/// When Slurm does not answer.
pub fn tasks(name: &str) -> Result<Vec<Task>, SlurmError> {
    let mut command = Command::new("squeue");
    command.args(["--me", "--noheader", "--array", "--format=%K|%T|%r|%N", "--name", name]);
    let said = heard("squeue", &mut command)?;
    let task = |line: &str| {
        let mut parts = line.trim().split('|').map(str::to_owned);
        Some(Task { number: parts.next()?, state: parts.next()?, reason: parts.next()?, node: parts.next()? })
    };
    Ok(said.lines().filter_map(task).collect())
}

/// How tasks of a job ended that did not end well, in words, as far as Slurm remembers.
#[must_use]
pub fn failures(job: &str) -> Vec<String> {
    // Where there is no accounting Slurm knows what ended a short while ago.
    let mut accounting = Command::new("sacct");
    accounting.args([
        "--noheader",
        "--parsable2",
        "--allocations",
        "--format=JobID,State,NodeList",
        "--jobs",
        job,
    ]);
    let mut queue = Command::new("squeue");
    queue.args(["--noheader", "--array", "--states=all", "--format=%F_%K|%T|%N", "--jobs", job]);
    let said = match heard("sacct", &mut accounting) {
        Ok(said) if !said.trim().is_empty() => said,
        _ => heard("squeue", &mut queue).unwrap_or_default(),
    };
    ended_badly(&said)
}

/// The tasks that did not end well, of `sacct` or `squeue`: task, state and node.
fn ended_badly(said: &str) -> Vec<String> {
    let mut failures = Vec::new();
    for line in said.lines() {
        if let [task, state, node] = line.trim().split('|').collect::<Vec<_>>()[..]
            && !["COMPLETED", "RUNNING", "PENDING", "COMPLETING"].contains(&state)
        {
            let state = state.to_lowercase().replace('_', " ");
            failures.push(one_line(&format!("task {task} on {node}: {state}")).into_owned());
        }
    }
    failures
}

/// Cancels all jobs of that name.
///
/// # Errors
/// When Slurm does not answer.
pub fn cancel(name: &str) -> Result<(), SlurmError> {
    heard("scancel", Command::new("scancel").args(["--me", "--name", name])).map(|_| ())
}

/// A word as a shell reads it.
#[must_use]
pub fn quoted(word: &str) -> String {
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// What a command prints.
fn heard(program: &'static str, command: &mut Command) -> Result<String, SlurmError> {
    let output = command.stdin(Stdio::null()).output();
    let Output { status, stdout, stderr } = output.map_err(|source| SlurmError::Start { program, source })?;
    if status.success() {
        return Ok(String::from_utf8_lossy(&stdout).into_owned());
    }
    let said = String::from_utf8_lossy(&stderr).into_owned();
    let last = said.lines().rfind(|line| !line.trim().is_empty());
    let said = last.map_or_else(|| status.to_string(), |line| one_line(line.trim()).into_owned());
    Err(SlurmError::Failed { program, said })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_become_requests() {
        let order = Order {
            name: "a",
            current: Path::new("."),
            output: Path::new("out"),
            tasks: 7,
            cores: 2,
            memory_mib: Some(300),
            seconds: 121.0,
            exclusive: true,
            options: &[],
            body: "true\n",
        };
        let script = order.script();
        for line in ["--array=1-7", "--cpus-per-task=2", "--mem=300M", "--time=3", "--exclusive"] {
            assert!(script.contains(&format!("\n#SBATCH {line}\n")), "{line}: {script}");
        }
        let plain = Order { memory_mib: None, exclusive: false, ..order }.script();
        assert!(!plain.contains("--mem") && !plain.contains("--exclusive"), "{plain}");
        assert!(plain.starts_with("#!/bin/sh\n") && plain.ends_with("\ntrue\n"), "{plain}");
    }

    /// As Slurm 22.05 prints them, with accounting and without.
    #[test]
    fn what_ended_badly_is_told() {
        let accounting = "7_1|COMPLETED|node1\n7_2|NODE_FAIL|node2\n7_3|OUT_OF_MEMORY|node1\n7_[4-9]|PENDING|None assigned\n";
        assert_eq!(
            ended_badly(accounting),
            ["task 7_2 on node2: node fail", "task 7_3 on node1: out of memory"]
        );
        assert_eq!(ended_badly("7_1|TIMEOUT|node1\n7_2|RUNNING|node2\n"), ["task 7_1 on node1: timeout"]);
        assert!(ended_badly("Slurm accounting storage is disabled\n").is_empty());
    }

    #[test]
    fn words_are_quoted() {
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
    }
}
