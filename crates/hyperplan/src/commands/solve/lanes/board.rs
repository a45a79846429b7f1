//! What several processes are to do next: for which value of a constant, and in which way or which case.
//!
//! A value is settled by the first *way* that decides it, or by all of its *cases*, of which one may be enough. Processes that are
//! free take first what is left of values that were begun in cases, then another value, and where there is no other, another way for one
//! that somebody is at already. Without a constant there is one value.

use hyperplan_problem::answer::Verdict;
use std::collections::{BTreeMap, BTreeSet};

/// How a value is settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// By the first that is decided.
    Ways,
    /// By one with this verdict, or all; without it, by all, and one that is realizable is enough.
    Cases(Option<Verdict>),
}

/// Values that may be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    pub(super) low: i64,
    pub(super) high: i64,
    /// Whether a value that is unrealizable says so of all smaller ones.
    pub(super) lasts: bool,
}

/// Where so many values could not be decided others are hardly easier.
const MOST_OPEN: usize = 16;

/// A value, and one of its ways or cases, from 0.
pub(super) type Lane = (i64, usize);

pub(super) struct Board {
    kind: Kind,
    /// How many ways or cases each value has.
    parts: usize,
    range: Range,
    /// The least value known to be realizable.
    best: Option<i64>,
    /// How far from the least that is open the next value is asked, while none is known to be realizable.
    distance: i64,
    asked: BTreeMap<i64, Asked>,
    /// By the numbers of lanes.
    lanes: Vec<Lane>,
    running: BTreeSet<usize>,
}

/// What became of a value.
#[derive(Debug, Default)]
struct Asked {
    /// When it was begun, among all.
    order: usize,
    begun: usize,
    running: usize,
    undecided: usize,
    /// Whether some way or case is realizable.
    realizable: bool,
    verdict: Option<Verdict>,
}

impl Board {
    pub(super) fn new(kind: Kind, parts: usize, range: Range) -> Board {
        Board {
            kind,
            parts,
            range,
            best: None,
            distance: 0,
            asked: BTreeMap::new(),
            lanes: Vec::new(),
            running: BTreeSet::new(),
        }
    }

    /// What the next lane does, if there is something to do.
    pub(super) fn next(&mut self) -> Option<Lane> {
        if self.is_settled() {
            return None;
        }
        let cases = self.kind != Kind::Ways;
        let rest = cases.then(|| self.begun(|asked| asked.order)).flatten();
        let value = rest.or_else(|| self.value()).or_else(|| self.begun(|asked| asked.running))?;
        let order = self.asked.len();
        let asked = self.asked.entry(value).or_insert_with(|| Asked { order, ..Asked::default() });
        let lane = (value, asked.begun);
        (asked.begun, asked.running) = (asked.begun + 1, asked.running + 1);
        self.running.insert(self.lanes.len());
        self.lanes.push(lane);
        Some(lane)
    }

    /// What a lane did.
    pub(super) fn lane(&self, number: usize) -> Lane {
        self.lanes[number]
    }

    /// Hears what a lane found.
    pub(super) fn told(&mut self, number: usize, found: Verdict) {
        let (value, _) = self.lanes[number];
        self.running.remove(&number);
        let Some(asked) = self.asked.get_mut(&value) else { return };
        asked.running -= 1;
        asked.undecided += usize::from(found == Verdict::Unknown);
        asked.realizable |= found == Verdict::Realizable;
        let all = asked.running == 0 && asked.begun == self.parts && asked.undecided == 0;
        let enough = match self.kind {
            Kind::Ways => found != Verdict::Unknown,
            Kind::Cases(decides) => decides == Some(found) || all,
        };
        if asked.verdict.is_some() || !enough {
            return;
        }
        let found = match self.kind {
            Kind::Cases(None) if asked.realizable => Verdict::Realizable,
            _ => found,
        };
        asked.verdict = Some(found);
        match found {
            Verdict::Realizable => self.best = Some(self.best.map_or(value, |best| best.min(value))),
            Verdict::Unrealizable if self.range.lasts => {
                if value >= self.range.low {
                    self.range.low = value + 1;
                    self.distance = self.distance.saturating_mul(2).saturating_add(1);
                }
            }
            _ => {
                while self.verdict(self.range.low) == Some(Verdict::Unrealizable) {
                    self.range.low += 1;
                }
            }
        }
    }

