//! Paths whose states are not enumerated (`--states bitvec` and `int`): each variable is a term, each step a choice
//! among the system's *moves*, and of values for what an update leaves open.

use crate::eval::{bounds, holds_in, value_in};
use crate::explicit::Names;
use crate::inputs::{Inputs, Move, Start};
use crate::value::{
    Leaves, Val, bits_sort, choose, compare, constant, equal, known, member_of, number_sort, same, translate,
    width,
};
use crate::{Error, Row, States};
use hyperplan_problem::{
    ActionId, Comparison, Expr, Leaf, PathId, Rational, State, System, Type, Update, Value, VarId,
};
use hyperplan_smt::{self as smt, Model, Script, Sort, Term, Terms};
use std::rc::Rc;

/// More moves than this are refused: each is a part of every step.
const MAX_MOVES: usize = 4096;

/// What becomes of a variable; expressions read the state before.
#[derive(Clone, Debug)]
enum NewValue {
    /// This.
    Is(Expr<Leaf>),
    /// This, a value among `lo..=hi`, which may depend on the state.
    OneOf { value: Expr<Leaf>, lo: Expr<Leaf>, hi: Expr<Leaf> },
    /// Any value among `lo..=hi`: an *input* of the step.
    Between { lo: Expr<Leaf>, hi: Expr<Leaf> },
}

/// New values of variables.
type Assignments = Vec<(VarId, NewValue)>;

/// One way to take an action: a clause with one of the values of each of its choices, or staying where the state
/// is absorbing.
#[derive(Clone, Debug)]
struct SystemMove {
    action: ActionId,
    /// The clause, and the new value of each variable that it updates; `None` for staying in an absorbing state.
    clause: Option<(usize, Assignments)>,
}

/// All moves of a system, those of an action next to each other.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    moves: Vec<SystemMove>,
    /// How states are written.
    states: States,
    /// The variables that are inputs of some move.
    inputs: Vec<VarId>,
}

impl Moves {
    pub(crate) fn new(system: &System, states: States) -> Result<Moves, Error> {
        let mut moves = Vec::new();
        for &action in &system.actions {
            if !system.absorb.is_false() {
                moves.push(SystemMove { action, clause: None });
            }
            for (at, clause) in system.clauses.iter().enumerate() {
                if clause.actions.contains(&action) {
                    for updates in combinations(system, &clause.updates, states)? {
                        moves.push(SystemMove { action, clause: Some((at, updates)) });
                    }
                }
            }
            if moves.len() > MAX_MOVES {
                return Err(too_many(system));
            }
        }
        let updates = moves.iter().filter_map(|m| m.clause.as_ref()).flat_map(|(_, updates)| updates);
        let open = updates.filter(|(_, new)| matches!(new, NewValue::Between { .. }));
        let mut inputs: Vec<VarId> = open.map(|(var, _)| *var).collect();
        inputs.sort_unstable();
        inputs.dedup();
        Ok(Moves { moves, states, inputs })
    }

    /// Whether some update leaves a value open.
    pub(crate) fn has_inputs(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// The positions of an action's moves.
    pub(crate) fn of_action(&self, action: ActionId) -> impl Iterator<Item = usize> + '_ {
        self.moves.iter().enumerate().filter(move |(_, m)| m.action == action).map(|(at, _)| at)
    }

    /// For each move, whether it can be made in a state, with some inputs.
    pub(crate) fn enabled(&self, terms: &mut Terms, system: &System, state: &[Val]) -> Vec<Term> {
        self.each(terms, system, state, &mut |terms, leaves, var, lo, hi| {
            let lo = translate(terms, lo, leaves);
            let hi = translate(terms, hi, leaves);
            let mut parts = vec![compare(terms, Comparison::Le, lo.clone(), hi.clone())];
            if let Some((least, most)) = bounds(&system.vars[var].ty) {
                parts.push(compare(terms, Comparison::Le, lo, constant(most)));
                parts.push(compare(terms, Comparison::Le, constant(least), hi));
            }
            terms.and(&parts)
        })
    }

    /// For each move, whether it can be made in a state with these inputs.
    fn enabled_with(&self, terms: &mut Terms, system: &System, state: &[Val], inputs: &[Val]) -> Vec<Term> {
        self.each(terms, system, state, &mut |terms, leaves, var, lo, hi| {
            let lo = translate(terms, lo, leaves);
            let hi = translate(terms, hi, leaves);
            let input = inputs[usize::from(var)].clone();
            let above = compare(terms, Comparison::Le, lo, input.clone());
            let below = compare(terms, Comparison::Le, input.clone(), hi);
            let fits = within(terms, input, bounds(&system.vars[var].ty));
            terms.and(&[above, below, fits])
        })
    }

