//! Quantifiers over systems without any path: every way to solve says what the checker says.

use hyperplan_plan::{Config, Fault, Quantifiers, Verdict, solve};
use hyperplan_solver::Spec;
use hyperplan_tests::judge::{EMBEDDED, lowered};
use hyperplan_verify::{Budget, decide};

const SYSTEMS: &str =
    "system Some { state x: 0..1; action set, wait; on set { x' = 1; } on wait {} init x == 0; }
system None { state x: 0..1; action set; on set {} init x == 0 & x == 1; }
";

#[test]
fn all_ways_agree_on_paths_that_are_not_there() {
    let mut verdicts = [0; 2];
    for prefix in 0..64 {
        let quantified = ["p", "q", "r"].iter().enumerate().map(|(at, path)| {
            let quantifier = if prefix >> at & 1 == 1 { "exists" } else { "forall" };
            let system = if prefix >> (at + 3) & 1 == 1 { "Some" } else { "None" };
            format!("{quantifier} {path}: {system}. ")
        });
        let quantified: String = quantified.collect();
        for body in ["F[0,2] x[p] > x[q] & G[0,2] x[r] == x[q]", "X x[p] == 1", "action[q] == none"] {
            let text = format!("{SYSTEMS}objective o {{ {quantified}{body} }}\n");
            let problem = lowered(&text);
            let objective = &problem.objectives[0];
            let expected = decide(&problem, objective, &Budget::default());
            let expected = expected.ok().flatten().unwrap_or_else(|| panic!("not decided:\n{text}"));
            verdicts[usize::from(expected)] += 1;
            for &quantifiers in EMBEDDED {
                let config = Config { quantifiers, ..Config::new(Spec::Builtin) };
                match solve(&problem, objective, &config) {
                    Ok(outcome) => {
                        let found = outcome.verdict == Verdict::Realizable;
                        assert_eq!(found, expected, "{quantifiers:?} finds {:?}:\n{text}", outcome.verdict);
                    }
                    Err(error) => {
                        assert_eq!(error.fault(), Fault::Request, "{quantifiers:?}: {error}\n{text}");
                        assert_eq!(quantifiers, Quantifiers::Explicit, "{error}\n{text}");
                    }
                }
            }
        }
    }
    assert!(verdicts.iter().all(|&count| count > 30), "{verdicts:?}");
}
