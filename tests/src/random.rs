//! Random problems.

pub use hyperplan_random::Random;

use crate::brute::Brute;
use crate::conformant::conformant;
use crate::model::{Also, Atom, Formula, Interval, Kind, Observe, Problem, Rule, Semantics, System};

/// Most tuples of paths that a problem may have.
const MOST_TUPLES: usize = 60_000;

/// A problem that brute force can decide: one in eight of one plan for all, the others of any shape.
#[must_use]
pub fn problem(random: &mut Random) -> Problem {
    if random.once_in(8) { decidable(random, conformant) } else { decidable(random, attempt) }
}

/// A problem of any shape that brute force can decide.
fn decidable(random: &mut Random, attempt: fn(&mut Random) -> Problem) -> Problem {
    loop {
        let candidate = attempt(random);
        let count = Brute::new(&candidate, MOST_TUPLES).map(|b| b.paths.len());
        // Problems without any path are decided by their quantifiers alone: a few are enough.
        let tuples = count.and_then(|n| n.checked_pow(u32::try_from(candidate.exists.len()).ok()?));
        match tuples {
            Some(0) if random.once_in(10) => return candidate,
            Some(1..=MOST_TUPLES) => return candidate,
            _ => {}
        }
    }
}

fn attempt(random: &mut Random) -> Problem {
    let system = system(random);
    // Four paths are there for three alternations of quantifiers.
    let paths = if random.once_in(8) { 4 } else { 1 + random.below(3) };
    let first = random.once_in(2);
    let exists: Vec<bool> = (0..paths)
        .map(|path| if paths == 4 { first == (path % 2 == 0) } else { random.once_in(2) })
        .collect();
    let horizon = 1 + random.bound([4, 4, 3, 2][paths - 1]);
    let within = random.once_in(2).then(|| horizon - random.bound(2));
    let depth = 2 + random.below(3);
    let mut formulas = Formulas { random, system: &system, paths, within: within.is_some() };
    let formula = formulas.formula(depth, horizon);
    let formula = if paths > 1 && random.once_in(4) {
        tied(random, &system, paths, horizon)
    } else if paths > 1 && random.once_in(2) {
        // Each path with a part of its own makes horizons unequal.
        let mut parts = vec![formula];
        for path in 0..paths {
            let look = random.bound(horizon + 1);
            let mut own =
                Own { path, formulas: Formulas { random, system: &system, paths: 1, within: false } };
            parts.push(own.formula(look));
        }
        if random.once_in(2) { Formula::And(parts) } else { Formula::Or(parts) }
    } else {
        formula
    };
    let semantics = within.filter(|_| random.once_in(2)).map(|_| Semantics::ALL[random.below(4)]);
    Problem { system, exists, within, semantics, look: horizon, formula }
}

/// A problem under one of the semantics, often with paths that halt.
#[must_use]
pub fn problem_with_semantics(random: &mut Random, semantics: Semantics) -> Problem {
    loop {
        let mut candidate = decidable(random, attempt);
        if candidate.within.is_none() {
            continue;
        }
        candidate.semantics = Some(semantics);
        if random.once_in(2) {
            candidate.system.absorb = random.subset(candidate.system.states(), 2);
        }
        if Brute::new(&candidate, MOST_TUPLES).is_some_and(|b| {
            let paths = u32::try_from(candidate.exists.len()).unwrap_or(u32::MAX);
            (1..=MOST_TUPLES).contains(&b.paths.len().saturating_pow(paths))
        }) {
            return candidate;
        }
    }
}

/// A problem in which steps cost something; if `read`, the formula reads what paths have cost.
#[must_use]
pub fn problem_with_costs(random: &mut Random, read: bool) -> Problem {
    loop {
        let mut candidate = decidable(random, attempt);
        if candidate.semantics.is_some() {
            continue;
        }
        let (states, actions) = (candidate.system.states(), candidate.system.actions.len());
        let cost = |random: &mut Random| [0, 1, 1, 2, 5][random.below(5)];
        candidate.system.costs = (0..states).map(|_| (0..actions).map(|_| cost(random)).collect()).collect();
        if read {
            let part = priced(random, &candidate);
            let formula = Box::new(candidate.formula.clone());
            candidate.formula = match random.below(4) {
                0 => Formula::And(vec![*formula, part]),
                1 => Formula::Or(vec![*formula, part]),
                2 => Formula::Implies(Box::new(part), formula),
                _ => Formula::Iff(formula, Box::new(part)),
            };
        }
        return candidate;
    }
}

