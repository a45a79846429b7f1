//! Transitions that are listed one by one.

use crate::ids::{ActionId, AttributeId, VarId};
use std::sync::Arc;
use typed_index_collections::{TiSlice, TiVec};

/// A transition, seen from its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Edge {
    /// The action.
    pub action: ActionId,
    /// The value that the variable gets.
    pub to: u32,
}

/// The attribute that transitions have where it is known where values lie.
const DISTANCE: &str = "distance";

/// A number that transitions carry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// It is not in the file, but follows from where the ends of transitions lie: what the problem calls so comes first.
    pub derived: bool,
    /// The number of each transition, by its position in the table.
    numbers: Arc<[i64]>,
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
    attributes: Arc<TiSlice<AttributeId, Attribute>>,
}

impl Edges {
    /// The table of transitions `(from, edge)` between the first `values` values of a variable; others are left out.
    #[must_use]
    pub fn new(var: VarId, values: usize, transitions: Vec<(u32, Edge)>) -> Self {
        let bare = transitions.into_iter().map(|(from, edge)| (from, edge, Vec::new())).collect();
        Edges::with_attributes(var, values, &[], bare)
    }

    /// The same with a number for each attribute: 0 for those that a transition does not have. Of equal transitions the
    /// one with the smaller numbers counts.
    #[must_use]
    pub fn with_attributes(
        var: VarId,
        values: usize,
        names: &[String],
        mut transitions: Vec<(u32, Edge, Vec<i64>)>,
    ) -> Self {
        transitions.retain(|(from, edge, _)| (*from as usize) < values && (edge.to as usize) < values);
        transitions.sort_unstable();
        transitions.dedup_by_key(|(from, edge, _)| (*from, *edge));
        let mut starts = vec![0; values + 1];
        for (from, ..) in &transitions {
            starts[*from as usize + 1] += 1;
        }
        for at in 0..values {
            starts[at + 1] += starts[at];
        }
        let attribute = |(at, name): (usize, &String)| Attribute {
            name: name.clone(),
            derived: false,
            numbers: transitions.iter().map(|(.., own)| own.get(at).copied().unwrap_or(0)).collect(),
        };
        let attributes: TiVec<AttributeId, Attribute> = names.iter().enumerate().map(attribute).collect();
        let list = transitions.iter().map(|(_, edge, _)| *edge).collect();
        Edges { var, starts: starts.into(), list, attributes: attributes.into_boxed_slice().into() }
    }

    /// The same with one more attribute, `distance`, unless the file has it: how far the ends of each transition are from each
    /// other, in thousandths of the unit in which values lie at these places, rounded.
    #[must_use]
    pub fn with_distances(mut self, places: &[(f64, f64)]) -> Self {
        if self.attributes.iter().any(|attribute| attribute.name == DISTANCE) {
            return self;
        }
        let place = |value: u32| places.get(value as usize).copied().unwrap_or_default();
        let distance = |(from, edge): (u32, Edge)| {
            let ((x, y), (u, v)) = (place(from), place(edge.to));
            // Places are within 10^9 units, so this is far from the limits of either type.
            (1000.0 * (u - x).hypot(v - y)).round() as i64
        };
        let numbers = self.iter().map(distance).collect();
        let mut attributes: Vec<Attribute> = self.attributes.iter().cloned().collect();
        attributes.push(Attribute { name: DISTANCE.to_owned(), derived: true, numbers });
        self.attributes = TiVec::from(attributes).into_boxed_slice().into();
        self
    }

    /// What numbers transitions carry.
    #[must_use]
    pub fn attributes(&self) -> &TiSlice<AttributeId, Attribute> {
        &self.attributes
    }

    /// The number of a transition, given by its position in the table.
    #[must_use]
    pub fn number(&self, at: usize, attribute: AttributeId) -> i64 {
        let numbers = self.attributes.get(attribute).map(|attribute| &attribute.numbers);
        numbers.and_then(|numbers| numbers.get(at)).copied().unwrap_or(0)
    }

    /// The least and greatest number that an attribute has.
    #[must_use]
    pub fn numbers_between(&self, attribute: AttributeId) -> (i64, i64) {
        let numbers = self.attributes.get(attribute).map_or(&[][..], |attribute| &attribute.numbers);
        // A step that follows no listed transition reads 0.
        (numbers.iter().copied().fold(0, i64::min), numbers.iter().copied().fold(0, i64::max))
    }

    /// The transitions from a value with their positions in the table.
    pub fn numbered(&self, from: u32) -> impl Iterator<Item = (usize, Edge)> + '_ {
        let start = self.starts.get(from as usize).copied().unwrap_or(0);
        (start..).zip(self.of(from).iter().copied())
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
    use crate::ids::{ActionId, AttributeId, VarId};

    #[test]
    fn edges_carry_numbers() {
        let edge = |to| Edge { action: ActionId(0), to };
        let given = vec![(1, edge(0), vec![7]), (0, edge(1), vec![-2]), (0, edge(0), Vec::new())];
        let edges = Edges::with_attributes(VarId(0), 2, &["length".to_owned()], given);
        let length = AttributeId(0);
        let all = |from| edges.numbered(from).map(|(at, e)| (e.to, edges.number(at, length)));
        assert_eq!(all(0).collect::<Vec<_>>(), [(0, 0), (1, -2)]);
        assert_eq!(all(1).collect::<Vec<_>>(), [(0, 7)]);
        assert_eq!(edges.numbers_between(length), (-2, 7));
    }

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
