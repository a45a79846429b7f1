//! Plans without detours: a last pass over a strategy that was found.
//!
//! What a leading path takes is the number of its steps until it is *at rest*: in a state that absorbs, or, where other paths
//! have nothing to say, when its own eventualities are met and only safety is owed. Of a strategy it is the sum over its
//! paths. Loops are cut out first, which the checker allows or not; then a strategy is asked for that takes less, by the
//! search for cheapest ones or by eventualities that end sooner. All of it stops when its time is over; what comes out is
//! verified like what went in, and never takes more.

use crate::cheapest::improved;
use crate::config::{Config, Outcome, Verdict, Verified};
use crate::explain::as_long;
use crate::fact::Note;
use crate::lint::demand::paths as read_paths;
use crate::prepare::is_existential;
use crate::race::search_or_race;
use hyperplan_problem::{
    Cost, Expr, FormulaId, Interval, Node, Objective, PathId, PathLeaf, Problem, Strategy, System, Target,
    Trace, Type, Value,
};
use hyperplan_solver::Deadline;
use hyperplan_space::{Graph, StateIx, bounds, eval, holds_in};
use hyperplan_verify::{Budget, Check, check, holds_for_all_outcomes, settled};
use std::sync::Arc;
use std::time::Duration;

/// What came of the pass.
#[derive(Debug)]
pub struct Straight {
    /// The answer, with the strategy that takes least of those found.
    pub outcome: Outcome,
    /// How its steps were counted, if that could be told, and how many it takes.
    pub steps: Option<(Rest, u64)>,
    /// Whether no strategy takes fewer.
    pub least: bool,
}

/// How steps are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rest {
    /// Until the paths are absorbed.
    Absorbed,
    /// Until their eventualities are met.
    Owing,
}

/// The pass may take one in so many parts of the time that the search took, but so much at least, and no more than this.
const SHARE: f64 = 0.25;
const LEAST: Duration = Duration::from_millis(10);
const MOST: Duration = Duration::from_secs(1);

/// With less time nothing is asked for. What was found so soon was found by going where less is left to do, and has few detours.
const WORTH_ASKING: Duration = Duration::from_millis(25);

/// What it may cost to check a strategy with a loop cut out.
const CHECK: Budget = Budget { states: 100_000, entries: 1_000_000, moves: 2_000_000 };

/// Systems with more states are not looked at for outcomes.
const STATES: usize = 300_000;

/// Eventualities that are followed.
const EVENTUALITIES: usize = 50;

/// Loops that are tried.
const LOOPS: usize = 20;

/// Problems of no more states at all times are small: the pass ends soon, and is not ended by the clock, on which its answer
/// would depend.
const SMALL: i64 = 20_000;

/// The time that the pass may take after a search.
#[must_use]
pub fn time_for(problem: &Problem, objective: &Objective, outcome: &Outcome) -> Duration {
    if size(problem, objective, outcome) <= SMALL {
        return MOST;
    }
    let took = outcome.seconds.encode + outcome.seconds.solve + outcome.seconds.verify;
    Duration::try_from_secs_f64(took * SHARE).unwrap_or(MOST).clamp(LEAST, MOST)
}

/// States of all paths at all times, reachable or not.
fn size(problem: &Problem, objective: &Objective, outcome: &Outcome) -> i64 {
    let of = |path: PathId| {
        let system = &problem.systems[objective.paths[path].system];
        let values =
            |ty: &Type| bounds(ty).map_or(i64::MAX, |(lo, hi)| hi.saturating_sub(lo).saturating_add(1));
        let states = system.vars.iter().map(|var| values(&var.ty)).fold(1, i64::saturating_mul);
        states.saturating_mul(i64::from(outcome.horizons[path].unwrap_or(0)).saturating_add(1))
    };
    objective.paths.keys().map(of).fold(0, i64::saturating_add)
}

/// The strategy of an answer without detours, as far as those are found before the deadline. Answers without a verified strategy
/// are left as they are.
#[must_use]
pub fn straightened(
    problem: &Problem,
    objective: &Objective,
    outcome: Outcome,
    config: &Config,
    deadline: &Deadline,
) -> Straight {
    straightened_among(problem, (objective, objective), outcome, config, deadline)
}

