//! The same comparison for BenchExec: a benchmark definition, a task-definition file for each problem, and a tool-info module.
//!
//! Queries are not among the tasks: their solvers run there without hyperplan.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use askama::Template;
use hyperplan_outlet::write as write_file;
use serde_json::to_string as quoted;

use crate::paths::relative;
use crate::{Answer, Limit};

/// A problem file and what is asked of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file.
    pub file: PathBuf,
    /// The objective; `None` where there is only one.
    pub objective: Option<String>,
    /// The constants to set, `T=12`.
    pub set: Vec<String>,
    /// The right answer, where it is known.
    pub expected: Option<Answer>,
}

/// A solver with its choices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Configuration {
    /// What the runs are called.
    pub name: String,
    /// Options of `hyperplan solve` with their values: `("--solver", "z3")`.
    pub options: Vec<(String, String)>,
}

#[derive(Template)]
#[template(path = "benchexec/hyperplan.xml")]
struct Definition {
    cpu_s: Option<u64>,
    wall_s: Option<u64>,
    memory: Option<u64>,
    configurations: Vec<Configuration>,
}

const TOOL: &str = include_str!("../templates/benchexec/hyperplan.py");

/// Writes everything into a folder, which is made if need be: `hyperplan.xml`, `realizable.prp`, `tasks/*.yml`, and the package
/// `hyperplan_tool`. Task files of an earlier time are taken away.
///
/// # Errors
/// If a file cannot be written, or a problem file is not there.
pub fn write(dir: &Path, problems: &[Problem], solvers: &[Configuration], limit: &Limit) -> io::Result<()> {
    let (tasks, tool) = (dir.join("tasks"), dir.join("hyperplan_tool"));
    fs::create_dir_all(&tasks)?;
    fs::create_dir_all(&tool)?;
    for entry in fs::read_dir(&tasks)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "yml") {
            fs::remove_file(path)?;
        }
    }
    let definition = Definition {
        cpu_s: limit.cpu_s.map(whole),
        wall_s: limit.wall_s.map(whole),
        memory: limit.memory_mib.map(|mib| mib.saturating_mul(1 << 20)),
        configurations: configurations(solvers),
    };
    let write = |path: PathBuf, text: &str| write_file(&path, |to| to.write_all(text.as_bytes()));
    write(dir.join("hyperplan.xml"), &definition.render().map_err(io::Error::other)?)?;
    write(dir.join("realizable.prp"), "CHECK( realizable )\n")?;
    write(tool.join("__init__.py"), "")?;
    write(tool.join("hyperplan.py"), TOOL)?;
    let from = tasks.canonicalize()?;
    let digits = problems.len().to_string().len();
    for (i, problem) in (1..).zip(problems) {
        let name = format!("{i:0digits$}-{}.yml", plain(&problem.label()));
        write(tasks.join(name), &problem.task(&from)?)?;
    }
    Ok(())
}

impl Problem {
    fn label(&self) -> String {
        let file = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let parts = file.iter().chain(&self.objective).chain(&self.set);
        parts.map(String::as_str).collect::<Vec<_>>().join("-")
    }

    /// A task-definition file. Its texts are JSON, which is YAML too.
    fn task(&self, from: &Path) -> io::Result<String> {
        let file = relative(from, &self.file.canonicalize()?);
        let file = file.to_str().ok_or_else(|| {
            io::Error::new(io::ErrorKind::InvalidInput, format!("{}: no UTF-8", self.file.display()))
        })?;
        let mut text = format!(
            "format_version: \"2.0\"\ninput_files: {}\nproperties:\n  - property_file: ../realizable.prp\n",
            quoted(&literally(file))?
        );
        if let Some(answer) = self.expected {
            text.push_str(&format!("    expected_verdict: {}\n", answer == Answer::Sat));
        }
        if self.objective.is_some() || !self.set.is_empty() {
            text.push_str("options:\n");
        }
        if let Some(objective) = &self.objective {
            text.push_str(&format!("  objective: {}\n", quoted(objective)?));
        }
        if !self.set.is_empty() {
            text.push_str(&format!("  set: {}\n", quoted(&self.set)?));
        }
        Ok(text)
    }
}

/// BenchExec counts whole seconds, and takes 0 for an error.
fn whole(seconds: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped, and casts saturate"
    )]
    let whole = seconds.ceil().clamp(1.0, 1e15) as u64;
    whole
}

/// With names that BenchExec takes as parts of file names, all different.
fn configurations(solvers: &[Configuration]) -> Vec<Configuration> {
    let mut taken = BTreeSet::new();
    let named = |configuration: &Configuration| {
        let plain = plain(&configuration.name);
        let names = std::iter::once(plain.clone()).chain((2..).map(|i| format!("{plain}-{i}")));
        let name = names.into_iter().find(|name| taken.insert(name.clone())).unwrap_or(plain);
        let options = configuration.options.iter().map(|(name, value)| (printable(name), printable(value)));
        Configuration { name, options: options.collect() }
    };
    solvers.iter().map(named).collect()
}

/// XML has no way to write control characters.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

fn plain(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || matches!(c, '.' | '=') { c } else { '-' };
    text.chars().take(80).map(plain).collect()
}

/// Input files are patterns to BenchExec.
fn literally(path: &str) -> String {
    let mut pattern = String::new();
    for c in path.chars() {
        match c {
            '*' | '?' | '[' => pattern.extend(['[', c, ']']),
            _ => pattern.push(c),
        }
    }
    pattern
}
