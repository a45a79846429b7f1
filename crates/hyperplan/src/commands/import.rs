//! `hyperplan import`: a problem file from those of other tools.

use crate::args;
use crate::explain::advise;
use crate::failure::{Exit, Failure, Result};
use crate::files::write_bytes;
use crate::output::Output;
use crate::report;
use hyperplan::foreign::text;
use hyperplan_problem::Overrides;

pub(crate) fn run(args: &args::Import, out: &mut Output) -> Result {
    let Some(foreign) = &args.problem.foreign else {
        let file = args.problem.file.display();
        return Err(Failure::input(format_args!(
            "{file} is neither a model (.smv, .aag, .aig, .txt, .pddl) nor a formula (.hq) of another tool"
        )));
    };
    let (mut lowered, sources, imported) = foreign.read(&Overrides { values: args.problem.set.clone() });
    advise(&mut lowered.diagnostics);
    report::diagnostics(&sources, &lowered.diagnostics, out);
    if lowered.has_errors() {
        return Ok(Exit::Input);
    }
    let text = text(&imported);
    match &args.output {
        Some(path) => write_bytes(path, text.as_bytes())?,
        None => {
            out.verbatim(&text)?;
            out.flush()?;
        }
    }
    Ok(Exit::Good)
}