/// As [`straightened`], of an objective that asks for more besides what another one does, whose formula is the beginning of its
/// own: it is the other one that says when paths are at rest.
pub(crate) fn straightened_among(
    problem: &Problem,
    (objective, plain): (&Objective, &Objective),
    outcome: Outcome,
    config: &Config,
    deadline: &Deadline,
) -> Straight {
    let found = outcome.verdict == Verdict::Realizable && outcome.verified == Some(Verified::BySearch);
    let first = outcome.witness.clone().filter(|_| found && is_existential(objective));
    let config = Config { deadline: deadline.clone(), queries: None, rivals: Vec::new(), ..config.clone() };
    let pass = first.as_ref().and_then(|first| Pass::new(problem, (objective, plain), first, &config));
    let (Some(pass), Some(mut best)) = (pass, first) else {
        return Straight { outcome, steps: None, least: false };
    };
    pass.cut(&mut best);
    let least = match pass.rest {
        _ if deadline.remaining().is_some_and(|left| left < WORTH_ASKING) => false,
        Rest::Absorbed => pass.is_soonest(&best) || pass.absorb_sooner(&mut best, &outcome),
        Rest::Owing => pass.owe_less(&mut best),
    };
    let steps = pass.steps(&best).map(|steps| (pass.rest, steps));
    let mut notes = outcome.notes.clone();
    if outcome.witness.as_ref() != Some(&best) {
        notes.retain(|note| !matches!(note, Note::PicksOutcomes { .. }));
        notes.extend(pass.picked_outcomes(&best));
    }
    Straight { outcome: Outcome { witness: Some(best), notes, ..outcome }, steps, least }
}

struct Pass<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    /// What says when paths are at rest.
    plain: &'a Objective,
    /// How questions are asked, and until when.
    config: &'a Config,
    rest: Rest,
    /// The eventualities of each leading path alone.
    eventualities: Vec<(PathId, FormulaId)>,
}

impl<'a> Pass<'a> {
    /// `None` where it is not known when paths are at rest.
    fn new(
        problem: &'a Problem,
        (objective, plain): (&'a Objective, &'a Objective),
        first: &Strategy,
        config: &'a Config,
    ) -> Option<Self> {
        let formula = &plain.formula;
        let eventualities = formula.parts().into_iter().filter_map(|part| {
            let own = read_paths(formula, part);
            let [path] = own.as_slice() else { return None };
            matches!(formula.nodes[part], Node::Until(..)).then_some((*path, part))
        });
        // Nobody waits for more of them to be followed one by one.
        let eventualities = Some(eventualities.collect::<Vec<_>>()).filter(|all| all.len() <= EVENTUALITIES);
        let eventualities = eventualities.unwrap_or_default();
        let mut pass = Pass { problem, objective, plain, config, rest: Rest::Owing, eventualities };
        let owing = pass.steps(first).filter(|_| pass.owes_little());
        pass.rest = Rest::Absorbed;
        let absorbed = pass.steps(first).filter(|_| first.traces.iter().all(|trace| pass.is_absorbed(trace)));
        pass.rest = match (absorbed, owing) {
            (Some(absorbed), Some(owing)) if owing < absorbed => Rest::Owing,
            (Some(_), _) => Rest::Absorbed,
            (None, Some(_)) => Rest::Owing,
            (None, None) => return None,
        };
        Some(pass)
    }

    /// Whether all that is owed over time are eventualities of single paths.
    fn owes_little(&self) -> bool {
        let formula = &self.plain.formula;
        let known = |part: &FormulaId| {
            let safe = matches!(formula.nodes[*part], Node::Atom(_)) || formula.globally(*part).is_some();
            safe || self.eventualities.iter().any(|(_, other)| other == part)
        };
        self.objective.blocks().len() == 1
            && self.objective.semantics.is_none()
            && !self.eventualities.is_empty()
            && formula.parts().iter().all(known)
    }

    /// The steps until the paths of a strategy are at rest.
    fn steps(&self, strategy: &Strategy) -> Option<u64> {
        strategy.traces.iter().map(|trace| self.until_rest(trace, strategy)).sum()
    }

    fn until_rest(&self, trace: &Trace, strategy: &Strategy) -> Option<u64> {
        match self.rest {
            Rest::Absorbed => {
                let first = (0..trace.states.len()).find(|&time| self.absorbs(trace, time));
                u64::try_from(first.unwrap_or(trace.actions.len())).ok()
            }
            Rest::Owing => {
                let own = self.eventualities.iter().filter(|(path, _)| *path == trace.path);
                let mut last = 0;
                for (_, part) in own {
                    let mut alone = self.plain.clone();
                    alone.formula.push(Node::And(vec![*part]), self.objective.span);
                    let (holds, time) =
                        settled(self.problem, &alone, strategy, &Budget::default()).ok()??;
                    last = last.max(if holds { u64::from(time) } else { u64::MAX });
                }
                Some(last)
            }
        }
    }

