//! What can matter of the paths of one query: of those of the leading block, found ahead and together, and of the
//! others, found as they are asked for.

use crate::ceiling::{self, NO_WAY};
use crate::game::Game;
use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::{self, Explored, Question};
use crate::task::{Arena, Error, Pruning};
use hyperplan_problem::{PathId, Quantifier};
use hyperplan_space::{Run, StateIx};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Which runs of the leading block are kept. What is found among some is right; that nothing is found says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Narrowing {
    /// Runs that owe nothing but safety at most so many steps after the earliest one does; without, all.
    pub slack: Option<u32>,
    /// Of these one only, that is there first, where it can be told: for a block of one path, and of two that are tied
    /// and that the formula reads nothing else beside.
    pub one_run: bool,
}

/// What was found so far. By default nothing was, and nothing is excluded.
#[derive(Clone, Debug, Default)]
pub struct Relevant {
    /// By path, and by what its player wants.
    layers: FxHashMap<(PathId, Goal), Arc<Layers>>,
    /// Where the first copy of each declared path can be.
    declared: FxHashMap<PathId, Arc<Layers>>,
    /// The game of the two paths that there are, where they are tied.
    game: Option<Arc<Game>>,
    lossy: bool,
}

impl Relevant {
    /// Whether no run was lost by narrowing, so that nothing found means that there is nothing.
    pub fn is_exact(&self) -> bool {
        !self.lossy
    }

    /// Whether it is plain that no choice of the leading block reaches its player's goal: nothing of some path can
    /// matter. Every quantifier must range over some path.
    pub fn is_hopeless(&self) -> bool {
        self.declared.values().any(|layers| layers.is_empty())
    }

    /// The game, if that is about these paths.
    pub fn game(&self) -> Option<&Arc<Game>> {
        self.game.as_ref()
    }
}

/// What can matter of the paths of the leading block for its player to reach the goal.
///
/// # Errors
/// [`Error::TooLarge`] where too much can matter.
pub fn leading(
    arena: &Arena<'_>,
    block: &[PathId],
    goal: &Goal,
    narrowing: Narrowing,
) -> Result<Relevant, Error> {
    let nothing = vec![None; arena.graphs.len()];
    let mut search = Relevance { narrowing, ..Relevance::new(arena, nothing, Relevant::default()) };
    if arena.task.limits.prunes() {
        search.explore_block(block, goal)?;
    }
    for &path in block {
        search.declare(path, goal)?;
    }
    Ok(search.found)
}

/// A value that the sum of the last ceiling is not below, whatever the choice of the leading block for its player to reach the
/// goal; [`NO_WAY`] where there is none.
///
/// # Errors
/// [`Error::TooLarge`] where too much can matter.
pub fn least(arena: &Arena<'_>, goal: &Goal) -> Result<i64, Error> {
    let search = Relevance::new(arena, vec![None; arena.graphs.len()], Relevant::default());
    let nothing = Goal::nothing();
    let goal = if arena.task.limits.prunes() { goal } else { &nothing };
    let mut sum: i64 = 0;
    let Some(ceiling) = arena.ceilings.last() else { return Ok(0) };
    for (path, _) in &ceiling.weights {
        let own = reach::least_cost(&search.question([*path], goal, &search.fixed), ceiling)?;
        sum = sum.saturating_add(own).min(NO_WAY);
    }
    Ok(sum)
}

/// What is known of the paths of one query, and what is found out about the others.
pub struct Relevance<'e, 'a> {
    arena: &'e Arena<'a>,
    /// Paths that are constants throughout.
    pub(crate) fixed: Vec<Option<Run>>,
    found: Relevant,
    narrowing: Narrowing,
    /// A time before which no choice of the leading block owes nothing but safety.
    least: u32,
}

impl<'e, 'a> Relevance<'e, 'a> {
    /// Beside known paths, given what was found out before.
    pub fn new(arena: &'e Arena<'a>, fixed: Vec<Option<Run>>, found: Relevant) -> Self {
        Relevance { arena, fixed, found, narrowing: Narrowing::default(), least: 0 }
    }

    /// What was found so far.
    pub fn found(&self) -> &Relevant {
        &self.found
    }

