//! What a comparison runs: every instance with every solver in every way.

use std::sync::Arc;

use hyperplan_solver::Standalone;
use sha2::{Digest as _, Sha256};

use crate::cases::{case, option};
use crate::query::Query;
use crate::record::{Answer, Limit};
use hyperplan_outlet::one_line;

/// Something to be solved.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The file as it was named, and for a problem file the objective: `specs/rooms.hp#fastest`.
    pub name: String,
    /// Its folder.
    pub family: String,
    /// The file.
    pub file: String,
    /// Of the file's bytes.
    pub sha256: String,
    /// Of all other files that it reads, such as maps.
    pub others: String,
    /// The constants that are set, in order.
    pub set: Vec<String>,
    /// The largest horizon of a path.
    pub horizon: Option<u64>,
    /// The right answer, where the file says it; of a query, see there.
    pub expected: Option<Answer>,
    /// What kind of file it is.
    pub kind: Kind,
}

/// The kinds of files.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A problem file, of which one objective is meant.
    Problem {
        /// The objective.
        objective: String,
    },
    /// An SMT-LIB file.
    Query(Query),
}

/// A solver in a comparison.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// As it was asked for.
    pub name: String,
    /// Its version, if it says one.
    pub version: Option<String>,
    /// Tells builds apart where there is no version.
    pub stamp: String,
    /// Its program; none for the embedded engine, which reads no SMT-LIB.
    pub standalone: Option<Standalone>,
}

/// In which ways instances are solved.
#[derive(Clone, Debug)]
pub struct Ways {
    /// How quantifiers are decided.
    pub quantifiers: Vec<String>,
    /// How states are written.
    pub states: Vec<String>,
    /// Seeds.
    pub seeds: Vec<u64>,
    /// How often.
    pub repetitions: u32,
    /// Limits of each run.
    pub limit: Limit,
    /// Further options of `solve`.
    pub options: Vec<String>,
    /// The cases of each objective, each a run by itself; one is all of it.
    pub cases: u16,
    /// Tells builds of hyperplan apart, which does the runs on problem files.
    pub build: String,
}

/// One run to be done.
#[derive(Clone, Debug)]
pub struct Run {
    /// What tells it from all others; changes with everything that its outcome depends on.
    pub key: String,
    /// What is to be solved.
    pub instance: Arc<Instance>,
    /// By which solver.
    pub solver: Arc<Candidate>,
    /// How quantifiers are decided; `None` for a query, as with what follows.
    pub quantifiers: Option<String>,
    /// How states are written.
    pub states: Option<String>,
    /// Further options.
    pub options: Vec<String>,
    /// The seed.
    pub seed: u64,
    /// Which of the repetitions.
    pub repetition: u32,
    /// The limits.
    pub limit: Limit,
}

/// How many runs there would be, without making them.
#[must_use]
pub fn count(instances: &[Arc<Instance>], solvers: &[Arc<Candidate>], ways: &Ways) -> u64 {
    let pairs = instances.iter().flat_map(|instance| solvers.iter().map(move |solver| (instance, solver)));
    let runs = |(instance, solver): (&Arc<Instance>, &Arc<Candidate>)| {
        encodings(instance, solver, ways).len() * cases(instance, ways).len()
    };
    let each: usize = pairs.map(runs).sum();
    (each as u64).saturating_mul(ways.seeds.len() as u64).saturating_mul(ways.repetitions.into())
}

/// All runs. Repetitions come last, so that what was done when a comparison is stopped covers as much as possible. The
/// embedded engine gets no queries.
#[must_use]
pub fn plan(instances: &[Arc<Instance>], solvers: &[Arc<Candidate>], ways: &Ways) -> Vec<Run> {
    let mut runs = Vec::new();
    for repetition in 0..ways.repetitions {
        for &seed in &ways.seeds {
            for instance in instances {
                for solver in solvers {
                    for (quantifiers, states) in encodings(instance, solver, ways) {
                        for options in cases(instance, ways) {
                            let mut run = Run {
                                key: String::new(),
                                instance: Arc::clone(instance),
                                solver: Arc::clone(solver),
                                quantifiers: quantifiers.clone(),
                                states: states.clone(),
                                options,
                                seed,
                                repetition,
                                limit: ways.limit,
                            };
                            run.key = run.digest(&ways.build);
                            runs.push(run);
                        }
                    }
                }
            }
        }
    }
    runs
}

