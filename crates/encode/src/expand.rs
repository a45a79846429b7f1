//! The finitely many cases of a universally quantified path.
//!
//! A case is an [`Instance`]: a start and moves, each either "the same action as that path" or a given action. At a
//! step where the formula compares the path's action with that of a path before it, the case "the same" stands for
//! every action at once, and a given action need be considered only where it differs. The formula is progressed
//! along each partial case with what the case determines, the rest unknown; a case along which it becomes false has
//! no part in a violation and is left out. What remains covers every violating path.

use crate::eval::{eval, eval_in};
use crate::goal::Goal;
use crate::graph::{Graph, StateIx};
use crate::inputs::{Inputs, Move, Start};
use crate::moves::Moves;
use crate::reach::lasts;
use crate::residual::{FALSE, MAX_ATOMS, Now, Residual, Residuals};
use crate::{Encoder, Error};
use hyperplan_problem::{ActionId, Expr, FormulaId, Mode, Node, PathId, PathLeaf};

/// The cases of a path with which its player can reach the goal. Outcomes are numbered as in the graph, or, where
/// paths are symbolic, by the system's moves.
pub(crate) fn cases(
    encoder: &Encoder<'_>,
    graph: &Graph,
    path: PathId,
    goal: &Goal,
    moves: Option<&Moves>,
) -> Result<Vec<Inputs<StateIx>>, Error> {
    let mut search = Search::new(encoder, graph, path, goal, moves);
    let root = search.root;
    for &state in &graph.initial {
        if !lasts(encoder.objective.mode, graph, state, 0) {
            continue;
        }
        let now = search.now(Some(state), None, 0);
        let residual = search.residuals.progress(root, now);
        if residual != FALSE {
            search.start = Some(state);
            search.extend(Some(state), residual)?;
        }
    }
    Ok(search.found)
}

struct Search<'a> {
    encoder: &'a Encoder<'a>,
    graph: &'a Graph,
    path: PathId,
    horizon: usize,
    residuals: Residuals,
    root: Residual,
    atoms: Vec<&'a Expr<PathLeaf>>,
    /// Paths before this one whose actions the formula compares with its own.
    tied: Vec<PathId>,
    /// How many outcomes each action may have.
    outcomes: Vec<(ActionId, u32)>,
    symbolic: Option<&'a Moves>,
    start: Option<StateIx>,
    moves: Vec<Move>,
    visited: usize,
    found: Vec<Inputs<StateIx>>,
}

