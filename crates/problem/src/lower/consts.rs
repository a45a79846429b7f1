//! Constants: numbers, known when the file is read.

use super::diagnostics::{Diagnostics, suggest};
use super::expr::{Context, integer, numeric};
use super::fractions;
use super::labels::cyclic;
use super::limits::Limits;
use super::order;
use super::typed::{EnumType, Typed, known_int};
use super::walk::visit;
use crate::expr::{Expr, Value};
use hyperplan_syntax::ast::{self, ExprKind, Ident, Item};
use hyperplan_syntax::{Diagnostic, Span};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::convert::Infallible;

/// Values that replace those of constants in the file (`--set NAME=VALUE`).
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Names and the texts of their values; of two for one name the later counts.
    pub values: Vec<(String, String)>,
}

impl Overrides {
    /// No constant is replaced.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// With one more replaced constant.
    #[must_use]
    pub fn with(mut self, name: impl Into<String>, value: impl ToString) -> Self {
        self.values.push((name.into(), value.to_string()));
        self
    }
}

/// A constant, or a parameter of a template that stands for a number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constant {
    /// An integer or a real; `None` where its value was refused already.
    pub(crate) value: Option<Value>,
    pub(crate) span: Span,
}

/// The constants of a file, in its order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Consts {
    by_name: IndexMap<String, Constant>,
}

impl Consts {
    pub(crate) fn get(&self, name: &str) -> Option<Constant> {
        self.by_name.get(name).copied()
    }

    /// As an expression; `Some(None)` where the value was refused.
    pub(crate) fn typed<L>(&self, name: &str) -> Option<Option<Typed<L>>> {
        Some(match self.get(name)?.value {
            Some(Value::Int(n)) => Some(Typed::int(n)),
            Some(Value::Real(r)) => Some(Typed::real(r)),
            _ => None,
        })
    }

    /// Adds or hides.
    pub(crate) fn insert(&mut self, name: &str, constant: Constant) {
        self.by_name.insert(name.to_owned(), constant);
    }

    /// Names and values.
    pub(crate) fn values(&self) -> Vec<(String, Value)> {
        self.by_name.iter().filter_map(|(name, constant)| Some((name.clone(), constant.value?))).collect()
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().map(String::as_str)
    }

    /// The value of a constant integer expression, or `None` after a message.
    pub(crate) fn evaluate(&self, e: &ast::Expr, diagnostics: &mut Diagnostics) -> Option<i64> {
        let mut cx = ConstContext { consts: self, diagnostics, limits: Limits::default() };
        let (value, _) = integer(&mut cx, e)?;
        known_int(&value)
    }

    /// The value of a constant expression, an integer or a real, or `None` after a message.
    pub(crate) fn number(&self, e: &ast::Expr, diagnostics: &mut Diagnostics) -> Option<Value> {
        let mut cx = ConstContext { consts: self, diagnostics, limits: Limits::default() };
        let (Typed::Int(value, _) | Typed::Real(value)) = numeric(&mut cx, e)?.typed() else { return None };
        if let Expr::Const(value) = value { Some(value) } else { None }
    }
}

/// Evaluates the constants of a file, with replacements. A constant may read constants declared after it.
pub(crate) fn constants(file: &ast::File, overrides: &Overrides, diagnostics: &mut Diagnostics) -> Consts {
    let replaced = read_overrides(file, overrides, diagnostics);
    let declared = declared(file, diagnostics);
    let mut consts = Consts::default();
    for constant in &declared {
        consts.insert(&constant.name.name, Constant { value: None, span: constant.name.span });
    }
    let indices: FxHashMap<&str, usize> =
        declared.iter().enumerate().map(|(index, constant)| (constant.name.name.as_str(), index)).collect();
    let reads = |constant: &&ast::Const| {
        let mut read = Vec::new();
        // A replaced constant reads nothing.
        if !replaced.contains_key(constant.name.name.as_str()) {
            visit(&constant.value, &mut |e| {
                if let ExprKind::Name(name) = &e.kind {
                    read.extend(indices.get(name.as_str()));
                }
            });
        }
        read.sort_unstable();
        read.dedup();
        read
    };
    let order = order::sort(&declared.iter().map(reads).collect::<Vec<_>>());
    let named = |index: &usize| (declared[*index].name.name.as_str(), declared[*index].name.span);
    if let Some(diagnostic) = cyclic("constant", "cyclic-constant", order.cycle.iter().map(named).collect()) {
        diagnostics.push(diagnostic);
    }
    for index in order.sorted {
        let constant = declared[index];
        let value = match replaced.get(constant.name.name.as_str()) {
            Some(value) => *value,
            None => consts.number(&constant.value, diagnostics),
        };
        consts.insert(&constant.name.name, Constant { value, span: constant.name.span });
    }
    consts
}

