//! The library as others use it: what is built in code means what its text means, errors have codes, time and tokens end
//! searches.

use hyperplan::answer::{ReasonCode, Scalar, Verdict};
use hyperplan::draw::Kind;
use hyperplan::{
    Cancel, Cell, Error, Graph, Grid, Objective, Options, Outcome, Problem, Reading, Solvers, System,
    Verification,
};
use std::collections::BTreeSet;
use std::thread;
use std::time::{Duration, Instant};

const LINE: &str = "const T = 3;
system Line {
  state x: 0..3;
  action left, right;
  on left  { x' = x - 1; }
  on right { x' = x + 1; }
  init x == 0;
}
objective end { exists p. F[0,T] x[p] == 3 }
";

/// Two players and many states: this takes long.
const HARD: &str = "system Big {
  state a: 0..60, b: 0..60, c: 0..60, d: bool;
  action u, v, w, z;
  on u { a' in {a + 1, a}; }
  on v { b' in {b + 1, b}; c' = if c == 60 then 0 else c + 1; }
  on w when a == b { c' in 0..60; }
  on z { d' = !d; a' = if a == 60 then 0 else a + 1; }
  init a == 0 & b == 0;
}
objective hard {
  exists p, s. forall q. exists r.
    F[0,24] (a[p] == 9 & b[q] != c[r] & a[s] != a[p]) & (G[0,24] action[q] == action[p] -> G[0,20] (c[r] != c[q] | d[p]))
}
";

fn line() -> Problem {
    Problem::from_text(LINE).expect("it has no errors")
}

#[test]
fn problems_and_answers_go_to_other_threads() {
    fn is_send_and_sync<T: Send + Sync>() {}
    is_send_and_sync::<Problem>();
    is_send_and_sync::<Objective<'_>>();
    is_send_and_sync::<Options>();
    is_send_and_sync::<Cancel>();
    is_send_and_sync::<Outcome>();
    is_send_and_sync::<Error>();
}

#[test]
fn two_mebibytes_of_stack_are_enough() {
    let deep = (0..200).fold("x[p] == 3".to_owned(), |inner, _| format!("(F[0,1] {inner})"));
    let text = LINE.replace("x[p] == 3", &deep);
    let solve = move || {
        let problem = Problem::from_text(text)?;
        problem.only_objective()?.solve(&Options::new()).map(|outcome| outcome.verdict())
    };
    let worker = thread::Builder::new().stack_size(2 << 20).spawn(solve).expect("it can be started");
    let verdict = worker.join().expect("nothing panics").expect("it can be decided");
    assert_eq!(verdict, Verdict::Realizable);
}

#[test]
fn errors_have_codes_and_places() {
    let broken = Problem::from_text(LINE.replace("x[p] == 3", "y[p] == 3")).expect_err("there is no y");
    let [fault] = broken.faults() else { panic!("{broken}") };
    assert_eq!(fault.code, broken.code());
    let span = fault.span.as_ref().expect("it has a place");
    assert_eq!((span.line, span.column), (9, 34));
    assert!(broken.to_string().contains("y[p] == 3"), "the line is shown: {broken}");

    let none = line().objective("start").map(|_| ()).expect_err("there is no such objective");
    assert_eq!((none.code(), none.faults().len()), ("no-objective", 0));
    assert_eq!(Problem::load("there/is/none.hp").expect_err("there is none").code(), "cannot-read");
    assert_eq!(Solvers::new().add("[[solver]]\n").expect_err("it has no name").code(), "bad-profile");
    let constant = line().only_objective().expect("there is one").minimize("K", None, &Options::new());
    assert_eq!(constant.expect_err("there is no K").code(), "bad-constant");
    let missing = Solvers::new().find("there-is-no-such-solver").expect("nobody has looked yet");
    let outcome = line().only_objective().expect("there is one").solve(&Options::new().solver(missing));
    assert_eq!(outcome.expect_err("it is not there").code(), "solver-failed");
    let mut graph = Graph::new();
    let state = graph.state("a");
    graph.edge(state, "go", state, &[]);
    graph.label("no word", [state]);
    let built = Problem::builder().system("S", System::graph(graph)).build();
    assert_eq!(built.expect_err("a label is a word").code(), "bad-system");
    let built = Problem::builder().system("no word", System::new()).build();
    assert_eq!(built.expect_err("so is a system's name").code(), "bad-system");
}

#[test]
fn codes_are_those_of_json() {
    for code in ReasonCode::ALL {
        assert_eq!(serde_json::to_value(code).expect("it has a name"), code.name());
    }
    for verdict in Verdict::ALL {
        assert_eq!(serde_json::to_value(verdict).expect("it has a name"), verdict.name());
    }
}

/// When it is over, and what the verdict is, if there is one.
fn hard(options: &Options) -> (Duration, Option<Verdict>) {
    let problem = Problem::from_text(HARD).expect("it has no errors");
    let start = Instant::now();
    let outcome = problem.only_objective().expect("there is one").solve(options);
    let verdict = match outcome {
        Ok(outcome) => Some(outcome.verdict()),
        Err(error) => {
            assert!(["timeout", "interrupted"].contains(&error.code()), "{error}");
            None
        }
    };
    (start.elapsed(), verdict)
}

#[test]
fn time_ends_a_search() {
    let (took, verdict) = hard(&Options::new().timeout(Duration::from_millis(300)));
    assert!(took < Duration::from_secs(10), "{took:?}");
    assert!(verdict.is_none_or(|verdict| verdict == Verdict::Unknown));
}

#[test]
fn a_token_ends_a_search_and_all_that_are_begun_with_it() {
    let cancel = Cancel::new();
    let options = Options::new().cancel(&cancel);
    let (took, verdict) = thread::scope(|scope| {
        let search = scope.spawn(|| hard(&options));
        thread::sleep(Duration::from_millis(300));
        cancel.cancel();
        search.join().expect("nothing panics")
    });
    assert!(took < Duration::from_secs(10), "{took:?}");
    assert!(verdict.is_none_or(|verdict| verdict == Verdict::Unknown));
    assert!(cancel.is_cancelled());
    let (_, verdict) = hard(&options);
    assert!(verdict.is_none_or(|verdict| verdict == Verdict::Unknown));
}

/// Numbers that look random, the same each time.
fn random(seed: &mut u64, below: u64) -> u64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 33) % below
}

/// The same random map as a grid, as a graph and as the language has it: the shortest ways are as long.
#[test]
fn grids_and_graphs_mean_what_their_texts_mean() {
    let mut seed = 5;
    for round in 0..20 {
        let (width, height) = (2 + random(&mut seed, 5), 2 + random(&mut seed, 5));
        let mut walls = BTreeSet::new();
        for cell in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            if cell != (0, 0) && cell != (width - 1, height - 1) && random(&mut seed, 3) == 0 {
                walls.insert(cell);
            }
        }
        let is_wall = |x: u64, y: u64| walls.contains(&(x, y));
        let text = (0..height).rev().map(|y| {
            let cell = |x: u64| match (x, y) {
                (0, 0) => 'S',
                (x, y) if (x, y) == (width - 1, height - 1) => 'G',
                (x, y) if is_wall(x, y) => '#',
                _ => '.',
            };
            format!("\"{}\"\n", (0..width).map(cell).collect::<String>())
        });
        let text: String = text.collect();
        let text = format!("system World = grid {{\n{text}}} {{ moves up, down, left, right, stay; }}");

        let cell = |x: usize, y: usize| if is_wall(x as u64, y as u64) { Cell::Obstacle } else { Cell::Free };
        let goal = (u32::try_from(width - 1).expect("small"), u32::try_from(height - 1).expect("small"));
        let grid = Grid::new(width as usize, height as usize, cell);
        let grid = System::grid(grid.label("start", [(0, 0)]).label("goal", [goal]));
        let grid = grid.item("moves up, down, left, right, stay;");

        let mut graph = Graph::new();
        let number = |graph: &mut Graph, x: u64, y: u64| graph.state(format!("{x} {y}"));
        for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            if is_wall(x, y) {
                continue;
            }
            let own = number(&mut graph, x, y);
            graph.edge(own, "stay", own, &[]);
            let near = [
                ("right", x + 1, y),
                ("left", x.wrapping_sub(1), y),
                ("up", x, y + 1),
                ("down", x, y.wrapping_sub(1)),
            ];
            for (action, x, y) in near {
                if x < width && y < height && !is_wall(x, y) {
                    let to = number(&mut graph, x, y);
                    graph.edge(own, action, to, &[]);
                }
            }
        }
        let (start, end) = (number(&mut graph, 0, 0), number(&mut graph, width - 1, height - 1));
        graph.label("start", [start]);
        graph.label("goal", [end]);

        let least = |builder: hyperplan::Builder| {
            let formula = "exists p. start[p] & F[0,T] goal[p]";
            let built =
                builder.constant("T", width * height).objective("o", formula).build().expect("no errors");
            let objective = built.only_objective().expect("there is one");
            let found = objective.minimize("T", None, &Options::new()).expect("it is decided");
            if let Some(strategy) = found.outcome.strategy() {
                let with = found.problem.only_objective().expect("there is one");
                assert_eq!(with.verify(strategy).expect("it is small"), Verification::Holds);
            }
            (found.value, found.proved)
        };
        let expected = least(Problem::builder().text(text));
        assert_eq!(least(Problem::builder().system("World", grid)), expected, "round {round}: a grid");
        assert_eq!(
            least(Problem::builder().system("World", System::graph(graph))),
            expected,
            "round {round}: a graph"
        );
    }
}

