//! Large and awkward scripts through real solvers, and the embedded engine's limits.

mod common;
#[path = "common/pigeons.rs"]
mod pigeons;

use std::time::{Duration, Instant};

use common::installed;
use hyperplan_smt::{Script, Sort, Term, Terms};
use hyperplan_solver::{Answer, Deadline, Error, Options, Spec, Unknown, open};
use pigeons::pigeons;

fn booleans(terms: &mut Terms, count: u32) -> Vec<Term> {
    let stem = terms.stem("x");
    (0..count).map(|i| terms.symbol(stem, Some(i), Sort::Bool)).collect()
}

/// A term that is `levels` deep and true exactly if `x` ends right.
fn deep(terms: &mut Terms, levels: u32) -> Term {
    let xs = booleans(terms, 4);
    let mut t = xs[0];
    for i in 0..levels {
        let x = xs[1 + (i % 3) as usize];
        t = if i % 2 == 0 { terms.iff(t, x) } else { terms.ite(x, t, !t) };
    }
    t
}

fn shared(terms: &mut Terms, levels: u32) -> Term {
    let xs = booleans(terms, levels);
    xs.iter().fold(xs[0], |t, &x| {
        let (a, b) = (terms.and2(t, x), terms.or2(t, !x));
        terms.iff(a, b)
    })
}

fn answer(spec: &Spec, options: &Options, script: &Script) -> Answer {
    let mut session = open(spec, options).expect("it is installed");
    session.check(script, &[], &Deadline::after(Duration::from_secs(120))).expect("an answer")
}

#[test]
fn a_million_levels_in_the_engine() {
    let mut script = Script::new();
    let t = deep(&mut script.terms, 1_000_000);
    script.assert(t);
    for spec in Spec::backends() {
        assert_eq!(answer(&spec, &Options::default(), &script), Answer::Sat, "{spec:?}");
    }
}

#[test]
fn a_million_levels_are_written() {
    let mut script = Script::new();
    let t = deep(&mut script.terms, 1_000_000);
    script.assert(t);
    let mut sink = std::io::sink();
    hyperplan_smt::write_script(&mut sink, &script, &hyperplan_smt::WriteOptions::default()).expect("a sink");
}

#[test]
fn deep_and_shared_terms_through_solvers() {
    let mut script = Script::new();
    let t = deep(&mut script.terms, 3000);
    let u = shared(&mut script.terms, 200);
    script.assert(t);
    script.assert(!u);
    script.assert(u);
    for name in installed(&["z3", "cvc5", "yices"]) {
        assert_eq!(answer(&Spec::Profile(name), &Options::default(), &script), Answer::Unsat);
    }
}

#[test]
fn shared_terms_under_a_binder() {
    let mut script = Script::new();
    let stem = script.terms.stem("v");
    let v: Vec<Term> = (0..3).map(|i| script.terms.bound_symbol(stem, Some(i), Sort::Bool)).collect();
    let x = booleans(&mut script.terms, 1)[0];
    let mut t = x;
    // Printed without sharing this would have 3^40 leaves.
    for &v in v.iter().cycle().take(40) {
        let (a, b) = (script.terms.xor(t, v), script.terms.or2(t, v));
        t = script.terms.ite(v, a, b);
    }
    let all = script.terms.exists(&v, t);
    script.assert(all);
    let options = Options { quantified: true, ..Options::default() };
    for name in installed(&["z3", "cvc5"]) {
        assert_eq!(answer(&Spec::Profile(name), &options, &script), Answer::Sat);
    }
}

#[test]
fn one_shot_yices_answers_exists_forall_again() {
    for name in installed(&["yices"]) {
        let mut script = Script::new();
        let stem = script.terms.stem("v");
        let v = script.terms.bound_symbol(stem, None, Sort::BitVec(4));
        let w = script.terms.symbol(stem, None, Sort::BitVec(4));
        let le = script.terms.bv_ule(w, v);
        let least = script.terms.forall(&[v], le);
        script.assert(least);
        let options = Options { quantified: true, incremental: true, ..Options::default() };
        let mut session = open(&Spec::Profile(name), &options).expect("it is installed");
        let check = session.check(&script, &[], &Deadline::never()).expect("an answer");
        assert_eq!(check, Answer::Sat);
        let values = session.values(&script, &[w]).expect("values");
        assert_eq!(values[0].as_unsigned(), Some(0));
        let zero = script.terms.bv(0, 4);
        let nonzero = !script.terms.eq(w, zero);
        let check = session.check(&script, &[nonzero], &Deadline::never()).expect("an answer");
        assert_eq!(check, Answer::Unsat);
    }
}

