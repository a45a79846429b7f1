//! Prints one term, iteratively. Terms that are named at the top are printed as their names; under
//! a binder, shared terms that depend on its variables are bound by `let`.

use std::io;

use rsmt2::SmtRes;
use rsmt2::print::{Expr2Smt, Sort2Smt as _, Sym2Smt};
use rustc_hash::{FxHashMap, FxHashSet};

use super::free::Free;
use super::io_error;
use crate::name::{SortName, SymbolName, write_number};
use crate::term::{Op, Term};
use crate::terms::{Terms, View};
use crate::value::Value;

/// The name of a shared term: `$` and its index, after the number of its series, if that is not 0. Symbols never look
/// like that.
pub(crate) struct SharedName {
    pub(crate) series: u32,
    pub(crate) term: Term,
}

impl Sym2Smt for SharedName {
    fn sym_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        w.write_all(b"$")?;
        if self.series > 0 {
            write_number(w, self.series.into())?;
            w.write_all(b".")?;
        }
        Ok(write_number(w, self.term.index() as u64)?)
    }
}

/// A term for printing.
pub(crate) struct Expression<'a> {
    pub(crate) terms: &'a Terms,
    /// The free variables, if anything is quantified.
    pub(crate) free: Option<&'a Free>,
    /// Per node, whether a definition has named it.
    pub(crate) named: &'a [bool],
    pub(crate) term: Term,
    /// The series of names.
    pub(crate) series: u32,
    /// Print the node itself even if it is named: this is its definition.
    pub(crate) define: bool,
}

impl Expr2Smt for Expression<'_> {
    fn expr_to_smt2<W: io::Write>(&self, w: &mut W, _: ()) -> SmtRes<()> {
        // Most terms of most scripts are literals of clauses.
        if self.terms.is_symbol(self.term) && !self.term.is_negated() {
            return SymbolName::new(self.terms, self.term).sym_to_smt2(w, ());
        }
        let mut walk =
            Walk { of: self, stack: Vec::new(), lets: FxHashSet::default(), scope: FxHashMap::default() };
        walk.stack.push(if self.define { Item::Expand(self.term) } else { Item::Term(self.term) });
        while let Some(item) = walk.stack.pop() {
            walk.step(w, item)?;
        }
        Ok(())
    }
}

/// What is still to be printed.
enum Item {
    Term(Term),
    /// The term, not its name.
    Expand(Term),
    Text(&'static str),
    /// So many closing parentheses.
    Close(usize),
    /// ` ($name ` at the start of a binding.
    Binding(Term),
    /// From here on the term has its name.
    Bind(Term),
    /// The end of a binder's scope: classes to leave, names to drop, hidden names to restore.
    Leave(Box<Binder>),
}

struct Binder {
    classes: Vec<u32>,
    bound: Vec<Term>,
    hidden: Vec<Term>,
}

struct Walk<'a> {
    of: &'a Expression<'a>,
    stack: Vec<Item>,
    /// Nodes that a `let` around this place has named.
    lets: FxHashSet<Term>,
    /// How many binders around this place bind each class.
    scope: FxHashMap<u32, u32>,
}

