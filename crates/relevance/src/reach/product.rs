//! The explored paths together with what is left of the goal.

use super::atoms::{Atoms, Bits};
use super::question::{Place, Question};
use crate::residual::{Now, Residual, Residuals};
use hyperplan_problem::{FormulaId, Node};
use hyperplan_space::Graph;
use std::ops::Range;

pub(crate) struct Product<'a, const N: usize> {
    pub(crate) question: &'a Question<'a, N>,
    pub(crate) graphs: [&'a Graph; N],
    /// The last time that one of the paths is read at.
    pub(crate) horizon: u32,
    pub(super) atoms: Atoms<'a, N>,
    pub(crate) residuals: Residuals,
    pub(crate) initial: Residual,
}

impl<'a, const N: usize> Product<'a, N> {
    pub(crate) fn new(question: &'a Question<'a, N>) -> Self {
        let task = &question.arena.task;
        let graphs = question.paths.map(|path| &*question.arena.graphs[path]);
        let horizon = question.paths.iter().map(|&path| task.horizon(path)).max().unwrap_or(0);
        let atoms = Atoms::new(question, graphs, horizon);
        let bit = |id: FormulaId| atoms.bit.get(&id).copied();
        let formula = &task.objective.formula;
        let (residuals, initial) = Residuals::settling(formula, question.goal, atoms.settling, &bit);
        Product { question, graphs, horizon, atoms, residuals, initial }
    }

    /// The values of the atoms where the paths enter these places at a time.
    pub(crate) fn bits(&mut self, places: &[Place; N], time: u32) -> Bits {
        self.atoms.bits(self.question, &self.graphs, places, time)
    }

    /// What is left once the atoms have these values at a time.
    pub(crate) fn progress(&mut self, before: Residual, bits: Bits, time: u32) -> Residual {
        let last = self.question.arena.task.is_last(time);
        self.residuals.progress(before, Now { bits: bits.holds, unknown: bits.unknown, last })
    }

    /// The values of the atoms where the paths enter these places at any time, as far as these tell.
    pub(crate) fn own_bits(&mut self, places: &[Place; N]) -> Bits {
        self.atoms.own_bits(self.question, &self.graphs, places)
    }

    /// What is left once these are the values at any time, relaxed.
    pub(crate) fn relaxed(&mut self, before: Residual, bits: Bits) -> Residual {
        self.residuals.progress(before, Now { bits: bits.holds, unknown: bits.unknown, last: false })
    }

    /// Whether nothing but safety is owed any more.
    pub(super) fn owes_nothing(&self, residual: Residual) -> bool {
        self.residuals.owes_nothing(residual)
    }

    /// The atoms that read other explored paths than those in a range, one bit each.
    pub(crate) fn reading_beside(&self, paths: &Range<usize>) -> u64 {
        let formula = &self.question.arena.task.objective.formula;
        let beside =
            |path| self.question.paths.iter().position(|&p| p == path).is_some_and(|at| !paths.contains(&at));
        let reads = |id: FormulaId| match &formula.nodes[id] {
            Node::Atom(expr) => {
                let mut reads = false;
                expr.for_each_leaf(&mut |leaf| reads |= leaf.paths().into_iter().flatten().any(beside));
                reads
            }
            _ => false,
        };
        self.atoms.bit.iter().filter(|(id, _)| reads(**id)).fold(0, |all, (_, bit)| all | 1 << bit)
    }

    /// Whether every atom of the formula is known.
    pub(crate) fn knows_all(&self) -> bool {
        let nodes = &self.question.arena.task.objective.formula.nodes;
        let atoms =
            nodes.iter().filter(|node| matches!(node, Node::Atom(e) if !e.is_true() && !e.is_false()));
        atoms.count() == self.atoms.bit.len()
    }
}
