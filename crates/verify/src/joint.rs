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
    /// Of all joint states but the start, one after the other.
    states: Vec<StateId>,
    state_index: FxHashMap<Box<[StateId]>, JointId>,
    /// Of a single path, the joint state of each state, and the deed of each action, instead.
    of_state: TiVec<StateId, Option<JointId>>,
    of_action: TiVec<ActionId, Option<DeedId>>,
    /// Where the moves of each joint state begin among all, and how many they are.
    moves: TiVec<JointId, Option<(usize, usize)>>,
    all_moves: Vec<JointMove>,
    /// Of each joint state, the first with the same moves.
    alike: TiVec<JointId, Option<JointId>>,
    deeds: TiVec<DeedId, Deed>,
    deed_index: FxHashMap<Deed, DeedId>,
    /// Whether all moves were kept.
    complete: bool,
    limit: usize,
}

/// How many joint moves of a block are kept; others are computed again.
const REMEMBERED_MOVES: usize = 10_000_000;

/// The moves of a joint state.
#[derive(Clone, Debug)]
pub(crate) enum Moves {
    /// Where they begin among those that are kept, and how many they are.
    Kept(usize, usize),
    /// They are not kept.
    Once(Vec<JointMove>),
}

impl Moves {
    pub(crate) fn len(&self) -> usize {
        match self {
            Moves::Kept(_, count) => *count,
            Moves::Once(moves) => moves.len(),
        }
    }
}

/// The ways in which one path of a block can move.
type Options = Vec<(Option<ActionId>, StateId)>;

impl Joint {
    /// Nothing explored yet; at most `limit` joint states will be.
    pub(crate) fn new(paths: Vec<(PathId, SystemId)>, limit: usize) -> Self {
        Joint {
            paths,
            states: Vec::new(),
            state_index: FxHashMap::default(),
            of_state: TiVec::new(),
            of_action: TiVec::new(),
            moves: TiVec::from(vec![None]),
            all_moves: Vec::new(),
            alike: TiVec::new(),
            deeds: TiVec::new(),
            deed_index: FxHashMap::default(),
            complete: true,
            limit: limit.min(u32::MAX as usize - 1),
        }
    }

    /// Number of joint states seen.
    pub(crate) fn len(&self) -> usize {
        self.moves.len()
    }

    /// Number of deeds seen.
    pub(crate) fn deeds(&self) -> usize {
        self.deeds.len()
    }

    /// The states of the paths, in order; none at the start.
    pub(crate) fn states(&self, joint: JointId) -> &[StateId] {
        let width = self.paths.len();
        usize::from(joint).checked_sub(1).map_or(&[], |before| &self.states[before * width..][..width])
    }

    /// What each path just did.
    pub(crate) fn deed(&self, deed: DeedId) -> &[Option<ActionId>] {
        &self.deeds[deed]
    }

    /// By joint state, those whose moves lead there; `None` where not all moves tried are kept.
    pub(crate) fn sources(&self) -> Option<TiVec<JointId, Vec<JointId>>> {
        let mut sources: TiVec<JointId, Vec<JointId>> = self.moves.iter().map(|_| Vec::new()).collect();
        for (from, moves) in self.moves.iter_enumerated() {
            for mv in moves.iter().flat_map(|(first, count)| &self.all_moves[*first..][..*count]) {
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
    ) -> Result<Moves, Stop> {
        let some_ended = self.paths.iter().any(|&(path, _)| ended(path));
        if let Some((first, count)) = self.moves[joint].filter(|_| !some_ended) {
            return Ok(Moves::Kept(first, count));
        }
        let mut moves = Vec::new();
        match (self.paths.as_slice(), self.states(joint)) {
            ([(_, system)], &[state]) if !some_ended => {
                for one in graphs[*system].moves(state)? {
                    let deed = self.intern_deed(&[Some(one.action)]);
                    moves.push(JointMove { deed, to: self.intern(&[one.to])? });
                }
            }
            _ => {
                let options = self.options(graphs, joint, ended)?;
                self.product(&options, &mut moves)?;
            }
        }
        if some_ended || self.all_moves.len() + moves.len() > REMEMBERED_MOVES {
            self.complete = false;
            return Ok(Moves::Once(moves));
        }
        let kept = (self.all_moves.len(), moves.len());
        self.all_moves.append(&mut moves);
        self.moves[joint] = Some(kept);
        Ok(Moves::Kept(kept.0, kept.1))
    }

    /// The first joint state whose paths can all move as those of this one, which is not the start.
    pub(crate) fn representative(
        &mut self,
        graphs: &mut TiVec<SystemId, Graph<'_>>,
        joint: JointId,
    ) -> Result<JointId, Stop> {
        if let Some(known) = self.alike.get(joint).copied().flatten() {
            return Ok(known);
        }
        let mut states = self.states(joint).to_vec();
        for (state, &(_, system)) in states.iter_mut().zip(&self.paths) {
            *state = graphs[system].first_alike(*state)?;
        }
        let first = self.intern(&states)?;
        note(&mut self.alike, joint, first);
        Ok(first)
    }

    /// One of the moves of a joint state.
    pub(crate) fn at(&self, moves: &Moves, index: usize) -> JointMove {
        match moves {
            Moves::Kept(first, _) => self.all_moves[first + index],
            Moves::Once(moves) => moves[index],
        }
    }

    /// How each path can move.
    fn options(
        &self,
        graphs: &mut TiVec<SystemId, Graph<'_>>,
        joint: JointId,
        ended: &dyn Fn(PathId) -> bool,
    ) -> Result<Vec<Options>, Stop> {
        let mut options: Vec<Options> = Vec::with_capacity(self.paths.len());
        let states = self.states(joint);
        for (i, &(path, system)) in self.paths.iter().enumerate() {
            let graph = &mut graphs[system];
            options.push(match states.get(i) {
                Some(&state) if ended(path) => vec![(None, state)],
                Some(&state) => graph.moves(state)?.iter().map(|m| (Some(m.action), m.to)).collect(),
                None => graph.initial_states()?.into_iter().map(|state| (None, state)).collect(),
            });
        }
        Ok(options)
    }

    fn product(&mut self, options: &[Options], moves: &mut Vec<JointMove>) -> Result<(), Stop> {
        let count = options.iter().try_fold(1_usize, |n, o| n.checked_mul(o.len())).ok_or(Stop::Budget)?;
        if count > self.limit.saturating_mul(4) {
            return Err(Stop::Budget);
        }
        moves.reserve(count);
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
        Ok(())
    }

    fn intern(&mut self, states: &[StateId]) -> Result<JointId, Stop> {
        let known = match *states {
            [only] => self.of_state.get(only).copied().flatten(),
            _ => self.state_index.get(states).copied(),
        };
        if let Some(id) = known {
            return Ok(id);
        }
        if self.moves.len() > self.limit {
            return Err(Stop::Budget);
        }
        self.states.extend_from_slice(states);
        let id = self.moves.push_and_get_key(None);
        match *states {
            [only] => note(&mut self.of_state, only, id),
            _ => {
                self.state_index.insert(states.into(), id);
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
