//! What is said to last, on random formulas and words.

use super::{Lasts, node};
use hyperplan_problem::{
    Expr, Formula, FormulaId, Interval, LabelId, Leaf, Node, PathId, PathLeaf, TemporalOp,
};
use hyperplan_random::{Random, property};
use hyperplan_syntax::{SourceId, Span};
use std::cell::Cell;
use typed_index_collections::TiVec;

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
    let mut add = |a: Node, b: Node| {
        both[0].push(a, span);
        both[1].push(b, span);
    };
    for label in [0, 1] {
        let leaf = Expr::Leaf(PathLeaf::State(PathId(0), Leaf::Label(LabelId(label))));
        add(Node::Atom(leaf.clone()), Node::Atom(leaf));
    }
    for size in 2..5 {
        let mut operand = || FormulaId::from(random.below(size));
        let (x, y) = (operand(), operand());
        let same = random.below(3) == 0;
        let i = interval(random);
        let j = if same { i } else { interval(random) };
        let temporal = |op| (Node::Temporal(op, i, x, y), Node::Temporal(op, j, x, y));
        let twice = |node: Node| (node.clone(), node);
        let (a, b) = match random.below(12) {
            0 => twice(Node::Not(x)),
            1 => twice(Node::And(vec![x, y])),
            2 => twice(Node::Or(vec![x, y])),
            3 => twice(Node::Implies(x, y)),
            4 => twice(Node::Iff(x, y)),
            5 => twice(Node::Next(x)),
            6 => twice(Node::WeakNext(x)),
            7 => (Node::Finally(i, x), Node::Finally(j, x)),
            8 => (Node::Globally(i, x), Node::Globally(j, x)),
            9 => temporal(TemporalOp::Until),
            10 => temporal(TemporalOp::Release),
            _ => temporal(TemporalOp::WeakUntil),
        };
        add(a, b);
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
        Node::Implies(a, b) => !sub(a, at) || sub(b, at),
        Node::Iff(a, b) => sub(a, at) == sub(b, at),
        Node::Next(a) => at + 1 < word.len() && sub(a, at + 1),
        Node::WeakNext(a) => at + 1 >= word.len() || sub(a, at + 1),
        Node::Finally(i, a) => until(i, &|_| true, &|t| sub(a, t)),
        Node::Globally(i, a) => !until(i, &|_| true, &|t| !sub(a, t)),
        Node::Temporal(TemporalOp::Until, i, a, b) => until(i, &|t| sub(a, t), &|t| sub(b, t)),
        Node::Temporal(TemporalOp::Release, i, a, b) => !until(i, &|t| !sub(a, t), &|t| !sub(b, t)),
        Node::Temporal(TemporalOp::WeakUntil, i, a, b) => {
            let from_now = Interval { lo: 0, hi: i.hi };
            until(i, &|t| sub(a, t), &|t| sub(b, t)) || !until(&from_now, &|_| true, &|t| !sub(a, t))
        }
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
        let mut lasts: TiVec<FormulaId, Lasts> = TiVec::new();
        for (a, b) in earlier.nodes.iter().zip(&later.nodes) {
            lasts.push(node(a, b, longer, &lasts).expect("nodes of one kind"));
        }
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
