//! Solving the paper's case studies with the embedded solver, verification included: `cargo bench`.
//!
//! The largest size is 40 unless `HYPERPLAN_BENCH_SIZE` says otherwise.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use hyperplan_plan::{Config, Verdict, solve};
use hyperplan_problem::{Overrides, Problem, read};
use hyperplan_solver::Spec;
use hyperplan_syntax::SourceMap;
use std::hint::black_box;
use std::path::{Path, PathBuf};

fn case_studies(criterion: &mut Criterion) {
    let largest = std::env::var("HYPERPLAN_BENCH_SIZE").ok().and_then(|n| n.parse().ok()).unwrap_or(40);
    for objective in ["sp", "isr", "ar", "iso", "cso"] {
        let mut group = criterion.benchmark_group(objective);
        group.sample_size(10);
        for size in [10, 20, 40, 60].into_iter().filter(|n| *n <= largest) {
            let problem = load(&format!("{objective}-{size}"));
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

fn load(name: &str) -> Problem {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/case-studies");
    let file: PathBuf = folder.join(format!("{name}.hp"));
    let text = std::fs::read_to_string(&file).expect("the specs are part of the repository");
    let loader = |path: &str| std::fs::read(folder.join(path)).map_err(|e| e.to_string());
    let lowered = read(&mut SourceMap::new(), name, &text, &loader, &Overrides::none());
    assert!(!lowered.has_errors(), "{name}: {:?}", lowered.diagnostics);
    lowered.problem
}

criterion_group!(benches, case_studies);
criterion_main!(benches);
