//! What a search has, and where it is.

use crate::atoms::{Atom, translate};
use crate::graph::{Graph, StateId};
use crate::horizon::horizon;
use crate::level::{Level, levels};
use crate::progress::Progress;
use crate::recent::Recent;
use crate::report::{Budget, Error, Reached, Stop};
use crate::residual::{AtomId, Residual, ResidualId, Residuals};
use crate::valuation::{ValuationId, Valuations};
use crate::value::{Sets, ValueId};
use hyperplan_problem::{ActionId, Mode, Objective, PathId, Problem, SystemId};
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

/// A trace whose states are interned.
#[derive(Debug)]
pub(crate) struct Fixed {
    pub(crate) path: PathId,
    pub(crate) states: Vec<StateId>,
    pub(crate) actions: Vec<ActionId>,
}

/// All that a search needs.
#[derive(Debug)]
pub(crate) struct Search<'p> {
    pub(crate) graphs: TiVec<SystemId, Graph<'p>>,
    pub(crate) levels: Vec<Level>,
    pub(crate) fixed: Vec<Fixed>,
    pub(crate) fixed_atoms: Vec<AtomId>,
    pub(crate) atoms: TiVec<AtomId, Atom>,
    pub(crate) residuals: Residuals,
    pub(crate) root: ResidualId,
    /// Whether a residual reads paths of the innermost block, as far as it was asked.
    pub(crate) reads_innermost: TiVec<ResidualId, bool>,
    pub(crate) progress: Progress,
    pub(crate) valuations: Valuations,
    pub(crate) recent: Recent,
    /// By time, the values of residuals that read given traces only.
    pub(crate) given: FxHashMap<(u32, ResidualId), ResidualId>,
    pub(crate) systems: TiVec<PathId, SystemId>,
    pub(crate) mode: Mode,
    /// Where paths of systems with infinitely many states end, where there is no `within`: at their horizon.
    pub(crate) ends: TiVec<PathId, Option<u64>>,
    pub(crate) reads_enabled: bool,
    pub(crate) time: u32,
    /// Where each path is, and what it just did; no state where its trace has ended.
    pub(crate) states: TiVec<PathId, Option<StateId>>,
    pub(crate) took: TiVec<PathId, Option<ActionId>>,
    pub(crate) before: Sets,
    pub(crate) now: Sets,
    pub(crate) memo: FxHashMap<Box<[u32]>, ValueId>,
    pub(crate) budget: Budget,
    pub(crate) reached: Reached,
}

impl<'p> Search<'p> {
    /// A search in which the first `fixed` path variables are given by traces, still to be set.
    pub(crate) fn new(
        problem: &'p Problem,
        objective: &'p Objective,
        fixed: usize,
        budget: &Budget,
    ) -> Result<Self, Stop> {
        if objective.paths.iter().any(|p| problem.systems.get(p.system).is_none()) {
            return Err(Error::Malformed { what: "a path variable has no system" }.into());
        }
        let mut residuals = Residuals::new(objective.mode);
        let (root, atoms) = translate(objective, &mut residuals)?;
        if atoms.iter().any(|a| a.paths.iter().any(|&p| objective.paths.get(p).is_none())) {
            return Err(Error::Malformed { what: "an atom reads an unknown path" }.into());
        }
        let limit = usize::try_from(budget.states).unwrap_or(usize::MAX);
        let levels = levels(objective, fixed, &atoms, limit)?;
        let is_fixed = |a: &Atom| a.paths.iter().all(|p| usize::from(*p) < fixed);
        Ok(Search {
            graphs: problem.systems.iter().map(|s| Graph::new(s, limit)).collect(),
            levels,
            fixed: Vec::new(),
            fixed_atoms: atoms.iter_enumerated().filter(|(_, a)| is_fixed(a)).map(|(id, _)| id).collect(),
            valuations: Valuations::new(atoms.len()),
            recent: Recent::new(),
            given: FxHashMap::default(),
            reads_enabled: atoms.iter().any(|a| a.reads_enabled),
            atoms,
            residuals,
            root,
            reads_innermost: TiVec::new(),
            progress: Progress::new(usize::try_from(budget.entries).unwrap_or(usize::MAX)),
            systems: objective.paths.iter().map(|p| p.system).collect(),
            mode: objective.mode,
            ends: objective.paths.keys().map(|path| end(problem, objective, path)).collect(),
            time: 0,
            states: objective.paths.iter().map(|_| None).collect(),
            took: objective.paths.iter().map(|_| None).collect(),
            before: Sets::default(),
            now: Sets::default(),
            memo: FxHashMap::default(),
            budget: *budget,
            reached: Reached::default(),
        })
    }

    /// Whether a residual reads paths of the innermost block.
    pub(crate) fn reads_innermost(&mut self, residual: ResidualId) -> bool {
        let Search { atoms, levels, residuals, reads_innermost: known, .. } = self;
        let innermost = levels.last().and_then(|level| level.joint.paths.first());
        // Paths are numbered from the outside, and operands are there before what is built from them.
        for at in (known.len()..=usize::from(residual)).map(ResidualId::from) {
            let reads = match residuals.get(at) {
                Residual::Constant(_) => false,
                Residual::Literal { atom, .. } => {
                    innermost.is_some_and(|(first, _)| atoms[*atom].paths.last() >= Some(first))
                }
                Residual::Connected(_, operands) => operands.iter().any(|&operand| known[operand]),
                Residual::Next(_, operand) => known[*operand],
                Residual::Temporal(_, _, lhs, rhs) => known[*lhs] || known[*rhs],
            };
            known.push(reads);
        }
        known[residual]
    }

    /// How far it got.
    pub(crate) fn reached(&self) -> Reached {
        let graphs = self.graphs.iter().map(Graph::len).max().unwrap_or(0);
        let joints = self.levels.iter().map(|l| l.joint.len()).max().unwrap_or(0);
        Reached { states: graphs.max(joints) as u64, ..self.reached }
    }

    /// Turns to the present time: where the fixed traces are, and what their atoms say.
    pub(crate) fn enter(&mut self) -> Result<ValuationId, Stop> {
        if self.progress.at_last_position(self.mode == Mode::Within(self.time)) {
            self.recent.clear();
        }
        self.memo.clear();
        self.levels[0].forget();
        self.place_fixed(self.time)?;
        Ok(self.fixed_part())
    }

    /// Puts the fixed traces where they are at a time.
    pub(crate) fn place_fixed(&mut self, time: u32) -> Result<(), Stop> {
        let time = time as usize;
        for trace in &self.fixed {
            let state = trace.states.get(time).copied();
            self.states[trace.path] = state;
            self.took[trace.path] = time.checked_sub(1).and_then(|t| trace.actions.get(t)).copied();
            if let Some(state) = state.filter(|_| self.reads_enabled) {
                self.graphs[self.systems[trace.path]].moves(state)?;
            }
        }
        Ok(())
    }
}

/// Where a path ends that is neither infinite nor given a length: in a system with infinitely many states, where
/// it cannot be said which states can go on for ever, a path has as many steps as the formula reads.
pub(crate) fn end(problem: &Problem, objective: &Objective, path: PathId) -> Option<u64> {
    let finite = problem.systems[objective.paths[path].system].is_finite();
    (objective.mode == Mode::Bounded && !finite).then(|| horizon(objective, path))
}
