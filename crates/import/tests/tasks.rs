//! Random planning tasks: how long the shortest conformant plan is, by an interpreter of PDDL of their own and by what
//! their import says.

use hyperplan_import::{Input, Options, import};
use hyperplan_problem::{NoFiles, Overrides, lower};
use hyperplan_random::{Random, property};
use hyperplan_space::{Graph, holds_in};
use hyperplan_syntax::SourceMap;
use std::cell::Cell;
use std::collections::BTreeSet;

/// A fact, perhaps of the parameter, and whether it is true.
#[derive(Clone, Copy)]
struct Literal(usize, bool);

/// The facts are `(p a)`, `(p b)` and `(q)`; the last is `(p ?x)`.
const FACTS: [&str; 4] = ["(p a)", "(p b)", "(q)", "(p ?x)"];

enum Effect {
    Set(Literal),
    When(Vec<Literal>, Literal),
    OneOf(Vec<Literal>, Vec<Literal>),
}

struct Action {
    condition: Vec<Literal>,
    effects: Vec<Effect>,
}

struct Task {
    actions: Vec<Action>,
    first: [bool; 3],
    /// Whether one of `(p a)` and `(p b)` holds, and whether `(q)` is unknown.
    either: bool,
    unknown: bool,
    goal: Vec<Literal>,
}

type State = [bool; 3];
const STEPS: usize = 5;

impl Literal {
    fn random(random: &mut Random, facts: usize) -> Literal {
        Literal(random.below(facts), random.flip())
    }

    fn some(random: &mut Random, facts: usize, most: usize) -> Vec<Literal> {
        (0..random.below(most + 1)).map(|_| Literal::random(random, facts)).collect()
    }

    fn show(self) -> String {
        let Literal(fact, positive) = self;
        if positive { FACTS[fact].to_owned() } else { format!("(not {})", FACTS[fact]) }
    }

    /// The fact where the parameter is this object.
    fn of(self, object: usize) -> usize {
        if self.0 == 3 { object } else { self.0 }
    }

    fn holds(self, state: &State, object: usize) -> bool {
        state[self.of(object)] == self.1
    }
}

fn all(literals: &[Literal]) -> String {
    format!("(and {})", literals.iter().map(|literal| literal.show()).collect::<Vec<_>>().join(" "))
}

impl Effect {
    fn random(random: &mut Random) -> Effect {
        match random.below(4) {
            0 => Effect::When(Literal::some(random, 4, 2), Literal::random(random, 4)),
            1 => Effect::OneOf(Literal::some(random, 4, 2), Literal::some(random, 4, 2)),
            _ => Effect::Set(Literal::random(random, 4)),
        }
    }

    fn show(&self) -> String {
        match self {
            Effect::Set(literal) => literal.show(),
            Effect::When(condition, literal) => format!("(when {} {})", all(condition), literal.show()),
            Effect::OneOf(one, other) => format!("(oneof {} {})", all(one), all(other)),
        }
    }
}

impl Task {
    fn random(random: &mut Random) -> Task {
        let action = |random: &mut Random| Action {
            condition: Literal::some(random, 4, 1),
            effects: (0..1 + random.below(3)).map(|_| Effect::random(random)).collect(),
        };
        Task {
            actions: (0..2 + random.below(4)).map(|_| action(random)).collect(),
            first: [random.flip(), random.flip(), random.flip()],
            either: random.flip(),
            unknown: random.flip(),
            goal: (0..2 + random.below(2)).map(|_| Literal::random(random, 3)).collect(),
        }
    }

    fn show(&self) -> String {
        let actions: String = (0..)
            .zip(&self.actions)
            .map(|(at, action): (usize, _)| {
                let effects: Vec<String> = action.effects.iter().map(Effect::show).collect();
                let condition = all(&action.condition);
                format!(
                    "(:action act{at} :parameters (?x - thing) :precondition {condition} :effect (and {}))\n",
                    effects.join(" ")
                )
            })
            .collect();
        let known = |fact: usize| self.first[fact] && !(self.either && fact < 2 || self.unknown && fact == 2);
        let mut init: Vec<String> = (0..3).filter(|fact| known(*fact)).map(|f| FACTS[f].to_owned()).collect();
        init.extend(self.either.then(|| "(oneof (p a) (p b))".to_owned()));
        init.extend(self.unknown.then(|| "(unknown (q))".to_owned()));
        format!(
            "(define (domain d) (:requirements :typing) (:types thing) (:predicates (p ?x - thing) (q))\n{actions})\n\
             (define (problem t) (:domain d) (:objects a b - thing) (:init {}) (:goal {}))",
            init.join(" "),
            all(&self.goal)
        )
    }

