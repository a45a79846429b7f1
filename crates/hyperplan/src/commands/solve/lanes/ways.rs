//! What lanes are told: the ways of a portfolio, and command lines.

use super::Team;
use crate::args;
use crate::configuration::Configured;
use crate::failure::Result;
use hyperplan_problem::Objective;
use hyperplan_problem::answer::Quantifiers;
use hyperplan_solver::Spec;

/// A way to search or a case: what it is called, and what a process is told besides the rest.
pub(super) struct Way {
    pub(super) name: String,
    pub(super) options: Vec<String>,
}

impl Team<'_> {
    /// So many cases.
    pub(super) fn cases(number: u16) -> Vec<Way> {
        let case = |index: u16| Way {
            name: format!("case {index} of {number}"),
            options: vec![format!("--cube={index}/{number}")],
        };
        (1..=number).map(case).collect()
    }

    /// The ways of a portfolio, what was asked for first, and some more, for those that cannot be had. Only what was left
    /// to hyperplan varies.
    pub(super) fn ways(&self, number: usize) -> Result<Vec<Way>> {
        let args = self.args;
        let mut ways: Vec<Vec<String>> = vec![Vec::new()];
        let mut add = |free: bool, option: &str, value: &str| {
            if free {
                ways.push(vec![format!("--{option}={value}")]);
            }
        };
        let quantifiers = args.encoding.quantifiers == Quantifiers::Auto;
        let builtin = args.solver == "builtin";
        add(builtin && !matches!(Spec::embedded("cadical"), Some(Err(_)) | None), "solver", "batsat");
        add(quantifiers, "quantifiers", "explicit");
        add(quantifiers, "quantifiers", "cegis");
        add(args.encoding.states.is_none(), "states", "bitvec");
        if builtin && number > 3 {
            for spec in Configured::new(self.out).catalog()?.installed() {
                let reads_smt = spec.profile().is_none_or(|profile| profile.format().is_none());
                add(!spec.is_embedded() && reads_smt, "solver", spec.name());
            }
        }
        add(quantifiers, "quantifiers", "expand");
        // As many again, with other seeds.
        let kinds = ways.len();
        for index in kinds..2 * number.max(kinds) {
            let mut way = ways[index % kinds].clone();
            way.push(format!("--seed={}", args.seed.wrapping_add((index / kinds) as u64)));
            ways.push(way);
        }
        let name = |way: &[String]| match way {
            [] => "as asked".to_owned(),
            words => words.join(" "),
        };
        Ok(ways.into_iter().map(|options| Way { name: name(&options), options }).collect())
    }

    /// The command line of a lane, which may take some part of the time that is left, one in so many. What it is told last wins, so its own
    /// options come last.
    pub(super) fn arguments(&self, objective: &Objective, own: &[String], share: u32) -> Vec<String> {
        let args = self.args;
        let mut words: Vec<String> = vec!["solve".to_owned(), "--format=json".into(), "--failures".into()];
        let mut files = vec![args.problem.file.display().to_string()];
        if let Some(foreign) = &args.problem.foreign {
            files = foreign.inputs.iter().map(|input| input.name.clone()).collect();
        }
        let mut option = |name: &str, value: String| words.push(format!("--{name}={value}"));
        option("objective", objective.name.clone());
        args.problem.set.iter().for_each(|(name, value)| option("set", format!("{name}={value}")));
        args.others.reading.bound.iter().for_each(|bound| option("bound", bound.to_string()));
        args.others.reading.semantics.iter().for_each(|semantics| option("semantics", semantics.clone()));
        if let Some(args::Wish::Costs(costs)) = &args.minimize {
            option("minimize", costs.clone());
        }
        // With a constant, what is preferred counts among those for its least value.
        let constant = matches!(args.minimize, Some(args::Wish::Constant(_)));
        args.prefer.iter().filter(|_| !constant).for_each(|costs| option("prefer", costs.clone()));
        args.cross_check.iter().for_each(|solver| option("cross-check", solver.clone()));
        args.memory.iter().for_each(|mib| option("memory", mib.to_string()));
        if let Some(left) = self.config.deadline.remaining() {
            // So that there is time to hear that it is over.
            let seconds = left.as_secs_f64() / f64::from(share);
            option("timeout", (seconds - (seconds / 10.0).min(0.5)).max(0.01).to_string());
        }
        let given = |name: &str| own.iter().any(|word| word.starts_with(&format!("--{name}=")));
        for (name, value) in [
            ("solver", args.solver.clone()),
            ("quantifiers", args.encoding.quantifiers.to_string()),
            ("states", crate::config::states_name(args.encoding.states)),
            ("seed", args.seed.to_string()),
        ] {
            if !given(name) {
                option(name, value);
            }
        }
        words.extend(constant.then(|| "--own-minimize-aside".to_owned()));
        words.extend(args.no_verify.then(|| "--no-verify".to_owned()));
        words.extend(own.iter().cloned());
        // So that no name is taken for an option.
        words.push("--".to_owned());
        words.extend(files);
        words
    }
}
