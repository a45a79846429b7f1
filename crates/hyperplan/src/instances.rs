//! The instances of a comparison: which files, and what is asked of each.

use crate::args;
use crate::failure::{Failure, Result};
use crate::files::{read_bytes, reason};
use crate::output::Output;
use crate::report;
use hyperplan::disk::Beside;
use hyperplan_compare::plan::{Instance, Kind, sha256};
use hyperplan_compare::{Answer, Query};
use hyperplan_horizon::horizons;
use hyperplan_problem::{KnownStatus, Loader, Lowered, Overrides, Problem, Value, read};
use hyperplan_syntax::{Diagnostic, SourceMap};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The most combinations of constants.
const COMBINATIONS: usize = 100_000;

/// All instances, in the order of the files. Files that cannot be read are all told of, and then nothing is run, unless
/// they are to be left out.
pub(crate) fn instances(args: &args::Asked, out: &Output) -> Result<Vec<Arc<Instance>>> {
    let files = files(&args.files)?;
    let sets = combinations(&args.set)?;
    let mut instances = Vec::new();
    let mut seen = BTreeSet::new();
    let mut bad = 0;
    for file in &files {
        // What is left out is told of in a line.
        let told = (!args.skip_bad).then_some(out);
        match of_file(file, &sets, &args.objective, &mut seen, told) {
            Ok(found) => instances.extend(found.into_iter().map(Arc::new)),
            Err(failure) => {
                bad += 1;
                if args.skip_bad {
                    out.remark(format_args!("left out: {}", failure.message));
                } else {
                    out.failure(&failure);
                }
            }
        }
    }
    let unknown = args.objective.iter().find(|name| *name != "all" && !seen.contains(*name));
    match unknown {
        _ if bad > 0 && (!args.skip_bad || bad == files.len()) => Err(Failure::input(format_args!(
            "{bad} of {} files cannot be used; nothing was run{}",
            files.len(),
            if args.skip_bad { "" } else { ": correct them, or leave them out with --skip-bad" }
        ))),
        Some(name) => Err(Failure::input(format_args!("no file has an objective `{name}`"))),
        None if instances.is_empty() => {
            Err(Failure::input("there is nothing to run: no file has an objective"))
        }
        None => Ok(instances),
    }
}

/// The files that arguments mean, each once, in the order of the arguments, those of a folder or a pattern by name.
fn files(arguments: &[String]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut known = BTreeSet::new();
    for argument in arguments {
        let path = PathBuf::from(argument);
        let before = files.len();
        let mut duplicate = false;
        for file in expand(&path, argument)? {
            // By another name it is the same file.
            if known.insert(file.canonicalize().unwrap_or_else(|_| file.clone())) {
                files.push(file);
            } else {
                duplicate = true;
            }
        }
        if files.len() == before && !duplicate {
            return Err(Failure::input(format_args!("{argument} has no .hp or .smt2 file")));
        }
    }
    Ok(files)
}

fn expand(path: &Path, argument: &str) -> Result<Vec<PathBuf>> {
    let cannot =
        |path: &Path, why: String| Failure::input(format_args!("cannot read {}: {why}", path.display()));
    if path.is_dir() {
        return walk(path);
    }
    if path.exists() || !argument.contains(['*', '?', '[']) {
        return Ok(vec![path.to_owned()]);
    }
    let matches = glob::glob(argument)
        .map_err(|error| Failure::input(format_args!("{argument} is no pattern: {}", error.msg)))?;
    let mut found = Vec::new();
    for path in matches {
        let path = path.map_err(|error| cannot(error.path(), reason(error.error())))?;
        if path.is_dir() {
            found.extend(walk(&path)?);
        } else if is_input(&path) {
            found.push(path);
        }
    }
    Ok(found)
}

/// The problem and SMT-LIB files in a folder and those below it. Links to folders are not followed.
fn walk(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let cannot =
            |error| Failure::input(format_args!("cannot read {}: {}", folder.display(), reason(&error)));
        for entry in std::fs::read_dir(&folder).map_err(cannot)? {
            let entry = entry.map_err(cannot)?;
            if entry.file_type().map_err(cannot)?.is_dir() {
                folders.push(entry.path());
            } else if is_input(&entry.path()) {
                found.push(entry.path());
            }
        }
    }
    found.sort();
    Ok(found)
}

fn is_input(path: &Path) -> bool {
    path.is_file() && (is_query(path) || path.extension().is_some_and(|extension| extension == "hp"))
}

fn is_query(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "smt2" || extension == "smt")
}

/// Every combination of the constants' values.
fn combinations(settings: &[args::Settings]) -> Result<Vec<Vec<(String, String)>>> {
    let mut combinations = vec![Vec::new()];
    for args::Settings { name, values } in settings {
        if combinations.len().saturating_mul(values.len()) > COMBINATIONS {
            return Err(Failure::input(format_args!("--set makes more than {COMBINATIONS} combinations")));
        }
        let extended = combinations.iter().flat_map(|combination| {
            values.iter().map(|value| {
                let mut combination: Vec<(String, String)> = combination.clone();
                combination.push((name.clone(), value.clone()));
                combination
            })
        });
        combinations = extended.collect();
    }
    Ok(combinations)
}

