//! Paths whose states are not enumerated (`--states bitvec`): each variable is a term, each step a choice among the
//! system's *moves*.

use crate::eval::{bounds, eval_in};
use crate::explicit::Names;
use crate::inputs::{Inputs, Move, Start};
use crate::value::{
    Leaves, Val, choose, compare, constant, equal, member_of, same, sort_of, translate, width,
};
use crate::{Error, Row};
use hyperplan_problem::{ActionId, Comparison, Expr, Leaf, PathId, System, Type, Update, VarId};
use hyperplan_smt::{Model, Script, Sort, Term, Terms, Value};
use std::rc::Rc;

/// More moves than this are refused: each is a part of every step.
const MAX_MOVES: usize = 4096;

/// New values of variables, read in the state before.
type Assignments = Vec<(VarId, Expr<Leaf>)>;

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
}

impl Moves {
    pub(crate) fn new(system: &System) -> Result<Moves, Error> {
        let mut moves = Vec::new();
        for &action in &system.actions {
            if !system.absorb.is_false() {
                moves.push(SystemMove { action, clause: None });
            }
            for (at, clause) in system.clauses.iter().enumerate() {
                if clause.actions.contains(&action) {
                    for updates in combinations(system, &clause.updates)? {
                        moves.push(SystemMove { action, clause: Some((at, updates)) });
                    }
                }
            }
            if moves.len() > MAX_MOVES {
                return Err(too_many(system));
            }
        }
        Ok(Moves { moves })
    }

    /// The positions of an action's moves.
    pub(crate) fn of_action(&self, action: ActionId) -> impl Iterator<Item = usize> + '_ {
        self.moves.iter().enumerate().filter(move |(_, m)| m.action == action).map(|(at, _)| at)
    }

    /// For each move, whether it can be made in a state.
    pub(crate) fn enabled(&self, terms: &mut Terms, system: &System, state: &[Val]) -> Vec<Term> {
        let mut leaves = InState { system, state };
        let absorbing = translate(terms, &system.absorb, &mut leaves).truth();
        self.moves
            .iter()
            .map(|a_move| {
                let Some((clause, updates)) = &a_move.clause else { return absorbing };
                let mut parts = vec![!absorbing];
                parts.push(translate(terms, &system.clauses[*clause].guard, &mut leaves).truth());
                for (var, expr) in updates {
                    let value = translate(terms, expr, &mut leaves);
                    parts.push(within(terms, value, bounds(&system.vars[*var].ty)));
                }
                terms.and(&parts)
            })
            .collect()
    }

    /// The first move of an action that can be made in a concrete state, counted from the preferred one and around:
    /// its number and where it leads.
    pub(crate) fn preferred(
        &self,
        system: &System,
        from: &[i64],
        action: ActionId,
        number: u32,
    ) -> Option<(u32, Row)> {
        let own: Vec<usize> = self.of_action(action).collect();
        (0..own.len())
            .map(|offset| (number as usize + offset) % own.len())
            .find_map(|at| Some((at as u32, self.moves[own[at]].apply(system, from)?)))
    }

    /// How many different states an action can lead to.
    pub(crate) fn outcomes(&self, system: &System, from: &[i64], action: ActionId) -> usize {
        let mut next: Vec<Row> =
            self.of_action(action).filter_map(|at| self.moves[at].apply(system, from)).collect();
        next.sort_unstable();
        next.dedup();
        next.len()
    }

    /// The number, among the moves of its action, of a move that makes a step.
    pub(crate) fn number_of(
        &self,
        system: &System,
        from: &[i64],
        action: ActionId,
        to: &[i64],
    ) -> Option<u32> {
        (0u32..)
            .zip(self.moves.iter().filter(|m| m.action == action))
            .find(|(_, m)| m.apply(system, from).as_deref() == Some(to))
            .map(|(number, _)| number)
    }
}

