//! The writer alone, into nothing: `cargo bench -p hyperplan-smt`. Real queries are written by the benchmark `stages`
//! of the command.

use std::io;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use hyperplan_smt::{Script, Sort, Term, WriteOptions, write_script};

/// Clauses of three literals over the cells of a map at each time.
fn clauses() -> Script {
    let mut script = Script::new();
    let cells: Vec<Vec<Term>> = (0..100)
        .map(|cell| {
            let stem = script.terms.stem(&format!("p.at({},{})", cell % 10, cell / 10));
            (0..100).map(|time| script.terms.symbol(stem, Some(time), Sort::Bool)).collect()
        })
        .collect();
    for time in 1..100 {
        for cell in 0..100 {
            for step in [1, 10, 90, 99] {
                let (here, next) = (cells[cell][time - 1], cells[(cell + step) % 100][time]);
                script.clause(&[!here, next, cells[cell][time]]);
            }
        }
    }
    script
}

/// A formula whose parts at each time are shared.
fn shared() -> Script {
    let mut script = Script::new();
    let (stem, flag) = (script.terms.stem("p.x"), script.terms.stem("p.held"));
    let mut held = Term::TRUE;
    for time in 0..20_000 {
        let x = script.terms.symbol(stem, Some(time), Sort::BitVec(8));
        let bound = script.terms.bv(i128::from(time % 200), 8);
        let below = script.terms.bv_ult(x, bound);
        let both = script.terms.and2(below, held);
        let now = script.terms.symbol(flag, Some(time), Sort::Bool);
        held = script.terms.iff(both, now);
        script.assert(held);
    }
    script
}

/// The same under quantifiers, one for each of a few paths.
fn quantified() -> Script {
    let mut script = Script::new();
    let name = script.terms.stem("q.x");
    for path in 0..20 {
        let times = path * 1000..(path + 1) * 1000;
        let bound: Vec<Term> =
            times.map(|time| script.terms.bound_symbol(name, Some(time), Sort::Bool)).collect();
        let mut held = Term::TRUE;
        for pair in bound.windows(2) {
            let both = script.terms.and2(pair[0], held);
            held = script.terms.iff(both, pair[1]);
        }
        let all = script.terms.forall(&bound, held);
        script.assert(all);
    }
    script
}

fn write(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("write");
    for (name, script) in [("clauses", clauses()), ("shared", shared()), ("quantified", quantified())] {
        let options = WriteOptions::default();
        let mut text = Vec::new();
        write_script(&mut text, &script, &options).expect("a vector takes everything");
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(name, |b| b.iter(|| write_script(&mut io::sink(), &script, &options)));
    }
    group.finish();
}

criterion_group!(benches, write);
criterion_main!(benches);
