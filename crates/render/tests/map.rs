//! Drawings of small problems, compared as a whole.

mod common;

use common::{problem, scene};
use hyperplan_problem::answer::{StrategyFile, to_strategy};
use hyperplan_problem::{Overrides, Problem, Strategy, read};
use hyperplan_render::{Error, Scene, TextStyle, actions_line, svg, table, text_map};
use hyperplan_syntax::SourceMap;

const ROOM: &str = r#"
system W = grid {
  "..G"
  ".#."
  "SS."
} {
  edge crash;
  obstacle crash;
  label high = y >= 2;
  absorb goal;
}
objective o { exists p, q. start[p] & start[q] & F[0,4] goal[p] & F[0,4] crash[q] }
"#;

const WITNESS: &str = r#"{"witness": [
  {"path": "p", "actions": ["left", "up", "up", "right", "right", "up"], "states": [
    {"x": 1, "y": 0}, {"x": 0, "y": 0}, {"x": 0, "y": 1}, {"x": 0, "y": 2}, {"x": 1, "y": 2}, {"x": 2, "y": 2},
    {"x": 2, "y": 2}]},
  {"path": "q", "actions": ["right", "up"], "states": [
    {"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 0, "crash": true}]}]}"#;

fn strategy(problem: &Problem) -> Strategy {
    common::strategy(problem, WITNESS)
}

#[test]
fn letters_are_those_of_the_map() {
    let problem = problem(
        r#"system W = grid { "A~.w" "S..." } { legend 'A' = goal; legend '~' = water; legend 'w' = water; label wet = x >= 1; }
           objective o { exists p. start[p] & F[0,9] goal[p] }"#,
    );
    let scene = Scene { problem: &problem, objective: None, traces: &[], note: "" };
    let text = text_map(scene, TextStyle::default()).expect("a map");
    let expected = "\
1  A  ~  W  ~
0  S  W  W  W
   0  1  2  3
A goal, ~ water, W wet
";
    assert!(text.ends_with(expected), "{text}");
}

#[test]
fn a_map_for_each_path() {
    let problem = problem(ROOM);
    let strategy = strategy(&problem);
    let text = text_map(scene(&problem, &strategy), TextStyle::default()).expect("a map");
    let expected = "\
p (5 steps):
2  H→ H→ G*
1  ↑  #  .
0  S↑ S← .
   0  1  2

q (2 steps):
2  H  H  G
1  .  #  .
0  S→ SX .
   0  1  2
H high
";
    assert_eq!(text, expected);
}

#[test]
fn lines_and_tables() {
    let problem = problem(ROOM);
    let strategy = strategy(&problem);
    let objective = &problem.objectives[0];
    let line = |i: usize| actions_line(&problem, objective, &strategy.traces[i]);
    assert_eq!(line(0), "left, up x2, right x2, absorbed after 5 steps");
    assert_eq!(line(1), "right, up");
    let expected = "\
time  action  x  y  crash
   0  right   0  0  false
   1  up      1  0  false
   2  -       1  0   true
";
    assert_eq!(table(&problem, objective, &strategy.traces[1]), expected);
}

#[test]
fn coordinates_make_a_map() {
    let problem = problem(
        "system S { state x: -1..1, y: 5..6, fast: bool; action go; on go { x' = x + 1; }
           label mark = x == 0 & y == 6; label quick = fast; }
         objective o { exists p. mark[p] }",
    );
    let scene = Scene { problem: &problem, objective: None, traces: &[], note: "" };
    let text = text_map(scene, TextStyle::default()).expect("x and y are integers");
    // `quick` depends on more than the place, and is left out.
    assert_eq!(text, "6  .  M  .\n5  .  .  .\n   -1 0  1\nM mark\n");
}

#[test]
fn other_systems_are_refused() {
    let problem = problem("system S { state n: 0..3; } objective o { exists p. n[p] == 0 }");
    let scene = Scene { problem: &problem, objective: None, traces: &[], note: "" };
    let error = Error::Unsupported { system: "S".to_owned() };
    assert_eq!(svg(scene), Err(error.clone()));
    assert_eq!(text_map(scene, TextStyle::default()), Err(error), "without a path there is nothing to tell");
}

#[test]
fn wide_maps_are_narrow() {
    let row = ".".repeat(30);
    let text = format!("system W = grid {{ \"{row}\" }} {{}} objective o {{ exists p. x[p] == 0 }}");
    let problem = problem(&text);
    let scene = Scene { problem: &problem, objective: None, traces: &[], note: "" };
    let drawn = text_map(scene, TextStyle::default()).expect("a map");
    assert_eq!(drawn, format!("0  {row}\n   0         10        20\n"));
}

#[test]
fn maps_that_lie_somewhere_say_where() {
    let files = |path: &str| match path {
        "m.yaml" => Ok(b"image: m.pgm\nresolution: 0.5\norigin: [-1, 2, 0]".to_vec()),
        "m.pgm" => Ok(b"P2 3 1 255 255 255 255".to_vec()),
        _ => Err("no such file".to_owned()),
    };
    let text = "system W = grid(\"m.yaml\") { init x == 0; }\nobjective o { exists p. F[0,2] x[p] == 2 }";
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &files, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    let problem = lowered.problem;
    let witness = r#"{"witness": [{"path": "p", "actions": ["right"], "states": [{"x": 0, "y": 0}, {"x": 1, "y": 0}]}]}"#;
    let witness = StrategyFile::read_all(witness).expect("JSON").remove(0).witness.expect("given");
    let strategy = to_strategy(&problem, &problem.objectives[0], &witness).expect("it fits");
    let scene = scene(&problem, &strategy);
    let text = text_map(scene, TextStyle::default()).expect("a map");
    assert!(text.ends_with("cells of 0.5 m, the centre of (0, 0) at (-0.75, 2.25) m\n"), "{text}");
    let drawn = svg(scene).expect("a map");
    assert!(drawn.contains("-0.75 m") && drawn.contains("2.25 m"), "{drawn}");
    let table = table(&problem, &problem.objectives[0], &strategy.traces[0]);
    assert_eq!(
        table,
        "time  action  x  y  x in m  y in m\n   0  right   0  0   -0.75    2.25\n   1  -       1  0   -0.25    2.25\n"
    );
}

#[test]
fn roadmaps_are_drawn_where_they_lie() {
    let graph = r#"{"directed": true, "nodes": [{"id": "a", "x": 0, "y": 0}, {"id": "b<", "x": 2, "y": 1, "goal": true}],
        "links": [{"source": "a", "target": "b<"}]}"#;
    let text = "system R = graph(\"r.json\") { absorb goal; }\nobjective o { exists p. node[p] == a & F[0,2] goal[p] }";
    let files = |_: &str| Ok(graph.as_bytes().to_vec());
    let lowered = read(&mut SourceMap::new(), "test.hp", text, &files, &Overrides::none());
    assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
    let problem = lowered.problem;
    let witness =
        r#"{"witness": [{"path": "p", "actions": ["go_b<"], "states": [{"node": "a"}, {"node": "b<"}]}]}"#;
    let witness = StrategyFile::read_all(witness).expect("JSON").remove(0).witness.expect("given");
    let strategy = to_strategy(&problem, &problem.objectives[0], &witness).expect("it fits");
    let drawn = svg(scene(&problem, &strategy)).expect("a roadmap");
    // Two units are 900 points; the second node is to the right and above.
    assert!(drawn.contains("M36,486 936,36"), "{drawn}");
    assert!(drawn.contains("b&lt;") && drawn.contains("goal"), "{drawn}");
    let text = text_map(scene(&problem, &strategy), TextStyle::default()).expect("a table");
    assert!(text.contains("time  action  node"), "{text}");
}

#[test]
fn what_nobody_has_seen_is_no_obstacle() {
    let files = |path: &str| match path {
        "m.yaml" => Ok(b"image: m.pgm".to_vec()),
        "m.pgm" => Ok(b"P2 3 1 255 255 150 0".to_vec()),
        _ => Err("no such file".to_owned()),
    };
    let drawn = |items: &str| {
        let text = format!("system W = grid(\"m.yaml\") {{ {items} }}");
        let lowered = read(&mut SourceMap::new(), "test.hp", &text, &files, &Overrides::none());
        assert!(!lowered.has_errors(), "{:?}", lowered.diagnostics);
        let scene = Scene { problem: &lowered.problem, objective: None, traces: &[], note: "" };
        (text_map(scene, TextStyle::default()).expect("a map"), svg(scene).expect("a map"))
    };
    let (text, picture) = drawn("");
    assert_eq!(text, "0  .  ░  #\n   0  1  2\n░ unknown\n");
    assert!(picture.contains("class=\"unknown\"") && picture.contains("class=\"obstacles\""), "{picture}");
    let (text, picture) = drawn("unknown free;");
    assert_eq!(text, "0  .  .  #\n   0  1  2\n", "the robot may go there");
    assert!(picture.contains("class=\"unknown\""), "{picture}");
}

#[test]
fn on_wide_maps_start_and_goal_stay() {
    let problem = problem(&format!(
        "system W = grid {{ \"S{}G\" }} {{}} objective o {{ exists p. x[p] == 0 }}",
        ".".repeat(28)
    ));
    let xs: Vec<usize> = [0, 1, 2, 1, 2].into_iter().chain(3..30).collect();
    let states: Vec<String> = xs.iter().map(|x| format!("{{\"x\": {x}, \"y\": 0}}")).collect();
    let actions: Vec<&str> =
        xs.windows(2).map(|two| if two[0] < two[1] { "\"right\"" } else { "\"left\"" }).collect();
    let (states, actions) = (states.join(","), actions.join(","));
    let witness =
        format!("{{\"witness\": [{{\"path\": \"p\", \"actions\": [{actions}], \"states\": [{states}]}}]}}");
    let strategy = common::strategy(&problem, &witness);
    let text = text_map(scene(&problem, &strategy), TextStyle::default()).expect("a map");
    let row = format!("0  S╬╬{}G\n", "→".repeat(26));
    assert!(text.contains(&row) && text.contains("╬ more than once"), "{text}");
    let colored = text_map(scene(&problem, &strategy), TextStyle { color: true }).expect("a map");
    assert!(colored.contains("\u{1b}[1;36mS\u{1b}[0m"), "{colored}");
}
