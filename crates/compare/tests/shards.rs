//! A comparison cut into pieces comes to the same as a whole one.

mod sample;

use hyperplan_compare::merge::{added, settled};
use hyperplan_compare::plan::{Candidate, Instance, Kind, Ways, plan};
use hyperplan_compare::share::{expected, shares};
use hyperplan_compare::{Limit, Log, Record, RunStatus, judge};
use hyperplan_random::{Random, property};
use std::fs;
use std::path::Path;
use std::sync::Arc;

#[test]
fn shares_are_balanced() {
    property(100, 400, |random| {
        let seconds: Vec<f64> = (0..random.below(60)).map(|_| f64::from(random.bound(1000)) / 7.0).collect();
        let of = 1 + random.below(9);
        let share = shares(&seconds, of);
        assert_eq!(share, shares(&seconds, of));
        let mut sums = vec![0.0; of];
        for (run, &share) in share.iter().enumerate() {
            sums[share] += seconds[run];
        }
        // Whoever got the last of the longest share had least by then.
        let most = sums.iter().copied().fold(0.0, f64::max);
        let longest = seconds.iter().copied().fold(0.0, f64::max);
        assert!(most <= seconds.iter().sum::<f64>() / of as f64 + longest + 1e-3, "{sums:?}");
        // Of equal runs nobody has two more than another.
        let equal = shares(&vec![1.5; seconds.len()], of);
        let counts = (0..of).map(|one| equal.iter().filter(|share| **share == one).count());
        let counts: Vec<usize> = counts.collect();
        assert!(counts.iter().max() <= counts.iter().min().map(|least| least + 1).as_ref(), "{counts:?}");
    });
}

/// What one machine writes about a run: the same status, another time each time.
fn done(run: usize, host: &str, random: &mut Random) -> Record {
    let statuses = [RunStatus::Sat, RunStatus::Unsat, RunStatus::Timeout, RunStatus::Error];
    let mut record = sample::run("z3", &format!("instance {run}"), statuses[run % 4], 0.0);
    record.key = format!("key {run}");
    record.host = host.to_owned();
    record.wall_s = f64::from(random.bound(1000));
    record
}

/// What a report shows but for times and machines.
fn shown(records: &[Record]) -> Vec<(String, RunStatus, String)> {
    records.iter().map(|run| (run.key.clone(), run.status, run.instance.clone())).collect()
}

/// A machine does some of the runs, in any order; it is killed now and then, in the middle of a line too, and begins again.
fn machine(runs: &[usize], path: &Path, random: &mut Random) {
    loop {
        let (mut log, past) = Log::open(path).expect("the folder is ours");
        let known: Vec<String> = past.records.into_iter().map(|record| record.key).collect();
        let missing = runs.iter().filter(|run| !known.contains(&format!("key {run}")));
        let missing: Vec<usize> = missing.copied().collect();
        if missing.is_empty() {
            return;
        }
        let until = 1 + random.below(missing.len());
        for run in &missing[..until] {
            log.append(&done(*run, &path.display().to_string(), random)).expect("the folder is ours");
        }
        drop(log);
        if random.once_in(3) {
            let bytes = fs::read(path).expect("it was written");
            let kept = bytes.len() - random.below(bytes.len().min(300));
            fs::write(path, &bytes[..kept]).expect("the folder is ours");
        }
    }
}

#[test]
fn any_split_any_order_and_any_number_of_kills_come_to_the_same() {
    property(40, 2000, |random| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let runs = 1 + random.below(20);
        let whole = folder.path().join("whole.jsonl");
        machine(&(0..runs).collect::<Vec<_>>(), &whole, random);
        let expected = settled(Log::look(&whole).expect("it was written").records);
        // Some runs are done by several machines, as where one was only thought to be dead.
        let mut logs: Vec<_> = (0..1 + random.below(5)).map(|_| Vec::new()).collect();
        for run in 0..runs {
            let count = logs.len();
            logs[random.below(count)].push(run);
            if random.once_in(5) {
                logs[random.below(count)].push(run);
            }
        }
        let mut paths = Vec::new();
        for (index, runs) in logs.iter_mut().enumerate() {
            runs.dedup();
            let path = folder.path().join(format!("{index}.jsonl"));
            machine(runs, &path, random);
            paths.extend(path.exists().then_some(path));
        }
        let mut outcomes = Vec::new();
        for _ in 0..3 {
            let mut all: Vec<Record> = Vec::new();
            // Twice, in any order.
            for _ in 0..2 * paths.len() {
                let path = &paths[random.below(paths.len())];
                let more = Log::look(path).expect("it was written").records;
                all.extend(added(&all, &more).expect("they are JSON"));
            }
            for path in &paths {
                let more = Log::look(path).expect("it was written").records;
                all.extend(added(&all, &more).expect("they are JSON"));
            }
            let again = added(&all, &all).expect("they are JSON");
            assert!(again.is_empty());
            let outcome = settled(all);
            assert_eq!(shown(&outcome.records), shown(&expected.records));
            assert!(outcome.contradictions.is_empty());
            outcomes.push(outcome);
        }
        assert!(outcomes.iter().all(|outcome| *outcome == outcomes[0]));
    });
}

