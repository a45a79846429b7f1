//! Enumerating the reachable states of a system, breadth first from its initial ones.

use crate::also::{Updates, applicable, applied, no_number};
use crate::eval::bounds;
use crate::graph::{EDGES, Graph, LIVE, Letter, StateIx, TooLarge, sources};
use crate::index::Met;
use crate::row::{Row, Rows};
use crate::step::{Steps, conjuncts, variables_read};
use hyperplan_problem::{ActionId, Also, Clause, Expr, Leaf, System, Update, Value, VarId};
use rustc_hash::FxHashMap;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

impl Graph {
    /// Enumerates a system, unless it has more than `budget` reachable states (or as many transitions times 16).
    ///
    /// # Errors
    /// [`TooLarge`] beyond the budget, or where the initial states cannot be enumerated within it.
    pub fn explore(system: &System, budget: usize) -> Result<Graph, TooLarge> {
        if is_too_wide(system, budget) {
            return Err(TooLarge);
        }
        let mut explorer = Explorer {
            system,
            budget,
            met: Met::new(system, budget)?,
            here: Row::new(system),
            next: Rows::default(),
            steps: Steps::new(system),
            also: FxHashMap::default(),
            positions: (0u32..).zip(&system.actions).map(|(at, action)| (*action, at)).collect(),
        };
        let initial = explorer.initial_states()?;
        let (starts, edges) = explorer.edges()?;
        let (width, codes) = (system.vars.len(), explorer.met.codes);
        let (letters, transitions) = number_letters(system, &starts, &edges);
        let rank = ranks(&starts, &transitions);
        let labels = vec![OnceLock::new(); system.labels.len()];
        Ok(Graph { width, codes, initial, letters, starts, transitions, rank, labels })
    }
}

/// Whether it is plain without looking that there are too many transitions: a clause that is enabled everywhere leads to
/// as many states as it has outcomes, and from each of them to as many.
fn is_too_wide(system: &System, budget: usize) -> bool {
    let width = |(var, update): &(VarId, Update)| match update {
        Update::Within(Expr::Const(Value::Int(lo)), Expr::Const(Value::Int(hi))) => {
            let (least, most) = bounds(&system.vars[*var].ty).unwrap_or((*lo, *hi));
            ((*hi).min(most) as i128 - (*lo).max(least) as i128 + 1).max(0) as u128
        }
        _ => 1,
    };
    let outcomes = |clause: &Clause| clause.updates.iter().map(width).fold(1u128, u128::saturating_mul);
    let everywhere = system.clauses.iter().filter(|clause| clause.guard.is_true());
    let most = everywhere.map(outcomes).max().unwrap_or(0);
    system.absorb.is_false()
        && system.trans.is_true()
        && most.saturating_mul(most) > budget.saturating_mul(EDGES) as u128
}

/// Systems that were enumerated, for objectives over equal ones: the last few. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Graphs {
    known: Arc<Mutex<VecDeque<Explored>>>,
}

/// How many are kept: more than the systems of most problems, and so few that what is gone does not fill the memory.
const KEPT: usize = 8;

/// A system, the budget, and what came of it.
type Explored = (System, usize, Option<Arc<Graph>>);

impl Graphs {
    /// As [`Graph::explore`], but a system with the same budget that is equal but for its costs is not enumerated again; `None`
    /// beyond the budget.
    #[must_use]
    pub fn explore(&self, system: &System, budget: usize) -> Option<Arc<Graph>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let tells = |(other, spent, graph): &&Explored| {
            (*spent == budget || graph.is_some()) && other.equals_but_for_costs(system)
        };
        if let Some((_, _, graph)) = known.iter().find(tells) {
            return graph.clone().filter(|graph| graph.fits(budget));
        }
        let graph = Graph::explore(system, budget).ok().map(Arc::new);
        known.truncate(KEPT - 1);
        known.push_front((system.clone(), budget, graph.clone()));
        graph
    }
}

struct Explorer<'a> {
    system: &'a System,
    budget: usize,
    met: Met,
    /// The state whose transitions are being found, and where some lead.
    here: Row<'a>,
    next: Rows,
    steps: Steps<'a>,
    /// What transitions with an action do besides, by its position, where it is the same for all.
    also: FxHashMap<u32, Vec<(&'a Also, Updates)>>,
    /// The position of each action in the system.
    positions: FxHashMap<ActionId, u32>,
}

/// Transitions as found: action's position in the system, successor.
type Edges = Vec<(u32, StateIx)>;

