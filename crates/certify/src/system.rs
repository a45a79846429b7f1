//! A finite system, explored from its initial states: this crate's own reading of what transitions there are.

use crate::error::Error;
use hyperplan_problem::{
    ActionId, Also, Clause, Expr, Leaf, PathLeaf, StepLeaf, System, TransLeaf, Type, Update, Value, VarId,
};
use rustc_hash::FxHashMap;

/// So many states, and so many transitions, are explored.
const STATES: usize = 1 << 20;
const MOVES: usize = 1 << 24;

/// The states that can be reached, and the transitions between them.
#[derive(Debug)]
pub(crate) struct Graph<'p> {
    pub(crate) system: &'p System,
    states: Vec<Node>,
    index: FxHashMap<Box<[Value]>, u32>,
    /// Where paths begin, in order.
    pub(crate) initial: Vec<u32>,
    /// Whether some state lacks some action, or some action's outcome.
    pub(crate) is_partial: bool,
}

#[derive(Debug)]
struct Node {
    values: Box<[Value]>,
    labels: Box<[Value]>,
    /// Its transitions, sorted, without repetition.
    moves: Vec<(ActionId, u32)>,
    /// Whether a path goes on from here for ever.
    is_live: bool,
}

/// An action and the values of the variables after it.
type Arrival = (ActionId, Box<[Value]>);

/// What variables may become, each variable at most once.
type Choices = Vec<(VarId, Vec<Value>)>;

impl<'p> Graph<'p> {
    /// Explores a system.
    pub(crate) fn new(system: &'p System, stop: &dyn Fn() -> bool) -> Result<Self, Error> {
        if !system.is_finite() {
            return Err(Error::Infinite { system: system.name.clone() });
        }
        let mut graph = Graph {
            system,
            states: Vec::new(),
            index: FxHashMap::default(),
            initial: Vec::new(),
            is_partial: false,
        };
        for values in graph.starts(stop)? {
            let state = graph.intern(values)?;
            graph.initial.push(state);
        }
        let (mut at, mut moves) = (0, 0);
        while at < graph.states.len() {
            if at % 256 == 0 && stop() {
                return Err(Error::Stopped);
            }
            let mut own = Vec::new();
            for (action, values) in graph.successors(at)? {
                own.push((action, graph.intern(values)?));
            }
            own.sort_unstable();
            own.dedup();
            moves += own.len();
            if moves > MOVES {
                return Err(graph.too_large());
            }
            graph.states[at].moves = own;
            at += 1;
        }
        graph.find_live();
        let total = |node: &Node| {
            let live = |(_, to): &&(ActionId, u32)| graph.states[*to as usize].is_live;
            let each =
                system.actions.iter().map(|a| node.moves.iter().filter(live).filter(|m| m.0 == *a).count());
            node.is_live && each.into_iter().all(|count| count == 1)
        };
        graph.is_partial = !graph.states.iter().all(total);
        Ok(graph)
    }

    fn too_large(&self) -> Error {
        Error::TooLarge { what: format!("system {} has too many states", self.system.name) }
    }

    /// All values with which `init` holds. A variable is added at a time, and what `init` rules out by then is gone.
    fn starts(&self, stop: &dyn Fn() -> bool) -> Result<Vec<Box<[Value]>>, Error> {
        let mut found: Vec<Vec<Value>> = vec![Vec::new()];
        for var in &self.system.vars {
            let domain = domain(&var.ty).ok_or_else(|| self.too_large())?;
            let mut longer = Vec::new();
            for start in &found {
                if stop() {
                    return Err(Error::Stopped);
                }
                for &value in &domain {
                    let mut start = start.clone();
                    start.push(value);
                    let holds = truth(&self.system.init, &mut |leaf| self.read(&start, *leaf));
                    if holds != Some(false) {
                        longer.push(start);
                    }
                }
                if longer.len() > STATES {
                    return Err(self.too_large());
                }
            }
            found = longer;
        }
        Ok(found.into_iter().map(Vec::into_boxed_slice).collect())
    }

    /// What a leaf reads where the first variables have these values.
    fn read(&self, values: &[Value], leaf: Leaf) -> Option<Value> {
        match leaf {
            Leaf::Var(v) => values.get(usize::from(v)).copied(),
            Leaf::Label(_) => {
                self.system.evaluate(&Expr::Leaf(leaf), &|v: VarId| values.get(usize::from(v)).copied())
            }
        }
    }

