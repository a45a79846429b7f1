//! Plans that leave: what `solve` writes for other programs, and that it comes back.

mod common;

use common::{hyperplan, hyperplan_with, text};
use std::fs;
use std::path::Path;

/// A room of ROS, two robots, and an objective for each way to write a plan.
fn room() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("writable");
    write("room.yaml", "image: room.pgm\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n");
    write("room.pgm", "P2 3 2 255\n255 255 255\n255 0 255\n");
    write(
        "room.hp",
        r#"system Room = grid("room.yaml") {
  moves up, down, left, right, stay;
  edge stay;
  label dock = (x, y) in {(0, 0)};
  label shelf = (x, y) in {(2, 0)};
  absorb shelf;
}

objective one { exists p. dock[p] & F[0,9] shelf[p] }
objective two { exists p, q. dock[p] & F[0,9] shelf[p] & shelf[q] & G[0,9] (y[p] < 2 & y[q] == 0) }
objective none { exists p. dock[p] & F[0,3] shelf[p] }
"#,
    );
    folder
}

fn solve(folder: &Path, arguments: &[&str]) -> common::Run {
    let file = folder.join("room.hp");
    hyperplan(&[&["solve", text(&file)], arguments].concat())
}

#[test]
fn tables_have_a_row_a_step_and_nothing_after_absorption() {
    let folder = room();
    let run = solve(folder.path(), &["--objective", "one", "--format", "csv"]);
    assert_eq!((run.status, run.stderr.as_str()), (0, "one: realizable\n"));
    let expected = "\
time,path,action,x,y,x_m,y_m
0,p,up,0,0,-0.75,2.25
1,p,right,0,1,-0.75,2.75
2,p,right,1,1,-0.25,2.75
3,p,down,2,1,0.25,2.75
4,p,,2,0,0.25,2.25
";
    assert_eq!(run.stdout, expected);
    // What cannot be had leaves no plan.
    let run = solve(folder.path(), &["--objective", "none", "--format", "csv"]);
    assert_eq!((run.status, run.stdout.as_str()), (1, ""));
}

