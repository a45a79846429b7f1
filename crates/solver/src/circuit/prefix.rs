//! The quantifiers of a script, moved to its front.
//!
//! Each node is one proposition, however often it is used, so a quantifier that is only used in one direction may be moved
//! out as a whole: a formula that is monotone in `forall y. P` is true if and only if, for all `y`, it is with `P`. Order
//! is only asked for between a quantifier and those inside of it.

use hyperplan_smt::{Op, Sort, Term, Terms, View};

use super::cnf::flip;
use super::{BOTH, POSITIVE};

/// The variables that quantifiers bind, by level.
pub(crate) struct Prefix {
    /// Of each level its variables. Those of even levels are existential, as declared symbols are, which come first; the others
    /// are universal.
    pub(crate) levels: Vec<Vec<Term>>,
}

impl Prefix {
    /// The prefix of what was asserted; `None` where a quantifier is used in both directions, as under an equality, or a
    /// variable is bound twice.
    pub(crate) fn of(terms: &Terms, asserted: &[Term]) -> Option<Prefix> {
        let (mut nodes, mut seen) = (Vec::new(), Vec::new());
        terms.reach(asserted, &mut seen, &mut nodes);
        nodes.sort_unstable();
        let mut walk = Walk { used: vec![(0, 0); terms.len()] };
        for &t in asserted {
            walk.uses(t, POSITIVE, 0);
        }
        let mut prefix = Prefix { levels: vec![Vec::new()] };
        let mut bound_before = vec![false; terms.len()];
        // Parents come before their children.
        for &t in nodes.iter().rev().filter(|&&t| terms.is_quantified(t)) {
            let (directions, level) = walk.used[t.index()];
            match terms.view(t) {
                View::App(Op::And, conjuncts) => {
                    conjuncts.iter().for_each(|&t| walk.uses(t, directions, level));
                }
                View::App(Op::Ite, &[c, a, b]) if terms.sort(t) == Sort::Bool => {
                    walk.uses(c, BOTH, level);
                    walk.uses(a, directions, level);
                    walk.uses(b, directions, level);
                }
                View::Forall(bound, body) => {
                    let universal = directions == POSITIVE;
                    if directions == BOTH {
                        return None;
                    }
                    let level = level + usize::from((level % 2 == 1) != universal);
                    prefix.levels.resize_with(prefix.levels.len().max(level + 1), Vec::new);
                    for &variable in bound {
                        if std::mem::replace(&mut bound_before[variable.index()], true) {
                            return None;
                        }
                        prefix.levels[level].push(variable);
                    }
                    walk.uses(body, directions, level);
                }
                _ => terms.children(t).iter().for_each(|&t| walk.uses(t, BOTH, level)),
            }
        }
        Some(prefix)
    }
}

struct Walk {
    /// Per node: in which directions it is used, and how deep.
    used: Vec<(u8, usize)>,
}

impl Walk {
    fn uses(&mut self, t: Term, directions: u8, level: usize) {
        let directions = if t.is_negated() { flip(directions) } else { directions };
        let (known, deepest) = &mut self.used[t.index()];
        *known |= directions;
        *deepest = level.max(*deepest);
    }
}
