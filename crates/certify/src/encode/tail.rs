//! The paths of the other player that nothing follows: the formula is unrolled along them, state by state.

use super::{About, At, BEYOND, Copy, Encoder, Scope, Tail, View};
use crate::error::Error;
use crate::instance::{Action, Instance, Step, targets};
use crate::layer::{Acts, Lit, TRUE};
use hyperplan_problem::{ActionId, FormulaId, PathId};
use std::iter::successors;
use std::rc::Rc;

/// A step of a tail: where these are true it gets there; or, if it is none, it is no path.
struct Move {
    conditions: Vec<Lit>,
    to: Tail,
    is_none: bool,
}

impl<'p> Encoder<'p> {
    /// An instance that nothing follows: a copy up to its first own step, and what it does from there on.
    pub(super) fn tail(&mut self, own: &Instance, scope: &mut Scope) -> Result<usize, Error> {
        let (layers, acts) = self.beginning(own, scope)?;
        let begun = acts.len();
        if begun + own.steps.len() != self.horizons[usize::from(own.path)] as usize {
            return Err(self.wrong(own, "it has not as many steps as are read of it"));
        }
        let mut steps = 0;
        for (time, step) in own.steps.iter().enumerate().rev() {
            if let Action::Like(other) = step.action
                && self.acts_of(other, begun + time, scope).is_none()
            {
                return Err(self.wrong(own, "it takes an action of no step before it"));
            }
            let next = (*step, steps);
            steps = *self.numbers.entry(next).or_insert_with(|| {
                self.steps.push(next);
                self.steps.len()
            });
        }
        self.copies.push(Copy { guard: scope.guard.clone(), layers, acts });
        scope.tail = Some(Tail { path: own.path, at: At::Along(begun), took: None, steps });
        Ok(self.copies.len() - 1)
    }

    pub(super) fn acts_of(&self, path: PathId, time: usize, scope: &Scope) -> Option<Rc<Acts>> {
        let copy = scope.copies.get(usize::from(path)).copied().flatten()?;
        self.copies[copy].acts.get(time).cloned()
    }

    /// What a path with a tail does: the actions it can take.
    pub(super) fn taken(&self, action: Action, time: usize, scope: &Scope) -> Result<Rc<Acts>, Error> {
        match action {
            Action::Is(action) => Ok(Rc::new(vec![(action, TRUE)])),
            Action::Like(other) => self.acts_of(other, time, scope).ok_or(BEYOND),
        }
    }

    /// Where a tail can be after its next step, from each state in which it can be now. Where there is no such step it stays where
    /// it is: then it is no path, and it does not matter what is said of it.
    fn moves(&self, scope: &Scope, tail: Tail, time: usize) -> Result<Vec<Vec<Move>>, Error> {
        let Some(&(step, steps)) = self.steps.get(tail.steps.wrapping_sub(1)) else {
            // It is not read any more.
            let to = Tail { at: At::Anywhere, took: None, ..tail };
            return Ok(vec![vec![Move { conditions: Vec::new(), to, is_none: false }]]);
        };
        let graph = self.graph(tail.path);
        let next = |at: At| Tail { path: tail.path, at, took: Some(step.action), steps };
        let cells = match tail.at {
            At::State(state) => vec![(state, TRUE)],
            At::Along(_) => {
                let copy = scope.copies.get(usize::from(tail.path)).copied().flatten().ok_or(BEYOND)?;
                self.copies[copy].layers.get(time).ok_or(BEYOND)?.cells.clone()
            }
            At::Anywhere => {
                let to = next(At::Anywhere);
                return Ok(vec![vec![Move { conditions: Vec::new(), to, is_none: false }]]);
            }
        };
        let acts = self.taken(step.action, time, scope)?;
        let from = |&(state, x): &(u32, Lit)| {
            let by = |&(action, a): &(ActionId, Lit)| {
                let to = targets(&graph, state, action, self.lasting()).nth(step.outcome as usize);
                let there = next(At::State(to.unwrap_or(state)));
                Move { conditions: vec![-x, -a], to: there, is_none: to.is_none() }
            };
            acts.iter().map(by).collect()
        };
        Ok(cells.iter().map(from).collect())
    }

