//! Expressions of SMV as expressions of the problem language.
//!
//! What the problem language lacks is said by what it has: words are integers, symbols of different enumerations are
//! compared value by value, quotients that round towards zero are chosen by sign, products and quotients of variables by
//! the values of one of them. Names of definitions stay names wherever a label can have their value.

mod arith;
mod calls;
mod sets;
mod symbols;
mod words;

use crate::Original;
use crate::names::Names;
use crate::parser::Parse;
use crate::smv::model::{Model, ScopeId, Symbol, Ty, suggest};
use crate::smv::resolve::Meaning;
use crate::tree::{Access, Expr, Infix, Kind, Name, Role, Word};
use hyperplan_syntax::ast::{self, CompareOp, ExprKind, Ident, Interval};
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
pub(crate) use sets::Choice;
use std::collections::BTreeMap;
use std::rc::Rc;
pub(crate) use symbols::Symbolic;

/// Nodes of one import; what would make more repeats itself.
const MAX_NODES: usize = 6_000_000;

/// Nesting of expressions once parameters and definitions are put in.
const MAX_DEPTH: u32 = 400;

/// An expression of the problem language with the type that it has in SMV.
#[derive(Clone, Debug)]
pub(crate) enum Val {
    Bool(ast::Expr),
    /// With bounds.
    Int(ast::Expr, i128, i128),
    Word(ast::Expr, Word),
    Symbol(Symbolic),
}

/// What a definition was found to be.
#[derive(Clone, Debug)]
pub(crate) enum Defined {
    /// A label of that type.
    Label(Shape),
    /// Written out wherever it is read: a set, or symbols that no enumeration has all of.
    WrittenOut,
}

/// A type with bounds.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Bool,
    Int(i128, i128),
    Word(Word),
    Symbol(Rc<[String]>),
}

/// A model with the names that it gets.
pub(crate) struct Named<'t> {
    pub(crate) model: Model<'t>,
    /// For each full name, that in the problem.
    pub(crate) names: FxHashMap<String, String>,
    pub(crate) defined: FxHashMap<String, Defined>,
}

impl<'t> Named<'t> {
    pub(crate) fn new(model: Model<'t>) -> Self {
        let mut given = Names::default();
        let readable = model.symbols.iter().filter(|(_, s)| matches!(s, Symbol::Var(_) | Symbol::Define(..)));
        let names = readable.map(|(name, _)| (name.clone(), given.name(name))).collect();
        Named { model, names, defined: FxHashMap::default() }
    }

    /// What variables are in the original.
    pub(crate) fn originals(&self) -> BTreeMap<String, Original> {
        let original = |(full, symbol): (&String, &Symbol<'t>)| {
            let Symbol::Var(var) = symbol else { return None };
            let word = match var.ty {
                Ty::Word(word) => Some((word.signed, word.width)),
                _ => None,
            };
            let input = var.role == Role::Input;
            Some((self.names.get(full)?.clone(), Original { name: full.clone(), word, input }))
        };
        self.model.symbols.iter().filter_map(original).collect()
    }
}

/// A path of a formula: its name, that in the problem, and its model.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    pub(crate) name: String,
    pub(crate) ident: Ident,
    pub(crate) model: usize,
}

/// Where an expression is read.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'p> {
    /// The model; in a formula, of the path.
    pub(crate) model: usize,
    pub(crate) scope: ScopeId,
    /// Inside `next(...)`.
    pub(crate) next: bool,
    pub(crate) path: Option<&'p Path>,
}

impl Place<'_> {
    /// In the main module of a model.
    pub(crate) fn main(model: usize) -> Self {
        Place { model, scope: ScopeId(0), next: false, path: None }
    }
}

/// Turns expressions of some models into those of the problem language.
pub(crate) struct Lower<'t> {
    pub(crate) models: Vec<Named<'t>>,
    /// The paths of the formula; none while models are read.
    pub(crate) paths: Vec<Path>,
    nodes: usize,
    depth: u32,
}

