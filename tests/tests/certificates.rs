//! Certificates that there is no strategy (or no counterexample): of random problems, against brute force, and of the case
//! studies; and what is damaged proves nothing.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of problems. `veripb` checks some too, where it is
//! installed.

use hyperplan_certify::{
    self as certify, Action, Branch, Certificate, Checked, Checker, Encoder, Instance, Start, Step, dimacs,
    pseudo_boolean,
};
use hyperplan_plan::{Config, Unproved, Verdict, prove, solve};
use hyperplan_problem::{Objective, Overrides, PathId, Problem, Quantifier, Type, Value, Var, read};
use hyperplan_solver::{Deadline, Refuter, Spec};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::{fixture, lowered};
use hyperplan_tests::mixed::Mixed;
use hyperplan_tests::model;
use hyperplan_tests::random::{Random, problem};
use hyperplan_tests::{number, say};
use std::fs::File;
use std::io::{BufReader, Cursor};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn never() -> bool {
    false
}

fn folder() -> TempDir {
    tempfile::tempdir().expect("there is room for temporary files")
}

/// A certificate with its refutation as text.
struct Made {
    branches: Vec<Branch>,
    refutation: Vec<u8>,
}

impl Made {
    fn new(problem: &Problem, objective: &Objective) -> Result<Made, Unproved> {
        let proved = prove(problem, objective, &Deadline::never())?;
        let mut refutation = Vec::new();
        proved.refutation(&mut refutation).expect("to memory");
        Ok(Made { branches: proved.branches, refutation })
    }

    fn check(&self, problem: &Problem, objective: &Objective) -> Result<Checked, certify::Error> {
        certify::check(problem, objective, &self.branches, &mut Cursor::new(&self.refutation), &never)
    }

    /// The clauses, a 0 behind each.
    fn clauses(&self, problem: &Problem, objective: &Objective) -> Vec<i32> {
        let mut text = Vec::new();
        dimacs(problem, objective, &self.branches, &mut text, &never).expect("it was encoded before");
        let text = String::from_utf8(text).expect("numbers");
        let numbers = text.lines().skip(1).flat_map(str::split_ascii_whitespace);
        numbers.map(|number| number.parse().expect("a number")).collect()
    }
}

fn seeds(cases: u64) -> impl Iterator<Item = u64> {
    let first = number("HYPERPLAN_SEED", 20_260_101);
    let cases = number("HYPERPLAN_CASES", cases);
    say(&format!("seed {first}, {cases} cases"));
    (0..cases).map(move |i| first.wrapping_add(i))
}

/// A random problem with what brute force says of it.
fn random(seed: u64) -> (model::Problem, bool, String) {
    let random = problem(&mut Random::new(seed));
    let verdict = Brute::new(&random, usize::MAX / 8).expect("no limit").verdict();
    let text = fixture(&random.to_string(), verdict);
    (random, verdict, text)
}

/// A random claim that is true, and its certificate.
struct Case {
    seed: u64,
    model: model::Problem,
    text: String,
    typed: Problem,
    made: Made,
}

impl Case {
    fn objective(&self) -> &Objective {
        &self.typed.objectives[0]
    }
}

/// Random claims that are true, each with its certificate.
fn true_claims(cases: u64) -> impl Iterator<Item = Case> {
    seeds(cases).filter_map(|seed| {
        let (model, verdict, text) = random(seed);
        if verdict == model.exists[0] {
            return None;
        }
        let typed = lowered(&text);
        let made = Made::new(&typed, &typed.objectives[0]);
        let made = made.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        Some(Case { seed, model, text, typed, made })
    })
}

