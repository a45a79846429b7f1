//! `hyperplan explain`: as JSON, of given strategies, of files of other tools, of what cannot be explained; and the line of
//! it that `solve` prints.

mod common;

use common::{Run, hyperplan, hyperplan_with};
use serde_json::{Value, json};

const FILE: &str = "explain/corridor.hp";

/// What `explain` says of an objective, as JSON.
fn explained(objective: &str) -> Value {
    let run = hyperplan(&["explain", FILE, "--objective", objective, "--format", "json"]);
    assert_eq!((run.status, run.stderr.as_str()), (1, ""), "{}", run.stdout);
    run.json().remove(0)
}

fn texts(parts: &Value) -> Vec<&str> {
    parts.as_array().expect("a list").iter().map(|part| part["text"].as_str().expect("text")).collect()
}

fn is_refused(run: &Run, message: &str) {
    assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{}", run.stderr);
    assert!(run.stderr.contains(message), "{}", run.stderr);
}

#[test]
fn walls_are_told_from_too_little_time() {
    let walled = explained("walled");
    assert_eq!(texts(&walled["core"]["parts"]), ["start[p]", "!crash[p] U goal[p]"]);
    assert_eq!(walled["core"]["scope"], "leading");
    assert_eq!(walled["core"]["minimal"], true);
    assert_eq!(walled["wall"]["reached"], 9);
    assert_eq!(walled["wall"]["states"].as_array().map(Vec::len), Some(9));
    assert_eq!(walled["wall"]["part"]["text"], "!crash[p] U goal[p]");
    assert_eq!(walled["later"], json!([]));
    let late = explained("late");
    assert_eq!(late["wall"], Value::Null);
    let least =
        json!([{"time": "constant", "name": "T", "now": 5, "least": 8, "proved": true, "refuted": 7}]);
    assert_eq!(late["later"], least);
    let torn = explained("torn");
    assert_eq!((&torn["wall"], &torn["later"][0]["least"]), (&Value::Null, &Value::Null));
    assert_eq!(texts(&torn["core"]["parts"]).len(), 3);
}

#[test]
fn opponents_are_told_apart() {
    let shaky = explained("shaky");
    assert_eq!(shaky["core"]["scope"], "game");
    assert_eq!(shaky["opponents"]["minimal"], true);
    assert_eq!(shaky["opponents"]["replaced"].as_array().map(Vec::len), Some(1));
    assert_eq!(shaky["candidate"]["failure"]["parts"][0]["text"], "!crash[q] U goal[q]");
    assert_eq!(shaky["candidate"]["failure"]["differences"][0]["actions"].as_array().map(Vec::len), Some(1));
    assert_eq!(shaky["later"][0]["least"], 12);
    assert_eq!(explained("alone")["core"]["scope"], "leading");
    let anywhere = explained("anywhere");
    assert_eq!(anywhere["opponents"]["starts"].as_array().map(Vec::len), Some(2));
    assert_eq!(anywhere["opponents"]["replaced"], json!([]));
    let asked = explained("asked");
    assert_eq!(asked["demanded"][0]["code"], "demanded-of-every-path");
}

#[test]
fn counterexamples_fail_somewhere() {
    let every = explained("every");
    let failure = &every["failure"];
    assert_eq!(failure["parts"].as_array().map(Vec::len), Some(1));
    assert!(failure["parts"][0]["time"].is_u64(), "{failure}");
    assert_eq!(failure["paths"][0]["path"], "p");
}

#[test]
fn a_given_plan_fails_as_the_checker_says() {
    let plan = "--actions=p=up,up,right,right,right,right,right,right";
    let run = hyperplan(&["explain", FILE, "--objective", "shaky", plan, "--format", "json"]);
    assert_eq!(run.status, 1, "{}", run.stderr);
    let told = &run.json()[0];
    assert_eq!(
        (&told["verdict"], &told["failure"]["reason"]),
        (&json!("fails"), &json!("defeated by a choice of q"))
    );
    assert_eq!(told["failure"]["parts"][0]["text"], "!crash[q] U goal[q]");
    let run = hyperplan(&["explain", FILE, "--objective", "fine", plan]);
    assert_eq!((run.status, run.stdout.as_str()), (0, "fine: the strategy holds\n"));
    let run = hyperplan(&[
        "explain",
        FILE,
        "--objective",
        "fine",
        "--actions=p=up,up,stay,stay,stay,stay,stay,stay",
    ]);
    is_refused(&run, "stay");
    let actions = ["right"; 8];
    let witness = json!([{"path": "p", "actions": actions, "states": [{"x": 0, "y": 0}]}]);
    let given = json!({"objective": "fine", "witness": witness}).to_string();
    let run = hyperplan_with(&["explain", FILE, "-"], &given);
    assert_eq!(run.status, 1, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("this part fails at time 8"), "{}", run.stdout);
    // What is claimed to refute a property does not.
    let witness =
        json!([{"path": "p", "actions": ["right", "right", "right"], "states": [{"x": 0, "y": 0}]}]);
    let given = json!({"objective": "every", "witness": witness}).to_string();
    let run = hyperplan_with(&["explain", FILE, "-"], &given);
    assert_eq!(run.status, 1, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.starts_with("every: the counterexample fails: "), "{}", run.stdout);
}

