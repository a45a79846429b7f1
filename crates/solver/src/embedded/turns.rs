//! Two SAT solvers that take turns.
//!
//! A dialogue has many queries, and most are easy. At these `BatSat` is ahead, because it simplifies nothing; of those that are
//! hard `CaDiCaL` decides more. Which is which cannot be told from the query. So each has a turn, longer every time, and who
//! answered last begins: a query takes at most about three times the effort that the better one needs.
//! `docs/performance.md` compares them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::backend::{Backend, Setup};
use super::batsat::BatSat;
use super::cadical::Cadical;

/// The effort of the first turn: some tenths of a second.
const FIRST: u64 = 20_000_000;

/// Both solvers.
pub(super) struct Turns {
    quick: BatSat,
    thorough: Cadical,
    /// Clauses that the second has not been given yet, a 0 after each: perhaps it is never asked.
    waiting: Vec<i32>,
    /// The effort of the first turn of each.
    first: u64,
    /// Whether the second one answered last.
    thoroughly: bool,
    stop: Arc<AtomicBool>,
}

impl Turns {
    /// One solver's turn.
    fn turn(&mut self, assumptions: &[i32], effort: u64) -> Option<bool> {
        if !self.thoroughly {
            return self.quick.solve(assumptions, Some(effort));
        }
        for clause in self.waiting.split_inclusive(|&number| number == 0) {
            self.thorough.clause(&clause[..clause.len() - 1]);
        }
        self.waiting.clear();
        self.thorough.solve(assumptions, Some(effort))
    }
}

impl Backend for Turns {
    fn signature() -> String {
        format!("{}, {}", Cadical::signature(), BatSat::signature())
    }

    fn new(setup: &Setup) -> Result<Turns, String> {
        let (quick, thorough) = (BatSat::new(setup)?, Cadical::new(setup)?);
        let stop = Arc::clone(&setup.stop);
        Ok(Turns { quick, thorough, waiting: Vec::new(), first: FIRST, thoroughly: false, stop })
    }

    fn clause(&mut self, literals: &[i32]) {
        self.quick.clause(literals);
        self.waiting.extend(literals);
        self.waiting.push(0);
    }

    fn solve(&mut self, assumptions: &[i32], effort: Option<u64>) -> Option<bool> {
        let (mut left, mut length) = (effort.unwrap_or(u64::MAX), self.first);
        loop {
            // Both have turns of the same length.
            for _ in 0..2 {
                let share = length.min(left);
                left -= share;
                let answer = self.turn(assumptions, share);
                if answer.is_some() || left == 0 || self.stop.load(Ordering::Relaxed) {
                    return answer;
                }
                self.thoroughly = !self.thoroughly;
            }
            length = length.saturating_mul(2);
        }
    }

    fn model(&mut self) -> Vec<bool> {
        if self.thoroughly { self.thorough.model() } else { self.quick.model() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_random::{Random, property};

    const VARIABLES: u32 = 10;

    fn literal(random: &mut Random) -> i32 {
        let variable = i32::try_from(1 + random.bound(VARIABLES)).expect("it is small");
        if random.flip() { -variable } else { variable }
    }

    fn literals(random: &mut Random, least: usize, most: usize) -> Vec<i32> {
        (0..least + random.below(most + 1 - least)).map(|_| literal(random)).collect()
    }

    fn holds(clause: &[i32], value: impl Fn(u32) -> bool) -> bool {
        clause.iter().any(|&literal| value(literal.unsigned_abs() - 1) == (literal > 0))
    }

    /// The assumptions are clauses of one literal.
    fn satisfiable(clauses: &[Vec<i32>], assumptions: &[i32]) -> bool {
        let all = || clauses.iter().map(Vec::as_slice).chain(assumptions.chunks(1));
        (0_u32..1 << VARIABLES).any(|values| all().all(|clause| holds(clause, |at| values >> at & 1 == 1)))
    }

    /// Turns are so short that it is now one, now the other.
    #[test]
    fn answers_are_right_whoever_gives_them() {
        property(300, 600, |random| {
            let setup = Setup { seed: 0, dialogue: true, stop: Arc::default() };
            let mut solver = Turns::new(&setup).expect("it has its options");
            solver.first = 1 + u64::from(random.bound(3_000));
            let mut all: Vec<Vec<i32>> = Vec::new();
            for _ in 0..=random.below(3) {
                for _ in 0..5 + random.below(25) {
                    all.push(literals(random, 2, 3));
                    solver.clause(&all[all.len() - 1]);
                }
                let assumptions = literals(random, 0, 2);
                let answer = solver.solve(&assumptions, None);
                assert_eq!(answer, Some(satisfiable(&all, &assumptions)), "{all:?} {assumptions:?}");
                let model = if answer == Some(true) { solver.model() } else { continue };
                let value = |at: u32| model.get(at as usize).copied().unwrap_or_default();
                for clause in all.iter().map(Vec::as_slice).chain(assumptions.chunks(1)) {
                    assert!(holds(clause, value), "{model:?} of {all:?} {assumptions:?}");
                }
            }
        });
    }

    #[test]
    fn who_does_not_answer_in_a_turn_makes_room() {
        let setup = Setup { seed: 0, dialogue: true, stop: Arc::default() };
        let mut solver = Turns { first: 1, ..Turns::new(&setup).expect("it has its options") };
        // Pigeons: six of them, five holes.
        let at = |pigeon: i32, hole: i32| pigeon * 5 + hole + 1;
        for pigeon in 0..6 {
            solver.clause(&(0..5).map(|hole| at(pigeon, hole)).collect::<Vec<_>>());
            for (other, hole) in (0..pigeon).flat_map(|other| (0..5).map(move |hole| (other, hole))) {
                solver.clause(&[-at(pigeon, hole), -at(other, hole)]);
            }
        }
        assert_eq!(solver.solve(&[], Some(1)), None);
        assert!(!solver.waiting.is_empty(), "the second has not had a turn");
        assert_eq!(solver.solve(&[], Some(3)), None);
        assert!(solver.waiting.is_empty(), "the second has had one");
        assert_eq!(solver.solve(&[], None), Some(false));
    }
}
