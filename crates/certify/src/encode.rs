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
//! # What is left out
//!
//! Only states that are reached from the start at that time have variables: a path is in one of them. No other pruning is done. A
//! path of the leading block starts where the conjuncts of the formula that read only its first state allow: they have to hold, as the other player has
//! at least one path (else nothing is left out). In bounded mode paths go on for ever, and so are in *live* states only; under `within K` a path has K
//! steps.

mod answer;

use crate::error::Error;
use crate::instance::{Action, Branch, Instance, Start, targets};
use crate::layer::{Acts, FALSE, Layer, Lit, Next, Order, TRUE};
use crate::reading::{VALUE_BOOL, alone, last_reads, number, reads, value_of};
use crate::system::Graph;
use hyperplan_problem::{
    ActionId, Comparison, Expr, FormulaId, Interval, Leaf, Mode, Node, Objective, PathId, PathLeaf, Problem,
    Quantifier, Value,
};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;

/// So many numbers are written, and so many combinations of values of an atom.
const SIZE: usize = 1 << 29;
const COMBINATIONS: usize = 1 << 20;

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
    guard: Vec<Lit>,
}

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
    goals: FxHashMap<(Goal, Vec<Option<usize>>), Lit>,
    open: Vec<(Lit, Goal, Rc<Scope>)>,
    orders: FxHashMap<(Read, u32), Rc<Order>>,
    /// Expressions that stay true, or false, in the step from a layer to the next.
    stays: FxHashSet<(Read, u32, u32, bool)>,
    /// Layers of which it is said that a path is in one state only.
    single: FxHashSet<u32>,
    atoms: FxHashMap<(usize, u32, Vec<Option<usize>>), Lit>,
    /// The paths that each part of the formula reads.
    reads: Vec<Vec<PathId>>,
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
            orders: FxHashMap::default(),
            stays: FxHashSet::default(),
            single: FxHashSet::default(),
            atoms: FxHashMap::default(),
            reads: reads(objective),
        };
        let copies = vec![None; objective.paths.len()];
        encoder.enter(Scope { copies, guard: Vec::new() }, 0)?;
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
        for instance in instances {
            let (copy, none) = self.follow(instance, &scope)?;
            scope.copies[usize::from(instance.path)] = Some(copy);
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

    /// The formula comes out as the player wants, unless an instance is none.
    fn demand(&mut self, scope: &Scope) -> Result<(), Error> {
        let scope = Rc::new(scope.clone());
        let root = self.objective.formula.root();
        let lit = self.part(root, 0, self.wants(), &scope)?;
        self.add(&scope.guard, [lit])?;
        while let Some((lit, goal, scope)) = self.open.pop() {
            self.expand(lit, goal, &scope)?;
        }
        Ok(())
    }

    /// A part of the formula at a time.
    fn part(&mut self, node: FormulaId, time: u32, positive: bool, scope: &Rc<Scope>) -> Result<Lit, Error> {
        let constant = |holds: bool| Ok(if holds == positive { TRUE } else { FALSE });
        let within = match self.objective.mode {
            Mode::Within(steps) => Some(steps.saturating_sub(time)),
            Mode::Bounded => None,
        };
        let objective = self.objective;
        match &objective.formula.nodes[node] {
            Node::Not(a) => return self.part(*a, time, !positive, scope),
            Node::And(all) if all.is_empty() => return constant(true),
            Node::Or(all) if all.is_empty() => return constant(false),
            // Beyond the last position strong next fails, and weak next holds.
            Node::Next(_) if within == Some(0) => return constant(false),
            Node::WeakNext(_) if within == Some(0) => return constant(true),
            Node::Next(a) | Node::WeakNext(a) => return self.part(*a, time + 1, positive, scope),
            Node::Until(Interval { lo, hi }, _, right) | Node::Release(Interval { lo, hi }, _, right) => {
                let hi = hi.unwrap_or(u32::MAX).min(within.unwrap_or(u32::MAX));
                if *lo > hi {
                    return constant(matches!(objective.formula.nodes[node], Node::Release(..)));
                }
                let strong = matches!(objective.formula.nodes[node], Node::Until(..)) == positive;
                let known = self.goals.len();
                let lit = self.goal(Goal { node, time, rest: (*lo, hi), positive }, scope);
                if strong && self.goals.len() > known {
                    self.by_the_end(lit, *right, (time, time + hi), positive, scope)?;
                }
                return Ok(lit);
            }
            Node::And(_) | Node::Or(_) | Node::Iff(..) | Node::Atom(_) => {}
        }
        Ok(self.goal(Goal { node, time, rest: (0, 0), positive }, scope))
    }

    /// What has to come true by some time, and stays true, is true at that time. This follows from the other clauses, but not by
    /// unit propagation alone.
    fn by_the_end(
        &mut self,
        lit: Lit,
        mut node: FormulaId,
        (time, end): (u32, u32),
        mut positive: bool,
        scope: &Scope,
    ) -> Result<(), Error> {
        let objective = self.objective;
        while let Node::Not(a) = &objective.formula.nodes[node] {
            (node, positive) = (*a, !positive);
        }
        let Node::Atom(expr) = &objective.formula.nodes[node] else { return Ok(()) };
        let mut expr = expr;
        while let Expr::Not(a) = expr {
            (expr, positive) = (a, !positive);
        }
        let Some(path) = alone(expr) else { return Ok(()) };
        let read = Read::Expr(std::ptr::from_ref(expr) as usize);
        let mut last = self.order(read, expr, time, scope)?;
        for now in time..end {
            last = self.order(read, expr, now + 1, scope)?;
            let layers = &self.copy(path, scope)?.layers[now as usize..now as usize + 2];
            if !self.stays.contains(&(read, layers[0].id, layers[1].id, positive)) {
                return Ok(());
            }
        }
        let holds = last.at_least(1);
        self.add(&[], [-lit, if positive { holds } else { -holds }])
    }

    /// The variable of a part; what it says is written later.
    fn goal(&mut self, goal: Goal, scope: &Rc<Scope>) -> Lit {
        let copies =
            self.reads[usize::from(goal.node)].iter().map(|&p| scope.copies[usize::from(p)]).collect();
        let key = (goal, copies);
        if let Some(&lit) = self.goals.get(&key) {
            return lit;
        }
        let lit = self.fresh();
        self.goals.insert(key, lit);
        self.open.push((lit, goal, Rc::clone(scope)));
        lit
    }

    /// Writes that a part is true if its variable is.
    fn expand(&mut self, lit: Lit, goal: Goal, scope: &Rc<Scope>) -> Result<(), Error> {
        let Goal { node, time, rest: (lo, hi), positive } = goal;
        let objective = self.objective;
        match &objective.formula.nodes[node] {
            Node::Atom(expr) => {
                let holds = self.truth(expr, time, positive, scope)?;
                self.add(&[], [-lit, holds])
            }
            both @ (Node::And(all) | Node::Or(all)) => {
                let mut some = vec![-lit];
                for &a in all {
                    some.push(self.part(a, time, positive, scope)?);
                }
                match matches!(both, Node::And(_)) == positive {
                    true => some[1..].iter().try_for_each(|&a| self.add(&[], [-lit, a])),
                    false => self.add(&[], some),
                }
            }
            Node::Iff(a, b) => {
                let (yes, no) = (self.part(*a, time, true, scope)?, self.part(*a, time, false, scope)?);
                let same = self.part(*b, time, positive, scope)?;
                let other = self.part(*b, time, !positive, scope)?;
                self.add(&[], [-lit, no, same])?;
                self.add(&[], [-lit, yes, other])
            }
            both @ (Node::Until(_, left, right) | Node::Release(_, left, right)) => {
                // The negation of an until is the release of the negations.
                let strong = matches!(both, Node::Until(..)) == positive;
                let later = |encoder: &mut Self| {
                    let step = encoder.part(*left, time, positive, scope)?;
                    let rest = (lo.saturating_sub(1), hi - 1);
                    Ok::<_, Error>((step, encoder.goal(Goal { node, time: time + 1, rest, positive }, scope)))
                };
                if lo > 0 {
                    let (step, next) = later(self)?;
                    if strong {
                        self.add(&[], [-lit, step])?;
                        return self.add(&[], [-lit, next]);
                    }
                    return self.add(&[], [-lit, step, next]);
                }
                let now = self.part(*right, time, positive, scope)?;
                let more = if hi > 0 { Some(later(self)?) } else { None };
                match (strong, more) {
                    (true, Some((step, next))) => {
                        self.add(&[], [-lit, now, step])?;
                        self.add(&[], [-lit, now, next])
                    }
                    (false, Some((step, next))) => {
                        self.add(&[], [-lit, now])?;
                        self.add(&[], [-lit, step, next])
                    }
                    (_, None) => self.add(&[], [-lit, now]),
                }
            }
            Node::Not(_) | Node::Next(_) | Node::WeakNext(_) => {
                Err(Error::Malformed { what: "a negation or next step has a variable of its own" })
            }
        }
    }

    /// A literal that is true only if the expression is (or is not, where `positive` is false).
    fn truth(
        &mut self,
        expr: &'p Expr<PathLeaf>,
        time: u32,
        positive: bool,
        scope: &Scope,
    ) -> Result<Lit, Error> {
        let sign = |lit: Lit| if positive { lit } else { -lit };
        match expr {
            Expr::Const(value) => Ok(sign(if *value == Value::Bool(true) { TRUE } else { FALSE })),
            Expr::Not(a) => self.truth(a, time, !positive, scope),
            _ if alone(expr).is_some() => {
                let order = self.order(Read::Expr(std::ptr::from_ref(expr) as usize), expr, time, scope)?;
                Ok(sign(order.at_least(1)))
            }
            Expr::And(all) | Expr::Or(all) => {
                let lit = self.fresh();
                let mut some = vec![-lit];
                for a in all {
                    some.push(self.truth(a, time, positive, scope)?);
                }
                match matches!(expr, Expr::And(_)) == positive {
                    true => some[1..].iter().try_for_each(|&a| self.add(&[], [-lit, a]))?,
                    false => self.add(&[], some)?,
                }
                Ok(lit)
            }
            Expr::Iff(a, b) => {
                let (yes, no) = (self.truth(a, time, true, scope)?, self.truth(a, time, false, scope)?);
                let (same, other) =
                    (self.truth(b, time, positive, scope)?, self.truth(b, time, !positive, scope)?);
                let lit = self.fresh();
                self.add(&[], [-lit, no, same])?;
                self.add(&[], [-lit, yes, other])?;
                Ok(lit)
            }
            Expr::If(branches, last) => {
                let mut rest = self.truth(last, time, positive, scope)?;
                for (condition, value) in branches.iter().rev() {
                    let (yes, no) = (
                        self.truth(condition, time, true, scope)?,
                        self.truth(condition, time, false, scope)?,
                    );
                    let value = self.truth(value, time, positive, scope)?;
                    let lit = self.fresh();
                    self.add(&[], [-lit, no, value])?;
                    self.add(&[], [-lit, yes, rest])?;
                    rest = lit;
                }
                Ok(rest)
            }
            _ => Ok(sign(self.atom(expr, time, scope)?)),
        }
    }

    /// A literal that is true exactly if an atom of several paths, or of actions, is.
    fn atom(&mut self, expr: &'p Expr<PathLeaf>, time: u32, scope: &Scope) -> Result<Lit, Error> {
        if let Expr::Leaf(PathLeaf::Took(path, action)) = expr {
            return self.took(*path, *action, time, scope);
        }
        let address = std::ptr::from_ref(expr) as usize;
        let mut paths = Vec::new();
        expr.for_each_leaf(&mut |leaf| paths.extend(leaf.paths().into_iter().flatten()));
        let key = (address, time, paths.iter().map(|&p| scope.copies[usize::from(p)]).collect());
        if let Some(&lit) = self.atoms.get(&key) {
            return Ok(lit);
        }
        let lit = match expr {
            Expr::Leaf(PathLeaf::SameAction(p, q)) => self.same_action(*p, *q, time, scope)?,
            Expr::Leaf(PathLeaf::SameState(p, q)) => self.same_state(*p, *q, time, scope)?,
            Expr::Compare(comparison, a, b) if alone(a).is_some() && alone(b).is_some() => {
                let mut side = |e: &'p Expr<PathLeaf>| {
                    self.order(Read::Expr(std::ptr::from_ref(e) as usize), e, time, scope)
                };
                let (a, b) = (side(a)?, side(b)?);
                self.compare(*comparison, &a, &b)?
            }
            _ => self.combinations(expr, time, scope)?,
        };
        self.atoms.insert(key, lit);
        Ok(lit)
    }

    fn copy(&self, path: PathId, scope: &Scope) -> Result<&Copy, Error> {
        let copy = scope.copies.get(usize::from(path)).copied().flatten();
        copy.map(|copy| &self.copies[copy])
            .ok_or(Error::Malformed { what: "a path is read before it is chosen" })
    }

    /// The action just taken; none at time 0.
    fn took(&self, path: PathId, action: ActionId, time: u32, scope: &Scope) -> Result<Lit, Error> {
        let Some(step) = (time as usize).checked_sub(1) else { return Ok(FALSE) };
        let acts = self.copy(path, scope)?.acts.get(step).ok_or(BEYOND)?;
        Ok(acts.iter().find(|act| act.0 == action).map_or(FALSE, |act| act.1))
    }

    fn same_action(&mut self, p: PathId, q: PathId, time: u32, scope: &Scope) -> Result<Lit, Error> {
        let Some(step) = (time as usize).checked_sub(1) else { return Ok(TRUE) };
        let acts = |path| Ok::<_, Error>(Rc::clone(self.copy(path, scope)?.acts.get(step).ok_or(BEYOND)?));
        let (own, other) = (acts(p)?, acts(q)?);
        if own == other {
            return Ok(TRUE);
        }
        let same = self.fresh();
        let of = |acts: &Acts, action: ActionId| acts.iter().find(|a| a.0 == action).map_or(FALSE, |a| a.1);
        let mut actions: Vec<ActionId> = own.iter().chain(other.iter()).map(|act| act.0).collect();
        actions.sort_unstable();
        actions.dedup();
        for action in actions {
            let (a, b) = (of(&own, action), of(&other, action));
            self.add(&[], [-same, -a, b])?;
            self.add(&[], [-same, -b, a])?;
            self.add(&[], [same, -a, -b])?;
        }
        Ok(same)
    }

    fn same_state(&mut self, p: PathId, q: PathId, time: u32, scope: &Scope) -> Result<Lit, Error> {
        let at = |path| Ok::<_, Error>(self.copy(path, scope)?.layers.get(time as usize).ok_or(BEYOND)?.id);
        if at(p)? == at(q)? {
            return Ok(TRUE);
        }
        let same = self.fresh();
        let mut some = vec![same];
        for var in self.problem.systems[self.objective.paths[p].system].vars.keys() {
            let mut side = |path| {
                let leaf = PathLeaf::State(path, Leaf::Var(var));
                self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, scope)
            };
            let (a, b) = (side(p)?, side(q)?);
            let equal = self.compare(Comparison::Eq, &a, &b)?;
            self.add(&[], [-same, equal])?;
            some.push(-equal);
        }
        self.add(&[], some)?;
        Ok(same)
    }

    /// What an expression over one path's state is at a time.
    fn order(
        &mut self,
        read: Read,
        expr: &Expr<PathLeaf>,
        time: u32,
        scope: &Scope,
    ) -> Result<Rc<Order>, Error> {
        let path = alone(expr).ok_or(Error::Malformed { what: "an expression reads several paths" })?;
        let copy = self.copy(path, scope)?;
        let layer = Rc::clone(copy.layers.get(time as usize).ok_or(BEYOND)?);
        if let Some(order) = self.orders.get(&(read, layer.id)) {
            return Ok(Rc::clone(order));
        }
        let (guard, graph) = (copy.guard.clone(), self.graph(path));
        let mut cells: Vec<(i64, Lit)> = Vec::with_capacity(layer.cells.len());
        for &(state, x) in &layer.cells {
            cells.push((number(expr.evaluate(&mut |leaf| graph.leaf(state, leaf)))?, x));
        }
        cells.sort_unstable();
        let mut order = Order { values: Vec::new(), lits: Vec::new() };
        for own in cells.chunk_by(|a, b| a.0 == b.0) {
            order.lits.push(if order.values.is_empty() { TRUE } else { self.fresh() });
            order.values.push(own[0].0);
        }
        for (at, own) in cells.chunk_by(|a, b| a.0 == b.0).enumerate() {
            let this = order.lits[at];
            let above = order.lits.get(at + 1).copied().unwrap_or(FALSE);
            self.add(&[], [-above, this])?;
            for &(_, x) in own {
                self.add(&[], [-x, this])?;
                self.add(&[], [-x, -above])?;
            }
            // If this is its value, the path is in one of these states.
            self.add(&guard, own.iter().map(|cell| cell.1).chain([-this, above]))?;
        }
        let order = Rc::new(order);
        self.orders.insert((read, layer.id), Rc::clone(&order));
        if time > 0 {
            self.steady(read, expr, time - 1, scope)?;
        }
        self.steady(read, expr, time, scope)?;
        Ok(order)
    }

    /// What a step does to a number at most: from at least so much it gets to no less than the least of what all steps from
    /// there lead to, and likewise for the greatest. So what stays true once it is true is known to.
    fn steady(&mut self, read: Read, expr: &Expr<PathLeaf>, time: u32, scope: &Scope) -> Result<(), Error> {
        let path = alone(expr).ok_or(Error::Malformed { what: "an expression reads several paths" })?;
        let copy = self.copy(path, scope)?;
        let (guard, graph, lasting) = (copy.guard.clone(), self.graph(path), self.lasting());
        let Some([layer, next]) = copy.layers.get(time as usize..time as usize + 2) else { return Ok(()) };
        let known = |layer: &Layer| self.orders.get(&(read, layer.id)).cloned();
        let (Some(before), Some(after)) = (known(layer), known(next)) else { return Ok(()) };
        let value = |state: u32| number(expr.evaluate(&mut |leaf| graph.leaf(state, leaf)));
        let mut bounds: FxHashMap<i64, (i64, i64)> = FxHashMap::default();
        for &(state, _) in &layer.cells {
            let bound = bounds.entry(value(state)?).or_insert((i64::MAX, i64::MIN));
            for &(action, _) in copy.acts[time as usize].iter() {
                for to in targets(&graph, state, action, lasting) {
                    let there = value(to)?;
                    *bound = (bound.0.min(there), bound.1.max(there));
                }
            }
        }
        // Of truth values: whether it stays true, and false.
        let of = |n: i64| bounds.get(&n).copied().unwrap_or((n, n));
        let here = (read, layer.id, next.id);
        let stay = [(true, of(1).0 == 1), (false, of(0).1 == 0)];
        self.stays.extend(stay.iter().filter(|s| s.1).map(|s| (here.0, here.1, here.2, s.0)));
        let (mut least, mut most) = (i64::MAX, i64::MIN);
        for &n in before.values.iter().rev() {
            least = bounds.get(&n).map_or(least, |bound| least.min(bound.0));
            self.add(&guard, [-before.at_least(n), after.at_least(least)])?;
        }
        for &n in &before.values {
            // Of values below this one.
            self.add(&guard, [before.at_least(n), -after.at_least(most.saturating_add(1))])?;
            most = bounds.get(&n).map_or(most, |bound| most.max(bound.1));
        }
        Ok(())
    }

    /// A literal that is true exactly if the comparison is.
    fn compare(&mut self, comparison: Comparison, a: &Order, b: &Order) -> Result<Lit, Error> {
        let lit = self.fresh();
        match comparison {
            Comparison::Lt => {
                let le = self.compare(Comparison::Le, b, a)?;
                return Ok(-le);
            }
            Comparison::Le => {
                for &n in &a.values {
                    self.add(&[], [-lit, -a.at_least(n), b.at_least(n)])?;
                }
                for &n in &b.values {
                    self.add(&[], [lit, -b.at_least(n), a.at_least(n + 1)])?;
                }
            }
            Comparison::Eq => {
                for &n in a.values.iter().chain(&b.values) {
                    self.add(&[], [-lit, -a.at_least(n), b.at_least(n)])?;
                    self.add(&[], [-lit, -b.at_least(n), a.at_least(n)])?;
                    let [a_above, b_above] = [a, b].map(|order| order.at_least(n + 1));
                    self.add(&[], [lit, -a.at_least(n), a_above, -b.at_least(n), b_above])?;
                }
            }
        }
        Ok(lit)
    }

    /// An atom by all combinations of the values that it reads.
    fn combinations(&mut self, expr: &'p Expr<PathLeaf>, time: u32, scope: &Scope) -> Result<Lit, Error> {
        let mut leaves: Vec<PathLeaf> = Vec::new();
        expr.for_each_leaf(&mut |leaf| {
            if !leaves.contains(leaf) {
                leaves.push(*leaf)
            }
        });
        let mut orders: Vec<Rc<Order>> = Vec::new();
        let mut kinds = Vec::new();
        for &leaf in &leaves {
            let truth = |lit| Rc::new(Order { values: vec![0, 1], lits: vec![TRUE, lit] });
            let (order, kind) = match leaf {
                PathLeaf::Took(path, action) => (truth(self.took(path, action, time, scope)?), VALUE_BOOL),
                PathLeaf::SameAction(p, q) => (truth(self.same_action(p, q, time, scope)?), VALUE_BOOL),
                PathLeaf::SameState(p, q) => (truth(self.same_state(p, q, time, scope)?), VALUE_BOOL),
                PathLeaf::Enabled(..) | PathLeaf::Halted(_) => {
                    (self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, scope)?, VALUE_BOOL)
                }
                PathLeaf::State(path, own) => {
                    let system = &self.problem.systems[self.objective.paths[path].system];
                    let order = self.order(Read::Leaf(leaf), &Expr::Leaf(leaf), time, scope)?;
                    (order, value_of(system.leaf_type(own)))
                }
            };
            orders.push(order);
            kinds.push(kind);
        }
        let count = orders.iter().try_fold(1_usize, |n, order| n.checked_mul(order.values.len()));
        if count.is_none_or(|count| count > COMBINATIONS) {
            return Err(Error::TooLarge { what: "an atom combines too many values".to_owned() });
        }
        let lit = self.fresh();
        let mut at = vec![0; orders.len()];
        for _ in 0..count.unwrap_or(0) {
            let mut clause = Vec::new();
            for (order, &at) in orders.iter().zip(&at) {
                clause.push(-order.lits[at]);
                clause.extend(order.lits.get(at + 1));
            }
            let value = expr.evaluate(&mut |leaf| {
                let which = leaves.iter().position(|own| own == leaf)?;
                Some(kinds[which](orders[which].values[at[which]]))
            });
            clause.push(if number(value)? == 1 { lit } else { -lit });
            self.add(&[], clause)?;
            for (at, order) in at.iter_mut().zip(&orders) {
                *at += 1;
                if *at < order.values.len() {
                    break;
                }
                *at = 0;
            }
        }
        Ok(lit)
    }
}

const BEYOND: Error = Error::Malformed { what: "a path is read beyond its end" };