impl Explorer<'_> {
    /// Every assignment that satisfies `init`, variable by variable; each conjunct is tested as soon as the
    /// variables that it reads are assigned.
    fn initial_states(&mut self) -> Result<Vec<StateIx>, TooLarge> {
        let system = self.system;
        let width = system.vars.len();
        let mut tests: Vec<Vec<&Expr<Leaf>>> = vec![Vec::new(); width + 1];
        for conjunct in conjuncts(&system.init) {
            tests[variables_needed(system, conjunct)].push(conjunct);
        }
        let mut initial = Vec::new();
        let row = &mut self.here;
        let mut fits = |codes: &[i64]| {
            let tests = &tests[codes.len()];
            if !tests.is_empty() {
                row.turn(codes);
            }
            tests.iter().all(|e| row.holds(e))
        };
        if !fits(&[]) {
            return Ok(initial);
        }
        let types: Vec<(i64, i64)> = system.vars.iter().filter_map(|v| bounds(&v.ty)).collect();
        let mut codes: Vec<i64> = Vec::with_capacity(width);
        let mut visited = 0usize;
        // Depth-first over prefixes; `codes` holds the current prefix.
        loop {
            if codes.len() == width {
                initial.extend(self.met.meet(&codes)?);
            } else {
                codes.push(types[codes.len()].0);
                visited += 1;
                if fits(&codes) {
                    continue;
                }
            }
            loop {
                let Some(last) = codes.pop() else { return Ok(initial) };
                if last < types[codes.len()].1 {
                    codes.push(last + 1);
                    visited += 1;
                    if visited > self.budget.saturating_mul(16) {
                        return Err(TooLarge);
                    }
                    if fits(&codes) {
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
        while at < self.met.len() {
            self.here.turn(self.met.codes(at));
            found.clear();
            self.successors(at as StateIx, &mut found)?;
            found.sort_unstable();
            found.dedup();
            edges.extend_from_slice(&found);
            if edges.len() > self.budget.saturating_mul(EDGES) {
                return Err(TooLarge);
            }
            starts.push(edges.len() as u32);
            at += 1;
        }
        Ok((starts, edges))
    }

    fn successors(&mut self, state: StateIx, found: &mut Edges) -> Result<(), TooLarge> {
        let system = self.system;
        if self.here.holds(&system.absorb) {
            found.extend((0..system.actions.len() as u32).map(|a| (a, state)));
            return Ok(());
        }
        for clause in &system.clauses {
            if !self.here.holds(&clause.guard) {
                continue;
            }
            if system.also.is_empty() {
                self.steps.outcomes(clause.updates.iter(), &self.here, self.budget, &mut self.next)?;
                for next in self.next.iter() {
                    if let Some(next) = self.met.meet(next)? {
                        found.extend(action_positions(system, clause).map(|a| (a, next)));
                    }
                }
                continue;
            }
            for at in action_positions(system, clause) {
                let besides = self.besides(at, None);
                self.step(at, clause.updates.iter().chain(&besides), found)?;
            }
        }
        self.listed(found)
    }

    /// The transitions of an action that make these updates.
    fn step<'u>(
        &mut self,
        action: u32,
        updates: impl Iterator<Item = &'u (VarId, Update)> + Clone,
        found: &mut Edges,
    ) -> Result<(), TooLarge> {
        self.steps.outcomes(updates, &self.here, self.budget, &mut self.next)?;
        for next in self.next.iter() {
            found.extend(self.met.meet(next)?.map(|next| (action, next)));
        }
        Ok(())
    }

    /// What a transition does besides in a state, one with that action that follows this edge.
    fn besides(&mut self, action: u32, edge: Option<usize>) -> Updates {
        let system = self.system;
        let edges = system.edges.as_ref().filter(|edges| !edges.attributes().is_empty()).zip(edge);
        let number = |attribute| match edges {
            None => no_number(attribute),
            Some((edges, at)) => Expr::Const(Value::Int(edges.number(at, attribute))),
        };
        let find = || applicable(system, system.actions[action as usize], &number);
        let found;
        let all = match edges {
            // Numbers differ from edge to edge.
            Some(_) => {
                found = find();
                &found
            }
            None => self.also.entry(action).or_insert_with(find),
        };
        applied(all, &self.here).cloned().collect()
    }

    /// The transitions that the system lists one by one.
    fn listed(&mut self, found: &mut Edges) -> Result<(), TooLarge> {
        let Some(edges) = &self.system.edges else { return Ok(()) };
        let here = u32::try_from(self.here.leaf(Leaf::Var(edges.var))).unwrap_or(u32::MAX);
        for (at, edge) in edges.numbered(here) {
            let Some(&action) = self.positions.get(&edge.action) else { continue };
            let also = !self.system.also.is_empty();
            let mut updates = if also { self.besides(action, Some(at)) } else { Updates::new() };
            updates.push((edges.var, Update::Assign(Expr::Const(Value::Enum(edge.to)))));
            self.step(action, updates.iter(), found)?;
        }
        Ok(())
    }
}

fn action_positions<'a>(system: &'a System, clause: &'a Clause) -> impl Iterator<Item = u32> + 'a {
    (0u32..).zip(&system.actions).filter(|(_, a)| clause.actions.contains(a)).map(|(at, _)| at)
}

/// How many variables, in order of declaration, must be assigned before the expression has a value.
fn variables_needed(system: &System, expr: &Expr<Leaf>) -> usize {
    variables_read(system, expr, &|leaf| Some(*leaf)).last().map_or(0, |var| usize::from(*var) + 1)
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
    let mut left: Vec<u32> = starts.windows(2).map(|w| w[1] - w[0]).collect();
    let mut rank = vec![LIVE; left.len()];
    let mut queue: Vec<StateIx> = (0..left.len() as StateIx).filter(|&s| left[s as usize] == 0).collect();
    if queue.is_empty() {
        return rank;
    }
    let of = |state: StateIx| starts[state as usize] as usize..starts[state as usize + 1] as usize;
    let edges = (0..left.len() as StateIx)
        .flat_map(|from| transitions[of(from)].iter().map(move |&(_, to)| (from, to)));
    let (ends, before) = sources(left.len(), edges);
    let mut longest = vec![0u32; left.len()];
    let mut next = 0;
    while let Some(&state) = queue.get(next) {
        next += 1;
        let (state, own) = (state as usize, longest[state as usize]);
        rank[state] = own;
        for &before in &before[ends[state] as usize..ends[state + 1] as usize] {
            let at = before as usize;
            longest[at] = longest[at].max(own + 1);
            left[at] -= 1;
            if left[at] == 0 {
                queue.push(before);
            }
        }
    }
    rank
}
