//! Files of other tools in place of a problem file.

mod common;

use common::{Run, hyperplan, text};
use std::path::{Path, PathBuf};

/// The files of `specs/import/pass`, with what is true of each within 6 steps.
const KNOWN: &[(&str, bool)] =
    &[("chain", true), ("kinds", true), ("modules", false), ("names", true), ("words", true)];

fn files(name: &str) -> [String; 2] {
    ["smv", "hq"].map(|ending| format!("import/pass/{name}.{ending}"))
}

fn solve(name: &str, more: &[&str]) -> Run {
    let [model, formula] = files(name);
    hyperplan(&[&["solve", &model, &formula, "--bound", "6", "--quiet"], more].concat())
}

#[test]
fn models_and_formulas_are_solved_as_their_imports_are() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, holds) in KNOWN {
        let run = solve(name, &[]);
        assert_eq!(run.status, i32::from(!holds), "{name}: {}{}", run.stdout, run.stderr);
        let bitvec = solve(name, &["--states", "bitvec", "--quantifiers", "cegis"]);
        assert_eq!(bitvec.status, run.status, "{name}: {}{}", bitvec.stdout, bitvec.stderr);
        let [model, formula] = files(name);
        let problem = folder.path().join(format!("{name}.hp"));
        let run = hyperplan(&["import", &model, &formula, "--bound", "6", "-o", text(&problem)]);
        assert_eq!(run.status, 0, "{}", run.stderr);
        let run = hyperplan(&["solve", text(&problem), "--quiet"]);
        assert_eq!(run.status, i32::from(!holds), "{name}: {}{}", run.stdout, run.stderr);
    }
}

#[test]
fn other_commands_take_them_too() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let plan = folder.path().join("plan.json");
    assert_eq!(solve("kinds", &["--save", text(&plan)]).status, 0);
    let [model, formula] = files("kinds");
    let run = hyperplan(&["verify", &model, &formula, text(&plan), "--bound", "6"]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    let run = hyperplan(&["horizon", &model, &formula, "--bound", "6"]);
    assert!(run.status == 0 && run.stdout.contains('6'), "{}{}", run.stdout, run.stderr);
    let run = hyperplan(&["emit", &model, &formula, "--bound", "6"]);
    assert!(run.stdout.contains("(check-sat)"), "{}", run.stderr);
    let run = hyperplan(&["check", &model, &formula, "--bound", "6"]);
    assert!(run.status == 0 && run.stdout.contains("1 system, 1 objective"), "{}{}", run.stdout, run.stderr);
    let [chain, formula] = files("chain");
    let run = hyperplan(&["check", &chain, &formula, "--bound", "6"]);
    assert!(run.stderr.contains("open-case"), "{}", run.stderr);
    // Of several semantics the pessimistic one knows nothing beyond the end.
    let run = hyperplan(&["solve", &chain, &formula, "--bound", "6", "--semantics", "opt", "--quiet"]);
    assert!(run.status < 2, "{}", run.stderr);
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let [model, formula] = files("kinds");
    for (arguments, said) in [
        (vec!["solve", &model, &formula], "say it with `--bound K`"),
        (vec!["solve", "rooms.hp", &formula], "cannot be read together with rooms.hp"),
        (vec!["solve", &model, "rooms.hp", "--bound", "3"], "neither a model"),
        (vec!["solve", "rooms.hp", "--bound", "3"], "write `within K`"),
        (vec!["solve", &model, &formula, "--bound", "3", "--semantics", "best"], "is none of pes, opt"),
        (vec!["solve", &model, "--bound", "3"], "has no objective"),
        (vec!["solve", &model, &model, &model, &formula, "--bound", "3"], "2 paths are quantified"),
        (vec!["import", "rooms.hp"], "neither a model"),
        (vec!["solve", "import/fail/types.smv", &formula, "--bound", "3"], "types.smv:8:14"),
        (vec!["verify", "rooms.hp"], "a strategy is needed"),
        (vec!["verify", "rooms.hp", "plan.json", "--actions", "p=up"], "cannot be used together"),
    ] {
        let run = hyperplan(&arguments);
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stdout);
        assert!(run.stderr.contains(said), "{arguments:?}: {}", run.stderr);
    }
}