/// A formula about what paths have cost.
fn priced(random: &mut Random, problem: &Problem) -> Formula {
    let paths = problem.exists.len();
    let (p, q) = (random.below(paths), random.below(paths));
    let atom = match random.below(3) {
        0 if p != q => Atom::Cheaper(p, random.below(2), q),
        _ => Atom::Costs(p, random.below(6)),
    };
    let hi = problem.within.unwrap_or(problem.look);
    let interval = Some((random.bound(hi + 1), hi));
    let atom = Box::new(Formula::Atom(atom));
    if random.flip() { Formula::Finally(interval, atom) } else { Formula::Globally(interval, atom) }
}

/// A problem whose numbers are of types without bounds, though its paths meet finitely many states. Without `within` a
/// path has as many steps there as the formula reads; where no state is a dead end, that makes no difference.
#[must_use]
pub fn unbounded_problem(random: &mut Random) -> Problem {
    loop {
        let mut candidate = decidable(random, attempt);
        let Problem { system, within, .. } = &mut candidate;
        let edges = system.edges();
        let total = (0..system.states()).all(|state| edges.iter().any(|edge| edge.0 == state));
        // Of numbers without bounds it cannot be told that two clauses never apply together, and none may lead out.
        let vars = &system.vars;
        let simple = |also: &Also| {
            also.choices.iter().all(|&choice| choice < vars[also.var].1.size())
                && system.also.iter().filter(|other| other.var == also.var).count() == 1
        };
        if !system.also.iter().all(simple)
            || (within.is_none() && !total)
            || !system.vars.iter().any(|(_, kind)| matches!(kind, Kind::Range(_)))
        {
            continue;
        }
        for (_, kind) in &mut system.vars {
            if let Kind::Range(n) = *kind {
                *kind = if random.once_in(2) { Kind::Int(n) } else { Kind::Real(n) };
            }
        }
        // What is outside would be reached here.
        let sizes: Vec<usize> = system.vars.iter().map(|(_, kind)| kind.size()).collect();
        for rule in &mut system.rules {
            for (choices, size) in rule.choices.iter_mut().zip(&sizes) {
                choices.iter_mut().for_each(|choices| choices.retain(|c| c < size));
            }
        }
        system.rules.retain(|rule| rule.choices.iter().flatten().all(|choices| !choices.is_empty()));
        let all = || (0..system.states()).collect();
        system.init = Some(system.init.clone().unwrap_or_else(all));
        return candidate;
    }
}

/// A problem on a system whose paths all halt within the horizon and never end, that reads no actions and has bounds
/// for all operators: the infinite path of each prefix is then known.
#[must_use]
pub fn halting_problem(random: &mut Random) -> Problem {
    let states = 2 + random.below(3);
    let mut system = system(random);
    system.vars = vec![("s", Kind::Range(states))];
    system.labels = vec![random.subset(states, 2), random.subset(states, 3)];
    system.init = None;
    system.rules.clear();
    system.also.clear();
    system.forbidden.clear();
    system.absorb = vec![states - 1];
    for from in 0..states - 1 {
        if random.once_in(4) {
            system.absorb.push(from);
            continue;
        }
        let higher: Vec<usize> = (from + 1..states).filter(|_| !random.once_in(2)).collect();
        let choices = vec![Some(if higher.is_empty() { vec![states - 1] } else { higher })];
        let actions = (0..system.actions.len()).collect();
        system.rules.push(Rule { from, actions, choices });
    }
    let paths = 1 + random.below(2);
    let exists: Vec<bool> = (0..paths).map(|_| random.once_in(2)).collect();
    let look = 1 + random.bound(6);
    let formula = loop {
        let depth = 2 + random.below(2);
        let formula = Formulas { random, system: &system, paths, within: false }.formula(depth, look);
        if !formula.reads_actions() {
            break formula;
        }
    };
    Problem { system, exists, within: None, semantics: None, look, formula }
}

/// The shape of robustness: a path does something, and another that takes the same actions, or two, do something too.
fn tied(random: &mut Random, system: &System, paths: usize, horizon: u32) -> Formula {
    let last = paths - 1;
    let mut own = |path: usize| {
        let formulas = Formulas { random: &mut *random, system, paths: 1, within: false };
        Own { path, formulas }.formula(horizon)
    };
    let (mine, mut theirs) = (own(0), own(last));
    let between = (last > 1).then(|| own(1));
    let follows =
        |path| Formula::Globally(Some((0, horizon)), Box::new(Formula::Atom(Atom::SameAction(0, path))));
    let mut same = follows(last);
    // Two that follow at once.
    if let Some(between) = between.filter(|_| random.once_in(2)) {
        same = Formula::And(vec![follows(1), same]);
        theirs = if random.once_in(2) {
            Formula::Or(vec![between, theirs])
        } else {
            Formula::And(vec![between, theirs])
        };
    }
    let formula = Formula::And(vec![mine, Formula::Implies(Box::new(same), Box::new(theirs))]);
    if random.once_in(4) { Formula::Not(Box::new(formula)) } else { formula }
}

