//! Who was compared on what: the records, sorted into a table of contestants by instances.

use std::collections::{BTreeMap, BTreeSet};

use hyperplan_problem::answer::ReasonCode;

use crate::{Answer, Record, RunStatus};
use hyperplan_outlet::one_line;

/// What takes part in a comparison: a solver together with everything that was chosen for it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Contestant<'a> {
    /// The solver, as it was asked for.
    pub solver: &'a str,
    /// How quantifiers were decided; `None` for queries.
    pub quantifiers: Option<&'a str>,
    /// How states were written; `None` for queries.
    pub states: Option<&'a str>,
    /// What the solver says its version is.
    pub version: Option<&'a str>,
    /// Further options.
    pub options: &'a str,
    /// The solver with no more of the rest than tells it from the other contestants.
    pub label: String,
}

/// What was asked: a file with its constants. Files that changed in between are different instances.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Row<'a> {
    /// Its folder.
    pub family: &'a str,
    /// The file, and for a problem file the objective.
    pub name: &'a str,
    /// The constants that were set.
    pub set: &'a [String],
    /// Of the file's bytes.
    pub sha256: &'a str,
    /// The name with its constants, and the beginning of the hash where the name alone is ambiguous.
    pub label: String,
}

/// The runs of one contestant on one instance.
#[derive(Clone, Debug)]
pub struct Cell<'a> {
    /// All of them, in the order of seeds and repetitions.
    pub runs: Vec<&'a Record>,
    /// The one that stands for all: the median.
    pub median: &'a Record,
    /// Some run gave an answer that is known to be wrong, or one that failed its check.
    pub wrong: bool,
}

/// The records as a table.
#[derive(Clone, Debug)]
pub struct Contest<'a> {
    /// The contestants, in order.
    pub contestants: Vec<Contestant<'a>>,
    /// The instances, by family and name.
    pub instances: Vec<Row<'a>>,
    /// By instance and contestant; `None` where nothing was run.
    pub cells: Vec<Vec<Option<Cell<'a>>>>,
    /// Of each instance, the answer that is known to be right.
    pub truth: Vec<Option<Answer>>,
    /// Of each instance, whether both answers were given and nothing says which is right.
    pub disputed: Vec<bool>,
}

impl<'a> Contest<'a> {
    /// Sorts the records.
    pub fn new(records: &'a [Record]) -> Self {
        let versions = Versions::new(records);
        let mut table: BTreeMap<_, BTreeMap<_, Vec<&Record>>> = BTreeMap::new();
        for record in records {
            let contestant = Contestant {
                solver: &record.solver,
                quantifiers: record.quantifiers.as_deref(),
                states: record.states.as_deref(),
                version: versions.of(record),
                options: &record.options,
                label: String::new(),
            };
            table.entry(instance(record)).or_default().entry(contestant).or_default().push(record);
        }
        let contestants: BTreeSet<_> = table.values().flat_map(BTreeMap::keys).cloned().collect();
        let mut contest = Self {
            contestants: contestants.into_iter().collect(),
            instances: table.keys().cloned().collect(),
            cells: Vec::new(),
            truth: Vec::new(),
            disputed: Vec::new(),
        };
        for mut row in table.into_values() {
            let runs: Vec<&Record> = row.values().flatten().copied().collect();
            let truth = truth(&runs);
            contest.truth.push(truth);
            contest.disputed.push(truth.is_none() && disputed(&runs));
            let cell = |who| row.remove(who).and_then(|runs| Cell::new(runs, truth));
            contest.cells.push(contest.contestants.iter().map(cell).collect());
        }
        label_contestants(&mut contest.contestants);
        label_instances(&mut contest.instances);
        contest
    }

    /// The answer to an instance, in a word: the one that is known to be right, or was given, or that nobody knows.
    pub fn answer(&self, instance: usize) -> String {
        let given = || self.cells[instance].iter().flatten().find_map(Cell::solved);
        match (self.disputed[instance], self.truth[instance].or_else(given)) {
            (true, _) => "disputed".to_owned(),
            (false, Some(answer)) => answer.to_string(),
            (false, None) => "unknown".to_owned(),
        }
    }

    /// The one contestant that solved an instance, if it was only one.
    pub fn only(&self, instance: usize) -> Option<usize> {
        let row = self.cells[instance].iter().enumerate();
        let mut solved = row.filter(|(_, cell)| cell.as_ref().is_some_and(|cell| cell.solved().is_some()));
        let (first, _) = solved.next()?;
        solved.next().is_none().then_some(first)
    }

    /// The cells of one contestant, with the number of the instance.
    pub fn column(&self, contestant: usize) -> impl Iterator<Item = (usize, &Cell<'a>)> {
        self.cells
            .iter()
            .enumerate()
            .filter_map(move |(i, row)| row[contestant].as_ref().map(|cell| (i, cell)))
    }

