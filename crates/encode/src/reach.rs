//! What can matter when: the states that a path can be in at each time.
//!
//! For a path `q` and a wanted truth value of the formula, the runs of `q` are explored together with the residual
//! that the formula, weakened to what is known of `q` alone and of fixed paths, leaves to be met
//! ([`crate::residual`]). A state is kept at time `t` only if some run through it at `t` can go on as long as the mode
//! demands and never meets the residual `false`.
//!
//! Soundness. Let `R` be the set of runs kept. If a choice of all paths gives the formula the wanted value, then
//! the run of `q` in it is in `R`, as the weakened formula is implied. So under `exists q`, with the formula
//! wanted true, no satisfying choice is lost; under `forall q`, with the formula wanted false, no violating
//! choice is lost: for every `q` outside `R` the rest of the formula holds whatever the other paths are. The latter
//! step needs that every other quantifier ranges over at least one path, which `hyperplan-plan` establishes
//! first. Keeping the states of `R` time by time keeps a superset of `R`, which is sound a fortiori.

use crate::eval::eval;
use crate::explicit::FixedPath;
use crate::graph::{Graph, LIVE, StateIx};
use crate::residual::{FALSE, MAX_ATOMS, Now, Residual, Residuals, TRUE};
use crate::{Error, Limits};
use hyperplan_problem::{ActionId, Expr, FormulaId, Leaf, Mode, Node, Objective, PathId, PathLeaf, Problem};
use rustc_hash::{FxHashMap, FxHashSet};

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

/// A question about one path.
pub(crate) struct Question<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) objective: &'a Objective,
    pub(crate) graph: &'a Graph,
    /// The path explored.
    pub(crate) path: PathId,
    /// Its number of steps.
    pub(crate) horizon: u32,
    /// The wanted value of the formula.
    pub(crate) want: bool,
    /// The paths whose states and actions are known, by path variable.
    pub(crate) fixed: &'a [Option<FixedPath>],
}

/// A state and what is left to be met after it, packed.
fn pack(state: StateIx, residual: Residual) -> u64 {
    u64::from(residual) << 32 | u64::from(state)
}

fn unpack(pair: u64) -> (StateIx, Residual) {
    (pair as StateIx, (pair >> 32) as Residual)
}

/// The states that can matter at each time.
///
/// # Errors
/// [`Error::TooLarge`] beyond the limits.
pub(crate) fn layers(question: &Question<'_>, limits: &Limits) -> Result<Layers, Error> {
    let mut exploration = Exploration::new(question);
    let forward = exploration.forward(limits)?;
    Ok(Layers { at: exploration.backward(forward) })
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

struct Exploration<'a> {
    question: &'a Question<'a>,
    atoms: Atoms<'a>,
    residuals: Residuals,
    initial: Residual,
    /// From this time on residuals are dropped, because there were too many.
    forget: u32,
}

impl<'a> Exploration<'a> {
    fn new(question: &'a Question<'a>) -> Self {
        let atoms = Atoms::new(question);
        let bit = |id: FormulaId| atoms.bit.get(&id).copied();
        let (residuals, initial) = Residuals::new(&question.objective.formula, question.want, &bit);
        Exploration { question, atoms, residuals, initial, forget: u32::MAX }
    }

    fn last(&self, time: u32) -> bool {
        matches!(self.question.objective.mode, Mode::Within(steps) if steps == time)
    }

    /// The residual after a state is entered at a time by an action, or `None` if the state cannot matter then.
    fn enter(
        &mut self,
        before: Residual,
        state: StateIx,
        action: Option<ActionId>,
        time: u32,
    ) -> Option<Residual> {
        let question = self.question;
        if !lasts(question.objective.mode, question.graph, state, time) {
            return None;
        }
        if before == TRUE {
            return Some(TRUE);
        }
        let bits = self.atoms.bits(question, state, action, time);
        let after = self.residuals.progress(before, Now { bits, unknown: 0, last: self.last(time) });
        match after {
            FALSE => None,
            _ if time >= self.forget => Some(TRUE),
            _ => Some(after),
        }
    }

    /// All pairs that can be reached, sorted, time by time.
    fn forward(&mut self, limits: &Limits) -> Result<Vec<Vec<u64>>, Error> {
        let graph = self.question.graph;
        let mut now: Vec<u64> = Vec::new();
        for &state in &graph.initial {
            now.extend(self.enter(self.initial, state, None, 0).map(|r| pack(state, r)));
        }
        now.sort_unstable();
        let mut all = Vec::with_capacity(self.question.horizon as usize + 1);
        let mut total = now.len();
        for time in 1..=self.question.horizon {
            if self.residuals.len() > limits.residuals && self.forget == u32::MAX {
                self.forget = time;
            }
            let mut next = Vec::new();
            for &pair in &now {
                let (state, residual) = unpack(pair);
                for &(letter, successor) in graph.successors(state) {
                    let action = graph.letters[letter as usize].0;
                    let entered = self.enter(residual, successor, Some(action), time);
                    next.extend(entered.map(|r| pack(successor, r)));
                }
            }
            next.sort_unstable();
            next.dedup();
            total += next.len();
            if total > limits.layer_states {
                return Err(Error::TooLarge {
                    what: format!("the states that path {} can be in over time", self.path_name()),
                    limit: limits.layer_states,
                });
            }
            all.push(std::mem::replace(&mut now, next));
        }
        all.push(now);
        Ok(all)
    }

