//! States written one by one (`--states onehot` and `enum`): what can matter of a path is found first, and only that is
//! written.

mod ceiling;
mod choice;
mod instance;
mod path;
mod run;
mod sweep;

use crate::names::{Copies, Names};
use crate::value::{Val, merge};
use crate::writing::{Bound, Env, PathIx, Writer, Writing, all_of};
use ceiling::afford;
use choice::Codings;
use hyperplan_problem::{
    ActionId, Expr, FormulaId, Leaf, PathId, PathLeaf, State, System, SystemId, Trace, Value,
};
use hyperplan_relevance::Error;
use hyperplan_relevance::{
    Arena, Belief, Case, Game, Goal, Instance, Known, Layers, Move, Narrowing, Numbering, Relevance,
    Relevant, Start, believe, case, cases, generalize, in_state, leading, least,
};
use hyperplan_smt::{Model, Script, Term, Terms};
use hyperplan_space::{Graph, Letter, Run, StateIx, eval};
use instance::{Building, Instances};
use path::{Builder, EnumeratedPath};
use run::is_truth;
use rustc_hash::FxHashMap;
use std::sync::Arc;
use sweep::{Sweep, sweep};
use typed_index_collections::TiVec;

/// States written one by one.
pub(crate) struct Enumerated<'a> {
    arena: Arena<'a>,
    /// Whether as values of a datatype; else a Boolean each.
    datatypes: bool,
}

impl<'a> Enumerated<'a> {
    pub(crate) fn new(arena: Arena<'a>, datatypes: bool) -> Self {
        Enumerated { arena, datatypes }
    }

    /// How the states and letters of each system are written.
    fn codings(&self, terms: &mut Terms) -> TiVec<SystemId, Codings> {
        let task = &self.arena.task;
        let coding = |(id, system): (SystemId, &'a System)| {
            let path = task.objective.paths.iter_enumerated().find(|(_, path)| path.system == id);
            match path {
                Some((path, _)) if self.datatypes => {
                    let names = Names { problem: task.problem, system, path: system.name.clone() };
                    Codings::enumerations(terms, &names, &self.arena.graphs[path])
                }
                _ => Codings::ONEHOT,
            }
        };
        task.problem.systems.iter_enumerated().map(coding).collect()
    }

    /// A known path through its graph; `None` where it is none.
    fn run(&self, path: PathId, known: &Known) -> Option<Run> {
        Run::of(&self.arena.graphs[path], &known.states, &known.actions)
    }

    fn known_run(&self, path: PathId, run: &Run) -> Known {
        let Trace { states, actions, .. } = run.trace(path, self.arena.task.system(path));
        let number = |&letter: &Letter| run.graph.letters[letter as usize].1;
        Known { states, actions, numbers: run.letters.iter().map(number).collect() }
    }
}

/// The outcome of an action with this number, where there are so many.
fn exactly(graph: &Graph, state: StateIx, action: ActionId, number: u32) -> Option<(Letter, StateIx)> {
    graph.outcome(state, action, number).filter(|(letter, _)| graph.letters[*letter as usize].1 == number)
}

/// Outcomes are numbered as in the graph.
struct AsInGraph;

impl Numbering for AsInGraph {
    fn outcomes(&self, _: ActionId, most: u32) -> u32 {
        most
    }

    fn number(&self, graph: &Graph, _: StateIx, letter: Letter, _: StateIx) -> u32 {
        graph.letters[letter as usize].1
    }

    fn shares_steps(&self) -> bool {
        true
    }
}

