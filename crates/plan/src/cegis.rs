//! Counterexample-guided search over any quantifier prefix.
//!
//! The player of a block of paths has a goal (that the formula, or what is left of it, has a given truth value) and
//! looks for paths of its own block that win against the *instances* found so far. What the goal asks of the block
//! alone is demanded at once. Whether a candidate really wins is asked of the other
//! player, recursively, with the candidate fixed. A counterexample becomes an instance: the other player's block
//! defined by inputs in terms of the paths before it, the condition that it is a path as a guard, and fresh copies
//! of the player's own next block. The copies may again leave a block of the other player open; such an instance is
//! one more *game*, checked and refined like the first.
//!
//! Every instance is implied by the objective, so "no candidate" is right. Under the candidate that produced it, an
//! instance evaluates to the counterexample, so that candidate does not come back; over finite systems there are
//! finitely many, and the search ends.

use crate::fact::Reason;
use crate::oracle::{Dialogue, Oracle, Stop};
use hyperplan_encode::{Copies, Encoder, Env, Goal, Instance, Known, Narrowing, Query, Relevant};
use hyperplan_problem::{Objective, PathId, Strategy};
use hyperplan_smt::{Model, Term};
use std::sync::Arc;

/// Counterexamples asked for in one round.
const PER_ROUND: usize = 8;

/// The paths of the leading blocks that are known, by path variable.
pub(crate) type Assignment = Vec<Option<Known>>;

/// What is known of the leading block, as traces.
pub(crate) fn strategy(objective: &Objective, known: &Assignment) -> Strategy {
    let trace = |path: PathId| known[usize::from(path)].as_ref().map(|known| known.trace(path));
    Strategy { traces: objective.leading_block().into_iter().filter_map(trace).collect() }
}

pub(crate) struct Cegis<'s, 'a, 'c> {
    pub(crate) encoder: &'s Encoder<'a>,
    pub(crate) oracle: &'s mut Oracle<'c>,
    /// The blocks of the quantifier prefix, outermost first.
    pub(crate) blocks: &'s [Vec<PathId>],
    /// Rounds of the outermost search.
    pub(crate) rounds: u32,
    /// Checks of all searches, and after how many to give up.
    pub(crate) checks: u32,
    pub(crate) most_checks: Option<u32>,
    /// After how many terms of one query to give up, and after how much effort of the solver in one check.
    pub(crate) most_terms: Option<usize>,
    pub(crate) most_effort: Option<u64>,
    /// Which runs of the leading block are tried.
    pub(crate) narrowing: Narrowing,
    /// Whether nothing has been lost thereby, so that nothing found means that there is nothing.
    pub(crate) exact: bool,
    /// How paths are named in all queries.
    copies: Arc<Copies>,
}

/// An instance of the formula up to a block of the other player.
#[derive(Clone)]
struct Game {
    env: Env,
    /// How each path of `env` is known once a model is.
    recipes: Vec<Option<Recipe>>,
    /// When the instance counts: its paths are paths.
    guard: Term,
    /// The next block, the other player's.
    level: usize,
}

#[derive(Clone)]
enum Recipe {
    Declared,
    Instance(Instance),
}

/// One block's search: the query, its solver, and the games that a candidate has to win.
struct Round<'e, 'a> {
    query: Query<'e, 'a>,
    dialogue: Dialogue,
    /// The block itself, over the paths known.
    first: Game,
    games: Vec<Game>,
    /// What the player wants beyond what its block alone was asked for.
    goal: Goal,
    /// What the other player wants.
    against: Goal,
}

impl<'s, 'a, 'c> Cegis<'s, 'a, 'c> {
    /// A search without limits.
    pub(crate) fn new(
        encoder: &'s Encoder<'a>,
        oracle: &'s mut Oracle<'c>,
        blocks: &'s [Vec<PathId>],
    ) -> Self {
        Cegis {
            encoder,
            oracle,
            blocks,
            rounds: 0,
            checks: 0,
            most_checks: None,
            most_terms: None,
            most_effort: None,
            narrowing: Narrowing::default(),
            exact: true,
            copies: Arc::default(),
        }
    }

    /// Paths of the block at `level` with which its player reaches the goal whatever the later blocks of the other
    /// player are; up to `many` different answers where no block follows, else at most one. Empty: none.
    /// Each answer has the paths known and those of the block.
    pub(crate) fn find(
        &mut self,
        level: usize,
        known: &Assignment,
        goal: &Goal,
        many: usize,
    ) -> Result<Vec<Assignment>, Stop> {
        let last = level + 1 == self.blocks.len();
        let mut round = self.start(level, known, goal, !last || many > 1)?;
        let found = self.search(&mut round, level, known, many)?;
        self.oracle.close(round.dialogue);
        Ok(found)
    }

