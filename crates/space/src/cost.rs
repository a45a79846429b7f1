//! What the transitions of a graph cost.

use crate::graph::{Graph, StateIx};
use crate::row::Row;
use hyperplan_problem::{ActionId, Cost, Expr, Leaf, StepLeaf, System, Value};
use rustc_hash::FxHashMap;

/// The cost of each transition of a graph, in its order.
#[must_use]
pub fn step_costs(system: &System, graph: &Graph, cost: &Cost) -> Vec<i64> {
    let mut reads_numbers = false;
    cost.expr.for_each_leaf(&mut |leaf| reads_numbers |= matches!(leaf, StepLeaf::Attribute(_)));
    let edges = system.edges.as_ref().filter(|_| reads_numbers);
    // Without numbers, what an action costs is the same for all its outcomes.
    let mut known: FxHashMap<ActionId, Expr<Leaf>> = FxHashMap::default();
    let mut all = Vec::with_capacity(graph.transitions.len());
    let mut here = Row::new(system);
    for state in 0..graph.len() as StateIx {
        here.turn(graph.codes(state));
        if here.holds(&system.absorb) {
            all.extend(graph.successors(state).iter().map(|_| 0));
            continue;
        }
        for &(letter, next) in graph.successors(state) {
            let action = graph.letters[letter as usize].0;
            let Some(edges) = edges else {
                let zero = |_| Expr::Const(Value::Int(0));
                let own = known.entry(action).or_insert_with(|| cost.expr.of_state(action, &zero));
                all.push(here.eval(own));
                continue;
            };
            let node = |state: StateIx| graph.codes(state)[usize::from(edges.var)];
            let mut leaving = edges.numbered(u32::try_from(node(state)).unwrap_or(u32::MAX));
            let taken = leaving.find(|(_, e)| e.action == action && i64::from(e.to) == node(next));
            let number =
                |attribute| Expr::Const(Value::Int(taken.map_or(0, |(at, _)| edges.number(at, attribute))));
            all.push(here.eval(&cost.expr.of_state(action, &number)));
        }
    }
    all
}
