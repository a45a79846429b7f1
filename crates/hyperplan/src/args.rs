//! What may be typed. What is meant by it is decided in [`crate::config`].

mod certify;
mod compare;
mod explain;
mod families;
mod verify;

pub(crate) use certify::Certify;
pub(crate) use compare::{Asked, Compare, Settings, Shard};
pub(crate) use explain::Explain;
pub(crate) use families::Family;
pub(crate) use verify::Verify;

pub(crate) use crate::reading::{Others, Reading};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use hyperplan::foreign::Foreign;
use hyperplan_import::Known;
use hyperplan_problem::Difference;
use hyperplan_problem::answer::{Quantifiers, States, WitnessPath};
use std::path::PathBuf;

/// Plans robot motion from objectives that relate several paths at once.
#[derive(Debug, Parser)]
#[command(name = "hyperplan", version, max_term_width = 100, after_help = AFTER_HELP)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
    #[command(flatten)]
    pub(crate) global: Global,
}

const AFTER_HELP: &str = "Exit status: 0 realizable, or the property holds; 1 unrealizable; 2 bad usage or input, \
or something not supported; 3 undecided; 4 a solver failed; 5 a bug in hyperplan. Of several objectives, the largest.";

/// Options of every command.
#[derive(Clone, Debug, Args)]
pub(crate) struct Global {
    /// Nothing but the result: no warnings, no progress
    #[arg(long, global = true)]
    pub(crate) quiet: bool,
    /// More detail, such as the time of each stage
    #[arg(short, long, global = true, conflicts_with = "quiet")]
    pub(crate) verbose: bool,
    /// When to use colors
    #[arg(long, global = true, value_enum, value_name = "WHEN", default_value_t = ColorWhen::Auto)]
    pub(crate) color: ColorWhen,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorWhen {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    Always,
    Never,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    #[default]
    Text,
    /// One JSON object a line
    Json,
}

/// How `solve` prints what it finds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SolveFormat {
    #[default]
    Text,
    /// One JSON object a line
    Json,
    /// A table with commas: a row a step, with the action taken there
    Csv,
    /// `nav_msgs/Path` messages as YAML
    Ros,
    /// A line for each path, with its actions and states
    Geojson,
    /// Actions as VAL reads them
    Pddl,
    /// Traces as NuSMV shows them, in the names of its model
    Nusmv,
}

/// A problem file and how to read it.
#[derive(Clone, Debug, Args)]
pub(crate) struct Problem {
    /// The problem file (.hp); `-` is standard input. Or a model of another tool (.smv, .aag, .aig, .txt, .pddl), with
    /// further models and the formula (.hq) behind it
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Replaces the value of a constant
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, String)>,
    /// What is read instead, where the file is one of another tool.
    #[arg(skip)]
    pub(crate) foreign: Option<Foreign>,
}

/// Which objective, and how to print what comes of it.
#[derive(Clone, Debug, Args)]
pub(crate) struct Selection {
    /// The objective, or `all`; needed only where the file has several
    #[arg(long, value_name = "NAME")]
    pub(crate) objective: Option<String>,
}

#[derive(Clone, Debug, Args)]
pub(crate) struct Output {
    /// How results are printed
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    pub(crate) format: Format,
}

/// The ways to decide quantifiers, with what they mean.
fn quantifiers() -> impl TypedValueParser<Value = Quantifiers> {
    let help = |value| match value {
        Quantifiers::Auto => "Whatever suits the objective and the solver",
        Quantifiers::Keep => "Leave quantifiers to the solver",
        Quantifiers::Expand => "Copies of the formula for every case, without quantifiers",
        Quantifiers::Cegis => "Counterexample-guided",
        Quantifiers::Explicit => "Without a solver: a search over what the other player may be doing",
    };
    let values = Quantifiers::ALL.iter().map(|&value| PossibleValue::new(value.name()).help(help(value)));
    PossibleValuesParser::new(values.collect::<Vec<_>>()).try_map(|name| name.parse())
}