    fn search(
        &mut self,
        round: &mut Round<'s, 'a>,
        level: usize,
        known: &Assignment,
        many: usize,
    ) -> Result<Vec<Assignment>, Stop> {
        let last = level + 1 == self.blocks.len();
        let mut found = Vec::new();
        loop {
            if level == 0 {
                self.rounds += 1;
            }
            self.checks += 1;
            let written = round.query.script.terms.len();
            if self.most_checks.is_some_and(|most| self.checks > most)
                || self.most_terms.is_some_and(|most| written > most)
            {
                return Err(Stop::Unknown(Reason::NoEnd(self.checks - 1)));
            }
            let answer =
                self.oracle.check_within(&mut round.dialogue, &round.query.script, self.most_effort)?;
            match answer {
                Some(true) => {}
                Some(false) => return Ok(found),
                None => return Err(Stop::Unknown(Reason::NoEnd(self.checks))),
            }
            let symbols = round.symbols();
            let model = self.oracle.model(&mut round.dialogue, &round.query.script, symbols)?;
            // The block's own paths are declared, so they are paths in every model.
            let candidate =
                self.assignment(round, &round.first, known, &model)?.ok_or_else(|| self.no_path(round))?;
            if !last {
                if level == 0 {
                    self.oracle.met(strategy(self.encoder.objective, &candidate));
                }
                if self.refine(round, known, &model)? {
                    continue;
                }
                return Ok(vec![candidate]);
            }
            let more = self.exclude(round, level, &candidate);
            found.push(candidate);
            if found.len() >= many || !more {
                return Ok(found);
            }
        }
    }

    /// The query of a block: its paths, and the formula or the game against the next block.
    fn start(
        &mut self,
        level: usize,
        known: &Assignment,
        goal: &Goal,
        incremental: bool,
    ) -> Result<Round<'s, 'a>, Stop> {
        let encoder = self.encoder;
        let dialogue = match incremental {
            true => self.oracle.open_growing(encoder.writer.features())?,
            false => self.oracle.open(1)?,
        };
        let relevant = match level {
            0 => encoder.writer.relevant(&self.blocks[level], goal, self.narrowing)?,
            _ => Relevant::default(),
        };
        self.exact &= relevant.is_exact();
        let mut query = Query::beside(encoder, known, relevant, &self.copies);
        let mut env = query.known();
        let mut recipes = vec![None; env.len()];
        for &path in &self.blocks[level] {
            env[usize::from(path)] = Some(query.paths.declare(&mut query.script, path, goal)?);
            recipes[usize::from(path)] = Some(Recipe::Declared);
        }
        if level == 0 {
            query.paths.afford(&mut query.script, &env)?;
        }
        let formula = &encoder.objective.formula;
        let (own, rest) = goal.split(formula, &|path| env[usize::from(path)].is_some());
        query.demand(&env, &own);
        let against = rest.opposed(formula);
        let first = Game { env, recipes, guard: Term::TRUE, level: level + 1 };
        let mut round =
            Round { query, dialogue, first: first.clone(), games: Vec::new(), goal: rest, against };
        let copied = self.copied(level, &first);
        round.conclude(self.blocks, first);
        if let Some(copied) = copied {
            round.conclude(self.blocks, copied);
        }
        Ok(round)
    }

    /// The game that is over because the other player, whose block is the last, takes paths that are there already: of the
    /// same systems, and as long. Where the formula asks for a path like another, that is what decides, and nothing
    /// has to be found. Within a search only: the outermost one has better ways for two blocks.
    fn copied(&self, level: usize, game: &Game) -> Option<Game> {
        if level == 0 || game.level + 1 != self.blocks.len() {
            return None;
        }
        let (paths, task) = (&self.encoder.objective.paths, &self.encoder.task);
        let earlier = self.blocks[..level].iter().flatten().rev();
        let there: Vec<PathId> = self.blocks[level].iter().chain(earlier).copied().collect();
        let mut next = game.clone();
        let mut taken = Vec::new();
        for &path in &self.blocks[game.level] {
            let fits = |other: &&PathId| {
                game.env[usize::from(**other)].is_some()
                    && paths[**other].system == paths[path].system
                    && task.horizon(**other) >= task.horizon(path)
            };
            let free = there.iter().find(|other| !taken.contains(*other) && fits(other));
            let other = *free.or_else(|| there.iter().find(fits))?;
            taken.push(other);
            next.env[usize::from(path)] = game.env[usize::from(other)];
        }
        next.level += 1;
        Some(next)
    }

    /// A model that describes no path: instance by instance, numbers without bounds can grow without end.
    fn no_path(&self, round: &Round<'_, 'a>) -> Stop {
        self.oracle.no_path(&round.dialogue, self.encoder)
    }

