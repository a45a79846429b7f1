//! What holds the house up, as tests: which crate and which module may know of which, that no file is dead, how long
//! files and functions may be, what only the command knows, and that the book is whole. They read the sources and need
//! nothing else of the workspace, so that they are the first to run: `cargo test -p hyperplan-tidy`.
//!
//! Each message begins with a place and ends with what to do. An exception is a line in a table here, with its reason;
//! one that is no longer needed is reported like what is missing.

#[cfg(test)]
mod book;
#[cfg(test)]
mod crates;
#[cfg(test)]
mod modules;
#[cfg(test)]
mod sizes;
#[cfg(test)]
mod sources;
#[cfg(test)]
mod words;

/// Fails with all that was found.
#[cfg(test)]
fn nothing(found: Vec<String>) {
    assert!(found.is_empty(), "{} found:\n{}\n", found.len(), found.join("\n"));
}

/// What an exception is for goes from what was found; one that is for nothing is found.
#[cfg(test)]
fn except(found: Vec<(String, String)>, exceptions: &[(&str, &str)]) -> Vec<String> {
    let unused = exceptions.iter().filter(|(key, _)| !found.iter().any(|(found, _)| found == key));
    let unused = unused.map(|(key, _)| format!("{key}: nothing is wrong any more: take the exception away"));
    let unused: Vec<String> = unused.collect();
    let kept = found.into_iter().filter(|(key, _)| !exceptions.iter().any(|(exception, _)| exception == key));
    kept.map(|(_, message)| message).chain(unused).collect()
}
