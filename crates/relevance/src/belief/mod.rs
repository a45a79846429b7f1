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
use crate::reach::{self, Question};
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
    /// The budget was not enough, or the objective is not of the kind.
    Open,
}

/// Searches for runs of the leading block that meet the goal whatever the other block, the last, does. `budget` is in chances
/// looked at.
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
    match paths.as_slice() {
        &[p, q] => about(arena, [p, q], leading, goal, budget),
        &[p, q, r] => about(arena, [p, q, r], leading, goal, budget),
        &[p, q, r, s] => about(arena, [p, q, r, s], leading, goal, budget),
        _ => Ok(Belief::Open),
    }
}

fn about<const N: usize>(
    arena: &Arena<'_>,
    paths: [PathId; N],
    leading: usize,
    goal: &Goal,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    let formula = &arena.task.objective.formula;
    let (own, rest) = goal.split(formula, &|path| paths[..leading].contains(&path));
    let against = rest.opposed(formula);
    let nothing: Vec<Option<Run>> = vec![None; N];
    let none = FxHashMap::default();
    let question = |goal| Question {
        arena,
        paths,
        within: [None; N],
        goal,
        fixed: &nothing,
        declared: &none,
        slack: None,
        least: 0,
        one_run: false,
        budget: arena.task.limits.pairs,
    };
    let mut layers: Vec<Layers> = Vec::with_capacity(N);
    for (at, &path) in paths.iter().enumerate() {
        let wants = question(if at < leading { goal } else { &against });
        let [found] = reach::layers(&wants.about([path]))?.layers;
        if found.is_empty() && at < leading {
            return Ok(Belief::Hopeless);
        }
        layers.push(found);
    }
    let (own, rest) = (question(&own), question(&rest));
    match Chances::new(&own, &rest, leading, layers) {
        Some(chances) => Search::new(chances, budget).run(),
        None => Ok(Belief::Open),
    }
}
