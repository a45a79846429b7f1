//! The solver as the search uses it: checks with a clock, and models that are evaluated before they are believed.

use crate::config::{Config, Error};
use hyperplan_smt::{Model, Script, Term, first_violated};
use hyperplan_solver::{self as solver, Answer, Identity, Options, Session, Size, Spec, open};
use std::time::Instant;

/// Why a search ended without an answer.
#[derive(Debug)]
pub(crate) enum Stop {
    /// Undecided, for this reason.
    Unknown(String),
    /// A failure.
    Error(Error),
}

impl<E: Into<Error>> From<E> for Stop {
    fn from(error: E) -> Self {
        Stop::Error(error.into())
    }
}

/// Opens sessions and keeps the accounts.
pub(crate) struct Oracle<'c> {
    config: &'c Config,
    identity: Option<Identity>,
    /// Time spent waiting for solvers.
    pub(crate) solving: f64,
    /// The largest query.
    pub(crate) largest: Size,
}

impl<'c> Oracle<'c> {
    pub(crate) fn new(config: &'c Config) -> Self {
        Oracle { config, identity: None, solving: 0.0, largest: Size::default() }
    }

    /// Starts a dialogue about queries with so many blocks of quantifiers, the leading one as free symbols.
    pub(crate) fn open(&mut self, blocks: usize, incremental: bool) -> Result<Dialogue, Stop> {
        let options = Options {
            seed: self.config.seed,
            quantified: blocks > 1,
            nested: blocks > 2,
            incremental,
            memory_mib: self.config.memory_mib,
            queries: self.config.queries.clone(),
            status: None,
        };
        let start = Instant::now();
        let session = open(&self.config.solver, &options)?;
        self.solving += start.elapsed().as_secs_f64();
        self.identity.get_or_insert_with(|| session.identity());
        Ok(Dialogue { session, trusted: self.config.solver == Spec::Builtin })
    }

    /// Whether the script is satisfiable.
    pub(crate) fn check(&mut self, dialogue: &mut Dialogue, script: &Script) -> Result<bool, Stop> {
        if self.config.deadline.passed() {
            return Err(Stop::Unknown(self.late()));
        }
        let start = Instant::now();
        let answer = dialogue.session.check(script, &[], &self.config.deadline);
        self.solving += start.elapsed().as_secs_f64();
        self.largest = self.largest.max(dialogue.session.size());
        match answer? {
            Answer::Sat => Ok(true),
            Answer::Unsat => Ok(false),
            // The solver may give its own name to what our clock did.
            Answer::Unknown(_) if self.config.deadline.passed() => Err(Stop::Unknown(self.late())),
            Answer::Unknown(reason) => Err(Stop::Unknown(reason)),
        }
    }

    fn late(&self) -> String {
        self.config.deadline.reason().to_owned()
    }

    /// The values of the symbols that describe the wanted paths. The model of an external solver is evaluated: one
    /// that does not satisfy the script is the solver's fault.
    pub(crate) fn model(
        &mut self,
        dialogue: &mut Dialogue,
        script: &Script,
        wanted: Vec<Term>,
    ) -> Result<Model, Stop> {
        let symbols = if dialogue.trusted { wanted } else { with_all_symbols(script, wanted) };
        let start = Instant::now();
        let values = dialogue.session.values(script, &symbols);
        self.solving += start.elapsed().as_secs_f64();
        if let Err(solver::Error::Deadline { .. }) = values {
            return Err(Stop::Unknown(self.late()));
        }
        let mut model = Model::new();
        for (symbol, value) in symbols.into_iter().zip(values?) {
            model.insert(symbol, value);
        }
        if !dialogue.trusted && first_violated(script, &model).is_some() {
            return Err(self.wrong(dialogue, "it does not satisfy the query").into());
        }
        Ok(model)
    }

    /// A model that describes no path, or whose paths fail.
    pub(crate) fn wrong(&self, dialogue: &Dialogue, what: &str) -> Error {
        Error::WrongModel { solver: dialogue.session.identity().name, what: what.into() }
    }

    /// Who answered; the name asked for, where nobody was asked.
    pub(crate) fn identity(&self) -> Identity {
        self.identity.clone().unwrap_or_else(|| Identity {
            name: match &self.config.solver {
                Spec::Builtin => "builtin".into(),
                Spec::Profile(name) => name.clone(),
                Spec::Command(line) => line.clone(),
            },
            version: String::new(),
        })
    }
}

/// One dialogue with a solver about one script.
pub(crate) struct Dialogue {
    session: Box<dyn Session>,
    /// The embedded engine's models are evaluated only when verification fails.
    trusted: bool,
}

fn with_all_symbols(script: &Script, wanted: Vec<Term>) -> Vec<Term> {
    let mut all = script.symbols();
    all.extend(wanted);
    all.sort_unstable();
    all.dedup();
    all
}
