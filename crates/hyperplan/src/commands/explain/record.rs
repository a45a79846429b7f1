//! Explanations as JSON.

use super::words::part_text;
use super::{Subject, Told};
use crate::load::Loaded;
use hyperplan_plan::Verdict;
use hyperplan_plan::explain::{
    Candidate, Choice, Core, Failure, Judged, Later, Opponents, Scope, Time, Wall,
};
use hyperplan_problem::answer::{Choices, Ordered, ReasonCode, Scalar, WitnessPath, to_witness, write_state};
use hyperplan_problem::{ActionId, FormulaId, Objective, PathId, State, Strategy};
use hyperplan_syntax::{Diagnostic, JsonDiagnostic, JsonSpan, to_json};
use serde::Serialize;

/// States of a wall that are listed.
const STATES: usize = 10_000;

/// What `explain --format json` prints, an object a line for each objective.
#[derive(Serialize)]
pub(super) struct Record {
    file: String,
    objective: String,
    /// `realizable`, `unrealizable` or `unknown`; of a given strategy `holds`, `fails` or `unknown`.
    verdict: &'static str,
    reason: Option<String>,
    reason_code: Option<ReasonCode>,
    core: Option<JsonCore>,
    wall: Option<JsonWall>,
    later: Vec<JsonLater>,
    candidate: Option<JsonCandidate>,
    opponents: Option<JsonOpponents>,
    demanded: Vec<JsonDiagnostic>,
    /// How a counterexample makes the objective fail, or how a given strategy fails.
    failure: Option<JsonFailure>,
    notes: Vec<String>,
    /// Questions that were not answered.
    open: Vec<String>,
    /// Files with certificates, where these were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    certificates: Vec<String>,
}

#[derive(Serialize)]
struct Part {
    text: String,
    file: String,
    span: Option<JsonSpan>,
}

#[derive(Serialize)]
struct JsonCore {
    /// `leading`, `all` or `game`.
    scope: &'static str,
    minimal: bool,
    parts: Vec<Part>,
}

#[derive(Serialize)]
struct JsonWall {
    path: String,
    part: Part,
    /// So many states are reached, of so many that there are.
    reached: usize,
    of: usize,
    states: Vec<Ordered<Scalar>>,
}

#[derive(Serialize)]
struct JsonLater {
    /// `constant`, `within`, `interval` or `bound`.
    time: &'static str,
    name: Option<String>,
    now: i64,
    least: Option<i64>,
    /// Whether no smaller value is enough.
    proved: bool,
    /// There is nothing with the values up to this.
    refuted: i64,
}

#[derive(Serialize)]
struct JsonCandidate {
    witness: Vec<WitnessPath>,
    /// It wins unless the other player makes one of these.
    spared: Option<Choices>,
    failure: JsonFailure,
}

#[derive(Serialize)]
struct JsonFailure {
    /// What the checker says.
    reason: Option<String>,
    paths: Vec<WitnessPath>,
    parts: Vec<JsonFailing>,
    differences: Vec<JsonDifference>,
}

#[derive(Serialize)]
struct JsonFailing {
    #[serde(flatten)]
    part: Part,
    time: Option<u32>,
}

#[derive(Serialize)]
struct JsonDifference {
    path: String,
    from: String,
    starts: Option<[Ordered<Scalar>; 2]>,
    actions: Vec<JsonReplaced>,
}

#[derive(Serialize)]
struct JsonReplaced {
    time: usize,
    action: String,
    instead_of: String,
}

#[derive(Serialize)]
struct JsonOpponents {
    minimal: bool,
    /// So many choices there were.
    of: usize,
    #[serde(flatten)]
    choices: Choices,
}

impl Record {
    pub(super) fn new(told: &Told<'_>) -> Record {
        let Told { loaded, objective, subject, certificates } = told;
        let own = Own { loaded, objective };
        let mut record = Record {
            file: loaded.file.clone(),
            objective: objective.name.clone(),
            verdict: "unknown",
            reason: None,
            reason_code: None,
            core: None,
            wall: None,
            later: Vec::new(),
            candidate: None,
            opponents: None,
            demanded: Vec::new(),
            failure: None,
            notes: Vec::new(),
            open: Vec::new(),
            certificates: certificates.clone(),
        };
        match subject {
            Subject::Given { judged, .. } => match judged {
                Judged::Holds => record.verdict = "holds",
                Judged::TooLarge => {}
                Judged::Fails(failure) => {
                    record.verdict = "fails";
                    record.failure = Some(own.failure(failure));
                }
            },
            Subject::Answer { verdict, reason, notes, found } => {
                record.verdict = match verdict {
                    Verdict::Realizable => "realizable",
                    Verdict::Unrealizable => "unrealizable",
                    Verdict::Unknown => "unknown",
                };
                record.reason = reason.as_ref().map(|why| why.words.clone());
                record.reason_code = reason.as_ref().map(|why| why.code);
                record.notes = notes.clone();
                record.core = found.core.as_ref().map(|core| own.core(core));
                record.wall = found.wall.as_ref().map(|wall| own.wall(wall));
                record.later = found.later.iter().map(later).collect();
                record.candidate = found.candidate.as_ref().map(|candidate| own.candidate(candidate));
                record.opponents = found.opponents.as_ref().map(|opponents| own.opponents(opponents));
                let diagnostic = |d: &Diagnostic| to_json(&loaded.sources, &loaded.file, d);
                record.demanded = found.demanded.iter().map(diagnostic).collect();
                record.failure = found.counterexample.as_ref().map(|failure| own.failure(failure));
                record.open = found.open.iter().map(ToString::to_string).collect();
            }
        }
        record
    }
}

