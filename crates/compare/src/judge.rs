//! What is wrong with the answers: who contradicts whom, and whose fault it is.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use hyperplan_solver::Spec;
use serde::Serialize;

use crate::contest::{
    Contest, answer, is_certified, is_query, is_refuted, is_refuted_strategy, is_wrong_model,
};
use crate::record::checked;
use crate::{Answer, Record};
use hyperplan_outlet::one_line;

/// What is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A checked witness contradicts the known status.
    #[error("the known status is wrong")]
    WrongStatus,
    /// An answer contradicts the known status.
    #[error("against the known status")]
    Expected,
    /// Different solvers gave different answers, each always the same.
    #[error("solvers disagree")]
    Disagreement,
    /// One solver gave different answers, to different encodings or in different runs, whatever others said.
    #[error("a solver contradicts itself")]
    SelfContradiction,
    /// A model does not satisfy its query.
    #[error("a model fails")]
    WrongModel,
    /// The checker refutes the strategy that was found.
    #[error("a strategy is refuted")]
    RefutedStrategy,
}

/// Whose fault it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, thiserror::Error)]
#[serde(rename_all = "kebab-case")]
pub enum Fault {
    /// A solver's: it was asked the same as one that says otherwise, or got a query and no more, or its model is wrong.
    #[error("a solver's fault")]
    Solver,
    /// That of who wrote the known status, or a solver's after all, unless a witness was checked: several solvers answered,
    /// and none says what it says.
    #[error("but all agree: the status may be wrong")]
    Status,
    /// Ours, for all that is known: nothing clears the encoding.
    #[error("a bug of hyperplan's until shown otherwise")]
    Ours,
}

/// What somebody said.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Claim {
    /// The contestant.
    pub who: String,
    /// What it said; `None` where it is the witness that is wrong.
    pub answer: Option<Answer>,
    /// How the answer's witness was checked.
    pub verified: Option<String>,
    /// How many of its runs said so.
    pub runs: usize,
    /// What was said besides, the first time.
    pub message: Option<String>,
    /// Where the queries are, relative to the log.
    pub queries: Option<String>,
}

/// Something wrong with the answers to one instance.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What.
    pub kind: Kind,
    /// Whose fault it is.
    pub fault: Fault,
    /// The instance.
    pub instance: String,
    /// The right answer, where it is known.
    pub truth: Option<Answer>,
    /// Who said what.
    pub claims: Vec<Claim>,
}

impl Finding {
    /// Whose fault it is, in words.
    pub(crate) fn blame(&self) -> String {
        match self.kind {
            Kind::WrongStatus => "for a checked witness contradicts it".to_owned(),
            _ => self.fault.to_string(),
        }
    }
}

/// All that is wrong.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Judgement {
    /// By instance.
    pub findings: Vec<Finding>,
}

impl Judgement {
    /// Whether nothing is wrong.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty()
    }

    /// Who is to blame for the worst, if anything is wrong.
    pub fn fault(&self) -> Option<Fault> {
        self.findings.iter().map(|finding| finding.fault).max()
    }
}

/// Judges the answers of all runs.
pub fn judge(records: &[Record]) -> Judgement {
    judge_contest(&Contest::new(records))
}

/// Judges the answers of a contest.
pub(crate) fn judge_contest(contest: &Contest<'_>) -> Judgement {
    let mut findings = Vec::new();
    for (i, row) in contest.cells.iter().enumerate() {
        let runs: Vec<Run<'_>> = row
            .iter()
            .zip(&contest.contestants)
            .filter_map(|(cell, contestant)| Some((cell.as_ref()?, contestant)))
            .flat_map(|(cell, contestant)| {
                cell.runs.iter().map(|record| Run { who: contestant.label.as_str(), record })
            })
            .collect();
        let instance = Case { label: &contest.instances[i].label, truth: contest.truth[i], runs: &runs };
        findings.extend(instance.answers());
        findings.extend(instance.witnesses(Kind::WrongModel, is_wrong_model, Fault::Solver));
        findings.extend(instance.witnesses(Kind::RefutedStrategy, is_refuted_strategy, Fault::Ours));
    }
    Judgement { findings }
}

