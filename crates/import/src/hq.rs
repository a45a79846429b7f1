//! Formulas of HyperQB 1 and 2.0, HyperLasso and AutoHyper: `exists A. forall B. F(goal[A]) /\ ...`.
//!
//! One parser reads them all; where they differ, see [`Grammar`](crate::dialect::Grammar).

use crate::dialect::{Dialect, USUAL};
use crate::lexer::{Tok, lex};
use crate::mchyper;
use crate::parser::{Parse, Parser};
use crate::tree::Formula;
use hyperplan_syntax::{Diagnostic, SourceId};

/// The formula of a text, in a language that is given or seen from its signs; with a warning where that language reads it
/// otherwise than usual.
pub(crate) fn parse(
    source: SourceId,
    text: &str,
    dialect: Option<Dialect>,
) -> Parse<(Formula, Option<Diagnostic>)> {
    let tokens = lex(source, text)?;
    if mchyper::is_written_so(&tokens) {
        return Ok((mchyper::parse(Parser::new(tokens))?, None));
    }
    let usual = formula(Parser::of(tokens.clone(), &USUAL));
    let Some(own) = dialect.or_else(|| Dialect::of(&tokens)) else { return Ok((usual?, None)) };
    let read = formula(Parser::of(tokens, own.grammar()));
    match (read, usual) {
        (Ok(formula), Ok(usual)) if usual != formula => {
            let message =
                format!("{} binds operators otherwise than usual, and that matters here", own.tool());
            let warning = Diagnostic::warning("other-precedence", formula.body.span, message);
            Ok((formula, Some(warning.with_help("this is read as it does; parentheses make it plain"))))
        }
        // A language that was only guessed is perhaps another.
        (Err(_), Ok(formula)) if dialect.is_none() => Ok((formula, None)),
        (read, _) => Ok((read?, None)),
    }
}

fn formula(mut parser: Parser<'_>) -> Parse<Formula> {
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
