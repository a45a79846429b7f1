//! Configuration files: where they are. What they say is for the solvers' catalog.

use crate::failure::{Failure, Result};
use crate::files::read_source;
use hyperplan_solver::Catalog;
use std::env;
use std::path::{Path, PathBuf};

const NAME: &str = "hyperplan.toml";

/// The solvers that can be named: hyperplan's own, those of the user's file, and those of the project's, which come
/// first.
pub(crate) fn catalog() -> Result<Catalog> {
    let mut catalog = Catalog::default();
    for file in users().into_iter().chain(projects()) {
        let text = read_source(&file)?;
        catalog.add(&file, &text).map_err(Failure::input)?;
    }
    Ok(catalog)
}

/// The user's file, if there is one.
fn users() -> Option<PathBuf> {
    let absolute = |name| env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let folder = absolute("XDG_CONFIG_HOME").or_else(|| Some(absolute("HOME")?.join(".config")))?;
    Some(folder.join("hyperplan").join(NAME)).filter(|file| file.is_file())
}

/// The project's file: in the current folder, or else in the nearest above it that has one. Files say which programs
/// are run, so one that belongs to somebody else is none of ours.
fn projects() -> Option<PathBuf> {
    let folder = env::current_dir().ok()?;
    folder.ancestors().map(|folder| folder.join(NAME)).find(|file| file.is_file() && is_ours(file))
}

#[cfg(unix)]
fn is_ours(file: &Path) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let owner = file.metadata().map(|data| data.uid());
    owner.is_ok_and(|owner| owner == 0 || owner == rustix::process::geteuid().as_raw())
}

#[cfg(not(unix))]
fn is_ours(_: &Path) -> bool {
    true
}
