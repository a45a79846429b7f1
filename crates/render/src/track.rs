//! Lines of paths that pass the same places, beside each other.
//!
//! Between two neighbouring places each path has a lane of its own for each direction, so that paths that share a way, and
//! one that comes back the way it went, can be followed.

use crate::mover::{Mover, Point};
use crate::style::{clipped, end, every, number, on_white, stroke, width};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Path, Title};

/// Left, top, right and bottom.
pub(crate) type Area = [f64; 4];

/// So many numbers are written along a path at most.
const MOST_NUMBERS: usize = 150;

/// A path that is drawn: where it is at each time.
#[derive(Clone, Debug)]
pub(crate) struct Track<'a> {
    /// Its path variable.
    pub(crate) name: &'a str,
    /// Its place among all paths, which says its colour.
    pub(crate) index: usize,
    /// A number for each place and where that lies, for each state.
    pub(crate) places: Vec<(usize, Point)>,
    /// From this time on nothing changes.
    pub(crate) rest: usize,
    /// Whether it ends in a crash.
    pub(crate) crashed: bool,
}

/// How large things are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    /// From one place to the next.
    pub(crate) room: f64,
    pub(crate) line: f64,
    pub(crate) mark: f64,
    pub(crate) letters: f64,
}

impl Sizes {
    /// What fits into so much room, but nothing that cannot be seen.
    pub(crate) fn of(room: f64) -> Sizes {
        Sizes {
            room,
            line: (room * 0.08).clamp(2.2, 4.0),
            mark: (room * 0.12).clamp(4.5, 7.0),
            letters: (room * 0.25).clamp(9.0, 13.0),
        }
    }

    /// The radius of what moves.
    fn robot(self) -> f64 {
        (self.room * 0.28).clamp(8.0, 14.0)
    }
}

/// A path's line.
struct Line {
    points: Vec<Point>,
    /// The point at each time.
    at: Vec<Point>,
}