#[test]
fn there_may_be_nothing_to_explain() {
    let run = hyperplan(&["explain", FILE, "--objective", "fine"]);
    let words = "fine: realizable\nthere is nothing to explain; `hyperplan solve` shows how\n";
    assert_eq!((run.status, run.stdout.as_str()), (0, words));
    let nowhere =
        "system S { state x: 0..3; action a; on a when x < 0 {} } objective o { exists p. X x[p] == 0 }";
    let run = hyperplan_with(&["explain", "-"], nowhere);
    assert_eq!(run.status, 1, "{}", run.stderr);
    assert!(run.stdout.contains("has no path"), "{}", run.stdout);
}

#[test]
fn what_cannot_be_read_is_refused() {
    is_refused(&hyperplan(&["explain", "no-such-file.hp"]), "no-such-file.hp");
    is_refused(&hyperplan(&["explain", FILE]), "has several objectives");
    is_refused(&hyperplan(&["explain", FILE, "--objective", "nothing"]), "has no objective `nothing`");
    is_refused(&hyperplan(&["explain", FILE, "--objective", "late", "--timeout", "0"]), "--timeout 0");
    let missing = hyperplan(&["explain", FILE, "--objective", "late", "--solver", "nobody"]);
    assert_eq!((missing.status, missing.stdout.as_str()), (4, ""), "{}", missing.stderr);
    is_refused(&hyperplan(&["explain", FILE, "no-such-strategy.json"]), "no-such-strategy.json");
    is_refused(&hyperplan_with(&["explain", "-"], "objective o { exists p. }"), "error[");
}

#[test]
fn the_time_that_there_is_is_kept() {
    let start = std::time::Instant::now();
    let run = hyperplan(&["explain", "case-studies/ar-60.hp", "--set", "T=60", "--timeout", "2"]);
    assert!(start.elapsed().as_secs() < 10, "{:?}", start.elapsed());
    assert!([1, 3].contains(&run.status), "{}{}", run.stdout, run.stderr);
}

#[test]
fn files_of_other_tools_are_explained() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("writable");
        path.display().to_string()
    };
    let model = write(
        "count.smv",
        "MODULE main\nVAR n : 0..7;\nASSIGN init(n) := 0; next(n) := case n < 7 : n + 1; TRUE : n; esac;\n",
    );
    let formula = write("reach.hq", "exists A. F(n[A] = 5)\n");
    let run = hyperplan(&["explain", &model, &formula, "--bound", "3"]);
    assert_eq!(run.status, 1, "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("--bound 5 instead of 3, the least"), "{}", run.stdout);
}

#[test]
fn solve_says_why_in_a_line() {
    let line = |objective: &str| {
        let run = hyperplan(&["solve", FILE, "--objective", objective]);
        assert_eq!(run.status, 1, "{}", run.stderr);
        run.stdout.lines().find(|line| line.starts_with("why: ")).unwrap_or_default().to_owned()
    };
    let late = "why: `start[p]`, `!crash[p] U goal[p]` exclude each other; `hyperplan explain` says more";
    assert_eq!(line("late"), late);
    assert!(line("every").contains(" fails at time "), "{}", line("every"));
    let quiet = hyperplan(&["solve", FILE, "--objective", "late", "--quiet"]);
    assert_eq!(quiet.stdout, "late: unrealizable\n");
}

/// What is said to be impossible has certificates: that parts exclude each other too; of fewer parts it is wrong.
#[test]
fn what_is_explained_is_certified() {
    for (objective, more) in [("walled", 0), ("late", 2), ("alone", 0), ("shaky", 0), ("anywhere", 0)] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let proof = folder.path().to_str().expect("a plain name");
        let arguments = ["explain", FILE, "--objective", objective, "--proof", proof, "--format", "json"];
        let run = hyperplan(&arguments);
        assert_eq!(run.status, 1, "{objective}: {}", run.stderr);
        let explained = run.json().remove(0);
        let names = explained["certificates"].as_array().expect("certificates");
        let constants =
            names.iter().filter(|name| name.as_str().is_some_and(|name| name.contains("-T="))).count();
        // The objective as it is, its parts, and the larger values of T.
        assert!(names.len() == constants + 2 && constants >= more, "{objective}: {names:?}");
        let run = hyperplan(&["certify", FILE, proof]);
        assert_eq!(run.status, 0, "{objective}: {}{}", run.stdout, run.stderr);
        let numbers = |list: &Value| list["parts"]["numbers"].as_array().map(Vec::len);
        let file = folder.path().join(format!("{objective}-parts.json"));
        let mut certificate: Value =
            serde_json::from_str(&std::fs::read_to_string(&file).expect("readable")).expect("JSON");
        assert_eq!(numbers(&certificate), explained["core"]["parts"].as_array().map(Vec::len), "{objective}");
        certificate["parts"]["numbers"].as_array_mut().expect("numbers").pop();
        std::fs::write(&file, certificate.to_string()).expect("written");
        assert_ne!(hyperplan(&["certify", FILE, proof]).status, 0, "{objective}");
    }
}
