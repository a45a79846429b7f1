//! From a typed formula to a residual over elementary atoms.

use crate::horizon::paths_of;
use crate::report::Error;
use crate::residual::{AtomId, Bounds, Connective, ResidualId, Residuals};
use hyperplan_problem::{Expr, FormulaId, Interval, Mode, Node, Objective, PathId, PathLeaf, Value};
use typed_index_collections::TiVec;

/// A Boolean expression without Boolean structure at its root.
#[derive(Clone, Debug)]
pub(crate) struct Atom {
    pub(crate) expr: Expr<PathLeaf>,
    /// The paths that it reads, sorted.
    pub(crate) paths: Vec<PathId>,
    /// Whether it reads their states.
    pub(crate) reads_states: bool,
    /// Whether it reads the actions just taken.
    pub(crate) reads_actions: bool,
    /// Whether it asks which transitions there are.
    pub(crate) reads_enabled: bool,
}

impl Atom {
    fn new(expr: Expr<PathLeaf>) -> Self {
        let mut atom =
            Atom { expr, paths: Vec::new(), reads_states: false, reads_actions: false, reads_enabled: false };
        let mut paths = Vec::new();
        let (mut states, mut actions, mut enabled) = (false, false, false);
        atom.expr.for_each_leaf(&mut |leaf| {
            paths.extend(paths_of(leaf).into_iter().flatten());
            match leaf {
                PathLeaf::State(..) | PathLeaf::SameState(..) => states = true,
                PathLeaf::Took(..) | PathLeaf::SameAction(..) => actions = true,
                PathLeaf::Enabled(..) | PathLeaf::Halted(_) => (states, enabled) = (true, true),
            }
        });
        paths.sort_unstable();
        paths.dedup();
        (atom.paths, atom.reads_states, atom.reads_actions, atom.reads_enabled) =
            (paths, states, actions, enabled);
        atom
    }
}

/// A formula and its negation.
pub(crate) type Pair = (ResidualId, ResidualId);

struct Translation<'a> {
    residuals: &'a mut Residuals,
    atoms: TiVec<AtomId, Atom>,
}

/// The objective's formula as a residual that is read from position 0 on, and its atoms.
pub(crate) fn translate(
    objective: &Objective,
    residuals: &mut Residuals,
) -> Result<(ResidualId, TiVec<AtomId, Atom>), Error> {
    let (done, atoms) = translated(objective, residuals)?;
    let root =
        done.last().map(|pair| pair.0).ok_or(Error::Malformed { what: "an objective has no formula" })?;
    Ok((root, atoms))
}

/// Every part of the objective's formula, and its negation, as residuals that are read from position 0 on, and all atoms.
pub(crate) fn translated(
    objective: &Objective,
    residuals: &mut Residuals,
) -> Result<(Vec<Pair>, TiVec<AtomId, Atom>), Error> {
    let mut t = Translation { residuals, atoms: TiVec::new() };
    let mut done: Vec<Pair> = Vec::with_capacity(objective.formula.nodes.len());
    for node in &objective.formula.nodes {
        let pair = t.node(objective.mode, node, &done)?;
        done.push(pair);
    }
    Ok((done, t.atoms))
}