#[test]
fn what_was_built_can_be_saved_and_read_again() {
    let grid = Grid::new(4, 2, |x, y| if (x, y) == (1, 1) { Cell::Unknown } else { Cell::Free });
    let system = System::grid(grid.place(0.5, [1.0, 2.0, 0.0]).label("goal", [(3, 1)]).label("nowhere", []));
    let built = Problem::builder()
        .system("Room", system.item("unknown free;").init("(x, y) in {(0, 1)}"))
        .objective("o", "exists p. F[0,3] goal[p]")
        .build()
        .expect("it has no errors");
    let folder = tempfile::tempdir().expect("there is a place");
    let file = built.save(folder.path(), "room").expect("it can be written");
    let read = Problem::load(&file).expect("it has no errors");
    for problem in [&built, &read] {
        let outcome =
            problem.only_objective().expect("there is one").solve(&Options::new()).expect("it is decided");
        let path = outcome.path("p").expect("it has a path");
        assert_eq!(path.actions, ["right"; 3]);
        assert_eq!(path.states[1].get("x"), Some(&Scalar::Int(1)));
        assert_eq!(path.positions.as_ref().map(|all| all[0]), Some((1.25, 2.75)));
    }
    let shown = read.only_objective().expect("there is one");
    let outcome = shown.solve(&Options::new()).expect("it is decided");
    let strategy = outcome.strategy().expect("it has one");
    let page = shown.draw(strategy, Kind::Html).expect("it can be drawn");
    assert!(page.starts_with(b"<!"));
}

