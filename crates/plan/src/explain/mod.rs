//! Why an objective has no strategy, why it has a counterexample, and why a given plan fails.
//!
//! All of it are questions to the search, each with a part of the time that is left: whether the objective has a strategy with
//! fewer parts, fewer choices of the other player, or more time. A strategy in an answer was verified; that there is
//! none is the search's word, as elsewhere. What was not found out is said to be so.
//!
//! Parts are the conjuncts of the formula. Leaving out parts makes an objective with a leading `exists` weaker, so one pass
//! that leaves out what is not needed ends with parts that exclude each other and of which none can be left out.

mod asker;
mod closest;
mod failure;
mod longer;
mod opponent;
mod part;
mod wall;

pub use crate::choice::{Choice, Closest};
pub use closest::closest;
pub use failure::{Difference, Failing, Failure, Judged};
pub use longer::{Later, Longer, Time, longer};
pub use opponent::Opponents;
pub(crate) use part::as_long;
pub use wall::Wall;

use crate::config::{Config, Outcome, Verdict};
use crate::fact::{Error, Note};
use crate::lint::demand;
use crate::lint::question;
use asker::{Asker, needed};
use hyperplan_problem::{FormulaId, Objective, PathId, Problem, Strategy};
use hyperplan_syntax::Diagnostic;
use hyperplan_verify as verify;
use opponent::Best;
use std::time::Duration;

/// Which paths the parts of a core leave without a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// The leading paths alone: no other player is needed.
    Leading,
    /// All paths together, even if the other player helped.
    All,
    /// The leading paths, against the other player.
    Game,
}

/// Parts of an objective that exclude each other.
#[derive(Clone, Debug)]
pub struct Core {
    /// The parts, in their order.
    pub parts: Vec<FormulaId>,
    /// Whether the objective has a strategy once any one of them is left out, of these.
    pub minimal: bool,
    /// For whom they exclude each other.
    pub scope: Scope,
}

/// Paths of the leading block that do what is asked of them but for one thing, and how they fail.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The paths.
    pub strategy: Strategy,
    /// It wins against all paths of the other player that make none of these choices; `None` where these were not told apart.
    pub spared: Option<Vec<Choice>>,
    /// How it fails.
    pub failure: Failure,
}

/// A question that was not answered in the time that there was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Open {
    /// Which parts exclude each other.
    #[error("whether any of these parts can be left out")]
    Core,
    /// Whether the leading paths alone can do what is asked of them.
    #[error("whether the leading paths alone can do what is asked of them")]
    Alone,
    /// What is demanded of every path.
    #[error("what is demanded of every path")]
    Demanded,
    /// Which choices of the other player are enough.
    #[error("which paths of the other player are enough to defeat every candidate")]
    Opponents,
    /// How the best candidate fails.
    #[error("how a candidate is defeated")]
    Candidate,
    /// Whether more time helps.
    #[error("whether more time would help")]
    Later,
    /// Which part of the objective fails.
    #[error("which part of the objective fails")]
    Failing,
}

/// What was found out.
#[derive(Debug, Default)]
pub struct Explanation {
    /// Parts that exclude each other.
    pub core: Option<Core>,
    /// What can never be reached.
    pub wall: Option<Wall>,
    /// What more time would do, by each way to give it.
    pub later: Vec<Later>,
    /// A candidate that comes far, and how it is defeated.
    pub candidate: Option<Candidate>,
    /// Choices of the other player that are enough.
    pub opponents: Option<Opponents>,
    /// What is demanded of every path although some does not meet it.
    pub demanded: Vec<Diagnostic>,
    /// How the paths of a counterexample make the objective fail.
    pub counterexample: Option<Failure>,
    /// What was not found out.
    pub open: Vec<Open>,
}

