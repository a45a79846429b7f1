//! Random numbers that are the same everywhere.

use rand_core::Rng as _;
use rand_pcg::Pcg32;

/// Numbers drawn from a seed. The generator is PCG-XSH-RR 64/32 ("PCG32": O'Neill, *PCG: A Family of Simple Fast
/// Space-Efficient Statistically Good Algorithms for Random Number Generation*, 2014), whose output is fixed by its
/// definition; how numbers below a bound are made of it is fixed here, since libraries change that now and then.
pub(crate) struct Random(Pcg32);

impl Random {
    /// The numbers of a seed; streams of one seed are independent of each other.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        Random(Pcg32::new(seed, stream))
    }

    /// A number below a bound, each as likely as the others: the generator's next number that is no part of the
    /// incomplete run at the low end, modulo the bound. A bound of 0 gives 0.
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        if bound == 0 {
            return 0;
        }
        let incomplete = bound.wrapping_neg() % bound;
        loop {
            let number = self.0.next_u32();
            if number >= incomplete {
                return number % bound;
            }
        }
    }

    /// Puts some of the things first, each as likely as the others: the beginning of a Fisher-Yates shuffle.
    pub(crate) fn shuffle<T>(&mut self, things: &mut [T], first: u32) {
        let count = u32::try_from(things.len()).unwrap_or(u32::MAX);
        for i in 0..first.min(count) {
            things.swap(i as usize, (i + self.below(count - i)) as usize);
        }
    }

    /// One of some things.
    pub(crate) fn choose<'a, T>(&mut self, things: &'a [T]) -> Option<&'a T> {
        let count = u32::try_from(things.len()).unwrap_or(u32::MAX);
        things.get(self.below(count) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers that the generator's own demonstration prints for seed 42, stream 54.
    #[test]
    fn the_generator_is_the_published_one() {
        let mut random = Random::new(42, 54);
        let numbers: Vec<u32> = (0..6).map(|_| random.0.next_u32()).collect();
        assert_eq!(numbers, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
    }

    #[test]
    fn numbers_are_below_their_bound() {
        let mut random = Random::new(1, 2);
        for bound in [1, 2, 3, 7, 1 << 31, u32::MAX] {
            assert!((0..100).all(|_| random.below(bound) < bound));
        }
        assert_eq!(random.below(0), 0);
        let mut seen = [0_u32; 5];
        (0..1000).for_each(|_| seen[random.below(5) as usize] += 1);
        assert!(seen.iter().all(|&n| n > 150), "{seen:?}");
    }
}
