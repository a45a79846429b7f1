//! A model as a system of the problem language.

use crate::lower::{Choice, Defined, Lower, Named, Place, Shape, Val, choice, e, int, wrong};
use crate::parser::Parse;
use crate::smv::model::{ScopeId, Symbol, Ty, Var};
use crate::smv::resolve::Meaning;
use crate::tree::{Expr, Kind, Moment, Role};
use hyperplan_syntax::ast::{
    Clause, ExprKind, Ident, Set, StateDecl, System, SystemItem, SystemKind, Type, Update, UpdateValue,
};
use hyperplan_syntax::{Diagnostic, Span, ast};
use rustc_hash::FxHashMap;

/// What is said of a variable's value, and where it stands.
type Assigned<'t> = FxHashMap<String, (ScopeId, &'t Expr, Span)>;

impl Named<'_> {
    /// Whether a definition is a label.
    pub(crate) fn is_label(&self, full: &str) -> bool {
        matches!(self.defined.get(full), Some(Defined::Label(_)))
    }
}

/// The system of a model; what is wrong goes to `found`.
pub(crate) fn system(
    lower: &mut Lower<'_>,
    model: usize,
    name: Ident,
    found: &mut Vec<Diagnostic>,
) -> System {
    let span = lower.models[model].model.span;
    let mut builder = Builder { lower, model, items: Vec::new(), updates: Vec::new(), found };
    builder.states();
    builder.definitions();
    let (first, next, every) = builder.assignments();
    builder.constraints(&every);
    builder.steps(&first, &next, &every);
    let Builder { mut items, updates, .. } = builder;
    let step = Ident { name: "step".to_owned(), span };
    items.push(SystemItem::On(Clause { actions: Some(vec![step]), guard: None, updates, span }));
    System { name, kind: SystemKind::Plain, items, span }
}

struct Builder<'l, 't, 'f> {
    lower: &'l mut Lower<'t>,
    model: usize,
    items: Vec<SystemItem>,
    updates: Vec<Update>,
    found: &'f mut Vec<Diagnostic>,
}

