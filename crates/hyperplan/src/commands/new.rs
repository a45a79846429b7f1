//! `hyperplan new`: a problem file to begin with.

use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::cannot_write;
use crate::output::Output;
use hyperplan_outlet::{create, one_line};
use std::io::ErrorKind;
use std::path::Path;

/// Where it says `FILE`, the name is filled in.
const STARTER: &str = include_str!("../starter.hp");

pub(crate) fn run(args: &args::New, out: &mut Output) -> Result {
    let Some(path) = &args.file else {
        out.line(STARTER.trim_end())?;
        return Ok(Exit::Good);
    };
    // In comments, which end with the line.
    let name = one_line(&path.display().to_string()).into_owned();
    let text = STARTER.replace("FILE", &name);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let file = path.file_name().unwrap_or(path.as_os_str());
    let written = create(folder, [file], |to| to.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::input(format_args!("{name} is there already")),
        _ => cannot_write(path, &error),
    })?;
    out.remark(format_args!("note: {name} is written; now: hyperplan solve {name}"));
    Ok(Exit::Good)
}
