//! Graphs that were not made for planning: node-link JSON, route graphs, GraphML.

use super::interpreter::labelled;
use super::{lowered_with, messages, ok_with};
use crate::ids::AttributeId;
use crate::{Overrides, Type, Value};

/// The transitions of a graph file as `FROM ACTION TO`, in order.
fn edges(file: &str, text: &str) -> Vec<String> {
    let lowered = ok_with(&format!("system W = graph({file:?});"), &[(file, text)]);
    let (problem, system) = (&lowered.problem, lowered.problem.systems.first().expect("a system"));
    let Type::Enum(names) = &system.vars.first().expect("node").ty else { panic!("node is an enumeration") };
    let name = |node: u32| names[node as usize].as_str();
    let edges = system.edges.as_ref().expect("a graph");
    let mut found: Vec<String> = edges
        .iter()
        .map(|(from, edge)| format!("{} {} {}", name(from), problem.actions[edge.action], name(edge.to)))
        .collect();
    found.sort();
    found
}

fn said(file: &str, text: &str) -> Vec<String> {
    let (lowered, sources) =
        lowered_with(&format!("system W = graph({file:?});"), &[(file, text)], &Overrides::none());
    messages(&lowered, &sources)
}

const LINKS: &str = r#"{"directed": true, "multigraph": false, "graph": {},
  "nodes": [{"id": "a", "dock": true, "pos": [0.5, 2]}, {"id": 7, "x": 1, "y": -1, "dock": false}, {"id": [0, 1], "pos": [3, 4, 5]}],
  "links": [{"source": "a", "target": 7}, {"source": 7, "target": [0, 1], "id": "lift"},
            {"source": [0, 1], "target": "a", "weight": 2.5}]}"#;

#[test]
fn node_link_data() {
    let directed = ["0,1 go_a a", "7 lift 0,1", "a go_7 7"];
    assert_eq!(edges("g.json", LINKS), directed);
    assert_eq!(edges("g.json", &LINKS.replace("\"links\"", "\"edges\"")), directed);
    let both = ["0,1 go_a a", "0,1 lift 7", "7 go_a a", "7 lift 0,1", "a go_0,1 0,1", "a go_7 7"];
    assert_eq!(edges("g.json", &LINKS.replace("\"directed\": true", "\"directed\": false")), both);
    // Without a word of it, as networkx has it.
    assert_eq!(edges("g.json", &LINKS.replace("\"directed\": true, ", "")), both);
    // Edges side by side are one where they have no names.
    let twice = LINKS.replace("\"multigraph\": false", "\"multigraph\": true").replace(
        "[{\"source\": \"a\"",
        "[{\"source\": \"a\", \"target\": 7, \"key\": 1, \"id\": \"ramp\"}, {\"source\": \"a\"",
    );
    assert_eq!(edges("g.json", &twice), ["0,1 go_a a", "7 lift 0,1", "a go_7 7", "a ramp 7"]);
    let lowered = ok_with("system W = graph(\"g.json\");", &[("g.json", LINKS)]);
    let system = lowered.problem.systems.first().expect("a system");
    assert_eq!(labelled(system, "dock"), [vec![Value::Enum(0)]]);
    assert_eq!(system.coordinates.as_deref(), Some(&[(0.5, 2.0), (1.0, -1.0), (3.0, 4.0)][..]));
    // Of some nodes is as good as of none.
    let some = LINKS.replace(", \"pos\": [0.5, 2]", "");
    let lowered = ok_with("system W = graph(\"g.json\");", &[("g.json", &some)]);
    assert_eq!(lowered.problem.systems.first().and_then(|system| system.coordinates.clone()), None);
}

#[test]
fn mistakes_in_node_link_data() {
    for (from, to, message) in [
        ("\"target\": 7}", "\"target\": 8}", "g.json:3:39 unknown-state: no node `8` in the graph"),
        ("\"source\": \"a\", ", "", "bad-graph: an edge has no `source`"),
        ("{\"id\": 7,", "{\"ID\": 7,", "bad-graph: a node has no `id`"),
        ("{\"id\": 7,", "{\"id\": \"a\",", "duplicate-name: the node `a` is listed twice"),
        (
            "{\"id\": 7,",
            "{\"id\": 7.5,",
            "bad-graph: a node is a string or an integer, not `7.5`; as a name it is written \"7.5\"",
        ),
        ("true, \"multi", "1, \"multi", "bad-graph: `directed` is `true` or `false`, not a number"),
        (
            "\"lift\"",
            "\"none\"",
            "reserved-name: `none` says in objectives that no action was taken: no edge can have that name",
        ),
        (
            "\"dock\": true",
            "\"is dock\": true",
            "not-a-label: the property \"is dock\" cannot be the name of a label, and is passed over",
        ),
        ("\"graph\": {},", "\"edges\": [],", "bad-graph: the graph has both `links` and `edges`"),
    ] {
        assert!(LINKS.contains(from), "{from}");
        let found = said("g.json", &LINKS.replacen(from, to, 1));
        assert!(found.iter().any(|said| said.ends_with(message)), "{to}: {found:#?}");
    }
    let none = r#"{"nodes": [], "links": []}"#;
    assert_eq!(said("g.json", none), ["g.json:1:1 bad-graph: the graph has no node"]);
    let lone = r#"{"nodes": [{"id": 1}], "links": []}"#;
    assert_eq!(said("g.json", lone), ["g.json:1:1 bad-graph: the graph has no edge"]);
}

