//! Tokens of SMT-LIB 2.

use super::Trouble;

/// A token.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Token<'t> {
    Open,
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
}

/// Splits a text into tokens.
pub(super) struct Lexer<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Lexer<'t> {
    pub(super) fn new(text: &'t str) -> Self {
        Lexer { text, at: 0 }
    }

    /// The text of which these are the tokens.
    pub(super) fn text(&self) -> &'t str {
        self.text
    }

    /// The next token, with the place where it begins; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<(usize, Token<'t>)>, Trouble> {
        self.blanks();
        let start = self.at;
        let Some(&first) = self.text.as_bytes().get(start) else { return Ok(None) };
        let token = match first {
            b'(' => self.advance(1, Token::Open),
            b')' => self.advance(1, Token::Close),
            b'|' => Token::Quoted(self.quoted()?),
            b'"' => self.string()?,
            _ => word(self.word(), start)?,
        };
        Ok(Some((start, token)))
    }

    fn advance(&mut self, by: usize, token: Token<'t>) -> Token<'t> {
        self.at += by;
        token
    }

    /// Passes over blanks and comments.
    fn blanks(&mut self) {
        let bytes = self.text.as_bytes();
        while let Some(byte) = bytes.get(self.at) {
            match byte {
                b' ' | b'\t' | b'\r' | b'\n' => self.at += 1,
                b';' => {
                    let rest = bytes[self.at..].iter().position(|&byte| byte == b'\n');
                    self.at = rest.map_or(bytes.len(), |length| self.at + length);
                }
                _ => return,
            }
        }
    }

    fn quoted(&mut self) -> Result<&'t str, Trouble> {
        let start = self.at + 1;
        let Some(length) = self.text[start..].find('|') else {
            return Err(Trouble::syntax(self.at, "a quoted symbol has no end"));
        };
        self.at = start + length + 1;
        Ok(&self.text[start..start + length])
    }

    /// A string, in which a quote is doubled.
    fn string(&mut self) -> Result<Token<'t>, Trouble> {
        let start = self.at;
        loop {
            let Some(length) = self.text[self.at + 1..].find('"') else {
                return Err(Trouble::syntax(start, "a string has no end"));
            };
            self.at += length + 2;
            if !self.text[self.at..].starts_with('"') {
                return Ok(Token::Text);
            }
        }
    }

    fn word(&mut self) -> &'t str {
        let start = self.at;
        let ends =
            |byte: &u8| matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | b'(' | b')' | b';' | b'"' | b'|');
        let bytes = &self.text.as_bytes()[start..];
        self.at += bytes.iter().position(ends).unwrap_or(bytes.len());
        &self.text[start..self.at]
    }
}

/// What a word is.
fn word(text: &str, at: usize) -> Result<Token<'_>, Trouble> {
    let bytes = text.as_bytes();
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let token = match bytes[0] {
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
        _ => (!bytes.iter().any(u8::is_ascii_control)).then_some(Token::Word(text)),
    };
    token.ok_or_else(|| Trouble::syntax(at, format!("{} is no symbol and no constant", super::shown(text))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str) -> Result<Vec<(usize, Token<'_>)>, Trouble> {
        let mut lexer = Lexer::new(text);
        std::iter::from_fn(|| lexer.next().transpose()).collect()
    }

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
        assert_eq!(tokens(text), Ok(expected.to_vec()));
    }

    #[test]
    fn damage() {
        for text in ["|", "(|a", "\"", "\"\"\"", "1a", "1.", "#", "#x", "#xg", "#b2", "#o7", "\u{1}", "#é"] {
            assert!(tokens(text).is_err(), "{text}");
        }
    }
}
