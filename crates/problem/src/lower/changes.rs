//! What is done to a map once it is read: scenarios put on it, unknown cells settled, obstacles grown, cells merged, a part
//! cut out, distances measured. In this order, whatever the order of the items.

use super::env::Env;
use super::grid::{Cell, Clearance, Lettered, MAX_CELLS, Occupancy, Raster};
use super::scenarios::{self, Scenario};
use crate::expr::{Rational, Value};
use hyperplan_syntax::ast::{self, Expr, Ident, MapItem, SystemItem};
use hyperplan_syntax::{Diagnostic, Span};

/// What a map was read from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin<'a> {
    /// Whether it is one of ROS.
    pub(super) is_ros: bool,
    /// Where it stands, or is named.
    pub(super) whole: Span,
    /// Its file, if it has one of its own.
    pub(super) file: Option<&'a str>,
}

/// How far obstacles grow.
#[derive(Clone, Copy, Debug)]
enum Radius {
    Cells(Rational),
    Metres(Rational),
}

/// The items of a system that change its map, each at most once, with its place.
#[derive(Debug, Default)]
pub(super) struct Changes {
    scenario: Option<(Scenario, Span)>,
    unknown: Option<(Occupancy, Span)>,
    inflate: Option<(Radius, Span)>,
    scale: Option<(i64, Span)>,
    /// The first and the last column, the first and the last row.
    crop: Option<([i64; 4], Span)>,
    clearance: Option<(Ident, u32)>,
}

/// Distances that are counted.
const MAX_CLEARANCE: u32 = 100;

impl Changes {
    /// The items of a system; `None` after a message.
    pub(super) fn of(ast: &ast::System, env: &mut Env) -> Option<Changes> {
        let mut changes = Changes::default();
        let (mut seen, mut good): (Vec<(&str, Span)>, bool) = (Vec::new(), true);
        for item in &ast.items {
            let SystemItem::Map { item, span } = item else { continue };
            if let Some((word, first)) = seen.iter().find(|(word, _)| *word == item.word()) {
                let message = format!("`{word}` was said already");
                let diagnostic = Diagnostic::error("repeated-item", *span, message);
                env.diagnostics.push(diagnostic.with_related(*first, "here"));
                good = false;
                continue;
            }
            seen.push((item.word(), *span));
            good &= changes.add(item, *span, env).is_some();
        }
        good.then_some(changes)
    }

    fn add(&mut self, item: &MapItem, span: Span, env: &mut Env) -> Option<()> {
        match item {
            MapItem::Scenario { file, row } => {
                let number = env.consts.evaluate(row, env.diagnostics)?;
                self.scenario = Some((scenarios::read(file, number, row.span, env)?, span));
            }
            MapItem::Unknown(rule) => self.unknown = Some((unknown(rule, env)?, span)),
            MapItem::Inflate { by, metres } => {
                let by = radius(by, env)?;
                let radius = if metres.is_some() { Radius::Metres(by) } else { Radius::Cells(by) };
                self.inflate = Some((radius, span));
            }
            MapItem::Scale(by) => self.scale = Some((env.consts.evaluate(by, env.diagnostics)?, span)),
            MapItem::Crop(part) => {
                let ends = [&part.x.0, &part.x.1, &part.y.0, &part.y.1];
                let ends = ends.map(|end| env.consts.evaluate(end, env.diagnostics));
                let [Some(x0), Some(x1), Some(y0), Some(y1)] = ends else { return None };
                self.crop = Some(([x0, x1, y0, y1], span));
            }
            MapItem::Clearance { name, most } => {
                let number = env.consts.evaluate(most, env.diagnostics)?;
                let Some(number) = u32::try_from(number).ok().filter(|n| (1..=MAX_CLEARANCE).contains(n))
                else {
                    let message =
                        format!("distances are counted up to 1 to {MAX_CLEARANCE} cells, not {number}");
                    return env.diagnostics.refuse(Diagnostic::error("bad-map", most.span, message));
                };
                self.clearance = Some((name.clone(), number));
            }
        }
        Some(())
    }

    /// Whether unknown cells are said to be free.
    pub(super) fn frees_unknown(&self) -> bool {
        matches!(self.unknown, Some((Occupancy::Free, _)))
    }

