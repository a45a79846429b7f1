//! What can matter when: the states that a path can be in at each time.
//!
//! For a path `q` and the goal of its player, the runs of `q` are explored together with the residual that the goal,
//! weakened to what is known of `q` alone and of fixed paths, leaves to be met ([`crate::residual`]). A state is kept at time `t` only if some run through it at `t` can go on as long as the mode
//! demands and never meets the residual `false`.
//!
//! Soundness. Let `R` be the set of runs kept. If a choice of all paths meets the goal, then the run of `q` in it is
//! in `R`, as the weakened goal is implied. So under `exists q`, with the formula wanted true, no satisfying choice is
//! lost; under `forall q`, with the formula wanted false, no violating choice is lost: for every `q` outside `R` the
//! rest of the formula holds whatever the other paths are. The latter
//! step needs that every other quantifier ranges over at least one path, which `hyperplan-plan` establishes
//! first. Keeping the states of `R` time by time keeps a superset of `R`, which is sound a fortiori.
//!
//! Two paths that the formula ties step by step (the same action, the same observation) are explored as a pair: what
//! one of them may do then depends on what the other does, and far fewer states remain. The argument is the same, with
//! the runs of one path that some run of the other, within its own layers, goes with.
//!
//! *Slack* keeps only runs that owe nothing more at most so many steps after the earliest run does. That loses
//! solutions, so it is used only for paths of the leading block, where what is found is a solution all the same.

use crate::eval::{eval, eval_in};
use crate::explicit::FixedPath;
use crate::goal::Goal;
use crate::graph::{Graph, LIVE, StateIx};
use crate::residual::{FALSE, MAX_ATOMS, Now, Residual, Residuals, TRUE};
use crate::{Encoder, Error};
use hyperplan_problem::{ActionId, Expr, FormulaId, Leaf, Mode, Node, PathId, PathLeaf};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::Cell;

/// The states that can matter at each time `0..=horizon`, sorted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layers {
    /// One sorted list of states a time.
    pub at: Vec<Vec<StateIx>>,
}

impl Layers {
    /// Whether a state can matter at a time.
    #[must_use]
    pub fn contains(&self, time: usize, state: StateIx) -> bool {
        self.at[time].binary_search(&state).is_ok()
    }
}

/// A question about one path, or about two at once.
pub(crate) struct Question<'a, const N: usize> {
    pub(crate) encoder: &'a Encoder<'a>,
    /// The paths explored.
    pub(crate) paths: [PathId; N],
    /// Where they may be, if that is known already.
    pub(crate) within: [Option<&'a Layers>; N],
    /// What their player wants.
    pub(crate) goal: &'a Goal,
    /// The paths whose states and actions are known, by path variable.
    pub(crate) fixed: &'a [Option<FixedPath>],
    /// How much later than the earliest run a run may owe nothing more.
    pub(crate) slack: Option<u32>,
    /// Set where the slack loses a run.
    pub(crate) lossy: &'a Cell<bool>,
    /// Joint states, over all times, beyond which to give up.
    pub(crate) budget: usize,
}

/// The state of one explored path and the action that led there.
type Place = (StateIx, Option<ActionId>);

/// A joint state and what is left to be met after it.
type Joint<const N: usize> = (Residual, [StateIx; N]);

/// The states of each explored path that can matter at each time.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
pub(crate) fn layers<const N: usize>(question: &Question<'_, N>) -> Result<[Layers; N], Error> {
    let mut exploration = Exploration::new(question)?;
    let forward = exploration.forward()?;
    exploration.backward(forward)
}

/// Whether a state allows enough further steps at a time: any number in bounded mode, all that are left under
/// `within`.
pub(crate) fn lasts(mode: Mode, graph: &Graph, state: StateIx, time: u32) -> bool {
    let rank = graph.rank[state as usize];
    match mode {
        Mode::Bounded => rank == LIVE,
        Mode::Within(steps) => rank >= steps.saturating_sub(time),
    }
}

