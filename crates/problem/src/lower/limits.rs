//! Limits that keep any input from exhausting the stack or the memory.

use super::diagnostics::Diagnostics;
use hyperplan_syntax::{Diagnostic, Span};

/// Deepest nesting of an expression once its definitions are expanded. The parser has a limit of its own for
/// what is written; definitions that use definitions could add up to more.
pub const MAX_DEPTH: u32 = 1_000;

/// Most nodes of one objective or system once its definitions are expanded.
pub const MAX_NODES: u32 = 6_000_000;

/// Bounds of temporal operators and the K of `within K` may be at most this: what the encoder takes.
pub const MAX_BOUND: i64 = 100_000;

/// Greatest absolute value at the ends of a variable's range.
pub(crate) const MAX_RANGE: i64 = 1 << 40;

/// Most nodes that may come from writing one expression several times, as `x in {..}` does with `x`.
pub(crate) const MAX_COPIES: usize = 100_000;

/// Counts the nodes built and how deep the recursion is.
#[derive(Debug, Default)]
pub(crate) struct Limits {
    depth: u32,
    nodes: u32,
    reported: bool,
}

impl Limits {
    /// Starts a node; says `false`, once with a message, where a limit is reached. Pair with [`Limits::leave`]
    /// where it said `true`.
    pub(crate) fn enter(&mut self, span: Span, diagnostics: &mut Diagnostics) -> bool {
        let allowed = self.depth < MAX_DEPTH && self.nodes < MAX_NODES && !diagnostics.are_enough();
        if allowed {
            self.depth += 1;
            self.nodes += 1;
        } else {
            self.refuse(span, diagnostics);
        }
        allowed
    }

    /// Not a part of [`Limits::enter`], as each level of the recursion would have room for the message on its stack.
    #[cold]
    #[inline(never)]
    fn refuse(&mut self, span: Span, diagnostics: &mut Diagnostics) {
        if std::mem::replace(&mut self.reported, true) {
            return;
        }
        diagnostics.push(if diagnostics.are_enough() {
            let what = "so many errors that what follows is not looked at";
            Diagnostic::error("too-many-errors", span, what)
        } else if self.depth >= MAX_DEPTH {
            let what = format!("nested more than {MAX_DEPTH} levels deep once definitions are expanded");
            Diagnostic::error("too-large", span, what)
        } else {
            let what = format!("more than {MAX_NODES} parts once definitions are expanded");
            Diagnostic::error("too-large", span, what)
        });
    }

    /// Ends a node.
    pub(crate) fn leave(&mut self) {
        self.depth -= 1;
    }
}
