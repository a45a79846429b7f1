//! An objective as an SMT-LIB 2 benchmark.

use crate::config::{EmitConfig, Error, Quantifiers};
use crate::direct;
use crate::prepare::{blocks, decided};
use hyperplan_encode::{self as encode, Encoder, Limits, Narrowing};
use hyperplan_problem::{Mode, Objective, Problem, Quantifier};
use hyperplan_smt::{Header, Script, Status, WriteOptions, write_script};
use std::io;

/// A query, ready to be written.
pub struct Emitted {
    script: Script,
    options: WriteOptions,
    /// What the user should know.
    pub notes: Vec<String>,
}

impl Emitted {
    /// The query.
    #[must_use]
    pub fn script(&self) -> &Script {
        &self.script
    }

    /// Writes the benchmark.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write(&self, mut to: &mut dyn io::Write) -> io::Result<()> {
        write_script(&mut to, &self.script, &self.options)
    }
}

/// Builds the query of an objective. It is satisfiable if and only if the leading block has a choice of paths that
/// decides the objective: a strategy where it is `exists`, a counterexample where it is `forall`.
///
/// # Errors
/// What is not supported, and what is too large.
pub fn emit(problem: &Problem, objective: &Objective, config: &EmitConfig) -> Result<Emitted, Error> {
    let stop = || config.deadline.passed();
    let encoder = Encoder::new(problem, objective, config.states.wish(), Limits::default(), &stop)?;
    let mut empty = None;
    for path in objective.paths.keys() {
        match encoder.has_path(path) {
            Some(true) => {}
            Some(false) => {
                empty = Some(objective.paths[path].quantifier);
                break;
            }
            None if objective.mode == Mode::Bounded && encoder.system(path).is_finite() => {
                return Err(Error::Unsupported(format!(
                    "system {} is too large to enumerate, so it is not known which of its paths go on for ever; \
                     use `within K`",
                    encoder.system(path).name
                )));
            }
            None => {}
        }
    }
    let Some(quantifier) = empty else { return build(&encoder, config) };
    let decided = decided(objective, quantifier);
    build(&Encoder::new(problem, &decided, config.states.wish(), Limits::default(), &stop)?, config)
}

fn build(encoder: &Encoder<'_>, config: &EmitConfig) -> Result<Emitted, Error> {
    let objective = encoder.objective;
    let blocks = blocks(objective);
    let exists = objective.paths.first().is_none_or(|p| p.quantifier == Quantifier::Exists);
    let query = match config.quantifiers {
        Quantifiers::Cegis => {
            return Err(Error::Unsupported(
                "a counterexample-guided search is no single query; emit takes --quantifiers keep or expand"
                    .into(),
            ));
        }
        Quantifiers::Expand => direct::expand(encoder, &blocks, exists, Narrowing::default()),
        _ if blocks.len() == 1 => direct::expand(encoder, &blocks, exists, Narrowing::default()),
        Quantifiers::Keep | Quantifiers::Auto => direct::keep(encoder, &blocks, exists),
    };
    let script = query?.into_script();
    let mut notes = Vec::new();
    if !exists {
        notes.push(format!(
            "{} begins with forall: the query is satisfiable if it has a counterexample",
            objective.name
        ));
    }
    let header = Header {
        source: Some(source(encoder, exists)),
        license: Some("https://creativecommons.org/licenses/by/4.0/".into()),
        category: Some("crafted".into()),
        status: Some(Status::Unknown),
    };
    Ok(Emitted { script, options: WriteOptions { header, ..WriteOptions::default() }, notes })
}

fn source(encoder: &Encoder<'_>, exists: bool) -> String {
    let objective = encoder.objective;
    let states = match encoder.states {
        encode::States::Onehot => "one Boolean for each time and state",
        encode::States::Bitvec => "one bit-vector for each time and variable",
        encode::States::Int => "one number for each time and variable",
        encode::States::Enum => "one value of a datatype for each time",
        encode::States::Real => "one real for each time and variable",
    };
    let meaning = if exists { "a strategy" } else { "a counterexample" };
    let horizons: Vec<String> = objective
        .paths
        .iter_enumerated()
        .map(|(path, var)| format!("{} {}", var.name, encoder.horizon(path)))
        .collect();
    format!(
        "\nGenerator: hyperplan {}\nApplication: robot motion planning from a HyperLTLf objective\n\nObjective {}; \
         satisfiable if and only if there is {meaning}.\nHorizons: {}. States: {states}.\n",
        env!("CARGO_PKG_VERSION"),
        objective.name,
        horizons.join(", "),
    )
}
