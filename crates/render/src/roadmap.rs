//! Graphs as drawings: their nodes where they lie, or in layers where the file does not say.

use crate::eval::truth;
use crate::mover::{Mover, Point};
use crate::panel::{Entry, Panel};
use crate::style::{MARGIN, fill, number, on_white, width};
use crate::track::{Area, Sizes, head};
use hyperplan_outlet::one_line;
use hyperplan_problem::{System, Trace, Type, Value};
use rust_sugiyama::configure::Config;
use std::borrow::Cow;
use std::collections::BTreeSet;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path};

/// The longer side of a drawing.
const SIDE: f64 = 900.0;
/// Of more nodes the names would cover each other.
const MOST_NAMES: usize = 120;
/// Graphs with more nodes are not laid out.
const MOST_LAID_OUT: usize = 150;
/// From node to node, as far as lines and letters go.
const ROOM: f64 = 36.0;

/// A graph and how it fits on paper.
pub(crate) struct Roadmap<'a> {
    system: &'a System,
    places: Cow<'a, [(f64, f64)]>,
    /// The least coordinates, and the greatest.
    low: (f64, f64),
    high: (f64, f64),
    /// Points of the drawing for each unit.
    scale: f64,
    /// The radius of a node.
    radius: f64,
    /// Labels that hold at some nodes, but not at all, and at which.
    marks: Vec<(&'a str, Vec<usize>)>,
}

impl<'a> Roadmap<'a> {
    /// The roadmap of a system; none where it is no graph, or one whose nodes lie nowhere and are too many.
    pub(crate) fn of(system: &'a System) -> Option<Self> {
        let given = system.coordinates.as_deref().filter(|places| !places.is_empty());
        let (places, side) = match given {
            Some(places) => (Cow::Borrowed(places), SIDE),
            // No larger than it has to be.
            None => laid_out(system).map(|places| {
                let side = SIDE.min(120.0 + 70.0 * (places.len() as f64).sqrt());
                (Cow::Owned(places), side)
            })?,
        };
        let ends = |of: fn(&(f64, f64)) -> f64| {
            let values = || places.iter().map(of);
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (low, high)) = (ends(|place| place.0), ends(|place| place.1));
        let extent = (right - left).max(high - low);
        let scale = if extent > 0.0 && extent.is_finite() { side / extent } else { 1.0 };
        let radius = (200.0 / (places.len() as f64).sqrt()).clamp(2.0, 8.0);
        let mut map = Roadmap {
            system,
            places,
            low: (left, low),
            high: (right, high),
            scale,
            radius,
            marks: Vec::new(),
        };
        map.marks = map.marks();
        Some(map)
    }

    fn marks(&self) -> Vec<(&'a str, Vec<usize>)> {
        let Some(edges) = &self.system.edges else { return Vec::new() };
        let mut known: Vec<Option<Value>> = vec![None; self.system.vars.len()];
        let mut marks = Vec::new();
        for label in &self.system.labels {
            let nodes: Vec<usize> = (0..self.places.len())
                .filter(|node| {
                    known[usize::from(edges.var)] = u32::try_from(*node).ok().map(Value::Enum);
                    truth(self.system, &label.expr, &known) == Some(true)
                })
                .collect();
            if !nodes.is_empty() && nodes.len() < self.places.len() {
                marks.push((label.name.as_str(), nodes));
            }
        }
        marks
    }

    pub(crate) fn labels(&self) -> usize {
        self.marks.len()
    }

    pub(crate) fn sizes(&self) -> Sizes {
        Sizes::of(ROOM)
    }

    fn point(&self, node: usize) -> (f64, f64) {
        let (x, y) = self.places[node];
        (number(MARGIN + (x - self.low.0) * self.scale), number(MARGIN + (self.high.1 - y) * self.scale))
    }

    /// The graph with paths.
    pub(crate) fn panel(&self, (paths, movers): (Group, Vec<Mover>), mut entries: Vec<Entry>) -> Panel {
        let mut group = Group::new().set("class", "roadmap").add(self.edges());
        for node in 0..self.places.len() {
            let (x, y) = self.point(node);
            let mark = self.marks.iter().position(|(_, nodes)| nodes.binary_search(&node).is_ok());
            let circle = Circle::new().set("cx", x).set("cy", y).set("r", self.radius);
            let fill = mark.map_or_else(|| "#ffffff".to_owned(), fill);
            group = group.add(circle.set("stroke", "#444444").set("fill", fill));
        }
        group = group.add(paths).add(self.names());
        let labels = self.marks.iter().enumerate();
        entries.extend(labels.map(|(i, (label, _))| Entry::Label(i, (*label).to_owned())));
        let longest = match self.node_names() {
            Some(names) => names.iter().map(|name| width(&one_line(name), 11.0)).fold(0.0, f64::max),
            None => 0.0,
        };
        Panel {
            group,
            width: (self.high.0 - self.low.0) * self.scale + 2.0 * MARGIN + longest.min(200.0),
            height: (self.high.1 - self.low.1) * self.scale + 2.0 * MARGIN + 12.0,
            movers,
        }
        .with_legend(entries)
    }

