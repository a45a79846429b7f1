//! The memory limit of a search, in a process of its own: memory that another test has given back would be taken again
//! before the process grows.

#[path = "common/pigeons.rs"]
mod pigeons;

use std::time::Duration;

use hyperplan_solver::{Answer, Deadline, Options, Spec, Unknown, open};
use pigeons::pigeons;

#[test]
fn search_stops_at_the_memory_limit() {
    let script = pigeons(12);
    let options = Options { memory_mib: Some(1), ..Options::default() };
    // What one back end took is kept, for the same reason, until the others are done.
    let mut sessions = Vec::new();
    for spec in Spec::backends() {
        let mut session = open(&spec, &options).expect("it is built in");
        let answer =
            session.check(&script, &[], &Deadline::after(Duration::from_secs(300))).expect("no error");
        assert_eq!(answer, Answer::Unknown(Unknown::MemoryLimit { mib: 1 }), "{spec:?}");
        sessions.push(session);
    }
}
