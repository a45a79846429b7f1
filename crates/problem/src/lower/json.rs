//! JSON texts whose parts know where they stand.

use hyperplan_syntax::{Diagnostic, SourceId, Span};
use serde::de::{Deserializer as _, Error, MapAccess, Visitor};
use serde_json::value::RawValue;
use std::fmt;

/// A value of a JSON text, not taken apart yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece<'t> {
    source: SourceId,
    whole: &'t str,
    raw: &'t str,
}

/// What a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Object,
    Array,
    Text,
    Number,
    Other,
}

impl<'t> Piece<'t> {
    /// The value that a text holds, or the message about what is no JSON in it.
    pub(super) fn parse(source: SourceId, text: &'t str) -> Result<Piece<'t>, Box<Diagnostic>> {
        match serde_json::from_str::<&RawValue>(text) {
            Ok(raw) => Ok(Piece { source, whole: text, raw: raw.get() }),
            Err(error) => Err(Box::new(syntax(source, text, &error))),
        }
    }

    /// Its place.
    pub(super) fn span(self) -> Span {
        // A piece borrows from the whole, so its address says where it begins.
        let start = self.raw.as_ptr().addr() - self.whole.as_ptr().addr();
        Span::new(self.source, start..start + self.raw.len())
    }

    /// The place of its first character: where a large value stands.
    pub(super) fn start(self) -> Span {
        let span = self.span();
        Span { end: span.end.min(span.start + 1), ..span }
    }

    pub(super) fn kind(self) -> Kind {
        match self.raw.bytes().next() {
            Some(b'{') => Kind::Object,
            Some(b'[') => Kind::Array,
            Some(b'"') => Kind::Text,
            Some(b'-' | b'0'..=b'9') => Kind::Number,
            _ => Kind::Other,
        }
    }

    /// How messages call what it is.
    pub(super) fn describe(self) -> &'static str {
        match self.kind() {
            Kind::Object => "an object",
            Kind::Array => "a list",
            Kind::Text => "a string",
            Kind::Number => "a number",
            Kind::Other => "`true`, `false` or `null`",
        }
    }

    fn part(self, raw: &'t RawValue) -> Piece<'t> {
        Piece { raw: raw.get(), ..self }
    }

    /// The members of an array.
    pub(super) fn array(self) -> Option<Vec<Piece<'t>>> {
        let members = serde_json::from_str::<Vec<&RawValue>>(self.raw).ok()?;
        Some(members.into_iter().map(|raw| self.part(raw)).collect())
    }

    /// The names and values of an object, in order, repeated names too.
    pub(super) fn object(self) -> Option<Vec<(Piece<'t>, Piece<'t>)>> {
        let members = serde_json::Deserializer::from_str(self.raw).deserialize_map(Members).ok()?;
        Some(members.into_iter().map(|(name, value)| (self.part(name), self.part(value))).collect())
    }

    /// The text of a string.
    pub(super) fn text(self) -> Option<String> {
        serde_json::from_str(self.raw).ok()
    }

    /// An integer of any size, as it is written.
    pub(super) fn digits(self) -> Option<&'t str> {
        let unsigned = self.raw.strip_prefix('-').unwrap_or(self.raw);
        (!unsigned.is_empty() && unsigned.bytes().all(|b| b.is_ascii_digit())).then_some(self.raw)
    }

    /// The text of the value.
    pub(super) fn raw(self) -> &'t str {
        self.raw
    }
}

struct Members;

impl<'de> Visitor<'de> for Members {
    type Value = Vec<(&'de RawValue, &'de RawValue)>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members = Vec::new();
        while let Some(member) = map.next_entry().map_err(A::Error::custom)? {
            members.push(member);
        }
        Ok(members)
    }
}

/// The message about a text that is no JSON.
fn syntax(source: SourceId, text: &str, error: &serde_json::Error) -> Diagnostic {
    let line_start = match error.line().checked_sub(2) {
        None => 0,
        Some(nth) => text.match_indices('\n').nth(nth).map_or(text.len(), |(at, _)| at + 1),
    };
    // Columns count bytes, the first is 1; 0 stands for the line end before.
    let at = (line_start + error.column()).saturating_sub(1).min(text.trim_end().len());
    let at = text.floor_char_boundary(at);
    let length = text[at..].chars().next().map_or(0, char::len_utf8);
    let message = error.to_string();
    let words = message.split(" at line ").next().unwrap_or_default();
    let words = words.replace("EOF while parsing", "the text ends within");
    let message = format!("this is not JSON: {words}");
    Diagnostic::error("bad-json", Span::new(source, at..at + length), message)
}