    /// For each move, whether it can be made in a state; `between` says whether a value in a range can.
    fn each(
        &self,
        terms: &mut Terms,
        system: &System,
        state: &[Val],
        between: &mut dyn FnMut(&mut Terms, &mut InState<'_>, VarId, &Expr<Leaf>, &Expr<Leaf>) -> Term,
    ) -> Vec<Term> {
        let mut leaves = InState { system, state };
        let absorbing = translate(terms, &system.absorb, &mut leaves).truth();
        let mut enabled = Vec::with_capacity(self.moves.len());
        for a_move in &self.moves {
            let Some((clause, updates)) = &a_move.clause else {
                enabled.push(absorbing);
                continue;
            };
            let mut parts = vec![!absorbing];
            parts.push(translate(terms, &system.clauses[*clause].guard, &mut leaves).truth());
            for (var, new) in updates {
                let range = bounds(&system.vars[*var].ty);
                match new {
                    NewValue::Is(expr) => {
                        let value = translate(terms, expr, &mut leaves);
                        parts.push(within(terms, value, range));
                    }
                    NewValue::OneOf { value, lo, hi } => {
                        let value = translate(terms, value, &mut leaves);
                        let (lo, hi) = (translate(terms, lo, &mut leaves), translate(terms, hi, &mut leaves));
                        parts.push(compare(terms, Comparison::Le, lo, value.clone()));
                        parts.push(compare(terms, Comparison::Le, value, hi));
                    }
                    NewValue::Between { lo, hi } => parts.push(between(terms, &mut leaves, *var, lo, hi)),
                }
            }
            enabled.push(terms.and(&parts));
        }
        enabled
    }

    /// Whether every move that can be made in a state, as [`Moves::enabled`] says, leads back to it.
    pub(crate) fn halted(&self, terms: &mut Terms, system: &System, state: &[Val], enabled: &[Term]) -> Term {
        let mut leaves = InState { system, state };
        let mut parts = Vec::with_capacity(self.moves.len());
        for (a_move, &possible) in self.moves.iter().zip(enabled) {
            let Some((_, updates)) = &a_move.clause else { continue };
            let mut unchanged = Vec::with_capacity(updates.len());
            for (var, new) in updates {
                let here = &state[usize::from(*var)];
                match new {
                    NewValue::Is(value) | NewValue::OneOf { value, .. } => {
                        let value = translate(terms, value, &mut leaves);
                        unchanged.push(same(terms, &value, here));
                    }
                    NewValue::Between { lo, hi } => {
                        let (lo, hi) = (translate(terms, lo, &mut leaves), translate(terms, hi, &mut leaves));
                        let range = bounds(&system.vars[*var].ty);
                        unchanged.push(only(terms, here, &lo, &hi, range));
                    }
                }
            }
            let unchanged = terms.and(&unchanged);
            parts.push(terms.implies(possible, unchanged));
        }
        terms.and(&parts)
    }

    /// The first move of an action that can be made in a concrete state with these inputs, counted from the
    /// preferred one and around: its number and where it leads.
    pub(crate) fn preferred(
        &self,
        system: &System,
        from: &[Value],
        action: ActionId,
        number: u32,
        inputs: &[Value],
    ) -> Option<(u32, State)> {
        let own: Vec<usize> = self.of_action(action).collect();
        (0..own.len())
            .map(|offset| (number as usize + offset) % own.len())
            .find_map(|at| Some((at as u32, self.moves[own[at]].apply(system, from, inputs)?)))
    }

    /// Whether an action can lead to different states.
    pub(crate) fn has_outcomes(&self, system: &System, from: &[Value], action: ActionId) -> bool {
        let mut next: Vec<State> = Vec::new();
        for at in self.of_action(action) {
            let a_move = &self.moves[at];
            if a_move.is_open(system, from) {
                return true;
            }
            // Of an input that is not open, the lower end is the only value.
            next.extend(a_move.lowest(system, from).and_then(|inputs| a_move.apply(system, from, &inputs)));
        }
        next.sort_unstable();
        next.dedup();
        next.len() > 1
    }

    /// The number, among the moves of its action, of a move that makes a step.
    pub(crate) fn number_of(
        &self,
        system: &System,
        from: &[Value],
        action: ActionId,
        to: &[Value],
    ) -> Option<u32> {
        (0u32..)
            .zip(self.moves.iter().filter(|m| m.action == action))
            .find(|(_, m)| m.apply(system, from, to).as_deref() == Some(to))
            .map(|(number, _)| number)
    }
}

impl SystemMove {
    /// What becomes of a variable, where something does.
    fn update(&self, var: VarId) -> Option<&NewValue> {
        let (_, updates) = self.clause.as_ref()?;
        updates.iter().find(|(updated, _)| *updated == var).map(|(_, new)| new)
    }