pub(crate) fn e(kind: ExprKind, span: Span) -> ast::Expr {
    ast::Expr { kind, span }
}

pub(crate) fn int(n: i128, span: Span) -> ast::Expr {
    let digits = e(ExprKind::Number(n.unsigned_abs().to_string()), span);
    if n < 0 { e(ExprKind::Neg(Box::new(digits)), span) } else { digits }
}

fn not(a: ast::Expr) -> ast::Expr {
    let span = a.span;
    match a.kind {
        ExprKind::Not(inside) => *inside,
        ExprKind::Bool(b) => e(ExprKind::Bool(!b), span),
        kind => e(ExprKind::Not(Box::new(e(kind, span))), span),
    }
}

fn compare(op: CompareOp, a: ast::Expr, b: ast::Expr, span: Span) -> ast::Expr {
    e(ExprKind::Compare(op, Box::new(a), Box::new(b)), span)
}

/// `if C then A else ... LAST`; a last value that is a choice itself belongs to the chain.
pub(crate) fn choice(mut branches: Vec<(ast::Expr, ast::Expr)>, last: ast::Expr, span: Span) -> ast::Expr {
    match last.kind {
        ExprKind::If(more, end) => {
            branches.extend(more);
            e(ExprKind::If(branches, end), span)
        }
        kind => e(ExprKind::If(branches, Box::new(e(kind, last.span))), span),
    }
}

pub(crate) fn wrong<T>(code: &'static str, span: Span, message: impl Into<String>) -> Parse<T> {
    Err(Box::new(Diagnostic::error(code, span, message)))
}

pub(crate) fn wrong_with<T>(
    code: &'static str,
    span: Span,
    message: impl Into<String>,
    help: impl Into<String>,
) -> Parse<T> {
    Err(Box::new(Diagnostic::error(code, span, message).with_help(help)))
}

impl Val {
    pub(crate) fn describe(&self) -> String {
        match self {
            Val::Bool(_) => "a truth value".to_owned(),
            Val::Int(..) => "an integer".to_owned(),
            Val::Word(_, word) => {
                format!("a word of {} bits", word.width)
            }
            Val::Symbol(_) => "a symbol".to_owned(),
        }
    }

    /// A number that is written.
    fn known(&self) -> Option<i128> {
        match self {
            Val::Int(_, lo, hi) if lo == hi => Some(*lo),
            _ => None,
        }
    }
}

impl<'t> Lower<'t> {
    pub(crate) fn new(models: Vec<Named<'t>>) -> Self {
        Lower { models, paths: Vec::new(), nodes: 0, depth: 0 }
    }

    /// Counts nodes that are made.
    pub(crate) fn count(&mut self, nodes: usize, span: Span) -> Parse<()> {
        self.nodes += nodes;
        if self.nodes <= MAX_NODES {
            return Ok(());
        }
        wrong("too-large", span, format!("more than {MAX_NODES} parts once all is written out"))
    }

    /// A truth value.
    pub(crate) fn truth(&mut self, place: Place<'_>, expr: &Expr) -> Parse<ast::Expr> {
        let value = self.value(place, expr)?;
        self.as_truth(value, expr.span)
    }

    fn as_truth(&mut self, value: Val, span: Span) -> Parse<ast::Expr> {
        match value {
            Val::Bool(a) => Ok(a),
            // Older models write truth values so.
            Val::Int(_, 0, 0) => Ok(e(ExprKind::Bool(false), span)),
            Val::Int(_, 1, 1) => Ok(e(ExprKind::Bool(true), span)),
            other => {
                wrong("type-mismatch", span, format!("expected a truth value, found {}", other.describe()))
            }
        }
    }

