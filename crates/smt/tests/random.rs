//! Random expressions: folding, the evaluator and a direct interpreter agree.

mod pool;

use hyperplan_random::property;
use hyperplan_smt::{Evaluation, Sort, Term, Terms};
use pool::{Pool, to_value};

#[test]
fn folding_and_evaluation_agree_with_the_interpreter() {
    property(1000, 3000, |random| {
        let pool = Pool::grown(random, 120);
        let evaluation = Evaluation::new(&pool.terms, &pool.model);
        for sample in &pool.samples {
            let expected = to_value(sample.value);
            assert_eq!(pool.terms.sort(sample.open), expected.sort());
            assert_eq!(pool.terms.value(sample.folded), Some(expected), "folding");
            assert_eq!(evaluation.value(&pool.terms, sample.open), Some(expected), "evaluation");
        }
    });
}

#[test]
fn sorts_are_checked() {
    let ill_sorted: [fn(&mut Terms, Term, Term); 4] = [
        |t, _, v| {
            let _ = t.and2(v, Term::TRUE);
        },
        |t, b, v| {
            let _ = t.eq(b, v);
        },
        |t, _, v| {
            let _ = t.le(v, v);
        },
        |t, b, _| {
            let _ = t.bv_neg(b);
        },
    ];
    for build in ill_sorted {
        let mut terms = Terms::new();
        let stem = terms.stem("x");
        let boolean = terms.symbol(stem, Some(0), Sort::Bool);
        let vector = terms.symbol(stem, Some(1), Sort::BitVec(4));
        let result =
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| build(&mut terms, boolean, vector)));
        assert!(result.is_err());
    }
}
