use super::interpreter::{holds, labelled, states, successors};
use super::{codes, lowered_with, messages, ok, ok_with};
use crate::{Overrides, System, Value};

fn int(n: i64) -> Value {
    Value::Int(n)
}

fn grid(text: &str) -> (crate::Problem, System) {
    let problem = ok(text).problem;
    let system = problem.systems.first().expect("a system").clone();
    (problem, system)
}

/// Where a move leads from a cell (with `crash` false where there is such a variable): cells and crashes.
fn go(text: &str, action: &str, x: i64, y: i64) -> Vec<(i64, i64, bool)> {
    let (problem, system) = grid(text);
    let mut state = vec![int(x), int(y)];
    if system.vars.len() == 3 {
        state.push(Value::Bool(false));
    }
    let action = problem.action(action).expect("the action exists");
    let number = |v: Value| if let Value::Int(n) = v { n } else { panic!("{v:?}") };
    successors(&system, &state, action)
        .into_iter()
        .map(|s| (number(s[0]), number(s[1]), s.get(2) == Some(&Value::Bool(true))))
        .collect()
}

const MAP: &str = r#"system W = grid { "..G" ".#." "S.." "#;

#[test]
fn coordinates_count_from_the_bottom_left() {
    let (_, system) = grid(&format!("{MAP} }}"));
    assert_eq!(labelled(&system, "start"), [vec![int(0), int(0)]]);
    assert_eq!(labelled(&system, "goal"), [vec![int(2), int(2)]]);
    let map = system.map.as_ref().expect("a map");
    assert_eq!((map.width, map.height, map.obstacles.as_slice()), (3, 3, &[(1, 1)][..]));
    assert_eq!(map.crash, None);
    let initial = states(&system).into_iter().filter(|s| holds(&system, &system.init, s)).count();
    assert_eq!(initial, 8);
}

#[test]
fn moves_by_default() {
    let text = format!("{MAP} }}");
    assert_eq!(go(&text, "up", 0, 0), [(0, 1, false)]);
    assert_eq!(go(&text, "right", 0, 0), [(1, 0, false)]);
    assert_eq!(go(&text, "down", 0, 2), [(0, 1, false)]);
    assert_eq!(go(&text, "left", 2, 2), [(1, 2, false)]);
    // Obstacle and edge: no transition.
    assert_eq!(go(&text, "right", 0, 1), []);
    assert_eq!(go(&text, "up", 1, 0), []);
    assert_eq!(go(&text, "left", 0, 0), []);
    assert_eq!(go(&text, "down", 2, 0), []);
    assert_eq!(go(&text, "up", 2, 2), []);
    assert_eq!(go(&text, "right", 2, 1), []);
}

#[test]
fn obstacle_and_edge_rules() {
    for (rule, outcome) in
        [("stay", vec![(0, 1, false)]), ("crash", vec![(0, 1, true)]), ("undefined", vec![])]
    {
        let text = format!("{MAP} obstacle {rule}; }}");
        assert_eq!(go(&text, "right", 0, 1), outcome, "{rule}");
        assert_eq!(go(&text, "left", 0, 1), [], "the edge is another rule");
        let text = format!("{MAP} edge {rule}; }}");
        assert_eq!(go(&text, "left", 0, 1), outcome, "{rule}");
        assert_eq!(go(&text, "right", 0, 1), [], "the obstacle is another rule");
        assert_eq!(go(&text, "up", 0, 0), [(0, 1, false)]);
    }
}

#[test]
fn rules_where_obstacles_are_the_majority() {
    let map = r##"system W = grid { "@@." "#.@" "#.@" obstacle crash; edge stay; moves up, right, up_right, stay; }"##;
    assert_eq!(go(map, "up", 1, 0), [(1, 1, false)]);
    assert_eq!(go(map, "up", 1, 1), [(1, 1, true)]);
    assert_eq!(go(map, "up_right", 1, 1), [(2, 2, false)]);
    assert_eq!(go(map, "up_right", 2, 2), [(2, 2, false)]);
    assert_eq!(go(map, "right", 2, 2), [(2, 2, false)]);
    assert_eq!(go(map, "right", 1, 1), [(1, 1, true)]);
    assert_eq!(go(map, "stay", 1, 1), [(1, 1, false)]);
}