    /// Where the move leads from a concrete state, if it can be made there. Inputs are read from a row with a value
    /// for every variable.
    fn apply(&self, system: &System, from: &[Value], inputs: &[Value]) -> Option<State> {
        let absorbing = holds_in(system, &system.absorb, from)?;
        let Some((clause, updates)) = &self.clause else { return absorbing.then(|| from.into()) };
        if absorbing || !holds_in(system, &system.clauses[*clause].guard, from)? {
            return None;
        }
        let mut to: State = from.into();
        for (var, new) in updates {
            let at = usize::from(*var);
            let among = |value: Value, lo: &Expr<Leaf>, hi: &Expr<Leaf>| {
                let (lo, hi) = (value_in(system, lo, from)?, value_in(system, hi, from)?);
                (lo <= value && value <= hi).then_some(value)
            };
            let value = match new {
                NewValue::Is(expr) => value_in(system, expr, from)?,
                NewValue::OneOf { value, lo, hi } => among(value_in(system, value, from)?, lo, hi)?,
                NewValue::Between { lo, hi } => among(inputs[at], lo, hi)?,
            };
            if !system.vars[*var].ty.contains(value) {
                return None;
            }
            to[at] = value;
        }
        Some(to)
    }

    fn ranges<'s>(
        &'s self,
        system: &'s System,
        from: &'s [Value],
    ) -> impl Iterator<Item = (VarId, Option<Value>, Option<Value>)> + 's {
        let updates = self.clause.iter().flat_map(|(_, updates)| updates);
        updates.filter_map(move |(var, new)| match new {
            NewValue::Between { lo, hi } => {
                Some((*var, value_in(system, lo, from), value_in(system, hi, from)))
            }
            NewValue::Is(_) | NewValue::OneOf { .. } => None,
        })
    }

    /// Whether some input has more than one possible value in a state where the move can be made.
    fn is_open(&self, system: &System, from: &[Value]) -> bool {
        let Some((clause, _)) = &self.clause else { return false };
        holds_in(system, &system.absorb, from) == Some(false)
            && holds_in(system, &system.clauses[*clause].guard, from) == Some(true)
            && self.ranges(system, from).any(|(_, lo, hi)| lo < hi)
    }

    /// The state with the lower end of each input's range.
    fn lowest(&self, system: &System, from: &[Value]) -> Option<State> {
        let mut inputs: State = from.into();
        for (var, lo, _) in self.ranges(system, from) {
            inputs[usize::from(var)] = lo?;
        }
        Some(inputs)
    }
}

fn too_many(system: &System) -> Error {
    Error::TooLarge {
        what: format!("the ways to take a step (clauses and choices) of system {}", system.name),
        limit: MAX_MOVES,
    }
}

/// Every combination of the values that updates allow. Where they are too many to list, they are inputs of the step,
/// if numbers are integers or reals.
fn combinations(
    system: &System,
    updates: &[(VarId, Update)],
    states: States,
) -> Result<Vec<Assignments>, Error> {
    let mut all: Vec<Assignments> = vec![Vec::new()];
    for (var, update) in updates {
        let values: Vec<NewValue> = match update {
            Update::Assign(e) => vec![NewValue::Is(e.clone())],
            Update::OneOf(es) => es.iter().cloned().map(NewValue::Is).collect(),
            Update::Within(lo, hi) => match members(lo, hi, bounds(&system.vars[*var].ty)) {
                Some(values) => values,
                None if states == States::Int => {
                    vec![NewValue::Between { lo: lo.clone(), hi: hi.clone() }]
                }
                None => return Err(too_many(system)),
            },
        };
        if all.len() * values.len() > MAX_MOVES {
            return Err(too_many(system));
        }
        all = all
            .iter()
            .flat_map(|done| {
                values.iter().map(|value| {
                    let mut next = done.clone();
                    next.push((*var, value.clone()));
                    next
                })
            })
            .collect();
    }
    Ok(all)
}