fn system(random: &mut Random) -> System {
    let vars = match random.below(5) {
        0 | 1 => vec![("s", Kind::Range(2 + random.below(4)))],
        2 => vec![("e", Kind::Enum(2 + random.below(3)))],
        3 => vec![("x", Kind::Range(2)), ("b", Kind::Bool)],
        _ => vec![("x", Kind::Range(2)), ("e", Kind::Enum(2))],
    };
    let actions = ["a", "b2", "c"][..1 + random.below(3)].to_vec();
    let mut system = System {
        vars,
        actions,
        rules: Vec::new(),
        also: Vec::new(),
        costs: Vec::new(),
        init: None,
        labels: Vec::new(),
        absorb: Vec::new(),
        forbidden: Vec::new(),
        merged: false,
        observe: Observe::First,
    };
    let states = system.states();
    for from in 0..states {
        // Some states have no rule: dead ends.
        for _ in 0..[0, 1, 1, 2, 2, 3][random.below(6)] {
            let rule = rule(random, &system, from);
            system.rules.push(rule);
        }
    }
    for var in 0..system.vars.len() {
        if random.once_in(4) {
            add_also(random, &mut system, var);
        }
    }
    if !random.once_in(4) {
        let mut init = random.subset(states, 2);
        if init.is_empty() {
            init.push(random.below(states));
        }
        system.init = Some(init);
    }
    system.labels = vec![random.subset(states, 2), random.subset(states, 3)];
    if random.once_in(4) {
        system.absorb = random.subset(states, 3);
    }
    if random.once_in(2) {
        system.observe = Observe::Label;
    }
    if random.once_in(4) {
        for _ in 0..1 + random.below(3) {
            system.forbidden.push((random.below(states), random.below(states)));
        }
    }
    system.merged = random.once_in(3);
    system
}

/// Makes some transitions change a variable besides: in one way, or in another where that does not apply. What the
/// transitions themselves said of it goes.
fn add_also(random: &mut Random, system: &mut System, var: usize) {
    let states = system.states();
    let everywhere = random.flip();
    let from = if everywhere { (0..states).collect() } else { random.subset(states, 2) };
    let mut actions = random.subset(system.actions.len(), 2);
    if actions.is_empty() {
        actions.push(0);
    }
    let elsewhere: Vec<usize> = (0..states).filter(|state| !from.contains(state)).collect();
    for rule in &mut system.rules {
        if rule.actions.iter().any(|action| actions.contains(action)) {
            rule.choices[var] = None;
        }
    }
    let kind = system.vars[var].1;
    let mut some = |from: Vec<usize>| {
        let mut choices: Vec<usize> = (0..1 + random.below(2)).map(|_| random.below(kind.size())).collect();
        // A value beyond the range takes the transition away.
        if matches!(kind, Kind::Range(_)) && random.once_in(4) {
            choices[0] = kind.size();
        }
        Also { actions: actions.clone(), from, var, choices }
    };
    system.also.push(some(from));
    if !everywhere {
        system.also.push(some(elsewhere));
    }
}

fn rule(random: &mut Random, system: &System, from: usize) -> Rule {
    let mut actions = random.subset(system.actions.len(), 2);
    if actions.is_empty() {
        actions.push(random.below(system.actions.len()));
    }
    let mut choices = Vec::new();
    for (_, kind) in &system.vars {
        if random.once_in(5) {
            choices.push(None);
            continue;
        }
        let mut values = vec![random.below(kind.size())];
        if random.once_in(3) {
            values.push(random.below(kind.size()));
        }
        // A value beyond the range makes no transition.
        if matches!(kind, Kind::Range(_)) && random.once_in(8) {
            values.push(kind.size());
        }
        if values.len() > 1 && random.once_in(6) {
            values.remove(0);
        }
        choices.push(Some(values));
    }
    Rule { from, actions, choices }
}

struct Formulas<'a> {
    random: &'a mut Random,
    system: &'a System,
    paths: usize,
    within: bool,
}