#[test]
fn diagonal_moves() {
    let text = format!("{MAP} moves up_left, up_right, down_left, down_right, stay; edge stay; }}");
    assert_eq!(go(&text, "up_right", 1, 0), [(2, 1, false)]);
    assert_eq!(go(&text, "up_left", 1, 0), [(0, 1, false)]);
    assert_eq!(go(&text, "down_right", 1, 2), [(2, 1, false)]);
    assert_eq!(go(&text, "down_left", 1, 2), [(0, 1, false)]);
    assert_eq!(go(&text, "up_right", 0, 0), [], "an obstacle");
    assert_eq!(go(&text, "down_left", 1, 0), [(1, 0, false)], "the edge");
    assert_eq!(go(&text, "stay", 2, 0), [(2, 0, false)]);
}

#[test]
fn crashes_absorb_and_hide_the_labels_of_the_map() {
    let text =
        format!("{MAP} obstacle crash; legend 'w' = water; label home = x == 0 & y == 0; absorb goal; }}");
    let (problem, system) = grid(&text);
    let crashed = [int(0), int(0), Value::Bool(true)];
    for action in &system.actions {
        assert_eq!(
            successors(&system, &crashed, *action).into_iter().collect::<Vec<_>>(),
            [crashed.to_vec()]
        );
    }
    assert_eq!(labelled(&system, "start"), [vec![int(0), int(0), Value::Bool(false)]]);
    assert_eq!(labelled(&system, "home").len(), 2, "the user's labels hold where they say");
    assert_eq!(labelled(&system, "water").len(), 0, "a label of the legend exists without cells too");
    assert!(states(&system).iter().all(|s| !holds(&system, &system.init, s) || s[2] == Value::Bool(false)));
    let goal = [int(2), int(2), Value::Bool(false)];
    let up = problem.action("up").expect("up");
    assert_eq!(successors(&system, &goal, up).len(), 1);
}

#[test]
fn init_is_conjoined() {
    let (_, system) = grid(&format!("{MAP} init y == 1; }}"));
    let initial: Vec<_> = states(&system).into_iter().filter(|s| holds(&system, &system.init, s)).collect();
    assert_eq!(initial, [vec![int(0), int(1)], vec![int(2), int(1)]]);
}

