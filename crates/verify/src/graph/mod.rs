//! One system, explored explicitly and lazily: states, moves, and which states can go on.

use crate::eval::{eval, truth};
use crate::index::Index;
pub(crate) use crate::index::StateId;
use crate::report::{Error, Stop};
use hyperplan_problem::{
    ActionId, Also, Expr, LabelId, Leaf, StepLeaf, System, TransLeaf, Update, Value, VarId,
};
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

mod target;

pub(crate) use target::integers;
use target::{Targets, is_wide, may_become};

/// A transition, seen from its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Move {
    pub(crate) action: ActionId,
    pub(crate) to: StateId,
}

/// How much further a prefix must be able to go to count as a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ahead {
    /// For ever.
    Forever,
    /// This many steps.
    Steps(u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Liveness {
    Unknown,
    /// On the stack of the search.
    Open,
    Live,
    Dead,
}

#[derive(Debug)]
struct Node {
    /// Where its moves begin among all, and how many they are.
    moves: Option<(usize, u32)>,
    liveness: Liveness,
    /// It can go at least so many steps ...
    at_least: u32,
    /// ... and no more than so many.
    at_most: u32,
}

/// A transition from a state: its action, and which listed one it is, if it is one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub(crate) action: ActionId,
    pub(crate) edge: Option<usize>,
}

/// How an expression gets its value.
pub(crate) type ValueOf<'f, L> = dyn Fn(&Expr<L>) -> Result<Value, Stop> + 'f;

/// The part of a system's transition graph seen so far.
#[derive(Debug)]
pub(crate) struct Graph<'p> {
    pub(crate) system: &'p System,
    nodes: TiVec<StateId, Node>,
    /// Of all states, one after the other: the values of the variables, and of the labels.
    values: Vec<Value>,
    labels: Vec<Value>,
    moves: Vec<Move>,
    index: Index,
    /// The first state with these moves, of those that were asked about.
    alike: FxHashMap<Box<[Move]>, StateId>,
    /// Room for the targets of a state.
    targets: Targets<'p>,
    pub(crate) limit: usize,
    /// Whether a variable may become anything between two ends.
    wide: bool,
    /// The labels that `trans` reads of the state after a step, in those too that it reads.
    after: Vec<bool>,
}

/// In place of a value that nobody reads.
const NOTHING: Value = Value::Bool(false);

/// Which labels `trans` reads of the state after a step. A label reads only labels before it.
fn read_after(system: &System) -> Vec<bool> {
    let mut wanted = vec![false; system.labels.len()];
    system.trans.for_each_leaf(&mut |leaf| {
        if let TransLeaf::After(Leaf::Label(label)) = leaf {
            wanted[usize::from(*label)] = true;
        }
    });
    for at in (0..wanted.len()).rev() {
        if wanted[at] {
            system.labels[LabelId::from(at)].expr.for_each_leaf(&mut |leaf| {
                if let Leaf::Label(label) = leaf {
                    wanted[usize::from(*label)] = true;
                }
            });
        }
    }
    wanted
}

/// Why an expression of a system has no value: in a finite system none may be without one.
pub(crate) fn no_value(system: &System) -> Error {
    if system.is_finite() {
        Error::Malformed { what: "an expression of a system has no value" }
    } else {
        Error::Overflow { system: system.name.clone() }
    }
}

impl<'p> Graph<'p> {
    /// Nothing seen yet; at most `limit` states will be.
    pub(crate) fn new(system: &'p System, limit: usize) -> Self {
        Graph {
            system,
            nodes: TiVec::new(),
            values: Vec::new(),
            labels: Vec::new(),
            moves: Vec::new(),
            index: Index::new(system),
            alike: FxHashMap::default(),
            targets: Targets::default(),
            limit: limit.min(u32::MAX as usize - 1),
            wide: system.clauses.iter().flat_map(|clause| &clause.updates).any(|own| is_wide(&own.1))
                || system.also.iter().flat_map(|also| &also.updates).any(|own| is_wide(&own.1)),
            after: read_after(system),
        }
    }

    /// Number of states seen.
    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The values of the variables.
    pub(crate) fn values(&self, state: StateId) -> &[Value] {
        part(&self.values, state, self.system.vars.len())
    }

    /// What a leaf reads.
    pub(crate) fn leaf(&self, state: StateId, leaf: Leaf) -> Option<Value> {
        read(self.values(state), part(&self.labels, state, self.system.labels.len()), leaf)
    }

