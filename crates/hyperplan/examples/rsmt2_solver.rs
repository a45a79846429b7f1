//! An encoding for a solver of one's own, spoken to by rsmt2. What it answers becomes a strategy again, which is checked.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::smt::{Printer, SymbolName, symbol_text};
use hyperplan::{EmitConfig, Options, Problem, Status, Verification};
use rsmt2::parse::{ExprParser, ValueParser};
use rsmt2::{SmtRes, Solver};
use std::error::Error;
use std::process::Command;

const PROBLEM: &str = "
system Walk {
  state x: 0..5;
  action left, right;
  on left  { x' = x - 1; }
  on right { x' = x + 1; }
  init x == 2;
}
objective meet { exists p, q. F[0,4] x[p] == 5 & F[0,4] x[q] == 0 }
";

/// Takes what the solver says as it is.
#[derive(Clone, Copy)]
struct Text;

impl<'a> ExprParser<String, (), &'a str> for Text {
    fn parse_expr(self, text: &'a str, (): ()) -> SmtRes<String> {
        Ok(text.to_owned())
    }
}

impl<'a> ValueParser<String, &'a str> for Text {
    fn parse_value(self, text: &'a str) -> SmtRes<String> {
        Ok(text.to_owned())
    }
}

/// Whether there was a solver to ask.
fn asked() -> Result<bool, Box<dyn Error>> {
    if Command::new("z3").arg("--version").output().is_err() {
        println!("z3 is not installed");
        return Ok(false);
    }
    let problem = Problem::from_text(PROBLEM)?;
    let objective = problem.only_objective()?;
    let config = EmitConfig { status: Some(Status::Sat), ..EmitConfig::new("2026-01-31") };
    let query = objective.emit(&config)?;
    let script = query.script().ok_or("it is a single query")?;
    let terms = &script.terms;

    let mut solver = Solver::default_z3(Text)?;
    let mut printer = Printer::new();
    printer.scan(terms, script.literals(0));
    // A solver of rsmt2 is something that can be written to; shared terms are printed once.
    printer.declare(&mut solver, terms)?;
    for literals in script.assertions(0) {
        printer.assertion(&mut solver, terms, literals)?;
    }
    assert!(solver.check_sat()?, "the objective is realizable");

    // Symbols and sorts print themselves through rsmt2's traits.
    let symbols = script.symbols();
    let values = solver.get_values(symbols.iter().map(|symbol| SymbolName::new(terms, *symbol)))?;
    let define = |(symbol, (_, value)): (_, &(String, String))| {
        format!("(define-fun {} () {} {value})\n", symbol_text(terms, symbol), terms.sort(symbol))
    };
    let model: String = symbols.iter().copied().zip(&values).map(define).collect();
    let strategy = objective.strategy_of_model(&format!("({model})"), &Options::new())?;
    for path in objective.paths_of(&strategy) {
        println!("{}: {}", path.path, path.actions.join(" "));
    }
    assert_eq!(objective.verify(&strategy)?, Verification::Holds);
    Ok(true)
}

fn main() -> Result<(), Box<dyn Error>> {
    asked().map(|_| ())
}

#[test]
fn it_runs() -> Result<(), Box<dyn Error>> {
    let is_there = asked()?;
    assert!(is_there || std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "z3 is missing");
    Ok(())
}
