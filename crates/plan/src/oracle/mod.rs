//! The solver as the search uses it: checks with a clock, and models that are evaluated before they are believed.

mod cross_check;
#[cfg(test)]
mod tests;

use crate::config::Config;
use crate::evidence::{Evidence, full};
use crate::fact::{Error, Note, Reason, Wrong};
use crate::watch::Stage;
use hyperplan_encode::Encoder;
use hyperplan_problem::Strategy;
use hyperplan_smt::{Features, Model, Script, Term, check_model};
use hyperplan_solver::{self as solver, Answer, Identity, Options, QuerySize, Session, Spec, Unknown, open};
use std::time::Instant;

/// Why a search ended without an answer.
#[derive(Debug)]
pub(crate) enum Stop {
    /// Undecided, for this reason.
    Unknown(Reason),
    /// A failure.
    Error(Error),
}

impl<E: Into<Error>> From<E> for Stop {
    fn from(error: E) -> Self {
        Stop::Error(error.into())
    }
}

/// Who is asked where no solver was named: the embedded one, or, about integers and reals, one that is found.
pub(crate) fn solver_for(arithmetic: bool) -> Option<Spec> {
    if arithmetic { Spec::for_arithmetic() } else { Some(Spec::Builtin) }
}

/// Hears what is said in dialogues, which nest.
pub(crate) trait Listener {
    /// A dialogue begins.
    fn opened(&mut self);
    /// The innermost dialogue ends.
    fn closed(&mut self);
    /// The innermost dialogue says what is new in its script, and gets an answer.
    fn checked(&mut self, script: &Script, satisfiable: bool);
}

/// Opens sessions and keeps the accounts.
pub(crate) struct Oracle<'c> {
    config: &'c Config,
    account: Account,
    /// Whether the solver has said who it is.
    introduced: bool,
    listener: Option<&'c mut dyn Listener>,
}

/// What is known of all that was asked of an oracle.
pub(crate) struct Account {
    /// Who answered; the name asked for, where nobody was asked.
    pub(crate) solver: Identity,
    /// What the user should know of the solvers.
    pub(crate) notes: Vec<Note>,
    /// Seconds spent waiting for solvers.
    pub(crate) solving: f64,
    /// The largest query.
    pub(crate) largest: QuerySize,
    /// The last query whose model could not be evaluated, since quantifiers cannot.
    unproved: Option<Evidence>,
}

impl<'c> Oracle<'c> {
    pub(crate) fn new(config: &'c Config) -> Self {
        let solver = Identity { name: config.solver.name().to_owned(), version: String::new() };
        let largest = QuerySize::default();
        let account = Account { solver, notes: Vec::new(), solving: 0.0, largest, unproved: None };
        Oracle { config, account, introduced: false, listener: None }
    }

    /// With somebody who hears what is said.
    pub(crate) fn heard_by(self, listener: &'c mut dyn Listener) -> Self {
        Oracle { listener: Some(listener), ..self }
    }

    /// Tells who watches of a candidate.
    pub(crate) fn met(&self, candidate: Strategy) {
        self.config.watch.candidate(candidate);
    }

    /// Ends all that was asked.
    pub(crate) fn into_account(self) -> Account {
        self.account
    }

    /// Starts a dialogue about one query with so many blocks of quantifiers, the leading one as free symbols.
    pub(crate) fn open(&mut self, blocks: usize) -> Result<Dialogue, Stop> {
        self.dialogue(blocks, None)
    }

    /// Starts a dialogue about a query without quantifiers that grows, perhaps to what needs all that.
    pub(crate) fn open_growing(&mut self, features: Features) -> Result<Dialogue, Stop> {
        self.dialogue(1, Some(features))
    }

    fn dialogue(&mut self, blocks: usize, growing: Option<Features>) -> Result<Dialogue, Stop> {
        let options = Options {
            seed: self.config.seed,
            quantified: blocks > 1,
            nested: blocks > 2,
            incremental: growing.is_some(),
            features: growing.unwrap_or_default(),
            memory_mib: self.config.memory_mib,
            queries: self.config.queries.clone(),
            status: None,
        };
        let start = Instant::now();
        let session = open(&self.config.solver, &options)?;
        self.account.solving += start.elapsed().as_secs_f64();
        if let Some(listener) = &mut self.listener {
            listener.opened();
        }
        Ok(Dialogue { session, trusted: self.config.solver.is_embedded(), options, second: None })
    }

    /// Ends the dialogue that was opened last.
    pub(crate) fn close(&mut self, _: Dialogue) {
        if let Some(listener) = &mut self.listener {
            listener.closed();
        }
    }

