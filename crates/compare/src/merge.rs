//! Logs of several machines as one.
//!
//! A log is a set of runs. Putting logs together is the union of sets: the order does not matter, and twice is as good as
//! once. What is to be made of the runs is said afterwards, of the whole set, by [`settled`]: the same set gives the same
//! outcome, whoever wrote which part of it.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use hyperplan_outlet::one_line;

use crate::contest::answer;
use crate::record::Record;

/// The records that are to be added to a log so that it has all of both.
///
/// # Errors
/// When a record is no JSON, which it always is.
pub fn added(log: &[Record], more: &[Record]) -> serde_json::Result<Vec<Record>> {
    let mut known: BTreeSet<String> = log.iter().map(serde_json::to_string).collect::<Result<_, _>>()?;
    let mut new = Vec::new();
    for record in more {
        if known.insert(serde_json::to_string(record)?) {
            new.push(record.clone());
        }
    }
    Ok(new)
}

/// What a set of records comes to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settled {
    /// A record for each run, by instance and solver. Of a run that was done several times, with the same answer or none, the
    /// one that stands for all; with both answers one of each, for the judgement.
    pub records: Vec<Record>,
    /// How many of the records were repetitions of others.
    pub repeated: usize,
    /// The runs with both answers, in words.
    pub contradictions: Vec<String>,
}

/// Makes one record of all that are about the same run, told by its key. As with medians, the later counts, and one
/// without an answer comes last. Records of old logs, which have no key, are runs of their own.
#[must_use]
pub fn settled(records: Vec<Record>) -> Settled {
    let all = records.len();
    let mut runs: BTreeMap<String, Vec<Record>> = BTreeMap::new();
    let mut kept = Vec::new();
    for record in records {
        match record.key.is_empty() {
            true => kept.push(record),
            false => runs.entry(record.key.clone()).or_default().push(record),
        }
    }
    let mut contradictions = Vec::new();
    for mut same in runs.into_values() {
        same.sort_by(later);
        let answers: BTreeSet<_> = same.iter().filter_map(answer).collect();
        if answers.len() > 1 {
            contradictions.push(contradiction(&same));
            kept.extend(answers.into_iter().filter_map(|one| {
                let mut saying = same.iter().rev().filter(|record| answer(record) == Some(one));
                saying.next().cloned()
            }));
        } else {
            kept.extend(same.pop());
        }
    }
    kept.sort_by(|a, b| about(a).cmp(&about(b)).then_with(|| later(a, b)));
    contradictions.sort();
    Settled { repeated: all - kept.len(), records: kept, contradictions }
}

/// Whether one of two outcomes of a run counts before the other; every difference matters, so that no order of the files does.
fn later(a: &Record, b: &Record) -> Ordering {
    let rank = |record: &Record| (answer(record).is_none(), record.status);
    let text = |record: &Record| serde_json::to_string(record).unwrap_or_default();
    (rank(a).0.cmp(&rank(b).0))
        .then_with(|| a.wall_s.total_cmp(&b.wall_s))
        .then_with(|| rank(a).1.cmp(&rank(b).1))
        .then_with(|| text(a).cmp(&text(b)))
}

/// What a record is about.
fn about(record: &Record) -> impl Ord + use<'_> {
    let Record { instance, states, quantifiers, set, solver, options, seed, repetition, key, .. } = record;
    ((instance, set, solver), (states, quantifiers, options), (seed, repetition), key)
}

fn contradiction(same: &[Record]) -> String {
    let said: BTreeSet<String> = same
        .iter()
        .filter(|record| answer(record).is_some())
        .map(|record| format!("{} on {}", record.status, record.host))
        .collect();
    let said: Vec<String> = said.into_iter().collect();
    let what = same.first().map_or_else(String::new, |one| {
        let words = [&one.instance].into_iter().chain(&one.set).chain([&one.solver]);
        words.map(String::as_str).collect::<Vec<_>>().join(" ")
    });
    one_line(&format!("{what}: the same run is {}", said.join(" and "))).into_owned()
}
