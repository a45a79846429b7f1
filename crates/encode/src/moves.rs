//! The moves of a system whose states are not enumerated: the ways to take a step, and what a step asks and does.

use crate::eval::{bounds, code, decode, holds_in, value_in};
use crate::value::{Leaves, Val, compare, constant, equal, member_of, merge, same, translate};
use crate::{Error, States};
use hyperplan_problem::{ActionId, Comparison, Expr, Leaf, State, System, Type, Update, Value, VarId};
use hyperplan_smt::{Term, Terms};
use rustc_hash::FxHashMap;
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

/// One way to take an action.
#[derive(Clone, Debug)]
pub(crate) struct SystemMove {
    pub(crate) action: ActionId,
    way: Way,
}

#[derive(Clone, Debug)]
enum Way {
    /// Staying where the state is absorbing.
    Stay,
    /// A clause, and the new value of each variable that it updates: one of the values of each of its choices.
    Clause(usize, Assignments),
    /// Listed transitions, at most one from each value of the variable.
    Listed(VarId, Rc<Listed>),
}

/// Sources with their targets, by source.
type Listed = Vec<(i64, i64)>;

/// Whether a variable can get a value between two ends.
type Between<'b> = &'b mut dyn FnMut(&mut Terms, &mut InState<'_>, VarId, &Expr<Leaf>, &Expr<Leaf>) -> Term;

/// All moves of a system, those of an action next to each other.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    pub(crate) all: Vec<SystemMove>,
    /// How states are written.
    pub(crate) states: States,
    /// The variables that are inputs of some move.
    pub(crate) inputs: Vec<VarId>,
}

impl Moves {
    pub(crate) fn new(system: &System, states: States) -> Result<Moves, Error> {
        let mut moves = Vec::new();
        let mut listed = listed(system);
        for &action in &system.actions {
            if !system.absorb.is_false() {
                moves.push(SystemMove { action, way: Way::Stay });
            }
            for (at, clause) in system.clauses.iter().enumerate() {
                if clause.actions.contains(&action) {
                    for updates in combinations(system, &clause.updates, states)? {
                        moves.push(SystemMove { action, way: Way::Clause(at, updates) });
                    }
                }
            }
            if let (Some(var), Some(tables)) = (system.edges.as_ref().map(|e| e.var), listed.remove(&action))
            {
                let tables = tables.into_iter().map(|table| Way::Listed(var, Rc::new(table)));
                moves.extend(tables.map(|way| SystemMove { action, way }));
            }
            if moves.len() > MAX_MOVES {
                return Err(too_many(system));
            }
        }
        let updates = moves.iter().flat_map(SystemMove::updates);
        let open = updates.filter(|(_, new)| matches!(new, NewValue::Between { .. }));
        let mut inputs: Vec<VarId> = open.map(|(var, _)| *var).collect();
        inputs.sort_unstable();
        inputs.dedup();
        Ok(Moves { all: moves, states, inputs })
    }

    /// Whether some update leaves a value open.
    pub(crate) fn has_inputs(&self) -> bool {
        !self.inputs.is_empty()
    }

