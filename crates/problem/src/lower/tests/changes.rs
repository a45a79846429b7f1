//! Maps that are changed once they are read, against what the words of the language page say, cell by cell.

use super::interpreter::labelled;
use super::messages;
use crate::lower::grid::{Occupancy, Raster};
use crate::{Lowered, Map, Overrides, Place, Rational, Value, read};
use hyperplan_syntax::SourceMap;

type Files<'a> = &'a [(&'a str, &'a [u8])];

fn lowered(text: &str, files: Files<'_>) -> (Lowered, SourceMap) {
    let mut sources = SourceMap::new();
    let load = |path: &str| {
        let found = files.iter().find(|(name, _)| *name == path);
        found.map(|(_, bytes)| bytes.to_vec()).ok_or_else(|| "no such file".to_owned())
    };
    let lowered = read(&mut sources, "test.hp", text, &load, &Overrides::none());
    (lowered, sources)
}

/// The map of the only system, of a text without errors and warnings.
fn map(text: &str, files: Files<'_>) -> Map {
    let (lowered, sources) = lowered(text, files);
    assert!(lowered.diagnostics.is_empty(), "{:#?}\n{text}", messages(&lowered, &sources));
    lowered.problem.systems.first().and_then(|system| system.map.clone()).expect("a map")
}

fn said(text: &str, files: Files<'_>) -> Vec<String> {
    let (lowered, sources) = lowered(text, files);
    messages(&lowered, &sources)
}

/// All maps of that size, by which of their cells are obstacles.
fn all(width: u32, height: u32) -> impl Iterator<Item = Raster> {
    (0..1_u32 << (width * height)).map(move |bits| {
        let mut map = Raster::new(width, height);
        for (at, cell) in map.cells.iter_mut().enumerate() {
            *cell = if bits >> at & 1 == 1 { Occupancy::Obstacle } else { Occupancy::Free };
        }
        map
    })
}

fn is_obstacle(map: &Raster, x: u32, y: u32) -> bool {
    map.cells[map.index((x, y))] == Occupancy::Obstacle
}

#[test]
fn obstacles_grow_by_the_distance_of_centres() {
    for before in all(4, 3).chain(all(5, 2)).chain(all(1, 6)).chain(all(6, 1)) {
        for limit in [0, 1, 2, 3, 4, 5, 8, 9, 10, 25, 81, 1 << 40] {
            let mut map = before.clone();
            map.inflate(limit);
            for (x, y) in (0..map.width).flat_map(|x| (0..map.height).map(move |y| (x, y))) {
                let near = (0..map.width).any(|a| {
                    (0..map.height).any(|b| {
                        let square = u64::from(x.abs_diff(a)).pow(2) + u64::from(y.abs_diff(b)).pow(2);
                        is_obstacle(&before, a, b) && square <= limit
                    })
                });
                assert_eq!(is_obstacle(&map, x, y), near, "({x}, {y}) with {limit} of {before:?}");
            }
        }
    }
}

/// A cell is as far from obstacles as they have to grow to cover it.
#[test]
fn distances_are_those_by_which_obstacles_grow() {
    for map in all(4, 3).chain(all(5, 2)).chain(all(1, 6)).chain(all(6, 1)) {
        for most in [1, 2, 3, 7, 100] {
            let by_distance = map.by_clearance(most);
            assert_eq!(by_distance.len(), most as usize);
            let (mut known, mut before) = (0, 0);
            for (distance, cells) in (0_u64..).zip(&by_distance) {
                let mut grown = map.clone();
                grown.inflate(distance * distance);
                assert!(cells.iter().all(|&(x, y)| is_obstacle(&grown, x, y)), "{distance} of {map:?}");
                let covered = grown.cells.len() - grown.free();
                known += cells.len();
                assert_eq!((known, cells.len()), (covered, covered - before), "{distance} of {map:?}");
                before = covered;
            }
        }
    }
}

#[test]
fn a_larger_cell_is_free_if_all_its_parts_are() {
    for before in all(4, 3).chain(all(5, 2)) {
        for by in 1..=4 {
            let mut map = before.clone();
            map.scale(by);
            assert_eq!((map.width, map.height), (before.width.div_ceil(by), before.height.div_ceil(by)));
            for (x, y) in (0..map.width).flat_map(|x| (0..map.height).map(move |y| (x, y))) {
                let part = |a: u32, b: u32| a / by == x && b / by == y && is_obstacle(&before, a, b);
                let covered = (0..before.width).any(|a| (0..before.height).any(|b| part(a, b)));
                assert_eq!(is_obstacle(&map, x, y), covered, "({x}, {y}) by {by} of {before:?}");
            }
        }
    }
}