fn later(later: &Later) -> JsonLater {
    let (time, name) = match &later.time {
        Time::Constant(name) => ("constant", Some(name.clone())),
        Time::Within => ("within", None),
        Time::Interval => ("interval", None),
        Time::Bound => ("bound", None),
    };
    let Later { now, least, refuted, .. } = *later;
    JsonLater { time, name, now, least, proved: later.is_proved(), refuted }
}

/// What is in the names of a problem.
struct Own<'a> {
    loaded: &'a Loaded,
    objective: &'a Objective,
}

impl Own<'_> {
    fn part(&self, part: FormulaId) -> Part {
        let Own { loaded, objective } = self;
        let place = Diagnostic::note("part", objective.formula.spans[part], "");
        let JsonDiagnostic { file, span, .. } = to_json(&loaded.sources, &loaded.file, &place);
        Part { text: part_text(loaded, objective, part), file, span }
    }

    fn name(&self, path: PathId) -> String {
        self.objective.paths[path].name.clone()
    }

    fn state(&self, path: PathId, state: &State) -> Ordered<Scalar> {
        write_state(&self.loaded.problem.systems[self.objective.paths[path].system], state)
    }

    fn witness(&self, strategy: &Strategy) -> Vec<WitnessPath> {
        to_witness(&self.loaded.problem, self.objective, strategy)
    }

    fn core(&self, core: &Core) -> JsonCore {
        let scope = match core.scope {
            Scope::Leading => "leading",
            Scope::All => "all",
            Scope::Game => "game",
        };
        let parts = core.parts.iter().map(|&part| self.part(part)).collect();
        JsonCore { scope, minimal: core.minimal, parts }
    }

    fn wall(&self, wall: &Wall) -> JsonWall {
        let states = wall.reached.iter().take(STATES).map(|state| self.state(wall.path, state));
        JsonWall {
            path: self.name(wall.path),
            part: self.part(wall.part),
            reached: wall.reached.len(),
            of: wall.states,
            states: states.collect(),
        }
    }

    fn candidate(&self, candidate: &Candidate) -> JsonCandidate {
        JsonCandidate {
            witness: self.witness(&candidate.strategy),
            spared: candidate.spared.as_deref().map(|choices| self.choices(choices)),
            failure: self.failure(&candidate.failure),
        }
    }

    fn failure(&self, failure: &Failure) -> JsonFailure {
        let action = |action: ActionId| self.loaded.problem.actions[action].clone();
        let differences = failure.differences.iter().map(|difference| JsonDifference {
            path: self.name(difference.path),
            from: self.name(difference.from),
            starts: difference
                .starts
                .as_ref()
                .map(|(own, other)| [self.state(difference.path, own), self.state(difference.from, other)]),
            actions: difference
                .actions
                .iter()
                .map(|&(time, own, other)| JsonReplaced {
                    time,
                    action: action(own),
                    instead_of: action(other),
                })
                .collect(),
        });
        let parts = failure.parts.iter();
        JsonFailure {
            reason: failure.defeat.as_ref().map(|defeat| defeat.describe(self.objective)),
            paths: self.witness(&Strategy { traces: failure.paths.clone() }),
            parts: parts.map(|one| JsonFailing { part: self.part(one.part), time: one.time }).collect(),
            differences: differences.collect(),
        }
    }

    fn opponents(&self, opponents: &Opponents) -> JsonOpponents {
        let choices = self.choices(&opponents.choices);
        JsonOpponents { minimal: opponents.minimal, of: opponents.of, choices }
    }

    fn choices(&self, choices: &[Choice]) -> Choices {
        hyperplan::search::choices(&self.loaded.problem, self.objective, choices)
    }
}
