//! Systems from maps: the items that only maps have, and the files that hold them.

use super::base::Base;
use super::changes::{Changes, Origin};
use super::consts::duplicate;
use super::diagnostics::suggest;
use super::env::Env;
use super::files::{load, text_of};
use super::grid::{self, Format, GridMap, Legend, MOVES, Meaning, Move, Raster, Row, Rule, Rules, formats};
use super::image::{self, Colors, color};
use super::ros;
use hyperplan_syntax::ast::{self, Ident, SystemItem, Text};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
use std::hash::Hash;

/// A map whose rows stand in the problem file.
pub(super) fn inline(ast: &ast::System, rows: &[Text], env: &mut Env) -> Base {
    let lines: Vec<Row> =
        rows.iter().map(|row| Row { text: &row.text, span: row.span, verbatim: false }).collect();
    let whole = rows.iter().map(|row| row.span).reduce(Span::to).unwrap_or(ast.span);
    let changes = Changes::of(ast, env);
    let map = letters(ast, Format::Text, env)
        .and_then(|legend| grid::from_rows(&lines, Format::Text, &legend, whole, env.diagnostics));
    let map = map
        .zip(changes)
        .and_then(|(map, changes)| changes.apply(map, Origin { is_ros: false, whole, file: None }, env));
    finish(ast, map, env)
}

/// A map in a file of its own: text, a Moving AI benchmark, a ROS map, or a picture.
pub(super) fn file(ast: &ast::System, file: &Text, env: &mut Env) -> Base {
    let changes = Changes::of(ast, env);
    let frees = changes.as_ref().is_some_and(Changes::frees_unknown);
    let map = read_file(ast, file, frees, env).zip(changes);
    let file = Some(file.text.as_str());
    let map = map
        .and_then(|((map, is_ros, whole), changes)| changes.apply(map, Origin { is_ros, whole, file }, env));
    finish(ast, map, env)
}

/// The map, whether it is one of ROS, and its place; `None` after a message.
fn read_file(ast: &ast::System, file: &Text, frees: bool, env: &mut Env) -> Option<(Raster, bool, Span)> {
    let bytes = load(file, env)?;
    if formats::is_png(&bytes) {
        let legend = colors(ast, env)?;
        return Some((image::read(file, &bytes, &legend, env)?, false, file.span));
    }
    let text = text_of(file, bytes, "a map", env)?;
    let lower = file.text.to_lowercase();
    if let Some((what, instead)) =
        OTHERS.iter().find_map(|(end, what, instead)| lower.ends_with(end).then_some((what, instead)))
    {
        let message = format!("`{}` is {what}, no map", file.text);
        env.diagnostics.push(Diagnostic::error("bad-map", file.span, message).with_help(*instead));
        return None;
    }
    let source = env.sources.add(file.text.clone(), text.as_str());
    if lower.ends_with(".yaml") || lower.ends_with(".yml") {
        // Pixels are no letters, but a legend for them is a mistake worth reporting.
        letters(ast, Format::Text, env)?;
        let map = ros::read((&file.text, file.span), source, &text, frees, env)?;
        return Some((map, true, file.span));
    }
    let whole = Span::new(source, 0..text.len().min(1));
    let mut lines = lines(&text, source);
    if is_moving_ai(&lines) {
        let legend = letters(ast, Format::MovingAi, env)?;
        let rows = moving_ai(&lines, env)?;
        let map = grid::from_rows(rows, Format::MovingAi, &legend, whole, env.diagnostics)?;
        return Some((map, false, whole));
    }
    while lines.last().is_some_and(|row| row.text.is_empty()) {
        lines.pop();
    }
    if lines.is_empty() {
        let message = format!("the map file `{}` is empty", file.text);
        return env.diagnostics.refuse(Diagnostic::error("bad-map", file.span, message));
    }
    let legend = letters(ast, Format::Text, env)?;
    let map = grid::from_rows(&lines, Format::Text, &legend, whole, env.diagnostics)?;
    Some((map, false, whole))
}

/// Files that people name where a map is wanted: how they end, what they are, and what to give instead.
const OTHERS: [(&str, &str, &str); 2] = [
    (
        ".scen",
        "a list of scenarios",
        "give the map that it is for, and in braces `scenario \"FILE.scen\" N;` for start and goal",
    ),
    (".json", "a graph", "write `graph(...)` in place of `grid(...)`"),
];

