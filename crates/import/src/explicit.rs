//! AutoHyper's explicit systems: each state with what holds there, and its successors.
//!
//! Two forms are read: `AP: "x"` with the numbers of what holds, and `Variables: ("x" Bool) ("n" Int)` with names and values.

use crate::build::{MAX_PARTS, assign, int, main, name, one_of, truth, wrong};
use crate::lexer::{Tok, lex};
use crate::parser::{Parse, Parser};
use crate::tree::{Expr, Infix, Item, Kind, Module, Moment, Role, Type, TypeKind};
use hyperplan_syntax::ast::Ident;
use hyperplan_syntax::{SourceId, Span};
use rustc_hash::FxHashMap;

/// A state as it is written.
struct State {
    number: i64,
    span: Span,
    /// The value of each property; those that are not named are false, or 0.
    values: FxHashMap<usize, i64>,
    next: Vec<(i64, Span)>,
}

/// A property of states.
struct Property {
    ident: Ident,
    boolean: bool,
}

/// A system as a module: the variable `state`, and a definition for each property.
pub(crate) fn parse(source: SourceId, text: &str) -> Parse<Vec<Module>> {
    // `--BODY--` and `--END--` would be comments.
    let text = text.replace("--BODY--", "  BODY  ").replace("--END--", "  END  ");
    let mut parser = Parser::new(lex(source, &text)?);
    let start = parser.token().span;
    let (numbered, properties) = properties(&mut parser)?;
    parser.expect("Init")?;
    parser.expect(":")?;
    let initial = numbers(&mut parser)?;
    parser.expect("BODY")?;
    let mut states: Vec<State> = Vec::new();
    let mut places: FxHashMap<i64, usize> = FxHashMap::default();
    while parser.eat("State") {
        let state = state(&mut parser, numbered, &properties)?;
        if places.insert(state.number, states.len()).is_some() {
            return wrong("duplicate-name", state.span, format!("a second state {}", state.number));
        }
        states.push(state);
        if states.len() > MAX_PARTS {
            return wrong("too-large", start, format!("more than {MAX_PARTS} states"));
        }
    }
    parser.expect("END")?;
    if parser.token().tok != Tok::Eof {
        return parser.fail("the end of the file");
    }
    let known = |(number, span): &(i64, Span)| match places.contains_key(number) {
        true => Ok(int(*number, *span)),
        false => wrong("unknown-name", *span, format!("there is no state {number}")),
    };
    let mut given = crate::build::Unique::default();
    properties.iter().for_each(|property| drop(given.name(&property.ident.name)));
    let own = given.name("state");
    let read = |span| name(&own, span);
    let every = states.iter().map(|state| int(state.number, state.span)).collect::<Vec<_>>();
    let Some(last) = states.last() else { return wrong("empty-range", start, "a system without states") };
    let ty = Type { kind: TypeKind::Values(every), span: start };
    let mut items = vec![Item::Var(Role::State, Ident { name: own.clone(), span: start }, ty)];
    let first = initial.iter().map(known).collect::<Parse<Vec<Expr>>>()?;
    items.push(assign(Moment::First, read(start), one_of(first, start)));
    let mut branches = Vec::new();
    for state in &states {
        if state.next.is_empty() {
            return wrong("syntax", state.span, format!("state {} has no successor", state.number));
        }
        let here = is(read(state.span), int(state.number, state.span), state.span);
        let next = state.next.iter().map(known).collect::<Parse<Vec<Expr>>>()?;
        branches.push((here, one_of(next, state.span)));
    }
    items.push(assign(Moment::Next, read(start), chosen(branches, last.span)));
    for (at, property) in properties.into_iter().enumerate() {
        let value = value(&property, at, &states, &read);
        items.push(Item::Define(property.ident, value));
    }
    Ok(main(items, start))
}

fn is(a: Expr, b: Expr, span: Span) -> Expr {
    crate::build::infix(Infix::Eq, a, b, span)
}

/// The value of the first branch that applies; one always does.
fn chosen(mut branches: Vec<(Expr, Expr)>, span: Span) -> Expr {
    match branches.pop() {
        Some((_, last)) if branches.is_empty() => last,
        Some((_, last)) => Expr::new(Kind::Case(branches, Some(Box::new(last))), span),
        None => truth(false, span),
    }
}

