//! `hyperplan import`: a problem file from those of other tools.

use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::files::write_bytes;
use crate::load::Loaded;
use crate::output::Output;
use crate::report;
use std::time::Instant;

pub(crate) fn run(args: &args::Import, out: &mut Output) -> Result {
    let Some(foreign) = &args.problem.foreign else {
        let file = args.problem.file.display();
        return Err(Failure::input(format_args!(
            "{file} is neither a model (.smv) nor a formula (.hq) of another tool"
        )));
    };
    let (lowered, sources) = Loaded::lower(&args.problem, "");
    if lowered.has_errors() {
        report::diagnostics(&sources, &lowered.diagnostics, out);
        return Ok(Exit::Input);
    }
    Loaded::of(&args.problem, (lowered, sources), Instant::now(), out)?;
    let text = foreign.text();
    match &args.output {
        Some(path) => write_bytes(path, text.as_bytes())?,
        None => {
            out.verbatim(&text)?;
            out.flush()?;
        }
    }
    Ok(Exit::Good)
}
