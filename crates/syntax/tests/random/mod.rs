//! Random trees and damaged texts, the same for the same seed everywhere, and what has to hold of them. Nothing here
//! knows the test harness: the crate with the bodies of the fuzzers includes the folder as it is.
#![allow(unreachable_pub, reason = "included by several tests")]

pub mod damage;
pub mod roundtrip;
pub mod tree;

/// A reproducible source of numbers (SplitMix64).
pub struct Random(pub u64);

impl Random {
    /// A number below `n`, which must not be 0.
    pub fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        usize::try_from((z ^ (z >> 31)) % n as u64).unwrap_or(0)
    }

    /// True half of the time.
    pub fn flip(&mut self) -> bool {
        self.below(2) == 0
    }

    /// One of them; there must be some.
    pub fn one<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.below(of.len())]
    }
}