    /// Whether the script is satisfiable.
    pub(crate) fn check(&mut self, dialogue: &mut Dialogue, script: &Script) -> Result<bool, Stop> {
        // Where effort has no limit, there is an answer or another reason for none.
        self.check_within(dialogue, script, None)?.ok_or(Stop::Unknown(Unknown::Effort.into()))
    }

    /// The same with limited effort, as of [`Session::check_within`]; `None` where it is spent.
    pub(crate) fn check_within(
        &mut self,
        dialogue: &mut Dialogue,
        script: &Script,
        effort: Option<u64>,
    ) -> Result<Option<bool>, Stop> {
        if self.config.deadline.passed() {
            return Err(Stop::Unknown(self.late()));
        }
        self.config.watch.tell(|standing| {
            standing.stage = Stage::Asking;
            standing.checks += 1;
        });
        let start = Instant::now();
        let answer = dialogue.session.check_within(script, &[], &self.config.deadline, effort);
        self.account.solving += start.elapsed().as_secs_f64();
        self.account.largest = std::mem::take(&mut self.account.largest).max(dialogue.session.size());
        let variables = self.account.largest.variables;
        self.config.watch.tell(|standing| standing.variables = standing.variables.max(variables));
        let answer = answer?;
        if answer != Answer::Sat {
            self.introduce(dialogue);
        }
        if let (Some(listener), Answer::Sat | Answer::Unsat) = (&mut self.listener, &answer) {
            listener.checked(script, answer == Answer::Sat);
        }
        match answer {
            Answer::Sat => Ok(Some(true)),
            Answer::Unsat => self.cross_check(dialogue, script).map(|()| Some(false)),
            Answer::Unknown(Unknown::Effort) => Ok(None),
            Answer::Unknown(unknown @ Unknown::WaitsForEnd) => Err(Stop::Unknown(unknown.into())),
            // The solver may give its own name to what our clock did.
            Answer::Unknown(_) if self.config.deadline.passed() => Err(Stop::Unknown(self.late())),
            Answer::Unknown(unknown) => Err(Stop::Unknown(unknown.into())),
        }
    }

    fn late(&self) -> Reason {
        self.config.deadline.reason().into()
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
        self.account.solving += start.elapsed().as_secs_f64();
        match &values {
            Err(solver::Error::Deadline { .. }) => return Err(Stop::Unknown(self.late())),
            Err(solver::Error::Memory { .. }) => return Err(Stop::Unknown(Unknown::Memory.into())),
            Err(solver::Error::LargeNumber { .. }) => return Err(Stop::Unknown(Reason::LargeNumbers)),
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
        let by = dialogue.session.identity();
        let answer = format!("Answer of {}: sat, with the model at the end of this file.", full(&by));
        if let Some(index) = result.violated {
            let answer = format!("{answer}\nIt violates assertion {}, counted from 1.", index + 1);
            let query = Some(Box::new(Evidence::new(script, &by, model, &answer)));
            return Err(Error::WrongModel { solver: by.name, wrong: Wrong::Violates, query });
        }
        self.account.unproved = Some(Evidence::new(script, &by, model, &answer));
        Ok(())
    }

    /// Takes note of who answers, once the solver has had the occasion to say its version.
    fn introduce(&mut self, dialogue: &Dialogue) {
        if !std::mem::replace(&mut self.introduced, true) {
            self.account.solver = dialogue.session.identity();
        }
    }

    /// A model that describes no path. A model that satisfies its query does, unless variables have no bounds: then its
    /// numbers may be too large for ours.
    pub(crate) fn no_path(&self, dialogue: &Dialogue, encoder: &Encoder<'_>) -> Stop {
        if !encoder.is_finite() {
            return Stop::Unknown(Reason::LargeNumbers);
        }
        let solver = dialogue.session.identity().name;
        Error::WrongModel { solver, wrong: Wrong::NoPath, query: None }.into()
    }
}

impl Account {
    /// A model whose paths are defeated; with its query, where it could not be evaluated on that.
    pub(crate) fn wrong_model(&self, defeat: String) -> Error {
        let query = self.unproved.clone().map(Box::new);
        Error::WrongModel { solver: self.solver.name.clone(), wrong: Wrong::Defeated(defeat), query }
    }
}

/// One dialogue with a solver about one script.
pub(crate) struct Dialogue {
    session: Box<dyn Session>,
    /// The embedded engine's models are evaluated only when verification fails.
    trusted: bool,
    options: Options,
    /// The solver that checks what this one says is unsatisfiable.
    second: Option<Box<dyn Session>>,
}

fn with_all_symbols(script: &Script, wanted: Vec<Term>) -> Vec<Term> {
    let mut all = script.symbols();
    all.extend(wanted);
    all.sort_unstable();
    all.dedup();
    all
}
