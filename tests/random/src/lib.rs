//! The random choices of all tests: [`Random`], which generators of trees, texts and problems draw from.
//!
//! Choices come from a seed, where tests name the seed that fails, or from a list, where proptest finds a shorter and
//! simpler one that fails as well ([`property`]): a generator need not know which. Smaller numbers should mean simpler
//! things, and a list that has come to its end means 0 from then on, so no generator may wait for another number.
//! (`family` has numbers of its own: its maps are published, and made by a generator with a name.)

use proptest::collection::vec;
use proptest::num::u32;
use proptest::test_runner::{Config, RngSeed, TestRunner};

/// A reproducible source of numbers.
pub struct Random(Box<dyn Iterator<Item = u64>>);

impl Random {
    /// The same seed gives the same numbers everywhere (SplitMix64: Steele, Lea, Flood, *Fast Splittable Pseudorandom
    /// Number Generators*, 2014).
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut state = seed;
        Random(Box::new(std::iter::repeat_with(move || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        })))
    }

    /// These numbers, and 0 after them.
    #[must_use]
    pub fn of(choices: Vec<u32>) -> Self {
        Random(Box::new(choices.into_iter().map(u64::from)))
    }

    /// A number.
    pub fn number(&mut self) -> u64 {
        self.0.next().unwrap_or(0)
    }

    /// A number below `n`, which must not be 0.
    pub fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.number() % n as u64).unwrap_or(0)
    }

    /// The same for numbers of 32 bits.
    pub fn bound(&mut self, n: u32) -> u32 {
        u32::try_from(self.number() % u64::from(n)).unwrap_or(0)
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    /// True half of the time.
    pub fn flip(&mut self) -> bool {
        self.once_in(2)
    }

    /// One of them; there must be some.
    pub fn one<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.below(of.len())]
    }

    /// Some of the numbers below `n`, each once in so many times.
    pub fn subset(&mut self, n: usize, once_in: usize) -> Vec<usize> {
        (0..n).filter(|_| self.once_in(once_in)).collect()
    }
}

/// Tries a property on so many random lists of at most so many choices.
///
/// # Panics
/// If it panics on one: with what it says of the simplest list that was found, and that list (see [`Random::of`]).
pub fn property(cases: u32, choices: usize, property: impl Fn(&mut Random)) {
    let seed = RngSeed::Fixed(20_260_101);
    let config = Config {
        cases,
        rng_seed: seed,
        failure_persistence: None,
        max_shrink_iters: 1 << 16,
        ..Config::default()
    };
    let tried = TestRunner::new(config).run(&vec(u32::ANY, 0..=choices), |choices| {
        property(&mut Random::of(choices));
        Ok(())
    });
    if let Err(failure) = tried {
        panic!("{failure}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::catch_unwind;

    #[test]
    fn numbers_are_the_published_ones() {
        let mut random = Random::new(1_234_567);
        let numbers: Vec<u64> = (0..3).map(|_| random.number()).collect();
        assert_eq!(
            numbers,
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]
        );
    }

    #[test]
    fn what_fails_is_made_simple() {
        let failure = catch_unwind(|| {
            property(1000, 50, |random| {
                let numbers: Vec<u64> = (0..20).map(|_| random.number()).collect();
                assert!(numbers.iter().all(|&n| n < 1000), "a number of {} is too large", numbers.len());
            });
        });
        let message =
            *failure.expect_err("most lists have such a number").downcast::<String>().expect("a message");
        assert!(message.contains("a number of 20") && message.contains("[\n    1000,\n]"), "{message}");
    }
}