/// Why an objective was decided as it was: nothing is to be said of one that has a strategy, or no counterexample. `ways` are
/// those to give it more time. The configuration's deadline is for all of it.
///
/// # Errors
/// Failures of solvers, and bugs; what is not found out in time is no error.
pub fn explain(
    problem: &Problem,
    objective: &Objective,
    outcome: &Outcome,
    ways: &mut [Longer<'_>],
    config: &Config,
) -> Result<Explanation, Error> {
    let mut explainer = Explainer::new(problem, objective, config);
    let empty = outcome.notes.iter().any(|note| matches!(note, Note::NoPaths { .. }));
    if outcome.verdict != Verdict::Unrealizable || empty {
        return Ok(explainer.found);
    }
    match &outcome.witness {
        Some(counterexample) => explainer.counterexample(counterexample)?,
        None => explainer.impossible(ways)?,
    }
    Ok(explainer.found)
}

/// As [`explain()`], of what can be said at once: the parts that exclude each other, or that fail on a counterexample.
///
/// # Errors
/// Those of [`explain()`].
pub fn in_short(
    problem: &Problem,
    objective: &Objective,
    outcome: &Outcome,
    config: &Config,
) -> Result<Explanation, Error> {
    let mut explainer = Explainer::new(problem, objective, config);
    let empty = outcome.notes.iter().any(|note| matches!(note, Note::NoPaths { .. }));
    match &outcome.witness {
        _ if outcome.verdict != Verdict::Unrealizable || empty => {}
        Some(counterexample) => explainer.counterexample(counterexample)?,
        None => {
            explainer.core()?;
        }
    }
    Ok(explainer.found)
}

/// How given paths of the leading block fail to do what is claimed of them, if they do.
///
/// # Errors
/// What is wrong with the paths, in the inner result; else those of [`explain()`].
pub fn judge(
    problem: &Problem,
    objective: &Objective,
    strategy: &Strategy,
    config: &Config,
) -> Result<Result<Judged, verify::Error>, Error> {
    failure::judge(&Asker::new(problem, config), objective, strategy)
}

/// The search takes one in so many parts of the time that is left for each of these.
const FOR_CORE: u32 = 3;
const FOR_OPPONENTS: u32 = 2;

/// One question of the lint.
const FOR_DEMAND: Duration = Duration::from_secs(2);

struct Explainer<'a> {
    asker: Asker<'a>,
    objective: &'a Objective,
    parts: Vec<FormulaId>,
    found: Explanation,
}

impl<'a> Explainer<'a> {
    fn new(problem: &'a Problem, objective: &'a Objective, config: &'a Config) -> Self {
        Explainer {
            asker: Asker::new(problem, config),
            objective,
            parts: objective.formula.parts(),
            found: Explanation::default(),
        }
    }

    /// How a counterexample makes the objective fail.
    fn counterexample(&mut self, counterexample: &Strategy) -> Result<(), Error> {
        let paths = counterexample.traces.clone();
        let parts = failure::failing(&self.asker, self.objective, &paths)?;
        if parts.is_empty() {
            self.found.open.push(Open::Failing);
        }
        let differences = failure::differences(self.objective, &paths, &parts);
        self.found.counterexample = Some(Failure { defeat: None, paths, parts, differences });
        Ok(())
    }

