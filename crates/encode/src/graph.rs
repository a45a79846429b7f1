//! A system's reachable states, enumerated.
//!
//! Transitions are made deterministic by *letters*: a letter is an action and the number of one of its outcomes, so
//! that a state and a letter have at most one successor. A system whose actions are deterministic has one letter an
//! action.

use crate::eval::{bounds, code, decode, eval_in};
use hyperplan_problem::{ActionId, Clause, Expr, Leaf, State, System, Update, VarId};
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// The index of a state of a [`Graph`].
pub type StateIx = u32;

/// The index of a letter of a [`Graph`].
pub type Letter = u32;

/// The number of steps that a state allows, where there is no limit: the state is live.
pub const LIVE: u32 = u32::MAX;

/// All states reachable from the initial ones, with every transition between them.
#[derive(Debug)]
pub struct Graph {
    /// Number of variables: the length of a row of `rows`.
    width: usize,
    /// The states, one row of codes after the other.
    rows: Vec<i64>,
    /// The initial states, in order.
    pub initial: Vec<StateIx>,
    /// The action and the outcome number of each letter; the letters of an action are neighbours.
    pub letters: Vec<(ActionId, u32)>,
    /// Where each state's transitions start in `transitions`.
    starts: Vec<u32>,
    /// `(letter, successor)`, by letter.
    transitions: Vec<(Letter, StateIx)>,
    /// The length of the longest path from each state; [`LIVE`] where there is no longest.
    pub rank: Vec<u32>,
}

/// Why a system was not enumerated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl Graph {
    /// Enumerates a system, unless it has more than `budget` reachable states (or as many transitions times 16).
    ///
    /// # Errors
    /// [`TooLarge`] beyond the budget, or where the initial states cannot be enumerated within it.
    pub fn explore(system: &System, budget: usize) -> Result<Graph, TooLarge> {
        let packing = Packing::new(system).ok_or(TooLarge)?;
        let mut explorer = Explorer {
            system,
            budget,
            packing,
            width: system.vars.len(),
            rows: Vec::new(),
            index: FxHashMap::default(),
            positions: (0u32..).zip(&system.actions).map(|(at, action)| (*action, at)).collect(),
        };
        let initial = explorer.initial_states()?;
        let (starts, edges) = explorer.edges()?;
        let Explorer { rows, width, .. } = explorer;
        let (letters, transitions) = number_letters(system, &starts, &edges);
        let rank = ranks(&starts, &transitions);
        Ok(Graph { width, rows, initial, letters, starts, transitions, rank })
    }

    /// Number of states.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rank.len()
    }

    /// Whether there is no state at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rank.is_empty()
    }

    /// The codes of a state's variables.
    #[must_use]
    pub fn row(&self, state: StateIx) -> &[i64] {
        let at = state as usize * self.width;
        &self.rows[at..at + self.width]
    }

    /// A state as values.
    #[must_use]
    pub fn state(&self, system: &System, state: StateIx) -> State {
        self.row(state).iter().zip(&system.vars).map(|(&c, var)| decode(&var.ty, c)).collect()
    }

    /// The index of a state given as values; a search, for the few states of a trace.
    #[must_use]
    pub fn find(&self, values: &State) -> Option<StateIx> {
        let row: Vec<i64> = values.iter().map(|&v| code(v)).collect();
        (0..self.len() as StateIx).find(|&s| self.row(s) == row)
    }

    /// The transitions of a state, by letter.
    #[must_use]
    pub fn successors(&self, state: StateIx) -> &[(Letter, StateIx)] {
        let at = state as usize;
        &self.transitions[self.starts[at] as usize..self.starts[at + 1] as usize]
    }

    /// Where a letter leads.
    #[must_use]
    pub fn successor(&self, state: StateIx, letter: Letter) -> Option<StateIx> {
        let all = self.successors(state);
        all.binary_search_by_key(&letter, |t| t.0).ok().map(|at| all[at].1)
    }

    /// Where an action leads when its outcome has this number, or its last outcome where there are fewer.
    #[must_use]
    pub fn outcome(&self, state: StateIx, action: ActionId, number: u32) -> Option<StateIx> {
        self.successors(state)
            .iter()
            .rfind(|(letter, _)| {
                let (a, n) = self.letters[*letter as usize];
                a == action && n <= number
            })
            .map(|t| t.1)
    }

    /// The letter of a step, where it is one.
    #[must_use]
    pub fn letter_of(&self, state: StateIx, action: ActionId, successor: StateIx) -> Option<Letter> {
        self.successors(state)
            .iter()
            .find(|(letter, next)| *next == successor && self.letters[*letter as usize].0 == action)
            .map(|t| t.0)
    }

    /// Whether a state has a transition with that action, live or not.
    #[must_use]
    pub fn enables(&self, state: StateIx, action: ActionId) -> bool {
        self.successors(state).iter().any(|(letter, _)| self.letters[*letter as usize].0 == action)
    }

    /// Whether every transition of a state leads back to it; so too where there is none.
    #[must_use]
    pub fn halts(&self, state: StateIx) -> bool {
        self.successors(state).iter().all(|&(_, next)| next == state)
    }

    /// Whether every state is live.
    #[must_use]
    pub fn all_live(&self) -> bool {
        self.rank.iter().all(|&r| r == LIVE)
    }
}

