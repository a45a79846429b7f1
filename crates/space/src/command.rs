//! A system as guarded commands: the ways to take a step, and what each asks and does, without a list of its states.

use crate::also::{self, MAX_COMMANDS};
use crate::eval::{bounds, code, decode, holds_in, value_in};
use crate::graph::TooLarge;
use hyperplan_problem::{
    ActionId, AttributeId, Edges, Expr, Leaf, State, System, TupleSet, Type, Update, Value, VarId,
};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What becomes of a variable; expressions read the state before.
#[derive(Clone, Debug)]
pub enum NewValue {
    /// This.
    Is(Expr<Leaf>),
    /// This, a value between two ends, which may depend on the state.
    OneOf {
        /// The value.
        value: Expr<Leaf>,
        /// The lower end.
        lo: Expr<Leaf>,
        /// The upper end.
        hi: Expr<Leaf>,
    },
    /// Any value between two ends: an *input* of the step.
    Between {
        /// The lower end.
        lo: Expr<Leaf>,
        /// The upper end.
        hi: Expr<Leaf>,
    },
}

/// New values of variables.
type Assignments = Vec<(VarId, NewValue)>;

/// One way to take an action.
#[derive(Clone, Debug)]
pub struct Command {
    /// The action.
    pub action: ActionId,
    /// When it can be taken.
    pub guard: Guard,
    /// The new value of each variable that a clause updates: one of the values of each of its choices.
    pub updates: Assignments,
}

/// When a command can be taken.
#[derive(Clone, Debug)]
pub enum Guard {
    /// Where the state is absorbing, and nothing changes.
    Absorbing,
    /// Where that clause's guard holds, and the state is not absorbing.
    Clause(usize),
    /// Where a transition that the system lists starts at the variable's value, and the state is not absorbing. At
    /// most one does from each value.
    Listed(VarId, Arc<Listed>),
}

/// Sources with their targets, by source.
pub type Listed = Vec<(i64, i64)>;

/// All commands of a system, those of an action next to each other.
#[derive(Clone, Debug)]
pub struct Commands {
    /// The commands.
    pub all: Vec<Command>,
    /// The variables that are inputs of some command.
    pub inputs: Vec<VarId>,
}

impl Commands {
    /// The commands of a system. A choice among too many values to list becomes an input where `open` says that a
    /// variable of that type may be one.
    ///
    /// # Errors
    /// [`TooLarge`] beyond [`MAX_COMMANDS`].
    pub fn new(system: &System, open: &dyn Fn(&Type) -> bool) -> Result<Commands, TooLarge> {
        let mut all = Vec::new();
        let mut listed = listed(system);
        for &action in &system.actions {
            let mut push = |guard, updates| all.push(Command { action, guard, updates });
            if !system.absorb.is_false() {
                push(Guard::Absorbing, Vec::new());
            }
            for (at, clause) in system.clauses.iter().enumerate() {
                if clause.actions.contains(&action) {
                    for besides in also::besides(system, action, &also::no_number)? {
                        let updates: Vec<_> = clause.updates.iter().cloned().chain(besides).collect();
                        for updates in combinations(system, &updates, open)? {
                            push(Guard::Clause(at), updates);
                        }
                    }
                }
            }
            if let (Some(edges), Some(tables)) = (&system.edges, listed.remove(&action)) {
                for Table { targets, positions } in tables {
                    let targets = Arc::new(targets);
                    let number = |attribute| numbers(edges, &targets, &positions, attribute);
                    for besides in also::besides(system, action, &number)? {
                        for updates in combinations(system, &besides, open)? {
                            push(Guard::Listed(edges.var, targets.clone()), updates);
                        }
                    }
                }
            }
            if all.len() > MAX_COMMANDS {
                return Err(TooLarge);
            }
        }
        let updates = all.iter().flat_map(|command| &command.updates);
        let open = updates.filter(|(_, new)| matches!(new, NewValue::Between { .. }));
        let mut inputs: Vec<VarId> = open.map(|(var, _)| *var).collect();
        inputs.sort_unstable();
        inputs.dedup();
        Ok(Commands { all, inputs })
    }

    /// The positions of an action's commands.
    pub fn of_action(&self, action: ActionId) -> impl Iterator<Item = usize> + '_ {
        self.all.iter().enumerate().filter(move |(_, m)| m.action == action).map(|(at, _)| at)
    }

    /// The first command of an action that can be taken in a state with these inputs, counted from the preferred one
    /// and around: its number among those of its action, and where it leads.
    #[must_use]
    pub fn preferred(
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
    #[must_use]
    pub fn has_outcomes(&self, system: &System, from: &[Value], action: ActionId) -> bool {
        let mut next: Vec<State> = Vec::new();
        for at in self.of_action(action) {
            let command = &self.all[at];
            if command.is_open(system, from) {
                return true;
            }
            // Of an input that is not open, the lower end is the only value.
            next.extend(command.lowest(system, from).and_then(|inputs| command.apply(system, from, &inputs)));
        }
        next.sort_unstable();
        next.dedup();
        next.len() > 1
    }

    /// The number, among the commands of its action, of the first that makes a step.
    #[must_use]
    pub fn number_of(&self, system: &System, from: &[Value], action: ActionId, to: &[Value]) -> Option<u32> {
        (0u32..)
            .zip(self.all.iter().filter(|command| command.action == action))
            .find(|(_, command)| command.apply(system, from, to).as_deref() == Some(to))
            .map(|(number, _)| number)
    }
}

