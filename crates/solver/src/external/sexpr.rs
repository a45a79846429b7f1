//! The parts of an s-expression.

/// What stands between the parentheses of a list, which has no comments; `None` if that is not whole, or no list.
/// What a part is made of does not matter here.
pub(super) fn parts(list: &str) -> Option<Vec<&str>> {
    let inner = list.strip_prefix('(')?.strip_suffix(')')?;
    let mut parts = Vec::new();
    let (mut depth, mut quote, mut start) = (0_usize, None, None);
    for (at, byte) in inner.bytes().enumerate() {
        match (quote, byte) {
            (Some(open), _) => {
                if byte == open {
                    quote = None;
                }
            }
            (None, b' ' | b'\t' | b'\r' | b'\n') if depth == 0 => {
                parts.extend(start.take().map(|start| &inner[start..at]));
            }
            (None, b')') => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    parts.extend(start.take().map(|start| &inner[start..=at]));
                }
            }
            (None, _) => {
                if byte == b'(' {
                    if depth == 0 {
                        parts.extend(start.take().map(|start| &inner[start..at]));
                    }
                    depth += 1;
                }
                quote = matches!(byte, b'"' | b'|').then_some(byte);
                start.get_or_insert(at);
            }
        }
    }
    parts.extend(start.map(|start| &inner[start..]));
    (depth == 0 && quote.is_none()).then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn lists_are_taken_apart() {
        assert_eq!(parts("()"), Some(vec![]));
        assert_eq!(parts("(a (b c)\r\n|d )(|(e)f)"), Some(vec!["a", "(b c)", "|d )(|", "(e)", "f"]));
        assert_eq!(parts("(a(b)\"(\" |\u{e4} |)"), Some(vec!["a", "(b)", "\"(\"", "|\u{e4} |"]));
        for broken in ["", "a", "(", ")", "(a", "a)", "(a))", "((a)", "(a)(b)", "(|a)", "(\")"] {
            assert_eq!(parts(broken), None, "{broken}");
        }
    }
}
