//! Terms taken apart.

use super::Terms;
use crate::term::{Function, Op, Sort, Stem, Term};
use crate::value::Value;

/// What a node is. The complement bit of the handle is not part of it.
#[derive(Clone, Copy, Debug)]
pub enum View<'a> {
    /// A constant of any sort (`true` for Booleans).
    Const(Value),
    /// A declared symbol.
    Symbol(Stem, Option<u32>),
    /// A variable that a quantifier binds.
    Bound(Stem, Option<u32>),
    /// An operator on terms.
    App(Op, &'a [Term]),
    /// `SignExtend` or `ZeroExtend` by some bits.
    Extend(Op, Term, u32),
    /// The bits from high to low, both included.
    Extract(Term, u32, u32),
    /// A declared function, applied.
    Apply(Function, &'a [Term]),
    /// Universal quantification.
    Forall(&'a [Term], Term),
}

impl Terms {
    /// Takes a node apart.
    #[must_use]
    pub fn view(&self, t: Term) -> View<'_> {
        let args = self.raw_args(t.index());
        let op = self.op(t);
        match op {
            Op::True => View::Const(Value::Bool(true)),
            Op::Const => View::Const(self.value(t).expect("constants have a value")),
            Op::Symbol => View::Symbol(Stem(args[0].0), args[1].0.checked_sub(1)),
            Op::Bound => View::Bound(Stem(args[0].0), args[1].0.checked_sub(1)),
            Op::SignExtend | Op::ZeroExtend => View::Extend(op, args[0], args[1].0),
            Op::Extract => View::Extract(args[0], args[1].0, args[2].0),
            Op::Apply => {
                let (function, args) = args.split_last().expect("an application has its function");
                View::Apply(Function(function.0), args)
            }
            Op::Forall => {
                let (body, bound) = args.split_last().expect("a quantifier has a body");
                View::Forall(bound, *body)
            }
            Op::And
            | Op::Eq
            | Op::Ite
            | Op::BvAdd
            | Op::BvMul
            | Op::BvNeg
            | Op::BvUlt
            | Op::BvSlt
            | Op::Add
            | Op::Mul
            | Op::Le
            | Op::IntDiv
            | Op::IntMod
            | Op::ToReal => View::App(op, args),
        }
    }

    /// Whether the term is a declared symbol of any sort, complemented or not.
    #[must_use]
    pub fn is_symbol(&self, t: Term) -> bool {
        self.op(t) == Op::Symbol
    }

    /// Adds all nodes below the roots (unnegated, each once, roots included) to `found`, children
    /// not before parents; `seen` marks what is known already, by index.
    pub fn reach(&self, roots: &[Term], seen: &mut Vec<bool>, found: &mut Vec<Term>) {
        seen.resize(self.len(), false);
        let mut next = found.len();
        let visit = |t: Term, seen: &mut Vec<bool>, found: &mut Vec<Term>| {
            if !std::mem::replace(&mut seen[t.index()], true) {
                found.push(t.positive());
            }
        };
        for &root in roots {
            visit(root, seen, found);
        }
        while let Some(&t) = found.get(next) {
            next += 1;
            for &child in self.children(t) {
                visit(child, seen, found);
            }
        }
    }

    /// The width of a bit-vector term.
    pub(super) fn width(&self, what: &str, t: Term) -> u32 {
        match self.sort(t) {
            Sort::BitVec(width) => width,
            other => panic!("{what}: a bit-vector is needed, not {other}"),
        }
    }
}
