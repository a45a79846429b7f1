//! Who listens to an oracle hears what is said.

use super::{Listener, Oracle};
use crate::cegis::Cegis;
use crate::config::Config;
use hyperplan_encode::{Encoder, Goal, Limits};
use hyperplan_problem::{NoFiles, Overrides, read};
use hyperplan_smt::Script;
use hyperplan_solver::Spec;
use hyperplan_syntax::SourceMap;

#[derive(Default)]
struct Recorder(Vec<(&'static str, usize)>);

impl Listener for Recorder {
    fn opened(&mut self) {
        self.0.push(("open", 0));
    }

    fn closed(&mut self) {
        self.0.push(("close", 0));
    }

    fn checked(&mut self, script: &Script, satisfiable: bool) {
        self.0.push((if satisfiable { "sat" } else { "unsat" }, script.len()));
    }
}

#[test]
fn dialogues_nest_and_scripts_grow() {
    let text =
        "system S { state x: 0..3; action up, stay; on up { x' = if x > 2 then 3 else x + 1; } on stay { x' = x; } }
        objective o within 3 { exists p. forall q. F x[p] == 3 & (x[q] == 0 -> G x[q] <= x[p]) }";
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &NoFiles, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    let objective = &lowered.problem.objectives[0];
    let encoder = Encoder::new(&lowered.problem, objective, None, Limits::default(), &|| false);
    let encoder = encoder.expect("it is small");
    let (config, mut heard) = (Config::new(Spec::Builtin), Recorder::default());
    let mut oracle = Oracle::new(&config).heard_by(&mut heard);
    let goal = Goal::new(&objective.formula, true);
    let blocks = objective.blocks();
    let found = Cegis::new(&encoder, &mut oracle, &blocks).find(0, &vec![None; 2], &goal, 1);
    assert_eq!(found.expect("it is decided").len(), 1);
    let account = oracle.into_account();
    assert_eq!((account.solver.name.as_str(), account.notes.len()), ("builtin", 0));
    let mut depth: Vec<usize> = Vec::new();
    for &(what, length) in &heard.0 {
        match what {
            "open" => depth.push(0),
            "close" => assert!(depth.pop().is_some()),
            _ => {
                let before = depth.last_mut().expect("it is in a dialogue");
                assert!(*before <= length, "{:?}", heard.0);
                *before = length;
            }
        }
    }
    assert!(depth.is_empty() && heard.0.first() == Some(&("open", 0)), "{:?}", heard.0);
    assert!(heard.0.iter().any(|(what, _)| *what == "unsat"), "the last candidate was not defeated");
}
