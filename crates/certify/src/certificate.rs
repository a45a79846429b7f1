//! Certificates as files, and what it takes for one to count.

use crate::cost::Bound;
use crate::encode::Encoder;
use crate::error::Error;
use crate::instance::{self, Branch, BranchFile};
use crate::lrat::Checker;
use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use hyperplan_problem::answer::{WitnessPath, to_strategy};
use hyperplan_problem::{Difference, Distinction, FormulaId, Node, Objective, Problem, Quantifier, Strategy};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::{self, Write as _};
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Write};
use std::path::Path;

/// The form of certificates that this version writes and reads.
const FORMAT: u32 = 1;

/// No description is longer.
const LONGEST: u64 = 1 << 30;

/// What is claimed of an objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Claim {
    /// It begins with `exists` and is unrealizable.
    NoStrategy,
    /// It begins with `forall` and holds.
    NoCounterexample,
}

impl Claim {
    /// What can be claimed of an objective.
    #[must_use]
    pub fn of(objective: &Objective) -> Claim {
        match objective.paths.first().map(|path| path.quantifier) {
            Some(Quantifier::Forall) => Claim::NoCounterexample,
            Some(Quantifier::Exists) | None => Claim::NoStrategy,
        }
    }
}

/// The description of a certificate; the refutation is a file beside it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    format: u32,
    /// The version of hyperplan that made it.
    pub hyperplan: String,
    /// Constants that had other values than in the file, each as `--set` takes it.
    pub set: Vec<String>,
    /// The objective.
    pub objective: String,
    /// What is claimed of it.
    pub claim: Claim,
    /// Of which strategies only: those with such costs, by [`crate::with_bounds`].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub costs: Vec<Bound>,
    /// Of which strategies only: those that differ from these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub apart: Option<Apart>,
    /// What of the objective alone excludes that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parts: Option<Parts>,
    /// The benchmark whose status it certifies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub benchmark: Option<Benchmark>,
    /// The digest of what the problem means.
    pub problem: String,
    /// How many variables the clauses have.
    pub variables: i32,
    /// How many clauses there are.
    pub clauses: u64,
    instances: Vec<BranchFile>,
}

/// Strategies, or counterexamples, that are known, so that the claim is about others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Apart {
    /// In what others would differ.
    pub differ: Difference,
    /// Those that are known.
    pub from: Vec<Vec<WitnessPath>>,
}

impl Apart {
    /// The objective with the demand that a strategy differs from those.
    ///
    /// # Errors
    /// If they are none of the objective.
    pub fn objective(&self, problem: &Problem, objective: &Objective) -> Result<Objective, Error> {
        let known = |paths: &Vec<WitnessPath>| to_strategy(problem, objective, paths);
        let known: Vec<Strategy> = self
            .from
            .iter()
            .map(known)
            .collect::<Result<_, _>>()
            .map_err(|error| Error::Unreadable(error.to_string()))?;
        let leading = objective.leading_block();
        let whole = |strategy: &Strategy| {
            strategy.traces.iter().map(|trace| trace.path).eq(leading.iter().copied())
                && strategy.traces.iter().all(|trace| trace.states.len() == trace.actions.len() + 1)
        };
        if !known.iter().all(whole) {
            return Err(Error::Unreadable(
                "a strategy that is known has not all its paths and states".to_owned(),
            ));
        }
        Ok(Distinction::new(problem, objective, self.differ).apart(objective, &known))
    }
}

/// Parts of an objective: conjuncts of its formula.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parts {
    /// Which, by their numbers from 1 on, in the order in which they are written.
    pub numbers: Vec<usize>,
    /// Whether they exclude each other even if the other player helps, so that every path is one of the leading player.
    pub helped: bool,
}

impl Parts {
    /// The objective that asks for these parts alone.
    ///
    /// # Errors
    /// If it has no such parts.
    pub fn objective(&self, objective: &Objective) -> Result<Objective, Error> {
        let all = objective.formula.parts();
        let part = |number: &usize| all.get(number.checked_sub(1)?).copied();
        let parts: Option<Vec<FormulaId>> = self.numbers.iter().map(part).collect();
        let parts = parts.ok_or_else(|| Error::Unreadable("the objective has no such parts".to_owned()))?;
        let mut own = objective.clone();
        own.formula.push(Node::And(parts), objective.span);
        if self.helped {
            own.paths.iter_mut().for_each(|path| path.quantifier = Quantifier::Exists);
        }
        Ok(own)
    }
}

/// A benchmark that was written of a problem.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Benchmark {
    /// The digest of its file, which has the certificate's name.
    pub sha256: String,
    /// The problem's file, from the folder of the certificate on.
    pub file: String,
}

/// What was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checked {
    /// Instances of blocks of the other player.
    pub instances: usize,
    /// Variables of the clauses.
    pub variables: i32,
    /// Clauses.
    pub clauses: u64,
    /// Steps of the refutation.
    pub steps: u64,
}

impl Certificate {
    /// The certificate of a claim that these instances refute. Where it is about costs, these are left to be said.
    ///
    /// # Errors
    /// Where they are none of the objective.
    pub fn new(
        problem: &Problem,
        objective: &Objective,
        set: Vec<String>,
        branches: &[Branch],
        stop: &dyn Fn() -> bool,
    ) -> Result<Certificate, Error> {
        let mut encoder = Encoder::new(problem, objective, stop)?;
        encoder.tree(branches)?;
        Ok(Certificate {
            format: FORMAT,
            hyperplan: env!("CARGO_PKG_VERSION").to_owned(),
            set,
            objective: objective.name.clone(),
            claim: Claim::of(objective),
            costs: Vec::new(),
            apart: None,
            parts: None,
            benchmark: None,
            problem: digest(problem, objective),
            variables: encoder.variables(),
            clauses: clauses(&encoder.take()).count() as u64,
            instances: instance::write(problem, objective, branches),
        })
    }

