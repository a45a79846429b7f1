//! Graphs in GraphML, as networkx, yEd and Gephi write them.

use super::Reader;
use super::roadmap::Roadmap;
use hyperplan_syntax::{Diagnostic, SourceId, Span};
use roxmltree::{Document, Node, ParsingOptions};
use rustc_hash::{FxHashMap, FxHashSet};

/// The graph of a text; what is wrong with it is said.
pub(super) fn read(reader: &mut Reader<'_, '_>, source: SourceId, text: &str) -> Roadmap {
    let mut map = Roadmap::default();
    let document = match Document::parse_with_options(text, ParsingOptions::default()) {
        Ok(document) => document,
        Err(error) => {
            let at = offset(text, error.pos());
            let words = error.to_string();
            let words = words.split(" at ").next().unwrap_or_default();
            let message = format!("this is not XML: {words}");
            reader.error(Diagnostic::error("bad-xml", Span::new(source, at..at), message));
            return map;
        }
    };
    let graph = document.root_element().children().find(|child| child.has_tag_name_of("graph"));
    let Some(graph) = graph.filter(|_| document.root_element().has_tag_name_of("graphml")) else {
        reader.bad(Span::new(source, 0..text.len().min(1)), "this is no GraphML: no `graph` in a `graphml`");
        return map;
    };
    let keys: FxHashMap<&str, Key<'_>> = document
        .root_element()
        .children()
        .filter(|child| child.has_tag_name_of("key"))
        .filter_map(|key| Some((key.attribute("id")?, Key::of(key))))
        .collect();
    let directed = graph.attribute("edgedefault") == Some("directed");
    let span = |node: Node<'_, '_>| {
        let start = node.range().start;
        Span::new(source, start..start + text[start..].find('>').map_or(1, |end| end + 1))
    };
    for node in graph.descendants().filter(|node| node.has_tag_name_of("node")) {
        one_node(reader, &mut map, node, &keys, span(node));
    }
    let edges = || graph.descendants().filter(|edge| edge.has_tag_name_of("edge"));
    // What networkx writes as ids of a multigraph's edges are numbers of those side by side, and repeat.
    let mut seen = FxHashSet::default();
    let unique = edges().filter_map(|edge| edge.attribute("id")).all(|id| seen.insert(id));
    for edge in edges() {
        let at = span(edge);
        let (Some(from), Some(to)) = (edge.attribute("source"), edge.attribute("target")) else {
            reader.bad(at, "an edge has a `source` and a `target`");
            continue;
        };
        let own = data(edge, &keys).into_iter().find(|(key, _)| key.name == "id").map(|(_, text)| text);
        let id = match own.or_else(|| edge.attribute("id").filter(|_| unique)) {
            None => None,
            Some(id) => match reader.plain_name(id, at) {
                Some(name) => Some((name, at)),
                None => continue,
            },
        };
        let directed = edge.attribute("directed").map_or(directed, |directed| directed == "true");
        let said = data(edge, &keys).into_iter().filter(|(key, _)| key.is_number);
        let said: Vec<_> = said.map(|(key, text)| (key.name.to_owned(), text, at)).collect();
        map.edge(reader, ((from, at), (to, at)), id, directed, &said);
    }
    map
}

/// What a datum of a node is.
struct Key<'t> {
    name: &'t str,
    is_boolean: bool,
    is_number: bool,
}

impl<'t> Key<'t> {
    fn of(key: Node<'t, '_>) -> Key<'t> {
        let name = key.attribute("attr.name").or_else(|| key.attribute("id")).unwrap_or_default();
        let kind = key.attribute("attr.type").unwrap_or_default();
        let is_number = name != "id" && ["int", "long", "float", "double"].contains(&kind);
        Key { name, is_boolean: kind == "boolean", is_number }
    }
}

/// What is said of a node or an edge.
fn data<'a>(of: Node<'a, '_>, keys: &'a FxHashMap<&str, Key<'a>>) -> Vec<(&'a Key<'a>, &'a str)> {
    of.children()
        .filter(|child| child.has_tag_name_of("data"))
        .filter_map(|datum| {
            Some((keys.get(datum.attribute("key")?)?, datum.text().unwrap_or_default().trim()))
        })
        .collect()
}

fn one_node(
    reader: &mut Reader<'_, '_>,
    map: &mut Roadmap,
    node: Node<'_, '_>,
    keys: &FxHashMap<&str, Key<'_>>,
    at: Span,
) {
    let Some(name) = node.attribute("id").and_then(|id| reader.plain_name(id, at)) else {
        if node.attribute("id").is_none() {
            reader.bad(at, "a node has an `id`");
        }
        return;
    };
    let data = data(node, keys);
    let coordinate = |name: &str| {
        let found = data.iter().find(|(key, _)| key.name == name);
        found.and_then(|(_, text)| text.parse::<f64>().ok())
    };
    let Some(number) = map.node(reader, name, at, coordinate("x").zip(coordinate("y"))) else { return };
    for (key, text) in data.iter().filter(|(key, _)| key.is_boolean) {
        map.label(reader, number, key.name, matches!(*text, "true" | "True" | "1"), at);
    }
}

/// Whatever their name space.
trait Tagged {
    fn has_tag_name_of(&self, name: &str) -> bool;
}

impl Tagged for Node<'_, '_> {
    fn has_tag_name_of(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

/// The byte at a row and column, which count from 1.
fn offset(text: &str, at: roxmltree::TextPos) -> usize {
    let row = usize::try_from(at.row).unwrap_or(1).saturating_sub(1);
    let start = match row {
        0 => 0,
        nth => text.match_indices('\n').nth(nth - 1).map_or(text.len(), |(at, _)| at + 1),
    };
    let column = usize::try_from(at.col).unwrap_or(1).saturating_sub(1);
    text[start..].char_indices().nth(column).map_or(text.len(), |(at, _)| start + at)
}
