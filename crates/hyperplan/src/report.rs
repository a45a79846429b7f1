//! How results and messages are printed, where several commands do it alike.

use crate::failure::{Exit, Failure, Result};
use crate::output::Output;
use hyperplan_outlet::is_harmless;
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