impl SystemMove {
    /// Where the move leads from a concrete state, if it can be made there.
    fn apply(&self, system: &System, from: &[i64]) -> Option<Row> {
        let absorbing = eval_in(system, &system.absorb, from) != 0;
        let Some((clause, updates)) = &self.clause else { return absorbing.then(|| from.into()) };
        if absorbing || eval_in(system, &system.clauses[*clause].guard, from) == 0 {
            return None;
        }
        let mut to: Row = from.into();
        for (var, expr) in updates {
            let value = eval_in(system, expr, from);
            let (lo, hi) = bounds(&system.vars[*var].ty);
            if value < lo || value > hi {
                return None;
            }
            to[usize::from(*var)] = value;
        }
        Some(to)
    }
}

fn too_many(system: &System) -> Error {
    Error::TooLarge {
        what: format!("the ways to take a step (clauses and choices) of system {}", system.name),
        limit: MAX_MOVES,
    }
}

/// Every combination of the values that updates allow.
fn combinations(system: &System, updates: &[(VarId, Update)]) -> Result<Vec<Assignments>, Error> {
    let mut all: Vec<Assignments> = vec![Vec::new()];
    for (var, update) in updates {
        let values: Vec<Expr<Leaf>> = match update {
            Update::Assign(e) => vec![e.clone()],
            Update::OneOf(es) => es.clone(),
            Update::Within(lo, hi) => {
                if hi - lo >= MAX_MOVES as i64 {
                    return Err(too_many(system));
                }
                (*lo..=*hi).map(|v| Expr::Const(hyperplan_problem::Value::Int(v))).collect()
            }
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

/// A path whose every state is known, as rows of codes.
#[derive(Clone, Debug)]
pub struct FixedRows {
    pub(crate) rows: Vec<Row>,
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
    /// The symbol that holds the number of the move, where the solver chooses it.
    symbol: Option<Term>,
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
            let (step, _) = self.choice(&mut script.terms, time + 1, false);
            let enabled = self.moves.enabled(&mut script.terms, self.system(), &here);
            let possible = possible(&mut script.terms, &step.moves, &enabled);
            script.assert(possible);
            let next = self.next(&mut script.terms, &here, &step.moves);
            let there = self.variables(&mut script.terms, time + 1, false);
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
            let (step, symbol) = self.choice(terms, time + 1, true);
            bound.extend(symbol);
            let enabled = self.moves.enabled(terms, self.system(), &here);
            guards.push(possible(terms, &step.moves, &enabled));
            let next = self.next(terms, &here, &step.moves);
            path.states.push(Rc::new(next));
            path.steps.push(Rc::new(step));
        }
        guards.push(self.ends_live(terms, &path));
        let guard = terms.and(&guards);
        (path, bound, guard)
    }

    /// A known path, as constants.
    pub(crate) fn fix(&self, fixed: &FixedRows) -> SymbolicPath {
        let state = |row: &Row| {
            let value = |(&code, var): (&i64, &hyperplan_problem::Var)| match var.ty {
                Type::Bool => Val::Bool(if code != 0 { Term::TRUE } else { Term::FALSE }),
                _ => constant(code),
            };
            Rc::new(row.iter().zip(&self.system().vars).map(value).collect::<Vec<_>>())
        };
        let step = |&action: &ActionId| {
            Rc::new(SymbolicStep { moves: Vec::new(), actions: vec![(action, Term::TRUE)], symbol: None })
        };
        SymbolicPath {
            states: fixed.rows.iter().map(state).collect(),
            steps: fixed.actions.iter().map(step).collect(),
        }
    }

    /// The path that starts and moves as `inputs` say, and the condition that it is a path.
    pub(crate) fn instantiate(
        &self,
        terms: &mut Terms,
        inputs: &Inputs<Row>,
        env: &[Option<&SymbolicPath>],
    ) -> (SymbolicPath, Term) {
        let at = |path: PathId| env[usize::from(path)].expect("inputs refer to paths quantified before");
        let first = match &inputs.start {
            Start::Same(other) => at(*other).states[0].clone(),
            Start::State(row) => {
                let alone = FixedRows { rows: vec![row.clone()], actions: Vec::new(), numbers: Vec::new() };
                self.fix(&alone).states[0].clone()
            }
        };
        let mut guards = vec![self.initial(terms, &first)];
        let mut path = SymbolicPath { states: vec![first], steps: Vec::new() };
        for (time, &movement) in inputs.moves.iter().enumerate() {
            let here = path.states[time].clone();
            let enabled = self.moves.enabled(terms, self.system(), &here);
            let (actions, number) = match movement {
                // Outcomes are told apart by the guards of clauses; see `prefer`.
                Move::Same(other) => (at(other).steps[time].actions.clone(), 0),
                Move::SameAction(other, number) => (at(other).steps[time].actions.clone(), number),
                Move::Act(action, number) => (vec![(action, Term::TRUE)], number),
            };
            let moves = self.prefer(terms, &enabled, &actions, number);
            guards.push(possible(terms, &moves, &enabled));
            let next = self.next(terms, &here, &moves);
            path.states.push(Rc::new(next));
            path.steps.push(Rc::new(SymbolicStep { moves, actions, symbol: None }));
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

    /// A variable for each state variable, in range.
    fn variables(&self, terms: &mut Terms, time: u32, bound: bool) -> Vec<Val> {
        let system = self.system();
        system
            .vars
            .iter()
            .map(|var| {
                let stem = terms.stem(&format!("{}.{}", self.names.path, var.name));
                let sort = sort_of(&var.ty);
                let time = Some(time);
                let term =
                    if bound { terms.bound_symbol(stem, time, sort) } else { terms.symbol(stem, time, sort) };
                let (lo, hi) = bounds(&var.ty);
                if sort == Sort::Bool { Val::Bool(term) } else { Val::Bits { term, lo, hi } }
            })
            .collect()
    }

    /// In range, and an initial state.
    fn initial(&self, terms: &mut Terms, state: &[Val]) -> Term {
        let mut parts = Vec::new();
        for value in state {
            if let Val::Bits { term, lo, hi } = *value {
                parts.push(in_range(terms, term, lo, hi));
            }
        }
        let system = self.system();
        parts.push(translate(terms, &system.init, &mut InState { system, state }).truth());
        terms.and(&parts)
    }

    /// The choice of a move.
    fn choice(&self, terms: &mut Terms, time: u32, bound: bool) -> (SymbolicStep, Option<Term>) {
        let count = self.moves.moves.len() as i64;
        let (moves, symbol) = if count == 1 {
            (vec![Term::TRUE], None)
        } else {
            let stem = terms.stem(&format!("{}.move", self.names.path));
            let width = width(0, count.max(1) - 1);
            let sort = Sort::BitVec(width);
            let symbol = if bound {
                terms.bound_symbol(stem, Some(time), sort)
            } else {
                terms.symbol(stem, Some(time), sort)
            };
            let is = |number: i64, terms: &mut Terms| {
                let number = terms.bv(i128::from(number), width);
                terms.eq(symbol, number)
            };
            ((0..count).map(|n| is(n, terms)).collect(), Some(symbol))
        };
        let mut actions: Vec<(ActionId, Vec<Term>)> = Vec::new();
        for (a_move, &term) in self.moves.moves.iter().zip(&moves) {
            match actions.last_mut() {
                Some((action, all)) if *action == a_move.action => all.push(term),
                _ => actions.push((a_move.action, vec![term])),
            }
        }
        let actions = actions.into_iter().map(|(a, all)| (a, terms.or(&all))).collect();
        (SymbolicStep { moves, actions, symbol }, symbol)
    }

    /// The state after the chosen move.
    fn next(&self, terms: &mut Terms, state: &[Val], moves: &[Term]) -> Vec<Val> {
        let system = self.system();
        let mut next = state.to_vec();
        for (a_move, &chosen) in self.moves.moves.iter().zip(moves) {
            if chosen == Term::FALSE {
                continue;
            }
            let Some((_, updates)) = &a_move.clause else { continue };
            for (var, expr) in updates {
                let value = translate(terms, expr, &mut InState { system, state });
                let at = usize::from(*var);
                next[at] = choose(terms, chosen, value, next[at].clone());
            }
        }
        for (value, var) in next.iter_mut().zip(&system.vars) {
            *value = clip(terms, value, &var.ty);
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

/// Whether a new value is in its variable's range.
fn within(terms: &mut Terms, value: Val, (lo, hi): (i64, i64)) -> Term {
    match &value {
        Val::Bool(_) => Term::TRUE,
        Val::Cases(cases) if cases.iter().all(|c| (lo..=hi).contains(&c.0)) => Term::TRUE,
        Val::Cases(cases) => {
            let inside: Vec<Term> = cases.iter().filter(|c| (lo..=hi).contains(&c.0)).map(|c| c.1).collect();
            terms.or(&inside)
        }
        Val::Bits { .. } => {
            let low = compare(terms, Comparison::Le, constant(lo), value.clone());
            let high = compare(terms, Comparison::Le, value, constant(hi));
            terms.and2(low, high)
        }
    }
}

fn in_range(terms: &mut Terms, term: Term, lo: i64, hi: i64) -> Term {
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
    let (lo, hi) = bounds(ty);
    match value {
        Val::Bits { .. } => {
            let Sort::BitVec(w) = sort_of(ty) else { return value.clone() };
            Val::Bits { term: value.bits_of_width(terms, w), lo, hi }
        }
        Val::Cases(cases) => Val::Cases(cases.iter().copied().filter(|c| (lo..=hi).contains(&c.0)).collect()),
        Val::Bool(_) => value.clone(),
    }
}

fn symbol_of(value: &Val) -> Option<Term> {
    match value {
        Val::Bool(term) | Val::Bits { term, .. } => Some(*term),
        Val::Cases(_) => None,
    }
}

impl SymbolicPath {
    /// The symbols that a model must give values to.
    pub(crate) fn symbols(&self) -> Vec<Term> {
        let steps = self.steps.iter().filter_map(|s| s.symbol);
        self.states[0].iter().filter_map(symbol_of).chain(steps).collect()
    }

    /// The path that a model describes, by replaying its moves; `None` if it is none.
    pub(crate) fn decode(&self, system: &System, moves: &Moves, model: &Model) -> Option<FixedRows> {
        let number = |symbol: Term| -> Option<i64> {
            match model.get(symbol)? {
                Value::Bool(b) => Some(i64::from(b)),
                value => i64::try_from(value.as_signed()?).ok(),
            }
        };
        let first: Option<Row> =
            self.states[0].iter().map(|value| symbol_of(value).and_then(number)).collect();
        let mut path = FixedRows { rows: vec![first?], actions: Vec::new(), numbers: Vec::new() };
        for step in &self.steps {
            let chosen = step.symbol.map_or(Some(0), number)?;
            let a_move = moves.moves.get(usize::try_from(chosen).ok()?)?;
            let from = path.rows.last()?;
            let to = a_move.apply(system, from)?;
            path.numbers.push(moves.number_of(system, from, a_move.action, &to)?);
            path.actions.push(a_move.action);
            path.rows.push(to);
        }
        Some(path)
    }
}

/// Whether some state in range has no move: then there may be dead ends.
pub(crate) fn stuck_state(script: &mut Script, builder: &Builder<'_>) {
    script.section("a state without transitions");
    let state = builder.variables(&mut script.terms, 0, false);
    for value in &state {
        if let Val::Bits { term, lo, hi } = *value {
            let range = in_range(&mut script.terms, term, lo, hi);
            script.assert(range);
        }
    }
    for enabled in builder.moves.enabled(&mut script.terms, builder.system(), &state) {
        script.assert(!enabled);
    }
}
