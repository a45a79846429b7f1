//! All runs of a universally quantified path at once.
//!
//! Where one path is left to the other player, its runs need not be told apart: what matters is which pairs of a
//! state and a residual of that player's goal *some* run can be in. These pairs are explored as layers are,
//! but what depends on the other paths is left to the solver: a move to a pair that happens only if another path
//! does this or that becomes a clause, "if the pair before may be, and the condition holds, the pair after may be".
//! A pair that has met the goal may not be. Under any choice of the other paths the least solution of these Horn
//! clauses is exactly the set of pairs that runs can be in, so they are satisfiable exactly by the choices that no
//! run defeats. There is one copy of the path's states for each residual, instead of one for each counterexample,
//! and unit propagation alone follows all runs.
//!
//! Where the only other path is tied to this one, a [`Game`] knows from which pairs which moves of that path lose.
//! They are ruled out before they are made, and runs are followed only where there is such a choice ahead.

use super::EnumeratedQuery;
use super::path::EnumeratedPath;
use super::run::OnRun;
use crate::names::Names;
use crate::value::translate;
use crate::writing::Env;
use hyperplan_problem::{ActionId, Expr, FormulaId, Node, PathId, PathLeaf};
use hyperplan_relevance::{
    FALSE, Game, Goal, Layers, MAX_ATOMS, MAX_RESIDUALS, Now, Pair, Residual, Residuals, TRUE, Task,
};
use hyperplan_smt::{Script, Sort, Term};
use hyperplan_space::{Graph, StateIx, eval};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// More conditions than this on one move are left to other methods: each doubles the clauses.
const MAX_CONDITIONS: usize = 3;

/// What a sweep is about.
pub(super) struct Sweep<'s, 'a> {
    pub(crate) task: &'s Task<'a>,
    pub(crate) graph: &'s Graph,
    pub(crate) names: &'s Names<'a>,
    pub(crate) path: PathId,
    /// What can matter of the path.
    pub(crate) layers: &'s Layers,
    /// What its player wants.
    pub(crate) goal: &'s Goal,
    /// The paths before it.
    pub(crate) env: &'s Env,
    /// The game of the path with the only other one, and that one's terms.
    pub(crate) game: Option<(&'s Game, &'s EnumeratedPath)>,
}

/// The pairs of one time with the terms that say that a run may be in them.
type Frontier = BTreeMap<Pair, Term>;

/// A way to reach a pair: all of these hold.
type Cube = Vec<Term>;

/// Demands that no run of the path meets its player's goal; `None` where that would take too much, and then nothing
/// of use has been demanded (though what has been is harmless).
pub(super) fn sweep(
    sweep: &Sweep<'_, '_>,
    query: &mut EnumeratedQuery<'_, '_>,
    script: &mut Script,
) -> Option<()> {
    let mut runs = Runs::new(sweep, query)?;
    let path = &sweep.names.path;
    let mut frontier = Frontier::new();
    let mut ways: BTreeMap<Pair, Vec<Cube>> = BTreeMap::new();
    for &state in &sweep.layers.at[0] {
        runs.enter(script, runs.root, state, None, 0, &[], &mut ways)?;
    }
    let mut total = 0;
    for time in 0..=runs.horizon {
        let text = format!("no run of path {path} defeats the others: time {time}");
        script.section(format!("runs.{path}.{time}"), text);
        runs.keep_open(time, &mut ways);
        runs.settle(script, time, std::mem::take(&mut ways), &mut frontier);
        runs.avoid_losing_moves(script, time, &frontier);
        total += frontier.len();
        if total > sweep.task.limits.swept || runs.residuals.count() > sweep.task.limits.residuals {
            return None;
        }
        let residuals: Vec<Residual> = frontier.keys().map(|pair| pair.0).collect();
        if residuals.chunk_by(|a, b| a == b).count() > MAX_RESIDUALS {
            return None;
        }
        if (sweep.task.stop)() {
            return None;
        }
        if time < runs.horizon {
            runs.advance(script, time + 1, &frontier, &mut ways)?;
        }
    }
    // In bounded mode what is left now reads no path any more.
    for (&(residual, _), &term) in &frontier {
        if runs.outcome(residual)? {
            script.assert(!term);
        }
    }
    Some(())
}

