//! What only the README has.

use super::page::{DOCS, page};
use super::problems::hyperplan;
use std::path::Path;

/// Of the block that [`own_map`] runs.
pub(crate) const OWN_MAP: &str = "hp own-map";

fn readme() -> String {
    std::fs::read_to_string(Path::new(DOCS).join("../README.md")).expect("it is part of the repository")
}

/// The README's problem for a map of one's own, on a map of ROS.
pub(crate) fn own_map() -> Result<(), String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let readme = readme();
    let page = page(&readme)?;
    let block = page.blocks.iter().find(|block| block.info == OWN_MAP).map(|block| block.text.as_str());
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
pub(crate) fn tour() -> Result<(), String> {
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
