//! One step: how a move of one block changes the values of the levels below it.

use crate::graph::Ahead;
use crate::joint::{JointId, JointMove, Moves};
use crate::level::Level;
use crate::recent::Look;
use crate::report::Stop;
use crate::residual::ResidualId;
use crate::scene::Scene;
use crate::search::Search;
use crate::valuation::ValuationId;
use crate::value::{Pair, ValueId};
use hyperplan_problem::{Mode, PathId};
use rustc_hash::FxHashSet;
use typed_index_collections::TiVec;

/// How many moves of the first block take as long as one deeper, whose sets are made anew for each move before.
const DEEPER: usize = 8;

impl Search<'_> {
    /// All joint moves of a block.
    pub(crate) fn joint_moves(&mut self, level: usize, joint: JointId) -> Result<Moves, Stop> {
        let time = u64::from(self.time);
        let ended = |path: PathId| self.ends[path].is_some_and(|end| time > end);
        self.levels[level].joint.moves(&mut self.graphs, joint, &ended)
    }

    /// How much further a prefix of a path that ends at the present step must be able to go.
    pub(crate) fn ahead(&self, path: PathId) -> Ahead {
        let left = |end: u64| u32::try_from(end.saturating_sub(self.time.into())).unwrap_or(u32::MAX);
        match (self.mode, self.ends[path]) {
            (Mode::Within(k), _) => Ahead::Steps(left(k.into())),
            (Mode::Bounded, Some(end)) => Ahead::Steps(left(end)),
            (Mode::Bounded, None) => Ahead::Forever,
        }
    }

    /// The value below a block after one of its moves, or `None` where the move leads to no path.
    pub(crate) fn follow(
        &mut self,
        level: usize,
        mv: JointMove,
        inner: ValueId,
        base: ValuationId,
    ) -> Result<Option<ValueId>, Stop> {
        let innermost = level + 1 == self.levels.len();
        let look = |search: &Self| {
            let (states, deeds) = search.levels[level].remembered(mv).filter(|_| innermost)?;
            Some(Look { value: inner, base, states, deeds })
        };
        if let Some(known) = look(self).and_then(|look| self.recent.get(look)) {
            return Ok(Some(known));
        }
        self.place(level, mv)?;
        let valuation = self.valuation(level, mv, base);
        let mut value = self.advance(level + 1, inner, valuation)?;
        let given = level == 0 && innermost && self.is_given(value);
        if given {
            value = self.settle(ResidualId(value.0))?;
        }
        // What decides nothing need not be a path.
        if value == ValueId::of(!self.levels[level].decisive) {
            return Ok(Some(value));
        }
        if !self.goes_on(level, mv)? {
            return Ok(None);
        }
        // What was settled looked ahead, and the next time may look like this one.
        if !given && let Some(look) = look(self) {
            self.recent.put(look, value);
        }
        Ok(Some(value))
    }

    /// Whether a value below the only block is a residual that reads nothing of that block any more.
    fn is_given(&mut self, value: ValueId) -> bool {
        !value.is_constant()
            && !self.levels[0].joint.paths.is_empty()
            && !self.reads_innermost(ResidualId(value.0))
    }

    /// The value of a residual that reads given traces only, which need not be waited for.
    fn settle(&mut self, residual: ResidualId) -> Result<ValueId, Stop> {
        let (mut time, mut value) = (self.time, residual);
        let mut passed = Vec::new();
        while !ValueId(value.0).is_constant() {
            if let Some(known) = self.given.get(&(time, value)) {
                value = *known;
                break;
            }
            self.count_moves(1)?;
            self.count_entries(1)?;
            passed.push((time, value));
            time += 1;
            self.place_fixed(time)?;
            self.progress.at_last_position(self.mode == Mode::Within(time));
            let base = self.fixed_part();
            value = self.progress.read(&mut self.residuals, &self.valuations, value, base)?;
        }
        if time != self.time {
            self.place_fixed(self.time)?;
            self.progress.at_last_position(self.mode == Mode::Within(self.time));
        }
        self.given.extend(passed.into_iter().map(|at| (at, value)));
        Ok(ValueId(value.0))
    }

    /// The joint state that stands for one that was reached: the first with the same moves, since what is read of a state has
    /// been read. Only where there are several blocks: sets within sets make it worth the while.
    pub(crate) fn representative(&mut self, level: usize, joint: JointId) -> Result<JointId, Stop> {
        let Level { joint: own, .. } = &mut self.levels[level];
        let last = self.mode == Mode::Within(self.time);
        if last || own.paths.iter().any(|&(path, _)| self.ends[path].is_some()) {
            return Ok(joint);
        }
        own.representative(&mut self.graphs, joint)
    }

    /// Makes a move.
    fn place(&mut self, level: usize, mv: JointMove) -> Result<(), Stop> {
        let Level { joint, reads_enabled, .. } = &self.levels[level];
        for (at, &(path, system)) in joint.paths.iter().enumerate() {
            let (state, action) = (joint.states(mv.to)[at], joint.deed(mv.deed)[at]);
            if *reads_enabled {
                self.graphs[system].moves(state)?;
            }
            self.states[path] = Some(state);
            self.took[path] = action;
        }
        Ok(())
    }

    /// Whether what a move leads to can go on far enough to be part of a path.
    fn goes_on(&mut self, level: usize, mv: JointMove) -> Result<bool, Stop> {
        for at in 0..self.levels[level].joint.paths.len() {
            let joint = &self.levels[level].joint;
            let ((path, system), state) = (joint.paths[at], joint.states(mv.to)[at]);
            let ahead = self.ahead(path);
            if !self.graphs[system].can_go(state, ahead)? {
                return Ok(false);
            }
        }
        let Level { viable, joint, .. } = &mut self.levels[level];
        viable.resize(joint.len(), false);
        viable[mv.to] = true;
        Ok(true)
    }

    /// The value of a level one step later, where the outer blocks have moved already.
    fn advance(&mut self, level: usize, value: ValueId, base: ValuationId) -> Result<ValueId, Stop> {
        if value.is_constant() {
            return Ok(value);
        }
        if level == self.levels.len() {
            let residual = if value == ValueId::START { self.root } else { ResidualId(value.0) };
            let next = self.progress.read(&mut self.residuals, &self.valuations, residual, base)?;
            return Ok(ValueId(next.0));
        }
        let key = self.memo_key(level, value, base);
        if let Some(&known) = self.memo.get(key.as_slice()) {
            return Ok(known);
        }
        let next = self.advance_set(level, value, base)?;
        self.memo.insert(key.into(), next);
        Ok(next)
    }

    fn advance_set(&mut self, level: usize, value: ValueId, base: ValuationId) -> Result<ValueId, Stop> {
        let decisive = self.levels[level].decisive;
        let mut pairs: Vec<Pair> = Vec::new();
        for &(joint, inner) in self.before.get(value).iter() {
            if inner == ValueId::MISSING {
                pairs.push((joint, inner));
                continue;
            }
            let moves = self.joint_moves(level, joint)?;
            self.count_moves(moves.len() * DEEPER)?;
            for at in 0..moves.len() {
                let mv = self.levels[level].joint.at(&moves, at);
                match self.follow(level, mv, inner, base)? {
                    Some(v) if v == ValueId::of(decisive) => return Ok(v),
                    Some(v) if v == ValueId::of(!decisive) => {}
                    Some(ValueId::MISSING) => pairs.push((JointId::START, ValueId::MISSING)),
                    Some(v) => pairs.push((self.representative(level, mv.to)?, v)),
                    None => {}
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        if level + 1 == self.levels.len() {
            self.drop_alike(&mut pairs);
        }
        match pairs.as_slice() {
            [] => Ok(ValueId::of(!decisive)),
            [(_, ValueId::MISSING)] => Ok(ValueId::MISSING),
            _ => {
                let size = pairs.len() as u64;
                let (id, new) = self.now.intern(pairs);
                self.count_entries(if new { size } else { 0 })?;
                Ok(id)
            }
        }
    }

    /// Of the prefixes of the innermost block of which the rest of the formula asks no more, and the same of other paths, keeps
    /// the first. All of them can go on, and nothing depends on how.
    fn drop_alike(&mut self, pairs: &mut Vec<Pair>) {
        let mut asked = FxHashSet::default();
        pairs.retain(|&(_, value)| {
            let read = value == ValueId::MISSING || self.reads_innermost(ResidualId(value.0));
            read || asked.insert(value)
        });
    }

    /// Everything on which the value of a level after this step can depend.
    fn memo_key(&self, level: usize, value: ValueId, base: ValuationId) -> Vec<u32> {
        let level_id = u32::try_from(level).unwrap_or(u32::MAX);
        let mut key = vec![level_id, value.0, base.0];
        let seen = &self.levels[level];
        key.extend(seen.outer_states.iter().map(|&p| self.states[p].map_or(u32::MAX, |s| s.0)));
        key.extend(seen.outer_actions.iter().map(|&p| self.took[p].map_or(u32::MAX, |a| a.0)));
        key
    }

    /// Counts pairs that are kept.
    pub(crate) fn count_entries(&mut self, entries: u64) -> Result<(), Stop> {
        self.reached.entries += entries;
        if self.reached.entries > self.budget.entries { Err(Stop::Budget) } else { Ok(()) }
    }

    /// Counts joint moves that are about to be tried.
    pub(crate) fn count_moves(&mut self, moves: usize) -> Result<(), Stop> {
        self.reached.moves += moves as u64;
        if self.reached.moves > self.budget.moves { Err(Stop::Budget) } else { Ok(()) }
    }

    /// What the atoms of the outer blocks, `base`, and those of this block say after a move of this block.
    fn valuation(&mut self, level: usize, mv: JointMove, base: ValuationId) -> ValuationId {
        let Level {
            local_states,
            local_actions,
            state_atoms,
            action_atoms,
            mixed_atoms,
            by_state,
            by_deed,
            joint,
            ..
        } = &mut self.levels[level];
        let scene = Scene {
            atoms: &self.atoms,
            graphs: &self.graphs,
            systems: &self.systems,
            states: &self.states,
            took: &self.took,
        };
        let valuations = &mut self.valuations;
        let keep = *local_states || level == 0;
        let find = || valuations.part(scene.values(state_atoms));
        let by_state = remembered(by_state, mv.to, joint.len(), keep, find);
        let keep = *local_actions || level == 0;
        let find = || valuations.part(scene.values(action_atoms));
        let by_deed = remembered(by_deed, mv.deed, joint.deeds(), keep, find);
        let mut all = valuations.join(by_state, by_deed);
        all = valuations.join(base, all);
        if mixed_atoms.is_empty() {
            return all;
        }
        let mixed = valuations.part(scene.values(mixed_atoms));
        valuations.join(all, mixed)
    }

    /// What the atoms that read fixed traces only say now.
    pub(crate) fn fixed_part(&mut self) -> ValuationId {
        let scene = Scene {
            atoms: &self.atoms,
            graphs: &self.graphs,
            systems: &self.systems,
            states: &self.states,
            took: &self.took,
        };
        self.valuations.part(scene.values(&self.fixed_atoms))
    }
}

/// What is known of one of `all` ids; found if nothing is, and then kept, if it may be.
fn remembered<K: Copy>(
    known: &mut TiVec<K, Option<ValuationId>>,
    id: K,
    all: usize,
    keep: bool,
    find: impl FnOnce() -> ValuationId,
) -> ValuationId
where
    usize: From<K>,
{
    known.get(id).copied().flatten().unwrap_or_else(|| {
        let found = find();
        if keep {
            known.resize(all, None);
            known[id] = Some(found);
        }
        found
    })
}
