//! `hyperplan horizon`: how much of each path an objective reads.

use crate::args;
use crate::config;
use crate::failure::{Exit, Result};
use crate::load::Loaded;
use crate::output::Output;
use hyperplan::PathHorizon;
use hyperplan_horizon::horizons;
use hyperplan_outlet::{blanks, one_line};
use hyperplan_problem::answer::Ordered;
use hyperplan_problem::{Mode, Objective, Semantics};
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

impl Report {
    fn new(loaded: &Loaded, objective: &Objective) -> Self {
        let each = objective.paths.iter().zip(horizons(objective));
        let horizon =
            each.map(|(path, h)| (path.name.clone(), PathHorizon::new(&loaded.sources, objective, &h)));
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
            text.push_str(&format!("  {name}{}  {}\n", blanks(name, width), in_words(h, objective)));
        }
        text
    }
}

fn in_words(horizon: &PathHorizon, objective: &Objective) -> String {
    let Some(steps) = horizon.steps else { return "not read".to_owned() };
    let plural = if steps == 1 { "" } else { "s" };
    let mut words = format!("{steps} step{plural}");
    if horizon.paper != horizon.steps {
        let paper = horizon.paper.map_or("none".to_owned(), |n| n.to_string());
        words.push_str(&format!(" (the paper's rules: {paper})"));
    }
    if let Mode::Within(k) = objective.mode {
        words.push_str(&format!(": within {k}"));
        if let Some(semantics) = objective.semantics {
            words.push_str(&format!(" semantics {}", semantics.name()));
        }
    } else if !horizon.reason.is_empty() {
        let parts = horizon
            .reason
            .iter()
            .map(|p| format!("\n      +{} at {}:{} {}", p.steps, p.line, p.column, one_line(&p.formula)));
        words.push_str(&parts.collect::<String>());
    }
    words
}