const ROWS: &str =
    r###"grid { "..W.G" "S.#.." "....." "#..W." "##..." legend 'W' = water; label home = x == 0;"###;

#[test]
fn a_part_is_cut_out_last() {
    // Rows from the bottom: "##...", "#..W.", ".....", "S.#..", "..W.G".
    let cut = map(&format!("system W = {ROWS} crop 0..4, 2..4; }}"), &[]);
    assert_eq!((cut.width, cut.height, cut.obstacles), (5, 3, vec![(2, 1)]));
    // Whatever their order: scaled by two, the map is 3 x 3, and then a row is cut off.
    let texts = ["scale 2; crop 0..2, 1..2;", "crop 0..2, 1..2; scale 2;"];
    let [first, second] = texts.map(|items| map(&format!("system W = {ROWS} {items} }}"), &[]));
    assert_eq!(first, second);
    assert_eq!((first.width, first.height, first.obstacles), (3, 2, vec![(1, 0)]));
}

#[test]
fn labels_go_with_their_cells() {
    let (lowered, _) = lowered(&format!("system W = {ROWS} scale 2; }}"), &[]);
    let system = lowered.problem.systems.first().expect("a system");
    let cells = |name: &str| {
        let number = |value: Value| if let Value::Int(n) = value { n } else { panic!("{value:?}") };
        let states = labelled(system, name).into_iter().map(|s| (number(s[0]), number(s[1])));
        states.collect::<Vec<_>>()
    };
    assert_eq!((cells("goal"), cells("water")), (vec![(2, 2)], vec![(1, 0), (1, 2)]));
    assert_eq!(cells("start"), [(0, 1)]);
    assert_eq!(cells("home").len(), 3);
}

#[test]
fn what_a_change_loses_is_said() {
    let lost = |items: &str| said(&format!("system W = {ROWS} {items} }}"), &[]);
    assert_eq!(
        lost("crop 0..3, 0..4;"),
        ["test.hp:1:100 label-lost: after `crop` no free cell of `goal` is left"]
    );
    assert_eq!(lost("inflate 9;"), ["test.hp:1:100 bad-map: after `inflate` the map has no free cell"]);
    for (items, code) in [
        ("crop 0..5, 0..4;", "bad-map: the map has the columns 0..4, not 0..5"),
        ("crop 0..4, 3..2;", "bad-map: the map has the rows 0..4, not 3..2"),
        ("crop -1..4, 0..2;", "bad-map: the map has the columns 0..4, not -1..4"),
        ("scale 0;", "bad-map: a map of 5 x 5 cells is not scaled by 0"),
        ("scale 6;", "bad-map: a map of 5 x 5 cells is not scaled by 6"),
        ("inflate -1;", "bad-map: obstacles do not grow by -1"),
        ("inflate 1 m;", "bad-map: this map does not say how large its cells are"),
        ("inflate K;", "unknown-name: no constant `K`"),
        ("clearance gap 0;", "bad-map: distances are counted up to 1 to 100 cells, not 0"),
        ("clearance gap 101;", "bad-map: distances are counted up to 1 to 100 cells, not 101"),
        ("clearance goal 2;", "duplicate-name: the label `goal` exists already"),
        ("clearance a 2; clearance b 2;", "repeated-item: `clearance` was said already"),
        ("unknown free;", "misplaced-item: only maps of ROS have cells that are unknown"),
        ("scale 1; scale 2;", "repeated-item: `scale` was said already"),
        ("scenario \"none.scen\" 1;", "cannot-read: cannot read `none.scen`: no such file"),
    ] {
        let found = lost(items);
        assert!(found.len() == 1 && found[0].ends_with(code), "{items}: {found:?}");
    }
    let plain = said("system S { state x: 0..1; scale 2; }", &[]);
    assert_eq!(plain, ["test.hp:1:27 misplaced-item: `scale` belongs to maps"]);
}

const MOVING_AI: &[u8] = b"type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n";

#[test]
fn scenarios_count_rows_from_the_top() {
    let scen =
        b"version 1\n0\tmaps/A.map\t4\t3\t0\t0\t3\t2\t4.24264068\n\n0\ta.map\t4\t3\t1\t2\t1\t0\t2.41\n";
    let files: Files<'_> = &[("a.map", MOVING_AI), ("a.scen", scen)];
    for (number, start, goal) in [("1", (0, 2), (3, 0)), ("SECOND", (1, 0), (1, 2))] {
        let text =
            format!("const SECOND = 2; system W = grid(\"a.map\") {{ scenario \"a.scen\" {number}; }}");
        let (lowered, sources) = lowered(&text, files);
        assert!(lowered.diagnostics.is_empty(), "{:#?}", messages(&lowered, &sources));
        let system = lowered.problem.systems.first().expect("a system");
        let cell = |(x, y): (i64, i64)| vec![vec![Value::Int(x), Value::Int(y)]];
        assert_eq!(labelled(system, "start"), cell(start));
        assert_eq!(labelled(system, "goal"), cell(goal));
    }
}

