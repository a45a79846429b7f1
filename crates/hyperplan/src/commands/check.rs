//! `hyperplan check`: what is wrong with a problem file, or doubtful.

use crate::args;
use crate::config;
use crate::failure::{Outcome, Status};
use crate::load::{Loaded, read_source};
use crate::output::Output;
use crate::report;
use hyperplan_plan::{Budget, Lints};
use hyperplan_syntax::{Diagnostic, JsonDiagnostic, SourceMap, to_json};
use serde::Serialize;

pub(crate) fn run(args: &args::Check, verbose: bool, out: &mut Output) -> Outcome {
    let deadline = config::deadline(args.timeout)?;
    let file = args.problem.file.display().to_string();
    let source = read_source(&args.problem.file)?;
    let (lowered, sources) = Loaded::lower(&args.problem, &source);
    let mut lints = Lints::default();
    let good = !lowered.has_errors();
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
    let warned = diagnostics.iter().any(|d| !d.is_error());
    match args.output.format {
        args::Format::Json => {
            let report = Report::new(file, &sources, &diagnostics, &lints);
            out.line(report::json(&report)?)?;
        }
        args::Format::Text => {
            report::diagnostics(&sources, &diagnostics, out);
            if verbose {
                report::diagnostics(&sources, &lints.undecided, out);
            }
            for note in &lints.notes {
                out.remark(format_args!("note: {note}"));
            }
            if good {
                let systems = count(lowered.problem.systems.len(), "system");
                let objectives = count(lowered.problem.objectives.len(), "objective");
                let warnings = count(diagnostics.len(), "warning");
                let more = match lints.undecided.len() {
                    0 => String::new(),
                    n if verbose => format!(" ({} undecided)", count(n, "question")),
                    n => format!(" ({} undecided, -v says which)", count(n, "question")),
                };
                out.line(format_args!("{file}: {systems}, {objectives}, {warnings}{more}"))?;
            }
        }
    }
    let denied = args.deny_warnings && warned;
    Ok(if good && !denied { Status::Good } else { Status::Input })
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

#[derive(Serialize)]
struct Report {
    file: String,
    errors: usize,
    warnings: usize,
    diagnostics: Vec<JsonDiagnostic>,
    /// Questions that were not decided; no warnings.
    undecided: Vec<JsonDiagnostic>,
    /// What was not looked at.
    notes: Vec<String>,
}

impl Report {
    fn new(file: String, sources: &SourceMap, diagnostics: &[Diagnostic], lints: &Lints) -> Self {
        let errors = diagnostics.iter().filter(|d| d.is_error()).count();
        let json = |ds: &[Diagnostic]| ds.iter().map(|d| to_json(sources, d)).collect();
        Report {
            file,
            errors,
            warnings: diagnostics.len() - errors,
            diagnostics: json(diagnostics),
            undecided: json(&lints.undecided),
            notes: lints.notes.clone(),
        }
    }
}