    /// A line for each pair of nodes, and an arrow where there is no way back.
    fn edges(&self) -> Group {
        let Some(edges) = &self.system.edges else { return Group::new() };
        let pairs: BTreeSet<(u32, u32)> = edges.iter().map(|(from, edge)| (from, edge.to)).collect();
        let (mut lines, mut arrows) = (Data::new(), Data::new());
        for &(from, to) in pairs.iter().filter(|(from, to)| from != to) {
            let there_and_back = pairs.contains(&(to, from));
            if there_and_back && from > to {
                continue;
            }
            let (a, b) = (self.point(from as usize), self.point(to as usize));
            lines = lines.move_to(a).line_to(b);
            if !there_and_back {
                arrows = self.arrow(arrows, a, b);
            }
        }
        let lines = Path::new().set("d", lines).set("stroke", "#aaaaaa").set("fill", "none");
        Group::new().add(lines).add(Path::new().set("d", arrows).set("fill", "#777777"))
    }

    /// An arrow's head before the node that it leads to.
    fn arrow(&self, data: Data, a: Point, b: Point) -> Data {
        let length = (b.0 - a.0).hypot(b.1 - a.1).max(1e-9);
        let back = |to: f64, from: f64| to - (to - from) / length * self.radius;
        head(data, (back(b.0, a.0), back(b.1, a.1)), a, b, 6.0)
    }

    /// The names of nodes, where they do not cover each other.
    fn node_names(&self) -> Option<&'a [String]> {
        match self.system.edges.as_ref().map(|edges| &self.system.vars[edges.var].ty) {
            Some(Type::Enum(names)) if names.len() <= MOST_NAMES => Some(names),
            _ => None,
        }
    }

    /// Where names are.
    pub(crate) fn taken(&self) -> Vec<Area> {
        let names = self.node_names().unwrap_or_default().iter().enumerate();
        let area = |(node, name): (usize, &String)| {
            let (x, y) = self.point(node);
            let (left, bottom) = (x + self.radius + 2.0, y - self.radius);
            [left, bottom - 11.0, left + width(&one_line(name), 11.0), bottom]
        };
        names.map(area).collect()
    }

    fn names(&self) -> Group {
        let names = self.node_names().unwrap_or_default().iter().enumerate();
        names.fold(Group::new().set("class", "names"), |group, (node, name)| {
            let (x, y) = self.point(node);
            let at = (x + self.radius + 2.0, y - self.radius - 2.0);
            group.add(on_white(&one_line(name), at, 11.0, "#222222"))
        })
    }

    /// The nodes of a trace with their places, one a state.
    pub(crate) fn places_of(&self, trace: &Trace) -> Vec<(usize, Point)> {
        let Some(edges) = &self.system.edges else { return Vec::new() };
        let node = |value: Option<&Value>| match value {
            Some(Value::Enum(node)) => Some(*node as usize).filter(|node| *node < self.places.len()),
            _ => None,
        };
        let nodes = trace.states.iter().filter_map(|state| node(state.get(usize::from(edges.var))));
        nodes.map(|node| (node, self.point(node))).collect()
    }
}

/// Places for the nodes of a graph that says none: in layers, along its edges. None where it has too many.
fn laid_out(system: &System) -> Option<Vec<(f64, f64)>> {
    let edges = system.edges.as_ref()?;
    let Type::Enum(names) = &system.vars[edges.var].ty else { return None };
    let pairs: BTreeSet<(u32, u32)> =
        edges.iter().map(|(from, edge)| (from, edge.to)).filter(|(from, to)| from != to).collect();
    if names.is_empty() || names.len() > MOST_LAID_OUT || pairs.len() > 4 * MOST_LAID_OUT {
        return None;
    }
    // What leads there and back is one line.
    let pairs: Vec<(u32, u32)> =
        pairs.iter().copied().filter(|&(a, b)| a < b || !pairs.contains(&(b, a))).collect();
    let nodes: Vec<(u32, (f64, f64))> = (0..names.len() as u32).map(|node| (node, (1.0, 1.0))).collect();
    let mut places = vec![(0.0, 0.0); names.len()];
    let mut left = 0.0;
    // Its parts that hang together come one by one.
    for (part, _, _) in rust_sugiyama::from_vertices_and_edges(&nodes, &pairs, &Config::default()) {
        let least = part.iter().map(|(_, (x, _))| *x).fold(f64::INFINITY, f64::min);
        let mut right = left;
        for (node, (x, y)) in part {
            places[node] = (left + x - least, -y);
            right = places[node].0.max(right);
        }
        left = right + Config::default().vertex_spacing.max(1.0);
    }
    Some(places)
}
