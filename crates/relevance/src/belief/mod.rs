//! The leading player's search over what the other player may be up to, without a solver.
//!
//! Where a second block of quantifiers is the last, a prefix of the leading paths leaves the other player finitely many
//! chances: a state for each of its paths, together with what the goal still asks for there. The set of all of them is a
//! *belief*, as in planning with incomplete information (Bonet and Geffner): which of them is the true one the leading
//! paths do not know, as their choice may not depend on the others. It has to be empty in the end, as a chance is gone once
//! nothing more can be asked for. A chance that becomes `false` loses.
//!
//! The search is depth first, with what was learnt from failing: for a node, the chances by which each of its moves failed,
//! traced back, are a *nogood*. A belief that includes a nogood of the same leading states at the same time need not be
//! searched. This is conflict-directed backjumping with learning (Dechter), the constraint being that no chance be missed.
//!
//! Soundness. Chances are dropped where the goal's rest is `true`, where the other player's path is none (it cannot go on as
//! long as the mode demands), and where its own [`Layers`] say that it can do no harm. What the goal asks of the leading paths
//! alone is followed beside the belief. So a run that is found is a strategy; and that none is found means that there is none,
//! as every run of the leading paths is looked at that no nogood excludes.

mod chances;
mod search;

use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::{self, Explored, Question};
use crate::task::{Arena, Error};
use chances::Chances;
use hyperplan_problem::PathId;
use hyperplan_space::Run;
use rustc_hash::FxHashMap;
use search::Search;

/// What a search came to.
pub enum Belief<R> {
    /// A run for each path of the leading block.
    Found(R),
    /// There are none.
    Hopeless,
    /// The budget was not enough.
    Open,
    /// The objective is not of the kind.
    Unfit,
}

impl<R> Belief<R> {
    /// The same about something made of what was found.
    pub fn map<S>(self, f: impl FnOnce(R) -> S) -> Belief<S> {
        match self {
            Belief::Found(found) => Belief::Found(f(found)),
            Belief::Hopeless => Belief::Hopeless,
            Belief::Open => Belief::Open,
            Belief::Unfit => Belief::Unfit,
        }
    }
}

/// Searches for runs of the leading block that meet the goal whatever the other block, the last, does. `budget` is in chances
/// looked at.
///
/// Runs that are hardly longer than the shortest leave the other player least to do, so they are tried first.
///
/// # Errors
/// [`Error::Interrupted`], and [`Error::TooLarge`] where too much can matter of a path alone.
pub fn believe(
    arena: &Arena<'_>,
    leading: usize,
    goal: &Goal,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    let paths: Vec<PathId> = arena.task.objective.paths.keys().collect();
    match *paths.as_slice() {
        [p, q] => narrowed(arena, [p, q], leading, goal, budget),
        [p, q, r] => narrowed(arena, [p, q, r], leading, goal, budget),
        [p, q, r, s] => narrowed(arena, [p, q, r, s], leading, goal, budget),
        _ => Ok(Belief::Unfit),
    }
}

/// How much later than the earliest a run may owe nothing but safety, at first.
const SLACK: u32 = 4;

fn narrowed<const N: usize>(
    arena: &Arena<'_>,
    paths: [PathId; N],
    leading: usize,
    goal: &Goal,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    // A path of a system without states is in none: the leading block has no run, or the other player no part in it.
    let is_empty = |&path: &PathId| arena.graphs[path].initial.is_empty();
    if paths[..leading].iter().any(is_empty) {
        return Ok(Belief::Hopeless);
    }
    if paths[leading..].iter().any(is_empty) {
        return Ok(Belief::Unfit);
    }
    let formula = &arena.task.objective.formula;
    let (own, rest) = goal.split(formula, &|path| paths[..leading].contains(&path));
    let against = rest.opposed(formula);
    let nothing: Vec<Option<Run>> = vec![None; N];
    let none = FxHashMap::default();
    let question = |goal, slack| Question {
        arena,
        paths,
        within: [None; N],
        goal,
        fixed: &nothing,
        declared: &none,
        slack,
        least: 0,
        one_run: false,
        budget: arena.task.limits.pairs,
    };
    let alone = |at: usize, slack| {
        if !arena.task.limits.prune {
            return Ok(Explored { layers: [Layers { at: Vec::new() }], lossy: false });
        }
        let wants = question(if at < leading { goal } else { &against }, slack);
        reach::layers(&wants.about([paths[at]]))
    };
    let others: Vec<Layers> = (leading..N)
        .map(|at| alone(at, None).map(|Explored { layers: [layers], .. }| layers))
        .collect::<Result<_, _>>()?;
    let (own, rest) = (question(&own, None), question(&rest, None));
    let mut answer = Belief::Open;
    for slack in [Some(SLACK), None] {
        let (mut layers, mut lossy) = (Vec::with_capacity(N), false);
        for at in 0..leading {
            let Explored { layers: [found], lossy: some } = alone(at, slack)?;
            lossy |= some;
            layers.push(found);
        }
        answer = if layers.iter().any(Layers::is_empty) {
            Belief::Hopeless
        } else {
            layers.extend(others.iter().cloned());
            match Chances::new(&own, &rest, leading, layers) {
                Some(chances) => Search::new(chances, budget).run()?,
                None => return Ok(Belief::Unfit),
            }
        };
        // What is too much among few runs is too much among all.
        if !matches!(answer, Belief::Hopeless) || !lossy {
            return Ok(answer);
        }
    }
    Ok(answer)
}
