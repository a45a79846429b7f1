//! Which files of projects the user trusts. What is trusted is a file as it was when that was said: a later one, from
//! somebody else perhaps, is another.

use crate::failure::{Failure, Result};
use crate::files::{cannot_write, name, read_source, write_bytes};
use crate::report::json;
use hyperplan_compare::plan::sha256;
use serde::{Deserialize, Serialize};
use std::env;
use std::path::{Path, PathBuf};

/// The list, beside the user's own configuration.
const LIST: &str = "trusted";

/// The folder of the user's own files, which need not be there.
pub(crate) fn users_folder() -> Option<PathBuf> {
    let absolute = |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = absolute("XDG_CONFIG_HOME").or_else(|| Some(absolute("HOME")?.join(".config")))?;
    Some(folder.join("hyperplan"))
}

/// A line of the list.
#[derive(Serialize, Deserialize, PartialEq, Eq)]
struct Entry {
    file: PathBuf,
    sha256: String,
}

/// Whether the user trusts a file with that text.
pub(crate) fn is_trusted(file: &Path, text: &str) -> bool {
    // Where anything is wrong with the list, nothing is trusted.
    let Some(list) = users_folder().map(|folder| folder.join(LIST)) else { return false };
    read(&list).is_ok_and(|entries| entries.contains(&entry(file, text)))
}

/// Puts a file with that text on the list.
pub(crate) fn allow(file: &Path, text: &str) -> Result<()> {
    if resolved(file).to_str().is_none() {
        return Err(Failure::input(format_args!("cannot trust {}: its name is not in UTF-8", name(file))));
    }
    let mut entries = others(file)?.0;
    entries.push(entry(file, text));
    write(&entries)
}

/// Takes a file off the list; whether it was there.
pub(crate) fn forget(file: &Path) -> Result<bool> {
    let (entries, found) = others(file)?;
    if found {
        write(&entries)?;
    }
    Ok(found)
}

fn entry(file: &Path, text: &str) -> Entry {
    Entry { file: resolved(file), sha256: sha256(text.as_bytes()) }
}

fn resolved(file: &Path) -> PathBuf {
    file.canonicalize().unwrap_or_else(|_| file.to_owned())
}

/// The entries about other files, and whether there are some about this one.
fn others(file: &Path) -> Result<(Vec<Entry>, bool)> {
    let (file, mut entries) = (resolved(file), read(&list()?)?);
    let all = entries.len();
    entries.retain(|entry| entry.file != file);
    let found = entries.len() < all;
    Ok((entries, found))
}

fn list() -> Result<PathBuf> {
    let nowhere = || Failure::input("there is no place for it: neither HOME nor XDG_CONFIG_HOME is set");
    Ok(users_folder().ok_or_else(nowhere)?.join(LIST))
}

/// What is no entry trusts nothing.
fn read(list: &Path) -> Result<Vec<Entry>> {
    if !list.exists() {
        return Ok(Vec::new());
    }
    Ok(read_source(list)?.lines().filter_map(|line| serde_json::from_str(line).ok()).collect())
}

fn write(entries: &[Entry]) -> Result<()> {
    let list = list()?;
    if let Some(folder) = list.parent() {
        std::fs::create_dir_all(folder).map_err(|e| cannot_write(&list, &e))?;
    }
    let lines: Vec<String> = entries.iter().map(json).collect::<Result<_>>()?;
    write_bytes(&list, lines.iter().flat_map(|line| [line, "\n"]).collect::<String>().as_bytes())
}