    /// Changes a map; `None` after a message.
    pub(super) fn apply(&self, mut map: Raster, origin: Origin<'_>, env: &mut Env) -> Option<Raster> {
        let Origin { is_ros, whole, file } = origin;
        if let (Some((_, span)), false) = (self.unknown, is_ros) {
            let message = "only maps of ROS have cells that are unknown";
            return env.diagnostics.refuse(Diagnostic::error("misplaced-item", span, message));
        }
        map.settle_unknown(self.unknown.map_or(Occupancy::Obstacle, |(what, _)| what));
        if let Some((scenario, span)) = &self.scenario {
            place(&mut map, scenario, *span, env)?;
            same_map(scenario, file, *span, env);
        }
        if map.free() == 0 {
            return env.diagnostics.refuse(Diagnostic::error("bad-map", whole, "the map has no free cell"));
        }
        if let Some((radius, span)) = self.inflate {
            let limit = limit(&map, radius, span, env)?;
            self.step(&mut map, "inflate", span, env, |map| map.inflate(limit))?;
        }
        if let Some((by, span)) = self.scale {
            let most = map.width.max(map.height);
            let Some(by) = u32::try_from(by).ok().filter(|by| (1..=most).contains(by)) else {
                let message = format!("a map of {} x {} cells is not scaled by {by}", map.width, map.height);
                return env.diagnostics.refuse(Diagnostic::error("bad-map", span, message));
            };
            self.step(&mut map, "scale", span, env, |map| map.scale(by))?;
        }
        if let Some((ends, span)) = self.crop {
            let (first, last) = part(&map, ends, span, env)?;
            self.step(&mut map, "crop", span, env, |map| map.crop(first, last))?;
        }
        if map.cells.len() > MAX_CELLS {
            let message = format!("the map has {} x {} cells, more than {MAX_CELLS}", map.width, map.height);
            let help = "cut it by `crop X0..X1, Y0..Y1;`, or make its cells larger by `scale N;`";
            return env.diagnostics.refuse(Diagnostic::error("bad-map", whole, message).with_help(help));
        }
        let clearance = self.clearance.as_ref();
        map.clearance =
            clearance.map(|(name, most)| Clearance { name: name.clone(), cells: map.by_clearance(*most) });
        Some(map)
    }

    /// One change, which must leave free cells, and those where a scenario begins and ends.
    fn step(
        &self,
        map: &mut Raster,
        word: &str,
        span: Span,
        env: &mut Env,
        change: impl FnOnce(&mut Raster),
    ) -> Option<()> {
        let had: Vec<bool> = map.labels.iter().map(|label| !label.cells.is_empty()).collect();
        change(map);
        if map.free() == 0 {
            let message = format!("after `{word}` the map has no free cell");
            return env.diagnostics.refuse(Diagnostic::error("bad-map", span, message));
        }
        let mut good = true;
        let labels = map.labels.iter().zip(had);
        for (label, _) in labels.filter(|(label, had)| *had && label.cells.is_empty()) {
            let message = format!("after `{word}` no free cell of `{}` is left", label.name);
            let diagnostic = match &self.scenario {
                Some((scenario, _)) if [START, GOAL].contains(&label.name.as_str()) => {
                    good = false;
                    Diagnostic::error("label-lost", span, message).with_related(scenario.span, "the scenario")
                }
                _ => Diagnostic::warning("label-lost", span, message),
            };
            env.diagnostics.push(diagnostic);
        }
        good.then_some(())
    }
}

const START: &str = "start";
const GOAL: &str = "goal";

fn unknown(rule: &Ident, env: &mut Env) -> Option<Occupancy> {
    match rule.name.as_str() {
        "obstacle" => Some(Occupancy::Obstacle),
        "free" => Some(Occupancy::Free),
        other => {
            let message = format!("unknown cells are `obstacle` or `free`, not `{other}`");
            env.diagnostics.refuse(Diagnostic::error("unknown-rule", rule.span, message))
        }
    }
}

fn radius(by: &Expr, env: &mut Env) -> Option<Rational> {
    let radius = match env.consts.number(by, env.diagnostics)? {
        Value::Int(n) => Rational::from(n),
        Value::Real(r) => r,
        Value::Bool(_) | Value::Enum(_) => return None,
    };
    if radius < Rational::ZERO {
        let message = format!("obstacles do not grow by {radius}");
        return env.diagnostics.refuse(Diagnostic::error("bad-map", by.span, message));
    }
    Some(radius)
}

