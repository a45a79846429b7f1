//! States written by variable (`--states bitvec`, `int` and `real`): nothing is excluded ahead, whatever cannot matter
//! is left to the solver.

mod observation;
mod path;
mod real;
mod step;
mod symbols;

use crate::names::{Copies, Names};
use crate::paths::Paths;
use crate::value::{Leaves, Val, is, same};
use crate::writing::{Bound, Env, PathIx, Writer, Writing, all_of};
use hyperplan_problem::{ActionId, Leaf, Mode, Node, Objective, PathId, PathLeaf, State, System, Trace};
use hyperplan_relevance::Error;
use hyperplan_relevance::{Goal, Instance, Known, Move, Numbering, Relevant, Start, Task, cases, generalize};
use hyperplan_smt::{Features, Model, Script, Term, Terms};
use hyperplan_space::{Commands, Graph, LIVE, Letter, MAX_COMMANDS, StateIx, code, holds_in};
use path::{Builder, VariablePath, stuck_state};
use rustc_hash::FxHashMap;
use std::sync::Arc;
use step::{InState, enabled, halted, is_told};
pub(crate) use symbols::Numbers;
use symbols::Symbols;
use typed_index_collections::TiVec;

/// States written by variable.
pub(crate) struct ByVariable<'a> {
    task: Task<'a>,
    numbers: Numbers,
    paths: Paths,
    /// The states of each path's system, where they were enumerated.
    graphs: TiVec<PathId, Option<Arc<Graph>>>,
    rules: TiVec<PathId, Arc<Rules>>,
}

/// What a path of a system has to keep to.
struct Rules {
    commands: Commands,
    /// The live states, sorted, where the system was enumerated and some are not live: a path has to end in one.
    live: Option<Vec<Box<[i64]>>>,
}

impl<'a> ByVariable<'a> {
    /// # Errors
    /// [`Error::TooLarge`] where there are too many commands, [`Error::NotReal`].
    pub(crate) fn new(
        task: Task<'a>,
        graphs: TiVec<PathId, Option<Arc<Graph>>>,
        numbers: Numbers,
    ) -> Result<Self, Error> {
        if numbers == Numbers::Reals {
            real::demand(task.problem, task.objective)?;
        }
        let mut rules: TiVec<PathId, Arc<Rules>> = TiVec::new();
        for (path, graph) in graphs.iter_enumerated() {
            let same = rules.iter_enumerated().find(|(other, _)| task.same_system(*other, path));
            let own = match same {
                Some((_, same)) => same.clone(),
                None => Arc::new(Rules::new(&task, path, graph.as_deref(), numbers)?),
            };
            if !is_told(&own.commands, task.system(path)) && asks_what_is_possible(task.objective, path) {
                let system = &task.system(path).name;
                return Err(Error::TooLarge {
                    what: format!(
                        "choices that `trans` restricts in system {system}, where it matters whether a step is possible"
                    ),
                    limit: MAX_COMMANDS,
                });
            }
            rules.push(own);
        }
        Ok(ByVariable { task, numbers, paths: Paths::Symbols, graphs, rules })
    }

    /// The same with other things standing for what paths do.
    pub(crate) fn with_paths(self, paths: Paths) -> Self {
        ByVariable { paths, ..self }
    }

    /// What a path that the solver chooses is made from, for each choice of bound variables.
    fn symbols(&self, path: PathId, terms: &mut Terms, of: &[Term]) -> Symbols {
        match self.paths {
            Paths::Symbols => Symbols::Declared,
            paths => {
                let names = Names::new(&self.task, path, 0);
                let builder = self.builder(path, &names);
                let time = self.numbers.sort_of_time(&self.features(), self.task.horizon(path));
                let observed = (paths == Paths::Policies).then(|| builder.observed_sorts(terms));
                Symbols::Functions { time, of: of.to_vec(), observed }
            }
        }
    }

