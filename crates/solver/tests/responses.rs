//! Replies find their commands, whatever is echoed, refused or left out between them: random scripts, with what solvers
//! of several manners print for them.

use hyperplan_random::{Random, property};
use hyperplan_smt::Request;
use hyperplan_solver::{Said, responses};

/// Texts that look like something else.
const TEXTS: [&str; 12] = [
    "sat",
    "unsat",
    "unknown",
    "sat\nunsat",
    "(",
    ")",
    "(error",
    "; sat",
    "a \"\" b",
    "",
    "((x 1))",
    "timeout",
];

/// A script: its commands that have an answer, with one check or two, and a model for each at most.
fn script(random: &mut Random) -> Vec<Request> {
    let mut requests = Vec::new();
    for _ in 0..1 + random.below(2) {
        for _ in 0..random.below(3) {
            let texts = TEXTS.map(|text| Request::Echo(text.to_owned()));
            let infos = [Request::Info, Request::Other];
            requests.push(
                texts.iter().chain(&infos).nth(random.below(TEXTS.len() + 2)).expect("so many").clone(),
            );
        }
        requests.push(Request::Check);
        let start = requests.len();
        for _ in 0..random.below(5) {
            let after = [Request::Model, Request::Values, Request::Refutation, Request::Info, Request::Other];
            let echo = Request::Echo(random.one(&TEXTS).to_owned());
            let some = after.iter().chain([&echo]).nth(random.below(6)).expect("so many").clone();
            if some != Request::Model || !requests[start..].contains(&some) {
                requests.push(some);
            }
        }
    }
    requests
}

/// What a solver prints for a command.
fn reply(random: &mut Random, request: &Request, quoted: bool, definitions: bool) -> String {
    let some = |random: &mut Random, texts: &[&str]| random.one(texts).to_owned();
    match request {
        Request::Check => some(random, &["sat", "unsat", "unknown", "timeout"]),
        Request::Echo(text) if quoted => format!("\"{text}\""),
        Request::Echo(text) => text.replace("\"\"", "\""),
        Request::Model if definitions => {
            some(random, &["(= x 4)\n(= |sat | 5)\n(function f\n (default 0))", ""])
        }
        Request::Model => some(random, &["(\n (define-fun x () Int\n 4))", "(model)", "()"]),
        Request::Values => some(random, &["((x 1))", "((x 1)\n (|a\nsat\n| true))"]),
        Request::Refutation => some(random, &["(a b)", "()"]),
        Request::Info => some(random, &["(:name \"sat\nunsat\")", "unsupported\n; unsat"]),
        Request::Other => some(random, &["true", "((a true))", "unsupported"]),
    }
}

#[test]
fn answers_are_those_of_the_checks() {
    property(10000, 120, |random| {
        let requests = script(random);
        let (quoted, definitions, end) = (random.flip(), random.flip(), random.once_in(3));
        let (mut output, mut expected) = (String::new(), Vec::new());
        for (at, request) in requests.iter().enumerate() {
            let refuses = !matches!(request, Request::Check | Request::Echo(_)) && random.once_in(4);
            if refuses {
                output += "(error \"line 1:\nsat\nunsat\n\")\n";
                if end {
                    break;
                }
                continue;
            }
            // What is echoed after a model of which nothing was printed could not be told from one.
            let parenthesis =
                |request: &Request| matches!(request, Request::Echo(text) if text.starts_with('('));
            let definitions = definitions && !requests[at..].iter().any(parenthesis);
            let reply = reply(random, request, quoted, definitions);
            output = output + &reply + random.one(&["\n", "\r\n", "\n\n"]);
            if *request == Request::Check {
                expected.push(reply);
            }
        }
        let word = |said: &Said| match said {
            Said::Answer(Some(true)) => Some("sat"),
            Said::Answer(Some(false)) => Some("unsat"),
            Said::Answer(None) => Some("unknown"),
            Said::Timeout => Some("timeout"),
            Said::Error(_) | Said::Other => None,
        };
        let found = responses(&requests, &output);
        let found: Vec<&str> = found.iter().filter_map(|response| word(&response.said)).collect();
        assert_eq!(found, expected, "{requests:?}\n{output}");
    });
}
