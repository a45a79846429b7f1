//! Solving the paper's case studies with the embedded solver, verification included: `cargo bench`.
//!
//! The largest size is 40 unless `HYPERPLAN_BENCH_SIZE` says otherwise.

mod common;

use common::{Case, OBJECTIVES, wanted_size};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use hyperplan_plan::{Config, Verdict, solve};
use hyperplan_solver::Spec;
use std::hint::black_box;

fn case_studies(criterion: &mut Criterion) {
    let largest = wanted_size().unwrap_or(40);
    for objective in OBJECTIVES {
        let mut group = criterion.benchmark_group(objective);
        group.sample_size(10);
        for size in [10, 20, 40, 60].into_iter().filter(|n| *n <= largest) {
            let problem = Case::new(objective, size).read();
            group.bench_with_input(BenchmarkId::from_parameter(size), &problem, |bencher, problem| {
                bencher.iter(|| {
                    let outcome =
                        solve(problem, &problem.objectives[0], &config()).expect("it can be solved");
                    assert_eq!(outcome.verdict, Verdict::Realizable);
                    black_box(outcome)
                });
            });
        }
        group.finish();
    }
}

fn config() -> Config {
    Config::new(Spec::Builtin)
}

criterion_group!(benches, case_studies);
criterion_main!(benches);