    fn builder<'b>(&'b self, path: PathId, names: &'b Names<'b>) -> Builder<'b> {
        let Rules { commands, live } = &*self.rules[path];
        let (numbers, horizon) = (self.numbers, self.task.horizon(path));
        Builder { path, names, commands, numbers, live: live.as_deref(), horizon }
    }
}

/// Whether the objective reads what a path could do, not only what it does.
fn asks_what_is_possible(objective: &Objective, path: PathId) -> bool {
    let mut asks = false;
    for node in &objective.formula.nodes {
        let Node::Atom(expr) = node else { continue };
        expr.for_each_leaf(&mut |leaf| {
            asks |= matches!(leaf, PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) if *p == path);
        });
    }
    asks
}

impl Rules {
    fn new(task: &Task<'_>, path: PathId, graph: Option<&Graph>, numbers: Numbers) -> Result<Rules, Error> {
        let system = task.system(path);
        let commands = Commands::new(system, &|ty| numbers.leaves_open(ty)).map_err(|_| Error::TooLarge {
            what: format!("the ways to take a step (clauses and choices) of system {}", system.name),
            limit: MAX_COMMANDS,
        })?;
        let mortal = graph.filter(|graph| task.objective.mode == Mode::Bounded && !graph.all_live());
        let live = mortal.map(|graph| {
            let states = (0..graph.len() as StateIx).filter(|&s| graph.rank[s as usize] == LIVE);
            let mut live: Vec<Box<[i64]>> = states.map(|state| graph.codes(state).into()).collect();
            live.sort_unstable();
            live
        });
        Ok(Rules { commands, live })
    }

    /// Whether a path can end in a state.
    fn lasts(&self, state: &State) -> bool {
        self.live.as_ref().is_none_or(|live| {
            let codes: Box<[i64]> = state.iter().map(|&value| code(value)).collect();
            live.binary_search(&codes).is_ok()
        })
    }
}

/// Outcomes are numbered by the commands of their action.
struct ByCommand<'a> {
    commands: &'a Commands,
    system: &'a System,
}

impl Numbering for ByCommand<'_> {
    fn outcomes(&self, action: ActionId, most: u32) -> u32 {
        if most > 1 { self.commands.of_action(action).count() as u32 } else { most }
    }

    fn number(&self, graph: &Graph, from: StateIx, letter: Letter, to: StateIx) -> u32 {
        let action = graph.letters[letter as usize].0;
        let [from, to] = [from, to].map(|state| graph.state(self.system, state));
        self.commands.number_of(self.system, &from, action, &to).unwrap_or(0)
    }

    fn shares_steps(&self) -> bool {
        false
    }
}

