//! Joint states and joint moves of the path variables of one block.

use crate::graph::{Graph, StateId};
use crate::report::Stop;
use hyperplan_problem::{ActionId, PathId, SystemId};
use rustc_hash::FxHashMap;
use std::rc::Rc;
use typed_index_collections::TiVec;

id! {
    /// A joint state of a block; 0 is [`JointId::START`].
    JointId, "the budget of states is kept below 2^32"
}

impl JointId {
    /// Before time 0: its moves lead to the initial states.
    pub(crate) const START: JointId = JointId(0);
}

id! {
    /// What the paths of a block just did together.
    DeedId, "joint moves are kept below 2^32"
}

/// A joint transition, seen from its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct JointMove {
    pub(crate) deed: DeedId,
    pub(crate) to: JointId,
}

/// What each path just did: nothing, at time 0.
type Deed = Rc<[Option<ActionId>]>;

/// The product of the graphs of a block's path variables, explored lazily.
#[derive(Debug)]
pub(crate) struct Joint {
    /// The path variables and their systems.
    pub(crate) paths: Vec<(PathId, SystemId)>,
    states: TiVec<JointId, Rc<[StateId]>>,
    state_index: FxHashMap<Rc<[StateId]>, JointId>,
    /// Of a single path, the joint state of each state, and the deed of each action, instead.
    of_state: TiVec<StateId, Option<JointId>>,
    of_action: TiVec<ActionId, Option<DeedId>>,
    moves: TiVec<JointId, Option<Rc<[JointMove]>>>,
    deeds: TiVec<DeedId, Deed>,
    deed_index: FxHashMap<Deed, DeedId>,
    remembered: usize,
    /// Whether all were kept.
    complete: bool,
    limit: usize,
}

/// How many joint moves of a block are kept; others are computed again.
const REMEMBERED_MOVES: usize = 10_000_000;

/// The ways in which one path of a block can move.
type Options = Vec<(Option<ActionId>, StateId)>;

impl Joint {
    /// Nothing explored yet; at most `limit` joint states will be.
    pub(crate) fn new(paths: Vec<(PathId, SystemId)>, limit: usize) -> Self {
        Joint {
            paths,
            // The start has no states; its entry keeps ids and indices in step.
            states: TiVec::from(vec![Rc::from([])]),
            state_index: FxHashMap::default(),
            of_state: TiVec::new(),
            of_action: TiVec::new(),
            moves: TiVec::from(vec![None]),
            deeds: TiVec::new(),
            deed_index: FxHashMap::default(),
            remembered: 0,
            complete: true,
            limit: limit.min(u32::MAX as usize - 1),
        }
    }

    /// Number of joint states seen.
    pub(crate) fn len(&self) -> usize {
        self.states.len()
    }

    /// Number of deeds seen.
    pub(crate) fn deeds(&self) -> usize {
        self.deeds.len()
    }

    /// The states of the paths, in order; none at the start.
    pub(crate) fn states(&self, joint: JointId) -> &[StateId] {
        &self.states[joint]
    }

    /// What each path just did.
    pub(crate) fn deed(&self, deed: DeedId) -> &[Option<ActionId>] {
        &self.deeds[deed]
    }

    /// By joint state, those whose moves lead there; `None` where not all moves tried are kept.
    pub(crate) fn sources(&self) -> Option<TiVec<JointId, Vec<JointId>>> {
        let mut sources: TiVec<JointId, Vec<JointId>> = self.states.iter().map(|_| Vec::new()).collect();
        for (from, moves) in self.moves.iter_enumerated() {
            for mv in moves.iter().flat_map(|moves| moves.iter()) {
                if sources[mv.to].last() != Some(&from) {
                    sources[mv.to].push(from);
                }
            }
        }
        self.complete.then_some(sources)
    }

    /// All joint moves. A path that has ended stays where it is and takes no action.
    pub(crate) fn moves(
        &mut self,
        graphs: &mut TiVec<SystemId, Graph<'_>>,
        joint: JointId,
        ended: &dyn Fn(PathId) -> bool,
    ) -> Result<Rc<[JointMove]>, Stop> {
        let some_ended = self.paths.iter().any(|&(path, _)| ended(path));
        if let Some(moves) = self.moves[joint].as_ref().filter(|_| !some_ended) {
            return Ok(moves.clone());
        }
        let mut options: Vec<Options> = Vec::with_capacity(self.paths.len());
        let states = self.states[joint].clone();
        for (i, &(path, system)) in self.paths.iter().enumerate() {
            let graph = &mut graphs[system];
            options.push(match states.get(i) {
                Some(&state) if ended(path) => vec![(None, state)],
                Some(&state) => graph.moves(state)?.iter().map(|m| (Some(m.action), m.to)).collect(),
                None => graph.initial_states()?.into_iter().map(|state| (None, state)).collect(),
            });
        }
        let moves = self.product(&options)?;
        if !some_ended && self.remembered + moves.len() <= REMEMBERED_MOVES {
            self.remembered += moves.len();
            self.moves[joint] = Some(moves.clone());
        } else {
            self.complete = false;
        }
        Ok(moves)
    }

    fn product(&mut self, options: &[Options]) -> Result<Rc<[JointMove]>, Stop> {
        let count = options.iter().try_fold(1_usize, |n, o| n.checked_mul(o.len())).ok_or(Stop::Budget)?;
        if count > self.limit.saturating_mul(4) {
            return Err(Stop::Budget);
        }
        let mut moves = Vec::with_capacity(count);
        let mut actions = Vec::with_capacity(options.len());
        let mut targets = Vec::with_capacity(options.len());
        for number in 0..count {
            actions.clear();
            targets.clear();
            let mut rest = number;
            for option in options {
                let (action, to) = option[rest % option.len()];
                rest /= option.len();
                actions.push(action);
                targets.push(to);
            }
            moves.push(JointMove { deed: self.intern_deed(&actions), to: self.intern(&targets)? });
        }
        Ok(moves.into())
    }

    fn intern(&mut self, states: &[StateId]) -> Result<JointId, Stop> {
        let known = match *states {
            [only] => self.of_state.get(only).copied().flatten(),
            _ => self.state_index.get(states).copied(),
        };
        if let Some(id) = known {
            return Ok(id);
        }
        if self.states.len() > self.limit {
            return Err(Stop::Budget);
        }
        let shared: Rc<[StateId]> = states.into();
        let id = self.states.push_and_get_key(shared.clone());
        self.moves.push(None);
        match *states {
            [only] => note(&mut self.of_state, only, id),
            _ => {
                self.state_index.insert(shared, id);
            }
        }
        Ok(id)
    }

    fn intern_deed(&mut self, actions: &[Option<ActionId>]) -> DeedId {
        let known = match *actions {
            [Some(only)] => self.of_action.get(only).copied().flatten(),
            _ => self.deed_index.get(actions).copied(),
        };
        if let Some(id) = known {
            return id;
        }
        let shared: Deed = actions.into();
        let id = self.deeds.push_and_get_key(shared.clone());
        match *actions {
            [Some(only)] => note(&mut self.of_action, only, id),
            _ => {
                self.deed_index.insert(shared, id);
            }
        }
        id
    }
}

/// Notes what belongs to a key.
fn note<K, V: Clone>(known: &mut TiVec<K, Option<V>>, key: K, value: V)
where
    usize: From<K>,
{
    let at = usize::from(key);
    if known.len() <= at {
        known.raw.resize(at + 1, None);
    }
    known.raw[at] = Some(value);
}