const ROUTE: &str = r#"{"type": "FeatureCollection", "name": "graph", "features": [
  {"type": "Feature", "properties": {"id": 10, "startid": 0, "endid": 1, "cost": 2.0, "overridable": true},
   "geometry": {"type": "MultiLineString", "coordinates": [[[0, 0], [1.5, 0]]]}},
  {"type": "Feature", "properties": {"id": 0, "frame": "map", "metadata": {"charger": true, "class": "dock"}},
   "geometry": {"type": "Point", "coordinates": [0.0, 0.0]}},
  {"type": "Feature", "properties": {"id": 1, "labels": ["goal"]}, "geometry": {"type": "Point", "coordinates": [1.5, 0]}},
  {"type": "Feature", "properties": {"startid": 1, "endid": 0}, "geometry": {"type": "LineString", "coordinates": []}}
]}"#;

#[test]
fn route_graphs() {
    assert_eq!(edges("r.geojson", ROUTE), ["0 10 1", "1 go_0 0"]);
    let lowered = ok_with("system W = graph(\"r.geojson\");", &[("r.geojson", ROUTE)]);
    let system = lowered.problem.systems.first().expect("a system");
    assert_eq!(labelled(system, "charger"), [vec![Value::Enum(0)]]);
    assert_eq!(labelled(system, "goal"), [vec![Value::Enum(1)]]);
    assert_eq!(system.coordinates.as_deref(), Some(&[(0.0, 0.0), (1.5, 0.0)][..]));
    assert_eq!(system.position(&[Value::Enum(1)].into()), Some((1.5, 0.0)));
    for (from, to, message) in [
        ("\"startid\": 0", "\"startid\": 5", "r.geojson:2:59 unknown-state: no node `5` in the graph"),
        ("\"endid\": 0", "\"end\": 0", "bad-graph: an edge has no `endid` among its properties"),
        ("\"id\": 1, ", "", "bad-graph: a node has no `id` among its properties"),
        ("[1.5, 0]}},\n", "[1.5]}},\n", "bad-graph: a node has no `coordinates`, two numbers"),
        (
            "\"Point\"",
            "\"Polygon\"",
            "bad-graph: a node is a `Point` and an edge a `MultiLineString`, not \"Polygon\"",
        ),
        ("\"features\"", "\"feature\"", "bad-graph: the collection has no `features`"),
    ] {
        assert!(ROUTE.contains(from), "{from}");
        let found = said("r.geojson", &ROUTE.replacen(from, to, 1));
        assert!(found.iter().any(|said| said.ends_with(message)), "{to}: {found:#?}");
    }
}

const GRAPHML: &str = r#"<?xml version="1.0" encoding="utf-8"?>
<!-- made by hand -->
<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
  <key id="d0" for="node" attr.name="x" attr.type="double"/>
  <key id="d1" for="node" attr.name="y" attr.type="double"/>
  <key id="d2" for="node" attr.name="dock" attr.type="boolean"/>
  <graph id="G" edgedefault="undirected">
    <node id="n1"><data key="d0">0.5</data><data key="d1">1</data><data key="d2">true</data></node>
    <node id="n 2"><data key="d0">2</data><data key="d1">-1</data><data key="d2">False</data></node>
    <edge id="e1" source="n1" target="n 2"/>
    <edge source="n 2" target="n1" directed="true"/>
  </graph>
</graphml>
"#;

