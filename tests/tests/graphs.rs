//! Graph files against brute force: random systems with one enumeration, written as lists of transitions.

use hyperplan_plan::{Config, Fault, Quantifiers, States, Verdict, solve};
use hyperplan_problem::{Overrides, Problem, read};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::brute::Brute;
use hyperplan_tests::model::{self, Kind, Observe};
use hyperplan_tests::random::{Random, problem};
use hyperplan_verify::{Budget, decide};
use std::time::Duration;

/// How many problems; about one in five random ones is of the kind.
const CASES: usize = 150;

/// A list of the states' names, as JSON.
fn names(states: impl IntoIterator<Item = usize>) -> String {
    let names: Vec<String> = states.into_iter().map(|s| format!("\"v{s}\"")).collect();
    format!("[{}]", names.join(", "))
}

/// The system as a graph file.
fn graph(system: &model::System) -> String {
    let actions: Vec<String> = system.actions.iter().map(|a| format!("{a:?}")).collect();
    let edge = |(from, action, to): &(usize, usize, usize)| {
        format!("[\"v{from}\", {:?}, \"v{to}\"]", system.actions[*action])
    };
    let edges: Vec<String> = system.edges().iter().map(edge).collect();
    let label = |(i, states): (usize, &Vec<usize>)| format!("\"l{i}\": {}", names(states.iter().copied()));
    let labels: Vec<String> = system.labels.iter().enumerate().map(label).collect();
    let initial = system.init.iter().map(|init| format!("\"initial\": {},", names(init.iter().copied())));
    format!(
        "{{\"states\": {}, \"actions\": [{}], {} \"transitions\": [{}], \"labels\": {{{}}}}}",
        names(0..system.states()),
        actions.join(", "),
        initial.collect::<String>(),
        edges.join(", "),
        labels.join(", ")
    )
}

/// The problem's text with the graph for its system; the variable `e` is called `node` there.
fn text(random: &model::Problem) -> String {
    let whole = random.to_string();
    let (_, objective) = whole.split_once("objective o").expect("every problem has it");
    let observe = if random.system.observe == Observe::First { "node" } else { "l0" };
    let objective = objective.replace("(e[", "(node[").replace(" e[", " node[");
    format!("system M = graph(\"g.json\") {{ observe {observe}; }}\nobjective o{objective}")
}

fn lowered(random: &model::Problem) -> Problem {
    let (text, file) = (text(random), graph(&random.system));
    let loader = |_: &str| Ok(file.clone().into_bytes());
    let lowered = read(&mut SourceMap::new(), "random.hp", &text, &loader, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{file}\n{:#?}", lowered.diagnostics);
    lowered.problem
}

#[test]
fn graphs_are_decided_as_brute_force_does() {
    let mut verdicts = [0_u32; 2];
    let graphs = (0..).map(|seed| (seed, problem(&mut Random::new(seed))));
    let graphs = graphs.filter(|(_, p)| matches!(p.system.vars.as_slice(), [(_, Kind::Enum(_))]));
    for (seed, random) in graphs.take(CASES) {
        let expected = Brute::new(&random, usize::MAX / 8).expect("no limit").verdict();
        verdicts[usize::from(expected)] += 1;
        let typed = lowered(&random);
        let objective = &typed.objectives[0];
        let context = || format!("seed {seed}\n{}\n{}", text(&random), graph(&random.system));
        assert_eq!(decide(&typed, objective, &Budget::default()), Ok(Some(expected)), "{}", context());
        for quantifiers in [Quantifiers::Auto, Quantifiers::Cegis, Quantifiers::Expand] {
            for states in [States::Onehot, States::Enum, States::Bitvec] {
                let deadline = Deadline::after(Duration::from_secs(60));
                let config =
                    Config { quantifiers, states: Some(states), deadline, ..Config::new(Spec::Builtin) };
                let way = format!("--quantifiers {quantifiers} --states {states}");
                // A witness was checked by then.
                match solve(&typed, objective, &config) {
                    Ok(outcome) => {
                        let realizable = outcome.verdict == Verdict::Realizable;
                        assert_eq!(realizable, expected, "{way}, {}", context());
                    }
                    Err(error) => assert_eq!(error.fault(), Fault::Request, "{way}, {error}, {}", context()),
                }
            }
        }
    }
    assert!(verdicts.iter().all(|&n| n * 5 >= CASES as u32 / 2), "{verdicts:?}");
}
