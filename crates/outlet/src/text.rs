//! Text that comes from elsewhere, such as names of files, in lines of ours.

use std::borrow::Cow;

/// What would break a line, or do something to a terminal, as an escape: a name with a line break reads `a\nb`.
#[must_use]
pub fn one_line(text: &str) -> Cow<'_, str> {
    if text.chars().all(is_harmless) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if is_harmless(c) {
            line.push(c);
        } else {
            line.extend(c.escape_default());
        }
    }
    Cow::Owned(line)
}

/// Whether a character does nothing but be seen: it is no control character, none of the two line breaks of Unicode
/// that are none, and does not turn the direction of text around.
#[must_use]
pub fn is_harmless(c: char) -> bool {
    let turns = matches!(
        c,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    !(c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}'))
}

/// The blanks that a text lacks to so many characters. The widths of `format!` end at 65,535, and names do not.
#[must_use]
pub fn blanks(text: &str, width: usize) -> String {
    " ".repeat(width.saturating_sub(text.chars().count()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_breaks_lines_is_escaped() {
        assert_eq!(one_line("a b/é-Ω_\\n"), "a b/é-Ω_\\n");
        assert_eq!(one_line("a\nb\r\t\u{1b}[31m\u{2028}\u{202e}"), r"a\nb\r\t\u{1b}[31m\u{2028}\u{202e}");
    }

    /// Of all characters, those that a terminal or a reader takes for something else than a sign.
    #[test]
    fn no_character_does_harm() {
        let ranges = ['\0'..='\u{1f}', '\u{7f}'..='\u{9f}', '\u{61c}'..='\u{61c}', '\u{200e}'..='\u{200f}'];
        let more = ['\u{2028}'..='\u{202e}', '\u{2066}'..='\u{2069}'];
        let harmful = |c: char| ranges.iter().chain(&more).any(|range| range.contains(&c));
        for c in '\0'..=char::MAX {
            let text = c.to_string();
            let shown = one_line(&text);
            assert_eq!(shown != text, harmful(c), "U+{:04X}", u32::from(c));
            assert!(shown.chars().all(is_harmless), "U+{:04X}", u32::from(c));
        }
    }

    #[test]
    fn any_width_is_reached() {
        assert_eq!((blanks("é", 3), blanks("abc", 2)), ("  ".to_owned(), String::new()));
        assert_eq!(blanks("", 1 << 17).len(), 1 << 17);
    }
}