/// The values that may lie between two ends, of a variable with that range; `None` where there are too many.
fn members(lo: &Expr<Leaf>, hi: &Expr<Leaf>, range: Option<(i64, i64)>) -> Option<Vec<NewValue>> {
    let (least, most) = range?;
    let end = |e: &Expr<Leaf>| match e {
        Expr::Const(Value::Int(n)) => Some(*n),
        _ => None,
    };
    let (from, to) = (end(lo).unwrap_or(least).max(least), end(hi).unwrap_or(most).min(most));
    if i128::from(to) - i128::from(from) >= MAX_MOVES as i128 {
        return None;
    }
    let constant = end(lo).is_some() && end(hi).is_some();
    let member = |n: i64| {
        let value = Expr::Const(Value::Int(n));
        if constant { NewValue::Is(value) } else { NewValue::OneOf { value, lo: lo.clone(), hi: hi.clone() } }
    };
    Some((from..=to).map(member).collect())
}

/// A path whose every state is known.
#[derive(Clone, Debug)]
pub struct FixedRows {
    pub(crate) rows: Vec<State>,
    pub(crate) actions: Vec<ActionId>,
    /// The number of each step's move among those of its action.
    pub(crate) numbers: Vec<u32>,
}

/// The terms of a path: `states[t]` its variables at time t, `steps[t]` what leads from there to t + 1.
#[derive(Clone, Debug)]
pub(crate) struct SymbolicPath {
    pub(crate) states: Vec<Rc<Vec<Val>>>,
    pub(crate) steps: Vec<Rc<SymbolicStep>>,
}

/// Which move is made.
#[derive(Debug)]
pub(crate) struct SymbolicStep {
    /// One condition for each move of the system; empty in a known path.
    moves: Vec<Term>,
    pub(crate) actions: Vec<(ActionId, Term)>,
    /// The symbols that say which move it is, where the solver chooses it: one that holds its number, or a Boolean
    /// for each move but the last, of which the first true one counts.
    symbols: Vec<Term>,
}

impl SymbolicStep {
    pub(crate) fn took(&self, action: ActionId) -> Term {
        self.actions.iter().find(|a| a.0 == action).map_or(Term::FALSE, |a| a.1)
    }
}

/// The leaves of a system's expressions in a symbolic state.
pub(crate) struct InState<'a> {
    pub(crate) system: &'a System,
    pub(crate) state: &'a [Val],
}

impl Leaves<Leaf> for InState<'_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &Leaf) -> Val {
        match *leaf {
            Leaf::Var(v) => self.state[usize::from(v)].clone(),
            Leaf::Label(l) => {
                let system = self.system;
                translate(terms, &system.labels[l].expr, self)
            }
        }
    }

    fn whole(&mut self, _: &mut Terms, _: &Expr<Leaf>) -> Option<Val> {
        None
    }
}

/// Builds symbolic paths of one system.
pub(crate) struct Builder<'a> {
    pub(crate) names: &'a Names<'a>,
    pub(crate) moves: &'a Moves,
    /// The live states, where some are not; the path must end in one.
    pub(crate) live: Option<&'a [Row]>,
    pub(crate) horizon: u32,
}

