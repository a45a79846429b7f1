//! Fewer of the same problems, for the loop of a change (`cargo quick`): what is wrong for one problem in fifty shows here.

use super::{checker_decides, embedded_solver_answers, minimize, semantics, unbounded};

#[test]
#[ignore = "a part of the others, for `cargo quick`"]
fn checker() {
    checker_decides(2000);
    semantics::checker_reads(400);
    unbounded::checker_decides(400);
}

#[test]
#[ignore = "a part of the others, for `cargo quick`"]
fn embedded_solver() {
    embedded_solver_answers(400);
}

#[test]
#[ignore = "a part of the others, for `cargo quick`"]
fn embedded_solver_under_semantics() {
    semantics::embedded_solver_finds(150);
}

#[test]
#[ignore = "a part of the others, for `cargo quick`"]
fn least_value() {
    minimize::least_value(200);
}
