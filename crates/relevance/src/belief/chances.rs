//! The moves of the leading paths, and what they leave of the other player's chances.

use super::Belief;
use super::distance::Distances;
use super::joint::{Numbers, States, joint};
use super::presence::Presence;
use super::untimed::{Goals, Untimed};
use crate::reach::{Place, Product, Question};
use crate::residual::{FALSE, Residual, TRUE};
use crate::task::Error;
use hyperplan_space::{Graph, Letter, Run, StateIx};
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::ops::Range;
use std::rc::Rc;

/// Chances looked at between two questions whether to stop.
const STRIDE: usize = 10_000;

/// Where the leading paths are, and what is left of what the goal asks of them alone.
pub(super) type LeadIx = u32;
/// Where the other player's paths are, and what is left of the goal's rest.
pub(super) type ChanceIx = u32;
/// The states of the other player's paths.
type OtherIx = u32;
/// Where the leading paths begin, and the chances that there are then.
pub(super) type Start = (LeadIx, Vec<ChanceIx>);
/// A step of the leading paths as the others see it: when it is, the actions, and the states that it leads to.
type MoveIx = u32;

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
    /// It may come true: the other player wins.
    Won,
}

/// What becomes of a chance.
enum Chance {
    Gone,
    Left(ChanceIx),
    Won,
}

/// Whose wish the residuals of chances are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wish {
    /// That of the leading paths, beyond what is asked of them alone.
    Leading,
    /// That of the other player.
    Other,
}

/// What is known of steps and chances; all of it is found when it is asked for.
pub(super) struct Chances<'a, const N: usize> {
    own: Product<'a, N>,
    rest: Product<'a, N>,
    graphs: [&'a Graph; N],
    wish: Wish,
    leading: usize,
    /// When each path can matter where.
    present: Vec<Presence>,
    /// Atoms that read the leading paths.
    reading_leads: u64,
    leads: Numbers<(States<N>, Residual)>,
    moves: Numbers<(u32, [Place; N])>,
    others: Numbers<States<N>>,
    chances: Numbers<(OtherIx, Residual)>,
    steps: FxHashMap<OtherIx, Rc<[OtherStep<N>]>>,
    after: FxHashMap<(MoveIx, ChanceIx), After>,
    /// What `after` speaks of.
    left: Vec<ChanceIx>,
    /// How far it is until nothing is asked of the leading paths alone, and until a chance is gone.
    distances: [Distances<N>; 2],
    /// The latter by chance, once it was asked for.
    far: Vec<Option<Option<u32>>>,
    /// For how long they last at least, once it was found out.
    untimed: Option<Untimed<N>>,
    /// The last set in which each chance was, by number.
    stamps: Vec<u32>,
    stamp: u32,
    asked: usize,
    /// Chances looked at so far.
    pub(super) work: usize,
    pub(super) end: u32,
}

impl<'a, const N: usize> Chances<'a, N> {
    /// `None` where not every atom of the formula can be told.
    pub(super) fn new(
        own: &'a Question<'a, N>,
        (wish, rest): (Wish, &'a Question<'a, N>),
        leading: usize,
        present: Vec<Presence>,
    ) -> Option<Self> {
        let (own, rest) = (Product::new(own), Product::new(rest));
        let end = own.question.arena.task.end();
        rest.knows_all().then(|| Chances {
            distances: [Distances::new(&own, 0..leading), Distances::new(&rest, leading..N)],
            graphs: rest.graphs,
            reading_leads: rest.reading_beside(&(leading..N)),
            own,
            rest,
            wish,
            leading,
            present,
            leads: Numbers::new(),
            moves: Numbers::new(),
            others: Numbers::new(),
            chances: Numbers::new(),
            steps: FxHashMap::default(),
            after: FxHashMap::default(),
            left: Vec::new(),
            far: Vec::new(),
            untimed: None,
            stamps: Vec::new(),
            stamp: 0,
            asked: 0,
            work: 0,
            end,
        })
    }

    fn question(&self) -> &'a Question<'a, N> {
        self.rest.question
    }

    /// The states of the leading paths.
    fn states(&self, lead: LeadIx) -> States<N> {
        self.leads.get(lead).0
    }

    /// Whether a path can be in a state at a time: it can go on, and it matters.
    fn matters(&self, at: usize, state: StateIx, time: u32) -> bool {
        let lasts = self.question().arena.task.lasts(self.graphs[at], state, time);
        lasts && self.present[at].allows(state, time)
    }