impl Builder<'_> {
    fn system(&self) -> &System {
        self.names.system
    }

    /// A path that the solver chooses.
    pub(crate) fn declare(&self, script: &mut Script) -> SymbolicPath {
        script.section(format!("path {}", self.names.path));
        let first = self.variables(&mut script.terms, 0, false);
        let start = self.initial(&mut script.terms, &first);
        script.assert(start);
        let mut path = SymbolicPath { states: vec![Rc::new(first)], steps: Vec::new() };
        for time in 0..self.horizon {
            let here = path.states[time as usize].clone();
            let step = self.choice(&mut script.terms, time + 1, false);
            // The inputs of a step are the new values themselves.
            let there = self.variables(&mut script.terms, time + 1, false);
            let enabled = self.moves.enabled_with(&mut script.terms, self.system(), &here, &there);
            let possible = possible(&mut script.terms, &step.moves, &enabled);
            script.assert(possible);
            let next = self.next(&mut script.terms, &here, &step.moves, &there);
            for (a, b) in there.iter().zip(&next) {
                let equal = same(&mut script.terms, a, b);
                script.assert(equal);
            }
            path.states.push(Rc::new(there));
            path.steps.push(Rc::new(step));
        }
        let lives = self.ends_live(&mut script.terms, &path);
        script.assert(lives);
        path
    }

    /// A path whose initial state and moves are bound variables and whose other states are defined by them.
    pub(crate) fn bind(&self, terms: &mut Terms) -> (SymbolicPath, Vec<Term>, Term) {
        let first = self.variables(terms, 0, true);
        let mut bound: Vec<Term> = first.iter().filter_map(symbol_of).collect();
        let mut guards = vec![self.initial(terms, &first)];
        let mut path = SymbolicPath { states: vec![Rc::new(first)], steps: Vec::new() };
        for time in 0..self.horizon {
            let here = path.states[time as usize].clone();
            let step = self.choice(terms, time + 1, true);
            bound.extend(&step.symbols);
            let mut inputs = here.to_vec();
            for &var in &self.moves.inputs {
                let input = self.variable(terms, var, time + 1, true);
                bound.extend(symbol_of(&input));
                inputs[usize::from(var)] = input;
            }
            let enabled = self.moves.enabled_with(terms, self.system(), &here, &inputs);
            guards.push(possible(terms, &step.moves, &enabled));
            let next = self.next(terms, &here, &step.moves, &inputs);
            path.states.push(Rc::new(next));
            path.steps.push(Rc::new(step));
        }
        guards.push(self.ends_live(terms, &path));
        let guard = terms.and(&guards);
        (path, bound, guard)
    }

    /// A known path, as constants.
    pub(crate) fn fix(&self, terms: &mut Terms, fixed: &FixedRows) -> SymbolicPath {
        let states = fixed.rows.iter().map(|row| Rc::new(constants(terms, row))).collect();
        let step = |&action: &ActionId| {
            Rc::new(SymbolicStep {
                moves: Vec::new(),
                actions: vec![(action, Term::TRUE)],
                symbols: Vec::new(),
            })
        };
        SymbolicPath { states, steps: fixed.actions.iter().map(step).collect() }
    }

    /// The path that starts and moves as `inputs` say, and the condition that it is a path.
    pub(crate) fn instantiate(
        &self,
        terms: &mut Terms,
        inputs: &Inputs<State>,
        env: &[Option<&SymbolicPath>],
    ) -> (SymbolicPath, Term) {
        let at = |path: PathId| env[usize::from(path)].expect("inputs refer to paths quantified before");
        let first = match &inputs.start {
            Start::Same(other) => at(*other).states[0].clone(),
            Start::State(row) => Rc::new(constants(terms, row)),
        };
        let mut guards = vec![self.initial(terms, &first)];
        let mut path = SymbolicPath { states: vec![first], steps: Vec::new() };
        for (time, &movement) in inputs.moves.iter().enumerate() {
            let here = path.states[time].clone();
            let values = match inputs.values.get(time) {
                Some(row) => constants(terms, row),
                None => here.to_vec(),
            };
            let enabled = self.moves.enabled_with(terms, self.system(), &here, &values);
            let (actions, number) = match movement {
                // Outcomes are told apart by the guards of clauses; see `prefer`.
                Move::Same(other) => (at(other).steps[time].actions.clone(), 0),
                Move::SameAction(other, number) => (at(other).steps[time].actions.clone(), number),
                Move::Act(action, number) => (vec![(action, Term::TRUE)], number),
            };
            let moves = self.prefer(terms, &enabled, &actions, number);
            guards.push(possible(terms, &moves, &enabled));
            let next = self.next(terms, &here, &moves, &values);
            path.states.push(Rc::new(next));
            path.steps.push(Rc::new(SymbolicStep { moves, actions, symbols: Vec::new() }));
        }
        guards.push(self.ends_live(terms, &path));
        let guard = terms.and(&guards);
        (path, guard)
    }

    /// For each move: its action is taken, and it is the first that is enabled among those of its action, counted
    /// from the preferred one and around.
    fn prefer(
        &self,
        terms: &mut Terms,
        enabled: &[Term],
        actions: &[(ActionId, Term)],
        number: u32,
    ) -> Vec<Term> {
        let mut chosen = vec![Term::FALSE; enabled.len()];
        for &(action, taken) in actions {
            let own: Vec<usize> =
                (0..enabled.len()).filter(|&at| self.moves.moves[at].action == action).collect();
            let mut free = taken;
            for offset in 0..own.len() {
                let at = own[(number as usize + offset) % own.len()];
                chosen[at] = terms.and2(free, enabled[at]);
                free = terms.and2(free, !enabled[at]);
            }
        }
        chosen
    }

    /// A symbol for each state variable.
    fn variables(&self, terms: &mut Terms, time: u32, bound: bool) -> Vec<Val> {
        self.system().vars.keys().map(|var| self.variable(terms, var, time, bound)).collect()
    }

    fn variable(&self, terms: &mut Terms, var: VarId, time: u32, bound: bool) -> Val {
        let var = &self.system().vars[var];
        let stem = terms.stem(&format!("{}.{}", self.names.path, var.name));
        let sort = match self.moves.states {
            States::Int => number_sort(&var.ty),
            States::Onehot | States::Bitvec => bits_sort(&var.ty),
        };
        let term = symbol(terms, stem, time, sort, bound);
        match (sort, bounds(&var.ty)) {
            (Sort::Bool, _) => Val::Bool(term),
            (Sort::BitVec(_), Some((lo, hi))) => Val::Bits { term, lo, hi },
            _ => Val::Number(term),
        }
    }

    /// In range, and an initial state.
    fn initial(&self, terms: &mut Terms, state: &[Val]) -> Term {
        let system = self.system();
        let ranges = state.iter().zip(&system.vars);
        let mut parts: Vec<Term> = ranges.map(|(value, var)| in_range(terms, value, &var.ty)).collect();
        parts.push(translate(terms, &system.init, &mut InState { system, state }).truth());
        terms.and(&parts)
    }

    /// The choice of a move.
    fn choice(&self, terms: &mut Terms, time: u32, bound: bool) -> SymbolicStep {
        let (moves, symbols) = match (self.moves.moves.len(), self.moves.states) {
            (0 | 1, _) => (vec![Term::TRUE; self.moves.moves.len()], Vec::new()),
            (_, States::Int) => self.first_true(terms, time, bound),
            (_, States::Onehot | States::Bitvec) => self.numbered(terms, time, bound),
        };
        let mut actions: Vec<(ActionId, Vec<Term>)> = Vec::new();
        for (a_move, &term) in self.moves.moves.iter().zip(&moves) {
            match actions.last_mut() {
                Some((action, all)) if *action == a_move.action => all.push(term),
                _ => actions.push((a_move.action, vec![term])),
            }
        }
        let actions = actions.into_iter().map(|(a, all)| (a, terms.or(&all))).collect();
        SymbolicStep { moves, actions, symbols }
    }

    /// A bit-vector that holds the number of the move.
    fn numbered(&self, terms: &mut Terms, time: u32, bound: bool) -> (Vec<Term>, Vec<Term>) {
        let count = self.moves.moves.len() as i64;
        let width = width(0, count - 1);
        let stem = terms.stem(&format!("{}.move", self.names.path));
        let number = symbol(terms, stem, time, Sort::BitVec(width), bound);
        let is = |at: i64| {
            let this = terms.bv(i128::from(at), width);
            terms.eq(number, this)
        };
        ((0..count).map(is).collect(), vec![number])
    }

    /// A Boolean for each move but the last; the first true one is made, the last where none is.
    fn first_true(&self, terms: &mut Terms, time: u32, bound: bool) -> (Vec<Term>, Vec<Term>) {
        let (mut moves, mut symbols) = (Vec::new(), Vec::new());
        let mut none = Term::TRUE;
        for at in 1..self.moves.moves.len() {
            let stem = terms.stem(&format!("{}.move{at}", self.names.path));
            let this = symbol(terms, stem, time, Sort::Bool, bound);
            moves.push(terms.and2(none, this));
            none = terms.and2(none, !this);
            symbols.push(this);
        }
        moves.push(none);
        (moves, symbols)
    }

    /// The state after the chosen move. Where no move is chosen the path is none, and any state will do.
    fn next(&self, terms: &mut Terms, state: &[Val], moves: &[Term], inputs: &[Val]) -> Vec<Val> {
        let system = self.system();
        let mut next = Vec::with_capacity(state.len());
        for (var, here) in system.vars.keys().zip(state) {
            // Each new value with the moves that lead to it.
            let mut values: Vec<(Val, Vec<Term>)> = Vec::new();
            for (a_move, &chosen) in self.moves.moves.iter().zip(moves) {
                if chosen == Term::FALSE {
                    continue;
                }
                let value = match a_move.update(var) {
                    None => here.clone(),
                    Some(NewValue::Is(value) | NewValue::OneOf { value, .. }) => {
                        translate(terms, value, &mut InState { system, state })
                    }
                    Some(NewValue::Between { .. }) => inputs[usize::from(var)].clone(),
                };
                match values.iter_mut().find(|(known, _)| *known == value) {
                    Some((_, when)) => when.push(chosen),
                    None => values.push((value, vec![chosen])),
                }
            }
            let last = values.pop().map_or_else(|| here.clone(), |(value, _)| value);
            let value = values.into_iter().rev().fold(last, |rest, (value, when)| {
                let when = terms.or(&when);
                choose(terms, when, value, rest)
            });
            next.push(clip(terms, &value, &system.vars[var].ty));
        }
        next
    }

    /// In bounded mode, the last state is live.
    fn ends_live(&self, terms: &mut Terms, path: &SymbolicPath) -> Term {
        match (self.live, path.states.last()) {
            (Some(live), Some(last)) => {
                let rows: Vec<&[i64]> = live.iter().map(|row| &**row).collect();
                if self.system().vars.iter().any(|v| v.ty == Type::Bool) {
                    let one = |terms: &mut Terms, row: &[i64]| {
                        let parts: Vec<Term> =
                            last.iter().zip(row).map(|(value, &code)| equal(terms, value, code)).collect();
                        terms.and(&parts)
                    };
                    let any: Vec<Term> = rows.iter().map(|row| one(terms, row)).collect();
                    terms.or(&any)
                } else {
                    member_of(terms, last, &rows)
                }
            }
            _ => Term::TRUE,
        }
    }
}

