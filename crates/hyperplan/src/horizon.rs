//! How much of each path matters, in the problem's own words.

use hyperplan_horizon::Horizon;
use hyperplan_problem::{FormulaId, Objective};
use hyperplan_syntax::{SourceMap, Span};
use serde::Serialize;

/// How many steps of a path matter, and why.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PathHorizon {
    /// Steps that matter; `None` where the path is not read.
    pub steps: Option<u64>,
    /// The number by the paper's rules.
    pub paper: Option<u64>,
    /// What adds up to it, outermost first.
    pub reason: Vec<HorizonPart>,
    /// What is read last.
    pub reads: Option<String>,
}

/// A part of a formula that adds to a horizon.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct HorizonPart {
    /// The part, on one line.
    pub formula: String,
    /// Where it stands, from 1.
    pub line: usize,
    /// Its column, from 1.
    pub column: usize,
    /// What it adds.
    pub steps: u64,
}

impl PathHorizon {
    /// As the texts say it that an objective was read from.
    #[must_use]
    pub fn new(sources: &SourceMap, objective: &Objective, horizon: &Horizon) -> Self {
        let snippet = |id: FormulaId| snippet(sources, objective.formula.spans[id]);
        let part = |&(id, steps): &(FormulaId, u64)| {
            let (line, column) = sources.position(objective.formula.spans[id]);
            HorizonPart { formula: snippet(id), line, column, steps }
        };
        PathHorizon {
            steps: horizon.steps,
            paper: horizon.paper,
            reason: horizon.reason.iter().map(part).collect(),
            reads: horizon.atom.map(snippet),
        }
    }
}

/// Characters of a formula that are shown on a line.
const SHOWN: usize = 60;

/// What is written at a place, on one line.
#[must_use]
pub fn snippet(sources: &SourceMap, span: Span) -> String {
    let words: Vec<&str> = sources.snippet(span).split_whitespace().collect();
    let line = words.join(" ");
    match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}