impl Command {
    /// Where the command leads from a state, if it can be taken there. Inputs are read from a state with a value for
    /// every variable.
    #[must_use]
    pub fn apply(&self, system: &System, from: &[Value], inputs: &[Value]) -> Option<State> {
        let absorbing = holds_in(system, &system.absorb, from)?;
        let mut to: State = from.into();
        match &self.guard {
            Guard::Absorbing => return absorbing.then_some(to),
            _ if absorbing => return None,
            Guard::Clause(clause) if !holds_in(system, &system.clauses[*clause].guard, from)? => return None,
            Guard::Clause(_) => {}
            Guard::Listed(var, table) => {
                let at = usize::from(*var);
                let entry = table.binary_search_by_key(&code(from[at]), |entry| entry.0).ok()?;
                to[at] = decode(&system.vars[*var].ty, table[entry].1);
            }
        }
        for (var, new) in &self.updates {
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

    /// The ends of its inputs' ranges.
    fn ranges<'s>(
        &'s self,
        system: &'s System,
        from: &'s [Value],
    ) -> impl Iterator<Item = (VarId, Option<Value>, Option<Value>)> + 's {
        self.updates.iter().filter_map(move |(var, new)| match new {
            NewValue::Between { lo, hi } => {
                Some((*var, value_in(system, lo, from), value_in(system, hi, from)))
            }
            NewValue::Is(_) | NewValue::OneOf { .. } => None,
        })
    }

    /// Whether some input has more than one possible value in a state where the command can be taken.
    fn is_open(&self, system: &System, from: &[Value]) -> bool {
        let taken = match &self.guard {
            Guard::Absorbing => false,
            Guard::Clause(clause) => holds_in(system, &system.clauses[*clause].guard, from) == Some(true),
            Guard::Listed(var, table) => {
                table.binary_search_by_key(&code(from[usize::from(*var)]), |entry| entry.0).is_ok()
            }
        };
        taken
            && holds_in(system, &system.absorb, from) == Some(false)
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

/// Listed transitions, no two from one value, with their positions among all.
#[derive(Default)]
struct Table {
    targets: Listed,
    positions: Vec<usize>,
}

/// The listed transitions of each action, told apart so that a table has at most one from each value.
fn listed(system: &System) -> FxHashMap<ActionId, Vec<Table>> {
    let mut tables: FxHashMap<ActionId, Vec<Table>> = FxHashMap::default();
    // By source, and of one source by action.
    let all: Vec<_> = system.edges.iter().flat_map(Edges::iter).enumerate().collect();
    for same in all.chunk_by(|(_, (from, a)), (_, (other, b))| from == other && a.action == b.action) {
        for (number, &(position, (from, edge))) in same.iter().enumerate() {
            let tables = tables.entry(edge.action).or_default();
            if tables.len() <= number {
                tables.push(Table::default());
            }
            tables[number].targets.push((i64::from(from), i64::from(edge.to)));
            tables[number].positions.push(position);
        }
    }
    tables
}

/// The number of whichever transition of a table starts at the present value: a sum of which one term counts.
fn numbers(edges: &Edges, targets: &Listed, positions: &[usize], attribute: AttributeId) -> Expr<Leaf> {
    let mut by_number: BTreeMap<i64, Vec<Box<[i64]>>> = BTreeMap::new();
    for ((from, _), &position) in targets.iter().zip(positions) {
        by_number.entry(edges.number(position, attribute)).or_default().push(Box::from([*from]));
    }
    if let (1, Some((number, _))) = (by_number.len(), by_number.first_key_value()) {
        return Expr::Const(Value::Int(*number));
    }
    let term = |(number, sources): (i64, Vec<Box<[i64]>>)| {
        let node = Expr::Leaf(Leaf::Var(edges.var));
        let here = Expr::Member(vec![node], Arc::new(TupleSet::new(sources)));
        let constant = |n| Box::new(Expr::Const(Value::Int(n)));
        Expr::If(Box::new(here), constant(number), constant(0))
    };
    Expr::Add(by_number.into_iter().map(term).collect())
}

/// Every combination of the values that updates allow. Where they are too many to list, they are inputs of the step,
/// if they may be.
fn combinations(
    system: &System,
    updates: &[(VarId, Update)],
    open: &dyn Fn(&Type) -> bool,
) -> Result<Vec<Assignments>, TooLarge> {
    let mut all: Vec<Assignments> = vec![Vec::new()];
    for (var, update) in updates {
        let values: Vec<NewValue> = match update {
            Update::Assign(e) => vec![NewValue::Is(e.clone())],
            Update::OneOf(es) => es.iter().cloned().map(NewValue::Is).collect(),
            Update::Within(lo, hi) => match members(lo, hi, bounds(&system.vars[*var].ty)) {
                Some(values) => values,
                None if open(&system.vars[*var].ty) => {
                    vec![NewValue::Between { lo: lo.clone(), hi: hi.clone() }]
                }
                None => return Err(TooLarge),
            },
        };
        if all.len() * values.len() > MAX_COMMANDS {
            return Err(TooLarge);
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
    if i128::from(to) - i128::from(from) >= MAX_COMMANDS as i128 {
        return None;
    }
    let constant = end(lo).is_some() && end(hi).is_some();
    let member = |n: i64| {
        let value = Expr::Const(Value::Int(n));
        if constant { NewValue::Is(value) } else { NewValue::OneOf { value, lo: lo.clone(), hi: hi.clone() } }
    };
    Some((from..=to).map(member).collect())
}