struct Runs<'s, 'e, 'a> {
    sweep: &'s Sweep<'s, 's>,
    query: &'s mut EnumeratedQuery<'e, 'a>,
    residuals: Residuals,
    root: Residual,
    /// The last time that any path is read at.
    horizon: u32,
    atoms: Vec<Atom<'s>>,
    /// Terms of atoms, by atom, time, and what they read of the run.
    terms: FxHashMap<(usize, u32, Option<StateIx>, Option<ActionId>), Term>,
}

struct Atom<'s> {
    expr: &'s Expr<PathLeaf>,
    reads_state: bool,
    reads_action: bool,
    reads_others: bool,
}

impl<'s, 'e, 'a> Runs<'s, 'e, 'a> {
    fn new(sweep: &'s Sweep<'s, 's>, query: &'s mut EnumeratedQuery<'e, 'a>) -> Option<Self> {
        let formula = &sweep.task.objective.formula;
        let mut atoms = Vec::new();
        let mut bits: FxHashMap<FormulaId, u8> = FxHashMap::default();
        for (id, node) in formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            if atoms.len() >= MAX_ATOMS {
                return None;
            }
            bits.insert(id, atoms.len() as u8);
            atoms.push(Atom::new(expr, sweep.path));
        }
        let (fresh, root) = Residuals::new(formula, sweep.goal, &|id| bits.get(&id).copied());
        // The game has numbered the same atoms alike, and its pairs are told by its residuals.
        let residuals = sweep.game.map_or(fresh, |(game, _)| game.residuals.clone());
        let horizon = sweep.task.end();
        Some(Runs { sweep, query, residuals, root, horizon, atoms, terms: FxHashMap::default() })
    }

    /// Drops the pairs that the game leaves nothing to be decided about: [`Runs::avoid_losing_moves`] keeps runs out of
    /// them, or they lead to no harm.
    fn keep_open(&self, time: u32, ways: &mut BTreeMap<Pair, Vec<Cube>>) {
        if let Some((game, _)) = self.sweep.game {
            let open = game.pairs(time);
            ways.retain(|pair, _| open.contains(pair));
        }
    }

    /// Rules out the moves of the leading path after which a run that may be in a pair of the frontier wins.
    fn avoid_losing_moves(&self, script: &mut Script, time: u32, frontier: &Frontier) {
        let Some((game, path)) = self.sweep.game else { return };
        for losing in game.losing_moves(time) {
            let pair = losing.pair.and_then(|pair| frontier.get(&pair).copied());
            if let Some(pair) = pair {
                script.clause(&path.avoids(&losing, time as usize, Some(pair)));
            }
        }
    }

    /// The pairs of a time become terms: a single condition stands for itself, several make a symbol.
    fn settle(
        &self,
        script: &mut Script,
        time: u32,
        ways: BTreeMap<Pair, Vec<Cube>>,
        frontier: &mut Frontier,
    ) {
        frontier.clear();
        for ((residual, state), mut ways) in ways {
            ways.sort_unstable();
            ways.dedup();
            let term = match ways.as_slice() {
                ways if ways.iter().any(Vec::is_empty) => Term::TRUE,
                [way] if way.len() == 1 => way[0],
                ways => {
                    let name = self.sweep.names.pair(self.sweep.graph, state, residual);
                    let stem = script.terms.stem(&name);
                    let term = script.terms.symbol(stem, Some(time), Sort::Bool);
                    for way in ways {
                        let clause: Vec<Term> = way.iter().map(|&t| !t).chain([term]).collect();
                        script.clause(&clause);
                    }
                    term
                }
            };
            if residual == TRUE {
                // The run can go on as it must, so it defeats the others already.
                script.assert(!term);
            } else if term != Term::FALSE {
                frontier.insert((residual, state), term);
            }
        }
    }

    fn advance(
        &mut self,
        script: &mut Script,
        time: u32,
        frontier: &Frontier,
        ways: &mut BTreeMap<Pair, Vec<Cube>>,
    ) -> Option<()> {
        let graph = self.sweep.graph;
        let own_horizon = self.sweep.task.horizon(self.sweep.path);
        for (&(residual, state), &term) in frontier {
            if time > own_horizon {
                // The path is not read any more.
                self.enter(script, residual, state, None, time, &[term], ways)?;
                continue;
            }
            for &(letter, next) in graph.successors(state) {
                if self.sweep.layers.contains(time as usize, next) {
                    let action = graph.letters[letter as usize].0;
                    self.enter(script, residual, next, Some(action), time, &[term], ways)?;
                }
            }
        }
        Some(())
    }

    /// Where a run may be after it enters a state, under each condition on the other paths that makes a difference.
    #[allow(clippy::too_many_arguments)]
    fn enter(
        &mut self,
        script: &mut Script,
        before: Residual,
        state: StateIx,
        action: Option<ActionId>,
        time: u32,
        given: &[Term],
        ways: &mut BTreeMap<Pair, Vec<Cube>>,
    ) -> Option<()> {
        let mut bits = 0u64;
        let mut open: Vec<(usize, Term)> = Vec::new();
        for at in 0..self.atoms.len() {
            match self.value(script, at, state, action, time) {
                Term::TRUE => bits |= 1 << at,
                Term::FALSE => {}
                term => open.push((at, term)),
            }
        }
        let last = self.sweep.task.is_last(time);
        // Atoms that what is left does not look at make no difference.
        let relevant = self.residuals.looks_at(before);
        open.retain(|&(at, _)| relevant >> at & 1 == 1);
        if open.len() > MAX_CONDITIONS {
            return None;
        }
        for choice in 0..1u64 << open.len() {
            let (mut bits, mut way) = (bits, given.to_vec());
            for (position, &(at, term)) in open.iter().enumerate() {
                let holds = choice >> position & 1 == 1;
                bits |= u64::from(holds) << at;
                way.push(term.negate_if(!holds));
            }
            let after = self.residuals.progress(before, Now { bits, unknown: 0, last });
            if after != FALSE {
                way.retain(|&t| t != Term::TRUE);
                way.sort_unstable();
                way.dedup();
                ways.entry((after, state)).or_default().push(way);
            }
        }
        Some(())
    }

    /// An atom where the run is in a state after an action.
    fn value(
        &mut self,
        script: &mut Script,
        at: usize,
        state: StateIx,
        action: Option<ActionId>,
        time: u32,
    ) -> Term {
        let atom = &self.atoms[at];
        let time_key = if atom.reads_others || atom.reads_action { time } else { u32::MAX };
        let key = (at, time_key, atom.reads_state.then_some(state), action.filter(|_| atom.reads_action));
        if let Some(&known) = self.terms.get(&key) {
            return known;
        }
        let sweep = self.sweep;
        let mut leaves = OnRun {
            query: self.query,
            task: sweep.task,
            env: sweep.env,
            path: sweep.path,
            graph: sweep.graph,
            state,
            action,
            time,
        };
        let term = translate(&mut script.terms, atom.expr, &mut leaves).truth();
        self.terms.insert(key, term);
        term
    }

    /// What a residual that reads no path comes to.
    fn outcome(&mut self, residual: Residual) -> Option<bool> {
        let mut bits = 0u64;
        for (at, atom) in self.atoms.iter().enumerate() {
            if !atom.reads_state && !atom.reads_action && !atom.reads_others {
                bits |= u64::from(eval(atom.expr, &mut |_| 0) != 0) << at;
            }
        }
        let mut residual = residual;
        for _ in 0..=self.sweep.task.limits.horizon {
            match residual {
                TRUE => return Some(true),
                FALSE => return Some(false),
                _ => residual = self.residuals.progress(residual, Now { bits, unknown: 0, last: false }),
            }
        }
        None
    }
}

impl<'s> Atom<'s> {
    fn new(expr: &'s Expr<PathLeaf>, path: PathId) -> Self {
        let mut atom = Atom { expr, reads_state: false, reads_action: false, reads_others: false };
        expr.for_each_leaf(&mut |leaf| {
            for p in leaf.paths().into_iter().flatten() {
                match leaf {
                    _ if p != path => atom.reads_others = true,
                    PathLeaf::Took(..) | PathLeaf::SameAction(..) => atom.reads_action = true,
                    PathLeaf::State(..)
                    | PathLeaf::SameState(..)
                    | PathLeaf::Enabled(..)
                    | PathLeaf::Halted(_) => atom.reads_state = true,
                }
            }
        });
        atom
    }
}
