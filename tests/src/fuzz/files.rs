//! The files that problems name, and strategies.

use super::problem::{Files, lowered};
use hyperplan_problem::answer::plans::{self, PlanFormat, meant};
use hyperplan_problem::answer::{StrategyFile, to_strategy, to_witness};
use hyperplan_problem::{Lowered, Map, Problem, Type};
use hyperplan_verify::{Budget, check};
use std::sync::OnceLock;

/// Pieces of maps.
pub(super) const MAP_PIECES: &[&str] = &[
    "\n",
    "\r\n",
    "\r",
    " ",
    "\t",
    "\0",
    "é",
    "\u{feff}",
    ".",
    "#",
    "@",
    "S",
    "G",
    "W",
    "M",
    "T",
    "O",
    "x",
    "type octile\n",
    "height 2\n",
    "width 3\n",
    "width ",
    "height ",
    "map\n",
    "map",
    "0",
    "99999999999999999999",
    "-1",
    "....\n",
];

/// Pieces of the descriptions of ROS maps.
pub(super) const ROS_PIECES: &[&str] = &[
    "\n",
    "\r\n",
    ":",
    ": ",
    " #",
    "\"",
    "'",
    "/",
    "../",
    "image: ",
    "image: room.pgm\n",
    "negate: 1\n",
    "negate: ",
    "mode: trinary\n",
    "mode: scale\n",
    "occupied_thresh: ",
    "free_thresh: ",
    "nan",
    "inf",
    "-1",
    "1e400",
    "0.5",
    "mode: raw\n",
    "resolution: 0.05\n",
    "resolution: ",
    "origin: ",
    "origin: [0, 0, 0]\n",
    "---\n",
    "é",
    "\0",
];

/// Pieces of pictures.
pub(super) const PGM_PIECES: &[&str] = &[
    "P2",
    "P5",
    "P6",
    "\n",
    " ",
    "# c\n",
    "#",
    "0",
    "1",
    "255",
    "256",
    "65535",
    "65536",
    "4294967296",
    "2000000",
    "\0",
    "\u{7f}",
    "3 2\n",
];

/// Pieces of lists of scenarios.
pub(super) const SCEN_PIECES: &[&str] = &[
    "\n",
    "\r\n",
    "\t",
    " ",
    "version 1\n",
    "0",
    "1",
    "2",
    "-1",
    "1.5",
    "m.map",
    "4294967296",
    "99999999999999999999",
    "\0",
    "é",
];

/// Pieces of graphs and strategies.
pub(super) const JSON_PIECES: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    "[[",
    "]]",
    "\"",
    ":",
    ",",
    "\\",
    "\\u0000",
    "\\ud800",
    "\n",
    " ",
    "\0",
    "é",
    "null",
    "true",
    "false",
    "0",
    "1",
    "-",
    "17",
    "1.5",
    "1e999",
    "99999999999999999999",
    "\"1/3\"",
    "\"states\": []",
    "\"n1\"",
    "\"actions\"",
    "\"transitions\"",
    "\"from\"",
    "\"action\"",
    "\"to\"",
    "\"length\": 3",
    "\"initial\"",
    "\"labels\"",
    "\"none\"",
    "\"path\"",
    "\"witness\"",
    "\"p\"",
    "\"system\": \"World\",",
    "\"node\": \"n2\"",
    "\"crash\": true",
    "\"nodes\"",
    "\"links\"",
    "\"edges\"",
    "\"id\": 1",
    "\"source\": \"a\"",
    "\"target\": 7",
    "\"directed\": true",
    "\"pos\": [0, 1]",
    "\"startid\": 0",
    "\"Point\"",
    "\"coordinates\": [0, 1]",
    "\"dock\": true",
    "<node id=\"a\"/>",
    "<edge source=\"a\" target=\"b\"/>",
    "</graph>",
    "<data key=\"d0\">1</data>",
    "&amp;",
    "{}",
    "[]",
    "time,path,action,",
    "0,p,",
    ",x,y",
    "\"type\": \"FeatureCollection\"",
    "\"features\": []",
    "\"properties\"",
    "; path p\n",
    "(up)\n",
    "0: (up p)\n",
];