    /// An integer with its bounds.
    pub(crate) fn integer(&mut self, place: Place<'_>, expr: &Expr) -> Parse<(ast::Expr, i128, i128)> {
        match self.value(place, expr)? {
            Val::Int(a, lo, hi) => Ok((a, lo, hi)),
            other => {
                wrong("type-mismatch", expr.span, format!("expected an integer, found {}", other.describe()))
            }
        }
    }

    /// What an expression that is no set is.
    pub(crate) fn value(&mut self, place: Place<'_>, expr: &Expr) -> Parse<Val> {
        self.count(1, expr.span)?;
        if self.depth >= MAX_DEPTH {
            let message = "nested too deeply once parameters and definitions are put in";
            return wrong("too-deep", expr.span, message);
        }
        self.depth += 1;
        let value = self.value_inner(place, expr);
        self.depth -= 1;
        value
    }

    fn value_inner(&mut self, place: Place<'_>, expr: &Expr) -> Parse<Val> {
        let span = expr.span;
        let truth = |kind| Ok(Val::Bool(e(kind, span)));
        match &expr.kind {
            Kind::Bool(b) => truth(ExprKind::Bool(*b)),
            Kind::Int(n) => Ok(Val::Int(int(i128::from(*n), span), i128::from(*n), i128::from(*n))),
            Kind::Word(word, n) => Ok(Val::Word(int(i128::from(*n), span), *word)),
            Kind::Name(name) => self.name(place, name, span),
            Kind::Next(a) if place.next || place.path.is_some() || !self.paths.is_empty() => {
                wrong("misplaced-next", a.span, "`next` cannot stand here")
            }
            Kind::Next(a) => self.value(Place { next: true, ..place }, a),
            Kind::At(a, path) => {
                let Some(at) = self.paths.iter().find(|known| known.name == path.name).cloned() else {
                    return wrong("unknown-path", path.span, format!("no path `{}`", path.name));
                };
                self.value(Place { model: at.model, path: Some(&at), ..place }, a)
            }
            Kind::Not(a) => match self.value(place, a)? {
                Val::Word(a, word) => Ok(self.complement(a, word, span)),
                value => Ok(Val::Bool(not(self.as_truth(value, a.span)?))),
            },
            Kind::And(es) | Kind::Or(es) => self.junction(place, es, matches!(expr.kind, Kind::And(_)), span),
            Kind::Neg(a) => self.negated(place, a, span),
            Kind::Sum(items) => self.sum(place, items, span),
            Kind::Infix(infix, a, b) => self.infix(place, *infix, a, b, span),
            Kind::Case(branches, last) => self.case(place, branches, last.as_deref(), span),
            Kind::Call(name, arguments) => self.call(place, name, arguments, span),
            Kind::Set(members) if members.len() == 1 => self.value(place, &members[0]),
            Kind::Set(_) | Kind::Range(..) | Kind::Union(_) => wrong_with(
                "misplaced-set",
                span,
                "a set cannot stand here",
                "sets stand to the right of `:=` and `in`, alone or as values of a `case`",
            ),
            Kind::Unary(op, bounds, a) => {
                let a = self.truth(place, a)?;
                truth(ExprKind::Unary(*op, bounds.map(|b| interval(b, span)), Box::new(a)))
            }
            Kind::Binary(op, bounds, a, b) => {
                let (a, b) = (self.truth(place, a)?, self.truth(place, b)?);
                truth(ExprKind::Binary(*op, bounds.map(|b| interval(b, span)), Box::new(a), Box::new(b)))
            }
        }
    }

    fn junction(&mut self, place: Place<'_>, es: &[Expr], and: bool, span: Span) -> Parse<Val> {
        let values: Vec<Val> = es.iter().map(|e| self.value(place, e)).collect::<Parse<_>>()?;
        if let Val::Word(_, word) = values[0] {
            return self.bitwise(values, word, if and { Infix::Mul } else { Infix::Iff }, span);
        }
        let parts = values.into_iter().zip(es);
        let parts: Vec<ast::Expr> = parts.map(|(v, e)| self.as_truth(v, e.span)).collect::<Parse<_>>()?;
        Ok(Val::Bool(e(if and { ExprKind::And(parts) } else { ExprKind::Or(parts) }, span)))
    }

