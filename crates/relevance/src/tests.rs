//! What the tests of the modules share, and soundness by brute force: nothing is excluded that counts.

use crate::belief::{Belief, believe};
use crate::cube::{Case, Cube};
use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::Question;
use crate::relevant::{Narrowing, Relevance, leading};
use crate::split::case;
use crate::task::{Arena, Limits, Pruning, Task};
use hyperplan_problem::{PathId, Problem, Trace};
use hyperplan_space::{Graph, Run};
pub(crate) use hyperplan_tiny::problem;
use hyperplan_tiny::{formula, holds, paths, system};
use proptest::prelude::*;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The first objective of a problem.
pub(crate) fn arena(problem: &Problem) -> Arena<'_> {
    let objective = &problem.objectives[0];
    let task = Task::new(problem, objective, Limits::default(), &|| false).expect("it is short");
    let graph = |path: PathId| Arc::new(Graph::explore(task.system(path), 1000).expect("it is small"));
    let graphs = objective.paths.keys().map(graph).collect();
    Arena { task, graphs, ceilings: Vec::new(), cube: Cube::default() }
}

/// The question about a path of which nothing is known.
pub(crate) fn alone<'a>(
    arena: &'a Arena<'a>,
    path: PathId,
    goal: &'a Goal,
    declared: &'a FxHashMap<PathId, Arc<Layers>>,
) -> Question<'a, 1> {
    Question {
        arena,
        paths: [path],
        within: [None],
        goal,
        fixed: &[None, None],
        declared,
        slack: None,
        least: 0,
        one_run: false,
        ceiling: None,
        budget: 10_000,
    }
}

/// Steps of every path.
const STEPS: usize = 2;

const P: PathId = PathId(0);
const Q: PathId = PathId(1);

fn objective(system: &str, prefix: &str, formula: &str) -> Problem {
    problem(&format!("{system} objective o within {STEPS} {{ {prefix} {formula} }}"))
}

/// All paths of the system, with how they run through its graph.
fn runs(arena: &Arena<'_>, path: PathId) -> Vec<(Trace, Run)> {
    let traces = paths(arena.task.system(path), path, STEPS).into_iter();
    let run = |trace: &Trace| Run::of(&arena.graphs[path], &trace.states, &trace.actions).expect("a path");
    traces.map(|trace| (trace.clone(), run(&trace))).collect()
}

/// Whether a run is in some layers, as long as these go.
fn within(run: &Run, layers: &Layers) -> bool {
    (0..layers.at.len()).all(|time| layers.contains(time, run.states[time]))
}

/// So many cases, those that are not empty.
fn cases(arena: &Arena<'_>, block: &[PathId], goal: &Goal, number: usize) -> Vec<Cube> {
    let all = (0..number).map(|index| case(arena, block, goal, (index, number)).expect("it is small"));
    let all: Vec<Case> = all.collect();
    let some = all.iter().filter_map(|case| match case {
        Case::Of(cube) => Some(cube.clone()),
        Case::Empty => None,
        Case::Whole => Some(Cube::default()),
    });
    let cubes: Vec<Cube> = some.collect();
    match all.contains(&Case::Whole) {
        true => vec![Cube::default()],
        false => cubes,
    }
}

/// Whether a run is in a case.
fn is_in(run: &Run, path: PathId, cube: &Cube) -> bool {
    cube.of(path).all(|(time, states)| states.contains(&run.states[time as usize]))
}

/// Whether the one choice of paths satisfies the formula.
fn satisfied(arena: &Arena<'_>, p: &Trace, q: &Trace) -> bool {
    holds(arena.task.problem, arena.task.objective, &[p, q])
}

fn layers(relevance: &mut Relevance<'_, '_>, path: PathId, goal: &Goal) -> Arc<Layers> {
    relevance.declare(path, goal).expect("it is small")
}

fn pruning() -> impl Strategy<Value = Pruning> {
    prop_oneof![Just(Pruning::Full), Just(Pruning::Light), Just(Pruning::None)]
}

