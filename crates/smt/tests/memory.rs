//! What the writer takes for itself, beyond the terms: little for each node, and nothing for each byte.

use std::io;

use hyperplan_smt::{Script, Sort, Term, Terms, WriteOptions, write_script};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The buffer, and what is there for any script.
const FIXED: usize = 200_000;
/// For each node of a script without quantifiers: how often it is used, whether it is named, how deep it is.
const PER_NODE: usize = 4;
/// With quantifiers, also which variables are free in it, what is bound by `let`, and a stack as deep as the term.
const QUANTIFIED: usize = 50;

/// Takes what is written, and counts it.
struct Sink(usize);

impl io::Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes a script; how long it is, and what that took at most.
fn cost(script: &Script) -> (usize, usize) {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let mut sink = Sink(0);
    write_script(&mut sink, script, &WriteOptions::default()).expect("a sink takes everything");
    (sink.0, MEMORY.peak_usage() - before)
}

fn booleans(terms: &mut Terms, count: u32) -> Vec<Term> {
    let stem = terms.stem("x");
    (0..count).map(|time| terms.symbol(stem, Some(time), Sort::Bool)).collect()
}

fn many_literals() {
    let mut script = Script::new();
    let x = booleans(&mut script.terms, 1000);
    for i in 0..2_500_000 {
        script.clause(&[x[i % 1000], !x[(i + 1) % 1000], x[(i + 7) % 1000], !x[(i + 500) % 1000]]);
    }
    let (length, memory) = cost(&script);
    assert!(length > 80_000_000, "{length}");
    assert!(memory < FIXED + PER_NODE * script.terms.len(), "{memory}");
}

/// A term that is used once at each depth, which is cut by definitions, and one that is used twice.
fn deep_terms() {
    for twice in [false, true] {
        let mut script = Script::new();
        let x = booleans(&mut script.terms, 1000);
        let mut t = x[0];
        for i in 1..1_000_000 {
            let other = if twice { script.terms.and2(t, x[i % 1000]) } else { x[i % 1000] };
            t = script.terms.iff(!t, other);
        }
        script.assert(t);
        let (length, memory) = cost(&script);
        assert!(length > 10_000_000, "{length}");
        assert!(memory < FIXED + PER_NODE * script.terms.len(), "{memory}");
    }
}

fn a_wide_term() {
    let mut script = Script::new();
    let x = booleans(&mut script.terms, 1_000_000);
    let wide = script.terms.and(&x);
    script.assert(!wide);
    let (_, memory) = cost(&script);
    assert!(memory < FIXED + PER_NODE * script.terms.len(), "{memory}");
}

/// Under a quantifier nothing can be cut by definitions.
fn a_deep_term_under_quantifiers() {
    let mut script = Script::new();
    let x = booleans(&mut script.terms, 1000);
    let stem = script.terms.stem("y");
    let [outer, inner] = [0, 1].map(|time| script.terms.bound_symbol(stem, Some(time), Sort::Bool));
    let mut t = inner;
    for i in 1..1_000_000 {
        let other = if i % 2 == 0 { x[i % 1000] } else { outer };
        t = script.terms.iff(t, other);
    }
    let inside = script.terms.exists(&[inner], t);
    let all = script.terms.forall(&[outer], inside);
    script.assert(all);
    let (length, memory) = cost(&script);
    assert!(length > 5_000_000, "{length}");
    assert!(memory < FIXED + QUANTIFIED * script.terms.len(), "{memory}");
}

/// One after the other: what is measured is of the whole process.
#[test]
fn memory_does_not_grow_with_the_text() {
    many_literals();
    deep_terms();
    a_wide_term();
    a_deep_term_under_quantifiers();
}
