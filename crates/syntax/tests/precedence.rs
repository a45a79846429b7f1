//! How tightly operators bind, and where expressions stand.

mod common;

use common::{SOURCE, formula};
use hyperplan_syntax::ast::{ExprKind, Item};
use hyperplan_syntax::parse;

#[test]
fn comparisons_bind_more_tightly_than_logic() {
    assert_eq!(formula("G action[p] == action[q]"), "(G (action[p] == action[q]))");
    assert_eq!(formula("!x[p] == 1"), "(! (x[p] == 1))");
    assert_eq!(formula("! G !a[p] != b"), "(! (G (! (a[p] != b))))");
    assert_eq!(formula("x[p] + 1 < x[q] & y"), "(((+x[p] +1) < x[q]) & y)");
    assert_eq!(formula("F x in {1, 3} & y"), "((F (x in {1,3})) & y)");
    assert_eq!(formula("up in enabled[p] -> a"), "((up in enabled[p]) -> a)");
    assert_eq!(formula("x in 0..2*T | a"), "((x in 0..(2 * T)) | a)");
}

#[test]
fn logic_from_tight_to_loose() {
    assert_eq!(formula("a <-> b -> c | d & e U f"), "(a <-> (b -> (c | (d & (e U f)))))");
    assert_eq!(formula("a U b & c | d -> e <-> f"), "(((((a U b) & c) | d) -> e) <-> f)");
    assert_eq!(formula("!a U X b"), "((! a) U (X b))");
    assert_eq!(formula("G a U b"), "((G a) U b)");
    assert_eq!(formula("!(a U b)"), "(! (a U b))");
}

#[test]
fn associativity() {
    assert_eq!(formula("a -> b -> c"), "(a -> (b -> c))");
    assert_eq!(formula("a U b R c W d M e"), "(a U (b R (c W (d M e))))");
    assert_eq!(formula("M M M M[0,M] M | M"), "((M M (M M[0,M] M)) | M)");
    assert_eq!(formula("a <-> b <-> c"), "((a <-> b) <-> c)");
    assert_eq!(formula("a * b / c div d % e"), "((((a * b) / c) div d) % e)");
    assert_eq!(formula("a & b & c & d"), "(a & b & c & d)");
    assert_eq!(formula("(a & b) & (c & d)"), "((a & b) & (c & d))");
    assert_eq!(formula("a | b | c"), "(a | b | c)");
    assert_eq!(formula("a - b + c - d == 0"), "((+a -b +c -d) == 0)");
    assert_eq!(formula("a & b U c & d -> e & f"), "((a & (b U c) & d) -> (e & f))");
    assert_eq!(formula("a & b | c & d | e"), "((a & b) | (c & d) | e)");
}

#[test]
fn arithmetic() {
    assert_eq!(formula("-a * b + -2 > - -c"), "((+((- a) * b) +(- 2)) > (- (- c)))");
    assert_eq!(formula("a - b * c - 1 <= 0.5"), "((+a -(b * c) -1) <= 0.5)");
    assert_eq!(formula("x<-1"), "(x < (- 1))");
    assert_eq!(formula("x in -2..-1"), "(x in (- 2)..(- 1))");
}

#[test]
fn conditionals_reach_to_the_right() {
    assert_eq!(formula("if a & b then x else y + 1 > 0"), "(if (a & b) then x else ((+y +1) > 0))");
    assert_eq!(formula("1 + (if a then x else y) > 0"), "((+1 +(if a then x else y)) > 0)");
    assert_eq!(formula("if a then if b then c else d else e"), "(if a then (if b then c else d) else e)");
}

#[test]
fn intervals() {
    assert_eq!(formula("F[0,T] goal[p]"), "(F[0,T] goal[p])");
    assert_eq!(formula("G[T] a U[1, T - 1] b"), "((G[T] a) U[1,(+T -1)] b)");
    assert_eq!(formula("a R[2] b W[0,2*T] c"), "(a R[2] (b W[0,(2 * T)] c))");
}

#[test]
fn paper_signs() {
    assert_eq!(formula("∃ p. ∀ q. ¬a[p] ∧ b[q] ∨ ◇[0,T] c[p]"), "(((! a[p]) & b[q]) | (F[0,T] c[p]))");
    assert_eq!(formula("a ⇒ b → c ⇔ □[3] d 𝒰[0,2] ○e"), "((a -> (b -> c)) <-> ((G[3] d) U[0,2] (X e)))");
}

#[test]
fn calls_and_tuples() {
    assert_eq!(formula("reach(p) & close(p, q) & all()"), "(reach(p) & close(p,q) & all())");
    assert_eq!(formula("(x, y) in {(0, 0), (3, 4)}"), "(<x,y> in {<0,0>,<3,4>})");
    assert_eq!(formula("far[p,q] & next[p] & always(p)"), "(far[p,q] & next[p] & always(p))");
    assert_eq!(formula("state[p] == obs[q] <-> label[p]"), "((state[p] == obs[q]) <-> label[p])");
}

/// Spans leave out surrounding parentheses, but cover those of operands.
#[test]
fn spans() {
    let text = "const A = ((a) & !(b[p] + 1 == 2));";
    let (file, errors) = parse(SOURCE, text);
    assert!(errors.is_empty());
    let Item::Const(constant) = &file.items[0] else { panic!("no constant") };
    assert_eq!(&text[constant.name.span.range()], "A");
    assert_eq!(&text[constant.value.span.range()], "(a) & !(b[p] + 1 == 2)");
    let ExprKind::And(items) = &constant.value.kind else { panic!("no conjunction") };
    assert_eq!(&text[items[0].span.range()], "a");
    assert_eq!(&text[items[1].span.range()], "!(b[p] + 1 == 2)");
    let ExprKind::Not(inner) = &items[1].kind else { panic!("no negation") };
    let ExprKind::Compare(_, left, _) = &inner.kind else { panic!("no comparison") };
    assert_eq!(&text[left.span.range()], "b[p] + 1");
}

/// Bytes, not characters, also behind a byte order mark.
#[test]
fn spans_behind_wide_characters() {
    let text = "\u{feff}// ∃∀\nconst 𝒰 = 1;";
    let (_, errors) = parse(SOURCE, text);
    assert_eq!(&text[errors[0].span.expect("a place").range()], "𝒰");
}
