//! Route graphs of Nav2, in GeoJSON: points are nodes, and lines from one to another are edges.

use super::super::json::{Kind, Piece};
use super::Reader;
use super::node_link::{labels, member, point, said};
use super::roadmap::Roadmap;

/// Whether an object is a collection of features.
pub(super) fn is_one(members: &[(Piece<'_>, Piece<'_>)]) -> bool {
    member(members, "type").and_then(Piece::text).as_deref() == Some("FeatureCollection")
}

/// The graph; what is wrong with it is said. All nodes are read before the first edge.
pub(super) fn read(
    reader: &mut Reader<'_, '_>,
    members: &[(Piece<'_>, Piece<'_>)],
    root: Piece<'_>,
) -> Roadmap {
    let mut map = Roadmap::default();
    let Some(features) = member(members, "features") else {
        reader.bad(root.start(), "the collection has no `features`");
        return map;
    };
    let mut edges = Vec::new();
    for feature in reader.list(features, "feature").unwrap_or_default() {
        let Some(parts) = reader.object(feature, "a feature") else { continue };
        let geometry = member(&parts, "geometry").and_then(Piece::object).unwrap_or_default();
        let kind = member(&geometry, "type").and_then(Piece::text).unwrap_or_default();
        let properties = member(&parts, "properties").and_then(Piece::object);
        let properties =
            properties.ok_or_else(|| reader.bad(feature.start(), "a feature has no `properties`"));
        let Ok(properties) = properties else { continue };
        match kind.as_str() {
            "Point" => {
                let place = member(&geometry, "coordinates").and_then(point);
                node(reader, &mut map, feature, &properties, place);
            }
            "LineString" | "MultiLineString" => edges.push((feature, properties)),
            other => {
                let message = format!("a node is a `Point` and an edge a `MultiLineString`, not {other:?}");
                reader.bad(feature.start(), message);
            }
        }
    }
    for (feature, properties) in edges {
        edge(reader, &mut map, feature, &properties);
    }
    map
}

type Members<'t> = [(Piece<'t>, Piece<'t>)];

fn node(
    reader: &mut Reader<'_, '_>,
    map: &mut Roadmap,
    feature: Piece<'_>,
    properties: &Members<'_>,
    place: Option<(f64, f64)>,
) {
    let Some(id) = member(properties, "id") else {
        return reader.bad(feature.start(), "a node has no `id` among its properties");
    };
    if place.is_none() {
        reader.bad(feature.start(), "a node has no `coordinates`, two numbers");
    }
    let Some(name) = reader.name(id, "node") else { return };
    let Some(number) = map.node(reader, name, id.span(), place) else { return };
    labels(reader, map, number, properties);
    let metadata = member(properties, "metadata").filter(|metadata| metadata.kind() == Kind::Object);
    labels(reader, map, number, &metadata.and_then(Piece::object).unwrap_or_default());
}

fn edge(reader: &mut Reader<'_, '_>, map: &mut Roadmap, feature: Piece<'_>, properties: &Members<'_>) {
    let mut end = |what: &str| match member(properties, what) {
        Some(end) => reader.name(end, "node").map(|name| (name, end.span())),
        None => {
            reader.bad(feature.start(), format!("an edge has no `{what}` among its properties"));
            None
        }
    };
    let (Some(from), Some(to)) = (end("startid"), end("endid")) else { return };
    let id = match member(properties, "id") {
        None => None,
        Some(id) => match reader.name(id, "edge") {
            Some(name) => Some((name, id.span())),
            None => return,
        },
    };
    let metadata = member(properties, "metadata").filter(|metadata| metadata.kind() == Kind::Object);
    let mut all = said(properties, &["id", "startid", "endid"]);
    all.extend(said(&metadata.and_then(Piece::object).unwrap_or_default(), &[]));
    map.edge(reader, ((&from.0, from.1), (&to.0, to.1)), id, true, &all);
}