    fn absorbs(&self, trace: &Trace, time: usize) -> bool {
        let system = &self.problem.systems[self.objective.paths[trace.path].system];
        holds_in(system, &system.absorb, &trace.states[time]) == Some(true)
    }

    fn is_absorbed(&self, trace: &Trace) -> bool {
        trace.states.len().checked_sub(1).is_some_and(|last| self.absorbs(trace, last))
    }

    /// Takes a strategy if it is one, and takes fewer steps.
    fn offer(&self, best: &mut Strategy, other: Strategy) -> bool {
        let fewer =
            matches!((self.steps(&other), self.steps(best)), (Some(other), Some(best)) if other < best);
        let holds = || check(self.problem, self.objective, &other, &CHECK).is_ok_and(|c| c == Check::Holds);
        let taken = fewer && holds();
        if taken {
            *best = other;
        }
        taken
    }

    /// Cuts out loops, the longest first.
    fn cut(&self, best: &mut Strategy) {
        let mut tried = 0;
        let mut at = 0;
        while at < best.traces.len() {
            let cuts = without_loops(&best.traces[at]);
            let mut taken = false;
            for trace in cuts {
                if tried == LOOPS || self.config.deadline.passed() {
                    return;
                }
                tried += 1;
                let mut other = best.clone();
                other.traces[at] = trace;
                taken = self.offer(best, other);
                if taken {
                    break;
                }
            }
            at += usize::from(!taken);
        }
    }

    /// Says of which paths the actions might have had other outcomes, unless the objective holds for these too.
    fn picked_outcomes(&self, strategy: &Strategy) -> Vec<Note> {
        let (problem, objective) = (self.problem, self.objective);
        let picks = |trace: &&Trace| {
            let system = &problem.systems[objective.paths[trace.path].system];
            // Where there is one action, a path is what it leads to, and nothing else is chosen.
            let several = system.actions.len() > 1;
            let Some(graph) = several.then(|| self.graph(system)).flatten() else { return false };
            let mut at = graph.initial_state(&trace.states[0]);
            trace.actions.iter().zip(&trace.states[1..]).any(|(&action, next)| {
                let Some(here) = at else { return false };
                at = graph.step_to(here, action, next).map(|(_, next)| next);
                graph.of_action(here, action).nth(1).is_some()
            })
        };
        let picking: Vec<PathId> = strategy.traces.iter().filter(picks).map(|trace| trace.path).collect();
        let all = || holds_for_all_outcomes(problem, objective, strategy, &picking, &CHECK);
        if picking.is_empty() || matches!(all(), Ok(Some(true))) {
            return Vec::new();
        }
        picking
            .into_iter()
            .map(|path| Note::PicksOutcomes { path: objective.paths[path].name.clone() })
            .collect()
    }

    /// Whether each path of a strategy is absorbed as soon as its system can be, from where the path may start. A path that is not
    /// absorbed at its end has taken more.
    fn is_soonest(&self, strategy: &Strategy) -> bool {
        strategy.traces.iter().all(|trace| {
            let system = &self.problem.systems[self.objective.paths[trace.path].system];
            let soonest = self.graph(system).and_then(|graph| {
                let starts = self.starts(trace.path, system, &graph);
                graph.steps_to(system, starts, &system.absorb)
            });
            soonest.is_some() && soonest.map(u64::from) == self.until_rest(trace, strategy)
        })
    }

    /// The states that a path may start in, by what the objective asks of its first state alone.
    fn starts(&self, path: PathId, system: &System, graph: &Graph) -> Vec<StateIx> {
        let formula = &self.objective.formula;
        let of_state = |part| {
            let Node::Atom(expr) = &formula.nodes[part] else { return None };
            let mut own = true;
            expr.for_each_leaf(&mut |leaf| own &= matches!(leaf, PathLeaf::State(read, _) if *read == path));
            own.then_some(expr)
        };
        let asked: Vec<&Expr<PathLeaf>> = formula.parts().into_iter().filter_map(of_state).collect();
        let value = |leaf: &PathLeaf, state| match *leaf {
            PathLeaf::State(_, leaf) => graph.leaf(system, state, leaf),
            _ => 0,
        };
        let may = |state: &StateIx| asked.iter().all(|expr| eval(expr, &mut |leaf| value(leaf, *state)) != 0);
        graph.initial.iter().copied().filter(may).collect()
    }

    /// The states of a system, which the search has enumerated before, or that are soon enumerated.
    fn graph(&self, system: &System) -> Option<Arc<Graph>> {
        system.is_finite().then(|| self.config.graphs.explore(system, STATES)).flatten()
    }

