//! Runs every example of the language's reference page, `docs/language.md`, of `docs/explaining.md`, `docs/pictures.md`, `docs/proofs.md`
//! and of the tutorials in `docs/tutorials/`, of which `check` must not warn; and what the README begins with.
//!
//! The info string of a fenced block says what the block is:
//!
//! | info string | what is done |
//! | --- | --- |
//! | `hp` | a whole problem: `check` accepts it, and `solve` agrees with its comments `// OBJECTIVE: VERDICT` at ends of lines, one for each objective (or `VERDICT by SOLVERS`) |
//! | `hp refused CODE` | a whole problem: `check` refuses it with that error |
//! | `hp FILE` | a whole problem that commands below may name; its known statuses, `// OBJECTIVE NAME=VALUE: VERDICT`, hold |
//! | `console` | commands after `$ `, which may end with `\| head -N`, each with what it prints |
//! | `hp in NAME` | a fragment: it takes the place of the line `...` in the context of that name, and the result is treated like a whole problem |
//! | `hp in NAME each` | the same for each line of the block by itself |
//! | `json FILE`, `text FILE` | a file that the problems below may name |
//!
//! A context is a comment of the page: `<!-- context NAME`, a problem with a line `...`, `-->`. A block of any other
//! kind fails: what is not run must not be there.

mod common;

use common::{Run, command};
use hyperplan_problem::KnownStatus;
use libtest_mimic::{Arguments, Trial};
use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::Arc;
use tempfile::TempDir;

/// The folder of the pages.
const DOCS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs");

fn main() {
    let arguments = Arguments::from_args();
    let mut trials = Vec::new();
    for (name, path) in pages() {
        let folder = Arc::new(tempfile::tempdir().expect("a temporary folder"));
        match page(&std::fs::read_to_string(path).expect("it is part of the repository")) {
            Ok(page) => trials.extend(page.into_trials(&name, &folder)),
            Err(message) => trials.push(Trial::test(name, move || Err(message.into()))),
        }
    }
    trials.push(Trial::test("readme::own_map", || Ok(own_map()?)));
    trials.push(Trial::test("readme::tour", || Ok(tour()?)));
    libtest_mimic::run(&arguments, trials).exit();
}

