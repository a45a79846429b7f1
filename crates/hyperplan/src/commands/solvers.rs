//! `hyperplan solvers`: which solvers there are, and how to get the others.

use crate::args::{self, Format};
use crate::failure::{Outcome, Status};
use crate::output::Output;
use crate::report::json;
use hyperplan_solver::{Found, discover};
use serde::Serialize;

pub(crate) fn run(args: &args::Solvers, out: &mut Output) -> Outcome {
    let found = discover();
    match args.output.format {
        Format::Json => found.iter().try_for_each(|solver| out.line(json(&Report::new(solver))?))?,
        Format::Text => {
            let width = found.iter().map(|s| s.name.len()).max().unwrap_or(0);
            let text: String = found.iter().map(|solver| describe(solver, width)).collect();
            out.line(text.trim_end())?;
        }
    }
    Ok(Status::Good)
}

/// A line for a solver that was found, three for one that was not.
fn describe(solver: &Found, width: usize) -> String {
    let name = &solver.name;
    let Some(path) = &solver.path else {
        let tried = solver.tried.join(", ");
        let indent = width + 2;
        return format!(
            "{name:<width$}  not found\n{:indent$}tried {tried}\n{:indent$}{}\n",
            "", "", solver.hint
        );
    };
    let version = solver.version.as_deref().unwrap_or("(version unknown)");
    let abilities = solver.abilities.join(", ");
    format!("{name:<width$}  {version}, {}: {abilities}\n", path.display())
}

#[derive(Serialize)]
struct Report<'a> {
    name: &'a str,
    path: Option<String>,
    version: Option<&'a str>,
    abilities: &'a [String],
    tried: &'a [String],
    /// How to install it.
    hint: &'a str,
}

impl<'a> Report<'a> {
    fn new(solver: &'a Found) -> Self {
        Report {
            name: &solver.name,
            path: solver.path.as_ref().map(|p| p.display().to_string()),
            version: solver.version.as_deref(),
            abilities: &solver.abilities,
            tried: &solver.tried,
            hint: &solver.hint,
        }
    }
}
