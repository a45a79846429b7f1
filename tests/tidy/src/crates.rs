//! Which crate may know of which: the table in ARCHITECTURE.md says it, and every manifest agrees.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};

use crate::nothing;
use crate::sources::{crates, everything, flat, top};

/// The heading of the column that says on which crates one rests.
const COLUMN: &str = "rests on";

/// A crate's own name: without the prefix that all have.
fn short(name: &str) -> &str {
    name.strip_prefix("hyperplan-").unwrap_or(name)
}

fn manifest(folder: &Path) -> toml::Table {
    let file = top().join(folder).join("Cargo.toml");
    let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    text.parse().unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// The names in a section of a manifest.
fn named(manifest: &toml::Table, section: &str) -> BTreeSet<String> {
    let table = manifest.get(section).and_then(toml::Value::as_table);
    table.into_iter().flat_map(toml::Table::keys).cloned().collect()
}

/// Of each published crate: those of the workspace on which it rests.
fn real() -> BTreeMap<String, BTreeSet<String>> {
    let mut all = BTreeMap::new();
    for folder in crates().iter().filter(|folder| folder.starts_with("crates")) {
        let name = folder.file_name().expect("it has a name").to_string_lossy().into_owned();
        let manifest = manifest(folder);
        if manifest["package"].get("publish").is_some_and(|publish| publish.as_bool() == Some(false)) {
            continue;
        }
        let ours = named(&manifest, "dependencies");
        let ours =
            ours.iter().filter(|name| name.starts_with("hyperplan-")).map(|name| short(name).to_owned());
        all.insert(name, ours.collect());
    }
    all
}

/// What ARCHITECTURE.md says.
fn said() -> BTreeMap<String, BTreeSet<String>> {
    let text = fs::read_to_string(top().join("ARCHITECTURE.md")).expect("it is there");
    let cells = |line: &str| -> Vec<String> {
        line.trim_matches('|').split('|').map(|cell| cell.replace('`', "").trim().to_owned()).collect()
    };
    let mut rows = text.lines().skip_while(|line| !(line.starts_with('|') && line.contains(COLUMN)));
    let heading = cells(rows.next().expect("the table of crates has such a column"));
    let at = heading.iter().position(|cell| cell == COLUMN).expect("it is one of the headings");
    let rows = rows.skip(1).take_while(|line| line.starts_with('|')).map(cells);
    let names = |cell: &str| cell.split(", ").filter(|name| !name.is_empty()).map(str::to_owned).collect();
    rows.map(|row| (row[0].clone(), names(&row[at]))).collect()
}

#[test]
fn crates_rest_on_what_the_architecture_says() {
    let (real, said) = (real(), said());
    let mut found = Vec::new();
    for name in real.keys().chain(said.keys()).collect::<BTreeSet<_>>() {
        let (Some(real), Some(said)) = (real.get(name), said.get(name)) else {
            found.push(format!(
                "ARCHITECTURE.md: {name} is only {}: make the table of crates right",
                match real.get(name) {
                    Some(_) => "in `crates/`",
                    None => "in the table",
                }
            ));
            continue;
        };
        for other in real.difference(said) {
            found.push(format!(
                "crates/{name}/Cargo.toml: {name} must not know of {other}: turn the dependency round, or change the \
                 column `{COLUMN}` in ARCHITECTURE.md if the house is to be built so"
            ));
        }
        for other in said.difference(real) {
            found.push(format!(
                "ARCHITECTURE.md: {name} does not rest on {other} any more: take it out of the row"
            ));
        }
    }
    nothing(found);
}

/// Every word of some Rust.
fn words(text: &str) -> BTreeSet<String> {
    let tokens: TokenStream = text.parse().expect("it was parsed before");
    let words = flat(tokens).into_iter().filter_map(|token| match token {
        TokenTree::Ident(word) => Some(word.to_string()),
        _ => None,
    });
    words.collect()
}

/// It and its dependencies are there for their features.
const FEATURES: &str = "workspace-hack";

#[test]
fn no_dependency_is_unused() {
    let (all, mut found) = (everything(), Vec::new());
    let roots = crates();
    for folder in roots.iter().filter(|folder| !folder.ends_with(FEATURES)) {
        let manifest = manifest(folder);
        // The folder `tests` has crates below it.
        let is_own = |file: &Path| roots.iter().filter(|root| file.starts_with(root)).max() == Some(folder);
        let own = |only: bool| -> BTreeSet<String> {
            let own = all.iter().filter(|module| is_own(&module.file) && !(only && module.is_test));
            own.flat_map(|module| words(&module.text)).collect()
        };
        for (section, words) in [("dependencies", own(true)), ("dev-dependencies", own(false))] {
            for name in named(&manifest, section) {
                if name != FEATURES && !words.contains(&name.replace('-', "_")) {
                    found.push(format!("{}/Cargo.toml: {name} is not used: take it out", folder.display()));
                }
            }
        }
    }
    nothing(found);
}