#[test]
fn messages_of_ros_have_a_pose_a_step() {
    let folder = room();
    let run = solve(folder.path(), &["--objective", "one", "--format", "ros"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    let begin = "\
header:
  stamp: {sec: 0, nanosec: 0}
  frame_id: map
poses:
  - header:
      stamp: {sec: 0, nanosec: 0}
      frame_id: map
    pose:
      position: {x: -0.75, y: 2.25, z: 0.0}
      orientation: {x: 0.0, y: 0.0, z: 0.707106781, w: 0.707106781}
";
    assert!(run.stdout.starts_with(begin), "{}", run.stdout);
    assert_eq!(run.stdout.matches("    pose:\n").count(), 5);
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--format", "ros"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("does not say where it lies"), "{}", run.stderr);
}

#[test]
fn several_robots_have_a_file_each() {
    let folder = room();
    for ending in ["csv", "yaml", "geojson", "plan"] {
        let file = folder.path().join(format!("both.{ending}"));
        let run = solve(folder.path(), &["--objective", "two", "--quiet", "--save", text(&file)]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert!(!file.exists());
        let [p, q] = ["p", "q"].map(|path| folder.path().join(format!("both-{path}.{ending}")));
        let problem = folder.path().join("room.hp");
        if ending != "yaml" {
            let run = hyperplan(&["verify", text(&problem), text(&p), text(&q), "--objective", "two"]);
            assert_eq!(
                run.stdout, "two: the strategy holds, verified by search\n",
                "{ending}: {}",
                run.stderr
            );
        }
        let one = hyperplan(&["verify", text(&problem), text(&p), "--objective", "two"]);
        assert_eq!(one.status, 2, "{ending}: {}", one.stdout);
    }
    let all = folder.path().join("all.csv");
    let run = solve(folder.path(), &["--objective", "all", "--quiet", "--save", text(&all)]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    for name in ["all-one.csv", "all-two-p.csv", "all-two-q.csv"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    let run = solve(folder.path(), &["--objective", "all", "--format", "csv"]);
    assert_eq!(run.status, 2);
}

/// Of every strategy for the problems of `specs/pass`, for the rooms and the small case studies.
#[test]
fn what_is_written_is_what_was_found() {
    let mut files: Vec<_> = fs::read_dir(common::specs().join("pass"))
        .expect("it is part of the repository")
        .map(|entry| format!("pass/{}", entry.expect("readable").file_name().to_string_lossy()))
        .filter(|name| name.ends_with(".hp"))
        .collect();
    files.sort();
    files.extend(["rooms.hp", "case-studies/isr-10.hp", "case-studies/ar-10.hp"].map(str::to_owned));
    let mut written = 0;
    for file in files {
        let found = hyperplan(&["solve", &file, "--objective", "all", "--format", "json", "--quiet"]);
        for answer in found.json().iter().filter(|answer| !answer["witness"].is_null()) {
            let objective = answer["objective"].as_str().expect("a name");
            for format in ["csv", "geojson"] {
                let options = ["--objective", objective, "--format", format];
                let plan = hyperplan(&[&["solve", &file], &options[..]].concat());
                let back = hyperplan_with(&["verify", &file, "-", "--objective", objective], &plan.stdout);
                let words = format!("{file} {objective} {format}:\n{}{}", back.stderr, plan.stdout);
                assert!(back.status == 0 || back.stdout.contains("infinitely many"), "{words}");
                written += 1;
            }
        }
    }
    assert!(written > 100, "only {written} plans");
}

#[test]
fn plans_in_pddl_come_back() {
    let folder = room();
    let file = folder.path().join("room.hp");
    let one = solve(folder.path(), &["--objective", "one", "--format", "pddl"]);
    assert_eq!(one.stdout, "; path p\n(up)\n(right)\n(right)\n(down)\n");
    let two = solve(folder.path(), &["--objective", "two", "--format", "pddl"]);
    assert!(two.stdout.starts_with("; path p\n; path q\n0: ("), "{}", two.stdout);
    for (objective, plan) in [
        ("one", one.stdout.as_str()),
        ("two", two.stdout.as_str()),
        ("one", "(up) ; a note\n\n1: (right) [1]\n(RIGHT)\n(down)\n".to_lowercase().as_str()),
    ] {
        let back = hyperplan_with(&["verify", text(&file), "-", "--objective", objective], plan);
        assert_eq!((back.status, back.stderr.as_str()), (0, ""), "{plan}");
    }
    // Names that PDDL does not have.
    let turns = hyperplan(&["solve", "pass/graph.hp", "--objective", "all", "--format", "json", "--quiet"]);
    for answer in turns.json().iter().filter(|answer| !answer["witness"].is_null()) {
        let objective = answer["objective"].as_str().expect("a name");
        let plan = hyperplan(&["solve", "pass/graph.hp", "--objective", objective, "--format", "pddl"]);
        assert!(!plan.stdout.contains('"'), "{}", plan.stdout);
    }
}

#[test]
fn damaged_tables_are_refused_with_a_line() {
    let folder = room();
    let file = folder.path().join("room.hp");
    for (table, message) in [
        ("time,path,action,x,y\n0,p,up,0,0\n2,p,,0,1\n", "line 3: time 1 of path p is due, not `2`"),
        ("time,path,action,x,y\n0,p,,0,0\n1,p,up,0,1\n", "line 3: path p ended before"),
        ("time,path,action,x,y\n0,p,up,0,0\n1,p,,0\n", "line: 3"),
        ("time,path,action,x,y\n", "the table has no rows"),
        ("time,path,action,x,y\n0,p,up,0,0\n", "has 1 steps, but the objective needs 9"),
        ("time,path,action,x,z\n0,p,up,0,0\n1,p,,0,1\n", "has no variable `z`"),
        ("time,path,action,x,y\n0,p,jump,0,0\n1,p,,0,1\n", "has no action `jump`"),
        ("time,path,action,x,y\n0,p,up,0,0\n1,p,,0,7\n", "y is an integer in 0..1, not 7"),
        ("(up up up)\n", "line 1: expected an action"),
        ("; path p\n", "more than 1 way"),
        ("{\"type\": \"FeatureCollection\", \"features\": [{\"properties\": {}}]}", "missing field"),
    ] {
        let back = hyperplan_with(&["verify", text(&file), "-", "--objective", "one"], table);
        if message == "more than 1 way" {
            assert_ne!(back.status, 0, "{table}");
            continue;
        }
        assert!(back.status == 2 && back.stderr.contains(message), "{table}: {}", back.stderr);
    }
}