/// The ways to write states, with what they mean; `auto` is none of them.
fn states() -> impl TypedValueParser<Value = Option<States>> {
    let help = |value| match value {
        States::Onehot => "A Boolean for each possible state",
        States::Bitvec => "A bit-vector for each variable",
        States::Int => "An integer for each variable; a real for each that is one",
        States::Enum => "A value of a datatype for each state",
        States::Real => "A real for each variable",
    };
    let values = States::ALL.iter().map(|&value| PossibleValue::new(value.name()).help(help(value)));
    let values: Vec<PossibleValue> = std::iter::once(PossibleValue::new("auto")).chain(values).collect();
    PossibleValuesParser::new(values).map(|name| name.parse().ok())
}

/// What strategies may differ in, with what it means.
fn differences() -> impl TypedValueParser<Value = Difference> {
    let help = |value| match value {
        Difference::Cells => "Where paths are: cells of maps, nodes of graphs, else all variables",
        Difference::Actions => "What paths do",
    };
    let values = Difference::ALL.iter().map(|&value| PossibleValue::new(value.name()).help(help(value)));
    PossibleValuesParser::new(values.collect::<Vec<_>>()).try_map(|name| name.parse())
}

/// How a query is built.
#[derive(Clone, Debug, Args)]
pub(crate) struct Encoding {
    /// How quantifiers are decided
    #[arg(long, value_parser = quantifiers(), value_name = "HOW", default_value_t = Quantifiers::Auto)]
    pub(crate) quantifiers: Quantifiers,
    /// How states are represented
    #[arg(long, value_parser = states(), value_name = "HOW", default_value = "auto")]
    // By its full name it is a value, not an option that may be left out.
    pub(crate) states: ::std::option::Option<States>,
    /// Seconds for the whole command
    #[arg(long, value_name = "SECONDS")]
    pub(crate) timeout: Option<f64>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Find a strategy, verify it, print it
    Solve(Solve),
    /// Write SMT-LIB 2
    Emit(Box<Emit>),
    /// Say how much of each path matters, and why
    Horizon(Horizon),
    /// Say what is wrong with a problem file, or doubtful
    Check(Check),
    /// Check a strategy without any solver
    Verify(Verify),
    /// Say why an objective is unrealizable, has a counterexample, or why a strategy fails
    Explain(Explain),
    /// Check certificates that there is no strategy, without any solver
    Certify(Certify),
    /// Draw the map, with the paths of a strategy
    Plot(Plot),
    /// Write a problem file from models and formulas of other tools
    Import(Import),
    /// Run solvers and encodings over problems, and say who is right and who is fast
    Compare(Box<Compare>),
    /// List the solvers that were found
    Solvers(Solvers),
    /// Show the built-in templates
    Templates(Templates),
    /// Write a commented problem file to begin with
    New(New),
    /// Print a shell's completions
    Completions(Completions),
    /// Print the manual page, or write all of them
    Man(Man),
    /// Measures one run of a comparison, which is read from standard input
    #[command(hide = true)]
    Supervise,
}

