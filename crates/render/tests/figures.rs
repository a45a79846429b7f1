//! What holds of every picture, of whatever size: it is well-formed, not too long, and what matters in it can be seen.

mod common;

use common::{problem, scene, square, strategy};
use hyperplan_render::{Error, Film, Scene, pdf, png, svg};
use roxmltree::{Document, Node};

/// All elements of a picture with such a name.
fn all<'a>(document: &'a Document<'_>, name: &str) -> Vec<Node<'a, 'a>> {
    document.descendants().filter(|node| node.has_tag_name(name)).collect()
}

fn with_class<'a>(document: &'a Document<'_>, class: &str) -> Vec<Node<'a, 'a>> {
    document.descendants().filter(|node| node.attribute("class") == Some(class)).collect()
}

fn value(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{name} of {node:?}"))
}

fn texts(document: &Document<'_>) -> Vec<String> {
    all(document, "text").iter().map(|node| node.text().unwrap_or_default().trim().to_owned()).collect()
}

#[test]
fn what_matters_can_be_seen_at_all_sizes() {
    for (size, obstacles) in [(3, 200), (10, 200), (40, 200), (64, 200), (200, 300), (512, 300), (512, 0)] {
        let (problem, strategy) = square(size, obstacles);
        let drawn = svg(scene(&problem, &strategy)).expect("a map");
        assert_eq!(drawn, svg(scene(&problem, &strategy)).expect("a map"), "the same every time");
        assert!(drawn.len() < 200_000, "{size}: {} bytes", drawn.len());
        let document = Document::parse(&drawn).expect("it is XML");
        let width = value(document.root_element(), "width");
        assert!(width <= 1000.0, "{size}: {width}");
        // Start and end, the line, and the letters along it.
        let ring = all(&document, "circle").into_iter().find(|c| c.attribute("fill") == Some("#ffffff"));
        assert!(value(ring.expect("a start"), "r") >= 4.0, "{size}");
        let path = with_class(&document, "path")[0];
        let lines: Vec<f64> =
            path.children().filter_map(|l| l.attribute("stroke-width")?.parse().ok()).collect();
        assert!(lines[1] >= 2.0, "{size}: {lines:?}");
        for text in document.descendants().filter(|node| node.has_attribute("font-size")) {
            assert!(value(text, "font-size") >= 8.0, "{size}: {text:?}");
        }
        // Letters of start and goal stand in their cells or at pins, the number of the last step at the end.
        let texts = texts(&document);
        let steps = 2 * (size - 1);
        for words in ["S", "G", &steps.to_string(), &format!("p: {steps} steps"), "S start", "G goal"] {
            assert!(texts.iter().any(|text| text == words), "{size}: {words} in {texts:?}");
        }
        assert_eq!(with_class(&document, "lattice").len(), usize::from(size <= 64), "{size}");
        assert!(texts.len() < 400, "{size}: {} words", texts.len());
    }
}

const LABELS: &str = r#"
system W = grid { "..........G" "S.........." } {
  label a = x == 1; label b = x == 2; label c = x == 3; label d = x == 4; label e = x == 5; label f = x == 6;
  label g = x == 7; label h = x == 8; label i = x >= 8;
}
objective o { exists p. start[p] }
"#;

#[test]
fn labels_are_told_apart_without_colours() {
    let problem = problem(LABELS);
    let drawn = svg(Scene { problem: &problem, objective: None, traces: &[], note: "" }).expect("a map");
    let document = Document::parse(&drawn).expect("it is XML");
    let hatchings = all(&document, "pattern");
    let of = |node: &Node<'_, '_>| {
        let lines = node.children().filter_map(|child| child.attribute("d")).collect::<String>();
        let ground = node.children().filter_map(|child| child.attribute("fill")).collect::<String>();
        (lines, ground)
    };
    let looks: std::collections::BTreeSet<_> = hatchings.iter().map(of).collect();
    assert_eq!((hatchings.len(), looks.len()), (12, 12), "eleven labels and the unknown");
    let first: std::collections::BTreeSet<_> = hatchings[1..9].iter().map(|node| of(node).0).collect();
    assert_eq!(first.len(), 8, "the first eight differ without colours");
    for label in ["start", "goal", "a", "i"] {
        assert_eq!(with_class(&document, label).len(), 1, "{label}");
    }
}

const BACK: &str = r#"
system W = grid { "S.G" } { edge stay; }
objective o { exists p, q. start[p] & start[q] & F[0,9] goal[p] }
"#;

const BACK_WITNESS: &str = r#"{"witness": [
  {"path": "p", "actions": ["right", "left", "right", "right"],
   "states": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 2, "y": 0}]},
  {"path": "q", "actions": ["right", "up", "up", "right"],
   "states": [{"x": 0, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 0}, {"x": 1, "y": 0}, {"x": 2, "y": 0}]}]}"#;

