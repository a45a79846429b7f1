//! Gray pictures: PGM, plain (`P2`) and raw (`P5`).

/// A gray picture; row 0 is the top one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// The shade of white.
    pub(crate) white: u16,
    shades: Vec<u16>,
}

impl Picture {
    /// The shade of a pixel inside the picture.
    pub(crate) fn at(&self, x: u32, row: u32) -> u16 {
        self.shades[row as usize * self.width as usize + x as usize]
    }
}

/// Reads a picture of at most so many pixels.
pub(crate) fn read(bytes: &[u8], most: usize) -> Result<Picture, String> {
    let raw = match bytes.get(..2) {
        Some(b"P5") => true,
        Some(b"P2") => false,
        _ => return Err("only PGM pictures (P2, P5) are supported".into()),
    };
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
    if shades.iter().any(|shade| *shade > white) {
        return Err(format!("a shade is above the greatest one, {white}"));
    }
    Ok(Picture { width, height, white, shades })
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl Reader<'_> {
    /// The next number, after white space and comments.
    fn number(&mut self) -> Result<u32, String> {
        loop {
            match self.rest.first() {
                Some(b'#') => {
                    let end = self.rest.iter().position(|b| *b == b'\n').unwrap_or(self.rest.len());
                    self.rest = &self.rest[end..];
                }
                Some(b) if b.is_ascii_whitespace() => self.rest = &self.rest[1..],
                _ => break,
            }
        }
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
        let bytes = if white > 255 { 2 } else { 1 };
        // A single white space ends the header.
        let data = self.rest.get(1..=pixels * bytes).ok_or("the picture is cut short")?;
        Ok(data.chunks(bytes).map(|b| b.iter().fold(0, |shade, b| (shade << 8) | u16::from(*b))).collect())
    }
}
