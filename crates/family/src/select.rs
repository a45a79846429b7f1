//! Some of a family's benchmarks, chosen by how hard they were measured to be.
//!
//! Competitions drop what every solver does within a second, and what is like something else. So the *difficulty* of a
//! benchmark is the wall time of the slowest solver that takes it, and a benchmark that one of them leaves unsolved is
//! beyond the limit. Difficulties fall into bins: below [`Criteria::easy_s`], from there on two to each power of ten up to
//! the limit, and beyond. A selection is made one benchmark after the other, each time from the status, of those the logic,
//! of those the bin, of those the source (objective and kind of map) with the fewest so far; among equals the digest of
//! what it asks decides, which has to do with nothing. The same candidates and runs give the same selection, in whatever
//! order they come.

use crate::record::Entry;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fmt;

/// Encodings of one question are not alike if their difficulties differ by this factor.
const APART: f64 = 3.0;
/// One in so many of a selection may be easy.
const EASY: usize = 10;
/// What stands for the version of a solver that says none.
pub const UNKNOWN: &str = "unknown";
/// The square root of 10: from one bin to the next.
const STEP: f64 = 3.162_277_660_168_379_5;

/// What a solver made of a benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It gave the right answer, as far as is known.
    Solved,
    /// It found no answer within its limits.
    Unsolved,
    /// Its answer contradicts the status, or its model fails.
    Wrong,
    /// It failed.
    Error,
    /// It does not take such benchmarks.
    Unsupported,
}

/// A run of a solver on a benchmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// What came of it.
    pub outcome: Outcome,
    /// What it says, right or wrong.
    pub answer: Option<String>,
    /// Wall time, in seconds.
    pub seconds: f64,
}

impl Timed {
    /// What the header says of it: where the answer is wrong, or the solver failed. What does not fit between `|` is left
    /// out of names.
    #[must_use]
    pub fn remark(&self, solver: &str, versions: &BTreeMap<String, String>) -> Option<String> {
        let what = match (self.outcome, &self.answer) {
            (Outcome::Wrong, Some(answer)) => format!("says {answer}, which is wrong"),
            (Outcome::Wrong, None) => "gives a model that fails".to_owned(),
            (Outcome::Error, _) => "ends with an error".to_owned(),
            (Outcome::Solved | Outcome::Unsolved | Outcome::Unsupported, _) => return None,
        };
        let version = versions.get(solver).filter(|version| *version != UNKNOWN);
        let version = version.map_or(String::new(), |version| format!(" {version}"));
        let plain = |c: char| if c == '|' || c == '\\' || !(' '..='~').contains(&c) { '?' } else { c };
        let who: String = format!("{solver}{version}").chars().take(100).map(plain).collect();
        Some(format!("Measured: {who} {what}."))
    }
}

impl fmt::Display for Timed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.outcome {
            Outcome::Solved => write!(f, "{}", self.seconds),
            other => other.serialize(f),
        }
    }
}

/// A benchmark with lines added to what its header says of it; unchanged where it has no header like ours.
#[must_use]
pub fn remarked(text: &[u8], remarks: &[String]) -> Vec<u8> {
    let end = b"\n|)\n";
    let Some(at) = text.windows(end.len()).position(|window| window == end) else { return text.to_vec() };
    let lines: String = remarks.iter().map(|line| format!("\n{line}")).collect();
    [&text[..at], lines.as_bytes(), &text[at..]].concat()
}

/// A benchmark that may be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The benchmark.
    pub entry: Entry,
    /// Its runs, by solver.
    pub runs: BTreeMap<String, Timed>,
}

/// What is asked of a selection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Criteria {
    /// How many benchmarks it has.
    pub count: usize,
    /// What all solvers do within so many seconds is easy.
    pub easy_s: f64,
    /// The limit of the runs, in seconds.
    pub limit_s: f64,
}

/// A benchmark that was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chosen {
    /// The benchmark.
    #[serde(flatten)]
    pub entry: Entry,
    /// The bin of its difficulty.
    pub bin: String,
    /// The seconds of the slowest solver; none where one solved it not.
    pub slowest: Option<f64>,
    /// Its runs, by solver.
    pub runs: BTreeMap<String, Timed>,
}

/// What was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Selection {
    /// The benchmarks, by name.
    pub chosen: Vec<Chosen>,
    /// How many candidates were not chosen, by the reason.
    pub left_out: BTreeMap<&'static str, usize>,
}

impl Candidate {
    /// The seconds of the slowest solver that takes it, without end where that did not solve it; `None` where no solver
    /// takes it. Wrong answers and failures say nothing of difficulty.
    #[must_use]
    pub fn difficulty(&self) -> Option<f64> {
        let seconds = self.runs.values().filter_map(|run| match run.outcome {
            Outcome::Solved => Some(run.seconds),
            Outcome::Unsolved => Some(f64::INFINITY),
            Outcome::Wrong | Outcome::Error | Outcome::Unsupported => None,
        });
        seconds.max_by(f64::total_cmp)
    }
}

