//! Text that comes from elsewhere, such as names of files, in lines of ours.

use std::borrow::Cow;

/// What would break a line, or do something to a terminal, as an escape: a name with a line break reads `a\nb`.
#[must_use]
pub fn one_line(text: &str) -> Cow<'_, str> {
    if !text.contains(breaks) {
        return Cow::Borrowed(text);
    }
    let mut line = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if breaks(c) {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    Cow::Owned(line)
}

/// Control characters, the two line breaks of Unicode that are none, and what turns the direction of text around.
fn breaks(c: char) -> bool {
    c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::one_line;

    #[test]
    fn what_breaks_lines_is_escaped() {
        assert_eq!(one_line("a b/é-Ω_\\n"), "a b/é-Ω_\\n");
        assert_eq!(one_line("a\nb\r\t\u{1b}[31m\u{2028}\u{202e}"), r"a\nb\r\t\u{1b}[31m\u{2028}\u{202e}");
    }
}
