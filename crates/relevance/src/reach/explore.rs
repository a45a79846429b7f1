//! Exploring one path, or two at once, time by time.

use super::atoms::Bits;
use super::bound::Bound;
use super::product::Product;
use super::question::{Explored, Place, Question};
use crate::ceiling::{Ceiling, NO_WAY, transitions};
use crate::layers::Layers;
use crate::residual::{FALSE, Residual, TRUE};
use crate::task::Error;
use hyperplan_space::StateIx;
use rustc_hash::FxHashMap;

/// Joint states entered between two looks at the clock.
pub(super) const STRIDE: usize = 1 << 14;

/// A joint state and what is left to be met after it.
pub(crate) type Joint<const N: usize> = (Residual, [StateIx; N]);

/// The joint states of one time, and where they lead.
pub(crate) struct Stage<const N: usize> {
    pub(crate) joints: Vec<Joint<N>>,
    /// Where the successors of each joint state start in `next`.
    starts: Vec<u32>,
    /// Positions in the next stage.
    next: Vec<u32>,
}

impl<const N: usize> Stage<N> {
    fn successors(&self, at: usize) -> &[u32] {
        &self.next[self.starts[at] as usize..self.starts[at + 1] as usize]
    }
}

pub(crate) struct Exploration<'a, const N: usize> {
    pub(crate) product: Product<'a, N>,
    /// From this time on residuals are dropped, because there were too many.
    forget: u32,
    /// After this time only runs that owe nothing but safety are kept.
    deadline: Option<u32>,
    /// The last time at which each state was found to be admitted, plus one; where it is looked up.
    within: [Vec<u32>; N],
    /// In which states each path is at some times.
    cuts: [Vec<(u32, &'a [StateIx])>; N],
    pub(super) bound: Option<Bound>,
    /// How much later than the earliest run a run may owe nothing but safety.
    pub(super) slack: Option<u32>,
    /// Whether a run was lost that the goal does not exclude.
    pub(super) lossy: bool,
    recent: Recent,
}

/// What was entered lately from the same residual at the same time: many moves are alike.
#[derive(Default)]
struct Recent {
    before: Residual,
    time: u32,
    after: Vec<(Bits, Residual, Option<usize>)>,
}

impl<'a, const N: usize> Exploration<'a, N> {
    pub(crate) fn new(question: &'a Question<'a, N>) -> Self {
        let product = Product::new(question);
        let within = std::array::from_fn(|at| match question.within[at] {
            Some(_) => vec![0; product.graphs[at].len()],
            None => Vec::new(),
        });
        Exploration {
            product,
            forget: u32::MAX,
            deadline: None,
            within,
            cuts: question.paths.map(|path| question.arena.cube.of(path).collect()),
            bound: None,
            slack: question.slack,
            lossy: false,
            recent: Recent::default(),
        }
    }

    /// Explores forwards, and keeps what can matter.
    pub(crate) fn explore(mut self) -> Result<Explored<N>, Error> {
        let forward = self.forward()?;
        let Question { one_run, ceiling, .. } = *self.product.question;
        let run = match ceiling.filter(|_| one_run) {
            None => one_run.then(|| self.run(&forward)).flatten(),
            Some(ceiling) => {
                let cheapest = self.cheapest(&forward, ceiling);
                if cheapest.as_ref().is_none_or(|(cost, _)| *cost > ceiling.most) {
                    // The goal is met by no run that costs so little.
                    let none = Layers { at: vec![Vec::new(); forward.len()] };
                    let layers = std::array::from_fn(|_| none.clone());
                    return Ok(Explored { layers, lossy: self.lossy });
                }
                cheapest.map(|(_, layers)| layers)
            }
        };
        let lossy = self.lossy || run.is_some();
        Ok(Explored { layers: run.unwrap_or_else(|| self.backward(&forward)), lossy })
    }

    /// The residual after places are entered at a time, or `None` if they cannot matter then.
    pub(crate) fn enter(&mut self, before: Residual, places: &[Place; N], time: u32) -> Option<Residual> {
        if before == TRUE {
            return Some(TRUE);
        }
        let bits = self.product.bits(places, time);
        if (self.recent.before, self.recent.time) != (before, time) {
            self.recent.after.clear();
            (self.recent.before, self.recent.time) = (before, time);
        }
        let known = self.recent.after.iter().find(|known| known.0 == bits).copied();
        let (_, after, row) = known.unwrap_or_else(|| self.progress(before, bits, time));
        if after == FALSE || !self.in_time(row, places[0].0, time) {
            return None;
        }
        Some(if time >= self.forget { TRUE } else { after })
    }

    fn progress(&mut self, before: Residual, bits: Bits, time: u32) -> (Bits, Residual, Option<usize>) {
        let mut after = self.product.progress(before, bits, time);
        if after != FALSE
            && self.deadline.is_some_and(|deadline| time > deadline)
            && !self.product.owes_nothing(after)
        {
            self.lossy = true;
            after = FALSE;
        }
        let row = match &mut self.bound {
            Some(bound) if after > FALSE => bound.met(&mut self.product.residuals, after, time),
            _ => None,
        };
        self.recent.after.push((bits, after, row));
        (bits, after, row)
    }

    /// Whether the lower bound on what is still to be done leaves a state in.
    fn in_time(&mut self, row: Option<usize>, state: StateIx, time: u32) -> bool {
        let (Some(bound), Some(row)) = (&self.bound, row) else { return true };
        let last = self.slack.map_or(bound.end, |slack| self.least().saturating_add(slack));
        if bound.admits(row, state, time, last.min(bound.end)) {
            return true;
        }
        if bound.admits(row, state, time, bound.end) {
            self.lossy = true;
        }
        false
    }

    /// A time before which nothing is there that owes nothing but safety.
    pub(crate) fn least(&self) -> u32 {
        self.bound.as_ref().map_or(0, |bound| bound.least).max(self.product.question.least)
    }

    /// Whether one path may be in a state at a time, whatever is left to be met.
    fn admits(&self, at: usize, state: StateIx, time: u32) -> bool {
        self.product.question.arena.task.lasts(self.product.graphs[at], state, time)
            && (self.within[at].is_empty() || self.within[at][state as usize] == time + 1)
            && self.cuts[at]
                .iter()
                .all(|(when, states)| *when != time || states.binary_search(&state).is_ok())
    }

    /// Marks the states that the paths may be in at a time.
    fn mark(&mut self, time: u32) {
        for (marks, layers) in self.within.iter_mut().zip(self.product.question.within) {
            if let Some(states) = layers.and_then(|layers| layers.at.get(time as usize)) {
                for &state in states {
                    marks[state as usize] = time + 1;
                }
            }
        }
    }

    /// Every joint move; a path beyond its horizon is no longer read and stays where it is.
    pub(crate) fn moves(&self, from: [StateIx; N], time: u32, moves: &mut Vec<[Place; N]>) {
        moves.clear();
        self.move_from(0, from.map(|state| (state, None)), time, moves);
    }

    /// The moves of the paths from the one at `at` on.
    fn move_from(&self, at: usize, joint: [Place; N], time: u32, moves: &mut Vec<[Place; N]>) {
        if at == N {
            moves.push(joint);
        } else if time > self.product.question.arena.task.horizon(self.product.question.paths[at]) {
            self.move_from(at + 1, joint, time, moves);
        } else {
            for &(letter, next) in self.product.graphs[at].successors(joint[at].0) {
                if self.admits(at, next, time) {
                    let mut joint = joint;
                    joint[at] = (next, Some(self.product.graphs[at].letters[letter as usize].0));
                    self.move_from(at + 1, joint, time, moves);
                }
            }
        }
    }

    /// The joint states at the start, sorted.
    pub(crate) fn start(&mut self) -> Vec<Joint<N>> {
        self.mark(0);
        let mut all: Vec<[Place; N]> = vec![[(0, None); N]];
        for at in 0..N {
            let states = self.product.graphs[at].initial.iter().filter(|&&s| self.admits(at, s, 0));
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
        let initial = self.product.initial;
        let mut found: Vec<Joint<N>> = all
            .iter()
            .filter_map(|places| Some((self.enter(initial, places, 0)?, places.map(|p| p.0))))
            .collect();
        found.sort_unstable();
        found
    }

    /// All joint states that can be reached, time by time.
    pub(crate) fn forward(&mut self) -> Result<Vec<Stage<N>>, Error> {
        let mut now = self.start();
        let mut all = Vec::with_capacity(self.product.horizon as usize + 1);
        let mut total = now.len();
        for time in 1..=self.product.horizon {
            self.note(&now, time - 1);
            if self.product.residuals.count() > self.product.question.arena.task.limits.residuals
                && self.forget == u32::MAX
            {
                self.forget = time;
            }
            self.mark(time);
            let (stage, next) = self.advance(now, time, total)?;
            total += next.len();
            all.push(stage);
            now = next;
        }
        let starts = vec![0; now.len() + 1];
        all.push(Stage { joints: now, starts, next: Vec::new() });
        Ok(all)
    }

    /// The joint states after those of a stage.
    fn advance(
        &mut self,
        joints: Vec<Joint<N>>,
        time: u32,
        total: usize,
    ) -> Result<(Stage<N>, Vec<Joint<N>>), Error> {
        let mut index: FxHashMap<Joint<N>, u32> = FxHashMap::default();
        index.reserve(joints.len());
        let mut next: Vec<Joint<N>> = Vec::with_capacity(joints.len());
        let mut stage = Stage { starts: Vec::with_capacity(joints.len() + 1), next: Vec::new(), joints };
        let mut moves = Vec::new();
        stage.starts.push(0);
        for at in 0..stage.joints.len() {
            if at.is_multiple_of(STRIDE) {
                self.product.question.arena.task.go_on()?;
            }
            let (residual, states) = stage.joints[at];
            self.moves(states, time, &mut moves);
            for places in &moves {
                let Some(after) = self.enter(residual, places, time) else { continue };
                let joint = (after, places.map(|p| p.0));
                let position = *index.entry(joint).or_insert_with(|| {
                    next.push(joint);
                    next.len() as u32 - 1
                });
                stage.next.push(position);
            }
            stage.starts.push(stage.next.len() as u32);
            if total + next.len() > self.product.question.budget {
                return Err(self.too_large());
            }
        }
        Ok((stage, next))
    }

    /// Without a lower bound, the slack is measured from the first run that owes nothing but safety.
    fn note(&mut self, joints: &[Joint<N>], time: u32) {
        let Some(slack) = self.slack.filter(|_| self.bound.is_none() && self.deadline.is_none()) else {
            return;
        };
        if joints.iter().any(|joint| self.product.owes_nothing(joint.0)) {
            self.deadline = Some(time.saturating_add(slack));
        }
    }

    /// Drops the joint states from which the end cannot be reached, and forgets the residuals.
    fn backward(&self, forward: &[Stage<N>]) -> [Layers; N] {
        let mut layers: [Layers; N] = std::array::from_fn(|_| Layers { at: Vec::new() });
        let mut alive: Vec<bool> = Vec::new();
        for (time, stage) in forward.iter().enumerate().rev() {
            let last = time + 1 == forward.len();
            let keeps = |at: usize| last || stage.successors(at).iter().any(|&to| alive[to as usize]);
            let kept: Vec<bool> = (0..stage.joints.len()).map(keeps).collect();
            for (at, layers) in layers.iter_mut().enumerate() {
                let alive = stage.joints.iter().zip(&kept).filter(|kept| *kept.1);
                let mut states: Vec<StateIx> = alive.map(|(joint, _)| joint.1[at]).collect();
                states.sort_unstable();
                states.dedup();
                layers.at.push(states);
            }
            alive = kept;
        }
        for (at, layers) in layers.iter_mut().enumerate() {
            layers.at.reverse();
            layers.at.truncate(
                self.product.question.arena.task.horizon(self.product.question.paths[at]) as usize + 1,
            );
        }
        layers
    }

    /// The layers of one run only, of those that soonest owe nothing but safety; `None` where there is none.
    fn run(&self, forward: &[Stage<N>]) -> Option<[Layers; N]> {
        // By stage and joint state: when nothing is owed any more, and the successor that leads there.
        let mut best: Vec<Vec<(u32, u32)>> = Vec::with_capacity(forward.len());
        for (time, stage) in forward.iter().enumerate().rev() {
            let later = best.last();
            let step = |at: usize| {
                let owes_nothing = self.product.owes_nothing(stage.joints[at].0);
                let Some(later) = later else {
                    return (if owes_nothing { time as u32 } else { u32::MAX }, 0);
                };
                let ways = stage.successors(at).iter().map(|&to| (later[to as usize].0, to));
                match ways.min() {
                    Some((when, to)) if owes_nothing && when < u32::MAX => (time as u32, to),
                    Some(way) => way,
                    None => (u32::MAX, 0),
                }
            };
            best.push((0..stage.joints.len()).map(step).collect());
        }
        best.reverse();
        let first =
            (0..best[0].len()).min_by_key(|&at| best[0][at]).filter(|&at| best[0][at].0 < u32::MAX)?;
        let way = best.iter().scan(first, |here, best| Some(std::mem::replace(here, best[*here].1 as usize)));
        Some(self.layers_of(forward, way))
    }

    /// The least that a run costs, and the layers of such a run; `None` where there is no run.
    fn cheapest(&self, forward: &[Stage<N>], ceiling: &Ceiling) -> Option<(i64, [Layers; N])> {
        let Question { paths, arena, .. } = self.product.question;
        let weights = paths.map(|path| ceiling.of(path));
        // By stage and joint state: the least that is still to be paid, and the successor that leads there.
        let mut best: Vec<Vec<(i64, u32)>> = Vec::with_capacity(forward.len());
        for (time, stage) in forward.iter().enumerate().rev() {
            let Some(later) = best.last() else {
                best.push(vec![(0, 0); stage.joints.len()]);
                continue;
            };
            let next = &forward[time + 1].joints;
            // The paths may have one action in common, and the least of each be of others: it is a bound all the same.
            let weight = |at: usize, from: StateIx, there: StateIx| match weights[at] {
                Some(weights) if time < arena.task.horizon(paths[at]) as usize => {
                    let steps = transitions(self.product.graphs[at], weights, from);
                    steps.filter(|step| step.1 == there).map(|step| step.2).min().unwrap_or(NO_WAY)
                }
                _ => 0,
            };
            let step = |joint: usize| {
                let from = stage.joints[joint].1;
                let way = |&to: &u32| {
                    let there = next[to as usize].1;
                    let own = (0..N).map(|at| weight(at, from[at], there[at]));
                    let cost = own.fold(later[to as usize].0, i64::saturating_add);
                    (cost.min(NO_WAY), to)
                };
                stage.successors(joint).iter().map(way).min().unwrap_or((NO_WAY, 0))
            };
            best.push((0..stage.joints.len()).map(step).collect());
        }
        best.reverse();
        let first = (0..best[0].len()).min_by_key(|&at| best[0][at]).filter(|&at| best[0][at].0 < NO_WAY)?;
        let way = best.iter().scan(first, |here, best| Some(std::mem::replace(here, best[*here].1 as usize)));
        Some((best[0][first].0, self.layers_of(forward, way)))
    }

    /// The layers of one run through these joint states.
    fn layers_of(&self, forward: &[Stage<N>], run: impl Iterator<Item = usize>) -> [Layers; N] {
        let mut layers: [Layers; N] = std::array::from_fn(|_| Layers { at: Vec::new() });
        for (stage, here) in forward.iter().zip(run) {
            for (at, layers) in layers.iter_mut().enumerate() {
                layers.at.push(vec![stage.joints[here].1[at]]);
            }
        }
        for (at, layers) in layers.iter_mut().enumerate() {
            layers.at.truncate(
                self.product.question.arena.task.horizon(self.product.question.paths[at]) as usize + 1,
            );
        }
        layers
    }

    fn too_large(&self) -> Error {
        let paths = &self.product.question.arena.task.objective.paths;
        let names: Vec<&str> = self.product.question.paths.iter().map(|&p| paths[p].name.as_str()).collect();
        Error::TooLarge {
            what: format!("the states that path {} can be in over time", names.join(" and ")),
            limit: self.product.question.budget,
        }
    }
}

impl<'a> Exploration<'a, 1> {
    /// The least that a run costs; [`NO_WAY`] where there is none.
    pub(crate) fn least_cost(mut self, ceiling: &Ceiling) -> Result<i64, Error> {
        let forward = self.forward()?;
        Ok(self.cheapest(&forward, ceiling).map_or(NO_WAY, |(cost, _)| cost))
    }

    /// By state, the first time from which on it cannot matter any more.
    pub(crate) fn until(self) -> Option<Vec<u32>> {
        let states = self.product.graphs[0].len();
        self.bound.map(|bound| bound.until(states))
    }

    /// Measures first how far states are from where nothing is owed.
    pub(crate) fn bounded(question: &'a Question<'a, 1>) -> Self {
        let mut exploration = Exploration::new(question);
        exploration.bound = Bound::new(&mut exploration.product);
        exploration
    }
}
