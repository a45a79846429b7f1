use crate::unroll::{AtomTerms, Unroller};
use hyperplan_problem::{Expr, Formula, FormulaId, Interval, Mode, Node, PathLeaf};
use hyperplan_relevance::Goal;
use hyperplan_smt::{Sort, Term, Terms};
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::{SourceId, Span};

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// Each atom at each time is a symbol of its own.
struct Free;

impl AtomTerms for Free {
    fn atom(&mut self, terms: &mut Terms, (atom, _): (FormulaId, &Expr<PathLeaf>), time: u32) -> Term {
        let stem = terms.stem(&format!("a{}", atom.0));
        terms.symbol(stem, Some(time), Sort::Bool)
    }
}

fn atom(formula: &mut Formula) -> FormulaId {
    formula.push(Node::Atom(Expr::TRUE), SPAN)
}

/// The number of terms of `G[0,T] (a OP[0,T] b)`, nested windows of the horizon's length.
fn size(build: &dyn Fn(&mut Formula, Interval) -> FormulaId, horizon: u32, mode: Mode) -> usize {
    let mut formula = Formula::default();
    let window = Interval { lo: 0, hi: Some(horizon) };
    let inner = build(&mut formula, window);
    formula.unary(UnaryOp::Globally, window, inner, SPAN);
    let mut terms = Terms::new();
    let goal = Goal::new(&formula, true);
    Unroller::new(&formula, mode, Free).goal(&mut terms, &goal);
    terms.len()
}

#[test]
fn every_operator_unrolls_to_linearly_many_terms() {
    type Build = Box<dyn Fn(&mut Formula, Interval) -> FormulaId>;
    let binary = |op: BinaryOp, lo: u32| -> Build {
        Box::new(move |f, window| {
            let (a, b) = (atom(f), atom(f));
            f.binary(op, Interval { lo, ..window }, a, b, SPAN)
        })
    };
    let unary = |op: UnaryOp| -> Build {
        Box::new(move |f, window| {
            let a = atom(f);
            f.unary(op, window, a, SPAN)
        })
    };
    let operators: Vec<(&str, Build)> = vec![
        ("F", unary(UnaryOp::Finally)),
        ("G", unary(UnaryOp::Globally)),
        ("X", unary(UnaryOp::Next)),
        ("U", binary(BinaryOp::Until, 0)),
        ("U[7,_]", binary(BinaryOp::Until, 7)),
        ("R", binary(BinaryOp::Release, 0)),
        ("R[7,_]", binary(BinaryOp::Release, 7)),
        ("W", binary(BinaryOp::WeakUntil, 0)),
        ("M", binary(BinaryOp::StrongRelease, 0)),
    ];
    for (name, build) in &operators {
        for mode in [|_| Mode::Bounded, Mode::Within] {
            let (small, large) = (size(build, 100, mode(100)), size(build, 400, mode(400)));
            let ratio = large as f64 / small as f64;
            assert!(ratio < 5.0, "{name}: {small} terms at 100, {large} at 400");
        }
    }
}

#[test]
fn encoders_are_shared_and_queries_sent() {
    fn shared<T: Send + Sync>() {}
    fn sent<T: Send>() {}
    shared::<crate::Encoder<'_>>();
    sent::<crate::Query<'_, '_>>();
}
