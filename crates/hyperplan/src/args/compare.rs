//! What may be typed behind `compare`.

use super::{Part, Reading, part, quantifiers, setting, states};
use clap::{Args, ValueEnum};
use hyperplan_problem::answer::{Quantifiers, States};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

#[derive(Debug, Args)]
#[command(after_help = COMPARE_HELP)]
pub(crate) struct Compare {
    #[command(flatten)]
    pub(crate) asked: Asked,
    /// How many runs at a time; they slow each other down
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: u16,
    /// Keeps each run on a core of its own
    #[arg(long)]
    pub(crate) pin: bool,
    /// The folder for the log of all runs, runs.jsonl, and the reports
    #[arg(long, value_name = "DIR", default_value = "comparison")]
    pub(crate) out: PathBuf,
    /// Believes known answers only where a certificate beside the benchmark, of `emit --certify`, proves them
    #[arg(long)]
    pub(crate) certified: bool,
    /// Keeps the queries of each run there
    #[arg(long)]
    pub(crate) queries: bool,
    /// Runs nothing, but writes the same comparison of problem files for BenchExec
    #[arg(long, value_name = "DIR", conflicts_with_all = ["plan", "shard", "merge", "engine", "cubes"])]
    pub(crate) benchexec: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) cluster: Cluster,
}

/// What is run in a comparison; a plan has it, so that other machines run the same.
#[derive(Clone, Debug, PartialEq, Args, Serialize, Deserialize)]
#[group(skip)]
pub(crate) struct Asked {
    /// Problem files (.hp), SMT-LIB files (.smt2), folders with such files, or patterns (`'specs/**/*-10.hp'`); models and
    /// formulas of other tools (.smv, .aag, .aig, .txt, .pddl, .hq), together one problem, or tables of such (.tsv); without any, what was run before
    /// is reported again
    #[arg(value_name = "FILE|FOLDER|PATTERN")]
    pub(crate) files: Vec<String>,
    /// Leaves out files that cannot be used, and says why, instead of running nothing
    #[arg(long)]
    pub(crate) skip_bad: bool,
    /// The objectives, or `all`; files that have none of that name are left out
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', default_value = "all")]
    pub(crate) objective: Vec<String>,
    /// Solvers as for `solve`; here commas mean each of them by itself, not a race [default: builtin and all that are
    /// installed]
    #[arg(long, value_name = "SOLVER,...")]
    pub(crate) solver: Option<String>,
    /// How quantifiers are decided, each in turn
    #[arg(long, value_parser = quantifiers(), value_name = "HOW,...", value_delimiter = ',', default_value = "auto")]
    pub(crate) quantifiers: Vec<Quantifiers>,
    /// How states are represented, each in turn
    #[arg(long, value_parser = states(), value_name = "HOW,...", value_delimiter = ',', default_value = "auto")]
    pub(crate) states: Vec<Option<States>>,
    /// Replaces the value of a constant, by each of several in turn; with several constants, all combinations
    #[arg(long, value_name = "NAME=VALUE,...|LO..HI", value_parser = settings)]
    pub(crate) set: Vec<Settings>,
    /// Seeds of the solver, each in turn
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "0")]
    pub(crate) seed: Vec<u64>,
    /// How often to do each run
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) repeat: u32,
    /// Wall time of each run
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0)]
    pub(crate) timeout: f64,
    /// CPU time of each run, with everything it starts
    #[arg(long, value_name = "SECONDS")]
    pub(crate) cpu: Option<f64>,
    /// Most memory of each run, with everything it starts
    #[arg(long, value_name = "MIB")]
    pub(crate) memory: Option<u64>,
    /// Leaves strategies unchecked
    #[arg(long)]
    pub(crate) no_verify: bool,
    /// Cuts each objective into N cases, each a run of its own, on several machines perhaps; reports have what they come to together
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    #[serde(default = "one")]
    pub(crate) cubes: u16,
    /// A plan names the problems that came of them.
    #[command(flatten)]
    #[serde(skip)]
    pub(crate) reading: Reading,
}

impl Compare {
    /// What the command has where nothing else is said.
    pub(crate) fn new(files: Vec<String>, solver: Option<String>, timeout: f64) -> Self {
        let asked = Asked { files, solver, timeout, ..Asked::default() };
        Compare {
            asked,
            jobs: 1,
            pin: false,
            out: PathBuf::new(),
            certified: false,
            queries: false,
            benchexec: None,
            cluster: Cluster {
                plan: None,
                shard: None,
                log: None,
                merge: Vec::new(),
                limit: None,
                echo: false,
                engine: None,
                tasks: None,
                exclusive: false,
                unshared: false,
                submit: Vec::new(),
            },
        }
    }
}

