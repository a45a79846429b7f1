//! Problem files.

use super::text::roundtrip::{formatted, without_places};
use super::text::tree;
use hyperplan_problem::{Lowered, Overrides, display, read};
use hyperplan_random::Random;
use hyperplan_syntax::{Diagnostic, SourceId, SourceMap, parse, print, render, to_json};

/// What is in a file that a problem names.
pub(super) type Files<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;

/// Reads a problem; what has no errors is formatted, and means the same afterwards.
pub(super) fn body(data: &[u8]) {
    if let Ok(text) = str::from_utf8(data) {
        formatted_alike(text, &file);
    }
}

/// What a text means, which is the same once it is formatted.
pub(super) fn formatted_alike(text: &str, file: Files<'_>) -> (Lowered, SourceMap) {
    let (lowered, sources) = understood(text, file);
    let (tree, errors) = parse(SourceId(0), text);
    if errors.iter().any(Diagnostic::is_error) {
        assert!(lowered.has_errors(), "errors are lost: {errors:#?}");
        return (lowered, sources);
    }
    let again = self::lowered(&formatted(&tree, text), file);
    let words = |lowered: &Lowered| {
        let all = lowered.diagnostics.iter().map(|d| (d.severity, d.code, d.message.clone()));
        all.collect::<Vec<_>>()
    };
    assert_eq!(words(&again), words(&lowered), "formatted, it has other faults");
    assert!(
        without_places(&again.problem) == without_places(&lowered.problem),
        "formatted, it means another"
    );
    (lowered, sources)
}

/// A text that the parser accepts, though it means little.
pub(super) fn random(random: &mut Random) -> Vec<u8> {
    print(&tree::file(random), "").into_bytes()
}

/// What a problem text means. `files` has what it names.
pub(super) fn lowered(text: &str, files: Files<'_>) -> Lowered {
    understood(text, files).0
}

/// What a problem text means, with all sources of its messages, which are right about places.
fn understood(text: &str, files: Files<'_>) -> (Lowered, SourceMap) {
    let mut sources = SourceMap::new();
    let lowered = read(&mut sources, "fuzz.hp", text, &files, &Overrides::default());
    let all: Vec<Diagnostic> = lowered.diagnostics.iter().chain(&lowered.unused).cloned().collect();
    shown(&sources, &all);
    if !lowered.has_errors() {
        for objective in &lowered.problem.objectives {
            assert!(!display::objective(&lowered.problem, objective).is_empty());
        }
    }
    (lowered, sources)
}

/// Messages have places inside the text, and can be shown.
pub(super) fn shown(sources: &SourceMap, messages: &[Diagnostic]) {
    for diagnostic in messages {
        let related = diagnostic.related.iter().map(|(span, _)| span);
        for span in diagnostic.span.iter().chain(related) {
            let source = sources.get(span.source);
            assert!(source.text.get(span.range()).is_some(), "a place outside of its text: {diagnostic:?}");
        }
        let json = to_json(sources, "fuzz.hp", diagnostic);
        assert_eq!(json.message, diagnostic.message);
    }
    for (color, width) in [(false, 100), (true, 20)] {
        let shown = render(sources, messages, color, width);
        assert_eq!(shown.is_empty(), messages.is_empty());
    }
}

/// The files that problems name: what is in one depends on how its name ends.
fn file(path: &str) -> Result<Vec<u8>, String> {
    let ending = path.rsplit('.').next().unwrap_or_default();
    let bytes: &[u8] = match ending {
        "json" => include_bytes!("../../corpus/graph/roadmap"),
        "map" => include_bytes!("../../corpus/map/benchmark"),
        "yaml" => include_bytes!("../../corpus/ros/room"),
        "pgm" => include_bytes!("../../corpus/pgm/raw"),
        "png" => include_bytes!("../../corpus/png/garden"),
        "scen" => include_bytes!("../../corpus/scen/two"),
        "txt" => include_bytes!("../../corpus/map/small"),
        _ => return Err("there is no such file".into()),
    };
    Ok(bytes.to_vec())
}