    fn intern(&mut self, values: Box<[Value]>) -> Result<u32, Error> {
        if let Some(&state) = self.index.get(&values) {
            return Ok(state);
        }
        if self.states.len() >= STATES {
            return Err(self.too_large());
        }
        let mut labels: Vec<Value> = Vec::with_capacity(self.system.labels.len());
        // A label reads only labels before it.
        for label in &self.system.labels {
            let value = label.expr.evaluate(&mut |leaf| look(&values, &labels, *leaf));
            labels.push(value.ok_or(NO_VALUE)?);
        }
        let state = u32::try_from(self.states.len()).map_err(|_| self.too_large())?;
        self.index.insert(values.clone(), state);
        self.states.push(Node { values, labels: labels.into(), moves: Vec::new(), is_live: true });
        Ok(state)
    }

    /// Where each action leads from a state, by the definition of [`System`].
    fn successors(&self, at: usize) -> Result<Vec<Arrival>, Error> {
        let (system, here) = (self.system, &self.states[at]);
        if self.holds(here, &system.absorb)? {
            return Ok(system.actions.iter().map(|&action| (action, here.values.clone())).collect());
        }
        let mut found = Vec::new();
        for Clause { actions, guard, updates, .. } in &system.clauses {
            if !self.holds(here, guard)? {
                continue;
            }
            let own =
                each(updates, system, &mut |e| e.evaluate(&mut |l| look(&here.values, &here.labels, *l)))?;
            for &action in actions {
                self.targets(here, action, None, own.clone(), &mut found)?;
            }
        }
        let Some(edges) = &system.edges else { return Ok(found) };
        let Some(Value::Enum(node)) = here.values.get(usize::from(edges.var)) else { return Err(NO_VALUE) };
        for (number, edge) in edges.numbered(*node) {
            let own = vec![(edges.var, vec![Value::Enum(edge.to)])];
            self.targets(here, edge.action, Some(number), own, &mut found)?;
        }
        Ok(found)
    }

    /// Adds where a transition leads that makes these choices and what `also` says besides, and of which `trans` holds.
    fn targets(
        &self,
        here: &Node,
        action: ActionId,
        edge: Option<usize>,
        mut choices: Choices,
        found: &mut Vec<Arrival>,
    ) -> Result<(), Error> {
        let system = self.system;
        let mut value = |e: &Expr<StepLeaf>| {
            e.evaluate(&mut |leaf| match *leaf {
                StepLeaf::State(leaf) => look(&here.values, &here.labels, leaf),
                StepLeaf::Took(other) => Some(Value::Bool(other == action)),
                StepLeaf::Attribute(attribute) => {
                    let listed = edge.zip(system.edges.as_ref());
                    Some(Value::Int(listed.map_or(0, |(at, edges)| edges.number(at, attribute))))
                }
            })
        };
        for Also { actions, guard, updates, .. } in &system.also {
            if actions.contains(&action) && self.holds(here, guard)? {
                choices.extend(each(updates, system, &mut value)?);
            }
        }
        let mut known = vec![true; here.values.len()];
        choices.iter().for_each(|(var, _)| known[usize::from(*var)] = false);
        let mut all = vec![here.values.to_vec()];
        for (var, values) in choices {
            known[usize::from(var)] = true;
            let mut longer = Vec::new();
            for target in &all {
                for &value in &values {
                    let mut target = target.clone();
                    target[usize::from(var)] = value;
                    if self.may_step(here, &target, &known) != Some(false) {
                        longer.push(target);
                    }
                }
                if longer.len() > STATES {
                    return Err(self.too_large());
                }
            }
            all = longer;
        }
        // Where nothing changes, nothing was asked yet.
        all.retain(|target| self.may_step(here, target, &known) != Some(false));
        found.extend(all.into_iter().map(|target| (action, target.into_boxed_slice())));
        Ok(())
    }

    /// What `trans` says of a step, as far as the values after it are known.
    fn may_step(&self, here: &Node, there: &[Value], known: &[bool]) -> Option<bool> {
        if self.system.trans.is_true() {
            return Some(true);
        }
        let var = |v: VarId| there.get(usize::from(v)).copied().filter(|_| known[usize::from(v)]);
        truth(&self.system.trans, &mut |leaf| match *leaf {
            TransLeaf::Before(leaf) => look(&here.values, &here.labels, leaf),
            TransLeaf::After(leaf) => self.system.evaluate(&Expr::Leaf(leaf), &var),
        })
    }

    fn holds(&self, here: &Node, expr: &Expr<Leaf>) -> Result<bool, Error> {
        truth(expr, &mut |leaf| look(&here.values, &here.labels, *leaf)).ok_or(NO_VALUE)
    }

