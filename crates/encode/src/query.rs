//! One script under construction, and the table that leads back from its values to paths.

use crate::atom::PathAtoms;
use crate::choice::Alphabet;
use crate::explicit::{Building, ExplicitPath, FixedPath, Instances};
use crate::game::Game;
use crate::goal::Goal;
use crate::inputs::{Move, Start};
use crate::names::Names;
use crate::path::{Instance, Known, Path, Shape};
use crate::reach::{self, Layers, Question};
use crate::sweep::{Sweep, sweep};
use crate::symbolic::{Builder, SymbolicPath};
use crate::unroll::Unroller;
use crate::{Encoder, Error, Graph, Model as SystemModel, States};
use hyperplan_problem::{PathId, Quantifier, System, SystemId};
use hyperplan_smt::{Model, Script, Term, Terms};
use rustc_hash::FxHashMap;
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use typed_index_collections::TiVec;

/// The paths over which the formula is unrolled, by path variable.
pub type Env = Vec<Option<Rc<Path>>>;

/// Which runs of the leading block are kept. What is found among some is right; that nothing is found says nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Narrowing {
    /// Runs that owe nothing but safety at most so many steps after the earliest one does; without, all.
    pub slack: Option<u32>,
    /// Of these one only, that is there first, where it can be told: for a block of one path, and of two that are tied
    /// and that the formula reads nothing else beside.
    pub one_run: bool,
}

/// One script under construction.
pub struct Query<'e, 'a> {
    encoder: &'e Encoder<'a>,
    /// What has been asserted so far, and the terms.
    pub script: Script,
    /// Paths that are constants throughout, for pruning.
    fixed: Vec<Option<FixedPath>>,
    layers: FxHashMap<(PathId, Goal), Rc<Layers>>,
    /// What can matter of the first copy of each declared path.
    declared: FxHashMap<PathId, Rc<Layers>>,
    /// The game of the two paths that there are, where they are tied and the first has been explored.
    game: Option<Rc<Game>>,
    /// See [`Query::narrowed`].
    narrowing: Narrowing,
    /// A time before which no choice of the leading block owes nothing but safety.
    least: u32,
    /// Whether runs have been lost that the goal does not exclude.
    lossy: Cell<bool>,
    instances: Instances,
    /// How states and letters are written, by system, where they are enumerated.
    alphabets: TiVec<SystemId, Alphabet>,
    copies: Rc<Copies>,
}

/// How many paths each path variable has stood for, so that all have names of their own.
#[derive(Debug, Default)]
pub struct Copies(RefCell<FxHashMap<PathId, u32>>);

impl Copies {
    /// The number of one more.
    fn next(&self, path: PathId) -> u32 {
        let mut copies = self.0.borrow_mut();
        let copy = copies.entry(path).or_default();
        *copy += 1;
        *copy - 1
    }
}

/// How the states and letters of each system are written.
fn alphabets(encoder: &Encoder<'_>, terms: &mut Terms) -> TiVec<SystemId, Alphabet> {
    let alphabet = |(system, model): (&System, &Option<SystemModel>)| match model
        .as_ref()
        .and_then(|m| m.graph.as_deref())
    {
        Some(graph) if encoder.states == States::Enum => {
            let names = Names { problem: encoder.problem, system, path: system.name.clone() };
            Alphabet::enumerations(terms, &names, graph)
        }
        _ => Alphabet::ONEHOT,
    };
    encoder.problem.systems.iter().zip(&encoder.models).map(alphabet).collect()
}

pub(crate) fn names<'a>(encoder: &Encoder<'a>, path: PathId, copy: u32) -> Names<'a> {
    let name = &encoder.objective.paths[path].name;
    let path_name = if copy == 0 { name.clone() } else { format!("{name}~{copy}") };
    Names { problem: encoder.problem, system: encoder.system(path), path: path_name }
}

impl<'e, 'a> Query<'e, 'a> {
    /// An empty script for a question in which some paths are known.
    #[must_use]
    pub fn new(encoder: &'e Encoder<'a>, known: &[Option<Known>]) -> Self {
        let fixed = encoder
            .objective
            .paths
            .keys()
            .map(|path| match known.get(usize::from(path)) {
                Some(Some(Known::Explicit(fixed))) => Some(fixed.clone()),
                _ => None,
            })
            .collect();
        let mut script = Script::new();
        let alphabets = alphabets(encoder, &mut script.terms);
        Query {
            encoder,
            script,
            fixed,
            layers: FxHashMap::default(),
            declared: FxHashMap::default(),
            game: None,
            narrowing: Narrowing::default(),
            least: 0,
            lossy: Cell::new(false),
            instances: Instances::default(),
            alphabets,
            copies: Rc::default(),
        }
    }

