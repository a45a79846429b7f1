//! What the formatter owes to every text without errors.

use hyperplan_syntax::ast::File;
use hyperplan_syntax::{SourceId, parse, print};

/// A tree, or what was made of one, without places.
pub fn without_places(tree: &impl std::fmt::Debug) -> String {
    let shown = format!("{tree:?}");
    let mut parts = shown.split("Span {");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |tree, part| tree + part.split_once('}').map_or("", |(_, rest)| rest))
}

fn comments(text: &str) -> Vec<&str> {
    // A carriage return ends a line too.
    text.split(['\n', '\r']).filter_map(comment).collect()
}

/// The comment of a line: it begins with the first `//` that is in no string.
fn comment(line: &str) -> Option<&str> {
    let mut rest = line;
    let mut in_string = false;
    while let Some(c) = rest.chars().next() {
        let length = match c {
            '\\' if in_string => 1 + rest[1..].chars().next().map_or(0, char::len_utf8),
            // A quoted letter may be a quote itself; a word's prime is followed by no other.
            '\'' if !in_string && rest.starts_with("'\"'") => 3,
            '/' if !in_string && rest.starts_with("//") => return Some(rest.trim_end()),
            _ => c.len_utf8(),
        };
        in_string ^= c == '"';
        rest = &rest[length..];
    }
    None
}

/// Formats what `text` was parsed to; the tree and the comments are the same afterwards, and formatting again changes
/// nothing.
pub fn formatted(file: &File, text: &str) -> String {
    let printed = print(file, text);
    let (again, errors) = parse(SourceId(0), &printed);
    assert!(errors.is_empty(), "{text}\n{printed}\n{errors:#?}");
    assert!(without_places(&again) == without_places(file), "another tree:\n{text}\n{printed}");
    assert_eq!(comments(&printed), comments(text), "{text}\n{printed}");
    assert_eq!(print(&again, &printed), printed, "not stable:\n{text}");
    printed
}
