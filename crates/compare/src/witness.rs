//! Whether a model that a solver printed satisfies its query: by evaluation, without any solver.

use std::fs;

use hyperplan_smt::{
    Benchmark, Model, ReadError, Request, check_partial_model, function_text, read_script, symbol_text,
};
use hyperplan_solver::{PrintedModel, PrintedModelError};

use crate::heard::Heard;
use crate::query::Query;
use crate::reading::Reading;
use crate::record::RunStatus;
use crate::supervise::Measured;

/// What became of a model.
#[derive(Debug, PartialEq)]
enum Worth {
    /// All assertions are true.
    Holds,
    /// An assertion is false.
    Fails(String),
    /// Nobody knows, and why.
    Unchecked(String),
}

/// The reading of a query, with what its model is worth where one was asked for.
pub(crate) fn checked(
    reading: Reading,
    query: &Query,
    heard: &Heard,
    file: &str,
    measured: &Measured,
) -> Reading {
    let request = query.of_model().filter(|_| reading.status == RunStatus::Sat && query.checks.len() == 1);
    let Some(request) = request else { return reading };
    let (verified, message) = match worth(request, query, heard, file, measured) {
        Worth::Holds => (Some("model"), None),
        Worth::Fails(why) => (Some("refuted"), Some(format!("wrong model: {why}"))),
        Worth::Unchecked(why) => (None, Some(format!("model not checked: {why}"))),
    };
    Reading { verified: verified.map(str::to_owned), message: message.or(reading.message), ..reading }
}

fn worth(request: &Request, query: &Query, heard: &Heard, file: &str, measured: &Measured) -> Worth {
    if measured.is_cut() {
        return Worth::Unchecked("it is too long".to_owned());
    }
    // Whatever it printed besides, it does not stand by it.
    if let Some(error) = &heard.late {
        return Worth::Unchecked(format!("the solver reported an error: {error}"));
    }
    // Before the file is: it may be long.
    let printed = match PrintedModel::read(&heard.model) {
        Ok(printed) => printed,
        // Of no symbols there is nothing to print.
        Err(PrintedModelError::Empty) if query.variables == 0 => PrintedModel::default(),
        Err(PrintedModelError::Empty) => return Worth::Unchecked("none was printed".to_owned()),
        Err(error) => return Worth::Unchecked(error.to_string()),
    };
    if let Some(symbol) = printed.ambiguous() {
        return Worth::Unchecked(format!("it says two things of {symbol}"));
    }
    match fs::read(file) {
        Ok(bytes) => of_model(request, &String::from_utf8_lossy(&bytes), &printed),
        Err(error) => Worth::Unchecked(format!("{file}: {error}")),
    }
}

/// What a printed model of a text is.
fn of_model(request: &Request, text: &str, printed: &PrintedModel) -> Worth {
    let benchmark = match read_script(text) {
        Ok(benchmark) => benchmark,
        Err(ReadError::Syntax { what, line, .. } | ReadError::Unsupported { what, line, .. }) => {
            return Worth::Unchecked(format!("{what} on line {line}"));
        }
    };
    let (model, gap) = values(&benchmark, printed);
    let check = check_partial_model(&benchmark.script, &model);
    if let Some(origin) = check.violated.and_then(|violated| benchmark.origins.get(violated)) {
        let (number, line, all) = (origin.number, origin.line, benchmark.assertions);
        return Worth::Fails(format!("assertion {number} of {all} (line {line}) is false"));
    }
    match gap {
        // A model that was asked for as a whole has to define all symbols, whether or not they matter.
        Some(gap) if check.unknown > 0 || *request == Request::Model => Worth::Unchecked(gap),
        _ if check.unknown > 0 => {
            let (unknown, all) = (check.unknown, benchmark.assertions);
            let script = &benchmark.script;
            let quantified = script.literals(0).iter().any(|&t| script.terms.is_quantified(t));
            let why = if quantified { "quantifiers" } else { "large numbers" };
            Worth::Unchecked(format!("{unknown} of {all} assertions cannot be evaluated ({why})"))
        }
        _ => Worth::Holds,
    }
}

