//! Graph files mean what the clauses that they list would.

use super::interpreter::{holds, labelled, states, successors};
use super::{lowered_with, messages, ok, ok_with};
use crate::{Overrides, Type};
use std::collections::BTreeSet;

const GRAPH: &str = r#"{
  "states": ["a", 2, "c d"], "actions": ["go", "b \u0061ck"], "initial": ["a", "c d"],
  "transitions": [["a", "go", 2], ["a", "go", "c d"], [2, "b ack", "a"], ["c d", "go", "c d"], ["a", "go", 2]],
  "labels": {"goal": ["c d"], "none_of_them": [], "all": ["a", 2, "c d"]}
}"#;

const PLAIN: &str = "system M {
  state node: {a, n2, c_d};
  action go, back;
  on go when node == a { node' in {n2, c_d}; }
  on back when node == n2 { node' = a; }
  on go when node == c_d {}
  init node in {a, c_d};
  label goal = node == c_d;
  label none_of_them = false;
  label all = true;
}";

#[test]
fn a_graph_is_what_its_clauses_would_be() {
    let graph = ok_with("system M = graph(\"g.json\");", &[("g.json", GRAPH)]).problem;
    let plain = ok(PLAIN).problem;
    assert_eq!(graph.actions.raw, ["go", "b ack"]);
    let (graph, plain) = (&graph.systems.raw[0], &plain.systems.raw[0]);
    let Type::Enum(names) = &graph.vars.raw[0].ty else { panic!("the node is an enumeration") };
    assert_eq!(**names, ["a", "2", "c d"]);
    assert_eq!(states(graph), states(plain));
    for state in states(graph) {
        assert_eq!(holds(graph, &graph.init, &state), holds(plain, &plain.init, &state), "{state:?}");
        for (a, b) in graph.actions.iter().zip(&plain.actions) {
            assert_eq!(successors(graph, &state, *a), successors(plain, &state, *b), "{state:?}");
        }
    }
    for label in ["goal", "none_of_them", "all"] {
        assert_eq!(labelled(graph, label), labelled(plain, label), "{label}");
    }
}

#[test]
fn items_refine_a_graph() {
    let text = "system M = graph(\"g.json\") {
      state load: 0..1;
      action pick;
      on pick when all & load == 0 { load' = 1; }
      init node == \"c d\" & load == 0;
      label mid = node in {\"2\"};
      absorb mid;
    }";
    let problem = ok_with(text, &[("g.json", GRAPH)]).problem;
    let system = &problem.systems.raw[0];
    let init: Vec<_> = states(system).into_iter().filter(|s| holds(system, &system.init, s)).collect();
    assert_eq!(init.len(), 1);
    let by = |name: &str, state: &[_]| successors(system, state, problem.action(name).expect("declared"));
    let mut loaded = init[0].clone();
    loaded[1] = crate::Value::Int(1);
    assert_eq!(by("pick", &init[0]), BTreeSet::from([loaded.clone()]));
    assert_eq!(by("go", &loaded), BTreeSet::from([loaded.clone()]));
    for state in labelled(system, "mid") {
        assert_eq!(by("go", &state), BTreeSet::from([state]));
    }
}

#[test]
fn every_cut_of_a_graph_file_is_refused_with_a_place() {
    for end in 0..GRAPH.len() {
        let files = [("g.json", &GRAPH[..end])];
        let (lowered, sources) = lowered_with("system M = graph(\"g.json\");", &files, &Overrides::none());
        let messages = messages(&lowered, &sources);
        assert_eq!(messages.len(), 1, "{messages:?}");
        assert!(messages[0].starts_with("g.json:") && messages[0].contains("bad-json"), "{messages:?}");
    }
}

#[test]
fn nesting_and_odd_strings_do_no_harm() {
    let deep = "[".repeat(100_000);
    let closed = format!("{deep}{}", "]".repeat(100_000));
    for text in [
        deep.clone(),
        closed.clone(),
        format!("{{\"states\": {closed}}}"),
        "{\"states\": [\"\\ud800\", \"\\u0000\", \"x\"], \"actions\": [\"a\"], \"transitions\": [[\"x\"]]}"
            .to_owned(),
        "{\"\\ud800\": 1}".to_owned(),
        "\u{feff}{}".to_owned(),
        "{\"states\": [1e3, -0, 99999999999999999999]}".to_owned(),
    ] {
        let files = [("g.json", &*text)];
        let (lowered, sources) = lowered_with("system M = graph(\"g.json\");", &files, &Overrides::none());
        assert!(lowered.has_errors(), "{:?}", messages(&lowered, &sources));
    }
}