impl Translation<'_> {
    fn node(&mut self, mode: Mode, node: &Node, done: &[Pair]) -> Result<Pair, Error> {
        let of = |id: &FormulaId| {
            let pair = done.get(usize::from(*id)).copied();
            pair.ok_or(Error::Malformed { what: "a formula node stands before its operands" })
        };
        let all = |ids: &[FormulaId]| ids.iter().map(of).collect::<Result<Vec<Pair>, Error>>();
        Ok(match node {
            Node::Atom(expr) => self.boolean(expr),
            Node::Not(a) => {
                let (a, not_a) = of(a)?;
                (not_a, a)
            }
            Node::And(ids) => self.connect(Connective::And, &all(ids)?),
            Node::Or(ids) => self.connect(Connective::Or, &all(ids)?),
            Node::Iff(a, b) => self.iff(of(a)?, of(b)?),
            Node::Next(a) => self.next(Connective::Or, of(a)?),
            Node::WeakNext(a) => self.next(Connective::And, of(a)?),
            Node::Until(i, a, b) => self.temporal(Connective::Or, bounds(mode, i)?, of(a)?, of(b)?),
            Node::Release(i, a, b) => self.temporal(Connective::And, bounds(mode, i)?, of(a)?, of(b)?),
        })
    }

    fn connect(&mut self, kind: Connective, operands: &[Pair]) -> Pair {
        let positive = self.residuals.connect(kind, operands.iter().map(|p| p.0));
        let negative = self.residuals.connect(kind.dual(), operands.iter().map(|p| p.1));
        (positive, negative)
    }

    fn iff(&mut self, a: Pair, b: Pair) -> Pair {
        let (not_a, not_b) = ((a.1, a.0), (b.1, b.0));
        let both = self.connect(Connective::And, &[a, b]);
        let neither = self.connect(Connective::And, &[not_a, not_b]);
        let positive = self.residuals.connect(Connective::Or, [both.0, neither.0]);
        let one = self.connect(Connective::And, &[a, not_b]);
        let other = self.connect(Connective::And, &[not_a, b]);
        let negative = self.residuals.connect(Connective::Or, [one.0, other.0]);
        (positive, negative)
    }

    fn next(&mut self, kind: Connective, (a, not_a): Pair) -> Pair {
        (self.residuals.next(kind, a), self.residuals.next(kind.dual(), not_a))
    }

    fn temporal(&mut self, kind: Connective, bounds: Bounds, lhs: Pair, rhs: Pair) -> Pair {
        let positive = self.residuals.temporal(kind, bounds, lhs.0, rhs.0);
        let negative = self.residuals.temporal(kind.dual(), bounds, lhs.1, rhs.1);
        (positive, negative)
    }

    /// Takes an expression's Boolean structure apart, so that its atoms depend on as few paths as can be.
    fn boolean(&mut self, expr: &Expr<PathLeaf>) -> Pair {
        match expr {
            Expr::Const(Value::Bool(true)) => (ResidualId::TRUE, ResidualId::FALSE),
            Expr::Const(Value::Bool(false)) => (ResidualId::FALSE, ResidualId::TRUE),
            Expr::Not(a) => {
                let (a, not_a) = self.boolean(a);
                (not_a, a)
            }
            Expr::And(es) => self.all(Connective::And, es),
            Expr::Or(es) => self.all(Connective::Or, es),
            Expr::Iff(a, b) => {
                let (a, b) = (self.boolean(a), self.boolean(b));
                self.iff(a, b)
            }
            Expr::If(branches, last) => {
                let last = self.boolean(last);
                branches.iter().rev().fold(last, |rest, (c, a)| {
                    let (c, a) = (self.boolean(c), self.boolean(a));
                    let then = self.connect(Connective::Or, &[(c.1, c.0), a]);
                    let otherwise = self.connect(Connective::Or, &[c, rest]);
                    self.connect(Connective::And, &[then, otherwise])
                })
            }
            _ => self.atom(expr),
        }
    }

    fn all(&mut self, kind: Connective, es: &[Expr<PathLeaf>]) -> Pair {
        let pairs: Vec<Pair> = es.iter().map(|e| self.boolean(e)).collect();
        self.connect(kind, &pairs)
    }

    fn atom(&mut self, expr: &Expr<PathLeaf>) -> Pair {
        let known = self.atoms.iter_enumerated().find(|(_, a)| a.expr == *expr).map(|(id, _)| id);
        let id = known.unwrap_or_else(|| self.atoms.push_and_get_key(Atom::new(expr.clone())));
        (self.residuals.literal(id, true), self.residuals.literal(id, false))
    }
}

fn bounds(mode: Mode, interval: &Interval) -> Result<Bounds, Error> {
    if mode == Mode::Bounded && interval.hi.is_none() {
        return Err(Error::Malformed { what: "an unbounded operator without `within`" });
    }
    if interval.hi.is_some_and(|hi| hi < interval.lo) {
        return Err(Error::Malformed { what: "an interval ends before it begins" });
    }
    Ok(Bounds { lo: interval.lo, hi: interval.hi })
}
