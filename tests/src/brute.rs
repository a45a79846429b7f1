//! The semantics by brute force: all paths enumerated, the formula evaluated by its definition on each tuple.

use crate::model::{Atom, Formula, Interval, Observe, Problem, System};

/// A path: its states, and the actions between them.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Path {
    /// From time 0.
    pub states: Vec<usize>,
    /// One fewer than states.
    pub actions: Vec<usize>,
}

/// A problem with its paths.
#[derive(Clone, Debug)]
pub struct Brute<'a> {
    problem: &'a Problem,
    pub(crate) edges: Vec<(usize, usize, usize)>,
    live: Vec<bool>,
    pub(crate) steps: usize,
    /// All paths, each as long as its variable needs.
    pub paths: Vec<Path>,
}

impl<'a> Brute<'a> {
    /// Enumerates paths; `None` if there are more than `most`.
    #[must_use]
    pub fn new(problem: &'a Problem, most: usize) -> Option<Self> {
        let system = &problem.system;
        let edges = system.edges();
        let live = live(system, &edges);
        let steps = problem.within.unwrap_or(problem.look) as usize;
        let starts = system.init.clone().unwrap_or_else(|| (0..system.states()).collect());
        let mut paths: Vec<Path> =
            starts.into_iter().map(|s| Path { states: vec![s], actions: Vec::new() }).collect();
        for _ in 0..steps {
            paths = paths.iter().flat_map(|path| longer(path, &edges)).collect();
            // Dead ends may still make them fewer, but not by much.
            if paths.len() > 4 * most {
                return None;
            }
        }
        // Without `within` paths are infinite: a prefix stands for its continuations.
        paths.retain(|path| problem.within.is_some() || live[path.states[steps]]);
        (paths.len() <= most).then_some(Brute { problem, edges, live, steps, paths })
    }

    /// The objective's truth.
    #[must_use]
    pub fn verdict(&self) -> bool {
        self.holds(&mut Vec::new())
    }