/// Systems that were enumerated, for objectives over equal ones.
#[derive(Debug, Default)]
pub struct Graphs {
    known: RefCell<Vec<Explored>>,
}

/// A system, the budget, and what came of it.
type Explored = (System, usize, Option<Rc<Graph>>);

impl Graphs {
    /// As [`Graph::explore`], but an equal system with the same budget is not enumerated again; `None` beyond the
    /// budget.
    #[must_use]
    pub fn explore(&self, system: &System, budget: usize) -> Option<Rc<Graph>> {
        let mut known = self.known.borrow_mut();
        if let Some((_, _, graph)) = known.iter().find(|(s, b, _)| *b == budget && s == system) {
            return graph.clone();
        }
        let graph = Graph::explore(system, budget).ok().map(Rc::new);
        known.push((system.clone(), budget, graph.clone()));
        graph
    }
}

/// Packs a state into one integer, mixed radix.
struct Packing {
    /// Least code and number of codes of each variable.
    radix: Vec<(i64, u128)>,
}

impl Packing {
    fn new(system: &System) -> Option<Packing> {
        let radix: Vec<(i64, u128)> = system
            .vars
            .iter()
            .map(|var| {
                let (lo, hi) = bounds(&var.ty)?;
                Some((lo, (hi - lo) as u128 + 1))
            })
            .collect::<Option<_>>()?;
        radix.iter().try_fold(1u128, |product, (_, n)| product.checked_mul(*n))?;
        Some(Packing { radix })
    }

    /// `None` where a value is outside its type.
    fn pack(&self, row: &[i64]) -> Option<u128> {
        let mut packed = 0u128;
        for (&value, &(lo, n)) in row.iter().zip(&self.radix) {
            let digit = u128::try_from(value.checked_sub(lo)?).ok().filter(|d| *d < n)?;
            packed = packed * n + digit;
        }
        Some(packed)
    }
}

struct Explorer<'a> {
    system: &'a System,
    budget: usize,
    packing: Packing,
    width: usize,
    rows: Vec<i64>,
    index: FxHashMap<u128, StateIx>,
    /// The position of each action in the system.
    positions: FxHashMap<ActionId, u32>,
}

/// Transitions as found: action's position in the system, successor.
type Edges = Vec<(u32, StateIx)>;

