//! From an objective and instances of the other player's paths to a plain CNF.
//!
//! # What is claimed
//!
//! The *player* has the paths of all blocks with the quantifier of the leading one, and wants the formula to be true where that
//! is `exists`, false where it is `forall`. The claim is that the player cannot have that: no strategy, or no
//! counterexample, exists. **If the CNF is unsatisfiable, the claim is true**, whatever the instances are. How this file shows
//! it: suppose that the player can; then the assignment described here satisfies every clause.
//!
//! # The assignment
//!
//! The player has a *choice* of paths for the leading block with which the formula comes out as wanted for every choice of
//! the other player. An instance of the other player's next block gives, as a function of these paths, either paths of the other
//! player, or none (it would have to make a step that is impossible). Where it gives paths, the player has an answer in the next
//! block, and so on. So each *copy* of a path in the tree of instances stands for one particular path, unless an instance
//! above it, or it itself, is none. Variables say what is true of these paths:
//!
//! - `x` of copy, time and state: the path of the copy is in that state then. If an instance stops being a path, its `x` are
//!   false from there on; so are all of copies below it.
//! - `a` of copy, time and action: the path takes that action.
//! - `d` of an instance: it is no path. Copies below it carry `d` in each clause (their *guard*): where it is true, they say
//!   nothing.
//! - order variables, for a number that depends on one state: it is at least so much; for Booleans: it is true.
//! - atoms that read several paths or actions; parts of the formula, of which only "if the variable is true, so is the part"
//!   is said, so that a variable may be false.
//!
//! Every clause is true under this assignment; beside each the reason is given, if it is not that of a definition. The last one
//! says that the formula, read on the copies of one branch, comes out as the player wants, unless an instance is none.
//!
//! # Tails
//!
//! Where the other player's last block is one path, no path follows from its instances, and their own steps have no `x`. From a
//! state at a time, by the steps that are left, exactly one path goes on, given the paths before it; if a step is impossible, let
//! it stay where it is, so that there is one always. That is a *tail*. A part of the formula at that time is true of it or not, and
//! this is what the variable of the part and the tail says. Instances that come to the same state at the same time with the same
//! steps left share it, and all that comes after. What is true of a tail at the next time is true of that which its step leads
//! to, which depends on an action of another path alone (and, in the first of the own steps, on where the copy along which it
//! went is): `later` says so, action by action. An instance is none if a tail makes a step that is impossible: `ends`.
//!
//! # What is left out
//!
//! Only states that are reached from the start at that time have variables: a path is in one of them. No other pruning is done. A
//! path of the leading block starts where the conjuncts of the formula that read only its first state allow: they have to hold, as
//! the other player has at least one path (else nothing is left out). In bounded mode paths go on for ever, and so are in *live*
//! states only; under `within K` a path has K steps.
//!
//! This file has the paths, `tail` the tails, `formula` the formula, and `atoms` what it reads. `answer` is not part of the argument.

mod answer;
mod atoms;
mod formula;
mod tail;

use crate::error::Error;
use crate::instance::{Action, Branch, Instance, Start, Step, targets};
use crate::layer::{Acts, FALSE, Layer, Lit, Next, Order, TRUE};
use crate::reading::{alone, last_reads, reads};
use crate::system::Graph;
use hyperplan_problem::{
    Expr, FormulaId, Mode, Node, Objective, PathId, PathLeaf, Problem, Quantifier, SystemId, Value,
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// So many numbers are written.
const SIZE: usize = 1 << 29;

/// A path in the tree of instances.
struct Copy {
    /// What is true where it is no path.
    guard: Vec<Lit>,
    layers: Vec<Rc<Layer>>,
    acts: Vec<Rc<Acts>>,
}

/// The first layers of a path, and the actions between them.
type Beginning = (Vec<Rc<Layer>>, Vec<Rc<Acts>>);

/// The copies of the paths of one branch, and what is true where it says nothing.
#[derive(Clone, Default)]
struct Scope {
    copies: Vec<Option<usize>>,
    /// The path that is an instance of the last block.
    tail: Option<Tail>,
    guard: Vec<Lit>,
}

/// What is known of a path with a tail at a time.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Tail {
    path: PathId,
    at: At,
    /// What it has just done.
    took: Option<Action>,
    /// What it does next, by its number in the list of steps.
    steps: usize,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum At {
    /// Where its copy is, which goes along another path until this time.
    Along(usize),
    State(u32),
    /// That does not matter.
    Anywhere,
}

/// The paths of a branch at a time.
#[derive(Clone)]
struct View {
    scope: Rc<Scope>,
    tail: Option<Tail>,
}

/// What a part of the formula is about: copies, and a tail.
type About = (Vec<Option<usize>>, Option<Tail>);

/// A place in the tree: behind the player's answer to a branch, given by its position from 1 on, or (0) behind the leading block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place(pub usize);

/// A part of the formula that is to be true (or false, where it is not `positive`) at a time; of an until or release with what
/// is left of its interval.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Goal {
    node: FormulaId,
    time: u32,
    rest: (u32, u32),
    positive: bool,
}

