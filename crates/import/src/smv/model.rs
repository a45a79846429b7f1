//! Modules put together: every instance's declarations with their full names.

use crate::parser::{MAX_WIDTH, Parse};
use crate::tree::{Expr, Infix, Item, Kind, Module, Moment, Role, Type, TypeKind, Word};
use hyperplan_syntax::ast::Ident;
use hyperplan_syntax::{Diagnostic, Span, similar};
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// More declarations than this, over all instances, are refused.
const MAX_SYMBOLS: usize = 1_000_000;

/// The type of a variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Ty {
    Bool,
    Int(i64, i64),
    /// Integers that are no range, sorted.
    Numbers(Rc<[i64]>),
    /// Symbols, perhaps numbers among them.
    Enum(Rc<[String]>),
    Word(Word),
}

#[derive(Clone, Debug)]
pub(crate) struct Var {
    pub(crate) role: Role,
    pub(crate) ty: Ty,
    pub(crate) span: Span,
    pub(crate) ty_span: Span,
}

#[derive(Clone, Debug)]
pub(crate) enum Symbol<'t> {
    Var(Var),
    Define(ScopeId, &'t Expr, Span),
    /// Elements have names of their own.
    Array(i64, i64, Span),
    Instance(ScopeId, Span),
}

impl Symbol<'_> {
    pub(crate) fn span(&self) -> Span {
        match self {
            Symbol::Var(var) => var.span,
            Symbol::Define(_, _, span) | Symbol::Array(_, _, span) | Symbol::Instance(_, span) => *span,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ScopeId(pub(crate) usize);

/// An instance of a module.
#[derive(Clone, Debug)]
pub(crate) struct Scope<'t> {
    /// What its names begin with, with the point.
    pub(crate) prefix: String,
    /// What stands for each parameter, and in which scope.
    pub(crate) params: FxHashMap<&'t str, (ScopeId, &'t Expr)>,
}

