//! The finitely many cases of a universally quantified path.
//!
//! A case is an [`Instance`]: a start and moves, each either "the same action as that path" or a given action. At a
//! step where the formula compares the path's action with that of a path before it, the case "the same" stands for
//! every action at once, and a given action need be considered only where it differs. The formula is progressed
//! along each partial case with what the case determines, the rest unknown; a case along which it becomes false has
//! no part in a violation and is left out. What remains covers every violating path.

use crate::goal::Goal;
use crate::instance::{Instance, Move, Start};
use crate::reads::in_state;
use crate::residual::{FALSE, MAX_ATOMS, Now, Residual, Residuals};
use crate::task::{Error, Task};
use hyperplan_problem::{ActionId, Expr, FormulaId, Node, PathId, PathLeaf};
use hyperplan_space::{Graph, Letter, StateIx, eval};

/// How the outcomes of actions are numbered in the moves of an instance.
pub trait Numbering {
    /// How many numbers the outcomes of an action take, where the graph has at most so many from one state.
    fn outcomes(&self, action: ActionId, most: u32) -> u32;

    /// The number of a step that the graph has.
    fn number(&self, graph: &Graph, from: StateIx, letter: Letter, to: StateIx) -> u32;

    /// Whether an action with one outcome everywhere can be followed by [`Move::Same`].
    fn shares_steps(&self) -> bool;
}

/// The instances that together cover every choice of a path with which its player can reach the goal.
///
/// # Errors
/// [`Error::TooManyCases`] beyond the limit.
pub fn cases(
    task: &Task<'_>,
    graph: &Graph,
    path: PathId,
    goal: &Goal,
    numbering: &dyn Numbering,
) -> Result<Vec<Instance>, Error> {
    let mut search = Search::new(task, graph, path, goal, numbering);
    let root = search.root;
    for &state in &graph.initial {
        if !task.lasts(graph, state, 0) {
            continue;
        }
        let now = search.now(Some(state), None, 0);
        let residual = search.residuals.progress(root, now);
        if residual != FALSE {
            search.extend(state, residual)?;
        }
    }
    Ok(search.found)
}

struct Search<'a> {
    task: &'a Task<'a>,
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
    numbering: &'a dyn Numbering,
    moves: Vec<Move>,
    visited: usize,
    found: Vec<Instance>,
}

impl<'a> Search<'a> {
    fn new(
        task: &'a Task<'a>,
        graph: &'a Graph,
        path: PathId,
        goal: &Goal,
        numbering: &'a dyn Numbering,
    ) -> Self {
        let mut atoms = Vec::new();
        let mut known: Vec<(FormulaId, u8)> = Vec::new();
        for (id, node) in task.objective.formula.nodes.iter_enumerated() {
            let Node::Atom(expr) = node else { continue };
            if atoms.len() < MAX_ATOMS && determined_by(expr, path) {
                known.push((id, atoms.len() as u8));
                atoms.push(expr);
            }
        }
        let bit = |id: FormulaId| known.binary_search_by_key(&id, |k| k.0).ok().map(|at| known[at].1);
        let (residuals, root) = Residuals::new(&task.objective.formula, goal, &bit);
        let mut outcomes: Vec<(ActionId, u32)> = Vec::new();
        for &(action, number) in &graph.letters {
            match outcomes.iter_mut().find(|o| o.0 == action) {
                Some(most) => most.1 = most.1.max(number + 1),
                None => outcomes.push((action, number + 1)),
            }
        }
        for (action, most) in &mut outcomes {
            *most = numbering.outcomes(*action, *most);
        }
        Search {
            task,
            numbering,
            graph,
            path,
            horizon: task.horizon(path) as usize,
            residuals,
            root,
            atoms,
            tied: task.objective.tied_before(path),
            outcomes,
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
        Now { bits, unknown, last: self.task.is_last(time) }
    }

    fn value(
        &self,
        expr: &Expr<PathLeaf>,
        state: Option<StateIx>,
        movement: Option<Move>,
        time: u32,
    ) -> Option<bool> {
        let mut known = true;
        let system = self.task.system(self.path);
        let value = eval(expr, &mut |leaf| {
            let value = match *leaf {
                PathLeaf::Took(_, wanted) => match movement {
                    None => Some(0),
                    Some(Move::Act(action, _)) => Some(i64::from(action == wanted)),
                    Some(Move::Same(_) | Move::SameAction(..)) => None,
                },
                PathLeaf::SameAction(p, q) => self.same(if p == self.path { q } else { p }, movement, time),
                PathLeaf::SameState(..) => None,
                PathLeaf::State(..) | PathLeaf::Enabled(..) | PathLeaf::Halted(_) => {
                    state.and_then(|s| in_state(system, self.graph, leaf, s))
                }
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
        self.tied.contains(&other) && step < self.task.horizon(other) as usize
    }

    fn extend(&mut self, start: StateIx, residual: Residual) -> Result<(), Error> {
        // An explicit stack: a case is as long as the horizon.
        let mut stack = vec![(0usize, Some(start), residual, None::<Move>)];
        while let Some((length, state, residual, movement)) = stack.pop() {
            self.moves.truncate(length.saturating_sub(1));
            self.moves.extend(movement);
            self.visited += 1;
            self.task.allow_cases(self.path, self.found.len().max(self.visited.div_ceil(256)))?;
            if length == self.horizon {
                let start = Start::State(self.graph.state(self.task.system(self.path), start));
                self.found.push(Instance { start, moves: self.moves.clone(), values: Vec::new() });
                continue;
            }
            let time = length as u32 + 1;
            for (movement, next) in self.branches(state, length) {
                if next.is_some_and(|s| !self.task.lasts(self.graph, s, time)) {
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
            if most == 1 && self.numbering.shares_steps() && self.task.same_system(self.path, other) {
                branches.push((Move::Same(other), None));
            } else {
                branches.extend((0..most).map(|number| (Move::SameAction(other, number), None)));
            }
        }
        match state {
            Some(state) => {
                for &(letter, next) in self.graph.successors(state) {
                    let action = self.graph.letters[letter as usize].0;
                    let number = self.numbering.number(self.graph, state, letter, next);
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