impl<'t> Builder<'_, 't, '_> {
    fn place(&self, scope: ScopeId) -> Place<'static> {
        Place { scope, ..Place::main(self.model) }
    }

    fn note<T>(&mut self, result: Parse<T>) -> Option<T> {
        match result {
            Ok(value) => Some(value),
            Err(error) => {
                if self.found.len() < 50 {
                    self.found.push(*error);
                }
                None
            }
        }
    }

    fn symbols(&self) -> Vec<(String, Symbol<'t>)> {
        let symbols = &self.lower.models[self.model].model.symbols;
        symbols.iter().map(|(name, symbol)| (name.clone(), symbol.clone())).collect()
    }

    fn vars(&self) -> Vec<(String, Var)> {
        let var = |(name, symbol)| match symbol {
            Symbol::Var(var) => Some((name, var)),
            _ => None,
        };
        self.symbols().into_iter().filter_map(var).collect()
    }

    fn ident(&self, full: &str, span: Span) -> Ident {
        let name = self.lower.models[self.model].names.get(full).cloned();
        Ident { name: name.unwrap_or_else(|| full.to_owned()), span }
    }

    /// A variable or, behind a step, what it is then.
    fn read(&self, full: &str, next: bool, span: Span) -> ast::Expr {
        let Ident { name, .. } = self.ident(full, span);
        e(if next { ExprKind::Primed(name) } else { ExprKind::Name(name) }, span)
    }

    fn states(&mut self) {
        for (full, var) in self.vars() {
            let number = |n: i64| int(i128::from(n), var.ty_span);
            let ty = match &var.ty {
                Ty::Bool => Type::Bool,
                Ty::Int(lo, hi) => Type::Range(number(*lo), number(*hi)),
                Ty::Numbers(all) => Type::Range(number(all[0]), number(all[all.len() - 1])),
                Ty::Word(word) => {
                    let (lo, hi) = word.bounds();
                    Type::Range(number(lo), number(hi))
                }
                Ty::Enum(values) => {
                    let value = |name: &String| Ident { name: name.clone(), span: var.ty_span };
                    Type::Enum(values.iter().map(value).collect())
                }
            };
            let name = self.ident(&full, var.span);
            self.items.push(SystemItem::State(vec![StateDecl { name, ty, ty_span: var.ty_span }]));
        }
    }

    /// Definitions, each after those that it reads.
    fn definitions(&mut self) {
        let defines: Vec<(String, ScopeId, &'t Expr, Span)> = self
            .symbols()
            .into_iter()
            .filter_map(|(name, symbol)| match symbol {
                Symbol::Define(scope, body, span) => Some((name, scope, body, span)),
                _ => None,
            })
            .collect();
        for at in self.order(&defines) {
            let (full, scope, body, span) = &defines[at];
            let label = self.definition(*scope, body);
            let defined = match self.note(label) {
                Some(Some((body, shape))) => {
                    let name = self.ident(full, *span);
                    self.items.push(SystemItem::Label(name, body));
                    Defined::Label(shape)
                }
                Some(None) => Defined::WrittenOut,
                // What was refused is not refused again where it is read.
                None => Defined::Label(Shape::Bool),
            };
            self.lower.models[self.model].defined.insert(full.clone(), defined);
        }
    }

    /// A label's expression and type, if a label can be that.
    fn definition(&mut self, scope: ScopeId, body: &'t Expr) -> Parse<Option<(ast::Expr, Shape)>> {
        let place = self.place(scope);
        without_next(body, "a definition")?;
        if self.lower.is_set(place, body, 0) {
            return Ok(None);
        }
        Ok(match self.lower.value(place, body)? {
            Val::Bool(a) => Some((a, Shape::Bool)),
            Val::Int(a, lo, hi) => Some((a, Shape::Int(lo, hi))),
            Val::Word(a, word) => Some((a, Shape::Word(word))),
            Val::Symbol(symbol) => match symbol.enumeration() {
                Some(of) => Some((self.lower.as_value_of(symbol, &of, body.span)?, Shape::Symbol(of))),
                None => None,
            },
        })
    }

    /// The order in which definitions are read: no recursion, however long their chains.
    fn order(&mut self, defines: &[(String, ScopeId, &'t Expr, Span)]) -> Vec<usize> {
        let model = &self.lower.models[self.model].model;
        let numbers: FxHashMap<&str, usize> =
            defines.iter().enumerate().map(|(at, define)| (define.0.as_str(), at)).collect();
        let reads: Vec<Vec<usize>> = defines
            .iter()
            .map(|(_, scope, body, _)| {
                let mut read = Vec::new();
                let mut stack = vec![(*scope, *body, 0)];
                while let Some((scope, e, depth)) = stack.pop() {
                    e.kind.for_each_child(&mut |child| stack.push((scope, child, depth)));
                    let Kind::Name(name) = &e.kind else { continue };
                    match model.meaning(scope, name) {
                        Some(Meaning::Symbol(full, _) | Meaning::Bits(full, _)) => {
                            read.extend(numbers.get(full))
                        }
                        Some(Meaning::Argument(scope, argument)) if depth < 100 => {
                            stack.push((scope, argument, depth + 1));
                        }
                        // Elements of arrays of definitions are not told apart here; they are read all.
                        Some(Meaning::Element(..) | Meaning::Argument(..) | Meaning::Constant) | None => {}
                    }
                }
                read
            })
            .collect();
        let mut done = vec![0u8; defines.len()];
        let mut order = Vec::with_capacity(defines.len());
        let mut cyclic = None;
        for start in 0..defines.len() {
            let mut stack = vec![(start, 0)];
            while let Some((at, next)) = stack.pop() {
                if next == 0 && done[at] == 2 {
                    continue;
                }
                done[at] = 1;
                match reads[at].get(next) {
                    Some(&read) => {
                        stack.push((at, next + 1));
                        match done[read] {
                            0 => stack.push((read, 0)),
                            1 => cyclic = cyclic.or(Some(at)),
                            _ => {}
                        }
                    }
                    None => {
                        done[at] = 2;
                        order.push(at);
                    }
                }
            }
        }
        if let Some(at) = cyclic {
            let (name, _, _, span) = &defines[at];
            let message = format!("the definition of `{name}` reads itself, directly or not");
            self.found.push(Diagnostic::error("cyclic-define", *span, message));
            return Vec::new();
        }
        order
    }

    /// What is assigned to each variable at first, by a step, and always.
    fn assignments(&mut self) -> (Assigned<'t>, Assigned<'t>, Assigned<'t>) {
        let (mut first, mut next, mut every) =
            (Assigned::default(), Assigned::default(), Assigned::default());
        let assigns = self.lower.models[self.model].model.assigns.clone();
        for (scope, moment, left, right) in assigns {
            let target = self.target(scope, left, moment);
            let Some(full) = self.note(target) else { continue };
            let table = match moment {
                Moment::First => &mut first,
                Moment::Next => &mut next,
                Moment::Every => &mut every,
            };
            if let Some((_, _, earlier)) = table.insert(full.clone(), (scope, right, left.span)) {
                let error = Diagnostic::error(
                    "repeated-update",
                    left.span,
                    format!("a second assignment to `{full}`"),
                );
                self.found.push(error.with_related(earlier, "the first one"));
            }
        }
        let mut twice: Vec<_> = every.iter().collect();
        twice.sort_unstable_by_key(|(_, (_, _, span))| span.start);
        for (full, (_, _, span)) in twice {
            if let Some((_, _, other)) = first.get(full).or(next.get(full)) {
                let message = format!("`{full}` is assigned always, and also by `init` or `next`");
                self.found
                    .push(Diagnostic::error("repeated-update", *span, message).with_related(*other, "here"));
            }
        }
        (first, next, every)
    }

    fn target(&mut self, scope: ScopeId, left: &Expr, moment: Moment) -> Parse<String> {
        let model = &self.lower.models[self.model].model;
        match model.symbol(scope, left) {
            Some((full, Symbol::Var(var))) => match (var.role, moment) {
                (Role::Input, _) => wrong(
                    "unsupported",
                    left.span,
                    format!("`{full}` is an input: nothing is assigned to it"),
                ),
                (Role::Frozen, Moment::Next | Moment::Every) => {
                    wrong("unsupported", left.span, format!("`{full}` is frozen: it never changes"))
                }
                _ => Ok(full.to_owned()),
            },
            Some((full, _)) => wrong("not-a-variable", left.span, format!("`{full}` is no variable")),
            None => {
                // The message is that of reading it.
                let place = self.place(scope);
                self.lower.value(place, left)?;
                wrong("not-a-variable", left.span, "this is no variable")
            }
        }
    }

    /// `INIT`, `INVAR`, `TRANS`, and what is assigned always.
    fn constraints(&mut self, every: &Assigned<'t>) {
        let model = &self.lower.models[self.model].model;
        let (inits, invars, transes) = (model.inits.clone(), model.invars.clone(), model.transes.clone());
        for (scope, constraint) in inits {
            let place = self.place(scope);
            let plain = without_next(constraint, "`INIT`");
            let truth = plain.and_then(|()| self.lower.truth(place, constraint));
            if let Some(said) = self.note(truth) {
                self.items.push(SystemItem::Init(said));
            }
        }
        for (scope, constraint) in invars {
            let place = self.place(scope);
            let plain = without_next(constraint, "`INVAR`");
            let truth = plain.and_then(|()| self.lower.truth(place, constraint));
            let Some(now) = self.note(truth) else { continue };
            self.items.push(SystemItem::Init(now));
            let later = self.lower.truth(Place { next: true, ..place }, constraint);
            if let Some(said) = self.note(later) {
                self.items.push(SystemItem::Trans(said));
            }
        }
        for (scope, constraint) in transes {
            let place = self.place(scope);
            let truth = self.lower.truth(place, constraint);
            if let Some(said) = self.note(truth) {
                self.items.push(SystemItem::Trans(said));
            }
        }
        let mut always: Vec<_> = every.iter().collect();
        always.sort_unstable_by_key(|(_, (_, _, span))| span.start);
        for (full, (scope, value, span)) in always {
            for next in [false, true] {
                let place = Place { next, ..self.place(*scope) };
                let holds = self.is_assigned(place, full, value, *span, next);
                let Some(holds) = self.note(holds) else { break };
                self.items.push(if next { SystemItem::Trans(holds) } else { SystemItem::Init(holds) });
            }
        }
    }

    /// That a variable, now or after a step, has a value that is assigned to it.
    fn is_assigned(
        &mut self,
        place: Place<'_>,
        full: &str,
        value: &Expr,
        span: Span,
        next: bool,
    ) -> Parse<ast::Expr> {
        let set = self.lower.choice(place, value)?;
        let read = self.read(full, next, span);
        let read = match self.var(full) {
            Ty::Bool => Val::Bool(read),
            Ty::Int(lo, hi) => Val::Int(read, i128::from(lo), i128::from(hi)),
            Ty::Numbers(all) => Val::Int(read, i128::from(all[0]), i128::from(all[all.len() - 1])),
            Ty::Word(word) => Val::Word(read, word),
            Ty::Enum(of) => Val::Symbol(crate::lower::Symbolic::Read(read, of)),
        };
        self.lower.member(read, set, value.span)
    }

    fn var(&self, full: &str) -> Ty {
        match self.lower.models[self.model].model.symbols.get(full) {
            Some(Symbol::Var(var)) => var.ty.clone(),
            _ => Ty::Bool,
        }
    }

    /// Initial values, and the one clause: what becomes of each variable.
    fn steps(&mut self, first: &Assigned<'t>, next: &Assigned<'t>, every: &Assigned<'t>) {
        for (full, var) in self.vars() {
            if let Some((scope, value, span)) = first.get(&full) {
                let place = self.place(*scope);
                let holds = self.is_assigned(place, &full, value, *span, false);
                let holds = self.note(holds);
                self.items.extend(holds.filter(|e| e.kind != ExprKind::Bool(true)).map(SystemItem::Init));
            }
            if let Ty::Numbers(all) = &var.ty {
                let set = |read| {
                    let members = all.iter().map(|n| int(i128::from(*n), var.ty_span)).collect();
                    e(ExprKind::In(Box::new(read), Set::List(members, var.ty_span)), var.ty_span)
                };
                self.items.push(SystemItem::Init(set(self.read(&full, false, var.ty_span))));
                if next.contains_key(&full) {
                    self.items.push(SystemItem::Trans(set(self.read(&full, true, var.ty_span))));
                }
            }
            if var.role == Role::Frozen {
                continue;
            }
            let (value, span) = match next.get(&full) {
                Some((scope, value, span)) if !value.reads_next => {
                    let place = self.place(*scope);
                    let value = self.update(place, value, &var.ty);
                    (self.note(value), *span)
                }
                Some((scope, value, span)) => {
                    let place = self.place(*scope);
                    let holds = self.is_assigned(place, &full, value, *span, true);
                    if let Some(said) = self.note(holds) {
                        self.items.push(SystemItem::Trans(said));
                    }
                    (Some(anything(&var)), var.span)
                }
                None => {
                    let span = every.get(&full).map_or(var.span, |(_, _, span)| *span);
                    (Some(anything(&var)), span)
                }
            };
            let Some(value) = value else { continue };
            // What keeps its value needs no update.
            let name = self.ident(&full, span);
            if matches!(&value, UpdateValue::Assign(ast::Expr { kind: ExprKind::Name(kept), .. }) if *kept == name.name)
            {
                continue;
            }
            self.updates.push(Update { var: name, value });
        }
    }

    fn update(&mut self, place: Place<'_>, value: &Expr, ty: &Ty) -> Parse<UpdateValue> {
        let set = self.lower.choice(place, value)?;
        if set.is_single() {
            return Ok(UpdateValue::Assign(self.single(set, ty, value.span)?));
        }
        Ok(UpdateValue::Choose(self.chosen(set, ty, value.span)?))
    }

    fn single(&mut self, set: Choice, ty: &Ty, span: Span) -> Parse<ast::Expr> {
        match set {
            Choice::Values(mut values) if values.len() == 1 => self.of_type(values.remove(0), ty, span),
            Choice::If(branches, last) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, set) in branches {
                    kept.push((condition, self.single(set, ty, span)?));
                }
                Ok(choice(kept, self.single(*last, ty, span)?, span))
            }
            Choice::Values(_) | Choice::Range(..) => wrong("misplaced-set", span, "a set cannot stand here"),
        }
    }

    fn chosen(&mut self, set: Choice, ty: &Ty, span: Span) -> Parse<Set> {
        Ok(match set {
            Choice::Values(values) => {
                let values = values.into_iter().map(|value| self.of_type(value, ty, span));
                Set::List(values.collect::<Parse<_>>()?, span)
            }
            Choice::Range(ends) if matches!(ty, Ty::Int(..) | Ty::Numbers(_)) => {
                let [(lo, ..), (hi, ..)] = *ends;
                Set::Range(Box::new(lo), Box::new(hi))
            }
            Choice::Range(..) => return wrong("type-mismatch", span, "a range is of integers"),
            Choice::If(branches, last) => {
                let mut kept = Vec::with_capacity(branches.len());
                for (condition, set) in branches {
                    kept.push((condition, self.chosen(set, ty, span)?));
                }
                Set::If(kept, Box::new(self.chosen(*last, ty, span)?), span)
            }
        })
    }

    /// A value as one of a variable's type. Integers outside its range make no step.
    fn of_type(&mut self, value: Val, ty: &Ty, span: Span) -> Parse<ast::Expr> {
        let expected = match (value, ty) {
            // Integers outside the range make no step.
            (Val::Bool(a), Ty::Bool) | (Val::Int(a, ..), Ty::Int(..) | Ty::Numbers(_)) => return Ok(a),
            (Val::Int(_, 0, 0), Ty::Bool) => return Ok(e(ExprKind::Bool(false), span)),
            (Val::Int(_, 1, 1), Ty::Bool) => return Ok(e(ExprKind::Bool(true), span)),
            (Val::Word(a, own), Ty::Word(word)) if own == *word => return Ok(a),
            (Val::Int(a, lo, hi), Ty::Word(_)) if lo == hi => return Ok(a),
            (Val::Symbol(symbol), Ty::Enum(of)) => return self.lower.as_value_of(symbol, of, span),
            (Val::Int(_, lo, hi), Ty::Enum(of)) if lo == hi => {
                let symbol = crate::lower::Symbolic::Constant(lo.to_string());
                return self.lower.as_value_of(symbol, of, span);
            }
            (other, _) => other.describe(),
        };
        wrong("type-mismatch", span, format!("{expected} is not of the variable's type"))
    }
}