/// The declarations of constants; a second one of a name is reported and left out.
fn declared<'a>(file: &'a ast::File, diagnostics: &mut Diagnostics) -> Vec<&'a ast::Const> {
    let mut places: FxHashMap<&str, Span> = FxHashMap::default();
    let mut declared = Vec::new();
    for item in &file.items {
        let Item::Const(constant) = item else { continue };
        let name = &constant.name;
        match places.get(name.name.as_str()) {
            Some(first) => diagnostics.push(duplicate("constant", name, *first)),
            None => {
                places.insert(&name.name, name.span);
                declared.push(constant);
            }
        }
    }
    declared
}

/// The message about a name that is declared twice.
pub(crate) fn duplicate(what: &str, name: &ast::Ident, first: Span) -> Diagnostic {
    Diagnostic::error("duplicate-name", name.span, format!("the {what} `{}` exists already", name.name))
        .with_related(first, "declared here")
}

fn read_overrides<'a>(
    file: &ast::File,
    overrides: &'a Overrides,
    diagnostics: &mut Diagnostics,
) -> FxHashMap<&'a str, Option<Value>> {
    let declared: Vec<&str> = file
        .items
        .iter()
        .filter_map(|item| if let Item::Const(c) = item { Some(c.name.name.as_str()) } else { None })
        .collect();
    let mut replaced = FxHashMap::default();
    for (name, text) in &overrides.values {
        if !declared.contains(&name.as_str()) {
            let message = format!("no constant `{name}` to set");
            let diagnostic = Diagnostic::error_nowhere("unknown-constant", message);
            diagnostics.push(suggest(diagnostic, name, declared.iter().copied()));
            continue;
        }
        let value = fractions::number(text.trim());
        if value.is_none() {
            let message = format!(
                "cannot set `{name}` to `{text}`: not a number, such as 8 or 1/4, of at most 62 bits"
            );
            diagnostics.push(Diagnostic::error_nowhere("not-a-number", message));
        }
        replaced.insert(name.as_str(), value);
    }
    replaced
}

/// Where only constants have a meaning.
struct ConstContext<'a> {
    consts: &'a Consts,
    diagnostics: &'a mut Diagnostics,
    limits: Limits,
}

impl Context for ConstContext<'_> {
    type Leaf = Infallible;

    fn parts(&mut self) -> (&mut Diagnostics, &mut Limits) {
        (self.diagnostics, &mut self.limits)
    }

    fn resolve(&mut self, name: &str) -> Option<Option<Typed<Infallible>>> {
        self.consts.typed(name)
    }

    fn unknown(&mut self, name: &str, span: Span) -> Diagnostic {
        let diagnostic = Diagnostic::error("unknown-name", span, format!("no constant `{name}`"));
        if self.consts.by_name.is_empty() {
            return diagnostic.with_help(format!("declare it: `const {name} = ...;`"));
        }
        suggest(diagnostic, name, self.consts.names())
    }

    fn at(&mut self, name: &Ident, _paths: &[Ident], span: Span) -> Option<Typed<Infallible>> {
        self.varies(&name.name, span)
    }

    fn call(
        &mut self,
        name: &Ident,
        _args: &[Ident],
        _hint: Option<&EnumType>,
        span: Span,
    ) -> Option<Typed<Infallible>> {
        self.varies(&name.name, span)
    }
}

impl ConstContext<'_> {
    fn varies(&mut self, name: &str, span: Span) -> Option<Typed<Infallible>> {
        let message = format!("expected a constant; `{name}` of a path varies");
        self.error(Diagnostic::error("not-constant", span, message))
    }
}
