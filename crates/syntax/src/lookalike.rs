//! Characters that look like signs of this language.

use crate::operator::TABLE;

/// The sign of this language that looks like a character, if there is one.
pub(crate) fn looks_like(c: char) -> Option<&'static str> {
    if let Some(row) = TABLE.iter().find(|row| row.lookalikes.contains(c)) {
        return Some(row.name);
    }
    Some(match c {
        '“' | '”' | '„' | '＂' => "\"",
        '‘' | '’' | '′' | '＇' | '´' | '`' => "'",
        '…' | '‥' => "..",
        '；' | '\u{37e}' => ";",
        '：' | '∶' => ":",
        '，' | '‚' => ",",
        '（' => "(",
        '）' => ")",
        '［' => "[",
        '］' => "]",
        '｛' => "{",
        '｝' => "}",
        '＝' => "=",
        '⊤' => "true",
        '⊥' => "false",
        _ => return None,
    })
}