impl Writer for Enumerated<'_> {
    fn relevant(&self, block: &[PathId], goal: &Goal, narrowing: Narrowing) -> Result<Relevant, Error> {
        leading(&self.arena, block, goal, narrowing)
    }

    fn least(&self, goal: &Goal) -> Result<Option<i64>, Error> {
        least(&self.arena, goal).map(Some)
    }

    fn case(&self, block: &[PathId], goal: &Goal, number: (usize, usize)) -> Result<Case, Error> {
        case(&self.arena, block, goal, number)
    }

    fn believe(&self, block: &[PathId], goal: &Goal, budget: usize) -> Result<Belief<Vec<Known>>, Error> {
        if !self.arena.ceilings.is_empty() {
            return Ok(Belief::Unfit);
        }
        let known =
            |runs: Vec<Run>| block.iter().zip(&runs).map(|(&path, run)| self.known_run(path, run)).collect();
        Ok(believe(&self.arena, block.len(), goal, budget)?.map(known))
    }

    fn begin<'e>(
        &'e self,
        known: &[Option<Known>],
        found: Relevant,
        copies: &Arc<Copies>,
        terms: &mut Terms,
    ) -> Box<dyn Writing + 'e> {
        let run = |path: PathId| self.run(path, known.get(usize::from(path))?.as_ref()?);
        let fixed = self.arena.graphs.keys().map(run).collect();
        Box::new(EnumeratedQuery {
            writer: self,
            relevance: Relevance::new(&self.arena, fixed, found),
            codings: self.codings(terms),
            instances: Instances::default(),
            truth: FxHashMap::default(),
            paths: TiVec::new(),
            copies: copies.clone(),
        })
    }

    fn known(&self, trace: &Trace) -> Option<Known> {
        let steps = self.arena.task.horizon(trace.path) as usize;
        let (states, actions) = (trace.states.get(..=steps)?, trace.actions.get(..steps)?);
        let run = Run::of(&self.arena.graphs[trace.path], states, actions)?;
        Some(self.known_run(trace.path, &run))
    }

    fn cases(&self, path: PathId, goal: &Goal) -> Result<Vec<Instance>, Error> {
        cases(&self.arena.task, &self.arena.graphs[path], path, goal, &AsInGraph)
    }

    fn generalize(&self, path: PathId, counterexample: &Known, before: &[Option<Known>]) -> Instance {
        let graphs = &self.arena.graphs;
        let shares = |other: PathId| Arc::ptr_eq(&graphs[other], &graphs[path]);
        generalize(self.arena.task.objective, path, counterexample, before, &shares)
    }

    fn realize(&self, path: PathId, instance: &Instance, known: &[Option<Known>]) -> Option<Known> {
        let (task, graph) = (&self.arena.task, &self.arena.graphs[path]);
        let other = |p: PathId| known[usize::from(p)].as_ref();
        let start = match &instance.start {
            Start::State(state) => state,
            Start::Same(p) => &other(*p)?.states[0],
        };
        let start = graph.initial_state(start)?;
        let (mut at, mut letters) = (start, Vec::with_capacity(instance.moves.len()));
        for (time, &movement) in instance.moves.iter().enumerate() {
            let action = movement.action(|p| other(p)?.actions.get(time).copied())?;
            let (letter, next) = match movement {
                Move::Same(p) => exactly(graph, at, action, *other(p)?.numbers.get(time)?)?,
                Move::SameAction(_, number) | Move::Act(_, number) => graph.outcome(at, action, number)?,
            };
            letters.push(letter);
            at = next;
        }
        let whole = letters.len() == task.horizon(path) as usize;
        if !whole || !task.lasts(graph, at, letters.len() as u32) {
            return None;
        }
        Some(self.known_run(path, &Run::replay(graph, start, letters)?))
    }

    fn picks_outcomes(&self, path: PathId, known: &Known) -> bool {
        self.run(path, known).is_some_and(|run| {
            let mut steps = run.states.iter().zip(&run.actions);
            steps.any(|(&state, &action)| run.graph.of_action(state, action).count() > 1)
        })
    }
}

/// Paths of one query whose states are written one by one.
pub(crate) struct EnumeratedQuery<'e, 'a> {
    writer: &'e Enumerated<'a>,
    relevance: Relevance<'e, 'a>,
    codings: TiVec<SystemId, Codings>,
    instances: Instances,
    /// Whether each state satisfies an atom that reads one path's state, by atom.
    truth: FxHashMap<FormulaId, Vec<Option<bool>>>,
    paths: TiVec<PathIx, EnumeratedPath>,
    copies: Arc<Copies>,
}