impl Default for Asked {
    fn default() -> Self {
        Asked {
            files: Vec::new(),
            skip_bad: false,
            objective: vec!["all".to_owned()],
            solver: None,
            quantifiers: vec![Quantifiers::Auto],
            states: vec![None],
            set: Vec::new(),
            seed: vec![0],
            repeat: 1,
            timeout: 60.0,
            cpu: None,
            memory: None,
            no_verify: false,
            cubes: 1,
            reading: Reading { bound: None, semantics: None, dialect: None },
        }
    }
}

fn one() -> u16 {
    1
}

impl Asked {
    /// Whether nothing was said of what is to be run.
    pub(crate) fn is_default(&self) -> bool {
        *self == Asked::default()
    }
}

/// A comparison on several machines.
#[derive(Debug, Args)]
#[group(skip)]
#[command(next_help_heading = "Several machines")]
pub(crate) struct Cluster {
    /// With files: runs nothing, but writes the list of all runs. Without: the runs are those of the list, as it was asked for
    /// then
    #[arg(long, value_name = "FILE")]
    pub(crate) plan: Option<PathBuf>,
    /// Does a share of the runs only, the I-th of N, with a log of its own, runs-I-of-N.jsonl; or `next`: takes runs from a folder
    /// below --out that other machines share, as long as there are some
    #[arg(long, value_name = "I/N|next", value_parser = shard, conflicts_with = "merge")]
    pub(crate) shard: Option<Shard>,
    /// The name of that log: a scheduler that starts a share again must not have two programs write one.
    #[arg(long, hide = true, requires = "shard")]
    pub(crate) log: Option<String>,
    /// Runs nothing, but puts other logs into that of --out and reports; of a plan, with what is missing. Also results of
    /// BenchExec (.xml), of SMT-COMP (.json) and of StarExec (.csv), all of which may be compressed (.gz)
    #[arg(long, value_name = "LOG", num_args = 1.., conflicts_with = "files")]
    pub(crate) merge: Vec<PathBuf>,
    /// The limit of results of others that do not say it, as those of SMT-COMP and StarExec; without it the sequential
    /// score counts whatever CPU time an answer took
    #[arg(long, value_name = "SECONDS", requires = "merge", value_parser = seconds)]
    pub(crate) limit: Option<f64>,
    /// Prints each run on standard output too, as its line in the log: where nothing else comes back from a machine
    #[arg(long, requires = "shard")]
    pub(crate) echo: bool,
    /// Has a cluster do the runs, as one array job, and waits for it; a signal cancels the job
    #[arg(long, value_enum, value_name = "ENGINE", conflicts_with_all = ["shard", "merge"])]
    pub(crate) engine: Option<Engine>,
    /// How many tasks the job has [default: one for 10 minutes of expected work]
    #[arg(long, value_name = "N", requires = "engine", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) tasks: Option<u16>,
    /// Each task has its node for itself
    #[arg(long, requires = "engine")]
    pub(crate) exclusive: bool,
    /// The nodes do not see the folder of --out: the runs come with what the job prints
    #[arg(long, requires = "engine", conflicts_with = "queries")]
    pub(crate) unshared: bool,
    /// An option for the submission of the job, such as --submit=--partition=long
    #[arg(long, value_name = "OPTION", requires = "engine", allow_hyphen_values = true)]
    pub(crate) submit: Vec<String>,
}

/// Who does the runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    Slurm,
}

/// Which runs are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shard {
    /// One of so many shares, from 0.
    Share(Part),
    /// Whatever is left.
    Next,
}

const COMPARE_HELP: &str =
    "Every run is written to the log as soon as it has ended. The same command again does only \
what is missing there: after an interruption, or where a file, a solver, an option or a limit has changed.

Exit status: 0 nothing is wrong with any answer; 3 with --merge: runs of the plan are missing; 4 a solver gave a wrong answer \
or model, or is not there; 5 hyperplan may be wrong; 2 bad usage or input; 130 interrupted.";

/// A time to work in.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = text.trim().parse::<f64>().ok().filter(|seconds| seconds.is_finite() && *seconds > 0.0);
    seconds.ok_or_else(|| "expected seconds, more than 0".to_owned())
}