#[test]
fn scenarios_for_other_maps_are_told() {
    let scen = b"0\ta b.map\t4\t3\t0\t0\t3\t2\t4.24264068\n";
    let files: Files<'_> = &[("a.map", MOVING_AI), ("a.scen", scen)];
    let found = said("system W = grid(\"a.map\") { scenario \"a.scen\" 1; }", files);
    assert_eq!(found, ["test.hp:1:28 other-map: the scenario is for `a b.map`, and the map is `a.map`"]);
    let rows = r#"system W = grid { "...." ".##." "...." } { scenario "a.scen" 1; }"#;
    assert_eq!(said(rows, files), [""; 0]);
}

#[test]
fn mistakes_in_scenarios_are_shown_there() {
    let with = |line: &str, item: &str| {
        let scen = format!("version 1\n{line}\n");
        said(
            &format!("system W = grid(\"a.map\") {{ {item} }}"),
            &[("a.map", MOVING_AI), ("a.scen", scen.as_bytes())],
        )
    };
    let good = "0\ta.map\t4\t3\t0\t0\t3\t2\t4.2";
    for (line, item, message) in [
        (
            good,
            "scenario \"a.scen\" 2;",
            "test.hp:1:46 unknown-scenario: `a.scen` has the scenarios 1 to 1, not 2",
        ),
        (
            good,
            "scenario \"a.scen\" 0;",
            "test.hp:1:46 unknown-scenario: `a.scen` has the scenarios 1 to 1, not 0",
        ),
        ("", "scenario \"a.scen\" 1;", "test.hp:1:46 unknown-scenario: `a.scen` has no scenario"),
        (
            "0 a.map 4 3 0 0 3 2",
            "scenario \"a.scen\" 1;",
            "a.scen:2:1 bad-scenario: a scenario has 9 fields, this line 8",
        ),
        (
            "0 a.map 4 3 0 -1 3 2 4",
            "scenario \"a.scen\" 1;",
            "a.scen:2:1 bad-scenario: the start's y is a number from 0 up, not `-1`",
        ),
        (
            "0 a.map 8 3 0 0 3 2 4",
            "scenario \"a.scen\" 1;",
            "a.scen:2:1 bad-scenario: the scenario is for a map of 8 x 3 cells, `a.map`; this one has 4 x 3",
        ),
        (
            "0 a.map 4 3 0 0 1 1 4",
            "scenario \"a.scen\" 1;",
            "a.scen:2:1 bad-scenario: the goal is an obstacle of this map",
        ),
        (
            "0 a.map 4 3 0 3 1 0 4",
            "scenario \"a.scen\" 1;",
            "a.scen:2:1 bad-scenario: the start is not on the map: its columns are 0..3, its rows 0..2",
        ),
        (
            good,
            "scenario \"a.scen\" 1; crop 1..3, 0..2;",
            "test.hp:1:49 label-lost: after `crop` no free cell of `start` is left",
        ),
        (
            good,
            "scenario \"a.scen\" 1; legend 'W' = goal;",
            "test.hp:1:28 duplicate-name: the map has a `goal` already",
        ),
    ] {
        assert_eq!(with(line, item), [message], "{line} {item}");
    }
}

/// The obstacles of a ROS map of one row.
fn row(yaml: &str, picture: &[u8], items: &str) -> Vec<u32> {
    let files: Files<'_> = &[("m.yaml", yaml.as_bytes()), ("m.png", picture)];
    let map = map(&format!("system W = grid(\"m.yaml\") {{ {items} }}"), files);
    map.obstacles.into_iter().map(|(x, _)| x).collect()
}

fn png(color: png::ColorType, width: u32, height: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(data)).expect("a picture");
    bytes
}

