//! The formula along the paths of a branch.

use super::{At, Encoder, Goal, Read, Scope, Tail, View};
use crate::error::Error;
use crate::layer::{FALSE, Lit, TRUE};
use crate::reading::alone;
use hyperplan_problem::{Expr, FormulaId, Interval, Mode, Node, PathLeaf, Value};
use std::rc::Rc;

impl<'p> Encoder<'p> {
    /// The formula comes out as the player wants, unless an instance is none.
    pub(super) fn demand(&mut self, scope: &Scope) -> Result<(), Error> {
        let view = View { scope: Rc::new(scope.clone()), tail: scope.tail };
        let root = self.objective.formula.root();
        let lit = self.part(root, 0, self.wants(), &view)?;
        self.add(&scope.guard, [lit])?;
        while let Some((lit, goal, view)) = self.open.pop() {
            self.expand(lit, goal, &view)?;
        }
        Ok(())
    }

    /// A part of the formula at a time.
    fn part(&mut self, node: FormulaId, time: u32, positive: bool, view: &View) -> Result<Lit, Error> {
        let constant = |holds: bool| Ok(if holds == positive { TRUE } else { FALSE });
        let within = match self.objective.mode {
            Mode::Within(steps) => Some(steps.saturating_sub(time)),
            Mode::Bounded => None,
        };
        let objective = self.objective;
        match &objective.formula.nodes[node] {
            Node::Not(a) => return self.part(*a, time, !positive, view),
            Node::And(all) if all.is_empty() => return constant(true),
            Node::Or(all) if all.is_empty() => return constant(false),
            // Beyond the last position strong next fails, and weak next holds.
            Node::Next(_) if within == Some(0) => return constant(false),
            Node::WeakNext(_) if within == Some(0) => return constant(true),
            Node::Next(a) | Node::WeakNext(a) if view.tail.is_none() => {
                return self.part(*a, time + 1, positive, view);
            }
            // The state of a path may be all that it reads.
            Node::Atom(expr @ (Expr::Leaf(_) | Expr::Compare(..))) => {
                return self.truth(expr, time, positive, view);
            }
            Node::Until(Interval { lo, hi }, ..) | Node::Release(Interval { lo, hi }, ..) => {
                let hi = hi.unwrap_or(u32::MAX).min(within.unwrap_or(u32::MAX));
                if *lo > hi {
                    return constant(matches!(objective.formula.nodes[node], Node::Release(..)));
                }
                return Ok(self.goal(Goal { node, time, rest: (*lo, hi), positive }, view));
            }
            Node::And(_)
            | Node::Or(_)
            | Node::Iff(..)
            | Node::Atom(_)
            | Node::Next(_)
            | Node::WeakNext(_) => {}
        }
        Ok(self.goal(Goal { node, time, rest: (0, 0), positive }, view))
    }

    /// The variable of a part; what it says is written later.
    pub(super) fn goal(&mut self, goal: Goal, view: &View) -> Lit {
        let mut view = view.clone();
        if let Some(Tail { path, at: at @ At::State(_), .. }) = &mut view.tail
            && !self.reads_states[usize::from(goal.node)].contains(path)
        {
            *at = At::Anywhere;
        }
        let key = (goal, self.about(&self.reads[usize::from(goal.node)], &view));
        if let Some(&lit) = self.goals.get(&key) {
            return lit;
        }
        let lit = self.fresh();
        self.goals.insert(key, lit);
        self.open.push((lit, goal, view));
        lit
    }

