//! What can matter when: the states that a path can be in at each time.
//!
//! For a path `q` and the goal of its player, the runs of `q` are explored together with the residual that the goal,
//! weakened to what is known of `q` alone, of fixed paths, and of declared ones, leaves to be met
//! ([`crate::residual`]). A state is kept at time `t` only if some run through it at `t` can go on as long as the mode
//! demands and never meets the residual `false`.
//!
//! Soundness. Let `R` be the set of runs kept. If a choice of all paths meets the goal, then the run of `q` in it is
//! in `R`, as the weakened goal is implied. So under `exists q`, with the formula wanted true, no satisfying choice is
//! lost; under `forall q`, with the formula wanted false, no violating choice is lost: for every `q` outside `R` the
//! rest of the formula holds whatever the other paths are. The latter
//! step needs that every other quantifier ranges over at least one path, which `hyperplan-plan` establishes
//! first. Keeping the states of `R` time by time keeps a superset of `R`, which is sound a fortiori.
//! Of a path declared before in the same query it is known that it is in its layers; where an atom over it has the
//! same value in all of a layer's states, that value counts, and the query speaks of no other choices.
//!
//! Two paths that the formula ties step by step (the same action, the same observation) are explored as a pair: what
//! one of them may do then depends on what the other does, and far fewer states remain. The argument is the same, with
//! the runs of one path that some run of the other, within its own layers, goes with.
//!
//! *Slack* keeps only runs that owe nothing but safety at most so many steps after the earliest run does. That loses
//! solutions, so it is used only for paths of the leading block, where what is found is a solution all the same. Where
//! the whole formula reads no other path than those explored, one run is enough.

//!
//! `question` says what is asked, `atoms` what is known of the formula's atoms, `product` joins the paths with what is left
//! of the goal; `bound` measures it without time, `explore` walks it time by time, and `dive` finds one run.

mod atoms;
mod bound;
mod dive;
mod explore;
mod product;
mod question;
#[cfg(test)]
mod tests;

pub(crate) use atoms::Bits;
pub(crate) use explore::Exploration;
pub(crate) use product::Product;
pub(crate) use question::{Explored, Place, Question};

use crate::ceiling::Ceiling;
use crate::task::Error;

/// The states of an explored path that can matter at each time; those of one run, if that is enough and
/// it can be told.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
pub(crate) fn layers(question: &Question<'_, 1>) -> Result<Explored<1>, Error> {
    let mut exploration = Exploration::bounded(question);
    if question.one_run
        && question.ceiling.is_none()
        && let Some(layers) = exploration.dive()?
    {
        return Ok(Explored { layers, lossy: true });
    }
    exploration.explore()
}

/// The states of two paths, explored as a pair, that can matter at each time; one run of each, if asked for and there
/// is one.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
pub(crate) fn pair_layers(question: &Question<'_, 2>) -> Result<Explored<2>, Error> {
    Exploration::new(question).explore()
}

/// A time before which no run of an explored path owes nothing but safety.
pub(crate) fn least(question: &Question<'_, 1>) -> u32 {
    Exploration::bounded(question).least()
}

/// By state of an explored path, the first time from which on it cannot matter any more; `None` where no bound is known. It is
/// found without exploring time by time.
pub(crate) fn until(question: &Question<'_, 1>) -> Option<Vec<u32>> {
    Exploration::bounded(question).until()
}

/// What no run of an explored path counts less than in the sum of a ceiling; [`NO_WAY`] if it has none.
///
/// # Errors
/// [`Error::TooLarge`] beyond the budget.
///
/// [`NO_WAY`]: crate::ceiling::NO_WAY
pub(crate) fn least_cost(question: &Question<'_, 1>, ceiling: &Ceiling) -> Result<i64, Error> {
    Exploration::bounded(question).least_cost(ceiling)
}