    /// The truth of the rest of the objective once the first path variables are chosen.
    pub fn holds<'b>(&'b self, chosen: &mut Vec<&'b Path>) -> bool {
        let Some(&exists) = self.problem.exists.get(chosen.len()) else {
            let formula = &self.problem.formula;
            return match self.problem.semantics {
                Some(semantics) => self.holds_under(semantics, formula, chosen),
                None => self.eval(formula, chosen, 0),
            };
        };
        for path in &self.paths {
            chosen.push(path);
            let holds = self.holds(chosen);
            chosen.pop();
            if holds == exists {
                return exists;
            }
        }
        !exists
    }

    /// Why a witness for the leading block is wrong, if it is: traces that are no paths, or paths for which (with
    /// whatever continues them) the rest does not come out as claimed.
    #[must_use]
    pub fn refute(&self, witness: &[Path], verdict: bool) -> Option<String> {
        let leading = self.problem.exists.iter().take_while(|&&e| e == self.problem.exists[0]).count();
        if witness.len() != leading || self.problem.exists[0] != verdict {
            return Some(format!("{} paths for a leading block of {leading}", witness.len()));
        }
        let mut continued: Vec<Vec<&Path>> = Vec::new();
        for path in witness {
            if let Some(why) = self.no_path(path) {
                return Some(format!("{path:?}: {why}"));
            }
            let continues = |p: &&Path| {
                let common = path.states.len().min(p.states.len());
                p.states[..common] == path.states[..common]
                    && p.actions[..common - 1] == path.actions[..common - 1]
            };
            continued.push(self.paths.iter().filter(continues).collect());
        }
        let mut tuples: Vec<Vec<&Path>> = vec![Vec::new()];
        for paths in &continued {
            if paths.is_empty() {
                return Some("a path has no continuation".into());
            }
            tuples = tuples
                .iter()
                .flat_map(|t| paths.iter().map(move |&p| [t.as_slice(), &[p]].concat()))
                .collect();
        }
        let wrong = tuples.iter_mut().find_map(|tuple| (self.holds(tuple) != verdict).then(|| tuple.clone()));
        wrong.map(|tuple| format!("it does not decide the objective as {tuple:?}"))
    }

    fn no_path(&self, path: &Path) -> Option<&'static str> {
        let Path { states, actions } = path;
        if states.len() != actions.len() + 1 {
            return Some("wrong lengths");
        }
        if self.problem.within.is_some() && actions.len() != self.steps {
            return Some("not K steps");
        }
        if self.problem.system.init.as_ref().is_some_and(|init| !init.contains(&states[0])) {
            return Some("not initial");
        }
        if (0..actions.len()).any(|t| !self.edges.contains(&(states[t], actions[t], states[t + 1]))) {
            return Some("not a transition");
        }
        let dead = self.problem.within.is_none() && !self.live[states[actions.len()]];
        dead.then_some("a dead end")
    }

    /// Whether a formula holds of these paths at a time.
    #[must_use]
    pub fn eval(&self, formula: &Formula, paths: &[&Path], t: usize) -> bool {
        let at = |f: &Formula, t: usize| self.eval(f, paths, t);
        // Positions of the interval that exist.
        let window = |i: &Interval| {
            let (lo, hi) = i.map_or((0, self.steps), |(lo, hi)| (lo as usize, hi as usize));
            t + lo..(t + hi + 1).min(self.steps + 1)
        };
        let until = |i: &Interval, a: &dyn Fn(usize) -> bool, b: &dyn Fn(usize) -> bool| {
            window(i).any(|j| b(j) && (t..j).all(a))
        };
        match formula {
            Formula::Atom(atom) => self.atom(atom, paths, t),
            Formula::Not(a) => !at(a, t),
            Formula::And(fs) => fs.iter().all(|f| at(f, t)),
            Formula::Or(fs) => fs.iter().any(|f| at(f, t)),
            Formula::Implies(a, b) => !at(a, t) || at(b, t),
            Formula::Iff(a, b) => at(a, t) == at(b, t),
            Formula::Next(a) => t < self.steps && at(a, t + 1),
            Formula::WeakNext(a) => t >= self.steps || at(a, t + 1),
            Formula::Finally(i, a) => window(i).any(|j| at(a, j)),
            Formula::Globally(i, a) => window(i).all(|j| at(a, j)),
            Formula::Until(i, a, b) => until(i, &|j| at(a, j), &|j| at(b, j)),
            Formula::Release(i, a, b) => !until(i, &|j| !at(a, j), &|j| !at(b, j)),
            Formula::WeakUntil(i, a, b) => {
                let from_now = i.map(|(_, hi)| (0, hi));
                until(i, &|j| at(a, j), &|j| at(b, j)) || window(&from_now).all(|j| at(a, j))
            }
            Formula::StrongRelease(i, a, b) => window(i).any(|j| at(a, j) && (t..=j).all(|k| at(b, k))),
        }
    }

    /// What a path costs in its first steps.
    #[must_use]
    pub fn cost(&self, path: &Path, steps: usize) -> usize {
        self.problem.system.cost_of(&path.states, &path.actions, steps)
    }

    pub(crate) fn atom(&self, atom: &Atom, paths: &[&Path], t: usize) -> bool {
        let system = &self.problem.system;
        let state = |p: &usize| paths[*p].states[t];
        let value = |p: &usize, v: &usize| system.values(state(p))[*v];
        // The action just taken: none at time 0.
        let taken = |p: &usize| t.checked_sub(1).map(|t| paths[*p].actions[t]);
        match atom {
            Atom::Label(p, l) => system.labels[*l].contains(&state(p)),
            Atom::Is(p, v, n) => value(p, v) == *n,
            Atom::Less(p, k, q, v) => value(p, v) + k < value(q, v),
            Atom::SameValue(p, q, v) => value(p, v) == value(q, v),
            Atom::Took(p, a) => taken(p) == Some(*a),
            Atom::SameAction(p, q) => taken(p) == taken(q),
            Atom::SameState(p, q) => state(p) == state(q),
            Atom::SameObs(p, q) => match system.observe {
                Observe::First => value(p, &0) == value(q, &0),
                Observe::Label => {
                    system.labels[0].contains(&state(p)) == system.labels[0].contains(&state(q))
                }
            },
            Atom::Choice(p, a, yes, no) => {
                let label = if taken(p) == Some(*a) { yes } else { no };
                system.labels[*label].contains(&state(p))
            }
            Atom::Coded(p, v, a) => value(p, v) == usize::from(taken(p) == Some(*a)),
            Atom::Costs(p, most) => self.cost(paths[*p], t) <= *most,
            Atom::Cheaper(p, less, q) => self.cost(paths[*p], t) + less < self.cost(paths[*q], t),
            Atom::Enabled(p, a) => self.edges.iter().any(|e| e.0 == state(p) && e.1 == *a),
        }
    }
}

fn longer<'a>(path: &'a Path, edges: &'a [(usize, usize, usize)]) -> impl Iterator<Item = Path> + 'a {
    let last = path.states[path.actions.len()];
    edges.iter().filter(move |e| e.0 == last).map(|&(_, action, to)| Path {
        states: [path.states.as_slice(), &[to]].concat(),
        actions: [path.actions.as_slice(), &[action]].concat(),
    })
}

/// Whether each state has an infinite path: all of them do, except those whose successors all do not.
fn live(system: &System, edges: &[(usize, usize, usize)]) -> Vec<bool> {
    let mut live = vec![true; system.states()];
    // Each round but the last strikes out a state.
    for _ in 0..system.states() {
        live = (0..live.len()).map(|s| edges.iter().any(|e| e.0 == s && live[e.2])).collect();
    }
    live
}
