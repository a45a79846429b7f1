//! Pictures by the formats that they come in.

use super::picture::Picture;
use super::{pgm, png};

/// Whether the bytes begin like a picture, of a kind that can be read or not.
pub(crate) fn is_picture(bytes: &[u8]) -> bool {
    let netpbm = matches!(bytes, [b'P', b'1'..=b'7', blank, ..] if blank.is_ascii_whitespace());
    netpbm || [&b"\x89PNG"[..], b"\xff\xd8\xff", b"GIF8", b"BM"].iter().any(|magic| bytes.starts_with(magic))
}

/// Whether the bytes begin like a PNG picture.
pub(crate) fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG")
}

/// Reads a picture of at most so many pixels.
///
/// # Errors
/// Words about what is wrong with it, or that its format is not supported.
pub(crate) fn read(bytes: &[u8], most: usize) -> Result<Picture, String> {
    match bytes {
        [b'P', b'2' | b'5', ..] => pgm::read(bytes, most),
        [0x89, b'P', b'N', b'G', ..] => png::read(bytes, most),
        _ => Err("only PGM (P2, P5) and PNG pictures are supported".into()),
    }
}