/// All paths of a panel; in a film, faint and without numbers, as something moves along them.
/// What is `taken` by others has no numbers on it.
pub(crate) fn draw(tracks: &[Track<'_>], sizes: Sizes, film: bool, taken: Vec<Area>) -> Group {
    let lanes = lanes(tracks);
    let lines = lines(tracks, &lanes, sizes);
    let mut all = Group::new().set("class", "paths");
    for (track, line) in tracks.iter().zip(&lines) {
        all = all.add(drawn(track, line, sizes, film));
    }
    if film {
        return all;
    }
    all.add(arrows(tracks, &lines, &lanes, sizes)).add(numbers(tracks, &lines, sizes, taken))
}

fn lines(tracks: &[Track<'_>], lanes: &Lanes, sizes: Sizes) -> Vec<Line> {
    let mut lines: Vec<Line> = (0..tracks.len()).map(|place| line(tracks, place, lanes, sizes)).collect();
    spread(tracks, &mut lines, sizes);
    lines
}

/// What moves along the paths: where each is at each time, those at the same place beside each other.
pub(crate) fn movers(tracks: &[Track<'_>], sizes: Sizes) -> Vec<Mover> {
    let lanes = lanes(tracks);
    let mut all: Vec<Vec<Point>> = lines(tracks, &lanes, sizes).into_iter().map(|line| line.at).collect();
    let radius = sizes.robot();
    let here = |track: &Track<'_>, time: usize| track.places.get(time).or(track.places.last()).map(|p| p.0);
    for time in 0..tracks.iter().map(|track| track.places.len()).max().unwrap_or(0) {
        for (place, track) in tracks.iter().enumerate() {
            let Some(at) = all[place].get_mut(time) else { continue };
            let mine = here(track, time);
            let same: Vec<usize> =
                (0..tracks.len()).filter(|other| here(&tracks[*other], time) == mine).collect();
            if let (true, Some(before)) = (same.len() > 1, same.iter().position(|other| *other == place)) {
                let step = (1.9 * radius).min(sizes.room.max(3.0 * radius) / same.len() as f64);
                let middle = track.places[time].1;
                *at = (middle.0 + (before as f64 - (same.len() as f64 - 1.0) / 2.0) * step, middle.1);
            }
        }
    }
    let robot = |(track, at): (&Track<'_>, Vec<Point>)| Mover::Robot {
        index: track.index,
        name: track.name.to_owned(),
        at,
        radius,
    };
    tracks.iter().zip(all).map(robot).collect()
}

/// Which tracks go from one place to another, by places and in order.
type Lanes = BTreeMap<(usize, usize), Vec<(bool, usize)>>;

fn lanes(tracks: &[Track<'_>]) -> Lanes {
    let mut lanes = Lanes::new();
    for (place, track) in tracks.iter().enumerate() {
        for pair in track.places.windows(2).filter(|pair| pair[0].0 != pair[1].0) {
            let forward = pair[0].0 < pair[1].0;
            let used = lanes.entry(between(pair)).or_default();
            if let Err(at) = used.binary_search(&(forward, place)) {
                used.insert(at, (forward, place));
            }
        }
    }
    lanes
}

fn between(pair: &[(usize, Point)]) -> (usize, usize) {
    (pair[0].0.min(pair[1].0), pair[0].0.max(pair[1].0))
}

/// How far to the side a track is on its way from one place to the next.
fn aside(lanes: &Lanes, place: usize, pair: &[(usize, Point)], sizes: Sizes) -> Point {
    let forward = pair[0].0 < pair[1].0;
    let Some(used) = lanes.get(&between(pair)) else { return (0.0, 0.0) };
    let lane = used.binary_search(&(forward, place)).unwrap_or(0) as f64 - (used.len() as f64 - 1.0) / 2.0;
    let ((ax, ay), (bx, by)) = if forward { (pair[0].1, pair[1].1) } else { (pair[1].1, pair[0].1) };
    let length = (bx - ax).hypot(by - ay).max(1e-9);
    let most = sizes.room * 0.7 / (used.len() as f64 - 1.0).max(1.0);
    let apart = (sizes.room * 0.2).min(most).max(sizes.line + 1.4) * lane;
    ((by - ay) / length * apart, -(bx - ax) / length * apart)
}

fn plus(a: Point, b: Point) -> Point {
    (a.0 + b.0, a.1 + b.1)
}

fn line(tracks: &[Track<'_>], place: usize, lanes: &Lanes, sizes: Sizes) -> Line {
    let (track, mut points, mut at) = (&tracks[place], Vec::new(), Vec::new());
    let mut before: Option<(&[(usize, Point)], Point)> = None;
    for (time, here) in track.places.iter().enumerate() {
        let next = track.places.get(time..time + 2).filter(|pair| pair[0].0 != pair[1].0);
        let onward = next.map(|pair| (pair, aside(lanes, place, pair, sizes)));
        match (before, onward) {
            (Some((came, from)), Some((_, to))) => {
                // Waiting lies between, where the last point is of an earlier time.
                turn(&mut points, here.1, (came, from), (next.unwrap_or(came), to), sizes);
            }
            (Some((_, side)), None) | (None, Some((_, side))) => points.push(plus(here.1, side)),
            (None, None) => points.push(here.1),
        }
        if points.len() > 1 && points[points.len() - 1] == points[points.len() - 2] {
            points.pop();
        }
        at.push(points.last().copied().unwrap_or(here.1));
        // While it waits it is still on the lane on which it came.
        before = onward.or(before);
    }
    Line { points, at }
}

/// From one lane to the next, at a place.
fn turn(
    points: &mut Vec<Point>,
    here: Point,
    (came, from): (&[(usize, Point)], Point),
    (goes, to): (&[(usize, Point)], Point),
    sizes: Sizes,
) {
    let way = |pair: &[(usize, Point)]| (pair[1].1.0 - pair[0].1.0, pair[1].1.1 - pair[0].1.1);
    let (a, b) = (way(came), way(goes));
    let straight = |(x, y): Point| x.abs() < 1e-6 || y.abs() < 1e-6;
    let dot = a.0 * b.0 + a.1 * b.1;
    if straight(a) && straight(b) && dot.abs() < 1e-6 {
        points.push(plus(here, plus(from, to)));
    } else if came[0].0 == goes[1].0 {
        // Back the way it came: a little further, so that it is seen where it turned.
        let length = a.0.hypot(a.1).max(1e-9);
        let further = (a.0 / length * sizes.line, a.1 / length * sizes.line);
        points.extend([plus(plus(here, from), further), plus(plus(here, to), further)]);
    } else {
        points.extend([plus(here, from), plus(here, to)]);
    }
}

/// Ends that would cover each other are moved apart, those on the left to the left.
fn spread(tracks: &[Track<'_>], lines: &mut [Line], sizes: Sizes) {
    let first = apart(tracks, lines, sizes, |track| track.places.first(), |line| line.points.first());
    let last = apart(tracks, lines, sizes, |track| track.places.last(), |line| line.points.last());
    for (place, line) in lines.iter_mut().enumerate() {
        if let Some(first) = first[place] {
            line.points.insert(0, first);
            line.at[0] = first;
        }
        if let Some(last) = last[place] {
            line.points.push(last);
            let places = &tracks[place].places;
            let waits = places.iter().rev().take_while(|here| Some(*here) == places.last()).count();
            line.at.iter_mut().rev().take(waits).for_each(|at| *at = last);
        }
    }
}

/// Where the end of each track is drawn, if others have theirs at the same place.
fn apart(
    tracks: &[Track<'_>],
    lines: &[Line],
    sizes: Sizes,
    end: for<'a> fn(&'a Track<'_>) -> Option<&'a (usize, Point)>,
    drawn: fn(&Line) -> Option<&Point>,
) -> Vec<Option<Point>> {
    let mut groups: BTreeMap<usize, Vec<(Point, usize)>> = BTreeMap::new();
    for (place, (track, line)) in tracks.iter().zip(lines).enumerate() {
        if let (Some((node, _)), Some(point)) = (end(track), drawn(line)) {
            groups.entry(*node).or_default().push((*point, place));
        }
    }
    let covers = |a: Point, b: Point| (a.0 - b.0).hypot(a.1 - b.1) < 1.7 * sizes.mark;
    let cover = |group: &[(Point, usize)]| {
        group.iter().enumerate().any(|(i, (a, _))| group[..i].iter().any(|(b, _)| covers(*a, *b)))
    };
    let mut found = vec![None; tracks.len()];
    for mut group in groups.into_values().filter(|group| cover(group)) {
        group.sort_by(|a, b| a.0.0.total_cmp(&b.0.0).then(a.1.cmp(&b.1)));
        let all = group.len() as f64;
        let step = (2.4 * sizes.mark).min(sizes.room.max(4.0 * sizes.mark) * 0.8 / all);
        for (before, (_, place)) in group.into_iter().enumerate() {
            let middle = end(&tracks[place]).map(|(_, middle)| *middle);
            found[place] = middle.map(|(x, y)| (x + (before as f64 - (all - 1.0) / 2.0) * step, y));
        }
    }
    found
}

fn drawn(track: &Track<'_>, line: &Line, sizes: Sizes, film: bool) -> Group {
    let (color, dashes) = stroke(track.index);
    let mut data = String::new();
    for (i, (x, y)) in line.points.iter().enumerate() {
        let _ = write!(data, "{}{},{}", if i == 0 { "M" } else { " " }, number(*x), number(*y));
    }
    let path = |color: &str, width: f64| {
        let path = Path::new().set("d", data.as_str()).set("fill", "none").set("stroke", color);
        path.set("stroke-width", number(width)).set("stroke-linejoin", "round")
    };
    let mut group =
        Group::new().set("class", "path").set("data-path", track.name).add(Title::new(track.name));
    if film {
        group = group.set("opacity", 0.4);
    }
    // White below the line, so that it can be seen on obstacles.
    group = group.add(path("#ffffff", sizes.line + 2.0).set("stroke-opacity", 0.85));
    group = group.add(path(color, sizes.line).set("stroke-dasharray", dashes));
    if let (Some((x, y)), Some(&last)) = (line.points.first(), line.points.last()) {
        let ring = Circle::new().set("cx", number(*x)).set("cy", number(*y)).set("r", number(sizes.mark));
        group = group.add(ring.set("fill", "#ffffff").set("stroke", color).set("stroke-width", 2));
        group = group.add(end(last, sizes.mark * 0.9, color, track.crashed));
    }
    group
}

/// Which way a line leads, where several share a way.
fn arrows(tracks: &[Track<'_>], lines: &[Line], lanes: &Lanes, sizes: Sizes) -> Group {
    let mut group = Group::new().set("class", "ways");
    if sizes.room < 20.0 {
        return group;
    }
    for (place, (track, _)) in tracks.iter().zip(lines).enumerate() {
        let (color, _) = stroke(track.index);
        let mut heads = Data::new();
        for pair in track.places.windows(2).filter(|pair| pair[0].0 != pair[1].0) {
            if lanes.get(&between(pair)).is_none_or(|used| used.len() < 2) {
                continue;
            }
            let side = aside(lanes, place, pair, sizes);
            let (a, b) = (plus(pair[0].1, side), plus(pair[1].1, side));
            heads = head(heads, (a.0 * 0.4 + b.0 * 0.6, a.1 * 0.4 + b.1 * 0.6), a, b, sizes.line + 2.0);
        }
        group = group.add(Path::new().set("d", heads).set("fill", color).set("data-path", track.name));
    }
    group
}

/// An arrow's head with its point there, on the way from one point to another.
pub(crate) fn head(data: Data, tip: Point, (ax, ay): Point, (bx, by): Point, size: f64) -> Data {
    let length = (bx - ax).hypot(by - ay);
    if length < 1.0 {
        return data;
    }
    let (dx, dy) = ((bx - ax) / length, (by - ay) / length);
    let at = |back: f64, aside: f64| {
        (number(tip.0 - dx * back - dy * aside), number(tip.1 - dy * back + dx * aside))
    };
    data.move_to(at(0.0, 0.0))
        .line_to(at(size * 1.3, size * 0.6))
        .line_to(at(size * 1.3, -size * 0.6))
        .close()
}

/// The names of paths at their starts, and numbers of steps where there is room for them.
fn numbers(tracks: &[Track<'_>], lines: &[Line], sizes: Sizes, mut taken: Vec<Area>) -> Group {
    let mut put = |words: &str, at: Point, size: f64, color: &str, must: bool| {
        let (wide, off) = (width(words, size), sizes.mark + 1.5);
        let spots = [
            (at.0 + off, at.1 + off + size * 0.6),
            (at.0 + off, at.1 - off),
            (at.0 - off - wide, at.1 + off + size * 0.6),
            (at.0 - off - wide, at.1 - off),
            (at.0 + off, at.1 + off + size * 1.7),
            (at.0 + off, at.1 - off - size * 1.1),
        ];
        let area = |(x, y): Point| [x, y - size * 0.8, x + wide, y + size * 0.1];
        let free = |spot: &Point| {
            let [a, b, c, d] = area(*spot);
            taken.iter().all(|[e, f, g, h]| c < *e || *g < a || d < *f || *h < b)
        };
        let spot = spots.into_iter().find(free).or(must.then_some(spots[0]))?;
        taken.push(area(spot));
        Some(on_white(words, spot, size, color))
    };
    // Names first, as they must be there.
    let mut groups: Vec<Group> = Vec::new();
    for (track, line) in tracks.iter().zip(lines) {
        let group = Group::new().set("data-path", track.name);
        let name = line.at.first();
        let name = name.and_then(|at| {
            put(&clipped(track.name, 12), *at, sizes.letters + 3.0, stroke(track.index).0, true)
        });
        groups.push(name.into_iter().fold(group, |group, name| group.add(name.set("class", "name"))));
    }
    let mut group = Group::new().set("class", "steps");
    for ((track, line), mut own) in tracks.iter().zip(lines).zip(groups) {
        for (time, words) in visits(track, sizes) {
            let text = put(&words, line.at[time], sizes.letters, stroke(track.index).0, time == track.rest);
            own = text.into_iter().fold(own, Group::add);
        }
        group = group.add(own);
    }
    group
}

/// The times to be written, each with the words, the first time of each place that it passes: when it is there.
fn visits(track: &Track<'_>, sizes: Sizes) -> Vec<(usize, String)> {
    let rest = track.rest.min(track.places.len().saturating_sub(1));
    // Some forty numbers are as many as one reads.
    let apart = every(sizes.room, 2.2 * sizes.letters).max(every(1.0, rest as f64 / 40.0));
    let mut times: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
    for (time, (place, _)) in track.places.iter().enumerate().take(rest + 1) {
        let stays = times.entry(*place).or_default();
        match stays.last_mut() {
            Some((_, last)) if *last + 1 == time => *last = time,
            _ => stays.push((time, time)),
        }
    }
    let wanted = |stays: &[(usize, usize)]| {
        let due = |(from, to): &(usize, usize)| from % apart == 0 || *to == rest || to > from;
        stays.iter().any(due) && stays != [(0, 0)]
    };
    let mut all: Vec<(usize, String)> = Vec::new();
    for stays in times.values().filter(|stays| wanted(stays)) {
        let one = |(from, to): &(usize, usize)| {
            if from == to { from.to_string() } else { format!("{from}–{to}") }
        };
        let mut words: Vec<String> = stays.iter().take(3).map(one).collect();
        if stays.len() > 3 {
            words.push("…".to_owned());
        }
        let at = stays.iter().find(|(_, to)| *to == rest).unwrap_or(&stays[0]);
        all.push((if at.1 == rest { rest } else { at.0 }, words.join(",")));
    }
    all.sort();
    let (count, of) = (all.len(), all.len().div_ceil(MOST_NUMBERS).max(1));
    all.into_iter().enumerate().filter(|(i, _)| i % of == 0 || i + 1 == count).map(|(_, one)| one).collect()
}