/// The pages by their names.
fn pages() -> Vec<(String, PathBuf)> {
    let tutorials = std::fs::read_dir(Path::new(DOCS).join("tutorials")).expect("it is there");
    let tutorials = tutorials.map(|entry| entry.expect("readable").path());
    let mut paths: Vec<PathBuf> = tutorials.filter(|path| path.extension() == Some("md".as_ref())).collect();
    paths.sort();
    let pages = ["explaining.md", "language.md", "pictures.md", "proofs.md"];
    paths.splice(0..0, pages.map(|page| Path::new(DOCS).join(page)));
    let name = |path: &PathBuf| path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    paths.into_iter().map(|path| (name(&path), path)).collect()
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
    fn into_trials(self, page: &str, folder: &Arc<TempDir>) -> Vec<Trial> {
        let mut trials = Vec::new();
        for block in &self.blocks {
            let words: Vec<&str> = block.info.split_whitespace().collect();
            let problems: Vec<Result<String, String>> = match words.as_slice() {
                ["json" | "text", file] => {
                    std::fs::write(folder.path().join(file), &block.text).expect("writable");
                    continue;
                }
                ["hp", file] => {
                    let (file, text) = ((*file).to_owned(), block.text.clone());
                    std::fs::write(folder.path().join(&file), &text).expect("writable");
                    let folder = folder.clone();
                    let name = format!("{page}::{file}");
                    trials.push(Trial::test(name, move || Ok(is_known(folder.path(), &file, &text)?)));
                    continue;
                }
                ["console"] => {
                    let (text, folder) = (block.text.clone(), folder.clone());
                    let name = format!("{page}::line_{}", block.line);
                    trials.push(Trial::test(name, move || Ok(prints(folder.path(), &text)?)));
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
                trials.push(Trial::test(format!("{page}::{name}"), move || {
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

/// Accepted without a warning, and every objective is decided as each known status says.
fn is_known(folder: &Path, file: &str, text: &str) -> Result<(), String> {
    let run = hyperplan(folder, &["check", file]);
    if run.status != 0 || !run.stderr.is_empty() {
        return Err(format!("exit status {}\n{}", run.status, run.stderr));
    }
    let known: Vec<KnownStatus> = KnownStatus::of_text(text).collect();
    for objective in text.lines().filter_map(|line| line.strip_prefix("objective ")) {
        if !known.iter().any(|status| objective.starts_with(&status.objective)) {
            return Err(format!("nothing is said of {objective}"));
        }
    }
    for KnownStatus { objective, set, realizable, .. } in known {
        let set: Vec<String> = set.iter().map(|(name, value)| format!("--set={name}={value}")).collect();
        let mut arguments = vec!["solve", "--quiet", "--objective", &objective, file];
        arguments.extend(set.iter().map(String::as_str));
        let run = hyperplan(folder, &arguments);
        if run.status != i32::from(!realizable) {
            return Err(format!("{arguments:?}: {}{}", run.stdout, run.stderr));
        }
    }
    Ok(())
}

fn readme() -> String {
    std::fs::read_to_string(Path::new(DOCS).join("../README.md")).expect("it is part of the repository")
}

/// The README's problem for a map of one's own, on a map of ROS.
fn own_map() -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let readme = readme();
    let block = readme.split("```").find(|block| block.trim_start().starts_with("const T = 100;"));
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("writable");
    write("my.hp", block.ok_or("there is no such block")?);
    write("my.yaml", "image: my.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n");
    write("my.pgm", &format!("P2 60 20 255\n{}", "255 ".repeat(60 * 20)));
    quiet(folder.path(), &["check", "my.hp"])?;
    quiet(folder.path(), &["solve", "my.hp", "--plot", "my.svg"])?;
    let least = quiet(folder.path(), &["solve", "my.hp", "--minimize", "T", "--quiet"])?;
    if least != "go: realizable with T = 45, unrealizable with 0..44\n" {
        return Err(least);
    }
    Ok(())
}

/// The commands of the README's tour, one after the other, but for those that want other solvers or a shell.
fn tour() -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let specs = Path::new(DOCS).join("../specs");
    let specs = specs.to_str().ok_or("the path is no text")?;
    let readme = readme();
    let commands = readme.lines().filter_map(|line| line.strip_prefix("| `hyperplan ")?.split('`').next());
    let commands: Vec<&str> = commands.filter(|line| !line.starts_with("compare")).collect();
    if commands.len() < 8 {
        return Err(format!("only {commands:?}"));
    }
    for line in commands {
        let line = line.replace("specs/", &format!("{specs}/"));
        quiet(folder.path(), &line.split(' ').collect::<Vec<_>>())?;
    }
    Ok(())
}

/// What a command prints that must succeed, with nothing but notes on standard error.
fn quiet(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let run = hyperplan(folder, arguments);
    match run.status == 0 && run.stderr.lines().all(|line| line.starts_with("note: ")) {
        true => Ok(run.stdout),
        false => Err(format!("{arguments:?}: exit status {}\n{}", run.status, run.stderr)),
    }
}

/// The words of a command line; what stands in single quotes is one.
fn words(line: &str) -> Vec<&str> {
    let parts = line.split('\'').enumerate();
    parts
        .flat_map(|(at, part)| if at % 2 == 1 { vec![part] } else { part.split_whitespace().collect() })
        .collect()
}

/// What the commands of a block print.
fn prints(folder: &Path, text: &str) -> Result<(), String> {
    for part in format!("\n{text}").split("\n$ ").skip(1) {
        let (line, expected) = part.split_once('\n').unwrap_or((part, ""));
        let (line, lines) = match line.split_once(" | head -") {
            Some((line, lines)) => (line, lines.parse().map_err(|_| format!("no number in `{line}`"))?),
            None => (line, usize::MAX),
        };
        let words = words(line);
        let Some(("hyperplan", arguments)) = words.split_first().map(|(first, rest)| (*first, rest)) else {
            return Err(format!("`{line}` is not hyperplan"));
        };
        let run = hyperplan(folder, arguments);
        let found: Vec<&str> = run.stdout.lines().take(lines).collect();
        if found != expected.lines().collect::<Vec<_>>() || !run.stderr.is_empty() {
            return Err(format!("{line} prints\n{}{}", run.stdout, run.stderr));
        }
    }
    Ok(())
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
                continue;
            }
            // What a cheapest strategy costs stands behind the verdict.
            let told = run.stdout.trim_end().split(" with ").next().unwrap_or_default();
            if run.status != status || told != format!("{name}: {verdict}") {
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