impl Formulas<'_> {
    fn formula(&mut self, depth: usize, look: u32) -> Formula {
        if depth == 0 {
            return Formula::Atom(self.atom());
        }
        let temporal = look > 0 || self.within;
        let kind = self.random.below(if temporal { 19 } else { 6 });
        match kind {
            0 => Formula::Not(self.sub(depth, look)),
            1 => Formula::And(self.subs(depth, look)),
            2 => Formula::Or(self.subs(depth, look)),
            3 => Formula::Implies(self.sub(depth, look), self.sub(depth, look)),
            4 => Formula::Iff(self.sub(depth, look), self.sub(depth, look)),
            5 => Formula::Atom(self.atom()),
            6 | 7 => Formula::Next(self.sub(depth, look.saturating_sub(1))),
            8 => Formula::WeakNext(self.sub(depth, look.saturating_sub(1))),
            _ => self.operator(kind, depth, look),
        }
    }

    fn operator(&mut self, kind: usize, depth: usize, look: u32) -> Formula {
        let (interval, later) = self.interval(look);
        match kind {
            9 | 10 => Formula::Finally(interval, self.sub(depth, later)),
            11 | 12 => Formula::Globally(interval, self.sub(depth, later)),
            13 | 14 => Formula::Until(interval, self.sub(depth, later), self.sub(depth, later)),
            15 | 16 => Formula::Release(interval, self.sub(depth, later), self.sub(depth, later)),
            17 => Formula::WeakUntil(interval, self.sub(depth, later), self.sub(depth, later)),
            _ => Formula::StrongRelease(interval, self.sub(depth, later), self.sub(depth, later)),
        }
    }

    fn sub(&mut self, depth: usize, look: u32) -> Box<Formula> {
        Box::new(self.formula(depth - 1, look))
    }

    fn subs(&mut self, depth: usize, look: u32) -> Vec<Formula> {
        (0..2 + self.random.below(2)).map(|_| self.formula(depth - 1, look)).collect()
    }

    /// An interval, and how far the operands may look. Under `within` bounds may lie beyond the trace.
    fn interval(&mut self, look: u32) -> (Interval, u32) {
        if self.within {
            let lo = self.random.bound(3);
            let interval = (!self.random.once_in(3)).then(|| (lo, lo + self.random.bound(4)));
            return (interval, look);
        }
        let hi = self.random.bound(look + 1);
        let lo = if self.random.once_in(2) { 0 } else { self.random.bound(hi + 1) };
        (Some((lo, hi)), look - hi)
    }

    fn atom(&mut self) -> Atom {
        let system = self.system;
        let p = self.random.below(self.paths);
        let q = if self.paths == 1 { p } else { (p + 1 + self.random.below(self.paths - 1)) % self.paths };
        let action = self.random.below(system.actions.len());
        let var = self.random.below(system.vars.len());
        let kind = system.vars[var].1;
        match self.random.below(if self.paths == 1 { 7 } else { 14 }) {
            0 | 1 => Atom::Label(p, self.random.below(2)),
            2 => Atom::Is(p, var, self.random.below(kind.size())),
            3 | 4 => Atom::Took(p, action),
            5 => Atom::Enabled(p, action),
            6 if matches!(kind, Kind::Range(_)) && self.random.once_in(2) => Atom::Coded(p, var, action),
            6 => Atom::Choice(p, action, self.random.below(2), self.random.below(2)),
            7 if matches!(kind, Kind::Range(_)) => Atom::Less(p, self.random.below(2), q, var),
            7 | 8 => Atom::SameValue(p, q, var),
            9 | 10 => Atom::SameAction(p, q),
            11 | 12 => Atom::SameState(p, q),
            _ => Atom::SameObs(p, q),
        }
    }
}

/// A formula of one path only.
struct Own<'a> {
    path: usize,
    formulas: Formulas<'a>,
}

impl Own<'_> {
    fn formula(&mut self, look: u32) -> Formula {
        let mut atom = self.formulas.atom();
        match &mut atom {
            Atom::Label(p, _)
            | Atom::Is(p, ..)
            | Atom::Took(p, _)
            | Atom::Enabled(p, _)
            | Atom::Choice(p, ..)
            | Atom::Coded(p, ..) => *p = self.path,
            _ => {}
        }
        let atom = Box::new(Formula::Atom(atom));
        let interval = Some((self.formulas.random.bound(look + 1), look));
        if self.formulas.random.once_in(2) {
            Formula::Finally(interval, atom)
        } else {
            Formula::Globally(interval, atom)
        }
    }
}
