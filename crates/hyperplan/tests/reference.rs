//! Runs every example of the language's reference page, `docs/language.md`.
//!
//! The info string of a fenced block says what the block is:
//!
//! | info string | what is done |
//! | --- | --- |
//! | `hp` | a whole problem: `check` accepts it, and `solve` agrees with its comments `// OBJECTIVE: VERDICT` at ends of lines, one for each objective (or `VERDICT by SOLVERS`) |
//! | `hp refused CODE` | a whole problem: `check` refuses it with that error |
//! | `hp in NAME` | a fragment: it takes the place of the line `...` in the context of that name, and the result is treated like a whole problem |
//! | `hp in NAME each` | the same for each line of the block by itself |
//! | `json FILE`, `text FILE` | a file that the problems below may name |
//!
//! A context is a comment of the page: `<!-- context NAME`, a problem with a line `...`, `-->`. A block of any other
//! kind fails: what is not run must not be there.

mod common;

use common::{Run, command};
use libtest_mimic::{Arguments, Trial};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;
use std::sync::Arc;
use tempfile::TempDir;

const PAGE: &str = include_str!("../../../docs/language.md");

fn main() {
    let arguments = Arguments::from_args();
    let folder = Arc::new(tempfile::tempdir().expect("a temporary folder"));
    let trials = match page(PAGE) {
        Ok(page) => page.into_trials(&folder),
        Err(message) => vec![Trial::test("page", move || Err(message.into()))],
    };
    libtest_mimic::run(&arguments, trials).exit();
}

/// What the page holds, in its order.
#[derive(Default)]
struct Page {
    contexts: BTreeMap<String, String>,
    blocks: Vec<Block>,
}

/// A fenced block.
struct Block {
    /// The line of its opening fence.
    line: usize,
    info: String,
    text: String,
}

/// Takes the page apart.
fn page(text: &str) -> Result<Page, String> {
    let mut page = Page::default();
    let mut lines = (1..).zip(text.lines());
    while let Some((line, content)) = lines.next() {
        let mut until = |end: &str| -> Result<String, String> {
            let mut body = String::new();
            for (_, inner) in lines.by_ref() {
                if inner.trim() == end {
                    return Ok(body);
                }
                body += inner;
                body.push('\n');
            }
            Err(format!("what begins in line {line} does not end"))
        };
        if let Some(info) = content.trim_start().strip_prefix("```") {
            page.blocks.push(Block { line, info: info.trim().to_owned(), text: until("```")? });
        } else if let Some(name) = content.strip_prefix("<!-- context ")
            && page.contexts.insert(name.trim().to_owned(), until("-->")?).is_some()
        {
            return Err(format!("line {line}: a second context of that name"));
        }
    }
    Ok(page)
}

impl Page {
    /// Writes the files and makes a test of each example.
    fn into_trials(self, folder: &Arc<TempDir>) -> Vec<Trial> {
        let mut trials = Vec::new();
        for block in &self.blocks {
            let words: Vec<&str> = block.info.split_whitespace().collect();
            let problems: Vec<Result<String, String>> = match words.as_slice() {
                ["json" | "text", file] => {
                    std::fs::write(folder.path().join(file), &block.text).expect("writable");
                    continue;
                }
                ["hp"] | ["hp", "refused", _] => vec![Ok(block.text.clone())],
                ["hp", "in", name] => vec![self.wrapped(name, &block.text)],
                ["hp", "in", name, "each"] => {
                    let lines = block.text.lines().filter(|line| !line.trim().is_empty());
                    lines.map(|line| self.wrapped(name, &format!("{line}\n"))).collect()
                }
                _ => vec![Err(format!("nobody runs a block of the kind `{}`", block.info))],
            };
            let refused = match words.as_slice() {
                ["hp", "refused", code] => Some((*code).to_owned()),
                _ => None,
            };
            for (number, problem) in problems.into_iter().enumerate() {
                let name = format!("line_{}_{number}", block.line);
                let (folder, refused) = (folder.clone(), refused.clone());
                trials.push(Trial::test(name.clone(), move || {
                    let file = format!("{name}.hp");
                    let text = problem?;
                    std::fs::write(folder.path().join(&file), &text)?;
                    let outcome = match refused {
                        Some(code) => is_refused(folder.path(), &file, &code),
                        None => holds(folder.path(), &file, &text),
                    };
                    outcome.map_err(|message| format!("{message}\n{text}").into())
                }));
            }
        }
        trials
    }

    /// The fragment in its context.
    fn wrapped(&self, context: &str, fragment: &str) -> Result<String, String> {
        let around = self.contexts.get(context).ok_or_else(|| format!("no context `{context}`"))?;
        match around.split_once("...\n") {
            Some((before, after)) => Ok(format!("{before}{fragment}{after}")),
            None => Err(format!("the context `{context}` has no line `...`")),
        }
    }
}

fn hyperplan(folder: &Path, arguments: &[&str]) -> Run {
    let mut command = command(arguments);
    Run::new(command.current_dir(folder).stderr(Stdio::piped()).output().expect("the command was built"))
}

fn is_refused(folder: &Path, file: &str, code: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status == 2 && run.stderr.contains(&format!("error[{code}]")) {
        return Ok(());
    }
    Err(format!("expected error[{code}] and exit status 2, found {}\n{}", run.status, run.stderr))
}

/// Accepted, and every objective is decided as a comment says.
fn holds(folder: &Path, file: &str, text: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status != 0 {
        return Err(format!("exit status {}\n{}", run.status, run.stderr));
    }
    let objectives = text.lines().filter_map(|line| line.trim().strip_prefix("objective "));
    for objective in objectives {
        let name: String = objective.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let mark = format!("// {name}: ");
        let mut said = text.lines().filter_map(|line| Some(line.trim_end().split_once(&mark)?.1));
        let (Some(answer), None) = (said.next(), said.next()) else {
            return Err(format!("no line ends with `// {name}: VERDICT`, or several do"));
        };
        let (verdict, solvers) = answer.split_once(" by ").unwrap_or((answer, "builtin"));
        let status = match verdict {
            "realizable" => 0,
            "unrealizable" => 1,
            other => return Err(format!("`{other}` is no verdict")),
        };
        for solver in solvers.split(", ") {
            let run =
                hyperplan(folder, &["solve", "--quiet", "--objective", &name, "--solver", solver, file]);
            let required = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some();
            if run.status == 4 && run.stderr.contains("not found") && !required {
                say_skipped(solver);
            } else if run.status != status || run.stdout.trim_end() != format!("{name}: {verdict}") {
                let (found, status, messages) = (run.stdout, run.status, run.stderr);
                return Err(format!("expected {verdict}, {solver} found {found} ({status})\n{messages}"));
            }
        }
    }
    Ok(())
}

fn say_skipped(solver: &str) {
    let _ = writeln!(std::io::stderr(), "{solver} is missing: skipped");
}
