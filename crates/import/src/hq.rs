//! Formulas of HyperQB 1 and 2.0, HyperLasso and AutoHyper: `exists A. forall B. F(goal[A]) /\ ...`.
//!
//! One grammar reads them all: what one of them writes means the same in the others that take it.

use crate::lexer::{Tok, lex};
use crate::parser::{Parse, Parser};
use crate::tree::Formula;
use hyperplan_syntax::{Diagnostic, SourceId};

/// The formula of a text.
pub(crate) fn parse(source: SourceId, text: &str) -> Parse<Formula> {
    let mut parser = Parser::new(lex(source, text)?);
    let mut quantifiers: Vec<(bool, hyperplan_syntax::ast::Ident)> = Vec::new();
    loop {
        let forall = match parser.token().text {
            "forall" | "Forall" | "FORALL" | "∀" => true,
            "exists" | "Exists" | "EXISTS" | "∃" => false,
            _ => break,
        };
        parser.bump();
        let paths = parser.list(|parser| parser.name("a path"))?;
        parser.eat(".");
        for path in paths {
            if let Some((_, first)) = quantifiers.iter().find(|(_, known)| known.name == path.name) {
                let message = format!("a second path `{}`", path.name);
                let error = Diagnostic::error("duplicate-name", path.span, message);
                return Err(Box::new(error.with_related(first.span, "the first one")));
            }
            quantifiers.push((forall, path));
        }
    }
    if quantifiers.is_empty() {
        return parser.fail("`forall` or `exists` and a path, such as `exists A.`");
    }
    parser.paths = Some(quantifiers.iter().map(|(_, path)| path.name.clone()).collect());
    let body = parser.expr()?;
    if parser.token().tok != Tok::Eof {
        return parser.fail("an operator or the end of the formula");
    }
    Ok(Formula { quantifiers, body })
}
