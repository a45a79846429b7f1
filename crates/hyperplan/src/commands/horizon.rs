//! `hyperplan horizon`: how much of each path an objective reads.

use crate::args;
use crate::config;
use crate::failure::{Exit, Result};
use crate::load::Loaded;
use crate::output::Output;
use hyperplan_horizon::{Horizon, horizons};
use hyperplan_outlet::{blanks, one_line};
use hyperplan_problem::answer::Ordered;
use hyperplan_problem::{FormulaId, Mode, Objective, Semantics};
use serde::Serialize;

pub(crate) fn run(args: &args::Horizon, out: &mut Output) -> Result {
    config::deadline(args.limit.timeout, None)?;
    let loaded = Loaded::read(&args.problem, out)?;
    for objective in loaded.selected(args.selection.objective.as_deref(), true)? {
        let report = Report::new(&loaded, objective);
        match args.output.format {
            args::Format::Json => out.line(crate::report::json(&report)?)?,
            args::Format::Text => out.write(|w| write!(w, "{}", report.text(objective)))?,
        }
    }
    Ok(Exit::Good)
}

#[derive(Serialize)]
struct Report {
    file: String,
    objective: String,
    /// What `semantics` says; left out where it does not.
    #[serde(skip_serializing_if = "Option::is_none")]
    semantics: Option<&'static str>,
    horizon: Ordered<PathHorizon>,
}

#[derive(Serialize)]
struct PathHorizon {
    /// Steps that matter; `null` where the path is not read.
    steps: Option<u64>,
    /// The number by the paper's rules.
    paper: Option<u64>,
    /// What adds up to it, outermost first.
    reason: Vec<Part>,
    /// What is read last.
    reads: Option<String>,
}

#[derive(Serialize)]
struct Part {
    formula: String,
    line: usize,
    column: usize,
    steps: u64,
}

impl Report {
    fn new(loaded: &Loaded, objective: &Objective) -> Self {
        let each = objective.paths.iter().zip(horizons(objective));
        let horizon = each.map(|(path, h)| (path.name.clone(), PathHorizon::new(loaded, objective, &h)));
        Report {
            file: loaded.file.clone(),
            objective: objective.name.clone(),
            semantics: objective.semantics.map(Semantics::name),
            horizon: Ordered(horizon.collect()),
        }
    }

    fn text(&self, objective: &Objective) -> String {
        let mut text = format!("{}\n", self.objective);
        let width = self.horizon.0.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
        for (name, h) in &self.horizon.0 {
            text.push_str(&format!("  {name}{}  {}\n", blanks(name, width), h.in_words(objective)));
        }
        text
    }
}

impl PathHorizon {
    fn new(loaded: &Loaded, objective: &Objective, horizon: &Horizon) -> Self {
        let snippet = |id: FormulaId| loaded.snippet(objective.formula.spans[id]);
        let part = |&(id, steps): &(FormulaId, u64)| {
            let (line, column) = loaded.sources.position(objective.formula.spans[id]);
            Part { formula: snippet(id), line, column, steps }
        };
        PathHorizon {
            steps: horizon.steps,
            paper: horizon.paper,
            reason: horizon.reason.iter().map(part).collect(),
            reads: horizon.atom.map(snippet),
        }
    }

    fn in_words(&self, objective: &Objective) -> String {
        let Some(steps) = self.steps else { return "not read".to_owned() };
        let plural = if steps == 1 { "" } else { "s" };
        let mut words = format!("{steps} step{plural}");
        if self.paper != self.steps {
            let paper = self.paper.map_or("none".to_owned(), |n| n.to_string());
            words.push_str(&format!(" (the paper's rules: {paper})"));
        }
        if let Mode::Within(k) = objective.mode {
            words.push_str(&format!(": within {k}"));
            if let Some(semantics) = objective.semantics {
                words.push_str(&format!(" semantics {}", semantics.name()));
            }
        } else if !self.reason.is_empty() {
            let parts = self
                .reason
                .iter()
                .map(|p| format!("\n      +{} at {}:{} {}", p.steps, p.line, p.column, one_line(&p.formula)));
            words.push_str(&parts.collect::<String>());
        }
        words
    }
}