    /// All runs, by instance.
    pub(crate) fn runs(&self) -> impl Iterator<Item = &'a Record> {
        self.cells.iter().flatten().flatten().flat_map(|cell| cell.runs.iter().copied())
    }

    /// The largest wall time that any run was allowed, or took where nothing was said; what a plot has to show.
    pub fn longest(&self) -> f64 {
        self.runs().map(|run| allowed(run).unwrap_or(run.wall_s)).fold(0.0, f64::max)
    }

    /// The wall time that every run was allowed, if it was the same for all.
    pub fn limit(&self) -> Option<f64> {
        let mut limits = self.runs().map(allowed);
        let first = limits.next()??;
        limits.all(|limit| limit == Some(first)).then_some(first)
    }
}

impl<'a> Cell<'a> {
    /// Of runs that ended sooner or later, the middle one, where those without an answer come last; of an even number the
    /// later of the two, so that a contestant that solves an instance every other time has not solved it. Unlike the mean
    /// of two runs, it is a run, with a status. Runs of what a contestant does not support do not count among others.
    fn new(mut runs: Vec<&'a Record>, truth: Option<Answer>) -> Option<Self> {
        runs.sort_by_key(|run| (run.seed, run.repetition));
        let mut order = runs.clone();
        if order.iter().any(|run| run.status != RunStatus::Unsupported) {
            order.retain(|run| run.status != RunStatus::Unsupported);
        }
        order.sort_by(|a, b| {
            let key = |run: &Record| (answer(run).is_none(), run.status);
            key(a).0.cmp(&key(b).0).then(a.wall_s.total_cmp(&b.wall_s)).then(key(a).1.cmp(&key(b).1))
        });
        let median = *order.get(order.len() / 2)?;
        let wrong = runs.iter().any(|run| is_wrong(run, truth));
        Some(Self { runs, median, wrong })
    }

    /// The answer of the median run, if no run was wrong.
    pub fn solved(&self) -> Option<Answer> {
        answer(self.median).filter(|_| !self.wrong)
    }

    /// What the median run says, wrong or not.
    pub fn says(&self) -> Option<Answer> {
        answer(self.median)
    }

    /// Whether it counts: what a contestant does not support is not held against it.
    pub fn counts(&self) -> bool {
        self.median.status != RunStatus::Unsupported
    }
}

/// The versions of each solver, as far as runs said them. One that crashed says none, another no more than the beginning; where
/// it can be only one, that is meant.
struct Versions<'a>(BTreeMap<&'a str, BTreeSet<&'a str>>);

impl<'a> Versions<'a> {
    fn new(records: &'a [Record]) -> Self {
        let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for record in records {
            versions.entry(&record.solver).or_default().extend(record.version.as_deref());
        }
        for known in versions.values_mut() {
            let full = |version: &&str| !known.iter().any(|other| is_beginning(version, other));
            *known = known.iter().copied().filter(full).collect();
        }
        Self(versions)
    }

    fn of(&self, record: &'a Record) -> Option<&'a str> {
        let said = record.version.as_deref();
        let known = self.0.get(record.solver.as_str())?;
        let mut meant = known.iter().copied().filter(|full| match said {
            Some(version) => version == *full || is_beginning(version, full),
            None => true,
        });
        match (meant.next(), meant.next()) {
            (Some(version), None) => Some(version),
            _ => said,
        }
    }
}

/// Whether a version is the same with less said: `1.0` of `1.0 (a build)`.
fn is_beginning(version: &str, other: &str) -> bool {
    other.strip_prefix(version).is_some_and(|rest| rest.starts_with(' '))
}

/// What a run says, whether or not it is right.
pub(crate) fn answer(run: &Record) -> Option<Answer> {
    match run.status {
        RunStatus::Sat => Some(Answer::Sat),
        RunStatus::Unsat => Some(Answer::Unsat),
        RunStatus::Unknown
        | RunStatus::Timeout
        | RunStatus::Memout
        | RunStatus::Error
        | RunStatus::Unsupported => None,
    }
}

/// Whether a run's witness failed its check.
pub(crate) fn is_refuted(run: &Record) -> bool {
    run.verified.as_deref() == Some("refuted")
}

/// Whether an SMT-LIB file was run.
pub(crate) fn is_query(record: &Record) -> bool {
    record.quantifiers.is_none() && record.states.is_none()
}

/// Whether the model fails, which is the solver's fault. Of a query it is the solver that is checked; hyperplan itself tells a
/// model that does not satisfy its query (exit status 4) from a strategy that its own checker refutes (5).
pub(crate) fn is_wrong_model(record: &Record) -> bool {
    let blamed = record.exit_code == Some(4) || is_query(record);
    is_refuted(record) && blamed || record.reason_code == Some(ReasonCode::WrongModel)
}

/// Whether the strategy fails though nobody blames the model.
pub(crate) fn is_refuted_strategy(record: &Record) -> bool {
    !is_query(record) && !is_wrong_model(record) && (is_refuted(record) || record.exit_code == Some(5))
}

/// Whether it is known that a run's answer is wrong.
fn is_wrong(run: &Record, truth: Option<Answer>) -> bool {
    is_wrong_model(run)
        || is_refuted_strategy(run)
        || truth.is_some() && answer(run).is_some_and(|answer| Some(answer) != truth)
}

/// Whether an answer came with a witness that was checked without any solver.
pub(crate) fn is_certified(run: &Record) -> bool {
    matches!(run.verified.as_deref(), Some("by-search" | "model")) && answer(run).is_some()
}

/// The wall time that a run was allowed.
pub(crate) fn allowed(run: &Record) -> Option<f64> {
    run.limit.wall_s.or(run.limit.cpu_s)
}

/// The answer that is known to be right: one with a checked witness, or else the expected one. Where witnesses contradict
/// each other nothing is known.
fn truth(runs: &[&Record]) -> Option<Answer> {
    let agreed = |answers: BTreeSet<Answer>| if answers.len() == 1 { answers.first().copied() } else { None };
    let certified = runs.iter().filter(|run| is_certified(run)).filter_map(|run| answer(run));
    let certified: BTreeSet<Answer> = certified.collect();
    if certified.is_empty() {
        agreed(runs.iter().filter_map(|run| run.expected).collect())
    } else {
        agreed(certified)
    }
}

/// Whether both answers were given, by runs that did not fail their check.
fn disputed(runs: &[&Record]) -> bool {
    let said = |what| runs.iter().any(|run| answer(run) == Some(what) && !is_refuted(run));
    said(Answer::Sat) && said(Answer::Unsat)
}

fn instance(record: &Record) -> Row<'_> {
    Row {
        family: &record.family,
        name: &record.instance,
        set: &record.set,
        sha256: &record.sha256,
        label: String::new(),
    }
}