    /// What can matter of a path, which is from now on known to be there.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn declare(&mut self, path: PathId, goal: &Goal) -> Result<Arc<Layers>, Error> {
        let layers = self.layers(path, goal)?;
        self.found.declared.entry(path).or_insert_with(|| layers.clone());
        Ok(layers)
    }

    /// What can matter of a path for its player to reach the goal. A path whose actions or states the formula
    /// compares with those of a path that has been declared is explored together with that one, where the budget
    /// allows.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn layers(&mut self, path: PathId, goal: &Goal) -> Result<Arc<Layers>, Error> {
        let key = (path, goal.clone());
        if let Some(known) = self.found.layers.get(&key) {
            return Ok(known.clone());
        }
        let found = match self.arena.task.limits.pruning {
            Pruning::Full => self.explore(path, goal)?,
            Pruning::Light => self.alone(path, &Goal::nothing(), &self.fixed)?,
            Pruning::None => self.unexplored(path)?,
        };
        Ok(self.keep(key, found))
    }

    /// What can matter of a path beside these known ones and those of the query.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn beside(
        &self,
        path: PathId,
        goal: &Goal,
        others: impl IntoIterator<Item = (PathId, Run)>,
    ) -> Result<Layers, Error> {
        let mut fixed = self.fixed.clone();
        for (other, run) in others {
            fixed[usize::from(other)] = Some(run);
        }
        let Explored { layers: [found], .. } = self.alone(path, goal, &fixed)?;
        Ok(found)
    }

    fn keep(&mut self, key: (PathId, Goal), found: Explored<1>) -> Arc<Layers> {
        let Explored { layers: [layers], lossy } = found;
        let layers = Arc::new(layers);
        self.found.lossy |= lossy;
        self.found.layers.insert(key, layers.clone());
        layers
    }

    fn explore(&mut self, path: PathId, goal: &Goal) -> Result<Explored<1>, Error> {
        // With a slack there is little to explore alone; without, little beside a path that has been declared.
        if self.narrowing.slack.is_none()
            && let Some(found) = self.beside_declared(path, goal, None)
        {
            return Ok(found);
        }
        let alone = self.alone(path, goal, &self.fixed)?;
        if let Some(game) = self.play(path, goal, &alone.layers[0]) {
            let found = Explored { layers: [game.layers()], lossy: alone.lossy || game.lossy };
            self.found.game = Some(Arc::new(game));
            return Ok(found);
        }
        let beside = self.beside_declared(path, goal, Some(&alone.layers[0]));
        Ok(beside
            .map_or_else(|| alone.clone(), |found| Explored { lossy: alone.lossy || found.lossy, ..found }))
    }

    /// Explores the paths of the leading block, together where the formula ties two.
    fn explore_block(&mut self, block: &[PathId], goal: &Goal) -> Result<(), Error> {
        let task = &self.arena.task;
        if self.narrowing.slack.is_some() && block.len() > 1 {
            for &path in block {
                self.least = self.least.max(reach::least(&self.question([path], goal, &self.fixed)));
            }
        }
        let one_run = self.narrowing.one_run;
        match *block {
            [path] if one_run => {
                let mut question = self.question([path], goal, &self.fixed);
                question.one_run = true;
                question.ceiling = self.arena.ceilings.last();
                let found = self.affordable(path, reach::layers(&question)?);
                self.keep((path, goal.clone()), found);
            }
            [first, second] if task.objective.ties(first, second) => {
                let alone = [self.alone(first, goal, &self.fixed)?, self.alone(second, goal, &self.fixed)?];
                let mut question = self.question([first, second], goal, &self.fixed);
                question.within = [Some(&alone[0].layers[0]), Some(&alone[1].layers[0])];
                question.budget = task.limits.pairs;
                let (_, rest) = goal.split(&task.objective.formula, &|path| block.contains(&path));
                question.one_run = one_run && rest.is_empty();
                question.ceiling = self.arena.ceilings.last();
                // Too many pairs, and the two are explored one by one.
                let Ok(found) = reach::pair_layers(&question) else { return task.go_on() };
                let lossy = found.lossy || alone.iter().any(|alone| alone.lossy);
                for (path, layers) in [first, second].into_iter().zip(found.layers) {
                    let one = Explored { layers: [layers], lossy };
                    self.keep((path, goal.clone()), one);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The game of the only path of the leading block, whose player has the goal, and the only other. `None` where the
    /// formula does not tie them, and where there is too much to explore.
    fn play(&self, path: PathId, goal: &Goal, within: &Layers) -> Option<Game> {
        let task = &self.arena.task;
        let [own, other] = task.objective.paths.raw.as_slice() else { return None };
        let formula = &task.objective.formula;
        let leads = usize::from(path) == 0 && own.quantifier != other.quantifier;
        let wants = Goal::new(formula, own.quantifier == Quantifier::Exists);
        if !leads || *goal != wants || self.fixed.iter().any(Option::is_some) {
            return None;
        }
        let other = PathId::from(1);
        if !task.objective.ties(path, other) {
            return None;
        }
        let (_, rest) = goal.split(formula, &|p| p == path);
        let against = rest.opposed(formula);
        let mut question = self.question([path, other], &against, &self.fixed);
        question.within = [Some(within), None];
        question.budget = task.limits.pairs;
        Game::new(&question)
    }

    pub(crate) fn question<'q, const N: usize>(
        &'q self,
        paths: [PathId; N],
        goal: &'q Goal,
        fixed: &'q [Option<Run>],
    ) -> Question<'q, N> {
        Question {
            arena: self.arena,
            paths,
            within: [None; N],
            goal,
            fixed,
            declared: &self.found.declared,
            slack: self.narrowing.slack,
            least: self.least,
            one_run: false,
            ceiling: None,
            budget: self.arena.task.limits.layer_states,
        }
    }

    /// All states of a path's system at every time, but for those that it cannot begin in, and at each time those from
    /// which it cannot go on.
    fn unexplored(&self, path: PathId) -> Result<Explored<1>, Error> {
        let mut found = self.alone(path, &Goal::nothing(), &self.fixed)?;
        let [layers] = &mut found.layers;
        let (task, graph) = (&self.arena.task, &self.arena.graphs[path]);
        let known = self.fixed[usize::from(path)].is_some();
        let mut count = 0_usize;
        for (time, layer) in layers.at.iter_mut().enumerate().skip(1).filter(|_| !known) {
            task.go_on()?;
            layer.clear();
            let states = (0..graph.len()).filter_map(|state| StateIx::try_from(state).ok());
            let time = u32::try_from(time).unwrap_or(u32::MAX);
            layer.extend(states.filter(|&state| task.lasts(graph, state, time)));
            count += layer.len();
            if count > task.limits.layer_states {
                return Err(Error::TooLarge {
                    what: format!("states of {} at all times", task.objective.paths[path].name),
                    limit: task.limits.layer_states,
                });
            }
        }
        Ok(found)
    }

    fn alone(&self, path: PathId, goal: &Goal, fixed: &[Option<Run>]) -> Result<Explored<1>, Error> {
        Ok(self.affordable(path, reach::layers(&self.question([path], goal, fixed))?))
    }

    /// What is left of the layers of a path under what it may cost.
    fn affordable(&self, path: PathId, mut found: Explored<1>) -> Explored<1> {
        for ceiling in &self.arena.ceilings {
            if let Some(weights) = ceiling.of(path) {
                let [layers] = found.layers;
                let graph = &self.arena.graphs[path];
                // Whatever others cost, it is not negative.
                found.layers = [ceiling::lowered(graph, layers, weights, ceiling.most)];
            }
        }
        found
    }

    /// Beside a path that has been declared and that the formula ties to this one. `None` where there is none, or too
    /// many pairs.
    fn beside_declared(&self, path: PathId, goal: &Goal, alone: Option<&Layers>) -> Option<Explored<1>> {
        let objective = self.arena.task.objective;
        let partners = objective.tied_before(path).into_iter().chain(objective.compared_before(path));
        let (other, beside) = partners.into_iter().find_map(|p| Some((p, self.found.declared.get(&p)?)))?;
        let mut question = self.question([other, path], goal, &self.fixed);
        question.within = [Some(beside), alone];
        question.slack = None;
        question.budget = self.arena.task.limits.pairs;
        let Explored { layers: [_, found], lossy } = reach::pair_layers(&question).ok()?;
        Some(Explored { layers: [found], lossy })
    }
}