#[test]
fn modes_of_ros() {
    use png::ColorType::{Grayscale, GrayscaleAlpha};
    let yaml = |rest: &str| format!("image: m.png\nfree_thresh: 0.196\noccupied_thresh: 0.65\n{rest}");
    // White, nearly free, between, nearly occupied, black.
    let gray = png(Grayscale, 5, 1, &[255, 206, 150, 89, 0]);
    assert_eq!(row(&yaml(""), &gray, ""), [2, 3, 4]);
    assert_eq!(row(&yaml(""), &gray, "unknown free;"), [3, 4]);
    assert_eq!(row(&yaml("negate: 1"), &gray, "unknown free;"), [0, 1]);
    // By the thresholds as well; a percentage that is rounded to none is free, and what is rounded to all is occupied.
    let near = png(Grayscale, 5, 1, &[255, 205, 203, 90, 0]);
    let scale = yaml("mode: scale").replace("0.65", "0.648");
    assert_eq!(row(&scale, &near, ""), [2, 3, 4]);
    assert_eq!(row(&scale, &near, "unknown free;"), [3, 4]);
    assert_eq!(row(&yaml("mode: scale"), &near, "unknown free;"), [4]);
    // What something shines through is unknown to `scale`; to `trinary` it is darker.
    let alpha = png(GrayscaleAlpha, 3, 1, &[255, 255, 255, 254, 0, 255]);
    assert_eq!(row(&yaml("mode: scale"), &alpha, ""), [1, 2]);
    assert_eq!(row(&yaml("mode: scale"), &alpha, "unknown free;"), [2]);
    assert_eq!(row(&yaml("mode: trinary"), &alpha, ""), [2]);
    // Shades are percentages, whatever `negate` says.
    let raw = png(Grayscale, 6, 1, &[0, 20, 21, 65, 100, 101]);
    assert_eq!(row(&yaml("mode: raw"), &raw, ""), [2, 3, 4, 5]);
    assert_eq!(row(&yaml("mode: raw\nnegate: 1"), &raw, "unknown free;"), [3, 4]);
}

#[test]
fn obstacles_grow_by_metres() {
    let mut cells = [255; 15];
    cells[7] = 0;
    let picture = png(png::ColorType::Grayscale, 15, 1, &cells);
    // 0.3 m are six cells exactly, however the resolution was rounded.
    for resolution in ["0.05", "0.05000000074505806", "5e-2"] {
        let yaml = format!("image: m.png\nresolution: {resolution}\norigin: [0, 0, 0]");
        assert_eq!(row(&yaml, &picture, "inflate 0.3 m;"), (1..=13).collect::<Vec<_>>(), "{resolution}");
        assert_eq!(row(&yaml, &picture, "inflate 0.2999 m;"), (2..=12).collect::<Vec<_>>());
        assert_eq!(row(&yaml, &picture, "inflate 2.5;"), (5..=9).collect::<Vec<_>>());
        assert_eq!(row(&yaml, &picture, "inflate 0 m;"), [7]);
    }
}

#[test]
fn places_stay_where_they_are() {
    let picture = png(png::ColorType::Grayscale, 6, 4, &[255; 24]);
    let yaml = b"image: m.png\nresolution: 0.5\norigin: [-1, 2, 0.3]";
    let place = |items: &str| {
        let files: Files<'_> = &[("m.yaml", yaml), ("m.png", &picture)];
        map(&format!("system W = grid(\"m.yaml\") {{ {items} }}"), files).place.expect("it is said")
    };
    let whole = place("");
    assert_eq!(whole, Place { resolution: Rational::new(1, 2), origin: (-1.0, 2.0), yaw: 0.3 });
    let (sin, cos) = 0.3_f64.sin_cos();
    let (x, y) = whole.centre((1, 2));
    assert!((x - (-1.0 + 0.75 * cos - 1.25 * sin)).abs() < 1e-6);
    assert!((y - (2.0 + 0.75 * sin + 1.25 * cos)).abs() < 1e-6);
    let (cut, scaled) = (place("crop 2..5, 1..3;"), place("scale 2;"));
    let near = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).abs() < 1e-6 && (b - d).abs() < 1e-6;
    assert!(near(cut.centre((1, 2)), whole.centre((3, 3))));
    let ((a, b), (c, d)) = (whole.centre((2, 0)), whole.centre((3, 1)));
    assert!(near(scaled.centre((1, 0)), ((a + c) / 2.0, (b + d) / 2.0)));
}

