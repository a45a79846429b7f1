//! What the table of operators says that an operator is short for is what it is lowered to.

use super::ok;
use crate::{Expr, Formula, FormulaId, Node};
use hyperplan_syntax::operator::{Fixity, TABLE};

/// The core of a formula over the variables `f` and `g`.
fn core(body: &str) -> String {
    let system = "system S { state f: bool, g: bool; action stay; on stay {} }";
    let read = ok(&format!("{system} objective o {{ exists p. {body} }}"));
    let formula = &read.problem.objectives[0].formula;
    shown(formula, formula.root())
}

fn shown(formula: &Formula, id: FormulaId) -> String {
    let of = |id: &FormulaId| shown(formula, *id);
    let all = |ids: &[FormulaId]| ids.iter().map(of).collect::<Vec<_>>().join(" ");
    match &formula.nodes[id] {
        // As part of an operator it is no atom, but the same otherwise.
        Node::Atom(e) if e.is_true() => "(and )".to_owned(),
        Node::Atom(e) if e.is_false() => "(or )".to_owned(),
        Node::Atom(Expr::Leaf(leaf)) => format!("{leaf:?}"),
        Node::Atom(e) => panic!("{e:?} is no variable"),
        Node::Not(a) => format!("(not {})", of(a)),
        Node::And(ids) => format!("(and {})", all(ids)),
        Node::Or(ids) => format!("(or {})", all(ids)),
        Node::Iff(a, b) => format!("(iff {} {})", of(a), of(b)),
        Node::Next(a) => format!("(next {})", of(a)),
        Node::WeakNext(a) => format!("(weak-next {})", of(a)),
        Node::Until(i, a, b) => format!("(until {i:?} {} {})", of(a), of(b)),
        Node::Release(i, a, b) => format!("(release {i:?} {} {})", of(a), of(b)),
    }
}

#[test]
fn what_is_short_for_something_means_it() {
    for row in TABLE {
        let Some(means) = row.means else { continue };
        let written = match row.fixity {
            Fixity::Prefix => format!("{}[2,5] f[p]", row.name),
            _ if row.interval => format!("f[p] {}[2,5] g[p]", row.name),
            _ => format!("f[p] {} g[p]", row.name),
        };
        let word = |word: &str| match word {
            "f" => "f[p]".to_owned(),
            "g" => "g[p]".to_owned(),
            "a" => "2".to_owned(),
            "b" => "5".to_owned(),
            other => other.to_owned(),
        };
        let pieces: String = means
            .split_inclusive(|c: char| !c.is_alphanumeric())
            .map(|piece| {
                let end = piece.trim_end_matches(|c: char| !c.is_alphanumeric()).len();
                word(&piece[..end]) + &piece[end..]
            })
            .collect();
        assert_eq!(core(&written), core(&pieces), "{written} is {pieces}");
    }
}