    fn infix(&mut self, place: Place<'_>, infix: Infix, a: &Expr, b: &Expr, span: Span) -> Parse<Val> {
        match infix {
            Infix::In => {
                let set = self.choice(place, b)?;
                let value = self.value(place, a)?;
                return self.member(value, set, span).map(Val::Bool);
            }
            Infix::Mul => return self.product(place, a, b, span),
            Infix::Div | Infix::Mod => return self.quotient(place, a, b, infix == Infix::Mod, span),
            Infix::ShiftLeft | Infix::ShiftRight | Infix::Concat => {
                return self.word_operator(place, infix, a, b, span);
            }
            _ => {}
        }
        let (left, right) = (self.value(place, a)?, self.value(place, b)?);
        let pair = |a: ast::Expr, b: ast::Expr| (Box::new(a), Box::new(b));
        match infix {
            Infix::Implies => {
                let (a, b) = pair(self.as_truth(left, a.span)?, self.as_truth(right, b.span)?);
                Ok(Val::Bool(e(ExprKind::Implies(a, b), span)))
            }
            Infix::Iff | Infix::Xor => {
                if let Val::Word(_, word) = left {
                    let values = vec![left, right];
                    return self.bitwise(values, word, Infix::Xor, span).map(|value| match (infix, value) {
                        (Infix::Iff, Val::Word(a, word)) => self.complement(a, word, span),
                        (_, value) => value,
                    });
                }
                // AutoHyper and HyperQB 1 compare numbers by it as well.
                if infix == Infix::Iff && !matches!((&left, &right), (Val::Bool(_), _) | (_, Val::Bool(_))) {
                    return self.equal(left, right, span).map(Val::Bool);
                }
                let (a, b) = pair(self.as_truth(left, a.span)?, self.as_truth(right, b.span)?);
                let iff = e(ExprKind::Iff(a, b), span);
                Ok(Val::Bool(if infix == Infix::Xor { not(iff) } else { iff }))
            }
            Infix::Eq => self.equal(left, right, span).map(Val::Bool),
            Infix::Ne => Ok(Val::Bool(not(self.equal(left, right, span)?))),
            _ => {
                let op = match infix {
                    Infix::Lt => CompareOp::Lt,
                    Infix::Le => CompareOp::Le,
                    Infix::Gt => CompareOp::Gt,
                    _ => CompareOp::Ge,
                };
                match (left, right) {
                    (Val::Int(a, ..), Val::Int(b, ..)) => Ok(Val::Bool(compare(op, a, b, span))),
                    (Val::Word(a, w), Val::Word(b, v)) if w == v => Ok(Val::Bool(compare(op, a, b, span))),
                    (Val::Word(a, _), Val::Int(b, lo, hi)) | (Val::Int(b, lo, hi), Val::Word(a, _))
                        if lo == hi =>
                    {
                        Ok(Val::Bool(compare(op, a, b, span)))
                    }
                    (left, right) => {
                        let (left, right) = (left.describe(), right.describe());
                        let message = format!("only numbers have an order, not {left} and {right}");
                        wrong("type-mismatch", span, message)
                    }
                }
            }
        }
    }