/// The models of other tools, where they are at hand: `HYPERPLAN_PEERS` names their folder.
fn peers() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/peers");
    let folder = std::env::var_os("HYPERPLAN_PEERS").map_or(beside, PathBuf::from);
    folder.join("hyperqb2/instances.tsv").is_file().then(|| folder.join("hyperqb2"))
}

#[test]
fn instances_of_another_tool_have_their_right_verdicts() {
    let Some(folder) = peers() else { return };
    let table = std::fs::read_to_string(folder.join("instances.tsv")).expect("it can be read");
    let mut wrong = Vec::new();
    for row in table.lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = row.split('\t').collect();
        let [_, models, formula, bound, verdict, ..] = cells[..] else { panic!("{row}") };
        let files: Vec<String> =
            models.split(' ').chain([formula]).map(|file| text(&folder.join(file)).to_owned()).collect();
        let files = files.iter().map(String::as_str);
        let options = ["--bound", bound, "--quiet", "--timeout", "10"];
        let arguments: Vec<&str> = ["solve"].into_iter().chain(files).chain(options).collect();
        let run = hyperplan(&arguments);
        let expected = i32::from(verdict != "realizable");
        // Undecided in some seconds, in a build for tests, is not wrong.
        if run.status != expected && run.status != 3 {
            wrong.push(format!("{formula}: {}, not {verdict}: {}", run.status, run.stderr));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The goal is 16 steps away on each of these maps, and a plan for every start has 13; one step less will not do.
#[test]
fn planning_models_of_other_tools_have_their_true_distances() {
    let Some(folder) = peers().and_then(|folder| Some(folder.parent()?.join("hyperqb1/planning"))) else {
        return;
    };
    let own = tempfile::tempdir().expect("a temporary folder");
    let reach = own.path().join("reach.hq");
    std::fs::write(&reach, "exists A. F(GOAL[A])\n").expect("it can be written");
    let robust = folder.join("robotic_robustness_formula.hq");
    for size in [100, 400, 1600, 3600] {
        for (kind, formula, least) in [("sp", &reach, 16), ("robustness", &robust, 13)] {
            let model = folder.join(format!("robotic_{kind}_{size}.smv"));
            for (steps, status) in [(least - 1, 1), (least, 0)] {
                let steps = steps.to_string();
                let run = hyperplan(&["solve", text(&model), text(formula), "--bound", &steps, "--quiet"]);
                assert_eq!(run.status, status, "{kind} {size}, K = {steps}: {}", run.stderr);
            }
        }
    }
}

/// A table of problems, with the folder of a comparison beside it.
fn table(rows: &[(&str, &str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let specs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/import/pass");
    for (name, ..) in rows {
        for ending in ["smv", "hq"] {
            let file = format!("{name}.{ending}");
            std::fs::copy(specs.join(&file), folder.path().join(&file)).expect("it can be copied");
        }
    }
    let row = |(name, bound, known): &(&str, &str, &str)| {
        format!("small\t{name}.smv\t{name}.hq\t{bound}\t{known}\tby hand\n")
    };
    let path = folder.path().join("table.tsv");
    let text =
        format!("# family\tmodels\tformula\tbound\tknown\n{}", rows.iter().map(row).collect::<String>());
    std::fs::write(&path, text).expect("it can be written");
    (folder, path)
}

#[test]
fn tables_of_models_and_formulas_are_compared() {
    let (folder, path) =
        table(&[("chain", "6", "holds"), ("modules", "6", "violated"), ("words", "6 pes", "-")]);
    let out = folder.path().join("out");
    let [model, formula] = files("names");
    let compare = [
        "compare",
        text(&path),
        &model,
        &formula,
        "--bound",
        "6",
        "--solver",
        "builtin",
        "--out",
        text(&out),
    ];
    let run = hyperplan(&compare);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    let imported = |name: &str| std::fs::read_to_string(out.join("imported").join(name)).expect(name);
    assert!(imported("small/chain-chain-6.hp").contains("\n// chain: realizable\n"));
    assert!(imported("small/modules-modules-6.hp").contains("\n// modules: unrealizable\n"));
    assert!(imported("small/words-words-6-pes.hp").contains("within 6 semantics pes"));
    assert!(!imported("names-names-6.hp").contains("realizable\n"));
    let log = std::fs::read_to_string(out.join("runs.jsonl")).expect("it is there");
    assert_eq!(log.matches("\"expected\":\"").count(), 2, "{log}");
    let again = hyperplan(&compare);
    assert!(again.stderr.contains("of 4 runs were done before"), "{}", again.stderr);
}

#[test]
fn tables_that_are_wrong_are_told_of() {
    let (folder, path) = table(&[("chain", "6", "violated")]);
    let out = folder.path().join("out");
    let compare = |more: &[&str]| {
        hyperplan(&[&["compare", text(&path), "--solver", "builtin", "--out", text(&out)], more].concat())
    };
    let run = compare(&[]);
    assert!(
        run.status == 4 && run.stdout.contains("the known status is wrong"),
        "{}{}",
        run.stdout,
        run.stderr
    );
    for (row, said) in [
        ("small\tchain.smv\tchain.hq\tsix\t-", "table.tsv:1: `six` is no bound"),
        ("small\tchain.smv\tchain.hq\t6 best\t-", "`6 best` is no bound"),
        ("small\tchain.smv\tchain.hq\t6\tmaybe", "`maybe` is none of"),
        ("small\tchain.smv", "separated by tabs"),
        ("small\tother.smv\tchain.hq\t6\t-", "there is no such file"),
        ("small\tchain.smv chain.smv\tchain.hq\t6\t-", "1 paths are quantified"),
    ] {
        std::fs::write(&path, row).expect("it can be written");
        let run = compare(&[]);
        assert!(run.status == 2 && run.stderr.contains(said), "{row}: {}", run.stderr);
        // With a good one beside it, it is left out.
        std::fs::write(&path, format!("{row}\nsmall\tchain.smv\tchain.hq\t6\t-")).expect("it can be written");
        let run = compare(&["--skip-bad"]);
        let whole = said.contains("tabs") || said.contains("none of") || said.contains("no bound");
        assert_eq!(run.status, if whole { 2 } else { 0 }, "{row}: {}", run.stderr);
    }
    let run = compare(&["--bound", "3"]);
    assert!(run.status == 2 && run.stderr.contains("tables have bounds"), "{}", run.stderr);
}

#[test]
fn what_is_known_is_kept() {
    let [model, formula] = files("chain");
    let import = |status| hyperplan(&["import", &model, &formula, "--bound", "6", "--status", status]);
    let run = import("holds");
    assert!(
        run.status == 0 && run.stdout.contains("\n// chain: realizable\n"),
        "{}{}",
        run.stdout,
        run.stderr
    );
    let run = import("unrealizable");
    assert!(run.stdout.contains("\n// chain: unrealizable\n"), "{}", run.stdout);
    assert_eq!(import("yes").status, 2);
}

#[test]
fn verifiers_have_their_words_and_traces() {
    let run = solve("modules", &[]);
    assert_eq!(run.stdout.trim(), "modules: unrealizable (violated)");
    let [model, formula] = files("names");
    let nusmv = |model: &str, formula: &str| {
        hyperplan(&["solve", model, formula, "--bound", "6", "--format", "nusmv"])
    };
    let run = nusmv(&model, &formula);
    assert!(run.stderr.contains("names: realizable (holds)"), "{}", run.stderr);
    let begins = "Trace Description: names, path G_\nTrace Type: Witness\n  -> State: 1.1 <-\n";
    assert!(run.stdout.starts_with(begins) && run.stdout.contains("State: 1.7 <-"), "{}", run.stdout);
    assert!(run.stdout.contains("    p1-TOKEN = "), "{}", run.stdout);
    let [model, formula] = files("kinds");
    let run = nusmv(&model, &formula);
    assert!(run.stdout.contains(" = 0ud"), "{}", run.stdout);
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "all", "--format", "nusmv"]);
    assert!(run.status == 2 && run.stderr.contains("of one objective"), "{}", run.stderr);
    // Systems of our own have actions that say something.
    let run = hyperplan(&["solve", "rooms.hp", "--objective", "sp", "--format", "nusmv"]);
    assert!(run.stdout.contains("Input: 1.2 <-\n    action = "), "{}", run.stdout);
}

#[test]
fn circuits_systems_and_programs_are_models_too() {
    for (model, holds) in
        [("circuit.aag", true), ("explicit.txt", false), ("values.txt", true), ("program.txt", true)]
    {
        let model = format!("import/pass/{model}");
        let stem = model.rsplit_once('.').expect("it has an ending").0;
        let run = hyperplan(&["solve", &model, &format!("{stem}.hq"), "--bound", "6", "--quiet"]);
        assert_eq!(run.status, i32::from(!holds), "{model}: {}{}", run.stdout, run.stderr);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let circuit = folder.path().join("toggle.aig");
    // The latch 4 becomes what the input 2 and its opposite say: 6 = 2 & !4.
    std::fs::write(&circuit, b"aig 3 1 1 1 1\n6\n4\n\x01\x03i0 go\no0 on\n").expect("it can be written");
    let formula = folder.path().join("f.hq");
    std::fs::write(&formula, "Exists (And (X (AP \"on\" 0)) (X (X (Neg (AP \"on\" 0)))))")
        .expect("it can be written");
    let files = [text(&circuit), text(&formula)];
    let plan = folder.path().join("plan.json");
    let solve = ["solve", files[0], files[1], "--bound", "3", "--quiet", "--save", text(&plan)];
    let run = hyperplan(&solve);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    for command in [&["check"][..], &["emit", "--status", "unknown"], &["horizon"], &["import"]] {
        let run = hyperplan(&[command, &files[..], &["--bound", "3"]].concat());
        assert_eq!(run.status, 0, "{command:?}: {}{}", run.stdout, run.stderr);
    }
    let run = hyperplan(&["verify", files[0], files[1], text(&plan), "--bound", "3"]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    std::fs::write(&circuit, b"aig 3 1 1 1 1\n6\n4\n\x09").expect("it can be written");
    let run = hyperplan(&solve);
    assert!(run.status == 2 && run.stderr.contains("toggle.aig: byte"), "{}", run.stderr);
}

#[test]
fn tasks_in_pddl_are_conformant_planning() {
    let task = "import/pass/bomb.pddl";
    // Both packages are dunked, and between them the toilet has to be flushed.
    for (bound, status) in [("2", 1), ("3", 0), ("4", 0)] {
        let run = hyperplan(&["solve", task, "--bound", bound, "--quiet"]);
        assert_eq!(run.status, status, "{bound}: {}{}", run.stdout, run.stderr);
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let plan = folder.path().join("bomb.pddl");
    let run = hyperplan(&["solve", task, "--bound", "3", "--save", text(&plan)]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    // What is saved is a plan, not a task, though their names end alike.
    let run = hyperplan(&["verify", task, text(&plan), "--bound", "3"]);
    assert_eq!(run.status, 0, "{}{}", run.stdout, run.stderr);
    for (arguments, said) in [
        (vec!["solve", task], "say it with `--bound K`"),
        (vec!["solve", task, "--bound", "3", "--semantics", "pes"], "semantics are for formulas"),
        (vec!["solve", task, "import/pass/names.hq", "--bound", "3"], "stands alone"),
    ] {
        let run = hyperplan(&arguments);
        assert!(run.status == 2 && run.stderr.contains(said), "{arguments:?}: {}", run.stderr);
    }
}
