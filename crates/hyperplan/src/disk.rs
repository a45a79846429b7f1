//! Reading regular files of a sensible size, and the files that a problem names.

use hyperplan_problem::Loader;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// The most bytes of a file that are read: far more than any map or strategy has.
const FILE_LIMIT: u64 = 1 << 30;

/// The bytes of a regular file. What has no end, or waits for somebody to write, is none.
///
/// # Errors
/// When there is no such file, or none that is read.
pub fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    let data = std::fs::metadata(path)?;
    if data.is_dir() {
        return Err(io::Error::other("it is a directory"));
    }
    if !data.is_file() {
        return Err(io::Error::other("it is no regular file, but a device, a pipe or a socket"));
    }
    if data.len() > FILE_LIMIT {
        return Err(too_long());
    }
    limited(File::open(path)?)
}

/// What there is to read, if it is not too long.
///
/// # Errors
/// Those of reading, and when it is too long.
pub fn limited(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(FILE_LIMIT + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > FILE_LIMIT { Err(too_long()) } else { Ok(bytes) }
}

fn too_long() -> io::Error {
    io::Error::other(format!("it has more than {FILE_LIMIT} bytes"))
}

/// Why a file cannot be read, in words without the system's error number.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::StorageFull => "the disk is full".to_owned(),
        _ => error.to_string(),
    }
}

/// The text that bytes are, without a byte order mark.
///
/// # Errors
/// In words, why they are none.
pub fn text(bytes: Vec<u8>) -> Result<String, String> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        if good.contains(&0) {
            return "it is not a text file".to_owned();
        }
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        format!("it is not in UTF-8; the first byte that cannot be read is on line {line}")
    })?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// Files named in a problem file are beside it.
#[derive(Clone, Debug)]
pub struct Beside(pub PathBuf);

impl Loader for Beside {
    fn load(&self, path: &str) -> Result<Vec<u8>, String> {
        read_bytes(&self.0.join(path)).map_err(|e| reason(&e))
    }
}