/// The points of each path's line.
fn points(document: &Document<'_>) -> Vec<Vec<(f64, f64)>> {
    let paths = with_class(document, "path");
    let point = |text: &str| {
        let (x, y) = text.trim_start_matches('M').split_once(',').expect("two numbers");
        (x.parse().expect("a number"), y.parse().expect("a number"))
    };
    let mut lines = Vec::new();
    for path in paths {
        let line = path.descendants().find_map(|node| node.attribute("d")).expect("a line");
        lines.push(line.split(' ').map(point).collect());
    }
    lines
}

#[test]
fn paths_that_share_a_way_have_lanes() {
    let problem = problem(BACK);
    let strategy = strategy(&problem, BACK_WITNESS);
    let drawn = svg(scene(&problem, &strategy)).expect("a map");
    let document = Document::parse(&drawn).expect("it is XML");
    let lines = points(&document);
    // Between the first two cells p goes there, back and there again, q there: three lanes.
    let mut heights: Vec<i64> = Vec::new();
    for line in &lines {
        for two in line.windows(2).filter(|two| two[0].1 == two[1].1 && (two[0].0 - two[1].0).abs() > 30.0) {
            heights.push((two[0].1 * 100.0) as i64);
        }
    }
    heights.sort_unstable();
    heights.dedup();
    assert!(heights.windows(2).all(|two| two[1] - two[0] >= 200), "far enough apart to be seen: {heights:?}");
    assert!(heights.len() >= 3, "{heights:?}");
    let texts = texts(&document);
    assert!(texts.iter().any(|text| text == "0,2"), "when p is at its start: {texts:?}");
    assert!(texts.iter().any(|text| text == "1–3"), "how long q waits: {texts:?}");
}

#[test]
fn pictures_of_other_formats() {
    let (problem, strategy) = square(10, 200);
    let picture = png(scene(&problem, &strategy)).expect("a picture");
    assert!(picture.starts_with(b"\x89PNG"));
    assert!(picture == png(scene(&problem, &strategy)).expect("a picture"), "the same every time");
    let paper = pdf(scene(&problem, &strategy)).expect("a picture");
    assert!(paper.starts_with(b"%PDF"));
    assert!(paper == pdf(scene(&problem, &strategy)).expect("a picture"), "the same every time");
}

/// Letters are drawn with a font that comes along: with another text the picture is another.
#[test]
fn letters_need_no_fonts_of_the_system() {
    let named = |label: &str| {
        let text = format!(
            "system W = grid {{ \"S.G\" }} {{ label {label} = x == 1; }} objective o {{ exists p. start[p] }}"
        );
        let problem = problem(&text);
        png(Scene { problem: &problem, objective: None, traces: &[], note: "" }).expect("a picture")
    };
    assert_ne!(named("maps"), named("mops"));
}

const LAMP: &str = "
system L { state on: bool, level: 0..9; action push, wait; init !on & level == 0;
  on push { on' = !on; level' = (level + 1) % 10; } on wait {} }
objective o { exists p. F[0,3] on[p] }
";

#[test]
fn what_lies_nowhere_has_a_timeline() {
    let problem = problem(LAMP);
    let strategy = strategy(
        &problem,
        r#"{"witness": [{"path": "p", "actions": ["wait", "push", "wait"],
           "states": [{"on": false, "level": 0}, {"on": false, "level": 0}, {"on": true, "level": 1}, {"on": true, "level": 1}]}]}"#,
    );
    let drawn = svg(scene(&problem, &strategy)).expect("a timeline");
    let document = Document::parse(&drawn).expect("it is XML");
    let texts = texts(&document);
    for words in ["action", "on", "level", "push", "true", "false", "p: 3 steps"] {
        assert!(texts.iter().any(|text| text == words), "{words} in {texts:?}");
    }
}

/// Graphs of all kinds have places of their own, the same every time.
#[test]
fn graphs_are_laid_out() {
    let mut number = 7_u64;
    for round in 0..60 {
        let nodes = 1 + round % 20;
        let mut next = |below: u64| {
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (number >> 33) % below
        };
        let edges: Vec<String> =
            (0..next(40)).map(|_| format!("[\"s{}\", \"go\", \"s{}\"]", next(nodes), next(nodes))).collect();
        let states: Vec<String> = (0..nodes).map(|node| format!("\"s{node}\"")).collect();
        let graph = format!(
            "{{\"states\": [{}], \"actions\": [\"go\"], \"transitions\": [{}]}}",
            states.join(", "),
            edges.join(", ")
        );
        let files = |_: &str| Ok(graph.clone().into_bytes());
        let text = "system R = graph(\"r.json\") {}\nobjective o { exists p. state[p] == state[p] }";
        let mut sources = hyperplan_syntax::SourceMap::new();
        let overrides = hyperplan_problem::Overrides::none();
        let lowered = hyperplan_problem::read(&mut sources, "test.hp", text, &files, &overrides);
        assert!(!lowered.has_errors(), "{graph}: {:?}", lowered.diagnostics);
        let problem = lowered.problem;
        let draw =
            || svg(Scene { problem: &problem, objective: None, traces: &[], note: "" }).expect("a graph");
        let drawn = draw();
        assert_eq!(drawn, draw(), "the same every time");
        let document = Document::parse(&drawn).expect("it is XML");
        let circles = all(&document, "circle");
        let places: std::collections::BTreeSet<String> = circles
            .iter()
            .map(|c| format!("{} {}", c.attribute("cx").unwrap_or(""), c.attribute("cy").unwrap_or("")))
            .collect();
        assert_eq!((circles.len() as u64, places.len() as u64), (nodes, nodes), "{graph}\n{drawn}");
    }
}

