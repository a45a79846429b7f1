//! The blocks of path variables that are not fixed, and what the atoms see of each.

use crate::atoms::Atom;
use crate::joint::{DeedId, Joint, JointId, JointMove};
use crate::report::Stop;
use crate::residual::AtomId;
use crate::valuation::ValuationId;
use hyperplan_problem::{Objective, PathId, Quantifier};
use typed_index_collections::{TiSlice, TiVec};

/// More blocks than this are "too large": each costs a stack frame.
const MOST_LEVELS: usize = 200;

/// One block.
#[derive(Debug)]
pub(crate) struct Level {
    /// The truth value that decides the whole set: true for `exists`, false for `forall`.
    pub(crate) decisive: bool,
    /// Its joint states.
    pub(crate) joint: Joint,
    /// Atoms that read no deeper block, by what they read of this one and those before.
    pub(crate) state_atoms: Vec<AtomId>,
    pub(crate) action_atoms: Vec<AtomId>,
    pub(crate) mixed_atoms: Vec<AtomId>,
    /// Whether atoms of this level or deeper ask what is enabled.
    pub(crate) reads_enabled: bool,
    /// Free paths of outer blocks whose states, and whose actions, atoms of this level or deeper read.
    pub(crate) outer_states: Vec<PathId>,
    pub(crate) outer_actions: Vec<PathId>,
    /// Joint states that are known to go on far enough; for good, since they need ever fewer steps.
    pub(crate) viable: TiVec<JointId, bool>,
    /// Whether its state atoms, and its action atoms, read this block only, so that their values need computing
    /// only once.
    pub(crate) local_states: bool,
    pub(crate) local_actions: bool,
    /// Valuations of state atoms by joint state, and of action atoms by deed: for ever where local, for one step
    /// at the first level, else not at all.
    pub(crate) by_state: TiVec<JointId, Option<ValuationId>>,
    pub(crate) by_deed: TiVec<DeedId, Option<ValuationId>>,
}

impl Level {
    /// What is remembered of what the state atoms and the action atoms say after a move to a viable state.
    pub(crate) fn remembered(&self, mv: JointMove) -> Option<(ValuationId, ValuationId)> {
        Some((self.said(mv.to)?, (*self.by_deed.get(mv.deed)?)?))
    }

    /// What is remembered of what the state atoms say in a viable state, where they and the deed say it all.
    pub(crate) fn said(&self, state: JointId) -> Option<ValuationId> {
        self.seen(state).filter(|_| self.viable.get(state).is_some_and(|viable| *viable))
    }

    /// The same in any state.
    pub(crate) fn seen(&self, state: JointId) -> Option<ValuationId> {
        self.by_state.get(state).copied().flatten().filter(|_| self.mixed_atoms.is_empty())
    }

    /// Forgets what holds for one step only.
    pub(crate) fn forget(&mut self) {
        if !self.local_states {
            self.by_state.clear();
        }
        if !self.local_actions {
            self.by_deed.clear();
        }
    }
}

/// The blocks after the first `fixed` path variables, outermost first. At least one: where all paths are fixed, a
/// block of no path variables, which has one joint path.
pub(crate) fn levels(
    objective: &Objective,
    fixed: usize,
    atoms: &TiSlice<AtomId, Atom>,
    limit: usize,
) -> Result<Vec<Level>, Stop> {
    let mut blocks: Vec<(Quantifier, Vec<PathId>)> = Vec::new();
    for (id, var) in objective.paths.iter_enumerated().skip(fixed) {
        match blocks.last_mut() {
            Some((quantifier, paths)) if *quantifier == var.quantifier => paths.push(id),
            _ => blocks.push((var.quantifier, vec![id])),
        }
    }
    if blocks.is_empty() {
        blocks.push((Quantifier::Forall, Vec::new()));
    }
    if blocks.len() > MOST_LEVELS {
        return Err(Stop::Budget);
    }
    let firsts: Vec<PathId> = blocks.iter().filter_map(|(_, paths)| paths.first().copied()).collect();
    let levels = blocks.into_iter().enumerate().map(|(i, (quantifier, paths))| {
        let systems = paths.iter().map(|&p| (p, objective.paths[p].system)).collect();
        let mut level = Level {
            decisive: quantifier == Quantifier::Exists,
            joint: Joint::new(systems, limit),
            state_atoms: Vec::new(),
            action_atoms: Vec::new(),
            mixed_atoms: Vec::new(),
            reads_enabled: false,
            outer_states: Vec::new(),
            outer_actions: Vec::new(),
            viable: TiVec::new(),
            local_states: true,
            local_actions: true,
            by_state: TiVec::new(),
            by_deed: TiVec::new(),
        };
        level.see(atoms, fixed, firsts.get(i).copied(), firsts.get(i + 1).copied());
        level
    });
    Ok(levels.collect())
}

impl Level {
    /// Sorts the atoms by what they read; `first` is the block's first path, `next` the next block's.
    fn see(
        &mut self,
        atoms: &TiSlice<AtomId, Atom>,
        fixed: usize,
        first: Option<PathId>,
        next: Option<PathId>,
    ) {
        let Some(first) = first else { return };
        for (id, atom) in atoms.iter_enumerated() {
            let Some(&last) = atom.paths.last() else { continue };
            if last < first {
                continue;
            }
            self.reads_enabled |= atom.reads_enabled;
            let outer = || atom.paths.iter().filter(|&&p| p < first && usize::from(p) >= fixed);
            if atom.reads_states {
                self.outer_states.extend(outer());
            }
            if atom.reads_actions {
                self.outer_actions.extend(outer());
            }
            if next.is_some_and(|next| last >= next) {
                continue;
            }
            let local = atom.paths.iter().all(|&p| p >= first);
            self.local_states &= local || !atom.reads_states;
            self.local_actions &= local || !atom.reads_actions;
            match (atom.reads_states, atom.reads_actions) {
                (true, true) => self.mixed_atoms.push(id),
                (false, true) => self.action_atoms.push(id),
                _ => self.state_atoms.push(id),
            }
        }
        for paths in [&mut self.outer_states, &mut self.outer_actions] {
            paths.sort_unstable();
            paths.dedup();
        }
    }
}
