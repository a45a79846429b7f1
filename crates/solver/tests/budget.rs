//! The embedded engine under limits of time and memory: it stops, says why, and can go on.

#![cfg(any(feature = "cadical", feature = "batsat"))]

#[path = "common/pigeons.rs"]
mod pigeons;

use std::time::{Duration, Instant};

use hyperplan_smt::{Script, Sort, Term, Terms};
use hyperplan_solver::{Answer, Deadline, Options, Spec, Unknown, open};
use pigeons::pigeons;

/// The last of so many products, each of the one before and itself plus the next constant: some fifty thousand
/// clauses each.
fn products(terms: &mut Terms, count: u32) -> (Term, Term) {
    let stem = terms.stem("x");
    let x = terms.symbol(stem, None, Sort::BitVec(64));
    let last = (0..count).fold(x, |t, i| {
        let constant = terms.bv(i128::from(i), 64);
        let sum = terms.bv_add(t, constant);
        terms.bv_mul(t, sum)
    });
    (x, last)
}

/// One assertion that would take minutes, and all memory there is, to be written as clauses.
fn endless() -> Script {
    let mut script = Script::new();
    let (x, last) = products(&mut script.terms, 200_000);
    let claim = script.terms.eq(x, last);
    script.assert(claim);
    script
}

#[test]
fn encoding_one_assertion_stops_at_the_deadline() {
    let script = endless();
    let mut session = open(&Spec::Builtin, &Options::default()).expect("it is built in");
    for _ in 0..3 {
        let start = Instant::now();
        let answer = session.check(&script, &[], &Deadline::after(Duration::from_millis(100)));
        assert_eq!(answer.expect("no error"), Answer::Unknown(Unknown::Timeout));
        assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    }
}

#[test]
fn a_cancelled_check_says_so() {
    let deadline = Deadline::never();
    let flag = deadline.cancel_flag();
    for script in [endless(), pigeons(12)] {
        flag.store(false, std::sync::atomic::Ordering::Relaxed);
        let mut session = open(&Spec::Builtin, &Options::default()).expect("it is built in");
        let answer = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(100));
                flag.store(true, std::sync::atomic::Ordering::Relaxed);
            });
            session.check(&script, &[], &deadline).expect("no error")
        });
        assert_eq!(answer, Answer::Unknown(Unknown::Interrupted));
    }
}

#[test]
fn an_interrupted_session_goes_on() {
    for (bit, expected) in [(0, Answer::Sat), (1, Answer::Unsat)] {
        let mut script = Script::new();
        // Products of what is even are even.
        let (x, last) = products(&mut script.terms, 6);
        for (t, bit) in [(x, 0), (last, bit)] {
            let low = script.terms.extract(t, 0, 0);
            let value = script.terms.bv(bit, 1);
            let claim = script.terms.eq(low, value);
            script.assert(claim);
        }
        let mut session = open(&Spec::Builtin, &Options::default()).expect("it is built in");
        let mut interruptions = 0;
        let answer = loop {
            let deadline = Deadline::after(Duration::from_millis(1 << interruptions));
            match session.check(&script, &[], &deadline).expect("no error") {
                Answer::Unknown(reason) => assert_eq!(reason, Unknown::Timeout),
                answer => break answer,
            }
            interruptions += 1;
        };
        assert_eq!(answer, expected);
        assert!(interruptions > 0, "it was never interrupted");
        if answer == Answer::Sat {
            let values = session.values(&script, &[x]).expect("a model");
            assert!(values[0].as_unsigned().is_some_and(|x| x % 2 == 0), "{values:?}");
        }
    }
}

#[test]
fn encoding_stops_at_the_memory_limit() {
    let script = endless();
    let options = Options { memory_mib: Some(64), ..Options::default() };
    let mut session = open(&Spec::Builtin, &options).expect("it is built in");
    let answer = session.check(&script, &[], &Deadline::after(Duration::from_secs(300))).expect("no error");
    assert_eq!(answer, Answer::Unknown(Unknown::MemoryLimit { mib: 64 }));
}

#[test]
fn a_limit_that_is_not_reached_changes_nothing() {
    let script = pigeons(5);
    let options = Options { memory_mib: Some(1 << 40), ..Options::default() };
    let mut session = open(&Spec::Builtin, &options).expect("it is built in");
    let answer = session.check(&script, &[], &Deadline::never()).expect("no error");
    assert_eq!(answer, Answer::Unsat);
}