struct Exploration<'a, const N: usize> {
    question: &'a Question<'a, N>,
    graphs: [&'a Graph; N],
    horizon: u32,
    atoms: Atoms<'a, N>,
    residuals: Residuals,
    initial: Residual,
    /// From this time on residuals are dropped, because there were too many.
    forget: u32,
    /// The first time at which some run owes nothing more.
    earliest: Option<u32>,
}

impl<'a, const N: usize> Exploration<'a, N> {
    fn new(question: &'a Question<'a, N>) -> Result<Self, Error> {
        let encoder = question.encoder;
        let mut graphs = Vec::with_capacity(N);
        for &path in &question.paths {
            let system = || encoder.system(path).name.clone();
            let graph = encoder.graph(path).ok_or_else(|| Error::NotEnumerable { system: system() })?;
            graphs.push(&**graph);
        }
        let graphs: [&Graph; N] = std::array::from_fn(|at| graphs[at]);
        let atoms = Atoms::new(question, graphs);
        let bit = |id: FormulaId| atoms.bit.get(&id).copied();
        let (residuals, initial) = Residuals::new(&encoder.objective.formula, question.goal, &bit);
        let horizon = question.paths.iter().map(|&p| encoder.horizon(p)).max().unwrap_or(0);
        Ok(Exploration {
            question,
            graphs,
            horizon,
            atoms,
            residuals,
            initial,
            forget: u32::MAX,
            earliest: None,
        })
    }

    /// The residual after places are entered at a time, or `None` if they cannot matter then.
    fn enter(&mut self, before: Residual, places: &[Place; N], time: u32) -> Option<Residual> {
        if before == TRUE {
            return Some(TRUE);
        }
        let bits = self.atoms.bits(self.question, &self.graphs, places, time);
        let last = matches!(self.question.encoder.objective.mode, Mode::Within(steps) if steps == time);
        match self.residuals.progress(before, Now { bits, unknown: 0, last }) {
            FALSE => None,
            _ if time >= self.forget => Some(TRUE),
            after => Some(after),
        }
    }

    /// Whether one path may be in a state at a time, whatever is left to be met.
    fn admits(&self, at: usize, state: StateIx, time: u32) -> bool {
        lasts(self.question.encoder.objective.mode, self.graphs[at], state, time)
            && self.question.within[at].is_none_or(|layers| layers.contains(time as usize, state))
    }

    /// Every joint move; a path beyond its horizon is no longer read and stays where it is.
    fn moves(&self, from: [StateIx; N], time: u32, moves: &mut Vec<[Place; N]>) {
        moves.clear();
        moves.push(from.map(|state| (state, None)));
        for at in 0..N {
            if time > self.question.encoder.horizon(self.question.paths[at]) {
                continue;
            }
            for _ in 0..moves.len() {
                let base = moves.remove(0);
                for &(letter, next) in self.graphs[at].successors(from[at]) {
                    if self.admits(at, next, time) {
                        let mut joint = base;
                        joint[at] = (next, Some(self.graphs[at].letters[letter as usize].0));
                        moves.push(joint);
                    }
                }
            }
        }
    }

    fn start(&mut self) -> Vec<Joint<N>> {
        let mut all: Vec<[Place; N]> = vec![[(0, None); N]];
        for at in 0..N {
            let states = self.graphs[at].initial.iter().filter(|&&s| self.admits(at, s, 0));
            all = states
                .flat_map(|&state| {
                    all.iter().map(move |base| {
                        let mut joint = *base;
                        joint[at] = (state, None);
                        joint
                    })
                })
                .collect();
        }
        let initial = self.initial;
        let mut found: Vec<Joint<N>> = all
            .iter()
            .filter_map(|places| Some((self.enter(initial, places, 0)?, places.map(|p| p.0))))
            .collect();
        found.sort_unstable();
        found
    }

