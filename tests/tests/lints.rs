//! A part of an objective that `check` calls superfluous is so: what the warning marks can be replaced, as it says, and no
//! choice of paths tells the difference. Decided by the checker, on random objectives.

use hyperplan_plan::{Budget as LintBudget, lint};
use hyperplan_problem::{NoFiles, Overrides, Problem, read};
use hyperplan_random::Random;
use hyperplan_solver::Deadline;
use hyperplan_syntax::SourceMap;
use hyperplan_tests::{number, say};
use hyperplan_verify::{Budget, decide};

const SYSTEM: &str = "system S { state x: 0..3, b: bool; action up, flip; on up { x' = x + 1; } on flip { b' = !b; } \
                      absorb x == 3; label low = x <= 1; label end = x == 3; }";

fn lowered(text: &str) -> (Problem, SourceMap) {
    let mut sources = SourceMap::new();
    let lowered = read(&mut sources, "random.hp", text, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    (lowered.problem, sources)
}

/// A formula of paths p and q, in all that stands for several atoms.
fn formula(random: &mut Random, depth: usize) -> String {
    let path = if random.once_in(2) { "p" } else { "q" };
    if depth == 0 || random.once_in(5) {
        let (lo, more) = (random.below(4), random.below(3));
        return match random.below(9) {
            0 => format!("x[{path}] in {lo}..{}", lo + more),
            1 => format!("x[{path}] in {{{lo}, {more}}}"),
            2 => format!("(x[{path}], x[q]) in {{({lo}, {more}), ({more}, {lo})}}"),
            3 => format!("b[{path}]"),
            4 => format!("x[p] + {more} < x[q] * 2"),
            5 => "state[p] == state[q]".to_owned(),
            6 => format!("low[{path}]"),
            7 => format!("action[{path}] == up"),
            _ => format!("(if b[{path}] then x[p] else {lo}) >= x[q]"),
        };
    }
    let mut part = || format!("({})", formula(random, depth - 1));
    let (f, g, h) = (part(), part(), part());
    match random.below(12) {
        0 | 1 => format!("{f} & {g} & {h}"),
        2 => format!("{f} | {g}"),
        3 => format!("{f} -> {g}"),
        4 => format!("{f} <-> {g}"),
        5 => format!("if {f} then {g} else {h}"),
        6 => format!("!{f}"),
        7 => format!("X {f}"),
        8 => format!("F[0,2] {f}"),
        9 => format!("G[0,1] {f}"),
        10 => format!("{f} U[0,2] {g}"),
        _ => format!("{f} W[0,1] {g}"),
    }
}

/// What may stand in the place that a warning marks.
fn replacement(code: &str) -> Option<&'static str> {
    match code {
        "vacuous" => Some("(true)"),
        "useless-alternative" | "impossible-consequent" | "vacuous-antecedent" => Some("(false)"),
        _ => None,
    }
}

#[test]
fn what_is_called_superfluous_is() {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", 400);
    let mut found = 0;
    for seed in first..first + cases {
        let body = formula(&mut Random::new(seed), 3);
        let objective =
            |quantifiers: &str, body: &str| format!("{SYSTEM}\nobjective o {{ {quantifiers} {body} }}\n");
        let text = objective("exists p. forall q.", &body);
        let (problem, sources) = lowered(&text);
        let lints = lint(&problem, &problem.objectives[0], &Deadline::never(), LintBudget::default());
        let start = text.len() - body.len() - 3;
        // Each is found with those before it replaced, so that all of them may be at once. Marks within marks are gone with them.
        let mut marks: Vec<(usize, usize, &str)> = Vec::new();
        for warning in &lints.warnings {
            let (Some(span), Some(instead)) = (warning.span, replacement(warning.code)) else { continue };
            let at = span.range();
            assert_eq!(sources.snippet(span), &text[at.clone()]);
            marks.push((at.start - start, at.end - start, instead));
        }
        if marks.is_empty() {
            continue;
        }
        found += 1;
        marks.sort_by_key(|&(from, to, _)| (from, std::cmp::Reverse(to)));
        let mut other = String::new();
        let mut done = 0;
        for (from, to, instead) in marks {
            if from >= done {
                other += &body[done..from];
                other += instead;
                done = to;
            }
        }
        other += &body[done..];
        let differs = objective("exists p. exists q.", &format!("!(({body}) <-> ({other}))"));
        let (differs, _) = lowered(&differs);
        let answer = decide(&differs, &differs.objectives[0], &Budget::default());
        assert_eq!(answer, Ok(Some(false)), "seed {seed}: {body}\nis not {other}\n{:#?}", lints.warnings);
    }
    say(&format!("seeds {first}..{}: warnings about {found} objectives", first + cases));
    assert!(found * 10 > cases, "too few warnings for the test to mean something");
}
