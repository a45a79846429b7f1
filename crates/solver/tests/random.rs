//! All solvers against brute force, on random scripts that grow between checks under assumptions.

mod common;

use common::{Growing, installed};
use hyperplan_random::Random;
use hyperplan_smt::Term;
use hyperplan_solver::{Answer, Catalog, Deadline, Options, Spec, discover, open};
use std::path::Path;

fn agrees(spec: &Spec, seeds: std::ops::Range<u64>) {
    let options = Options { incremental: true, ..Options::default() };
    let (mut sat, mut unsat) = (0, 0);
    for seed in seeds {
        let mut random = Random::new(seed);
        let mut growing = Growing::new();
        let mut session = open(spec, &options).expect("it is installed");
        for round in 0..6 {
            let context = format!("{spec:?}, seed {seed}, round {round}");
            for _ in 0..12 {
                growing.step(&mut random);
            }
            growing.assert_some(&mut random);
            let assumptions: Vec<Term> = (0..random.below(3)).map(|_| growing.pick(&mut random)).collect();
            let answer = session.check(&growing.script, &assumptions, &Deadline::never()).expect(&context);
            if growing.brute_force(&assumptions) {
                assert_eq!(answer, Answer::Sat, "{context}");
                growing.check_model(session.as_mut(), &assumptions, &context);
                sat += 1;
            } else {
                assert_eq!(answer, Answer::Unsat, "{context}");
                assert!(session.values(&growing.script, &growing.symbols).is_err(), "{context}");
                unsat += 1;
            }
        }
    }
    assert!(sat > 20 && unsat > 20, "{sat} sat, {unsat} unsat: too one-sided");
}

#[test]
fn back_ends_agree_with_brute_force() {
    for spec in Spec::backends() {
        agrees(&spec, 0..600);
    }
}

#[test]
fn external_solvers_agree_with_brute_force() {
    for name in installed(&["z3", "cvc5", "yices"]) {
        agrees(&Spec::Profile(name), 0..40);
    }
}

#[test]
fn solvers_of_bits_agree_with_brute_force() {
    for name in installed(&["depqbf", "cryptominisat", "minisat", "picosat", "clasp"]) {
        agrees(&Spec::Profile(name), 0..20);
    }
    // These come with no system.
    let optional = ["caqe", "qute", "rareqs", "kissat", "glucose"];
    for solver in discover().into_iter().filter(|solver| optional.contains(&solver.name.as_str())) {
        if solver.path.is_some() {
            agrees(&Spec::Profile(solver.name), 0..20);
        }
    }
}

/// Assumptions between push and pop, a process for each check, and queries in files.
#[test]
fn other_ways_to_ask_agree_with_brute_force() {
    let mut catalog = Catalog::default();
    for name in installed(&["z3", "cvc5", "yices"]) {
        let entries = format!(
            "[[solver]]\nname = \"push-{name}\"\nlike = \"{name}\"\nassumptions = \"push\"\n\
             [[solver]]\nname = \"once-{name}\"\nlike = \"{name}\"\nincremental = false\n"
        );
        catalog.add(Path::new("hyperplan.toml"), &entries).expect("it is good");
        agrees(&catalog.spec(&format!("push-{name}")).expect("it was added"), 0..12);
        agrees(&catalog.spec(&format!("once-{name}")).expect("it was added"), 0..12);
    }
    for (name, line) in [("z3", "z3 {file}"), ("cvc5", "cvc5 -m {file}"), ("yices", "yices-smt2 {file}")] {
        if !installed(&[name]).is_empty() {
            agrees(&line.parse().expect("a command line"), 0..12);
        }
    }
}
