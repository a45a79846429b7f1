//! Paths whose states are not enumerated: each variable is a term, each step a choice among the system's commands, and
//! of values for what an update leaves open.

use super::step::{InState, after, clip, enabled, enabled_with, within};
use super::symbols::{Numbers, Symbols};
use crate::names::Names;
use crate::value::{Val, choose, equal, known, member_of, same, translate, width};
use crate::writing::at;
use hyperplan_problem::{ActionId, PathId, Rational, State, System, Type, Value, VarId};
use hyperplan_relevance::{Instance, Known, Move, Start};
use hyperplan_smt::{self as smt, Model, Script, Sort, Term, Terms};
use hyperplan_space::{Commands, bounds};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// The terms of a path: `states[t]` its variables at time t, `steps[t]` what leads from there to t + 1.
#[derive(Clone, Debug)]
pub(crate) struct VariablePath {
    /// The path variable that it stands for.
    pub(crate) path: PathId,
    pub(crate) states: Vec<Arc<Vec<Val>>>,
    pub(crate) steps: Vec<Arc<Step>>,
}

/// Which command is taken.
#[derive(Debug)]
pub(crate) struct Step {
    /// One condition for each command of the system; empty in a known path.
    commands: Vec<Term>,
    pub(crate) actions: Vec<(ActionId, Term)>,
    /// The symbols that say which command it is, where the solver chooses it: one that holds its number, or a Boolean
    /// for each command but the last, of which the first true one counts.
    symbols: Vec<Term>,
}

impl Step {
    pub(crate) fn took(&self, action: ActionId) -> Term {
        self.actions.iter().find(|a| a.0 == action).map_or(Term::FALSE, |a| a.1)
    }
}

/// Builds paths of one system.
pub(crate) struct Builder<'a> {
    pub(crate) path: PathId,
    pub(crate) names: &'a Names<'a>,
    pub(crate) commands: &'a Commands,
    pub(crate) numbers: Numbers,
    /// The live states, where some are not; the path must end in one.
    pub(crate) live: Option<&'a [Box<[i64]>]>,
    pub(crate) horizon: u32,
}