impl Explorer<'_> {
    /// The index of a state, new or known; `None` where it is outside the types.
    fn intern(&mut self, row: &[i64]) -> Result<Option<StateIx>, TooLarge> {
        let Some(packed) = self.packing.pack(row) else { return Ok(None) };
        let next = self.index.len();
        if let Some(&known) = self.index.get(&packed) {
            return Ok(Some(known));
        }
        if next >= self.budget {
            return Err(TooLarge);
        }
        let id = next as StateIx;
        self.index.insert(packed, id);
        self.rows.extend_from_slice(row);
        Ok(Some(id))
    }

    /// Every assignment that satisfies `init`, variable by variable; each conjunct is tested as soon as the
    /// variables that it reads are assigned.
    fn initial_states(&mut self) -> Result<Vec<StateIx>, TooLarge> {
        let system = self.system;
        let mut tests: Vec<Vec<&Expr<Leaf>>> = vec![Vec::new(); self.width + 1];
        for conjunct in conjuncts(&system.init) {
            tests[variables_needed(system, conjunct)].push(conjunct);
        }
        let mut initial = Vec::new();
        if tests[0].iter().any(|e| eval_in(system, e, &[]) == 0) {
            return Ok(initial);
        }
        let types: Vec<(i64, i64)> = system.vars.iter().filter_map(|v| bounds(&v.ty)).collect();
        let mut row: Vec<i64> = Vec::with_capacity(self.width);
        let mut visited = 0usize;
        // Depth-first over prefixes; `row` holds the current prefix.
        loop {
            if row.len() == self.width {
                initial.extend(self.intern(&row)?);
            } else {
                row.push(types[row.len()].0);
                visited += 1;
                if tests[row.len()].iter().all(|e| eval_in(system, e, &row) != 0) {
                    continue;
                }
            }
            loop {
                let Some(last) = row.pop() else { return Ok(initial) };
                if last < types[row.len()].1 {
                    row.push(last + 1);
                    visited += 1;
                    if visited > self.budget.saturating_mul(16) {
                        return Err(TooLarge);
                    }
                    if tests[row.len()].iter().all(|e| eval_in(system, e, &row) != 0) {
                        break;
                    }
                }
            }
        }
    }

    /// Breadth first from the states interned so far.
    fn edges(&mut self) -> Result<(Vec<u32>, Edges), TooLarge> {
        let mut starts = vec![0u32];
        let mut edges: Edges = Vec::new();
        let mut found = Vec::new();
        let mut at = 0usize;
        while at < self.index.len() {
            let row = self.rows[at * self.width..(at + 1) * self.width].to_vec();
            found.clear();
            self.successors(&row, &mut found)?;
            found.sort_unstable();
            found.dedup();
            edges.extend_from_slice(&found);
            if edges.len() > self.budget.saturating_mul(16) {
                return Err(TooLarge);
            }
            starts.push(edges.len() as u32);
            at += 1;
        }
        Ok((starts, edges))
    }

    fn successors(&mut self, row: &[i64], found: &mut Edges) -> Result<(), TooLarge> {
        let system = self.system;
        if eval_in(system, &system.absorb, row) != 0 {
            if let Some(here) = self.intern(row)? {
                found.extend((0..system.actions.len() as u32).map(|a| (a, here)));
            }
            return Ok(());
        }
        for clause in &system.clauses {
            if eval_in(system, &clause.guard, row) == 0 {
                continue;
            }
            for next in outcomes(system, clause, row, self.budget)? {
                if let Some(next) = self.intern(&next)? {
                    found.extend(action_positions(system, clause).map(|a| (a, next)));
                }
            }
        }
        self.listed(row, found)
    }

    /// The transitions that the system lists one by one.
    fn listed(&mut self, row: &[i64], found: &mut Edges) -> Result<(), TooLarge> {
        let Some(edges) = &self.system.edges else { return Ok(()) };
        let at = usize::from(edges.var);
        let mut next = row.to_vec();
        for edge in edges.of(u32::try_from(row[at]).unwrap_or(u32::MAX)) {
            next[at] = i64::from(edge.to);
            if let (Some(next), Some(&action)) = (self.intern(&next)?, self.positions.get(&edge.action)) {
                found.push((action, next));
            }
        }
        Ok(())
    }
}

/// The rows that a clause's updates allow, in or out of range.
pub(crate) fn outcomes(
    system: &System,
    clause: &Clause,
    row: &[i64],
    budget: usize,
) -> Result<Vec<Vec<i64>>, TooLarge> {
    let mut all = vec![row.to_vec()];
    for (var, update) in &clause.updates {
        let values = update_values(system, *var, update, row);
        if values.len().saturating_mul(all.len()) > budget {
            return Err(TooLarge);
        }
        all = all
            .iter()
            .flat_map(|done| {
                values.iter().map(|&value| {
                    let mut next = done.clone();
                    next[usize::from(*var)] = value;
                    next
                })
            })
            .collect();
    }
    Ok(all)
}

/// The least and greatest values that an update gives, whatever the variable's type.
pub(crate) fn update_values_unclipped(system: &System, update: &Update, row: &[i64]) -> Vec<i64> {
    match update {
        Update::Assign(e) => vec![eval_in(system, e, row)],
        Update::OneOf(es) => es.iter().map(|e| eval_in(system, e, row)).collect(),
        Update::Within(lo, hi) => vec![eval_in(system, lo, row), eval_in(system, hi, row)],
    }
}

/// The values that an update allows; those outside the variable's type may be left out.
fn update_values(system: &System, var: VarId, update: &Update, row: &[i64]) -> Vec<i64> {
    match update {
        Update::Assign(_) | Update::OneOf(_) => update_values_unclipped(system, update, row),
        Update::Within(lo, hi) => {
            let (lo, hi) = (eval_in(system, lo, row), eval_in(system, hi, row));
            let (least, greatest) = bounds(&system.vars[var].ty).unwrap_or((lo, hi));
            (lo.max(least)..=hi.min(greatest)).collect()
        }
    }
}