    /// Where the leading paths can begin, each with the chances that there are then, unless they lose at once; `None` where more
    /// than `budget` chances would have been looked at in all.
    pub(super) fn starts(&mut self, budget: usize) -> Result<Option<Vec<Start>>, Error> {
        let initial = |at: usize| -> Vec<Place> {
            let states = self.graphs[at].initial.iter().filter(|&&state| self.matters(at, state, 0));
            states.map(|&state| (state, None)).collect()
        };
        let many = |paths: Range<usize>| {
            let each = paths.map(|at| self.graphs[at].initial.len());
            each.fold(1_usize, usize::saturating_mul)
        };
        if many(0..self.leading).max(many(self.leading..N)) > budget {
            return Ok(None);
        }
        let leads = joint(0..self.leading, initial);
        let others = joint(self.leading..N, initial);
        let mut starts = Vec::new();
        for lead in leads {
            self.go_on()?;
            if self.work > budget {
                return Ok(None);
            }
            let Some(entered) = self.lead(&lead, self.own.initial, 0) else { continue };
            starts.extend(self.start(&lead, &others).map(|belief| (entered, belief)));
        }
        Ok(Some(starts))
    }

    fn start(&mut self, lead: &[Place; N], others: &[[Place; N]]) -> Option<Vec<ChanceIx>> {
        let mut left = Vec::new();
        for places in others {
            let other = self.others.of(places.map(|place| place.0));
            match self.chance(&self.together(lead, places), other, self.rest.initial, 0) {
                Chance::Gone => {}
                Chance::Left(chance) => left.push(chance),
                Chance::Won => return None,
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
        match (self.rest.progress(before, bits, time), self.wish) {
            (TRUE, Wish::Leading) | (FALSE, Wish::Other) => Chance::Gone,
            (FALSE, Wish::Leading) | (TRUE, Wish::Other) => Chance::Won,
            (left, _) => Chance::Left(self.chances.of((other, left))),
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

    /// A step to a time of leading paths of which nothing is read then.
    pub(super) fn unread_step(&mut self, lead: LeadIx, time: u32) -> LeadStep<N> {
        let seen = self.moves.of((time, [(0, None); N]));
        LeadStep { letters: [0; N], to: lead, seen }
    }

    /// Whether anything of the leading paths is read as long as a chance is open.
    pub(super) fn reads_leads(&mut self, chance: ChanceIx) -> bool {
        let (_, left) = self.chances.get(chance);
        self.rest.residuals.looks_at(left) & self.reading_leads != 0
    }

    /// Sorts chances, those last that are nearest to what is wished for.
    pub(super) fn nearest_last(&mut self, chances: &mut [ChanceIx]) {
        chances.sort_by_cached_key(|&chance| Reverse((self.far(chance).unwrap_or(u32::MAX), chance)));
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
                Chance::Won => {
                    self.left.truncate(first);
                    after = Some(After::Won);
                    break;
                }
            }
        }
        let after = after.unwrap_or(After::Left(first..self.left.len()));
        self.after.insert((step.seen, chance), after.clone());
        after
    }

    /// The belief after a step, or a chance that loses by it.
    pub(super) fn after_all(
        &mut self,
        step: LeadStep<N>,
        belief: &[ChanceIx],
    ) -> Result<Vec<ChanceIx>, ChanceIx> {
        let mut next = Vec::new();
        self.stamp += 1;
        for &chance in belief {
            self.work += 1;
            let After::Left(range) = self.after(step, chance) else { return Err(chance) };
            for at in range {
                let left = self.left[at];
                if stamped(&mut self.stamps, left, self.stamp) {
                    if self.is_late(step, left) {
                        return Err(chance);
                    }
                    next.push(left);
                }
            }
        }
        Ok(next)
    }

    /// Finds out for how long chances last at least, looking at so many steps; whether the leading paths lose by it from the start.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn foresee(&mut self, budget: usize) -> Result<bool, Error> {
        let Some(starts) = self.starts(self.work.saturating_add(budget))? else { return Ok(false) };
        let mut all = Vec::new();
        for (lead, belief) in &starts {
            let lead = self.leads.get(*lead);
            let chances = belief.iter().map(|&chance| (lead, Some(self.half(chance))));
            all.extend(chances);
            all.extend(belief.is_empty().then_some((lead, None)));
        }
        let goals = Goals { own: &mut self.own, rest: &mut self.rest };
        self.untimed = Some(Untimed::new(goals, self.leading, &self.present, &all, budget)?);
        let loses = |chances: &mut Self, (lead, belief): &Start| match belief.as_slice() {
            [] => chances.lasts(*lead, None, 0) > chances.end,
            belief => belief.iter().any(|&chance| chances.lasts(*lead, Some(chance), 0) > chances.end),
        };
        Ok(starts.iter().all(|start| loses(self, start)))
    }

    fn half(&self, chance: ChanceIx) -> (States<N>, Residual) {
        let (other, left) = self.chances.get(chance);
        (self.others.get(other), left)
    }

    /// For how many steps from a time on a chance lasts at least, or what is asked of the leading paths alone does.
    fn lasts(&mut self, lead: LeadIx, chance: Option<ChanceIx>, time: u32) -> u32 {
        let chance = chance.map(|chance| (chance, self.half(chance)));
        let Some(untimed) = &mut self.untimed else { return 0 };
        let goals = Goals { own: &mut self.own, rest: &mut self.rest };
        untimed.steps(goals, (lead, self.leads.get(lead)), chance, time)
    }

    /// Whether a chance will not be gone in time, whatever the leading paths do after a step.
    fn is_late(&mut self, step: LeadStep<N>, chance: ChanceIx) -> bool {
        if self.untimed.is_none() {
            return false;
        }
        let (time, _) = self.moves.get(step.seen);
        time.saturating_add(self.lasts(step.to, Some(chance), time)) > self.end
    }

    /// Whether a chance is in a belief, said fast for many.
    pub(super) fn marked(&mut self, belief: &[ChanceIx]) -> impl Fn(ChanceIx) -> bool {
        self.stamp += 1;
        for &chance in belief {
            stamped(&mut self.stamps, chance, self.stamp);
        }
        |chance| self.stamps.get(chance as usize) == Some(&self.stamp)
    }

    /// Whether the leading paths need do nothing more.
    pub(super) fn is_won(&self, lead: LeadIx, belief: &[ChanceIx]) -> bool {
        belief.is_empty() && self.leads.get(lead).1 == TRUE
    }

    /// How far a belief is from being empty: the logarithm of how many chances there are, where each counts twice as much for
    /// every step that it takes at least until it is gone; the leading paths by themselves count as one more.
    pub(super) fn urgency(&mut self, lead: LeadIx, belief: &[ChanceIx]) -> f64 {
        let (states, left) = self.leads.get(lead);
        let own = self.distances[0].of(&mut self.own, states, left);
        let mut all = vec![f64::from(own.unwrap_or(self.end))];
        for &chance in belief {
            all.push(f64::from(self.far(chance).unwrap_or(self.end)));
        }
        log_sum(all)
    }

    fn far(&mut self, chance: ChanceIx) -> Option<u32> {
        let at = chance as usize;
        if self.far.len() <= at {
            self.far.resize(self.chances.len(), None);
        }
        if let Some(known) = self.far[at] {
            return known;
        }
        let (other, left) = self.chances.get(chance);
        let far = self.distances[1].of(&mut self.rest, self.others.get(other), left);
        self.far[at] = Some(far);
        far
    }

    /// # Errors
    /// [`Error::Interrupted`]; the question is put now and then.
    pub(super) fn go_on(&mut self) -> Result<(), Error> {
        if self.work - self.asked > STRIDE {
            self.asked = self.work;
            self.question().arena.task.go_on()?;
        }
        Ok(())
    }

    /// The runs of the leading paths from where they begin along these steps, and on to where they are read.
    pub(super) fn found(&self, first: LeadIx, steps: &[LeadStep<N>], last: LeadIx) -> Belief<Vec<Run>> {
        let task = &self.question().arena.task;
        let runs = (0..self.leading).map(|at| {
            let path = self.question().paths[at];
            let graph = &self.question().arena.graphs[path];
            let mut letters: Vec<_> = steps.iter().map(|step| step.letters[at]).collect();
            let horizon = task.horizon(path) as usize;
            let mut here = self.states(last)[at];
            while letters.len() < horizon {
                let time = letters.len() as u32 + 1;
                let mut all = graph.successors(here).iter();
                let &(letter, next) = all.find(|&&(_, next)| task.lasts(graph, next, time))?;
                letters.push(letter);
                here = next;
            }
            letters.truncate(horizon);
            Run::replay(graph, self.states(first)[at], letters)
        });
        runs.collect::<Option<Vec<Run>>>().map_or(Belief::Open, Belief::Found)
    }

    /// Chances that [`After::Left`] speaks of.
    pub(super) fn left(&self, range: Range<usize>) -> &[ChanceIx] {
        &self.left[range]
    }
}

/// The base-2 logarithm of the sum of powers of two.
fn log_sum(mut powers: Vec<f64>) -> f64 {
    let most = powers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most == f64::NEG_INFINITY {
        return most;
    }
    // From the smallest to the greatest, so that equal sets have equal sums.
    powers.sort_by(f64::total_cmp);
    most + powers.iter().map(|power| (power - most).exp2()).sum::<f64>().log2()
}

/// Marks a chance as one of the present set; whether it was not before.
fn stamped(stamps: &mut Vec<u32>, chance: ChanceIx, stamp: u32) -> bool {
    let at = chance as usize;
    if stamps.len() <= at {
        stamps.resize(at + 1, 0);
    }
    std::mem::replace(&mut stamps[at], stamp) != stamp
}