impl Walk<'_> {
    fn step<W: io::Write>(&mut self, w: &mut W, item: Item) -> SmtRes<()> {
        match item {
            Item::Term(t) => self.term(w, t)?,
            Item::Expand(t) => self.expand(w, t)?,
            Item::Text(text) => w.write_all(text.as_bytes())?,
            Item::Close(count) => (0..count).try_for_each(|_| w.write_all(b")"))?,
            Item::Binding(t) => {
                w.write_all(b"(")?;
                self.name(t).sym_to_smt2(w, ())?;
                w.write_all(b" ")?;
            }
            Item::Bind(t) => {
                self.lets.insert(t);
            }
            Item::Leave(binder) => self.leave(&binder),
        }
        Ok(())
    }

    fn name(&self, term: Term) -> SharedName {
        SharedName { series: self.of.series, term }
    }

    fn term<W: io::Write>(&mut self, w: &mut W, t: Term) -> SmtRes<()> {
        let node = t.positive();
        if !self.of.named[t.index()] && !self.lets.contains(&node) {
            return self.expand(w, t);
        }
        if t.is_negated() {
            w.write_all(b"(not ")?;
        }
        self.name(node).sym_to_smt2(w, ())?;
        if t.is_negated() {
            w.write_all(b")")?;
        }
        Ok(())
    }

    fn expand<W: io::Write>(&mut self, w: &mut W, t: Term) -> SmtRes<()> {
        let terms = self.of.terms;
        match (terms.view(t), t.is_negated()) {
            (View::Const(Value::Bool(_)), negated) => {
                Ok(w.write_all(if negated { b"false" } else { b"true" })?)
            }
            (View::Const(value), _) => Ok(write_value(w, terms, value)?),
            (View::Symbol(..) | View::Bound(..), false) => Ok(SymbolName::new(terms, t).sym_to_smt2(w, ())?),
            (View::App(Op::And, conjuncts), true) => self.application(w, "or", conjuncts.iter().map(|&t| !t)),
            (View::App(Op::BvUlt, &[a, b]), true) => self.application(w, "bvule", [b, a].into_iter()),
            (View::App(Op::BvSlt, &[a, b]), true) => self.application(w, "bvsle", [b, a].into_iter()),
            (View::App(Op::Le, &[a, b]), true) => self.application(w, "<", [b, a].into_iter()),
            (View::Forall(bound, body), negated) => self.enter(w, bound, body, negated),
            (_, true) => {
                w.write_all(b"(not ")?;
                self.stack.push(Item::Close(1));
                self.expand(w, !t)
            }
            (View::App(op, args), false) => self.application(w, op.name(), args.iter().copied()),
            (View::Extend(op, a, by), false) => {
                write!(w, "((_ {} {by})", op.name())?;
                self.arguments(std::iter::once(a));
                Ok(())
            }
            (View::Extract(a, hi, lo), false) => {
                write!(w, "((_ extract {hi} {lo})")?;
                self.arguments(std::iter::once(a));
                Ok(())
            }
        }
    }

    fn application<W: io::Write>(
        &mut self,
        w: &mut W,
        name: &str,
        args: impl DoubleEndedIterator<Item = Term>,
    ) -> SmtRes<()> {
        w.write_all(b"(")?;
        w.write_all(name.as_bytes())?;
        self.arguments(args);
        Ok(())
    }

    fn arguments(&mut self, args: impl DoubleEndedIterator<Item = Term>) {
        self.stack.push(Item::Close(1));
        for arg in args.rev() {
            self.stack.push(Item::Term(arg));
            self.stack.push(Item::Text(" "));
        }
    }

    /// Prints the head of a quantifier and schedules its `let`s and its body.
    fn enter<W: io::Write>(&mut self, w: &mut W, bound: &[Term], body: Term, exists: bool) -> SmtRes<()> {
        w.write_all(if exists { b"(exists (" } else { b"(forall (" })?;
        for (i, &variable) in bound.iter().enumerate() {
            w.write_all(if i == 0 { b"(" } else { b" (" })?;
            SymbolName::new(self.of.terms, variable).sym_to_smt2(w, ())?;
            w.write_all(b" ")?;
            SortName { terms: self.of.terms, sort: self.of.terms.sort(variable) }.sort_to_smt2(w)?;
            w.write_all(b")")?;
        }
        w.write_all(b") ")?;
        let (binder, layers) = self.plan(bound, body);
        self.stack.push(Item::Leave(Box::new(binder)));
        self.stack.push(Item::Close(1 + layers.len()));
        self.stack.push(Item::Term(body.negate_if(exists)));
        for layer in layers.iter().rev() {
            self.stack.push(Item::Text(") "));
            self.stack.extend(layer.iter().map(|&t| Item::Bind(t)));
            for (i, &t) in layer.iter().enumerate().rev() {
                self.stack.push(Item::Close(1));
                self.stack.push(Item::Expand(t));
                self.stack.push(Item::Binding(t));
                self.stack.push(Item::Text(if i == 0 { "(let (" } else { " " }));
            }
        }
        Ok(())
    }

    /// Enters a binder's scope and finds what it has to bind by `let`: the nodes that depend on its
    /// variables and on those of no inner binder, and are used more than once. They come in layers:
    /// each depends on earlier layers only.
    fn plan(&mut self, bound: &[Term], body: Term) -> (Binder, Vec<Vec<Term>>) {
        let Some(free) = self.of.free else {
            return (Binder { classes: Vec::new(), bound: Vec::new(), hidden: Vec::new() }, Vec::new());
        };
        let classes = free.classes_of(bound);
        for &class in &classes {
            *self.scope.entry(class).or_default() += 1;
        }
        let (mut nodes, uses) = self.dependents(free, &classes, body);
        nodes.sort_unstable();
        // An outer `let` of a node means the outer variable of the same name.
        let hidden: Vec<Term> = nodes.iter().copied().filter(|t| self.lets.contains(t)).collect();
        for t in &hidden {
            self.lets.remove(t);
        }
        let mut layers: Vec<Vec<Term>> = Vec::new();
        let mut depth: FxHashMap<Term, usize> = FxHashMap::default();
        for &t in &nodes {
            let children = self.of.terms.children(t).iter();
            let layer = children.filter_map(|c| depth.get(&c.positive())).max().copied().unwrap_or(0);
            let shared = uses[&t] > 1 && self.of.terms.op(t) != Op::Bound;
            let bindable = free.of(t).iter().all(|c| self.scope.get(c).is_some_and(|&n| n > 0));
            if shared && bindable {
                layers.resize_with(layers.len().max(layer + 1), Vec::new);
                layers[layer].push(t);
                depth.insert(t, layer + 1);
            } else {
                depth.insert(t, layer);
            }
        }
        let names = layers.iter().flatten().copied().collect();
        (Binder { classes, bound: names, hidden }, layers)
    }

    /// The nodes in the body in which some variable of the classes is free, with their uses there.
    fn dependents(&self, free: &Free, classes: &[u32], body: Term) -> (Vec<Term>, FxHashMap<Term, u32>) {
        let mut uses: FxHashMap<Term, u32> = FxHashMap::default();
        let mut nodes = Vec::new();
        let mut stack = vec![body.positive()];
        while let Some(t) = stack.pop() {
            if !free.of(t).iter().any(|c| classes.binary_search(c).is_ok()) {
                continue;
            }
            let count = uses.entry(t).or_default();
            *count += 1;
            if *count == 1 {
                nodes.push(t);
                stack.extend(self.of.terms.children(t).iter().map(|c| c.positive()));
            }
        }
        (nodes, uses)
    }

    fn leave(&mut self, binder: &Binder) {
        for class in &binder.classes {
            if let Some(count) = self.scope.get_mut(class) {
                *count -= 1;
            }
        }
        for t in &binder.bound {
            self.lets.remove(t);
        }
        self.lets.extend(binder.hidden.iter().copied());
    }
}