    /// The positions of an action's moves.
    pub(crate) fn of_action(&self, action: ActionId) -> impl Iterator<Item = usize> + '_ {
        self.all.iter().enumerate().filter(move |(_, m)| m.action == action).map(|(at, _)| at)
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
    pub(crate) fn enabled_with(
        &self,
        terms: &mut Terms,
        system: &System,
        state: &[Val],
        inputs: &[Val],
    ) -> Vec<Term> {
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
    fn each(&self, terms: &mut Terms, system: &System, state: &[Val], between: Between<'_>) -> Vec<Term> {
        let mut leaves = InState { system, state };
        let absorbing = translate(terms, &system.absorb, &mut leaves).truth();
        let mut enabled = Vec::with_capacity(self.all.len());
        for a_move in &self.all {
            let mut parts = vec![!absorbing];
            match &a_move.way {
                Way::Stay => parts[0] = absorbing,
                Way::Clause(clause, _) => {
                    parts.push(translate(terms, &system.clauses[*clause].guard, &mut leaves).truth());
                }
                Way::Listed(var, table) => parts.push(has_target(terms, &state[usize::from(*var)], table)),
            }
            for (var, new) in a_move.updates() {
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
        let mut parts = Vec::with_capacity(self.all.len());
        for (a_move, &possible) in self.all.iter().zip(enabled) {
            let mut unchanged = Vec::new();
            if let Way::Listed(var, table) = &a_move.way {
                let here = &state[usize::from(*var)];
                let loops = table.iter().filter(|(from, to)| from == to).copied().collect();
                unchanged.push(has_target(terms, here, &loops));
            }
            for (var, new) in a_move.updates() {
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
            .find_map(|at| Some((at as u32, self.all[own[at]].apply(system, from, inputs)?)))
    }

    /// Whether an action can lead to different states.
    pub(crate) fn has_outcomes(&self, system: &System, from: &[Value], action: ActionId) -> bool {
        let mut next: Vec<State> = Vec::new();
        for at in self.of_action(action) {
            let a_move = &self.all[at];
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
            .zip(self.all.iter().filter(|m| m.action == action))
            .find(|(_, m)| m.apply(system, from, to).as_deref() == Some(to))
            .map(|(number, _)| number)
    }
}

impl SystemMove {
    /// What becomes of the variables that an update mentions.
    fn updates(&self) -> &[(VarId, NewValue)] {
        match &self.way {
            Way::Clause(_, updates) => updates,
            Way::Stay | Way::Listed(..) => &[],
        }
    }

    /// The value of a variable after the move.
    pub(crate) fn after(
        &self,
        terms: &mut Terms,
        system: &System,
        var: VarId,
        state: &[Val],
        inputs: &[Val],
    ) -> Val {
        let at = usize::from(var);
        if let Way::Listed(moving, table) = &self.way
            && *moving == var
        {
            return follow(terms, &state[at], table);
        }
        match self.updates().iter().find(|(updated, _)| *updated == var) {
            None => state[at].clone(),
            Some((_, NewValue::Is(value) | NewValue::OneOf { value, .. })) => {
                translate(terms, value, &mut InState { system, state })
            }
            Some((_, NewValue::Between { .. })) => inputs[at].clone(),
        }
    }

    /// Where the move leads from a concrete state, if it can be made there. Inputs are read from a row with a value
    /// for every variable.
    pub(crate) fn apply(&self, system: &System, from: &[Value], inputs: &[Value]) -> Option<State> {
        let absorbing = holds_in(system, &system.absorb, from)?;
        let mut to: State = from.into();
        match &self.way {
            Way::Stay => return absorbing.then_some(to),
            _ if absorbing => return None,
            Way::Clause(clause, _) if !holds_in(system, &system.clauses[*clause].guard, from)? => {
                return None;
            }
            Way::Clause(..) => {}
            Way::Listed(var, table) => {
                let at = usize::from(*var);
                let entry = table.binary_search_by_key(&code(from[at]), |entry| entry.0).ok()?;
                to[at] = decode(&system.vars[*var].ty, table[entry].1);
            }
        }
        for (var, new) in self.updates() {
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
        self.updates().iter().filter_map(move |(var, new)| match new {
            NewValue::Between { lo, hi } => {
                Some((*var, value_in(system, lo, from), value_in(system, hi, from)))
            }
            NewValue::Is(_) | NewValue::OneOf { .. } => None,
        })
    }

    /// Whether some input has more than one possible value in a state where the move can be made.
    fn is_open(&self, system: &System, from: &[Value]) -> bool {
        let Way::Clause(clause, _) = &self.way else { return false };
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

/// The listed transitions of each action, told apart so that a table has at most one from each value.
fn listed(system: &System) -> FxHashMap<ActionId, Vec<Listed>> {
    let mut tables: FxHashMap<ActionId, Vec<Listed>> = FxHashMap::default();
    // By source, and of one source by action.
    let all: Vec<_> = system.edges.iter().flat_map(|edges| edges.iter()).collect();
    for same in all.chunk_by(|(from, a), (other, b)| from == other && a.action == b.action) {
        for (number, &(from, edge)) in same.iter().enumerate() {
            let tables = tables.entry(edge.action).or_default();
            if tables.len() <= number {
                tables.push(Listed::new());
            }
            tables[number].push((i64::from(from), i64::from(edge.to)));
        }
    }
    tables
}

/// Whether some listed transition starts at a value.
fn has_target(terms: &mut Terms, from: &Val, table: &Listed) -> Term {
    let sources: Vec<[i64; 1]> = table.iter().map(|(from, _)| [*from]).collect();
    let sources: Vec<&[i64]> = sources.iter().map(|from| &from[..]).collect();
    member_of(terms, std::slice::from_ref(from), &sources)
}

/// Where listed transitions lead from a value that has one: each target with the condition to be at one of its
/// sources.
fn follow(terms: &mut Terms, from: &Val, table: &Listed) -> Val {
    let mut by_target = table.clone();
    by_target.sort_unstable_by_key(|&(from, to)| (to, from));
    let mut cases = Vec::new();
    for same in by_target.chunk_by(|a, b| a.1 == b.1) {
        cases.push((same[0].1, has_target(terms, from, &same.to_vec())));
    }
    merge(terms, cases.into_iter())
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
                None if open(&system.vars[*var].ty, states) => {
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

/// Whether an update may leave a value of that type open: a solver for integers and reals then finds it.
fn open(ty: &Type, states: States) -> bool {
    states == States::Int || states == States::Real && *ty == Type::Real
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

/// Whether a new value is in its variable's range, where it has one.
pub(crate) fn within(terms: &mut Terms, value: Val, range: Option<(i64, i64)>) -> Term {
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
