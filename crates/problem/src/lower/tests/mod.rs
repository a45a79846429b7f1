mod changes;
mod costs;
mod display;
mod graphs;
mod grids;
mod interpreter;
mod meaning;
mod objectives;
mod roadmaps;
mod semantics;
mod systems;

use crate::{Lowered, Overrides, read};
use hyperplan_syntax::SourceMap;

/// A loader for a few files.
fn files(files: &[(&str, &str)]) -> impl Fn(&str) -> Result<Vec<u8>, String> {
    move |path| {
        let found = files.iter().find(|(name, _)| *name == path);
        found.map(|(_, text)| text.as_bytes().to_vec()).ok_or_else(|| "no such file".to_owned())
    }
}

fn lowered(text: &str) -> (Lowered, SourceMap) {
    lowered_with(text, &[], &Overrides::none())
}

fn lowered_with(text: &str, named: &[(&str, &str)], overrides: &Overrides) -> (Lowered, SourceMap) {
    let mut sources = SourceMap::new();
    let lowered = read(&mut sources, "test.hp", text, &files(named), overrides);
    (lowered, sources)
}

/// What a text means; it must have no errors and no warnings.
fn ok(text: &str) -> Lowered {
    ok_with(text, &[])
}

fn ok_with(text: &str, named: &[(&str, &str)]) -> Lowered {
    let (lowered, sources) = lowered_with(text, named, &Overrides::none());
    let messages = messages(&lowered, &sources);
    assert!(messages.is_empty(), "{messages:#?}\n{text}");
    lowered
}

/// Diagnostics as `line:column code: message`.
fn messages(lowered: &Lowered, sources: &SourceMap) -> Vec<String> {
    let message = |d: &hyperplan_syntax::Diagnostic| {
        let place = d.span.map_or(String::new(), |span| {
            let (line, column) = sources.position(span);
            format!("{}:{line}:{column} ", sources.get(span.source).name)
        });
        format!("{place}{}: {}", d.code, d.message)
    };
    lowered.diagnostics.iter().map(message).collect()
}

/// The codes of a text's diagnostics, with the texts they mark.
fn codes(text: &str) -> Vec<(&'static str, String)> {
    let (lowered, sources) = lowered(text);
    let marked = |d: &hyperplan_syntax::Diagnostic| {
        (d.code, d.span.map_or(String::new(), |span| sources.snippet(span).to_owned()))
    };
    lowered.diagnostics.iter().map(marked).collect()
}