/// What an order belongs to: an expression, by its address in the objective, or a variable.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Read {
    Expr(usize),
    Leaf(PathLeaf),
}

/// The encoder: clauses are taken from it as they are made.
pub struct Encoder<'p> {
    problem: &'p Problem,
    objective: &'p Objective,
    blocks: Vec<Vec<PathId>>,
    /// The last time at which each path is read.
    horizons: Vec<u32>,
    graphs: Vec<Option<Rc<Graph<'p>>>>,
    copies: Vec<Copy>,
    /// Each with the number of blocks before it.
    places: Vec<(Scope, usize)>,
    variables: Lit,
    layers: u32,
    written: usize,
    clauses: Vec<i32>,
    goals: FxHashMap<(Goal, About), Lit>,
    open: Vec<(Lit, Goal, View)>,
    /// What tails do: a step, and the number of the next, from 1 on.
    steps: Vec<(Step, usize)>,
    numbers: FxHashMap<(Step, usize), usize>,
    /// Where tails are none.
    nones: FxHashMap<(Tail, Vec<Option<usize>>), Lit>,
    /// Layers of which the state is known.
    points: FxHashMap<(SystemId, u32), Rc<Layer>>,
    orders: FxHashMap<(Read, u32), Rc<Order>>,
    /// Layers of which it is said that a path is in one state only.
    single: FxHashSet<u32>,
    atoms: FxHashMap<(usize, u32, About), Lit>,
    /// The paths that each part of the formula reads, and those of which it reads states.
    reads: Vec<Vec<PathId>>,
    reads_states: Vec<Vec<PathId>>,
}

impl<'p> Encoder<'p> {
    /// The player's leading block, before any instance.
    ///
    /// # Errors
    /// Where systems are infinite or too large.
    pub fn new(
        problem: &'p Problem,
        objective: &'p Objective,
        stop: &dyn Fn() -> bool,
    ) -> Result<Self, Error> {
        let mut graphs: Vec<Option<Rc<Graph<'p>>>> = vec![None; problem.systems.len()];
        for path in &objective.paths {
            let known = &mut graphs[usize::from(path.system)];
            if known.is_none() {
                *known = Some(Rc::new(Graph::new(&problem.systems[path.system], stop)?));
            }
        }
        let mut encoder = Encoder {
            problem,
            objective,
            blocks: objective.blocks(),
            horizons: last_reads(objective)?,
            graphs,
            copies: Vec::new(),
            places: Vec::new(),
            variables: 0,
            layers: 0,
            written: 0,
            clauses: Vec::new(),
            goals: FxHashMap::default(),
            open: Vec::new(),
            steps: Vec::new(),
            numbers: FxHashMap::default(),
            nones: FxHashMap::default(),
            points: FxHashMap::default(),
            orders: FxHashMap::default(),
            single: FxHashSet::default(),
            atoms: FxHashMap::default(),
            reads: reads(objective, false),
            reads_states: reads(objective, true),
        };
        let copies = vec![None; objective.paths.len()];
        encoder.enter(Scope { copies, tail: None, guard: Vec::new() }, 0)?;
        Ok(encoder)
    }

    /// The place behind the leading block.
    #[must_use]
    pub fn root(&self) -> Place {
        Place(0)
    }

    /// Adds instances of the other player's next block, the player's block after it, and, behind the last block, the formula.
    ///
    /// # Errors
    /// Where they are no instances of these paths, or too much would be written.
    pub fn branch(&mut self, place: Place, instances: &[Instance]) -> Result<Place, Error> {
        let (mut scope, block) = self.places[place.0].clone();
        let paths = self.blocks.get(block).cloned().unwrap_or_default();
        if paths.is_empty() || !instances.iter().map(|own| own.path).eq(paths) {
            return Err(Error::Unreadable("a branch has other paths than its block".to_owned()));
        }
        let is_last = block + 2 >= self.blocks.len() && instances.len() == 1;
        for instance in instances {
            let (copy, mut none) = match is_last {
                true => (self.tail(instance, &mut scope)?, None),
                false => self.follow(instance, &scope)?,
            };
            scope.copies[usize::from(instance.path)] = Some(copy);
            if let Some(tail) = scope.tail {
                none = self.ends(&scope, tail)?;
            }
            scope.guard.extend(none);
        }
        self.enter(scope, block + 1)
    }