impl Writer for ByVariable<'_> {
    fn begin<'e>(
        &'e self,
        _: &[Option<Known>],
        _: Relevant,
        copies: &Arc<Copies>,
        _: &mut Terms,
    ) -> Box<dyn Writing + 'e> {
        let (paths, enabled) = (TiVec::new(), FxHashMap::default());
        Box::new(VariableQuery { writer: self, paths, enabled, copies: copies.clone() })
    }

    fn features(&self) -> Features {
        let mut features = Features::default();
        for (path, rules) in self.rules.iter_enumerated() {
            let types = self.task.system(path).vars.iter().map(|var| &var.ty);
            let sorts =
                types.map(|ty| self.numbers.sort(ty)).chain(self.numbers.sort_of_choice(&rules.commands));
            sorts.for_each(|sort| features.add_sort(sort));
        }
        features
    }

    fn known(&self, trace: &Trace) -> Option<Known> {
        let (system, commands) = (self.task.system(trace.path), &self.rules[trace.path].commands);
        let steps = self.task.horizon(trace.path) as usize;
        let (actions, states) = (trace.actions.get(..steps)?, trace.states.get(..=steps)?);
        let step = |at: usize| commands.number_of(system, &states[at], actions[at], &states[at + 1]);
        let numbers: Option<Vec<u32>> = (0..steps).map(step).collect();
        Some(Known { states: states.to_vec(), actions: actions.to_vec(), numbers: numbers? })
    }

    fn cases(&self, path: PathId, goal: &Goal) -> Result<Vec<Instance>, Error> {
        let (system, commands) = (self.task.system(path), &self.rules[path].commands);
        match &self.graphs[path] {
            Some(graph) if commands.inputs.is_empty() => {
                cases(&self.task, graph, path, goal, &ByCommand { commands, system })
            }
            _ => self.task.allow_cases(path, usize::MAX).map(|()| Vec::new()),
        }
    }

    fn generalize(&self, path: PathId, counterexample: &Known, before: &[Option<Known>]) -> Instance {
        let open = !self.rules[path].commands.inputs.is_empty();
        let values = if open { counterexample.states[1..].to_vec() } else { Vec::new() };
        Instance { values, ..generalize(self.task.objective, path, counterexample, before, &|_| false) }
    }

    fn realize(&self, path: PathId, instance: &Instance, known: &[Option<Known>]) -> Option<Known> {
        let (system, rules) = (self.task.system(path), &self.rules[path]);
        let other = |p: PathId| known[usize::from(p)].as_ref();
        let first = match &instance.start {
            Start::State(state) => state.clone(),
            Start::Same(p) => other(*p)?.states[0].clone(),
        };
        if holds_in(system, &system.init, &first) != Some(true) {
            return None;
        }
        let mut path = Known { states: vec![first], actions: Vec::new(), numbers: Vec::new() };
        for (time, &movement) in instance.moves.iter().enumerate() {
            let action = movement.action(|p| other(p)?.actions.get(time).copied())?;
            let preferred = match movement {
                Move::Act(_, number) | Move::SameAction(_, number) => number,
                Move::Same(_) => 0,
            };
            let from = path.states.last()?;
            let values = instance.values.get(time).unwrap_or(from);
            let (number, next) = rules.commands.preferred(system, from, action, preferred, values)?;
            path.states.push(next);
            path.actions.push(action);
            path.numbers.push(number);
        }
        let lasts = rules.lasts(path.states.last()?);
        lasts.then_some(path)
    }

    fn picks_outcomes(&self, path: PathId, known: &Known) -> bool {
        let (system, commands) = (self.task.system(path), &self.rules[path].commands);
        let mut steps = known.states.iter().zip(&known.actions);
        steps.any(|(state, &action)| commands.has_outcomes(system, state, action))
    }

    fn stuck(&self, path: PathId) -> Option<Script> {
        if self.graphs[path].is_some() {
            return None;
        }
        let mut script = Script::new();
        if !is_told(&self.rules[path].commands, self.task.system(path)) {
            // Satisfiable: nothing is known.
            return Some(script);
        }
        let names = Names::new(&self.task, path, 0);
        stuck_state(&mut script, &self.builder(path, &names));
        Some(script)
    }
}

/// Paths of one query whose states are written by variable.
struct VariableQuery<'e, 'a> {
    writer: &'e ByVariable<'a>,
    paths: TiVec<PathIx, VariablePath>,
    /// For each command whether it can be taken, by path and time.
    enabled: FxHashMap<(PathIx, u32), Arc<Vec<Term>>>,
    copies: Arc<Copies>,
}

impl VariableQuery<'_, '_> {
    fn system(&self, path: PathIx) -> &System {
        self.writer.task.system(self.paths[path].path)
    }

    fn commands(&self, path: PathIx) -> &Commands {
        &self.writer.rules[self.paths[path].path].commands
    }

    fn state(&self, path: PathIx, time: u32) -> &[Val] {
        &self.paths[path].states[time as usize]
    }

    /// For each command, whether it can be taken at a time.
    fn enabled_commands(&mut self, terms: &mut Terms, path: PathIx, time: u32) -> Arc<Vec<Term>> {
        if let Some(known) = self.enabled.get(&(path, time)) {
            return known.clone();
        }
        let found = enabled(self.commands(path), terms, self.system(path), self.state(path, time));
        self.enabled.entry((path, time)).or_insert(Arc::new(found)).clone()
    }
}

