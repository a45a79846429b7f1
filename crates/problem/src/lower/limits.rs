//! Limits that keep any input from exhausting the stack or the memory.

use super::diagnostics::Diagnostics;
use hyperplan_syntax::{Diagnostic, Span};

/// Deepest nesting of an expression once its definitions are expanded. The parser has a limit of its own for
/// what is written; definitions that use definitions could add up to more.
pub const MAX_DEPTH: u32 = 1_000;

/// Most nodes of one objective or system once its definitions are expanded.
pub const MAX_NODES: u32 = 2_000_000;

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
        if diagnostics.are_enough() {
            if !self.reported {
                self.reported = true;
                let message = "so many errors that what follows is not looked at";
                diagnostics.push(Diagnostic::error("too-many-errors", span, message));
            }
            return false;
        }
        if self.depth < MAX_DEPTH && self.nodes < MAX_NODES {
            self.depth += 1;
            self.nodes += 1;
            return true;
        }
        if !self.reported {
            self.reported = true;
            let what = if self.depth >= MAX_DEPTH {
                format!("nested more than {MAX_DEPTH} levels deep once definitions are expanded")
            } else {
                format!("more than {MAX_NODES} parts once definitions are expanded")
            };
            diagnostics.push(Diagnostic::error("too-large", span, what));
        }
        false
    }

    /// Ends a node.
    pub(crate) fn leave(&mut self) {
        self.depth -= 1;
    }
}