    /// Adds a whole tree of instances.
    ///
    /// # Errors
    /// As [`Encoder::branch`], and where one is behind none before it.
    pub fn tree(&mut self, branches: &[Branch]) -> Result<(), Error> {
        for (number, branch) in branches.iter().enumerate() {
            if branch.after > number {
                return Err(Error::Unreadable("a branch is behind none before it".to_owned()));
            }
            self.branch(Place(branch.after), &branch.instances)?;
        }
        Ok(())
    }

    /// The clauses since the last time, a 0 behind each.
    pub fn take(&mut self) -> Vec<i32> {
        std::mem::take(&mut self.clauses)
    }

    /// How many variables there are.
    #[must_use]
    pub fn variables(&self) -> i32 {
        self.variables
    }

    /// The player's paths of a block, after `before` others, and the formula if nothing is left to choose.
    fn enter(&mut self, mut scope: Scope, block: usize) -> Result<Place, Error> {
        for path in self.blocks.get(block).cloned().unwrap_or_default() {
            let copy = self.declare(path, &scope.guard, block == 0)?;
            scope.copies[usize::from(path)] = Some(copy);
        }
        let next = block + 1;
        if next >= self.blocks.len() {
            self.demand(&scope)?;
        }
        self.places.push((scope, next));
        Ok(Place(self.places.len() - 1))
    }

