//! Graphs as networkx writes them in JSON: a list of nodes, and one of links between them.

use super::super::json::{Kind, Piece};
use super::Reader;
use super::roadmap::Roadmap;
use hyperplan_syntax::{Diagnostic, Span};

/// What the list of edges is called, before networkx 3.4 and since.
pub(super) const EDGES: [&str; 2] = ["links", "edges"];

/// A member of an object.
pub(super) fn member<'t>(members: &[(Piece<'t>, Piece<'t>)], name: &str) -> Option<Piece<'t>> {
    // Of several the last, as everywhere in JSON.
    members.iter().rev().find(|(key, _)| key.text().as_deref() == Some(name)).map(|(_, value)| *value)
}

/// Whether an object is such a graph.
pub(super) fn is_one(members: &[(Piece<'_>, Piece<'_>)]) -> bool {
    member(members, "nodes").is_some() && EDGES.iter().any(|edges| member(members, edges).is_some())
}

/// The graph; what is wrong with it is said.
pub(super) fn read(reader: &mut Reader<'_, '_>, members: &[(Piece<'_>, Piece<'_>)]) -> Roadmap {
    let mut map = Roadmap::default();
    let directed = flag(reader, members, "directed");
    // What it says is seen from the edges.
    flag(reader, members, "multigraph");
    let nodes = member(members, "nodes").and_then(|nodes| reader.list(nodes, "node")).unwrap_or_default();
    for node in nodes {
        one_node(reader, &mut map, node);
    }
    let edges: Vec<Piece<'_>> = EDGES.iter().filter_map(|name| member(members, name)).collect();
    if let [_, second, ..] = edges.as_slice() {
        reader.error(Diagnostic::error(
            "bad-graph",
            second.start(),
            "the graph has both `links` and `edges`",
        ));
    }
    let edges = edges.first().and_then(|edges| reader.list(*edges, "edge")).unwrap_or_default();
    for edge in edges {
        let Some(properties) = reader.object(edge, "an edge") else { continue };
        let mut end = |what: &str| match member(&properties, what) {
            Some(end) => name(reader, end, "node").map(|name| (name, end.span())),
            None => {
                reader.bad(edge.start(), format!("an edge has no `{what}`"));
                None
            }
        };
        let (Some(from), Some(to)) = (end("source"), end("target")) else { continue };
        let id = match member(&properties, "id") {
            None => None,
            Some(id) => match name(reader, id, "edge") {
                Some(name) => Some((name, id.span())),
                None => continue,
            },
        };
        let said = said(&properties, &["source", "target", "id", "key"]);
        map.edge(reader, ((&from.0, from.1), (&to.0, to.1)), id, directed, &said);
    }
    map
}

/// The properties of an edge that are numbers, but for some.
pub(super) fn said<'t>(properties: &[(Piece<'t>, Piece<'t>)], but: &[&str]) -> Vec<(String, &'t str, Span)> {
    let numbers = properties.iter().filter(|(_, value)| value.kind() == Kind::Number);
    let named = numbers.filter_map(|(key, value)| Some((key.text()?, value.raw(), key.span())));
    named.filter(|(name, ..)| !but.contains(&name.as_str())).collect()
}

fn one_node(reader: &mut Reader<'_, '_>, map: &mut Roadmap, node: Piece<'_>) {
    let Some(properties) = reader.object(node, "a node") else { return };
    let Some(id) = member(&properties, "id") else {
        reader.bad(node.start(), "a node has no `id`");
        return;
    };
    let Some(name) = name(reader, id, "node") else { return };
    let coordinate = |name: &str| member(&properties, name).and_then(number);
    let place = member(&properties, "pos").and_then(point).or_else(|| coordinate("x").zip(coordinate("y")));
    if let Some(number) = map.node(reader, name, id.span(), place) {
        labels(reader, map, number, &properties);
    }
}

/// Properties that are true or false are labels, and so are the words of `labels`.
pub(super) fn labels(
    reader: &mut Reader<'_, '_>,
    map: &mut Roadmap,
    node: u32,
    all: &[(Piece<'_>, Piece<'_>)],
) {
    for (key, value) in all {
        let name = key.text().unwrap_or_default();
        match value.raw() {
            "true" => map.label(reader, node, &name, true, key.span()),
            "false" => map.label(reader, node, &name, false, key.span()),
            _ if name == "labels" => {
                for word in value.array().unwrap_or_default() {
                    match word.text() {
                        Some(text) => map.label(reader, node, &text, true, word.span()),
                        None => reader.bad(word.span(), "a label is a string"),
                    }
                }
            }
            _ => {}
        }
    }
}

fn flag(reader: &mut Reader<'_, '_>, members: &[(Piece<'_>, Piece<'_>)], name: &str) -> bool {
    match member(members, name).map(|value| (value.raw(), value)) {
        None | Some(("false", _)) => false,
        Some(("true", _)) => true,
        Some((_, other)) => {
            reader.bad(other.start(), format!("`{name}` is `true` or `false`, not {}", other.describe()));
            false
        }
    }
}

/// The name of a node: a string, an integer, or a list of these, as the nodes of lattices are in networkx, which is called by
/// its parts.
fn name(reader: &mut Reader<'_, '_>, piece: Piece<'_>, what: &str) -> Option<String> {
    let Some(parts) = piece.array().filter(|_| piece.kind() == Kind::Array) else {
        return reader.name(piece, what);
    };
    let names: Option<Vec<String>> = parts.into_iter().map(|part| reader.name(part, what)).collect();
    names.filter(|names| !names.is_empty()).map(|names| names.join(",")).or_else(|| {
        reader.bad(piece.span(), "a name is not empty");
        None
    })
}

/// A number of any kind.
pub(super) fn number(piece: Piece<'_>) -> Option<f64> {
    if piece.kind() == Kind::Number { piece.raw().parse().ok() } else { None }
}

/// A list of two numbers, or of more, of which the first two count.
pub(super) fn point(piece: Piece<'_>) -> Option<(f64, f64)> {
    let parts = piece.array()?;
    Some((number(*parts.first()?)?, number(*parts.get(1)?)?))
}