    /// Equality of two values of any type.
    pub(crate) fn equal(&mut self, a: Val, b: Val, span: Span) -> Parse<ast::Expr> {
        match (a, b) {
            (Val::Bool(a), Val::Bool(b)) => Ok(match (&a.kind, &b.kind) {
                (_, ExprKind::Bool(true)) => a,
                (ExprKind::Bool(true), _) => b,
                (_, ExprKind::Bool(false)) => not(a),
                (ExprKind::Bool(false), _) => not(b),
                _ => e(ExprKind::Iff(Box::new(a), Box::new(b)), span),
            }),
            (Val::Bool(a), known @ Val::Int(_, 0 | 1, _)) | (known @ Val::Int(_, 0 | 1, _), Val::Bool(a)) => {
                match known.known() {
                    Some(0) => Ok(not(a)),
                    Some(_) => Ok(a),
                    None => wrong("type-mismatch", span, "cannot compare a truth value with an integer"),
                }
            }
            (Val::Int(a, ..), Val::Int(b, ..)) => Ok(compare(CompareOp::Eq, a, b, span)),
            (Val::Word(a, w), Val::Word(b, v)) if w == v => Ok(compare(CompareOp::Eq, a, b, span)),
            (Val::Word(a, _), Val::Int(b, lo, hi)) | (Val::Int(b, lo, hi), Val::Word(a, _)) if lo == hi => {
                Ok(compare(CompareOp::Eq, a, b, span))
            }
            (Val::Symbol(a), Val::Symbol(b)) => self.same_symbol(a, b, span),
            (Val::Symbol(a), known @ Val::Int(..)) | (known @ Val::Int(..), Val::Symbol(a)) => {
                let Some(number) = known.known() else {
                    return wrong("type-mismatch", span, "cannot compare a symbol with an integer");
                };
                self.same_symbol(a, Symbolic::Constant(number.to_string()), span)
            }
            (a, b) => {
                let message = format!("cannot compare {} with {}", a.describe(), b.describe());
                wrong("type-mismatch", span, message)
            }
        }
    }

    fn case(
        &mut self,
        place: Place<'_>,
        branches: &[(Expr, Expr)],
        last: Option<&Expr>,
        span: Span,
    ) -> Parse<Val> {
        let mut conditions = Vec::with_capacity(branches.len());
        let mut values = Vec::with_capacity(branches.len());
        for (condition, value) in branches {
            conditions.push(self.truth(place, condition)?);
            values.push(self.value(place, value)?);
        }
        match last {
            Some(last) => values.push(self.value(place, last)?),
            // It has been read, and makes no difference.
            None => drop(conditions.pop()),
        }
        self.joined(conditions, values, span)
    }

    /// The value beside the first condition that holds, or the last.
    pub(crate) fn joined(
        &mut self,
        conditions: Vec<ast::Expr>,
        mut values: Vec<Val>,
        span: Span,
    ) -> Parse<Val> {
        // Numbers among symbols are symbols.
        if values.iter().any(|value| matches!(value, Val::Symbol(_))) {
            return self.joined_symbols(conditions, values, span);
        }
        // Truth values may be written as numbers.
        if values.iter().any(|value| matches!(value, Val::Bool(_))) {
            values =
                values.into_iter().map(|v| self.as_truth(v, span).map(Val::Bool)).collect::<Parse<_>>()?;
        }
        let mut whole = values.pop().unwrap_or_else(|| Val::Bool(e(ExprKind::Bool(false), span)));
        let mut kept = Vec::with_capacity(values.len());
        for (condition, value) in conditions.into_iter().zip(values) {
            let (value, joined) = match (value, whole) {
                (Val::Bool(a), Val::Bool(b)) => (a, Val::Bool(b)),
                (Val::Int(a, alo, ahi), Val::Int(b, lo, hi)) => (a, Val::Int(b, lo.min(alo), hi.max(ahi))),
                (Val::Word(a, w), Val::Word(b, v)) if w == v => (a, Val::Word(b, v)),
                (Val::Int(a, lo, hi), Val::Word(b, v)) if lo == hi => (a, Val::Word(b, v)),
                (a, b) => {
                    let message = format!("one case is {}, another {}", a.describe(), b.describe());
                    return wrong("type-mismatch", span, message);
                }
            };
            kept.push((condition, value));
            whole = joined;
        }
        Ok(match whole {
            Val::Bool(last) => Val::Bool(choice(kept, last, span)),
            Val::Int(last, lo, hi) => Val::Int(choice(kept, last, span), lo, hi),
            Val::Word(last, word) => Val::Word(choice(kept, last, span), word),
            Val::Symbol(_) => unreachable!("choices of symbols were joined above"),
        })
    }

