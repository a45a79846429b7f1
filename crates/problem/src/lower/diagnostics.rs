//! Collecting diagnostics without saying anything twice.

use crate::display;
use hyperplan_syntax::{Diagnostic, Span, similar};
use rustc_hash::FxHashSet;

/// What was found wrong so far, and the uses (of definitions, of templates) that are being expanded.
#[derive(Debug, Default)]
pub(crate) struct Diagnostics {
    list: Vec<Diagnostic>,
    errors: usize,
    seen: FxHashSet<(Option<Span>, &'static str, String)>,
    uses: Vec<(Span, String)>,
}

impl Diagnostics {
    /// Adds a message, unless the same one was added for the same place already: a definition that is used twice
    /// has its mistakes reported once.
    pub(crate) fn push(&mut self, mut diagnostic: Diagnostic) {
        if !self.seen.insert((diagnostic.span, diagnostic.code, diagnostic.message.clone())) {
            return;
        }
        // The innermost use and the outermost one: those between rarely help.
        let mut uses = self.uses.iter().rev();
        for (span, words) in uses.next().into_iter().chain(uses.next_back()) {
            if Some(*span) != diagnostic.span {
                diagnostic = diagnostic.with_related(*span, words.clone());
            }
        }
        self.errors += usize::from(diagnostic.is_error());
        self.list.push(diagnostic);
    }

    /// Whether there are so many errors that nobody would read more: each takes a search for what was probably meant.
    pub(crate) fn are_enough(&self) -> bool {
        self.errors > MAX_ERRORS
    }

    /// Adds a message about something of which nothing comes.
    pub(crate) fn refuse<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.push(diagnostic);
        None
    }

    /// Enters the text of a definition or template that is used at `span`.
    pub(crate) fn enter_use(&mut self, span: Span, words: String) {
        self.uses.push((span, words));
    }

    /// Leaves it.
    pub(crate) fn leave_use(&mut self) {
        self.uses.pop();
    }

    /// Adds a message, unless there is one for that place already.
    pub(crate) fn push_where_none(&mut self, diagnostic: Diagnostic) {
        if !self.list.iter().any(|known| known.span == diagnostic.span) {
            self.push(diagnostic);
        }
    }

    /// Whether there is an error among them.
    pub(crate) fn any_error(&self) -> bool {
        self.errors > 0
    }

    /// Everything, in the order found.
    pub(crate) fn into_list(self) -> Vec<Diagnostic> {
        self.list
    }
}

/// Expressions are not looked at after so many errors.
const MAX_ERRORS: usize = 200;

/// Completes a message about an unknown name by the one that was probably meant, or by those there are.
pub(crate) fn suggest<'a>(
    diagnostic: Diagnostic,
    name: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Diagnostic {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    if let Some(meant) = similar(name, candidates.iter().copied()) {
        return diagnostic.with_help(format!("did you mean `{}`?", display::name(meant)));
    }
    if candidates.is_empty() || candidates.len() > 12 {
        return diagnostic;
    }
    let list: Vec<String> = candidates.iter().map(|c| format!("`{}`", display::name(c))).collect();
    diagnostic.with_help(format!("known here: {}", list.join(", ")))
}