/// A whole model.
#[derive(Debug)]
pub(crate) struct Model<'t> {
    pub(crate) scopes: Vec<Scope<'t>>,
    /// By full name, in the order of declaration.
    pub(crate) symbols: IndexMap<String, Symbol<'t>>,
    /// Symbolic constants.
    pub(crate) constants: FxHashMap<String, Span>,
    pub(crate) assigns: Vec<(ScopeId, Moment, &'t Expr, &'t Expr)>,
    pub(crate) inits: Vec<(ScopeId, &'t Expr)>,
    pub(crate) transes: Vec<(ScopeId, &'t Expr)>,
    pub(crate) invars: Vec<(ScopeId, &'t Expr)>,
    /// The main module's name.
    pub(crate) span: Span,
    warnings: Vec<Diagnostic>,
}

impl<'t> Model<'t> {
    /// The model that some modules make.
    pub(crate) fn new(modules: &'t [Module], found: &mut Vec<Diagnostic>) -> Option<Model<'t>> {
        let mut by_name: FxHashMap<&str, &Module> = FxHashMap::default();
        for module in modules {
            if let Some(first) = by_name.insert(&module.name.name, module) {
                let message = format!("a second module `{}`", module.name.name);
                let error = Diagnostic::error("duplicate-name", module.name.span, message);
                found.push(error.with_related(first.name.span, "the first one"));
            }
        }
        let Some(main) = by_name.get("main") else {
            let span = modules.first()?.name.span;
            found.push(Diagnostic::error("no-module", span, "there is no module `main`"));
            return None;
        };
        let main_scope = Scope { prefix: String::new(), params: FxHashMap::default() };
        let mut model = Model {
            scopes: vec![main_scope],
            symbols: IndexMap::new(),
            constants: FxHashMap::default(),
            assigns: Vec::new(),
            inits: Vec::new(),
            transes: Vec::new(),
            invars: Vec::new(),
            span: main.name.span,
            warnings: Vec::new(),
        };
        let mut open = vec![(ScopeId(0), *main, 0)];
        let mut next = 0;
        while let Some(&(scope, module, depth)) = open.get(next) {
            next += 1;
            for item in &module.items {
                let added = model.item(scope, item, depth, &by_name);
                match added {
                    Ok(more) => open.extend(more),
                    Err(error) => found.push(*error),
                }
                if found.len() > 50 {
                    return None;
                }
            }
        }
        found.append(&mut model.warnings);
        Some(model)
    }

    /// Adds an item of an instance; and the instances that it declares.
    fn item(
        &mut self,
        scope: ScopeId,
        item: &'t Item,
        depth: u32,
        modules: &FxHashMap<&str, &'t Module>,
    ) -> Parse<Vec<(ScopeId, &'t Module, u32)>> {
        let prefix = self.scopes[scope.0].prefix.clone();
        match item {
            Item::Var(role, name, ty) => {
                return self.declare(scope, *role, prefix + &name.name, name.span, ty, (depth, modules));
            }
            Item::Define(name, body) => {
                self.add(prefix + &name.name, Symbol::Define(scope, body, name.span))?;
            }
            Item::Constants(names) => {
                self.constants.extend(names.iter().map(|name| (name.name.clone(), name.span)));
            }
            Item::Assign(moment, left, right) => self.assigns.push((scope, *moment, left, right)),
            Item::Init(e) => self.inits.push((scope, e)),
            Item::Trans(e) => self.transes.push((scope, e)),
            Item::Invar(e) => self.invars.push((scope, e)),
        }
        Ok(Vec::new())
    }

    fn add(&mut self, name: String, symbol: Symbol<'t>) -> Parse<()> {
        if self.symbols.len() >= MAX_SYMBOLS {
            let message = format!("more than {MAX_SYMBOLS} declarations once instances are made");
            return Err(Box::new(Diagnostic::error("too-large", symbol.span(), message)));
        }
        if let Some(first) = self.symbols.get(&name) {
            // HyperQB 2.0 has models that declare what they define.
            if matches!((first, &symbol), (Symbol::Var(_), Symbol::Define(..))) {
                let message =
                    format!("`{name}` is declared as a variable, and defined: it is what is defined");
                let warning = Diagnostic::warning("duplicate-name", symbol.span(), message);
                self.warnings.push(warning.with_related(first.span(), "the variable"));
                self.symbols.insert(name, symbol);
                return Ok(());
            }
            let error = Diagnostic::error("duplicate-name", symbol.span(), format!("a second `{name}`"));
            return Err(Box::new(error.with_related(first.span(), "the first one")));
        }
        self.symbols.insert(name, symbol);
        Ok(())
    }

    fn declare(
        &mut self,
        scope: ScopeId,
        role: Role,
        name: String,
        span: Span,
        ty: &'t Type,
        (depth, modules): (u32, &FxHashMap<&str, &'t Module>),
    ) -> Parse<Vec<(ScopeId, &'t Module, u32)>> {
        let ty_span = ty.span;
        let kind = match &ty.kind {
            TypeKind::Instance(module, arguments) => {
                return self.instance(scope, name, (span, ty_span), module, arguments, (depth, modules));
            }
            TypeKind::Array(lo, hi, of) => {
                let (lo, hi) = (self.number(scope, lo)?, self.number(scope, hi)?);
                if lo > hi || i128::from(hi) - i128::from(lo) >= MAX_SYMBOLS as i128 {
                    let message = format!("an array from {lo} to {hi} is empty, or too large");
                    return Err(Box::new(Diagnostic::error("empty-range", ty_span, message)));
                }
                self.add(name.clone(), Symbol::Array(lo, hi, span))?;
                let mut more = Vec::new();
                for at in lo..=hi {
                    more.extend(self.declare(
                        scope,
                        role,
                        format!("{name}[{at}]"),
                        span,
                        of,
                        (depth, modules),
                    )?);
                }
                return Ok(more);
            }
            TypeKind::Bool => Ty::Bool,
            TypeKind::Range(lo, hi) => {
                let (lo, hi) = (self.number(scope, lo)?, self.number(scope, hi)?);
                if lo > hi {
                    let error =
                        Diagnostic::error("empty-range", ty_span, format!("the range {lo}..{hi} is empty"));
                    return Err(Box::new(error));
                }
                Ty::Int(lo, hi)
            }
            TypeKind::Values(values) => self.values(scope, values, ty_span)?,
            TypeKind::Word(signed, width) => {
                let bits = self.number(scope, width)?;
                match u32::try_from(bits) {
                    Ok(width) if (1..=MAX_WIDTH).contains(&width) => {
                        Ty::Word(Word { signed: *signed, width })
                    }
                    _ => {
                        let message =
                            format!("words of {bits} bits are not supported; of 1 to {MAX_WIDTH} they are");
                        return Err(Box::new(Diagnostic::error("unsupported", width.span, message)));
                    }
                }
            }
        };
        self.add(name, Symbol::Var(Var { role, ty: kind, span, ty_span }))?;
        Ok(Vec::new())
    }

    /// Declares an instance of a module, whose items are to be added.
    fn instance(
        &mut self,
        scope: ScopeId,
        name: String,
        (span, ty_span): (Span, Span),
        module: &'t Ident,
        arguments: &'t [Expr],
        (depth, modules): (u32, &FxHashMap<&str, &'t Module>),
    ) -> Parse<Vec<(ScopeId, &'t Module, u32)>> {
        let Some(instance) = modules.get(module.name.as_str()) else {
            let message = format!("no module `{}`", module.name);
            let mut known: Vec<&str> = modules.keys().copied().collect();
            known.sort_unstable();
            let error = Diagnostic::error("unknown-name", module.span, message);
            return Err(Box::new(suggest(error, &module.name, known)));
        };
        if depth >= 64 {
            let message = "instances within instances, more than 64 of them: a module has itself inside";
            return Err(Box::new(Diagnostic::error("too-deep", span, message)));
        }
        if arguments.len() != instance.params.len() {
            let (takes, given) = (instance.params.len(), arguments.len());
            let message = format!("`{}` takes {takes} arguments, not {given}", module.name);
            let error = Diagnostic::error("argument-count", ty_span, message);
            return Err(Box::new(error.with_related(instance.name.span, "declared here")));
        }
        let id = ScopeId(self.scopes.len());
        let prefix = format!("{name}.");
        let mut params = FxHashMap::default();
        self.add(name, Symbol::Instance(id, span))?;
        for (param, argument) in instance.params.iter().zip(arguments) {
            match argument.kind {
                Kind::Name(_) | Kind::Bool(_) | Kind::Int(_) | Kind::Word(..) => {
                    params.insert(param.name.as_str(), (scope, argument));
                }
                // What is more than a name is a definition, which is shared by all who read it.
                _ => {
                    let define = Symbol::Define(scope, argument, argument.span);
                    self.add(format!("{prefix}{}", param.name), define)?;
                }
            }
        }
        self.scopes.push(Scope { prefix, params });
        Ok(vec![(id, instance, depth + 1)])
    }

    /// `{a, b, 3}`: numbers alone, or symbols.
    fn values(&mut self, scope: ScopeId, values: &'t [Expr], span: Span) -> Parse<Ty> {
        let mut numbers = Vec::new();
        let mut names = Vec::new();
        for value in values {
            if let Kind::Name(name) = &value.kind
                && name.access.is_empty()
                && !self.symbols.contains_key(&name.base)
            {
                self.constants.insert(name.base.clone(), value.span);
                names.push(name.base.clone());
            } else if matches!(value.kind, Kind::Bool(_)) {
                let message = "an enumeration of truth values is written `boolean`";
                return Err(Box::new(Diagnostic::error("unsupported", value.span, message)));
            } else {
                let number = self.number(scope, value)?;
                numbers.push(number);
                names.push(number.to_string());
            }
        }
        let mut sorted = names.clone();
        sorted.sort_unstable();
        if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(Box::new(Diagnostic::error("duplicate-name", span, "a value is listed twice")));
        }
        if numbers.len() < names.len() {
            return Ok(Ty::Enum(names.into()));
        }
        numbers.sort_unstable();
        let (lo, hi) = (numbers[0], numbers[numbers.len() - 1]);
        let run = i128::from(hi) - i128::from(lo) + 1 == numbers.len() as i128;
        Ok(if run { Ty::Int(lo, hi) } else { Ty::Numbers(numbers.into()) })
    }

    /// A constant integer, as the ends of ranges are. Recursion is bounded by the nesting of expressions, and by the
    /// depth of definitions that are read.
    pub(crate) fn number(&self, scope: ScopeId, e: &Expr) -> Parse<i64> {
        let limit = |n: i128| i64::try_from(n).ok().filter(|n| n.unsigned_abs() < 1 << 60);
        self.constant(scope, e, 0)
            .and_then(limit)
            .ok_or_else(|| Box::new(Diagnostic::error("not-constant", e.span, "expected a constant integer")))
    }

    fn constant(&self, scope: ScopeId, e: &Expr, depth: u32) -> Option<i128> {
        let of = |e: &Expr| self.constant(scope, e, depth);
        match &e.kind {
            Kind::Int(n) => Some(i128::from(*n)),
            Kind::Neg(a) => of(a).map(|a| -a),
            Kind::Sum(items) => items.iter().try_fold(0, |sum: i128, (minus, e)| {
                let n = of(e)?;
                sum.checked_add(if *minus { -n } else { n })
            }),
            Kind::Infix(Infix::Mul, a, b) => of(a)?.checked_mul(of(b)?),
            Kind::Infix(Infix::Div, a, b) => of(a)?.checked_div(of(b)?),
            Kind::Infix(Infix::Mod, a, b) => of(a)?.checked_rem(of(b)?),
            Kind::Name(_) if depth < 64 => match self.symbol(scope, e)? {
                (_, Symbol::Define(scope, body, _)) => self.constant(*scope, body, depth + 1),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Adds what was probably meant.
pub(crate) fn suggest<'n>(
    error: Diagnostic,
    name: &str,
    known: impl IntoIterator<Item = &'n str>,
) -> Diagnostic {
    match similar(name, known.into_iter()) {
        Some(found) => error.with_help(format!("did you mean `{found}`?")),
        None => error,
    }
}