#[test]
fn legends() {
    let (_, system) =
        grid(r#"system W = grid { "wX" "S." legend 'w' = water; legend 'X' = #; legend 'v' = start; }"#);
    assert_eq!(labelled(&system, "water"), [vec![int(0), int(1)]]);
    assert_eq!(labelled(&system, "start"), [vec![int(0), int(0)]]);
    assert_eq!(system.map.expect("a map").obstacles, [(1, 1)]);
}

#[test]
fn cells_by_coordinates() {
    let (_, system) = grid(r#"system W = grid { "..." "..." label at = (x, y) in {(0, 0), (2, 1)}; }"#);
    assert_eq!(labelled(&system, "at"), [vec![int(0), int(0)], vec![int(2), int(1)]]);
}

#[test]
fn labels_of_letters() {
    let duplicate = codes(&format!("{MAP} label goal = x == 0; }}"));
    assert_eq!(duplicate, [("duplicate-name", "goal".to_owned())]);
    let (_, system) = grid(r#"system W = grid { ".." label goal = x == 1; }"#);
    assert!(system.label("start").is_none());
    assert_eq!(labelled(&system, "goal").len(), 1);
}

#[test]
fn mistakes_in_maps() {
    assert_eq!(codes(r#"system W = grid { "..." ".." }"#), [("ragged-map", "\"..\"".to_owned())]);
    assert_eq!(codes(r#"system W = grid { "..?" }"#), [("unknown-letter", "\"..?\"".to_owned())]);
    assert_eq!(codes(r#"system W = grid { "@@" }"#)[0].0, "bad-map");
    assert_eq!(codes(r#"system W = grid { ".." moves up, upp; }"#), [("unknown-move", "upp".to_owned())]);
    assert_eq!(codes(r#"system W = grid { ".." edge bounce; }"#), [("unknown-rule", "bounce".to_owned())]);
    assert_eq!(codes(r#"system W = grid { ".." legend 'S' = a; }"#)[0].0, "reserved-name");
    assert_eq!(codes(r#"system W = grid { ".." edge stay; edge crash; }"#)[0].0, "repeated-item");
    assert_eq!(codes(r#"system W = grid { ".." state y: 0..1; }"#)[0].0, "duplicate-name");
    assert_eq!(codes(r#"system W = grid { ".." action up; }"#)[0].0, "duplicate-name");
    assert_eq!(codes(r#"system W = grid { ".." on jump { x' = 0; } }"#)[0].0, "unknown-action");
    assert_eq!(codes("system W { state x: 0..1; moves up; }")[0].0, "misplaced-item");
    assert_eq!(codes("const x = 1; system W = grid { \"..\" }")[0].0, "duplicate-name");
}

#[test]
fn a_map_with_items_of_its_own() {
    let text = r#"system W = grid { "..G" edge stay;
        state full: bool; action fill; on fill when goal { full' = true; } on left when full { full' = false; } }"#;
    let problem = ok(text).problem;
    let system = problem.systems.first().expect("a system");
    let by = |name: &str, x: i64, full: bool| {
        let state = [int(x), int(0), Value::Bool(full)];
        let action = problem.action(name).expect("declared");
        let next = successors(system, &state, action).into_iter();
        next.map(|s| (s[0], s[2])).collect::<Vec<_>>()
    };
    // A move leaves what is no place as it is; a clause adds an outcome to it.
    assert_eq!(by("right", 1, true), [(int(2), Value::Bool(true))]);
    assert_eq!(by("left", 1, false), [(int(0), Value::Bool(false))]);
    assert_eq!(by("left", 1, true), [(int(0), Value::Bool(true)), (int(1), Value::Bool(false))]);
    assert_eq!(by("fill", 2, false), [(int(2), Value::Bool(true))]);
    assert_eq!(by("fill", 1, false), []);
}

#[test]
fn a_broken_map_does_not_cascade() {
    let text = r#"system W = grid { "..G" ".." label far = x > 1; }
        objective o { exists p. F[0,3] goal[p] & far[p] & x[p] == 0 }"#;
    assert_eq!(codes(text), [("ragged-map", "\"..\"".to_owned())]);
}

const FILE: &str = r#"system W = grid("map.txt") { label at = x == 1; }"#;

#[test]
fn text_files() {
    let problem = ok_with(FILE, &[("map.txt", "..G\r\n.#.\r\nS. \r\n\r\n")]).problem;
    let system = problem.systems.first().expect("a system");
    assert_eq!(labelled(system, "start"), [vec![int(0), int(0)]]);
    assert_eq!(system.map.as_ref().expect("a map").obstacles, [(1, 1)]);
}

fn file_messages(text: &str, files: &[(&str, &str)]) -> Vec<String> {
    let (lowered, sources) = lowered_with(text, files, &Overrides::none());
    messages(&lowered, &sources)
}

#[test]
fn mistakes_in_files_are_shown_there() {
    let ragged = file_messages(FILE, &[("map.txt", "...\n..\n...\n")]);
    assert_eq!(ragged, ["map.txt:2:1 ragged-map: this row has 2 cells, the first one 3"]);
    let unknown = file_messages(FILE, &[("map.txt", "...\n..?\n")]);
    assert_eq!(unknown, ["map.txt:2:3 unknown-letter: the letter '?' has no meaning in a map"]);
    let missing = file_messages(FILE, &[]);
    assert_eq!(missing, ["test.hp:1:17 cannot-read: cannot read `map.txt`: no such file"]);
    let empty = file_messages(FILE, &[("map.txt", "\n\n")]);
    assert_eq!(empty, ["test.hp:1:17 bad-map: the map file `map.txt` is empty"]);
    let binary = file_messages(FILE, &[("map.txt", "a\0b")]);
    assert_eq!(binary, ["test.hp:1:17 not-text: `map.txt` is not a text file"]);
}

#[test]
fn moving_ai_maps() {
    let map = "type octile\nheight 3\nwidth 4\nmap\n..G@\nOTW.\nS...\n";
    let files = [("map.txt", map)];
    let problem = ok_with(FILE, &files).problem;
    let system = problem.systems.first().expect("a system");
    let map = system.map.as_ref().expect("a map");
    assert_eq!((map.width, map.height), (4, 3));
    assert_eq!(map.obstacles, [(0, 1), (1, 1), (2, 1), (3, 2)]);
    assert!(system.label("goal").is_none() && system.label("start").is_none());
}

#[test]
fn mistakes_in_moving_ai_maps() {
    let rows = file_messages(FILE, &[("map.txt", "type octile\nheight 3\nwidth 2\nmap\n..\n..\n")]);
    assert_eq!(rows, ["map.txt:4:1 bad-map: the header says 3 rows, the map has 2"]);
    let cells = file_messages(FILE, &[("map.txt", "type octile\nheight 2\nwidth 2\nmap\n..\n...\n")]);
    assert_eq!(cells, ["map.txt:6:1 ragged-map: this row has 3 cells, the header says 2"]);
    let header = file_messages(FILE, &[("map.txt", "type octile\nheight x\nwidth 2\nmap\n..\n")]);
    assert_eq!(header.len(), 1);
    let end = file_messages(FILE, &[("map.txt", "type octile\nheight 2\n")]);
    assert_eq!(end.len(), 1);
}

#[test]
fn ros_maps() {
    let yaml = "image: \"room.pgm\"\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\noccupied_thresh: 0.65\n\
                free_thresh: 0.25\nnegate: 0 # white is free\n";
    let picture = "P2\n# a comment\n3 2\n255\n255 0 255\n255 255 128\n";
    let files = [("maps/room.yaml", yaml), ("maps/room.pgm", picture)];
    let text = r#"system W = grid("maps/room.yaml") { }"#;
    let problem = ok_with(text, &files).problem;
    let map = problem.systems.first().and_then(|s| s.map.clone()).expect("a map");
    // The top picture row is y = 1; gray is unknown, and so an obstacle.
    assert_eq!((map.width, map.height, map.obstacles), (3, 2, vec![(1, 1), (2, 0)]));
    let raw = crate::lower::grid::formats::read(b"P5 2 1 255\n\x00\xff", 10).expect("a picture");
    assert_eq!(shades(&raw), [0, 255]);
    for bad in [&b"P5 2 1 255\n\x00"[..], b"P5 2", b"P6 1 1 255\n000", b"P2 1 1 255\n256", b"", b"P2 9 9 9 9"]
    {
        assert!(crate::lower::grid::formats::read(bad, 10).is_err());
    }
}

/// How bright the pixels of a picture are, of 255, from the top.
fn shades(picture: &crate::lower::grid::picture::Picture) -> Vec<u16> {
    let pixels = (0..picture.height).flat_map(|row| (0..picture.width).map(move |x| (x, row)));
    pixels.map(|(x, row)| (picture.brightness(x, row, true) * 255.0).round() as u16).collect()
}

/// What the map of a YAML file and a plain picture is, or the messages.
fn ros(yaml: &str, picture: &str) -> Result<Vec<(u32, u32)>, Vec<String>> {
    let files = [("room.yaml", yaml), ("room.pgm", picture)];
    let text = r#"system W = grid("room.yaml") { } objective o { exists p. F[0,1] x[p] == 0 }"#;
    let (lowered, sources) = lowered_with(text, &files, &Overrides::none());
    if lowered.has_errors() {
        return Err(messages(&lowered, &sources));
    }
    let problem = lowered.problem;
    Ok(problem.systems.first().and_then(|s| s.map.clone()).expect("a map").obstacles)
}

#[test]
fn ros_settings_in_every_style() {
    let picture = "P2 3 1 255 255 0 205";
    let flat = "image: room.pgm\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    let obstacles = Ok(vec![(1, 0), (2, 0)]);
    for yaml in [
        flat.to_owned(),
        flat.replace('\n', "\r\n"),
        format!("\u{feff}{flat}"),
        format!("%YAML 1.2\n---\n# saved\n{flat}..."),
        "{image: room.pgm, negate: 0, origin: [0, 0, 0.5]}".to_owned(),
        "\"image\": 'room.pgm' # of the room\n'negate': false\n".to_owned(),
        "image:\n  room.pgm\nmode: trinary\nnegate: off\n".replace("negate: off\n", ""),
    ] {
        assert_eq!(ros(&yaml, picture), obstacles, "{yaml:?}");
    }
    assert_eq!(ros("image: room.pgm\nnegate: true", picture), Ok(vec![(0, 0), (2, 0)]));
    for bad in [
        "",
        "room.pgm",
        "image: [a, b]",
        "image: ''",
        "negate: 0",
        "image: room.pgm\nnegate: 2",
        "image: room.pgm\nnegate: perhaps",
        "image: room.pgm\nfree_thresh: 1.5",
        "image: room.pgm\noccupied_thresh: -0.1",
        "image: room.pgm\noccupied_thresh: .nan",
        "image: room.pgm\nfree_thresh: 0.7",
        "image: room.pgm\nmode: grey",
        "image: room.pgm\nresolution: 0",
        "image: room.pgm\nresolution: -0.05",
        "image: room.pgm\nresolution: .nan",
        "image: room.pgm\nresolution: .inf",
        "image: room.pgm\nresolution: 0.05\norigin: [0, 0]",
        "image: room.pgm\nresolution: 0.05\norigin: [0, .nan, 0]",
        "image: room.pgm\nimage: other.pgm",
        "image: room.pgm\n  bad: [",
    ] {
        let said = ros(bad, picture).expect_err(bad);
        assert!(said.len() == 1 && said[0].starts_with("room.yaml:"), "{bad:?}: {said:?}");
    }
}

#[test]
fn thresholds_that_free_unknown_cells_are_told() {
    let files = [("room.yaml", "image: room.pgm\nfree_thresh: 0.25"), ("room.pgm", "P2 2 1 255 255 205")];
    let said = file_messages(r#"system W = grid("room.yaml") { }"#, &files);
    assert!(said.iter().any(|message| message.contains("unknown-is-free")), "{said:?}");
}

/// Whatever the white space and comments of its header: a picture is read pixel by pixel, or refused.
#[test]
fn pictures_are_never_shifted() {
    let pixels: [u8; 6] = *b"\0#5\r\n0";
    let blanks = [" ", "\n", "\r\n", "\t", "\n# 7 7\n", " # a\r\n", ""];
    let (mut read, mut refused) = (0, 0);
    for at in 0..blanks.len().pow(3) {
        let n = blanks.len();
        let (a, b, c) = (blanks[at % n], blanks[at / n % n], blanks[at / n / n]);
        for (extra, cut) in [(0, 0), (1, 0), (0, 1)] {
            let mut bytes = format!("P5{a}3{b}2{a}255{c}").into_bytes();
            bytes.extend_from_slice(&pixels[cut..]);
            bytes.extend(std::iter::repeat_n(b'x', extra));
            match crate::lower::grid::formats::read(&bytes, 100) {
                // A line end of two bytes is one white space only where the sizes say so.
                Ok(picture) if extra == 0 && cut == 0 => {
                    assert_eq!(shades(&picture), pixels.map(u16::from), "{a:?} {b:?} {c:?}");
                    read += 1;
                }
                Ok(picture) => {
                    // One byte less after a line end of two: it was one byte of white space, and a pixel.
                    assert!(c == "\r\n" && cut == 1 && shades(&picture)[0] == 10, "{a:?} {b:?} {c:?}");
                }
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read > 50 && refused > 500, "{read} read, {refused} refused");
}

#[test]
fn png_pictures() {
    let encoded = |color, depth, data: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        encoder.write_header().and_then(|mut writer| writer.write_image_data(data)).expect("a picture");
        bytes
    };
    let (eight, sixteen) = (png::BitDepth::Eight, png::BitDepth::Sixteen);
    for (bytes, shades) in [
        (encoded(png::ColorType::Grayscale, eight, &[0, 205]), [0, 205]),
        (encoded(png::ColorType::Grayscale, sixteen, &[0, 0, 205, 7]), [0, 205]),
        (encoded(png::ColorType::Grayscale, png::BitDepth::One, &[0b0100_0000]), [0, 255]),
        (encoded(png::ColorType::Rgb, eight, &[0, 30, 60, 255, 255, 255]), [30, 255]),
        (encoded(png::ColorType::Rgba, eight, &[0, 0, 0, 0, 255, 255, 255, 255]), [0, 255]),
    ] {
        let picture = crate::lower::grid::formats::read(&bytes, 100).expect("a picture");
        assert_eq!((picture.width, picture.height), (2, 1));
        assert_eq!(self::shades(&picture), shades);
        for end in 0..bytes.len() - 12 {
            assert!(crate::lower::grid::formats::read(&bytes[..end], 100).is_err(), "cut after {end} bytes");
        }
        assert!(crate::lower::grid::formats::read(&bytes, 1).is_err());
    }
}

#[test]
fn headers_of_the_moving_ai_lab_in_every_spelling() {
    for header in [
        "type octile\nheight 2\nwidth 3\nmap\n",
        "Type octile\nHEIGHT 2\nwidth 3\nMap\n",
        "\u{feff}type octile\r\nheight 2\r\nwidth 3\r\nmap\r\n",
        "\n# a note\ntype octile\nwidth 3\nheight 2\nmap\n",
        "height 2\nwidth 3\nmap\n",
    ] {
        let text = format!("{header}..@\n@.T\n");
        let files = [("map.txt", text.as_str())];
        let problem = ok_with(FILE, &files).problem;
        let map = problem.systems.first().and_then(|s| s.map.clone()).expect("a map");
        assert_eq!(map.obstacles, [(0, 0), (2, 0), (2, 1)], "{header:?}");
    }
}

#[test]
fn files_of_other_kinds_are_named() {
    for (name, contents) in [
        ("a.scen", "version 1\n0 a.map 3 3 0 0 1 1 1.0\n"),
        ("a.pgm", "P5 1 1 255\n0"),
        ("a.json", "{\"states\": []}"),
    ] {
        let text = format!("system W = grid({name:?}) {{ }}");
        let said = file_messages(&text, &[(name, contents)]);
        assert!(said.len() == 1 && said[0].contains(" is a"), "{said:?}");
    }
    let said = file_messages("system W = graph(\"a.map\") { }", &[("a.map", "P2 1 1 255 0")]);
    assert!(said.len() == 1 && said[0].contains("is a picture"), "{said:?}");
}

#[test]
fn a_large_map() {
    let map = ["type octile\nheight 512\nwidth 512\nmap\n", &format!("{}\n", ".@".repeat(256)).repeat(512)]
        .concat();
    let files = [("map.txt", &*map)];
    let problem = ok_with(FILE, &files).problem;
    let map = problem.systems.first().and_then(|s| s.map.clone()).expect("a map");
    assert_eq!(map.obstacles.len(), 512 * 256);
}