proptest! {
    // Some faults show in one of a thousand.
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn satisfying_pairs_are_kept(system in system(), formula in formula(&["p", "q"])) {
        let problem = objective(&system, "exists p. exists q.", &formula);
        let arena = arena(&problem);
        let goal = Goal::new(&arena.task.objective.formula, true);
        let found = leading(&arena, &[P, Q], &goal, Narrowing::default()).expect("it is small");
        prop_assert!(found.is_exact());
        let hopeless = found.is_hopeless();
        let mut relevance = Relevance::new(&arena, vec![None, None], found);
        let kept = [layers(&mut relevance, P, &goal), layers(&mut relevance, Q, &goal)];
        for (p, p_run) in runs(&arena, P) {
            for (q, q_run) in runs(&arena, Q) {
                if satisfied(&arena, &p, &q) {
                    prop_assert!(!hopeless && within(&p_run, &kept[0]) && within(&q_run, &kept[1]));
                }
            }
        }
    }

    /// One run is found where there is one within the slack, and satisfies what is read of it alone.
    #[test]
    fn one_run_is_a_run(
        system in system(),
        formula in formula(&["p"]),
        slack in prop::option::of(0..3u32),
    ) {
        let problem = objective(&system, "exists p.", &formula);
        let arena = arena(&problem);
        let goal = Goal::new(&arena.task.objective.formula, true);
        let find = |one_run| leading(&arena, &[P], &goal, Narrowing { slack, one_run }).expect("it is small");
        let (one, all) = (find(true), find(false));
        prop_assert_eq!(one.is_hopeless(), all.is_hopeless());
        let kept = layers(&mut Relevance::new(&arena, vec![None], one), P, &goal);
        if !kept.is_empty() && kept.at.iter().all(|states| states.len() == 1) {
            // Layers say where it is, not which action it takes.
            let holds = |p: &Trace| holds(arena.task.problem, arena.task.objective, &[p]);
            prop_assert!(runs(&arena, P).iter().any(|(p, run)| within(run, &kept) && holds(p)));
        }
    }

    /// With games where the two are tied. A path that wins against all others is kept, and makes no move that the game
    /// has closed; beside a path that is kept, all that defeat it are.
    #[test]
    fn winners_and_their_defeats_are_kept(
        system in system(),
        formula in formula(&["p", "q"]),
        slack in prop::option::of(0..2u32),
    ) {
        let problem = objective(&system, "exists p. forall q.", &formula);
        let arena = arena(&problem);
        let formula = &arena.task.objective.formula;
        let goal = Goal::new(formula, true);
        let narrowing = Narrowing { slack, one_run: false };
        let found = leading(&arena, &[P], &goal, narrowing).expect("it is small");
        prop_assert!(found.is_exact() || slack.is_some());
        let (exact, game) = (found.is_exact(), found.game().cloned());
        let (own, rest) = goal.split(formula, &|path| path == P);
        let against = rest.opposed(formula);
        let mut relevance = Relevance::new(&arena, vec![None, None], found);
        let kept = layers(&mut relevance, P, &goal);
        let defeats = layers(&mut relevance, Q, &against);
        let (all, others) = (runs(&arena, P), runs(&arena, Q));
        for (p, run) in &all {
            let wins = others.iter().all(|(q, _)| satisfied(&arena, p, q));
            if wins && exact && !others.is_empty() {
                prop_assert!(within(run, &kept), "{:?}", p);
                for (game, time) in game.iter().flat_map(|game| (0..run.letters.len()).map(move |t| (game, t))) {
                    let closed = game.closed(time as u32);
                    let made = |l: &crate::LosingMove| {
                        l.state == run.states[time] && l.turn.letter == Some(run.letters[time])
                    };
                    prop_assert!(!closed.iter().any(made), "{:?}", p);
                }
            }
            // What is asked of p alone, p satisfies if it does so beside some q.
            let alone = own.is_empty() || others.iter().any(|(q, _)| satisfied(&arena, p, q));
            for (q, q_run) in others.iter().filter(|_| alone && within(run, &kept)) {
                prop_assert!(satisfied(&arena, p, q) || within(q_run, &defeats), "{:?} {:?}", p, q);
            }
        }
    }

    /// The explicit search says what listing all paths says, with layers and without; where it gives up early, nothing.
    #[test]
    fn beliefs_are_right(
        system in system(),
        formula in formula(&["p", "q"]),
        exists in any::<bool>(),
        pruning in pruning(),
        budget in prop_oneof![Just(usize::MAX), 0..40usize],
    ) {
        let prefix = if exists { "exists p. forall q." } else { "forall p. exists q." };
        let problem = objective(&system, prefix, &formula);
        let mut arena = arena(&problem);
        arena.task.limits.pruning = pruning;
        let goal = Goal::new(&arena.task.objective.formula, exists);
        let (all, others) = (runs(&arena, P), runs(&arena, Q));
        prop_assume!(!others.is_empty());
        let wins = |p: &Trace| others.iter().all(|(q, _)| satisfied(&arena, p, q) == exists);
        match believe(&arena, 1, &goal, budget).expect("it is small") {
            Belief::Found(found) => {
                prop_assert_eq!(found.len(), 1);
                prop_assert!(wins(&found[0].trace(P, arena.task.system(P))));
            }
            Belief::Hopeless => prop_assert!(!all.iter().any(|(p, _)| wins(p))),
            Belief::Open => prop_assert!(budget < usize::MAX),
            Belief::Unfit => prop_assert!(false, "all atoms are known"),
        }
    }

    /// Whatever is satisfied is so in one case.
    #[test]
    fn satisfying_pairs_are_in_one_case(
        system in system(),
        formula in formula(&["p", "q"]),
        number in 1..7usize,
    ) {
        let problem = objective(&system, "exists p. exists q.", &formula);
        let arena = arena(&problem);
        let goal = Goal::new(&arena.task.objective.formula, true);
        let cases = cases(&arena, &[P, Q], &goal, number);
        for (p, p_run) in runs(&arena, P) {
            for (q, q_run) in runs(&arena, Q) {
                if satisfied(&arena, &p, &q) {
                    let holds = |cube: &&Cube| is_in(&p_run, P, cube) && is_in(&q_run, Q, cube);
                    prop_assert_eq!(cases.iter().filter(holds).count(), 1, "{:?}", cases);
                }
            }
        }
    }

    /// Whoever wins does so in one case, where both kinds of search keep it, or find another.
    #[test]
    fn winners_are_in_one_case(
        system in system(),
        formula in formula(&["p", "q"]),
        number in 1..7usize,
        pruning in pruning(),
    ) {
        let problem = objective(&system, "exists p. forall q.", &formula);
        let mut arena = arena(&problem);
        arena.task.limits.pruning = pruning;
        let goal = Goal::new(&arena.task.objective.formula, true);
        let (all, others) = (runs(&arena, P), runs(&arena, Q));
        prop_assume!(!others.is_empty());
        let wins = |p: &Trace| others.iter().all(|(q, _)| satisfied(&arena, p, q));
        let winners: Vec<&Run> = all.iter().filter(|(p, _)| wins(p)).map(|(_, run)| run).collect();
        let cases = cases(&arena, &[P], &goal, number);
        for run in &winners {
            prop_assert_eq!(cases.iter().filter(|cube| is_in(run, P, cube)).count(), 1, "{:?}", cases);
        }
        for cube in &cases {
            let own = Arena { cube: cube.clone(), ..arena.clone() };
            let found = leading(&own, &[P], &goal, Narrowing::default()).expect("it is small");
            let kept = layers(&mut Relevance::new(&own, vec![None, None], found), P, &goal);
            let here: Vec<_> = winners.iter().filter(|run| is_in(run, P, cube)).collect();
            prop_assert!(here.iter().all(|run| within(run, &kept)), "{:?}", cube);
            match believe(&own, 1, &goal, usize::MAX).expect("it is small") {
                Belief::Found(found) => prop_assert!(wins(&found[0].trace(P, own.task.system(P)))),
                Belief::Hopeless => prop_assert!(here.is_empty(), "{:?}", cube),
                Belief::Open | Belief::Unfit => prop_assert!(false, "there is no limit"),
            }
        }
    }

    #[test]
    fn pruning_only_takes_away(system in system(), formula in formula(&["p", "q"])) {
        let problem = objective(&system, "exists p. forall q.", &formula);
        let pruned = arena(&problem);
        let [mut reached, mut all] = [pruned.clone(), pruned.clone()];
        reached.task.limits.pruning = Pruning::Light;
        all.task.limits.pruning = Pruning::None;
        let goal = Goal::new(&pruned.task.objective.formula, true);
        let [few, some, many] = [&pruned, &reached, &all].map(|arena| {
            let found = leading(arena, &[P], &goal, Narrowing::default()).expect("it is small");
            layers(&mut Relevance::new(arena, vec![None, None], found), P, &goal)
        });
        for (time, states) in few.at.iter().enumerate() {
            prop_assert!(states.iter().all(|&state| some.contains(time, state)));
            prop_assert!(some.at[time].iter().all(|&state| many.contains(time, state)));
        }
        prop_assert_eq!(&some.at[0], &many.at[0]);
        prop_assert!(runs(&all, P).iter().all(|(_, run)| within(run, &some)));
    }
}

/// What cannot be done with open eyes is known after a look at each pair of states, however many times there are.
#[test]
fn many_times_are_looked_at_once() {
    let text = "
        system Line {
          state x: 0..9;
          action left, right, stay;
          init x == 0;
          on left when x > 0 { x' = x - 1; }
          on left when x == 0 {}
          on right when x < 9 { x' = x + 1; }
          on right when x == 9 {}
          on stay {}
        }
        objective o within 500 { exists p. forall q. F (x[p] == 9 & x[q] == 9) }";
    let problem = problem(text);
    let arena = arena(&problem);
    let goal = Goal::new(&arena.task.objective.formula, true);
    let answer = believe(&arena, 1, &goal, 500).expect("it is small");
    assert!(matches!(answer, Belief::Hopeless), "it is lost step by step");
}
