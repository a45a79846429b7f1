//! PGM pictures, plain (`P2`) and raw (`P5`), read whole: what is left over or missing shifts pixels, or was never
//! meant to be one, so it is refused. Libraries for the format leave it alone.

use super::picture::{Picture, Pixels};

/// Reads a picture of at most so many pixels; the first two bytes have said that it is one.
pub(super) fn read(bytes: &[u8], most: usize) -> Result<Picture, String> {
    let raw = bytes.starts_with(b"P5");
    let mut reader = Reader { rest: &bytes[2..] };
    let (width, height) = (reader.number()?, reader.number()?);
    let white = u16::try_from(reader.number()?).map_err(|_| "the greatest shade is above 65535")?;
    let pixels = (width as usize).saturating_mul(height as usize);
    if pixels == 0 || white == 0 {
        return Err("the picture is empty".into());
    }
    if pixels > most {
        return Err(format!("the picture has more than {most} pixels"));
    }
    let shades = if raw { reader.raw(pixels, white)? } else { reader.plain(pixels)? };
    reader.end(raw)?;
    if shades.iter().any(|shade| *shade > white) {
        return Err(format!("a shade is above the greatest one, {white}"));
    }
    Ok(Picture { width, height, pixels: Pixels::Gray(shades, white) })
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl Reader<'_> {
    /// Passes white space and comments.
    fn blanks(&mut self) {
        loop {
            match self.rest.first() {
                Some(b'#') => {
                    let end = self.rest.iter().position(|b| *b == b'\n').unwrap_or(self.rest.len());
                    self.rest = &self.rest[end..];
                }
                Some(b) if b.is_ascii_whitespace() => self.rest = &self.rest[1..],
                _ => return,
            }
        }
    }

    /// The next number, after white space and comments.
    fn number(&mut self) -> Result<u32, String> {
        self.blanks();
        let end = self.rest.iter().position(|b| !b.is_ascii_digit()).unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(end);
        self.rest = rest;
        let number = str::from_utf8(digits).ok().and_then(|digits| digits.parse().ok());
        number.ok_or_else(|| "the picture is cut short or damaged".into())
    }

    fn plain(&mut self, pixels: usize) -> Result<Vec<u16>, String> {
        let shade = |n| u16::try_from(n).map_err(|_| "a shade is above 65535".to_owned());
        (0..pixels).map(|_| self.number().and_then(shade)).collect()
    }

    /// One byte a pixel, or two, the higher first, where white is above 255.
    fn raw(&mut self, pixels: usize, white: u16) -> Result<Vec<u16>, String> {
        let width = if white > 255 { 2 } else { 1 };
        let length = pixels * width;
        // A single white space ends the header. Two, as on systems that end lines so, can only be meant where the
        // rest has one byte too many for the pixels.
        let blank = match self.rest {
            [b'\r', b'\n', rest @ ..] if rest.len() == length => 2,
            [first, ..] if first.is_ascii_whitespace() => 1,
            _ => return Err("after the greatest shade comes white space, and then the pixels".into()),
        };
        let data = self.rest.get(blank..).unwrap_or_default();
        let (data, rest) = data.split_at_checked(length).ok_or_else(|| {
            format!("the picture is cut short: {length} bytes of pixels are due, {} are there", data.len())
        })?;
        self.rest = rest;
        Ok(data.chunks(width).map(|b| b.iter().fold(0, |shade, b| (shade << 8) | u16::from(*b))).collect())
    }

    /// Nothing but white space may be left, in a raw picture not even that.
    fn end(&mut self, raw: bool) -> Result<(), String> {
        if !raw {
            self.blanks();
        }
        match self.rest.len() {
            0 => Ok(()),
            left => Err(format!(
                "{left} bytes are left over after the last pixel, so that it is not clear which bytes are pixels; the \
                 header must end with the greatest shade and a single white space, without a comment"
            )),
        }
    }
}
