//! A system as guarded commands: the ways to take a step, and what each asks and does, without a list of its states.

use crate::also;
use crate::eval::{bounds, code, decode, holds_in, is_step, value_in};
use crate::graph::TooLarge;
use hyperplan_problem::{
    ActionId, AttributeId, Edges, Expr, Leaf, State, System, TupleSet, Type, Update, Value, VarId,
};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::Arc;

/// More commands than this are refused: each is a part of every step.
pub const MAX_COMMANDS: usize = 4096;

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
    /// Any value that the update allows: an *input* of the step.
    Among(Update),
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
    /// The commands of a system. Choices with many conditions, and all choices of a clause where they are too many to
    /// list, become inputs; those between two ends only where `open` says that a variable of that type may be one.
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
            let besides = also::besides(system, action, &also::no_number);
            for (at, clause) in system.clauses.iter().enumerate() {
                if clause.actions.contains(&action) {
                    let updates: Vec<_> = clause.updates.iter().chain(&besides).cloned().collect();
                    for updates in combinations(system, &updates, open)? {
                        push(Guard::Clause(at), updates);
                    }
                }
            }
            if let (Some(edges), Some(tables)) = (&system.edges, listed.remove(&action)) {
                for Table { targets, positions } in tables {
                    let targets = Arc::new(targets);
                    let number = |attribute| numbers(edges, &targets, &positions, attribute);
                    for updates in combinations(system, &also::besides(system, action, &number), open)? {
                        push(Guard::Listed(edges.var, targets.clone()), updates);
                    }
                }
            }
            if all.len() > MAX_COMMANDS {
                return Err(TooLarge);
            }
        }
        let updates = all.iter().flat_map(|command| &command.updates);
        let open = updates.filter(|(_, new)| matches!(new, NewValue::Among(_)));
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
            let value = match new {
                NewValue::Is(expr) => value_in(system, expr, from)?,
                NewValue::OneOf { value, lo, hi } => {
                    let value = value_in(system, value, from)?;
                    let (lo, hi) = (value_in(system, lo, from)?, value_in(system, hi, from)?);
                    (lo <= value && value <= hi).then_some(value)?
                }
                NewValue::Among(update) => match allowed(system, *var, update, from)? {
                    Allowed::These(values) => values.contains(&inputs[at]).then_some(inputs[at])?,
                    Allowed::Between(lo, hi) => {
                        (lo <= inputs[at] && inputs[at] <= hi).then_some(inputs[at])?
                    }
                },
            };
            if !system.vars[*var].ty.contains(value) {
                return None;
            }
            to[at] = value;
        }
        is_step(system, from, &to)?.then_some(to)
    }

    /// What its inputs may be in a state.
    fn allowed<'s>(
        &'s self,
        system: &'s System,
        from: &'s [Value],
    ) -> impl Iterator<Item = (VarId, Option<Allowed>)> + 's {
        self.updates.iter().filter_map(move |(var, new)| match new {
            NewValue::Among(update) => Some((*var, allowed(system, *var, update, from))),
            NewValue::Is(_) | NewValue::OneOf { .. } => None,
        })
    }

    /// Whether some input has more than one possible value in a state where the command can be taken. What `trans` says
    /// of them is not asked.
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
            && self.allowed(system, from).any(|(_, allowed)| match allowed {
                Some(Allowed::These(values)) => values.len() > 1,
                Some(Allowed::Between(lo, hi)) => lo < hi,
                None => false,
            })
    }

    /// The state with the least value of each input.
    fn lowest(&self, system: &System, from: &[Value]) -> Option<State> {
        let mut inputs: State = from.into();
        for (var, allowed) in self.allowed(system, from) {
            inputs[usize::from(var)] = match allowed? {
                Allowed::These(values) => *values.first()?,
                Allowed::Between(lo, _) => lo,
            };
        }
        Some(inputs)
    }
}

/// What an input may be in a state.
enum Allowed {
    /// One of these, sorted, which are of its type.
    These(Vec<Value>),
    /// What lies between two ends and is of its type.
    Between(Value, Value),
}

fn allowed(system: &System, var: VarId, update: &Update, from: &[Value]) -> Option<Allowed> {
    let update = update.in_state(&mut |condition| holds_in(system, condition, from).ok_or(())).ok()?;
    match update {
        Update::Assign(e) => of_type(system, var, [value_in(system, e, from)?]),
        Update::OneOf(es) => {
            let values: Vec<Value> = es.iter().map(|e| value_in(system, e, from)).collect::<Option<_>>()?;
            of_type(system, var, values)
        }
        Update::Within(lo, hi) => {
            Some(Allowed::Between(value_in(system, lo, from)?, value_in(system, hi, from)?))
        }
        // There is none in a state.
        Update::If(..) => None,
    }
}