#[test]
fn what_brute_force_refutes_is_certified_and_nothing_else() {
    let (mut certificates, mut instances, mut wrong) = (0, 0, 0);
    for seed in seeds(1000) {
        let (random, verdict, text) = random(seed);
        let typed = lowered(&text);
        let objective = &typed.objectives[0];
        // A leading `exists` is certified where it fails, a leading `forall` where it holds.
        let certifiable = verdict != random.exists[0];
        match Made::new(&typed, objective) {
            Ok(made) => {
                assert!(certifiable, "seed {seed}: a wrong claim was refuted\n{text}");
                let checked = made.check(&typed, objective);
                let checked = checked.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
                certificates += 1;
                instances += checked.instances;
            }
            Err(error) => {
                assert!(!certifiable, "seed {seed}: {error}\n{text}");
                let said = error.to_string();
                assert!(
                    said.contains("there is what it says that there is not"),
                    "seed {seed}: {said}\n{text}"
                );
                wrong += 1;
            }
        }
    }
    say(&format!("{certificates} certificates with {instances} instances, {wrong} wrong claims"));
    let all = certificates + wrong;
    assert!(all < 100 || 5 * certificates.min(wrong) >= all, "one kind is less than a fifth of all");
}

/// The planner's word against a certificate: a `no` that is wrong cannot have one.
#[test]
fn every_no_of_the_planner_is_certified() {
    let config = Config::new(Spec::Builtin);
    let mut count = 0;
    for seed in seeds(300) {
        for text in [random(seed).2, Mixed::alternating(&mut Random::new(seed)).text(true)] {
            let typed = lowered(&text);
            let objective = &typed.objectives[0];
            let outcome =
                solve(&typed, objective, &config).unwrap_or_else(|e| panic!("seed {seed}: {e}\n{text}"));
            let exists = objective.paths.first().is_some_and(|path| path.quantifier == Quantifier::Exists);
            let no = if exists { Verdict::Unrealizable } else { Verdict::Realizable };
            if outcome.verdict == no {
                let made =
                    Made::new(&typed, objective).unwrap_or_else(|e| panic!("seed {seed}: {e}\n{text}"));
                let checked = made.check(&typed, objective);
                checked.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
                count += 1;
            }
        }
    }
    assert!(count > 0, "nothing was certified");
}

/// Whether clauses have a model.
fn has_model(clauses: &[i32]) -> bool {
    let mut sat = Refuter::new(&Deadline::never()).expect("this build has one");
    sat.add(clauses);
    sat.solve().expect("there is no deadline").is_some()
}

/// Whether the refutation is accepted for these clauses.
fn accepted(clauses: &[i32], refutation: &[u8]) -> bool {
    let mut checker = Checker::default();
    for clause in clauses.split_inclusive(|literal| *literal == 0) {
        checker.clause(&clause[..clause.len() - 1]).expect("they are few");
    }
    checker.check(&mut Cursor::new(refutation), &never).is_ok()
}

/// The branches without one and what comes after it.
fn without(branches: &[Branch], gone: usize) -> Vec<Branch> {
    let (mut left, mut places) = (Vec::new(), vec![Some(0)]);
    for (at, branch) in branches.iter().enumerate() {
        let after = places[branch.after].filter(|_| at != gone);
        left.extend(after.map(|after| Branch { after, ..branch.clone() }));
        places.push(after.map(|_| left.len()));
    }
    left
}

