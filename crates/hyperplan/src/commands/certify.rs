//! `hyperplan certify`: whether certificates prove what they claim, without any solver.

use crate::args::{self, Certify};
use crate::config;
use crate::failure::{Exit, Failure, Result};
use crate::files::{self, reason};
use crate::guard;
use crate::load::{self, Consts, Loaded};
use crate::output::Output;
use crate::proof::{DESCRIPTION, REFUTATION, status};
use crate::report::json;
use crate::wish::Sums;
use hyperplan::foreign::Foreign;
use hyperplan_certify::{
    Bound, Certificate, Checked, Claim, Error, dimacs, pseudo_boolean, refutation, with_bounds,
};
use hyperplan_outlet::one_line;
use hyperplan_problem::{Difference, Objective, Problem, Target};
use hyperplan_solver::Deadline;
use serde::Serialize;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(crate) fn run(args: &Certify, out: &mut Output) -> Result {
    let deadline = config::deadline(args.limit.timeout, None)?;
    let [folder] = args.folder.as_slice() else {
        return Err(Failure::input("certificates are in one folder"));
    };
    if let Some(folder) = &args.export {
        files::make_folder(folder)?;
    }
    let checking = Checking {
        file: &args.file,
        foreign: args.foreign.as_ref(),
        export: args.export.as_deref(),
        deadline: &deadline,
    };
    let mut worst = Exit::Good;
    let wanted = args.selection.objective.as_deref().filter(|name| *name != "all");
    let mut checked = 0;
    for file in descriptions(folder)? {
        let name = files::name(&file);
        let certificate = Certificate::read(&file)
            .map_err(|error| Failure::new(status(&error), format_args!("{name}: {error}")))?;
        if wanted.is_some_and(|wanted| wanted != certificate.objective) {
            continue;
        }
        checked += 1;
        guard::doing("checking a certificate");
        let result = check(&checking, &certificate, &file, out)?;
        let report = Report::new(&certificate, &name, &result);
        match args.output.format {
            args::Format::Json => out.line(json(&report)?)?,
            args::Format::Text => out.line(report.text())?,
        }
        worst = worst.max(result.as_ref().map_or_else(status, |_| Exit::Good));
    }
    if checked == 0 {
        let what = wanted.map_or(String::new(), |name| format!(" for objective {name}"));
        return Err(Failure::input(format_args!("{} has no certificate{what}", folder.display())));
    }
    Ok(worst)
}

/// The descriptions of a folder's certificates, by name.
fn descriptions(folder: &Path) -> Result<Vec<PathBuf>> {
    let cannot =
        |e: io::Error| Failure::input(format_args!("cannot read {}: {}", folder.display(), reason(&e)));
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.extension().is_some_and(|ending| ending == DESCRIPTION) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// What certificates are checked against, and what else becomes of them.
pub(super) struct Checking<'a> {
    /// The problem.
    pub(super) file: &'a Path,
    pub(super) foreign: Option<&'a Foreign>,
    /// The folder for other checkers' files.
    pub(super) export: Option<&'a Path>,
    pub(super) deadline: &'a Deadline,
}

/// Checks one certificate against the problem with the constants that it was made for.
pub(super) fn check(
    checking: &Checking<'_>,
    certificate: &Certificate,
    file: &Path,
    out: &Output,
) -> Result<Result<Checked, Error>> {
    let set = certificate.set.iter().map(|set| set.split_once('=').unwrap_or((set, "")));
    let problem = args::Problem {
        file: checking.file.to_owned(),
        set: set.map(|(name, value)| (name.to_owned(), value.to_owned())).collect(),
        foreign: checking.foreign.cloned(),
    };
    let (loaded, consts) = Loaded::with_consts(&problem, &load::text(&problem)?, Instant::now(), out)?;
    let Some(objective) = loaded.problem.objective(&certificate.objective) else {
        return Ok(Err(Error::Foreign(format!("objective {}", certificate.objective))));
    };
    let parts = certificate.parts.as_ref().map(|parts| parts.objective(objective));
    let parts = match parts.transpose() {
        Ok(parts) => parts,
        Err(error) => return Ok(Err(error)),
    };
    let objective = parts.as_ref().unwrap_or(objective);
    let apart = certificate.apart.as_ref().map(|apart| apart.objective(&loaded.problem, objective));
    let apart = match apart.transpose() {
        Ok(apart) => apart,
        Err(error) => return Ok(Err(error)),
    };
    let objective = apart.as_ref().unwrap_or(objective);
    let bounded = match certificate.costs.as_slice() {
        [] => None,
        costs => match bounded(costs, &loaded, objective, consts) {
            Ok(bounded) => Some(bounded),
            Err(error) => return Ok(Err(error)),
        },
    };
    let (problem, objective) = match &bounded {
        Some((problem, objective)) => (problem, objective),
        None => (&loaded.problem, objective),
    };
    let stop = || checking.deadline.passed();
    let beside = file.with_extension(REFUTATION);
    let result =
        refutation(&beside).and_then(|mut proof| certificate.check(problem, objective, &mut proof, &stop));
    if let (Some(folder), Ok(_)) = (checking.export, &result) {
        let name = file.file_stem().unwrap_or_default();
        let path = |ending: &str| folder.join(name).with_added_extension(ending);
        let exported = |error: Error| match error {
            Error::Io(error) => error,
            error => io::Error::other(error),
        };
        let mut count = (0, None);
        files::write(&path("cnf"), |to| {
            let branches = certificate.branches(problem, objective).map_err(exported)?;
            count = dimacs(problem, objective, &branches, to, &stop).map_err(exported)?;
            Ok(())
        })?;
        let again = || refutation(&beside).map_err(exported);
        files::write(&path("lrat"), |to| io::copy(&mut again()?, to).map(drop))?;
        files::write(&path("pbp"), |to| pseudo_boolean(&mut again()?, count, to).map_err(exported))?;
    }
    Ok(result)
}