impl Criteria {
    /// Where bins begin, but for the first. The last is beyond the limit.
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        let inner = std::iter::successors(Some(self.easy_s), |edge| Some(edge * STEP));
        // What is left to the limit is a bin only if it is worth one.
        let inner = inner.take_while(|edge| *edge * 1.05 < self.limit_s);
        inner.chain([self.limit_s]).collect()
    }

    /// The bin of a difficulty, from 0.
    #[must_use]
    pub fn bin(&self, difficulty: f64) -> usize {
        let edges = self.edges();
        let bin = edges.iter().take_while(|edge| **edge <= difficulty).count();
        // A solver that ends on the very limit has solved it.
        if difficulty.is_finite() { bin.min(edges.len() - 1) } else { edges.len() }
    }

    /// A bin in words.
    #[must_use]
    pub fn name(&self, bin: usize) -> String {
        let edges = self.edges();
        let seconds = |edge: f64| format!("{}", (edge * 100.0).round() / 100.0);
        match (bin, edges.get(bin)) {
            (_, None) => format!("over {} s", seconds(self.limit_s)),
            (0, Some(&end)) => format!("under {} s", seconds(end)),
            (_, Some(&end)) => format!("{} to {} s", seconds(edges[bin - 1]), seconds(end)),
        }
    }

    /// Whether two encodings of one question are alike. Below what is easy, and beyond the limit, nothing is told apart.
    fn are_alike(&self, a: f64, b: f64) -> bool {
        let [a, b] = [a, b].map(|seconds| seconds.max(self.easy_s).min(self.limit_s));
        a.max(b) < APART * a.min(b)
    }
}

/// How many were chosen so far of each of a candidate's keys.
#[derive(Default)]
struct Counts(BTreeMap<String, usize>);

impl Counts {
    fn add(&mut self, rated: &Rated) {
        for key in &rated.keys {
            *self.0.entry(key.clone()).or_default() += 1;
        }
    }

    /// Less is what there are fewer of.
    fn compare(&self, a: &Rated, b: &Rated) -> Ordering {
        let of = |key| self.0.get(key).copied().unwrap_or(0);
        a.keys.iter().map(of).cmp(b.keys.iter().map(of))
    }
}

/// A candidate with what is asked about it again and again.
struct Rated {
    candidate: Candidate,
    question: String,
    difficulty: f64,
    bin: usize,
    /// What is to be balanced, the most important first: statuses, their logics, of these the bins, and sources.
    keys: [String; 4],
}

impl Rated {
    fn new(candidate: Candidate, difficulty: f64, criteria: &Criteria) -> Rated {
        let Entry { status, logic, about, .. } = &candidate.entry;
        let bin = criteria.bin(difficulty);
        let keys = [
            status.clone(),
            format!("{status} {logic}"),
            format!("{status} {logic} {bin}"),
            format!("of {}", about.case.source()),
        ];
        let question = format!("{}-T{}", about.case, about.steps);
        Rated { question, difficulty, bin, keys, candidate }
    }

    fn chosen(self, criteria: &Criteria) -> Chosen {
        let Candidate { entry, runs } = self.candidate;
        let slowest = Some(self.difficulty).filter(|seconds| seconds.is_finite());
        Chosen { entry, bin: criteria.name(self.bin), slowest, runs }
    }
}

/// Chooses [`Criteria::count`] of the candidates, or as many as there are that may be chosen.
///
/// What is chosen: only what has a status and was measured; of one question (objective, map and horizon) several
/// encodings only if the difficulties of any two differ by a factor of 3; of what is easy no more than a tenth of the
/// count.
#[must_use]
pub fn select(candidates: Vec<Candidate>, criteria: &Criteria) -> Selection {
    let mut left_out: BTreeMap<&'static str, usize> = BTreeMap::new();
    let mut leave = |why, number| *left_out.entry(why).or_default() += number;
    let mut left = Vec::new();
    for candidate in candidates {
        match (candidate.entry.status.as_str(), candidate.difficulty()) {
            ("unknown", _) => leave("the status is unknown", 1),
            (_, None) => leave("no solver that was run takes it", 1),
            (_, Some(difficulty)) => left.push(Rated::new(candidate, difficulty, criteria)),
        }
    }
    // An order that does not depend on how they came.
    let digest = |rated: &Rated| {
        let entry = &rated.candidate.entry;
        (entry.body.clone(), entry.about.instance.clone())
    };
    left.sort_by_cached_key(digest);
    let (mut counts, mut easy, mut chosen) = (Counts::default(), 0, Vec::new());
    while chosen.len() < criteria.count {
        let allowed = |rated: &Rated| rated.bin > 0 || easy < criteria.count / EASY;
        let open = left.iter().enumerate().filter(|(_, rated)| allowed(rated));
        // Of equals `min_by` takes the first.
        let Some((at, _)) = open.min_by(|a, b| counts.compare(a.1, b.1)) else { break };
        let next = left.remove(at);
        counts.add(&next);
        easy += usize::from(next.bin == 0);
        let before = left.len();
        left.retain(|other| {
            other.question != next.question || !criteria.are_alike(other.difficulty, next.difficulty)
        });
        leave("it asks what another asks that was chosen, and is about as hard", before - left.len());
        chosen.push(next.chosen(criteria));
    }
    let rest = left.iter().filter(|rated| rated.bin == 0 && easy >= criteria.count / EASY).count();
    leave("it is easy, and a tenth of the selection is already", rest);
    leave("others were taken in its place", left.len() - rest);
    left_out.retain(|_, number| *number > 0);
    chosen.sort_by(|a, b| a.entry.about.instance.cmp(&b.entry.about.instance));
    Selection { chosen, left_out }
}

/// The largest count, up to that of the criteria, of which as many can be chosen.
#[must_use]
pub fn most(candidates: &[Candidate], criteria: &Criteria) -> usize {
    let mut count = criteria.count;
    loop {
        // With fewer in all, fewer may be easy.
        let found = select(candidates.to_vec(), &Criteria { count, ..*criteria }).chosen.len();
        if found >= count {
            return count;
        }
        count = found;
    }
}