#[test]
fn of_a_run_done_twice_the_later_counts() {
    let record = |status, wall_s| Record { key: "one".to_owned(), ..sample::run("z3", "a", status, wall_s) };
    let kept = |records: Vec<Record>| {
        let settled = settled(records);
        assert_eq!((settled.records.len(), settled.repeated), (1, 1));
        (settled.records[0].status, settled.records[0].wall_s)
    };
    let (fast, slow) = (record(RunStatus::Sat, 1.0), record(RunStatus::Sat, 2.0));
    assert_eq!(kept(vec![slow.clone(), fast.clone()]), (RunStatus::Sat, 2.0));
    let late = record(RunStatus::Timeout, 0.5);
    assert_eq!(kept(vec![late, slow]), (RunStatus::Timeout, 0.5));
    // Other runs stay as they are, and those without a key are all others.
    let other = Record { key: "two".to_owned(), ..fast.clone() };
    let old = Record { key: String::new(), ..fast.clone() };
    assert_eq!(settled(vec![fast, other, old.clone(), old]).records.len(), 4);
}

#[test]
fn contradictions_between_machines_are_found() {
    let on = |host: &str, status| Record {
        key: "one".to_owned(),
        host: host.to_owned(),
        verified: None,
        ..sample::run("z3", "a", status, 1.0)
    };
    let records = vec![
        on("east", RunStatus::Sat),
        on("west", RunStatus::Unsat),
        on("south", RunStatus::Sat),
        on("north", RunStatus::Timeout),
    ];
    let outcome = settled(records.clone());
    assert_eq!(
        outcome.contradictions,
        ["a z3: the same run is sat on east and sat on south and unsat on west"]
    );
    // One of each is left, so that the judgement finds it too.
    assert_eq!(outcome.records.len(), 2);
    assert!(judge(&outcome.records).fault().is_some());
    let mut turned = records;
    turned.reverse();
    assert_eq!(settled(turned), outcome);
}

#[test]
fn what_is_known_of_a_run_says_how_long_it_takes() {
    let instance = |name: &str| {
        Arc::new(Instance {
            name: name.to_owned(),
            family: "specs".to_owned(),
            file: name.to_owned(),
            sha256: String::new(),
            others: String::new(),
            set: Vec::new(),
            horizon: None,
            expected: None,
            kind: Kind::Problem { objective: "o".to_owned() },
        })
    };
    let solver = |name: &str| {
        Arc::new(Candidate { name: name.to_owned(), version: None, stamp: String::new(), standalone: None })
    };
    let ways = Ways {
        quantifiers: vec!["auto".to_owned()],
        states: vec!["onehot".to_owned()],
        seeds: vec![0, 1],
        repetitions: 1,
        limit: Limit { wall_s: Some(10.0), cpu_s: None, memory_mib: None },
        cases: 1,
        options: Vec::new(),
        build: String::new(),
    };
    let runs = plan(&[instance("a"), instance("b")], &[solver("z3"), solver("cvc5")], &ways);
    assert_eq!(expected(&runs, &[]), [10.0; 8]);
    let past = [
        sample::run("z3", "a", RunStatus::Sat, 1.0),
        sample::run("z3", "a", RunStatus::Sat, 3.0),
        sample::run("cvc5", "c", RunStatus::Sat, 4.0),
        sample::run("z3", "d", RunStatus::Timeout, 500.0),
    ];
    // The same; the instance; the solver, which took longer than any run may now; again the solver. With both seeds.
    assert_eq!(expected(&runs, &past), [2.0, 2.0, 10.0, 4.0, 2.0, 2.0, 10.0, 4.0]);
    assert_eq!(expected(&runs, &past[2..3]), [4.0; 8]);
}
