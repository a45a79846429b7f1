//! The embedded engine under limits of time and memory: it stops, says why, and can go on.

#[path = "common/pigeons.rs"]
mod pigeons;

use std::time::{Duration, Instant};

use hyperplan_smt::{Script, Sort, Term, Terms};
use hyperplan_solver::{Answer, Deadline, Options, Spec, Unknown, open};
use pigeons::pigeons;

/// The last of so many products, each of the one before and of `x` plus another even number: some fifty thousand clauses
/// each, as no bit of them is constant.
fn products(terms: &mut Terms, count: u32) -> (Term, Term) {
    let stem = terms.stem("x");
    let x = terms.symbol(stem, None, Sort::BitVec(64));
    let last = (1..=count).fold(x, |t, i| {
        let constant = terms.bv(2 * i128::from(i), 64);
        let sum = terms.bv_add(x, constant);
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
    for spec in Spec::backends() {
        let mut session = open(&spec, &Options::default()).expect("it is built in");
        for _ in 0..3 {
            let start = Instant::now();
            let answer = session.check(&script, &[], &Deadline::after(Duration::from_millis(100)));
            assert_eq!(answer.expect("no error"), Answer::Unknown(Unknown::Timeout));
            assert!(start.elapsed() < Duration::from_secs(20), "{spec:?}: {:?}", start.elapsed());
        }
    }
}

#[test]
fn effort_is_limited_and_can_be_added_to() {
    for spec in Spec::backends() {
        let script = pigeons(7);
        let mut session = open(&spec, &Options::default()).expect("it is built in");
        let mut check =
            |effort| session.check_within(&script, &[], &Deadline::never(), effort).expect("no error");
        let mut first = || check(Some(1_000));
        assert_eq!(
            [first(), first()],
            [Answer::Unknown(Unknown::Effort), Answer::Unknown(Unknown::Effort)],
            "{spec:?}"
        );
        // What is told to do more does, and what has no limit comes to its end.
        let answers: Vec<Answer> = (10..40).map(|power| check(Some(1 << power))).collect();
        assert!(answers.contains(&Answer::Unsat), "{spec:?}");
        assert_eq!(check(None), Answer::Unsat, "{spec:?}");
    }
}

#[test]
fn a_cancelled_check_says_so() {
    let deadline = Deadline::never();
    let flag = deadline.cancel_flag();
    for spec in Spec::backends() {
        for script in [endless(), pigeons(12)] {
            flag.store(false, std::sync::atomic::Ordering::Relaxed);
            let mut session = open(&spec, &Options::default()).expect("it is built in");
            let answer = std::thread::scope(|scope| {
                scope.spawn(|| {
                    std::thread::sleep(Duration::from_millis(100));
                    flag.store(true, std::sync::atomic::Ordering::Relaxed);
                });
                session.check(&script, &[], &deadline).expect("no error")
            });
            assert_eq!(answer, Answer::Unknown(Unknown::Interrupted), "{spec:?}");
        }
    }
}

#[test]
fn an_interrupted_session_goes_on() {
    for spec in Spec::backends() {
        for (bit, expected) in [(0, Answer::Sat), (1, Answer::Unsat)] {
            goes_on(&spec, bit, &expected);
        }
    }
}

/// Asks for a product of even factors with that lowest bit, in pieces of time.
fn goes_on(spec: &Spec, bit: i128, expected: &Answer) {
    let mut script = Script::new();
    let (x, last) = products(&mut script.terms, 6);
    for (t, bit) in [(x, 0), (last, bit)] {
        let low = script.terms.extract(t, 0, 0);
        let value = script.terms.bv(bit, 1);
        let claim = script.terms.eq(low, value);
        script.assert(claim);
    }
    let mut session = open(spec, &Options::default()).expect("it is built in");
    let mut interruptions = 0;
    let answer = loop {
        let deadline = Deadline::after(Duration::from_millis(1 << interruptions));
        match session.check(&script, &[], &deadline).expect("no error") {
            Answer::Unknown(reason) => assert_eq!(reason, Unknown::Timeout),
            answer => break answer,
        }
        interruptions += 1;
    };
    assert_eq!(answer, *expected, "{spec:?}");
    assert!(interruptions > 0, "{spec:?} was never interrupted");
    if answer == Answer::Sat {
        let values = session.values(&script, &[x]).expect("a model");
        assert!(values[0].as_unsigned().is_some_and(|x| x % 2 == 0), "{spec:?}: {values:?}");
    }
}

#[test]
fn encoding_stops_at_the_memory_limit() {
    let script = endless();
    let options = Options { memory_mib: Some(64), ..Options::default() };
    // None is given back before the end: it would be taken again without growth.
    let mut sessions = Vec::new();
    for spec in Spec::backends() {
        let mut session = open(&spec, &options).expect("it is built in");
        let answer =
            session.check(&script, &[], &Deadline::after(Duration::from_secs(300))).expect("no error");
        assert_eq!(answer, Answer::Unknown(Unknown::MemoryLimit { mib: 64 }), "{spec:?}");
        sessions.push(session);
    }
}

#[test]
fn a_limit_that_is_not_reached_changes_nothing() {
    let script = pigeons(5);
    let options = Options { memory_mib: Some(1 << 40), ..Options::default() };
    for spec in Spec::backends() {
        let mut session = open(&spec, &options).expect("it is built in");
        let answer = session.check(&script, &[], &Deadline::never()).expect("no error");
        assert_eq!(answer, Answer::Unsat, "{spec:?}");
    }
}
