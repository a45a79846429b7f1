//! Choices of more values than are listed one by one: the values are then left to the solver, in every width and way of
//! writing numbers. The checker says what is right.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems.

use hyperplan_plan::{Config, Fault, Quantifiers, States, Verdict, solve};
use hyperplan_solver::{Spec, discover};
use hyperplan_tests::judge::{EMBEDDED, lowered};
use hyperplan_tests::random::Random;
use hyperplan_tests::{number, say};
use hyperplan_verify::{Budget, decide};
use std::str::FromStr;

/// A variable of some range that is no power of two, which may become anything between ends that depend on the state.
fn text(random: &mut Random) -> String {
    let lo = 10 - i64::from(random.bound(20));
    let hi = lo + 66 + i64::from(random.bound(60));
    let mut number = |around: i64| around + 4 - i64::from(random.bound(9));
    let ends = [(number(lo), number(hi)), (number(lo), number(hi - 10)), (number(lo + 10), number(hi))];
    let (target, other, limit) = (number(lo), number(hi), number((lo + hi) / 2));
    let ranges = match random.below(3) {
        0 => format!("{}..{}", ends[0].0, ends[0].1),
        1 => format!("if x > {limit} then {}..{} else {}..{}", ends[1].0, ends[1].1, ends[2].0, ends[2].1),
        _ => format!("x - {}..x + {}", 40 + random.bound(20), 40 + random.bound(20)),
    };
    let guard = if random.once_in(3) { format!(" when x != {target}") } else { String::new() };
    let relation = if random.once_in(3) { format!("  trans x' != {other} | b;\n") } else { String::new() };
    let start = if random.once_in(2) { format!("x == {limit}") } else { format!("x == {limit} | x == {hi}") };
    let paths = match random.below(4) {
        0 => "exists p, q.",
        1 => "exists p. forall q.",
        2 => "forall p. exists q.",
        _ => "forall p, q.",
    };
    let parts = [
        format!("F[0,1] x[p] == {target}"),
        format!("X x[p] >= {other}"),
        "F[0,1] x[q] != x[p]".to_owned(),
        format!("X x[q] < x[p] + {}", 60 + random.bound(20)),
        "X b[q]".to_owned(),
        "action[p] == action[q]".to_owned(),
    ];
    let mut chosen = |parts: &[String]| parts[random.below(parts.len())].clone();
    let (one, two) = (chosen(&parts), chosen(&parts));
    let how = if random.once_in(2) { "&" } else { "|" };
    let negated = if random.once_in(2) { "!" } else { "" };
    let within = if random.once_in(2) { " within 1" } else { "" };
    format!(
        "system S {{\n  state x: {lo}..{hi}, b: bool;\n  action go, flip;\n  init {start};\n  \
         on go{guard} {{ x' in {ranges}; }}\n  on flip {{ b' = !b; }}\n{relation}}}\n\
         objective o{within} {{ {paths} {negated}({one}) {how} {two} }}\n"
    )
}

#[test]
fn what_the_solver_chooses_is_what_the_checker_lists() {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", 16);
    say(&format!("seed {first}, {cases} cases"));
    let external = discover().into_iter().filter(|found| found.path.is_some() && found.name == "z3");
    let external: Vec<Spec> =
        external.map(|found| Spec::from_str(&found.name).expect("a solver that was discovered")).collect();
    let mut verdicts = [0; 2];
    for seed in (0..cases).map(|i| first.wrapping_add(i)) {
        let text = text(&mut Random::new(seed));
        let problem = lowered(&text);
        let objective = &problem.objectives[0];
        let expected = decide(&problem, objective, &Budget::default()).expect("it is well-formed");
        let expected = expected.unwrap_or_else(|| panic!("seed {seed} is too large\n{text}"));
        verdicts[usize::from(expected)] += 1;
        let embedded = EMBEDDED.iter().map(|&how| (Spec::Builtin, States::Bitvec, how));
        let ways = [States::Bitvec, States::Int].map(|states| (states, Quantifiers::Cegis));
        let others =
            external.iter().flat_map(|solver| ways.map(|(states, how)| (solver.clone(), states, how)));
        for (solver, states, quantifiers) in embedded.chain(others) {
            let config = Config { quantifiers, states: Some(states), ..Config::new(solver.clone()) };
            match solve(&problem, objective, &config) {
                Ok(outcome) => {
                    let found = outcome.verdict == Verdict::Realizable;
                    let what = format!("{solver:?}, {states:?}, {quantifiers:?}, seed {seed}");
                    assert_eq!(found, expected, "{what}: {:?}:\n{text}", outcome.verdict);
                }
                Err(error) => assert_eq!(error.fault(), Fault::Request, "seed {seed}: {error}\n{text}"),
            }
        }
    }
    assert!(cases < 16 || verdicts.iter().all(|&count| count > 1), "{verdicts:?}");
}
