//! `within K semantics pes | opt | hpes | hopt`, compiled into an ordinary formula of `within K`.
//!
//! A path of K steps is read as a prefix of an infinite one, as bounded model checkers do. Positions up to K are known.
//! What of positions beyond K:
//!
//! | semantics | |
//! | --- | --- |
//! | `pes` | no subformula holds there, not even `true`: whatever an operator needs has to exist |
//! | `opt` | every subformula holds there, even `false` |
//! | `hpes`, `hopt` | where every path has *halted* at K, the last states repeat for ever, and only the actions taken beyond K are unknown: literals that read them do not hold (`hpes`) or hold (`hopt`). Elsewhere as `pes` and `opt` |
//!
//! A path has halted where each transition of its state leads back to it; so too where there is no transition, since
//! nothing can change there either.
//!
//! All of this is defined on the *negation normal form*, so that `opt(f)` is `!pes(!f)` and `hopt(f)` is `!hpes(!f)`:
//! negation is pushed to the literals through the forms of the core, `a <-> b` being `(a & b) | (!a & !b)` and
//! `if c then a else b` being `(c & a) | (!c & b)`. What else is written was lowered to the core before, as the table of
//! operators says.
//! A literal is what remains: an atom that reads no action, or one that has no connective at its top
//! ([`literals`]).
//!
//! # The translation
//!
//! All positions beyond K are alike, so a subformula `f` has one value there. Write `later(f)` for it: a constant, or
//! in the halting semantics a combination of state literals, read at K. So `end(f)`, which is `F (last & later(f))` with
//! `last` for `N false`, has that value wherever it stands on the finite trace. Write `now(f)` for the
//! translation of f, which has f's value at all positions up to K. Below, i is the position where f is read,
//! `exists(n)` (which is `F[n,n] true`) says that position i + n is one of the trace, i + n <= K, and d is K + 1 - i,
//! the number of steps to the first position beyond; d >= 1.
//!
//! - `X f`, `N f`: at K the next position is beyond, elsewhere it is not: `X now(f) | last & later(f)`.
//! - `f U[a,b] g` holds if for some n in a..b, g holds n steps from now and f before. Those n < d are positions of the
//!   trace: `now(f) U[a,b] now(g)` on the finite trace. There are n in a..b with n >= d if d <= b, that is, if not
//!   `exists(b)`. The least of them, m = max(a, d), will do: g is alike at all of them, and f is asked at
//!   fewer positions. It needs `end(g)`, f at i..K, which is `G now(f)` on the finite trace, and f at K + 1 .. i + m - 1:
//!   no position if m = d, which is a <= d, i + (a - 1) <= K, `exists(a - 1)` (true if a = 0); else `end(f)`.
//!   Together `now(f) U[a,b] now(g) | !exists(b) & G now(f) & end(g) & (exists(a - 1) | end(f))`.
//! - `f R[a,b] g` is the dual: `now(f) R[a,b] now(g) & (exists(b) | F now(f) | end(g) | !exists(a - 1) & end(f))`.
//! - Beyond K the same, where d <= 0: `later(f U[a,b] g)` is `later(g) & later(f)`, without the second if a = 0.
//!
//! Without an end, `exists(b)` is false. The `true` of `F`, which is `true U`, and the `false` of `G` are no subformulas:
//! they have their values beyond the trace too.
//!
//! Every node of the formula is translated once for each sign, and the result shares what can be shared, so its size
//! is linear.

mod builder;
mod demand;
mod literals;
mod reading;

use crate::expr::{Expr, PathLeaf};
use crate::formula::{Formula, Interval};
use crate::ids::PathId;
use crate::objective::Semantics;
use builder::Builder;
use demand::demands;
use literals::literals;
use reading::{Beyond, Reading};

/// A formula with more nodes is not translated: each may become some dozens.
pub(super) const MAX_SOURCE: usize = 250_000;

/// The formula that says on traces of `steps` steps what `formula` says under the semantics. `paths` are all paths of
/// the objective.
pub(super) fn compile(
    formula: &Formula,
    steps: u32,
    semantics: Semantics,
    paths: impl Iterator<Item = PathId>,
) -> Formula {
    let source = literals(formula);
    let demands = demands(&source);
    let span = source.spans[source.root()];
    let mut builder = Builder::new(&source, span);
    let read = |builder: &mut Builder, beyond| {
        Reading { source: &source, demands: &demands, steps, beyond }.root(builder)
    };
    let hopeful = matches!(semantics, Semantics::Optimistic | Semantics::HaltingOptimistic);
    let unknown = read(&mut builder, Beyond::Constant(hopeful));
    let root = if matches!(semantics, Semantics::Pessimistic | Semantics::Optimistic) {
        unknown
    } else {
        let known = read(&mut builder, Beyond::Repeated { actions: hopeful });
        builder.at(span);
        let all: Vec<_> = paths.map(|path| builder.new_atom(Expr::Leaf(PathLeaf::Halted(path)))).collect();
        let all = builder.and(&all);
        let halted = builder.finally(Interval { lo: steps, hi: Some(steps) }, all);
        // `if halted then known else unknown`, given that `pes` implies `known`, and that implies `opt`: both grow with
        // what holds beyond K, as there is no negation but in literals.
        if known == unknown {
            known
        } else if hopeful {
            let moving = builder.not(halted);
            let known = builder.or(&[moving, known]);
            builder.and(&[unknown, known])
        } else {
            let known = builder.and(&[halted, known]);
            builder.or(&[unknown, known])
        }
    };
    builder.finish(root)
}
