//! The bodies of the fuzzers on damaged inputs, about a second each. `HYPERPLAN_FUZZ_SECONDS` makes it longer, and
//! `HYPERPLAN_SEED` begins elsewhere.

use hyperplan_tests::fuzz::{self, run};

#[test]
fn problem() {
    run(fuzz::PROBLEM);
}

#[test]
fn reply() {
    run(fuzz::REPLY);
}

#[test]
fn map() {
    run(fuzz::MAP);
}

#[test]
fn ros() {
    run(fuzz::ROS);
}

#[test]
fn pgm() {
    run(fuzz::PGM);
}

#[test]
fn graph() {
    run(fuzz::GRAPH);
}

#[test]
fn strategy() {
    run(fuzz::STRATEGY);
}