/// The folder that all absolute paths among some names have in common, with its `/`; nothing where one is not absolute.
/// What is on the way to it says nothing, and would fill a table.
fn common<'n>(names: impl IntoIterator<Item = &'n str>) -> &'n str {
    let folder = |name: &'n str| name.rsplit_once('/').map_or("", |(folder, _)| &name[..=folder.len()]);
    let mut names = names.into_iter();
    let mut common = names.next().map_or("", folder);
    for name in names {
        while !name.starts_with(common) {
            common = folder(common.trim_end_matches('/'));
        }
    }
    if common.starts_with('/') { common } else { "" }
}

/// Tells instances of one name apart.
fn label_instances(instances: &mut [Row<'_>]) {
    let folder = common(instances.iter().map(|instance| instance.name)).len();
    for instance in &mut *instances {
        let words: Vec<&str> =
            [&instance.name[folder..]].into_iter().chain(instance.set.iter().map(String::as_str)).collect();
        instance.label = one_line(&words.join(" ")).into_owned();
    }
    let mut labels: BTreeMap<String, usize> = BTreeMap::new();
    for instance in &*instances {
        *labels.entry(instance.label.clone()).or_default() += 1;
    }
    for instance in instances.iter_mut().filter(|instance| labels[&instance.label] > 1) {
        let hash: String = instance.sha256.chars().take(8).collect();
        instance.label = format!("{} ({hash})", instance.label);
    }
}

fn label_contestants(contestants: &mut [Contestant<'_>]) {
    let mut versions: BTreeMap<&str, BTreeSet<Option<&str>>> = BTreeMap::new();
    for who in &*contestants {
        versions.entry(who.solver).or_default().insert(who.version);
    }
    // A choice is worth saying if it was not the same for everyone who had it: solvers that got a query by themselves had none.
    let problems: Vec<&Contestant<'_>> = contestants.iter().filter(|who| who.quantifiers.is_some()).collect();
    let quantifiers_vary = problems.iter().any(|who| who.quantifiers != problems[0].quantifiers);
    let states_vary = problems.iter().any(|who| who.states != problems[0].states);
    let options_vary = problems.iter().any(|who| who.options != problems[0].options);
    let both = !problems.is_empty() && problems.len() < contestants.len();
    for who in contestants {
        let hyperplan = (both && who.quantifiers.is_some()).then_some("hyperplan");
        let version = who.version.unwrap_or("(version unknown)");
        let parts = [
            hyperplan,
            Some(who.solver),
            Some(version).filter(|_| versions[who.solver].len() > 1),
            who.quantifiers.filter(|_| quantifiers_vary),
            who.states.filter(|_| states_vary),
            Some(who.options).filter(|options| options_vary && !options.is_empty()),
        ];
        let parts: Vec<&str> = parts.into_iter().flatten().collect();
        who.label = one_line(&parts.join(" ")).into_owned();
    }
}

#[cfg(test)]
mod tests {
    use super::common;

    #[test]
    fn absolute_paths_are_shown_from_their_common_folder_on() {
        assert_eq!(common(["/a/b/c.smt2", "/a/b/d.smt2"]), "/a/b/");
        assert_eq!(common(["/a/b/c.smt2", "/a/bc/d.smt2"]), "/a/");
        assert_eq!(common(["/a/b/c.smt2", "/b/d.smt2"]), "/");
        assert_eq!(common(["/a/b/c.hp#o"]), "/a/b/");
        assert_eq!(common(["/a/b.smt2", "b.smt2"]), "");
        assert_eq!(common(["a/b.smt2", "a/c.smt2"]), "");
        assert_eq!(common([]), "");
    }
}
