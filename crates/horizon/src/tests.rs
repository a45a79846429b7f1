use super::*;
use hyperplan_problem::{Formula, Leaf, PathVar, Quantifier, SystemId, VarId};
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::{SourceId, Span};

const SPAN: Span = Span { source: SourceId(0), start: 0, end: 0 };
const P: PathId = PathId(0);
const Q: PathId = PathId(1);

fn atom(formula: &mut Formula, path: PathId) -> FormulaId {
    formula.push(Node::Atom(Expr::Leaf(PathLeaf::State(path, Leaf::Var(VarId(0))))), SPAN)
}

fn upto(hi: u32) -> Interval {
    Interval { lo: 0, hi: Some(hi) }
}

fn objective(mode: Mode, build: impl FnOnce(&mut Formula)) -> Objective {
    let mut formula = Formula::default();
    build(&mut formula);
    let path =
        |name: &str, quantifier| PathVar { name: name.into(), quantifier, system: SystemId(0), span: SPAN };
    let paths = [path("p", Quantifier::Exists), path("q", Quantifier::Forall)];
    let paths = paths.into_iter().collect();
    Objective { name: "o".into(), paths, mode, semantics: None, formula, minimize: Vec::new(), span: SPAN }
}

fn steps(objective: &Objective) -> Vec<(Option<u64>, Option<u64>)> {
    horizons(objective).iter().map(|h| (h.paper, h.steps)).collect()
}

#[test]
fn left_operand_of_until_is_read_one_step_less() {
    let o = objective(Mode::Bounded, |f| {
        let (q, p) = (atom(f, Q), atom(f, P));
        f.binary(BinaryOp::Until, upto(6), q, p, SPAN);
    });
    assert_eq!(steps(&o), [(Some(6), Some(6)), (Some(6), Some(5))]);
}

#[test]
fn left_operand_of_a_zero_until_is_not_read_and_weak_until_reads_it_all() {
    for (op, hi, expected) in [
        (BinaryOp::Until, 0, None),
        (BinaryOp::Release, 3, Some(2)),
        (BinaryOp::WeakUntil, 3, Some(3)),
        (BinaryOp::WeakUntil, 0, Some(0)),
        (BinaryOp::StrongRelease, 3, Some(3)),
    ] {
        let o = objective(Mode::Bounded, |f| {
            let (q, p) = (atom(f, Q), atom(f, P));
            f.binary(op, upto(hi), q, p, SPAN);
        });
        assert_eq!(steps(&o)[1].1, expected, "{op:?}[0,{hi}]");
        assert_eq!(steps(&o)[1].0, Some(u64::from(hi)), "the paper's");
    }
}

#[test]
fn a_path_that_does_not_occur_has_no_horizon() {
    let o = objective(Mode::Bounded, |f| {
        let p = atom(f, P);
        f.unary(UnaryOp::Finally, upto(4), p, SPAN);
    });
    assert_eq!(steps(&o), [(Some(4), Some(4)), (None, None)]);
}

#[test]
fn nested_bounds_add_and_the_reason_lists_them() {
    let o = objective(Mode::Bounded, |f| {
        let p = atom(f, P);
        let next = f.push(Node::Next(p), SPAN);
        let inner = f.unary(UnaryOp::Globally, upto(2), next, SPAN);
        let q = atom(f, Q);
        let both = f.push(Node::And(vec![inner, q]), SPAN);
        f.unary(UnaryOp::Finally, upto(5), both, SPAN);
    });
    assert_eq!(steps(&o), [(Some(8), Some(8)), (Some(5), Some(5))]);
    let reason: Vec<u64> = horizons(&o)[P].reason.iter().map(|r| r.1).collect();
    assert_eq!(reason, [5, 2, 1]);
}

#[test]
fn within_gives_every_path_the_bound() {
    let o = objective(Mode::Within(7), |f| {
        let p = atom(f, P);
        f.unary(UnaryOp::Finally, Interval::ALWAYS, p, SPAN);
    });
    assert_eq!(steps(&o), [(Some(7), Some(7)), (Some(7), Some(7))]);
}