/// Exactly one move is chosen, and it is enabled. The conditions of moves exclude each other by construction (they
/// are values of one variable, or chosen in order), so some move that is chosen and enabled is enough.
fn possible(terms: &mut Terms, moves: &[Term], enabled: &[Term]) -> Term {
    let parts: Vec<Term> = moves.iter().zip(enabled).map(|(&m, &e)| terms.and2(m, e)).collect();
    terms.or(&parts)
}

/// The values of a known state.
fn constants(terms: &mut Terms, row: &[Value]) -> Vec<Val> {
    row.iter().map(|&value| known(terms, value)).collect()
}

fn symbol(terms: &mut Terms, stem: smt::Stem, time: u32, sort: Sort, bound: bool) -> Term {
    let time = Some(time);
    if bound { terms.bound_symbol(stem, time, sort) } else { terms.symbol(stem, time, sort) }
}

/// Whether a new value is in its variable's range, where it has one.
fn within(terms: &mut Terms, value: Val, range: Option<(i64, i64)>) -> Term {
    let Some((lo, hi)) = range else { return Term::TRUE };
    match &value {
        Val::Bool(_) => Term::TRUE,
        Val::Cases(cases) if cases.iter().all(|c| (lo..=hi).contains(&c.0)) => Term::TRUE,
        Val::Cases(cases) => {
            let inside: Vec<Term> = cases.iter().filter(|c| (lo..=hi).contains(&c.0)).map(|c| c.1).collect();
            terms.or(&inside)
        }
        Val::Bits { .. } | Val::Number(_) => {
            let low = compare(terms, Comparison::Le, constant(lo), value.clone());
            let high = compare(terms, Comparison::Le, value, constant(hi));
            terms.and2(low, high)
        }
    }
}