    /// Whether `init` holds.
    pub(crate) fn is_initial(&self, state: StateId) -> Result<bool, Stop> {
        truth(&self.system.init, &|l| self.leaf(state, *l)).ok_or_else(|| no_value(self.system).into())
    }

    /// Whether each variable has a value of its type.
    pub(crate) fn is_state(&self, values: &[Value]) -> bool {
        values.len() == self.system.vars.len()
            && self.system.vars.iter().zip(values).all(|(var, value)| var.ty.contains(*value))
    }

    /// The id of a state, which must satisfy [`Graph::is_state`].
    pub(crate) fn intern(&mut self, values: &[Value]) -> Result<StateId, Stop> {
        if let Some(id) = self.index.get(values) {
            return Ok(id);
        }
        if self.nodes.len() >= self.limit {
            return Err(Stop::Budget);
        }
        // A label reads only labels before it.
        let before = self.labels.len();
        for label in &self.system.labels {
            match eval(&label.expr, &|l| read(values, &self.labels[before..], *l)) {
                Some(value) => self.labels.push(value),
                None => {
                    self.labels.truncate(before);
                    return Err(no_value(self.system).into());
                }
            }
        }
        self.values.extend_from_slice(values);
        let id = self.nodes.push_and_get_key(Node {
            moves: None,
            liveness: Liveness::Unknown,
            at_least: 0,
            at_most: u32::MAX,
        });
        self.index.insert(values, id);
        Ok(id)
    }

    /// The transitions from a state, sorted, without repetition.
    pub(crate) fn moves(&mut self, state: StateId) -> Result<&[Move], Stop> {
        if self.nodes[state].moves.is_none() {
            let mut targets = std::mem::take(&mut self.targets);
            (targets.actions, targets.values) = (cleared(targets.actions), cleared(targets.values));
            let found = self.list(state, &mut targets);
            self.targets = targets;
            self.nodes[state].moves = Some(found?);
        }
        Ok(self.known_moves(state).unwrap_or_default())
    }

    /// The first state asked about that has the same transitions: from now on they are the same.
    pub(crate) fn first_alike(&mut self, state: StateId) -> Result<StateId, Stop> {
        let moves: Box<[Move]> = self.moves(state)?.into();
        Ok(*self.alike.entry(moves).or_insert(state))
    }

    /// The same if they were asked for before.
    fn known_moves(&self, state: StateId) -> Option<&[Move]> {
        let (first, count) = self.nodes[state].moves?;
        self.moves.get(first..first + count as usize)
    }

    /// Adds the transitions from a state to all; where they begin, and how many they are.
    fn list(&mut self, state: StateId, targets: &mut Targets<'p>) -> Result<(usize, u32), Stop> {
        self.find_targets(state, targets)?;
        let mut moves = Vec::new();
        let width = self.system.vars.len();
        for (at, actions) in targets.actions.iter().enumerate() {
            let target = &targets.values[at * width..][..width];
            if !self.by_trans(state, target)? {
                continue;
            }
            let to = self.intern(target)?;
            moves.extend(actions.iter().map(|&action| Move { action, to }));
        }
        moves.sort_unstable();
        moves.dedup();
        let first = self.moves.len();
        self.moves.append(&mut moves);
        Ok((first, u32::try_from(self.moves.len() - first).map_err(|_| Stop::Budget)?))
    }

    /// Where an action can lead.
    pub(crate) fn after(&mut self, state: StateId, action: ActionId) -> Result<Vec<StateId>, Stop> {
        Ok(self.moves(state)?.iter().filter(|m| m.action == action).map(|m| m.to).collect())
    }

    /// Whether there is a transition with that action; the state's moves must have been asked for.
    pub(crate) fn enabled(&self, state: StateId, action: ActionId) -> Option<bool> {
        self.known_moves(state).map(|moves| moves.iter().any(|m| m.action == action))
    }

