//! That no modules of a crate go round in circles.
//!
//! Modules are a tree. What a module and those below it say to each other is their own business: a parent gathers what
//! its children do, and children share what the parent has. But of two modules side by side, with all below them, only
//! one may know of the other, directly or through more of them. What is re-exported counts as being where it is.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Item, Macro, UseTree};

use crate::sources::{Module, crates, production};
use crate::{except, nothing};

/// Circles that may be, and why.
const CIRCLES: &[(&str, &str)] = &[
    // What is written in one language recurses like it.
    ("crates/problem crate::lower: expr sets", "expressions have sets, and sets expressions"),
];

/// How many re-exports are followed at most.
const HOPS: usize = 8;

/// What is named somewhere: the parts of its path, and the line.
type Named = (Vec<String>, usize);

/// The paths in a module.
#[derive(Default)]
struct Paths {
    named: Vec<Named>,
    /// What is imported or re-exported, by the name that it has here.
    imports: BTreeMap<String, Vec<String>>,
    /// Of what everything is imported.
    globs: Vec<Vec<String>>,
    /// What is defined here.
    items: BTreeSet<String>,
}

impl Paths {
    fn of(items: &[Item]) -> Paths {
        let mut paths = Paths::default();
        items.iter().for_each(|item| paths.visit_item(item));
        paths
    }

    fn import(&mut self, tree: &UseTree, mut path: Vec<String>) {
        let mut add = |path: Vec<String>, line: usize, called: String| {
            self.named.push((path.clone(), line));
            self.imports.insert(called, path);
        };
        match tree {
            UseTree::Path(part) => {
                path.push(part.ident.to_string());
                self.import(&part.tree, path);
            }
            UseTree::Name(part) => {
                let line = part.ident.span().start().line;
                let called = match part.ident == "self" {
                    true => path.last().cloned().unwrap_or_default(),
                    false => part.ident.to_string(),
                };
                if part.ident != "self" {
                    path.push(called.clone());
                }
                add(path, line, called);
            }
            UseTree::Rename(part) => {
                path.push(part.ident.to_string());
                add(path, part.ident.span().start().line, part.rename.to_string());
            }
            UseTree::Glob(part) => {
                let line = part.star_token.spans[0].start().line;
                self.named.push((path.clone(), line));
                self.globs.push(path);
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(tree, path.clone())),
        }
    }

    /// Paths in the tokens of a macro: words between `::`.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut line, mut colons) = (Vec::new(), 0, 0);
        for token in tokens {
            match &token {
                TokenTree::Ident(word) => {
                    if colons != 2 {
                        self.named.push((std::mem::take(&mut path), line));
                        line = word.span().start().line;
                    }
                    path.push(word.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                _ => {
                    self.named.push((std::mem::take(&mut path), line));
                    colons = 0;
                }
            }
            if let TokenTree::Group(group) = token
                && group.delimiter() != Delimiter::None
            {
                self.tokens(group.stream());
            }
        }
        self.named.push((path, line));
    }
}

impl<'a> Visit<'a> for Paths {
    fn visit_item(&mut self, item: &'a Item) {
        let name = match item {
            Item::Const(item) => Some(&item.ident),
            Item::Enum(item) => Some(&item.ident),
            Item::Fn(item) => Some(&item.sig.ident),
            Item::Macro(item) => item.ident.as_ref(),
            Item::Static(item) => Some(&item.ident),
            Item::Struct(item) => Some(&item.ident),
            Item::Trait(item) => Some(&item.ident),
            Item::Type(item) => Some(&item.ident),
            _ => None,
        };
        self.items.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        self.import(&item.tree, Vec::new());
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|part| part.ident.to_string()).collect();
        let line = path.segments.first().map_or(0, |part| part.ident.span().start().line);
        self.named.push((parts, line));
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invoked: &'a Macro) {
        self.tokens(invoked.tokens.clone());
    }
}

/// A crate's modules by their paths.
struct Tree<'a>(BTreeMap<&'a [String], Paths>);