/// What the declared symbols and functions are, and what the first is missing that has no value.
fn values(benchmark: &Benchmark, printed: &PrintedModel) -> (Model, Option<String>) {
    let terms = &benchmark.script.terms;
    let (mut model, mut gap) = (Model::new(), None);
    for &symbol in &benchmark.symbols {
        match printed.value(terms, symbol) {
            Ok(Some(value)) => model.insert(symbol, value),
            Ok(None) => gap = gap.or_else(|| Some(format!("no value for {}", symbol_text(terms, symbol)))),
            Err(error) => gap = gap.or_else(|| Some(error.to_string())),
        }
    }
    for &function in &benchmark.functions {
        match printed.function(terms, function) {
            Ok(Some(definition)) => model.define(function, definition.clone()),
            Ok(None) => {
                gap = gap.or_else(|| Some(format!("no value for {}", function_text(terms, function))))
            }
            Err(error) => gap = gap.or_else(|| Some(error.to_string())),
        }
    }
    (model, gap)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "(declare-const x Int)(declare-const |y z| Bool)(declare-const unused Bool)\n\
                        (assert true)\n(assert (or |y z| (< x 3)))\n(assert (not (= x 2)))\n(check-sat)";

    fn of(request: &Request, text: &str, output: &str) -> Worth {
        let stdout = format!("sat\n{output}");
        match PrintedModel::read(&stdout) {
            Ok(printed) => of_model(request, text, &printed),
            Err(error) => panic!("{error}"),
        }
    }

    #[test]
    fn models_as_a_whole() {
        let define = |x: &str, y: &str| {
            format!(
                "((define-fun x () Int {x}) (define-fun |y z| () Bool {y}) (define-fun unused () Bool true))"
            )
        };
        let of = |output: &str| of(&Request::Model, TEXT, output);
        assert_eq!(of(&define("(- 1)", "false")), Worth::Holds);
        assert_eq!(of(&define("5", "true")), Worth::Holds);
        let fails = |text: &str| Worth::Fails(text.to_owned());
        assert_eq!(of(&define("5", "false")), fails("assertion 2 of 3 (line 3) is false"));
        assert_eq!(of(&define("2", "false")), fails("assertion 3 of 3 (line 4) is false"));
        let unchecked = |text: &str| Worth::Unchecked(text.to_owned());
        assert_eq!(of("((define-fun x () Int 1))"), unchecked("no value for |y z|"));
        // Whatever the missing values are.
        assert_eq!(of("((define-fun x () Int 2))"), fails("assertion 3 of 3 (line 4) is false"));
        let strange = of(&define("(f 1)", "true"));
        assert_eq!(strange, unchecked("the value of x cannot be read: (f 1)"));
    }

    #[test]
    fn models_in_part() {
        let of = |output: &str| of(&Request::Values, TEXT, output);
        assert_eq!(of("((x 1))"), Worth::Holds);
        assert_eq!(of("((|y z| true) (x 3))"), Worth::Holds);
        assert_eq!(of("((|y z| true))"), Worth::Unchecked("no value for x".to_owned()));
        assert_eq!(of("((x 2))"), Worth::Fails("assertion 3 of 3 (line 4) is false".to_owned()));
    }

    #[test]
    fn what_cannot_be_evaluated() {
        let of = |text: &str| of(&Request::Model, text, "()");
        let unchecked = |text: &str| Worth::Unchecked(text.to_owned());
        assert_eq!(of("(push 1)(check-sat)"), unchecked("push on line 1"));
        assert_eq!(of("(assert\n(and))"), unchecked("arguments are missing on line 2"));
        let text = "(assert (forall ((x Int)) (< x 1)))(assert true)(check-sat)";
        assert_eq!(of(text), unchecked("1 of 2 assertions cannot be evaluated (quantifiers)"));
        assert_eq!(
            of("(assert (forall ((x Int)) (< x 1)))(assert (= 1 2))"),
            Worth::Fails("assertion 2 of 2 (line 1) is false".to_owned())
        );
    }

    #[test]
    fn what_was_cut_off_is_not_checked() {
        let mut stdout = "sat\n((x 2))".to_owned();
        let of = |stdout: String| {
            let reading = Reading::new(RunStatus::Sat, None);
            let query = Query::scan("(check-sat)(get-value (x))");
            let heard = Heard::new(&query, &stdout);
            checked(reading, &query, &heard, "no-such-file", &Measured { stdout, ..Measured::default() })
        };
        let missing = of(stdout.clone());
        assert!(missing.message.is_some_and(|message| message.contains("no-such-file: ")));
        stdout.extend(std::iter::repeat_n(' ', 64 << 20));
        let cut = of(stdout);
        assert_eq!((cut.status, cut.verified), (RunStatus::Sat, None));
        assert_eq!(cut.message.as_deref(), Some("model not checked: it is too long"));
    }
}
