//! How the quantifiers of an objective are decided: in one query, or by counterexamples.

use crate::cegis::{Assignment, Cegis};
use crate::config::{Config, Quantifiers};
use crate::direct::{self, Direct};
use crate::fact::{Because, Error, Fault, Reason, Unsupported};
use crate::oracle::{Oracle, Stop};
use crate::prepare::is_existential;
use crate::watch::Stage;
use hyperplan_encode::{Belief, Encoder, Goal, Narrowing};
use hyperplan_problem::PathId;
use hyperplan_solver::Spec;

/// Runs that are hardly longer than the shortest make small queries, so they are tried first; then longer ones, and
/// then all, if there are others.
pub(crate) const SLACKS: [Option<u32>; 4] = [Some(4), Some(16), Some(64), None];

/// After so many checks a search over infinitely many choices is taken to have no end.
const ENDLESS: u32 = 200;

/// How many chances an explicit search looks at in the time that it takes to write a term, by measurement.
const CHANCES_PER_TERM: usize = 20;

/// How much effort of the SAT solver takes as long as a chance, by measurement.
const EFFORT_PER_CHANCE: u64 = 6;

/// Chances of an explicit search that takes a few hundredths of a second, then eight times as many, and so on; the other searches
/// may take as long after each. The last takes some seconds, and a few hundred MB; what it does not find is left to the others.
const TURNS: [usize; 3] = [600_000, 5_000_000, 40_000_000];

/// What was found, and how.
pub(crate) struct Decision {
    /// How quantifiers were decided in the end.
    pub(crate) quantifiers: Quantifiers,
    /// Why so, where the choice was ours.
    pub(crate) because: Option<Because>,
    /// Checks of the outermost query.
    pub(crate) rounds: u32,
    /// The paths of the leading block that decide the objective, if there are some.
    pub(crate) found: Result<Option<Assignment>, Stop>,
}

impl Decision {
    /// Decides an objective.
    pub(crate) fn of(encoder: &Encoder<'_>, config: &Config, oracle: &mut Oracle<'_>) -> Decision {
        let mut search = Search::new(encoder, config);
        let found = search.run(oracle);
        search.end(found)
    }

    /// Nothing was asked, for this reason.
    pub(crate) fn stopped(encoder: &Encoder<'_>, config: &Config, stop: Stop) -> Decision {
        Search::new(encoder, config).end(Err(stop))
    }
}

struct Search<'s, 'a> {
    encoder: &'s Encoder<'a>,
    config: &'s Config,
    blocks: Vec<Vec<PathId>>,
    /// The truth value that the player of the leading block wants the formula to have.
    want: bool,
    /// The choice that is left, and then the one that was made.
    quantifiers: Quantifiers,
    because: Option<Because>,
    rounds: u32,
    /// How many explicit searches had their turn.
    turns: usize,
}

/// An answer of one of the searches: paths of the leading block, or that there are none.
type Found = Option<Assignment>;

impl<'s, 'a> Search<'s, 'a> {
    fn new(encoder: &'s Encoder<'a>, config: &'s Config) -> Self {
        let blocks = encoder.objective.blocks();
        // A single block has no quantifiers to decide: its query has none.
        let alone = blocks.len() == 1;
        Search {
            encoder,
            config,
            want: is_existential(encoder.objective),
            quantifiers: if alone { Quantifiers::Expand } else { config.quantifiers },
            because: alone.then_some(Because::OneBlock),
            rounds: 0,
            turns: 0,
            blocks,
        }
    }

    fn end(self, found: Result<Option<Assignment>, Stop>) -> Decision {
        let Search { quantifiers, because, rounds, .. } = self;
        // No search by instances is to blame.
        let one_query = self.blocks.len() == 1 || quantifiers == Quantifiers::Keep;
        let found = match found {
            Err(Stop::Unknown(Reason::LargeNumbers)) if one_query => Err(Stop::Unknown(Reason::LargeModel)),
            found => found,
        };
        Decision { quantifiers, because, rounds, found }
    }