impl Builder<'_> {
    fn system(&self) -> &System {
        self.names.system
    }

    /// A path of its first state alone.
    fn starting(&self, first: Arc<Vec<Val>>) -> VariablePath {
        VariablePath { path: self.path, states: vec![first], steps: Vec::new() }
    }

    /// A path that the solver chooses.
    pub(super) fn declare(&self, script: &mut Script, symbols: &Symbols) -> VariablePath {
        script.section(
            format!("path.{}", self.names.path),
            format!("path {}: where it starts", self.names.path),
        );
        let first = self.variables(&mut script.terms, 0, symbols);
        let start = self.initial(&mut script.terms, &first);
        script.assert(start);
        let mut path = self.starting(Arc::new(first));
        for time in 0..self.horizon {
            self.names.begin_step(script, time as usize + 1);
            let here = path.states[time as usize].clone();
            let choices = self.of_step(&mut script.terms, symbols, &here);
            let step = self.choice(&mut script.terms, time + 1, &choices);
            // The inputs of a step are the new values themselves.
            let there = self.variables(&mut script.terms, time + 1, symbols);
            for &var in &self.commands.inputs {
                let range = self.input_in_range(&mut script.terms, var, &there);
                script.assert(range);
            }
            let enabled = enabled_with(self.commands, &mut script.terms, self.system(), &here, &there);
            let possible = possible(&mut script.terms, &step.commands, &enabled);
            script.assert(possible);
            let next = self.next(&mut script.terms, &here, &step.commands, &there);
            for (a, b) in there.iter().zip(&next) {
                let equal = same(&mut script.terms, a, b);
                script.assert(equal);
            }
            path.states.push(Arc::new(there));
            path.steps.push(Arc::new(step));
        }
        let name = &self.names.path;
        script.section(format!("path.{name}"), format!("path {name}: it can go on"));
        let lives = self.ends_live(&mut script.terms, &path);
        script.assert(lives);
        path
    }

    /// A path whose initial state and moves are such terms, all of which are given too, and whose other states are defined
    /// by them.
    pub(super) fn bind(&self, terms: &mut Terms, symbols: &Symbols) -> (VariablePath, Vec<Term>, Term) {
        let first = self.variables(terms, 0, symbols);
        let mut bound: Vec<Term> = first.iter().filter_map(symbol_of).collect();
        let mut guards = vec![self.initial(terms, &first)];
        let mut path = self.starting(Arc::new(first));
        for time in 0..self.horizon {
            let here = path.states[time as usize].clone();
            let choices = self.of_step(terms, symbols, &here);
            let step = self.choice(terms, time + 1, &choices);
            bound.extend(&step.symbols);
            let mut inputs = here.to_vec();
            for &var in &self.commands.inputs {
                let input = self.variable(terms, var, time + 1, symbols);
                bound.extend(symbol_of(&input));
                inputs[usize::from(var)] = input;
                guards.push(self.input_in_range(terms, var, &inputs));
            }
            let enabled = enabled_with(self.commands, terms, self.system(), &here, &inputs);
            guards.push(possible(terms, &step.commands, &enabled));
            let next = self.next(terms, &here, &step.commands, &inputs);
            path.states.push(Arc::new(next));
            path.steps.push(Arc::new(step));
        }
        guards.push(self.ends_live(terms, &path));
        let guard = terms.and(&guards);
        (path, bound, guard)
    }

    /// The path that starts and moves as `inputs` say, and the condition that it is a path.
    pub(crate) fn instantiate(
        &self,
        terms: &mut Terms,
        inputs: &Instance,
        env: &[Option<&VariablePath>],
    ) -> (VariablePath, Term) {
        let first = match &inputs.start {
            Start::Same(other) => at(env, *other).states[0].clone(),
            Start::State(row) => Arc::new(constants(terms, row)),
        };
        let mut guards = vec![self.initial(terms, &first)];
        let mut path = self.starting(first);
        for (time, &movement) in inputs.moves.iter().enumerate() {
            let here = path.states[time].clone();
            let values = match inputs.values.get(time) {
                Some(row) => constants(terms, row),
                None => here.to_vec(),
            };
            let enabled = enabled_with(self.commands, terms, self.system(), &here, &values);
            let (actions, number) = match movement {
                // Outcomes are told apart by the guards of clauses; see `prefer`.
                Move::Same(other) => (at(env, other).steps[time].actions.clone(), 0),
                Move::SameAction(other, number) => (at(env, other).steps[time].actions.clone(), number),
                Move::Act(action, number) => (vec![(action, Term::TRUE)], number),
            };
            let commands = self.prefer(terms, &enabled, &actions, number);
            guards.push(possible(terms, &commands, &enabled));
            let next = self.next(terms, &here, &commands, &values);
            path.states.push(Arc::new(next));
            path.steps.push(Arc::new(Step { commands, actions, symbols: Vec::new() }));
        }
        guards.push(self.ends_live(terms, &path));
        let guard = terms.and(&guards);
        (path, guard)
    }

    /// For each command: its action is taken, and it is the first that is enabled among those of its action, counted
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
            let own: Vec<usize> = self.commands.of_action(action).collect();
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
    pub(super) fn variables(&self, terms: &mut Terms, time: u32, symbols: &Symbols) -> Vec<Val> {
        self.system().vars.keys().map(|var| self.variable(terms, var, time, symbols)).collect()
    }

    fn variable(&self, terms: &mut Terms, var: VarId, time: u32, symbols: &Symbols) -> Val {
        let var = &self.system().vars[var];
        let stem = terms.stem(&format!("{}.{}", self.names.path, var.name));
        let sort = self.numbers.sort(&var.ty);
        let term = symbols.at(terms, stem, time, sort);
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
        parts.push(translate(terms, &system.init, &mut InState::new(system, state)).truth());
        terms.and(&parts)
    }

    /// That an input is in its variable's range, which comparisons then take for granted.
    fn input_in_range(&self, terms: &mut Terms, var: VarId, inputs: &[Val]) -> Term {
        in_range(terms, &inputs[usize::from(var)], &self.system().vars[var].ty)
    }

    /// The choice of a command.
    fn choice(&self, terms: &mut Terms, time: u32, symbols: &Symbols) -> Step {
        let (commands, symbols) = match (self.commands.all.len(), self.numbers) {
            (0 | 1, _) => (vec![Term::TRUE; self.commands.all.len()], Vec::new()),
            (_, Numbers::Integers | Numbers::Reals) => self.first_true(terms, time, symbols),
            (_, Numbers::Bits) => self.numbered(terms, time, symbols),
        };
        let mut actions: Vec<(ActionId, Vec<Term>)> = Vec::new();
        for (command, &term) in self.commands.all.iter().zip(&commands) {
            match actions.last_mut() {
                Some((action, all)) if *action == command.action => all.push(term),
                _ => actions.push((command.action, vec![term])),
            }
        }
        let actions = actions.into_iter().map(|(a, all)| (a, terms.or(&all))).collect();
        Step { commands, actions, symbols }
    }

    /// A bit-vector that holds the number of the command.
    fn numbered(&self, terms: &mut Terms, time: u32, symbols: &Symbols) -> (Vec<Term>, Vec<Term>) {
        let count = self.commands.all.len() as i64;
        let width = width(0, count - 1);
        let stem = terms.stem(&format!("{}.{}", self.names.path, symbols.word()));
        let number = symbols.at(terms, stem, time, Sort::BitVec(width));
        let is = |at: i64| {
            let this = terms.bv(i128::from(at), width);
            terms.eq(number, this)
        };
        ((0..count).map(is).collect(), vec![number])
    }

    /// A Boolean for each command but the last; the first true one is taken, the last where none is.
    fn first_true(&self, terms: &mut Terms, time: u32, symbols: &Symbols) -> (Vec<Term>, Vec<Term>) {
        let (mut commands, mut made) = (Vec::new(), Vec::new());
        let mut none = Term::TRUE;
        for at in 1..self.commands.all.len() {
            let stem = terms.stem(&format!("{}.{}{at}", self.names.path, symbols.word()));
            let this = symbols.at(terms, stem, time, Sort::Bool);
            commands.push(terms.and2(none, this));
            none = terms.and2(none, !this);
            made.push(this);
        }
        commands.push(none);
        (commands, made)
    }

    /// The state after the chosen command. Where none is chosen the path is none, and any state will do.
    fn next(&self, terms: &mut Terms, state: &[Val], taken: &[Term], inputs: &[Val]) -> Vec<Val> {
        let system = self.system();
        let mut next = Vec::with_capacity(state.len());
        for (var, here) in system.vars.keys().zip(state) {
            // Each new value with the commands that lead to it.
            let mut values: Vec<(Val, Vec<Term>)> = Vec::new();
            for (command, &chosen) in self.commands.all.iter().zip(taken) {
                if chosen == Term::FALSE {
                    continue;
                }
                let value = after(command, terms, system, var, state, inputs);
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
    fn ends_live(&self, terms: &mut Terms, path: &VariablePath) -> Term {
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

/// Exactly one command is chosen, and it is enabled. The conditions of commands exclude each other by construction (they
/// are values of one variable, or chosen in order), so some command that is chosen and enabled is enough.
fn possible(terms: &mut Terms, commands: &[Term], enabled: &[Term]) -> Term {
    let parts: Vec<Term> = commands.iter().zip(enabled).map(|(&m, &e)| terms.and2(m, e)).collect();
    terms.or(&parts)
}

/// The values of a known state.
fn constants(terms: &mut Terms, row: &[Value]) -> Vec<Val> {
    row.iter().map(|&value| known(terms, value)).collect()
}

/// Whether a symbol's value is one of the variable's type.
fn in_range(terms: &mut Terms, value: &Val, ty: &Type) -> Term {
    let Some((lo, hi)) = bounds(ty) else { return Term::TRUE };
    let term = match value {
        Val::Bits { term, .. } => *term,
        Val::Number(term) if terms.sort(*term) == Sort::Real => return one_of(terms, value, lo..=hi),
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

/// Whether a real is one of some integers.
fn one_of(terms: &mut Terms, value: &Val, range: RangeInclusive<i64>) -> Term {
    let each: Vec<Term> = range.map(|code| equal(terms, value, code)).collect();
    terms.or(&each)
}

fn symbol_of(value: &Val) -> Option<Term> {
    match value {
        Val::Bool(term) | Val::Bits { term, .. } | Val::Number(term) => Some(*term),
        Val::Cases(_) => None,
    }
}

impl VariablePath {
    /// A known path, as constants.
    pub(crate) fn fix(terms: &mut Terms, path: PathId, fixed: &Known) -> Self {
        let states = fixed.states.iter().map(|row| Arc::new(constants(terms, row))).collect();
        let step = |&action: &ActionId| {
            Arc::new(Step { commands: Vec::new(), actions: vec![(action, Term::TRUE)], symbols: Vec::new() })
        };
        VariablePath { path, states, steps: fixed.actions.iter().map(step).collect() }
    }

    /// The symbols that a model must give values to.
    pub(crate) fn symbols(&self, commands: &Commands) -> Vec<Term> {
        let steps = self.steps.iter().flat_map(|s| s.symbols.iter().copied());
        let inputs = commands.inputs.iter().flat_map(|&var| {
            self.states[1..].iter().filter_map(move |state| symbol_of(&state[usize::from(var)]))
        });
        self.states[0].iter().filter_map(symbol_of).chain(steps).chain(inputs).collect()
    }

    /// The path that a model describes, by replaying its commands; `None` if it is none, or a number does not fit.
    pub(crate) fn decode(&self, system: &System, commands: &Commands, model: &Model) -> Option<Known> {
        let value = |var: VarId, time: usize| -> Option<Value> {
            let term = symbol_of(&self.states[time][usize::from(var)])?;
            value_of(&system.vars[var].ty, model.get(term)?)
        };
        let first: Option<State> = system.vars.keys().map(|var| value(var, 0)).collect();
        let mut path = Known { states: vec![first?], actions: Vec::new(), numbers: Vec::new() };
        for (time, step) in self.steps.iter().enumerate() {
            let command = commands.all.get(step.chosen(model, commands.all.len())?)?;
            let from = path.states.last()?;
            let mut inputs: State = from.clone();
            for &var in &commands.inputs {
                inputs[usize::from(var)] = value(var, time + 1)?;
            }
            let to = command.apply(system, from, &inputs)?;
            path.numbers.push(commands.number_of(system, from, command.action, &to)?);
            path.actions.push(command.action);
            path.states.push(to);
        }
        Some(path)
    }
}

impl Step {
    /// The position of the command that a model takes, among `count`.
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
    let integer = || match value {
        smt::Value::Real(r) if r.denominator() == 1 => i64::try_from(r.numerator()).ok(),
        value => i64::try_from(value.as_signed()?).ok(),
    };
    match (ty, value) {
        (Type::Bool, value) => value.as_bool().map(Value::Bool),
        (Type::Real, smt::Value::Real(r)) => {
            let (numerator, denominator) = (r.numerator().try_into().ok()?, r.denominator().try_into().ok()?);
            Value::real(Rational::new(numerator, denominator))
        }
        (Type::Enum(_), _) => u32::try_from(integer()?).ok().map(Value::Enum),
        (Type::Range { .. } | Type::Int, _) => integer().map(Value::Int),
        (Type::Real, _) => None,
    }
}

/// Whether no command can be taken in some state in range: then there may be dead ends.
pub(crate) fn stuck_state(script: &mut Script, builder: &Builder<'_>) {
    script.section("stuck", "a state without transitions");
    let state = builder.variables(&mut script.terms, 0, &Symbols::Declared);
    for (value, var) in state.iter().zip(&builder.system().vars) {
        let range = in_range(&mut script.terms, value, &var.ty);
        script.assert(range);
    }
    for enabled in enabled(builder.commands, &mut script.terms, builder.system(), &state) {
        script.assert(!enabled);
    }
}
