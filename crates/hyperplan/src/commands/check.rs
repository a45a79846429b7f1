//! `hyperplan check`: what is wrong with a problem file, or doubtful.

use crate::args;
use crate::config;
use crate::failure::{Exit, Result};
use crate::load::{self, Loaded};
use crate::output::Output;
use crate::report;
use hyperplan::foreign;
use hyperplan_outlet::one_line;
use hyperplan_plan::{Budget, Lints};
use hyperplan_problem::Overrides;
use hyperplan_syntax::{SourceId, parse, print, to_json};

pub(crate) fn run(args: &args::Check, verbose: bool, out: &mut Output) -> Result {
    let deadline = config::deadline(args.limit.timeout, None)?;
    let file = args.problem.file.display().to_string();
    let source = load::text(&args.problem)?;
    let (lowered, sources) = Loaded::lower(&args.problem, &source);
    let good = !lowered.has_errors();
    if args.print {
        report::diagnostics(&sources, &lowered.diagnostics, out);
        return if good { formatted(&args.problem, &source, out) } else { Ok(Exit::Input) };
    }
    let mut lints = Lints::default();
    if good {
        lints.warnings.extend(lowered.unused);
        add(&mut lints, hyperplan_plan::lint_systems(&lowered.problem, &deadline));
        for objective in &lowered.problem.objectives {
            let found = hyperplan_plan::lint(&lowered.problem, objective, &deadline, Budget::default());
            add(&mut lints, found);
        }
    }
    let mut diagnostics = lowered.diagnostics;
    diagnostics.append(&mut lints.warnings);
    let warnings = diagnostics.iter().filter(|d| !d.is_error()).count();
    // Whether there was time for a question says nothing about the file.
    let undecided = lints.undecided.len();
    if verbose {
        diagnostics.append(&mut lints.undecided);
    }
    match args.format {
        args::Format::Text => report::diagnostics(&sources, &diagnostics, out),
        args::Format::Json => {
            for diagnostic in &diagnostics {
                out.line(report::json(&to_json(&sources, &file, diagnostic))?)?;
            }
        }
    }
    for note in &lints.notes {
        out.remark(format_args!("note: {note}"));
    }
    if good && args.format == args::Format::Text {
        let systems =
            count(lowered.problem.systems.iter().filter(|system| system.base.is_none()).count(), "system");
        let objectives = count(lowered.problem.objectives.len(), "objective");
        let more = match undecided {
            0 => String::new(),
            n if verbose => format!(" ({} undecided)", count(n, "question")),
            n => format!(" ({} undecided, -v says which)", count(n, "question")),
        };
        let file = one_line(&file);
        out.line(format_args!("{file}: {systems}, {objectives}, {}{more}", count(warnings, "warning")))?;
    }
    let denied = args.deny_warnings && warnings > 0;
    Ok(if good && !denied { Exit::Good } else { Exit::Input })
}

fn add(all: &mut Lints, mut more: Lints) {
    all.warnings.append(&mut more.warnings);
    all.undecided.append(&mut more.undecided);
    all.notes.append(&mut more.notes);
}

fn count(n: usize, what: &str) -> String {
    match n {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        _ => format!("{n} {what}s"),
    }
}

/// Prints the file as its syntax tree says, with its comments.
fn formatted(problem: &args::Problem, text: &str, out: &mut Output) -> Result {
    match &problem.foreign {
        Some(given) => out.verbatim(&foreign::text(&given.read(&Overrides::default()).2))?,
        None => out.verbatim(&print(&parse(SourceId(0), text).0, text))?,
    }
    out.flush()?;
    Ok(Exit::Good)
}