/// The further options of each case.
fn cases(instance: &Instance, ways: &Ways) -> Vec<Vec<String>> {
    let with = |index: u16| {
        let case = (ways.cases > 1).then(|| option(index, ways.cases));
        ways.options.iter().cloned().chain(case).collect()
    };
    match instance.kind {
        Kind::Query(_) => vec![Vec::new()],
        Kind::Problem { .. } => (1..=ways.cases.max(1)).map(with).collect(),
    }
}

fn encodings(instance: &Instance, solver: &Candidate, ways: &Ways) -> Vec<(Option<String>, Option<String>)> {
    match instance.kind {
        Kind::Query(_) if solver.standalone.is_none() => Vec::new(),
        Kind::Query(_) => vec![(None, None)],
        Kind::Problem { .. } => {
            let each = |q: &String| {
                ways.states.iter().map(|s| (Some(q.clone()), Some(s.clone()))).collect::<Vec<_>>()
            };
            ways.quantifiers.iter().flat_map(each).collect()
        }
    }
}

/// How queries are given to solvers and their answers read; changes where the same output would come to something else.
const READING: &str = "without status, one answer, models evaluated";

impl Run {
    /// A digest of all that the outcome depends on, with the build of hyperplan where it takes part.
    fn digest(&self, build: &str) -> String {
        let Run { key: _, instance, solver, quantifiers, states, options, seed, repetition, limit } = self;
        let Instance { name, family: _, file, sha256, others, set, horizon: _, expected: _, kind } =
            &**instance;
        let Candidate { name: solver, version, stamp, standalone } = &**solver;
        let standalone = standalone.as_ref().map(|standalone| match kind {
            // hyperplan adds arguments by itself.
            Kind::Problem { .. } => (Vec::new(), None),
            Kind::Query(query) => (standalone.arguments(file, query.incremental).0, standalone.seed(*seed)),
        });
        let own = match kind {
            Kind::Problem { .. } => build,
            Kind::Query(_) => READING,
        };
        let input = (name, sha256, others, set);
        let solver = (solver, version, stamp, standalone, own);
        let way = (quantifiers, states, options, seed, repetition, limit);
        hexadecimal(&Sha256::digest(format!("{input:?} {solver:?} {way:?}")))[..32].to_owned()
    }

    /// Instance, constants, solver and encoding, in a few words.
    #[must_use]
    pub fn label(&self) -> String {
        let mut words = vec![self.instance.name.clone()];
        words.extend(self.instance.set.iter().cloned());
        words.push(self.solver.name.clone());
        if let (Some(quantifiers), Some(states)) = (&self.quantifiers, &self.states) {
            words.push(format!("{quantifiers}/{states}"));
        }
        if self.seed != 0 {
            words.push(format!("seed {}", self.seed));
        }
        words.extend(
            self.options.iter().find_map(|word| case(word)).map(|(index, of)| format!("case {index}/{of}")),
        );
        if self.repetition != 0 {
            words.push(format!("repetition {}", self.repetition));
        }
        one_line(&words.join(" ")).into_owned()
    }
}