#[test]
fn what_is_damaged_proves_nothing_wrong() {
    let (mut refused, mut true_still) = (0, 0);
    for case in true_claims(200) {
        let (objective, Case { seed, model: random, text, typed, made }) = (case.objective(), &case);
        let seed = *seed;
        let (clauses, mut dice) = (made.clauses(typed, objective), Random::new(seed));
        // A clause less: refused unless the others have no model either.
        let starts: Vec<usize> = (0..clauses.len()).filter(|&at| at == 0 || clauses[at - 1] == 0).collect();
        for _ in 0..5 {
            let start = starts[dice.below(starts.len())];
            let length = clauses[start..].iter().position(|literal| *literal == 0).expect("it ends") + 1;
            let left = [&clauses[..start], &clauses[start + length..]].concat();
            // In its place one that says nothing, so that the others keep their numbers.
            let tautology = [&clauses[..start], &[1, -1, 0], &clauses[start + length..]].concat();
            if has_model(&left) {
                assert!(!accepted(&tautology, &made.refutation), "seed {seed}: without a clause\n{text}");
                refused += 1;
            } else {
                true_still += 1;
            }
        }
        // The proof is cut, or has another number somewhere.
        let lines: Vec<&[u8]> = made.refutation.split_inclusive(|byte| *byte == b'\n').collect();
        // An empty clause needs no proof.
        if let Some(end) = lines.len().checked_sub(1).filter(|_| !accepted(&clauses, b"")) {
            let cut = lines[..dice.below(end + 1)].concat();
            assert!(!accepted(&clauses, &cut), "seed {seed}: cut\n{text}");
            let mut changed = made.refutation.clone();
            let digits: Vec<usize> = (0..changed.len()).filter(|&at| changed[at].is_ascii_digit()).collect();
            changed[digits[dice.below(digits.len())]] = b'0' + u8::try_from(dice.below(10)).expect("a digit");
            if has_model(&clauses) {
                assert!(!accepted(&clauses, &changed), "seed {seed}: changed\n{text}");
            }
        }
        // Instances less or more: whatever is accepted, the claim is true, and the refutation belongs to its clauses.
        for at in 0..made.branches.len() {
            let other = Made { branches: without(&made.branches, at), refutation: made.refutation.clone() };
            if has_model(&other.clauses(typed, objective)) {
                assert!(other.check(typed, objective).is_err(), "seed {seed}: without an instance\n{text}");
                refused += 1;
            }
        }
        // Another problem, of which the claim is wrong.
        for other in (0..20).map(|i| seed.wrapping_add(1000 + i)) {
            let (model, verdict, text) = self::random(other);
            if verdict == model.exists[0] && model.exists == random.exists {
                let typed = lowered(&text);
                assert!(made.check(&typed, &typed.objectives[0]).is_err(), "seeds {seed}, {other}\n{text}");
                refused += 1;
            }
        }
    }
    say(&format!("{refused} refused, {true_still} not needed"));
    assert!(refused > 100, "hardly anything was damaged");
}

/// Instances of the other player's blocks, as they come: what is none of its path is left out.
fn any_instances(
    dice: &mut Random,
    problem: &Problem,
    objective: &Objective,
    steps: &[usize],
) -> Vec<Branch> {
    let (blocks, mut branches, mut depths) = (objective.blocks(), Vec::new(), vec![1]);
    for _ in 0..12 {
        let after = dice.below(depths.len());
        let Some(block) = blocks.get(depths[after]) else { continue };
        let instances =
            block.iter().map(|&path| any_instance(dice, problem, objective, path, steps)).collect();
        branches.push(Branch { after, instances });
        let mut encoder = Encoder::new(problem, objective, &never).expect("it is finite");
        match encoder.tree(&branches) {
            Ok(()) => depths.push(depths[after] + 2),
            Err(_) => drop(branches.pop()),
        }
    }
    branches
}

fn any_instance(
    dice: &mut Random,
    problem: &Problem,
    objective: &Objective,
    path: PathId,
    steps: &[usize],
) -> Instance {
    let system = &problem.systems[objective.paths[path].system];
    let (own, before) = (usize::from(path), |dice: &mut Random, n| PathId::from(dice.below(n)));
    let (start, begun) = match own > 0 && !dice.once_in(3) {
        true => {
            let other = before(dice, own);
            let begun = dice.below(steps[own].min(steps[usize::from(other)]) + 1);
            (Start::Along(other, u32::try_from(begun).expect("few")), begun)
        }
        false => {
            let value = |var: &Var| match &var.ty {
                Type::Bool => Value::Bool(dice.flip()),
                Type::Enum(names) => Value::Enum(u32::try_from(dice.below(names.len())).expect("few")),
                Type::Range { lo, .. } => Value::Int(lo + i64::try_from(dice.below(2)).expect("few")),
                Type::Int | Type::Real => unreachable!("random systems are finite"),
            };
            (Start::State(system.vars.iter().map(value).collect()), 0)
        }
    };
    let step = |_| {
        let action = match own > 0 && dice.flip() {
            true => Action::Like(before(dice, own)),
            false => Action::Is(system.actions[dice.below(system.actions.len())]),
        };
        Step { action, outcome: dice.bound(2) }
    };
    Instance { path, start, steps: (begun..steps[own]).map(step).collect() }
}