#[derive(Debug, Args)]
pub(crate) struct Solve {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) others: Others,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// How the answer is printed; `csv`, `ros`, `geojson`, `pddl` and `nusmv`: the strategy alone, for other programs
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = SolveFormat::Text)]
    pub(crate) format: SolveFormat,
    #[command(flatten)]
    pub(crate) encoding: Encoding,
    /// `builtin`, `cadical`, `batsat`, `z3`, `cvc5`, `yices`, `bitwuzla`, a name in hyperplan.toml, or a command line;
    /// several, separated by commas, race each other
    #[arg(long, value_name = "SOLVER", default_value = "builtin")]
    pub(crate) solver: String,
    /// Asks this solver too whether what the other finds impossible is so
    #[arg(long, value_name = "SOLVER")]
    pub(crate) cross_check: Option<String>,
    /// Most memory of each solver process; the builtin one stops when hyperplan itself has grown by so much
    #[arg(long, value_name = "MIB")]
    pub(crate) memory: Option<u64>,
    /// Finds the least value of a constant, such as T, for which the objective is realizable, and proves that
    /// smaller ones are not; the range is 0 (or the least value that the file allows) up to the constant's value.
    /// Or finds the cheapest strategy: `cost fuel[p]`, in place of what the objective says after `minimize`
    #[arg(long, value_name = "CONST[=LO..HI]|EXPR", value_parser = wish)]
    pub(crate) minimize: Option<Wish>,
    /// Among strategies that are equal in what is to be minimized, prefers those with the least sums of costs, such as
    /// `cost turns[p]`, what counts most first, and proves that none has less
    #[arg(long, value_name = "EXPR", value_parser = sums)]
    pub(crate) prefer: Option<String>,
    /// Finds up to N strategies (or counterexamples), each of which differs from those before it, and says whether there are
    /// others
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000), conflicts_with = "cube")]
    pub(crate) all: Option<u16>,
    /// In what the strategies of --all differ while their paths are not at rest
    #[arg(long, value_parser = differences(), value_name = "WHAT", default_value_t = Difference::Cells, requires = "all")]
    pub(crate) differ: Difference,
    /// Draws the paths into an .svg, .png, .pdf, .gif, .html or .txt file, as `plot` does
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Saves the answer as JSON; into a .csv, .yaml (ROS), .geojson or .plan (PDDL) file the strategy in that format, of
    /// several paths each in a file of its own, FILE-PATH.csv
    #[arg(long, value_name = "FILE")]
    pub(crate) save: Option<PathBuf>,
    /// Keeps every query sent to the solver, with its replies as comments
    #[arg(long, value_name = "DIR")]
    pub(crate) queries: Option<PathBuf>,
    /// Where there is no strategy (or, for `forall`, no counterexample), writes certificates of that into this folder, for
    /// `hyperplan certify`
    #[arg(long, value_name = "DIR")]
    pub(crate) proof: Option<PathBuf>,
    /// Prints the strategy unchecked
    #[arg(long)]
    pub(crate) no_verify: bool,
    /// Prints the strategy that was found first, detours and all
    #[arg(long)]
    pub(crate) first: bool,
    /// Searches in N processes at once, each with these limits: with --minimize of a constant several of its values, and in several
    /// ways, modes of quantifiers, encodings, solvers, seeds, of which only those vary that are not given; the first verified answer that decides
    /// ends the others
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), conflicts_with = "cubes")]
    pub(crate) portfolio: Option<u16>,
    /// Searches in N cases, by where the leading paths are on the way, or what they do first, each in a process with these limits, as many
    /// at once as there are cores
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=10_000))]
    pub(crate) cubes: Option<u16>,
    /// Searches in the I-th of these N cases only: the objective is realizable if one case is (`forall`: if all are)
    #[arg(long, value_name = "I/N", value_parser = case, conflicts_with_all = ["cubes", "portfolio", "proof"])]
    pub(crate) cube: Option<Part>,
    /// Leaves aside what the objective itself wants to be small.
    #[arg(long, hide = true, conflicts_with = "minimize")]
    pub(crate) own_minimize_aside: bool,
    /// Says on standard output too, in JSON, why an objective has no answer: for comparisons
    #[arg(long, hide = true)]
    pub(crate) failures: bool,
    /// Seed of the solver; the same seed gives the same answer where no limit is reached
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
}

/// What is to be as small as possible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Wish {
    /// A constant.
    Constant(Minimize),
    /// Sums of costs, as they are written in problem files.
    Costs(String),
}

/// A constant, and the range of its values where that was given; never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Minimize {
    pub(crate) constant: String,
    pub(crate) range: Option<(i64, i64)>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Track {
    /// One query
    #[default]
    Single,
    /// The dialogue of the search by counterexamples; with `--quantifiers keep`, which steps of a strategy are forced
    Incremental,
    /// One query, and its model
    Model,
    /// One query with named assertions, and an unsatisfiable core
    UnsatCore,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Status {
    /// What solving it finds out
    #[default]
    Auto,
    Sat,
    Unsat,
    Unknown,
}

/// What stands for what paths do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Paths {
    /// A symbol for each time
    Symbols,
    /// Functions of time; a path after a universal one depends on that too
    Functions,
    /// Functions of time, and moves of what is observed as well
    Policies,
}

