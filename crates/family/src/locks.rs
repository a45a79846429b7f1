//! Counters: a lock with two dials that turn each other. Nothing is near or far, so that neither distance nor shape tells a
//! solver where to look, and arithmetic modulo two numbers without a common divisor wipes out what is known of one dial from
//! the other.

use crate::parameters::Parameters;
use crate::random::Random;

/// What is asked of the dials.
pub(crate) const OBJECTIVE: &str = "\
objective locks {
  exists p. forall q.
    first[p] & F[0,T] goal[p] & (start[q] & G[0,T] action[p] == action[q] -> F[0,T] goal[q])
}";

/// The stream of its numbers, apart from those of all maps.
const STREAM: u64 = 5_000_000;

/// The dials have `size` and `size + 1` positions. `below` of these say, in this order, where the dials are at the first
/// start, at the second, and at the goal; what is one at the goal is moved on by one.
pub(crate) fn system(Parameters { size, seed, .. }: Parameters) -> String {
    let mut random = Random::new(seed, STREAM + u64::from(size));
    let mut place = || (random.below(size), random.below(size + 1));
    let (first, second, goal) = (place(), place(), place());
    let moved = |at: (u32, u32)| if at == goal { ((at.0 + 1) % size, at.1) } else { at };
    let is = |(a, b): (u32, u32)| format!("a == {a} & b == {b}");
    let (first, second) = (moved(first), moved(second));
    format!(
        "system Dials {{\n  state a: 0..{}, b: 0..{size};\n  action twist, press, pull;\n  \
         on twist {{ a' = (a + 1) % {size}; b' = (b + a) % {n}; }}\n  \
         on press {{ a' = 2 * a % {size}; }}\n  \
         on pull {{ b' = (2 * b + 1) % {n}; }}\n  \
         absorb goal;\n  init start;\n  \
         label first = {};\n  label start = first | {};\n  label goal = {};\n}}\n\n",
        size - 1,
        is(first),
        is(second),
        is(goal),
        n = size + 1,
    )
}

/// Of random pairs of places some sequence of about as many actions as their number has digits meets each other; this is
/// several times that.
pub(crate) fn most_steps(Parameters { size, .. }: Parameters) -> u32 {
    8 * (u32::BITS - size.leading_zeros())
}
