//! The templates that every problem file can use, written in the language itself.

use hyperplan_syntax::ast::{File, Item, Template};
use hyperplan_syntax::{SourceMap, parse as parse_text};

/// The text of the prelude.
pub const TEXT: &str = include_str!("prelude.hp");

/// How messages call the prelude's text.
pub const NAME: &str = "<prelude>";

/// The prelude's syntax tree; its text is added to `sources`.
pub fn parse(sources: &mut SourceMap) -> File {
    let source = sources.add(NAME, TEXT);
    // The text is our own, and a test says that it is free of errors.
    parse_text(source, TEXT).0
}

/// The templates of the prelude, in its order.
#[must_use]
pub fn templates() -> Vec<Template> {
    let file = parse(&mut SourceMap::new());
    let template = |item| if let Item::Template(template) = item { Some(template) } else { None };
    file.items.into_iter().filter_map(template).collect()
}