    /// Strikes out states without a transition to a state that is left, until there are none.
    fn find_live(&mut self) {
        let mut before: Vec<Vec<u32>> = vec![Vec::new(); self.states.len()];
        let mut ways: Vec<usize> = self.states.iter().map(|node| node.moves.len()).collect();
        for (at, node) in self.states.iter().enumerate() {
            for (_, to) in &node.moves {
                // Ids are below `STATES`.
                before[*to as usize].push(at as u32);
            }
        }
        let mut dead: Vec<usize> = (0..ways.len()).filter(|at| ways[*at] == 0).collect();
        while let Some(at) = dead.pop() {
            self.states[at].is_live = false;
            for &from in &before[at] {
                let from = from as usize;
                ways[from] -= 1;
                if ways[from] == 0 {
                    dead.push(from);
                }
            }
        }
    }

    pub(crate) fn values(&self, state: u32) -> &[Value] {
        &self.states[state as usize].values
    }

    pub(crate) fn find(&self, values: &[Value]) -> Option<u32> {
        self.index.get(values).copied()
    }

    pub(crate) fn is_live(&self, state: u32) -> bool {
        self.states[state as usize].is_live
    }

    /// The transitions from a state.
    pub(crate) fn moves(&self, state: u32) -> &[(ActionId, u32)] {
        &self.states[state as usize].moves
    }

    /// What is read of a path that is in this state.
    pub(crate) fn leaf(&self, state: u32, leaf: &PathLeaf) -> Option<Value> {
        let node = &self.states[state as usize];
        match *leaf {
            PathLeaf::State(_, leaf) => look(&node.values, &node.labels, leaf),
            PathLeaf::Enabled(_, action) => Some(Value::Bool(node.moves.iter().any(|m| m.0 == action))),
            PathLeaf::Halted(_) => Some(Value::Bool(node.moves.iter().all(|m| m.1 == state))),
            PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => None,
        }
    }
}

/// No expression of a finite system is without value.
const NO_VALUE: Error = Error::Malformed { what: "an expression of a system has no value" };

fn truth<L>(expr: &Expr<L>, read: &mut impl FnMut(&L) -> Option<Value>) -> Option<bool> {
    match expr.evaluate(read)? {
        Value::Bool(holds) => Some(holds),
        Value::Int(_) | Value::Enum(_) | Value::Real(_) => None,
    }
}

fn look(values: &[Value], labels: &[Value], leaf: Leaf) -> Option<Value> {
    match leaf {
        Leaf::Var(v) => values.get(usize::from(v)).copied(),
        Leaf::Label(l) => labels.get(usize::from(l)).copied(),
    }
}

/// All values of a type, if they are not too many.
fn domain(ty: &Type) -> Option<Vec<Value>> {
    match ty {
        Type::Bool => Some(vec![Value::Bool(false), Value::Bool(true)]),
        Type::Range { lo, hi } => between(*lo, *hi),
        Type::Enum(names) => Some((0..u32::try_from(names.len()).ok()?).map(Value::Enum).collect()),
        Type::Int | Type::Real => None,
    }
}

fn between(lo: i64, hi: i64) -> Option<Vec<Value>> {
    let count = i128::from(hi) - i128::from(lo) + 1;
    (count <= STATES as i128).then(|| (lo..=hi).map(Value::Int).collect())
}

/// What each of some updates allows, within the variables' types.
fn each<L>(
    updates: &[(VarId, Update<L>)],
    system: &System,
    value: &mut dyn FnMut(&Expr<L>) -> Option<Value>,
) -> Result<Choices, Error> {
    let mut all = Choices::new();
    for (var, update) in updates {
        let ty = &system.vars.get(*var).ok_or(NO_VALUE)?.ty;
        let applied = update.in_state(&mut |c: &Expr<L>| match value(c) {
            Some(Value::Bool(holds)) => Ok(holds),
            _ => Err(NO_VALUE),
        })?;
        let mut values = match applied {
            Update::Assign(e) => vec![value(e).ok_or(NO_VALUE)?],
            Update::OneOf(es) => es.iter().map(&mut *value).collect::<Option<_>>().ok_or(NO_VALUE)?,
            Update::Within(lo, hi) => match (ty, value(lo), value(hi)) {
                (Type::Range { lo: least, hi: most }, Some(Value::Int(lo)), Some(Value::Int(hi))) => {
                    between(lo.max(*least), hi.min(*most)).ok_or(NO_VALUE)?
                }
                _ => return Err(NO_VALUE),
            },
            Update::If(..) => return Err(NO_VALUE),
        };
        values.retain(|value| ty.contains(*value));
        all.push((*var, values));
    }
    Ok(all)
}