    /// Lanes that run and are of no use any more.
    pub(super) fn moot(&self) -> Vec<usize> {
        let moot = |number: &usize| {
            let (value, _) = self.lanes[*number];
            self.verdict(value).is_some() || !self.is_open(value)
        };
        self.running.iter().copied().filter(moot).collect()
    }

    /// Whether the least value is known, or that there is none.
    pub(super) fn is_settled(&self) -> bool {
        self.range.low >= self.bound()
    }

    /// The least value known to be realizable.
    pub(super) fn best(&self) -> Option<i64> {
        self.best
    }

    /// Smaller values are unrealizable.
    pub(super) fn low(&self) -> i64 {
        self.range.low
    }

    /// Whether larger values than this one can still be asked, for which it should leave time.
    pub(super) fn leaves_time(&self, value: i64) -> bool {
        self.range.lasts && self.best.is_none() && value < self.range.high
    }

    fn verdict(&self, value: i64) -> Option<Verdict> {
        self.asked.get(&value)?.verdict
    }

    /// The first value that need not be asked any more.
    fn bound(&self) -> i64 {
        self.best.unwrap_or(self.range.high + 1)
    }

    fn is_open(&self, value: i64) -> bool {
        (self.range.low..self.bound()).contains(&value)
    }

    /// An open value that was begun and has something left to do, the first by this number.
    fn begun(&self, by: impl Fn(&Asked) -> usize) -> Option<i64> {
        let open = self.asked.range(self.range.low..self.bound());
        let left = open.filter(|(_, asked)| asked.verdict.is_none() && asked.begun < self.parts);
        left.min_by_key(|(value, asked)| (by(asked), **value)).map(|(value, _)| *value)
    }