    /// Asks for strategies that are absorbed sooner; whether there is none.
    fn absorb_sooner(&self, best: &mut Strategy, outcome: &Outcome) -> bool {
        let mut problem = self.problem.clone();
        let mut terms = Vec::new();
        for path in self.objective.leading_block() {
            let system = &mut problem.systems[self.objective.paths[path].system];
            let step = Cost {
                // No cost of a file is called so.
                name: "each step".to_owned(),
                expr: Expr::Const(Value::Int(1)),
                most: 1,
                span: self.objective.span,
            };
            let known = system.costs.iter().position(|cost| *cost == step);
            let cost = known.map(Into::into).unwrap_or_else(|| system.costs.push_and_get_key(step));
            terms.push((1, path, cost));
        }
        let targets = [Target { terms, constant: 0, span: self.objective.span }];
        let outcome = Outcome { witness: Some(best.clone()), ..outcome.clone() };
        let Some(Ok(cheapest)) = improved(&problem, self.objective, &targets, self.config, outcome) else {
            return false;
        };
        if let Some(other) = cheapest.outcome.witness {
            self.offer(best, other);
        }
        let value = cheapest.values.first();
        value.is_some_and(|value| u64::try_from(value.least).ok() == self.steps(best))
    }

    /// Asks for strategies whose eventualities are met sooner, path by path; whether there is none.
    fn owe_less(&self, best: &mut Strategy) -> bool {
        let paths = self.objective.leading_block();
        let mut sure = paths.len() == 1;
        for path in paths {
            let mut low = 0;
            while let Some(most) = self.longest(best, path).filter(|most| *most > low) {
                let middle = low + (most - low) / 2;
                let sooner = self.sooner(best, path, middle);
                match search_or_race(self.problem, &sooner, self.config) {
                    Ok(Outcome { verdict: Verdict::Realizable, witness: Some(other), .. }) => {
                        if !self.offer(best, other) {
                            // What is nested in it is met too late.
                            (low, sure) = (middle + 1, false);
                        }
                    }
                    Ok(Outcome { verdict: Verdict::Unrealizable, .. }) => low = middle + 1,
                    _ => {
                        sure = false;
                        break;
                    }
                }
            }
        }
        sure
    }

    fn longest(&self, best: &Strategy, path: PathId) -> Option<u64> {
        best.traces.iter().find(|trace| trace.path == path).and_then(|trace| self.until_rest(trace, best))
    }

    /// The objective with the eventualities of a path met by a time, and those of others when they are.
    fn sooner(&self, best: &Strategy, path: PathId, time: u64) -> Objective {
        let mut sooner = self.objective.clone();
        for &(own, part) in &self.eventualities {
            let end = if own == path { Some(time) } else { self.longest(best, own) };
            let end = end.and_then(|end| u32::try_from(end).ok());
            if let (Node::Until(interval, ..), Some(end)) = (&mut sooner.formula.nodes[part], end) {
                // One that begins later is met there at the earliest, and the last eventuality then comes no sooner.
                let end = end.max(interval.lo);
                *interval = Interval { hi: Some(interval.hi.map_or(end, |hi| hi.min(end))), ..*interval };
            }
        }
        as_long(self.problem, self.objective, &sooner)
    }
}

/// A trace with one of its loops cut out, which stays at its end for as long: the longest loops first.
fn without_loops(trace: &Trace) -> Vec<Trace> {
    let last = trace.states.len().saturating_sub(1);
    // Where it cannot stay, nothing can be cut.
    let (Some(&idle), true) =
        (trace.actions.last(), last > 0 && trace.states[last] == trace.states[last - 1])
    else {
        return Vec::new();
    };
    let mut loops: Vec<(usize, usize)> = Vec::new();
    for from in 0..last {
        let back = (from + 1..=last).rev().find(|&to| trace.states[to] == trace.states[from]);
        loops.extend(
            back.filter(|&to| trace.states[from] != trace.states[last] || to < last).map(|to| (from, to)),
        );
    }
    loops.sort_by_key(|&(from, to)| (std::cmp::Reverse(to - from), from));
    let cut = |(from, to): (usize, usize)| {
        let mut short = trace.clone();
        short.states.drain(from + 1..=to);
        short.actions.drain(from..to);
        short.states.extend(std::iter::repeat_n(trace.states[last].clone(), to - from));
        short.actions.extend(std::iter::repeat_n(idle, to - from));
        short
    };
    loops.into_iter().take(LOOPS).map(cut).collect()
}
