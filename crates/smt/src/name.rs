//! How symbols are called in SMT-LIB. The only place that quotes.
//!
//! A symbol is its stem, followed by `@time` where it has one. The mapping is injective and keeps
//! clear of what SMT-LIB and this writer use themselves:
//! - `@` in a stem is doubled; `|`, `\`, `!` and what is no sign, such as control characters, are written as `!` escapes;
//! - a first `$` (our names for shared terms) or `?` (bound variables) is doubled, and a `.`, which
//!   SMT-LIB reserves as a first character, gets a `!` before it;
//! - a stem without a time that could be an SMT-LIB word gets a final `@`.

use hyperplan_outlet::is_harmless;
use std::fmt::Write as _;
use std::io;

/// A stem as it is written, without time and quotes.
pub(crate) struct Mangled {
    /// With the `@` that a time follows, or that marks a word.
    text: Box<str>,
    /// Whether some character needs the symbol to be quoted.
    quoted: bool,
    /// Whether it needs a mark where it has no time.
    word: bool,
}

impl Mangled {
    pub(crate) fn new(stem: &str) -> Mangled {
        let mut text = String::with_capacity(stem.len() + 2);
        match stem.chars().next() {
            Some(first @ ('$' | '?')) => text.push(first),
            Some('.') => text.push('!'),
            _ => {}
        }
        for c in stem.chars() {
            match c {
                '@' => text.push_str("@@"),
                '!' => text.push_str("!!"),
                '|' => text.push_str("!p"),
                '\\' => text.push_str("!b"),
                c if !is_harmless(c) => {
                    // Writing to a string cannot fail.
                    let _ = write!(text, "!u{:x};", u32::from(c));
                }
                c => text.push(c),
            }
        }
        let (quoted, word) = (!is_simple(&text) || text.starts_with('@'), is_word(&text));
        text.push('@');
        Mangled { text: text.into(), quoted, word }
    }

    /// The name that is written exactly so, where there is no time: of a text that was read.
    pub(crate) fn verbatim(name: &str) -> Mangled {
        let quoted = !is_simple(name) || name.starts_with(['@', '.']) || is_reserved(name);
        Mangled { text: format!("{name}@").into(), quoted, word: false }
    }

    /// Writes it as a name that has no time: of a sort or a constructor.
    pub(crate) fn write(&self, w: &mut impl io::Write) -> io::Result<()> {
        self.write_at(w, false, None)
    }

    /// Writes the name of a symbol, or of a bound variable, at a time perhaps.
    #[inline]
    pub(crate) fn write_at(
        &self,
        w: &mut impl io::Write,
        is_bound: bool,
        time: Option<u32>,
    ) -> io::Result<()> {
        if self.quoted {
            w.write_all(b"|")?;
        }
        if is_bound {
            w.write_all(b"?")?;
        }
        match time {
            Some(time) => {
                w.write_all(self.text.as_bytes())?;
                write_number(w, time.into())?;
            }
            None => w.write_all(self.timeless().as_bytes())?,
        }
        if self.quoted {
            w.write_all(b"|")?;
        }
        Ok(())
    }

    /// The text where there is no time.
    fn timeless(&self) -> &str {
        if self.word { &self.text } else { &self.text[..self.text.len() - 1] }
    }

    /// Whether the text is the name as [`Mangled::write`] has it, with or without quotes.
    pub(crate) fn is_written(&self, text: &str) -> bool {
        text.strip_prefix('|').and_then(|text| text.strip_suffix('|')).unwrap_or(text) == self.timeless()
    }
}

/// Whether a word is no symbol without quotes.
pub(crate) fn is_reserved(word: &str) -> bool {
    matches!(word, "!" | "_" | "as" | "exists" | "forall" | "let" | "match" | "par")
}

/// Whether it is a symbol without quotes.
fn is_simple(text: &str) -> bool {
    let simple = |c: char| c.is_ascii_alphanumeric() || "~!@$%^&*_-+=<>.?/".contains(c);
    !text.is_empty() && text.chars().all(simple) && !text.starts_with(|c: char| c.is_ascii_digit())
}

/// Whether SMT-LIB or a solver may have a meaning for the word.
fn is_word(text: &str) -> bool {
    const WORDS: &str = "\
        true false not and or xor ite distinct let forall exists par as match div mod abs divisible to_real \
        to_int is_int concat extract select store const is lambda choice root pi iff implies if nat success \
        error unsupported unknown sat unsat logic theory continued-execution immediate-exit incomplete \
        memout BINARY DECIMAL HEXADECIMAL NUMERAL STRING";
    const PREFIXES: &str = "\
        bv ext_ rotate_ repeat zero_ sign_ int2 nat2 int. real. str. re. seq. set. bag. rel. fp to_ from_ \
        ubv_ sbv_ get- set- tuple";
    WORDS.split(' ').any(|word| word == text)
        || !text.bytes().any(|b| b.is_ascii_alphanumeric())
        || PREFIXES.split(' ').any(|prefix| text.starts_with(prefix))
}

/// A decimal number, without the formatting machinery: the writer writes millions of them.
#[inline]
pub(crate) fn write_number(w: &mut impl io::Write, mut number: u64) -> io::Result<()> {
    if number < 10 {
        return w.write_all(&[b'0' + number as u8]);
    }
    let mut digits = [0; 20];
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            break;
        }
    }
    w.write_all(&digits[at..])
}
