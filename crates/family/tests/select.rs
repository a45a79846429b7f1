//! Selections from random measurements.

use hyperplan_family::select::{Candidate, Criteria, Outcome, Selection, Timed, most, select};
use hyperplan_family::{About, Case, Entry, Horizon, Kind, Objective, Parameters};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Candidates on a few maps and horizons, each in several encodings, with runs of up to three solvers.
fn candidates() -> impl Strategy<Value = Vec<Candidate>> {
    let outcome = prop_oneof![
        6 => Just(Outcome::Solved),
        3 => Just(Outcome::Unsolved),
        1 => Just(Outcome::Wrong),
        1 => Just(Outcome::Error),
        1 => Just(Outcome::Unsupported),
    ];
    // Seconds from a hundredth to the limit, as many in each power of ten.
    let timed = (outcome, -2.0..1.3_f64).prop_map(|(outcome, log)| Timed {
        outcome,
        answer: None,
        seconds: 10_f64.powf(log),
    });
    let runs = prop::collection::btree_map(prop_oneof!["a", "b", "c"], timed, 0..=3);
    let one = (
        0..5_usize,
        0..4_u64,
        1..4_u32,
        0..4_usize,
        prop_oneof![9 => Just(0), 9 => Just(1), 1 => Just(2)],
        runs,
    );
    prop::collection::vec(one, 0..120).prop_map(|all| {
        let mut seen = BTreeSet::new();
        let all = all.into_iter().map(|(objective, seed, steps, encoding, status, runs)| {
            let entry =
                entry(Objective::ALL[objective], seed, steps, encoding, ["sat", "unsat", "unknown"][status]);
            Candidate { entry, runs }
        });
        all.filter(|candidate| seen.insert(candidate.entry.about.instance.clone())).collect()
    })
}

fn entry(objective: Objective, seed: u64, steps: u32, encoding: usize, status: &str) -> Entry {
    let case = Case { objective, map: Parameters { kind: Kind::Random, size: 8, density: 10, seed } };
    let (states, quantifiers, logic) = [
        ("onehot", "expand", "QF_UF"),
        ("onehot", "keep", "UF"),
        ("bitvec", "expand", "QF_BV"),
        ("bitvec", "keep", "BV"),
    ][encoding];
    let instance = format!("{case}-T{steps}-{states}-{quantifiers}");
    Entry {
        file: format!("{instance}.smt2"),
        sha256: hyperplan_family::sha256(instance.as_bytes()),
        body: hyperplan_family::sha256(instance.as_bytes()),
        bytes: 1,
        logic: logic.into(),
        status: status.into(),
        certified: false,
        problem: format!("problems/{case}.hp"),
        about: About {
            instance,
            case,
            horizon: Horizon::Least,
            steps,
            states: states.into(),
            quantifiers: quantifiers.into(),
            paths: "symbols".into(),
            pruning: "light".into(),
        },
    }
}

fn criteria(count: usize) -> Criteria {
    Criteria { count, easy_s: 1.0, limit_s: 20.0 }
}

fn question(entry: &Entry) -> (String, u32) {
    (entry.about.case.to_string(), entry.about.steps)
}

/// The difficulty, by its definition.
fn difficulty(runs: &BTreeMap<String, Timed>) -> Option<f64> {
    let mut worst = None;
    for run in runs.values() {
        let seconds = match run.outcome {
            Outcome::Solved => run.seconds,
            Outcome::Unsolved => f64::INFINITY,
            _ => continue,
        };
        worst = Some(worst.map_or(seconds, |other: f64| other.max(seconds)));
    }
    worst
}

fn text(selection: &Selection) -> String {
    serde_json::to_string(selection).expect("plain data")
}

