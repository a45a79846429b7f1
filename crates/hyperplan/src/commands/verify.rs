//! `hyperplan verify`: whether a strategy does what its objective asks, decided without any solver.

use crate::args;
use crate::failure::{Failure, Outcome, Status};
use crate::load::{Given, Loaded};
use crate::output::Output;
use crate::report;
use hyperplan_problem::answer::{WitnessPath, to_witness};
use hyperplan_problem::{Objective, Problem, Quantifier, Strategy, Trace};
use hyperplan_render::{actions_line, table};
use hyperplan_verify::{Budget, Defeat, Verdict, check};
use serde::Serialize;

pub(crate) fn run(args: &args::Verify, out: &mut Output) -> Outcome {
    let loaded = Loaded::read(&args.problem, out)?;
    let given = Given::read(&args.strategy)?;
    let mut worst = Status::Good;
    for (objective, strategy) in given.strategies(&loaded, args.selection.objective.as_deref())? {
        let verdict = check(&loaded.problem, objective, &strategy, &Budget::default());
        let verdict = verdict.map_err(|e| Failure::input(format_args!("{}: {e}", given.name)))?;
        let report = Report::new(&loaded, &given.name, objective, &verdict);
        match args.output.format {
            args::Format::Json => out.line(report::json(&report)?)?,
            args::Format::Text => {
                let text = report.text(&loaded.problem, objective, &verdict);
                out.write(|w| w.write_all(text.as_bytes()))?;
            }
        }
        worst = worst.max(report.status());
    }
    Ok(worst)
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
    fn new(loaded: &Loaded, strategy: &str, objective: &Objective, verdict: &Verdict) -> Self {
        let (verdict, reason, defeat) = match verdict {
            Verdict::Holds => ("holds", None, None),
            Verdict::Fails(defeat) => {
                let paths = match defeat {
                    Defeat::Paths(traces) => {
                        let strategy = Strategy { traces: traces.clone() };
                        Some(to_witness(&loaded.problem, objective, &strategy))
                    }
                    _ => None,
                };
                ("fails", Some(defeat.describe(objective)), paths)
            }
            Verdict::TooLarge { reached, .. } => {
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

    fn status(&self) -> Status {
        match self.verdict {
            "holds" => Status::Good,
            "fails" => Status::Unrealizable,
            _ => Status::Undecided,
        }
    }

    fn text(&self, problem: &Problem, objective: &Objective, verdict: &Verdict) -> String {
        let role = match objective.paths.first().map(|p| p.quantifier) {
            Some(Quantifier::Forall) => "counterexample",
            _ => "strategy",
        };
        let mut text = match &self.reason {
            None => format!("{}: the {role} holds, verified by search\n", self.objective),
            Some(reason) if self.verdict == "fails" => {
                format!("{}: the {role} fails: {reason}\n", self.objective)
            }
            Some(reason) => format!("{}: undecided: {reason}\n", self.objective),
        };
        if let Verdict::Fails(Defeat::Paths(traces)) = verdict {
            for trace in traces {
                text.push_str(&defeating(problem, objective, trace));
            }
        }
        text
    }
}

fn defeating(problem: &Problem, objective: &Objective, trace: &Trace) -> String {
    let name = objective.paths.get(trace.path).map_or("", |p| p.name.as_str());
    let actions = actions_line(problem, objective, trace);
    format!("\n{name}: {actions}\n{}", table(problem, objective, trace))
}