    /// Whether there is a transition between two states, by the definition; without enumerating where else the
    /// action leads.
    pub(crate) fn has_step(&self, from: StateId, action: ActionId, to: StateId) -> Result<bool, Stop> {
        let (here, there) = (self.values(from), self.values(to));
        if self.holds(from, &self.system.absorb)? {
            return Ok(self.system.actions.contains(&action) && here == there);
        }
        if !self.by_trans(from, there)? {
            return Ok(false);
        }
        for clause in self.system.clauses.iter().filter(|c| c.actions.contains(&action)) {
            let step = Step { action, edge: None };
            if self.holds(from, &clause.guard)? && self.allows(from, &clause.updates, step, there)? {
                return Ok(true);
            }
        }
        let Some(edges) = &self.system.edges else { return Ok(false) };
        for (at, edge) in edges.numbered(position(here, edges.var)).filter(|(_, edge)| edge.action == action)
        {
            let moved = [(edges.var, Update::Assign(Expr::Const(Value::Enum(edge.to))))];
            if self.allows(from, &moved, Step { action, edge: Some(at) }, there)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether a transition with these updates, and what it does besides, leads to these values, which are of their
    /// variables' types.
    fn allows(
        &self,
        from: StateId,
        updates: &[(VarId, Update)],
        step: Step,
        there: &[Value],
    ) -> Result<bool, Stop> {
        let here = self.values(from);
        let mut allowed: Vec<Option<bool>> = vec![None; here.len()];
        let mut say = |var: VarId, says: bool| allowed[usize::from(var)] = Some(says);
        for (var, update) in updates {
            let new = there[usize::from(*var)];
            say(*var, may_become(update, new, &|e| self.value(from, e))?);
        }
        for also in self.also_in(from, step.action)? {
            for (var, update) in &also.updates {
                let new = there[usize::from(*var)];
                say(*var, may_become(update, new, &|e| self.step_value(from, step, e))?);
            }
        }
        let unchanged = |at: usize| here[at] == there[at];
        Ok(allowed.iter().enumerate().all(|(at, allowed)| allowed.unwrap_or_else(|| unchanged(at))))
    }

    /// The clauses that add something to an action's transitions from a state that does not absorb.
    pub(crate) fn also_in(&self, state: StateId, action: ActionId) -> Result<Vec<&'p Also>, Stop> {
        let mut found = Vec::new();
        for also in &self.system.also {
            if also.actions.contains(&action) && self.holds(state, &also.guard)? {
                found.push(also);
            }
        }
        Ok(found)
    }

    /// What a step costs.
    pub(crate) fn step_cost(
        &self,
        from: StateId,
        action: ActionId,
        to: StateId,
        cost: &Expr<StepLeaf>,
    ) -> Result<i64, Stop> {
        if self.holds(from, &self.system.absorb)? {
            return Ok(0);
        }
        let edges = self.system.edges.as_ref();
        let edge = edges.and_then(|edges| {
            let node = |state: StateId| position(self.values(state), edges.var);
            let mut own = edges.numbered(node(from));
            own.find(|(_, edge)| edge.action == action && edge.to == node(to)).map(|(at, _)| at)
        });
        match self.step_value(from, Step { action, edge }, cost)? {
            Value::Int(cost) if cost >= 0 => Ok(cost),
            _ => Err(no_value(self.system).into()),
        }
    }

    /// The value of an expression over a step from a state.
    pub(crate) fn step_value(&self, from: StateId, step: Step, e: &Expr<StepLeaf>) -> Result<Value, Stop> {
        let edges = self.system.edges.as_ref().zip(step.edge);
        let read = |leaf: &StepLeaf| match *leaf {
            StepLeaf::State(leaf) => self.leaf(from, leaf),
            StepLeaf::Took(action) => Some(Value::Bool(action == step.action)),
            StepLeaf::Attribute(attribute) => {
                Some(Value::Int(edges.map_or(0, |(edges, at)| edges.number(at, attribute))))
            }
        };
        eval(e, &read).ok_or_else(|| no_value(self.system).into())
    }

    /// Whether the step to these values, if they are of their variables' types, is one by `trans`. States that absorb do
    /// not ask.
    fn by_trans(&self, from: StateId, there: &[Value]) -> Result<bool, Stop> {
        if self.system.trans.is_true() || self.holds(from, &self.system.absorb)? {
            return Ok(true);
        }
        let mut labels = Vec::with_capacity(self.system.labels.len());
        for (label, wanted) in self.system.labels.iter().zip(&self.after) {
            // The others are not read.
            let value =
                if *wanted { eval(&label.expr, &|l| read(there, &labels, *l)) } else { Some(NOTHING) };
            labels.push(value.ok_or_else(|| no_value(self.system))?);
        }
        let holds = truth(&self.system.trans, &|leaf| match *leaf {
            TransLeaf::Before(leaf) => self.leaf(from, leaf),
            TransLeaf::After(leaf) => read(there, &labels, leaf),
        });
        holds.ok_or_else(|| no_value(self.system).into())
    }

    pub(crate) fn value(&self, state: StateId, e: &Expr<Leaf>) -> Result<Value, Stop> {
        eval(e, &|l| self.leaf(state, *l)).ok_or_else(|| no_value(self.system).into())
    }

    pub(crate) fn holds(&self, state: StateId, e: &Expr<Leaf>) -> Result<bool, Stop> {
        truth(e, &|l| self.leaf(state, *l)).ok_or_else(|| no_value(self.system).into())
    }

    /// Whether no transition leads to another state; the state's moves must have been asked for.
    pub(crate) fn halted(&self, state: StateId) -> Option<bool> {
        self.known_moves(state).map(|moves| moves.iter().all(|m| m.to == state))
    }

    /// Whether a prefix that ends here can go on so far.
    pub(crate) fn can_go(&mut self, state: StateId, ahead: Ahead) -> Result<bool, Stop> {
        match ahead {
            Ahead::Forever => self.is_live(state),
            Ahead::Steps(steps) => self.has_steps(state, steps),
        }
    }

    /// In a finite system a state is live if it reaches a cycle, so a depth-first search may stop at the first
    /// state that is live or on its own stack: the whole stack is live then.
    fn is_live(&mut self, state: StateId) -> Result<bool, Stop> {
        match self.nodes[state].liveness {
            Liveness::Live => return Ok(true),
            Liveness::Dead => return Ok(false),
            Liveness::Unknown | Liveness::Open => {}
        }
        if self.can_stay(state)? {
            self.nodes[state].liveness = Liveness::Live;
            return Ok(true);
        }
        let mut stack = vec![(state, 0_usize)];
        self.nodes[state].liveness = Liveness::Open;
        while let Some((here, next)) = stack.last_mut() {
            let Some(to) = self.moves(*here)?.get(*next).map(|m| m.to) else {
                self.nodes[*here].liveness = Liveness::Dead;
                stack.pop();
                continue;
            };
            *next += 1;
            match self.nodes[to].liveness {
                Liveness::Dead => {}
                Liveness::Unknown => {
                    self.nodes[to].liveness = Liveness::Open;
                    stack.push((to, 0));
                }
                Liveness::Open | Liveness::Live => {
                    for (open, _) in stack {
                        self.nodes[open].liveness = Liveness::Live;
                    }
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// Whether a transition leads back to the state; asked only where one may lead to too many states to list.
    fn can_stay(&self, state: StateId) -> Result<bool, Stop> {
        if !self.wide || self.nodes[state].moves.is_some() {
            return Ok(false);
        }
        for &action in &self.system.actions {
            if self.has_step(state, action, state)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether some path of `steps` steps starts here; looks no further than that.
    fn has_steps(&mut self, state: StateId, steps: u32) -> Result<bool, Stop> {
        if self.nodes[state].at_least >= steps {
            return Ok(true);
        }
        let mut stack = vec![(state, steps, 0_usize)];
        while let Some((here, steps, next)) = stack.last_mut() {
            let (here, steps) = (*here, *steps);
            if self.nodes[here].at_least >= steps {
                for (open, steps, _) in stack {
                    let node = &mut self.nodes[open];
                    node.at_least = node.at_least.max(steps);
                }
                return Ok(true);
            }
            match self.moves(here)?.get(*next).copied() {
                Some(m) if self.nodes[here].at_most >= steps => {
                    *next += 1;
                    stack.push((m.to, steps - 1, 0));
                }
                _ => {
                    let node = &mut self.nodes[here];
                    node.at_most = node.at_most.min(steps - 1);
                    stack.pop();
                }
            }
        }
        Ok(false)
    }
}

/// A state's part of what is listed for all, so much for each.
fn part(all: &[Value], state: StateId, width: usize) -> &[Value] {
    &all[usize::from(state) * width..][..width]
}

/// The same room, empty.
fn cleared<T>(mut room: Vec<T>) -> Vec<T> {
    room.clear();
    room
}

fn read(values: &[Value], labels: &[Value], leaf: Leaf) -> Option<Value> {
    match leaf {
        Leaf::Var(v) => values.get(usize::from(v)).copied(),
        Leaf::Label(l) => labels.get(usize::from(l)).copied(),
    }
}

/// Where an enumeration's value stands in it; of another type, which no lowered problem has there, nowhere.
pub(crate) fn position(values: &[Value], var: VarId) -> u32 {
    match values.get(usize::from(var)) {
        Some(Value::Enum(position)) => *position,
        _ => u32::MAX,
    }
}