impl<'a> Search<'a> {
    fn new(
        encoder: &'a Encoder<'a>,
        graph: &'a Graph,
        path: PathId,
        goal: &Goal,
        symbolic: Option<&'a Moves>,
    ) -> Self {
        let mut atoms = Vec::new();
        let mut known: Vec<(FormulaId, u8)> = Vec::new();
        for (id, node) in encoder.objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            if atoms.len() < MAX_ATOMS && determined_by(expr, path) {
                known.push((id, atoms.len() as u8));
                atoms.push(expr);
            }
        }
        let bit = |id: FormulaId| known.binary_search_by_key(&id, |k| k.0).ok().map(|at| known[at].1);
        let (residuals, root) = Residuals::new(&encoder.objective.formula, goal, &bit);
        let mut outcomes: Vec<(ActionId, u32)> = Vec::new();
        for &(action, number) in &graph.letters {
            match outcomes.iter_mut().find(|o| o.0 == action) {
                Some(most) => most.1 = most.1.max(number + 1),
                None => outcomes.push((action, number + 1)),
            }
        }
        if let Some(moves) = symbolic {
            for (action, most) in outcomes.iter_mut().filter(|o| o.1 > 1) {
                *most = moves.of_action(*action).count() as u32;
            }
        }
        Search {
            encoder,
            symbolic,
            graph,
            path,
            horizon: encoder.horizon(path) as usize,
            residuals,
            root,
            atoms,
            tied: encoder.tied_before(path),
            outcomes,
            start: None,
            moves: Vec::new(),
            visited: 0,
            found: Vec::new(),
        }
    }

    /// What is known of the atoms where the path may be in a known state and has just made a known move.
    fn now(&self, state: Option<StateIx>, movement: Option<Move>, time: u32) -> Now {
        let (mut bits, mut unknown) = (0u64, 0u64);
        for (at, expr) in self.atoms.iter().enumerate() {
            match self.value(expr, state, movement, time) {
                Some(true) => bits |= 1 << at,
                Some(false) => {}
                None => unknown |= 1 << at,
            }
        }
        let last = matches!(self.encoder.objective.mode, Mode::Within(steps) if steps == time);
        Now { bits, unknown, last }
    }

    fn value(
        &self,
        expr: &Expr<PathLeaf>,
        state: Option<StateIx>,
        movement: Option<Move>,
        time: u32,
    ) -> Option<bool> {
        let mut known = true;
        let system = self.encoder.system(self.path);
        let value = eval(expr, &mut |leaf| {
            let value = match *leaf {
                PathLeaf::State(_, leaf) => {
                    state.map(|s| eval_in(system, &Expr::Leaf(leaf), self.graph.row(s)))
                }
                PathLeaf::Enabled(_, action) => state.map(|s| i64::from(self.graph.enables(s, action))),
                PathLeaf::Halted(_) => state.map(|s| i64::from(self.graph.halts(s))),
                PathLeaf::Took(_, wanted) => match movement {
                    None => Some(0),
                    Some(Move::Act(action, _)) => Some(i64::from(action == wanted)),
                    Some(Move::Same(_) | Move::SameAction(..)) => None,
                },
                PathLeaf::SameAction(p, q) => self.same(if p == self.path { q } else { p }, movement, time),
                PathLeaf::SameState(..) => None,
            };
            known &= value.is_some();
            value.unwrap_or(0)
        });
        known.then_some(value != 0)
    }

    /// Whether the move is the same action as another path's. A given action is considered only where it differs
    /// from those of the tied paths: elsewhere the case "the same" covers it.
    fn same(&self, other: PathId, movement: Option<Move>, time: u32) -> Option<i64> {
        match movement {
            _ if time == 0 || other == self.path => Some(1),
            Some(Move::Same(path) | Move::SameAction(path, _)) if path == other => Some(1),
            Some(Move::Act(..)) if self.can_follow(other, time as usize - 1) => Some(0),
            _ => None,
        }
    }

    /// Whether "the same action as that path" is among the cases of a step.
    fn can_follow(&self, other: PathId, step: usize) -> bool {
        self.tied.contains(&other) && step < self.encoder.horizon(other) as usize
    }

    fn extend(&mut self, state: Option<StateIx>, residual: Residual) -> Result<(), Error> {
        // An explicit stack: a case is as long as the horizon.
        let mut stack = vec![(0usize, state, residual, None::<Move>)];
        while let Some((length, state, residual, movement)) = stack.pop() {
            self.moves.truncate(length.saturating_sub(1));
            self.moves.extend(movement);
            self.visited += 1;
            if self.found.len() > self.encoder.limits.cases || self.visited > self.encoder.limits.cases * 256
            {
                return Err(Error::TooManyCases {
                    path: self.encoder.objective.paths[self.path].name.clone(),
                    limit: self.encoder.limits.cases,
                });
            }
            if length == self.horizon {
                let start = Start::State(self.start.unwrap_or(0));
                self.found.push(Inputs { start, moves: self.moves.clone(), values: Vec::new() });
                continue;
            }
            let time = length as u32 + 1;
            for (movement, next) in self.branches(state, length) {
                if next.is_some_and(|s| !lasts(self.encoder.objective.mode, self.graph, s, time)) {
                    continue;
                }
                let now = self.now(next, Some(movement), time);
                let rest = self.residuals.progress(residual, now);
                if rest != FALSE {
                    stack.push((length + 1, next, rest, Some(movement)));
                }
            }
        }
        self.moves.clear();
        Ok(())
    }

    /// The cases of one step, each with the state that it leads to where that is known.
    fn branches(&self, state: Option<StateIx>, step: usize) -> Vec<(Move, Option<StateIx>)> {
        let mut branches = Vec::new();
        for &other in &self.tied {
            if !self.can_follow(other, step) {
                continue;
            }
            let most = self.outcomes.iter().map(|o| o.1).max().unwrap_or(1);
            if most == 1 && self.symbolic.is_none() && self.encoder.same_system(self.path, other) {
                branches.push((Move::Same(other), None));
            } else {
                branches.extend((0..most).map(|number| (Move::SameAction(other, number), None)));
            }
        }
        match state {
            Some(state) => {
                for &(letter, next) in self.graph.successors(state) {
                    let (action, mut number) = self.graph.letters[letter as usize];
                    if let Some(moves) = self.symbolic {
                        let system = self.encoder.system(self.path);
                        let (from, to) = (self.graph.state(system, state), self.graph.state(system, next));
                        number = moves.number_of(system, &from, action, &to).unwrap_or(0);
                    }
                    branches.push((Move::Act(action, number), Some(next)));
                }
            }
            None => {
                for &(action, most) in &self.outcomes {
                    branches.extend((0..most).map(|number| (Move::Act(action, number), None)));
                }
            }
        }
        branches
    }
}

/// Whether a case of the path can determine the atom: it reads that path, or compares its action with another's.
fn determined_by(expr: &Expr<PathLeaf>, path: PathId) -> bool {
    let mut yes = true;
    expr.for_each_leaf(&mut |leaf| {
        yes &= match *leaf {
            PathLeaf::State(p, _) | PathLeaf::Took(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
                p == path
            }
            PathLeaf::SameAction(p, q) => p == path || q == path,
            PathLeaf::SameState(..) => false,
        };
    });
    yes
}