    fn graph(&self, path: PathId) -> Rc<Graph<'p>> {
        let system = self.objective.paths[path].system;
        Rc::clone(self.graphs[usize::from(system)].as_ref().expect("graphs of all paths are made first"))
    }

    fn lasting(&self) -> bool {
        self.objective.mode == Mode::Bounded
    }

    fn fresh(&mut self) -> Lit {
        self.variables += 1;
        self.variables
    }

    /// Writes a clause of these literals and those of the guard.
    fn add(&mut self, guard: &[Lit], literals: impl IntoIterator<Item = Lit>) -> Result<(), Error> {
        let start = self.clauses.len();
        for literal in literals.into_iter().chain(guard.iter().copied()) {
            if literal == TRUE {
                self.clauses.truncate(start);
                return Ok(());
            }
            if literal != FALSE {
                self.clauses.push(literal);
            }
        }
        let own = &mut self.clauses[start..];
        own.sort_unstable_by_key(|literal| (literal.abs(), *literal));
        let is_tautology = own.windows(2).any(|pair| pair[0] == -pair[1]);
        if is_tautology {
            self.clauses.truncate(start);
            return Ok(());
        }
        let mut end = start;
        for at in start..self.clauses.len() {
            if end == start || self.clauses[end - 1] != self.clauses[at] {
                self.clauses[end] = self.clauses[at];
                end += 1;
            }
        }
        self.clauses.truncate(end);
        self.clauses.push(0);
        self.written += end + 1 - start;
        match self.written > SIZE {
            true => Err(Error::TooLarge { what: "the clauses are too many".to_owned() }),
            false => Ok(()),
        }
    }

    fn layer(&mut self, cells: Vec<(u32, Lit)>) -> Rc<Layer> {
        self.layers += 1;
        Rc::new(Layer { id: self.layers, cells })
    }

    /// A path that the player chooses.
    fn declare(&mut self, path: PathId, guard: &[Lit], leading: bool) -> Result<usize, Error> {
        let graph = self.graph(path);
        let lasting = self.lasting();
        let starts = self.starts(path, leading && self.others_have_paths())?;
        let cells: Vec<(u32, Lit)> = starts.into_iter().map(|state| (state, self.fresh())).collect();
        // It starts somewhere.
        self.add(guard, cells.iter().map(|cell| cell.1))?;
        let mut layers = vec![self.layer(cells)];
        let mut acts = Vec::new();
        let mut actions = graph.system.actions.clone();
        actions.sort_unstable();
        for time in 0..self.horizons[usize::from(path)] as usize {
            let layer = Rc::clone(&layers[time]);
            self.at_most_one(&graph, &layer, guard)?;
            let own: Acts = actions.iter().map(|&action| (action, self.fresh())).collect();
            // It takes one action.
            self.add(guard, own.iter().map(|act| act.1))?;
            for (i, (_, a)) in own.iter().enumerate() {
                for (_, b) in &own[..i] {
                    self.add(guard, [-a, -b])?;
                }
            }
            let mut next = Next::default();
            for &(state, x) in &layer.cells {
                let mut all = vec![-x];
                for &(action, a) in &own {
                    let mut there = vec![-x, -a];
                    for to in targets(&graph, state, action, lasting) {
                        there.push(next.reach(to, x, &mut self.variables));
                    }
                    all.extend(&there[2..]);
                    // In this state, by this action, it gets to one of these.
                    self.add(guard, there)?;
                }
                // It goes on to one of the next states.
                self.add(guard, all)?;
            }
            layers.push(self.came_from(next, guard)?);
            acts.push(Rc::new(own));
        }
        if let Some(last) = layers.last().cloned() {
            self.at_most_one(&graph, &last, guard)?;
        }
        self.copies.push(Copy { guard: guard.to_vec(), layers, acts });
        Ok(self.copies.len() - 1)
    }

    /// A path that an instance gives, and the variable that it is none, if that can be.
    fn follow(&mut self, own: &Instance, scope: &Scope) -> Result<(usize, Option<Lit>), Error> {
        let (path, guard) = (own.path, scope.guard.as_slice());
        let graph = self.graph(path);
        let lasting = self.lasting();
        let horizon = self.horizons[usize::from(path)] as usize;
        let (mut layers, mut acts) = self.beginning(own, scope)?;
        if acts.len() + own.steps.len() != horizon {
            return Err(self.wrong(own, "it has not as many steps as are read of it"));
        }
        // In such a state, taking such an action, it is no path.
        let mut ends: Vec<(Lit, Lit)> = Vec::new();
        for step in &own.steps {
            let time = acts.len();
            let layer = Rc::clone(&layers[time]);
            self.at_most_one(&graph, &layer, guard)?;
            let taken: Acts = match step.action {
                Action::Is(action) => vec![(action, TRUE)],
                Action::Like(other) => {
                    let other = scope.copies.get(usize::from(other)).copied().flatten();
                    let other = other.and_then(|copy| self.copies[copy].acts.get(time));
                    other.ok_or_else(|| self.wrong(own, "it takes an action of no step before it"))?.to_vec()
                }
            };
            let mut next = Next::default();
            for &(state, x) in &layer.cells {
                let mut all = vec![-x];
                let before = ends.len();
                for &(action, a) in &taken {
                    match targets(&graph, state, action, lasting).nth(step.outcome as usize) {
                        Some(to) => {
                            let there = next.reach(to, x, &mut self.variables);
                            all.push(there);
                            // In this state, by this action, it gets there.
                            self.add(guard, [-x, -a, there])?;
                        }
                        None => ends.push((x, a)),
                    }
                }
                if ends.len() == before {
                    // It goes on to one of the next states.
                    self.add(guard, all)?;
                }
            }
            layers.push(self.came_from(next, guard)?);
            acts.push(Rc::new(taken));
        }
        if let Some(last) = layers.last().cloned() {
            self.at_most_one(&graph, &last, guard)?;
        }
        let mut inner = guard.to_vec();
        let none = if ends.is_empty() { None } else { Some(self.fresh()) };
        inner.extend(none);
        if let Some(none) = none {
            let mut some = vec![-none];
            for (x, a) in ends {
                let end = if a == TRUE { x } else { self.fresh() };
                self.add(guard, [-end, x])?;
                self.add(guard, [-end, a])?;
                some.push(end);
            }
            // It is none only where it ends.
            self.add(guard, some)?;
        }
        self.copies.push(Copy { guard: inner, layers, acts });
        Ok((self.copies.len() - 1, none))
    }

    fn wrong(&self, own: &Instance, what: &str) -> Error {
        Error::Instance { path: self.objective.paths[own.path].name.clone(), what: what.to_owned() }
    }

    /// How an instance begins.
    fn beginning(&mut self, own: &Instance, scope: &Scope) -> Result<Beginning, Error> {
        let graph = self.graph(own.path);
        match &own.start {
            Start::State(values) => {
                let state = graph.find(values).filter(|state| graph.initial.contains(state));
                let state = state.filter(|state| !self.lasting() || graph.is_live(*state));
                let state = state.ok_or_else(|| self.wrong(own, "no path starts there"))?;
                let x = self.fresh();
                self.add(&scope.guard, [x])?;
                Ok((vec![self.layer(vec![(state, x)])], Vec::new()))
            }
            Start::Along(other, steps) => {
                let system = |path: PathId| self.objective.paths[path].system;
                let copy = scope.copies.get(usize::from(*other)).copied().flatten();
                let copy = copy.filter(|_| system(*other) == system(own.path)).map(|copy| &self.copies[copy]);
                let copy =
                    copy.ok_or_else(|| self.wrong(own, "it goes along no path of its system before it"))?;
                let steps = *steps as usize;
                let begun = copy.layers.get(..=steps).zip(copy.acts.get(..steps));
                let (layers, acts) = begun.ok_or_else(|| self.wrong(own, "it goes along for too long"))?;
                Ok((layers.to_vec(), acts.to_vec()))
            }
        }
    }

    /// A path came to each state from one of those that lead there; of which the layer consists.
    fn came_from(&mut self, next: Next, guard: &[Lit]) -> Result<Rc<Layer>, Error> {
        let mut cells = Vec::with_capacity(next.reached.len());
        for (state, x, mut from) in next.reached {
            from.push(-x);
            self.add(guard, from)?;
            cells.push((state, x));
        }
        cells.sort_unstable();
        Ok(self.layer(cells))
    }

    /// A path is in no two states. It is said only where it matters: where a path may be one or not, the step that is impossible
    /// should not be made by a state in which it is not.
    fn at_most_one(&mut self, graph: &Graph<'_>, layer: &Layer, guard: &[Lit]) -> Result<(), Error> {
        if !graph.is_partial || layer.cells.len() < 2 || !self.single.insert(layer.id) {
            return Ok(());
        }
        let mut above = TRUE;
        for &(_, x) in &layer.cells {
            // Its position in the layer is at least that of the next state, or not.
            let next = self.fresh();
            self.add(guard, [-x, above])?;
            self.add(guard, [-x, -next])?;
            self.add(guard, [-next, above])?;
            above = next;
        }
        Ok(())
    }

    /// Whether each path of the other player has a path to be.
    fn others_have_paths(&self) -> bool {
        let others = self.blocks.iter().skip(1).step_by(2).flatten();
        others.into_iter().all(|&path| {
            let graph = self.graph(path);
            let Mode::Within(steps) = self.objective.mode else {
                return graph.initial.iter().any(|state| graph.is_live(*state));
            };
            let mut reached = graph.initial.clone();
            for _ in 0..steps {
                let next: Vec<u32> = reached.iter().flat_map(|s| graph.moves(*s)).map(|m| m.1).collect();
                reached = next;
                reached.sort_unstable();
                reached.dedup();
            }
            !reached.is_empty()
        })
    }

    /// Where a path can start; of the leading block, by the conjuncts of the formula about its first state too.
    fn starts(&self, path: PathId, leading: bool) -> Result<Vec<u32>, Error> {
        let graph = self.graph(path);
        let mut starts = graph.initial.clone();
        starts.retain(|state| !self.lasting() || graph.is_live(*state));
        let mut parts: Vec<(&Expr<PathLeaf>, bool)> = Vec::new();
        let mut nodes = vec![(self.objective.formula.root(), self.wants())];
        while let Some((node, positive)) = nodes.pop().filter(|_| leading) {
            match &self.objective.formula.nodes[node] {
                Node::Not(a) => nodes.push((*a, !positive)),
                Node::And(all) if positive => nodes.extend(all.iter().map(|&a| (a, true))),
                Node::Or(all) if !positive => nodes.extend(all.iter().map(|&a| (a, false))),
                Node::Atom(expr) => parts.push((expr, positive)),
                _ => {}
            }
        }
        while let Some((expr, positive)) = parts.pop() {
            match expr {
                Expr::Not(a) => parts.push((a, !positive)),
                Expr::And(all) if positive => parts.extend(all.iter().map(|a| (a, true))),
                Expr::Or(all) if !positive => parts.extend(all.iter().map(|a| (a, false))),
                _ if alone(expr) == Some(path) => {
                    let value = Some(Value::Bool(positive));
                    starts.retain(|state| expr.evaluate(&mut |leaf| graph.leaf(*state, leaf)) == value);
                }
                _ => {}
            }
        }
        Ok(starts)
    }

    /// Whether the player wants the formula to be true.
    fn wants(&self) -> bool {
        self.objective.paths.first().is_none_or(|path| path.quantifier == Quantifier::Exists)
    }

    fn copy(&self, path: PathId, scope: &Scope) -> Result<&Copy, Error> {
        let copy = scope.copies.get(usize::from(path)).copied().flatten();
        copy.map(|copy| &self.copies[copy])
            .ok_or(Error::Malformed { what: "a path is read before it is chosen" })
    }
}

const BEYOND: Error = Error::Malformed { what: "a path is read beyond its end" };
