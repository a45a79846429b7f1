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
    lower(&text(random), &graph(&random.system))
}

fn lower(text: &str, file: &str) -> Problem {
    let loader = |_: &str| Ok(file.to_owned().into_bytes());
    let lowered = read(&mut SourceMap::new(), "random.hp", text, &loader, &Overrides::default());
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

/// The problem with a load that each transition changes by a number of its own: as a graph file, and in clauses.
fn loaded(random: &model::Problem, numbers: &mut Random) -> (Problem, Problem) {
    let system = &random.system;
    let number: Vec<usize> = system.edges().iter().map(|_| numbers.below(3)).collect();
    let described: Vec<String> = system
        .edges()
        .iter()
        .zip(&number)
        .enumerate()
        .map(|(at, ((from, action, to), n))| {
            // The first has it in any case, so that there is such an attribute.
            let number = if *n == 0 && at > 0 { String::new() } else { format!(", \"n\": {n}") };
            let action = system.actions[*action];
            format!("{{\"from\": \"v{from}\", \"action\": {action:?}, \"to\": \"v{to}\"{number}}}")
        })
        .collect();
    let whole = graph(system);
    let (head, tail) =
        (whole.find("\"transitions\"").expect("there"), whole.find("\"labels\"").expect("there"));
    let file = format!("{}\"transitions\": [{}], {}", &whole[..head], described.join(", "), &whole[tail..]);
    let (_, objective) = random
        .to_string()
        .split_once("objective o")
        .map(|(a, b)| (a.to_owned(), b.to_owned()))
        .expect("every problem has it");
    let objective = objective.replace("(e[", "(node[").replace(" e[", " node[");
    let (at, end) = (objective.find("\n  ").expect("a line"), objective.rfind("\n}").expect("an end"));
    let (head, body) = (&objective[..at], objective[at..end].trim());
    let (quantifiers, body) = body.split_once("\n").expect("quantifiers have a line");
    let objective = format!(
        "objective o{head} {quantifiers} ({body}) & load[p] != 1 & (load[p] == 0 -> F[0,1] load[p] < 2) }}"
    );
    let observe = if system.observe == Observe::First { "node" } else { "l0" };
    let load = "state load: 0..3; init load < 2;";
    let text = format!(
        "system M = graph(\"g.json\") {{ {load} observe {observe}; also on * when load < 3 {{ load' = load + n; }} \
        also on * when !load < 3 {{ load' in {{0, n}}; }} }}\n{objective}"
    );
    let of_file = lower(&text, &file);
    let values: Vec<String> = (0..system.states()).map(|s| format!("v{s}")).collect();
    let mut plain = format!(
        "system M {{ state node: {{{}}}; {load} observe {observe}; action {};",
        values.join(", "),
        system.actions.join(", ")
    );
    for ((from, action, to), n) in system.edges().iter().zip(&number) {
        let action = system.actions[*action];
        plain +=
            &format!("on {action} when node == v{from} & load < 3 {{ node' = v{to}; load' = load + {n}; }}");
        plain += &format!(
            "on {action} when node == v{from} & load == 3 {{ node' = v{to}; load' in {{0, {n}}}; }}"
        );
    }
    for (i, states) in system.labels.iter().enumerate() {
        let members: Vec<String> = states.iter().map(|s| format!("node == v{s}")).collect();
        plain += &format!(
            "label l{i} = {};",
            if members.is_empty() { "false".into() } else { members.join(" | ") }
        );
    }
    if let Some(init) = &system.init {
        let members: Vec<String> = init.iter().map(|s| format!("node == v{s}")).collect();
        plain += &format!("init {};", members.join(" | "));
    }
    (of_file, lower(&format!("{plain} }}\n{objective}"), ""))
}

#[test]
fn numbers_of_transitions_count_as_clauses_do() {
    let mut verdicts = [0_u32; 2];
    let graphs = (0..).map(|seed| (seed, problem(&mut Random::new(seed))));
    let graphs = graphs
        .filter(|(_, p)| matches!(p.system.vars.as_slice(), [(_, Kind::Enum(_))]) && p.exists.len() < 3);
    for (seed, random) in graphs.take(CASES / 2) {
        let (graph, plain) = loaded(&random, &mut Random::new(seed));
        let expected = decide(&plain, &plain.objectives[0], &Budget::default())
            .expect("it is small")
            .expect("no trace ends");
        verdicts[usize::from(expected)] += 1;
        assert_eq!(
            decide(&graph, &graph.objectives[0], &Budget::default()),
            Ok(Some(expected)),
            "seed {seed}"
        );
        for (quantifiers, states) in [
            (Quantifiers::Auto, States::Onehot),
            (Quantifiers::Cegis, States::Bitvec),
            (Quantifiers::Expand, States::Bitvec),
        ] {
            let deadline = Deadline::after(Duration::from_secs(60));
            let config = Config { quantifiers, states: Some(states), deadline, ..Config::new(Spec::Builtin) };
            match solve(&graph, &graph.objectives[0], &config) {
                Ok(outcome) => assert_eq!(
                    outcome.verdict == Verdict::Realizable,
                    expected,
                    "seed {seed}, {quantifiers} {states}"
                ),
                Err(error) => {
                    assert_eq!(error.fault(), Fault::Request, "seed {seed}, {quantifiers} {states}, {error}")
                }
            }
        }
    }
    assert!(verdicts.iter().all(|&n| n > 5), "{verdicts:?}");
}
