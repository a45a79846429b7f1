//! The leading player's search over what the other player may be up to, without a solver.
//!
//! Where a second block of quantifiers is the last, a prefix of the leading paths leaves the other player finitely many
//! chances: a state for each of its paths, together with what the goal still asks for there. The set of all of them is a
//! *belief*, as in planning with incomplete information (Bonet and Geffner): which of them is the true one the leading
//! paths do not know, as their choice may not depend on the others. It has to be empty in the end, as a chance is gone once
//! nothing more can be asked for. A chance that becomes `false` loses.
//!
//! Two searches are made of beliefs. The first keeps only the most promising at each time ([`beam`]), at first very few,
//! which finds a strategy soon where there are many. For that, when a path can matter where is told by bounds, which do not
//! depend on the horizon ([`presence`]); layers, which do, are explored afterwards. Before it keeps more the other player is given a turn: if it wins by
//! answering step by step, the leading paths lose ([`response`]). They lose as well if they would without deadlines, seeing
//! what the other player does ([`untimed`]); for how long a chance lasts at least is known from then on. The second is depth
//! first, with what was learnt from failing: for a node, the chances by which each of its moves failed, traced back, are a
//! *nogood*. A belief that includes a nogood of the same leading states at the same time need not be searched. This is
//! conflict-directed backjumping with learning (Dechter), the constraint being that no chance be missed.
//!
//! Soundness. Chances are dropped where the goal's rest is `true`, where the other player's path is none (it cannot go on as
//! long as the mode demands), and where its own [`Layers`], or its bound, say that it can do no harm. What the goal asks of the leading paths
//! alone is followed beside the belief. So a run that is found is a strategy; and that none is found means that there is none,
//! as every run of the leading paths is looked at that no nogood excludes.

mod beam;
mod chances;
mod distance;
mod joint;
mod presence;
mod response;
mod search;
mod untimed;

use crate::goal::Goal;
use crate::layers::Layers;
use crate::reach::{self, Explored, Question};
use crate::task::{Arena, Error};
use chances::{Chances, Wish};
use hyperplan_problem::PathId;
use hyperplan_space::Run;
use presence::Presence;
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
/// that each search may look at: the beams, and that by depth; the other player's answers get a quarter of it.
///
/// Runs that are hardly longer than the shortest leave the other player least to do, so depth first they are tried first.
///
/// # Errors
/// [`Error::Interrupted`], and [`Error::TooLarge`] where too much can matter of a path alone.
pub fn believe(
    arena: &Arena<'_>,
    leading: usize,
    goal: &Goal,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    arena.task.go_on()?;
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

/// How many beliefs at a time the beams keep: the first, and the others one after the other.
const NARROW: usize = 4;
const WIDTHS: [usize; 4] = [16, 128, 1024, 8192];

/// Steps of the game without time for each chance that a beam may look at; these take up to three times as long.
const STEPS_PER_CHANCE: usize = 12;

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
    let other = rest.opposed(formula);
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
        ceiling: None,
        budget: arena.task.limits.pairs,
    };
    let (asked, rest, against) = (question(&own, None), question(&rest, None), question(&other, None));
    let wants = |at: usize| if at < leading { goal } else { &other };
    let present = |wish, present: Vec<Presence>| {
        let rest = if wish == Wish::Leading { &rest } else { &against };
        Chances::new(&asked, (wish, rest), leading, present)
    };
    // Bounds on what is left to do are soon found, and most often they are all that the first beam needs.
    if let Some(bounds) = bounds(&question, &wants) {
        let Some(mut all) = present(Wish::Leading, bounds) else { return Ok(Belief::Unfit) };
        let answer = beam::search(&mut all, NARROW, budget / 2)?;
        if !matches!(answer, Belief::Open) {
            return Ok(answer);
        }
    }
    let alone = |at: usize, slack| {
        if !arena.task.limits.prunes() {
            return Ok(Explored { layers: [Layers { at: Vec::new() }], lossy: false });
        }
        reach::layers(&question(wants(at), slack).about([paths[at]]))
    };
    let others = (leading..N).map(|at| alone(at, None)).collect::<Result<Vec<_>, Error>>()?;
    let leads = |slack| (0..leading).map(|at| alone(at, slack)).collect::<Result<Vec<_>, Error>>();
    let among = |wish, leads: &[Explored<1>]| {
        let all = leads.iter().chain(&others);
        present(wish, all.map(|Explored { layers: [layers], .. }| Presence::Layers(layers.clone())).collect())
    };
    let any = leads(None)?;
    let Some(mut all) = among(Wish::Leading, &any) else { return Ok(Belief::Unfit) };
    let answer = by_beams(&mut all, || among(Wish::Other, &any), budget)?;
    if !matches!(answer, Belief::Open) {
        return Ok(answer);
    }
    let soon = leads(Some(SLACK))?;
    let Some(mut few) = among(Wish::Leading, &soon) else { return Ok(Belief::Unfit) };
    let answer = Search::new(&mut few, budget).run()?;
    // What is too much among few runs is too much among all.
    if !matches!(answer, Belief::Hopeless) || !soon.iter().any(|explored| explored.lossy) {
        return Ok(answer);
    }
    let budget = all.work.saturating_add(budget);
    Search::new(&mut all, budget).run()
}

/// When paths can matter where by a bound for each; `None` where there is none for some, or states are not to be pruned.
fn bounds<'q, const N: usize>(
    question: &impl Fn(&'q Goal, Option<u32>) -> Question<'q, N>,
    wants: &impl Fn(usize) -> &'q Goal,
) -> Option<Vec<Presence>> {
    let until = |at: usize| {
        let question = question(wants(at), None);
        let prunes = question.arena.task.limits.prunes();
        let until = || reach::until(&question.about([question.paths[at]]));
        prunes.then(until).flatten().map(Presence::Until)
    };
    (0..N).map(until).collect()
}

/// Looks for a strategy where it is most likely, and between that for reasons that there is none.
fn by_beams<'a, const N: usize>(
    all: &mut Chances<'a, N>,
    others: impl FnOnce() -> Option<Chances<'a, N>>,
    budget: usize,
) -> Result<Belief<Vec<Run>>, Error> {
    // Where there are many strategies, one of the most promising is among them.
    let answer = beam::search(all, NARROW, budget / 2)?;
    if !matches!(answer, Belief::Open) {
        return Ok(answer);
    }
    let Some(mut answers) = others() else { return Ok(Belief::Unfit) };
    if response::is_won(&mut answers, budget / 4)? {
        return Ok(Belief::Hopeless);
    }
    drop(answers);
    for (turn, width) in WIDTHS.into_iter().enumerate() {
        let answer = beam::search(all, width, budget)?;
        if !matches!(answer, Belief::Open) {
            return Ok(answer);
        }
        // What was not found soon may be impossible even for who sees everything.
        if turn == 0 && all.foresee(budget.saturating_mul(STEPS_PER_CHANCE))? {
            return Ok(Belief::Hopeless);
        }
    }
    Ok(Belief::Open)
}
