//! What graphs that were not made for planning have in common: nodes that may lie somewhere and have properties, and edges that
//! are actions.

use super::{Listed, MAX_ATTRIBUTES, MAX_STATES, NODE, Reader, Table, is_attribute, one_of};
use crate::edges::{Edge, Edges};
use crate::expr::{Expr, Type};
use crate::ids::ActionId;
use crate::lower::base::Base;
use crate::lower::limits::MAX_RANGE;
use crate::system::{Label, Var};
use hyperplan_syntax::{Diagnostic, Span, is_name};
use indexmap::IndexMap;
use rustc_hash::FxBuildHasher;

/// The action of an edge without a name of its own, but for where it leads.
const GO: &str = "go_";

/// Most units from the origin, for a place to be one.
pub(super) const MAX_DISTANCE: f64 = 1e9;

/// A graph while it is read.
#[derive(Debug, Default)]
pub(super) struct Roadmap {
    /// Names of nodes.
    nodes: Table,
    /// Where each lies, as far as that is said.
    places: Vec<Option<(f64, f64)>>,
    /// Names of actions, in order of first mention.
    actions: Table,
    /// From where, by which action, to where, with which numbers.
    edges: Vec<([u32; 3], Vec<i64>)>,
    /// Where each edge is written.
    spans: Vec<Span>,
    /// What the numbers are called.
    attributes: Table,
    /// The nodes of each label.
    labels: IndexMap<String, (Vec<u32>, Span), FxBuildHasher>,
}

impl Roadmap {
    /// One more node; its number, or `None` after a message.
    pub(super) fn node(
        &mut self,
        reader: &mut Reader<'_, '_>,
        name: String,
        span: Span,
        place: Option<(f64, f64)>,
    ) -> Option<u32> {
        if let Some(first) = self.nodes.get(&name) {
            let message = format!("the node `{name}` is listed twice");
            let diagnostic = Diagnostic::error("duplicate-name", span, message);
            reader.error(diagnostic.with_related(*first, "the first one"));
            return None;
        }
        if self.nodes.len() >= MAX_STATES {
            reader.bad(span, format!("the graph has more than {MAX_STATES} nodes"));
            return None;
        }
        let number = u32::try_from(self.nodes.len()).ok()?;
        self.nodes.insert(name, span);
        self.places.push(place.filter(|(x, y)| x.abs().max(y.abs()) <= MAX_DISTANCE));
        Some(number)
    }

    /// A property that is true of a node, or false of it.
    pub(super) fn label(
        &mut self,
        reader: &mut Reader<'_, '_>,
        node: u32,
        name: &str,
        holds: bool,
        span: Span,
    ) {
        if !is_name(name) {
            let message = format!("the property {name:?} cannot be the name of a label, and is passed over");
            reader.env.diagnostics.push(Diagnostic::warning("not-a-label", span, message));
            return;
        }
        let (nodes, _) = self.labels.entry(name.to_owned()).or_insert_with(|| (Vec::new(), span));
        if holds {
            nodes.push(node);
        }
    }

    /// An edge between two nodes, by their names, and back where it has no direction, with what is said of it.
    pub(super) fn edge(
        &mut self,
        reader: &mut Reader<'_, '_>,
        (from, to): ((&str, Span), (&str, Span)),
        name: Option<(String, Span)>,
        directed: bool,
        said: &[(String, &str, Span)],
    ) {
        let to_span = to.1;
        let ends = [from, to].map(|(name, span)| reader.known_name(name, &self.nodes, "node", span));
        let [Some(from), Some(to)] = ends else { return };
        if let Some((name, span)) = name.as_ref().filter(|(name, _)| name == "none") {
            let message =
                format!("`{name}` says in objectives that no action was taken: no edge can have that name");
            reader.error(Diagnostic::error("reserved-name", *span, message));
            return;
        }
        let numbers = self.numbers(said);
        let at = name.as_ref().map_or(to_span, |name| name.1);
        let mut go = |from: u32, to: u32, target: (&str, Span)| {
            let (name, span) = name.clone().unwrap_or_else(|| (format!("{GO}{}", target.0), target.1));
            let (action, _) = self.actions.insert_full(name, span);
            let Ok(action) = u32::try_from(action) else { return };
            self.edges.push(([from, action, to], numbers.clone()));
            self.spans.push(at);
        };
        let (source, target) = (self.nodes.get_index(from as usize), self.nodes.get_index(to as usize));
        if let (Some((source, at)), Some((target, _))) = (source, target) {
            go(from, to, (target, *at));
            if !directed {
                go(to, from, (source, *at));
            }
        }
    }

    /// What is an integer of all that is said of an edge, in the order of the attributes; fractions, and numbers whose name is
    /// none, are passed over: nobody may ask for them.
    fn numbers(&mut self, said: &[(String, &str, Span)]) -> Vec<i64> {
        let mut numbers = Vec::new();
        for (name, text, span) in said {
            let whole = text.parse::<i64>().ok().or_else(|| {
                let number = text.parse::<f64>().ok()?;
                (number.fract() == 0.0).then_some(number as i64)
            });
            let whole = whole.filter(|whole| whole.unsigned_abs() <= MAX_RANGE.unsigned_abs());
            let known = self.attributes.get_index_of(name);
            let fits = known.is_some() || is_attribute(name) && self.attributes.len() < MAX_ATTRIBUTES;
            if let Some(whole) = whole.filter(|_| fits) {
                let (at, _) = self.attributes.insert_full(name.clone(), *span);
                numbers.resize(numbers.len().max(at + 1), 0);
                numbers[at] = whole;
            }
        }
        numbers
    }

    /// The system, in which the node that it is in is the state.
    pub(super) fn into_base(self, reader: &mut Reader<'_, '_>, whole: Span, span: Span) -> Option<Base> {
        // What is missing after another mistake may be missing for it.
        let missing = if self.nodes.is_empty() { "node" } else { "edge" };
        if reader.errors == 0 && self.actions.is_empty() {
            reader.bad(whole, format!("the graph has no {missing}"));
        }
        let ids: Vec<ActionId> = self.actions.keys().map(|name| reader.env.actions.intern(name)).collect();
        let edge = |([from, action, to], numbers): ([u32; 3], Vec<i64>)| {
            (from, Edge { action: ids[action as usize], to }, numbers)
        };
        let edges = self.edges.into_iter().map(edge).collect();
        let listed = Listed { edges, attributes: self.attributes };
        reader.demand_one_number(&listed, &self.spans);
        reader.end(whole);
        if self.nodes.is_empty() {
            return None;
        }
        let names: Vec<String> = listed.attributes.into_keys().collect();
        let label =
            |(name, (nodes, span))| Label { name, expr: one_of(nodes), ty: Type::Bool, nested: false, span };
        let places: Option<Vec<(f64, f64)>> = self.places.into_iter().collect();
        let mut edges = Edges::with_attributes(NODE, self.nodes.len(), &names, listed.edges);
        if let Some(places) = &places {
            edges = edges.with_distances(places);
        }
        let node =
            Var { name: "node".into(), ty: Type::Enum(self.nodes.into_keys().collect()), sums: None, span };
        Some(Base {
            vars: [node].into_iter().collect(),
            actions: ids,
            edges: Some(edges),
            labels: self.labels.into_iter().map(label).collect(),
            init: Expr::TRUE,
            coordinates: places.map(Into::into),
            poisoned: reader.errors > 0,
            ..Base::default()
        })
    }
}