    /// The paths of a game under a model; `None` where one of its instances describes no path.
    fn assignment(
        &self,
        round: &Round<'_, 'a>,
        game: &Game,
        known: &Assignment,
        model: &Model,
    ) -> Result<Option<Assignment>, Stop> {
        let mut assignment = known.clone();
        for (at, recipe) in game.recipes.iter().enumerate() {
            let path = PathId::from(at);
            match (recipe, game.env[at]) {
                (Some(Recipe::Declared), Some(terms)) => {
                    let decoded = round.query.paths.decode(terms, model);
                    assignment[at] = Some(decoded.ok_or_else(|| self.no_path(round))?);
                }
                (Some(Recipe::Instance(instance)), _) => {
                    let Some(realized) = self.encoder.writer.realize(path, instance, &assignment) else {
                        return Ok(None);
                    };
                    assignment[at] = Some(realized);
                }
                _ => {}
            }
        }
        Ok(Some(assignment))
    }

    /// Lets the other player answer in every game, and adds what it finds. Whether it found anything.
    fn refine(&mut self, round: &mut Round<'_, 'a>, known: &Assignment, model: &Model) -> Result<bool, Stop> {
        let mut defeated = false;
        for at in 0..round.games.len() {
            let game = round.games[at].clone();
            let Some(assignment) = self.assignment(round, &game, known, model)? else { continue };
            for answer in self.find(game.level, &assignment, &round.against, PER_ROUND)? {
                defeated = true;
                self.add(round, &game, &answer)?;
            }
        }
        Ok(defeated)
    }

    /// Adds the instance that a counterexample stands for.
    fn add(&mut self, round: &mut Round<'_, 'a>, game: &Game, answer: &Assignment) -> Result<(), Stop> {
        let query = &mut round.query;
        let mut next = game.clone();
        let (mut absolute, mut beside) = (true, Vec::new());
        for &path in &self.blocks[game.level] {
            let Some(counterexample) = &answer[usize::from(path)] else { continue };
            let instance = self.encoder.writer.generalize(path, counterexample, answer);
            let (terms, guard) =
                query.paths.instantiate(&mut query.script, path, &instance, &next.env, &round.against)?;
            next.guard = query.script.terms.and2(next.guard, guard);
            next.env[usize::from(path)] = Some(terms);
            absolute &= instance.is_absolute();
            next.recipes[usize::from(path)] = Some(Recipe::Instance(instance));
            beside.push((path, counterexample.clone()));
        }
        next.level += 1;
        if absolute && game.guard == Term::TRUE && next.level == self.blocks.len() {
            for &path in &self.blocks[game.level - 1] {
                if let Some(terms) = game.env[usize::from(path)] {
                    query.paths.restrict(&mut query.script, terms, &round.goal, &beside)?;
                }
            }
        }
        if next.level < self.blocks.len() {
            for &path in &self.blocks[next.level] {
                next.env[usize::from(path)] =
                    Some(query.paths.declare(&mut query.script, path, &round.goal)?);
                next.recipes[usize::from(path)] = Some(Recipe::Declared);
            }
            next.level += 1;
        }
        round.conclude(self.blocks, next);
        Ok(())
    }

    /// Asks for an answer that differs from this one in more than what follows from the paths known; whether that is
    /// worth while. An answer that has nothing to do with those paths makes a weak instance: one a round is enough.
    fn exclude(&mut self, round: &mut Round<'_, 'a>, level: usize, answer: &Assignment) -> bool {
        let mut alike = Vec::new();
        let mut absolute = true;
        for &path in &self.blocks[level] {
            if let (Some(own), Some(terms)) = (&answer[usize::from(path)], round.first.env[usize::from(path)])
            {
                let instance = self.encoder.writer.generalize(path, own, answer);
                absolute &= instance.is_absolute();
                alike.push(round.query.resembles(terms, &instance));
            }
        }
        let alike = round.query.script.terms.and(&alike);
        round.query.script.assert(!alike);
        alike != Term::TRUE && !absolute
    }
}

impl Round<'_, '_> {
    /// Demands the formula where all paths are there; else leaves the game open.
    fn conclude(&mut self, blocks: &[Vec<PathId>], game: Game) {
        if game.level < blocks.len() {
            self.games.push(game);
            return;
        }
        self.query.script.section("formula", "the rest of the formula");
        let formula = self.query.goal(&game.env, &self.goal);
        self.query.script.clause(&[!game.guard, formula]);
    }

    /// The symbols that describe the paths chosen by the solver, in all games.
    fn symbols(&self) -> Vec<Term> {
        let mut symbols = Vec::new();
        for game in std::iter::once(&self.first).chain(&self.games) {
            for (path, recipe) in game.env.iter().zip(&game.recipes) {
                if let (Some(path), Some(Recipe::Declared)) = (*path, recipe) {
                    symbols.extend(self.query.paths.symbols(path));
                }
            }
        }
        symbols.sort_unstable();
        symbols.dedup();
        symbols
    }
}