struct Run<'a> {
    who: &'a str,
    record: &'a Record,
}

struct Case<'a> {
    label: &'a str,
    truth: Option<Answer>,
    runs: &'a [Run<'a>],
}

impl<'a> Case<'a> {
    fn finding(&self, kind: Kind, fault: Fault, claims: Vec<Claim>) -> Finding {
        Finding { kind, fault, instance: self.label.to_owned(), truth: self.truth, claims }
    }

    /// What is wrong with the answers, once: where they contradict the known status and each other, the claims are those
    /// of all. A status that is itself wrong is told of by itself.
    fn answers(&self) -> Vec<Finding> {
        let disagreement = self.disagreement();
        if let Some(wrong) = self.wrong_status() {
            return std::iter::once(wrong).chain(disagreement).collect();
        }
        let finding = match (self.against_expected(), disagreement) {
            (Some(against), Some(other)) => {
                let fault = against.fault.max(other.fault);
                Some(Finding { fault, claims: other.claims, ..against })
            }
            (against, other) => against.or(other),
        };
        finding.into_iter().collect()
    }

    /// Checked witnesses against the known status, where they do not contradict each other too.
    fn wrong_status(&self) -> Option<Finding> {
        let truth = self.truth?;
        let against = |run: &&Run<'_>| {
            is_certified(run.record)
                && answer(run.record) == Some(truth)
                && run.record.expected.is_some_and(|expected| expected != truth)
        };
        let right: Vec<&Run<'_>> = self.runs.iter().filter(against).collect();
        (!right.is_empty()).then(|| self.finding(Kind::WrongStatus, Fault::Status, claims(&right)))
    }

    /// Answers other than the expected one.
    fn against_expected(&self) -> Option<Finding> {
        let against = |run: &&Run<'_>| {
            run.record
                .expected
                .is_some_and(|expected| answer(run.record).is_some_and(|said| said != expected))
        };
        let wrong: Vec<&Run<'_>> = self.runs.iter().filter(against).collect();
        if wrong.is_empty() {
            return None;
        }
        let several = wrong.iter().any(|run| run.record.solver != wrong[0].record.solver);
        let unanimous = self.runs.iter().filter(|run| answer(run.record).is_some()).count() == wrong.len();
        let fault = match self.fault(&wrong) {
            Fault::Solver if several && unanimous => Fault::Status,
            fault => fault,
        };
        let mut finding = self.finding(Kind::Expected, fault, claims(&wrong));
        finding.truth = wrong.iter().find_map(|run| run.record.expected);
        Some(finding)
    }

    /// Answers that contradict each other. Those whose witness failed are told of anyway.
    fn disagreement(&self) -> Option<Finding> {
        let said: Vec<&Run<'_>> =
            self.runs.iter().filter(|run| answer(run.record).is_some() && !is_refuted(run.record)).collect();
        let first = answer(said.first()?.record);
        if said.iter().all(|run| answer(run.record) == first) {
            return None;
        }
        let mut first_of = BTreeMap::new();
        let contradicts_itself = said.iter().any(|run| {
            *first_of.entry(&run.record.solver).or_insert(answer(run.record)) != answer(run.record)
        });
        let kind = if contradicts_itself { Kind::SelfContradiction } else { Kind::Disagreement };
        let wrong: Vec<&Run<'_>> = match self.truth {
            Some(_) => said.iter().copied().filter(|run| answer(run.record) != self.truth).collect(),
            None => said.clone(),
        };
        let mut finding = self.finding(kind, self.fault(&wrong), claims(&said));
        finding.claims.sort_by_key(|claim| self.truth.is_some() && claim.answer == self.truth);
        Some(finding)
    }

    /// What failed witnesses of one kind come to.
    fn witnesses(&self, kind: Kind, is: fn(&Record) -> bool, fault: Fault) -> Option<Finding> {
        let failed: Vec<&Run<'_>> = self.runs.iter().filter(|run| is(run.record)).collect();
        (!failed.is_empty()).then(|| self.finding(kind, fault, claims(&failed)))
    }

    /// Whose fault answers are that contradict something. Solvers that got the same and say different things cannot both be
    /// right; neither can a solver that got a query, as it stands in a file, and contradicts its status. Otherwise nothing
    /// clears the encoding, which is ours; and so is the embedded engine.
    fn fault(&self, wrong: &[&Run<'_>]) -> Fault {
        let contradicted = |run: &&&Run<'_>| {
            is_query(run.record)
                || self.runs.iter().any(|other| {
                    asked(other.record) == asked(run.record)
                        && answer(other.record).is_some_and(|said| Some(said) != answer(run.record))
                })
        };
        let clears = wrong.iter().all(|run| contradicted(&run));
        let external = wrong.iter().any(|run| Spec::embedded(&run.record.solver).is_none());
        if clears && external { Fault::Solver } else { Fault::Ours }
    }
}

