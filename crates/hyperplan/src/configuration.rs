//! Configured files: where they are, and whether they may be used. What they say is for the solvers' catalog.

use crate::failure::{Failure, Result};
use crate::files::{name, read_source};
use crate::output::Output;
use crate::trusted::{self, users_folder};
use hyperplan_solver::{Catalog, says_what_to_run};
use std::cell::OnceCell;
use std::env;
use std::path::{Path, PathBuf};

const NAME: &str = "hyperplan.toml";

/// What the configuration files say, which are read when somebody wants to know.
pub(crate) struct Configured<'a> {
    out: &'a Output,
    catalog: OnceCell<Catalog>,
}

impl<'a> Configured<'a> {
    pub(crate) fn new(out: &'a Output) -> Self {
        Configured { out, catalog: OnceCell::new() }
    }

    /// The solvers that can be named: hyperplan's own, those of the user's file, and those of the project's, which come
    /// first.
    pub(crate) fn catalog(&self) -> Result<&Catalog> {
        match self.catalog.get() {
            Some(catalog) => Ok(catalog),
            None => {
                let catalog = read(self.out)?;
                Ok(self.catalog.get_or_init(|| catalog))
            }
        }
    }
}

/// Whoever hands on a folder is not to run programs with that: a project's file that says what to run is used only if
/// the user has allowed it.
fn read(out: &Output) -> Result<Catalog> {
    let mut catalog = Catalog::default();
    let users = users();
    if let Some(file) = &users {
        catalog.add(file, &read_source(file)?).map_err(Failure::input)?;
    }
    // In the user's own folder they are the same.
    if let Some(file) = projects().filter(|file| Some(file) != users.as_ref()) {
        let text = read_source(&file)?;
        if !says_what_to_run(&text) || trusted::is_trusted(&file, &text) {
            catalog.add(&file, &text).map_err(Failure::input)?;
        } else {
            out.remark(format_args!(
                "note: {} names programs to run and is not used: `hyperplan solvers --trust` allows it as it is now",
                name(&file)
            ));
        }
    }
    Ok(catalog)
}

/// Allows the project's file to say what to run, as it is now.
pub(crate) fn trust(out: &Output) -> Result<()> {
    let none = || Failure::input(format_args!("there is no {NAME} of yours in this folder or above it"));
    let file = projects().ok_or_else(none)?;
    let text = read_source(&file)?;
    Catalog::default().add(&file, &text).map_err(Failure::input)?;
    trusted::allow(&file, &text)?;
    out.remark(format_args!("note: {} is trusted until it changes", name(&file)));
    Ok(())
}

/// Takes that back.
pub(crate) fn distrust(out: &Output) -> Result<()> {
    let file = match projects() {
        Some(file) => file,
        // It may be gone.
        None => env::current_dir().map_err(Failure::input)?.join(NAME),
    };
    let was = if trusted::forget(&file)? { "no longer" } else { "not" };
    out.remark(format_args!("note: {} is {was} trusted", name(&file)));
    Ok(())
}

/// The user's file, if there is one.
fn users() -> Option<PathBuf> {
    Some(users_folder()?.join(NAME)).filter(|file| file.is_file())
}

/// The project's file: in the current folder, or else in the nearest above it that has one. One that belongs to somebody
/// else is none of ours.
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