/// Whether lines begin with a header of the Moving AI Lab: it comes in several spellings.
fn is_moving_ai(lines: &[Row<'_>]) -> bool {
    let first = lines.iter().map(header).find(|words| !words.is_empty());
    match first.as_deref() {
        Some([word, ..]) => ["type", "height", "width"].contains(&word.as_str()),
        _ => false,
    }
}

/// The words of a header's line, in small letters; none of a note.
fn header(line: &Row<'_>) -> Vec<String> {
    match line.text.trim_start().starts_with("# ") {
        true => Vec::new(),
        false => line.text.split_whitespace().map(str::to_lowercase).collect(),
    }
}

/// The lines of a text with their places, without line ends.
fn lines(text: &str, source: hyperplan_syntax::SourceId) -> Vec<Row<'_>> {
    let mut start = 0;
    let mut rows = Vec::new();
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim_end_matches(['\n', '\r']);
        let span = Span::new(source, start..start + trimmed.len());
        rows.push(Row { text: trimmed, span, verbatim: true });
        start += line.len();
    }
    rows
}

/// The rows of a Moving AI map, after its header is read and agrees with them.
fn moving_ai<'a>(lines: &'a [Row<'a>], env: &mut Env) -> Option<&'a [Row<'a>]> {
    let bad = |env: &mut Env, span, message: String| {
        env.diagnostics.push(Diagnostic::error("bad-map", span, message));
    };
    let (mut height, mut width) = (None, None);
    for (index, line) in lines.iter().enumerate() {
        let words = header(line);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match words.as_slice() {
            [] | ["type", _] => {}
            ["height", n] if n.parse::<usize>().is_ok() => height = n.parse().ok(),
            ["width", n] if n.parse::<usize>().is_ok() => width = n.parse().ok(),
            ["map"] => {
                let (Some(height), Some(width)) = (height, width) else {
                    bad(env, line.span, "the header gives no height or no width".into());
                    return None;
                };
                let mut rows = &lines[index + 1..];
                while let [rest @ .., last] = rows
                    && last.text.is_empty()
                {
                    rows = rest;
                }
                return sized(rows, width, height, line.span, env).then_some(rows);
            }
            _ => {
                let message = "expected `type octile`, `height N`, `width N` or `map`".into();
                bad(env, line.span, message);
                return None;
            }
        }
    }
    let end = lines.last().map(|line| line.span)?;
    bad(env, end, "the header does not end: no line `map`".into());
    None
}

/// Whether the rows have the size that the header says.
fn sized(rows: &[Row], width: usize, height: usize, header: Span, env: &mut Env) -> bool {
    if rows.len() != height {
        let message = format!("the header says {height} rows, the map has {}", rows.len());
        env.diagnostics.push(Diagnostic::error("bad-map", header, message));
        return false;
    }
    let wrong = rows.iter().find(|row| row.text.chars().count() != width);
    if let Some(row) = wrong {
        let message = format!("this row has {} cells, the header says {width}", row.text.chars().count());
        env.diagnostics.push(Diagnostic::error("ragged-map", row.span, message));
    }
    wrong.is_none()
}

/// The system's parts; without a map after an error, what keeps the names known that every map has.
fn finish(ast: &ast::System, map: Option<Raster>, env: &mut Env) -> Base {
    let rules = rules(ast, env);
    let failed = map.is_none();
    let map = map.map_or(GridMap { width: 1, height: 1, ..GridMap::default() }, Raster::finish);
    let mut base = grid::base(&map, &rules, env.actions, ast.span);
    base.poisoned = failed;
    base
}

/// What the `legend` items say of letters, or `None` after a message.
fn letters(ast: &ast::System, format: Format, env: &mut Env) -> Option<Legend> {
    legend(ast, env, |letter, env| {
        let mut chars = letter.text.chars();
        let wrong = match (chars.next(), chars.next()) {
            (Some(c), None) if format.may_redefine(c) => return Some(c),
            (Some(c), None) => {
                let message = format!("the letter {c:?} has a meaning already");
                let help = "in maps `.` and space are free, `#` and `@` obstacles, `S` start, `G` goal";
                Diagnostic::error("reserved-name", letter.span, message).with_help(help)
            }
            _ if color(&letter.text).is_some() => {
                let message = "the cells of this map are no colours: only pictures in PNG have some";
                Diagnostic::error("bad-legend", letter.span, message)
            }
            _ => Diagnostic::error("bad-legend", letter.span, "expected a single letter"),
        };
        env.diagnostics.refuse(wrong)
    })
}

/// What the `legend` items say of colours, or `None` after a message.
fn colors(ast: &ast::System, env: &mut Env) -> Option<Colors> {
    legend(ast, env, |letter, env| {
        color(&letter.text).or_else(|| {
            let message = "the cells of a picture are colours, no letters";
            let wrong = Diagnostic::error("bad-legend", letter.span, message);
            env.diagnostics.refuse(wrong.with_help("write `legend '#0000ff' = water;`"))
        })
    })
}

/// What each key that the `legend` items name stands for, or `None` after a message.
fn legend<K: Copy + Eq + Hash>(
    ast: &ast::System,
    env: &mut Env,
    key: impl Fn(&Text, &mut Env) -> Option<K>,
) -> Option<Vec<(K, Meaning)>> {
    let mut legend = Vec::new();
    let mut places: FxHashMap<K, Span> = FxHashMap::default();
    let mut failed = false;
    for item in &ast.items {
        let SystemItem::Legend { letter, label, span } = item else { continue };
        let Some(key) = key(letter, env) else {
            failed = true;
            continue;
        };
        if let Some(first) = places.insert(key, *span) {
            let message = format!("a second legend for '{}'", letter.text);
            let second = Diagnostic::error("duplicate-name", *span, message);
            env.diagnostics.push(second.with_related(first, "the first one"));
            failed = true;
        }
        legend.push((key, label.as_ref().map_or(Meaning::Obstacle, |l| Meaning::Labelled(l.name.clone()))));
    }
    (!failed).then_some(legend)
}

/// The `moves`, `obstacle`, `edge` and `corner` items.
fn rules(ast: &ast::System, env: &mut Env) -> Rules {
    let mut moves: Option<Vec<Move>> = None;
    let (mut obstacle, mut edge, mut corner) = (None, None, None);
    let mut seen: FxHashMap<&str, Span> = FxHashMap::default();
    for item in &ast.items {
        let (what, at) = match item {
            SystemItem::Moves(names) => match names.first() {
                Some(first) => ("moves", first),
                None => continue,
            },
            SystemItem::Obstacle(rule) => ("obstacle", rule),
            SystemItem::Edge(rule) => ("edge", rule),
            SystemItem::Corner(rule) => ("corner", rule),
            _ => continue,
        };
        if let Some(first) = seen.insert(what, at.span) {
            let message = format!("`{what}` was said already");
            let diagnostic = Diagnostic::error("repeated-item", at.span, message);
            env.diagnostics.push(diagnostic.with_related(first, "here"));
        }
        match item {
            SystemItem::Moves(names) => moves = Some(named_moves(names, env)),
            SystemItem::Obstacle(name) => obstacle = named_rule(name, &[], env),
            SystemItem::Edge(name) => edge = named_rule(name, &[], env),
            SystemItem::Corner(name) if name.name == FREE => {}
            SystemItem::Corner(name) => corner = named_rule(name, &[FREE], env),
            _ => {}
        }
    }
    Rules {
        moves: moves.filter(|m| !m.is_empty()).unwrap_or_else(|| MOVES[..4].to_vec()),
        obstacle: obstacle.unwrap_or_default(),
        edge: edge.unwrap_or_default(),
        corner,
        clauses_move: ast.items.iter().any(moves_itself),
    }
}

/// Of `corner`: a diagonal move between two obstacles is one like others.
const FREE: &str = "free";

/// Whether an item is a clause that says where the robot is next.
fn moves_itself(item: &SystemItem) -> bool {
    match item {
        SystemItem::On(clause) | SystemItem::Also(clause) => {
            clause.updates.iter().any(|u| matches!(u.var.name.as_str(), "x" | "y"))
        }
        _ => false,
    }
}

fn named_moves(names: &[Ident], env: &mut Env) -> Vec<Move> {
    let mut moves: Vec<Move> = Vec::new();
    for (index, name) in names.iter().enumerate() {
        match MOVES.iter().find(|m| m.name == name.name) {
            Some(step) if !moves.contains(step) => moves.push(*step),
            Some(_) => {
                let first = names[..index].iter().find(|n| n.name == name.name).unwrap_or(name);
                env.diagnostics.push(duplicate("move", name, first.span));
            }
            None => {
                let diagnostic =
                    Diagnostic::error("unknown-move", name.span, format!("no move `{}`", name.name));
                env.diagnostics.push(suggest(diagnostic, &name.name, MOVES.iter().map(|m| m.name)));
            }
        }
    }
    moves
}

fn named_rule(name: &Ident, others: &[&str], env: &mut Env) -> Option<Rule> {
    let rule = name.name.parse().ok();
    if rule.is_none() {
        let diagnostic = Diagnostic::error("unknown-rule", name.span, format!("no rule `{}`", name.name));
        env.diagnostics.push(suggest(
            diagnostic,
            &name.name,
            Rule::ALL.map(Rule::name).into_iter().chain(others.iter().copied()),
        ));
    }
    rule
}