/// A problem on a system that is read from a file, and what it means.
fn on_file(system: &str, files: Files<'_>) -> Lowered {
    let objective = "objective o { exists p, q. F[0,2] state[p] != state[q] }";
    lowered(&format!("system World = {system}\n{objective}"), files)
}

/// What must hold of every map.
fn sound(map: &Map) {
    assert!(map.obstacles.is_sorted_by(|a, b| a < b), "obstacles are sorted, each listed once");
    assert!(map.obstacles.iter().all(|&(x, y)| x < map.width && y < map.height), "obstacles are on the map");
    assert!(map.obstacles.len() < map.width as usize * map.height as usize, "some cell is free");
}

fn map_of(lowered: &Lowered) -> Option<&Map> {
    if lowered.has_errors() {
        return None;
    }
    let map =
        lowered.problem.systems[hyperplan_problem::SystemId(0)].map.as_ref().expect("the system is a map");
    sound(map);
    Some(map)
}

/// A map's text. No obstacle is lost, and none is made up.
pub(super) fn map(data: &[u8]) {
    let items = "legend 'W' = water; legend 'x' = #; obstacle crash; edge stay; absorb !water;";
    let lowered = on_file(&format!("grid(\"m.txt\") {{ {items} }}"), &|_| Ok(data.to_vec()));
    let Some(map) = map_of(&lowered) else { return };
    map_of(&on_file(
        "grid(\"m.txt\") { legend 'W' = water; legend 'x' = #; inflate 1; scale 2; crop 0..0, 0..0; }",
        &|_| Ok(data.to_vec()),
    ));
    let text = String::from_utf8_lossy(data);
    // A header in any spelling ends with a line `map`.
    let words = |line: &str| line.split_whitespace().next().unwrap_or_default().to_lowercase();
    let is_note = |line: &str| line.trim_start().starts_with("# ") || line.trim().is_empty();
    let first = text.trim_start_matches('\u{feff}').lines().find(|line| !is_note(line)).map(words);
    let is_benchmark = first.is_some_and(|word| ["type", "height", "width"].contains(&word.as_str()));
    let rows: Vec<&str> = match is_benchmark {
        true => text.lines().skip_while(|line| words(line) != "map").skip(1).collect(),
        false => text.lines().collect(),
    };
    let (letters, rows) = (if is_benchmark { "x@OT" } else { "x#@" }, rows.concat());
    let count = rows.chars().filter(|letter| letters.contains(*letter)).count();
    assert_eq!(count, map.obstacles.len(), "the number of obstacles");
}

/// The description of a ROS map, whose picture is a good one.
pub(super) fn ros(data: &[u8]) {
    let picture = include_bytes!("../../corpus/pgm/raw");
    let files = |path: &str| {
        let is_yaml = path == "m.yaml";
        Ok(if is_yaml { data.to_vec() } else { picture.to_vec() })
    };
    map_of(&on_file("grid(\"m.yaml\") { moves up_left, down, stay; }", &files));
    map_of(&on_file("grid(\"m.yaml\") { unknown free; inflate 0.05 m; scale 2; }", &files));
}

/// The picture of a ROS map.
pub(super) fn pgm(data: &[u8]) {
    let yaml = b"image: m.pgm\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    let files = |path: &str| {
        let is_yaml = path == "m.yaml";
        Ok(if is_yaml { yaml.to_vec() } else { data.to_vec() })
    };
    map_of(&on_file("grid(\"m.yaml\");", &files));
}