    /// Names paths beside those of other queries, so that these can be parts of one text.
    #[must_use]
    pub fn beside(mut self, copies: &Rc<Copies>) -> Self {
        self.copies = copies.clone();
        self
    }

    /// Keeps of the runs of the paths declared first only some.
    #[must_use]
    pub fn narrowed(mut self, narrowing: Narrowing) -> Self {
        self.narrowing = narrowing;
        self
    }

    /// Lifts [`Query::narrowed`] for the paths to come.
    pub fn widen(&mut self) {
        self.narrowing = Narrowing::default();
    }

    /// Whether no run was lost by [`Query::narrowed`], so that nothing found means that there is nothing.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        !self.lossy.get()
    }

    /// An environment without paths.
    #[must_use]
    pub fn empty_env(&self) -> Env {
        vec![None; self.encoder.objective.paths.len()]
    }

    fn names(&mut self, path: PathId) -> Names<'a> {
        names(self.encoder, path, self.copies.next(path))
    }

    /// What can matter of a path for its player to reach the goal. A path whose actions or states the formula
    /// compares with those of a path that has been declared is explored together with that one, where the budget
    /// allows.
    fn layers(&mut self, path: PathId, goal: &Goal) -> Result<Rc<Layers>, Error> {
        let key = (path, goal.clone());
        if let Some(known) = self.layers.get(&key) {
            return Ok(known.clone());
        }
        if !self.encoder.limits.prune {
            let found = Rc::new(self.explore(path, &Goal::nothing(), &self.fixed)?);
            self.layers.insert(key, found.clone());
            return Ok(found);
        }
        // With a slack there is little to explore alone; without, little beside a path that has been declared.
        let beside = self.narrowing.slack.is_none().then(|| self.explore_beside(path, goal, None)).flatten();
        let found = match beside {
            Some(found) => found,
            None => {
                let alone = self.explore(path, goal, &self.fixed)?;
                match self.play(path, goal, &alone) {
                    Some(game) => {
                        let layers = game.layers();
                        self.game = Some(Rc::new(game));
                        layers
                    }
                    None => self.explore_beside(path, goal, Some(&alone)).unwrap_or(alone),
                }
            }
        };
        let found = Rc::new(found);
        self.layers.insert(key, found.clone());
        Ok(found)
    }

    /// Explores the paths of the leading block, together where the formula ties two.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn explore_block(&mut self, block: &[PathId], goal: &Goal) -> Result<(), Error> {
        if !self.encoder.states.is_enumerated() || !self.encoder.limits.prune {
            return Ok(());
        }
        if self.narrowing.slack.is_some() && block.len() > 1 {
            for &path in block {
                self.least = self.least.max(reach::least(&self.question([path], goal, &self.fixed))?);
            }
        }
        let one_run = self.narrowing.one_run;
        match *block {
            [path] if one_run => {
                let mut question = self.question([path], goal, &self.fixed);
                question.one_run = true;
                let found = reach::layers(&question)?;
                self.layers.insert((path, goal.clone()), Rc::new(found));
            }
            [first, second] if self.encoder.ties(first, second) => {
                let alone =
                    [self.explore(first, goal, &self.fixed)?, self.explore(second, goal, &self.fixed)?];
                let mut question = self.question([first, second], goal, &self.fixed);
                question.within = [Some(&alone[0]), Some(&alone[1])];
                question.budget = self.encoder.limits.pairs;
                let (_, rest) = goal.split(&self.encoder.objective.formula, &|path| block.contains(&path));
                question.one_run = one_run && rest.is_empty();
                let Ok(found) = reach::pair_layers(&question) else { return self.encoder.go_on() };
                for (path, found) in [first, second].into_iter().zip(found) {
                    self.layers.insert((path, goal.clone()), Rc::new(found));
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The game of the only path of the leading block, whose player has the goal, and the only other. `None` where the
    /// formula does not tie them, and where there is too much to explore.
    fn play(&self, path: PathId, goal: &Goal, within: &Layers) -> Option<Game> {
        let encoder = self.encoder;
        let [own, other] = encoder.objective.paths.raw.as_slice() else { return None };
        let formula = &encoder.objective.formula;
        let leads = usize::from(path) == 0 && own.quantifier != other.quantifier;
        let wants = Goal::new(formula, own.quantifier == Quantifier::Exists);
        if !leads || *goal != wants || self.fixed.iter().any(Option::is_some) {
            return None;
        }
        let other = PathId::from(1);
        if !encoder.ties(path, other) {
            return None;
        }
        let (_, rest) = goal.split(formula, &|p| p == path);
        let against = rest.opposed(formula);
        let mut question = self.question([path, other], &against, &self.fixed);
        question.within = [Some(within), None];
        question.budget = encoder.limits.pairs;
        Game::new(&question)
    }

    /// Whether it is plain that no choice of the leading block's paths reaches its player's goal: nothing of some path
    /// can matter. Where states are not enumerated, nothing is plain. Every quantifier must range over some path.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn is_hopeless(&mut self, block: &[PathId], goal: &Goal) -> Result<bool, Error> {
        if !self.encoder.states.is_enumerated() {
            return Ok(false);
        }
        self.explore_block(block, goal)?;
        for &path in block {
            let layers = self.layers(path, goal)?;
            if layers.is_empty() {
                return Ok(true);
            }
            self.declared.entry(path).or_insert(layers);
        }
        Ok(false)
    }

    fn question<'q, const N: usize>(
        &'q self,
        paths: [PathId; N],
        goal: &'q Goal,
        fixed: &'q [Option<FixedPath>],
    ) -> Question<'q, N> {
        Question {
            encoder: self.encoder,
            paths,
            within: [None; N],
            goal,
            fixed,
            declared: &self.declared,
            slack: self.narrowing.slack,
            least: self.least,
            one_run: false,
            lossy: &self.lossy,
            budget: self.encoder.limits.layer_states,
        }
    }

    fn explore(&self, path: PathId, goal: &Goal, fixed: &[Option<FixedPath>]) -> Result<Layers, Error> {
        reach::layers(&self.question([path], goal, fixed))
    }

    /// `None` where there is no such other path, or too many pairs.
    fn explore_beside(&self, path: PathId, goal: &Goal, alone: Option<&Layers>) -> Option<Layers> {
        let encoder = self.encoder;
        let partners = encoder.tied_before(path).into_iter().chain(encoder.compared_before(path));
        let (other, beside) = partners.into_iter().find_map(|p| Some((p, self.declared.get(&p)?)))?;
        let mut question = self.question([other, path], goal, &self.fixed);
        question.within = [Some(beside), alone];
        question.slack = None;
        question.budget = encoder.limits.pairs;
        let [_, found] = reach::pair_layers(&question).ok()?;
        Some(found)
    }

    fn builder<'n>(&self, path: PathId, names: &'n Names<'a>) -> Builder<'n>
    where
        'e: 'n,
    {
        let model = self.encoder.model(path);
        Builder {
            names,
            moves: model.moves.as_deref().expect("symbolic paths have moves"),
            live: model.live.as_deref(),
            horizon: self.encoder.horizon(path),
        }
    }

    fn path(&self, path: PathId, shape: Shape) -> Rc<Path> {
        Rc::new(Path { shape, moves: self.encoder.model(path).moves.clone() })
    }

    /// A path that the solver chooses to reach a goal.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn declare(&mut self, path: PathId, goal: &Goal) -> Result<Rc<Path>, Error> {
        let names = self.names(path);
        let shape = match self.encoder.states {
            States::Onehot | States::Enum => {
                let layers = self.layers(path, goal)?;
                self.declared.entry(path).or_insert_with(|| layers.clone());
                let graph = explicit_graph(self.encoder, path);
                let script = &mut self.script;
                let alphabet = &self.alphabets[self.encoder.objective.paths[path].system];
                let stop = self.encoder.stop;
                let declared = ExplicitPath::declare(script, &names, graph, &layers, alphabet, stop)?;
                if let Some(game) = self.game.as_ref().filter(|game| game.paths[0] == path) {
                    close_moves(script, game, &declared);
                }
                Shape::Explicit(declared)
            }
            States::Bitvec | States::Int | States::Real => {
                let declared = self.builder(path, &names).declare(&mut self.script);
                Shape::Symbolic(declared)
            }
        };
        Ok(self.path(path, shape))
    }

    /// A path under a quantifier: the path, the bound variables, and the condition that they describe a path.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn bind(&mut self, path: PathId, goal: &Goal) -> Result<(Rc<Path>, Vec<Term>, Term), Error> {
        let names = self.names(path);
        let (shape, bound, guard) = match self.encoder.states {
            States::Onehot | States::Enum => {
                let layers = self.layers(path, goal)?;
                let graph = explicit_graph(self.encoder, path);
                let terms = &mut self.script.terms;
                let alphabet = &self.alphabets[self.encoder.objective.paths[path].system];
                let (path, bound, guard) =
                    ExplicitPath::bind(terms, &names, graph, &layers, alphabet, self.encoder.stop)?;
                (Shape::Explicit(path), bound, guard)
            }
            States::Bitvec | States::Int | States::Real => {
                let builder = self.builder(path, &names);
                let (path, bound, guard) = builder.bind(&mut self.script.terms);
                (Shape::Symbolic(path), bound, guard)
            }
        };
        Ok((self.path(path, shape), bound, guard))
    }

    /// A known path, as constants.
    #[must_use]
    pub fn fix(&mut self, path: PathId, known: &Known) -> Rc<Path> {
        let shape = match known {
            Known::Explicit(fixed) => Shape::Explicit(ExplicitPath::fix(fixed)),
            Known::Symbolic(fixed) => {
                let names = names(self.encoder, path, 0);
                let builder = self.builder(path, &names);
                Shape::Symbolic(builder.fix(&mut self.script.terms, fixed))
            }
        };
        self.path(path, shape)
    }

    /// An instance of a path whose player has the goal: the path, and the condition that it is one.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn instantiate(
        &mut self,
        path: PathId,
        instance: &Instance,
        env: &Env,
        goal: &Goal,
    ) -> Result<(Rc<Path>, Term), Error> {
        let (shape, guard) = match instance {
            Instance::Explicit(inputs) => {
                let layers = self.layers(path, goal)?;
                let graph = explicit_graph(self.encoder, path);
                let others: Vec<Option<&ExplicitPath>> =
                    env.iter().map(|p| p.as_deref().and_then(explicit)).collect();
                let names = self.names(path);
                let script = &mut self.script;
                let mut building =
                    Building { script, path, names: &names, graph, layers: &layers, env: &others };
                let (path, guard) = self.instances.build(&mut building, inputs);
                (Shape::Explicit(path), guard)
            }
            Instance::Symbolic(inputs) => {
                let names = names(self.encoder, path, 0);
                let builder = self.builder(path, &names);
                let others: Vec<Option<&SymbolicPath>> =
                    env.iter().map(|p| p.as_deref().and_then(symbolic)).collect();
                let (path, guard) = builder.instantiate(&mut self.script.terms, inputs, &others);
                (Shape::Symbolic(path), guard)
            }
        };
        Ok((self.path(path, shape), guard))
    }

    /// Demands of a declared path what the goal asks of it next to a known one: states from which it cannot be met
    /// are excluded at once. The solver would find out, but by search.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn restrict(
        &mut self,
        path: PathId,
        terms: &Path,
        goal: &Goal,
        beside: &[(PathId, Known)],
    ) -> Result<(), Error> {
        let Shape::Explicit(explicit) = &terms.shape else { return Ok(()) };
        if !self.encoder.limits.prune {
            return Ok(());
        }
        let mut fixed = self.fixed.clone();
        for (other, known) in beside {
            if let Known::Explicit(known) = known {
                fixed[usize::from(*other)] = Some(known.clone());
            }
        }
        let layers = self.explore(path, goal, &fixed)?;
        for (time, layer) in explicit.layers.iter().enumerate() {
            for (&state, &term) in layer.states.iter().zip(&layer.terms) {
                if !layers.contains(time, state) {
                    self.script.assert(!term);
                }
            }
        }
        Ok(())
    }

    /// Whether a declared path is like a counterexample: starts like it and takes the actions that the instance
    /// made of it gives outright. Used to ask for a different one.
    pub fn resembles(&mut self, terms: &Path, instance: &Instance) -> Term {
        let script_terms = &mut self.script.terms;
        let mut parts = Vec::new();
        match (&terms.shape, instance) {
            (Shape::Explicit(path), Instance::Explicit(inputs)) => {
                if let Start::State(state) = inputs.start {
                    parts.push(path.layers[0].is(state));
                }
                for (step, movement) in path.steps.iter().zip(&inputs.moves) {
                    if let Move::Act(action, _) = *movement {
                        parts.push(step.took(action));
                    }
                }
            }
            (Shape::Symbolic(path), Instance::Symbolic(inputs)) => {
                if let Start::State(row) = &inputs.start {
                    for (value, &known) in path.states[0].iter().zip(row) {
                        parts.push(crate::value::is(script_terms, value, known));
                    }
                }
                for (step, movement) in path.steps.iter().zip(&inputs.moves) {
                    if let Move::Act(action, _) = *movement {
                        parts.push(step.took(action));
                    }
                }
            }
            _ => {}
        }
        script_terms.and(&parts)
    }

    /// Demands that no choice of a path, the last of all, reaches its player's goal, whatever it is; `env` has the
    /// paths before it. False, with nothing of use demanded, where that takes too much or states are not enumerated.
    ///
    /// # Errors
    /// [`Error::TooLarge`] where too much can matter.
    pub fn sweep(&mut self, path: PathId, env: &Env, goal: &Goal) -> Result<bool, Error> {
        if !self.encoder.states.is_enumerated() {
            return Ok(false);
        }
        let names = self.names(path);
        let game = self.game.clone().filter(|game| game.paths[1] == path && game.goal == *goal);
        let game = game.as_deref().and_then(|game| {
            let leading = env[usize::from(game.paths[0])].as_deref()?;
            Some((game, explicit(leading)?))
        });
        let layers = match game {
            Some((game, _)) => Rc::new(game.other_layers()),
            None => self.layers(path, goal)?,
        };
        let graph = explicit_graph(self.encoder, path);
        let question =
            Sweep { encoder: self.encoder, graph, names: &names, path, layers: &layers, goal, env, game };
        Ok(sweep(&question, &mut self.script).is_some())
    }

    /// Asserts a goal over these paths, which must be all that it reads: of a conjunction each part in a section of
    /// its own.
    pub fn demand(&mut self, env: &Env, goal: &Goal) {
        let encoder = self.encoder;
        let formula = &encoder.objective.formula;
        let atoms = PathAtoms::new(encoder.problem, encoder.objective, env);
        let mut unroller = Unroller::new(formula, encoder.objective.mode, atoms);
        for part in goal.conjuncts() {
            let (number, text) = part.described(encoder.problem, encoder.objective);
            self.script.section(format!("formula.{number}"), text);
            let demanded = unroller.goal(&mut self.script.terms, &part);
            self.script.assert(demanded);
        }
    }

    /// A goal over these paths, which must be all that it reads.
    pub fn goal(&mut self, env: &Env, goal: &Goal) -> Term {
        let encoder = self.encoder;
        let atoms = PathAtoms::new(encoder.problem, encoder.objective, env);
        let mut unroller = Unroller::new(&encoder.objective.formula, encoder.objective.mode, atoms);
        unroller.goal(&mut self.script.terms, goal)
    }

    /// The path that a model describes; `None` if it is none, which a right model cannot cause.
    #[must_use]
    pub fn decode(&self, path: PathId, terms: &Path, model: &Model) -> Option<Known> {
        match &terms.shape {
            Shape::Explicit(explicit) => explicit.decode(model).map(Known::Explicit),
            Shape::Symbolic(symbolic) => {
                let moves = terms.moves.as_deref()?;
                symbolic.decode(self.encoder.system(path), moves, model).map(Known::Symbolic)
            }
        }
    }
}

/// Rules out the moves of a declared path that no winning run of it has.
fn close_moves(script: &mut Script, game: &Game, path: &ExplicitPath) {
    for time in 0..path.steps.len() {
        for mistake in game.closed(time as u32) {
            script.clause(&mistake.avoided(path, time, None));
        }
    }
}

fn explicit(path: &Path) -> Option<&ExplicitPath> {
    match &path.shape {
        Shape::Explicit(path) => Some(path),
        Shape::Symbolic(_) => None,
    }
}

fn symbolic(path: &Path) -> Option<&SymbolicPath> {
    match &path.shape {
        Shape::Symbolic(path) => Some(path),
        Shape::Explicit(_) => None,
    }
}

fn explicit_graph<'e>(encoder: &'e Encoder<'_>, path: PathId) -> &'e Rc<Graph> {
    encoder.graph(path).expect("onehot encodings enumerate every system")
}
