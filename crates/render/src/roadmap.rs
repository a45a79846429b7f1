//! Graphs whose nodes lie somewhere, as SVG.

use crate::drawing::{LEGEND_LINE, MARGIN, STROKES, end, fill, number};
use crate::eval::truth;
use hyperplan_outlet::one_line;
use hyperplan_problem::{System, Trace, Type, Value};
use std::collections::BTreeSet;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Line, Path, Polyline, Rectangle, Text, Title};

/// The longer side of a drawing.
const SIDE: f64 = 900.0;
/// Of more nodes the names would cover each other.
const MOST_NAMES: usize = 120;

/// A graph and how it fits on paper.
pub(crate) struct Roadmap<'a> {
    system: &'a System,
    places: &'a [(f64, f64)],
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
    /// The roadmap of a system; none where its nodes lie nowhere.
    pub(crate) fn of(system: &'a System) -> Option<Self> {
        let places = system.coordinates.as_deref().filter(|places| !places.is_empty())?;
        let ends = |of: fn(&(f64, f64)) -> f64| {
            let values = || places.iter().map(of);
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (low, high)) = (ends(|place| place.0), ends(|place| place.1));
        let extent = (right - left).max(high - low);
        let scale = if extent > 0.0 && extent.is_finite() { SIDE / extent } else { 1.0 };
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

    pub(crate) fn width(&self) -> f64 {
        (self.high.0 - self.low.0) * self.scale + 2.0 * MARGIN
    }

    /// The height with the lines of the legend, of which one is for each path.
    pub(crate) fn height(&self, paths: usize) -> f64 {
        let lines = (paths + self.marks.len() + 1) as f64;
        (self.high.1 - self.low.1) * self.scale + 2.0 * MARGIN + lines * LEGEND_LINE
    }

    fn point(&self, node: usize) -> (f64, f64) {
        let (x, y) = self.places[node];
        (number(MARGIN + (x - self.low.0) * self.scale), number(MARGIN + (self.high.1 - y) * self.scale))
    }

    pub(crate) fn draw(&self, traces: &[(usize, &str, &Trace)]) -> Group {
        let mut group = Group::new().set("class", "roadmap").add(self.edges());
        for node in 0..self.places.len() {
            let (x, y) = self.point(node);
            let mark = self.marks.iter().find(|(_, nodes)| nodes.binary_search(&node).is_ok());
            let circle =
                Circle::new().set("cx", x).set("cy", y).set("r", self.radius).set("stroke", "#444444");
            group = group.add(circle.set("fill", mark.map_or("#ffffff", |(label, _)| fill(label))));
        }
        group = group.add(self.names());
        for (place, (index, name, trace)) in traces.iter().enumerate() {
            let aside = (place as f64 - (traces.len() as f64 - 1.0) / 2.0) * 4.0;
            group = group.add(self.path(aside, *index, name, trace));
        }
        group.add(self.legend(traces))
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
    fn arrow(&self, data: Data, (ax, ay): (f64, f64), (bx, by): (f64, f64)) -> Data {
        let length = (bx - ax).hypot(by - ay);
        if length < 1.0 {
            return data;
        }
        let (dx, dy) = ((bx - ax) / length, (by - ay) / length);
        let at = |along: f64, aside: f64| {
            let back = self.radius + along;
            (number(bx - dx * back - dy * aside), number(by - dy * back + dx * aside))
        };
        data.move_to(at(0.0, 0.0)).line_to(at(7.0, 3.0)).line_to(at(7.0, -3.0)).close()
    }

    fn names(&self) -> Group {
        let group = Group::new().set("font-size", 11);
        let Some(Type::Enum(names)) = self.system.edges.as_ref().map(|edges| &self.system.vars[edges.var].ty)
        else {
            return group;
        };
        if names.len() > MOST_NAMES {
            return group;
        }
        names.iter().enumerate().fold(group, |group, (node, name)| {
            let (x, y) = self.point(node);
            let text = Text::new(one_line(name)).set("x", x + self.radius + 2.0).set("y", y - self.radius);
            group.add(text)
        })
    }

    /// A path: its line, a ring at the start, a square at the end, and when it comes to each node first.
    fn path(&self, aside: f64, index: usize, name: &str, trace: &Trace) -> Group {
        let (color, dashes) = STROKES[index % STROKES.len()];
        let nodes = self.nodes(trace);
        let points: Vec<(f64, f64)> = nodes.iter().map(|node| self.point(*node)).collect();
        let moved = |(x, y): (f64, f64)| (number(x + aside), number(y - aside));
        let line: Vec<String> =
            points.iter().map(|point| moved(*point)).map(|(x, y)| format!("{x},{y}")).collect();
        let polyline = Polyline::new()
            .set("points", line.join(" "))
            .set("fill", "none")
            .set("stroke", color)
            .set("stroke-width", 3)
            .set("stroke-linejoin", "round")
            .set("stroke-dasharray", if dashes.is_empty() { "none" } else { dashes });
        let mut group = Group::new().set("class", format!("path {name}")).add(Title::new(name)).add(polyline);
        let radius = number(self.radius * 0.7);
        if let (Some(first), Some(last)) = (points.first(), points.last()) {
            let (x, y) = moved(*first);
            let ring = Circle::new().set("cx", x).set("cy", y).set("r", radius);
            group = group.add(ring.set("fill", "#ffffff").set("stroke", color).set("stroke-width", 1.5));
            group = group.add(end(moved(*last), radius, color, false));
        }
        let mut seen = BTreeSet::new();
        let times = Group::new().set("font-size", 10);
        group.add(nodes.iter().enumerate().filter(|(_, node)| seen.insert(**node)).fold(
            times,
            |group, (time, node)| {
                let (x, y) = moved(self.point(*node));
                let text = Text::new(time.to_string()).set("style", format!("fill: {color}"));
                group.add(text.set("x", x + self.radius + 2.0).set("y", y + self.radius + 8.0))
            },
        ))
    }

    /// The nodes of a trace, one a state.
    fn nodes(&self, trace: &Trace) -> Vec<usize> {
        let Some(edges) = &self.system.edges else { return Vec::new() };
        let node = |value: Option<&Value>| match value {
            Some(Value::Enum(node)) => Some(*node as usize).filter(|node| *node < self.places.len()),
            _ => None,
        };
        trace.states.iter().filter_map(|state| node(state.get(usize::from(edges.var)))).collect()
    }

    fn legend(&self, traces: &[(usize, &str, &Trace)]) -> Group {
        let mut group = Group::new().set("font-size", 13);
        let mut y = (self.high.1 - self.low.1) * self.scale + 2.0 * MARGIN + 8.0;
        let mut line = |swatch: Group, words: String| {
            let text = Text::new(words).set("x", MARGIN + 44.0).set("y", y);
            let moved = swatch.set("transform", format!("translate(0 {})", number(y)));
            y += LEGEND_LINE;
            Group::new().add(moved).add(text)
        };
        for (index, name, trace) in traces {
            let (color, dashes) = STROKES[index % STROKES.len()];
            let stroke = Line::new().set("x1", MARGIN).set("x2", MARGIN + 36.0).set("y1", -4).set("y2", -4);
            let stroke = stroke.set("stroke", color).set("stroke-width", 3);
            let stroke = stroke.set("stroke-dasharray", if dashes.is_empty() { "none" } else { dashes });
            let words = format!("{name} ({} steps)", trace.actions.len());
            group = group.add(line(Group::new().add(stroke), words));
        }
        for (label, _) in &self.marks {
            let swatch =
                Rectangle::new().set("x", MARGIN + 20.0).set("y", -12).set("width", 16).set("height", 16);
            let swatch = swatch.set("fill", fill(label)).set("stroke", "#888888");
            group = group.add(line(Group::new().add(swatch), (*label).to_owned()));
        }
        group
    }
}
