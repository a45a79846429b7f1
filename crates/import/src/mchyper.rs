//! MCHyper's formulas, with their operators before their operands: `Forall (Exists (G (Eq (AP "x" 0) (AP "x" 1))))`.
//!
//! Paths have no names there: they are counted from the outermost quantifier, and called `p0`, `p1` and so on here.

use crate::build::{infix, name, not, truth};
use crate::lexer::{Tok, Token};
use crate::parser::{Parse, Parser};
use crate::tree::{Expr, Formula, Infix, Kind};
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{BinaryOp, Ident, UnaryOp};

/// Operators nested more deeply are refused, as in the other languages.
const MAX_NESTING: u32 = 200;

/// Whether a formula is written so: its quantifier has no name, and its propositions have a number.
pub(crate) fn is_written_so(tokens: &[Token<'_>]) -> bool {
    let mut words = tokens.iter().map(|token| token.text).skip_while(|text| *text == "(");
    matches!(words.next(), Some("Forall" | "Exists")) && words.next() == Some("(")
}

/// A formula.
pub(crate) fn parse(mut parser: Parser<'_>) -> Parse<Formula> {
    let mut quantifiers = Vec::new();
    let mut open = 0;
    loop {
        if parser.eat("(") {
            open += 1;
            continue;
        }
        let token = parser.token();
        if !matches!(token.text, "Forall" | "Exists") {
            break;
        }
        parser.bump();
        let path = Ident { name: format!("p{}", quantifiers.len()), span: token.span };
        quantifiers.push((token.text == "Forall", path));
    }
    if quantifiers.is_empty() {
        return parser.fail("`Forall` or `Exists`");
    }
    let body = operation(&mut parser, &quantifiers, 0)?;
    for _ in 0..open {
        parser.expect(")")?;
    }
    if parser.token().tok != Tok::Eof {
        return parser.fail("the end of the formula");
    }
    Ok(Formula { quantifiers, body })
}

/// An operator with its operands.
fn operation(parser: &mut Parser<'_>, paths: &[(bool, Ident)], depth: u32) -> Parse<Expr> {
    let token = parser.token();
    let span = token.span;
    if depth >= MAX_NESTING {
        return parser.refuse(span, format!("nested more than {MAX_NESTING} levels deep"), "");
    }
    if parser.eat("(") {
        let inside = operation(parser, paths, depth + 1)?;
        parser.expect(")")?;
        return Ok(inside);
    }
    if token.tok != Tok::Word {
        return parser.fail("an operator such as `And` or `AP`");
    }
    parser.bump();
    let mut operand = || operation(parser, paths, depth + 1);
    let temporal = |op, a: Expr| Expr::new(Kind::Unary(op, None, Box::new(a)), span);
    let until = |op, a: Expr, b: Expr| Expr::new(Kind::Binary(op, None, Box::new(a), Box::new(b)), span);
    Ok(match token.text {
        "AP" => return proposition(parser, paths, span),
        "Const" => match parser.bump().text {
            "True" => truth(true, span),
            "False" => truth(false, span),
            _ => return parser.refuse(span, "`Const` is `True` or `False`", ""),
        },
        "Neg" => not(operand()?, span),
        "X" => temporal(UnaryOp::Next, operand()?),
        "G" => temporal(UnaryOp::Globally, operand()?),
        "F" => temporal(UnaryOp::Finally, operand()?),
        "And" => Expr::new(Kind::And(vec![operand()?, operand()?]), span),
        "Or" => Expr::new(Kind::Or(vec![operand()?, operand()?]), span),
        "Until" => until(BinaryOp::Until, operand()?, operand()?),
        "WUntil" => until(BinaryOp::WeakUntil, operand()?, operand()?),
        "Release" => until(BinaryOp::Release, operand()?, operand()?),
        "Eq" => infix(Infix::Iff, operand()?, operand()?, span),
        "Neq" => not(infix(Infix::Iff, operand()?, operand()?, span), span),
        "Implies" => infix(Infix::Implies, operand()?, operand()?, span),
        other => {
            let message = format!("the operator `{other}` is not read");
            return parser.refuse(span, message, "write it with those of the future, and with `AP`");
        }
    })
}

/// `"name" 0`, behind `AP`.
fn proposition(parser: &mut Parser<'_>, paths: &[(bool, Ident)], start: Span) -> Parse<Expr> {
    if parser.token().tok != Tok::Text {
        return parser.fail("a name in quotes");
    }
    let token = parser.bump();
    let number = parser.bump();
    let Some((_, path)) = number.text.parse::<usize>().ok().and_then(|number| paths.get(number)) else {
        let message = format!("there is no path {}: {} are quantified", number.text, paths.len());
        return parser.refuse(number.span, message, "they are counted from 0, the outermost first");
    };
    let own = name(token.text.trim_matches('"'), token.span);
    let path = Ident { name: path.name.clone(), span: number.span };
    Ok(Expr::new(Kind::At(Box::new(own), path), start))
}
