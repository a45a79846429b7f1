//! Runs every example of the README and of the book in `docs/`, and compares what is printed and drawn. `check` must not
//! warn of the problems. `UPDATE=1` writes what commands print and draw into the pages and `docs/pictures/`.
//!
//! The info string of a fenced block says what the block is:
//!
//! | info string | what is done |
//! | --- | --- |
//! | `hp` | a whole problem: `check` accepts it, and `solve` agrees with its comments `// OBJECTIVE: VERDICT` at ends of lines, one for each objective (or `VERDICT by SOLVERS`) |
//! | `hp refused CODE` | a whole problem: `check` refuses it with that error |
//! | `hp FILE` | a whole problem that commands below may name; its known statuses, `// OBJECTIVE NAME=VALUE: VERDICT`, hold |
//! | `hp doubtful FILE` | the same, of which `check` warns |
//! | `hp in NAME` | a fragment: it takes the place of the line `...` in the context of that name, and the result is treated like a whole problem |
//! | `hp in NAME each` | the same for each line of the block by itself |
//! | `console` | commands after `$ `, run by a shell, each with what it prints; they may end with `\| head -N`, and have `specs/` beside them |
//! | `console with SOLVER...` | the same where these are installed |
//! | `toml` | a configuration: the solvers that it names are known then |
//! | `KIND from FILE` | a part of that file of the repository, which other tests run or read |
//! | `KIND FILE` | a file of any other kind that problems and commands below may name |
//! | `KIND not-run REASON` | what is not run, for one of the reasons in [`NOT_RUN`]; options of `hyperplan` in it have to exist |
//!
//! A context is a comment of the page: `<!-- context NAME`, a problem with a line `...`, `-->`. A block of any other
//! kind fails. A picture of a page is in `docs/pictures/`, and one of the page's commands draws a file of its name.

mod common;
#[path = "reference/console.rs"]
mod console;
#[path = "reference/page.rs"]
mod page;
#[path = "reference/problems.rs"]
mod problems;
#[path = "reference/readme.rs"]
mod readme;

use libtest_mimic::{Arguments, Trial};
use page::{Block, DOCS, Page};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

/// Why a block may be shown that is not run, and how many there may be of each kind.
const NOT_RUN: &[(&str, usize)] = &[
    // What it prints was measured on one machine.
    ("measured", 4),
    // It takes several machines, or a scheduler.
    ("cluster", 5),
    // It builds the project, or runs for minutes.
    ("long", 10),
    // It takes files or programs of others.
    ("others", 5),
];

fn main() {
    let arguments = Arguments::from_args();
    let (mut trials, mut not_run, mut pictures) = (Vec::new(), Vec::new(), Vec::new());
    for (name, path) in page::pages() {
        let folder = Arc::new(tempfile::tempdir().expect("a temporary folder"));
        link_specs(folder.path());
        match page::page(&std::fs::read_to_string(&path).expect("it is part of the repository")) {
            Ok(page) => {
                not_run.extend(page.blocks.iter().filter_map(reason).map(str::to_owned));
                pictures.extend(page.pictures.iter().cloned());
                trials.extend(trials_of(page, &name, path, &folder));
            }
            Err(message) => trials.push(Trial::test(name, move || Err(message.into()))),
        }
    }
    trials.push(Trial::test("readme::own_map", || Ok(readme::own_map()?)));
    trials.push(Trial::test("readme::tour", || Ok(readme::tour()?)));
    trials.push(Trial::test("answers::reason_codes", || Ok(reason_codes()?)));
    trials.push(Trial::test("few_are_not_run", move || Ok(are_few(&not_run)?)));
    trials.push(Trial::test("pictures_are_shown", move || Ok(are_shown(&pictures)?)));
    libtest_mimic::run(&arguments, trials).exit();
}

/// `answers.md` has a row for each reason code of the schema, and no other.
fn reason_codes() -> Result<(), String> {
    let read =
        |name: &str| std::fs::read_to_string(Path::new(DOCS).join(name)).map_err(|error| error.to_string());
    let schema: serde_json::Value =
        serde_json::from_str(&read("answer.schema.json")?).map_err(|error| error.to_string())?;
    let codes = schema["$defs"]["ReasonCode"]["oneOf"].as_array().ok_or("the schema has no reason codes")?;
    let mut codes: Vec<&str> = codes.iter().filter_map(|code| code["const"].as_str()).collect();
    let page = read("answers.md")?;
    let (_, section) = page.split_once("\n## Reasons\n").ok_or("there is no section `Reasons`")?;
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `")?.split('`').next());
    let mut rows: Vec<&str> = rows.collect();
    codes.sort_unstable();
    rows.sort_unstable();
    if rows == codes { Ok(()) } else { Err(format!("the schema has {codes:?}, the page {rows:?}")) }
}

/// Puts `specs/` beside what commands write.
fn link_specs(folder: &Path) {
    let specs = Path::new(DOCS).join("../specs").canonicalize().expect("it is there");
    std::os::unix::fs::symlink(specs, folder.join("specs")).expect("the folder is ours");
}

