//! One step of the first free block: its pairs, moved.
//!
//! To the atoms many moves look alike: those from pairs of one value, with the same deed, to states of which the
//! state atoms say the same. They are one *kind*, and lead to the same value; so one of them is followed.
//!
//! Often a step only adds to the step two before: the same kinds of moves lead from the same groups to the same
//! groups as then (whatever the values now are), and each group has all the members that it had then. So the next
//! layer has, group by group, all the members of the last layer, for they came about by just these moves; and only
//! the moves of members that are new need be made. (Two steps and not one, because on a map without waiting a robot
//! is back in a cell after two.)

use crate::history::Step;
use crate::joint::JointId;
use crate::layer::{Group, Next, Slot};
use crate::report::Stop;
use crate::search::Search;
use crate::valuation::ValuationId;
use crate::value::ValueId;
use hyperplan_problem::Mode;

/// What came of moving a layer.
pub(crate) enum Spread {
    /// A move decides.
    Decided(Step),
    /// None does.
    Open(Kinds),
}

/// A kind of moves from a group: one of them, what the atoms say of where it leads, and to which group that is.
#[derive(Clone, Debug)]
struct Kind {
    step: Step,
    said: ValuationId,
    slot: Slot,
}

/// The moves of a layer.
#[derive(Clone, Debug)]
pub(crate) struct Kinds {
    by_group: Vec<Vec<Kind>>,
    /// Whether all moves that the same pairs can make later are of these kinds.
    lasting: bool,
    /// Whether some value depends on what a trace would have done beyond its end.
    pub(crate) missing: bool,
}

impl Search<'_> {
    /// Moves all pairs of the last layer, up to the first move that decides. `before` are the kinds of moves of the
    /// layer two before.
    pub(crate) fn spread(
        &mut self,
        layers: &[Vec<Group>],
        before: Option<&Kinds>,
        base: ValuationId,
        next: &mut Next,
    ) -> Result<Spread, Stop> {
        let layer = layers.last().map_or(&[][..], Vec::as_slice);
        let none =
            Kinds { by_group: vec![Vec::new(); layer.len()], lasting: self.is_lasting(), missing: false };
        let mut kinds = none.clone();
        let mut fresh = None;
        if let (Some(before), [.., earlier, last, _]) = (before, layers)
            && let Some(grown) = grown(layer, earlier).filter(|_| before.lasting)
        {
            match self.again(layer, before, base, next)? {
                Again::Decided(step) => return Ok(Spread::Decided(step)),
                Again::Same(same) if next.found(last) => (kinds, fresh) = (same, Some(grown)),
                Again::Same(_) | Again::Different => next.clear(),
            }
        }
        for (index, (value, members)) in layer.iter().enumerate() {
            let list =
                fresh.as_mut().map_or_else(|| members.list(), |fresh| std::mem::take(&mut fresh[index]));
            if let Some(step) = self.spread_group((*value, &list), index, base, next, &mut kinds)? {
                return Ok(Spread::Decided(step));
            }
        }
        Ok(Spread::Open(kinds))
    }

    /// Whether moves of one kind now are of one kind later.
    fn is_lasting(&self) -> bool {
        let level = &self.levels[0];
        let endless = level.joint.paths.iter().all(|&(path, _)| self.ends[path].is_none());
        self.levels.len() == 1 && level.mixed_atoms.is_empty() && level.local_states && endless
    }

    /// Follows one move of each kind of an earlier step.
    fn again(
        &mut self,
        layer: &[Group],
        before: &Kinds,
        base: ValuationId,
        next: &mut Next,
    ) -> Result<Again, Stop> {
        let mut kinds = before.clone();
        kinds.missing = false;
        for ((value, _), known) in layer.iter().zip(&mut kinds.by_group) {
            self.count_moves(known.len())?;
            for kind in known {
                kind.step.value = *value;
                match self.lead(kind.step, base, next)? {
                    Lead::Decides => return Ok(Again::Decided(kind.step)),
                    Lead::To { slot, missing } if slot == kind.slot => kinds.missing |= missing,
                    Lead::To { .. } | Lead::Nowhere => return Ok(Again::Different),
                }
            }
        }
        Ok(Again::Same(kinds))
    }

    /// Moves pairs of one value.
    fn spread_group(
        &mut self,
        (value, list): (ValueId, &[JointId]),
        index: usize,
        base: ValuationId,
        next: &mut Next,
        kinds: &mut Kinds,
    ) -> Result<Option<Step>, Stop> {
        let innermost = self.levels.len() == 1;
        next.turn();
        for kind in &kinds.by_group[index] {
            next.remember(kind.said, kind.step.mv.deed, kind.slot);
        }
        for &joint in list {
            let moves = self.joint_moves(0, joint)?;
            self.count_moves(moves.len())?;
            if self.reached.entries + next.room() > self.budget.entries {
                return Err(Stop::Budget);
            }
            for at in 0..moves.len() {
                let mv = self.levels[0].joint.at(&moves, at);
                let said = |search: &Self| search.levels[0].said(mv.to).filter(|_| innermost);
                if let Some(slot) = said(self).and_then(|said| next.known(said, mv.deed)) {
                    next.push(slot, mv.to);
                    continue;
                }
                let step = Step { joint, value, mv };
                match self.lead(step, base, next)? {
                    Lead::Decides => return Ok(Some(step)),
                    // For ever nowhere only where paths are infinite.
                    Lead::Nowhere => kinds.lasting &= self.mode == Mode::Bounded,
                    Lead::To { slot, missing } => {
                        kinds.missing |= missing;
                        let to = if innermost { mv.to } else { self.representative(0, mv.to)? };
                        next.push(slot, to);
                        // What decides nothing does so for all that look the same, whether they are paths or not; later it may
                        // decide.
                        let decided = slot == Slot::DROPPED && !missing;
                        let said = if decided { self.levels[0].seen(mv.to) } else { said(self) };
                        match said.filter(|_| innermost) {
                            Some(said) if next.known(said, mv.deed).is_none() => {
                                next.remember(said, mv.deed, slot);
                                kinds.by_group[index].push(Kind { step, said, slot });
                            }
                            Some(_) => {}
                            None => kinds.lasting = false,
                        }
                    }
                }
            }
        }
        Ok(None)
    }

    /// Follows a move.
    fn lead(&mut self, step: Step, base: ValuationId, next: &mut Next) -> Result<Lead, Stop> {
        Ok(match self.follow(0, step.mv, step.value, base)? {
            None => Lead::Nowhere,
            Some(value) if value == ValueId::of(self.levels[0].decisive) => Lead::Decides,
            Some(value) if value.is_constant() => {
                Lead::To { slot: Slot::DROPPED, missing: value == ValueId::MISSING }
            }
            Some(value) => Lead::To { slot: next.slot(value), missing: false },
        })
    }
}

/// Where a move leads.
enum Lead {
    /// To a value that decides.
    Decides,
    /// To no path.
    Nowhere,
    /// Into a group; or to a value that can change no more, perhaps because it is missing.
    To { slot: Slot, missing: bool },
}

/// What comes of making an earlier step's kinds of moves again.
enum Again {
    /// One decides.
    Decided(Step),
    /// They lead to the same groups.
    Same(Kinds),
    /// They do not.
    Different,
}

/// The new members of each group, where none is gone.
fn grown(layer: &[Group], earlier: &[Group]) -> Option<Vec<Vec<JointId>>> {
    if layer.len() != earlier.len() {
        return None;
    }
    layer.iter().zip(earlier).map(|((_, now), (_, before))| now.grown(before)).collect()
}