    /// All joint states that can be reached, sorted, time by time.
    fn forward(&mut self) -> Result<Vec<Vec<Joint<N>>>, Error> {
        let mut now = self.start();
        let mut all = Vec::with_capacity(self.horizon as usize + 1);
        let mut total = now.len();
        let mut moves = Vec::new();
        for time in 1..=self.horizon {
            self.question.encoder.go_on()?;
            self.note(&now, time - 1);
            if self.residuals.len() > self.question.encoder.limits.residuals && self.forget == u32::MAX {
                self.forget = time;
            }
            let mut next: Vec<Joint<N>> = Vec::new();
            for &(residual, states) in &now {
                self.moves(states, time, &mut moves);
                for places in &moves {
                    let entered = self.enter(residual, places, time);
                    next.extend(entered.map(|r| (r, places.map(|p| p.0))));
                }
                // Many ways lead to few joint states.
                if next.len() > 4_000_000 {
                    next.sort_unstable();
                    next.dedup();
                }
            }
            next.sort_unstable();
            next.dedup();
            total += next.len();
            if total > self.question.budget {
                return Err(self.too_large());
            }
            all.push(std::mem::replace(&mut now, next));
        }
        self.note(&now, self.horizon);
        all.push(now);
        Ok(all)
    }

    fn note(&mut self, joints: &[Joint<N>], time: u32) {
        if self.earliest.is_none() && joints.first().is_some_and(|j| j.0 == TRUE) {
            self.earliest = Some(time);
        }
    }

    /// Whether the slack leaves a joint state in.
    fn in_slack(&self, residual: Residual, time: u32) -> bool {
        match (self.question.slack, self.earliest) {
            (Some(slack), Some(earliest)) => {
                let kept = residual == TRUE || time < earliest.saturating_add(slack);
                if !kept {
                    self.question.lossy.set(true);
                }
                kept
            }
            _ => true,
        }
    }

    /// Drops the joint states from which the end cannot be reached, and forgets the residuals.
    fn backward(&mut self, forward: Vec<Vec<Joint<N>>>) -> Result<[Layers; N], Error> {
        let mut layers: [Layers; N] = std::array::from_fn(|_| Layers { at: Vec::new() });
        let mut later: Option<FxHashSet<Joint<N>>> = None;
        let mut moves = Vec::new();
        for (time, mut joints) in (0u32..).zip(forward).collect::<Vec<_>>().into_iter().rev() {
            self.question.encoder.go_on()?;
            joints.retain(|&(residual, states)| {
                self.in_slack(residual, time)
                    && later.as_ref().is_none_or(|later| {
                        self.moves(states, time + 1, &mut moves);
                        moves.iter().any(|places| {
                            self.enter(residual, places, time + 1)
                                .is_some_and(|r| later.contains(&(r, places.map(|p| p.0))))
                        })
                    })
            });
            for (at, layers) in layers.iter_mut().enumerate() {
                let mut states: Vec<StateIx> = joints.iter().map(|j| j.1[at]).collect();
                states.sort_unstable();
                states.dedup();
                layers.at.push(states);
            }
            later = Some(joints.into_iter().collect());
        }
        for (at, layers) in layers.iter_mut().enumerate() {
            layers.at.reverse();
            layers.at.truncate(self.question.encoder.horizon(self.question.paths[at]) as usize + 1);
        }
        Ok(layers)
    }

    fn too_large(&self) -> Error {
        let paths = &self.question.encoder.objective.paths;
        let names: Vec<&str> = self.question.paths.iter().map(|&p| paths[p].name.as_str()).collect();
        Error::TooLarge {
            what: format!("the states that path {} can be in over time", names.join(" and ")),
            limit: self.question.budget,
        }
    }
}