#[test]
fn integers_and_reals() {
    for name in installed(&["z3", "cvc5", "yices"]) {
        let mut script = Script::new();
        let (n, r) = (script.terms.stem("n"), script.terms.stem("r"));
        let n = script.terms.symbol(n, None, Sort::Int);
        let (three, minus) = (script.terms.int(3), script.terms.int(-7));
        let sum = script.terms.int_mul(2, n);
        let below = script.terms.lt(sum, minus);
        let rest = script.terms.int_mod(n, 5);
        let rest = script.terms.eq(rest, three);
        let low = script.terms.int(-9);
        let low = script.terms.le(low, n);
        script.clause(&[below]);
        script.clause(&[rest]);
        script.clause(&[low]);
        let r = script.terms.symbol(r, None, Sort::Real);
        let three = hyperplan_smt::Rational::from(3);
        let triple = script.terms.real_mul(three, r);
        let one = script.terms.real(hyperplan_smt::Rational::from(-1));
        let third = script.terms.eq(triple, one);
        script.assert(third);
        let mut session = open(&Spec::Profile(name.clone()), &Options::default()).expect("it is installed");
        let check = session.check(&script, &[], &Deadline::never()).expect("an answer");
        assert_eq!(check, Answer::Sat, "{name}");
        let values = session.values(&script, &[n, r]).expect("values");
        assert_eq!(values[0].as_signed(), Some(-7), "{name}");
        assert_eq!(hyperplan_smt::value_text(&script.terms, values[1]), "(- (/ 1.0 3.0))", "{name}");
        let builtin = open(&Spec::Builtin, &Options::default());
        let check = builtin.and_then(|mut session| session.check(&script, &[], &Deadline::never()));
        assert!(matches!(check, Err(Error::Unsupported { .. })));
    }
}

#[test]
fn the_engine_stops_at_the_deadline() {
    let script = pigeons(11);
    for spec in Spec::backends() {
        let mut session = open(&spec, &Options { seed: 7, ..Options::default() }).expect("it is built in");
        let start = Instant::now();
        let answer =
            session.check(&script, &[], &Deadline::after(Duration::from_millis(300))).expect("no error");
        assert_eq!(answer, Answer::Unknown(Unknown::Timeout), "{spec:?}");
        // Some tens of milliseconds late where nothing else runs.
        assert!(start.elapsed() < Duration::from_secs(10), "{spec:?}: {:?}", start.elapsed());
        assert!(matches!(session.values(&script, &[]), Err(Error::NoModel { .. })), "{spec:?}");
    }
}

#[test]
fn the_engine_refuses_quantifiers_for_good() {
    let mut script = Script::new();
    let stem = script.terms.stem("v");
    let v = script.terms.bound_symbol(stem, None, Sort::Bool);
    let x = booleans(&mut script.terms, 1)[0];
    let body = script.terms.or2(v, x);
    let all = script.terms.forall(&[v], body);
    script.assert(all);
    let mut session = open(&Spec::Builtin, &Options::default()).expect("it is built in");
    for _ in 0..2 {
        let error = session.check(&script, &[], &Deadline::never()).expect_err("quantified");
        assert!(error.is_unsupported() && error.to_string().contains("z3"), "{error}");
    }
}

#[test]
fn a_session_knows_how_much_it_was_told() {
    let mut specs: Vec<Spec> = installed(&["z3", "cvc5", "yices"]).into_iter().map(Spec::Profile).collect();
    specs.extend(Spec::backends());
    for spec in specs {
        let mut script = Script::new();
        let xs = booleans(&mut script.terms, 5);
        let options = Options { incremental: true, ..Options::default() };
        let mut session = open(&spec, &options).expect("it is installed");
        let mut told = Vec::new();
        for pair in xs[..4].chunks(2) {
            script.clause(pair);
            session.check(&script, &[], &Deadline::never()).expect("an answer");
            told.push(session.size());
        }
        // The engine has a variable and a clause of its own, for what is true.
        let own = usize::from(spec.is_embedded());
        let expected = [(1, 2), (2, 4)];
        let sizes: Vec<_> = told.iter().map(|told| (told.clauses, told.variables)).collect();
        assert_eq!(sizes, expected.map(|(c, v)| (c + own, v + own)), "{spec:?}");
        for told in &told {
            let is_text = !spec.is_embedded();
            assert_eq!((told.bytes > 0, told.logic.is_some()), (is_text, is_text), "{spec:?}");
        }
        assert!(spec.is_embedded() || told[0].bytes < told[1].bytes, "{spec:?}");
    }
}