/// A constant and its values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Settings {
    pub(crate) name: String,
    pub(crate) values: Vec<String>,
}

/// The most values of a range.
const VALUES: i64 = 10_000;

fn settings(text: &str) -> Result<Settings, String> {
    let (name, values) = setting(text)?;
    let number = |text: &str| text.trim().parse::<i64>().ok();
    let range = values.split_once("..").and_then(|(lo, hi)| number(lo).zip(number(hi)));
    let values: Vec<String> = match range {
        Some((lo, hi)) if lo > hi => return Err(format!("the range {lo}..{hi} is empty")),
        Some((lo, hi)) if hi.checked_sub(lo).is_none_or(|size| size >= VALUES) => {
            return Err(format!("the range {lo}..{hi} has more than {VALUES} values"));
        }
        Some((lo, hi)) => (lo..=hi).map(|value| value.to_string()).collect(),
        None => values.split(',').map(|value| value.trim().to_owned()).collect(),
    };
    if values.iter().any(String::is_empty) {
        return Err("expected NAME=VALUE, NAME=VALUE,VALUE or NAME=LO..HI".to_owned());
    }
    Ok(Settings { name, values })
}

/// More machines are hardly meant.
const MOST_SHARES: usize = 100_000;

fn shard(text: &str) -> Result<Shard, String> {
    if text == "next" {
        return Ok(Shard::Next);
    }
    part(text, MOST_SHARES).map(Shard::Share).map_err(|error| format!("{error}; or `next`"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{CommandFactory as _, Parser};

    #[test]
    fn what_is_not_said_is_what_the_parser_fills_in() {
        #[derive(Parser)]
        struct Nothing {
            #[command(flatten)]
            asked: Asked,
        }
        let nothing = Nothing::try_parse_from([""]).expect("nothing is required");
        assert_eq!(nothing.asked, Asked::default());
    }

    #[test]
    fn shares_are_read() {
        assert_eq!(shard("1/4"), Ok(Shard::Share(Part { index: 0, of: 4 })));
        assert_eq!(shard("next"), Ok(Shard::Next));
        for wrong in ["", "0/4", "5/4", "1/0", "1", "a/b", "-1/4", "1/1000000"] {
            assert!(shard(wrong).is_err(), "{wrong}");
        }
    }

    /// Where or how runs are done and judged, which changes nothing of what they are. Every other option is part of what a plan says.
    const ELSEWHERE: [&str; 17] = [
        "certified",
        "jobs",
        "pin",
        "out",
        "queries",
        "benchexec",
        "plan",
        "shard",
        "log",
        "merge",
        "limit",
        "echo",
        "engine",
        "tasks",
        "exclusive",
        "unshared",
        "submit",
    ];

    /// Values of which one fits each option, and is not what it is without.
    const VALUES: [&str; 8] = ["7", "a", "T=3", "cegis", "bitvec", "pes", "hyperqb1", "true"];

    #[test]
    fn every_option_that_shapes_a_run_is_part_of_a_plan() {
        #[derive(Parser)]
        struct All {
            #[command(flatten)]
            all: Compare,
        }
        let mut shaping = 0;
        for option in All::command().get_arguments().filter_map(|argument| argument.get_long()) {
            if ["help", "version"].contains(&option) || ELSEWHERE.contains(&option) {
                continue;
            }
            let with = VALUES
                .iter()
                .map(|value| vec![format!("--{option}={value}")])
                .chain([vec![format!("--{option}")]]);
            let parsed = with.filter_map(|words| {
                let needed = (option == "semantics").then(|| "--bound=3".to_owned());
                All::try_parse_from(["".to_owned()].into_iter().chain(needed).chain(words)).ok()
            });
            let told: Vec<bool> = parsed.map(|All { all }| !all.asked.is_default()).collect();
            assert!(told.contains(&true), "--{option} is not part of what is asked: {told:?}");
            shaping += 1;
        }
        assert!(shaping > 10, "{shaping}");
    }

    #[test]
    fn what_is_not_said_is_told_from_what_is() {
        #[derive(Parser)]
        struct Said {
            #[command(flatten)]
            asked: Asked,
        }
        let said = |words: &[&str]| Said::try_parse_from(words).expect("they are options").asked.is_default();
        assert!(said(&[""]));
        assert!(!said(&["", "--bound=5"]) && !said(&["", "--dialect=hyperqb1"]));
        assert!(!said(&["", "a.hp"]) && !said(&["", "--timeout=5"]) && !said(&["", "--seed=1"]));
    }
}
