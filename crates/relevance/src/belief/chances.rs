//! The moves of the leading paths, and what they leave of the other player's chances.

use crate::layers::Layers;
use crate::reach::{Place, Product, Question};
use crate::residual::{FALSE, Residual, TRUE};
use hyperplan_space::{Graph, Letter, StateIx};
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::rc::Rc;

/// A number for each of some things.
#[derive(Debug)]
struct Numbers<T> {
    all: Vec<T>,
    index: FxHashMap<T, u32>,
}

impl<T: Copy + Eq + Hash> Numbers<T> {
    fn new() -> Self {
        Numbers { all: Vec::new(), index: FxHashMap::default() }
    }

    fn of(&mut self, thing: T) -> u32 {
        let next = self.all.len() as u32;
        *self.index.entry(thing).or_insert_with(|| {
            self.all.push(thing);
            next
        })
    }

    fn get(&self, number: u32) -> T {
        self.all[number as usize]
    }
}

/// Where the leading paths are, and what is left of what the goal asks of them alone.
pub(super) type LeadIx = u32;
/// Where the other player's paths are, and what is left of the goal's rest.
pub(super) type ChanceIx = u32;

/// States of all paths; those of the paths that are not meant are 0.
type States<const N: usize> = [StateIx; N];

/// A joint step: letters and states, of the paths that are meant.
type JointStep<const N: usize> = ([Letter; N], States<N>);

/// A step of the leading paths.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeadStep<const N: usize> {
    pub(super) letters: [Letter; N],
    pub(super) to: LeadIx,
}

/// What a step of the leading paths makes of one chance.
#[derive(Clone, Debug)]
pub(super) enum After {
    /// It may become any of these.
    Left(Rc<[ChanceIx]>),
    /// It may come true: the leading paths lose.
    Lost,
}

/// What is known of steps and chances; all of it is found when it is asked for.
pub(super) struct Chances<'a, const N: usize> {
    own: Product<'a, N>,
    rest: Product<'a, N>,
    graphs: [&'a Graph; N],
    leading: usize,
    layers: Vec<Layers>,
    leads: Numbers<(States<N>, Residual)>,
    chances: Numbers<(States<N>, Residual)>,
    /// Steps of the other player's paths, by their states.
    steps: FxHashMap<States<N>, Rc<[JointStep<N>]>>,
    /// By time, letters and states of the leading step, and chance.
    after: FxHashMap<(u32, [Letter; N], States<N>, ChanceIx), After>,
    /// Chances looked at so far.
    pub(super) work: usize,
    pub(super) end: u32,
}

impl<'a, const N: usize> Chances<'a, N> {
    /// `None` where not every atom of the formula can be told.
    pub(super) fn new(
        own: &'a Question<'a, N>,
        rest: &'a Question<'a, N>,
        leading: usize,
        layers: Vec<Layers>,
    ) -> Option<Self> {
        let (own, rest) = (Product::new(own), Product::new(rest));
        let end = own.question.arena.task.end();
        rest.knows_all().then(|| Chances {
            graphs: rest.graphs,
            own,
            rest,
            leading,
            layers,
            leads: Numbers::new(),
            chances: Numbers::new(),
            steps: FxHashMap::default(),
            after: FxHashMap::default(),
            work: 0,
            end,
        })
    }

    pub(super) fn question(&self) -> &'a Question<'a, N> {
        self.rest.question
    }

    /// The number of leading paths.
    pub(super) fn leading(&self) -> usize {
        self.leading
    }

    /// The states of the leading paths.
    pub(super) fn states(&self, lead: LeadIx) -> States<N> {
        self.leads.get(lead).0
    }

    /// Whether nothing more is asked of the leading paths alone.
    pub(super) fn owes_nothing(&self, lead: LeadIx) -> bool {
        self.leads.get(lead).1 == TRUE
    }

    /// Whether a path can be in a state at a time: it can go on, and it matters.
    fn matters(&self, at: usize, state: StateIx, time: u32) -> bool {
        let lasts = self.question().arena.task.lasts(self.graphs[at], state, time);
        lasts && self.layers[at].at.get(time as usize).is_none_or(|layer| layer.binary_search(&state).is_ok())
    }

    /// Every choice of one of each path's options, of the paths in a range.
    fn joint<T: Copy + Default>(
        range: std::ops::Range<usize>,
        options: impl Fn(usize) -> Vec<T>,
    ) -> Vec<[T; N]> {
        let mut all = vec![[T::default(); N]];
        for at in range {
            let own = options(at);
            all = all
                .iter()
                .flat_map(|done| {
                    own.iter()
                        .map(move |&option| std::array::from_fn(|i| if i == at { option } else { done[i] }))
                })
                .collect();
        }
        all
    }

