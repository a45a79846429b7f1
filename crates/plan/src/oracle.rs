//! The solver as the search uses it: checks with a clock, and models that are evaluated before they are believed.

use crate::config::{Config, Error};
use crate::emit::Tape;
use crate::evidence::{Claim, Evidence};
use hyperplan_smt::{Model, Script, Term, check_model};
use hyperplan_solver::{self as solver, Answer, Identity, Options, Session, Spec, Told, open};
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
    pub(crate) config: &'c Config,
    identity: Option<Identity>,
    /// The last query whose model could not be evaluated, since quantifiers cannot.
    unproved: Option<Evidence>,
    /// What the user should know of the solvers.
    pub(crate) notes: Vec<String>,
    /// Time spent waiting for solvers.
    pub(crate) solving: f64,
    /// The largest query.
    pub(crate) largest: Told,
    /// Where what is said is kept, for a benchmark.
    pub(crate) tape: Option<Tape>,
}

impl<'c> Oracle<'c> {
    pub(crate) fn new(config: &'c Config) -> Self {
        Oracle {
            config,
            identity: None,
            unproved: None,
            notes: Vec::new(),
            solving: 0.0,
            largest: Told::default(),
            tape: None,
        }
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
        if let Some(tape) = &mut self.tape {
            tape.open();
        }
        Ok(Dialogue { session, trusted: self.config.solver == Spec::Builtin, options, second: None })
    }

    /// Ends the dialogue that was opened last.
    pub(crate) fn close(&mut self, _: Dialogue) {
        if let Some(tape) = &mut self.tape {
            tape.close();
        }
    }

    /// Whether the script is satisfiable.
    pub(crate) fn check(&mut self, dialogue: &mut Dialogue, script: &Script) -> Result<bool, Stop> {
        if self.config.deadline.passed() {
            return Err(Stop::Unknown(self.late()));
        }
        let start = Instant::now();
        let answer = dialogue.session.check(script, &[], &self.config.deadline);
        self.solving += start.elapsed().as_secs_f64();
        self.largest = std::mem::take(&mut self.largest).max(dialogue.session.told());
        let answer = answer?;
        if answer != Answer::Sat {
            self.introduce(dialogue);
        }
        if let (Some(tape), Answer::Sat | Answer::Unsat) = (&mut self.tape, &answer) {
            tape.check(script, answer == Answer::Sat);
        }
        match answer {
            Answer::Sat => Ok(true),
            Answer::Unsat => self.cross_check(dialogue, script).map(|()| false),
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
        match &values {
            Err(solver::Error::Deadline { .. }) => return Err(Stop::Unknown(self.late())),
            Err(solver::Error::Memory { .. }) => return Err(Stop::Unknown("out of memory".to_owned())),
            _ => {}
        }
        let model: Model = symbols.into_iter().zip(values?).collect();
        self.introduce(dialogue);
        if !dialogue.trusted {
            self.evaluate(dialogue, script, &model)?;
        }
        Ok(model)
    }

    /// Refuses a model that does not satisfy the script. What cannot be evaluated is remembered, should the paths fail.
    fn evaluate(&mut self, dialogue: &Dialogue, script: &Script, model: &Model) -> Result<(), Error> {
        let result = check_model(script, model);
        if result.violated.is_none() && result.unknown == 0 {
            return Ok(());
        }
        let claim = Claim::Sat { by: &dialogue.session.identity(), model, violated: result.violated };
        let evidence = Evidence::new(script, &claim);
        if result.violated.is_some() {
            let what = format!("it does not satisfy the query, {}", evidence.keep(self.config));
            return Err(self.wrong(dialogue, &what));
        }
        self.unproved = Some(evidence);
        Ok(())
    }

    /// A model whose paths fail comes with its query, where that could not be evaluated.
    pub(crate) fn with_evidence(&self, error: Error) -> Error {
        match (error, &self.unproved) {
            (Error::WrongModel { solver, what }, Some(evidence)) => {
                let kept = evidence.keep(self.config);
                let what = format!("{what}; its model could not be evaluated on the query, {kept}");
                Error::WrongModel { solver, what }
            }
            (error, _) => error,
        }
    }

    /// Takes note of who answers, once the solver has had the occasion to say its version.
    fn introduce(&mut self, dialogue: &Dialogue) {
        self.identity.get_or_insert_with(|| dialogue.session.identity());
    }

    /// A model that describes no path, or whose paths fail.
    pub(crate) fn wrong(&self, dialogue: &Dialogue, what: &str) -> Error {
        Error::WrongModel { solver: dialogue.session.identity().name, what: what.into() }
    }

    /// Who answered; the name asked for, where nobody was asked.
    pub(crate) fn identity(&self) -> Identity {
        self.identity.clone().unwrap_or_else(|| Identity {
            name: self.config.solver.name().to_owned(),
            version: String::new(),
        })
    }
}

/// One dialogue with a solver about one script.
pub(crate) struct Dialogue {
    pub(crate) session: Box<dyn Session>,
    /// The embedded engine's models are evaluated only when verification fails.
    trusted: bool,
    pub(crate) options: Options,
    /// The solver that checks what this one says is unsatisfiable.
    pub(crate) second: Option<Box<dyn Session>>,
}

fn with_all_symbols(script: &Script, wanted: Vec<Term>) -> Vec<Term> {
    let mut all = script.symbols();
    all.extend(wanted);
    all.sort_unstable();
    all.dedup();
    all
}
