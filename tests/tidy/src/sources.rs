//! The sources: each crate's modules, found as the compiler finds them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::{Attribute, Item, Meta};

/// A module that has a file.
pub(crate) struct Module {
    /// The file, from the top of the repository.
    pub(crate) file: PathBuf,
    /// Its path in its crate.
    pub(crate) path: Vec<String>,
    /// Whether only tests have it.
    pub(crate) is_test: bool,
    /// Its text.
    pub(crate) text: String,
    /// What it has, without tests.
    pub(crate) items: Vec<Item>,
}

/// The top of the repository.
pub(crate) fn top() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().nth(2).expect("this crate lies two folders deep").to_owned()
}

/// The folders of all crates, from the top.
pub(crate) fn crates() -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> =
        ["tests", "tests/random", "tests/tidy", "tests/tiny", "fuzz", "python"].map(PathBuf::from).to_vec();
    let entries = fs::read_dir(top().join("crates")).expect("the crates lie there");
    all.extend(entries.map(|entry| Path::new("crates").join(entry.expect("readable").file_name())));
    all.sort();
    all
}

/// The modules of a crate that are compiled into its library or program.
pub(crate) fn production(folder: &Path) -> Vec<Module> {
    let mut found = Vec::new();
    for root in ["src/lib.rs", "src/main.rs"] {
        let file = folder.join(root);
        if top().join(&file).exists() {
            follow(&file, Vec::new(), false, &mut found);
        }
    }
    found
}

/// All modules: also those of tests, benches and fuzzers.
pub(crate) fn everything() -> Vec<Module> {
    let mut found = Vec::new();
    for folder in crates() {
        found.extend(production(&folder));
        let script = folder.join("build.rs");
        if top().join(&script).exists() {
            follow(&script, Vec::new(), false, &mut found);
        }
        for other in ["tests", "benches", "examples", "targets"] {
            let Ok(entries) = fs::read_dir(top().join(&folder).join(other)) else { continue };
            let mut names: Vec<_> = entries.map(|entry| entry.expect("readable").file_name()).collect();
            names.sort();
            for name in names.iter().filter(|name| Path::new(name).extension().is_some_and(|end| end == "rs"))
            {
                follow(&folder.join(other).join(name), Vec::new(), other != "targets", &mut found);
            }
        }
    }
    found
}

/// Reads a file and the files of the modules that it declares.
fn follow(file: &Path, path: Vec<String>, is_test: bool, found: &mut Vec<Module>) {
    let shown = file.display();
    let text = fs::read_to_string(top().join(file)).unwrap_or_else(|error| panic!("{shown}: {error}"));
    let syntax = syn::parse_file(&text).unwrap_or_else(|error| panic!("{shown}: {error}"));
    let parent = file.parent().expect("it lies in a folder");
    let stem = file.file_stem().expect("it has a name");
    let is_root = path.is_empty() || stem == "mod";
    let folder = if is_root { parent.to_owned() } else { parent.join(stem) };
    let mut below = Vec::new();
    let items = without_tests(syntax.items, &folder, parent, is_test, &mut below);
    found.push(Module { file: file.to_owned(), path: path.clone(), is_test, text, items });
    for (name, file, is_test) in below {
        follow(&file, [path.as_slice(), &[name]].concat(), is_test, found);
    }
}

/// The items that are not for tests only; the files of modules are collected.
fn without_tests(
    items: Vec<Item>,
    folder: &Path,
    parent: &Path,
    is_test: bool,
    below: &mut Vec<(String, PathBuf, bool)>,
) -> Vec<Item> {
    let mut kept = Vec::new();
    for mut item in items {
        let for_tests = is_test || attributes(&item).iter().any(is_for_tests);
        if let Item::Mod(module) = &mut item {
            let name = module.ident.to_string();
            match &mut module.content {
                Some((_, inner)) => {
                    let folder = folder.join(&name);
                    *inner = without_tests(std::mem::take(inner), &folder, &folder, for_tests, below);
                }
                None => below.push((name.clone(), file_of(module, folder, parent), for_tests)),
            }
        }
        if is_test || !for_tests {
            kept.push(item);
        }
    }
    kept
}

fn file_of(module: &syn::ItemMod, folder: &Path, parent: &Path) -> PathBuf {
    for attribute in &module.attrs {
        if let Meta::NameValue(meta) = &attribute.meta
            && meta.path.is_ident("path")
            && let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) = &meta.value
        {
            return normal(&parent.join(text.value()));
        }
    }
    let name = module.ident.to_string();
    let flat = folder.join(&name).with_extension("rs");
    if top().join(&flat).exists() { flat } else { folder.join(name).join("mod.rs") }
}

/// The path without `..`.
pub(crate) fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        if part.as_os_str() == ".." {
            normal.pop();
        } else {
            normal.push(part);
        }
    }
    normal
}

/// Whether it is `#[cfg(test)]`, or with more beside it, or `#[test]`.
fn is_for_tests(attribute: &Attribute) -> bool {
    match &attribute.meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) if list.path.is_ident("cfg") => {
            let words: Vec<String> = flat(list.tokens.clone()).iter().map(ToString::to_string).collect();
            words.iter().any(|word| word == "test") && !words.iter().any(|word| word == "not")
        }
        _ => false,
    }
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// All tokens, in groups or not.
pub(crate) fn flat(tokens: TokenStream) -> Vec<TokenTree> {
    let mut all = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Group(group) => all.extend(flat(group.stream())),
            token => all.push(token),
        }
    }
    all
}

/// Every file with Rust below the top.
fn files(folder: &Path, found: &mut BTreeSet<PathBuf>) {
    for entry in fs::read_dir(top().join(folder)).expect("readable") {
        let name = entry.expect("readable").file_name();
        let path = folder.join(&name);
        if top().join(&path).is_dir() {
            let skipped = name == "target" || name.to_string_lossy().starts_with('.');
            if !skipped {
                files(&path, found);
            }
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.insert(path);
        }
    }
}

#[test]
fn no_file_is_dead() {
    let mut all = BTreeSet::new();
    files(Path::new(""), &mut all);
    // What a script compiles is no part of a crate.
    all.retain(|file| !file.starts_with("scripts"));
    for module in everything() {
        all.remove(&module.file);
    }
    let dead =
        all.iter().map(|file| format!("{}: no module declares it: declare or delete it", file.display()));
    crate::nothing(dead.collect());
}