    /// The variable that a path with a tail is none, if that can be: it is true only if a step that it has to make is impossible.
    pub(super) fn ends(&mut self, scope: &Scope, tail: Tail) -> Result<Option<Lit>, Error> {
        let At::Along(begun) = tail.at else { return Ok(None) };
        // The steps are a list, of which each names the next.
        let next = |step: &(Step, usize)| self.steps.get(step.1.wrapping_sub(1)).copied();
        let first = self.steps.get(tail.steps.wrapping_sub(1)).copied();
        let is_sure = successors(first, next).all(|(step, _)| step.outcome == 0);
        if is_sure && !self.graph(tail.path).is_partial {
            return Ok(None);
        }
        let none = self.fresh();
        let horizon = self.horizons[usize::from(tail.path)] as usize;
        let mut open = vec![(none, tail, begun)];
        while let Some((lit, tail, time)) = open.pop() {
            if time >= horizon {
                self.add(&[], [-lit])?;
                continue;
            }
            for from in self.moves(scope, tail, time)? {
                let mut some = own(&from);
                some.push(-lit);
                for Move { conditions, to, is_none } in from {
                    let key = (to, before(scope, tail.path));
                    let later = match (is_none, self.nones.get(&key)) {
                        (true, _) => TRUE,
                        (false, Some(&known)) => known,
                        (false, None) => {
                            let later = self.fresh();
                            self.nones.insert(key, later);
                            open.push((later, to, time + 1));
                            later
                        }
                    };
                    self.add(&conditions, [-lit, later])?;
                    some.push(later);
                }
                self.add(&[], some)?;
            }
        }
        Ok(Some(none))
    }

    /// A literal that is true only if what `make` gives for the next time is, wherever the path with a tail is then.
    pub(super) fn later(
        &mut self,
        node: FormulaId,
        time: u32,
        view: &View,
        make: &mut dyn FnMut(&mut Self, &View) -> Result<Lit, Error>,
    ) -> Result<Lit, Error> {
        let own_steps = |tail: &Tail| !matches!(tail.at, At::Along(until) if (time as usize) < until);
        let reads = |tail: &Tail| self.reads[usize::from(node)].contains(&tail.path);
        let Some(mut tail) = view.tail.filter(own_steps).filter(reads) else { return make(self, view) };
        if !self.reads_states[usize::from(node)].contains(&tail.path) {
            tail.at = At::Anywhere;
        }
        let mut all: Vec<(Vec<Lit>, Lit)> = Vec::new();
        let mut clauses: Vec<Vec<Lit>> = Vec::new();
        for from in self.moves(&view.scope, tail, time as usize)? {
            // From this state it gets to one of the next.
            let mut some = own(&from);
            for Move { conditions, to, .. } in from {
                let there = View { scope: Rc::clone(&view.scope), tail: Some(to) };
                let lit = make(self, &there)?;
                some.push(lit);
                all.push((conditions, lit));
            }
            // Where there is one, the clause with the action says so.
            if some.len() > 2 {
                clauses.push(some);
            }
        }
        if let Some(&(_, first)) = all.first()
            && all.iter().all(|(_, lit)| *lit == first)
        {
            return Ok(first);
        }
        let lit = self.fresh();
        for (conditions, there) in all {
            self.add(&conditions, [-lit, there])?;
        }
        for some in clauses {
            self.add(&some, [-lit])?;
        }
        Ok(lit)
    }

    /// What something that reads these paths is about.
    pub(super) fn about(&self, paths: &[PathId], view: &View) -> About {
        let mut copies = vec![None; self.objective.paths.len()];
        for &path in paths {
            copies[usize::from(path)] = view.scope.copies[usize::from(path)];
        }
        let tail = view.tail.filter(|tail| paths.contains(&tail.path));
        if let Some(Tail { path, at: At::State(_) | At::Anywhere, .. }) = tail {
            // Its steps may depend on all paths before it.
            let before = before(&view.scope, path);
            copies[..before.len()].copy_from_slice(&before);
            copies[usize::from(path)] = None;
        }
        (copies, tail)
    }
}

/// The copies of the paths before one.
fn before(scope: &Scope, path: PathId) -> Vec<Option<usize>> {
    scope.copies.iter().take(usize::from(path)).copied().collect()
}

/// That moves are not from this state.
fn own(moves: &[Move]) -> Vec<Lit> {
    moves.iter().take(1).filter_map(|first| first.conditions.first().copied()).collect()
}
