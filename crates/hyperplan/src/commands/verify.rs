//! `hyperplan verify`: whether a strategy does what its objective asks, decided without any solver.

use crate::args;
use crate::config;
use crate::explain::Explain;
use crate::failure::{Exit, Failure, Result};
use crate::files::{self, read_source, write_bytes};
use crate::guard;
use crate::load::{Given, Loaded};
use crate::output::Output;
use crate::report;
use hyperplan_outlet::one_line;
use hyperplan_plan::{Error, Unsupported, strategy_of_model};
use hyperplan_problem::answer::{WitnessPath, to_witness};
use hyperplan_problem::{Objective, Problem, Strategy, Trace};
use hyperplan_render::{actions_line, table};
use hyperplan_solver::{Deadline, PrintedModel};
use hyperplan_verify::{Budget, Check, Defeat, check};
use serde::Serialize;
use std::path::Path;

pub(crate) fn run(args: &args::Verify, out: &mut Output) -> Result {
    let deadline = config::deadline(args.limit.timeout, None)?;
    let loaded = Loaded::read(&args.problem, out)?;
    let name = args.selection.objective.as_deref();
    let (given, strategies) = match (Given::of(&args.plan)?, &args.model) {
        (Some(given), _) => {
            let strategies = given.strategies(&loaded, name)?;
            (given.name, strategies)
        }
        (None, Some(file)) => (file.display().to_string(), of_model(&loaded, name, file, &deadline)?),
        (None, None) => return Err(Failure::input("a strategy or a model is needed")),
    };
    if let Some(path) = &args.save {
        save(&loaded, &strategies, path)?;
    }
    guard::doing("checking the strategy");
    let mut worst = Exit::Good;
    for (objective, strategy) in strategies {
        let verdict = check(&loaded.problem, objective, &strategy, &Budget::default());
        let verdict = verdict.map_err(|e| Failure::input(format_args!("{given}: {e}")))?;
        let report = Report::new(&loaded, &given, objective, &verdict);
        match args.output.format {
            args::Format::Json => out.line(report::json(&report)?)?,
            args::Format::Text => {
                let mut text = report.text(&loaded.problem, objective, &verdict);
                // A model does not show the paths that it describes.
                for trace in strategy.traces.iter().filter(|_| args.model.is_some()) {
                    text.push_str(&shown(&loaded.problem, objective, trace));
                }
                out.write(|w| w.write_all(text.as_bytes()))?;
            }
        }
        worst = worst.max(report.status());
    }
    Ok(worst)
}

/// The strategy that a printed model describes.
fn of_model<'l>(
    loaded: &'l Loaded,
    name: Option<&str>,
    file: &Path,
    deadline: &Deadline,
) -> Result<Vec<(&'l Objective, Strategy)>> {
    let shown = files::name(file);
    let text = read_source(file)?;
    let model = PrintedModel::read(&text);
    let model = model.map_err(|e| Failure::input(format_args!("{shown} is no model: {e}")))?;
    let objectives = loaded.selected(name, false)?;
    let strategy = |objective: &'l Objective| {
        let strategy = strategy_of_model(&loaded.problem, objective, &model, deadline);
        let strategy = strategy.map_err(|error| {
            let failure = Failure::input(format_args!("{shown}: {}", Explain::default().error(&error)));
            match error {
                Error::Unsupported(Unsupported::LargeModel) => Failure { status: Exit::Undecided, ..failure },
                _ => failure,
            }
        })?;
        Ok((objective, strategy))
    };
    objectives.into_iter().map(strategy).collect()
}

/// Saves strategies as `verify` and `plot` read them, a line each.
fn save(loaded: &Loaded, strategies: &[(&Objective, Strategy)], path: &Path) -> Result<()> {
    let mut text = String::new();
    for (objective, strategy) in strategies {
        let witness = to_witness(&loaded.problem, objective, strategy);
        let saved = Saved { file: &loaded.file, objective: &objective.name, witness };
        text += &report::json(&saved)?;
        text.push('\n');
    }
    write_bytes(path, text.as_bytes())
}

/// A strategy without a verdict.
#[derive(Serialize)]
struct Saved<'a> {
    file: &'a str,
    objective: &'a str,
    witness: Vec<WitnessPath>,
}

#[derive(Serialize)]
struct Report {
    file: String,
    strategy: String,
    objective: String,
    /// `holds`, `fails` or `unknown`.
    verdict: &'static str,
    reason: Option<String>,
    /// Paths that defeat the strategy.
    defeat: Option<Vec<WitnessPath>>,
}

impl Report {
    fn new(loaded: &Loaded, strategy: &str, objective: &Objective, verdict: &Check) -> Self {
        let (verdict, reason, defeat) = match verdict {
            Check::Holds => ("holds", None, None),
            Check::Fails(defeat) => {
                let paths = match defeat {
                    Defeat::Paths(traces) => {
                        let strategy = Strategy { traces: traces.clone() };
                        Some(to_witness(&loaded.problem, objective, &strategy))
                    }
                    _ => None,
                };
                ("fails", Some(defeat.describe(objective)), paths)
            }
            Check::TooLarge { reached, .. } => {
                let systems = objective.paths.iter().map(|path| &loaded.problem.systems[path.system]);
                let unbounded = systems.into_iter().find(|system| !system.is_finite());
                let reason = match unbounded {
                    Some(system) => format!(
                        "system {} has infinitely many paths that compete; this takes a solver, as in `solve`",
                        system.name
                    ),
                    None => format!("too large to enumerate: gave up after {} joint moves", reached.moves),
                };
                ("unknown", Some(reason), None)
            }
        };
        Report {
            file: loaded.file.clone(),
            strategy: strategy.to_owned(),
            objective: objective.name.clone(),
            verdict,
            reason,
            defeat,
        }
    }

    fn status(&self) -> Exit {
        match self.verdict {
            "holds" => Exit::Good,
            "fails" => Exit::Unrealizable,
            _ => Exit::Undecided,
        }
    }

    fn text(&self, problem: &Problem, objective: &Objective, verdict: &Check) -> String {
        let role = report::role(objective);
        let mut text = match &self.reason {
            None => format!("{}: the {role} holds, verified by search\n", self.objective),
            Some(reason) if self.verdict == "fails" => {
                format!("{}: the {role} fails: {}\n", self.objective, one_line(reason))
            }
            Some(reason) => format!("{}: undecided: {}\n", self.objective, one_line(reason)),
        };
        if let Check::Fails(Defeat::Paths(traces)) = verdict {
            for trace in traces {
                text.push_str(&shown(problem, objective, trace));
            }
        }
        text
    }
}

fn shown(problem: &Problem, objective: &Objective, trace: &Trace) -> String {
    let name = objective.paths.get(trace.path).map_or("", |p| p.name.as_str());
    let actions = actions_line(problem, objective, trace);
    format!("\n{name}: {actions}\n{}", table(problem, objective, trace))
}
