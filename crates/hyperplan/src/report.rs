//! How results and messages are printed, where several commands do it alike.

use crate::failure::{Exit, Failure, Result};
use crate::files::write_bytes;
use crate::output::Output;
use hyperplan_outlet::is_harmless;
use hyperplan_render::{Scene, TextStyle, svg, text_map};
use hyperplan_syntax::{Diagnostic, SourceMap, render};
use serde::Serialize;
use std::path::{Path, PathBuf};

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

/// A file to draw into, its kind known from its name.
#[derive(Clone)]
pub(crate) struct Picture {
    path: PathBuf,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Svg,
    Text,
}

impl Picture {
    /// Refuses names that do not end in a known way.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        let kind = match path.extension().and_then(|e| e.to_str()) {
            Some("svg") => Kind::Svg,
            Some("txt") => Kind::Text,
            _ => {
                let message =
                    format!("cannot draw into {}: only .svg and .txt are supported", path.display());
                return Err(Failure::input(message));
            }
        };
        Ok(Picture { path: path.to_owned(), kind })
    }

    /// The file for one of several objectives: its name goes before the extension.
    pub(crate) fn for_objective(&self, name: &str) -> Self {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let extension = self.path.extension().unwrap_or_default().to_string_lossy();
        Picture { path: self.path.with_file_name(format!("{stem}-{name}.{extension}")), kind: self.kind }
    }
}

/// Draws into a file.
pub(crate) fn write_picture(scene: Scene<'_>, picture: &Picture) -> Result<()> {
    let drawn = match picture.kind {
        Kind::Svg => svg(scene),
        Kind::Text => text_map(scene, TextStyle::default()),
    };
    write_bytes(&picture.path, drawn.map_err(Failure::input)?.as_bytes())
}