    /// Why there is no strategy.
    fn impossible(&mut self, ways: &mut [Longer<'_>]) -> Result<(), Error> {
        self.asker.begin(FOR_CORE);
        let best = self.core()?;
        let (problem, objective) = (self.asker.problem, self.objective);
        self.demanded();
        let scope = self.found.core.as_ref().map(|core| core.scope);
        if let Some(core) = self.found.core.as_ref().filter(|core| core.scope != Scope::Game) {
            self.found.wall = wall::wall(problem, objective, &core.parts, &self.asker.config.graphs);
        }
        if scope == Some(Scope::Game) {
            self.game(best)?;
        }
        if self.found.wall.is_none() {
            self.later(ways)?;
        }
        Ok(())
    }

    /// Finds parts that exclude each other; and a candidate, if the leading paths alone can do what is asked of them.
    fn core(&mut self) -> Result<Option<Best>, Error> {
        let objective = self.objective;
        let leading = objective.leading_block();
        let alone: Vec<FormulaId> =
            self.parts.iter().copied().filter(|&part| self.reads_only(part, &leading)).collect();
        let several = objective.blocks().len() > 1;
        let mut best = None;
        if !several {
            self.shrink(self.parts.clone(), Scope::Leading)?;
            return Ok(None);
        }
        match self.asker.ask(&self.as_long(&self.question(&alone, Scope::Leading)))? {
            Ok(outcome) if outcome.verdict == Verdict::Unrealizable => {
                self.shrink(alone, Scope::Leading)?;
                return Ok(None);
            }
            Ok(outcome) => {
                best = outcome.witness.map(|strategy| Best { strategy, spared: None });
            }
            Err(_) => self.found.open.push(Open::Alone),
        }
        let helped = self.question(&self.parts, Scope::All);
        let scope = if self.asker.impossible(&helped)? == Some(true) { Scope::All } else { Scope::Game };
        self.shrink(self.parts.clone(), scope)?;
        Ok(best)
    }

    /// Leaves out the parts that are not needed.
    fn shrink(&mut self, parts: Vec<FormulaId>, scope: Scope) -> Result<(), Error> {
        let mut without = |rest: &[FormulaId]| {
            // There are paths, so something is possible.
            if rest.is_empty() { Ok(Some(false)) } else { self.asker.impossible(&self.question(rest, scope)) }
        };
        let (parts, minimal) = needed(parts, &self.asker.deadline, &mut without)?;
        if !minimal {
            self.found.open.push(Open::Core);
        }
        self.found.core = Some(Core { parts, minimal, scope });
        Ok(())
    }

    /// The objective with these parts only.
    fn question(&self, parts: &[FormulaId], scope: Scope) -> Objective {
        let own = part::of_parts(self.objective, parts);
        match scope {
            Scope::Game => own,
            Scope::Leading => part::first_paths(&own, self.objective.leading_block().len()),
            Scope::All => {
                let formula = own.formula.clone();
                question::free(&own, formula)
            }
        }
    }

    fn reads_only(&self, part: FormulaId, paths: &[PathId]) -> bool {
        demand::paths(&self.objective.formula, part).iter().all(|path| paths.contains(path))
    }

    fn as_long(&self, question: &Objective) -> Objective {
        part::as_long(self.asker.problem, self.objective, question)
    }

    /// What `check` says of parts that are demanded of every path.
    fn demanded(&mut self) {
        if self.objective.blocks().len() < 2 || self.objective.semantics.is_some() {
            return;
        }
        self.asker.begin(FOR_CORE);
        let deadline = self.asker.deadline.clone();
        let mut asker = question::Asker::new(self.asker.problem, self.objective, deadline, FOR_DEMAND);
        demand::lint(&mut asker, &mut self.found.demanded);
        if !asker.into_undecided().is_empty() {
            self.found.open.push(Open::Demanded);
        }
    }

    /// Which paths of the other player are enough, and how far a candidate can come.
    fn game(&mut self, mut best: Option<Best>) -> Result<(), Error> {
        self.asker.begin(FOR_OPPONENTS);
        self.found.opponents = opponent::opponents(&self.asker, self.objective, &mut best)?;
        if self.found.opponents.as_ref().is_some_and(|found| !found.minimal) {
            self.found.open.push(Open::Opponents);
        }
        let Some(Best { strategy, spared }) = best else {
            self.found.open.push(Open::Candidate);
            return Ok(());
        };
        match failure::judge(&self.asker, self.objective, &strategy)? {
            Ok(Judged::Fails(failure)) => {
                self.found.candidate = Some(Candidate { strategy, spared, failure: *failure });
            }
            Ok(Judged::TooLarge) => self.found.open.push(Open::Candidate),
            // It cannot win: there is no strategy.
            Ok(Judged::Holds) => return Err(Error::Bug("a strategy was found where there is none".into())),
            Err(error) => return Err(Error::Bug(error.to_string())),
        }
        Ok(())
    }

    /// Whether more time would help.
    fn later(&mut self, ways: &mut [Longer<'_>]) -> Result<(), Error> {
        let count = ways.len();
        for (at, longer) in ways.iter_mut().enumerate() {
            self.asker.begin(u32::try_from(count - at).unwrap_or(u32::MAX));
            let name = &self.objective.name;
            let later = longer::later(name, longer, self.asker.config, &self.asker.deadline)?;
            let done = later.least.is_some();
            self.found.later.push(later);
            if done {
                break;
            }
        }
        if ways.is_empty() || self.asker.deadline.passed() && !self.found.later.iter().any(Later::is_proved) {
            self.found.open.push(Open::Later);
        }
        Ok(())
    }
}
