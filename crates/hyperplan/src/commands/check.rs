//! `hyperplan check`: what is wrong with a problem file, or doubtful.

use crate::args;
use crate::config;
use crate::failure::{Outcome, Status};
use crate::load::{Loaded, read_source};
use crate::output::Output;
use crate::report;
use hyperplan_syntax::{Diagnostic, JsonDiagnostic, SourceMap, to_json};
use serde::Serialize;

/// The code of warnings about questions for which there was no time.
const UNDECIDED: &str = "vacuity-undecided";

pub(crate) fn run(args: &args::Check, verbose: bool, out: &mut Output) -> Outcome {
    let deadline = config::deadline(args.timeout)?;
    let file = args.problem.file.display().to_string();
    let source = read_source(&args.problem.file)?;
    let (loaded, sources, mut diagnostics) = Loaded::parse(&args.problem, &source);
    if let Some(problem) = &loaded {
        diagnostics.extend(hyperplan_plan::lint_systems(problem));
        for objective in &problem.objectives {
            diagnostics.extend(hyperplan_plan::lint(problem, objective, &deadline));
        }
    }
    // Whether there was time for a question says nothing about the file.
    let all = diagnostics.len();
    if !verbose {
        diagnostics.retain(|d| d.code != UNDECIDED);
    }
    let undecided = all - diagnostics.len();
    match args.output.format {
        args::Format::Text => report::diagnostics(&sources, &diagnostics, out),
        args::Format::Json => out.line(report::json(&Report::new(file.clone(), &sources, &diagnostics))?)?,
    }
    let Some(problem) = loaded else { return Ok(Status::Input) };
    if args.output.format == args::Format::Text {
        let warnings = count(diagnostics.len(), "warning");
        let systems = count(problem.systems.len(), "system");
        let objectives = count(problem.objectives.len(), "objective");
        let more = match undecided {
            0 => String::new(),
            n => format!(" ({} not decided in time, -v says which)", count(n, "question")),
        };
        out.line(format_args!("{file}: {systems}, {objectives}, {warnings}{more}"))?;
    }
    Ok(Status::Good)
}

fn count(n: usize, what: &str) -> String {
    match n {
        0 => format!("no {what}s"),
        1 => format!("1 {what}"),
        _ => format!("{n} {what}s"),
    }
}

#[derive(Serialize)]
struct Report {
    file: String,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<JsonDiagnostic>,
}

impl Report {
    fn new(file: String, sources: &SourceMap, diagnostics: &[Diagnostic]) -> Self {
        let errors = diagnostics.iter().filter(|d| d.is_error()).count();
        let warnings = diagnostics.len() - errors;
        Report {
            file,
            errors,
            warnings,
            diagnostics: diagnostics.iter().map(|d| to_json(sources, d)).collect(),
        }
    }
}