impl Tree<'_> {
    /// The module that has what a path means in a module; `None` where that is no module of this crate.
    fn home(&self, from: &[String], path: &[String], hops: usize) -> Option<Vec<String>> {
        let (first, rest) = path.split_first()?;
        let (mut at, rest) = match first.as_str() {
            "crate" => (Vec::new(), rest),
            "self" => (from.to_vec(), rest),
            "super" => (from[..from.len().checked_sub(1)?].to_vec(), rest),
            _ if self.0.contains_key([from, std::slice::from_ref(first)].concat().as_slice()) => {
                (from.to_vec(), path)
            }
            _ => return None,
        };
        for (index, part) in rest.iter().enumerate() {
            if part == "super" {
                at.pop();
                continue;
            }
            at.push(part.clone());
            if self.0.contains_key(at.as_slice()) {
                continue;
            }
            at.pop();
            return Some(self.elsewhere(&at, &rest[index..], hops).unwrap_or(at));
        }
        Some(at)
    }

    /// The module that has what a module only re-exports.
    fn elsewhere(&self, at: &[String], path: &[String], hops: usize) -> Option<Vec<String>> {
        let (paths, hops) = (self.0.get(at)?, hops.checked_sub(1)?);
        let name = path.first()?;
        if paths.items.contains(name) {
            return None;
        }
        if let Some(import) = paths.imports.get(name) {
            return self.home(at, &[import.as_slice(), &path[1..]].concat(), hops);
        }
        paths.globs.iter().find_map(|glob| {
            let home = self.home(at, glob, hops)?;
            let has = self.0.get(home.as_slice()).is_some_and(|paths| paths.items.contains(name));
            if has { Some(home) } else { self.elsewhere(&home, path, hops) }
        })
    }

    /// Which of the modules side by side below a module know of which, each with a place.
    fn beside<'a>(&self, modules: &'a [Module]) -> BTreeMap<Vec<String>, Edges<'a>> {
        let mut all: BTreeMap<Vec<String>, Edges<'a>> = BTreeMap::new();
        for module in modules {
            for (path, line) in &self.0[module.path.as_slice()].named {
                let Some(home) = self.home(&module.path, path, HOPS) else { continue };
                let common = home.iter().zip(&module.path).take_while(|(a, b)| a == b).count();
                if let (Some(from), Some(to)) = (module.path.get(common), home.get(common)) {
                    let edges = all.entry(home[..common].to_vec()).or_default();
                    edges.entry((from.clone(), to.clone())).or_insert((&module.file, *line));
                }
            }
        }
        all
    }
}

/// From one module to another, with a place where that is said.
type Edges<'a> = BTreeMap<(String, String), (&'a Path, usize)>;

/// A circle, if there is one: the modules on it.
fn circle(edges: &Edges<'_>) -> Option<Vec<String>> {
    let names: BTreeSet<&String> = edges.keys().flat_map(|(from, to)| [from, to]).collect();
    // The shortest way from each module back to itself.
    let ways = names.into_iter().filter_map(|start| {
        let mut reached = BTreeMap::from([(start, start)]);
        let mut queue = vec![start];
        let mut next = 0;
        while let Some(&at) = queue.get(next) {
            next += 1;
            for (from, to) in edges.keys().filter(|(from, _)| from == at) {
                if to == start {
                    let mut way = vec![from.clone()];
                    while way.last() != Some(start) {
                        way.push(reached[&way[way.len() - 1]].clone());
                    }
                    way.reverse();
                    return Some(way);
                }
                if !reached.contains_key(to) {
                    reached.insert(to, at);
                    queue.push(to);
                }
            }
        }
        None
    });
    ways.min_by_key(Vec::len)
}

#[test]
fn modules_do_not_go_round_in_circles() {
    let mut found = Vec::new();
    for folder in crates().iter().filter(|folder| folder.starts_with("crates")) {
        let modules: Vec<Module> = production(folder).into_iter().filter(|module| !module.is_test).collect();
        let paths = modules.iter().map(|module| (module.path.as_slice(), Paths::of(&module.items)));
        for (parent, mut edges) in Tree(paths.collect()).beside(&modules) {
            while let Some(way) = circle(&edges) {
                let pairs = way.iter().zip(way.iter().cycle().skip(1));
                let said = pairs.map(|(from, to)| {
                    let (file, line) = edges[&(from.clone(), to.clone())];
                    format!("\n    {from} knows of {to}: {}:{line}", file.display())
                });
                let place = [&["crate".to_owned()], parent.as_slice()].concat().join("::");
                let key = format!("{} {place}: {}", folder.display(), way.join(" "));
                let what = "turn one round, or move what both need below them";
                found.push((key.clone(), format!("{key}: a circle: {what}{}", said.collect::<String>())));
                // The next, without this.
                edges.remove(&(way[0].clone(), way.get(1).unwrap_or(&way[0]).clone()));
            }
        }
    }
    nothing(except(found, CIRCLES));
}