impl Writing for VariableQuery<'_, '_> {
    fn declare(&mut self, script: &mut Script, path: PathId, _: &Goal) -> Result<PathIx, Error> {
        let names = self.copies.next(&self.writer.task, path);
        let symbols = self.writer.symbols(path, &mut script.terms, &[]);
        Ok(self.paths.push_and_get_key(self.writer.builder(path, &names).declare(script, &symbols)))
    }

    fn bind(&mut self, terms: &mut Terms, path: PathId, _: &Goal) -> Result<Bound, Error> {
        let names = self.copies.next(&self.writer.task, path);
        let (path, variables, guard) = self.writer.builder(path, &names).bind(terms, &Symbols::Bound);
        Ok(Bound { path: self.paths.push_and_get_key(path), variables, guard })
    }

    fn depend(&mut self, terms: &mut Terms, path: PathId, of: &[Term]) -> Option<(PathIx, Term)> {
        if self.writer.paths == Paths::Symbols {
            return None;
        }
        let names = self.copies.next(&self.writer.task, path);
        let symbols = self.writer.symbols(path, terms, of);
        let (path, _, guard) = self.writer.builder(path, &names).bind(terms, &symbols);
        Some((self.paths.push_and_get_key(path), guard))
    }

    fn fix(&mut self, terms: &mut Terms, path: PathId, known: &Known) -> Option<PathIx> {
        Some(self.paths.push_and_get_key(VariablePath::fix(terms, path, known)))
    }

    fn instantiate(
        &mut self,
        script: &mut Script,
        path: PathId,
        instance: &Instance,
        env: &Env,
        _: &Goal,
    ) -> Result<(PathIx, Term), Error> {
        // No symbol is made, so the names do not matter.
        let names = Names::new(&self.writer.task, path, 0);
        let builder = self.writer.builder(path, &names);
        let (path, guard) = builder.instantiate(&mut script.terms, instance, &all_of(&self.paths, env));
        Ok((self.paths.push_and_get_key(path), guard))
    }

    fn symbols(&self, path: PathIx) -> Vec<Term> {
        self.paths[path].symbols(self.commands(path))
    }

    fn decode(&self, path: PathIx, model: &Model) -> Option<Known> {
        self.paths[path].decode(self.system(path), self.commands(path), model)
    }

    fn starts(&self, terms: &mut Terms, path: PathIx, state: &State) -> Vec<Term> {
        let values = self.state(path, 0).iter().zip(state);
        values.map(|(value, &known)| is(terms, value, known)).collect()
    }

    fn took(&self, path: PathIx, step: usize, action: ActionId) -> Term {
        self.paths[path].steps[step].took(action)
    }

    fn same_state(&self, terms: &mut Terms, p: PathIx, q: PathIx, time: u32) -> Term {
        let pairs = self.state(p, time).iter().zip(self.state(q, time));
        let parts: Vec<Term> = pairs.map(|(a, b)| same(terms, a, b)).collect();
        terms.and(&parts)
    }

    fn leaf(&mut self, terms: &mut Terms, path: PathIx, time: u32, leaf: Leaf) -> Val {
        InState::new(self.system(path), self.state(path, time)).leaf(terms, &leaf)
    }

    fn enabled(&mut self, terms: &mut Terms, path: PathIx, time: u32, action: ActionId) -> Term {
        let enabled = self.enabled_commands(terms, path, time);
        let own: Vec<Term> = self.commands(path).of_action(action).map(|at| enabled[at]).collect();
        terms.or(&own)
    }

    fn halted(&mut self, terms: &mut Terms, path: PathIx, time: u32) -> Term {
        let enabled = self.enabled_commands(terms, path, time);
        halted(self.commands(path), terms, self.system(path), self.state(path, time), &enabled)
    }
}
