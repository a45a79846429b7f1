//! `hyperplan explain`: why an objective has no strategy, or a counterexample, and why a given strategy fails.

mod proofs;
mod record;
mod ways;
mod words;

pub(crate) use words::{closest, in_short};

use crate::args::{self, Format};
use crate::config;
use crate::configuration::Configured;
use crate::explain::{Explain, Why};
use crate::failure::{Exit, Failure, Result};
use crate::files::make_folder;
use crate::guard;
use crate::load::{self, Given, Loaded};
use crate::output::Output;
use crate::proof::Prover;
use crate::report::json;
use hyperplan_plan::explain::{Explanation, Judged, explain, judge};
use hyperplan_plan::{self as plan, Config, Verdict};
use hyperplan_problem::{Objective, Strategy};
use record::Record;
use std::time::{Duration, Instant};
use ways::Ways;
use words::Words;

/// How long to look for reasons, where no time was said. The verdict may take what it takes.
const TIME: Duration = Duration::from_secs(30);

pub(crate) fn run(args: &args::Explain, out: &mut Output) -> Result {
    let deadline = config::deadline(args.limit.timeout, None)?;
    let solver = config::solver(&args.solver, &Configured::new(out))?;
    let config = Config { deadline, ..Config::new(solver) };
    args.proof.iter().try_for_each(|folder| make_folder(folder))?;
    let start = Instant::now();
    let text = load::text(&args.problem)?;
    let (loaded, consts) = Loaded::with_consts(&args.problem, &text, start, out)?;
    let name = args.selection.objective.as_deref();
    let limited = args.limit.timeout.is_some();
    let mut worst = Exit::Good;
    if let Some(given) = Given::of(&args.plan)? {
        for (objective, strategy) in given.strategies(&loaded, name)? {
            let config = Config { deadline: limit(&config, limited), ..config.clone() };
            let told = judged(&loaded, objective, &strategy, (&given, &config))?;
            worst = worst.max(told.status());
            told.print(args.output.format, out)?;
        }
        return Ok(worst);
    }
    let prover = |folder| Prover { folder, set: &args.problem.set, deadline: &config.deadline };
    let prover = args.proof.as_deref().map(prover);
    let ways = Ways { args: &args.problem, text: &text, consts: &consts };
    for (index, objective) in loaded.selected(name, false)?.into_iter().enumerate() {
        if index > 0 && args.output.format == Format::Text {
            out.line("")?;
        }
        match why(&loaded, objective, &ways, (&config, limited), prover.as_ref(), out) {
            Ok((told, certified)) => {
                worst = worst.max(told.status()).max(certified);
                told.print(args.output.format, out)?;
            }
            Err(failure) => {
                // The other objectives may do better.
                out.failure(&failure);
                worst = worst.max(failure.status);
            }
        }
    }
    Ok(worst)
}

/// The end of the search for reasons.
fn limit(config: &Config, limited: bool) -> hyperplan_solver::Deadline {
    if limited { config.deadline.clone() } else { config.deadline.within(TIME) }
}

/// What became of an objective, and why.
pub(crate) struct Told<'a> {
    pub(crate) loaded: &'a Loaded,
    pub(crate) objective: &'a Objective,
    pub(crate) subject: Subject,
    /// Files with certificates, where these were asked for.
    pub(crate) certificates: Vec<String>,
}

/// What is explained.
pub(crate) enum Subject {
    /// The answer for the objective: why it is undecided, or has an answer; and what is remarkable about it.
    Answer { verdict: Verdict, reason: Option<Why>, notes: Vec<String>, found: Box<Explanation> },
    /// A strategy, or counterexample.
    Given { judged: Judged, role: &'static str },
}

impl Told<'_> {
    fn status(&self) -> Exit {
        match &self.subject {
            Subject::Answer { verdict: Verdict::Realizable, .. } => Exit::Good,
            Subject::Answer { verdict: Verdict::Unrealizable, .. } => Exit::Unrealizable,
            Subject::Answer { verdict: Verdict::Unknown, .. } => Exit::Undecided,
            Subject::Given { judged: Judged::Holds, .. } => Exit::Good,
            Subject::Given { judged: Judged::Fails(_), .. } => Exit::Unrealizable,
            Subject::Given { judged: Judged::TooLarge, .. } => Exit::Undecided,
        }
    }

    fn print(&self, format: Format, out: &mut Output) -> Result<()> {
        match format {
            Format::Json => out.line(json(&Record::new(self))?),
            Format::Text => {
                let text = Words { told: self, color: out.color }.text();
                out.line(text.trim_end())
            }
        }
    }
}

/// Decides an objective, and asks why.
fn why<'a>(
    loaded: &'a Loaded,
    objective: &'a Objective,
    ways: &Ways<'_>,
    (config, limited): (&Config, bool),
    prover: Option<&Prover<'_>>,
    out: &mut Output,
) -> Result<(Told<'a>, Exit)> {
    let explain_error = |error: &plan::Error| Explain::default().failure(&objective.name, error);
    guard::doing("searching for a strategy");
    let outcome = plan::solve(&loaded.problem, objective, config).map_err(|error| explain_error(&error))?;
    guard::doing("looking for reasons");
    let config = Config { deadline: limit(config, limited), ..config.clone() };
    let mut longer = ways.of(&loaded.problem, objective);
    let found = explain(&loaded.problem, objective, &outcome, &mut longer, &config);
    let found = Box::new(found.map_err(|error| explain_error(&error))?);
    let reason = outcome.reason.as_ref().map(|reason| Why::new(reason, Explain::default()));
    let notes = outcome.notes.iter().map(|note| Explain::default().note(note)).collect();
    let subject = Subject::Answer { verdict: outcome.verdict, reason, notes, found };
    let mut told = Told { loaded, objective, subject, certificates: Vec::new() };
    let status = match prover {
        Some(prover) => {
            guard::doing("making certificates");
            told.certify(prover, &mut longer, out)?
        }
        None => Exit::Good,
    };
    Ok((told, status))
}

/// Checks a strategy, and says how it fails.
fn judged<'a>(
    loaded: &'a Loaded,
    objective: &'a Objective,
    strategy: &Strategy,
    (given, config): (&Given, &Config),
) -> Result<Told<'a>> {
    guard::doing("checking the strategy");
    let judged = judge(&loaded.problem, objective, strategy, config);
    let judged = judged.map_err(|error| Explain::default().failure(&objective.name, &error))?;
    let judged = judged.map_err(|error| Failure::input(format_args!("{}: {error}", given.name)))?;
    let role = crate::report::role(objective);
    Ok(Told { loaded, objective, subject: Subject::Given { judged, role }, certificates: Vec::new() })
}