impl<'e, 'a> EnumeratedQuery<'e, 'a> {
    fn builder<'b>(&'b self, path: PathId, names: &'b Names<'a>, layers: &'b Layers) -> Builder<'b, 'a> {
        let arena = &self.writer.arena;
        let codings = &self.codings[arena.task.objective.paths[path].system];
        Builder { task: &arena.task, path, names, graph: &arena.graphs[path], layers, codings }
    }

    fn names(&self, path: PathId) -> Names<'a> {
        self.copies.next(&self.writer.arena.task, path)
    }

    fn system(&self, path: &EnumeratedPath) -> &'a System {
        self.writer.arena.task.system(path.path)
    }

    /// The game with these paths.
    fn game(&self, is: impl Fn(&Game) -> bool) -> Option<Arc<Game>> {
        self.relevance.found().game().filter(|game| is(game)).cloned()
    }

    /// An expression over the path's state, by the value that it has in each state; of an atom these are kept.
    fn by_state(
        &mut self,
        terms: &mut Terms,
        path: PathIx,
        time: u32,
        expr: &Expr<PathLeaf>,
        atom: Option<FormulaId>,
    ) -> Val {
        let path = &self.paths[path];
        let (system, layer) = (self.system(path), &path.layers[time as usize]);
        // What reads more than the state is not asked for.
        let leaf = |leaf: &PathLeaf, state| in_state(system, &path.graph, leaf, state).unwrap_or(0);
        let value = |state| eval(expr, &mut |read| leaf(read, state));
        if let Some(atom) = atom {
            let truth = self.truth.entry(atom).or_insert_with(|| vec![None; path.graph.len()]);
            let mut holds = |state: StateIx| *truth[state as usize].get_or_insert_with(|| value(state) != 0);
            return Val::Bool(layer.any(terms, &mut holds));
        }
        if is_truth_value(system, expr) {
            return Val::Bool(layer.any(terms, |state| value(state) != 0));
        }
        let cases = layer.states.iter().zip(&layer.terms).map(|(&state, &here)| (value(state), here));
        merge(terms, cases)
    }
}

impl Writing for EnumeratedQuery<'_, '_> {
    fn declare(&mut self, script: &mut Script, path: PathId, goal: &Goal) -> Result<PathIx, Error> {
        let names = self.names(path);
        let layers = self.relevance.declare(path, goal)?;
        let declared = self.builder(path, &names, &layers).declare(script)?;
        if let Some(game) = self.game(|game| game.paths[0] == path) {
            // What no winning run of the path does.
            for time in 0..declared.steps.len() {
                for losing in game.closed(time as u32) {
                    script.clause(&declared.avoids(&losing, time, None));
                }
            }
        }
        Ok(self.paths.push_and_get_key(declared))
    }

    fn afford(&mut self, script: &mut Script, env: &Env) -> Result<(), Error> {
        let arena = &self.writer.arena;
        for (number, ceiling) in arena.ceilings.iter().enumerate() {
            let mut paths: Vec<(&EnumeratedPath, &[i64])> = Vec::new();
            for (path, weights) in &ceiling.weights {
                if let Some(declared) = env[usize::from(*path)] {
                    paths.push((&self.paths[declared], weights));
                }
            }
            script.section(format!("cost.{}", number + 1), "what the paths may cost");
            afford(script, &arena.task, &paths, ceiling.most)?;
        }
        Ok(())
    }

    fn bind(&mut self, terms: &mut Terms, path: PathId, goal: &Goal) -> Result<Bound, Error> {
        let names = self.names(path);
        let layers = self.relevance.layers(path, goal)?;
        let (path, variables, guard) = self.builder(path, &names, &layers).bind(terms)?;
        Ok(Bound { path: self.paths.push_and_get_key(path), variables, guard })
    }

    fn fix(&mut self, _: &mut Terms, path: PathId, known: &Known) -> Option<PathIx> {
        let run = self.writer.run(path, known)?;
        Some(self.paths.push_and_get_key(EnumeratedPath::fix(path, &run)))
    }

    fn instantiate(
        &mut self,
        script: &mut Script,
        path: PathId,
        instance: &Instance,
        env: &Env,
        goal: &Goal,
    ) -> Result<(PathIx, Term), Error> {
        let layers = self.relevance.layers(path, goal)?;
        let graph = &self.writer.arena.graphs[path];
        let names = self.names(path);
        let others = all_of(&self.paths, env);
        let mut building = Building { script, path, names: &names, graph, layers: &layers, env: &others };
        let (path, guard) = self.instances.build(&mut building, instance);
        Ok((self.paths.push_and_get_key(path), guard))
    }

