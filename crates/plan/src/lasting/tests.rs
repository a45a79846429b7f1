//! What is said to last, on random formulas and words.

use super::compare;
use hyperplan_problem::{Expr, Formula, FormulaId, Interval, LabelId, Leaf, Node, PathId, PathLeaf};
use hyperplan_random::{Random, property};
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::{SourceId, Span};
use std::cell::Cell;

fn interval(random: &mut Random) -> Interval {
    let lo = random.bound(3);
    Interval { lo, hi: Some(lo + random.bound(3)) }
}

/// The labels that hold at each position.
type Word = Vec<[bool; 2]>;

fn word(random: &mut Random, length: usize) -> Word {
    (0..length).map(|_| [random.below(2) == 0, random.below(2) == 0]).collect()
}

/// Two formulas that differ in intervals at most.
fn pair(random: &mut Random) -> [Formula; 2] {
    let mut both = [Formula::default(), Formula::default()];
    let span = Span::new(SourceId(0), 0..0);
    let mut operands = Vec::new();
    for label in [0, 1] {
        let leaf = Expr::Leaf(PathLeaf::State(PathId(0), Leaf::Label(LabelId(label))));
        for formula in &mut both {
            formula.push(Node::Atom(leaf.clone()), span);
        }
        operands.push(FormulaId::from(label as usize));
    }
    for _ in 0..3 {
        let mut operand = || operands[random.below(operands.len())];
        let (x, y) = (operand(), operand());
        let same = random.below(3) == 0;
        let i = interval(random);
        let j = if same { i } else { interval(random) };
        let kind = random.below(13);
        let [formula, other] = &mut both;
        let [id, _] = [(formula, i), (other, j)].map(|(formula, i)| match kind {
            0 => formula.push(Node::Not(x), span),
            1 => formula.push(Node::And(vec![x, y]), span),
            2 => formula.push(Node::Or(vec![x, y]), span),
            3 => formula.implies(x, y, span),
            4 => formula.push(Node::Iff(x, y), span),
            5 => formula.unary(UnaryOp::Next, i, x, span),
            6 => formula.unary(UnaryOp::WeakNext, i, x, span),
            7 => formula.unary(UnaryOp::Finally, i, x, span),
            8 => formula.unary(UnaryOp::Globally, i, x, span),
            9 => formula.binary(BinaryOp::Until, i, x, y, span),
            10 => formula.binary(BinaryOp::Release, i, x, y, span),
            11 => formula.binary(BinaryOp::WeakUntil, i, x, y, span),
            _ => formula.binary(BinaryOp::StrongRelease, i, x, y, span),
        });
        operands.push(id);
    }
    both
}

/// Whether a formula holds at a position of a finite word, by the definition.
fn holds(formula: &Formula, id: FormulaId, word: &[[bool; 2]], at: usize) -> bool {
    let sub = |id: &FormulaId, at: usize| holds(formula, *id, word, at);
    let until = |i: &Interval, f: &dyn Fn(usize) -> bool, g: &dyn Fn(usize) -> bool| {
        let end = at + i.hi.expect("bounded") as usize;
        (at + i.lo as usize..=end).any(|t| t < word.len() && g(t) && (at..t).all(f))
    };
    match &formula.nodes[id] {
        Node::Atom(Expr::Leaf(PathLeaf::State(_, Leaf::Label(label)))) => word[at][usize::from(*label)],
        Node::Atom(other) => panic!("no label: {other:?}"),
        Node::Not(a) => !sub(a, at),
        Node::And(ids) => ids.iter().all(|id| sub(id, at)),
        Node::Or(ids) => ids.iter().any(|id| sub(id, at)),
        Node::Iff(a, b) => sub(a, at) == sub(b, at),
        Node::Next(a) => at + 1 < word.len() && sub(a, at + 1),
        Node::WeakNext(a) => at + 1 >= word.len() || sub(a, at + 1),
        Node::Until(i, a, b) => until(i, &|t| sub(a, t), &|t| sub(b, t)),
        Node::Release(i, a, b) => !until(i, &|t| !sub(a, t), &|t| !sub(b, t)),
    }
}

#[test]
fn what_is_said_to_last_does() {
    let (up, down) = (Cell::new(0), Cell::new(0));
    property(30_000, 100, |random| {
        let [earlier, later] = pair(random);
        // Words of infinite paths are longer than anything reads.
        let longer = random.flip();
        let (cut, whole) = if longer { (1 + random.below(4), 8) } else { (24, 24) };
        let word = word(random, whole);
        let lasts = compare(&earlier, &later, longer).expect("nodes of one kind");
        for (id, lasts) in lasts.iter_enumerated() {
            for at in 0..cut.min(6) {
                let (before, after) = (holds(&earlier, id, &word[..cut], at), holds(&later, id, &word, at));
                assert!(!lasts.up || !before || after, "{:?} {:?}", earlier.nodes, later.nodes);
                assert!(!lasts.down || !after || before, "{:?} {:?}", earlier.nodes, later.nodes);
                up.set(up.get() + u32::from(lasts.up && before));
                down.set(down.get() + u32::from(lasts.down && after));
            }
        }
    });
    assert!(up.get() > 100_000 && down.get() > 100_000, "{} {}", up.get(), down.get());
}