    /// Writes the description.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *to, self)?;
        to.write_all(b"\n")
    }

    /// Reads a description.
    ///
    /// # Errors
    /// If it is none.
    pub fn read(file: &Path) -> Result<Certificate, Error> {
        let text = BufReader::new(File::open(file)?.take(LONGEST));
        let own: Certificate =
            serde_json::from_reader(text).map_err(|error| Error::Unreadable(error.to_string()))?;
        match own.format {
            FORMAT => Ok(own),
            format => Err(Error::Unreadable(format!("its form is {format}; this version knows {FORMAT}"))),
        }
    }

    /// The instances.
    ///
    /// # Errors
    /// If they are none of the objective.
    pub fn branches(&self, problem: &Problem, objective: &Objective) -> Result<Vec<Branch>, Error> {
        instance::read(problem, objective, self.instances.clone())
    }

    /// Checks that it is for this objective, and that it proves what it claims.
    ///
    /// # Errors
    /// If it does not.
    pub fn check(
        &self,
        problem: &Problem,
        objective: &Objective,
        refutation: &mut dyn BufRead,
        stop: &dyn Fn() -> bool,
    ) -> Result<Checked, Error> {
        if self.objective != objective.name {
            return Err(Error::Foreign(format!("objective {}", self.objective)));
        }
        if self.claim != Claim::of(objective) {
            return Err(Error::Foreign("another claim".to_owned()));
        }
        if self.problem != digest(problem, objective) {
            let version = match self.hyperplan == env!("CARGO_PKG_VERSION") {
                true => String::new(),
                false => format!(", or hyperplan {} read it otherwise", self.hyperplan),
            };
            return Err(Error::Foreign(format!(
                "another problem: the file or its constants were changed{version}"
            )));
        }
        let checked = check(problem, objective, &self.branches(problem, objective)?, refutation, stop)?;
        if (checked.variables, checked.clauses) != (self.variables, self.clauses) {
            return Err(Error::Foreign("other clauses".to_owned()));
        }
        Ok(checked)
    }
}

/// Checks that instances refute the claim of an objective. This is all that has to be believed, with what it calls: that the
/// clauses say what `encode` says, and that [`Checker`] is right.
///
/// # Errors
/// If they do not.
pub fn check(
    problem: &Problem,
    objective: &Objective,
    branches: &[Branch],
    refutation: &mut dyn BufRead,
    stop: &dyn Fn() -> bool,
) -> Result<Checked, Error> {
    let mut encoder = Encoder::new(problem, objective, stop)?;
    encoder.tree(branches)?;
    let (variables, written) = (encoder.variables(), encoder.take());
    drop(encoder);
    let mut checker = Checker::default();
    let mut count = 0;
    for clause in clauses(&written) {
        checker.clause(clause)?;
        count += 1;
    }
    drop(written);
    checker.check(refutation, stop)?;
    Ok(Checked { instances: branches.len(), variables, clauses: count, steps: checker.steps() })
}

/// The clauses of a list in which a 0 stands behind each.
fn clauses(written: &[i32]) -> impl Iterator<Item = &[i32]> {
    written.split_inclusive(|literal| *literal == 0).map(|own| own.strip_suffix(&[0]).unwrap_or(own))
}

/// Writes the clauses as DIMACS, for other checkers. How many there are, and which is the first that is empty, from 1 on.
///
/// # Errors
/// If the instances are none of the objective, or nothing can be written.
pub fn dimacs(
    problem: &Problem,
    objective: &Objective,
    branches: &[Branch],
    to: &mut dyn Write,
    stop: &dyn Fn() -> bool,
) -> Result<(u64, Option<u64>), Error> {
    let mut encoder = Encoder::new(problem, objective, stop)?;
    encoder.tree(branches)?;
    let (variables, written) = (encoder.variables(), encoder.take());
    let mut to = BufWriter::new(to);
    let count = clauses(&written).count() as u64;
    writeln!(to, "p cnf {variables} {count}")?;
    for literal in &written {
        match literal {
            0 => to.write_all(b"0\n")?,
            literal => write!(to, "{literal} ")?,
        }
    }
    to.flush()?;
    let empty = (1..).zip(clauses(&written)).find(|(_, clause)| clause.is_empty());
    Ok((count, empty.map(|(number, _)| number)))
}

/// Writes, compressed, what is printed.
///
/// # Errors
/// If it cannot be written.
pub fn compress(to: &mut dyn Write, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut encoder = GzEncoder::new(to, Compression::fast());
    print(&mut encoder)?;
    encoder.finish().map(drop)
}

/// A compressed refutation as text.
///
/// # Errors
/// If the file cannot be opened.
pub fn refutation(file: &Path) -> Result<impl BufRead + use<>, Error> {
    Ok(BufReader::with_capacity(1 << 16, MultiGzDecoder::new(BufReader::new(File::open(file)?))))
}

struct Digester(Sha256);

impl fmt::Write for Digester {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// A digest of all that the typed problem says of an objective, places in the file included.
fn digest(problem: &Problem, objective: &Objective) -> String {
    let mut digester = Digester(Sha256::new());
    // It cannot fail: nothing is written anywhere.
    let _ = write!(digester, "{:?} {:?} {objective:?}", problem.actions, problem.systems);
    let mut text = String::from("sha256:");
    for byte in digester.0.finalize() {
        let _ = write!(text, "{byte:02x}");
    }
    text
}