    fn run(&mut self, oracle: &mut Oracle<'_>) -> Result<Option<Assignment>, Stop> {
        if self.quantifiers == Quantifiers::Keep {
            self.rounds = 1;
            return self.keep(oracle);
        }
        let choice = self.quantifiers;
        if choice == Quantifiers::Explicit {
            return match self.explicit(usize::MAX)? {
                Belief::Found(found) => Ok(Some(found)),
                Belief::Hopeless => Ok(None),
                Belief::Open | Belief::Unfit => Err(Error::from(Unsupported::NotExplicit).into()),
            };
        }
        for narrowing in self.narrowings() {
            self.config.watch.stage(Stage::Preparing);
            // What depends on little is found soonest without any query, but for what one run decides.
            if self.turns == 0
                && !narrowing.one_run
                && let Some(found) = self.without_query(choice)?
            {
                return Ok(found);
            }
            let (found, exact) = match self.query(choice, narrowing)? {
                Some(direct) => self.ask(choice, &direct, oracle)?,
                None => self.by_counterexamples(choice, narrowing, oracle)?,
            };
            if found.is_some() || exact {
                return Ok(found);
            }
        }
        Ok(None)
    }

    /// How many chances the next explicit search may look at, if it has a turn: where the choice is ours, and no query is asked
    /// for, since what solvers are compared by is what they are asked.
    fn chances(&self, choice: Quantifiers) -> Option<usize> {
        let Config { solver, queries, cross_check, limits, .. } = self.config;
        let ours = *solver == Spec::Builtin && queries.is_none() && cross_check.is_none();
        let before = self.turns.checked_sub(1).map_or(0, |last| TURNS[last]);
        let next =
            TURNS.get(self.turns).filter(|_| choice == Quantifiers::Auto && ours && self.blocks.len() == 2);
        next.filter(|_| before < limits.chances).map(|&chances| chances.min(limits.chances))
    }

    /// The chances that the last explicit search was allowed, if there will be another: the other searches may do as much before.
    fn as_much(&self, choice: Quantifiers) -> Option<usize> {
        self.chances(choice).and(self.turns.checked_sub(1)).map(|last| TURNS[last])
    }

    /// An explicit search, if it has a turn, and the answer, if it has one.
    fn without_query(&mut self, choice: Quantifiers) -> Result<Option<Found>, Stop> {
        let Some(chances) = self.chances(choice) else { return Ok(None) };
        self.turns += 1;
        let found = match self.explicit(chances)? {
            Belief::Found(found) => Some(found),
            Belief::Hopeless => None,
            Belief::Open => return Ok(None),
            Belief::Unfit => {
                self.turns = TURNS.len();
                return Ok(None);
            }
        };
        (self.quantifiers, self.because) = (Quantifiers::Explicit, Some(Because::Searched));
        Ok(Some(found))
    }

    /// Asks a query and searches explicitly in turn, each with more effort every time; also whether nothing found means that
    /// there is nothing.
    fn ask(
        &mut self,
        choice: Quantifiers,
        direct: &Direct<'_, '_>,
        oracle: &mut Oracle<'_>,
    ) -> Result<(Found, bool), Stop> {
        self.quantifiers = Quantifiers::Expand;
        self.rounds += 1;
        let mut dialogue = oracle.open(1)?;
        loop {
            let effort = self.as_much(choice).map(|chances| chances as u64 * EFFORT_PER_CHANCE);
            match oracle.check_within(&mut dialogue, &direct.query.script, effort)? {
                Some(true) => return Ok((Some(direct.paths(oracle, &mut dialogue)?), direct.exact)),
                Some(false) => return Ok((None, direct.exact)),
                None => {}
            }
            if let Some(found) = self.without_query(choice)? {
                return Ok((found, true));
            }
        }
    }

    /// Searches by counterexamples and explicitly in turn, each with more effort every time; also whether nothing found means
    /// that there is nothing.
    fn by_counterexamples(
        &mut self,
        choice: Quantifiers,
        narrowing: Narrowing,
        oracle: &mut Oracle<'_>,
    ) -> Result<(Found, bool), Stop> {
        loop {
            let most = self.as_much(choice);
            match self.counterexamples(choice, narrowing, most, oracle) {
                Err(Stop::Unknown(Reason::NoEnd(_))) if most.is_some() && !self.config.deadline.passed() => {}
                answer => return answer,
            }
            if let Some(found) = self.without_query(choice)? {
                return Ok((found, true));
            }
        }
    }

    /// What a search without queries finds of two blocks.
    fn explicit(&self, budget: usize) -> Result<Belief<Assignment>, Stop> {
        let [leading, _] = self.blocks.as_slice() else { return Ok(Belief::Unfit) };
        self.config.watch.stage(Stage::Playing { chances: budget });
        let goal = Goal::new(&self.encoder.objective.formula, self.want);
        let assigned = |known| {
            let mut found: Assignment = vec![None; self.encoder.objective.paths.len()];
            for (&path, known) in leading.iter().zip(known) {
                found[usize::from(path)] = Some(known);
            }
            found
        };
        Ok(self.encoder.writer.believe(leading, &goal, budget)?.map(assigned))
    }

