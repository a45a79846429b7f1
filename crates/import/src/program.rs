//! AutoHyper's Boolean programs: variables are vectors of bits, and each statement is a step.
//!
//! A program becomes a module with a variable `pc` for the statement that comes next and one for each bit, `h_0`. The steps are
//! those of AutoHyper: an assignment takes one, and so does finding out which way an `if` or a `while` goes; a
//! program that has ended stays as it is.

use crate::build::{MAX_PARTS, Unique, assign, boolean, infix, int, main, name, not, one_of, truth, wrong};
use crate::lexer::{Tok, lex};
use crate::parser::{Parse, Parser};
use crate::tree::{Expr, Infix, Item, Kind, Module, Moment, Role, Type, TypeKind};
use hyperplan_syntax::ast::Ident;
use hyperplan_syntax::{SourceId, Span};
use indexmap::IndexMap;

/// Statements nested more deeply are refused.
const MAX_NESTING: u32 = 100;

/// What a statement does, and where the program goes on.
enum Step {
    /// The bits of a variable; `None` for any.
    Assign(String, Option<Vec<Expr>>, usize),
    /// Where a condition holds, and where not; `None` for either.
    Branch(Option<Expr>, usize, usize),
}

struct Statement {
    span: Span,
    step: Step,
}

struct Program<'p, 't> {
    parser: &'p mut Parser<'t>,
    /// The names of the bits of each variable.
    bits: IndexMap<String, Vec<String>>,
    /// In the order in which they are written; places are filled in once they are known.
    statements: Vec<Statement>,
    depth: u32,
    /// Bits of all expressions so far.
    size: usize,
}

/// A program as a module.
pub(crate) fn parse(source: SourceId, text: &str) -> Parse<Vec<Module>> {
    let mut parser = Parser::new(lex(source, text)?);
    let start = parser.token().span;
    let mut unique = Unique::default();
    let mut items = Vec::new();
    let mut bits: IndexMap<String, Vec<String>> = IndexMap::new();
    while parser.token_at(1).text == ":" {
        let variable = parser.name("a variable")?;
        parser.expect(":")?;
        let width = number(&mut parser)?;
        parser.expect(";")?;
        let names: Vec<String> =
            (0..width).map(|at| unique.name(&format!("{}_{at}", variable.name))).collect();
        for name in &names {
            items.push(boolean(Role::State, Ident { name: name.clone(), span: variable.span }));
        }
        if items.len() > MAX_PARTS {
            return wrong("too-large", variable.span, format!("more than {MAX_PARTS} bits"));
        }
        if bits.insert(variable.name.clone(), names).is_some() {
            return wrong("duplicate-name", variable.span, format!("a second `{}`", variable.name));
        }
    }
    let mut program = Program { parser: &mut parser, bits, statements: Vec::new(), depth: 0, size: 0 };
    let open = program.block(&[])?;
    if program.parser.token().tok != Tok::Eof {
        return program.parser.fail("a statement or the end of the program");
    }
    let Program { bits, mut statements, .. } = program;
    let end = statements.len();
    open.into_iter().for_each(|hole| hole.fill(&mut statements, end));
    let pc = unique.name("pc");
    let read = |span| name(&pc, span);
    let range = TypeKind::Range(int(0, start), int(end as i64, start));
    let place = Ident { name: pc.clone(), span: start };
    items.push(Item::Var(Role::State, place, Type { kind: range, span: start }));
    items.push(assign(Moment::First, read(start), int(0, start)));
    let at = |number: usize, span| infix(Infix::Eq, read(span), int(number as i64, span), span);
    let go = |to: &usize, span| int(*to as i64, span);
    let mut branches = Vec::new();
    for (number, Statement { span, step }) in statements.iter().enumerate() {
        let next = match step {
            Step::Assign(_, _, to) => go(to, *span),
            Step::Branch(None, yes, no) if yes == no => go(yes, *span),
            Step::Branch(None, yes, no) => one_of(vec![go(yes, *span), go(no, *span)], *span),
            Step::Branch(Some(condition), yes, no) => {
                let branch = vec![(condition.clone(), go(yes, *span))];
                Expr::new(Kind::Case(branch, Some(Box::new(go(no, *span)))), *span)
            }
        };
        branches.push((at(number, *span), next));
    }
    items.push(assign(Moment::Next, read(start), case(branches, read(start), start)));
    for (variable, names) in &bits {
        for (bit, own) in names.iter().enumerate() {
            let mut branches = Vec::new();
            for (number, Statement { span, step }) in statements.iter().enumerate() {
                let Step::Assign(to, values, _) = step else { continue };
                if to == variable {
                    let any = || one_of(vec![truth(false, *span), truth(true, *span)], *span);
                    let value = values.as_ref().map_or_else(any, |values| values[bit].clone());
                    branches.push((at(number, *span), value));
                }
            }
            let here = || name(own, start);
            items.push(assign(Moment::First, here(), truth(false, start)));
            items.push(assign(Moment::Next, here(), case(branches, here(), start)));
        }
    }
    Ok(main(items, start))
}

