//! How long files and functions may be.

use syn::visit::{self, Visit};

use crate::sources::everything;
use crate::{except, nothing};

/// A file has fewer lines.
const FILE: usize = 700;
/// A function has fewer lines, from its name to its end.
const FUNCTION: usize = 80;

/// Files that may be longer, and why.
const LONG_FILES: &[(&str, &str)] = &[];

/// Functions that may be longer, and why.
const LONG_FUNCTIONS: &[(&str, &str)] = &[];

#[test]
fn files_fit_in_one_reading() {
    let mut found = Vec::new();
    for module in everything() {
        let (file, lines) = (module.file.display().to_string(), module.text.lines().count());
        if lines >= FILE {
            let message = format!("{file}: {lines} lines: split it, each part below {FILE}");
            found.push((file, message));
        }
    }
    nothing(except(found, LONG_FILES));
}

/// Functions with their first and last lines.
#[derive(Default)]
struct Functions(Vec<(String, usize, usize)>);

impl Functions {
    fn add(&mut self, signature: &syn::Signature, body: &syn::Block) {
        let first = signature.ident.span().start().line;
        let last = body.brace_token.span.close().end().line;
        self.0.push((signature.ident.to_string(), first, last));
    }
}

impl<'a> Visit<'a> for Functions {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        self.add(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        self.add(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'a syn::TraitItemFn) {
        if let Some(body) = &function.default {
            self.add(&function.sig, body);
        }
        visit::visit_trait_item_fn(self, function);
    }
}

#[test]
fn functions_fit_on_a_screen() {
    let mut found = Vec::new();
    for module in everything() {
        let mut functions = Functions::default();
        // From the text: tests count too.
        functions.visit_file(&syn::parse_file(&module.text).expect("it was parsed before"));
        for (name, first, last) in functions.0 {
            let lines = last + 1 - first;
            if lines >= FUNCTION {
                let file = module.file.display();
                let message = format!("{file}:{first}: {name} has {lines} lines: split it, below {FUNCTION}");
                found.push((format!("{file}: {name}"), message));
            }
        }
    }
    nothing(except(found, LONG_FUNCTIONS));
}