fn action_positions<'a>(system: &'a System, clause: &'a Clause) -> impl Iterator<Item = u32> + 'a {
    (0u32..).zip(&system.actions).filter(|(_, a)| clause.actions.contains(a)).map(|(at, _)| at)
}

/// The parts of a conjunction.
fn conjuncts(expr: &Expr<Leaf>) -> Vec<&Expr<Leaf>> {
    match expr {
        Expr::And(es) => es.iter().flat_map(conjuncts).collect(),
        other => vec![other],
    }
}

/// How many variables, in order of declaration, must be assigned before the expression has a value.
fn variables_needed(system: &System, expr: &Expr<Leaf>) -> usize {
    let mut needed = 0;
    expr.for_each_leaf(&mut |leaf| {
        needed = needed.max(match *leaf {
            Leaf::Var(v) => usize::from(v) + 1,
            Leaf::Label(l) => variables_needed(system, &system.labels[l].expr),
        });
    });
    needed
}

type Letters = Vec<(ActionId, u32)>;
type Transitions = Vec<(Letter, StateIx)>;

/// Turns (action, successor) pairs into letters.
fn number_letters(system: &System, starts: &[u32], edges: &Edges) -> (Letters, Transitions) {
    let mut most = vec![0u32; system.actions.len()];
    // The edges of a state are sorted, so those of an action are neighbours; graphs may have as many actions as
    // states, and no state is made to look at all of them.
    let states = || starts.windows(2).map(|w| &edges[w[0] as usize..w[1] as usize]);
    for same in states().flat_map(|edges| edges.chunk_by(|a, b| a.0 == b.0)) {
        let most = &mut most[same[0].0 as usize];
        *most = (*most).max(same.len() as u32);
    }
    let mut first = Vec::new();
    let mut letters = Vec::new();
    for (at, &action) in system.actions.iter().enumerate() {
        first.push(letters.len() as Letter);
        letters.extend((0..most[at]).map(|n| (action, n)));
    }
    let mut transitions = Vec::with_capacity(edges.len());
    for same in states().flat_map(|edges| edges.chunk_by(|a, b| a.0 == b.0)) {
        let numbered = (first[same[0].0 as usize]..).zip(same);
        transitions.extend(numbered.map(|(letter, &(_, next))| (letter, next)));
    }
    (letters, transitions)
}

/// The longest path from each state: states are peeled off once all their successors are.
fn ranks(starts: &[u32], transitions: &[(Letter, StateIx)]) -> Vec<u32> {
    let states = starts.len() - 1;
    let mut rank = vec![LIVE; states];
    let mut left: Vec<u32> = starts.windows(2).map(|w| w[1] - w[0]).collect();
    let mut queue: VecDeque<StateIx> = (0..states as StateIx).filter(|&s| left[s as usize] == 0).collect();
    if queue.is_empty() {
        return rank;
    }
    let predecessors = predecessors(starts, transitions);
    let mut longest = vec![0u32; states];
    while let Some(state) = queue.pop_front() {
        let own = longest[state as usize];
        rank[state as usize] = own;
        for &before in predecessors.of(state) {
            longest[before as usize] = longest[before as usize].max(own + 1);
            left[before as usize] -= 1;
            if left[before as usize] == 0 {
                queue.push_back(before);
            }
        }
    }
    rank
}

/// Who leads to each state, once per transition.
struct Predecessors {
    starts: Vec<u32>,
    states: Vec<StateIx>,
}

impl Predecessors {
    fn of(&self, state: StateIx) -> &[StateIx] {
        let at = state as usize;
        &self.states[self.starts[at] as usize..self.starts[at + 1] as usize]
    }
}

fn predecessors(starts: &[u32], transitions: &[(Letter, StateIx)]) -> Predecessors {
    let count = starts.len() - 1;
    let mut ends = vec![0u32; count + 1];
    for &(_, next) in transitions {
        ends[next as usize + 1] += 1;
    }
    for at in 0..count {
        ends[at + 1] += ends[at];
    }
    let result_starts = ends.clone();
    let mut states = vec![0; transitions.len()];
    for state in 0..count {
        for &(_, next) in &transitions[starts[state] as usize..starts[state + 1] as usize] {
            let slot = &mut ends[next as usize];
            states[*slot as usize] = state as StateIx;
            *slot += 1;
        }
    }
    Predecessors { starts: result_starts, states }
}
