//! Transitions that are listed one by one.

use crate::ids::{ActionId, VarId};
use std::sync::Arc;

/// A transition, seen from its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Edge {
    /// The action.
    pub action: ActionId,
    /// The value that the variable gets.
    pub to: u32,
}

/// The transitions of a graph: one variable moves from value to value, all others stay as they are.
///
/// Each of them means what `on ACTION when v == FROM { v' = TO; }` would; a table finds those of a state without
/// asking a guard of each. Copies share it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edges {
    /// The variable, an enumeration.
    pub var: VarId,
    /// Where the transitions from each value start in `list`, and the end of the last.
    starts: Arc<[usize]>,
    /// By source; those of one source sorted, without repetition.
    list: Arc<[Edge]>,
}

impl Edges {
    /// The table of transitions `(from, edge)` between the first `values` values of a variable; others are left out.
    #[must_use]
    pub fn new(var: VarId, values: usize, mut transitions: Vec<(u32, Edge)>) -> Self {
        transitions.retain(|(from, edge)| (*from as usize) < values && (edge.to as usize) < values);
        transitions.sort_unstable();
        transitions.dedup();
        let mut starts = vec![0; values + 1];
        for (from, _) in &transitions {
            starts[*from as usize + 1] += 1;
        }
        for at in 0..values {
            starts[at + 1] += starts[at];
        }
        let list = transitions.into_iter().map(|(_, edge)| edge).collect();
        Edges { var, starts: starts.into(), list }
    }

    /// The transitions from a value, by action.
    #[must_use]
    pub fn of(&self, from: u32) -> &[Edge] {
        let at = from as usize;
        match (self.starts.get(at), self.starts.get(at + 1)) {
            (Some(&start), Some(&end)) => &self.list[start..end],
            _ => &[],
        }
    }

    /// All transitions with their sources, in order.
    pub fn iter(&self) -> impl Iterator<Item = (u32, Edge)> + '_ {
        let sources = 0..u32::try_from(self.starts.len().saturating_sub(1)).unwrap_or(u32::MAX);
        sources.flat_map(|from| self.of(from).iter().map(move |edge| (from, *edge)))
    }
}

#[cfg(test)]
mod tests {
    use super::{Edge, Edges};
    use crate::ids::{ActionId, VarId};

    #[test]
    fn edges_are_found_by_source() {
        let edge = |action, to| Edge { action: ActionId(action), to };
        let given = vec![(2, edge(1, 0)), (0, edge(0, 2)), (2, edge(0, 2)), (0, edge(0, 2)), (7, edge(0, 0))];
        let edges = Edges::new(VarId(0), 3, given);
        assert_eq!(edges.of(0), [edge(0, 2)]);
        assert_eq!(edges.of(1), []);
        assert_eq!(edges.of(2), [edge(0, 2), edge(1, 0)]);
        assert_eq!(edges.of(3), []);
        assert_eq!(edges.iter().count(), 3);
    }
}