/// A picture in PNG: a map by its colours, and one of ROS.
pub(super) fn png(data: &[u8]) {
    let yaml = |mode: &str| format!("image: m.png\nmode: {mode}\nresolution: 0.1\norigin: [1, -2, 0.5]\n");
    for mode in ["trinary", "scale", "raw"] {
        let files = |path: &str| {
            let is_yaml = path == "m.yaml";
            Ok(if is_yaml { yaml(mode).into_bytes() } else { data.to_vec() })
        };
        map_of(&on_file("grid(\"m.yaml\") { unknown free; inflate 0.1 m; scale 2; }", &files));
    }
    let items = "legend '#0000ff' = water; legend '#00a000' = start; legend '#ff0000' = #;";
    map_of(&on_file(&format!("grid(\"m.png\") {{ {items} }}"), &|_| Ok(data.to_vec())));
}

/// A list of scenarios, of which the first two are tried.
pub(super) fn scen(data: &[u8]) {
    let files = |path: &str| {
        let is_map = path == "m.map";
        Ok(if is_map { b"type octile\nheight 2\nwidth 3\nmap\n..T\n...\n".to_vec() } else { data.to_vec() })
    };
    for number in 1..=2 {
        let items = format!("scenario \"a.scen\" {number}; inflate 1/2; crop 0..2, 0..1;");
        let lowered = on_file(&format!("grid(\"m.map\") {{ {items} }}"), &files);
        if map_of(&lowered).is_some() {
            let system = &lowered.problem.systems[hyperplan_problem::SystemId(0)];
            assert!(system.label("start").is_some() && system.label("goal").is_some());
        }
    }
}

/// A graph.
pub(super) fn graph(data: &[u8]) {
    let lowered = on_file("graph(\"g.json\");", &|_| Ok(data.to_vec()));
    if lowered.has_errors() {
        return;
    }
    let system = &lowered.problem.systems[hyperplan_problem::SystemId(0)];
    assert!(system.edges.is_some() && system.vars.len() == 1 && !system.actions.is_empty());
    let nodes = match &system.vars[hyperplan_problem::VarId(0)].ty {
        Type::Enum(nodes) => nodes.len(),
        other => panic!("{other:?}"),
    };
    assert!(system.coordinates.as_ref().is_none_or(|places| places.len() == nodes));
}

/// A strategy: what fits the problem survives being written and read again, and the checker can judge it.
pub(super) fn strategy(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let Ok(files) = plans::read(text) else { return };
    let problem = problem();
    for objective in &problem.objectives {
        for witness in files.iter().filter_map(|file| file.witness.as_deref()) {
            let witness = meant(problem, objective, witness);
            let Ok(strategy) = to_strategy(problem, objective, &witness) else { continue };
            let written = to_witness(problem, objective, &strategy);
            // A path that has actions and no states yet is no table.
            let whole = strategy.traces.iter().all(|trace| trace.states.len() == trace.actions.len() + 1);
            for format in [PlanFormat::Csv, PlanFormat::Geojson].into_iter().filter(|_| whole) {
                let text = format.write(&objective.name, &written).expect("it can be written");
                let again = plans::read(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
                let again = again[0].witness.as_deref().expect("it was written");
                assert_eq!(to_strategy(problem, objective, again), Ok(strategy.clone()), "{text}");
            }
            let _ = PlanFormat::Pddl.write(&objective.name, &written).map(|text| plans::read(&text));
            let json = serde_json::json!({ "witness": written }).to_string();
            let again = StrategyFile::read_all(&json).expect("what was written can be read");
            let again = again[0].witness.as_deref().expect("it was written");
            assert_eq!(to_strategy(problem, objective, again), Ok(strategy.clone()));
            // Any verdict will do, and so will a refusal.
            let _ = check(problem, objective, &strategy, &Budget::default());
        }
    }
}

/// A problem with variables of all finite types.
fn problem() -> &'static Problem {
    static PROBLEM: OnceLock<Problem> = OnceLock::new();
    PROBLEM.get_or_init(|| {
        let graph = include_bytes!("../../corpus/graph/roadmap");
        let text = include_str!("../../corpus/strategies.hp");
        lowered(text, &|_| Ok(graph.to_vec())).problem
    })
}
