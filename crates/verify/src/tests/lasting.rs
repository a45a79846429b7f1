//! Steps that only add to earlier ones: what a move leads to may change with the given traces, even where it led to nothing that
//! matters.

use crate::{Budget, Check, Defeat, check};
use hyperplan_problem::{ActionId, NoFiles, Overrides, PathId, Problem, Strategy, Trace, Value, read};
use hyperplan_random::Random;
use hyperplan_syntax::SourceMap;

/// How many steps are read.
const T: usize = 14;

/// Among these states, some of which are exits, other paths move.
const STATES: usize = 5;

/// p counts, and the doors are open at some times; q must not leave when they are closed.
struct Doors {
    open: Vec<bool>,
    exit: Vec<bool>,
    starts: Vec<usize>,
    edges: Vec<Vec<usize>>,
}

impl Doors {
    fn random(random: &mut Random) -> Doors {
        let some = |random: &mut Random| -> Vec<usize> {
            let mut some: Vec<usize> = (0..STATES).filter(|_| random.once_in(3)).collect();
            some.push(random.below(STATES));
            some
        };
        Doors {
            open: (0..=T).map(|_| !random.once_in(6)).collect(),
            exit: (0..STATES).map(|state| state > 0 && random.once_in(3)).collect(),
            starts: vec![0],
            edges: (0..STATES).map(|_| some(random)).collect(),
        }
    }

    fn problem(&self) -> Problem {
        let all = |of: &[bool], name: &str| {
            let each = of.iter().enumerate().filter(|(_, is)| **is).map(|(n, _)| format!("{name} == {n}"));
            each.chain(["false".to_owned()]).collect::<Vec<_>>().join(" | ")
        };
        let listed =
            |numbers: &[usize]| numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let clauses: String = (0..STATES)
            .map(|state| format!("on go when s == {state} {{ s' in {{{}}}; }}\n", listed(&self.edges[state])))
            .collect();
        let starts: Vec<String> = self.starts.iter().map(|state| format!("s == {state}")).collect();
        let text = format!(
            "system Clock {{ state c: 0..{T}; action go; on go {{ c' = if c < {T} then c + 1 else c; }}
               init c == 0; label open = {}; }}
             system Rooms {{ state s: 0..{}; action go; {clauses} init {}; label exit = {}; }}
             objective o {{ exists p: Clock. forall q: Rooms. !exit[q] W[0,{T}] (exit[q] & open[p]) }}",
            all(&self.open, "c"),
            STATES - 1,
            starts.join(" | "),
            all(&self.exit, "s"),
        );
        let lowered = read(&mut SourceMap::new(), "test.hp", &text, &NoFiles, &Overrides::none());
        assert!(!lowered.has_errors(), "{:?}\n{text}", lowered.diagnostics);
        lowered.problem
    }

    /// Whether some path leaves when the doors are closed.
    fn escapes(&self) -> bool {
        let mut inside: Vec<bool> = (0..STATES).map(|state| self.starts.contains(&state)).collect();
        for time in 0..=T {
            if !self.open[time] && (0..STATES).any(|state| inside[state] && self.exit[state]) {
                return true;
            }
            let stays = |state: usize| inside[state] && !self.exit[state];
            let reached = |to: usize| (0..STATES).any(|from| stays(from) && self.edges[from].contains(&to));
            inside = (0..STATES).map(reached).collect();
        }
        false
    }
}

#[test]
fn a_move_that_led_nowhere_is_not_forgotten() {
    let (mut hold, mut fail) = (0, 0);
    for seed in 0..3_000 {
        let doors = Doors::random(&mut Random::new(seed));
        let problem = doors.problem();
        let objective = &problem.objectives[0];
        let go = problem.action("go").expect("it is declared");
        let states = (0..=T).map(|time| [Value::Int(time as i64)].into()).collect();
        let actions: Vec<ActionId> = vec![go; T];
        let strategy = Strategy { traces: vec![Trace { path: PathId(0), states, actions }] };
        let checked = check(&problem, objective, &strategy, &Budget::default()).expect("well-formed");
        match checked {
            Check::Holds => {
                assert!(!doors.escapes(), "seed {seed}");
                hold += 1;
            }
            Check::Fails(Defeat::Paths(paths)) => {
                assert!(doors.escapes(), "seed {seed}");
                let state = |time: usize| match paths[0].states[time][0] {
                    Value::Int(state) => usize::try_from(state).expect("a room"),
                    _ => panic!("a room is a number"),
                };
                let left = (0..=T).find(|time| doors.exit[state(*time)]).expect("it leaves");
                assert!(!doors.open[left], "seed {seed}: it may leave at {left}");
                fail += 1;
            }
            other => panic!("seed {seed}: {other:?}"),
        }
    }
    assert!(hold > 300 && fail > 300, "{hold} {fail}");
}