/// The square of a radius in cells, rounded down; all that is farther than the map is long is alike.
fn limit(map: &Raster, radius: Radius, span: Span, env: &mut Env) -> Option<u64> {
    let (numerator, denominator) = match (radius, map.place) {
        (Radius::Cells(cells), _) => (i128::from(*cells.numer()), i128::from(*cells.denom())),
        (Radius::Metres(metres), Some(place)) => {
            let wide = |a: &i64, b: &i64| i128::from(*a) * i128::from(*b);
            let (n, d) = (
                wide(metres.numer(), place.resolution.denom()),
                wide(metres.denom(), place.resolution.numer()),
            );
            let common = num_integer::gcd(n, d).max(1);
            (n / common, d / common)
        }
        (Radius::Metres(_), None) => {
            let message = "this map does not say how large its cells are";
            let diagnostic = Diagnostic::error("bad-map", span, message);
            let help = "give the radius in cells, `inflate 2;`, or a map of ROS with a `resolution`";
            return env.diagnostics.refuse(diagnostic.with_help(help));
        }
    };
    let longest = i128::from(map.width) + i128::from(map.height);
    if numerator / denominator >= longest {
        return u64::try_from(longest * longest).ok();
    }
    let square = |n: i128| n.checked_mul(n);
    let limit = square(numerator).zip(square(denominator)).map(|(n, d)| n / d);
    limit.and_then(|limit| u64::try_from(limit).ok()).or_else(|| {
        let message = "the radius has too many digits";
        env.diagnostics.refuse(Diagnostic::error("number-too-large", span, message))
    })
}

/// The first and the last cell of a part of the map.
fn part(map: &Raster, ends: [i64; 4], span: Span, env: &mut Env) -> Option<(Cell, Cell)> {
    let mut inside = |what: &str, first: i64, last: i64, size: u32| {
        let number = |n: i64| u32::try_from(n).ok().filter(|n| *n < size);
        match (number(first), number(last)) {
            (Some(first), Some(last)) if first <= last => Some((first, last)),
            _ => {
                let most = size - 1;
                let message = format!("the map has the {what} 0..{most}, not {first}..{last}");
                env.diagnostics.refuse(Diagnostic::error("bad-map", span, message))
            }
        }
    };
    let [x0, x1, y0, y1] = ends;
    let (x, y) = (inside("columns", x0, x1, map.width), inside("rows", y0, y1, map.height));
    let ((x0, x1), (y0, y1)) = (x?, y?);
    Some(((x0, y0), (x1, y1)))
}

/// Warns of a scenario for a map of another name: many are of one size.
fn same_map(scenario: &Scenario, file: Option<&str>, span: Span, env: &mut Env) {
    let name = |path: &str| path.rsplit(['/', '\\']).next().unwrap_or_default().to_lowercase();
    if let Some(file) = file.filter(|file| name(file) != name(&scenario.map)) {
        let message = format!("the scenario is for `{}`, and the map is `{file}`", scenario.map);
        let warning = Diagnostic::warning("other-map", span, message);
        env.diagnostics.push(warning.with_related(scenario.span, "the scenario"));
    }
}

/// Puts the labels of a scenario on a map; `None` after a message.
fn place(map: &mut Raster, scenario: &Scenario, span: Span, env: &mut Env) -> Option<()> {
    let bad = |message: String| {
        Diagnostic::error("bad-scenario", scenario.span, message).with_related(span, "used here")
    };
    let (width, height) = scenario.size;
    if (width, height) != (map.width, map.height) {
        let message = format!(
            "the scenario is for a map of {width} x {height} cells, `{}`; this one has {} x {}",
            scenario.map, map.width, map.height
        );
        return env.diagnostics.refuse(bad(message));
    }
    let mut good = true;
    for (name, letter, (x, from_top)) in [(START, 'S', scenario.start), (GOAL, 'G', scenario.goal)] {
        if map.labels.iter().any(|label| label.name == name) {
            let message = format!("the map has a `{name}` already");
            env.diagnostics.push(Diagnostic::error("duplicate-name", span, message));
            good = false;
        } else if x >= width || from_top >= height {
            let message = format!(
                "the {name} is not on the map: its columns are 0..{}, its rows 0..{}",
                width - 1,
                height - 1
            );
            env.diagnostics.push(bad(message));
            good = false;
        } else {
            let cell = (x, height - 1 - from_top);
            if map.cells[map.index(cell)] != Occupancy::Free {
                env.diagnostics.push(bad(format!("the {name} is an obstacle of this map")));
                good = false;
            }
            map.labels.push(Lettered { name: name.to_owned(), letter: Some(letter), cells: vec![cell] });
        }
    }
    good.then_some(())
}