/// A property by the states in which it has each value.
fn value(property: &Property, at: usize, states: &[State], read: &dyn Fn(Span) -> Expr) -> Expr {
    let span = property.ident.span;
    let mut by_value: FxHashMap<i64, Vec<Expr>> = FxHashMap::default();
    for state in states {
        let value = state.values.get(&at).copied().unwrap_or(0);
        by_value.entry(value).or_default().push(int(state.number, state.span));
    }
    let mut values: Vec<(i64, Vec<Expr>)> = by_value.into_iter().collect();
    values.sort_unstable_by_key(|(value, states)| (states.len(), *value));
    let within = |states: Vec<Expr>| {
        crate::build::infix(Infix::In, read(span), Expr::new(Kind::Set(states), span), span)
    };
    if property.boolean {
        let holds = values.into_iter().find(|(value, _)| *value == 1);
        return holds.map_or(truth(false, span), |(_, states)| within(states));
    }
    chosen(values.into_iter().map(|(value, states)| (within(states), int(value, span))).collect(), span)
}

/// The properties, and whether states name them by number.
fn properties(parser: &mut Parser<'_>) -> Parse<(bool, Vec<Property>)> {
    let mut found = Vec::new();
    let numbered = parser.is("AP");
    if !numbered && !parser.is("Variables") {
        return parser.fail("`AP:` or `Variables:`");
    }
    parser.bump();
    parser.expect(":")?;
    while !parser.is("Init") {
        if numbered {
            found.push(Property { ident: text(parser)?, boolean: true });
            continue;
        }
        parser.expect("(")?;
        let ident = text(parser)?;
        let boolean = parser.eat("Bool");
        if !boolean {
            parser.expect("Int")?;
        }
        parser.expect(")")?;
        found.push(Property { ident, boolean });
    }
    Ok((numbered, found))
}

fn text(parser: &mut Parser<'_>) -> Parse<Ident> {
    if parser.token().tok != Tok::Text {
        return parser.fail("a name in quotes");
    }
    let token = parser.bump();
    Ok(Ident { name: token.text.trim_matches('"').to_owned(), span: token.span })
}

fn numbers(parser: &mut Parser<'_>) -> Parse<Vec<(i64, Span)>> {
    let mut found = Vec::new();
    while parser.token().tok == Tok::Number {
        found.push(number(parser)?);
    }
    if found.is_empty() { parser.fail("the number of a state") } else { Ok(found) }
}

fn number(parser: &mut Parser<'_>) -> Parse<(i64, Span)> {
    let minus = parser.eat("-");
    let token = parser.token();
    match token.text.parse::<i64>() {
        Ok(number) if token.tok == Tok::Number && number < 1 << 40 => {
            parser.bump();
            Ok((if minus { -number } else { number }, token.span))
        }
        _ => parser.fail("a number"),
    }
}

fn state(parser: &mut Parser<'_>, numbered: bool, properties: &[Property]) -> Parse<State> {
    parser.expect(":")?;
    let (own, span) = number(parser)?;
    parser.expect("{")?;
    let mut values = FxHashMap::default();
    while !parser.eat("}") {
        let (at, value) = if numbered {
            let (at, span) = number(parser)?;
            match usize::try_from(at).ok().filter(|at| *at < properties.len()) {
                Some(at) => (at, 1),
                None => return wrong("unknown-name", span, format!("there is no property {at}")),
            }
        } else {
            let open = parser.eat("(");
            let ident = text(parser)?;
            let Some(at) = properties.iter().position(|known| known.ident.name == ident.name) else {
                return wrong("unknown-name", ident.span, format!("no property `{}`", ident.name));
            };
            let value = match (open, parser.token().text) {
                (false, _) | (true, "true") => 1,
                (true, "false") => 0,
                (true, _) => number(parser)?.0,
            };
            if open {
                let _ = parser.eat("true") || parser.eat("false");
                parser.expect(")")?;
            }
            (at, value)
        };
        values.insert(at, value);
    }
    let mut next = Vec::new();
    while parser.token().tok == Tok::Number {
        next.push(number(parser)?);
    }
    Ok(State { number: own, span, values, next })
}
