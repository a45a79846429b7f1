//! What is known of a formula: in comments such as `-- within 18: unrealizable`, or from who gives the files.

use crate::{Options, parser::Parse};
use hyperplan_syntax::{Diagnostic, SourceId, Span};

/// Whether a formula holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// It holds.
    Realizable,
    /// It is violated.
    Unrealizable,
}

impl Known {
    /// By our word, or that of verifiers.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Known> {
        match word {
            "realizable" | "holds" => Some(Known::Realizable),
            "unrealizable" | "violated" => Some(Known::Unrealizable),
            _ => None,
        }
    }

    /// Our word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Known::Realizable => "realizable",
            Known::Unrealizable => "unrealizable",
        }
    }

    /// What the comments of a formula and the options say of it, read in this way.
    pub(crate) fn of(source: SourceId, text: &str, options: &Options) -> Parse<Option<Known>> {
        let mut known = options.status;
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let span = Span::new(source, start..start + line.trim_end().len());
            start += line.len();
            let Some(said) = of_line(line, options) else { continue };
            if known.is_some_and(|before| before != said) {
                let message = format!("it is {} here, and {} elsewhere", said.word(), opposite(said).word());
                return Err(Box::new(Diagnostic::error("contradictory-status", span, message)));
            }
            known = Some(said);
        }
        Ok(known)
    }
}

fn opposite(known: Known) -> Known {
    match known {
        Known::Realizable => Known::Unrealizable,
        Known::Unrealizable => Known::Realizable,
    }
}

/// `-- within K [semantics S]: WORD`, if it is about this bound and these semantics.
fn of_line(line: &str, options: &Options) -> Option<Known> {
    let line = line.trim();
    let comment = line.strip_prefix("--").or_else(|| line.strip_prefix("//"))?;
    let (question, answer) = comment.split_once(':')?;
    let words: Vec<&str> = question.split_whitespace().collect();
    let (bound, semantics) = match words[..] {
        ["within", bound] => (bound, None),
        ["within", bound, "semantics", semantics] => (bound, Some(semantics)),
        _ => return None,
    };
    let same = bound.parse().ok() == options.bound && semantics == options.semantics.as_deref();
    Known::of_word(answer.trim()).filter(|_| same && options.bound.is_some())
}