    fn restrict(
        &mut self,
        script: &mut Script,
        path: PathIx,
        goal: &Goal,
        beside: &[(PathId, Known)],
    ) -> Result<(), Error> {
        let path = &self.paths[path];
        if !self.writer.arena.task.limits.prunes() {
            return Ok(());
        }
        let runs = beside.iter().filter_map(|(other, known)| Some((*other, self.writer.run(*other, known)?)));
        let layers = self.relevance.beside(path.path, goal, runs)?;
        for (time, layer) in path.layers.iter().enumerate() {
            for (&state, &term) in layer.states.iter().zip(&layer.terms) {
                if !layers.contains(time, state) {
                    script.assert(!term);
                }
            }
        }
        Ok(())
    }

    fn sweep(&mut self, script: &mut Script, path: PathId, env: &Env, goal: &Goal) -> Result<bool, Error> {
        let names = self.names(path);
        let game = self.game(|game| game.paths[1] == path && game.goal == *goal);
        let leading = game.as_ref().and_then(|game| env[usize::from(game.paths[0])]);
        let leading = leading.map(|leading| self.paths[leading].clone());
        let game = game.as_deref().zip(leading.as_ref());
        let layers = match game {
            Some((game, _)) => Arc::new(game.other_layers()),
            None => self.relevance.layers(path, goal)?,
        };
        let arena = &self.writer.arena;
        let (task, graph) = (&arena.task, &*arena.graphs[path]);
        let question = Sweep { task, graph, names: &names, path, layers: &layers, goal, env, game };
        Ok(sweep(&question, self, script).is_some())
    }

    fn symbols(&self, path: PathIx) -> Vec<Term> {
        self.paths[path].symbols()
    }

    fn decode(&self, path: PathIx, model: &Model) -> Option<Known> {
        let path = &self.paths[path];
        Some(self.writer.known_run(path.path, &path.decode(model)?))
    }

    fn starts(&self, _: &mut Terms, path: PathIx, state: &State) -> Vec<Term> {
        let path = &self.paths[path];
        vec![path.graph.initial_state(state).map_or(Term::FALSE, |state| path.layers[0].is(state))]
    }

    fn took(&self, path: PathIx, step: usize, action: ActionId) -> Term {
        self.paths[path].steps[step].took(action)
    }

    fn same_state(&self, terms: &mut Terms, p: PathIx, q: PathIx, time: u32) -> Term {
        let [p, q] = [p, q].map(|path| &self.paths[path].layers[time as usize]);
        if let ([state], [Term::TRUE]) = (&p.states[..], &p.terms[..]) {
            return q.is(*state);
        }
        let parts: Vec<Term> =
            p.states.iter().zip(&p.terms).map(|(&s, &here)| terms.implies(here, q.is(s))).collect();
        terms.and(&parts)
    }

    fn leaf(&mut self, terms: &mut Terms, path: PathIx, time: u32, leaf: Leaf) -> Val {
        let leaf = PathLeaf::State(self.paths[path].path, leaf);
        self.by_state(terms, path, time, &Expr::Leaf(leaf), None)
    }

    fn enabled(&mut self, terms: &mut Terms, path: PathIx, time: u32, action: ActionId) -> Term {
        let path = &self.paths[path];
        path.layers[time as usize].any(terms, |state| path.graph.enables(state, action))
    }

    fn halted(&mut self, terms: &mut Terms, path: PathIx, time: u32) -> Term {
        let path = &self.paths[path];
        path.layers[time as usize].any(terms, |state| path.graph.halts(state))
    }

    fn whole(
        &mut self,
        terms: &mut Terms,
        path: PathIx,
        time: u32,
        expr: &Expr<PathLeaf>,
        atom: Option<FormulaId>,
    ) -> Option<Val> {
        Some(self.by_state(terms, path, time, expr, atom))
    }
}

/// Whether an expression over one path's state is a truth value rather than a number.
fn is_truth_value(system: &System, expr: &Expr<PathLeaf>) -> bool {
    match expr {
        Expr::Const(Value::Bool(_))
        | Expr::Not(_)
        | Expr::And(_)
        | Expr::Or(_)
        | Expr::Iff(..)
        | Expr::Compare(..)
        | Expr::Member(..) => true,
        Expr::Const(_)
        | Expr::Add(_)
        | Expr::Mul(..)
        | Expr::Scale(..)
        | Expr::ToReal(_)
        | Expr::Div(..)
        | Expr::Mod(..) => false,
        Expr::If(_, last) => is_truth_value(system, last),
        Expr::Leaf(PathLeaf::State(_, leaf)) => is_truth(system, *leaf),
        Expr::Leaf(_) => true,
    }
}