#[test]
fn films_show_each_time() {
    let problem = problem(BACK);
    let strategy = strategy(&problem, BACK_WITNESS);
    let film = Film::of(scene(&problem, &strategy)).expect("it moves");
    let frames: Vec<Vec<u8>> = film.svgs().expect("few").map(|frame| frame.expect("drawn")).collect();
    assert_eq!(frames.len(), 5);
    // Where each robot is.
    let robots = |frame: &[u8]| {
        let text = String::from_utf8(frame.to_vec()).expect("it is text");
        let document = Document::parse(&text).expect("it is XML");
        let robots = with_class(&document, "robot");
        robots
            .iter()
            .map(|robot| robot.parent().expect("a group").attribute("transform").map(str::to_owned))
            .collect::<Vec<_>>()
    };
    let at: Vec<_> = frames.iter().map(|frame| robots(frame)).collect();
    assert!(
        at.iter().all(|robots| robots.len() == 2 && robots[0] != robots[1]),
        "none covers the other: {at:?}"
    );
    assert!(at[1][1] != at[4][1] && at[0][0] != at[1][0], "they move");
    let pngs: Vec<Vec<u8>> = film.pngs().expect("few").map(|frame| frame.expect("drawn")).collect();
    assert!(pngs.len() == 5 && pngs.iter().all(|png| png.starts_with(b"\x89PNG")) && pngs[0] != pngs[1]);
    let animated = film.animated();
    let document = Document::parse(&animated).expect("it is XML");
    assert_eq!(all(&document, "animateTransform").len(), 2);
    for moves in document.descendants().filter(|node| node.has_attribute("keyTimes")) {
        let count = |name: &str| moves.attribute(name).map_or(0, |values| values.split(';').count());
        assert_eq!(count("values"), count("keyTimes"));
        let keys: Vec<f64> =
            moves.attribute("keyTimes").unwrap_or("").split(';').filter_map(|k| k.parse().ok()).collect();
        assert!(
            keys[0] == 0.0 && keys.windows(2).all(|two| two[0] <= two[1]) && keys.iter().all(|k| *k <= 1.0)
        );
    }
    let gif = film.gif().expect("drawn");
    let mut reader = gif::DecodeOptions::new().read_info(gif.as_slice()).expect("a GIF");
    let mut count = 0;
    while reader.read_next_frame().expect("a frame").is_some() {
        count += 1;
    }
    assert_eq!(count, 5);
}

/// What is too large is refused, or takes a bounded amount of time and text.
#[test]
fn hostile_sizes() {
    let text =
        "system S { state x: 0..3999, y: 0..3999; action go; on go {} } objective o { exists p. x[p] == 0 }";
    let problem = problem(text);
    let drawn = svg(Scene { problem: &problem, objective: None, traces: &[], note: "" });
    assert!(matches!(drawn, Err(Error::TooLarge { .. })));
    // A path of many steps to and fro.
    let problem = common::problem(
        "system S { state x: 0..2, y: 0..0; action go; on go { x' = 1 - x % 2; } } objective o { exists p. x[p] == 0 }",
    );
    let states: Vec<String> = (0..100_001).map(|i| format!("{{\"x\": {}, \"y\": 0}}", i % 2)).collect();
    let actions = vec!["\"go\""; 100_000].join(",");
    let witness = format!(
        "{{\"witness\": [{{\"path\": \"p\", \"actions\": [{actions}], \"states\": [{}]}}]}}",
        states.join(",")
    );
    let strategy = common::strategy(&problem, &witness);
    let drawn = svg(scene(&problem, &strategy)).expect("a map");
    assert!(drawn.len() < 10_000_000, "{}", drawn.len());
    let film = Film::of(scene(&problem, &strategy)).expect("it moves");
    assert!(matches!(film.svgs().map(|_| ()), Err(Error::TooManyPictures { .. })));
    assert!(film.animated().len() < 10_000_000);
    let traces = [strategy.traces[0].clone(), strategy.traces[0].clone(), strategy.traces[0].clone()];
    let scene = Scene { traces: &traces, ..scene(&problem, &strategy) };
    assert!(matches!(svg(scene), Err(Error::TooLong { .. })));
}

/// A small picture as a whole; `UPDATE=1` writes it anew.
#[test]
fn a_picture_as_a_whole() {
    let problem = problem(BACK);
    let strategy = strategy(&problem, BACK_WITNESS);
    let drawn = svg(scene(&problem, &strategy)).expect("a map");
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/back.svg");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(file, &drawn).expect("writable");
    }
    assert_eq!(drawn, std::fs::read_to_string(file).expect("it is part of the repository"));
}