fn of_type(system: &System, var: VarId, values: impl IntoIterator<Item = Value>) -> Option<Allowed> {
    let ty = &system.vars[var].ty;
    let mut values: Vec<Value> = values.into_iter().filter(|value| ty.contains(*value)).collect();
    values.sort_unstable();
    values.dedup();
    Some(Allowed::These(values))
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
    let constant = |n| Expr::Const(Value::Int(n));
    let term = |(number, sources): (i64, Vec<Box<[i64]>>)| {
        let node = Expr::Leaf(Leaf::Var(edges.var));
        let here = Expr::Member(vec![node], Arc::new(TupleSet::new(sources)));
        Expr::choice([(here, constant(number))], constant(0))
    };
    Expr::Add(by_number.into_iter().map(term).collect())
}

/// Combinations of values up to which each is a command of its own, where they may be inputs as well.
const LISTED: usize = 64;

/// Every combination of the values that updates allow. Where they are too many to list, they are inputs of the step.
fn combinations(
    system: &System,
    updates: &[(VarId, Update)],
    open: &dyn Fn(&Type) -> bool,
) -> Result<Vec<Assignments>, TooLarge> {
    let listed: Vec<Option<Vec<NewValue>>> =
        updates.iter().map(|(var, update)| alternatives(system, *var, update)).collect();
    let count = listed.iter().flatten().map(Vec::len).fold(1usize, usize::saturating_mul);
    let mut all: Vec<Assignments> = vec![Vec::new()];
    for ((var, update), listed) in updates.iter().zip(listed) {
        let may_be_input = may_be_input(update, &|| open(&system.vars[*var].ty));
        let values = match listed {
            Some(values) if values.len() == 1 || count <= LISTED || !may_be_input => values,
            _ if may_be_input => vec![NewValue::Among(update.clone())],
            _ => return Err(TooLarge),
        };
        if all.len() * values.len() > MAX_COMMANDS {
            return Err(TooLarge);
        }
        if let [value] = &values[..] {
            all.iter_mut().for_each(|done| done.push((*var, value.clone())));
            continue;
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

/// Whether an update's value may be left to be found: one among some always, one between two ends where `open` says so.
fn may_be_input(update: &Update, open: &dyn Fn() -> bool) -> bool {
    match update {
        Update::Assign(_) | Update::OneOf(_) => true,
        Update::Within(..) => open(),
        Update::If(branches, last) => {
            branches.iter().all(|(_, branch)| may_be_input(branch, open)) && may_be_input(last, open)
        }
    }
}

/// The values that an update allows, one by one, perhaps one several times; `None` where it has many conditions, or
/// they are too many.
fn alternatives(system: &System, var: VarId, update: &Update) -> Option<Vec<NewValue>> {
    match update {
        Update::Assign(e) => Some(vec![NewValue::Is(e.clone())]),
        Update::OneOf(es) => Some(es.iter().cloned().map(NewValue::Is).collect()),
        Update::Within(lo, hi) => members(lo, hi, bounds(&system.vars[var].ty)),
        Update::If(branches, _) if branches.len() > FEW => None,
        Update::If(branches, last) => {
            let of = |update| alternatives(system, var, update);
            let last = of(last)?;
            let branches: Vec<_> =
                branches.iter().map(|(c, update)| Some((c, of(update)?))).collect::<Option<_>>()?;
            let most = branches.iter().map(|(_, values)| values.len()).chain([last.len()]).max()?;
            let none = branches.iter().map(|(_, values)| values).chain([&last]).any(Vec::is_empty);
            if none && most > 1 {
                // The last value stands for more only where there is one.
                return None;
            }
            Some((0..most).map(|number| conditional(&branches, &last, number)).collect())
        }
    }
}

/// Conditions up to which a conditional choice may become a command for each of its values.
const FEW: usize = 16;

/// The value of that number beside the first condition that holds, or the last that there is.
fn conditional(branches: &[(&Expr<Leaf>, Vec<NewValue>)], last: &[NewValue], number: usize) -> NewValue {
    let of = |values: &[NewValue]| match values.get(number).or(values.last()) {
        Some(NewValue::OneOf { value, lo, hi }) => (value.clone(), Some((lo.clone(), hi.clone()))),
        Some(NewValue::Is(value)) => (value.clone(), None),
        // A range that has no value of the type.
        None | Some(NewValue::Among(_)) => {
            let [zero, one] = [0, 1].map(|n| Expr::Const(Value::Int(n)));
            (zero.clone(), Some((one, zero)))
        }
    };
    let all: Vec<_> = branches.iter().map(|(c, values)| ((*c).clone(), of(values))).collect();
    let (last, last_ends) = of(last);
    let values = all.iter().map(|(c, (value, _))| (c.clone(), value.clone()));
    let value = Expr::choice(values, last.clone());
    if last_ends.is_none() && all.iter().all(|(_, (_, ends))| ends.is_none()) {
        return NewValue::Is(value);
    }
    // What is no range lies between itself and itself.
    let (last_lo, last_hi) = last_ends.unwrap_or((last.clone(), last));
    let ends = all.into_iter().map(|(c, (value, ends))| (c, ends.unwrap_or((value.clone(), value))));
    let (los, his): (Vec<_>, Vec<_>) = ends.map(|(c, (lo, hi))| ((c.clone(), lo), (c, hi))).unzip();
    NewValue::OneOf { value, lo: Expr::choice(los, last_lo), hi: Expr::choice(his, last_hi) }
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
