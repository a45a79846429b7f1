//! The stages from a problem file to a verified answer, each by itself, on the paper's case studies: `cargo bench`.
//!
//! The size is 20 unless `HYPERPLAN_BENCH_SIZE` says otherwise. `cargo bench --bench stages -- --quick reach` is a
//! look at one stage.

mod common;

use common::{Case, OBJECTIVES, wanted_size};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use hyperplan_encode::{Encoder, Goal, Limits, Narrowing, Query, Relevant};
use hyperplan_horizon::horizons;
use hyperplan_plan::{Config, EmitConfig, Emitted, Quantifiers, Status, emit, solve};
use hyperplan_problem::{Objective, Problem};
use hyperplan_solver::{Answer, Deadline, Options, Spec, open};
use hyperplan_verify as verify;
use std::hint::black_box;
use std::time::Duration;

/// A benchmark of one stage on one objective.
type Stage = fn(&mut Criterion, &str, &Case, &Problem);

const STAGES: [Stage; 9] =
    [read, horizon, enumerate, reach, unroll, encode, solve_query, verify_strategy, write];

fn stages(criterion: &mut Criterion) {
    let size = wanted_size().unwrap_or(20);
    for stage in STAGES {
        for objective in OBJECTIVES {
            let case = Case::new(objective, size);
            let problem = case.read();
            stage(criterion, &format!("{objective}-{size}"), &case, &problem);
        }
    }
}

fn objective(problem: &Problem) -> &Objective {
    &problem.objectives[0]
}

fn encoder(problem: &Problem) -> Encoder<'_> {
    Encoder::new(problem, objective(problem), None, Limits::default(), &|| false).expect("it can be encoded")
}

/// The quantifier-free query, for all runs.
fn query(problem: &Problem) -> Emitted {
    emitted(problem, Quantifiers::Expand)
}

fn emitted(problem: &Problem, quantifiers: Quantifiers) -> Emitted {
    let status = Some(Status::Unknown);
    let config = EmitConfig { quantifiers, status, ..EmitConfig::new("2026-01-31") };
    emit(problem, objective(problem), &config).expect("it can be expanded")
}

/// From text to a typed problem.
fn read(criterion: &mut Criterion, name: &str, case: &Case, _: &Problem) {
    criterion.bench_function(&format!("read/{name}"), |b| b.iter(|| black_box(case.read())));
}

/// How much of each path matters.
fn horizon(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    criterion
        .bench_function(&format!("horizon/{name}"), |b| b.iter(|| black_box(horizons(objective(problem)))));
}

/// The reachable states of the system.
fn enumerate(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    criterion.bench_function(&format!("enumerate/{name}"), |b| {
        b.iter(|| black_box(encoder(problem).states));
    });
}

/// Which states can matter at which time, for the leading block.
fn reach(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    let encoder = encoder(problem);
    let goal = Goal::new(&objective(problem).formula, true);
    let leading = objective(problem).leading_block();
    criterion.bench_function(&format!("reach/{name}"), |b| {
        b.iter(|| {
            encoder.writer.relevant(&leading, &goal, Narrowing::default()).expect("it is within the budget")
        });
    });
}

/// The formula over paths of which none is known.
fn unroll(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    let encoder = encoder(problem);
    let goal = Goal::new(&objective(problem).formula, true);
    let declared = || {
        let mut query = Query::new(&encoder, &[], Relevant::default());
        let paths = objective(problem).paths.keys();
        let env = paths
            .map(|path| {
                Some(query.paths.declare(&mut query.script, path, &goal).expect("it is within the budget"))
            })
            .collect();
        (query, env)
    };
    criterion.bench_function(&format!("unroll/{name}"), |b| {
        b.iter_batched(declared, |(mut query, env)| query.goal(&env, &goal), BatchSize::LargeInput);
    });
}

/// From the problem to the query: enumerating, reaching, unrolling and all between.
fn encode(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    criterion.bench_function(&format!("encode/{name}"), |b| b.iter(|| black_box(query(problem))));
}

/// The query, by the embedded solver.
fn solve_query(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    let query = query(problem);
    criterion.bench_function(&format!("solve/{name}"), |b| {
        b.iter(|| {
            let mut session = open(&Spec::Builtin, &Options::default()).expect("it is built in");
            let answer = session
                .check(query.script().expect("one query"), &[], &Deadline::never())
                .expect("it can be solved");
            assert_eq!(answer, Answer::Sat);
        });
    });
}

/// The independent check of a strategy.
fn verify_strategy(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    let config = Config { verify: false, ..Config::new(Spec::Builtin) };
    let outcome = solve(problem, objective(problem), &config).expect("it can be solved");
    let strategy = outcome.witness.expect("the case studies are realizable");
    criterion.bench_function(&format!("verify/{name}"), |b| {
        b.iter(|| {
            let verdict = verify::check(problem, objective(problem), &strategy, &verify::Budget::default());
            assert!(matches!(verdict, Ok(verify::Check::Holds)));
        });
    });
}

/// The query as SMT-LIB, into nothing: quantifier-free, and with its quantifiers.
fn write(criterion: &mut Criterion, name: &str, _: &Case, problem: &Problem) {
    let mut group = criterion.benchmark_group("write");
    for (how, quantifiers) in [("", Quantifiers::Expand), ("-keep", Quantifiers::Keep)] {
        let mut query = emitted(problem, quantifiers);
        let mut text = Vec::new();
        query.write(&mut text).expect("a vector takes everything");
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_function(format!("{name}{how}"), |b| {
            b.iter(|| query.write(&mut std::io::sink()).expect("nothing can go wrong"));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = stages
}
criterion_main!(benches);
