//! A solver that hyperplan does not know, described by a profile.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::{Error, Options, Problem, Solvers, Verdict};

/// As in `docs/solvers.md`: a solver like z3, which is started otherwise.
const PROFILE: &str = r#"
[[solver]]
name = "careful"
like = "z3"
setup = ["(set-option :smt.random_seed 7)"]
"#;

const PROBLEM: &str = "
system Counter {
  state n: int;
  action add, double;
  on add    { n' = n + 3; }
  on double { n' = 2 * n; }
  init n == 1;
}
objective reach within 4 { exists p. F n[p] == 22 }
";

/// Whether there was a solver to ask.
fn asked() -> Result<bool, Error> {
    let mut solvers = Solvers::new();
    solvers.add(PROFILE)?;
    let problem = Problem::from_text(PROBLEM)?;
    let options = Options::new().solver(solvers.find("careful")?);
    let outcome = match problem.only_objective()?.solve(&options) {
        Ok(outcome) => outcome,
        Err(error) if error.code() == "solver-failed" => {
            println!("{error}");
            return Ok(false);
        }
        Err(error) => return Err(error),
    };
    assert_eq!(outcome.verdict(), Verdict::Realizable);
    println!("{} {}: {:?}", outcome.answer.solver.name, outcome.answer.solver.version, outcome.paths());
    Ok(true)
}

fn main() -> Result<(), Error> {
    asked().map(|_| ())
}

#[test]
fn it_runs() -> Result<(), Error> {
    let is_there = asked()?;
    assert!(is_there || std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_none(), "z3 is missing");
    Ok(())
}
