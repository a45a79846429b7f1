//! Reading files: regular ones of a sensible size, or standard input. Writing them whole or not at all.

use crate::failure::{Failure, Result};
use hyperplan::disk::{limited, text};
pub(crate) use hyperplan::disk::{read_bytes, reason};
use std::io::{self, Write};
use std::path::Path;

/// The name of standard input.
pub(crate) const STDIN: &str = "-";

/// The text of a file; of standard input, where it is called `-`. A byte order mark is left out.
pub(crate) fn read_source(path: &Path) -> Result<String> {
    let cannot = |why: String| Failure::input(format_args!("cannot read {}: {why}", name(path)));
    let bytes = if is_stdin(path) { limited(io::stdin().lock()) } else { read_bytes(path) };
    text(bytes.map_err(|e| cannot(reason(&e)))?).map_err(cannot)
}

/// What a file is called in messages and answers.
pub(crate) fn name(path: &Path) -> String {
    if is_stdin(path) { "standard input".to_owned() } else { path.display().to_string() }
}

pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == STDIN
}

/// Writes a file so that it is there whole, or as it was before; what is no regular file, such as a device, is written
/// as it comes. How many bytes it has.
pub(crate) fn write(path: &Path, print: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<u64> {
    hyperplan_outlet::write(path, print).map_err(|e| cannot_write(path, &e))
}

/// As [`write()`], what is in memory.
pub(crate) fn write_bytes(path: &Path, contents: &[u8]) -> Result<()> {
    write(path, |to| to.write_all(contents)).map(|_| ())
}

/// The failure to write a file.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Failure {
    Failure::input(format_args!("cannot write {}: {}", name(path), reason(error)))
}

/// Where a file is, from the folder of another on; folders are separated by `/`.
pub(crate) fn relative(from: &Path, to: &Path) -> Result<String> {
    let cannot = |path: &Path, error: &io::Error| {
        Failure::input(format_args!("cannot read {}: {}", name(path), reason(error)))
    };
    let whole = |path: &Path| path.canonicalize().map_err(|error| cannot(path, &error));
    let (from, to) = (whole(from)?, whole(to)?);
    let folder: Vec<_> = from.parent().into_iter().flat_map(Path::components).collect();
    let file: Vec<_> = to.components().collect();
    let common = folder.iter().zip(&file).take_while(|(a, b)| a == b).count();
    let up = folder[common..].iter().map(|_| "..".to_owned());
    let down = file[common..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    Ok(up.chain(down).collect::<Vec<_>>().join("/"))
}

/// Refuses a file that could not be written after all the work.
pub(crate) fn check_writable(path: &Path) -> Result<()> {
    let cannot = |why: String| Failure::input(format_args!("cannot write {}: {why}", name(path)));
    match path.metadata() {
        Ok(data) if data.is_dir() => return Err(cannot("it is a directory".to_owned())),
        Ok(data) if !data.is_file() => return Ok(()),
        _ => {}
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        return Err(cannot(format!("there is no directory {}", folder.display())));
    }
    // It is gone when it is closed.
    tempfile::tempfile_in(folder).map(|_| ()).map_err(|e| cannot(reason(&e)))
}

/// The folder, made if it is not there.
pub(crate) fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| {
        Failure::input(format_args!("cannot make directory {}: {}", folder.display(), reason(&e)))
    })
}
