//! A set of nodes that gives them in order.

use crate::term::Term;

/// Nodes as bits, with summaries: bit `i` of a level says whether word `i` of the level below has any. That takes
/// hardly more than a bit for each node of the arena, and finds the least and the greatest without a search.
#[derive(Default)]
pub(crate) struct NodeSet {
    /// From the nodes' own bits to a level of one word.
    levels: Vec<Vec<u64>>,
    count: usize,
    /// Where the last node was taken from or put: the next is mostly beside it.
    low: usize,
    high: usize,
}

const BITS: usize = u64::BITS as usize;

impl NodeSet {
    /// Makes room for nodes with smaller indices.
    pub(crate) fn grow(&mut self, nodes: usize) {
        let mut words = nodes.div_ceil(BITS);
        for level in 0.. {
            if level == self.levels.len() {
                let below = self.levels.last().and_then(|below| below.first()).copied().unwrap_or(0);
                self.levels.push(vec![u64::from(below != 0)]);
            }
            let bits = &mut self.levels[level];
            bits.resize(words.max(bits.len()), 0);
            if bits.len() <= 1 {
                break;
            }
            words = bits.len().div_ceil(BITS);
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Adds a node, complemented or not. There must be room for it.
    #[inline]
    pub(crate) fn insert(&mut self, t: Term) {
        let mut index = t.index();
        self.low = self.low.min(index / BITS);
        self.high = self.high.max(index / BITS);
        for (height, level) in self.levels.iter_mut().enumerate() {
            let word = &mut level[index / BITS];
            let (old, new) = (*word, *word | 1 << (index % BITS));
            *word = new;
            self.count += usize::from(height == 0 && old != new);
            if old != 0 {
                return;
            }
            index /= BITS;
        }
    }

    /// Takes the node with the least index out.
    pub(crate) fn pop_first(&mut self) -> Option<Term> {
        let first = |word: u64| word.trailing_zeros() as usize;
        self.low = self.nearest(self.low, first)?;
        Some(self.pop(self.low, first))
    }

    /// Takes the node with the greatest index out.
    pub(crate) fn pop_last(&mut self) -> Option<Term> {
        let last = |word: u64| BITS - 1 - word.leading_zeros() as usize;
        self.high = self.nearest(self.high, last)?;
        Some(self.pop(self.high, last))
    }

    /// The first word with a node in that order: the one there, or, if it is empty, the one that the summaries tell.
    #[inline]
    fn nearest(&self, there: usize, bit: impl Fn(u64) -> usize) -> Option<usize> {
        if self.count == 0 {
            return None;
        }
        let (words, summaries) = self.levels.split_first()?;
        if words[there] != 0 {
            return Some(there);
        }
        Some(summaries.iter().rev().fold(0, |at, level| at * BITS + bit(level[at])))
    }

    #[inline]
    fn pop(&mut self, at: usize, bit: impl Fn(u64) -> usize) -> Term {
        let index = at * BITS + bit(self.levels[0][at]);
        self.count -= 1;
        let mut rest = index;
        for level in &mut self.levels {
            let word = &mut level[rest / BITS];
            *word &= !(1 << (rest % BITS));
            if *word != 0 {
                break;
            }
            rest /= BITS;
        }
        Term::of_index(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gives_nodes_in_order() {
        let mut set = NodeSet::default();
        let mut all = Vec::new();
        for room in [1, 64, 65, 5_000, 300_000] {
            set.grow(room);
            for step in [1, 7, 63, 64, 4_097] {
                let new = (room / 2..room).step_by(step * 3);
                all.extend(new.clone());
                new.for_each(|index| set.insert(Term::of_index(index)));
            }
        }
        all.sort_unstable();
        all.dedup();
        assert_eq!(set.len(), all.len());
        let (low, high) = all.split_at(all.len() / 2);
        let first: Vec<usize> = low.iter().filter_map(|_| set.pop_first()).map(Term::index).collect();
        assert_eq!(first, low);
        let mut last: Vec<usize> = std::iter::from_fn(|| set.pop_last()).map(Term::index).collect();
        last.reverse();
        assert_eq!(last, high);
        assert!(set.len() == 0 && set.pop_first().is_none());
        set.insert(Term::of_index(299_999));
        assert_eq!(set.pop_first(), Some(Term::of_index(299_999)));
    }
}
