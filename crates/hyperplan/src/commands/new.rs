//! `hyperplan new`: a problem file to begin with.

use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::cannot_write;
use crate::output::Output;
use hyperplan_compare::one_line;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};

/// Where it says `FILE`, the name is filled in.
const STARTER: &str = include_str!("../starter.hp");

pub(crate) fn run(args: &args::New, out: &mut Output) -> Result {
    let Some(path) = &args.file else {
        out.line(STARTER.trim_end())?;
        return Ok(Exit::Good);
    };
    // In comments, which end with the line.
    let name = one_line(&path.display().to_string()).into_owned();
    let opened = OpenOptions::new().write(true).create_new(true).open(path);
    let mut file = opened.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Failure::input(format_args!("{name} is there already")),
        _ => cannot_write(path, &error),
    })?;
    file.write_all(STARTER.replace("FILE", &name).as_bytes()).map_err(|error| cannot_write(path, &error))?;
    out.remark(format_args!("note: {name} is written; now: hyperplan solve {name}"));
    Ok(Exit::Good)
}