/// How much is left out of a benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Pruning {
    /// Nothing but states that no path begins in, at the start
    None,
    /// States that cannot be reached by then
    Light,
    /// States through which the objective cannot be met any more, too
    Full,
}

#[derive(Debug, Args)]
pub(crate) struct Emit {
    /// The problem file (.hp)
    #[arg(value_name = "FILE", required_unless_present = "folder")]
    pub(crate) file: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) others: Others,
    #[arg(skip)]
    pub(crate) foreign: Option<Foreign>,
    /// Replaces the value of a constant
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, String)>,
    #[command(flatten)]
    pub(crate) family: Family,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// How quantifiers are written; several, separated by commas, are a file each
    #[arg(long, value_parser = quantifiers(), value_name = "HOW,...", value_delimiter = ',', default_value = "auto")]
    pub(crate) quantifiers: Vec<Quantifiers>,
    /// How states are represented; several are a file each
    #[arg(long, value_parser = states(), value_name = "HOW,...", value_delimiter = ',', default_value = "auto")]
    pub(crate) states: Vec<Option<States>>,
    /// What stands for what paths do; several are a file each
    #[arg(long, value_enum, value_name = "HOW,...", value_delimiter = ',', default_values_t = [Paths::Symbols])]
    pub(crate) paths: Vec<Paths>,
    /// A file for each value of a constant, such as T
    #[arg(long, value_name = "CONST=LO..HI", value_parser = range)]
    pub(crate) each: Option<(String, i64, i64)>,
    /// What it is written in; without it, what --solver reads, else SMT-LIB 2
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with = "folder")]
    pub(crate) format: Option<EmitFormat>,
    /// The track of SMT-COMP that the file is for
    #[arg(long, value_enum, value_name = "TRACK", default_value_t = Track::Single)]
    pub(crate) track: Track,
    /// The expected answer; `auto` solves first
    #[arg(long, value_enum, value_name = "STATUS", default_value_t = Status::Auto)]
    pub(crate) status: Status,
    /// Where the answer is unsat, also writes a certificate of that beside the benchmark, as `solve --proof` does
    #[arg(long)]
    pub(crate) certify: bool,
    /// The solver to write for; without it, plain SMT-LIB for all
    #[arg(long, value_name = "SOLVER")]
    pub(crate) solver: Option<String>,
    /// A file, or a directory for several; without it, standard output
    #[arg(short, long, value_name = "FILE|DIR")]
    pub(crate) output: Option<PathBuf>,
    /// When it was generated; without it, that of SOURCE_DATE_EPOCH, or today
    #[arg(long, value_name = "YYYY-MM-DD")]
    pub(crate) date: Option<String>,
    /// Who generated it, for the header
    #[arg(long, value_name = "NAME")]
    pub(crate) author: Option<String>,
    /// No comments that say what follows
    #[arg(long)]
    pub(crate) no_comments: bool,
    /// What says which states of a time are in the benchmark: the goal too, the steps until then only, or nothing; the
    /// less, the larger and the harder it is; several are a file each [default: full; families: light]
    #[arg(long, value_enum, value_name = "HOW,...", value_delimiter = ',', conflicts_with = "no_pruning")]
    pub(crate) pruning: Vec<Pruning>,
    /// The same as `--pruning light`
    #[arg(long)]
    pub(crate) no_pruning: bool,
    /// Seconds for the whole command
    #[arg(long, value_name = "SECONDS")]
    pub(crate) timeout: Option<f64>,
}

/// What a benchmark is written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EmitFormat {
    /// SMT-LIB 2
    Smt2,
    /// Gates with quantifiers: QCIR-14, prenex and cleansed
    Qcir,
    /// Clauses with quantifiers: QDIMACS 1.1
    Qdimacs,
    /// Clauses, with quantifiers expanded: DIMACS
    Dimacs,
}

/// Seeds, in the order in which they were named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Seeds(pub(crate) Vec<u64>);

