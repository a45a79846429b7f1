//! What one player wants of the formula, taken apart.
//!
//! The player of a block wants the formula at one truth value, which often is a conjunction of parts: "start on the
//! start, and reach the goal, and ...". Parts that read no path of a later block can be demanded of the block at once;
//! the other player then need only be asked about the others, and what the others leave to be met prunes better.

use hyperplan_problem::{Formula, FormulaId, Node, Objective, PathId, Problem, display};
use rustc_hash::FxHashSet;

/// That all, or at least one, of some subformulas have given truth values.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Goal {
    /// The subformulas with their values.
    pub parts: Vec<(FormulaId, bool)>,
    /// Whether all are wanted; else one.
    pub all: bool,
}

impl Goal {
    /// That the whole formula has this truth value.
    pub fn new(formula: &Formula, want: bool) -> Goal {
        Goal { parts: conjuncts(formula, formula.root(), want), all: true }
    }

    /// That this goal is not met: what the other player wants.
    pub fn opposed(&self, formula: &Formula) -> Goal {
        match self.parts.as_slice() {
            [(only, want)] => Goal { parts: conjuncts(formula, *only, !want), all: true },
            parts => Goal { parts: parts.iter().map(|&(id, want)| (id, !want)).collect(), all: !self.all },
        }
    }

    /// The parts of a conjunction, each by itself; else the goal.
    pub fn conjuncts(&self) -> Vec<Goal> {
        if !self.all {
            return vec![self.clone()];
        }
        self.parts.iter().map(|&part| Goal { parts: vec![part], all: true }).collect()
    }

    /// The least number of its subformulas, and the goal in the language's words.
    pub fn described(&self, problem: &Problem, objective: &Objective) -> (usize, String) {
        let number = self.parts.iter().map(|(id, _)| usize::from(*id)).min().unwrap_or(0);
        let part = |&(id, want): &(FormulaId, bool)| {
            let text = display::formula(problem, objective, id);
            if want { text } else { format!("!({text})") }
        };
        let parts: Vec<String> = self.parts.iter().map(part).collect();
        (number, parts.join(if self.all { " & " } else { " | " }))
    }

    /// Nothing at all.
    pub fn nothing() -> Goal {
        Goal { parts: Vec::new(), all: true }
    }

    /// Whether nothing is wanted.
    pub fn is_empty(&self) -> bool {
        self.all && self.parts.is_empty()
    }

    /// The parts that read only these paths, which can be demanded of them alone, and the rest.
    pub fn split(&self, formula: &Formula, paths: &dyn Fn(PathId) -> bool) -> (Goal, Goal) {
        let (own, rest) = if self.all {
            self.parts.iter().partition(|part| reads_only(formula, part.0, paths))
        } else {
            (Vec::new(), self.parts.clone())
        };
        (Goal { parts: own, all: true }, Goal { parts: rest, all: self.all })
    }
}

/// The parts of a conjunction, through whatever operators amount to one.
fn conjuncts(formula: &Formula, id: FormulaId, want: bool) -> Vec<(FormulaId, bool)> {
    let mut found = Vec::new();
    let mut stack = vec![(id, want)];
    while let Some((id, want)) = stack.pop() {
        match (&formula.nodes[id], want) {
            (Node::And(ids), true) | (Node::Or(ids), false) => {
                stack.extend(ids.iter().rev().map(|&i| (i, want)))
            }
            (Node::Not(a), _) => stack.push((*a, !want)),
            _ => found.push((id, want)),
        }
    }
    found
}

fn reads_only(formula: &Formula, id: FormulaId, paths: &dyn Fn(PathId) -> bool) -> bool {
    let mut seen: FxHashSet<FormulaId> = FxHashSet::default();
    let mut stack = vec![id];
    while let Some(id) = stack.pop() {
        if !seen.insert(id) {
            continue;
        }
        match &formula.nodes[id] {
            Node::Atom(expr) => {
                let mut only = true;
                expr.for_each_leaf(&mut |leaf| only &= leaf.paths().into_iter().flatten().all(paths));
                if !only {
                    return false;
                }
            }
            node => stack.extend(node.children()),
        }
    }
    true
}