/// Whether no value from `lo` to `hi` (some are) that is in the variable's range differs from the present one.
fn only(terms: &mut Terms, here: &Val, lo: &Val, hi: &Val, range: Option<(i64, i64)>) -> Term {
    let mut none_below = vec![compare(terms, Comparison::Le, here.clone(), lo.clone())];
    let mut none_above = vec![compare(terms, Comparison::Le, hi.clone(), here.clone())];
    if let Some((least, most)) = range {
        none_below.push(equal(terms, here, least));
        none_above.push(equal(terms, here, most));
    }
    let (none_below, none_above) = (terms.or(&none_below), terms.or(&none_above));
    terms.and2(none_below, none_above)
}

/// Whether a symbol's value is one of the variable's type.
fn in_range(terms: &mut Terms, value: &Val, ty: &Type) -> Term {
    let Some((lo, hi)) = bounds(ty) else { return Term::TRUE };
    let term = match value {
        Val::Bits { term, .. } => *term,
        Val::Number(_) => return within(terms, value.clone(), Some((lo, hi))),
        Val::Bool(_) | Val::Cases(_) => return Term::TRUE,
    };
    let Sort::BitVec(w) = terms.sort(term) else { return Term::TRUE };
    let (least, greatest) = (-(1i128 << (w - 1)), (1i128 << (w - 1)) - 1);
    let mut parts = Vec::new();
    if least < i128::from(lo) {
        let bound = terms.bv(i128::from(lo), w);
        parts.push(terms.bv_sle(bound, term));
    }
    if i128::from(hi) < greatest {
        let bound = terms.bv(i128::from(hi), w);
        parts.push(terms.bv_sle(term, bound));
    }
    terms.and(&parts)
}

