//! Smaller problems that show the same fault.

use crate::model::{Formula, Problem, Rule};
use crate::number;
use std::time::{Duration, Instant};

/// How many seconds to look for one, unless `HYPERPLAN_SHRINK_SECONDS` says otherwise.
const PATIENCE: u64 = 10;

/// A problem that fails, and does so no more whatever single thing is left out of it (if there was time to find out).
pub fn shrunk(mut problem: Problem, fails: impl Fn(&Problem) -> bool) -> Problem {
    let end = Instant::now() + Duration::from_secs(number("HYPERPLAN_SHRINK_SECONDS", PATIENCE));
    let in_time = |_: &Problem| Instant::now() < end;
    while let Some(smaller) = smaller(&problem).into_iter().take_while(in_time).find(&fails) {
        problem = smaller;
    }
    problem
}

/// The problem without one of its parts, in all ways.
fn smaller(problem: &Problem) -> Vec<Problem> {
    let mut all = Vec::new();
    let mut changed = |change: &dyn Fn(&mut Problem)| {
        let mut smaller = problem.clone();
        change(&mut smaller);
        all.push(smaller);
    };
    for at in 0..size(&problem.formula) {
        for part in 0..parts(nth(&mut problem.formula.clone(), at)).len() {
            changed(&|p| instead(nth(&mut p.formula, at), part));
            changed(&|p| without(nth(&mut p.formula, at), part));
        }
        changed(&|p| shorter(nth(&mut p.formula, at)));
    }
    for at in 0..problem.system.also.len() {
        changed(&|p| remove(&mut p.system.also, at));
    }
    for (at, rule) in problem.system.rules.iter().enumerate() {
        changed(&|p| remove(&mut p.system.rules, at));
        for action in (0..rule.actions.len()).filter(|_| rule.actions.len() > 1) {
            changed(&|p| remove(&mut p.system.rules[at].actions, action));
        }
        changed(&|p| determined(&mut p.system.rules[at]));
    }
    for at in 0..problem.system.init.as_ref().map_or(0, Vec::len) {
        changed(&|p| p.system.init.iter_mut().for_each(|init| remove(init, at)));
    }
    for at in 0..problem.system.absorb.len() {
        changed(&|p| remove(&mut p.system.absorb, at));
    }
    for at in 0..problem.system.forbidden.len() {
        changed(&|p| remove(&mut p.system.forbidden, at));
    }
    changed(&|p| p.system.merged = false);
    for (label, states) in problem.system.labels.iter().enumerate() {
        for at in 0..states.len() {
            changed(&|p| remove(&mut p.system.labels[label], at));
        }
    }
    changed(&|p| p.semantics = None);
    changed(&|p| p.within = p.within.map(|within| within.saturating_sub(1)));
    let text = problem.to_string();
    all.retain(|smaller| smaller.to_string() != text);
    all
}

fn remove<T>(list: &mut Vec<T>, at: usize) {
    list.remove(at);
}

/// Every variable has one next value.
fn determined(rule: &mut Rule) {
    rule.choices.iter_mut().flatten().for_each(|values| values.truncate(1));
}

/// The formulas directly below.
fn parts(formula: &mut Formula) -> Vec<&mut Formula> {
    match formula {
        Formula::Atom(_) => Vec::new(),
        Formula::And(all) | Formula::Or(all) => all.iter_mut().collect(),
        Formula::Not(a)
        | Formula::Next(a)
        | Formula::WeakNext(a)
        | Formula::Finally(_, a)
        | Formula::Globally(_, a) => vec![a],
        Formula::Implies(a, b)
        | Formula::Iff(a, b)
        | Formula::Until(_, a, b)
        | Formula::Release(_, a, b)
        | Formula::WeakUntil(_, a, b)
        | Formula::StrongRelease(_, a, b) => vec![a, b],
    }
}

/// How many formulas there are in it.
fn size(formula: &Formula) -> usize {
    1 + parts(&mut formula.clone()).into_iter().map(|part| size(part)).sum::<usize>()
}

/// One of the formulas in it, the whole being the first.
fn nth(formula: &mut Formula, mut at: usize) -> &mut Formula {
    if at == 0 {
        return formula;
    }
    at -= 1;
    for part in parts(formula) {
        let size = size(part);
        if at < size {
            return nth(part, at);
        }
        at -= size;
    }
    unreachable!("there are as many as it has")
}

/// One of the parts in place of the whole.
fn instead(formula: &mut Formula, part: usize) {
    let part = parts(formula).swap_remove(part).clone();
    *formula = part;
}

/// A conjunction or disjunction without one of its parts.
fn without(formula: &mut Formula, part: usize) {
    if let Formula::And(all) | Formula::Or(all) = formula
        && all.len() > 2
    {
        all.remove(part);
    }
}

/// A window that ends a step earlier.
fn shorter(formula: &mut Formula) {
    if let Formula::Finally(Some((lo, hi)), _)
    | Formula::Globally(Some((lo, hi)), _)
    | Formula::Until(Some((lo, hi)), ..)
    | Formula::Release(Some((lo, hi)), ..)
    | Formula::WeakUntil(Some((lo, hi)), ..)
    | Formula::StrongRelease(Some((lo, hi)), ..) = formula
    {
        *hi = (*hi).saturating_sub(1).max(*lo);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Atom;
    use crate::random::{Random, problem};

    #[test]
    fn what_does_not_matter_goes() {
        let took = |problem: &Problem| format!("{:?}", problem.formula).contains("Took");
        let large =
            (0..).map(|seed| problem(&mut Random::new(seed))).find(|p| took(p) && size(&p.formula) > 9);
        let small = shrunk(large.expect("most formulas are large"), took);
        assert!(matches!(small.formula, Formula::Atom(Atom::Took(..))), "{small}");
        assert!(small.system.rules.is_empty() && small.within.is_none_or(|k| k == 0), "{small}");
    }
}
