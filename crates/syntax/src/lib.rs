//! From text to syntax tree: the problem language of `docs/language.md`, with places and diagnostics.

pub mod ast;
mod diagnostic;
mod excerpt;
mod lexer;
mod lookalike;
pub mod operator;
mod parser;
mod print;
mod render;
mod similar;
mod span;
mod token;

pub use diagnostic::{Diagnostic, Severity};
pub use lexer::is_name;
pub use parser::{MAX_NESTING, parse, parse_exprs, vocabulary};
pub use print::print;
pub use render::{JsonDiagnostic, JsonRelated, JsonSpan, render, to_json};
pub use similar::similar;
pub use span::{Source, SourceId, SourceMap, Span};