fn case(branches: Vec<(Expr, Expr)>, last: Expr, span: Span) -> Expr {
    if branches.is_empty() { last } else { Expr::new(Kind::Case(branches, Some(Box::new(last))), span) }
}

fn number(parser: &mut Parser<'_>) -> Parse<usize> {
    let token = parser.token();
    match token.text.parse::<usize>() {
        Ok(number) if token.tok == Tok::Number && number <= 1000 => {
            parser.bump();
            Ok(number)
        }
        _ => parser.fail("a number of at most 1000"),
    }
}

/// A place in a statement that is to lead to whatever comes next.
#[derive(Clone, Copy)]
struct Hole {
    statement: usize,
    /// Of a branch, the one taken where the condition does not hold.
    other: bool,
}

impl Hole {
    fn fill(self, statements: &mut [Statement], to: usize) {
        match &mut statements[self.statement].step {
            Step::Assign(_, _, next) => *next = to,
            Step::Branch(_, yes, no) => *(if self.other { no } else { yes }) = to,
        }
    }
}

impl Program<'_, '_> {
    /// Statements up to `}` or the end, to the first of which some places lead; the places behind the last.
    fn block(&mut self, before: &[Hole]) -> Parse<Vec<Hole>> {
        let mut open = self.statement(before.to_vec())?;
        while !self.parser.is("}") && self.parser.token().tok != Tok::Eof {
            open = self.statement(open)?;
        }
        Ok(open)
    }

    fn braced(&mut self, before: &[Hole]) -> Parse<Vec<Hole>> {
        self.parser.expect("{")?;
        let open = self.block(before)?;
        self.parser.expect("}")?;
        Ok(open)
    }

    fn push(&mut self, before: Vec<Hole>, span: Span, step: Step) -> usize {
        let number = self.statements.len();
        before.into_iter().for_each(|hole| hole.fill(&mut self.statements, number));
        self.statements.push(Statement { span, step });
        number
    }

    fn statement(&mut self, before: Vec<Hole>) -> Parse<Vec<Hole>> {
        let start = self.parser.token().span;
        if self.depth >= MAX_NESTING {
            return wrong(
                "too-deep",
                start,
                format!("statements are nested more than {MAX_NESTING} levels deep"),
            );
        }
        self.depth += 1;
        let open = self.inside(before, start);
        self.depth -= 1;
        open
    }

    fn inside(&mut self, before: Vec<Hole>, start: Span) -> Parse<Vec<Hole>> {
        if self.parser.is("{") {
            return self.braced(&before);
        }
        let leading = |statement, other| Hole { statement, other };
        if self.parser.eat("SKIP") {
            self.parser.expect(";")?;
            let at = self.push(before, start, Step::Branch(None, 0, 0));
            return Ok(vec![leading(at, false), leading(at, true)]);
        }
        if self.parser.eat("while") {
            let condition = self.condition()?;
            let at = self.push(before, start, Step::Branch(Some(condition), 0, 0));
            let back = self.braced(&[leading(at, false)])?;
            back.into_iter().for_each(|hole| hole.fill(&mut self.statements, at));
            return Ok(vec![leading(at, true)]);
        }
        if self.parser.eat("if") {
            return self.branches(before, start);
        }
        let variable = self.parser.name("a statement")?;
        let Some(width) = self.bits.get(&variable.name).map(Vec::len) else {
            return wrong("unknown-name", variable.span, format!("no variable `{}`", variable.name));
        };
        self.parser.expect("=")?;
        let value = if self.parser.eat("*") { None } else { Some(self.expression(0)?) };
        if let Some(value) = value.as_ref().filter(|value| value.len() != width) {
            let message = format!("`{}` has {width} bits, and this has {}", variable.name, value.len());
            return wrong("type", self.parser.since(variable.span), message);
        }
        self.parser.expect(";")?;
        let at = self.push(before, start, Step::Assign(variable.name, value, 0));
        Ok(vec![leading(at, false)])
    }

