//! Several problems at a time, each in a thread of its own; whoever is first ends the others. How far they are is told.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::{Cancel, Error, Options, Outcome, Problem, Verdict};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

const PROBLEM: &str = "
const SIZE = 4;
system Lights {
  state a: 0..SIZE, b: 0..SIZE;
  action left, right, both;
  on left  { a' = a + 1; }
  on right { b' = b + 1; }
  on both when a > b { b' = a; }
  init a == 0 & b == 0;
  absorb a == SIZE & b == SIZE;
}
objective all { exists p. F[0,2*SIZE] (a[p] == SIZE & b[p] == SIZE) }
";

fn main() -> Result<(), Error> {
    let problem = Problem::from_text(PROBLEM)?;
    // A problem is handed to threads, as are options; clones share what was read.
    let sizes = [4, 6, 8, 10];
    let verdicts: Vec<Result<Verdict, Error>> = thread::scope(|scope| {
        let solve = |size: i64| {
            let problem = problem.clone();
            move || problem.with("SIZE", size)?.only_objective()?.solve(&Options::new()).map(|o| o.verdict())
        };
        let running: Vec<_> = sizes.map(|size| scope.spawn(solve(size))).into_iter().collect();
        running.into_iter().map(|thread| thread.join().expect("nothing panics in there")).collect()
    });
    for (size, verdict) in sizes.iter().zip(verdicts) {
        let verdict = verdict?;
        println!("SIZE = {size}: {verdict}");
        assert_eq!(verdict, Verdict::Realizable);
    }
    first_of_two(&problem)
}

/// The same question with two seeds, of which the faster one ends the other.
fn first_of_two(problem: &Problem) -> Result<(), Error> {
    let (cancel, told) = (Cancel::new(), Arc::new(AtomicUsize::new(0)));
    let race = |seed: u64| {
        let (told, cancel, problem) = (Arc::clone(&told), cancel.clone(), problem.clone());
        move || -> Result<Outcome, Error> {
            let tell = move |_: &hyperplan::Standing| {
                told.fetch_add(1, Ordering::Relaxed);
            };
            let options = Options::new().seed(seed).cancel(&cancel).timeout(Duration::from_secs(60));
            let options = options.progress(Duration::from_millis(1), tell);
            let outcome = problem.only_objective()?.solve(&options)?;
            if outcome.verdict() != Verdict::Unknown {
                cancel.cancel();
            }
            Ok(outcome)
        }
    };
    let (first, second) = thread::scope(|scope| {
        let (first, second) = (scope.spawn(race(1)), scope.spawn(race(2)));
        (first.join().expect("nothing panics in there"), second.join().expect("nothing panics in there"))
    });
    let verdicts = [first?.verdict(), second?.verdict()];
    println!("{verdicts:?}, told {} times", told.load(Ordering::Relaxed));
    assert!(verdicts.contains(&Verdict::Realizable) && !verdicts.contains(&Verdict::Unrealizable));
    Ok(())
}

#[test]
fn it_runs() -> Result<(), Error> {
    main()
}
