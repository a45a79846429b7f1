//! Putting declarations in an order in which each reads only earlier ones.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An order of declarations that read each other, and what is left over because of cycles.
#[derive(Debug)]
pub(super) struct Order {
    /// Declarations in an order that works; of several that could be next the first declared is.
    pub(super) sorted: Vec<usize>,
    /// Declarations that read themselves, or something that does, in order of declaration.
    pub(super) stuck: Vec<usize>,
    /// The declarations of one cycle, each reading the next; empty if nothing is stuck.
    pub(super) cycle: Vec<usize>,
}

/// Sorts declarations; `reads[i]` are those that `i` reads, without repetition.
pub(super) fn sort(reads: &[Vec<usize>]) -> Order {
    let mut readers = vec![Vec::new(); reads.len()];
    let mut missing: Vec<usize> = reads.iter().map(Vec::len).collect();
    for (reader, read) in reads.iter().enumerate() {
        for other in read {
            readers[*other].push(reader);
        }
    }
    let free = missing.iter().enumerate().filter(|(_, n)| **n == 0);
    let mut ready: BinaryHeap<Reverse<usize>> = free.map(|(index, _)| Reverse(index)).collect();
    let mut sorted = Vec::with_capacity(reads.len());
    while let Some(Reverse(next)) = ready.pop() {
        sorted.push(next);
        for reader in &readers[next] {
            missing[*reader] -= 1;
            if missing[*reader] == 0 {
                ready.push(Reverse(*reader));
            }
        }
    }
    let stuck: Vec<usize> = (0..reads.len()).filter(|index| missing[*index] > 0).collect();
    let cycle = cycle(reads, &missing, &stuck);
    Order { sorted, stuck, cycle }
}

/// Whatever is stuck reads something that is stuck: walking on for as many steps as there are declarations ends in a
/// cycle.
fn cycle(reads: &[Vec<usize>], missing: &[usize], stuck: &[usize]) -> Vec<usize> {
    let next = |from: usize| reads[from].iter().copied().find(|read| missing[*read] > 0);
    let Some(start) = stuck.first() else { return Vec::new() };
    let Some(first) = (0..reads.len()).try_fold(*start, |at, _| next(at)) else { return Vec::new() };
    let mut cycle = vec![first];
    while let Some(read) = next(cycle[cycle.len() - 1]).filter(|read| *read != first) {
        cycle.push(read);
    }
    cycle
}