#[derive(Debug, Args)]
pub(crate) struct Horizon {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) others: Others,
    #[command(flatten)]
    pub(crate) limit: Limit,
    #[command(flatten)]
    pub(crate) selection: Selection,
    #[command(flatten)]
    pub(crate) output: Output,
}

/// When a command that needs no solver has to end.
#[derive(Debug, Args)]
pub(crate) struct Limit {
    /// Seconds for the whole command
    #[arg(long, value_name = "SECONDS")]
    pub(crate) timeout: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct Import {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) others: Others,
    /// What is known of the formula: it is kept in a comment, for `compare`
    #[arg(long, value_parser = crate::reading::known(), value_name = "WORD")]
    pub(crate) status: Option<Known>,
    /// The problem file; without it, standard output
    #[arg(short, long, value_name = "FILE.hp")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) others: Others,
    /// Exit status 2 if there is a warning
    #[arg(short = 'D', long)]
    pub(crate) deny_warnings: bool,
    /// How messages are printed; `json`: one object a line on standard output, for editors
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Text)]
    pub(crate) format: Format,
    /// Prints the file, formatted, instead of what is doubtful; a file with errors is not printed
    #[arg(long, conflicts_with_all = ["format", "timeout", "deny_warnings"])]
    pub(crate) print: bool,
    #[command(flatten)]
    pub(crate) limit: Limit,
}

/// A strategy of the user's.
#[derive(Debug, Args)]
pub(crate) struct Plan {
    /// A strategy, as `solve --save` and `solve --format json|csv|geojson|pddl` write it, or the files with its paths; `-` is
    /// standard input
    #[arg(value_name = "STRATEGY")]
    pub(crate) strategy: Vec<PathBuf>,
    /// A strategy by its actions, `p=up,up,right`, once for each path; the states follow from them
    #[arg(long, value_name = "PATH=ACTION,...", value_parser = path_of_actions)]
    pub(crate) actions: Vec<WitnessPath>,
}

#[derive(Debug, Args)]
pub(crate) struct Plot {
    #[command(flatten)]
    pub(crate) problem: Problem,
    #[command(flatten)]
    pub(crate) limit: Limit,
    #[command(flatten)]
    pub(crate) plan: Plan,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) selection: Selection,
    /// An .svg, .png, .pdf, .gif, .html or .txt file; without it, text on standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Writes a picture for each time into this folder, as PNG, or as SVG if --output is one
    #[arg(long, value_name = "DIR")]
    pub(crate) frames: Option<PathBuf>,
    /// Makes an SVG that moves by itself
    #[arg(long, requires = "output")]
    pub(crate) animate: bool,
    /// Which of several strategies of the file is drawn, from 1
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) number: Option<u16>,
    /// Draws these paths only; without it, those of the strategy, and of the paths that it has to cope with the worst
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) path: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct Solvers {
    /// Only allows the hyperplan.toml of this folder (or of the nearest above it) to say which programs are run, until it
    /// changes
    #[arg(long)]
    pub(crate) trust: bool,
    /// Only takes that back
    #[arg(long, alias = "untrust", conflicts_with = "trust")]
    pub(crate) no_trust: bool,
    #[command(flatten)]
    pub(crate) output: Output,
}

#[derive(Debug, Args)]
pub(crate) struct New {
    /// The file (.hp), which must not be there yet; without it, standard output
    pub(crate) file: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell that is to read them
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// The command; without it, hyperplan itself
    #[arg(conflicts_with = "output")]
    pub(crate) command: Option<String>,
    /// Writes the pages of all commands into this folder
    #[arg(short, long, value_name = "DIR")]
    pub(crate) output: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Templates {
    /// One template; without it, all
    pub(crate) name: Option<String>,
}

fn setting(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("expected NAME=VALUE, such as T=8".to_owned()),
    }
}