    /// What a name is.
    fn name(&mut self, place: Place<'_>, name: &Name, span: Span) -> Parse<Val> {
        let named = &self.models[place.model];
        let meaning = match named.model.meaning(place.scope, name) {
            Some(Meaning::Symbol(full, symbol)) => (full.to_owned(), symbol.clone()),
            Some(Meaning::Argument(scope, argument)) => {
                return self.value(Place { scope, ..place }, argument);
            }
            Some(Meaning::Element(array, at)) => return self.element(place, name, &array, at, span),
            Some(Meaning::Bits(full, symbol)) => {
                let (full, symbol) = (full.to_owned(), symbol.clone());
                let word = self.symbol(place, &full, &symbol, span)?;
                return self.bits(place, word, name.access.last(), span);
            }
            Some(Meaning::Constant) => return Ok(Val::Symbol(Symbolic::Constant(name.base.clone()))),
            None => return Err(Box::new(self.unknown(place, name, span))),
        };
        self.symbol(place, &meaning.0, &meaning.1, span)
    }

    fn symbol(&mut self, place: Place<'_>, full: &str, symbol: &Symbol<'t>, span: Span) -> Parse<Val> {
        match symbol {
            Symbol::Var(var) => {
                let read = self.read(place, full, span)?;
                Ok(match &var.ty {
                    Ty::Bool => Val::Bool(read),
                    Ty::Int(lo, hi) => Val::Int(read, i128::from(*lo), i128::from(*hi)),
                    Ty::Numbers(all) => Val::Int(read, i128::from(all[0]), i128::from(all[all.len() - 1])),
                    Ty::Word(word) => Val::Word(read, *word),
                    Ty::Enum(values) => Val::Symbol(Symbolic::Read(read, values.clone())),
                })
            }
            Symbol::Define(scope, body, _) => match self.models[place.model].defined.get(full).cloned() {
                Some(Defined::Label(shape)) => {
                    let read = self.read(place, full, span)?;
                    Ok(match shape {
                        Shape::Bool => Val::Bool(read),
                        Shape::Int(lo, hi) => Val::Int(read, lo, hi),
                        Shape::Word(word) => Val::Word(read, word),
                        Shape::Symbol(values) => Val::Symbol(Symbolic::Read(read, values)),
                    })
                }
                // Errors in it are told where it stands.
                Some(Defined::WrittenOut) | None => self.value(Place { scope: *scope, ..place }, body),
            },
            Symbol::Array(..) | Symbol::Instance(..) => {
                let what =
                    if matches!(symbol, Symbol::Array(..)) { "an array" } else { "an instance of a module" };
                wrong("type-mismatch", span, format!("`{full}` is {what}, and has no value as a whole"))
            }
        }
    }

    /// The value of a variable or label.
    fn read(&mut self, place: Place<'_>, full: &str, span: Span) -> Parse<ast::Expr> {
        let name = self.models[place.model].names.get(full).cloned().unwrap_or_else(|| full.to_owned());
        let kind = match place.path {
            Some(path) => ExprKind::At(Ident { name, span }, vec![path.ident.clone()]),
            None if !self.paths.is_empty() => {
                let message = format!("of which path is `{full}`?");
                let help = format!("write `{full}[{}]`", self.paths[0].name);
                return wrong_with("unknown-path", span, message, help);
            }
            None if place.next => ExprKind::Primed(name),
            None => ExprKind::Name(name),
        };
        Ok(e(kind, span))
    }

