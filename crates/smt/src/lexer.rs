//! Tokens of SMT-LIB 2: the one place that knows where its words, strings, quoted symbols and comments begin and end.
//!
//! Nothing is refused here: what is no token is one of a kind of its own, for whoever reads to judge. Text that comes in
//! pieces is followed byte by byte ([`Context`]); [`tokens`] and [`parts`] take what is whole.

use std::ops::Range;

/// What a byte belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Context {
    /// Words, parentheses and blanks.
    #[default]
    Code,
    /// A comment, up to the end of the line.
    Comment,
    /// A symbol in quotes.
    Quoted,
    /// A string. A doubled quote inside of it makes two of one.
    Text,
}

impl Context {
    /// The context after one more byte.
    #[must_use]
    pub fn after(self, byte: u8) -> Context {
        match (self, byte) {
            (Context::Code, b';') => Context::Comment,
            (Context::Code, b'|') => Context::Quoted,
            (Context::Code, b'"') => Context::Text,
            (Context::Comment, b'\n') | (Context::Quoted, b'|') | (Context::Text, b'"') => Context::Code,
            (context, _) => context,
        }
    }
}

/// A token.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Token<'t> {
    /// An opening parenthesis.
    Open,
    /// A closing one.
    Close,
    /// A symbol without quotes, reserved words among them.
    Word(&'t str),
    /// A symbol in quotes, without these.
    Quoted(&'t str),
    /// A keyword, with its colon.
    Keyword(&'t str),
    /// Digits, perhaps with a point.
    Number(&'t str),
    /// The digits after `#x`.
    Hex(&'t str),
    /// The digits after `#b`.
    Binary(&'t str),
    /// A string.
    Text,
    /// What is no symbol and no constant.
    Strange(&'t str),
    /// The rest of the text, if what is in quotes has no end.
    Endless(Context),
}

/// The tokens of a text, each with its place.
#[must_use]
pub fn tokens(text: &str) -> Tokens<'_> {
    Tokens { text, at: 0 }
}

/// Splits a text into tokens.
#[derive(Clone, Debug)]
pub struct Tokens<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Tokens<'t> {
    /// The text of which these are the tokens.
    pub(crate) fn text(&self) -> &'t str {
        self.text
    }

    /// The end of what has begun at that place in a context that is not code: after the quote or line that ends it.
    fn end(&self, start: usize) -> Option<usize> {
        let mut context = Context::Code;
        let ended = |byte: &u8| {
            context = context.after(*byte);
            context == Context::Code
        };
        Some(start + self.text.as_bytes()[start..].iter().position(ended)? + 1)
    }

    /// Passes over blanks and comments; the first byte of what comes then.
    fn blanks(&mut self) -> Option<u8> {
        loop {
            match *self.text.as_bytes().get(self.at)? {
                b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
                b';' => self.at = self.end(self.at).unwrap_or(self.text.len()),
                byte => return Some(byte),
            }
        }
    }

    /// Something in quotes.
    fn quoted(&mut self, context: Context) -> Token<'t> {
        let start = self.at;
        while let Some(end) = self.end(self.at) {
            self.at = end;
            if context == Context::Quoted {
                return Token::Quoted(&self.text[start + 1..end - 1]);
            }
            if !self.text[end..].starts_with('"') {
                return Token::Text;
            }
        }
        self.at = self.text.len();
        Token::Endless(context)
    }

    fn word(&mut self) -> Token<'t> {
        let ends =
            |byte: &u8| matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b'(' | b')' | b';' | b'"' | b'|');
        let rest = &self.text[self.at..];
        let word = &rest[..rest.bytes().position(|byte| ends(&byte)).unwrap_or(rest.len())];
        self.at += word.len();
        kind(word)
    }
}

