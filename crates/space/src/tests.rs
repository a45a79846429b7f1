use crate::{Commands, Graph, LIVE, Run, StateIx};
use hyperplan_problem::{ActionId, PathId, State};
use hyperplan_tiny::{paths, problem, starts, system, transitions};
use proptest::prelude::*;
use std::sync::Arc;

/// Where an action leads, whatever the order.
fn targets(steps: impl Iterator<Item = (ActionId, State)>, action: ActionId) -> Vec<State> {
    let mut found: Vec<State> = steps.filter(|step| step.0 == action).map(|step| step.1).collect();
    found.sort();
    found.dedup();
    found
}

proptest! {
    /// The graph, the commands, and the clauses read by brute force.
    #[test]
    fn graph_and_commands_take_the_steps_of_the_clauses(text in system()) {
        let problem = problem(&text);
        let system = problem.systems.first().expect("there is one");
        let graph = Graph::explore(system, 100).expect("it is small");
        let commands = Commands::new(system, &|_| false).expect("it is small");
        let initial: Vec<State> = graph.initial.iter().map(|&s| graph.state(system, s)).collect();
        prop_assert_eq!(initial, starts(system));
        for index in 0..graph.len() as StateIx {
            let state = graph.state(system, index);
            let steps = transitions(system, &state);
            for &action in &system.actions {
                let expected = targets(steps.iter().cloned(), action);
                let there = graph.of_action(index, action).map(|t| (action, graph.state(system, t.1)));
                prop_assert_eq!(targets(there, action), expected.clone());
                let own = commands.of_action(action).map(|at| &commands.all[at]);
                let there = own.filter_map(|c| Some((action, c.apply(system, &state, &state)?)));
                prop_assert_eq!(targets(there, action), expected.clone());
                prop_assert_eq!(commands.has_outcomes(system, &state, action), expected.len() > 1);
                for to in &expected {
                    let number = commands.number_of(system, &state, action, to).expect("it is a step");
                    let taken = commands.preferred(system, &state, action, number, &state);
                    prop_assert_eq!(taken, Some((number, to.clone())));
                }
            }
        }
    }

    /// Ranks are the lengths of longest paths; the number of states is as good as infinity.
    #[test]
    fn ranks_say_how_many_steps_a_state_allows(text in system()) {
        let problem = problem(&text);
        let system = problem.systems.first().expect("there is one");
        let graph = Graph::explore(system, 100).expect("it is small");
        let mut allow = vec![true; graph.len()];
        for steps in 0..=graph.len() as u32 {
            for (state, allows) in allow.iter().enumerate() {
                prop_assert_eq!(*allows, graph.rank[state] >= steps, "state {}, {} steps", state, steps);
            }
            let next = |s| graph.successors(s).iter().any(|t| allow[t.1 as usize]);
            allow = (0..graph.len() as StateIx).map(next).collect();
        }
        prop_assert!((0..graph.len()).all(|s| allow[s] == (graph.rank[s] == LIVE)));
    }

    #[test]
    fn paths_are_runs_and_back(text in system()) {
        let problem = problem(&text);
        let system = problem.systems.first().expect("there is one");
        let graph = Arc::new(Graph::explore(system, 100).expect("it is small"));
        for trace in paths(system, PathId::from(0), 2) {
            let run = Run::of(&graph, &trace.states, &trace.actions).expect("it is a path");
            prop_assert_eq!(run.trace(trace.path, system), trace);
        }
    }
}