/// Whatever the instances are, and whoever chose them: where there is what a claim says that there is not, the clauses have a
/// model.
#[test]
fn no_instances_refute_what_is_wrong() {
    let (mut wrong, mut instances) = (0, 0);
    for seed in seeds(1000) {
        let (model, verdict, text) = random(seed);
        if verdict != model.exists[0] {
            continue;
        }
        let typed = lowered(&text);
        let objective = &typed.objectives[0];
        let steps = horizons(&typed, objective);
        let branches = any_instances(&mut Random::new(seed), &typed, objective, &steps);
        let mut encoder = Encoder::new(&typed, objective, &never).expect("it is finite");
        encoder.tree(&branches).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        assert!(has_model(&encoder.take()), "seed {seed}: {branches:?}\n{text}");
        wrong += 1;
        instances += branches.len();
    }
    say(&format!("{wrong} wrong claims, {instances} instances of their other player"));
    assert!(2 * instances > wrong, "hardly any instance");
}

/// An instance may begin in one of several states, of which some are hopeless: what holds in those says nothing of the others.
#[test]
fn where_an_instance_is_not_says_nothing() {
    let text = "system M { state x: 0..2; action go, stay, wait; on go when x == 0 { x' = 1; } on go when x > 0 {} on stay | wait {}
        init x != 1; }
        // o: realizable
        objective o within 2 {
          exists p, r. forall q. x[p] == x[q] & G action[q] == action[r] -> F x[q] == 1
        }";
    let typed = lowered(text);
    let objective = &typed.objectives[0];
    assert_eq!(
        solve(&typed, objective, &Config::new(Spec::Builtin)).expect("small").verdict,
        Verdict::Realizable
    );
    let (p, r, q) = (PathId::from(0), PathId::from(1), PathId::from(2));
    let go = typed.systems[objective.paths[q].system].actions[0];
    for action in [Action::Like(r), Action::Is(go)] {
        let instance =
            Instance { path: q, start: Start::Along(p, 0), steps: vec![Step { action, outcome: 0 }; 2] };
        let branches = [Branch { after: 0, instances: vec![instance] }];
        let mut encoder = Encoder::new(&typed, objective, &never).expect("it is finite");
        encoder.tree(&branches).expect("it is an instance");
        assert!(has_model(&encoder.take()), "a wrong claim is refuted by {branches:?}");
    }
}

/// The last times at which paths are read.
fn horizons(problem: &Problem, objective: &Objective) -> Vec<usize> {
    let outcome = solve(problem, objective, &Config::new(Spec::Builtin)).expect("it is small");
    outcome.horizons.iter().map(|steps| usize::try_from(steps.unwrap_or(0)).expect("few")).collect()
}

fn case_study(objective: &str, size: u32, horizon: u32) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../specs/case-studies");
    let name = format!("{objective}-{size}.hp");
    let text = std::fs::read_to_string(folder.join(&name)).expect("the specs are there");
    let loader = |path: &str| std::fs::read(folder.join(path)).map_err(|e| e.to_string());
    let overrides = Overrides::none().with("T", i64::from(horizon));
    let lowered = read(&mut SourceMap::new(), &name, &text, &loader, &overrides);
    assert!(!lowered.has_errors(), "{name}: {:?}", lowered.diagnostics);
    lowered.problem
}

/// Objective, size, and one below the least T.
const STUDIES: [(&str, u32, u32); 10] = [
    ("sp", 10, 15),
    ("isr", 10, 14),
    ("ar", 10, 15),
    ("iso", 10, 13),
    ("cso", 10, 9),
    ("sp", 20, 31),
    ("isr", 20, 34),
    ("ar", 20, 32),
    ("iso", 20, 28),
    ("cso", 20, 19),
];

const LARGE: [(&str, u32, u32); 10] = [
    ("sp", 40, 71),
    ("isr", 40, 74),
    ("ar", 40, 71),
    ("iso", 40, 58),
    ("cso", 40, 39),
    ("sp", 60, 111),
    ("isr", 60, 114),
    ("ar", 60, 111),
    ("iso", 60, 88),
    ("cso", 60, 59),
];

