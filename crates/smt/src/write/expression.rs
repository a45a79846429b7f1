//! Prints one term, iteratively. Terms that are named at the top are printed as their names; under
//! a binder, shared terms that depend on its variables are bound by `let`.

use std::cell::RefCell;
use std::io;

use super::free::Free;
use super::name::{FunctionName, SortName, SymbolName};
use super::node_set::NodeSet;
use crate::name::write_number;
use crate::term::{Op, Term};
use crate::terms::{Terms, View};
use crate::value::Value;

/// The name of a shared term: `$` and its index, after the number of its series, if that is not 0. Symbols never look
/// like that.
pub(crate) struct SharedName {
    pub(crate) series: u32,
    pub(crate) term: Term,
}

impl SharedName {
    pub(super) fn write(&self, w: &mut impl io::Write) -> io::Result<()> {
        w.write_all(b"$")?;
        if self.series > 0 {
            write_number(w, self.series.into())?;
            w.write_all(b".")?;
        }
        write_number(w, self.term.index() as u64)
    }
}

/// What the printer knows of a node: one of these for each node of an arena.
#[derive(Copy, Clone, Default)]
pub(crate) struct Mark {
    /// How often it occurs in what was scanned: 0, 1, or 2 for more.
    pub(crate) uses: u8,
    /// Whether it was seen to when it was printed (named, or left inline), and whether it was named.
    flags: u8,
    /// How deep it is when printed inline.
    pub(crate) height: u8,
}

impl Mark {
    const SETTLED: u8 = 1;
    const NAMED: u8 = 2;

    #[inline]
    pub(crate) fn is_settled(self) -> bool {
        self.flags & Mark::SETTLED != 0
    }

    #[inline]
    pub(crate) fn is_named(self) -> bool {
        self.flags & Mark::NAMED != 0
    }

    #[inline]
    pub(crate) fn settle(&mut self, settled: bool) {
        self.flags = self.flags & !Mark::SETTLED | u8::from(settled);
    }

    pub(crate) fn name(&mut self) {
        self.flags |= Mark::NAMED;
    }
}

/// A term for printing.
pub(crate) struct Expression<'a> {
    pub(crate) terms: &'a Terms,
    /// The free variables, if anything is quantified.
    pub(crate) free: Option<&'a Free>,
    pub(crate) marks: &'a [Mark],
    pub(crate) scratch: &'a RefCell<Scratch>,
    pub(crate) term: Term,
    /// The series of names.
    pub(crate) series: u32,
    /// Print the node itself even if it is named: this is its definition.
    pub(crate) define: bool,
}

impl Expression<'_> {
    pub(super) fn write<W: io::Write>(&self, w: &mut W) -> io::Result<()> {
        // Most terms of most scripts are literals of clauses.
        if !self.define && self.leaf(w, self.term, false)? {
            return Ok(());
        }
        let mut scratch = self.scratch.borrow_mut();
        let written = Walk { of: self, scratch: &mut scratch }.run(w);
        if written.is_err() {
            *scratch = Scratch::default();
        }
        written
    }

    /// Prints what has no parts here: a symbol, a constant, a name, each perhaps negated. Whether it was one.
    #[inline]
    fn leaf<W: io::Write>(&self, w: &mut W, t: Term, is_let: bool) -> io::Result<bool> {
        let op = self.terms.op(t);
        let named = is_let || self.marks[t.index()].is_named();
        if !named && !matches!(op, Op::Symbol | Op::Bound | Op::Const | Op::True) {
            return Ok(false);
        }
        if op == Op::True {
            w.write_all(if t.is_negated() { b"false" } else { b"true" })?;
            return Ok(true);
        }
        if t.is_negated() {
            w.write_all(b"(not ")?;
        }
        match op {
            _ if named => SharedName { series: self.series, term: t }.write(w)?,
            Op::Const => write_value(w, self.terms, self.terms.value(t).expect("constants have a value"))?,
            _ => SymbolName::new(self.terms, t).write(w)?,
        }
        if t.is_negated() {
            w.write_all(b")")?;
        }
        Ok(true)
    }
}