    /// Where the leading paths can begin, each with the chances that there are then; `None` where they lose at once.
    pub(super) fn starts(&mut self) -> Vec<(LeadIx, Option<Vec<ChanceIx>>)> {
        let initial = |this: &Self, at: usize| -> Vec<StateIx> {
            this.graphs[at].initial.iter().copied().filter(|&state| this.matters(at, state, 0)).collect()
        };
        let leads = Self::joint(0..self.leading, |at| initial(self, at));
        let others = Self::joint(self.leading..N, |at| initial(self, at));
        let mut starts = Vec::new();
        for states in leads {
            let Some(lead) = self.lead(&states, &[None; N], self.own.initial, 0) else { continue };
            let mut left = Some(Vec::new());
            for other in &others {
                let places = self.places(&states, &[None; N], other, &[None; N]);
                match (self.chance(&places, other, self.rest.initial, 0), &mut left) {
                    (Chance::Gone, _) | (_, None) => {}
                    (Chance::Left(chance), Some(left)) => left.push(chance),
                    (Chance::Lost, left) => *left = None,
                }
            }
            if let Some(left) = &mut left {
                left.sort_unstable();
                left.dedup();
            }
            starts.push((lead, left));
        }
        starts
    }

    fn places(
        &self,
        lead: &States<N>,
        lead_letters: &[Option<Letter>; N],
        other: &States<N>,
        other_letters: &[Option<Letter>; N],
    ) -> [Place; N] {
        std::array::from_fn(|at| {
            let (states, letters) =
                if at < self.leading { (lead, lead_letters) } else { (other, other_letters) };
            (states[at], letters[at].map(|letter| self.graphs[at].letters[letter as usize].0))
        })
    }

    /// The leading paths as they enter these states; `None` where what is asked of them alone cannot be met any more.
    fn lead(
        &mut self,
        states: &States<N>,
        letters: &[Option<Letter>; N],
        before: Residual,
        time: u32,
    ) -> Option<LeadIx> {
        let places = self.places(states, letters, &[0; N], &[None; N]);
        let bits = self.own.bits(&places, time);
        let left = self.own.progress(before, bits, time);
        (left != FALSE).then(|| self.leads.of((*states, left)))
    }

    fn chance(&mut self, places: &[Place; N], other: &States<N>, before: Residual, time: u32) -> Chance {
        self.work += 1;
        let bits = self.rest.bits(places, time);
        match self.rest.progress(before, bits, time) {
            TRUE => Chance::Gone,
            FALSE => Chance::Lost,
            left => Chance::Left(self.chances.of((*other, left))),
        }
    }

    /// The steps of the leading paths to a time.
    pub(super) fn lead_steps(&mut self, lead: LeadIx, time: u32) -> Vec<LeadStep<N>> {
        let (states, before) = self.leads.get(lead);
        let joint = Self::joint(0..self.leading, |at| self.single_steps(at, states[at], time));
        let mut steps = Vec::with_capacity(joint.len());
        for step in joint {
            let (letters, to) = (step.map(|s| s.0), step.map(|s| s.1));
            if let Some(to) = self.lead(&to, &letters.map(Some), before, time) {
                steps.push(LeadStep { letters, to });
            }
        }
        steps
    }

    fn single_steps(&self, at: usize, state: StateIx, time: u32) -> Vec<(Letter, StateIx)> {
        let all = self.graphs[at].successors(state).iter().copied();
        all.filter(|&(_, to)| self.matters(at, to, time)).collect()
    }

    /// The steps of the other player's paths; which of them matter depends on the time.
    fn other_steps(&mut self, states: &States<N>) -> Rc<[JointStep<N>]> {
        if let Some(known) = self.steps.get(states) {
            return known.clone();
        }
        let joint = Self::joint(self.leading..N, |at| self.graphs[at].successors(states[at]).to_vec());
        let steps: Rc<[JointStep<N>]> =
            joint.into_iter().map(|step| (step.map(|s| s.0), step.map(|s| s.1))).collect();
        self.steps.insert(*states, steps.clone());
        steps
    }

    /// What a step of the leading paths to a time makes of a chance.
    pub(super) fn after(&mut self, step: LeadStep<N>, chance: ChanceIx, time: u32) -> After {
        let lead = self.states(step.to);
        let key = (time, step.letters, lead, chance);
        if let Some(known) = self.after.get(&key) {
            return known.clone();
        }
        let (states, before) = self.chances.get(chance);
        let mut left = Vec::new();
        let mut lost = false;
        for (letters, to) in self.other_steps(&states).iter() {
            if !(self.leading..N).all(|at| self.matters(at, to[at], time)) {
                continue;
            }
            let places = self.places(&lead, &step.letters.map(Some), to, &letters.map(Some));
            match self.chance(&places, to, before, time) {
                Chance::Gone => {}
                Chance::Left(chance) => left.push(chance),
                Chance::Lost => {
                    lost = true;
                    break;
                }
            }
        }
        left.sort_unstable();
        left.dedup();
        let after = if lost { After::Lost } else { After::Left(left.into()) };
        self.after.insert(key, after.clone());
        after
    }
}

/// What becomes of a chance.
enum Chance {
    Gone,
    Left(ChanceIx),
    Lost,
}