/// A text with a folder, and files of other tools: what is saved means the same without either.
#[test]
fn what_was_read_can_be_saved() {
    let (from, to) = (tempfile::tempdir().expect("a place"), tempfile::tempdir().expect("a place"));
    let write = |name: &str, text: &str| {
        let path = from.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("it can be made");
        std::fs::write(&path, text).expect("it can be written");
        path
    };
    write("maps/room.txt", "..G\n.#.\nS..\n");
    let model = write("m.smv", "MODULE main\nVAR b : boolean;\nASSIGN init(b) := FALSE; next(b) := !b;\n");
    let formula = write("f.hq", "exists A. F b[A]\n");
    let map = |name: &str| {
        let system = format!("system Room = grid(\"{name}\") {{}}\n");
        let text = system + "const T = 9;\nobjective o { exists p. start[p] & F[0,T] goal[p] }\n";
        Problem::builder().text(text).folder(from.path()).build().expect("it has no errors")
    };
    let outside = write("outside.txt", "S.G\n").display().to_string();
    let reading = Reading { bound: Some(3), ..Reading::default() };
    let foreign = Problem::load_foreign(&[model, formula], reading).expect("it has no errors");
    for (name, problem) in [("map", map("maps/room.txt")), ("foreign", foreign)] {
        let file = problem.save(to.path(), name).expect("it can be written");
        let read = Problem::load(&file).expect("it has no errors");
        assert_eq!(format!("{:?}", read.constants()), format!("{:?}", problem.constants()));
        let actions = [&problem, &read].map(|problem| {
            let objective = problem.only_objective().expect("there is one");
            let outcome = objective.solve(&Options::new()).expect("it is decided");
            assert_eq!(outcome.answer.verdict, Verdict::Realizable, "{name}");
            outcome.paths()[0].actions.clone()
        });
        assert_eq!(actions[0], actions[1], "{name}");
    }
    let refused = map(&outside).save(to.path(), "absolute").expect_err("it lies elsewhere");
    assert_eq!(refused.code(), "cannot-write");
    let own = from.path().file_name().expect("it has a name").to_string_lossy().into_owned();
    let up = map(&format!("../{own}/outside.txt"));
    assert_eq!(up.save(to.path(), "up").expect_err("it lies elsewhere").code(), "cannot-write");
}

#[test]
fn strategies_come_from_names_and_texts() {
    let problem = line();
    let objective = problem.only_objective().expect("there is one");
    let outcome = objective.solve(&Options::new()).expect("it is decided");
    let json = serde_json::to_string(&outcome.answer).expect("it is JSON");
    let strategy = objective.read_strategy(&json).expect("it is one");
    assert_eq!(Some(&strategy), outcome.strategy());
    let mut paths = objective.paths_of(&strategy);
    paths[0].states.clear();
    assert_eq!(objective.strategy(&paths).expect("actions decide the states"), strategy);
    paths[0].actions = vec!["left".to_owned()];
    assert_eq!(objective.strategy(&paths).expect_err("there is a wall").code(), "no-strategy");
    assert_eq!(objective.read_strategy("{").expect_err("it is no JSON").code(), "no-strategy");
}

#[test]
fn unrealizable_objectives_are_explained() {
    let problem = line().with("T", 2).expect("there is a T");
    assert_eq!(problem.constants().len(), 1);
    let objective = problem.only_objective().expect("there is one");
    let outcome = objective.solve(&Options::new()).expect("it is decided");
    assert_eq!(outcome.verdict(), Verdict::Unrealizable);
    let found = objective.explain(&outcome, &Options::new()).expect("reasons are found");
    assert!(found.core.is_some_and(|core| core.parts.len() == 1));
    assert!(found.later.iter().any(|later| later.least == Some(3)), "{:?}", found.later);
    let [(name, horizon)] = objective.horizon_in_words().try_into().expect("there is one path");
    assert_eq!((name.as_str(), horizon.steps), ("p", Some(2)));
}