/// What printing needs beyond the marks: kept from term to term, so that it is allocated once.
#[derive(Default)]
pub(crate) struct Scratch {
    stack: Vec<Frame>,
    /// Per class of bound variables, how many binders around this place bind it.
    scope: Vec<u32>,
    /// Per node, if anything is quantified.
    local: Vec<Local>,
    work: NodeSet,
    found: NodeSet,
}

/// What is known of a node under a binder.
#[derive(Copy, Clone, Default)]
struct Local {
    /// Whether a `let` around this place has named it.
    is_let: bool,
    /// While a binder is planned: how often the node occurs in its body, 0, 1, or 2 for more.
    uses: u8,
    /// While a binder is planned: how many layers of `let` have to come before it can be printed.
    layer: u32,
}

/// What is still to be printed.
enum Frame {
    /// The arguments of an application from that one on, and its closing parenthesis.
    Arguments(Term, u32),
    Close,
    /// What comes in a binder's scope.
    Scope(Box<Binder>),
}

/// A binder: its `let`s, its body, and what is to be restored when it ends.
struct Binder {
    classes: Vec<u32>,
    /// What is bound by `let`, in layers.
    lets: Vec<(u32, Term)>,
    /// Nodes that are bound by `let`s further out, for another variable of the same name.
    hidden: Vec<Term>,
    body: Term,
    /// How many `let`s were printed.
    printed: usize,
    stage: Stage,
}

/// What of a binder was begun last.
enum Stage {
    Head,
    Let,
    Body,
}

struct Walk<'a> {
    of: &'a Expression<'a>,
    scratch: &'a mut Scratch,
}