    /// `if C { } elif C { } else { }`, behind the `if`. What is left out is a step that does nothing.
    fn branches(&mut self, before: Vec<Hole>, start: Span) -> Parse<Vec<Hole>> {
        let any = self.parser.eat("*");
        let condition = if any { None } else { Some(self.condition()?) };
        let at = self.push(before, start, Step::Branch(condition, 0, 0));
        let mut open = self.braced(&[Hole { statement: at, other: false }])?;
        let other = Hole { statement: at, other: true };
        if !any && self.parser.is("elif") {
            if self.depth >= MAX_NESTING {
                return wrong("too-deep", start, format!("more than {MAX_NESTING} ways"));
            }
            let start = self.parser.bump().span;
            self.depth += 1;
            let more = self.branches(vec![other], start);
            self.depth -= 1;
            open.extend(more?);
        } else if self.parser.eat("else") {
            open.extend(self.braced(&[other])?);
        } else if any {
            return self.parser.fail("`else`");
        } else {
            let at = self.push(vec![other], start, Step::Branch(None, 0, 0));
            open.extend([Hole { statement: at, other: false }, Hole { statement: at, other: true }]);
        }
        Ok(open)
    }

    fn condition(&mut self) -> Parse<Expr> {
        let start = self.parser.token().span;
        let mut value = self.expression(0)?;
        match value.pop() {
            Some(bit) if value.is_empty() => Ok(bit),
            _ => wrong(
                "type",
                self.parser.since(start),
                "a condition has one bit; `x[0]` is the first of several",
            ),
        }
    }

    /// The bits of an expression. An index belongs to all that stands before it, as in AutoHyper.
    fn expression(&mut self, least: u8) -> Parse<Vec<Expr>> {
        let start = self.parser.token().span;
        if self.depth >= MAX_NESTING {
            return wrong("too-deep", start, format!("nested more than {MAX_NESTING} levels deep"));
        }
        self.depth += 1;
        let value = self.operators(least);
        self.depth -= 1;
        let mut value = value?;
        if least == 0 && self.parser.eat("[") {
            let first = number(self.parser)?;
            let last = if self.parser.eat(",") { number(self.parser)? } else { first };
            self.parser.expect("]")?;
            if first > last || last >= value.len() {
                let message = format!("bits {first} to {last} of {} that there are", value.len());
                return wrong("type", self.parser.since(start), message);
            }
            value = value.drain(first..=last).collect();
        }
        Ok(value)
    }

    fn operators(&mut self, least: u8) -> Parse<Vec<Expr>> {
        let start = self.parser.token().span;
        let mut left = self.operand()?;
        loop {
            let level = match self.parser.token().text {
                "@" => 1,
                "|" => 2,
                "&" => 3,
                _ => return Ok(left),
            };
            if level < least.max(1) {
                return Ok(left);
            }
            self.parser.bump();
            let right = self.expression(level + 1)?;
            let span = self.parser.since(start);
            self.size += left.len() + right.len();
            if self.size > MAX_PARTS {
                return wrong("too-large", span, format!("more than {MAX_PARTS} bits in expressions"));
            }
            if level == 1 {
                left.extend(right);
                continue;
            }
            if left.len() != right.len() {
                let message = format!("{} bits here, and {} there", left.len(), right.len());
                return wrong("type", span, message);
            }
            let both = |(a, b)| {
                let pair = vec![a, b];
                Expr::new(if level == 2 { Kind::Or(pair) } else { Kind::And(pair) }, span)
            };
            left = left.into_iter().zip(right).map(both).collect();
        }
    }

    fn operand(&mut self) -> Parse<Vec<Expr>> {
        let token = self.parser.token();
        let span = token.span;
        match (token.tok, token.text) {
            (Tok::Sign, "!") => {
                self.parser.bump();
                let bits = self.expression(4)?;
                Ok(bits.into_iter().map(|bit| not(bit, span)).collect())
            }
            (Tok::Sign, "(") => {
                self.parser.bump();
                let bits = self.expression(0)?;
                self.parser.expect(")")?;
                Ok(bits)
            }
            (Tok::Number, _) => {
                let times = number(self.parser)?;
                self.parser.expect("*")?;
                let bits = self.expression(0)?;
                self.size += times * bits.len();
                if self.size > MAX_PARTS {
                    return wrong("too-large", span, format!("more than {MAX_PARTS} bits in expressions"));
                }
                Ok((0..times).flat_map(|_| bits.iter().cloned()).collect())
            }
            (Tok::Word, "true" | "t") if !self.bits.contains_key(token.text) => {
                self.parser.bump();
                Ok(vec![truth(true, span)])
            }
            (Tok::Word, "false" | "f") if !self.bits.contains_key(token.text) => {
                self.parser.bump();
                Ok(vec![truth(false, span)])
            }
            (Tok::Word, _) => {
                let variable = self.parser.name("a variable")?;
                match self.bits.get(&variable.name) {
                    Some(names) => Ok(names.iter().map(|bit| name(bit, span)).collect()),
                    None => wrong("unknown-name", span, format!("no variable `{}`", variable.name)),
                }
            }
            _ => self.parser.fail("an expression"),
        }
    }
}