fn studies(all: &[(&str, u32, u32)]) {
    let veripb = veripb();
    for &(objective, size, horizon) in all {
        let problem = case_study(objective, size, horizon);
        let what = format!("{objective}-{size}, T = {horizon}");
        let objective = &problem.objectives[0];
        let made = Made::new(&problem, objective).unwrap_or_else(|error| panic!("{what}: {error}"));
        let checked = made.check(&problem, objective).unwrap_or_else(|error| panic!("{what}: {error}"));
        say(&format!("{what}: {checked:?}"));
        if let Some(veripb) = &veripb {
            assert!(by_veripb(veripb, &made, &problem, objective), "{what}: veripb refuses it");
        }
    }
}

#[test]
fn case_studies_below_the_least_horizon() {
    studies(&STUDIES);
}

#[test]
#[ignore = "takes minutes"]
fn large_case_studies_below_the_least_horizon() {
    studies(&LARGE);
}

/// Where `veripb` is installed.
fn veripb() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let found = std::env::split_paths(&path).map(|folder| folder.join("veripb")).find(|file| file.is_file());
    if found.is_none() {
        say("veripb is missing: skipped");
    }
    found
}

fn by_veripb(veripb: &Path, made: &Made, problem: &Problem, objective: &Objective) -> bool {
    let folder = folder();
    let (formula, proof) = (folder.path().join("a.cnf"), folder.path().join("a.pbp"));
    let create = |path: &Path| File::create(path).expect("the folder is ours");
    let count =
        dimacs(problem, objective, &made.branches, &mut create(&formula), &never).expect("it was encoded");
    let mut refutation = BufReader::new(Cursor::new(&made.refutation));
    pseudo_boolean(&mut refutation, count, &mut create(&proof)).expect("it was checked before");
    let output = Command::new(veripb).arg("--cnf").args([&formula, &proof]).output().expect("it runs");
    String::from_utf8_lossy(&output.stdout).contains("s VERIFIED UNSATISFIABLE")
}

/// Both checkers accept certificates of random problems, of several alternations too.
#[test]
fn another_checker_accepts_them_too() {
    let Some(veripb) = veripb() else { return };
    let (mut accepted, mut alternating, mut instances) = (0, 0, 0);
    for case in true_claims(100) {
        let (seed, text, typed, objective) = (case.seed, &case.text, &case.typed, case.objective());
        let checked = case.made.check(typed, objective);
        let checked = checked.unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        assert!(by_veripb(&veripb, &case.made, typed, objective), "seed {seed}\n{text}");
        accepted += 1;
        alternating += u64::from(objective.blocks().len() > 2);
        instances += checked.instances;
    }
    say(&format!("{accepted} accepted, {alternating} of three and more blocks, {instances} instances"));
}

#[test]
fn a_certificate_is_for_one_problem() {
    let (mut others, mut found) = (0, 0);
    for case in true_claims(60) {
        let (objective, Case { seed, text, typed, made, .. }) = (case.objective(), &case);
        let own =
            Certificate::new(typed, objective, Vec::new(), &made.branches, &never).expect("it was encoded");
        // As a file and back.
        let (folder, mut written) = (folder(), Vec::new());
        own.write(&mut written).expect("to memory");
        let file = folder.path().join("o.json");
        std::fs::write(&file, &written).expect("the folder is ours");
        let own = Certificate::read(&file).expect("it was written");
        let check = |problem: &Problem| {
            own.check(problem, &problem.objectives[0], &mut Cursor::new(&made.refutation), &never)
        };
        check(typed).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        let same = own.branches(typed, objective).expect("it was read");
        assert_eq!(same, made.branches, "seed {seed}\n{text}");
        found += 1;
        let other = lowered(&self::random(seed.wrapping_add(1)).2);
        assert!(check(&other).is_err(), "seed {seed}: for another problem\n{text}");
        others += 1;
    }
    assert!(others == found && found > 0, "there are no certificates");
}