/// A new value at its variable's width and bounds: a move that leaves them is not enabled.
fn clip(terms: &mut Terms, value: &Val, ty: &Type) -> Val {
    let Some((lo, hi)) = bounds(ty) else { return value.clone() };
    match value {
        Val::Bits { .. } => {
            let Sort::BitVec(w) = bits_sort(ty) else { return value.clone() };
            Val::Bits { term: value.bits_of_width(terms, w), lo, hi }
        }
        Val::Cases(cases) => Val::Cases(cases.iter().copied().filter(|c| (lo..=hi).contains(&c.0)).collect()),
        Val::Bool(_) | Val::Number(_) => value.clone(),
    }
}

fn symbol_of(value: &Val) -> Option<Term> {
    match value {
        Val::Bool(term) | Val::Bits { term, .. } | Val::Number(term) => Some(*term),
        Val::Cases(_) => None,
    }
}

impl SymbolicPath {
    /// The symbols that a model must give values to.
    pub(crate) fn symbols(&self, moves: &Moves) -> Vec<Term> {
        let steps = self.steps.iter().flat_map(|s| s.symbols.iter().copied());
        let inputs = moves.inputs.iter().flat_map(|&var| {
            self.states[1..].iter().filter_map(move |state| symbol_of(&state[usize::from(var)]))
        });
        self.states[0].iter().filter_map(symbol_of).chain(steps).chain(inputs).collect()
    }

    /// The path that a model describes, by replaying its moves; `None` if it is none, or a number does not fit.
    pub(crate) fn decode(&self, system: &System, moves: &Moves, model: &Model) -> Option<FixedRows> {
        let value = |var: VarId, time: usize| -> Option<Value> {
            let term = symbol_of(&self.states[time][usize::from(var)])?;
            value_of(&system.vars[var].ty, model.get(term)?)
        };
        let first: Option<State> = system.vars.keys().map(|var| value(var, 0)).collect();
        let mut path = FixedRows { rows: vec![first?], actions: Vec::new(), numbers: Vec::new() };
        for (time, step) in self.steps.iter().enumerate() {
            let a_move = moves.moves.get(step.chosen(model, moves.moves.len())?)?;
            let from = path.rows.last()?;
            let mut inputs: State = from.clone();
            for &var in &moves.inputs {
                inputs[usize::from(var)] = value(var, time + 1)?;
            }
            let to = a_move.apply(system, from, &inputs)?;
            path.numbers.push(moves.number_of(system, from, a_move.action, &to)?);
            path.actions.push(a_move.action);
            path.rows.push(to);
        }
        Some(path)
    }
}

impl SymbolicStep {
    /// The position of the move that a model makes, among `count`.
    fn chosen(&self, model: &Model, count: usize) -> Option<usize> {
        match self.symbols.as_slice() {
            [] => Some(0),
            [number] if matches!(model.get(*number)?, smt::Value::Bv { .. }) => {
                usize::try_from(model.get(*number)?.as_signed()?).ok()
            }
            symbols => Some(symbols.iter().position(|&s| model.is_true(s)).unwrap_or(count - 1)),
        }
    }
}

/// What a variable of that type is by a term's value; `None` where it does not fit.
fn value_of(ty: &Type, value: smt::Value) -> Option<Value> {
    let integer = || i64::try_from(value.as_signed()?).ok();
    match (ty, value) {
        (Type::Bool, value) => value.as_bool().map(Value::Bool),
        (Type::Real, smt::Value::Real(r)) => {
            let (numerator, denominator) = (r.numerator().try_into().ok()?, r.denominator().try_into().ok()?);
            Some(Value::Real(Rational::new(numerator, denominator)))
        }
        (Type::Enum(_), _) => u32::try_from(integer()?).ok().map(Value::Enum),
        (Type::Range { .. } | Type::Int, _) => integer().map(Value::Int),
        (Type::Real, _) => None,
    }
}

/// Whether some state in range has no move: then there may be dead ends.
pub(crate) fn stuck_state(script: &mut Script, builder: &Builder<'_>) {
    script.section("a state without transitions");
    let state = builder.variables(&mut script.terms, 0, false);
    for (value, var) in state.iter().zip(&builder.system().vars) {
        let range = in_range(&mut script.terms, value, &var.ty);
        script.assert(range);
    }
    for enabled in builder.moves.enabled(&mut script.terms, builder.system(), &state) {
        script.assert(!enabled);
    }
}
