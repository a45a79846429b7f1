//! A template of one's own, for objectives that are asked of many problems: a plan that still arrives if one step fails.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::{Error, Options, Problem, System, Verdict};

/// The plan arrives, and so does whoever follows it but for one step, at any time, in which nothing happens.
const TEMPLATE: &str = "
template one_failure(there, T) {
  exists p. forall q.
    F[0,T] there[p]
    & (same_start(p, q) & G[0,T] (action[q] != action[p] -> action[q] == fail & N G[0,T] action[q] == action[p])
       -> F[0,T] there[q])
}
define same_start(p, q) = obs[p] == obs[q];
";

/// A corridor of some length, in which a robot drives.
fn corridor(length: u32) -> System {
    System::new()
        .state("x", &format!("0..{length}"))
        .actions(["right", "fail"])
        .on("right", "true", &format!("x' = if x == {length} then x else x + 1;"))
        .on("fail", "true", "")
        .init("x == 0")
        .observe("x")
        .label("goal", &format!("x == {length}"))
}

fn main() -> Result<(), Error> {
    for (length, steps, expected) in
        [(4, 5, Verdict::Realizable), (4, 4, Verdict::Unrealizable), (6, 7, Verdict::Realizable)]
    {
        let problem = Problem::builder()
            .text(TEMPLATE)
            .system("Corridor", corridor(length))
            .objective("arrive", &format!("one_failure(goal, {steps})"))
            .build()?;
        let outcome = problem.only_objective()?.solve(&Options::new())?;
        println!("{length} cells in {steps} steps: {}", outcome.verdict());
        assert_eq!(outcome.verdict(), expected);
    }
    Ok(())
}

#[test]
fn it_runs() -> Result<(), Error> {
    main()
}