/// A path by its actions.
fn path_of_actions(text: &str) -> Result<WitnessPath, String> {
    let expected = || "expected PATH=ACTION,ACTION,..., such as p=up,up,right".to_owned();
    let (path, actions) = text.split_once('=').ok_or_else(expected)?;
    let (path, actions) = (path.trim().to_owned(), actions.trim());
    if path.is_empty() {
        return Err(expected());
    }
    let actions = match actions {
        "" => Vec::new(),
        some => some.split(',').map(|action| action.trim().to_owned()).collect(),
    };
    Ok(WitnessPath { path, system: String::new(), actions, states: Vec::new(), positions: None })
}

/// One of so many parts, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) index: usize,
    pub(crate) of: usize,
}

/// One of at most so many parts, as it is written.
fn part(text: &str, most: usize) -> Result<Part, String> {
    let number = |text: &str| text.trim().parse::<usize>().ok();
    match text.split_once('/').and_then(|(index, of)| number(index).zip(number(of))) {
        Some((index, of)) if index >= 1 && index <= of && of <= most => Ok(Part { index: index - 1, of }),
        Some(_) => Err(format!("expected one from 1/N to N/N, with N at most {most}")),
        None => Err("expected one of several, such as 1/4".to_owned()),
    }
}

/// More cases are hardly meant: each is a process.
const MOST_CUBES: usize = 10_000;

fn case(text: &str) -> Result<Part, String> {
    part(text, MOST_CUBES)
}

/// The greatest number that a range may have, as in problem files; differences of two of them are numbers still.
const GREATEST: u64 = (1 << 62) - 1;

fn range(text: &str) -> Result<(String, i64, i64), String> {
    match minimize(text)? {
        Minimize { constant, range: Some((lo, hi)) } => Ok((constant, lo, hi)),
        Minimize { constant, range: None } => Err(format!("expected a range, such as {constant}=4..20")),
    }
}

fn wish(text: &str) -> Result<Wish, String> {
    // Costs are read of paths, and neither constants nor ranges have brackets.
    if text.contains('[') { Ok(Wish::Costs(text.to_owned())) } else { minimize(text).map(Wish::Constant) }
}

/// Sums of costs of paths.
fn sums(text: &str) -> Result<String, String> {
    match text.contains('[') {
        true => Ok(text.to_owned()),
        false => {
            Err("expected costs of paths, such as `cost turns[p]`; what a step costs is said in the system, \
                      `cost turns = ...;`"
                .to_owned())
        }
    }
}

fn minimize(text: &str) -> Result<Minimize, String> {
    let (constant, range) = text.split_once('=').map_or((text, None), |(name, range)| (name, Some(range)));
    let constant = constant.trim().to_owned();
    if constant.is_empty() {
        return Err("expected CONST or CONST=LO..HI, such as T or T=4..20".to_owned());
    }
    let Some(range) = range else { return Ok(Minimize { constant, range: None }) };
    let number = |text: &str| text.trim().parse::<i64>().ok().filter(|n| n.unsigned_abs() <= GREATEST);
    let ends = range.split_once("..").and_then(|(lo, hi)| number(lo).zip(number(hi)));
    match ends {
        None => Err(format!("expected a range of integers after `{constant}=`, such as {constant}=4..20")),
        Some((lo, hi)) if lo > hi => Err(format!("the range {lo}..{hi} is empty")),
        range => Ok(Minimize { constant, range }),
    }
}

/// More maps than this in one range are hardly meant.
const MOST_SEEDS: u64 = 100_000;

fn seeds(text: &str) -> Result<Seeds, String> {
    let mut seeds = Vec::new();
    for part in text.split(',') {
        let number = |text: &str| text.trim().parse::<u64>().ok();
        let (lo, hi) = part.split_once("..").unwrap_or((part, part));
        match number(lo).zip(number(hi)) {
            Some((lo, hi)) if hi < lo => return Err(format!("the range {part} is empty")),
            Some((lo, hi)) if hi - lo >= MOST_SEEDS => {
                return Err(format!("the range {part} has more than {MOST_SEEDS} seeds"));
            }
            Some((lo, hi)) => seeds.extend(lo..=hi),
            None => return Err("expected numbers or ranges of them, such as 3 or 0..9".to_owned()),
        }
    }
    Ok(Seeds(seeds))
}