    fn starts(&self) -> BTreeSet<State> {
        let mut starts = BTreeSet::from([self.first]);
        if self.either {
            let [_, _, q] = self.first;
            starts = BTreeSet::from([[true, false, q], [false, true, q]]);
        }
        if self.unknown {
            starts = starts.iter().flat_map(|[a, b, _]| [[*a, *b, true], [*a, *b, false]]).collect();
        }
        starts
    }

    /// Where an action leads; nowhere where it is impossible.
    fn step(action: &Action, state: &State, object: usize) -> Option<Vec<State>> {
        if !action.condition.iter().all(|literal| literal.holds(state, object)) {
            return None;
        }
        let mut outcomes: Vec<Vec<Literal>> = vec![Vec::new()];
        for effect in &action.effects {
            let ways: Vec<Vec<Literal>> = match effect {
                Effect::Set(literal) => vec![vec![*literal]],
                Effect::When(condition, literal) => {
                    let applies = condition.iter().all(|literal| literal.holds(state, object));
                    vec![if applies { vec![*literal] } else { Vec::new() }]
                }
                Effect::OneOf(one, other) => vec![one.clone(), other.clone()],
            };
            outcomes = outcomes
                .iter()
                .flat_map(|before| ways.iter().map(move |way| [before.as_slice(), way].concat()))
                .collect();
        }
        let after = |changes: &Vec<Literal>| {
            let mut next = *state;
            // Deleted first, then added.
            for positive in [false, true] {
                for literal in changes.iter().filter(|literal| literal.1 == positive) {
                    next[literal.of(object)] = positive;
                }
            }
            next
        };
        Some(outcomes.iter().map(after).collect())
    }

    fn shortest(&self) -> Option<usize> {
        let goal = |belief: &BTreeSet<State>| {
            belief.iter().all(|state| self.goal.iter().all(|literal| literal.holds(state, 0)))
        };
        let next = |belief: &BTreeSet<State>| {
            let mut found = Vec::new();
            for (action, object) in self.actions.iter().flat_map(|action| [(action, 0), (action, 1)]) {
                let all: Option<Vec<Vec<State>>> =
                    belief.iter().map(|state| Task::step(action, state, object)).collect();
                found.extend(all.map(|all| all.into_iter().flatten().collect::<BTreeSet<State>>()));
            }
            found
        };
        search(self.starts(), goal, next)
    }
}

/// The least number of steps to a goal, up to [`STEPS`].
fn search<B: Ord + Clone>(first: B, goal: impl Fn(&B) -> bool, next: impl Fn(&B) -> Vec<B>) -> Option<usize> {
    let mut layer = BTreeSet::from([first]);
    for steps in 0..=STEPS {
        if layer.iter().any(&goal) {
            return Some(steps);
        }
        layer = layer.iter().flat_map(&next).collect();
    }
    None
}

/// The same, of what the task was imported as: whatever has the plan's actions ends at the goal.
fn imported(text: &str) -> Option<usize> {
    let mut sources = SourceMap::new();
    let input = Input { name: "t.pddl".to_owned(), text: text.to_owned() };
    let options = Options { bound: Some(3), ..Options::default() };
    let imported = import(&[input], &options, &mut sources);
    assert!(imported.diagnostics.is_empty(), "{text}\n{:#?}", imported.diagnostics);
    let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    let objective = &lowered.problem.objectives[0];
    let system = &lowered.problem.systems[objective.paths.iter().last().expect("it has paths").system];
    let graph = Graph::explore(system, 10_000).expect("it is small");
    let label = &system.labels[system.label("goal").expect("it is there")];
    let goal = |belief: &BTreeSet<u32>| {
        belief.iter().all(|state| holds_in(system, &label.expr, &graph.state(system, *state)) == Some(true))
    };
    let next = |belief: &BTreeSet<u32>| {
        let of = |action: usize| {
            let steps = belief.iter().flat_map(|state| graph.of_action(*state, system.actions[action]));
            steps.map(|(_, to)| to).collect()
        };
        (0..system.actions.len()).map(of).collect::<Vec<BTreeSet<u32>>>()
    };
    search(graph.initial.iter().copied().collect(), goal, next)
}

#[test]
fn tasks_have_the_plans_that_they_have() {
    let (solved, longer) = (Cell::new(0), Cell::new(0));
    property(1500, 120, |random| {
        let task = Task::random(random);
        let text = task.show();
        let expected = task.shortest();
        assert_eq!(imported(&text), expected, "{text}");
        solved.set(solved.get() + usize::from(expected.is_some()));
        longer.set(longer.get() + usize::from(expected.is_some_and(|steps| steps > 1)));
    });
    let found = (solved.get(), longer.get());
    assert!(found.0 > 100 && found.0 < 1400 && found.1 > 15, "{found:?} have plans, and longer ones");
}
