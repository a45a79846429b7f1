//! `hyperplan solvers`: which solvers there are, what each can do, and how to get the others.

use crate::args::{self, Format};
use crate::configuration::{self, Configured};
use crate::failure::{Exit, Result};
use crate::output::Output;
use crate::report::json;
use hyperplan_outlet::{blanks, one_line};
use hyperplan_solver::{Found, Install};
use serde::Serialize;

pub(crate) fn run(args: &args::Solvers, out: &mut Output) -> Result {
    if args.trust || args.no_trust {
        // Nothing is run yet.
        let done = if args.trust { configuration::trust(out) } else { configuration::distrust(out) };
        return done.map(|()| Exit::Good);
    }
    let catalog = Configured::new(out).catalog()?.clone();
    let found = catalog.discover();
    match args.output.format {
        Format::Json => found.iter().try_for_each(|solver| out.line(json(&Report::new(solver))?))?,
        Format::Text => {
            let width = found.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
            let text: String = found.iter().map(|solver| describe(solver, width)).collect();
            out.line(text.trim_end())?;
            for file in catalog.files() {
                out.remark(format_args!("note: {} was read", file.display()));
            }
        }
    }
    Ok(Exit::Good)
}

/// A line for where a solver is, and lines for what it can do; for one that was not found, what was tried, and how to
/// install it.
fn describe(solver: &Found, width: usize) -> String {
    let mut lines = Vec::new();
    match &solver.path {
        Some(path) => {
            lines.push(format!(
                "{}, {}",
                solver.version.as_deref().unwrap_or("(version unknown)"),
                path.display()
            ));
            lines.push(match solver.abilities.as_slice() {
                [] => "it answered no question".to_owned(),
                abilities => abilities.join(", "),
            });
            lines.extend(solver.faults.iter().map(|fault| format!("WRONG on {fault}")));
        }
        None => {
            lines.push("not found".to_owned());
            if !solver.is_embedded {
                lines.push(format!("tried {}", solver.tried.join(", ")));
            }
            lines.push(solver.hint.clone());
        }
    }
    let lines: Vec<_> = lines.iter().map(|line| one_line(line)).collect();
    let below = format!("\n{}", blanks("", width + 2));
    format!("{}{}  {}\n", solver.name, blanks(&solver.name, width), lines.join(&below))
}

#[derive(Serialize)]
struct Report<'a> {
    name: &'a str,
    /// Whether it is part of hyperplan.
    embedded: bool,
    path: Option<String>,
    version: Option<&'a str>,
    abilities: &'a [String],
    /// Small questions that it answered wrong.
    faults: &'a [String],
    tried: &'a [String],
    /// How to install it, in words.
    hint: &'a str,
    /// Commands for each kind of system, and an address that says more.
    install: &'a Install,
    /// The configuration file that describes it.
    origin: Option<String>,
}

impl<'a> Report<'a> {
    fn new(solver: &'a Found) -> Self {
        Report {
            name: &solver.name,
            embedded: solver.is_embedded,
            path: solver.path.as_ref().map(|p| p.display().to_string()),
            version: solver.version.as_deref(),
            abilities: &solver.abilities,
            faults: &solver.faults,
            tried: &solver.tried,
            hint: &solver.hint,
            install: &solver.install,
            origin: solver.origin.as_ref().map(|p| p.display().to_string()),
        }
    }
}
