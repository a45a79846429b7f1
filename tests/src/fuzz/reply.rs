//! What solvers write.

use hyperplan_smt::Request;
use hyperplan_solver::{Said, responses, understand_output};

/// Pieces of replies.
pub(super) const PIECES: &[&str] = &[
    "(",
    ")",
    "((",
    "))",
    "\"",
    "|",
    ";",
    "\n",
    "\r\n",
    " ",
    "\\",
    "\0",
    "é",
    "sat",
    "unsat",
    "unknown",
    "timeout",
    "success",
    "unsupported",
    "warning",
    "(error \"",
    "\")",
    "(:reason-unknown ",
    "true",
    "false",
    "#b",
    "#x",
    "#b01",
    "#xfF",
    "(_ bv",
    "(- ",
    "(/ ",
    "(- (/ ",
    "1.0",
    "0",
    ".5",
    "-",
    "+1",
    "170141183460469231731687303715884105728",
    "0.0000000000000000000000000000000000000001",
    "(x ",
    "(|a b| ",
    "(let ((a 1)) a)",
];

/// Replies are the same, in whatever pieces the output comes, and no answer belongs to a command that is no check.
pub(super) fn body(data: &[u8]) {
    let whole = understand_output(data, data.len().max(1));
    for piece in [1, 7] {
        assert_eq!(understand_output(data, piece), whole, "in pieces of {piece}");
    }
    let requests =
        [Request::Echo("sat".to_owned()), Request::Check, Request::Model, Request::Values, Request::Info];
    for response in responses(&requests, &String::from_utf8_lossy(data)) {
        let is_answer = matches!(response.said, Said::Answer(_) | Said::Timeout);
        let of_check = response.to.is_none_or(|to| requests[to] == Request::Check);
        assert!(!is_answer || of_check, "{response:?}");
    }
}