    fn unknown(&self, place: Place<'_>, name: &Name, span: Span) -> Diagnostic {
        let model = &self.models[place.model].model;
        let mut full = name.base.clone();
        for access in &name.access {
            if let Access::Dot(part) = access {
                full += ".";
                full += part;
            }
        }
        let message = format!("no variable, definition or constant `{full}`");
        let error = Diagnostic::error("unknown-name", span, message);
        if let Some((first, _)) = full.split_once('-').filter(|(first, _)| {
            let alone = Name { base: (*first).to_owned(), access: Vec::new() };
            model.meaning(place.scope, &alone).is_some()
        }) {
            return error.with_help(format!("a hyphen is part of a name; write `{first} - ...` with blanks"));
        }
        if !self.paths.is_empty() && place.path.is_none() {
            return error
                .with_help(format!("what is read of a path is written `{full}[{}]`", self.paths[0].name));
        }
        let prefix = &model.scopes[place.scope.0].prefix;
        let known = model.symbols.keys().filter_map(|known| known.strip_prefix(prefix.as_str()));
        suggest(error, &full, known.chain(model.constants.keys().map(String::as_str)))
    }

    /// `a[i]` where i varies: by the values of i.
    fn element(&mut self, place: Place<'_>, name: &Name, array: &str, at: usize, span: Span) -> Parse<Val> {
        let bounds = match self.models[place.model].model.symbols.get(array) {
            Some(Symbol::Array(lo, hi, _)) => (*lo, *hi),
            _ => return wrong("type-mismatch", span, format!("`{array}` is no array")),
        };
        let Some(Access::Index(index)) = name.access.get(at) else {
            return wrong("type-mismatch", span, "an index was expected");
        };
        let (number, lo, hi) = self.integer(place, index)?;
        if lo < i128::from(bounds.0) || hi > i128::from(bounds.1) {
            let message =
                format!("the index may be {lo}..{hi}, and `{array}` has elements {}..{}", bounds.0, bounds.1);
            return wrong("out-of-range", index.span, message);
        }
        let (mut conditions, mut values) = (Vec::new(), Vec::new());
        for value in lo..=hi {
            let mut one = name.clone();
            one.access[at] = Access::Index(Expr::new(Kind::Int(value as i64), index.span));
            values.push(self.name(place, &one, span)?);
            if value < hi {
                let number = self.copy(&number)?;
                conditions.push(compare(CompareOp::Eq, number, int(value, span), span));
            }
        }
        self.joined(conditions, values, span)
    }

    /// A copy, which counts.
    pub(crate) fn copy(&mut self, expr: &ast::Expr) -> Parse<ast::Expr> {
        let mut size = 0;
        let mut stack = vec![expr];
        while let Some(expr) = stack.pop() {
            size += 1;
            push_children(expr, &mut stack);
        }
        self.count(size, expr.span)?;
        Ok(expr.clone())
    }
}

/// The parts of an expression that imports make.
fn push_children<'a>(expr: &'a ast::Expr, stack: &mut Vec<&'a ast::Expr>) {
    match &expr.kind {
        ExprKind::Not(a) | ExprKind::Neg(a) | ExprKind::Unary(_, _, a) | ExprKind::In(a, _) => stack.push(a),
        ExprKind::And(es) | ExprKind::Or(es) => stack.extend(es),
        ExprKind::Sum(es) => stack.extend(es.iter().map(|(_, e)| e)),
        ExprKind::Implies(a, b)
        | ExprKind::Iff(a, b)
        | ExprKind::Compare(_, a, b)
        | ExprKind::Arith(_, a, b)
        | ExprKind::Binary(_, _, a, b) => stack.extend([&**a, b]),
        ExprKind::If(branches, last) => {
            stack.extend(branches.iter().flat_map(|(c, a)| [c, a]).chain([&**last]))
        }
        _ => {}
    }
}

fn interval((lo, hi): (u32, u32), span: Span) -> Interval {
    let bound = |n: u32| Box::new(int(i128::from(n), span));
    Interval { lo: Some(bound(lo)), hi: bound(hi), span }
}
