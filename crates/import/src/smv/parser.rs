//! The sections of SMV modules.

use crate::lexer::{Tok, lex};
use crate::parser::{Parse, Parser};
use crate::tree::{Expr, Item, Module, Moment, Role, Type, TypeKind};
use hyperplan_syntax::{Diagnostic, SourceId};

/// Words that begin a section.
const SECTIONS: &[&str] = &[
    "MODULE",
    "VAR",
    "IVAR",
    "FROZENVAR",
    "DEFINE",
    "CONSTANTS",
    "ASSIGN",
    "INIT",
    "TRANS",
    "INVAR",
    "FAIRNESS",
    "JUSTICE",
    "COMPASSION",
    "SPEC",
    "CTLSPEC",
    "LTLSPEC",
    "INVARSPEC",
    "PSLSPEC",
    "COMPUTE",
    "ISA",
    "PRED",
    "MIRROR",
    "PARSYNTH",
    "FUN",
];

/// More errors than these are not worth telling.
const MAX_ERRORS: usize = 20;

/// The modules of a text, as far as they can be read, and what is wrong.
pub(crate) fn parse(source: SourceId, text: &str) -> (Vec<Module>, Vec<Diagnostic>) {
    let tokens = match lex(source, text) {
        Ok(tokens) => tokens,
        Err(error) => return (Vec::new(), vec![*error]),
    };
    let mut parser = Parser::new(tokens);
    let (mut modules, mut found): (Vec<Module>, Vec<Diagnostic>) = (Vec::new(), Vec::new());
    while parser.token().tok != Tok::Eof && found.len() < MAX_ERRORS {
        if let Err(error) = section(&mut parser, &mut modules, &mut found) {
            found.push(*error);
            skip(&mut parser);
        }
    }
    if modules.is_empty() && found.is_empty() {
        let error = Diagnostic::error("no-module", parser.token().span, "there is no `MODULE main`");
        found.push(error.with_help("a model begins with `MODULE main`"));
    }
    if let Some(first) = parser.open_cases.first() {
        let message = match parser.open_cases.len() {
            1 => "this `case` has none that always applies; where none does, its last value is taken"
                .to_owned(),
            n => format!(
                "{n} `case`s have none that always applies; where none does, their last value is taken"
            ),
        };
        let warning = Diagnostic::warning("open-case", *first, message);
        found.push(warning.with_help("end it with `TRUE : ...;`, as NuSMV wants it where it cannot tell"));
    }
    (modules, found)
}

/// Goes on at the next section.
fn skip(parser: &mut Parser<'_>) {
    while parser.token().tok != Tok::Eof && !at_section(parser) {
        parser.bump();
    }
}

fn at_section(parser: &Parser<'_>) -> bool {
    let token = parser.token();
    token.tok == Tok::Eof || token.tok == Tok::Word && SECTIONS.contains(&token.text)
}

fn section(parser: &mut Parser<'_>, modules: &mut Vec<Module>, warnings: &mut Vec<Diagnostic>) -> Parse<()> {
    if !at_section(parser) {
        return parser.fail("a section such as `VAR` or `ASSIGN`");
    }
    let word = parser.bump();
    if word.text == "MODULE" {
        let name = parser.name("the name of the module")?;
        let mut params = Vec::new();
        if parser.eat("(") && !parser.eat(")") {
            params = parser.list(|parser| parser.name("a parameter"))?;
            parser.expect(")")?;
        }
        modules.push(Module { name, params, items: Vec::new() });
        return Ok(());
    }
    let Some(module) = modules.last_mut() else {
        parser.at -= 1;
        return parser.fail("`MODULE main`");
    };
    let items = &mut module.items;
    match word.text {
        "VAR" => variables(parser, Role::State, items),
        "IVAR" => variables(parser, Role::Input, items),
        "FROZENVAR" => variables(parser, Role::Frozen, items),
        "DEFINE" => definitions(parser, items),
        "CONSTANTS" => {
            items.push(Item::Constants(parser.list(|parser| parser.name("a constant"))?));
            parser.expect(";").map(|_| ())
        }
        "ASSIGN" => assignments(parser, items),
        "INIT" => constraint(parser, Item::Init, items),
        "TRANS" => constraint(parser, Item::Trans, items),
        "INVAR" => constraint(parser, Item::Invar, items),
        "FAIRNESS" | "JUSTICE" | "COMPASSION" => {
            let message = format!("`{}` speaks of infinite paths, and these are finite", word.text);
            let help = "within K steps every fair path begins like an unfair one: leave it out";
            parser.refuse(word.span, message, help)
        }
        "SPEC" | "CTLSPEC" | "LTLSPEC" | "INVARSPEC" | "PSLSPEC" | "COMPUTE" => {
            let message =
                format!("this `{}` is not read: what is asked stands in the formula file", word.text);
            warnings.push(Diagnostic::warning("ignored", word.span, message));
            skip(parser);
            Ok(())
        }
        _ => parser.refuse(word.span, format!("`{}` is not supported", word.text), ""),
    }
}