/// Writes a constant. Also useful for showing values.
pub(crate) fn write_value(w: &mut impl io::Write, terms: &Terms, value: Value) -> io::Result<()> {
    match value {
        Value::Bool(b) => write!(w, "{b}"),
        Value::Bv { width, bits } if width.is_multiple_of(4) => {
            write!(w, "#x{bits:0digits$x}", digits = (width / 4) as usize)
        }
        Value::Bv { width, bits } => write!(w, "#b{bits:0digits$b}", digits = width as usize),
        Value::Enum(enumeration, position) => {
            terms.constructor_names(enumeration)[position as usize].write(w)
        }
        Value::Int(i) if i < 0 => write!(w, "(- {})", i.unsigned_abs()),
        Value::Int(i) => write!(w, "{i}"),
        Value::Real(r) => {
            let (numerator, denominator) = (r.numerator().unsigned_abs(), r.denominator());
            let (open, close) = if r.numerator() < 0 { ("(- ", ")") } else { ("", "") };
            if denominator == 1 {
                write!(w, "{open}{numerator}.0{close}")
            } else {
                write!(w, "{open}(/ {numerator}.0 {denominator}.0){close}")
            }
        }
    }
}

/// A term as text, without names for what is shared: for messages about small terms.
pub(crate) fn write_plain(w: &mut impl io::Write, terms: &Terms, term: Term) -> io::Result<()> {
    let named = vec![false; terms.len()];
    let free = terms.is_quantified(term).then(|| Free::new(terms));
    let expression = Expression { terms, free: free.as_ref(), named: &named, term, series: 0, define: false };
    expression.expr_to_smt2(w, ()).map_err(io_error)
}
