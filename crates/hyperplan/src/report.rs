//! How results and messages are printed, where several commands do it alike.

use crate::failure::{Exit, Failure, Result};
use crate::output::Output;
use hyperplan_outlet::is_harmless;
use hyperplan_problem::{Objective, Quantifier, System, Trace};
use hyperplan_render::{Board, Scene, TextStyle, actions_line, table, text_map};
use hyperplan_syntax::{Diagnostic, SourceMap, render};
use serde::Serialize;

/// One line of JSON, which does no harm to a terminal.
pub(crate) fn json(value: &impl Serialize) -> Result<String> {
    // Our own structs have string keys and finite numbers.
    let text = serde_json::to_string(value);
    let text = text.map_err(|e| Failure::new(Exit::Bug, format_args!("cannot write JSON: {e}")))?;
    if text.chars().all(is_harmless) {
        return Ok(text);
    }
    // What does harm stands in strings, and to a reader of JSON an escape is the same; all of it is below U+10000.
    let escaped = |c: char| if is_harmless(c) { c.to_string() } else { format!("\\u{:04x}", u32::from(c)) };
    Ok(text.chars().map(escaped).collect())
}

/// Width of messages. The same on every terminal, so that messages can be compared.
pub(crate) const WIDTH: usize = 100;

/// How many errors, and how many warnings, are shown as text.
const SHOWN: usize = 100;

/// Prints diagnostics on standard error: errors always, warnings unless they are not wanted.
pub(crate) fn diagnostics(sources: &SourceMap, diagnostics: &[Diagnostic], out: &Output) {
    let (errors, warnings): (Vec<_>, Vec<_>) = diagnostics.iter().cloned().partition(Diagnostic::is_error);
    if !errors.is_empty() {
        out.lines(rendered(sources, &errors, "errors", out));
    }
    if !warnings.is_empty() && !out.is_quiet() {
        out.lines(rendered(sources, &warnings, "warnings", out));
    }
}

/// More of one kind than anybody reads are counted only.
fn rendered(sources: &SourceMap, diagnostics: &[Diagnostic], what: &str, out: &Output) -> String {
    let shown = &diagnostics[..diagnostics.len().min(SHOWN)];
    let text = render(sources, shown, out.color_errors, WIDTH);
    match diagnostics.len() - shown.len() {
        0 => text.trim_end().to_owned(),
        more => format!("{}\n\nand {more} more {what}", text.trim_end()),
    }
}

/// What the paths of the leading block are called.
pub(crate) fn role(objective: &Objective) -> &'static str {
    match objective.paths.first().map(|p| p.quantifier) {
        Some(Quantifier::Forall) => "counterexample",
        _ => "strategy",
    }
}

/// Larger maps are left to `--plot`.
const MAP_COLUMNS: u32 = 64;
const MAP_ROWS: u32 = 40;
/// Longer tables are left to `--save`.
const TABLE_ROWS: usize = 60;

/// The traces of a scene: what is done, and where that leads, on a map or as tables, if these are not large.
pub(crate) fn paths_text(scene: Scene<'_>, color: bool) -> String {
    let (problem, Some(objective)) = (scene.problem, scene.objective) else { return String::new() };
    let name = |trace: &Trace| objective.paths.get(trace.path).map_or("", |p| p.name.as_str());
    let mut text = String::new();
    for trace in scene.traces {
        text += &format!("{}: {}\n", name(trace), actions_line(problem, objective, trace));
    }
    let system = |trace: &Trace| objective.paths.get(trace.path).map(|p| &problem.systems[p.system]);
    let (drawn, written): (Vec<Trace>, Vec<Trace>) =
        scene.traces.iter().cloned().partition(|trace| system(trace).is_some_and(is_drawable));
    if !drawn.is_empty()
        && let Ok(map) = text_map(Scene { traces: &drawn, ..scene }, TextStyle { color })
    {
        text += &format!("\n{map}");
    }
    for trace in written.iter().filter(|t| t.states.len() <= TABLE_ROWS) {
        text += &format!("\n{}:\n{}", name(trace), table(problem, objective, trace));
    }
    text
}

/// Whether a system has a map that is not too large for text.
pub(crate) fn is_drawable(system: &System) -> bool {
    Board::of(system).is_ok_and(|b| b.width <= MAP_COLUMNS && b.height <= MAP_ROWS)
}
