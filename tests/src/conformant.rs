//! Random problems of one plan for all: a path waits at home and takes actions, and every path that takes the same
//! ones elsewhere, perhaps but for one, has to get somewhere. What wins against each of these paths alone need not win
//! against all.

use crate::model::{Atom, Formula, Kind, Observe, Problem, Rule, System};
use crate::random::Random;

/// The one state in which all actions do nothing.
const HOME: usize = 0;

/// A problem of that shape; one in four is about the other player.
pub(crate) fn conformant(random: &mut Random) -> Problem {
    let system = system(random);
    let horizon = if system.actions.len() > 2 { 1 + random.bound(2) } else { 1 + random.bound(3) };
    let within = random.once_in(2).then_some(horizon);
    let always = |f| Formula::Globally(Some((0, horizon)), Box::new(f));
    let not = |f| Formula::Not(Box::new(f));
    let same = || Formula::Atom(Atom::SameAction(0, 1));
    let tie = if within.is_some() && random.once_in(2) {
        // One action at most is different.
        let rest = Formula::Globally(None, Box::new(same()));
        let slip = Formula::Implies(Box::new(not(same())), Box::new(Formula::WeakNext(Box::new(rest))));
        Formula::Globally(None, Box::new(slip))
    } else {
        always(same())
    };
    let premise = Formula::And(vec![not(Formula::Atom(Atom::Label(1, 0))), tie]);
    let there = Box::new(Formula::Atom(Atom::Label(1, 1)));
    let arrives = match random.below(3) {
        0 => Formula::Finally(Some((horizon, horizon)), there),
        1 => Formula::Until(Some((0, horizon)), Box::new(not(Formula::Atom(Atom::Is(1, 0, 1)))), there),
        _ => Formula::Finally(Some((0, horizon)), there),
    };
    let waits = always(Formula::Atom(Atom::Label(0, 0)));
    let formula = Formula::And(vec![waits, Formula::Implies(Box::new(premise), Box::new(arrives))]);
    let (first, formula) = if random.once_in(4) { (false, not(formula)) } else { (true, formula) };
    Problem { system, exists: vec![first, !first], within, semantics: None, look: horizon, formula }
}

fn system(random: &mut Random) -> System {
    let states = 4 + random.below(3);
    let actions = ["a", "b2", "c"][..2 + random.below(2)].to_vec();
    let mut rules =
        vec![Rule { from: HOME, actions: (0..actions.len()).collect(), choices: vec![Some(vec![HOME])] }];
    for from in 1..states {
        for action in 0..actions.len() {
            let mut next = vec![1 + random.below(states - 1)];
            if random.once_in(12) {
                next.push(1 + random.below(states - 1));
            }
            rules.push(Rule { from, actions: vec![action], choices: vec![Some(next)] });
        }
    }
    // Where to get is often a place to stay.
    let goal = states - 1;
    let absorb = if random.once_in(2) { vec![goal] } else { Vec::new() };
    let mut starts = vec![HOME, 1, 2];
    starts.truncate(2 + random.below(2));
    System {
        vars: vec![("s", Kind::Range(states))],
        actions,
        rules,
        also: Vec::new(),
        costs: Vec::new(),
        init: Some(starts),
        labels: vec![vec![HOME], vec![goal]],
        absorb,
        forbidden: Vec::new(),
        merged: random.once_in(4),
        observe: Observe::First,
    }
}