impl<'t> Iterator for Tokens<'t> {
    type Item = (Range<usize>, Token<'t>);

    fn next(&mut self) -> Option<Self::Item> {
        let first = self.blanks()?;
        let start = self.at;
        let token = match first {
            b'(' | b')' => {
                self.at += 1;
                if first == b'(' { Token::Open } else { Token::Close }
            }
            b'|' => self.quoted(Context::Quoted),
            b'"' => self.quoted(Context::Text),
            _ => self.word(),
        };
        Some((start..self.at, token))
    }
}

/// What a word is.
fn kind(text: &str) -> Token<'_> {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let token = match text.as_bytes()[0] {
        b'0'..=b'9' => {
            let number = text.split_once('.').map_or(digits(text), |(a, b)| digits(a) && digits(b));
            number.then_some(Token::Number(text))
        }
        b'#' => match text.split_at_checked(2) {
            Some(("#x", rest)) if !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_hexdigit()) => {
                Some(Token::Hex(rest))
            }
            Some(("#b", rest)) if !rest.is_empty() && rest.bytes().all(|b| matches!(b, b'0' | b'1')) => {
                Some(Token::Binary(rest))
            }
            _ => None,
        },
        b':' => Some(Token::Keyword(text)),
        _ => (!text.bytes().any(|byte| byte.is_ascii_control())).then_some(Token::Word(text)),
    };
    token.unwrap_or(Token::Strange(text))
}

/// What stands between the parentheses of a list, part by part; `None` if the list is not whole, or there is more than
/// one. What a part is made of does not matter here.
#[must_use]
pub fn parts(list: &str) -> Option<Vec<&str>> {
    let (mut parts, mut depth, mut start, mut ended) = (Vec::new(), 0_usize, 0, false);
    for (place, token) in tokens(list) {
        let before = depth;
        match token {
            _ if ended => return None,
            Token::Open => depth += 1,
            Token::Close => depth = depth.checked_sub(1)?,
            Token::Endless(_) => return None,
            _ => {}
        }
        match (before, depth) {
            (0, 1) => {}
            (0, _) => return None,
            (1, 2) => start = place.start,
            (1, 1) => parts.push(&list[place]),
            (2, 1) => parts.push(&list[start..place.end]),
            (1, 0) => ended = true,
            _ => {}
        }
    }
    ended.then_some(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_kinds() {
        let text = "(a.b;c\n|d e|\"f\"\"(\" :g 1 2.50 #xAf #b01)<=";
        let expected = [
            (0, Token::Open),
            (1, Token::Word("a.b")),
            (7, Token::Quoted("d e")),
            (12, Token::Text),
            (19, Token::Keyword(":g")),
            (22, Token::Number("1")),
            (24, Token::Number("2.50")),
            (29, Token::Hex("Af")),
            (34, Token::Binary("01")),
            (38, Token::Close),
            (39, Token::Word("<=")),
        ];
        let found: Vec<_> = tokens(text).map(|(place, token)| (place.start, token)).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn damage() {
        for (text, context) in [("(|a", Context::Quoted), ("\"", Context::Text), ("\"\"\" b", Context::Text)]
        {
            assert_eq!(tokens(text).last().map(|(_, token)| token), Some(Token::Endless(context)), "{text}");
        }
        for text in ["1a", "1.", "#", "#x", "#xg", "#b2", "#o7", "\u{1}", "#é"] {
            assert_eq!(tokens(text).collect::<Vec<_>>(), [(0..text.len(), Token::Strange(text))]);
        }
    }

    #[test]
    fn lists_are_taken_apart() {
        assert_eq!(parts("()"), Some(vec![]));
        assert_eq!(parts("(a (b c)\r\n|d )(|(e)f)"), Some(vec!["a", "(b c)", "|d )(|", "(e)", "f"]));
        assert_eq!(parts("(a(b)\"(\"\")\" |\u{e4} |)"), Some(vec!["a", "(b)", "\"(\"\")\"", "|\u{e4} |"]));
        for broken in ["", "a", "(", ")", "(a", "a)", "(a))", "((a)", "(a)(b)", "(a) b", "(|a)", "(\")"] {
            assert_eq!(parts(broken), None, "{broken}");
        }
    }
}