proptest! {
    #[test]
    fn a_selection_is_as_it_is_described(all in candidates(), count in 1..60_usize, turn in any::<prop::sample::Index>()) {
        let criteria = criteria(count);
        let found = select(all.clone(), &criteria);
        prop_assert!(found.chosen.len() <= count);
        prop_assert_eq!(found.chosen.len() + found.left_out.values().sum::<usize>(), all.len());
        // The order in which candidates come does not matter.
        let mut turned = all.clone();
        if !turned.is_empty() {
            turned.rotate_left(turn.index(all.len()));
            turned.reverse();
        }
        prop_assert_eq!(text(&select(turned, &criteria)), text(&found));
        let easy = found.chosen.iter().filter(|one| one.bin == "under 1 s").count();
        prop_assert!(easy <= count / 10, "{} of {}", easy, count);
        for one in &found.chosen {
            prop_assert!(one.entry.status != "unknown");
            let seconds = difficulty(&one.runs).expect("it was measured");
            prop_assert_eq!(criteria.name(criteria.bin(seconds)), one.bin.clone());
            prop_assert_eq!(one.slowest, Some(seconds).filter(|seconds| seconds.is_finite()));
        }
        // Of one question no two encodings that are about as hard.
        for (i, one) in found.chosen.iter().enumerate() {
            for other in &found.chosen[i + 1..] {
                prop_assert!(one.entry.about.instance != other.entry.about.instance);
                if question(&one.entry) == question(&other.entry) {
                    let [a, b] = [one, other].map(|one| one.slowest.unwrap_or(20.0).clamp(1.0, 20.0));
                    prop_assert!(a.max(b) >= 3.0 * a.min(b), "{} {}", a, b);
                }
            }
        }
    }

    #[test]
    fn what_can_be_balanced_is(count in 2..40_usize, hard in 0..8_usize) {
        // More than enough of everything that is not easy: each status, logic and bin.
        let bins = [2.0, 5.0, 15.0, f64::INFINITY];
        let mut all = Vec::new();
        for (at, &seconds) in bins.iter().enumerate() {
            for status in ["sat", "unsat"] {
                for encoding in 0..4 {
                    for number in 0..12 + hard {
                        let steps = u32::try_from(at * 1000 + number * 10 + encoding).expect("small");
                        let outcome = if seconds.is_finite() { Outcome::Solved } else { Outcome::Unsolved };
                        let run = Timed { outcome, answer: None, seconds: seconds.min(20.0) };
                        let seed = u64::from(status == "sat");
                        let entry = entry(Objective::Ar, seed, steps, encoding, status);
                        all.push(Candidate { entry, runs: BTreeMap::from([("a".into(), run)]) });
                    }
                }
            }
        }
        let found = select(all, &criteria(count)).chosen;
        prop_assert_eq!(found.len(), count);
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for one in &found {
            let (status, logic) = (&one.entry.status, &one.entry.logic);
            for key in [format!("1 {status}"), format!("2 {status} {logic}"), format!("3 {status} {logic} {}", one.bin)] {
                *counts.entry(key).or_default() += 1;
            }
        }
        // Of each level, and within each cell of the level above, no count is further from another than one.
        let of = |status: &str| counts.get(&format!("1 {status}")).copied().unwrap_or(0);
        prop_assert!(of("sat").abs_diff(of("unsat")) <= 1);
        for status in ["sat", "unsat"] {
            let logics = ["QF_UF", "UF", "QF_BV", "BV"];
            let logics = logics.map(|logic| counts.get(&format!("2 {status} {logic}")).copied().unwrap_or(0));
            prop_assert!(logics.iter().max().unwrap_or(&0) - logics.iter().min().unwrap_or(&0) <= 1);
        }
        let cells: Vec<usize> = counts.iter().filter(|(key, _)| key.starts_with('3')).map(|(_, &n)| n).collect();
        prop_assert!(cells.iter().all(|&n| n <= count.div_ceil(32) + 1), "{:?}", cells);
    }

    #[test]
    fn the_most_that_can_be_chosen_can_be(all in candidates(), count in 1..100_usize) {
        let most = most(&all, &criteria(count));
        prop_assert!(most <= count);
        prop_assert_eq!(select(all, &criteria(most)).chosen.len(), most);
    }
}

#[test]
fn bins_are_logarithmic_up_to_the_limit() {
    let criteria = Criteria { count: 1, easy_s: 1.0, limit_s: 60.0 };
    let names: Vec<String> = (0..6).map(|bin| criteria.name(bin)).collect();
    assert_eq!(
        names,
        ["under 1 s", "1 to 3.16 s", "3.16 to 10 s", "10 to 31.62 s", "31.62 to 60 s", "over 60 s"]
    );
    let bins = [0.5, 1.0, 3.0, 3.2, 60.0, 60.5, f64::INFINITY].map(|seconds| criteria.bin(seconds));
    assert_eq!(bins, [0, 1, 1, 2, 4, 4, 5]);
    // A limit below what is easy leaves two bins.
    let criteria = Criteria { limit_s: 1.0, ..criteria };
    assert_eq!(
        [0.5, f64::INFINITY].map(|seconds| criteria.name(criteria.bin(seconds))),
        ["under 1 s", "over 1 s"]
    );
}

#[test]
fn encodings_stay_if_they_differ() {
    let run = |seconds| {
        BTreeMap::from([("a".to_owned(), Timed { outcome: Outcome::Solved, answer: None, seconds })])
    };
    let of = |encoding, seconds| Candidate {
        entry: entry(Objective::Ar, 0, 7, encoding, "sat"),
        runs: run(seconds),
    };
    let names = |all: Vec<Candidate>| select(all, &criteria(9)).chosen.len();
    assert_eq!(names(vec![of(0, 2.0), of(1, 5.9)]), 1);
    assert_eq!(names(vec![of(0, 2.0), of(1, 6.1)]), 2);
    assert_eq!(names(vec![of(0, 2.0), of(1, 6.1), of(2, 19.0)]), 3);
}