    /// Drops the pairs from which the end cannot be reached, and forgets the residuals.
    fn backward(&mut self, forward: Vec<Vec<u64>>) -> Vec<Vec<StateIx>> {
        let graph = self.question.graph;
        let mut layers = Vec::with_capacity(forward.len());
        let mut alive: Option<FxHashSet<u64>> = None;
        for (time, pairs) in forward.into_iter().enumerate().rev() {
            let kept: Vec<u64> = match &alive {
                None => pairs,
                Some(later) => pairs
                    .into_iter()
                    .filter(|&pair| {
                        let (state, residual) = unpack(pair);
                        graph.successors(state).iter().any(|&(letter, successor)| {
                            let action = graph.letters[letter as usize].0;
                            self.enter(residual, successor, Some(action), time as u32 + 1)
                                .is_some_and(|r| later.contains(&pack(successor, r)))
                        })
                    })
                    .collect(),
            };
            let mut states: Vec<StateIx> = kept.iter().map(|&pair| unpack(pair).0).collect();
            states.sort_unstable();
            states.dedup();
            layers.push(states);
            alive = Some(kept.into_iter().collect());
        }
        layers.reverse();
        layers
    }

    fn path_name(&self) -> &str {
        &self.question.objective.paths[self.question.path].name
    }
}

/// The atoms whose values are known along the explored path, each with its bit.
struct Atoms<'a> {
    bit: FxHashMap<FormulaId, u8>,
    /// Those that depend on the explored path's state only.
    of_state: Vec<(u8, &'a Expr<PathLeaf>)>,
    /// Those that read actions or fixed paths.
    of_step: Vec<(u8, &'a Expr<PathLeaf>)>,
    /// `of_state` by state, computed when asked.
    by_state: Vec<Option<u64>>,
}

impl<'a> Atoms<'a> {
    fn new(question: &Question<'a>) -> Self {
        let mut atoms = Atoms {
            bit: FxHashMap::default(),
            of_state: Vec::new(),
            of_step: Vec::new(),
            by_state: vec![None; question.graph.len()],
        };
        for (id, node) in question.objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            let Some(steps) = classify(question, expr) else { continue };
            let next = atoms.bit.len();
            if next >= MAX_ATOMS {
                break;
            }
            atoms.bit.insert(id, next as u8);
            let list = if steps { &mut atoms.of_step } else { &mut atoms.of_state };
            list.push((next as u8, expr));
        }
        atoms
    }

    fn bits(&mut self, question: &Question<'_>, state: StateIx, action: Option<ActionId>, time: u32) -> u64 {
        let word = |atoms: &[(u8, &Expr<PathLeaf>)]| {
            atoms.iter().fold(0u64, |word, (bit, expr)| {
                word | u64::from(holds(question, expr, state, action, time)) << bit
            })
        };
        let of_state = match self.by_state[state as usize] {
            Some(bits) => bits,
            None => {
                let bits = word(&self.of_state);
                self.by_state[state as usize] = Some(bits);
                bits
            }
        };
        of_state | word(&self.of_step)
    }
}

/// `None` where the atom reads a path that is not known; else whether it reads more than the explored path's state.
fn classify(question: &Question<'_>, expr: &Expr<PathLeaf>) -> Option<bool> {
    let known = |p: PathId| p == question.path || question.fixed[usize::from(p)].is_some();
    let mut steps = false;
    let mut all_known = true;
    expr.for_each_leaf(&mut |leaf| match *leaf {
        PathLeaf::State(p, _) | PathLeaf::Enabled(p, _) => {
            all_known &= known(p);
            steps |= p != question.path;
        }
        PathLeaf::Took(p, _) => {
            all_known &= known(p);
            steps = true;
        }
        PathLeaf::SameAction(p, q) | PathLeaf::SameState(p, q) => {
            // Of a path with itself both hold; evaluation sees to it.
            all_known &= known(p) && known(q);
            steps = true;
        }
    });
    all_known.then_some(steps)
}

/// Whether an atom whose paths are all known holds. A fixed path is read only within its trace: beyond it the
/// formula does not read it, and the value given does not matter.
fn holds(
    question: &Question<'_>,
    expr: &Expr<PathLeaf>,
    state: StateIx,
    action: Option<ActionId>,
    time: u32,
) -> bool {
    let place = |p: PathId| -> Option<(&Graph, StateIx, Option<ActionId>)> {
        if p == question.path {
            return Some((question.graph, state, action));
        }
        let fixed = question.fixed[usize::from(p)].as_ref()?;
        let time = time as usize;
        let taken = time.checked_sub(1).and_then(|before| fixed.actions.get(before)).copied();
        Some((&fixed.graph, *fixed.states.get(time)?, taken))
    };
    eval(expr, &mut |leaf| match *leaf {
        PathLeaf::State(p, leaf) => {
            place(p).map_or(0, |(graph, state, _)| read(question, p, graph, state, leaf))
        }
        PathLeaf::Took(p, wanted) => i64::from(place(p).is_some_and(|(_, _, taken)| taken == Some(wanted))),
        PathLeaf::SameAction(p, q) => i64::from(place(p).map(|x| x.2) == place(q).map(|x| x.2)),
        PathLeaf::SameState(p, q) => i64::from(place(p).map(|x| x.1) == place(q).map(|x| x.1)),
        PathLeaf::Enabled(p, a) => {
            i64::from(place(p).is_some_and(|(graph, state, _)| graph.enables(state, a)))
        }
    }) != 0
}

fn read(question: &Question<'_>, path: PathId, graph: &Graph, state: StateIx, leaf: Leaf) -> i64 {
    let system = &question.problem.systems[question.objective.paths[path].system];
    crate::eval::eval_in(system, &Expr::Leaf(leaf), graph.row(state))
}
