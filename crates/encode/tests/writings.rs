//! Every way of writing states against brute force: terms are evaluated under all models there are.

use hyperplan_encode::{
    Encoder, Env, Error, Goal, Known, Limits, Narrowing, Paths, Pruning, Query, Relevant, States,
};
use hyperplan_problem::{PathId, Problem, Trace};
use hyperplan_smt::{Model, Op, Script, Sort, Term, Value, check_model};
use hyperplan_tiny::{formula, holds, paths, problem, system};
use proptest::prelude::*;

const ALL: [States; 5] = [States::Onehot, States::Enum, States::Bitvec, States::Int, States::Real];
const PRUNING: [Pruning; 3] = [Pruning::Full, Pruning::Light, Pruning::None];
const P: PathId = PathId(0);
const Q: PathId = PathId(1);

/// Models beyond which a query is not tried.
const MODELS: usize = 1 << 12;

fn objective(system: &str, prefix: &str, steps: usize, formula: &str) -> Problem {
    problem(&format!("{system} objective o within {steps} {{ {prefix} {formula} }}"))
}

fn encoder(problem: &Problem, states: States, pruning: Pruning) -> Encoder<'_> {
    let limits = Limits { pruning, ..Limits::default() };
    Encoder::new(problem, &problem.objectives[0], Some(states), limits, &|| false).expect("it is small")
}

/// Whether the paths satisfy the problem's objective.
fn satisfied(problem: &Problem, paths: &[&Trace]) -> bool {
    holds(problem, &problem.objectives[0], paths)
}

/// The values that a symbol is given: numbers one further than variables go.
fn domain(script: &Script, symbol: Term) -> Vec<Value> {
    match script.terms.sort(symbol) {
        Sort::Bool => [false, true].map(Value::Bool).to_vec(),
        Sort::BitVec(width) => (0..1 << width).map(|n| Value::bv(n, width)).collect(),
        Sort::Int => (-1..=3).map(Value::Int).collect(),
        Sort::Real => (-1..=3).map(|n| Value::Real(n.into())).collect(),
        Sort::Enum(all) => (0..script.terms.constructors(all)).map(|at| Value::Enum(all, at)).collect(),
    }
}

/// All models of a script, which are about these symbols too; `None` where there are too many candidates.
fn models(script: &Script, wanted: &[Term]) -> Option<Vec<Model>> {
    let mut symbols = script.symbols();
    // Paths apply functions to times, each another: what these give is as free as symbols.
    symbols.extend(script.used_terms().into_iter().filter(|&t| script.terms.op(t) == Op::Apply));
    symbols.extend(wanted);
    symbols.sort_unstable();
    symbols.dedup();
    let domains: Vec<(Term, Vec<Value>)> = symbols.into_iter().map(|s| (s, domain(script, s))).collect();
    let size =
        domains.iter().try_fold(1usize, |size, d| size.checked_mul(d.1.len()).filter(|&s| s <= MODELS));
    let candidate = |mut number: usize| -> Model {
        let mut digit = |values: &[Value]| {
            let value = values[number % values.len()];
            number /= values.len();
            value
        };
        domains.iter().map(|(symbol, values)| (*symbol, digit(values))).collect()
    };
    Some((0..size?).map(candidate).filter(|model| check_model(script, model).violated.is_none()).collect())
}

/// The paths p that the models of a script describe.
fn described(query: &Query<'_, '_>, env: &Env) -> Option<Vec<Trace>> {
    let p = env[0].expect("it was declared");
    let mut found: Vec<Trace> = models(&query.script, &query.paths.symbols(p))?
        .iter()
        .map(|model| query.paths.decode(p, model).expect("every model describes a path").trace(P))
        .collect();
    found.sort_by(|a, b| (&a.states, &a.actions).cmp(&(&b.states, &b.actions)));
    found.dedup();
    Some(found)
}

