//! Runs on the cases of an objective, and what they come to together.
//!
//! An objective is decided where one case decides it, or all cases are decided. Nothing else is told of: a case says nothing of the
//! objective, and cases do not contradict each other.

use std::collections::BTreeMap;

use hyperplan_problem::answer::Verdict;

use crate::record::{Record, RunStatus};

/// The option of `solve` for a case, from 1.
const OPTION: &str = "--cube=";

pub(crate) fn option(index: u16, of: u16) -> String {
    format!("{OPTION}{index}/{of}")
}

/// The case that an option asks for, and of how many.
pub(crate) fn case(word: &str) -> Option<(u16, u16)> {
    let (index, of) = word.strip_prefix(OPTION)?.split_once('/')?;
    Some((index.parse().ok()?, of.parse().ok()?))
}

/// The same runs, but one for all the cases of an objective: by the case that decides it, the soonest of several, or by all.
/// CPU time is that of all cases, wall time as if all had begun at once, memory the most of any.
#[must_use]
pub fn together(records: Vec<Record>) -> Vec<Record> {
    let mut whole: Vec<Result<Record, usize>> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for record in records {
        let words: Vec<&str> = record.options.split(' ').collect();
        let Some((index, of)) = words.iter().find_map(|word| case(word)) else {
            whole.push(Ok(record));
            continue;
        };
        let rest: Vec<&str> = words.into_iter().filter(|word| case(word).is_none()).collect();
        let options = [&rest[..], &[&*format!("--cubes={of}")]].concat().join(" ");
        let Record { instance, sha256, set, solver, quantifiers, states, seed, repetition, limit, .. } =
            &record;
        let key = format!(
            "{:?}",
            (instance, sha256, set, solver, quantifiers, states, seed, repetition, limit, &options)
        );
        let group = *known.entry(key).or_insert_with(|| {
            whole.push(Err(groups.len()));
            groups.push(Group { options, of, cases: BTreeMap::new() });
            groups.len() - 1
        });
        groups[group].cases.insert(index, record);
    }
    let mut joined: Vec<Option<Record>> = groups.into_iter().map(Group::together).collect();
    whole.into_iter().filter_map(|record| record.map_or_else(|group| joined[group].take(), Some)).collect()
}

/// The cases of one run.
struct Group {
    /// The options, with that for all cases.
    options: String,
    of: u16,
    cases: BTreeMap<u16, Record>,
}

impl Group {
    fn together(self) -> Option<Record> {
        let most = |by: fn(&Record) -> f64| self.cases.values().map(by).fold(0.0, f64::max);
        let (wall_s, memory_mib) = (most(|case| case.wall_s), most(|case| case.memory_mib));
        let cpu_s = self.cases.values().map(|case| case.cpu_s).sum();
        let decisive =
            self.cases.values().filter(|case| decides(case)).min_by(|a, b| a.wall_s.total_cmp(&b.wall_s));
        let missing = usize::from(self.of) - self.cases.len().min(self.of.into());
        let (mut base, status, message, wall_s) = match (decisive, self.open()) {
            (Some(case), _) => (case.clone(), case.status, None, case.wall_s),
            (None, Some((index, open))) => {
                let why = open.message.clone().unwrap_or_else(|| open.status.to_string());
                (open.clone(), open.status, Some(format!("case {index} of {}: {why}", self.of)), wall_s)
            }
            (None, None) => {
                let first = self.cases.values().next()?.clone();
                let message = (missing > 0).then(|| format!("{missing} of {} cases were not run", self.of));
                let status = if missing > 0 { RunStatus::Unknown } else { first.status };
                (first, status, message, wall_s)
            }
        };
        base.case = None;
        Some(Record { options: self.options, status, message, wall_s, cpu_s, memory_mib, ..base })
    }

    /// The first case without an answer, those that went wrong first.
    fn open(&self) -> Option<(u16, &Record)> {
        let open = self.cases.iter().filter(|(_, case)| !is_decided(case));
        open.min_by_key(|(index, case)| (case.status != RunStatus::Error, **index))
            .map(|(index, case)| (*index, case))
    }
}

fn is_decided(record: &Record) -> bool {
    matches!(record.status, RunStatus::Sat | RunStatus::Unsat)
}

fn decides(record: &Record) -> bool {
    let status = record.case.map(|case| match case.decides {
        Verdict::Realizable => RunStatus::Sat,
        _ => RunStatus::Unsat,
    });
    status == Some(record.status)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::tests::record;
    use hyperplan_problem::answer::Case;

    fn run(index: u16, of: u16, status: RunStatus, decides: Verdict) -> Record {
        Record {
            options: format!("--no-verify {}", option(index, of)),
            status,
            wall_s: f64::from(index),
            case: is_decided(&Record { status, ..record("") }).then_some(Case {
                index: index.into(),
                of: of.into(),
                decides,
            }),
            ..record(&format!("{index}"))
        }
    }

    /// All combinations of what three cases can come to, and any of them missing.
    #[test]
    fn one_case_or_all_decide() {
        let each = [None, Some(RunStatus::Sat), Some(RunStatus::Unsat), Some(RunStatus::Timeout)];
        for decides in [Verdict::Realizable, Verdict::Unrealizable] {
            let (good, other) = match decides {
                Verdict::Realizable => (RunStatus::Sat, RunStatus::Unsat),
                _ => (RunStatus::Unsat, RunStatus::Sat),
            };
            for code in 1..64usize {
                let statuses = [each[code % 4], each[code / 4 % 4], each[code / 16]];
                let cases = statuses
                    .iter()
                    .zip(1..)
                    .filter_map(|(status, index)| Some(run(index, 3, (*status)?, decides)));
                let mut cases: Vec<Record> = cases.collect();
                cases.push(record("another"));
                let joined = together(cases);
                assert_eq!(joined.len(), 2);
                let whole =
                    joined.iter().find(|run| run.options == "--no-verify --cubes=3").expect("one is joined");
                let expected = if statuses.contains(&Some(good)) {
                    good
                } else if statuses.contains(&Some(RunStatus::Timeout)) {
                    RunStatus::Timeout
                } else if statuses.contains(&None) {
                    RunStatus::Unknown
                } else {
                    other
                };
                assert_eq!(whole.status, expected, "{statuses:?}");
                let sums = statuses.iter().flatten().count() as f64 * record("").cpu_s;
                assert!((whole.cpu_s - sums).abs() < 1e-9);
                if let Some(place) = statuses.iter().position(|status| *status == Some(good)) {
                    assert!((whole.wall_s - (place + 1) as f64).abs() < 1e-9);
                }
            }
        }
    }

    #[test]
    fn different_runs_are_not_joined() {
        let mut other = run(2, 2, RunStatus::Unsat, Verdict::Realizable);
        other.seed = 1;
        let cases = vec![run(1, 2, RunStatus::Unsat, Verdict::Realizable), other];
        assert!(together(cases).iter().all(|run| run.status == RunStatus::Unknown));
    }
}
