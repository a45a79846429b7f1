//! The commands of a page: each is run, and what it prints is what the page says; pictures are what they draw.

use super::common::{command, solver_is_there};
use super::page::{Block, DOCS, Page};
use std::path::Path;
use std::process::{Command, Stdio};

/// What paths below the folder of the commands begin with in the book.
const HOME: &str = "/home/me";

/// Runs all commands of the page in their order, and compares; `UPDATE=1` writes what they print, and draw, into `file`.
pub(crate) fn page_prints(page: &Page, file: &Path, folder: &Path) -> Result<(), String> {
    let update = std::env::var_os("UPDATE").is_some();
    let (mut wrong, mut anew, mut skipped) = (Vec::new(), Vec::new(), false);
    for block in &page.blocks {
        let words = block.words();
        let solvers = match words.as_slice() {
            ["console"] => &[],
            ["console", "with", solvers @ ..] => solvers,
            _ => continue,
        };
        if !solvers.iter().all(|solver| solver_is_there(solver)) {
            skipped = true;
            continue;
        }
        let found = printed(folder, &block.text)?;
        if without_seconds(&found) != without_seconds(&block.text) {
            wrong.push(format!("line {}: expected\n{}found\n{found}", block.line, block.text));
            anew.push((block, found));
        }
    }
    if update && !anew.is_empty() {
        rewrite(file, &anew)?;
        wrong.clear();
    }
    if !skipped {
        wrong.extend(page.pictures.iter().filter_map(|name| picture(folder, name, update).err()));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n")) }
}

/// The text with every `0.01 s` as `. s`: how long it takes differs from run to run.
fn without_seconds(text: &str) -> String {
    let mut parts = text.split(" s").peekable();
    let mut kept = String::new();
    while let Some(part) = parts.next() {
        let is_last = parts.peek().is_none();
        let digits = |text: &str| text.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let whole = part[..digits(part)].strip_suffix('.').filter(|_| !is_last);
        match whole {
            Some(whole) => kept.extend([&whole[..digits(whole)], "."]),
            None => kept += part,
        }
        kept += if is_last { "" } else { " s" };
    }
    kept
}

/// Puts texts in the place of those of the blocks, the last first so that lines stay where they are.
fn rewrite(file: &Path, anew: &[(&Block, String)]) -> Result<(), String> {
    let text = std::fs::read_to_string(file).map_err(|error| error.to_string())?;
    let mut lines: Vec<&str> = text.lines().collect();
    for (block, found) in anew.iter().rev() {
        let end = block.line + block.text.lines().count();
        lines.splice(block.line..end, found.lines());
    }
    std::fs::write(file, lines.join("\n") + "\n").map_err(|error| error.to_string())
}

/// That the picture in the book is what a command of the page has drawn.
fn picture(folder: &Path, name: &str, update: bool) -> Result<(), String> {
    let drawn =
        std::fs::read(folder.join(name)).map_err(|error| format!("no command draws {name}: {error}"))?;
    let kept = Path::new(DOCS).join("pictures").join(name);
    if update {
        return std::fs::write(kept, drawn).map_err(|error| error.to_string());
    }
    match std::fs::read(&kept).is_ok_and(|kept| kept == drawn) {
        true => Ok(()),
        false => Err(format!("docs/pictures/{name} is not what is drawn; UPDATE=1 accepts that")),
    }
}

/// The commands of a block, each with what it prints.
fn printed(folder: &Path, text: &str) -> Result<String, String> {
    let mut found = String::new();
    for part in format!("\n{text}").split("\n$ ").skip(1) {
        let line = logical_lines(part).next().ok_or("an empty command")?;
        found += &format!("$ {line}\n{}", shell(folder, &line)?.1);
    }
    Ok(found)
}

/// Lines, of which one that ends with `\` goes on in the next.
fn logical_lines(text: &str) -> impl Iterator<Item = String> {
    let mut lines = text.lines();
    std::iter::from_fn(move || {
        let mut line = lines.next()?.to_owned();
        while line.ends_with('\\') {
            line.push('\n');
            line += lines.next()?;
        }
        Some(line)
    })
}

/// Whether a line of shell succeeds, and what it prints, messages included, of which `| head -N` keeps N lines without
/// closing the pipe before its end.
fn shell(folder: &Path, line: &str) -> Result<(bool, String), String> {
    let (line, lines) = match line.split_once(" | head -") {
        Some((line, lines)) => (line, lines.parse().map_err(|_| format!("no number in `{line}`"))?),
        None => (line, usize::MAX),
    };
    let like = command(&[]);
    let program = Path::new(like.get_program()).parent().ok_or("the command lies in no folder")?;
    let others = std::env::var_os("PATH").unwrap_or_default();
    let places = [program.to_owned()].into_iter().chain(std::env::split_paths(&others));
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("exec 2>&1\n{line}")])
        .current_dir(folder)
        .stdin(Stdio::null())
        .env_remove("NO_COLOR");
    shell.env("PATH", std::env::join_paths(places).map_err(|error| error.to_string())?);
    shell.env("XDG_CONFIG_HOME", folder.join(".config"));
    let output = shell.output().map_err(|error| format!("sh: {error}"))?;
    let printed = String::from_utf8_lossy(&output.stdout);
    let kept: String = printed.lines().take(lines).map(|line| format!("{line}\n")).collect();
    let shown = folder.to_str().ok_or("the folder's name is no text")?;
    Ok((output.status.success(), kept.replace(shown, HOME)))
}

/// That commands which are not run have at least options that there are.
pub(crate) fn options_exist(folder: &Path, text: &str) -> Result<(), String> {
    for line in logical_lines(text) {
        let line = line.strip_prefix("$ ").unwrap_or(&line);
        let ends = [" > ", " | ", " # ", " && "].iter().filter_map(|end| line.find(end));
        let line = &line[..ends.min().unwrap_or(line.len())];
        if line.starts_with("hyperplan ")
            && let (false, said) = shell(folder, &format!("{line} --help"))?
        {
            return Err(format!("{line}\n{said}"));
        }
    }
    Ok(())
}

/// That the solvers of a configuration are known once it is trusted.
pub(crate) fn is_configuration(folder: &Path, text: &str) -> Result<(), String> {
    let place = tempfile::tempdir_in(folder).map_err(|error| error.to_string())?;
    std::fs::write(place.path().join("hyperplan.toml"), text).map_err(|error| error.to_string())?;
    let (understood, said) = shell(place.path(), "hyperplan solvers --trust && hyperplan solvers")?;
    let mut names = text.lines().filter_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
    if understood && names.all(|name| said.contains(name)) { Ok(()) } else { Err(said) }
}