/// Why the block is not run, if it is not.
fn reason(block: &Block) -> Option<&str> {
    match block.words().as_slice() {
        [_, "not-run", reason] => Some(reason),
        _ => None,
    }
}

/// No more are left out than the table says, and no fewer, so that the table stays true.
fn are_few(not_run: &[String]) -> Result<(), String> {
    for (reason, most) in NOT_RUN {
        let found = not_run.iter().filter(|other| other == reason).count();
        if found != *most {
            return Err(format!("{found} blocks are not run for being `{reason}`, the table says {most}"));
        }
    }
    match not_run.iter().find(|other| !NOT_RUN.iter().any(|(reason, _)| reason == other)) {
        Some(other) => Err(format!("`{other}` is no reason")),
        None => Ok(()),
    }
}

/// Every file of `docs/pictures/` is on a page.
fn are_shown(shown: &[String]) -> Result<(), String> {
    let files = std::fs::read_dir(Path::new(DOCS).join("pictures")).map_err(|error| error.to_string())?;
    for file in files {
        let name = file.map_err(|error| error.to_string())?.file_name().to_string_lossy().into_owned();
        if !shown.contains(&name) {
            return Err(format!("docs/pictures/{name} is on no page"));
        }
    }
    Ok(())
}

/// Writes the files of the page and makes a test of each example; the commands are one, since they follow each other.
fn trials_of(page: Page, name: &str, path: PathBuf, folder: &Arc<TempDir>) -> Vec<Trial> {
    let mut trials: Vec<Trial> =
        page.blocks.iter().flat_map(|block| trials_of_block(&page, block, name, folder)).collect();
    let has_commands = page.blocks.iter().any(|block| block.info.starts_with("console"));
    if has_commands || !page.pictures.is_empty() {
        let (name, folder) = (format!("{name}::console"), folder.clone());
        trials.push(Trial::test(name, move || Ok(console::page_prints(&page, &path, folder.path())?)));
    }
    trials
}

fn trials_of_block(page: &Page, block: &Block, name: &str, folder: &Arc<TempDir>) -> Vec<Trial> {
    let (info, text, folder) = (block.info.clone(), block.text.clone(), folder.clone());
    let write = |file: &str| std::fs::write(folder.path().join(file), &block.text).expect("writable");
    let line = format!("{name}::line_{}", block.line);
    if info == readme::OWN_MAP {
        return Vec::new();
    }
    match block.words().as_slice() {
        ["console"] | ["console", "with", ..] => Vec::new(),
        [_, "not-run", reason] => {
            let listed = Trial::test(format!("{line}::not_run::{reason}"), || Ok(())).with_ignored_flag(true);
            let options = move || Ok(console::options_exist(folder.path(), &text)?);
            vec![listed, Trial::test(format!("{line}::options"), options)]
        }
        ["toml"] => {
            vec![Trial::test(line, move || Ok(console::is_configuration(folder.path(), &text)?))]
        }
        [_, "from", file] => {
            let file = Path::new(DOCS).join("..").join(file);
            vec![Trial::test(line, move || Ok(page::is_part(&text, &file)?))]
        }
        ["hp", file] | ["hp", "doubtful", file] => {
            write(file);
            let (doubtful, file) = (info.contains(" doubtful "), (*file).to_owned());
            let known = move || Ok(problems::is_known(folder.path(), &file, doubtful, &text)?);
            vec![Trial::test(format!("{name}::{}", info.split(' ').next_back().unwrap_or_default()), known)]
        }
        ["hp"] => vec![whole(line, Ok(text), None, folder)],
        ["hp", "refused", code] => vec![whole(line, Ok(text), Some((*code).to_owned()), folder)],
        ["hp", "in", context] => vec![whole(line, page.wrapped(context, &text), None, folder)],
        ["hp", "in", context, "each"] => {
            let lines = text.lines().filter(|line| !line.trim().is_empty());
            let wrapped = lines.map(|line| page.wrapped(context, &format!("{line}\n")));
            let whole = |(number, problem)| whole(format!("{line}_{number}"), problem, None, folder.clone());
            wrapped.enumerate().map(whole).collect()
        }
        [_, file] => {
            write(file);
            Vec::new()
        }
        _ => vec![Trial::test(line, move || Err(format!("nobody runs a block of the kind `{info}`").into()))],
    }
}

/// A problem that holds what it says, or is refused with a code.
fn whole(
    name: String,
    problem: Result<String, String>,
    refused: Option<String>,
    folder: Arc<TempDir>,
) -> Trial {
    let file = format!("{}.hp", name.replace("::", "_"));
    Trial::test(name, move || {
        let text = problem?;
        std::fs::write(folder.path().join(&file), &text)?;
        let outcome = match refused {
            Some(code) => problems::is_refused(folder.path(), &file, &code),
            None => problems::holds(folder.path(), &file, &text),
        };
        outcome.map_err(|message| format!("{message}\n{text}").into())
    })
}