fn expected(problem: &Problem, steps: usize, wins: impl Fn(&Trace) -> bool) -> Vec<Trace> {
    let mut all = paths(&problem.systems.raw[0], P, steps);
    all.retain(wins);
    all.sort_by(|a, b| (&a.states, &a.actions).cmp(&(&b.states, &b.actions)));
    all
}

/// How the runs of the other path are excluded that defeat the leading one.
#[derive(Clone, Copy, Debug)]
enum Against {
    Sweep,
    Cases,
}

/// The query for the winners of `exists p. forall q`, with p in the environment; `None` where it cannot be written so.
fn winning<'e, 'a>(
    encoder: &'e Encoder<'a>,
    against: Against,
) -> Result<Option<(Query<'e, 'a>, Env)>, Error> {
    let formula = &encoder.objective.formula;
    let goal = Goal::new(formula, true);
    let (own, rest) = goal.split(formula, &|path| path == P);
    let opposed = rest.opposed(formula);
    let relevant = encoder.writer.relevant(&[P], &goal, Narrowing::default())?;
    let mut query = Query::new(encoder, &[], relevant);
    let mut env = query.known();
    env[0] = Some(query.paths.declare(&mut query.script, P, &goal)?);
    query.demand(&env, &own);
    match against {
        Against::Sweep => {
            if !query.paths.sweep(&mut query.script, Q, &env, &opposed)? {
                return Ok(None);
            }
        }
        Against::Cases => {
            for case in encoder.writer.cases(Q, &opposed)? {
                let mut env = env.clone();
                let (q, guard) = query.paths.instantiate(&mut query.script, Q, &case, &env, &opposed)?;
                env[1] = Some(q);
                let rest = query.goal(&env, &rest);
                query.script.clause(&[!guard, rest]);
            }
        }
    }
    Ok(Some((query, env)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Where every path is known a formula is a constant.
    #[test]
    fn formulas_over_known_paths_are_decided(system in system(), formula in formula(&["p", "q"])) {
        let problem = objective(&system, "exists p. forall q.", 2, &formula);
        let all = [P, Q].map(|path| paths(&problem.systems.raw[0], path, 2));
        for states in ALL {
            let encoder = encoder(&problem, states, Pruning::Full);
            let goal = Goal::new(&encoder.objective.formula, true);
            for (p, q) in all[0].iter().zip(all[1].iter().rev()).take(20) {
                let known = [p, q].map(|trace| encoder.writer.known(trace));
                prop_assert_eq!(known[0].as_ref().map(|known| known.trace(P)), Some(p.clone()));
                let mut query = Query::new(&encoder, &known, Relevant::default());
                let env = query.known();
                let decided = query.goal(&env, &goal);
                prop_assert_eq!(decided, Term::from(satisfied(&problem, &[p, q])), "{}", states);
            }
        }
    }

    /// A counterexample's instance describes it beside the path that it is from, and beside others what the instance
    /// says; where it describes none, or one that does no harm, it asks for nothing.
    #[test]
    fn instances_are_what_they_describe(system in system(), formula in formula(&["p", "q"]), pick in 0..1000usize) {
        let problem = objective(&system, "exists p. forall q.", 2, &formula);
        let all = [P, Q].map(|path| paths(&problem.systems.raw[0], path, 2));
        prop_assume!(!all[0].is_empty());
        let (first, counterexample) = (&all[0][pick % all[0].len()], &all[1][pick / 7 % all[1].len()]);
        for states in ALL {
            let encoder = encoder(&problem, states, Pruning::Full);
            let against = Goal::new(&encoder.objective.formula, false);
            let known = |trace| encoder.writer.known(trace);
            let before = [known(first), known(counterexample)];
            let own = before[1].clone().expect("it is a path");
            let instance = encoder.writer.generalize(Q, &own, &before);
            let realized = encoder.writer.realize(Q, &instance, &[known(first), None]);
            prop_assert_eq!(realized.map(|q| q.trace(Q)), Some(counterexample.clone()), "{}", states);
            for p in all[0].iter().take(20) {
                let known: [Option<Known>; 2] = [known(p), None];
                let realized = encoder.writer.realize(Q, &instance, &known).map(|q| q.trace(Q));
                let defeats = realized.as_ref().is_some_and(|q| !satisfied(&problem, &[p, q]));
                let mut query = Query::new(&encoder, &known, Relevant::default());
                let mut env = query.known();
                let (q, guard) = query
                    .paths
                    .instantiate(&mut query.script, Q, &instance, &env, &against)
                    .expect("it is small");
                env[1] = Some(q);
                let defeated = query.goal(&env, &against);
                let said = query.script.terms.and2(guard, defeated);
                query.script.assert(said);
                let models = models(&query.script, &[]).expect("there is little to choose");
                prop_assert_eq!(!models.is_empty(), defeats, "{} {:?} {:?}", states, p, instance);
            }
        }
    }

    /// A declared path of which its goal is demanded is any path that meets it, and no other, pruned or not.
    #[test]
    fn declared_paths_are_those_that_meet_their_goal(system in system(), formula in formula(&["p"])) {
        let problem = objective(&system, "exists p.", 1, &formula);
        let expected = expected(&problem, 1, |p| satisfied(&problem, &[p]));
        for (states, pruning) in ALL.into_iter().flat_map(|states| PRUNING.map(|pruning| (states, pruning))) {
            let encoder = encoder(&problem, states, pruning);
            let goal = Goal::new(&encoder.objective.formula, true);
            let relevant = encoder.writer.relevant(&[P], &goal, Narrowing::default()).expect("it is small");
            prop_assert!(!relevant.is_hopeless() || expected.is_empty());
            let mut query = Query::new(&encoder, &[], relevant);
            let env = vec![Some(query.paths.declare(&mut query.script, P, &goal).expect("it is small"))];
            query.demand(&env, &goal);
            if let Some(found) = described(&query, &env) {
                prop_assert_eq!(&found, &expected, "{} {:?}", states, pruning);
            }
        }
    }

    /// Functions describe the paths that symbols do, whatever moves depend on.
    #[test]
    fn functions_describe_the_same_paths(system in system(), formula in formula(&["p", "q"])) {
        let problem = objective(&system, "exists p. forall q.", 1, &formula);
        let others = paths(&problem.systems.raw[0], Q, 1);
        let expected = expected(&problem, 1, |p| others.iter().all(|q| satisfied(&problem, &[p, q])));
        for states in ALL.into_iter().filter(|states| !states.is_enumerated()) {
            for how in [Paths::Functions, Paths::Policies] {
                let encoder = encoder(&problem, states, Pruning::Full).with_paths(how).expect("by variable");
                let query = winning(&encoder, Against::Cases).expect("it is small");
                let found = query.and_then(|(query, env)| described(&query, &env));
                if let Some(found) = found {
                    prop_assert_eq!(&found, &expected, "{} {}", states, how);
                }
            }
        }
    }

    /// What is left of p is what wins against every q, however the states are written and q is excluded.
    #[test]
    fn what_wins_is_the_same_in_every_writing(system in system(), formula in formula(&["p", "q"])) {
        let problem = objective(&system, "exists p. forall q.", 1, &formula);
        let others = paths(&problem.systems.raw[0], Q, 1);
        let expected = expected(&problem, 1, |p| others.iter().all(|q| satisfied(&problem, &[p, q])));
        for states in ALL {
            let ways = PRUNING.map(|pruning| (Against::Cases, pruning));
            for (against, pruning) in ways.into_iter().chain([(Against::Sweep, Pruning::Full)]) {
                let encoder = encoder(&problem, states, pruning);
                let query = winning(&encoder, against).expect("it is small");
                let found = query.and_then(|(query, env)| described(&query, &env));
                if let Some(found) = found {
                    prop_assert_eq!(&found, &expected, "{} {:?} {:?}", states, against, pruning);
                }
            }
        }
    }
}
