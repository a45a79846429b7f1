//! The same comparison for BenchExec.

use super::comparison::Comparison;
use crate::failure::{Exit, Failure, Result};
use crate::files::cannot_write;
use crate::output::Output;
use hyperplan_compare::benchexec::{Configuration, Problem};
use hyperplan_compare::plan::Kind;
use std::path::Path;

/// Writes the same comparison for BenchExec, and runs nothing.
pub(super) fn run(folder: &Path, comparison: &Comparison, out: &mut Output) -> Result {
    let (instances, ways) = (comparison.instances(out)?, &comparison.ways);
    let problems: Vec<Problem> = instances
        .iter()
        .filter_map(|instance| match &instance.kind {
            Kind::Query(_) => None,
            Kind::Problem { objective } => Some(Problem {
                file: instance.file.clone().into(),
                objective: Some(objective.clone()),
                set: instance.set.clone(),
                expected: instance.expected,
            }),
        })
        .collect();
    let left_out = counted(instances.len() - problems.len(), "SMT-LIB file");
    if problems.is_empty() {
        return Err(Failure::input(format_args!("nothing is left for BenchExec without {left_out}")));
    }
    if problems.len() < instances.len() {
        out.remark(format_args!("note: {left_out} left out: solvers run these there without hyperplan"));
    }
    let option = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let mut configurations = Vec::new();
    for solver in &comparison.solvers {
        for (quantifiers, states) in
            ways.quantifiers.iter().flat_map(|q| ways.states.iter().map(move |s| (q.as_str(), s.as_str())))
        {
            for seed in &ways.seeds {
                let name = format!("{}-{quantifiers}-{states}", solver.name);
                configurations.push(Configuration {
                    name: if ways.seeds.len() > 1 { format!("{name}-{seed}") } else { name },
                    options: vec![
                        option("--solver", &solver.name),
                        option("--quantifiers", quantifiers),
                        option("--states", states),
                        option("--seed", &seed.to_string()),
                    ],
                });
            }
        }
    }
    hyperplan_compare::benchexec::write(folder, &problems, &configurations, &ways.limit)
        .map_err(|error| cannot_write(folder, &error))?;
    let dir = folder.display();
    out.remark(format_args!(
        "note: {} and {} in {dir}; to run them: cd {dir} && PYTHONPATH=. benchexec hyperplan.xml",
        counted(problems.len(), "task"),
        counted(configurations.len(), "run definition")
    ));
    Ok(Exit::Good)
}

fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}
