//! What only the command knows: the names of its flags, and its exit codes.

use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Lit, LitStr, Macro, Meta};

use crate::sources::{crates, flat, production};
use crate::{except, nothing};

/// Files of libraries that may name flags, and why.
const FLAGS: &[(&str, &str)] = &[
    ("crates/compare/src/cases.rs", "it writes what a run on a case is told, and finds it again in a log"),
    ("crates/compare/src/pool.rs", "it writes the command lines of the runs that it starts"),
    ("crates/compare/src/slurm.rs", "those of Slurm"),
    ("crates/solver/src/external/profile.rs", "those of solvers"),
    ("crates/solver/src/external/standalone.rs", "those of solvers"),
];

/// Files of libraries that may know exit codes, and why.
const EXITS: &[(&str, &str)] = &[];

/// The words of interest, with their lines.
#[derive(Default)]
struct Words {
    flags: Vec<(usize, String)>,
    exits: Vec<(usize, String)>,
}

impl Words {
    fn text(&mut self, line: usize, text: &str) {
        for (at, _) in text.match_indices("--") {
            let before = text[..at].chars().next_back();
            let name: String =
                text[at + 2..].chars().take_while(|c| c.is_ascii_lowercase() || *c == '-').collect();
            let is_alone = before.is_none_or(|c| !c.is_alphanumeric() && c != '-');
            if is_alone && name.starts_with(|c: char| c.is_ascii_lowercase()) {
                self.flags.push((line, format!("--{name}")));
            }
        }
    }

    fn name(&mut self, name: &Ident) {
        if name == "ExitCode" || name == "exit_code" {
            self.exits.push((name.span().start().line, name.to_string()));
        }
    }

    /// The tokens of a macro: most messages stand in one.
    fn tokens(&mut self, tokens: TokenStream) {
        for token in flat(tokens) {
            match token {
                TokenTree::Literal(literal) => {
                    if let Lit::Str(text) = Lit::new(literal) {
                        self.visit_lit_str(&text);
                    }
                }
                // A field of that name is what another program ended with.
                TokenTree::Ident(name) if name == "ExitCode" => self.name(&name),
                _ => {}
            }
        }
    }
}

impl<'a> Visit<'a> for Words {
    fn visit_lit_str(&mut self, text: &'a LitStr) {
        self.text(text.span().start().line, &text.value());
    }

    fn visit_macro(&mut self, invoked: &'a Macro) {
        self.tokens(invoked.tokens.clone());
    }

    fn visit_attribute(&mut self, attribute: &'a Attribute) {
        // What documentation says is for who reads the source; errors and help are for users.
        if let Meta::List(list) = &attribute.meta {
            self.tokens(list.tokens.clone());
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.ends_with(&["process".to_owned(), "exit".to_owned()]) {
            self.exits.push((path.segments[0].ident.span().start().line, "process::exit".to_owned()));
        }
        path.segments.iter().filter(|part| part.ident == "ExitCode").for_each(|part| self.name(&part.ident));
        visit::visit_path(self, path);
    }

    fn visit_signature(&mut self, signature: &'a syn::Signature) {
        self.name(&signature.ident);
        visit::visit_signature(self, signature);
    }
}

/// The words in libraries that `of` asks for, with a message each, by file.
fn found(of: fn(Words) -> Vec<(usize, String)>, what_to_do: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for folder in crates() {
        if !folder.starts_with("crates") || folder.ends_with("hyperplan") {
            continue;
        }
        for module in production(&folder).iter().filter(|module| !module.is_test) {
            let mut words = Words::default();
            module.items.iter().for_each(|item| words.visit_item(item));
            let file = module.file.display().to_string();
            for (line, word) in of(words) {
                found.push((file.clone(), format!("{file}:{line}: {word} in a library: {what_to_do}")));
            }
        }
    }
    found
}

#[test]
fn only_the_command_knows_flags() {
    let found = found(|words| words.flags, "give a fact, which `crates/hyperplan` puts into words");
    nothing(except(found, FLAGS));
}

#[test]
fn only_the_command_knows_exit_codes() {
    let found = found(|words| words.exits, "give a fact, which `crates/hyperplan` makes an exit code of");
    nothing(except(found, EXITS));
}
