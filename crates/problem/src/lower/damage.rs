//! Files that could be parsed only in part: which mistakes are mistakes whatever the rest says.

use hyperplan_syntax::ast::{File, Item, SystemItem};
use hyperplan_syntax::{Diagnostic, SourceMap, Span};
use rustc_hash::FxHashSet;

/// The errors that do not come from what is missing. A name that stands somewhere in what could not be parsed may have
/// been declared there; warnings, and what depends on a declaration being complete, say nothing here.
pub(super) fn independent(found: Vec<Diagnostic>, file: &File, sources: &SourceMap) -> Vec<Diagnostic> {
    let missing: FxHashSet<&str> =
        file.skipped.iter().flat_map(|span| words(sources.snippet(*span))).collect();
    let about_missing = |span: Span| words(sources.snippet(span)).any(|word| missing.contains(word));
    let suspect = |diagnostic: &Diagnostic| match diagnostic.code {
        // The tokens in the way of a system, or of a part of it, may be the answer.
        "no-system" | "which-system" => missing.contains("system"),
        "nothing-observed" => missing.contains("observe"),
        "empty-file" => true,
        _ => diagnostic.span.is_some_and(about_missing),
    };
    let declared = |name: &str| file.items.iter().any(|item| declares(item, name));
    found
        .into_iter()
        .filter(|diagnostic| diagnostic.is_error())
        .filter(|diagnostic| {
            // A name that is declared soundly is not missing, wherever else it stands.
            let known = diagnostic.span.is_some_and(|span| declared(sources.snippet(span)));
            known && diagnostic.code == "duplicate-name" || !suspect(diagnostic)
        })
        .collect()
}

/// Whether the item declares the name, itself or inside.
fn declares(item: &Item, name: &str) -> bool {
    match item {
        Item::Const(constant) => constant.name.name == name,
        Item::Template(template) => template.name.name == name,
        Item::Define(define) => define.name.name == name,
        Item::Objective(objective) => objective.name.name == name,
        Item::System(system) => {
            system.name.name == name
                || system.items.iter().any(|item| match item {
                    SystemItem::Label(label, _) => label.name == name,
                    SystemItem::State(variables) => {
                        variables.iter().any(|variable| variable.name.name == name)
                    }
                    SystemItem::Action(actions) => actions.iter().any(|action| action.name == name),
                    _ => false,
                })
        }
    }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}