    /// The query without quantifiers, where one is wanted.
    fn query(&mut self, choice: Quantifiers, narrowing: Narrowing) -> Result<Option<Direct<'s, 'a>>, Stop> {
        let Search { encoder, ref blocks, want, .. } = *self;
        match choice {
            // Without a second block there is nothing to expand: the search by counterexamples asks one query.
            Quantifiers::Expand if blocks.len() > 1 => {
                Ok(Some(direct::expand(encoder, blocks, want, narrowing)?))
            }
            Quantifiers::Auto => {
                let query = direct::sweep(encoder, blocks, want, narrowing)?;
                self.because = Some(because(encoder, blocks, query.is_some()));
                Ok(query)
            }
            _ => Ok(None),
        }
    }

    /// Searches by counterexamples, doing as much as an explicit search of so many chances, if there is a limit; also whether nothing found means that there is nothing.
    fn counterexamples(
        &mut self,
        choice: Quantifiers,
        narrowing: Narrowing,
        chances: Option<usize>,
        oracle: &mut Oracle<'_>,
    ) -> Result<(Found, bool), Stop> {
        let auto = choice == Quantifiers::Auto;
        if auto {
            self.quantifiers = Quantifiers::Cegis;
        }
        let patient = !auto || self.encoder.is_finite();
        let objective = self.encoder.objective;
        let goal = Goal::new(&objective.formula, self.want);
        let mut cegis = Cegis::new(self.encoder, oracle, &self.blocks);
        cegis.narrowing = narrowing;
        cegis.most_terms = chances.map(|chances| chances / CHANCES_PER_TERM);
        cegis.most_effort = chances.map(|chances| chances as u64 * EFFORT_PER_CHANCE);
        cegis.most_checks = (!patient).then_some(ENDLESS);
        let found = cegis.find(0, &vec![None; objective.paths.len()], &goal, 1);
        self.rounds += cegis.rounds;
        let exact = cegis.exact;
        match found {
            // Numbers without bounds have infinitely many counterexamples; the solver may know better.
            Err(Stop::Unknown(reason)) if !patient && !self.config.deadline.passed() => {
                self.quantifiers = Quantifiers::Keep;
                self.because = Some(Because::NoEnd);
                match self.keep(oracle) {
                    // Not every solver takes every prefix of quantifiers.
                    Err(Stop::Error(error)) if error.fault() == Fault::Request => Err(Stop::Unknown(reason)),
                    answer => Ok((answer?, true)),
                }
            }
            found => Ok((found?.pop(), exact)),
        }
    }

    /// Which runs of the leading block are tried, one after the other. Where the choice is ours, a search finds a run
    /// that is done first: where nothing else is read it decides; where no path is tied to it, it is worth a guess.
    fn narrowings(&self) -> Vec<Narrowing> {
        let auto = self.config.quantifiers == Quantifiers::Auto;
        let alone = self.blocks.len() == 1;
        if !self.config.among.bounds.is_empty() {
            // Costs say which runs are long.
            let one_run = (auto && alone).then_some(Narrowing { slack: None, one_run: true });
            return one_run.into_iter().chain([Narrowing::default()]).collect();
        }
        let guess = auto && !alone && !self.encoder.objective.has_ties();
        let guess = guess.then_some(Narrowing { slack: SLACKS[0], one_run: true });
        let steps = SLACKS.map(|slack| Narrowing { slack, one_run: auto && alone && slack.is_some() });
        guess.into_iter().chain(steps).collect()
    }

    /// Asks one query with its quantifiers, of a solver that takes them.
    fn keep(&self, oracle: &mut Oracle<'_>) -> Result<Option<Assignment>, Stop> {
        if self.config.solver.is_embedded() {
            return Err(Error::from(Unsupported::KeptQuantifiers).into());
        }
        direct::keep(self.encoder, &self.blocks, self.want)?.solve(oracle, self.blocks.len())
    }
}

/// Why quantifiers are decided as they are, where the choice is ours.
fn because(encoder: &Encoder<'_>, blocks: &[Vec<PathId>], swept: bool) -> Because {
    match blocks {
        _ if swept => Because::Swept,
        [_, last] if last.len() > 1 => Because::SeveralPaths,
        [_, _] if !encoder.states.is_enumerated() => Because::Symbolic,
        [_, _] => Because::ManyRuns,
        _ => Because::Alternations,
    }
}
