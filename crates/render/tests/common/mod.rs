//! Problems and paths for tests of drawings.

#![allow(dead_code, reason = "each test file is a crate of its own")]

use hyperplan_problem::answer::{StrategyFile, to_strategy};
use hyperplan_problem::{NoFiles, Overrides, Problem, Strategy, read};
use hyperplan_render::Scene;
use hyperplan_syntax::SourceMap;

pub(crate) fn problem(text: &str) -> Problem {
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    lowered.problem
}

pub(crate) fn strategy(problem: &Problem, witness: &str) -> Strategy {
    let file = StrategyFile::read_all(witness).expect("JSON").remove(0);
    to_strategy(problem, &problem.objectives[0], &file.witness.expect("given")).expect("it fits")
}

pub(crate) fn scene<'a>(problem: &'a Problem, strategy: &'a Strategy) -> Scene<'a> {
    Scene { problem, objective: problem.objectives.first(), traces: &strategy.traces, note: "" }
}

/// A square map with start and goal in its corners, the others obstacles with that chance in a thousand but along the lower
/// and the right edge, where the path of the witness goes.
pub(crate) fn square(size: usize, obstacles: u64) -> (Problem, Strategy) {
    let mut number = 42_u64;
    let mut rows = vec![String::new(); size];
    for (y, row) in rows.iter_mut().enumerate() {
        for x in 0..size {
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let is_free = y + 1 == size || x + 1 == size || (number >> 33) % 1000 >= obstacles;
            row.push(match (x, y) {
                (0, y) if y + 1 == size => 'S',
                (x, 0) if x + 1 == size => 'G',
                _ if is_free => '.',
                _ => '#',
            });
        }
    }
    let map: Vec<String> = rows.iter().map(|row| format!("\"{row}\"")).collect();
    let steps = 2 * (size - 1);
    let text = format!(
        "system W = grid {{\n{}\n}} {{ edge stay; obstacle stay; absorb goal; }}\n\
         objective o {{ exists p. start[p] & F[0,{}] goal[p] }}",
        map.join("\n"),
        steps + 5
    );
    let problem = problem(&text);
    let state = |i: usize| {
        let (x, y) = if i < size { (i, 0) } else { (size - 1, (i - size + 1).min(size - 1)) };
        format!("{{\"x\": {x}, \"y\": {y}}}")
    };
    let action = |i: usize| if i + 1 < size { "\"right\"" } else { "\"up\"" };
    let states: Vec<String> = (0..=steps + 5).map(state).collect();
    let actions: Vec<&str> = (0..steps + 5).map(action).collect();
    let witness = format!(
        "{{\"witness\": [{{\"path\": \"p\", \"actions\": [{}], \"states\": [{}]}}]}}",
        actions.join(", "),
        states.join(", ")
    );
    let strategy = strategy(&problem, &witness);
    (problem, strategy)
}