/// Any value of the variable's type.
fn anything(var: &Var) -> UpdateValue {
    let span = var.span;
    let number = |n: i64| Box::new(int(i128::from(n), span));
    UpdateValue::Choose(match &var.ty {
        Ty::Bool => Set::List([false, true].map(|b| e(ExprKind::Bool(b), span)).into(), span),
        Ty::Int(lo, hi) => Set::Range(number(*lo), number(*hi)),
        Ty::Word(word) => Set::Range(number(word.bounds().0), number(word.bounds().1)),
        Ty::Numbers(all) => Set::List(all.iter().map(|n| int(i128::from(*n), span)).collect(), span),
        Ty::Enum(of) => {
            let value = |name: &String| match hyperplan_syntax::is_name(name) {
                true => e(ExprKind::Name(name.clone()), span),
                false => e(ExprKind::Text(name.clone()), span),
            };
            Set::List(of.iter().map(value).collect(), span)
        }
    })
}

/// Refuses `next` where no step is spoken of.
fn without_next(expr: &Expr, what: &str) -> Parse<()> {
    if !expr.reads_next {
        return Ok(());
    }
    let message = format!("{what} speaks of one state, and `next` of the one after it");
    let help = "`next` belongs into `TRANS`, and to the right of `next(x) :=`";
    crate::lower::wrong_with("misplaced-next", expr.span, message, help)
}