    /// A value that was not begun: at growing distances while none is known to be realizable, then in the middle of the largest gap
    /// between those that are asked; one after the other where no value says anything of another.
    fn value(&self) -> Option<i64> {
        let idle = |asked: &&Asked| asked.verdict.is_none() && asked.running == 0;
        if self.asked.values().filter(idle).count() >= MOST_OPEN {
            return None;
        }
        let (Range { low, high, lasts }, bound) = (self.range, self.bound());
        let is_new = |value: &i64| !self.asked.contains_key(value);
        if !lasts {
            return (low..bound).find(is_new);
        }
        if self.best.is_none() {
            let mut step = self.distance;
            let mut value = low.saturating_add(step);
            while value < high && !is_new(&value) {
                step = step.saturating_mul(2).saturating_add(1);
                value = value.saturating_add(step);
            }
            if is_new(&value.min(high)) {
                return Some(value.min(high));
            }
        }
        let mut last = low - 1;
        let mut widest: Option<(i64, i64)> = None;
        for value in self.asked.range(low..bound).map(|(value, _)| *value).chain([bound]) {
            if value - last > 1 && widest.is_none_or(|(gap, _)| value - last > gap) {
                widest = Some((value - last, last + (value - last) / 2));
            }
            last = value;
        }
        widest.map(|(_, middle)| middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole searches, with so many processes that end in any order: the least value is found whatever is asked, and nothing is asked twice.
    #[test]
    fn the_least_value_is_found() {
        let mut state = 7u64;
        let mut random = move |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for _ in 0..3000 {
            let lasts = random(2) == 0;
            let (low, high) = (random(5) as i64 - 2, 3 + random(40) as i64);
            let threshold = low + random((high - low + 3) as u64) as i64;
            let holes = random(50);
            let is_realizable = |value: i64| {
                if lasts {
                    value >= threshold
                } else {
                    value >= threshold && !(value as u64 ^ holes).is_multiple_of(3)
                }
            };
            let kind = [
                Kind::Ways,
                Kind::Cases(Some(Verdict::Realizable)),
                Kind::Cases(Some(Verdict::Unrealizable)),
                Kind::Cases(None),
            ][random(4) as usize];
            let parts = 1 + random(4) as usize;
            let mut board = Board::new(kind, parts, Range { low, high, lasts });
            let processes = 1 + random(5) as usize;
            let mut running: Vec<usize> = Vec::new();
            let mut lanes = BTreeSet::new();
            loop {
                while running.len() < processes
                    && let Some(lane) = board.next()
                {
                    running.push(lanes.len());
                    assert!(lanes.insert(lane), "{lane:?} twice");
                }
                if running.is_empty() {
                    break;
                }
                let number = running.swap_remove(random(running.len() as u64) as usize);
                let (value, part) = board.lane(number);
                let verdict = match is_realizable(value) {
                    true => Verdict::Realizable,
                    false => Verdict::Unrealizable,
                };
                let found = match kind {
                    // The last way always decides.
                    Kind::Ways if part + 1 < parts && random(3) == 0 => Verdict::Unknown,
                    // One case has the verdict, the others need not.
                    Kind::Cases(None | Some(Verdict::Realizable))
                        if part > 0 && verdict == Verdict::Realizable =>
                    {
                        [verdict, Verdict::Unrealizable][random(2) as usize]
                    }
                    Kind::Cases(Some(Verdict::Unrealizable))
                        if part > 0 && verdict == Verdict::Unrealizable =>
                    {
                        [verdict, Verdict::Realizable][random(2) as usize]
                    }
                    _ => verdict,
                };
                board.told(number, found);
                let moot = board.moot();
                running.retain(|number| !moot.contains(number));
            }
            assert!(board.is_settled(), "{kind:?} {low}..{high} from {threshold}");
            assert_eq!(board.best(), (low..=high).find(|value| is_realizable(*value)));
        }
    }

    #[test]
    fn values_are_asked_at_growing_distances_and_then_in_between() {
        let mut board = Board::new(Kind::Ways, 2, Range { low: 0, high: 100, lasts: true });
        let begin =
            |board: &mut Board, number: usize| (0..number).filter_map(|_| board.next()).collect::<Vec<_>>();
        assert_eq!(begin(&mut board, 3), [(0, 0), (1, 0), (4, 0)]);
        board.told(1, Verdict::Unrealizable);
        assert_eq!(board.moot(), [0]);
        assert!(board.leaves_time(4));
        board.told(2, Verdict::Realizable);
        assert!(!board.leaves_time(2));
        // What is left has two values, and then other ways.
        assert_eq!(begin(&mut board, 5), [(2, 0), (3, 0), (2, 1), (3, 1)]);
        board.told(3, Verdict::Unknown);
        board.told(6, Verdict::Unrealizable);
        assert!(board.is_settled() && board.best() == Some(4));
    }

    /// A wide range of which nothing can be decided is given up.
    #[test]
    fn what_cannot_be_decided_is_not_asked_without_end() {
        for lasts in [false, true] {
            let range = Range { low: 0, high: 1 << 40, lasts };
            let mut board = Board::new(Kind::Ways, 3, range);
            let mut lanes = 0;
            while board.next().is_some() {
                board.told(lanes, Verdict::Unknown);
                lanes += 1;
            }
            assert!(!board.is_settled() && lanes <= 3 * MOST_OPEN, "{lanes}");
        }
    }

    #[test]
    fn undecided_cases_leave_a_value_open() {
        let range = Range { low: 0, high: 0, lasts: false };
        let mut board = Board::new(Kind::Cases(Some(Verdict::Realizable)), 3, range);
        while board.next().is_some() {}
        board.told(0, Verdict::Unrealizable);
        board.told(1, Verdict::Unknown);
        board.told(2, Verdict::Unrealizable);
        assert!(!board.is_settled() && board.next().is_none());
    }
}
