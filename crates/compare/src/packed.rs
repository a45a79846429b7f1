//! Files that may be compressed: those whose names end in `.gz`.

use std::borrow::Cow;
use std::io::{self, Read as _};
use std::path::Path;

use flate2::read::MultiGzDecoder;

/// No file stands for more: a small one could stand for anything.
const LONGEST: u64 = 1 << 30;

/// How a name ends, but for the `.gz` of what is compressed, in small letters: that says what the file is.
pub(crate) fn ending(path: &Path) -> String {
    let ending =
        |path: &Path| path.extension().and_then(|ending| ending.to_str()).map(str::to_ascii_lowercase);
    match ending(path).as_deref() {
        Some("gz") => path.file_stem().and_then(|stem| ending(Path::new(stem))).unwrap_or_default(),
        other => other.unwrap_or_default().to_owned(),
    }
}

/// What a file stands for.
///
/// # Errors
/// When it is damaged, or stands for too much.
pub(crate) fn unpacked<'a>(path: &Path, bytes: &'a [u8]) -> io::Result<Cow<'a, [u8]>> {
    if path.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("gz")) {
        return Ok(Cow::Borrowed(bytes));
    }
    let mut plain = Vec::new();
    MultiGzDecoder::new(bytes).take(LONGEST + 1).read_to_end(&mut plain)?;
    if plain.len() as u64 > LONGEST {
        return Err(io::Error::other("it stands for more than 1 GiB"));
    }
    Ok(Cow::Owned(plain))
}