fn of_file(
    file: &Path,
    sets: &[Vec<(String, String)>],
    objectives: &[String],
    seen: &mut BTreeSet<String>,
    out: Option<&Output>,
) -> Result<Vec<Instance>> {
    let cannot = |why: String| Failure::input(format_args!("cannot read {}: {why}", file.display()));
    let name = file.to_str().ok_or_else(|| cannot("its name is not in UTF-8".to_owned()))?;
    let bytes = read_bytes(file).map_err(|error| cannot(reason(&error)))?;
    let parent = file.parent().and_then(Path::to_str).filter(|folder| !folder.is_empty());
    let instance = |kind| Instance {
        name: name.to_owned(),
        family: parent.unwrap_or(".").to_owned(),
        file: name.to_owned(),
        sha256: sha256(&bytes),
        others: String::new(),
        set: Vec::new(),
        horizon: None,
        expected: None,
        kind,
    };
    if is_query(file) {
        let query = Query::scan(&String::from_utf8_lossy(&bytes));
        if query.checks.is_empty() {
            return Err(cannot("it has no (check-sat)".to_owned()));
        }
        return Ok(vec![instance(Kind::Query(query))]);
    }
    let text = std::str::from_utf8(&bytes).map_err(|_| cannot("it is not in UTF-8".to_owned()))?;
    let meanings = sets.iter().map(|set| Ok((set, lower(file, text, set, out)?)));
    let meanings: Vec<(&Vec<(String, String)>, Meaning)> = meanings.collect::<Result<_>>()?;
    let known = known(file, text, &meanings);
    let mut found = Vec::new();
    for (set, Meaning { problem, consts, others }) in &meanings {
        for objective in &problem.objectives {
            if !objectives.iter().any(|name| name == "all" || *name == objective.name) {
                continue;
            }
            seen.insert(objective.name.clone());
            found.push(Instance {
                name: format!("{name}#{}", objective.name),
                others: others.clone(),
                set: set.iter().map(|(name, value)| format!("{name}={value}")).collect(),
                horizon: horizons(objective).iter().filter_map(|horizon| horizon.steps).max(),
                expected: expected(&known, &objective.name, consts).map_err(cannot)?,
                ..instance(Kind::Problem { objective: objective.name.clone() })
            });
        }
    }
    Ok(found)
}

/// What a file says is known, each with the values that all constants have then. What it says of values for which it has
/// errors is about nothing. What it means with some constants is known already.
fn known(
    file: &Path,
    text: &str,
    meanings: &[(&Vec<(String, String)>, Meaning)],
) -> Vec<(KnownStatus, Consts)> {
    let read = meanings.iter().map(|(set, meaning)| ((*set).clone(), Some(meaning.consts.clone())));
    let mut consts: BTreeMap<Vec<(String, String)>, Option<Consts>> = read.collect();
    let with_consts = |status: KnownStatus| {
        let values = consts.entry(status.set.clone()).or_insert_with_key(|set| {
            let (lowered, _, _) = read_with(file, text, set);
            (!lowered.has_errors()).then_some(lowered.consts)
        });
        values.clone().map(|values| (status, values))
    };
    KnownStatus::of_text(text).filter_map(with_consts).collect()
}

/// What is known of an objective with those constants.
fn expected(
    known: &[(KnownStatus, Consts)],
    objective: &str,
    consts: &Consts,
) -> Result<Option<Answer>, String> {
    let about = known.iter().filter(|(status, values)| status.objective == objective && values == consts);
    let mut said = about.map(|(status, _)| status.realizable);
    let Some(realizable) = said.next() else { return Ok(None) };
    if said.any(|other| other != realizable) {
        return Err(format!("its comments call {objective} both realizable and unrealizable"));
    }
    Ok(Some(if realizable { Answer::Sat } else { Answer::Unsat }))
}

/// The constants of a file with their values.
type Consts = Vec<(String, Value)>;

/// What a file means with certain constants.
struct Meaning {
    problem: Problem,
    consts: Consts,
    /// A digest of the other files that it reads.
    others: String,
}

fn lower(file: &Path, text: &str, set: &[(String, String)], out: Option<&Output>) -> Result<Meaning> {
    let (lowered, sources, others) = read_with(file, text, set);
    if lowered.has_errors() {
        let errors: Vec<Diagnostic> = lowered.diagnostics.into_iter().filter(Diagnostic::is_error).collect();
        let Some(out) = out else { return Err(first(file, &sources, &errors)) };
        report::diagnostics(&sources, &errors, out);
        return Err(Failure::said());
    }
    let others = if others.is_empty() { String::new() } else { sha256(format!("{others:?}").as_bytes()) };
    Ok(Meaning { problem: lowered.problem, consts: lowered.consts, others })
}

/// Reads a file with certain constants; also the digests of the other files that it reads.
fn read_with(
    file: &Path,
    text: &str,
    set: &[(String, String)],
) -> (Lowered, SourceMap, BTreeMap<String, String>) {
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    let loader = Noted { folder: Beside(folder), read: RefCell::default() };
    let overrides = Overrides { values: set.to_vec() };
    let mut sources = SourceMap::new();
    let lowered = read(&mut sources, &file.display().to_string(), text, &loader, &overrides);
    (lowered, sources, loader.read.into_inner())
}

/// The first error of a file, for a line.
fn first(file: &Path, sources: &SourceMap, errors: &[Diagnostic]) -> Failure {
    let message = errors.first().map_or("it has errors", |error| error.message.as_str());
    match errors.first().and_then(|error| error.span) {
        Some(span) => {
            let (line, column) = sources.position(span);
            Failure::input(format_args!("{}:{line}:{column}: {message}", sources.get(span.source).name))
        }
        None => Failure::input(format_args!("{}: {message}", file.display())),
    }
}

/// Notes what is loaded.
struct Noted {
    folder: Beside,
    read: RefCell<BTreeMap<String, String>>,
}

impl Loader for Noted {
    fn load(&self, path: &str) -> Result<Vec<u8>, String> {
        let bytes = self.folder.load(path)?;
        self.read.borrow_mut().insert(path.to_owned(), sha256(&bytes));
        Ok(bytes)
    }
}