#[test]
fn graphml() {
    assert_eq!(edges("g.graphml", GRAPHML), ["n 2 e1 n1", "n 2 go_n1 n1", "n1 e1 n 2"]);
    // Ids that repeat are none, and a datum `id` is one.
    let keys = GRAPHML.replace("<edge source", "<edge id=\"e1\" source");
    assert_eq!(edges("g.graphml", &keys), ["n 2 go_n1 n1", "n1 go_n 2 n 2"]);
    let datum =
        GRAPHML.replace("<key id=\"d0\"", "<key id=\"d9\" for=\"edge\" attr.name=\"id\"/><key id=\"d0\"");
    let datum = datum.replace("target=\"n 2\"/>", "target=\"n 2\"><data key=\"d9\">lift</data></edge>");
    assert_eq!(edges("g.graphml", &datum), ["n 2 go_n1 n1", "n 2 lift n1", "n1 lift n 2"]);
    let lowered = ok_with("system W = graph(\"g.graphml\");", &[("g.graphml", GRAPHML)]);
    let system = lowered.problem.systems.first().expect("a system");
    assert_eq!(labelled(system, "dock"), [vec![Value::Enum(0)]]);
    assert_eq!(system.coordinates.as_deref(), Some(&[(0.5, 1.0), (2.0, -1.0)][..]));
    for (from, to, message) in [
        ("source=\"n 2\"", "source=\"n3\"", "g.graphml:11:5 unknown-state: no node `n3` in the graph"),
        ("source=\"n 2\" ", "", "g.graphml:11:5 bad-graph: an edge has a `source` and a `target`"),
        ("<node id=\"n1\">", "<node>", "g.graphml:8:5 bad-graph: a node has an `id`"),
        ("id=\"n 2\"", "id=\"n1\"", "g.graphml:9:5 duplicate-name: the node `n1` is listed twice"),
        ("</graphml>", "", "bad-xml: this is not XML"),
        ("<graph id", "<graph <", "bad-xml: this is not XML"),
        ("<graphml xmlns", "<html xmlns", "bad-xml: this is not XML"),
    ] {
        let found = said("g.graphml", &GRAPHML.replacen(from, to, 1));
        assert!(found.iter().any(|said| said.contains(message)), "{to}: {found:#?}");
    }
    let other = said("g.graphml", "<svg/>");
    assert_eq!(other, ["g.graphml:1:1 bad-graph: this is no GraphML: no `graph` in a `graphml`"]);
    let dot = said("g.dot", "digraph { a -> b }");
    assert_eq!(dot, ["test.hp:1:18 not-supported: `g.dot` is a graph in DOT, which is not read"]);
}

/// Nesting and entities cost what they are long.
#[test]
fn xml_that_is_meant_to_hurt() {
    let deep = format!("<graphml>{}{}</graphml>", "<a>".repeat(300_000), "</a>".repeat(300_000));
    assert!(!said("g.graphml", &deep).is_empty());
    let lol = r#"<!DOCTYPE l [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]><graphml>&b;</graphml>"#;
    assert!(!said("g.graphml", lol).is_empty());
    let nested = format!("{{\"nodes\": {}{}}}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(!said("g.json", &nested).is_empty());
}

#[test]
fn states_of_our_own_graphs_lie_somewhere() {
    let text =
        r#"{"states": ["a", 7], "actions": ["go"], "transitions": [["a", "go", 7]], "coordinates": PLACES}"#;
    let with = |places: &str| text.replace("PLACES", places);
    let lowered =
        ok_with("system W = graph(\"g.json\");", &[("g.json", &with(r#"{"7": [0.5, 2], "a": [0, -1]}"#))]);
    let system = lowered.problem.systems.first().expect("a system");
    assert_eq!(system.coordinates.as_deref(), Some(&[(0.0, -1.0), (0.5, 2.0)][..]));
    let edges = system.edges.as_ref().expect("a graph");
    assert_eq!(edges.numbered(0).map(|(at, _)| edges.number(at, AttributeId(0))).collect::<Vec<_>>(), [3041]);
    // What is called so in the problem comes first.
    let text = "system W = graph(\"g.json\") { label distance = true; cost c = if distance then 2 else 3; }";
    ok_with(text, &[("g.json", &with(r#"{"7": [0.5, 2], "a": [0, -1]}"#))]);
    let text = "system W = graph(\"g.json\") { cost c = distance; }";
    ok_with(text, &[("g.json", &with(r#"{"7": [0.5, 2], "a": [0, -1]}"#))]);
    for (places, words) in [
        (r#"{"a": [0, 1]}"#, "the state `7` has no coordinates, though others have"),
        (r#"{"a": [0, 1], "7": [1]}"#, "a place is `[X, Y]`, two numbers within 10^9, not a list"),
        (r#"{"a": [0, 1], "b": [1, 1]}"#, "no state `b` in the graph"),
    ] {
        let found = said("g.json", &with(places));
        assert!(found.iter().any(|said| said.contains(words)), "{places}: {found:?}");
    }
}

#[test]
fn integers_of_edges_are_attributes() {
    let text = r#"{"directed": true, "nodes": [{"id": "a"}, {"id": "b"}],
        "links": [{"source": "a", "target": "b", "length": 3, "weight": 1.5, "lanes": 2.0},
                  {"source": "b", "target": "a", "length": 4}]}"#;
    let lowered = ok_with("system W = graph(\"g.json\");", &[("g.json", text)]);
    let system = lowered.problem.systems.first().expect("a system");
    let edges = system.edges.as_ref().expect("a graph");
    let names: Vec<&str> = edges.attributes().iter().map(|attribute| attribute.name.as_str()).collect();
    assert_eq!(names, ["length", "lanes"]);
    let of = |from: u32| edges.numbered(from).map(|(at, _)| [0, 1].map(|a| edges.number(at, AttributeId(a))));
    assert_eq!((of(0).collect::<Vec<_>>(), of(1).collect::<Vec<_>>()), (vec![[3, 2]], vec![[4, 0]]));
}