#[test]
fn colours_are_labels() {
    let (w, k, r, b) = ([255, 255, 255], [0, 0, 0], [200, 0, 0], [0, 0, 255]);
    let picture = png(png::ColorType::Rgb, 3, 2, &[w, r, b, b, k, w].concat());
    let files: Files<'_> = &[("m.png", &picture)];
    let text = "system W = grid(\"m.png\") { legend '#c80000' = fire; legend '#0000FF' = water; legend '#00ff00' = grass; }";
    let (lowered, sources) = lowered(text, files);
    assert!(lowered.diagnostics.is_empty(), "{:#?}", messages(&lowered, &sources));
    let system = lowered.problem.systems.first().expect("a system");
    let cells = |cells: &[(i64, i64)]| -> Vec<Vec<Value>> {
        cells.iter().map(|&(x, y)| vec![Value::Int(x), Value::Int(y)]).collect()
    };
    assert_eq!(labelled(system, "water"), cells(&[(0, 0), (2, 1)]));
    assert_eq!(labelled(system, "fire"), cells(&[(1, 1)]));
    assert_eq!(labelled(system, "grass"), cells(&[]));
    assert_eq!(system.map.as_ref().expect("a map").obstacles, [(1, 0)]);
    // White and black may mean something else.
    let text =
        "system W = grid(\"m.png\") { legend '#c80000' = #; legend '#0000ff' = #; legend '#ffffff' = snow; }";
    assert_eq!(map(text, files).obstacles, [(0, 0), (1, 0), (1, 1), (2, 1)]);
    for (items, message) in [
        (
            "legend '#c80000' = fire;",
            "unknown-color: `m.png` has the colour #0000ff at x = 0, y = 0, which has no meaning",
        ),
        ("legend 'W' = a;", "bad-legend: the cells of a picture are colours, no letters"),
        ("legend '#0000ff' = a; legend '#0000FF' = b;", "duplicate-name: a second legend for '#0000FF'"),
    ] {
        let said = said(&format!("system W = grid(\"m.png\") {{ {items} }}"), files);
        assert!(said.first().is_some_and(|first| first.ends_with(message)), "{items}: {said:?}");
    }
    let rows = said("system W = grid { \".\" legend '#0000ff' = a; }", &[]);
    assert!(rows.len() == 1 && rows[0].contains("bad-legend"), "{rows:?}");
}

/// A picture that promises more than it has takes no room, and one that is too large is refused before it is read.
#[test]
fn pictures_do_not_keep_what_they_promise() {
    let mut large = Vec::new();
    // A header of more than a thousand million pixels, and a few bytes.
    let header = png::Encoder::new(&mut large, 40_000, 40_000).write_header();
    header.and_then(|mut writer| writer.write_chunk(png::chunk::IDAT, &[0; 9])).expect("it is written");
    let text = "system W = grid(\"m.png\");";
    let found = said(text, &[("m.png", &large)]);
    assert_eq!(found, ["test.hp:1:17 bad-map: `m.png`: the picture has more than 33554432 pixels"]);
    let plain = b"P5 40000 40000 255\n";
    let found = said("system W = grid(\"m.yaml\");", &[("m.yaml", b"image: m.pgm"), ("m.pgm", plain)]);
    assert_eq!(found, ["m.yaml:1:8 bad-map: `m.pgm`: the picture has more than 33554432 pixels"]);
    for cut in 0..large.len() {
        assert!(!said(text, &[("m.png", &large[..cut])]).is_empty());
    }
}

#[test]
fn maps_that_are_too_large_can_be_cut() {
    let text = format!("{}\n", ".".repeat(2100)).repeat(2100);
    let files: Files<'_> = &[("m.txt", text.as_bytes())];
    let found = said("system W = grid(\"m.txt\");", files);
    assert_eq!(found, ["m.txt:1:1 bad-map: the map has 2100 x 2100 cells, more than 4000000"]);
    let cut = map("system W = grid(\"m.txt\") { crop 100..199, 0..9; }", files);
    assert_eq!((cut.width, cut.height), (100, 10));
    let scaled = map("system W = grid(\"m.txt\") { scale 10; }", files);
    assert_eq!((scaled.width, scaled.height), (210, 210));
}

#[test]
fn what_nobody_has_seen_is_known() {
    // Free, unknown, occupied, free, unknown, unknown, occupied, unknown.
    let gray = png(png::ColorType::Grayscale, 8, 1, &[255, 150, 0, 255, 150, 150, 0, 150]);
    let unknown = |items: &str| {
        let files: Files<'_> = &[("m.yaml", b"image: m.png"), ("m.png", &gray)];
        let map = map(&format!("system W = grid(\"m.yaml\") {{ {items} }}"), files);
        map.unknown.into_iter().map(|(x, _)| x).collect::<Vec<u32>>()
    };
    assert_eq!(unknown(""), [1, 4, 5, 7]);
    assert_eq!(unknown("unknown free;"), [1, 4, 5, 7], "whatever it is taken for");
    assert_eq!(unknown("unknown free; scale 2;"), [0, 2], "where there is an obstacle, that is known");
    assert_eq!(unknown("unknown free; crop 4..7, 0..0;"), [0, 1, 3]);
}
