//! The moves of the leading paths, and what they leave of the other player's chances.

use crate::layers::Layers;
use crate::reach::{Place, Product, Question};
use crate::residual::{FALSE, Residual, TRUE};
use hyperplan_space::{Graph, Letter, StateIx};
use rustc_hash::FxHashMap;
use std::hash::Hash;
use std::ops::Range;
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
/// The states of the other player's paths.
type OtherIx = u32;
/// A step of the leading paths as the others see it: when it is, the actions, and the states that it leads to.
type MoveIx = u32;

/// States of all paths; those of the paths that are not meant are 0.
type States<const N: usize> = [StateIx; N];

/// A joint step of the other player's paths.
#[derive(Clone, Copy, Debug)]
struct OtherStep<const N: usize> {
    places: [Place; N],
    to: OtherIx,
}

/// A step of the leading paths.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeadStep<const N: usize> {
    pub(super) letters: [Letter; N],
    pub(super) to: LeadIx,
    seen: MoveIx,
}

/// What a step of the leading paths makes of one chance.
#[derive(Clone, Debug)]
pub(super) enum After {
    /// It may become any of these, by their places among all that were found.
    Left(Range<usize>),
    /// It may come true: the leading paths lose.
    Lost,
}

/// What becomes of a chance.
enum Chance {
    Gone,
    Left(ChanceIx),
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
    moves: Numbers<(u32, [Place; N])>,
    others: Numbers<States<N>>,
    chances: Numbers<(OtherIx, Residual)>,
    steps: FxHashMap<OtherIx, Rc<[OtherStep<N>]>>,
    after: FxHashMap<(MoveIx, ChanceIx), After>,
    /// What `after` speaks of.
    left: Vec<ChanceIx>,
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
            moves: Numbers::new(),
            others: Numbers::new(),
            chances: Numbers::new(),
            steps: FxHashMap::default(),
            after: FxHashMap::default(),
            left: Vec::new(),
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

    /// Where the leading paths can begin, each with the chances that there are then; `None` where they lose at once.
    pub(super) fn starts(&mut self) -> Vec<(LeadIx, Option<Vec<ChanceIx>>)> {
        let initial = |at: usize| -> Vec<Place> {
            let states = self.graphs[at].initial.iter().filter(|&&state| self.matters(at, state, 0));
            states.map(|&state| (state, None)).collect()
        };
        let leads = joint(0..self.leading, initial);
        let others = joint(self.leading..N, initial);
        let mut starts = Vec::new();
        for lead in leads {
            let Some(entered) = self.lead(&lead, self.own.initial, 0) else { continue };
            starts.push((entered, self.start(&lead, &others)));
        }
        starts
    }

    fn start(&mut self, lead: &[Place; N], others: &[[Place; N]]) -> Option<Vec<ChanceIx>> {
        let mut left = Vec::new();
        for places in others {
            let other = self.others.of(places.map(|place| place.0));
            match self.chance(&self.together(lead, places), other, self.rest.initial, 0) {
                Chance::Gone => {}
                Chance::Left(chance) => left.push(chance),
                Chance::Lost => return None,
            }
        }
        Some(left)
    }

    fn together(&self, lead: &[Place; N], other: &[Place; N]) -> [Place; N] {
        std::array::from_fn(|at| if at < self.leading { lead[at] } else { other[at] })
    }

    /// The leading paths as they enter these places; `None` where what is asked of them alone cannot be met any more.
    fn lead(&mut self, places: &[Place; N], before: Residual, time: u32) -> Option<LeadIx> {
        let bits = self.own.bits(places, time);
        let left = self.own.progress(before, bits, time);
        (left != FALSE).then(|| self.leads.of((places.map(|place| place.0), left)))
    }

    fn chance(&mut self, places: &[Place; N], other: OtherIx, before: Residual, time: u32) -> Chance {
        self.work += 1;
        let bits = self.rest.bits(places, time);
        match self.rest.progress(before, bits, time) {
            TRUE => Chance::Gone,
            FALSE => Chance::Lost,
            left => Chance::Left(self.chances.of((other, left))),
        }
    }

    /// The steps of the leading paths to a time.
    pub(super) fn lead_steps(&mut self, lead: LeadIx, time: u32) -> Vec<LeadStep<N>> {
        let (states, before) = self.leads.get(lead);
        let single = |at: usize| -> Vec<(Letter, StateIx)> {
            let all = self.graphs[at].successors(states[at]).iter().copied();
            all.filter(|&(_, to)| self.matters(at, to, time)).collect()
        };
        let all = joint(0..self.leading, single);
        let mut steps = Vec::with_capacity(all.len());
        for step in all {
            let places = self.places(&step, 0..self.leading);
            if let Some(to) = self.lead(&places, before, time) {
                let seen = self.moves.of((time, places));
                steps.push(LeadStep { letters: step.map(|s| s.0), to, seen });
            }
        }
        steps
    }

    fn places(&self, step: &[(Letter, StateIx); N], meant: Range<usize>) -> [Place; N] {
        std::array::from_fn(|at| {
            let (letter, to) = step[at];
            (to, meant.contains(&at).then(|| self.graphs[at].letters[letter as usize].0))
        })
    }

    /// The steps of the other player's paths; which of them matter depends on the time.
    fn other_steps(&mut self, other: OtherIx) -> Rc<[OtherStep<N>]> {
        if let Some(known) = self.steps.get(&other) {
            return known.clone();
        }
        let states = self.others.get(other);
        let all = joint(self.leading..N, |at| self.graphs[at].successors(states[at]).to_vec());
        let mut steps = Vec::with_capacity(all.len());
        for step in all {
            let places = self.places(&step, self.leading..N);
            steps.push(OtherStep { places, to: self.others.of(step.map(|s| s.1)) });
        }
        let steps: Rc<[OtherStep<N>]> = steps.into();
        self.steps.insert(other, steps.clone());
        steps
    }

    /// What a step of the leading paths to a time makes of a chance.
    pub(super) fn after(&mut self, step: LeadStep<N>, chance: ChanceIx) -> After {
        if let Some(known) = self.after.get(&(step.seen, chance)) {
            return known.clone();
        }
        let (time, lead) = self.moves.get(step.seen);
        let (other, before) = self.chances.get(chance);
        let first = self.left.len();
        let mut after = None;
        for step in self.other_steps(other).iter() {
            if !(self.leading..N).all(|at| self.matters(at, step.places[at].0, time)) {
                continue;
            }
            match self.chance(&self.together(&lead, &step.places), step.to, before, time) {
                Chance::Gone => {}
                Chance::Left(chance) => self.left.push(chance),
                Chance::Lost => {
                    self.left.truncate(first);
                    after = Some(After::Lost);
                    break;
                }
            }
        }
        let after = after.unwrap_or(After::Left(first..self.left.len()));
        self.after.insert((step.seen, chance), after.clone());
        after
    }

    /// Chances that [`After::Left`] speaks of.
    pub(super) fn left(&self, range: Range<usize>) -> &[ChanceIx] {
        &self.left[range]
    }
}

/// Every choice of one of each path's options, of the paths in a range.
fn joint<T: Copy + Default, const N: usize>(
    range: Range<usize>,
    options: impl Fn(usize) -> Vec<T>,
) -> Vec<[T; N]> {
    let mut all = vec![[T::default(); N]];
    for at in range {
        let own = options(at);
        let with = |done: &[T; N]| {
            let done = *done;
            own.iter().map(move |&option| std::array::from_fn(|i| if i == at { option } else { done[i] }))
        };
        all = all.iter().flat_map(with).collect();
    }
    all
}