fn variables(parser: &mut Parser<'_>, role: Role, items: &mut Vec<Item>) -> Parse<()> {
    while !at_section(parser) {
        let name = declared(parser, "the name of a variable")?;
        parser.expect(":")?;
        let ty = declared_type(parser)?;
        parser.expect(";")?;
        items.push(Item::Var(role, name, ty));
    }
    Ok(())
}

/// A name that is declared: NuSMV has plain ones, its relatives also `proc1.line` and `items[0]`.
fn declared(parser: &mut Parser<'_>, what: &str) -> Parse<hyperplan_syntax::ast::Ident> {
    let mut name = parser.name(what)?;
    loop {
        if parser.is(".") && parser.token_at(1).tok == Tok::Word {
            parser.bump();
            name.name += ".";
            name.name += parser.bump().text;
        } else if parser.is("[") && parser.token_at(1).tok == Tok::Number && parser.token_at(2).text == "]" {
            parser.bump();
            name.name += &format!("[{}]", parser.bump().text);
            parser.bump();
        } else {
            name.span = parser.since(name.span);
            return Ok(name);
        }
    }
}

fn declared_type(parser: &mut Parser<'_>) -> Parse<Type> {
    let start = parser.token();
    let kind = match start.text {
        "boolean" => {
            parser.bump();
            TypeKind::Bool
        }
        "array" => return array(parser),
        "unsigned" | "signed" | "word" => {
            parser.bump();
            if start.text != "word" {
                parser.expect("word")?;
            }
            parser.expect("[")?;
            let width = parser.expr()?;
            parser.expect("]")?;
            TypeKind::Word(start.text == "signed", width)
        }
        "{" => {
            parser.bump();
            let values = parser.list(Parser::sum)?;
            parser.expect("}")?;
            TypeKind::Values(values)
        }
        "process" => {
            let help = "let the modules take their steps together, and say who moves by a variable";
            return parser.refuse(start.span, "processes are not supported", help);
        }
        "integer" | "real" | "clock" => {
            let message =
                format!("variables of type `{}` have no bounds, which is not supported", start.text);
            return parser.refuse(start.span, message, "give the variable a range, such as `0..9`");
        }
        _ if start.tok == Tok::Word && matches!(parser.token_at(1).text, ";" | "(") => {
            let module = parser.name("a type")?;
            let mut arguments = Vec::new();
            if parser.eat("(") && !parser.eat(")") {
                arguments = parser.list(Parser::expr)?;
                parser.expect(")")?;
            }
            TypeKind::Instance(module, arguments)
        }
        _ => {
            let lo = parser.sum()?;
            parser.expect("..")?;
            TypeKind::Range(lo, parser.sum()?)
        }
    };
    Ok(Type { kind, span: parser.since(start.span) })
}

/// `array LO..HI of TYPE`; of several, from the outermost.
fn array(parser: &mut Parser<'_>) -> Parse<Type> {
    let mut around = Vec::new();
    while parser.is("array") {
        let start = parser.bump().span;
        if around.len() >= 8 {
            return parser.refuse(start, "arrays of more than 8 dimensions are not supported", "");
        }
        let lo = parser.sum()?;
        parser.expect("..")?;
        let hi = parser.sum()?;
        parser.expect("of")?;
        around.push((start, lo, hi));
    }
    let mut ty = declared_type(parser)?;
    for (start, lo, hi) in around.into_iter().rev() {
        ty = Type { kind: TypeKind::Array(lo, hi, Box::new(ty)), span: parser.since(start) };
    }
    Ok(ty)
}

fn definitions(parser: &mut Parser<'_>, items: &mut Vec<Item>) -> Parse<()> {
    while !at_section(parser) {
        let name = declared(parser, "the name of a definition")?;
        parser.expect(":=")?;
        let body = parser.expr()?;
        parser.expect(";")?;
        items.push(Item::Define(name, body));
    }
    Ok(())
}

fn assignments(parser: &mut Parser<'_>, items: &mut Vec<Item>) -> Parse<()> {
    while !at_section(parser) {
        let moment = match parser.token().text {
            "init" if parser.token_at(1).text == "(" => Moment::First,
            "next" if parser.token_at(1).text == "(" => Moment::Next,
            _ => Moment::Every,
        };
        if moment != Moment::Every {
            parser.bump();
            parser.bump();
        }
        let left = parser.sum()?;
        if moment != Moment::Every {
            parser.expect(")")?;
        }
        parser.expect(":=")?;
        let right = parser.expr()?;
        parser.expect(";")?;
        items.push(Item::Assign(moment, left, right));
    }
    Ok(())
}

fn constraint(parser: &mut Parser<'_>, make: impl Fn(Expr) -> Item, items: &mut Vec<Item>) -> Parse<()> {
    items.push(make(parser.expr()?));
    parser.eat(";");
    Ok(())
}