/// The SHA-256 digest of some bytes, in hexadecimal.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn instance(name: &str, kind: Kind) -> Arc<Instance> {
        Arc::new(Instance {
            name: name.to_owned(),
            family: ".".to_owned(),
            file: name.to_owned(),
            sha256: sha256(name.as_bytes()),
            others: String::new(),
            set: Vec::new(),
            horizon: None,
            expected: None,
            kind,
        })
    }

    fn ways() -> Ways {
        Ways {
            quantifiers: ["keep", "cegis"].map(str::to_owned).to_vec(),
            states: ["onehot", "bitvec", "int"].map(str::to_owned).to_vec(),
            seeds: vec![0, 7],
            repetitions: 2,
            limit: Limit::default(),
            options: Vec::new(),
            cases: 1,
            build: "one".to_owned(),
        }
    }

    fn candidate(name: &str) -> Arc<Candidate> {
        Arc::new(Candidate { name: name.to_owned(), version: None, stamp: String::new(), standalone: None })
    }

    #[test]
    fn every_run_has_its_own_key() {
        let problem = || Kind::Problem { objective: "sp".to_owned() };
        let instances = [instance("a.hp#sp", problem()), instance("b.hp#sp", problem())];
        let runs = plan(&instances, &[candidate("builtin"), candidate("other")], &ways());
        assert_eq!(runs.len(), 2 * 2 * (2 * 3) * 2 * 2);
        assert_eq!(
            count(&instances, &[candidate("builtin"), candidate("other")], &ways()),
            runs.len() as u64
        );
        let keys: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
        assert_eq!(keys.len(), runs.len());
        assert_eq!(runs[0].label(), "a.hp#sp builtin keep/onehot");
        assert_eq!(runs.last().expect("there are some").repetition, 1);
    }

    #[test]
    fn each_case_of_an_objective_is_a_run() {
        let problem = instance("a.hp#sp", Kind::Problem { objective: "sp".to_owned() });
        let instances = [problem, instance("a.smt2", Kind::Query(Query::default()))];
        let ways = Ways { cases: 3, ..ways() };
        let runs = plan(&instances, &[candidate("builtin")], &ways);
        assert_eq!(runs.len(), 3 * (2 * 3) * 2 * 2);
        assert_eq!(count(&instances, &[candidate("builtin")], &ways), runs.len() as u64);
        let keys: BTreeSet<&str> = runs.iter().map(|run| run.key.as_str()).collect();
        assert_eq!(keys.len(), runs.len());
        assert_eq!(runs[1].options, ["--cube=2/3"]);
        assert_eq!(runs[1].label(), "a.hp#sp builtin keep/onehot case 2/3");
    }

    #[test]
    fn the_engine_gets_no_queries() {
        let query = instance("a.smt2", Kind::Query(Query::default()));
        assert!(plan(&[query], &[candidate("builtin")], &ways()).is_empty());
    }

    #[test]
    fn a_key_changes_with_all_that_matters() {
        let run = |change: &dyn Fn(&mut Instance, &mut Candidate, &mut Ways)| {
            let mut instance =
                Instance::clone(&instance("a.hp#sp", Kind::Problem { objective: "sp".to_owned() }));
            let (mut solver, mut ways) = (Candidate::clone(&candidate("z3")), ways());
            change(&mut instance, &mut solver, &mut ways);
            plan(&[Arc::new(instance)], &[Arc::new(solver)], &ways)[0].key.clone()
        };
        let same = run(&|_, _, _| {});
        assert_eq!(same, run(&|_, _, _| {}));
        let mut keys = BTreeSet::from([
            same,
            run(&|i, _, _| i.sha256 = "0".to_owned()),
            run(&|i, _, _| i.others = "0".to_owned()),
            run(&|i, _, _| i.set = vec!["T=3".to_owned()]),
            run(&|_, s, _| s.version = Some("4.0".to_owned())),
            run(&|_, s, _| s.stamp = "1".to_owned()),
            run(&|_, _, w| w.limit.wall_s = Some(1.0)),
            run(&|_, _, w| w.limit.cpu_s = Some(1.0)),
            run(&|_, _, w| w.limit.memory_mib = Some(1)),
            run(&|_, _, w| w.options = vec!["--no-verify".to_owned()]),
            run(&|_, _, w| w.build = "another".to_owned()),
            run(&|_, _, w| w.cases = 2),
        ]);
        assert_eq!(keys.len(), 12);
        // The family is for tables only.
        assert!(!keys.insert(run(&|i, _, _| i.family = "x".to_owned())));
    }
}