/// The atoms whose values are known along the explored paths, each with its bit.
struct Atoms<'a, const N: usize> {
    bit: FxHashMap<FormulaId, u8>,
    /// Those that depend on the state of one explored path only, by path.
    of_state: [Vec<(u8, &'a Expr<PathLeaf>)>; N],
    /// Those that read actions, several paths, or fixed ones.
    of_step: Vec<(u8, &'a Expr<PathLeaf>)>,
    /// `of_state` by state, computed when asked.
    by_state: [Vec<Option<u64>>; N],
}

impl<'a, const N: usize> Atoms<'a, N> {
    fn new(question: &Question<'a, N>, graphs: [&Graph; N]) -> Self {
        let mut atoms = Atoms {
            bit: FxHashMap::default(),
            of_state: std::array::from_fn(|_| Vec::new()),
            of_step: Vec::new(),
            by_state: graphs.map(|graph| vec![None; graph.len()]),
        };
        for (id, node) in question.encoder.objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            let next = atoms.bit.len();
            if next >= MAX_ATOMS {
                break;
            }
            match classify(question, expr) {
                Reads::Unknown => continue,
                Reads::State(at) => atoms.of_state[at].push((next as u8, expr)),
                Reads::More => atoms.of_step.push((next as u8, expr)),
            }
            atoms.bit.insert(id, next as u8);
        }
        atoms
    }

    fn bits(
        &mut self,
        question: &Question<'a, N>,
        graphs: &[&Graph; N],
        places: &[Place; N],
        time: u32,
    ) -> u64 {
        let word = |atoms: &[(u8, &Expr<PathLeaf>)]| {
            atoms.iter().fold(0u64, |word, (bit, expr)| {
                word | u64::from(holds(question, graphs, expr, places, time)) << bit
            })
        };
        let mut all = word(&self.of_step);
        for (at, &(state, _)) in places.iter().enumerate() {
            let of_state = &self.of_state[at];
            all |= *self.by_state[at][state as usize].get_or_insert_with(|| word(of_state));
        }
        all
    }
}

enum Reads {
    /// A path that is neither explored nor fixed.
    Unknown,
    /// Only the state of this explored path.
    State(usize),
    More,
}

fn classify<const N: usize>(question: &Question<'_, N>, expr: &Expr<PathLeaf>) -> Reads {
    let explored = |p: PathId| question.paths.iter().position(|&q| q == p);
    let mut known = true;
    let mut alone: Option<PathId> = None;
    let mut only_state = true;
    expr.for_each_leaf(&mut |leaf| {
        for path in leaf.paths().into_iter().flatten() {
            known &= explored(path).is_some() || question.fixed[usize::from(path)].is_some();
            only_state &= alone.is_none_or(|other| other == path);
            alone = Some(path);
        }
        only_state &= matches!(leaf, PathLeaf::State(..) | PathLeaf::Enabled(..) | PathLeaf::Halted(_));
    });
    match alone.and_then(explored) {
        _ if !known => Reads::Unknown,
        Some(at) if only_state => Reads::State(at),
        _ => Reads::More,
    }
}

/// Whether an atom whose paths are all known holds. A fixed path is read only within its trace: beyond it the
/// formula does not read it, and the value given does not matter.
fn holds<const N: usize>(
    question: &Question<'_, N>,
    graphs: &[&Graph; N],
    expr: &Expr<PathLeaf>,
    places: &[Place; N],
    time: u32,
) -> bool {
    let place = |p: PathId| -> Option<(&Graph, StateIx, Option<ActionId>)> {
        if let Some(at) = question.paths.iter().position(|&q| q == p) {
            return Some((graphs[at], places[at].0, places[at].1));
        }
        let fixed = question.fixed[usize::from(p)].as_ref()?;
        let time = time as usize;
        let taken = time.checked_sub(1).and_then(|before| fixed.actions.get(before)).copied();
        Some((&fixed.graph, *fixed.states.get(time)?, taken))
    };
    let read = |p: PathId, leaf: Leaf| {
        let system = question.encoder.system(p);
        place(p).map_or(0, |(graph, state, _)| eval_in(system, &Expr::Leaf(leaf), graph.row(state)))
    };
    eval(expr, &mut |leaf| match *leaf {
        PathLeaf::State(p, leaf) => read(p, leaf),
        PathLeaf::Took(p, wanted) => i64::from(place(p).is_some_and(|(_, _, taken)| taken == Some(wanted))),
        PathLeaf::SameAction(p, q) => i64::from(place(p).map(|x| x.2) == place(q).map(|x| x.2)),
        PathLeaf::SameState(p, q) => i64::from(place(p).map(|x| x.1) == place(q).map(|x| x.1)),
        PathLeaf::Enabled(p, a) => {
            i64::from(place(p).is_some_and(|(graph, state, _)| graph.enables(state, a)))
        }
        PathLeaf::Halted(p) => i64::from(place(p).is_some_and(|(graph, state, _)| graph.halts(state))),
    }) != 0
}