/// Who asks the same gets the same query, or is led by the answers of the solver alone. What was left to hyperplan counts as
/// what became of it.
fn asked(record: &Record) -> (Option<&str>, Option<&str>, &str) {
    let quantifiers = record.quantifiers_used.as_deref().or(record.quantifiers.as_deref());
    let states = record.states_used.as_deref().or(record.states.as_deref());
    (quantifiers, states, &record.options)
}

/// Runs of one contestant that say the same, as one claim.
fn claims(runs: &[&Run<'_>]) -> Vec<Claim> {
    let mut found: BTreeMap<(Option<Answer>, &str, Option<&str>), Claim> = BTreeMap::new();
    for run in runs {
        let record = run.record;
        let claim =
            found.entry((answer(record), run.who, record.verified.as_deref())).or_insert_with(|| Claim {
                who: run.who.to_owned(),
                answer: answer(record),
                verified: record.verified.clone(),
                runs: 0,
                message: None,
                queries: None,
            });
        claim.runs += 1;
        claim.message = claim.message.take().or_else(|| record.message.clone());
        claim.queries = claim.queries.take().or_else(|| record.queries.clone());
    }
    found.into_values().collect()
}

/// Who said what; what was said besides stands in [`Claim::details`].
impl fmt::Display for Claim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.who)?;
        if let Some(answer) = self.answer {
            write!(f, " says {answer}")?;
        }
        if let Some(verified) = &self.verified {
            write!(f, ", {}", checked(verified))?;
        }
        if self.runs > 1 {
            write!(f, " ({} runs)", self.runs)?;
        }
        Ok(())
    }
}

impl Claim {
    /// The message, line by line, and where the queries are.
    pub fn details(&self) -> impl Iterator<Item = Cow<'_, str>> {
        let queries = self.queries.as_deref().map(|path| Cow::from(format!("queries: {}", one_line(path))));
        self.said().chain(queries)
    }

    /// The message, line by line.
    pub(crate) fn said(&self) -> impl Iterator<Item = Cow<'_, str>> {
        self.message.as_deref().unwrap_or_default().lines().map(one_line)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, {}", self.instance, self.kind, self.blame())?;
        match self.truth {
            Some(truth) => write!(f, "; known: {truth}"),
            None => Ok(()),
        }
    }
}

/// A line for each finding, an indented one for each claim, and below it what was said.
impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for finding in &self.findings {
            writeln!(f, "{finding}")?;
            for claim in &finding.claims {
                writeln!(f, "  {claim}")?;
                for line in claim.details() {
                    writeln!(f, "    {line}")?;
                }
            }
        }
        Ok(())
    }
}