/// The objective with bounds on costs.
fn bounded(
    costs: &[Bound],
    loaded: &Loaded,
    objective: &Objective,
    consts: Consts,
) -> Result<(Problem, Objective), Error> {
    let texts: Vec<&str> = costs.iter().map(|bound| bound.cost.as_str()).collect();
    let targets =
        Sums::read("--minimize", &texts.join(", "), consts).and_then(|sums| sums.of(loaded, objective));
    let Some(targets) = targets.ok().filter(|targets| targets.len() == costs.len()) else {
        return Err(Error::Unreadable("its costs are no sums of costs of the objective".to_owned()));
    };
    let bounds: Vec<(Target, i64)> = targets.into_iter().zip(costs.iter().map(|bound| bound.most)).collect();
    with_bounds(&loaded.problem, objective, &bounds)
}

#[derive(Serialize)]
struct Report<'a> {
    certificate: &'a str,
    objective: &'a str,
    /// Constants with other values than in the file.
    set: &'a [String],
    /// What the strategies that there are none of would cost at most.
    costs: &'a [Bound],
    /// In what they would differ from those that are known, and how many these are.
    #[serde(skip_serializing_if = "Option::is_none")]
    apart: Option<(Difference, usize)>,
    /// The numbers of the parts that are claimed to exclude each other.
    #[serde(skip_serializing_if = "Option::is_none")]
    parts: Option<&'a [usize]>,
    claim: Claim,
    /// `certified`, or `refused`.
    verdict: &'static str,
    reason: Option<String>,
    instances: Option<usize>,
    variables: Option<i32>,
    clauses: Option<u64>,
    steps: Option<u64>,
}

impl<'a> Report<'a> {
    fn new(certificate: &'a Certificate, name: &'a str, result: &Result<Checked, Error>) -> Self {
        let of = |get: fn(&Checked) -> u64| result.as_ref().ok().map(get);
        Report {
            certificate: name,
            objective: &certificate.objective,
            set: &certificate.set,
            costs: &certificate.costs,
            apart: certificate.apart.as_ref().map(|apart| (apart.differ, apart.from.len())),
            parts: certificate.parts.as_ref().map(|parts| parts.numbers.as_slice()),
            claim: certificate.claim,
            verdict: if result.is_ok() { "certified" } else { "refused" },
            reason: result.as_ref().err().map(Error::to_string),
            instances: result.as_ref().ok().map(|checked| checked.instances),
            variables: result.as_ref().ok().map(|checked| checked.variables),
            clauses: of(|checked| checked.clauses),
            steps: of(|checked| checked.steps),
        }
    }

    fn text(&self) -> String {
        let costs = self.costs.iter().map(|Bound { cost, most }| format!("{cost} <= {most}"));
        let with: Vec<String> = self.set.iter().cloned().chain(costs).collect();
        let with = match with.is_empty() {
            true => String::new(),
            false => format!(" with {}", one_line(&with.join(", "))),
        };
        let claim = match self.claim {
            Claim::NoStrategy => "unrealizable",
            Claim::NoCounterexample => "realizable",
        };
        let apart = self.apart.map_or(String::new(), |(differ, known)| {
            format!(", apart from the {known} known that differ in {differ}")
        });
        let parts = self.parts.map_or(String::new(), |parts| {
            let numbers: Vec<String> = parts.iter().map(ToString::to_string).collect();
            format!(", parts {} alone", numbers.join(", "))
        });
        let about = format!("{}{with}{parts}{apart}: {claim}", one_line(self.objective));
        match (&self.reason, self.instances, self.clauses, self.steps) {
            (None, Some(instances), Some(clauses), Some(steps)) => {
                let count = |n: u64, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
                let (instances, clauses) = (count(instances as u64, "instance"), count(clauses, "clause"));
                format!("{about}, certified: {instances}, {clauses}, {}", count(steps, "step"))
            }
            (reason, ..) => {
                format!("{about} is not certified: {}", one_line(reason.as_deref().unwrap_or("no reason")))
            }
        }
    }
}