impl Walk<'_> {
    fn run<W: io::Write>(&mut self, w: &mut W) -> io::Result<()> {
        match self.of.define {
            true => self.expand(w, self.of.term)?,
            false => self.term(w, self.of.term)?,
        }
        while let Some(frame) = self.scratch.stack.pop() {
            match frame {
                Frame::Arguments(t, next) => self.arguments(w, t, next as usize)?,
                Frame::Close => w.write_all(b")")?,
                Frame::Scope(binder) => self.scope(w, binder)?,
            }
        }
        Ok(())
    }

    /// Prints a term or its name, or schedules the rest of it.
    fn term<W: io::Write>(&mut self, w: &mut W, t: Term) -> io::Result<()> {
        if self.leaf(w, t)? { Ok(()) } else { self.expand(w, t) }
    }

    /// Prints what has no parts here.
    #[inline]
    fn leaf<W: io::Write>(&self, w: &mut W, t: Term) -> io::Result<bool> {
        let is_let = self.scratch.local.get(t.index()).is_some_and(|local| local.is_let);
        self.of.leaf(w, t, is_let)
    }

    /// Begins a node, even if it has a name; what follows is scheduled.
    fn expand<W: io::Write>(&mut self, w: &mut W, t: Term) -> io::Result<()> {
        let terms = self.of.terms;
        let name = match (terms.view(t), t.is_negated()) {
            (View::Const(_) | View::Symbol(..) | View::Bound(..), _) => return self.leaf(w, t).map(drop),
            (View::Forall(bound, body), negated) => return self.enter(w, bound, body, negated),
            (View::App(Op::And, _), true) => "or",
            (View::App(Op::BvUlt, _), true) => "bvule",
            (View::App(Op::BvSlt, _), true) => "bvsle",
            (View::App(Op::Le, _), true) => "<",
            (_, true) => {
                w.write_all(b"(not ")?;
                self.scratch.stack.push(Frame::Close);
                return self.expand(w, !t);
            }
            (View::App(op, _), false) => op.name(),
            (View::Apply(function, _), false) => {
                w.write_all(b"(")?;
                FunctionName { terms, function }.write(w)?;
                self.scratch.stack.push(Frame::Arguments(t, 0));
                return Ok(());
            }
            (View::Extend(op, _, by), false) => {
                write!(w, "((_ {} {by})", op.name())?;
                self.scratch.stack.push(Frame::Arguments(t, 0));
                return Ok(());
            }
            (View::Extract(_, hi, lo), false) => {
                write!(w, "((_ extract {hi} {lo})")?;
                self.scratch.stack.push(Frame::Arguments(t, 0));
                return Ok(());
            }
        };
        w.write_all(b"(")?;
        w.write_all(name.as_bytes())?;
        self.scratch.stack.push(Frame::Arguments(t, 0));
        Ok(())
    }

    /// Prints arguments until one has parts of its own, and schedules the rest.
    fn arguments<W: io::Write>(&mut self, w: &mut W, t: Term, next: usize) -> io::Result<()> {
        let args = self.of.terms.children(t);
        let is_or = t.is_negated() && self.of.terms.op(t) == Op::And;
        for i in next..args.len() {
            w.write_all(b" ")?;
            let arg = match t.is_negated() {
                false => args[i],
                true if is_or => !args[i],
                // The complement of a comparison has its sides exchanged.
                true => args[args.len() - 1 - i],
            };
            if !self.leaf(w, arg)? {
                // A node has fewer than 2^32 arguments.
                self.scratch.stack.push(Frame::Arguments(t, i as u32 + 1));
                return self.expand(w, arg);
            }
        }
        w.write_all(b")")
    }

    /// Prints the head of a quantifier and schedules its `let`s and its body.
    fn enter<W: io::Write>(&mut self, w: &mut W, bound: &[Term], body: Term, exists: bool) -> io::Result<()> {
        w.write_all(if exists { b"(exists (" } else { b"(forall (" })?;
        for (i, &variable) in bound.iter().enumerate() {
            w.write_all(if i == 0 { b"(" } else { b" (" })?;
            SymbolName::new(self.of.terms, variable).write(w)?;
            w.write_all(b" ")?;
            let sort = SortName::new(self.of.terms, self.of.terms.sort(variable));
            sort.write(w)?;
            w.write_all(b")")?;
        }
        w.write_all(b") ")?;
        let binder = self.plan(bound, body, exists);
        self.scratch.stack.push(Frame::Scope(Box::new(binder)));
        Ok(())
    }

    /// Goes on in a binder's scope: the next `let`, the body, or its end.
    fn scope<W: io::Write>(&mut self, w: &mut W, mut binder: Box<Binder>) -> io::Result<()> {
        let layer = |at: usize| binder.lets.get(at).map(|&(layer, _)| layer);
        if let Stage::Let = binder.stage {
            w.write_all(b")")?;
            let begun = binder.printed;
            binder.printed += 1;
            if layer(begun) != layer(begun + 1) {
                w.write_all(b") ")?;
                let whole =
                    binder.lets[..=begun].iter().rev().take_while(|&&(of, _)| Some(of) == layer(begun));
                whole.for_each(|&(_, t)| self.scratch.local[t.index()].is_let = true);
            }
        }
        let at = binder.printed;
        match binder.stage {
            Stage::Head | Stage::Let => match binder.lets.get(at).copied() {
                Some((of, t)) => {
                    let first = at == 0 || layer(at - 1) != Some(of);
                    w.write_all(if first { b"(let ((" } else { b" (" })?;
                    SharedName { series: self.of.series, term: t }.write(w)?;
                    w.write_all(b" ")?;
                    binder.stage = Stage::Let;
                    self.scratch.stack.push(Frame::Scope(binder));
                    self.expand(w, t)
                }
                None => {
                    let body = binder.body;
                    binder.stage = Stage::Body;
                    self.scratch.stack.push(Frame::Scope(binder));
                    self.term(w, body)
                }
            },
            Stage::Body => {
                let layers = binder.lets.last().map_or(0, |&(layer, _)| layer + 1);
                self.leave(&binder);
                (0..=layers).try_for_each(|_| w.write_all(b")"))
            }
        }
    }

    /// Enters a binder's scope and finds what it has to bind by `let`: the nodes that depend on its
    /// variables and on those of no inner binder, and are used more than once. They come in layers:
    /// each depends on earlier layers only.
    fn plan(&mut self, bound: &[Term], body: Term, exists: bool) -> Binder {
        let (classes, lets, hidden) = (Vec::new(), Vec::new(), Vec::new());
        let body_wanted = body.negate_if(exists);
        let mut binder = Binder { classes, lets, hidden, body: body_wanted, printed: 0, stage: Stage::Head };
        let Some(free) = self.of.free else { return binder };
        binder.classes = free.classes_of(bound);
        self.scratch.make_room(self.of.terms.len(), free.class_count());
        for &class in &binder.classes {
            self.scratch.scope[class as usize] += 1;
        }
        self.find_dependents(free, &binder.classes, body);
        let Scratch { scope, local, work, found, .. } = &mut *self.scratch;
        while let Some(t) = found.pop_first() {
            // Once more, to forget it.
            work.insert(t);
            let here = &mut local[t.index()];
            // An outer `let` of a node means the outer variable of the same name.
            if std::mem::take(&mut here.is_let) {
                binder.hidden.push(t);
            }
            let shared = here.uses > 1 && self.of.terms.op(t) != Op::Bound;
            let layers = self.of.terms.children(t).iter().map(|child| local[child.index()].layer);
            let layer = layers.max().unwrap_or(0);
            if shared && free.of(t).iter().all(|&class| scope[class as usize] > 0) {
                binder.lets.push((layer, t));
                local[t.index()].layer = layer + 1;
            } else {
                local[t.index()].layer = layer;
            }
        }
        while let Some(t) = work.pop_first() {
            local[t.index()] = Local::default();
        }
        binder.lets.sort_unstable();
        binder
    }

    /// Finds the nodes in the body in which some variable of the classes is free, and counts their uses there.
    fn find_dependents(&mut self, free: &Free, classes: &[u32], body: Term) {
        let Scratch { local, work, found, .. } = &mut *self.scratch;
        let depends = |t: Term| free.of(t).iter().any(|class| classes.binary_search(class).is_ok());
        let mut touch = |t: Term, work: &mut NodeSet| {
            if !depends(t) {
                return;
            }
            let uses = &mut local[t.index()].uses;
            if *uses == 0 {
                work.insert(t);
            }
            *uses = 2.min(*uses + 1);
        };
        touch(body, work);
        while let Some(t) = work.pop_last() {
            found.insert(t);
            for &child in self.of.terms.children(t) {
                touch(child, work);
            }
        }
    }

    fn leave(&mut self, binder: &Binder) {
        for &class in &binder.classes {
            self.scratch.scope[class as usize] -= 1;
        }
        for (_, t) in &binder.lets {
            self.scratch.local[t.index()].is_let = false;
        }
        for t in &binder.hidden {
            self.scratch.local[t.index()].is_let = true;
        }
    }
}

impl Scratch {
    /// Makes room for so many nodes and classes of bound variables.
    fn make_room(&mut self, nodes: usize, classes: usize) {
        if self.local.len() < nodes {
            self.local.resize(nodes, Local::default());
            self.work.grow(nodes);
            self.found.grow(nodes);
        }
        self.scope.resize(classes.max(self.scope.len()), 0);
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
    let marks = vec![Mark::default(); terms.len()];
    let free = terms.is_quantified(term).then(|| Free::new(terms));
    let scratch = RefCell::default();
    Expression {
        terms,
        free: free.as_ref(),
        marks: &marks,
        scratch: &scratch,
        term,
        series: 0,
        define: false,
    }
    .write(w)
}