    /// Writes that a part is true if its variable is.
    fn expand(&mut self, lit: Lit, goal: Goal, view: &View) -> Result<(), Error> {
        let Goal { node, time, rest: (lo, hi), positive } = goal;
        let objective = self.objective;
        match &objective.formula.nodes[node] {
            Node::Atom(expr) => {
                let holds = self.truth(expr, time, positive, view)?;
                self.add(&[], [-lit, holds])
            }
            both @ (Node::And(all) | Node::Or(all)) => {
                let mut some = vec![-lit];
                for &a in all {
                    some.push(self.part(a, time, positive, view)?);
                }
                match matches!(both, Node::And(_)) == positive {
                    true => some[1..].iter().try_for_each(|&a| self.add(&[], [-lit, a])),
                    false => self.add(&[], some),
                }
            }
            Node::Iff(a, b) => {
                let (yes, no) = (self.part(*a, time, true, view)?, self.part(*a, time, false, view)?);
                let same = self.part(*b, time, positive, view)?;
                let other = self.part(*b, time, !positive, view)?;
                self.add(&[], [-lit, no, same])?;
                self.add(&[], [-lit, yes, other])
            }
            both @ (Node::Until(_, left, right) | Node::Release(_, left, right)) => {
                // The negation of an until is the release of the negations.
                let strong = matches!(both, Node::Until(..)) == positive;
                let later = |encoder: &mut Self| {
                    let step = encoder.part(*left, time, positive, view)?;
                    let rest = (lo.saturating_sub(1), hi - 1);
                    let goal = Goal { node, time: time + 1, rest, positive };
                    let next = encoder.later(node, time, view, &mut |own, view| Ok(own.goal(goal, view)))?;
                    Ok::<_, Error>((step, next))
                };
                if lo > 0 {
                    let (step, next) = later(self)?;
                    if strong {
                        self.add(&[], [-lit, step])?;
                        return self.add(&[], [-lit, next]);
                    }
                    return self.add(&[], [-lit, step, next]);
                }
                let now = self.part(*right, time, positive, view)?;
                let more = if hi > 0 { Some(later(self)?) } else { None };
                match (strong, more) {
                    (true, Some((step, next))) => {
                        self.add(&[], [-lit, now, step])?;
                        self.add(&[], [-lit, now, next])
                    }
                    (false, Some((step, next))) => {
                        self.add(&[], [-lit, now])?;
                        self.add(&[], [-lit, step, next])
                    }
                    (_, None) => self.add(&[], [-lit, now]),
                }
            }
            Node::Next(a) | Node::WeakNext(a) => {
                let next =
                    self.later(*a, time, view, &mut |own, view| own.part(*a, time + 1, positive, view))?;
                self.add(&[], [-lit, next])
            }
            Node::Not(_) => Err(Error::Malformed { what: "a negation has a variable of its own" }),
        }
    }

    /// A literal that is true only if the expression is (or is not, where `positive` is false).
    fn truth(
        &mut self,
        expr: &'p Expr<PathLeaf>,
        time: u32,
        positive: bool,
        view: &View,
    ) -> Result<Lit, Error> {
        let sign = |lit: Lit| if positive { lit } else { -lit };
        match expr {
            Expr::Const(value) => Ok(sign(if *value == Value::Bool(true) { TRUE } else { FALSE })),
            Expr::Not(a) => self.truth(a, time, !positive, view),
            _ if alone(expr).is_some() => {
                let order = self.order(Read::Expr(std::ptr::from_ref(expr) as usize), expr, time, view)?;
                Ok(sign(order.at_least(1)))
            }
            Expr::And(all) | Expr::Or(all) => {
                let lit = self.fresh();
                let mut some = vec![-lit];
                for a in all {
                    some.push(self.truth(a, time, positive, view)?);
                }
                match matches!(expr, Expr::And(_)) == positive {
                    true => some[1..].iter().try_for_each(|&a| self.add(&[], [-lit, a]))?,
                    false => self.add(&[], some)?,
                }
                Ok(lit)
            }
            Expr::Iff(a, b) => {
                let (yes, no) = (self.truth(a, time, true, view)?, self.truth(a, time, false, view)?);
                let (same, other) =
                    (self.truth(b, time, positive, view)?, self.truth(b, time, !positive, view)?);
                let lit = self.fresh();
                self.add(&[], [-lit, no, same])?;
                self.add(&[], [-lit, yes, other])?;
                Ok(lit)
            }
            Expr::If(branches, last) => {
                let mut rest = self.truth(last, time, positive, view)?;
                for (condition, value) in branches.iter().rev() {
                    let (yes, no) =
                        (self.truth(condition, time, true, view)?, self.truth(condition, time, false, view)?);
                    let value = self.truth(value, time, positive, view)?;
                    let lit = self.fresh();
                    self.add(&[], [-lit, no, value])?;
                    self.add(&[], [-lit, yes, rest])?;
                    rest = lit;
                }
                Ok(rest)
            }
            _ => Ok(sign(self.atom(expr, time, view)?)),
        }
    }
}
